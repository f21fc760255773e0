// GPL v2 or later, see LICENSE.
// All bonds at once give what each gives alone, whatever the instruction set and the number of threads.
#include "bond_samples.hpp"

#include <pkg/bonded/kernel/BondLoops.hpp>
#include <pkg/bonded/kernel/SphereMotion.hpp>

#include <gtest/gtest.h>

#include <omp.h>

#include <random>

namespace {

using namespace bond_samples;

class RandomSample : public testing::TestWithParam<BondConvention> {
protected:
	struct Particle {
		Vector     x;
		Quaternion q;
	};
	std::mt19937_64                              engine { 5 };
	std::uniform_real_distribution<double>       unit { -1, 1 };
	std::vector<Particle>                        particles;
	std::vector<std::pair<int, int>>             pairs;
	std::vector<Bond>                            bonds;
	BondSystem                                   system;
	std::vector<double>                          pose, load;
	static constexpr double                      size = 1e-3;

	Vector vector() { return { unit(engine), unit(engine), unit(engine) }; }

	/// Bonds between all pairs of some particles, made in random orientations;
	/// then everything is moved by `amplitude` sizes and radians.
	void make(int count, double amplitude, double cohesion)
	{
		for (int i = 0; i < count; i++)
			particles.push_back(
			        { 5 * size * vector(),
			          Quaternion(unit(engine), unit(engine), unit(engine), unit(engine)).normalized() });
		for (int i = 0; i < count; i++)
			for (int j = i + 1; j < count; j++) {
				const Vector        branch    = particles[j].x - particles[i].x;
				const BondStiffness stiffness
				        = bondStiffness({ 100e9, 0.25 }, BondSection(branch.norm() / 2), branch.norm());
				bonds.push_back(
				        join(stiffness, branch, particles[i].q, particles[j].q,
				             (0.3 + 0.2 * unit(engine)) * branch.norm()));
				pairs.emplace_back(i, j);
				system.add(i, j, breakable(bonds.back(), cohesion));
			}
		system.assemble(std::size_t(count));
		pose.assign(std::size_t(sphereRow) * std::size_t(count), 0.);
		load = pose;
		for (int i = 0; i < count; i++) {
			Particle& p = particles[std::size_t(i)];
			p.x += amplitude * size * vector();
			p.q = Quaternion(Eigen::AngleAxisd(amplitude * unit(engine), vector().normalized())) * p.q;
			const double row[8] = { p.x.x(), p.x.y(), p.x.z(), 0, p.q.w(), p.q.x(), p.q.y(), p.q.z() };
			std::copy_n(row, 8, pose.begin() + 8 * i);
		}
	}
	Loads alone(std::size_t bond) const
	{
		const Particle &a = particles[std::size_t(pairs[bond].first)],
		               &b = particles[std::size_t(pairs[bond].second)];
		return loadsOf(bonds[bond], b.x - a.x, a.q, b.q, GetParam());
	}
};

TEST_P(RandomSample, addsUpTheLoadsOfItsBonds)
{
	for (const double amplitude : { 1e-6, 1e-3, 0.5 }) { // the last one beyond the series of small angles
		SCOPED_TRACE(amplitude);
		particles.clear(), pairs.clear(), bonds.clear(), system.clear();
		make(23, amplitude, 1e15);
		std::vector<std::int32_t> overloaded;
		const double energy
		        = system.step(GetParam(), true, pose.data(), load.data(), overloaded).stored;
		EXPECT_TRUE(overloaded.empty());

		std::vector<Vector> force(particles.size(), Vector::Zero()), moment = force;
		double              sum = 0, scale = 0;
		for (std::size_t b = 0; b < bonds.size(); b++) {
			const Loads l = alone(b);
			force[std::size_t(pairs[b].first)] += l.force;
			force[std::size_t(pairs[b].second)] -= l.force;
			moment[std::size_t(pairs[b].first)] += l.moment1;
			moment[std::size_t(pairs[b].second)] += l.moment2;
			sum += l.energy;
			scale                   = std::max(scale, l.force.norm());
			const BondStress stress = bondStress(BondSection(bonds[b].length / 2), l.section);
			EXPECT_NEAR(system.row(b).normalStress, stress.normal, 1e-9 * std::abs(stress.normal) + 0.1);
			EXPECT_NEAR(system.row(b).shearStress, stress.shear, 1e-9 * stress.shear + 0.1);
		}
		// 22 bonds of up to 2e9 N/m; positions are rounded to 1e-18 m
		const double round = 1e-11 * scale + 22 * 2e9 * 1e-18;
		EXPECT_NEAR(energy, sum, 1e-8 * sum);
		for (std::size_t i = 0; i < particles.size(); i++)
			for (int axis = 0; axis < 3; axis++) {
				EXPECT_NEAR(load[8 * i + std::size_t(axis)], force[i][axis], round);
				EXPECT_NEAR(
				        load[8 * i + 4 + std::size_t(axis)], moment[i][axis], round * 10 * size);
			}
	}
}

TEST_P(RandomSample, namesOverloadedBondsInOrder)
{
	make(20, 1e-3, 20e6);
	std::vector<std::int32_t> overloaded, expected;
	system.step(GetParam(), false, pose.data(), load.data(), overloaded);
	for (std::size_t b = 0; b < bonds.size(); b++)
		if (MohrCoulomb::overload(
		            { 20e6, 1, 20e6 }, bondStress(BondSection(bonds[b].length / 2), alone(b).section))
		    > 0)
			expected.push_back(std::int32_t(b));
	EXPECT_GT(expected.size(), 10u);
	EXPECT_LT(expected.size(), bonds.size() - 10);
	EXPECT_EQ(overloaded, expected);
}

TEST_P(RandomSample, noticesWhatIsNotANumber)
{
	make(5, 1e-6, 1e15);
	pose[8] = std::nan("");
	std::vector<std::int32_t> overloaded;
	system.step(GetParam(), false, pose.data(), load.data(), overloaded);
	EXPECT_EQ(overloaded, (std::vector<std::int32_t> { 0, 4, 5, 6 })); // the bonds of particle 1
}

TEST_P(RandomSample, doesNotDependOnTheNumberOfThreads)
{
	make(60, 1e-2, 1e15);
	std::vector<std::int32_t> overloaded;
	const int                 threads = omp_get_max_threads();
	std::vector<double>       first;
	double                    energy = 0;
	for (const int n : { 1, 2, 3 }) {
		omp_set_num_threads(n);
		const double now
		        = system.step(GetParam(), true, pose.data(), load.data(), overloaded).stored;
		if (n == 1) {
			first  = load;
			energy = now;
		}
		EXPECT_EQ(load, first);
		EXPECT_EQ(now, energy);
	}
	omp_set_num_threads(threads);
}

INSTANTIATE_TEST_SUITE_P(
        Conventions, RandomSample, testing::Values(BondConvention::Consistent, BondConvention::Esys),
        [](const auto& i) { return i.param == BondConvention::Esys ? "Esys" : "Consistent"; });

TEST(BondSystem, refusesBondsToParticlesThatDoNotExist)
{
	BondSystem system;
	system.add(
	        0, 2,
	        breakable(join({ 1, 1, 1, 1 }, { 1, 0, 0 }, Quaternion::Identity(), Quaternion::Identity()), 1));
	EXPECT_THROW(system.assemble(2), std::logic_error);
}

} // namespace
