// GPL v2 or later, see LICENSE.
// Lumped masses are those of the solid triangle.
#include "../TriangleSamples.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::samples;

/// Polar moment of a solid triangle about its centroid over its mass: (a² + b² + c²)/36 of its edges
/// (standard table of solids).
double solidGyration(const Vertices& v)
{
	double edges = 0;
	for (std::size_t e = 0; e < 3; e++) {
		const Point edge = v[(e + 1) % 3] - v[e];
		edges += dot(edge, edge);
	}
	return edges / 36;
}

TEST(LumpedMass, keepsMassCentroidAndInertiaForAnyShare)
{
	Random       random(21);
	const double density = 2400, thickness = 0.3;
	for (int i = 0; i < 1000; i++) {
		const Vertices v         = random.skewedTriangle();
		const auto     reference = makeReference(v);
		const auto m = lumpMass(
		        reference, density, thickness, random.uniform(0.001, 0.249), RotationTreatment::Cosserat);
		const double   mass      = density * thickness * 0.5 * cross(v[1] - v[0], v[2] - v[0]);
		EXPECT_NEAR(3 * m.vertex + m.core, mass, 1e-13 * mass);
		EXPECT_GT(m.vertex, 0);
		EXPECT_GT(m.inertia, 0);
		double inertia = m.inertia;
		Point  moment { 0, 0 }; // first moment about the core
		for (const Point& r : reference.arm) {
			inertia += m.vertex * dot(r, r);
			moment = moment + m.vertex * r;
		}
		EXPECT_NEAR(inertia, mass * solidGyration(v), 1e-12 * inertia);
		EXPECT_NEAR(moment.x, 0, 1e-14 * std::sqrt(mass * inertia));
		EXPECT_NEAR(moment.y, 0, 1e-14 * std::sqrt(mass * inertia));
	}
}

TEST(LumpedMass, verticesAloneCarryTheWholeInertiaAtAQuarter) // the right share where cores do not rotate
{
	Random random(22);
	for (int i = 0; i < 100; i++) {
		const Vertices v         = random.skewedTriangle();
		const auto     reference = makeReference(v);
		const auto     m         = lumpMass(reference, 2400, 1, 0.25, RotationTreatment::Corotational);
		double         inertia   = 0;
		for (const Point& r : reference.arm)
			inertia += m.vertex * dot(r, r);
		EXPECT_NEAR(inertia, (3 * m.vertex + m.core) * solidGyration(v), 1e-12 * inertia);
	}
}

TEST(LumpedMass, givesEachVertexAThirdOfTheShare) // 3-4-5 triangle of 6 m² × 1 m × 100 kg/m³ = 600 kg
{
	const auto m = lumpMass(
	        makeReference({ { { 0, 0 }, { 4, 0 }, { 0, 3 } } }), 100, 1, 0.2, RotationTreatment::Cosserat);
	EXPECT_DOUBLE_EQ(m.vertex, 40);
	EXPECT_DOUBLE_EQ(m.core, 480);
}

std::string refusal(double density, double thickness, double share, RotationTreatment rotation)
{
	try {
		lumpMass(makeReference({ { { 0, 0 }, { 4, 0 }, { 0, 3 } } }), density, thickness, share, rotation);
	} catch (const std::invalid_argument& e) {
		return e.what();
	}
	return "accepted";
}

TEST(LumpedMass, leavesNoInertiaForTheCoreFromAQuarterOn)
{
	for (const double share : { 0.25, 0.3, 0.99 }) {
		EXPECT_NE(refusal(2400, 1, share, RotationTreatment::Cosserat).find("1/4"), std::string::npos) << share;
		// no rotation, no inertia needed
		EXPECT_EQ(refusal(2400, 1, share, RotationTreatment::None), "accepted");
		EXPECT_EQ(refusal(2400, 1, share, RotationTreatment::Corotational), "accepted");
	}
	EXPECT_EQ(refusal(2400, 1, std::nextafter(0.25, 0), RotationTreatment::Cosserat), "accepted");
}

TEST(LumpedMass, refusesValuesOutOfRangeByNameValueAndUnit)
{
	const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
	for (const auto rotation : allTreatments) {
		for (const double bad : { 0., -2400., nan, infinity }) {
			const std::string density   = refusal(bad, 1, 0.1, rotation),
			                  thickness = refusal(2400, bad, 0.1, rotation);
			EXPECT_NE(density.find("density"), std::string::npos) << bad << ": " << density;
			EXPECT_NE(density.find("kg/m³"), std::string::npos) << bad << ": " << density;
			EXPECT_NE(thickness.find("thickness"), std::string::npos) << bad << ": " << thickness;
		}
		for (const double bad : { 0., -0.1, 1., 2., nan }) {
			const std::string share = refusal(2400, 1, bad, rotation);
			EXPECT_NE(share.find("vertexShare"), std::string::npos) << bad << ": " << share;
		}
	}
	// the value itself, not 0.000000
	EXPECT_NE(refusal(-2.5e-9, 1, 0.1, RotationTreatment::None).find("-2.5e-09"), std::string::npos);
}

} // namespace
