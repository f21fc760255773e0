// GPL v2 or later, see LICENSE.
// What the bond's mathematics costs, without YADE around it.
#include <pkg/ddem/kernel/BondStrength.hpp>

#include <benchmark/benchmark.h>

#include <random>

namespace {

using namespace yade::ddem;

void bondWithFailureCheck(benchmark::State& state)
{
	const BondSection                      section(1e-3);
	const BondStiffness                    stiffness = bondStiffness({ 100e9, 0.25 }, section, 2e-3);
	std::mt19937_64                        engine(1);
	std::uniform_real_distribution<double> unit(-1, 1);
	const auto                             vector = [&] { return Eigen::Vector3d(unit(engine), unit(engine), unit(engine)); };
	struct Sample {
		Bond               bond;
		Eigen::Vector3d    branch;
		Eigen::Quaterniond orientation1, orientation2;
	};
	std::vector<Sample> samples;
	for (int i = 0; i < 1000; i++) {
		const Eigen::Vector3d branch = 2e-3 * vector().normalized();
		const auto            turned = [&] { return Eigen::Quaterniond(Eigen::AngleAxisd(1e-3, vector().normalized())); };
		samples.push_back({ makeBond(stiffness, branch, Eigen::Quaterniond::Identity(), Eigen::Quaterniond::Identity()),
		                    branch + 1e-6 * vector(),
		                    turned(),
		                    turned() });
	}
	for (auto _ : state)
		for (const Sample& s : samples) {
			BondLoads loads = bondLoads(s.bond, s.branch, s.orientation1, s.orientation2);
			benchmark::DoNotOptimize(bondFailure({ 1e12, 1 }, bondStress(section, loads.section)));
			benchmark::DoNotOptimize(loads);
		}
	state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(samples.size()));
}
BENCHMARK(bondWithFailureCheck);

} // namespace
