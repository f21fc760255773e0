// GPL v2 or later, see LICENSE.
// A rigid platen under a force: Newton's law for it, its stability, and the energy book.
#include "../TriangleSamples.hpp"

#include <gtest/gtest.h>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::samples;

class Platen : public testing::TestWithParam<RotationTreatment> {
protected:
	const int    columns = 4, rows = 5;
	const double width = 0.04, height = 0.05;
	const Mesh   mesh     = rectangle(columns, rows, width, height);
	const double critical = criticalStep(mesh, Material(), GetParam());

	/// The bottom held, the top a platen that goes down; both slide.
	TriangleSystem pressed(double force, double dashpot) const
	{
		TriangleSystem system = makeSystem(mesh, Material(), GetParam());
		RigidPlaten    platen;
		platen.axis    = 1;
		platen.sign    = -1;
		platen.dashpot = dashpot;
		platen.limit   = 100;
		platen.to      = force;
		for (std::size_t v = 0; v < mesh.node.size(); v++) {
			const bool top = v >= std::size_t(rows * (columns + 1)), bottom = v <= std::size_t(columns);
			if (top) platen.nodes.push_back(v);
			if (top || bottom) system.motion.node.inverseMass[2 * v + 1] = 0;
		}
		system.motion.collectConstraints();
		system.platens.push_back(platen);
		return system;
	}
};
INSTANTIATE_TEST_SUITE_P(, Platen, testing::ValuesIn(allTreatments), [](const auto& test) { return name(test.param); });

// the step at its bound, without any damping but the dashpot, weak and very strong
TEST_P(Platen, isStableAtTheBoundOfItsTriangles)
{
	const double wave = std::sqrt(2400 * (30e9 + 4. / 3 * 26e9)) * width;
	for (const double strength : { 0., 0.1, 1., 1000. }) {
		TriangleSystem system = pressed(1e3, strength * wave);
		const auto     steps  = stepOf(0.9999 * critical);
		double         fastest = 0;
		for (int i = 0; i < 20000; i++) {
			system.step(steps);
			fastest = std::max(fastest, std::abs(system.platens[0].velocity));
		}
		// of the first moment, the force on the platen's own nodes alone
		double mass = 0;
		for (const std::size_t v : system.platens[0].nodes)
			mass += system.motion.node.mass[v];
		EXPECT_LT(fastest, 10 * 1e3 * critical / mass) << strength;
	}
}

// σ = F/A, and the shortening of plane strain with free sides, F h (1 − ν²)/(E A)
TEST_P(Platen, comesToRestUnderItsForce)
{
	const double   force = 1e3, young = ElasticModuli { 30e9, 26e9 }.young();
	const double   ratio = (3 * 30e9 - 2 * 26e9) / (2 * (3 * 30e9 + 26e9));
	TriangleSystem system = pressed(force, std::sqrt(2400 * (30e9 + 4. / 3 * 26e9)) * width);
	StepSettings   steps  = stepOf(0.8 * critical);
	steps.damping         = 0.1;
	run(system, steps, 20000);
	EXPECT_NEAR(system.platens[0].force, force, 1e-6 * force);
	const std::size_t first = system.platens[0].nodes.front();
	const double      moved = height - system.motion.node.position[2 * first + 1];
	EXPECT_NEAR(moved, force * height * (1 - ratio * ratio) / (young * width), 1e-4 * moved);
	for (const std::size_t v : system.platens[0].nodes)
		EXPECT_NEAR(system.motion.node.position[2 * v + 1], height - moved, 1e-15);
}

// what is not damped: the platen's work minus its dashpot's and its own kinetic energy is that of the sample
TEST_P(Platen, isBookedAsWorkFromOutside)
{
	TriangleSystem system = pressed(1e3, 2e4);
	const auto     steps  = stepOf(0.9 * critical, true);
	double         first = 0, works = 0, gap = 0, size = 0;
	for (int i = 0; i < 2000; i++) {
		const StepEnergy e      = system.step(steps);
		const double     stored = e.kinetic + e.elastic + e.rotation;
		if (i == 0) first = stored;
		else
			works += e.externalWork;
		gap  = std::max(gap, std::abs(stored - first - works));
		size = std::max(size, std::abs(stored));
	}
	EXPECT_LT(gap, 1e-5 * size); // frames turn by the strain, 4e-7
}

TEST_P(Platen, keepsItsLimitAndBeginsFromTheForceItFinds)
{
	TriangleSystem system    = pressed(1e9, 0);
	system.platens[0].limit  = 0.01;
	run(system, stepOf(0.8 * critical), 100);
	EXPECT_TRUE(system.platens[0].limited);
	EXPECT_EQ(system.platens[0].velocity, 0.01);
	RigidPlaten& platen = system.platens[0];
	platen.limit        = 100;
	platen.begins       = true;
	platen.share        = 0;
	system.step(stepOf(0.8 * critical));
	EXPECT_FALSE(platen.limited);
	EXPECT_NEAR(platen.velocity, 0.01, 1e-12); // no jolt
	EXPECT_NEAR(platen.from, platen.force, 1e-9 * platen.force);
}

} // namespace
