// GPL v2 or later, see LICENSE.
// The parallel bond of Potyondy and Cundall (2004): eqs. 15 to 17 there, with the moment contribution of PFC.
#include <pkg/bonded/kernel/BondCriterionOf.hpp>
#include <pkg/bonded/kernel/criteria/ParallelBond.hpp>

#include <gtest/gtest.h>

namespace {

using namespace yade::ddem;

const BondSection section { 1e-3 };

ParallelBond::Parameters parameters()
{
	ParallelBond::Parameters p;
	p.cohesion        = 40e6;
	p.tensileStrength = 10e6;
	return p;
}

/// How far a bond under these loads is beyond its strength [Pa].
double overload(const ParallelBond::Parameters& p, BondResultants load)
{
	NoBondMemory<double> none;
	return ParallelBond::advance(ParallelBond::strengthOf(p, {}), none, section, BondStiffness {}, load).overload;
}

TEST(ParallelBond, strengthsInTensionAndShearAreFreeOfEachOther)
{
	for (const double shear : { 1e6, 40e6, 900e6 }) {
		auto p     = parameters();
		p.cohesion = shear;
		EXPECT_NEAR(overload(p, { { 10e6 * section.area, 0, 0 }, {} }), 0, 1) << shear;
		EXPECT_NEAR(overload(p, { { 0, shear * section.area, 0 }, {} }), 0, 1e-8 * shear) << shear;
	}
}

TEST(ParallelBond, bearsShearWhateverTheNormalStressUnlessItHasFriction)
{
	auto p = parameters();
	const BondResultants pressed { { -30e6 * section.area, 40e6 * section.area, 0 }, {} };
	EXPECT_NEAR(overload(p, pressed), 0, 1);
	p.bondFrictionAngle = std::atan(0.5);
	EXPECT_NEAR(overload(p, pressed), -15e6, 1);
	// PFC takes the mean normal stress there, not that of the rim
	EXPECT_NEAR(overload(p, { { -30e6 * section.area, 40e6 * section.area, 0 }, { 0, 0.01, 0 } }), -15e6, 1);
}

TEST(ParallelBond, momentsCountAsMuchAsTold)
{
	auto p = parameters();
	for (const double beta : { 0., 0.5, 1. }) {
		p.momentContribution = beta;
		const double bending = 8e6 * section.bendingModulus, torsion = 50e6 * section.torsionModulus;
		EXPECT_NEAR(overload(p, { { 9e6 * section.area, 0, 0 }, { 0, bending, 0 } }), -1e6 + beta * 8e6, 1);
		EXPECT_NEAR(overload(p, { {}, { torsion, 0, 0 } }), std::max(-10e6, beta * 50e6 - 40e6), 1);
	}
}

TEST(ParallelBond, radiusIsOfTheSmallerSphere)
{
	auto p         = parameters();
	p.radiusFactor = 0.8;
	EXPECT_DOUBLE_EQ(ParallelBond::radius(p, { {}, 5e-3, 3e-3, 2e-3 }), 1.6e-3);
}

TEST(ParallelBond, theWeakerOfTwoTakesMoreOfTheMoments)
{
	auto a = parameters(), b = parameters();
	a.momentContribution = 0.2;
	a.cohesion           = 30e6;
	const auto weaker    = ParallelBond::weaker(a, b);
	EXPECT_EQ(weaker.momentContribution, 1);
	EXPECT_EQ(weaker.cohesion, 30e6);
	EXPECT_EQ(weaker.tensileStrength, 10e6);
}

} // namespace
