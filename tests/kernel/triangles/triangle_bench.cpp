// GPL v2 or later, see LICENSE.
// Cost of one step of triangles, one thread: elastic with three rotation treatments, with the energy book, and concrete with all effects.
#include "../TriangleSamples.hpp"

#include <benchmark/benchmark.h>

#include <omp.h>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::samples;

void triangleStep(benchmark::State& state, RotationTreatment rotation, bool energy, bool concrete = false)
{
	omp_set_num_threads(1);
	const int      columns = int(state.range(0)), rows = 2 * columns;
	const double   width  = 0.1;
	const Mesh     mesh   = rectangle(columns, rows, width, 2 * width, 0.1);
	TriangleSystem system = makeSystem(mesh, Material(), rotation);
	if (concrete) makeConcrete(system, ConcreteParameters(), ConcreteEffects::All & ~unsigned(ConcreteEffects::Energy));
	agitate(system, 0.5, 10, 71);
	StepSettings settings = stepOf(0.5 * criticalStep(mesh, Material(), rotation), energy);
	for (auto _ : state)
		benchmark::DoNotOptimize(system.step(settings).kinetic);
	const auto triangles              = double(mesh.triangle.size());
	state.counters["triangles"]       = triangles;
	state.counters["s/triangle-step"] = benchmark::Counter(triangles, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void sizes(benchmark::internal::Benchmark* b)
{
	b->ArgName("columns")->Arg(20)->Arg(57)->Arg(180); // 1600, 12 996 and 129 600 triangles
}

BENCHMARK_CAPTURE(triangleStep, none, RotationTreatment::None, false)->Apply(sizes);
BENCHMARK_CAPTURE(triangleStep, corotational, RotationTreatment::Corotational, false)->Apply(sizes);
BENCHMARK_CAPTURE(triangleStep, cosserat, RotationTreatment::Cosserat, false)->Apply(sizes);
BENCHMARK_CAPTURE(triangleStep, cosserat_energy, RotationTreatment::Cosserat, true)->Apply(sizes);
BENCHMARK_CAPTURE(triangleStep, concrete_cosserat, RotationTreatment::Cosserat, false, true)->Apply(sizes);

} // namespace
