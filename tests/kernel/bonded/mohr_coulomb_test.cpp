// GPL v2 or later, see LICENSE.
// Mohr-Coulomb failure of a bond: envelope, apex, cut-off, mode.
#include <pkg/bonded/kernel/BondCriterionOf.hpp>
#include <pkg/bonded/kernel/criteria/MohrCoulomb.hpp>

#include <gtest/gtest.h>

namespace {

using namespace yade::ddem;

using Strength = MohrCoulomb::Strength<double>;

Strength strength(double cohesion, double friction, double tensile = std::numeric_limits<double>::infinity())
{
	MohrCoulomb::Parameters p;
	p.cohesion          = cohesion;
	p.bondFrictionAngle = std::atan(friction);
	p.tensileStrength   = tensile;
	return MohrCoulomb::strengthOf(p, {});
}

BondFailure failure(const Strength& strength, const BondStress& stress)
{
	return MohrCoulomb::overload(strength, stress) > 0 ? MohrCoulomb::mode(strength, {}, stress)
	                                                   : BondFailure::None;
}

TEST(MohrCoulomb, breaksJustBeyondItsEnvelope)
{
	for (double normal = -300e6; normal < 199e6; normal += 7e6) {
		const double limit = 100e6 - 0.5 * normal;
		EXPECT_EQ(failure(strength(100e6, 0.5), { normal, limit * (1 - 1e-9) }), BondFailure::None) << normal;
		EXPECT_NE(failure(strength(100e6, 0.5), { normal, limit * (1 + 1e-9) }), BondFailure::None) << normal;
	}
}

TEST(MohrCoulomb, breaksInTensionAtTheApex)
{
	const Strength s = strength(100e6, 0.5);
	EXPECT_NEAR(s.tensionLimit, 200e6, 1e-6);
	EXPECT_EQ(failure(s, { 200e6 * (1 - 1e-12), 0 }), BondFailure::None);
	EXPECT_EQ(failure(s, { 200e6 * (1 + 1e-12), 0 }), BondFailure::Tension);
}

TEST(MohrCoulomb, hasNoLimitInCompression)
{
	EXPECT_EQ(failure(strength(1e6, 1), { -1e15, 0 }), BondFailure::None);
}

TEST(MohrCoulomb, cutOffLiesBelowTheApex)
{
	const Strength s = strength(100e6, 0.5, 30e6);
	EXPECT_EQ(failure(s, { 29e6, 80e6 }), BondFailure::None);
	EXPECT_EQ(failure(s, { 31e6, 0 }), BondFailure::Tension);
	EXPECT_EQ(failure(s, { 29e6, 90e6 }), BondFailure::Shear);
}

TEST(MohrCoulomb, namesTheLargerShare)
{
	const Strength s = strength(100e6, 1);
	EXPECT_EQ(failure(s, { 60e6, 41e6 }), BondFailure::Tension);
	EXPECT_EQ(failure(s, { 40e6, 61e6 }), BondFailure::Shear);
	EXPECT_EQ(failure(s, { -40e6, 141e6 }), BondFailure::Shear);
}

TEST(MohrCoulomb, withoutFrictionIsTresca)
{
	EXPECT_EQ(failure(strength(100e6, 0), { 1e12, 99e6 }), BondFailure::None);
	EXPECT_EQ(failure(strength(100e6, 0), { -1e12, 101e6 }), BondFailure::Shear);
}

} // namespace
