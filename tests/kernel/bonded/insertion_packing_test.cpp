// GPL v2 or later, see LICENSE.
// Packings by insertion: what touches what, and the same bits everywhere.
#include <pkg/bonded/kernel/packing/InsertionPacking.hpp>
#include <pkg/bonded/kernel/packing/SphereGrid.hpp>

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>
#include <vector>

namespace {

using namespace yade::ddem;

constexpr double largest = 1, smallest = 0.3, tolerance = 1e-10;

Specimen cylinder(const SpaceVector<double>& axis)
{
	return { 3,
		 { -4, -4, -4 },
		 { 4, 4, 4 },
		 { { WallKind::Cylinder, { 0, 0, 0 }, 2, axis },
		   { WallKind::Plane, axis, -3 },
		   { WallKind::Plane, -axis, -3 } } };
}

std::vector<Specimen> specimens()
{
	const double n = -1 / std::sqrt(3.);
	return { cylinder({ 0, 1, 0 }),
		 cylinder({ 0.6, 0, 0.8 }),
		 { 3, { -3, -3, -3 }, { 3, 3, 3 }, { { WallKind::Ball, { 0, 0, 0 }, 3 } } },
		 { 3, // a tetrahedron
		   { 0, 0, 0 },
		   { 8, 8, 8 },
		   { { WallKind::Plane, { 1, 0, 0 }, 0 },
		     { WallKind::Plane, { 0, 1, 0 }, 0 },
		     { WallKind::Plane, { 0, 0, 1 }, 0 },
		     { WallKind::Plane, { n, n, n }, 8 * n } } },
		 { 2, { -6, -6, 0 }, { 6, 6, 0 }, { { WallKind::Ball, { 0, 0, 0 }, 6 } } },
		 { 2,
		   { 0, 0, 0 },
		   { 8, 6, 0 },
		   { { WallKind::Plane, { 1, 0, 0 }, 0 },
		     { WallKind::Plane, { 0, 1, 0 }, 0 },
		     { WallKind::Plane, { -0.6, -0.8, 0 }, -4.8 } } } };
}

double gap(const PackedSphere& a, const PackedSphere& b) { return norm(a.centre - b.centre) - a.radius - b.radius; }

TEST(InsertionPacking, spheresAreInsideAndClearOfEachOtherAndTouchEnough)
{
	for (const Specimen& specimen : specimens()) {
		const auto packing = fillSpecimen(specimen, { smallest, largest, 5, 2000 });
		const auto& all    = packing.spheres;
		ASSERT_GT(all.size(), packing.seeds + 10);
		for (std::size_t i = 0; i < all.size(); i++) {
			int touched = 0;
			for (const SpecimenWall& wall : specimen.walls) {
				const double apart = wall.distance(all[i].centre) - all[i].radius;
				EXPECT_GE(apart, -1.01 * tolerance);
				touched += apart <= 1.01 * tolerance;
			}
			for (std::size_t j = 0; j < i; j++) {
				EXPECT_GE(gap(all[i], all[j]), -1.01 * tolerance);
				touched += gap(all[i], all[j]) <= 1.01 * tolerance;
			}
			EXPECT_TRUE(all[i].radius >= smallest && all[i].radius <= largest);
			EXPECT_TRUE(i < packing.seeds || touched > specimen.dimension) << "sphere " << i;
			EXPECT_TRUE(specimen.dimension == 3 || all[i].centre.z == 0);
		}
	}
}

TEST(InsertionPacking, stopsWhereItsTickThrows)
{
	PackingOrder order { smallest, largest, 1, 1000 };
	order.tick = [] { throw std::runtime_error("stop"); };
	EXPECT_THROW(fillSpecimen(specimens()[0], order), std::runtime_error);
}

TEST(SphereGrid, findsWhatLookingAtAllFinds)
{
	std::mt19937_64 random(11);
	const auto draw = [&](double from, double to) { return from + (to - from) * double(random() >> 11) * 0x1p-53; };
	const auto      point = [&] { return SpaceVector<double> { draw(0, 10), draw(0, 5), draw(0, 10) }; };
	SphereGrid      grid(3, { 0, 0, 0 }, { 10, 5, 10 }, 0.05, 1);
	for (int i = 0; i < 500; i++)
		grid.add({ point(), std::pow(20, -draw(0, 1)) }); // five octaves
	for (int trial = 0; trial < 500; trial++) {
		const PackedSphere probe { point(), std::pow(20, -draw(0, 1)) };
		ClosestThings      expected(4), found(4);
		bool               overlaps = false;
		for (std::size_t i = 0; i < grid.spheres().size(); i++) {
			const PackedSphere& sphere = grid.spheres()[i];
			expected.offer(norm(probe.centre - sphere.centre) - sphere.radius, std::int32_t(i));
			overlaps = overlaps || gap(probe, sphere) < -0.01;
		}
		EXPECT_EQ(grid.overlaps(probe, 0.01), overlaps);
		grid.offerAround(probe.centre, 1.01 * std::abs(expected.limit()) + 0.01, found);
		for (std::size_t k = 0; k < 4; k++)
			EXPECT_EQ(found[k], expected[k]);
	}
}

} // namespace
