// GPL v2 or later, see LICENSE.
// Cost of a triangle-step of every law with every mask of its effects, one thread: driven, at rest, and driven in the
// instructions that every processor has. Names: LAW/effects/state; the counter ns is per triangle and step.
#include "../TriangleSamples.hpp"

#include <laws/AllLaws.hpp>

#include <benchmark/benchmark.h>

#include <omp.h>

#include <set>
#include <string>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::samples;

enum class State { Driven, Baseline, Rest };

/// Every element is compressed and sheared by 1e-6 in each step; starts over after 4000 steps.
template <class Law> class Sample {
public:
	Sample(unsigned mask, State state_)
	        : state(state_)
	        , mesh(rectangle(20, 40, 0.1, 0.2, 0.1)) // 1600 triangles: the law is measured, not the memory
	        , system(makeSystem(mesh, Material(), RotationTreatment::Cosserat))
	        , settings(stepOf(
	                  0.5 * criticalStep(mesh, Material(), RotationTreatment::Cosserat), mask & LawEffects::Energy))
	{
		setGroups<Law>(
		        system,
		        Material(),
		        typename Law::Parameters(),
		        mask & ~unsigned(LawEffects::Energy),
		        { system.triangles() });
		if (state == State::Rest) agitate(system, 1e-20, 1e-20, 71);
		else
			drive(1e-6 / settings.dt);
		system.step(settings); // the book is open
		if (state == State::Baseline) system.group[0]->prepare(RotationTreatment::Cosserat, false);
		start = system;
		for (int i = 0; i < 20; i++)
			step();
	}
	void step()
	{
		if (state != State::Rest && ++done == 4000) {
			system = start;
			done   = 0;
		}
		benchmark::DoNotOptimize(system.step(settings).kinetic);
	}
	std::size_t triangles() const { return system.triangles(); }

private:
	State          state;
	Mesh           mesh;
	TriangleSystem system, start;
	StepSettings   settings;
	int            done = 0;

	void drive(double rate)
	{
		for (Points* points : { &system.motion.node, &system.motion.core })
			for (std::size_t i = 0; i < points->size(); i++) {
				const double x = points->position[2 * i], y = points->position[2 * i + 1];
				points->velocity[2 * i]     = rate * (0.3 * x + 0.3 * y);
				points->velocity[2 * i + 1] = -rate * y;
				points->inverseMass[2 * i] = points->inverseMass[2 * i + 1] = 0;
			}
		std::fill(system.motion.spin.inverseInertia.begin(), system.motion.spin.inverseInertia.end(), 0.);
		system.motion.collectConstraints();
	}
};

template <class Law> std::string nameOf(unsigned mask)
{
	std::string effects;
	for (const LawEffect& effect : Law::effects())
		if (mask & effect.bit) effects += (effects.empty() ? "" : "+") + std::string(effect.name);
	if (mask & LawEffects::Energy) effects += effects.empty() ? "book" : "+book";
	return std::string(Law::name) + "/" + (effects.empty() ? "plain" : effects);
}

template <class Law> void registerBenchmark(unsigned mask, State kind)
{
	const char* const suffix = kind == State::Driven ? "driven"
	        : kind == State::Baseline                ? "driven-baseline"
	                                                 : "rest";
	benchmark::RegisterBenchmark((nameOf<Law>(mask) + "/" + suffix).c_str(), [=](benchmark::State& state) {
		omp_set_num_threads(1);
		Sample<Law> sample(mask, kind);
		for (auto _ : state)
			sample.step();
		state.counters["ns"] = benchmark::Counter(
		        1e-9 * double(sample.triangles()),
		        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
	});
}

template <class... Laws> struct Registration {
	Registration() { (ofLaw<Laws>(), ...); }

private:
	template <class Law> static void ofLaw()
	{
		std::set<unsigned> masks;
		for (unsigned mask = 0; mask <= Law::allEffects; mask++)
			masks.insert(Law::distinct(mask));
		for (const State state : { State::Driven, State::Baseline, State::Rest })
			for (const unsigned mask : masks)
				registerBenchmark<Law>(mask, state);
	}
};
const AllLaws<Registration> registered;

} // namespace
