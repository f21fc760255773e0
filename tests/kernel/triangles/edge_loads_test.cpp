// GPL v2 or later, see LICENSE.
// Loads and dampers on nodes, and the forces that tractions on edges make of themselves.
#include "../TriangleSamples.hpp"

#include <pkg/ddem/kernel/triangles/EdgeTraction.hpp>

#include <gtest/gtest.h>
#include <omp.h>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::samples;

/// Corners of a polygon, counter-clockwise.
std::vector<Point> star(std::uint64_t seed)
{
	Random             random(seed);
	std::vector<Point> corner;
	for (int k = 0; k < 12; k++) {
		const double angle = 2 * M_PI * k / 12, radius = random.uniform(0.5, 1.5);
		corner.push_back({ radius * std::cos(angle), radius * std::sin(angle) });
	}
	return corner;
}

double areaOf(const std::vector<Point>& corner)
{
	double twice = 0;
	for (std::size_t k = 0; k < corner.size(); k++)
		twice += cross(corner[k], corner[(k + 1) % corner.size()]);
	return 0.5 * twice;
}

std::vector<Point> forcesOn(const std::vector<Point>& corner, const EdgeStress& stress, double thickness)
{
	std::vector<Point> force(corner.size(), Point { 0, 0 });
	for (std::size_t k = 0; k < corner.size(); k++) {
		const std::size_t next   = (k + 1) % corner.size();
		const Point       along  = corner[next] - corner[k];
		const auto        forces = edgeForces(stress, {}, along, std::hypot(along.x, along.y), thickness);
		force[k]                 = force[k] + forces.start;
		force[next]              = force[next] + forces.end;
	}
	return force;
}

TEST(EdgeTraction, pressureAndShearAroundAClosedLineHaveNoResultant)
{
	EdgeStress stress;
	stress.pressure   = 3e6;
	stress.shear      = 2e6;
	const auto corner = star(3);
	Point      sum { 0, 0 };
	double     moment = 0;
	for (std::size_t k = 0; k < corner.size(); k++) {
		const auto force = forcesOn(corner, stress, 0.2)[k];
		sum              = sum + force;
		moment += cross(corner[k], force);
	}
	EXPECT_LT(std::hypot(sum.x, sum.y), 1e-13 * 3e6);
	// that of a shear all around: ∮ r × q ds = 2 q A
	EXPECT_NEAR(moment, 2 * 2e6 * areaOf(corner) * 0.2, 1e-13 * 2e6);
}

// dW/dx = −p dV/dx: central differences of the area, which is quadratic in each corner, are exact
TEST(EdgeTraction, pressureDoesTheWorkOfTheVolumeThatItTakes)
{
	EdgeStress stress;
	stress.pressure    = 3e6;
	const auto corner  = star(4);
	const auto force   = forcesOn(corner, stress, 0.2);
	const auto derived = [&](std::size_t k, double Point::*axis) {
		auto low = corner, high = corner;
		low[k].*axis -= 0.1;
		high[k].*axis += 0.1;
		return (areaOf(high) - areaOf(low)) / 0.2;
	};
	for (std::size_t k = 0; k < corner.size(); k++) {
		EXPECT_NEAR(force[k].x, -3e6 * 0.2 * derived(k, &Point::x), 1e-12 * 3e6);
		EXPECT_NEAR(force[k].y, -3e6 * 0.2 * derived(k, &Point::y), 1e-12 * 3e6);
	}
}

// resultant ∫ f ds and moment ∫ f s ds of f = a + (b − a) s/L
TEST(EdgeTraction, aProfileThatGrowsAlongTheEdgeKeepsResultantAndMoment)
{
	EdgeStress   stress;
	stress.fixed       = { 0, -5e6 };
	const double a = 0.3, b = 1.7, length = 2;
	const auto   forces = edgeForces(stress, { a, b }, { length, 0 }, length, 0.1);
	EXPECT_NEAR(forces.start.y + forces.end.y, -5e6 * 0.1 * length * (a + b) / 2, 1e-9);
	EXPECT_NEAR(forces.end.y * length, -5e6 * 0.1 * length * length * (a / 6 + b / 3), 1e-8);
	EXPECT_EQ(forces.start.x, 0);
}

TEST(EdgeTraction, aDamperActsAlongAndAcrossItsEdge)
{
	const WaveImpedance impedance { 9e6, 5e6 };
	const Point         along { 0.06, 0.08 }, normal { 0.8, -0.6 }, tangent { 0.6, 0.8 };
	const auto          damper = edgeDamper(impedance, along, 0.1, 0.5);
	for (const auto& [direction, expected] : { std::make_pair(normal, 9e6), std::make_pair(tangent, 5e6) }) {
		const Point force = damper * direction;
		EXPECT_NEAR(force.x, 0.5 * expected * 0.1 * 0.5 * direction.x, 1e-9);
		EXPECT_NEAR(force.y, 0.5 * expected * 0.1 * 0.5 * direction.y, 1e-9);
	}
}

class LoadedNodes : public testing::TestWithParam<RotationTreatment> {
protected:
	const Mesh   mesh     = rectangle(4, 5, 0.04, 0.05, 0.25, 9);
	const double critical = criticalStep(mesh, Material(), GetParam());

	TriangleSystem agitated(double strain) const
	{
		TriangleSystem system = makeSystem(mesh, Material(), GetParam());
		agitate(system, 5000 * strain, 5000 * strain / 0.005, 45);
		return system;
	}
};
INSTANTIATE_TEST_SUITE_P(, LoadedNodes, testing::ValuesIn(allTreatments), [](const auto& test) {
	return name(test.param);
});

TEST_P(LoadedNodes, aLoadMovesANodeAsAForceFromOutsideDoes)
{
	StepSettings settings = stepOf(0.9 * critical, true);
	settings.gravity      = { 1, -9.81 };
	settings.damping      = 0.2;
	TriangleSystem loaded = agitated(1e-4), forced = agitated(1e-4);
	loaded.motion.loads.assign({ 7, 0, 12, 7 });
	ASSERT_EQ(loaded.motion.loads.size(), 3u);
	settings.external = true;
	forced.motion.node.external.assign(2 * mesh.node.size(), 0.);
	for (auto& load : loaded.motion.loads) {
		load.force                                     = { 3e3, -2e3 };
		forced.motion.node.external[2 * load.node]     = 3e3;
		forced.motion.node.external[2 * load.node + 1] = -2e3;
	}
	double works[2] = { 0, 0 };
	for (int i = 0; i < 200; i++) {
		const StepEnergy a = loaded.step(settings), b = forced.step(settings);
		works[0] += a.edgeWork;
		works[1] += b.externalWork;
		EXPECT_EQ(a.externalWork, 0);
		EXPECT_EQ(b.edgeWork, 0);
		EXPECT_NEAR(a.kinetic, b.kinetic, 1e-9 * b.kinetic);
	}
	EXPECT_LT(
	        largestDifference(loaded.motion.node.position, forced.motion.node.position),
	        1e-12 * largest(forced.motion.node.position));
	EXPECT_NEAR(works[0], works[1], 1e-9 * std::abs(works[1]));
}

// Weak and strong dampers, turned so that they couple both directions: the bound of the elements is that of
// the damped system, see LoadedNode.hpp. Rotations of the frame left out, the system is linear.
TEST_P(LoadedNodes, dampersLeaveTheStableStepAsItIs)
{
	if (GetParam() != RotationTreatment::None) GTEST_SKIP() << "a bound of linear systems";
	for (const double strength : { 0.1, 1., 100. }) {
		TriangleSystem system = agitated(1e-9);
		Random         random(8);
		std::vector<std::size_t> nodes;
		for (std::size_t v = 0; v < mesh.node.size(); v += 2)
			nodes.push_back(v);
		system.motion.loads.assign(nodes);
		for (auto& load : system.motion.loads) {
			const double scale = strength * system.motion.node.mass[load.node] / critical;
			const Point  n     = random.point(1), s = random.point(1);
			load.damper = { scale * (n.x * n.x + s.x * s.x), scale * (n.y * n.y + s.y * s.y),
				        scale * (n.x * n.y + s.x * s.y) };
		}
		const StepSettings settings = stepOf(0.9999 * critical, true);
		double             stored = 0, lost = 0, first = 0;
		for (int i = 0; i < 20000; i++) {
			const StepEnergy e = system.step(settings);
			stored             = e.kinetic + e.elastic + e.rotation;
			if (i == 0) first = stored;
			else
				lost += e.edgeAbsorption;
			// the book's energy is not the one that never grows, but as large
			ASSERT_LE(stored, 2 * first) << "step " << i << ", strength " << strength;
		}
		EXPECT_NEAR(first - stored, lost, 2e-5 * first) << "strength " << strength; // round-off, 1e-14/strain
		EXPECT_LT(stored, 0.5 * first);
	}
}

TEST_P(LoadedNodes, giveTheSameBitsForAnyNumberOfThreads)
{
	const Mesh            wide = rectangle(60, 50, 0.6, 0.5, 0.25, 9); // three tiles of nodes
	std::vector<double>   positions[2];
	double                absorbed[2];
	const int             before = omp_get_max_threads();
	for (const int run : { 0, 1 }) {
		omp_set_num_threads(run ? 2 : 1);
		TriangleSystem system = makeSystem(wide, Material(), GetParam());
		agitate(system, 1, 1, 45);
		std::vector<std::size_t> nodes;
		for (std::size_t v = 0; v < wide.node.size(); v += 7)
			nodes.push_back(v);
		system.motion.loads.assign(nodes);
		for (auto& load : system.motion.loads) {
			load.force  = { 1e4, -2e4 };
			load.damper = { 2e3, 3e3, 1e3 };
		}
		const StepSettings settings = stepOf(0.5 * criticalStep(wide, Material(), GetParam()), true);
		absorbed[run]               = 0;
		for (int i = 0; i < 5; i++)
			absorbed[run] += system.step(settings).edgeAbsorption;
		positions[run].assign(system.motion.node.position.begin(), system.motion.node.position.end());
	}
	omp_set_num_threads(before);
	EXPECT_EQ(positions[0], positions[1]);
	EXPECT_EQ(absorbed[0], absorbed[1]);
	EXPECT_GT(absorbed[0], 0);
}

TEST_P(LoadedNodes, closeTheBookWithEveryEffect)
{
	const double   strain = 1e-4;
	TriangleSystem system = agitated(strain);
	Random         random(46);
	for (Points* points : { &system.motion.node, &system.motion.core })
		for (std::size_t i = 0; i < 2 * points->size(); i++)
			points->external.push_back(random.uniform(-1e4, 1e4));
	for (std::size_t v = 0; v < 5; v++) { // the bottom, driven along x and free or held along y
		system.motion.node.inverseMass[2 * v] = 0;
		system.motion.node.velocity[2 * v]    = 0.3;
		if (v % 2 == 0) system.motion.node.inverseMass[2 * v + 1] = 0;
	}
	system.motion.collectConstraints();
	system.motion.loads.assign({ 0, 1, 2, 3, 4, 9, 14, 19 });
	for (auto& load : system.motion.loads) {
		load.force  = random.point(1e4);
		load.damper = { 2e3, 3e3, 1e3 };
	}
	StepSettings settings = stepOf(0.9 * critical, true);
	settings.gravity      = { 1, -9.81 };
	settings.damping      = 0.1;
	settings.external     = true;
	double first = 0, works = 0, gap = 0, size = 0, edges = 0, absorbed = 0;
	for (int i = 0; i < 1000; i++) {
		for (std::size_t v = 0; v < 5; v++)
			system.motion.node.velocity[2 * v] = 0.3 * std::cos(0.01 * i);
		const StepEnergy e      = system.step(settings);
		const double     stored = e.kinetic + e.elastic + e.rotation;
		if (i == 0) first = stored;
		else
			works += e.externalWork + e.gravityWork + e.edgeWork - e.dampingLoss - e.edgeAbsorption;
		if (i > 0) edges += e.edgeWork;
		if (i > 0) absorbed += e.edgeAbsorption;
		gap  = std::max(gap, std::abs(stored - first - works));
		size = std::max({ size, std::abs(stored), std::abs(works) });
	}
	// as TriangleEnergy: forces of rotating frames are linear up to the strain
	EXPECT_LT(gap, (GetParam() == RotationTreatment::None ? 2e-14 / strain : 0.02 * strain) * size);
	EXPECT_GT(std::abs(edges), 0.01 * size);
	EXPECT_GT(absorbed, 0.01 * size);
}

} // namespace
