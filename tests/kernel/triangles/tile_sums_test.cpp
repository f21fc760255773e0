// GPL v2 or later, see LICENSE.
// Sums over tiles: a fixed tree that any division into domains can follow.
#include "../TriangleSamples.hpp"

#include <pkg/ddem/kernel/triangles/TileSums.hpp>

#include <gtest/gtest.h>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::samples;

std::vector<double> numbers(std::size_t count)
{
	Random              random(61);
	std::vector<double> list;
	for (std::size_t i = 0; i < count; i++)
		list.push_back(random.uniform(-1, 1) * std::pow(10, random.uniform(-8, 8)));
	return list;
}

TEST(TileSums, addsNeighboursInPairs)
{
	EXPECT_EQ(treeSum(std::vector<double> {}), 0);
	EXPECT_EQ(treeSum(std::vector<double> { 5 }), 5);
	const auto n = numbers(5);
	EXPECT_EQ(treeSum(n), ((n[0] + n[1]) + (n[2] + n[3])) + n[4]);
	EXPECT_NE(treeSum(numbers(1001)), [] { // the order matters to the last digits, or this test could not fail
		double sum = 0;
		for (const double x : numbers(1001))
			sum += x;
		return sum;
	}());
}

/// What a domain that owns the tiles [begin, end) of all hands over: sums of its largest complete subtrees,
/// each by its level and place.
struct Subtree {
	std::size_t level, place;
	double      sum;
};
void handOver(const std::vector<double>& all, std::size_t begin, std::size_t end, std::vector<Subtree>& to)
{
	while (begin < end) {
		std::size_t level = 0;
		while (begin % (std::size_t(2) << level) == 0 && begin + (std::size_t(2) << level) <= end)
			level++;
		const std::size_t size = std::size_t(1) << level;
		to.push_back(
		        { level, begin >> level,
		          treeSum(std::vector<double>(
		                  all.begin() + std::ptrdiff_t(begin), all.begin() + std::ptrdiff_t(begin + size))) });
		begin += size;
	}
}

TEST(TileSums, domainsJoinTheirSubtreesToTheSameBits)
{
	for (const std::size_t count : { 1u, 2u, 3u, 7u, 64u, 100u, 257u }) {
		const auto all = numbers(count);
		Random     random(62);
		for (int division = 0; division < 20; division++) {
			std::vector<Subtree> parts;
			for (std::size_t begin = 0; begin < count;) {
				const std::size_t end = std::min(
				        count, begin + 1 + std::size_t(random.uniform(0, double(count) / 3)));
				handOver(all, begin, end, parts);
				begin = end;
			}
			// join level by level, as the tree does: a part waits until its level comes
			std::vector<double> now(count);
			std::vector<char>   there(count, 0);
			std::size_t         width = count;
			for (std::size_t level = 0;; level++) {
				for (const Subtree& part : parts)
					if (part.level == level) {
						now[part.place]   = part.sum;
						there[part.place] = 1;
					}
				if (width == 1) break;
				for (std::size_t i = 0; i < (width + 1) / 2; i++) {
					const bool left = there[2 * i], right = 2 * i + 1 < width && there[2 * i + 1];
					const double sum = right ? now[2 * i] + now[2 * i + 1] : now[2 * i];
					now[i]   = sum;
					// a pair of which nothing is there yet is a part of a higher level
					there[i] = left;
				}
				for (std::size_t i = (width + 1) / 2; i < width; i++)
					there[i] = 0;
				width = (width + 1) / 2;
			}
			EXPECT_EQ(now[0], treeSum(all)) << count << " tiles, division " << division;
		}
	}
}

TEST(TileSums, energiesHaveTheSameBitsForAnyNumberOfThreadsAndAnyCutOfAGroupAtTiles)
{
	const Mesh     mesh  = rectangle(40, 33, 0.40, 0.33, 0.25, 10); // 2640 triangles
	TriangleSystem whole = makeSystem(mesh, Material(), RotationTreatment::Cosserat);
	agitate(whole, 5, 500, 63);
	TriangleSystem cut = whole;
	setGroups<Elastic>(cut, Material(), ElasticParameters(), 0, { 256, 1024, 2640 }); // tiles stay what they are
	for (int i = 0; i < 10; i++) {
		const StepEnergy a = whole.step(stepOf(1e-7, true)), b = cut.step(stepOf(1e-7, true));
		EXPECT_EQ(a.kinetic, b.kinetic);
		EXPECT_EQ(a.elastic, b.elastic);
		EXPECT_EQ(a.rotation, b.rotation);
	}
}

} // namespace
