// GPL v2 or later, see LICENSE.
// What the bonds' mathematics costs, without YADE around it.
#include "bond_samples.hpp"

#include <pkg/bonded/kernel/SphereMotion.hpp>

#include <benchmark/benchmark.h>

#include <random>

namespace {

using namespace bond_samples;

/// Particles of a chain, each bonded to the next three, slightly out of place;
/// one thread sees what a sample of this size costs per bond.
void allBonds(benchmark::State& state, BondConvention convention)
{
	const auto                             particles = static_cast<std::int32_t>(state.range(0));
	std::mt19937_64                        engine(1);
	std::uniform_real_distribution<double> unit(-1, 1);
	const auto vector = [&] { return Vector(unit(engine), unit(engine), unit(engine)); };
	BondSystem                             system;
	for (std::int32_t i = 0; i < particles; i++)
		for (std::int32_t j = i + 1; j < std::min(i + 4, particles); j++) {
			const Vector        branch(2e-3 * (j - i), 0, 0);
			const BondStiffness stiffness
			        = bondStiffness({ 100e9, 0.25 }, BondSection(branch.norm() / 2), branch.norm());
			system.add(
			        i, j,
			        breakable(
			                join(stiffness, branch, Quaternion::Identity(), Quaternion::Identity()), 1e15));
		}
	system.assemble(std::size_t(particles));
	std::vector<double> pose(std::size_t(sphereRow) * std::size_t(particles)), load(pose.size());
	for (std::int32_t i = 0; i < particles; i++) {
		const Vector     x = Vector(2e-3 * i, 0, 0) + 1e-6 * vector();
		const Quaternion q(Eigen::AngleAxisd(1e-3, vector().normalized()));
		const double     row[8] = { x.x(), x.y(), x.z(), 0, q.w(), q.x(), q.y(), q.z() };
		std::copy_n(row, 8, pose.begin() + 8 * i);
	}
	std::vector<std::int32_t> overloaded;
	for (auto _ : state) {
		benchmark::DoNotOptimize(
		        system.step(convention, false, pose.data(), load.data(), overloaded).stored);
		benchmark::ClobberMemory();
	}
	state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(system.size()));
}
BENCHMARK_CAPTURE(allBonds, consistent, BondConvention::Consistent)->Arg(1000)->Arg(30000);
BENCHMARK_CAPTURE(allBonds, esys, BondConvention::Esys)->Arg(1000)->Arg(30000);

} // namespace
