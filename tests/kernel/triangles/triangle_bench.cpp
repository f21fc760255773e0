// GPL v2 or later, see LICENSE.
// Cost of one step of triangles by rotation treatment and size, one thread: elastic, with the energy book, and concrete
// with all effects that moves, rests (only round-off moves it) or solves its flow in every fourth step.
#include "../TriangleSamples.hpp"

#include <benchmark/benchmark.h>

#include <omp.h>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::samples;

struct Scene {
	RotationTreatment rotation     = RotationTreatment::Cosserat;
	bool              energy       = false;
	bool              concrete     = false;
	bool              rests        = false;
	unsigned          flowInterval = 1;
};

void triangleStep(benchmark::State& state, const Scene& scene)
{
	omp_set_num_threads(1);
	const int      columns = int(state.range(0)), rows = 2 * columns;
	const double   width  = 0.1;
	const Mesh     mesh   = rectangle(columns, rows, width, 2 * width, 0.1);
	TriangleSystem system = makeSystem(mesh, Material(), scene.rotation);
	if (scene.concrete)
		makeConcrete(system, ConcreteParameters(), ConcreteEffects::All & ~unsigned(ConcreteEffects::Energy));
	system.group[0]->flowInterval = scene.flowInterval;
	agitate(system, scene.rests ? 1e-20 : 0.5, scene.rests ? 1e-20 : 10, 71);
	const StepSettings settings = stepOf(0.5 * criticalStep(mesh, Material(), scene.rotation), scene.energy);
	for (auto _ : state)
		benchmark::DoNotOptimize(system.step(settings).kinetic);
	const auto triangles              = double(mesh.triangle.size());
	state.counters["triangles"]       = triangles;
	state.counters["s/triangle-step"] = benchmark::Counter(
	        triangles, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void sizes(benchmark::internal::Benchmark* b)
{
	b->ArgName("columns")->Arg(20)->Arg(57)->Arg(180); // 1600, 12 996 and 129 600 triangles
}

constexpr auto none = RotationTreatment::None, corotational = RotationTreatment::Corotational,
               cosserat = RotationTreatment::Cosserat;
BENCHMARK_CAPTURE(triangleStep, none, Scene { none, false, false, false, 1 })->Apply(sizes);
BENCHMARK_CAPTURE(triangleStep, corotational, Scene { corotational, false, false, false, 1 })->Apply(sizes);
BENCHMARK_CAPTURE(triangleStep, cosserat, Scene { cosserat, false, false, false, 1 })->Apply(sizes);
BENCHMARK_CAPTURE(triangleStep, cosserat_rest, Scene { cosserat, false, false, true, 1 })->Apply(sizes);
BENCHMARK_CAPTURE(triangleStep, cosserat_energy, Scene { cosserat, true, false, false, 1 })->Apply(sizes);
BENCHMARK_CAPTURE(triangleStep, concrete_none, Scene { none, false, true, false, 1 })->Apply(sizes);
BENCHMARK_CAPTURE(triangleStep, concrete_corotational, Scene { corotational, false, true, false, 1 })->Apply(sizes);
BENCHMARK_CAPTURE(triangleStep, concrete_cosserat, Scene { cosserat, false, true, false, 1 })->Apply(sizes);
BENCHMARK_CAPTURE(triangleStep, concrete_rest, Scene { cosserat, false, true, true, 1 })->Apply(sizes);
BENCHMARK_CAPTURE(triangleStep, concrete_flow_interval_4, Scene { cosserat, false, true, false, 4 })->Apply(sizes);

} // namespace
