// GPL v2 or later, see LICENSE.
// The search finds every pair that touches in the step in which it does, however seldom it looks.
#include <pkg/bonded/kernel/SphereMotion.hpp>
#include <pkg/bonded/kernel/SpherePairs.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace {

using namespace yade::ddem;

TEST(SpherePairs, findsWhatAlwaysLookingFinds)
{
	std::mt19937_64                        engine(7);
	std::uniform_real_distribution<double> unit(-1, 1);
	constexpr std::int32_t                 count = 60;
	constexpr double                       reach = 0.1;
	std::vector<double>                    pose(sphereRow * count), speed(3 * count);
	for (std::int32_t p = 0; p < count; p++)
		for (int c = 0; c < 3; c++) {
			pose[std::size_t(sphereRow * p + c)] = unit(engine);
			// most are slow, so that most groups are left alone for long
			speed[std::size_t(3 * p + c)] = (p % 20 ? 0.01 : 1) * unit(engine);
		}
	SpherePairs search;
	for (std::int32_t i = 0; i < count; i++)
		for (std::int32_t j = i + 1; j < count; j++)
			search.add(i, j, reach);
	const auto distance = [&](std::size_t k) {
		const double *a = &pose[std::size_t(sphereRow * search.firstOf(k))],
		             *b = &pose[std::size_t(sphereRow * search.secondOf(k))];
		return std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
	};
	std::vector<std::int32_t> found;
	std::size_t               total = 0;
	double                    moved = 0;
	for (int step = 0; step < 2000; step++) {
		std::vector<std::int32_t> expected;
		for (std::size_t k = 0; k < search.size(); k++)
			if (distance(k) < reach) expected.push_back(std::int32_t(k));
		search.find(pose.data(), moved, found);
		ASSERT_EQ(found, expected) << "step " << step;
		total += found.size();
		moved = 0;
		for (std::size_t p = 0; p < std::size_t(count); p++) {
			double square = 0;
			for (std::size_t c = 0; c < 3; c++) {
				double& x = pose[std::size_t(sphereRow) * p + c];
				double& v = speed[3 * p + c];
				if (std::abs(x) > 1) v = x > 0 ? -std::abs(v) : std::abs(v); // stays in a box
				x += 1e-2 * v;
				square += 1e-4 * v * v;
			}
			moved = std::max(moved, std::sqrt(square));
		}
	}
	EXPECT_GT(total, 100u);
}

TEST(SpherePairs, leavesOutWhatOthersFollow)
{
	const std::vector<double> pose { 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0 };
	SpherePairs               search;
	search.add(0, 1, 1.5);
	std::vector<std::int32_t> found;
	search.find(pose.data(), 0, found);
	EXPECT_EQ(found, std::vector<std::int32_t> { 0 });
	search.follow(0, true);
	search.find(pose.data(), 0, found);
	EXPECT_TRUE(found.empty());
	search.follow(0, false);
	search.find(pose.data(), 0, found);
	EXPECT_EQ(found, std::vector<std::int32_t> { 0 });
}

TEST(SpherePairs, looksAtAllAfterAnUnknownWay)
{
	std::vector<double> pose { 0, 0, 0, 0, 1, 0, 0, 0, 3, 0, 0, 0, 1, 0, 0, 0 };
	SpherePairs         search;
	search.add(0, 1, 1.5);
	std::vector<std::int32_t> found;
	search.find(pose.data(), 0, found);
	EXPECT_TRUE(found.empty());
	pose[8] = 1;
	search.find(pose.data(), std::numeric_limits<double>::infinity(), found);
	EXPECT_EQ(found, std::vector<std::int32_t> { 0 });
	pose[8] = 3;
	search.find(pose.data(), 0, found);
	EXPECT_TRUE(found.empty());
	pose[8] = 1;
	search.find(pose.data(), 1, found); // after infinity a way counts no more, so it must look always
	EXPECT_EQ(found, std::vector<std::int32_t> { 0 });
}

} // namespace
