// GPL v2 or later, see LICENSE.
// Forces of the deformable triangle derive from one energy and balance (Zubelewicz 2018, eqs. 3, 4, 15).
#include "../TriangleSamples.hpp"

#include <gtest/gtest.h>

#include <complex>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::samples;
using Complex = std::complex<double>;

/// Unknowns of one element: x, y of three vertices and of the core, rotation of the core.
template <class Number> using Unknowns = std::array<Number, 9>;

template <class Number> TriangleReference<Number> convert(const TriangleReference<double>& reference)
{
	return TriangleReference<Number>(
	        { Number(reference.arm[0].x), Number(reference.arm[0].y) },
	        { Number(reference.arm[1].x), Number(reference.arm[1].y) });
}

template <class Number> struct Deformed {
	RelativeDisplacements<Number> fromCentre, du;
	PlaneRotation<Number>              frame;
};

template <class Frame, class Number>
Deformed<Number> deform(const TriangleReference<Number>& reference, const Unknowns<Number>& x)
{
	Deformed<Number> state;
	for (std::size_t e = 0; e < 3; e++)
		state.fromCentre[e] = { x[2 * e] - x[6], x[2 * e + 1] - x[7] };
	state.frame = Frame::rotation(reference, state.fromCentre, x[8]);
	for (std::size_t e = 0; e < 3; e++)
		state.du[e] = relativeDisplacement(state.frame, state.fromCentre[e], reference.arm[e]);
	return state;
}

/// U = h [Σ_k S/3 (½ λ tr² ε_k + μ ε_k:ε_k) + ½ μ β_φ ε_φ² S]
template <class Frame, class Number>
Number energyOf(const TriangleReference<Number>& reference, const Unknowns<Number>& x, const Material& m)
{
	const Deformed<Number> state = deform<Frame>(reference, x);
	Number                 density(0);
	for (const auto& e : subElementStrains(reference, state.du)) {
		const Number trace = e.xx + e.yy;
		density += (0.5 * m.lambda() * trace * trace + m.shear * (e.xx * e.xx + e.yy * e.yy + 2. * e.xy * e.xy))
		        / 3.;
	}
	if (Frame::coreRotates) {
		const Number turn = rotationStrain(reference, state.du);
		density += 0.5 * m.shear * m.rotationStiffness * turn * turn;
	}
	return m.thickness * reference.area() * density;
}

/// The kernel's forces and moment in the order of Unknowns.
template <class Frame, class Number>
Unknowns<Number> forcesOf(const TriangleReference<Number>& reference, const Unknowns<Number>& x, const Material& m)
{
	const Deformed<Number>    state = deform<Frame>(reference, x);
	SubElementTensors<Number> stress;
	const auto                strain = subElementStrains(reference, state.du);
	for (std::size_t k = 0; k < 3; k++)
		stress[k] = elasticStress(strain[k], Number(m.lambda()), Number(m.shear));
	auto q = stressForces(reference, stress, Number(m.thickness));
	if (Frame::coreRotates)
		addRotationForces(
		        reference, Number(m.shear * m.rotationStiffness) * rotationStrain(reference, state.du),
		        Number(m.thickness), q);
	const auto f = Frame::distribute(reference, state.fromCentre, state.frame, state.du, q);
	return { f.vertex[0].x, f.vertex[0].y, f.vertex[1].x, f.vertex[1].y, f.vertex[2].x,
		 f.vertex[2].y, f.core.x,      f.core.y,      f.moment };
}

/// ∂f/∂x_i by a complex step: exact to round-off, there is no difference of near numbers.
template <class Function> auto derivative(const Function& f, const Unknowns<double>& x, std::size_t i)
{
	constexpr double  step = 1e-100;
	Unknowns<Complex> z;
	for (std::size_t j = 0; j < 9; j++)
		z[j] = Complex(x[j], j == i ? step : 0.);
	return f(z, step);
}

/// A finite deformation (up to 20 %, not homogeneous) in any position and orientation,
/// the core off the centroid and turned by itself.
Unknowns<double> deformedPlaces(const TriangleReference<double>& reference, Random& random)
{
	const double           angle = random.uniform(-10, 10), size = std::sqrt(reference.area());
	const PlaneRotation<double> R { std::cos(angle), std::sin(angle) };
	const Point            centre = random.point(size);
	Unknowns<double>       x;
	for (std::size_t e = 0; e < 3; e++) {
		const Point place = centre + R * (reference.arm[e] + random.point(0.2 * size));
		x[2 * e]          = place.x;
		x[2 * e + 1]      = place.y;
	}
	const Point core = centre + random.point(0.1 * size);
	x[6]             = core.x;
	x[7]             = core.y;
	x[8]             = angle + random.uniform(-0.3, 0.3);
	return x;
}

Unknowns<double> placesAtRest(const TriangleReference<double>& reference)
{
	const auto& r = reference.arm;
	return { r[0].x, r[0].y, r[1].x, r[1].y, r[2].x, r[2].y, 0, 0, 0 };
}

/// Largest force, with the moment per length, so that one tolerance serves all sizes.
double scaleOf(const Unknowns<double>& f, double size)
{
	double scale = std::abs(f[8]) / size;
	for (std::size_t i = 0; i < 8; i++)
		scale = std::max(scale, std::abs(f[i]));
	return scale;
}

template <class Frame> class TriangleForces : public testing::Test { };
struct FrameNames {
	template <class Frame> static std::string GetName(int)
	{
		return Frame::coreRotates ? "Cosserat" : std::is_same_v<Frame, FrameNone> ? "None" : "Corotational";
	}
};
using Frames = testing::Types<FrameNone, FrameCorotational, FrameCosserat>;
TYPED_TEST_SUITE(TriangleForces, Frames, FrameNames);

TYPED_TEST(TriangleForces, areMinusTheGradientOfTheEnergyAtFiniteDeformation)
{
	Random         random(11);
	const Material material { 30e9, 26e9, 2, 2400, 0.7, 1. / 6 };
	for (int i = 0; i < 500; i++) {
		const auto   reference = makeReference(random.skewedTriangle());
		const auto   complex   = convert<Complex>(reference);
		const auto   x         = deformedPlaces(reference, random);
		const auto   force     = forcesOf<TypeParam>(reference, x, material);
		const double size = std::sqrt(reference.area()), scale = scaleOf(force, size);
		for (std::size_t j = 0; j < 9; j++) {
			const double slope = derivative(
			        [&](const Unknowns<Complex>& z, double step) {
				        return energyOf<TypeParam>(complex, z, material).imag() / step;
			        },
			        x, j);
			EXPECT_NEAR(force[j], -slope, 1e-12 * scale * (j == 8 ? size : 1)) << "unknown " << j;
		}
	}
}

TYPED_TEST(TriangleForces, vanishAtRest)
{
	Random         random(12);
	const Material material;
	for (int i = 0; i < 100; i++) {
		const auto reference = makeReference(random.skewedTriangle());
		const auto force     = forcesOf<TypeParam>(reference, placesAtRest(reference), material);
		for (const double f : force)
			EXPECT_LT(std::abs(f), 1e-13 * material.bulk * std::sqrt(reference.area()));
	}
}

TYPED_TEST(TriangleForces, conserveMomentum)
{
	Random         random(13);
	const Material material;
	for (int i = 0; i < 500; i++) {
		const auto   reference = makeReference(random.skewedTriangle());
		const auto   x         = deformedPlaces(reference, random);
		const auto   f         = forcesOf<TypeParam>(reference, x, material);
		const double size = std::sqrt(reference.area()), scale = scaleOf(f, size);
		EXPECT_NEAR(f[0] + f[2] + f[4] + f[6], 0, 1e-14 * scale);
		EXPECT_NEAR(f[1] + f[3] + f[5] + f[7], 0, 1e-14 * scale);
		// R = 1 is not objective: its angular momentum balances at rest only
		if (std::is_same_v<TypeParam, FrameNone>) continue;
		double torque = f[8];
		for (std::size_t e = 0; e < 3; e++)
			torque += (x[2 * e] - x[6]) * f[2 * e + 1] - (x[2 * e + 1] - x[7]) * f[2 * e];
		EXPECT_NEAR(torque, 0, 1e-13 * scale * size);
	}
}

TYPED_TEST(TriangleForces, haveTheElementStiffnessAsTheirDerivativeAtRest)
{
	Random                  random(14);
	const Material          material { 30e9, 26e9, 2, 2400, 0.7, 1. / 6 };
	const RotationTreatment rotation
	        = TypeParam::coreRotates ? RotationTreatment::Cosserat : RotationTreatment::Corotational;
	for (int i = 0; i < 200; i++) {
		const auto          reference = makeReference(random.skewedTriangle());
		const auto          complex   = convert<Complex>(reference);
		const double        size      = std::sqrt(reference.area());
		const ElementMatrix stiffness
		        = elementStiffness(reference, material.stiffness(), material.thickness, rotation);
		ElementMatrix       slopes;
		for (int column = 0; column < 9; column++) {
			const auto slope = derivative(
			        [&](const Unknowns<Complex>& z, double step) {
				        Unknowns<double> result;
				        const auto       force = forcesOf<TypeParam>(complex, z, material);
				        for (std::size_t row = 0; row < 9; row++)
					        result[row] = -force[row].imag() / step;
				        return result;
			        },
			        placesAtRest(reference),
			        std::size_t(column));
			for (int row = 0; row < 9; row++)
				slopes(row, column) = slope[std::size_t(row)];
		}
		ElementVector units       = ElementVector::Ones(); // newtons per metre throughout
		units[8]                  = 1 / size;
		const ElementMatrix error = units.asDiagonal() * (slopes - stiffness) * units.asDiagonal();
		EXPECT_LT(
		        error.cwiseAbs().maxCoeff(),
		        1e-12 * (units.asDiagonal() * stiffness * units.asDiagonal()).cwiseAbs().maxCoeff());
	}
}

// a homogeneous stress loads a vertex by ½ h σ·(outward normals of its two edges)
TEST(StressForces, areTheDivergenceTheoremsTractions)
{
	Random random(15);
	for (int i = 0; i < 200; i++) {
		const auto                  reference = makeReference(random.skewedTriangle());
		const InPlaneTensor<double> stress { random.uniform(-1, 1), random.uniform(-1, 1),
			                             random.uniform(-1, 1) };
		const double                thickness = 0.3;
		const auto                  q         = stressForces(reference, { stress, stress, stress }, thickness);
		for (std::size_t e = 0; e < 3; e++) {
			// both edges' normals sum to the opposite one's reverse
			const Point chord    = reference.arm[(e + 2) % 3] - reference.arm[(e + 1) % 3];
			const Point expected = stress * ((-0.5 * thickness) * Point { chord.y, -chord.x });
			EXPECT_NEAR(q[e].x, expected.x, 1e-14 * thickness * std::hypot(chord.x, chord.y) * 10);
			EXPECT_NEAR(q[e].y, expected.y, 1e-14 * thickness * std::hypot(chord.x, chord.y) * 10);
		}
	}
}

TEST(ElasticStress, isIsotropicAndStoresHalfItsWork) // σ = λ tr ε 1 + 2μ ε in plane strain, w = ½ λ tr² ε + μ ε:ε
{
	const double                lambda = 3, mu                    = 5;
	const InPlaneTensor<double> strain { 0.7, -0.2, 0.4 }, stress = elasticStress(strain, lambda, mu);
	EXPECT_DOUBLE_EQ(stress.xx, 3 * 0.5 + 10 * 0.7);
	EXPECT_DOUBLE_EQ(stress.yy, 3 * 0.5 - 10 * 0.2);
	EXPECT_DOUBLE_EQ(stress.xy, 10 * 0.4);
	EXPECT_DOUBLE_EQ(energyDensity(stress, strain), 1.5 * 0.25 + 5 * (0.49 + 0.04 + 2 * 0.16));
}

// stress is symmetric: its moment is of second order, that of ε_φ is h S μ β_φ ε_φ
TEST(CoreMoment, comesFromTheRotationStrainAloneAtSmallStrain)
{
	Random         random(16);
	const Material material;
	for (int i = 0; i < 200; i++) {
		const auto       reference = makeReference(random.skewedTriangle());
		const double     size = std::sqrt(reference.area()), small = 1e-7;
		Unknowns<double> x = placesAtRest(reference);
		for (std::size_t j = 0; j < 6; j++)
			x[j] += small * size * random.uniform(-1, 1);
		const auto   state = deform<FrameCosserat>(reference, x);
		const double expected = material.thickness * reference.area() * material.shear
		        * material.rotationStiffness * rotationStrain(reference, state.du);
		EXPECT_NEAR(
		        forcesOf<FrameCosserat>(reference, x, material)[8], expected,
		        1e3 * small * small * material.bulk * size * size);
	}
}

} // namespace
