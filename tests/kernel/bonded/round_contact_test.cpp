// GPL v2 or later, see LICENSE.
// Spheres on rollers and in jaws, by plane geometry.
#include <pkg/bonded/kernel/RoundContact.hpp>

#include <gtest/gtest.h>

namespace yade::ddem {
namespace {

	constexpr double R = 0.02, r = 0.003;

	TEST(RoundContact, RollerTouchesAtTheSumOfTheRadii)
	{
		const RoundSurface roller { R, 0.1, false, 0.5 };
		for (const double angle : { 0., 0.7, 2.5, -2. }) {
			const double d = R + r - 1e-5;
			const auto   touch = touchOf(roller, { d * std::sin(angle), d * std::cos(angle), 0.01 }, r);
			EXPECT_TRUE(touch.there);
			EXPECT_NEAR(touch.depth, 1e-5, 1e-15);
			EXPECT_NEAR(touch.normal.x, std::sin(angle), 1e-15);
			EXPECT_NEAR(touch.normal.y, std::cos(angle), 1e-15);
			EXPECT_EQ(touch.normal.z, 0);
		}
		EXPECT_LT(touchOf(roller, { 0, R + r + 1e-6, 0 }, r).depth, 0);
	}

	TEST(RoundContact, JawTouchesAtTheDifferenceOfTheRadiiAndPushesInwards)
	{
		const RoundSurface jaw { R, 0.1, true, 0.5 };
		const double       d = R - r + 1e-5;
		const auto         touch = touchOf(jaw, { d * std::sin(0.4), d * std::cos(0.4), 0 }, r);
		EXPECT_TRUE(touch.there);
		EXPECT_NEAR(touch.depth, 1e-5, 1e-15);
		EXPECT_NEAR(touch.normal.x, -std::sin(0.4), 1e-15);
		EXPECT_NEAR(touch.normal.y, -std::cos(0.4), 1e-15);
	}

	TEST(RoundContact, NothingTouchesBeyondEndsAndEdges)
	{
		const RoundSurface jaw { R, 0.1, true, 0.5 }, roller { R, 0.1, false, 0.5 };
		EXPECT_FALSE(touchOf(jaw, { 0.018 * std::sin(0.51), 0.018 * std::cos(0.51), 0 }, r).there);
		EXPECT_TRUE(touchOf(jaw, { 0.018 * std::sin(-0.49), 0.018 * std::cos(0.49), 0 }, r).there);
		EXPECT_FALSE(touchOf(jaw, { 0, -0.018, 0 }, r).there);
		EXPECT_FALSE(touchOf(roller, { 0, 0.02, 0.051 }, r).there);
		EXPECT_TRUE(touchOf(roller, { 0, 0.02, 0.049 }, r).there);
		EXPECT_FALSE(touchOf(roller, { 0, 0, 0 }, r).there);
	}

} // namespace
} // namespace yade::ddem
