// GPL v2 or later, see LICENSE.
// The bound on the time step against eigenvalues of whole systems.
#include "bond_samples.hpp"

#include <pkg/bonded/kernel/BondStableStep.hpp>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <random>

namespace {

using namespace bond_samples;
using Matrix = Eigen::MatrixXd;

PairSpring bondSpring(int first, int second, const BondStiffness& k, double length)
{
	return { first, second, k.normal, k.shear, k.bending, k.torsion, length / 2, length / 2 };
}

TEST(StableStep, isExactForTwoParticles)
{
	const double        r = 1e-3, mass = 1e-5, inertia = 0.4 * mass * r * r;
	const BondStiffness k = bondStiffness({ 100e9, 0.25 }, BondSection(r), 2 * r);
	// equal spheres: shear against both rotations, ks (2/m + 2 (d0/2)²/I), is the highest of axial, torsion,
	// bending and shear frequencies
	const double highest = k.shear * 2 * (1 / mass + r * r / inertia);
	ASSERT_GT(highest, k.normal * 2 / mass);
	ASSERT_GT(highest, k.bending * 2 / inertia);
	EXPECT_NEAR(
	        stableStep({ { mass, inertia }, { mass, inertia } }, { bondSpring(0, 1, k, 2 * r) }),
	        2 / std::sqrt(highest), 1e-12 * 2 / std::sqrt(highest));
}

TEST(StableStep, isExactForASpringToAWall)
{
	EXPECT_NEAR(stableStep({ { 2., 1. } }, { { 0, -1, 50., 0, 0, 0, 0, 0 } }), 2 / std::sqrt(25.), 1e-14);
	EXPECT_EQ(stableStep({ { 2., 1. } }, {}), std::numeric_limits<double>::infinity());
}

/// Stiffness of all bonds by differences of their loads: 6 unknowns a particle.
Matrix assembledStiffness(
        const std::vector<Eigen::Vector3d>& centres, const std::vector<std::pair<int, int>>& pairs,
        const std::vector<Bond>& bonds, double size)
{
	const double step   = 1e-7;
	const auto   n      = static_cast<Eigen::Index>(6 * centres.size());
	Matrix       result = Matrix::Zero(n, n);
	for (std::size_t b = 0; b < pairs.size(); b++)
		for (int side = 0; side < 2; side++)
			for (int unknown = 0; unknown < 6; unknown++) {
				Eigen::VectorXd loads[2];
				for (int sign = 0; sign < 2; sign++) {
					Vector x[2] = { centres[static_cast<std::size_t>(pairs[b].first)],
						        centres[static_cast<std::size_t>(pairs[b].second)] };
					Quaternion   q[2]  = { Quaternion::Identity(), Quaternion::Identity() };
					const double delta = sign ? step : -step;
					if (unknown < 3) x[side][unknown] += delta * size;
					else
						q[side] = Quaternion(
						        Eigen::AngleAxisd(delta, Vector::Unit(unknown - 3)));
					const Loads l = loadsOf(bonds[b], x[1] - x[0], q[0], q[1]);
					loads[sign].resize(12);
					loads[sign] << l.force, l.moment1, -l.force, l.moment2;
				}
				const Eigen::VectorXd column
				        = (loads[0] - loads[1]) / (2 * step * (unknown < 3 ? size : 1));
				const int             place  = 6 * (side ? pairs[b].second : pairs[b].first) + unknown;
				result.col(place).segment<6>(6 * pairs[b].first) += column.head<6>();
				result.col(place).segment<6>(6 * pairs[b].second) += column.tail<6>();
			}
	return result;
}

TEST(StableStep, boundsWholePackingsClosely)
{
	std::mt19937_64                        engine { 11 };
	std::uniform_real_distribution<double> unit { 0, 1 };
	for (int trial = 0; trial < 10; trial++) {
		std::vector<Eigen::Vector3d>     centres;
		std::vector<double>              radii;
		std::vector<ParticleMass>        masses;
		std::vector<std::pair<int, int>> pairs;
		std::vector<Bond>                bonds;
		std::vector<PairSpring>          springs;
		for (int i = 0; i < 12; i++) {
			const double r = 0.5e-3 + 1.5e-3 * unit(engine), m = 2600 * 4. / 3 * M_PI * r * r * r;
			centres.push_back(5e-3 * Eigen::Vector3d(unit(engine), unit(engine), unit(engine)));
			radii.push_back(r);
			masses.push_back({ m, 0.4 * m * r * r });
		}
		for (int i = 0; i < 12; i++)
			for (int j = i + 1; j < 12; j++) {
				const Eigen::Vector3d branch
				        = centres[static_cast<std::size_t>(j)] - centres[static_cast<std::size_t>(i)];
				if (branch.norm() > 3e-3) continue;
				const BondStiffness k
				        = bondStiffness({ 100e9, 0.25 }, BondSection(branch.norm() / 2), branch.norm());
				pairs.emplace_back(i, j);
				bonds.push_back(join(k, branch, Quaternion::Identity(), Quaternion::Identity()));
				springs.push_back(bondSpring(i, j, k, branch.norm()));
			}
		Matrix          stiffness = assembledStiffness(centres, pairs, bonds, 1e-3);
		Eigen::VectorXd root(stiffness.rows());
		for (std::size_t i = 0; i < masses.size(); i++)
			root.segment<6>(static_cast<Eigen::Index>(6 * i))
			        << Vector::Constant(std::sqrt(masses[i].mass)),
			        Vector::Constant(std::sqrt(masses[i].inertia));
		EXPECT_LT((stiffness - stiffness.transpose()).norm(), 1e-6 * stiffness.norm());
		stiffness            = root.cwiseInverse().asDiagonal() * stiffness * root.cwiseInverse().asDiagonal();
		const double highest = Eigen::SelfAdjointEigenSolver<Matrix>(0.5 * (stiffness + stiffness.transpose()))
		                               .eigenvalues()
		                               .maxCoeff();
		const double exact = 2 / std::sqrt(highest), bound = stableStep(masses, springs);
		EXPECT_LE(bound, exact * (1 + 1e-6));
		EXPECT_GE(bound, 0.8 * exact);
	}
}

TEST(DampedStableStep, isSharpForAnOscillatorWithLaggingDamping) // v' = v - h (ω² x + λ v), x' = x + h v'
{
	const double omega = 3;
	for (const double rate : { 0.1, 1., 10. }) {
		const double limit  = dampedStableStep(2 / omega, 2 / std::sqrt(rate));
		const auto   growth = [&](double h) {
                        double x = 1, v = 0;
                        for (int i = 0; i < 4000; i++) {
                                v -= h * (omega * omega * x + rate * v);
                                x += h * v;
                        }
                        return std::abs(x);
		};
		EXPECT_LT(growth(0.99 * limit), 1) << rate;
		EXPECT_FALSE(growth(1.01 * limit) < 1e3) << rate; // it overflows to what is not a number
	}
	EXPECT_EQ(dampedStableStep(0.5, std::numeric_limits<double>::infinity()), 0.5);
}

} // namespace
