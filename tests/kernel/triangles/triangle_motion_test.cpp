// GPL v2 or later, see LICENSE.
// Motion of the triangle system: critical step, free flight, loads, rigid spin, damping.
#include "../TriangleSamples.hpp"

#include <gtest/gtest.h>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::samples;

struct Momentum {
	double x = 0, y = 0, angular = 0; ///< [kg·m/s], [kg·m²/s] about the origin
	double size = 0, angularSize = 0; ///< sums of absolute values, to judge round-off
};

Momentum momentumOf(const TriangleSystem& s)
{
	Momentum p;
	for (const Points* points : { &s.motion.node, &s.motion.core })
		for (std::size_t i = 0; i < points->size(); i++) {
			const double m = points->mass[i];
			const Point  x { points->position[2 * i], points->position[2 * i + 1] },
			        v { points->velocity[2 * i], points->velocity[2 * i + 1] };
			p.x += m * v.x;
			p.y += m * v.y;
			p.angular += m * cross(x, v);
			p.size += m * std::hypot(v.x, v.y);
			p.angularSize += m * std::hypot(x.x, x.y) * std::hypot(v.x, v.y);
		}
	for (std::size_t i = 0; i < s.motion.spin.size(); i++)
		p.angular += s.motion.spin.inertia[i] * s.motion.spin.velocity[i];
	return p;
}

class TriangleMotion : public testing::TestWithParam<RotationTreatment> { };
INSTANTIATE_TEST_SUITE_P(, TriangleMotion, testing::ValuesIn(allTreatments), [](const auto& test) {
	return name(test.param);
});

TEST_P(TriangleMotion, isStableJustBelowTheCriticalStepAndNotJustAbove) // the bound is sharp for a free triangle
{
	Random random(41);
	for (int i = 0; i < 5; i++) {
		const Vertices corners  = random.skewedTriangle();
		const Mesh     mesh     = single(corners);
		const double critical = criticalStep(mesh, Material(), GetParam()),
		             size = std::sqrt(makeReference(corners).area());
		const auto     largestStrain = [&](double fraction, int steps) {
                        TriangleSystem system = makeSystem(mesh, Material(), GetParam());
                        agitate(system, 1e-9 * size / critical, 1e-9 / critical, 42);
                        double worst = 0;
                        for (int step = 0; step < steps; step++) {
                                system.step(stepOf(fraction * critical));
                                for (const auto& strain : system.strain(0))
					worst = std::max({ worst, std::abs(strain.xx), std::abs(strain.yy),
					                   std::abs(strain.xy) });
			}
                        return worst;
		};
		// At 0.99 the leapfrog's own invariant allows amplitudes up to 1/√(1 − 0.99²) = 7 times those of the
		// exact motion; the triangle may be a sliver (20).
		EXPECT_LT(largestStrain(0.99, 20000), 7 * 20 * 1e-9 * 3) << "triangle " << i;
		// Above, growth per step is exp(2 acosh 1.01) = 1.33: 1e8 in 64 steps.
		EXPECT_GT(largestStrain(1.01, 100), 1e-4) << "triangle " << i;
	}
}

TEST_P(TriangleMotion, conservesMomentumInFreeFlight)
{
	const Mesh     mesh   = rectangle(5, 8, 0.05, 0.08, 0.25, 2);
	TriangleSystem system = makeSystem(mesh, Material(), GetParam());
	agitate(system, 5, 500, 43); // strains of 1e-3
	for (auto* velocity : { &system.motion.node.velocity, &system.motion.core.velocity })
		for (std::size_t i = 0; i < velocity->size(); i += 2)
			(*velocity)[i] += 20;
	const Momentum before = momentumOf(system);
	run(system, stepOf(0.9 * criticalStep(mesh, Material(), GetParam())), 2000);
	const Momentum after = momentumOf(system);
	EXPECT_NEAR(after.x, before.x, 1e-12 * before.size);
	EXPECT_NEAR(after.y, before.y, 1e-12 * before.size);
	if (GetParam() == RotationTreatment::None) return; // R = 1 balances angular momentum at small rotations only
	EXPECT_NEAR(after.angular, before.angular, 1e-12 * before.angularSize);
}

TEST_P(TriangleMotion, fallsOnAParabola) // leapfrog from rest: x_n = g dt² n(n+1)/2, exactly
{
	const Mesh     mesh   = rectangle(3, 3, 0.03, 0.03, 0.25, 3);
	TriangleSystem system = makeSystem(mesh, Material(), GetParam()), start = system;
	StepSettings   settings = stepOf(0.5 * criticalStep(mesh, Material(), GetParam()));
	settings.gravity        = { 3e4, -9e4 };
	const int    steps      = 1000;
	const double fall       = settings.dt * settings.dt * steps * (steps + 1) / 2;
	run(system, settings, steps);
	for (const auto& [now, then] :
	     { std::pair(&system.motion.node, &start.motion.node), { &system.motion.core, &start.motion.core } })
		for (std::size_t i = 0; i < now->size(); i++) {
			EXPECT_NEAR(now->position[2 * i], then->position[2 * i] + 3e4 * fall, 1e-11 * 9e4 * fall);
			EXPECT_NEAR(
			        now->position[2 * i + 1], then->position[2 * i + 1] - 9e4 * fall, 1e-11 * 9e4 * fall);
		}
	EXPECT_LT(largest(system.motion.spin.angle), 1e-10);
}

// from rest half a step early: x = g t (t + dt_0)/2 exactly
TEST_P(TriangleMotion, fallsOnTheSameParabolaWithStepsThatChange)
{
	const Mesh     mesh   = rectangle(3, 3, 0.03, 0.03, 0.25, 3);
	TriangleSystem system = makeSystem(mesh, Material(), GetParam()), start = system;
	const double   limit  = criticalStep(mesh, Material(), GetParam());
	StepSettings   settings = stepOf(0);
	settings.gravity        = { 0, -9e4 };
	settings.energy         = true;
	Random random(45);
	double time = 0, first = 0, gained = 0, kinetic = 0;
	for (int i = 0; i < 1000; i++) {
		settings.dt = limit * random.uniform(0.1, 0.9);
		if (i == 0) first = settings.dt;
		const StepEnergy energy = system.step(settings); // at the positions before the step
		gained += energy.gravityWork;
		kinetic = energy.kinetic;
		if (i < 999) time += settings.dt;
	}
	const double end  = time + settings.dt, fall = 0.5 * end * (end + first);
	for (const auto& [now, then] :
	     { std::pair(&system.motion.node, &start.motion.node), { &system.motion.core, &start.motion.core } })
		for (std::size_t i = 0; i < now->size(); i++)
			EXPECT_NEAR(
			        now->position[2 * i + 1], then->position[2 * i + 1] - 9e4 * fall, 1e-10 * 9e4 * fall);
	// the leapfrog's product differs from ½ m v² by the square of one step in a thousand, and that only once
	EXPECT_NEAR(gained, kinetic, 2e-3 * kinetic);
}

TEST_P(TriangleMotion, gainsTheImpulseOfForcesFromOutside)
{
	const Mesh     mesh   = rectangle(3, 3, 0.03, 0.03, 0.25, 4);
	TriangleSystem system = makeSystem(mesh, Material(), GetParam());
	Random         random(44);
	double         x = 0, y = 0;
	for (Points* points : { &system.motion.node, &system.motion.core }) {
		points->external.resize(2 * points->size());
		for (std::size_t i = 0; i < points->size(); i++) {
			x += points->external[2 * i]     = random.uniform(-1e4, 1e4);
			y += points->external[2 * i + 1] = random.uniform(-1e4, 1e4);
		}
	}
	StepSettings settings = stepOf(0.5 * criticalStep(mesh, Material(), GetParam()));
	settings.external     = true;
	run(system, settings, 200);
	const Momentum now = momentumOf(system);
	EXPECT_NEAR(now.x, x * 200 * settings.dt, 1e-12 * now.size);
	EXPECT_NEAR(now.y, y * 200 * settings.dt, 1e-12 * now.size);

	settings.external = false; // the switch, not the list, decides
	run(system, settings, 50);
	EXPECT_NEAR(momentumOf(system).x, now.x, 1e-12 * now.size);
}

TEST_P(TriangleMotion, blockedDegreesOfFreedomKeepTheirVelocity)
{
	const Mesh     mesh         = rectangle(3, 3, 0.03, 0.03, 0.25, 5);
	TriangleSystem system       = makeSystem(mesh, Material(), GetParam());
	system.motion.node.inverseMass[6]  = 0;
	system.motion.node.velocity[6]     = 2.5;
	system.motion.core.inverseMass[11] = 0;
	if (system.motion.spin.size()) {
		system.motion.spin.inverseInertia[4] = 0;
		system.motion.spin.velocity[4]       = -30;
	}
	const double start = system.motion.node.position[6], core = system.motion.core.position[11],
	             dt = 0.5 * criticalStep(mesh, Material(), GetParam());
	StepSettings settings = stepOf(dt);
	settings.gravity      = { 9.81, -9.81 };
	settings.damping      = 0.3;
	run(system, settings, 100);
	EXPECT_EQ(system.motion.node.velocity[6], 2.5);
	EXPECT_NEAR(system.motion.node.position[6], start + 2.5 * 100 * dt, 1e-15);
	EXPECT_EQ(system.motion.core.velocity[11], 0);
	EXPECT_EQ(system.motion.core.position[11], core);
	if (system.motion.spin.size()) {
		EXPECT_EQ(system.motion.spin.velocity[4], -30);
		EXPECT_NEAR(system.motion.spin.angle[4], -30 * 100 * dt, 1e-15);
	}
}

// cundallDamp2nd: a (1 − d sign(a (v + a dt/2))); it slows a fall and hastens the end of a rise
TEST_P(TriangleMotion, dampingIsThatOfNewtonIntegrator)
{
	const double dt = 1e-7, g = -1e5, damping = 0.2;
	const Mesh   mesh      = rectangle(2, 2, 0.02, 0.02, 0.25, 6);
	StepSettings settings  = stepOf(dt);
	settings.gravity       = { 0, g };
	settings.damping       = damping;
	TriangleSystem falling = makeSystem(mesh, Material(), GetParam()), rising = falling;
	for (auto* velocity : { &rising.motion.node.velocity, &rising.motion.core.velocity })
		for (std::size_t i = 1; i < velocity->size(); i += 2)
			(*velocity)[i] = 100;
	run(falling, settings, 100);
	run(rising, settings, 100);
	for (const double v : { falling.motion.node.velocity[1], falling.motion.core.velocity[1] })
		EXPECT_NEAR(v, 0.8 * g * 100 * dt, 1e-9);
	for (const double v : { rising.motion.node.velocity[1], rising.motion.core.velocity[1] })
		EXPECT_NEAR(v, 100 + 1.2 * g * 100 * dt, 1e-9);
}

TEST(CoreSpin, feelsMomentsFromOutside) // a moment on a core goes over to the whole body
{
	const Mesh     mesh     = rectangle(3, 3, 0.03, 0.03, 0.25, 7);
	TriangleSystem system   = makeSystem(mesh, Material(), RotationTreatment::Cosserat);
	system.motion.spin.external    = std::vector<double>(system.motion.spin.size(), 0.);
	system.motion.spin.external[7] = 3;
	StepSettings settings   = stepOf(0.5 * criticalStep(mesh, Material(), RotationTreatment::Cosserat));
	settings.external       = true;
	run(system, settings, 500);
	const Momentum now = momentumOf(system);
	EXPECT_NEAR(now.angular, 3 * 500 * settings.dt, 1e-11 * (3 * 500 * settings.dt + now.angularSize));
	EXPECT_GT(
	        std::abs(now.angular), 100 * std::abs(system.motion.spin.inertia[7] * system.motion.spin.velocity[7]));
}

/// A block that turns about its centre as a rigid body.
TriangleSystem spinningBlock(const Mesh& mesh, double size, double speed, double dt, RotationTreatment rotation)
{
	TriangleSystem system = makeSystem(mesh, Material(), rotation);
	for (Points* points : { &system.motion.node, &system.motion.core })
		for (std::size_t i = 0; i < points->size(); i++) {
			// velocities live half a step before positions, on the chord of the circle
			const double x = points->position[2 * i] - size / 2, y = points->position[2 * i + 1] - size / 2,
			             angle = speed * dt;
			points->velocity[2 * i]     = (x * (1 - std::cos(angle)) - y * std::sin(angle)) / dt;
			points->velocity[2 * i + 1] = (x * std::sin(angle) + y * (1 - std::cos(angle))) / dt;
		}
	for (double& w : system.motion.spin.velocity)
		w = speed;
	return system;
}

TEST_P(TriangleMotion, rigidSpinThroughARadianAndAHalf)
{
	if (GetParam() == RotationTreatment::None) return; // it is for small rotations
	const double   size = 0.01, speed = 2000, angle = 1.5;
	const Mesh     mesh   = rectangle(4, 4, size, size, 0.25, 8);
	const int      steps  = int(std::ceil(angle / speed / (0.5 * criticalStep(mesh, Material(), GetParam()))));
	const double   dt     = angle / speed / steps;
	TriangleSystem system = spinningBlock(mesh, size, speed, dt, GetParam()), start = system;
	double         virial = 0, inertia = 0; // ∫ tr σ dV over time; ∫ ρ r² dV
	for (int i = 0; i < steps; i++) {
		system.step(stepOf(dt));
		for (std::size_t t = 0; t < system.triangles(); t++)
			for (const auto& stress : system.stress(t))
				virial += (stress.xx + stress.yy) * system.topology.reference(t).area() / 3 / steps;
	}
	for (const Points* points : { &start.motion.node, &start.motion.core })
		for (std::size_t i = 0; i < points->size(); i++)
			inertia += points->mass[i]
			        * (std::pow(points->position[2 * i] - size / 2, 2)
			           + std::pow(points->position[2 * i + 1] - size / 2, 2));
	double meanTurn = 0;
	for (std::size_t t = 0; t < system.triangles(); t++) {
		EXPECT_NEAR(system.frameAngle(t), angle, 1e-4); // waves of the sudden centrifugal force
		meanTurn += system.frameAngle(t) / double(system.triangles());
	}
	EXPECT_NEAR(meanTurn, angle, 1e-5);
	// Only the physical centrifugal stress: virial theorem, the mean of ∫ tr σ dV is twice the kinetic energy,
	// ω² ∫ ρ r² dV
	EXPECT_NEAR(virial, speed * speed * inertia, 0.05 * speed * speed * inertia);
}

} // namespace
