// GPL v2 or later, see LICENSE.
#include <pkg/ddem/kernel/triangles/LawGroup.hpp>

#include <limits>
#include <stdexcept>

namespace yade::ddem {

bool processorHasAvx2()
{
#if defined(__x86_64__) || defined(__i386__)
	return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
	return false;
#endif
}

const StateField* LawGroup::field(const std::string& wanted) const
{
	for (const StateField& f : fieldList)
		if (f.name == wanted) return &f;
	return nullptr;
}

void LawGroup::get(const StateField& f, std::size_t triangle, std::size_t k, double* to) const
{
	const double*     first = columns.row(triangle, k);
	const std::size_t step  = columns.columnStep(triangle);
	for (std::size_t c = 0; c < f.components(); c++)
		to[c] = first[(f.column + c) * step];
}

void LawGroup::set(const StateField& f, std::size_t triangle, std::size_t k, const double* from)
{
	double*           first = columns.row(triangle, k);
	const std::size_t step  = columns.columnStep(triangle);
	for (std::size_t c = 0; c < f.components(); c++)
		first[(f.column + c) * step] = from[c];
}

std::size_t LawGroup::bytesPerTriangle() const
{
	return 3 * columns.columns() * sizeof(double) + (triangles() ? propertyBytes / triangles() : 0);
}

void LawGroup::beginStep(double dt)
{
	if (flowInterval < 1)
		throw std::invalid_argument(
		        "flowInterval = 0 [steps] must be at least 1, which solves flow in every step.");
	flowClock.steps++;
	flowClock.time += dt;
	held.rest      = rest * std::numeric_limits<double>::epsilon();
	held.flowWaits = flowInterval > 1 || flowClock.steps > 1;
	held.flowIsDue = flowClock.steps >= flowInterval;
	held.flowTime  = flowClock.time;
}

void LawGroup::endStep()
{
	if (held.flowIsDue) flowClock = FlowClock();
}

} // namespace yade::ddem
