// GPL v2 or later, see LICENSE.
// Steps of a sample of triangles for a count of instructions (test_instructions.py):
//
//     system SAMPLE ROTATION STEPS       ROTATION 0 none, 1 corotational, 2 cosserat
#include "../../kernel/TriangleSamples.hpp"

#include <pkg/ddem/kernel/laws/ScalarDamage.hpp>
#include <pkg/ddem/kernel/laws/VonMises.hpp>

#include <omp.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::samples;

double stepsOfSystem(const char* sample, RotationTreatment rotation, int steps)
{
	const auto     is     = [&](const char* name) { return std::strcmp(sample, name) == 0; };
	const Mesh     mesh   = rectangle(16, 32, 0.1, 0.2, 0.1); // 1024 triangles, four tiles
	TriangleSystem system = makeSystem(mesh, Material(), rotation);
	const unsigned all    = ConcreteEffects::All & ~unsigned(ConcreteEffects::Energy);
	if (is("ScalarDamage")) setGroups<ScalarDamage>(system, Material(), ScalarDamage::Parameters(), 0, { 1024 });
	if (is("VonMises")) setGroups<VonMises>(system, Material(), VonMises::Parameters(), 0, { 1024 });
	if (is("concrete") || is("rest")) makeConcrete(system, ConcreteParameters(), all);
	if (is("beside")) { // half of it elastic
		setGroups<Elastic>(system, Material(), Elastic::Parameters(), 0, { 512, 1024 });
		auto concrete       = makeGroup<ConcreteDamage>(ConcreteParameters(), all);
		concrete->begin     = 512;
		concrete->end       = 1024;
		concrete->constants = system.group[1]->constants;
		concrete->start(std::vector<TriangleProperties>(512));
		system.group[1] = GroupPointer(std::move(concrete));
		system.build();
	}
	// strains far below 1e-5, so that no threshold is reached
	if (is("rest")) agitate(system, 1e-20, 1e-20, 71);
	else
		agitate(system, 1e-3, 1, 71);
	return run(system, stepOf(0.5 * criticalStep(mesh, Material(), rotation)), steps).kinetic
	        + system.motion.node.force[0];
}

} // namespace

int main(int argc, char** argv)
{
	if (argc != 4) return 1;
	omp_set_num_threads(1);
	std::printf("%.17g\n", stepsOfSystem(argv[1], RotationTreatment(std::atoi(argv[2])), std::atoi(argv[3])));
	return 0;
}
