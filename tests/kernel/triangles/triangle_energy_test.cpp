// GPL v2 or later, see LICENSE.
// The energy book of the triangle system closes: kinetic + elastic + rotation energy changes by the
// works and the damping loss.
#include "../TriangleSamples.hpp"

#include <gtest/gtest.h>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::samples;

/// Sums up the book of a run and keeps the largest gap in it.
struct Book {
	double first = 0, works = 0, gap = 0, size = 0; ///< [J]; size: largest energy or sum of works seen
	double kinetic = 0, rotation = 0;               ///< largest seen
	bool   open = false;

	void add(const StepEnergy& e)
	{
		const double stored = e.kinetic + e.elastic + e.rotation;
		if (!open) first = stored; // works of the first step come before it
		else
			works += e.externalWork + e.gravityWork - e.dampingLoss;
		open     = true;
		gap      = std::max(gap, std::abs(stored - first - works));
		size     = std::max({ size, std::abs(stored), std::abs(works) });
		kinetic  = std::max(kinetic, e.kinetic);
		rotation = std::max(rotation, e.rotation);
	}
};

class TriangleEnergy : public testing::TestWithParam<RotationTreatment> {
protected:
	const Mesh   mesh = rectangle(5, 8, 0.05, 0.08, 0.25, 9);
	const double dt   = 0.9 * criticalStep(mesh, Material(), GetParam());

	/// Strains of about `strain`.
	TriangleSystem agitated(double strain) const
	{
		TriangleSystem system = makeSystem(mesh, Material(), GetParam());
		agitate(system, 5000 * strain, 5000 * strain / 0.005, 45);
		return system;
	}
	/** The leapfrog's product energy is exact for linear forces; those of a rotating frame are linear up to the
	 * strain itself. Positions carry round-off relative to the block,
	 * so small strains carry it relative to 1/strain. */
	double tolerance(double strain) const
	{
		return GetParam() == RotationTreatment::None ? 2e-14 / strain : 0.02 * strain;
	}
};
INSTANTIATE_TEST_SUITE_P(, TriangleEnergy, testing::ValuesIn(allTreatments), [](const auto& test) {
	return name(test.param);
});

TEST_P(TriangleEnergy, staysConstantInAnElasticBlock)
{
	for (const double strain : { 1e-2, 1e-4, 1e-6 }) {
		TriangleSystem system = agitated(strain);
		Book           book;
		for (int i = 0; i < 1000; i++)
			book.add(system.step(stepOf(dt, true)));
		EXPECT_LT(book.gap, tolerance(strain) * book.size) << "strain " << strain;
		EXPECT_GT(book.kinetic, 0.3 * book.size);
		if (GetParam() == RotationTreatment::Cosserat) {
			EXPECT_GT(book.rotation, 1e-3 * book.size);
		}
	}
}

// prescribed and released degrees of freedom, gravity, forces from outside, damping
TEST_P(TriangleEnergy, closesWithEveryEffect)
{
	const double   strain = 1e-4;
	TriangleSystem system = agitated(strain);
	Random         random(46);
	for (Points* points : { &system.motion.node, &system.motion.core })
		for (std::size_t i = 0; i < 2 * points->size(); i++)
			points->external.push_back(random.uniform(-1e4, 1e4));
	for (std::size_t i = 0; i < system.motion.spin.size(); i++)
		system.motion.spin.external.push_back(random.uniform(-1e2, 1e2));
	const auto block = [&](std::size_t row, bool blocked) {
		for (std::size_t i = 12 * row; i < 12 * (row + 1); i++)
			system.motion.node.inverseMass[i] = blocked ? 0 : 1 / system.motion.node.mass[i / 2];
		system.motion.collectConstraints();
	};
	block(0, true); // 6 nodes, x and y
	system.motion.core.inverseMass[41] = 0;
	if (system.motion.spin.size()) system.motion.spin.inverseInertia[20] = 0;
	system.motion.collectConstraints();
	StepSettings settings = stepOf(dt, true);
	settings.external     = true;
	settings.gravity      = { 2e3, -1e4 };
	settings.damping      = 0.05;
	Book       book;
	StepEnergy works;
	for (int i = 0; i < 1000; i++) {
		if (i == 300) block(8, true); // caught while it moves
		if (i == 500) block(0, false);
		if (i < 500)
			for (std::size_t j = 0; j < 12; j++)
				system.motion.node.velocity[j] = 0.5 * std::sin(0.02 * i + double(j));
		system.motion.core.velocity[41] = 0.3 * std::sin(0.05 * i);
		if (system.motion.spin.size()) system.motion.spin.velocity[20] = 10 * std::sin(0.03 * i);
		for (double& f : system.motion.node.external)
			f += random.uniform(-1e3, 1e3);
		const StepEnergy e = system.step(settings);
		book.add(e);
		works.externalWork += std::abs(e.externalWork);
		works.gravityWork += std::abs(e.gravityWork);
		works.dampingLoss += e.dampingLoss;
		EXPECT_GE(e.dampingLoss, -1e-12 * book.size);
	}
	EXPECT_LT(book.gap, tolerance(strain) * book.size);
	for (const double work : { works.externalWork, works.gravityWork, works.dampingLoss }) // each matters
		EXPECT_GT(work, 10 * tolerance(strain) * book.size);
}

TEST_P(TriangleEnergy, equalsTheWorkOfASlowCompression) // platen pushed in by δ: U = W, and U = ½ F δ
{
	TriangleSystem system = makeSystem(mesh, Material(), GetParam());
	const auto     nodes  = mesh.node.size();
	for (std::size_t v = 0; v < 6; v++) {
		system.motion.node.inverseMass[2 * v + 1]               = 0;
		system.motion.node.inverseMass[2 * (nodes - 6 + v) + 1] = 0;
	}
	system.motion.node.inverseMass[0] = 0;
	system.motion.collectConstraints();
	StepSettings settings = stepOf(dt, true);
	settings.damping      = 0.3;
	const int    steps    = 4000;
	const double depth    = 1e-6;
	Book         book;
	double       work = 0, damped = 0;
	StepEnergy   last;
	for (int i = 0; i <= 2 * steps; i++) {
		for (std::size_t v = nodes - 6; v < nodes; v++)
			system.motion.node.velocity[2 * v + 1] = i < steps ? -depth / (steps * dt) : 0;
		last = system.step(settings);
		book.add(last);
		work += last.externalWork;
		damped += last.dampingLoss;
	}
	double force = 0;
	for (std::size_t v = nodes - 6; v < nodes; v++)
		force += system.motion.node.force[2 * v + 1];
	EXPECT_NEAR(last.elastic + last.rotation, 0.5 * force * depth, 1e-3 * last.elastic);
	EXPECT_NEAR(last.elastic + last.rotation + last.kinetic + damped, work, 1e-3 * work);
	EXPECT_GT(work, 0);
	EXPECT_LT(last.kinetic, 1e-6 * last.elastic);
	EXPECT_LT(last.rotation, 1e-6 * last.elastic); // cores have turned until ε_φ = 0
}

TEST_P(TriangleEnergy, doesNotChangeTheMotion)
{
	TriangleSystem with = agitated(1e-3), without = with;
	StepSettings   settings = stepOf(dt);
	settings.gravity        = { 1, -9.81 };
	settings.damping        = 0.1;
	run(without, settings, 200);
	settings.energy = true;
	run(with, settings, 200);
	EXPECT_LT(largestDifference(with.motion.node.position, without.motion.node.position), 1e-15);
	EXPECT_LT(largestDifference(with.motion.spin.angle, without.motion.spin.angle), 1e-12);
}

TEST_P(TriangleEnergy, isLeftAtZeroWhenNotAskedFor)
{
	TriangleSystem   system = agitated(1e-3);
	const StepEnergy e      = system.step(stepOf(dt));
	EXPECT_EQ(e.kinetic + e.elastic + e.rotation + e.externalWork, 0);
}

TEST_P(TriangleEnergy, bookGoesOnAfterASave)
{
	const auto prepared = [&] {
		TriangleSystem system      = agitated(1e-4);
		system.motion.node.inverseMass[0] = 0;
		system.motion.node.velocity[0]    = 0.7;
		system.motion.collectConstraints();
		return system;
	};
	StepSettings settings = stepOf(dt, true);
	settings.gravity      = { 0, -9.81 };
	settings.damping      = 0.1;
	TriangleSystem whole = prepared(), first = prepared(), second = prepared();
	run(whole, settings, 50);
	run(first, settings, 50);
	second.motion.node = first.motion.node;
	second.motion.core = first.motion.core;
	second.motion.spin = first.motion.spin;
	second.motion.setBook(first.motion.book());
	const StepEnergy expected = whole.step(settings), got = second.step(settings);
	EXPECT_EQ(got.externalWork, expected.externalWork);
	EXPECT_EQ(got.gravityWork, expected.gravityWork);
	EXPECT_EQ(got.dampingLoss, expected.dampingLoss);
	EXPECT_EQ(got.elastic, expected.elastic);
	EXPECT_NE(expected.externalWork, 0);
	EXPECT_THROW(second.motion.setBook(Motion::Book()), std::logic_error);
}

} // namespace
