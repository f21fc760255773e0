// GPL v2 or later, see LICENSE.
// Mohr-Coulomb failure of a bond: stresses of the cross-section, envelope, mode.
#include <pkg/bonded/kernel/BondStrength.hpp>

#include <gtest/gtest.h>

namespace {

using namespace yade::ddem;
using Vector = SpaceVector<double>;

const Vector zero { 0, 0, 0 };

const BondSection section { 1e-3 };

BondStress stress(const Vector& force, const Vector& moment) { return bondStress(section, { force, moment }); }

TEST(BondStress, ofEachLoadAlone) // |Mb| R/I = 4 |Mb|/(πR³), |Mt| R/J = 2 |Mt|/(πR³)
{
	const double area = M_PI * 1e-6, cube = M_PI * 1e-9;
	EXPECT_DOUBLE_EQ(stress({ -5, 0, 0 }, zero).normal, -5 / area);
	EXPECT_DOUBLE_EQ(stress({ 0, 3, 4 }, zero).shear, 5 / area);
	EXPECT_DOUBLE_EQ(stress(zero, { 0, -3e-3, 4e-3 }).normal, 4 * 5e-3 / cube);
	EXPECT_DOUBLE_EQ(stress(zero, { -5e-3, 0, 0 }).shear, 2 * 5e-3 / cube);
}

TEST(BondStress, bendingAddsTensionEvenUnderCompression)
{
	const BondStress s = stress({ -5, 0, 0 }, { 0, 1e-3, 0 });
	EXPECT_DOUBLE_EQ(s.normal, stress({ -5, 0, 0 }, zero).normal + stress(zero, { 0, 1e-3, 0 }).normal);
	EXPECT_EQ(s.shear, 0);
}

TEST(MohrCoulomb, breaksJustBeyondItsEnvelope)
{
	const MohrCoulomb strength { 100e6, 0.5 };
	for (double normal = -300e6; normal < 199e6; normal += 7e6) {
		const double limit = 100e6 - 0.5 * normal;
		EXPECT_EQ(bondFailure(strength, { normal, limit * (1 - 1e-9) }), BondFailure::None) << normal;
		EXPECT_NE(bondFailure(strength, { normal, limit * (1 + 1e-9) }), BondFailure::None) << normal;
	}
}

TEST(MohrCoulomb, breaksInTensionAtTheApex)
{
	const MohrCoulomb strength { 100e6, 0.5 };
	EXPECT_DOUBLE_EQ(strength.tensionLimit(), 200e6);
	EXPECT_EQ(bondFailure(strength, { 200e6 * (1 - 1e-12), 0 }), BondFailure::None);
	EXPECT_EQ(bondFailure(strength, { 200e6 * (1 + 1e-12), 0 }), BondFailure::Tension);
}

TEST(MohrCoulomb, hasNoLimitInCompression) { EXPECT_EQ(bondFailure({ 1e6, 1 }, { -1e15, 0 }), BondFailure::None); }

TEST(MohrCoulomb, cutOffLiesBelowTheApex)
{
	const MohrCoulomb strength { 100e6, 0.5, 30e6 };
	EXPECT_EQ(bondFailure(strength, { 29e6, 80e6 }), BondFailure::None);
	EXPECT_EQ(bondFailure(strength, { 31e6, 0 }), BondFailure::Tension);
	EXPECT_EQ(bondFailure(strength, { 29e6, 90e6 }), BondFailure::Shear);
}

TEST(MohrCoulomb, namesTheLargerShare)
{
	const MohrCoulomb strength { 100e6, 1 };
	EXPECT_EQ(bondFailure(strength, { 60e6, 41e6 }), BondFailure::Tension);
	EXPECT_EQ(bondFailure(strength, { 40e6, 61e6 }), BondFailure::Shear);
	EXPECT_EQ(bondFailure(strength, { -40e6, 141e6 }), BondFailure::Shear);
}

TEST(MohrCoulomb, withoutFrictionIsTresca)
{
	EXPECT_EQ(bondFailure({ 100e6, 0 }, { 1e12, 99e6 }), BondFailure::None);
	EXPECT_EQ(bondFailure({ 100e6, 0 }, { -1e12, 101e6 }), BondFailure::Shear);
}

} // namespace
