// GPL v2 or later, see LICENSE.
// Strain of the sub-elements and rotation strain: patch test, rigid motion, objectivity
// (Zubelewicz 2018, eqs. 1–2, 9–14).
#include "../TriangleSamples.hpp"

#include <gtest/gtest.h>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::samples;

struct Gradient { ///< of a linear displacement field
	double xx, xy, yx, yy;

	static Gradient random(Random& random, double size)
	{
		return { random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size),
			 random.uniform(-size, size) };
	}
	Point                 operator*(const Point& a) const { return { xx * a.x + xy * a.y, yx * a.x + yy * a.y }; }
	InPlaneTensor<double> strain() const { return { xx, yy, 0.5 * (xy + yx) }; }
	Gradient              symmetric() const { return { xx, 0.5 * (xy + yx), 0.5 * (xy + yx), yy }; }
};

double difference(const InPlaneTensor<double>& a, const InPlaneTensor<double>& b)
{
	return std::max({ std::abs(a.xx - b.xx), std::abs(a.yy - b.yy), std::abs(a.xy - b.xy) });
}

PlaneRotation<double> turn(double angle) { return { std::cos(angle), std::sin(angle) }; }

/// What an element makes of given positions, by the frame's own rotation.
template <class Frame>
RelativeDisplacements<double>
displacements(const TriangleReference<double>& reference, const Vertices& x, const Point& core, double angle)
{
	const RelativeDisplacements<double> fromCentre = { x[0] - core, x[1] - core, x[2] - core };
	const PlaneRotation<double>              frame      = Frame::rotation(reference, fromCentre, angle);
	RelativeDisplacements<double>       du;
	for (std::size_t e = 0; e < 3; e++)
		du[e] = relativeDisplacement(frame, fromCentre[e], reference.arm[e]);
	return du;
}

/// ε_φ of eq. 2 worked out by angles: a symmetric strain turns the direction θ by ½(ε_yy − ε_xx) sin 2θ + ε_xy cos 2θ.
double meanTurnOfVertices(const TriangleReference<double>& reference, const InPlaneTensor<double>& strain)
{
	double sum = 0;
	for (const Point& r : reference.arm) {
		const double twice = 2 * std::atan2(r.y, r.x);
		sum += 0.5 * (strain.yy - strain.xx) * std::sin(twice) + strain.xy * std::cos(twice);
	}
	return sum / 3;
}

RelativeDisplacements<double> linearField(const TriangleReference<double>& reference, const Gradient& g)
{
	return { g * reference.arm[0], g * reference.arm[1], g * reference.arm[2] };
}

TEST(TriangleStrain, linearFieldGivesItsStrainInAllSubElements) // patch test
{
	Random random(2);
	for (int i = 0; i < 1000; i++) {
		const auto     reference = makeReference(random.skewedTriangle());
		const Gradient field     = Gradient::random(random, 0.01);
		for (const auto& strain : subElementStrains(reference, linearField(reference, field)))
			EXPECT_LT(difference(strain, field.strain()), 1e-12 * 0.01);
	}
}

// the third vertex moves: the opposite sub-element stays unstrained
TEST(TriangleStrain, subElementSeesOnlyItsTwoVertices)
{
	Random random(3);
	for (std::size_t e = 0; e < 3; e++) {
		const auto                    reference = makeReference(random.skewedTriangle());
		RelativeDisplacements<double> du {};
		du[e]             = 1e-3 * reference.arm[e];
		const auto strain = subElementStrains(reference, du);
		EXPECT_EQ(difference(strain[(e + 1) % 3], { 0, 0, 0 }), 0);
		EXPECT_GT(difference(strain[e], { 0, 0, 0 }), 1e-4);
		EXPECT_GT(difference(strain[(e + 2) % 3], { 0, 0, 0 }), 1e-4);
	}
}

template <class Frame> void expectObjective(std::uint64_t seed)
{
	Random random(seed);
	for (int i = 0; i < 1000; i++) {
		const Vertices X         = random.skewedTriangle();
		const auto     reference = makeReference(X);
		const double   angle     = random.uniform(-10, 10);
		const auto     R         = turn(angle);
		const Gradient stretch   = Gradient::random(random, 0.2).symmetric();
		const double   size      = std::hypot(reference.arm[0].x, reference.arm[0].y)
		        + std::hypot(reference.arm[1].x, reference.arm[1].y);
		const Point    core      = random.point(size);
		Vertices       rigid, stretched;
		for (std::size_t e = 0; e < 3; e++) {
			rigid[e]     = core + R * reference.arm[e];
			stretched[e] = core + R * (reference.arm[e] + stretch * reference.arm[e]);
		}
		// aspect ratios up to 20 magnify the round-off of positions
		const auto still = displacements<Frame>(reference, rigid, core, angle);
		for (const auto& strain : subElementStrains(reference, still))
			EXPECT_LT(difference(strain, { 0, 0, 0 }), 1e-13);
		EXPECT_NEAR(rotationStrain(reference, still), 0, 1e-13);
		for (const auto& strain :
		     subElementStrains(reference, displacements<Frame>(reference, stretched, core, angle)))
			EXPECT_LT(difference(strain, stretch.strain()), 1e-13);
	}
}

TEST(TriangleStrain, isObjectiveInTheCorotationalFrame) { expectObjective<FrameCorotational>(4); }
TEST(TriangleStrain, isObjectiveInTheCosseratFrame) { expectObjective<FrameCosserat>(5); }

TEST(TriangleStrain, corotationalFrameIgnoresTheCore) // its rotation follows the vertices alone
{
	Random         random(6);
	const auto     reference = makeReference(random.skewedTriangle());
	const Vertices v         = { { { 0.3, 0.1 }, { 2, 0.4 }, { 0.6, 1.7 } } };
	const auto frame = [&](const Point& core) {
		return FrameCorotational::rotation(reference, { v[0] - core, v[1] - core, v[2] - core }, 0.);
	};
	const auto     first = frame({ 0, 0 }), second = frame({ 3, -2 });
	EXPECT_NEAR(first.c, second.c, 1e-14);
	EXPECT_NEAR(first.s, second.s, 1e-14);
	EXPECT_NEAR(first.c * first.c + first.s * first.s, 1, 1e-15);
}

TEST(RotationStrain, isTheSineOfTheVerticesRotationAboutTheCore)
{
	Random random(7);
	for (int i = 0; i < 1000; i++) {
		const auto                    reference = makeReference(random.skewedTriangle());
		const double                  angle     = random.uniform(-10, 10);
		RelativeDisplacements<double> du;
		for (std::size_t e = 0; e < 3; e++)
			du[e] = turn(angle) * reference.arm[e] - reference.arm[e];
		EXPECT_NEAR(rotationStrain(reference, du), std::sin(angle), 1e-14);
	}
}

TEST(RotationStrain, ofAHomogeneousStrainIsTheMeanTurnOfTheThreeArms)
{
	Random random(8);
	for (int i = 0; i < 1000; i++) {
		const auto     reference = makeReference(random.skewedTriangle());
		const Gradient strain    = Gradient::random(random, 0.01).symmetric();
		EXPECT_NEAR(
		        rotationStrain(reference, linearField(reference, strain)),
		        meanTurnOfVertices(reference, strain.strain()), 1e-16);
	}
}

TEST(RotationStrain, ofAHomogeneousStrainVanishesInEquilateralTrianglesOnly)
{
	Random     random(9);
	const auto rotationOf = [](const Vertices& v, const Gradient& strain) {
		const auto reference = makeReference(v);
		return rotationStrain(reference, linearField(reference, strain));
	};
	const Gradient stretch { 1, 0, 0, 0 }, shear { 0, 0.5, 0.5, 0 };
	const Vertices equilateral = { { { 0, 0 }, { 2, 0 }, { 1, std::sqrt(3.) } } };
	const Vertices isosceles   = { { { 0, 0 }, { 2, 0 }, { 1, 3 } } };
	const Vertices right       = { { { 0, 0 }, { 2, 0 }, { 0, 1 } } };
	for (int i = 0; i < 100; i++)
		EXPECT_NEAR(rotationOf(equilateral, Gradient::random(random, 1).symmetric()), 0, 1e-15);
	// strain along the axis of symmetry turns left and right alike
	EXPECT_NEAR(rotationOf(isosceles, stretch), 0, 1e-15);
	EXPECT_GT(std::abs(rotationOf(isosceles, shear)), 0.1);
	EXPECT_GT(std::abs(rotationOf(right, stretch)), 0.1);
	EXPECT_GT(std::abs(rotationOf(right, shear)), 0.1);
}

} // namespace
