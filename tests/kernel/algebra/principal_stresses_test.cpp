// GPL v2 or later, see LICENSE.
// Principal stresses against an eigen-solver; smooth sharing where they coincide.
#include "../ConcreteSamples.hpp"

#include <gtest/gtest.h>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::test;

constexpr double tolerance = 0.05;

PrincipalStresses<double> principal(const PlaneTensor& stress) { return principalStresses(stress, tolerance); }

double distance(const PrincipalStresses<double>& a, const PrincipalStresses<double>& b)
{
	return norm(a.n1 - b.n1) + norm(a.n3 - b.n3);
}

bool distinct(const PrincipalStresses<double>& p)
{
	const double band = tolerance * std::max(std::abs(p.s1), std::abs(p.s3));
	return p.s1 - p.s2 > band && p.s2 - p.s3 > band;
}

TEST(PrincipalStresses, agreeWithEigenSolver)
{
	Random random(2);
	int    compared = 0;
	for (int i = 0; i < 2000; ++i) {
		const PlaneTensor                              stress = random.tensor(50e6);
		const PrincipalStresses<double>                p      = principal(stress);
		Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrixOf(stress));
		EXPECT_NEAR(p.s1, solver.eigenvalues()[2], 1e-7);
		EXPECT_NEAR(p.s2, solver.eigenvalues()[1], 1e-7);
		EXPECT_NEAR(p.s3, solver.eigenvalues()[0], 1e-7);
		if (!distinct(p)) continue;
		++compared;
		const Eigen::Vector3d v1 = solver.eigenvectors().col(2), v3 = solver.eigenvectors().col(0);
		EXPECT_LT((matrixOf(p.n1) - v1 * v1.transpose()).norm(), 1e-12);
		EXPECT_LT((matrixOf(p.n3) - v3 * v3.transpose()).norm(), 1e-12);
	}
	EXPECT_GT(compared, 1500);
}

TEST(PrincipalStresses, eigentensorsHaveUnitTraceAndGiveTheirStress)
{
	Random random(3);
	for (int i = 0; i < 2000; ++i) {
		PlaneTensor stress = random.tensor(50e6);
		if (i % 4 == 0) stress.zz = stress.xx; // some that share
		const PrincipalStresses<double> p    = principal(stress);
		const double                    band = tolerance * std::max(std::abs(p.s1), std::abs(p.s3));
		EXPECT_NEAR(trace(p.n1), 1, 1e-14);
		EXPECT_NEAR(trace(p.n3), 1, 1e-14);
		EXPECT_NEAR(doubleDot(p.n1, stress), p.s1, band);
		EXPECT_NEAR(doubleDot(p.n3, stress), p.s3, band);
	}
}

TEST(PrincipalStresses, sharedEquallyWhereTwoCoincide)
{
	const PrincipalStresses<double> column = principal({ 0, -30e6, 0, 0 }); // σ1 = σ2 = 0: N1 is half x, half z
	EXPECT_LT(norm(column.n1 - PlaneTensor { 0.5, 0, 0.5, 0 }), 1e-15);
	EXPECT_LT(norm(column.n3 - PlaneTensor { 0, 1, 0, 0 }), 1e-15);
	// σ2 = σ3 in the plane, where the axes are arbitrary
	const PrincipalStresses<double> disc = principal({ -30e6, -30e6, 4e6, 0 });
	EXPECT_LT(norm(disc.n3 - PlaneTensor { 0.5, 0.5, 0, 0 }), 1e-15);
	for (const double p : { -7e6, 0., 7e6 }) {
		const PrincipalStresses<double> all = principal({ p, p, p, 0 });
		EXPECT_LT(norm(all.n1 - PlaneTensor { 1. / 3, 1. / 3, 1. / 3, 0 }), 1e-15);
		EXPECT_LT(norm(all.n3 - PlaneTensor { 1. / 3, 1. / 3, 1. / 3, 0 }), 1e-15);
	}
}

// the eigentensors' change is proportional to the step, also across coincidences
TEST(PrincipalStresses, handOverIsSmoothInTheStress)
{
	const PlaneTensor starts[] = { { 0, -30e6, 1e6, 0 }, { -30e6, -31e6, 4e6, -1e6 }, { 10e6, 11e6, 9e6, 0.5e6 } };
	const PlaneTensor ends[]   = { { 1e6, -30e6, 0, 0 }, { -31e6, -30e6, 4e6, 1e6 }, { 11e6, 9e6, 10e6, -0.5e6 } };
	for (int path = 0; path < 3; ++path)
		for (const int steps : { 1000, 10000 }) {
			double largest = 0, largestBend = 0;
			auto   before = principal(starts[path]), current = before;
			for (int i = 0; i <= steps; ++i) {
				const auto next
				        = principal(starts[path] + (double(i) / steps) * (ends[path] - starts[path]));
				largest         = std::max(largest, distance(next, current));
				if (i > 1)
					largestBend = std::max(
					        largestBend,
					        norm(next.n1 - 2. * current.n1 + before.n1)
					                + norm(next.n3 - 2. * current.n3 + before.n3));
				before  = current;
				current = next;
			}
			EXPECT_LT(largest * steps, 10) << "path " << path; // bounded slope: continuous
			// bounded curvature: slope continuous
			EXPECT_LT(largestBend * steps * steps, 1000) << "path " << path;
		}
}

TEST(PrincipalStresses, turnWithTheAxes)
{
	Random random(4);
	for (int i = 0; i < 500; ++i) {
		const PlaneTensor stress = random.tensor(20e6);
		const double      angle  = random.number(-3, 3);
		const auto        here = principal(stress), there = principal(turned(stress, angle));
		EXPECT_LT(norm(turned(here.n1, angle) - there.n1), 1e-10);
		EXPECT_LT(norm(turned(here.n3, angle) - there.n3), 1e-10);
	}
}

TEST(PrincipalStresses, directionDoesNotDependOnTheSizeOfTheStress)
{
	const PlaneTensor stress { 3, -1, 2.95, 0.4 };
	for (const double scale : { 1e-100, 1e-6, 1e9 })
		EXPECT_LT(distance(principal(scale * stress), principal(stress)), 1e-12);
}

} // namespace
