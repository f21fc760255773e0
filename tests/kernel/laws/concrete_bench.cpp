// GPL v2 or later, see LICENSE.
// What a step of the concrete law costs per sub-element (items per second, its inverse as time), for every combination of effects.
#include <pkg/ddem/kernel/laws/concrete/ConcreteLaw.hpp>

#include <benchmark/benchmark.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace yade::ddem;

constexpr std::size_t count = 300; // sub-elements; they fit the inner caches, so that the law is measured and not the memory

std::string nameOf(unsigned effects)
{
	std::string name;
	for (const auto& [bit, word] : { std::pair<unsigned, const char*> { ConcreteEffects::Flow, "flow " },
	                                 { ConcreteEffects::Rate, "rate " },
	                                 { ConcreteEffects::Damage, "damage " },
	                                 { ConcreteEffects::EquationOfState, "eos " },
	                                 { ConcreteEffects::Energy, "energy " } })
		if (effects & bit) name += word;
	return name.empty() ? "elastic" : name;
}

/// Compression with shear, different in each element, going on by 1e-6 in every step and starting over after 4000 steps.
class Crushing {
public:
	Crushing()
	        : states(count, ConcreteState {})
	        , strains(count)
	        , energies(count, 80e3)
	{
	}
	void nextStrains()
	{
		if (++step_ > 4000) {
			step_  = 1;
			states = std::vector<ConcreteState>(count, ConcreteState {});
		}
		for (std::size_t i = 0; i < count; ++i) {
			const double share = double(i) / count, t = 1e-6 * step_;
			strains[i] = { 0.3 * t * (1 + 0.2 * share), -t, 0, 0.3 * t * share };
		}
	}

	const PreparedConcrete     concrete;
	std::vector<ConcreteState> states;
	std::vector<PlaneTensor>   strains;
	std::vector<double>        energies;

private:
	int step_ = 0;
};

void finish(benchmark::State& state, unsigned effects)
{
	state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(count));
	state.counters["per element"]
	        = benchmark::Counter(static_cast<double>(state.iterations()) * double(count), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
	state.SetLabel(nameOf(effects));
}

void concreteBlock(benchmark::State& state, ConcreteBlockUpdate (*choose)(unsigned))
{
	const auto effects = static_cast<unsigned>(state.range(0));
	const auto update  = choose(effects);
	if (!update) {
		state.SkipWithMessage("this processor or build has no AVX2");
		return;
	}
	Crushing sample;
	for (auto _ : state) {
		sample.nextStrains();
		update(sample.concrete, sample.energies.data(), sample.strains.data(), 2e-8, sample.states.data(), count);
		benchmark::ClobberMemory();
	}
	finish(state, effects);
}

void concreteSingle(benchmark::State& state)
{
	const auto effects = static_cast<unsigned>(state.range(0));
	const auto update  = concreteUpdate(effects);
	Crushing   sample;
	for (auto _ : state) {
		sample.nextStrains();
		for (std::size_t i = 0; i < count; ++i)
			update(sample.concrete, sample.energies[i], sample.strains[i], 2e-8, sample.states[i]);
		benchmark::ClobberMemory();
	}
	finish(state, effects);
}

/// Elements at rest, with everything on: the cheap way out where nothing can flow.
void concreteAtRest(benchmark::State& state)
{
	const auto update = concreteBlockUpdate(ConcreteEffects::All);
	Crushing   sample;
	for (auto _ : state) {
		update(sample.concrete, sample.energies.data(), sample.strains.data(), 2e-8, sample.states.data(), count);
		benchmark::ClobberMemory();
	}
	finish(state, ConcreteEffects::All);
}

void combinations(benchmark::internal::Benchmark* b)
{
	for (unsigned effects = 0; effects <= ConcreteEffects::All; ++effects) {
		const bool flows = effects & ConcreteEffects::Flow;
		if (!flows && (effects & ConcreteEffects::Rate)) continue; // no flow to depend on the rate
		b->Arg(effects);
	}
}

BENCHMARK_CAPTURE(concreteBlock, widest, concreteBlockUpdate)->Apply(combinations);
BENCHMARK_CAPTURE(concreteBlock, baseline, concreteBlockUpdateBaseline)->Arg(0)->Arg(15)->Arg(31);
BENCHMARK(concreteSingle)->Arg(0)->Arg(15)->Arg(31);
BENCHMARK(concreteAtRest);

} // namespace
