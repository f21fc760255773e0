// GPL v2 or later, see LICENSE.
// Steps of a tile of concrete for a count of instructions (test_instructions.py), corotational; all elements are
// driven:
//
//     tile MASK STEPS
//
// Compiled with ALONE=MASK, the loop of that one mask of effects is made here, and no other.
#include <pkg/ddem/kernel/laws/ConcreteDamage.hpp>
#ifdef ALONE
#include <pkg/ddem/kernel/triangles/LawLoopBodies.hpp>
#else
#include <pkg/ddem/kernel/triangles/GroupOf.hpp>
#endif

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

namespace {

using namespace yade::ddem;

constexpr std::size_t count = tileSize;

#ifdef ALONE
#if defined(__AVX2__) && defined(__FMA__)
using Set = Avx2;
#else
using Set = Baseline;
#endif
TileLoop<ConcreteDamage> loopOf(unsigned)
{
	return &tileLoop<ConcreteDamage, ALONE, false, FrameCorotational, BatchOf<Set>::Type, Set>;
}
std::size_t columnsOf(unsigned)
{
	ListFields    list;
	ConcreteState any {};
	ConcreteDamage::fields<ALONE>(any, list);
	return list.columns;
}
#else
TileLoop<ConcreteDamage> loopOf(unsigned mask)
{
	return selectTileLoops<ConcreteDamage>(mask, RotationTreatment::Corotational).law;
}
std::size_t columnsOf(unsigned mask)
{
	ListFields list;
	withMask<ConcreteDamage>(mask, [&](auto constant) {
		ConcreteState any {};
		ConcreteDamage::fields<constant()>(any, list);
	});
	return list.columns;
}
#endif

double stepsOfMask(unsigned mask, int steps)
{
	std::vector<std::int32_t> vertex[3];
	std::vector<double>       arm[4], node, reference, core, corner(6 * count), force(2 * count), moment(count);
	for (std::size_t i = 0; i < count; i++) {
		const double skew = 1e-3 * std::sin(double(i)); // arms of triangles that differ, sum zero
		const TriangleReference<double> shape({ -3e-3 + skew, -1e-3 }, { 3e-3, -1e-3 - skew });
		for (std::size_t e = 0; e < 3; e++) {
			vertex[e].push_back(std::int32_t(node.size() / 2));
			node.insert(node.end(), { shape.arm[e].x, shape.arm[e].y });
		}
		for (std::size_t e = 0; e < 2; e++) {
			arm[2 * e].push_back(shape.arm[e].x);
			arm[2 * e + 1].push_back(shape.arm[e].y);
		}
		core.insert(core.end(), { 0., 0. });
	}
	reference = node;
	std::vector<double> angle(count, 0.);
	ElementArrays       a {};
	for (std::size_t e = 0; e < 3; e++) {
		a.vertex[e]      = vertex[e].data();
		a.cornerForce[e] = corner.data() + 2 * e * count;
	}
	for (std::size_t c = 0; c < 4; c++)
		a.arm[c] = arm[c].data();
	a.nodePosition = node.data();
	a.corePosition = core.data();
	a.coreAngle    = angle.data();
	a.coreForce    = force.data();
	a.coreMoment   = moment.data();

	const PreparedConcrete law;
	StateColumns           columns;
	columns.resize(count, columnsOf(mask));
	const double energy[widestBatch] = { 80e3, 80e3, 80e3, 80e3, 80e3, 80e3, 80e3, 80e3 };
	const double band[widestBatch]   = { 1, 1, 1, 1, 1, 1, 1, 1 };
	HeldSteps    held;
	held.rest = 4 * std::numeric_limits<double>::epsilon();
	const TileState<ConcreteDamage> tile { &law, columns.tile(0), columns.stride(0), { energy, band }, { 0, 0 },
		                               held };
	StepEnergy                      sum;
	const auto                      loop = loopOf(mask);
	for (int s = 1; s <= steps; s++) {
		for (std::size_t j = 0; j < node.size(); j += 2) {
			node[j]     = reference[j] + 2e-5 * s * (0.3 * reference[j] + 0.3 * reference[j + 1]);
			node[j + 1] = reference[j + 1] - 2e-5 * s * reference[j + 1];
		}
		loop(a, GroupConstants(), tile, 1e-7, 0, count, sum);
	}
	double total = sum.elastic;
	for (const double f : corner)
		total += std::abs(f);
	return total;
}

} // namespace

int main(int argc, char** argv)
{
	if (argc != 3) return 1;
	std::printf("%.17g\n", stepsOfMask(unsigned(std::atoi(argv[1])), std::atoi(argv[2])));
	return 0;
}
