// GPL v2 or later, see LICENSE.
// Tangent spheres against exact configurations and against what tangency means.
#include <pkg/bonded/kernel/packing/TangentSphere.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace {

using namespace yade::ddem;

Touched sphere(double x, double y, double z, double r) { return { { x, y, z }, r, false }; }
Touched plane(double x, double y, double z, double offset) { return { { x, y, z }, offset, true }; }

template <int dimension>
std::vector<PackedSphere> solve(const std::array<Touched, std::size_t(dimension) + 1>& things)
{
	std::array<PackedSphere, 2> found;
	const int                   count = tangentSpheres<dimension>(things, found);
	return { found.begin(), found.begin() + count };
}

/// The solution with a positive radius that touches everything, which must be the only one.
template <int dimension> PackedSphere only(const std::array<Touched, std::size_t(dimension) + 1>& things)
{
	std::vector<PackedSphere> real;
	for (const PackedSphere& s : solve<dimension>(things)) {
		bool touches = s.radius > 0;
		for (const Touched& thing : things)
			touches = touches && std::abs(thing.distance(s.centre) - s.radius) < 1e-9;
		if (touches) real.push_back(s);
	}
	EXPECT_EQ(real.size(), 1u);
	return real.empty() ? PackedSphere { { NAN, NAN, NAN }, NAN } : real[0];
}

TEST(TangentSphere, isThatOfDescartesTheorem)
{
	// Three mutually tangent circles of curvatures k: k4 = k1 + k2 + k3 + 2 sqrt(k1 k2 + k2 k3 + k3 k1)
	// (Descartes 1643).
	const double a = 1, b = 2, c = 3; // radii; the centres form a triangle with sides 3, 5, 4
	const auto   s = only<2>({ sphere(0, 0, 0, a), sphere(3, 0, 0, b), sphere(0, 4, 0, c) });
	EXPECT_NEAR(
	        1 / s.radius, 1 / a + 1 / b + 1 / c + 2 * std::sqrt(1 / (a * b) + 1 / (b * c) + 1 / (c * a)), 1e-13);
	EXPECT_EQ(s.centre.z, 0);
}

TEST(TangentSphere, isThatOfSoddysTheorem)
{
	// Five mutually tangent spheres in space: (sum k)² = 3 sum k² (Soddy 1936), four of them here of radius 1.
	const double h = 1 / std::sqrt(2.); // edges of 2 between alternate corners of a cube
	const auto   s
	        = only<3>({ sphere(h, h, h, 1), sphere(h, -h, -h, 1), sphere(-h, h, -h, 1), sphere(-h, -h, h, 1) });
	const double k = 1 / s.radius;
	EXPECT_NEAR((4 + k) * (4 + k), 3 * (4 + k * k), 1e-12 * k * k);
	EXPECT_NEAR(s.radius, std::sqrt(1.5) - 1, 1e-15);
	EXPECT_NEAR(norm(s.centre), 0, 1e-15);
}

TEST(TangentSphere, liesInTheMiddleOfEqualCirclesAtTheCornersOfASquare)
{
	// Coplanar centres and equal radii: nothing but the height is left to the equations' line.
	// radii of four spheres on the floor of a square of side 1, below a sphere of the same floor
	const double b = 0.3;
	const auto   s = only<3>({ sphere(0, 0, b, b), sphere(1, 0, b, b), sphere(0, 1, b, b), plane(0, 0, 1, 0) });
	// (r + b)² = 1/2 + (r - b)²
	EXPECT_NEAR(s.radius, 0.125 / b, 1e-14);
	EXPECT_NEAR(s.centre.x, 0.5, 1e-14);
	EXPECT_NEAR(s.centre.y, 0.5, 1e-14);
}

TEST(TangentSphere, touchesWallsAlone)
{
	// The ball in the corner of three planes below x + y + z = 1:
	// distances from all are equal at r (3 + sqrt 3) = 1.
	const double n = -1 / std::sqrt(3.);
	const auto   s = only<3>(
                { plane(1, 0, 0, 0), plane(0, 1, 0, 0), plane(0, 0, 1, 0), plane(n, n, n, n) });
	EXPECT_NEAR(s.radius, 1 / (3 + std::sqrt(3.)), 1e-15);
}

TEST(TangentSphere, touchesAHollowBallFromInside)
{
	// Two half as large circles in a circle, and the next of Pappus' chain: curvatures -1, 2, 2, 3.
	const auto s = solve<2>({ sphere(0, 0, 0, -1), sphere(0.5, 0, 0, 0.5), sphere(-0.5, 0, 0, 0.5) });
	ASSERT_EQ(s.size(), 2u);
	for (const PackedSphere& one : s) {
		EXPECT_NEAR(one.radius, 1. / 3, 1e-14);
		EXPECT_NEAR(std::abs(one.centre.y), 2. / 3, 1e-14);
	}
}

TEST(TangentSphere, thereIsNoneWhereAllIsInOneRow)
{
	EXPECT_TRUE(solve<2>({ sphere(0, 0, 0, 1), sphere(2, 0, 0, 1), sphere(4, 0, 0, 1) }).empty());
	EXPECT_TRUE(solve<3>({ plane(1, 0, 0, 0), plane(1, 0, 0, 0.1), plane(0, 1, 0, 0), plane(0, 0, 1, 0) }).empty());
}

TEST(TangentSphere, isFoundAgainAmongThingsPutAroundIt)
{
	std::mt19937_64 random(3);
	const auto draw = [&](double from, double to) { return from + (to - from) * double(random() >> 11) * 0x1p-53; };
	for (int trial = 0; trial < 2000; trial++) {
		const PackedSphere hidden { { draw(-1, 1), draw(-1, 1), draw(-1, 1) }, draw(0.1, 1) };
		std::array<Touched, 4> things;
		for (std::size_t i = 0; i < 4; i++) {
			SpaceVector<double> way { draw(-1, 1), draw(-1, 1), draw(-1, 1) };
			way = 1 / norm(way) * way;
			const double size = draw(0.05, 2);
			if (i + trial % 5 >= 4)
				things[i] = plane(way.x, way.y, way.z, dot(way, hidden.centre) - hidden.radius);
			else
				things[i] = { hidden.centre + (hidden.radius + size) * way, size, false };
		}
		double closest = 1;
		for (const PackedSphere& s : solve<3>(things))
			closest = std::min(
			        closest, norm(s.centre - hidden.centre) + std::abs(s.radius - hidden.radius));
		EXPECT_LT(closest, 1e-6) << "trial " << trial; // random directions may nearly depend on each other
	}
}

} // namespace
