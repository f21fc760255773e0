// GPL v2 or later, see LICENSE.
// Stresses of a bond's cross-section under each load.
#include <pkg/bonded/kernel/BondStress.hpp>

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

TEST(BondStress, takesTheShareOfMoments) // that is asked for
{
	const BondResultants load { { -5, 3, 4 }, { 2e-3, -3e-3, 4e-3 } };
	const BondStress all = bondStress(section, load), none = bondStress(section, load, 0.),
	                 half = bondStress(section, load, 0.5);
	EXPECT_DOUBLE_EQ(none.normal, -5 / section.area);
	EXPECT_DOUBLE_EQ(none.shear, 5 / section.area);
	EXPECT_DOUBLE_EQ(half.normal, 0.5 * (all.normal + none.normal));
	EXPECT_DOUBLE_EQ(half.shear, 0.5 * (all.shear + none.shear));
}

} // namespace
