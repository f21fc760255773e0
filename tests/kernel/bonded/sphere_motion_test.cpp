// GPL v2 or later, see LICENSE.
// Spheres in arrays move as Newton's law by leapfrog says, whatever the instruction set and the number of threads.
#include <pkg/bonded/kernel/BondDamping.hpp>
#include <pkg/bonded/kernel/SphereLoopBodies.hpp>
#include <pkg/bonded/kernel/SphereLoops.hpp>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <omp.h>

#include <cmath>
#include <limits>
#include <random>

namespace {

using namespace yade::ddem;
using Vector     = Eigen::Vector3d;
using Quaternion = Eigen::Quaterniond;

struct Scalar;

Vector first(const double* row) { return { row[0], row[1], row[2] }; }
Vector second(const double* row) { return { row[4], row[5], row[6] }; }

/// Spheres with random loads, velocities and orientations.
SphereMotion sample(std::size_t count)
{
	std::mt19937_64                        engine(3);
	std::uniform_real_distribution<double> unit(-1, 1);
	SphereMotion                           m;
	m.resize(count);
	for (std::size_t p = 0; p < count; p++) {
		m.setMass(p, 1.5 + unit(engine), 0.3 + 0.2 * unit(engine));
		const Quaternion q = Quaternion(unit(engine), unit(engine), unit(engine), unit(engine)).normalized();
		const double     turn[4] = { q.w(), q.x(), q.y(), q.z() };
		for (int k = 0; k < 3; k++) {
			m.poseOf(p)[k]         = unit(engine);
			m.velocityOf(p)[k]     = unit(engine);
			m.velocityOf(p)[4 + k] = unit(engine);
			m.loadOf(p)[k]         = unit(engine);
			m.loadOf(p)[4 + k]     = unit(engine);
		}
		std::copy_n(turn, 4, m.poseOf(p) + 4);
	}
	return m;
}

TEST(SphereMotion, followsNewtonsLaw)
{
	for (const double dt : { 1e-6, 1e-2, 3. }) { // the last one turns beyond the series
		SCOPED_TRACE(dt);
		SphereMotion       m = sample(11);
		const SphereMotion b = m;
		SphereStep         step;
		step.dt         = dt;
		step.gravity[1] = -9.81;
		const SphereSums sums = m.step(step);
		EXPECT_TRUE(sums.finite);
		double fastest = 0;
		for (std::size_t p = 0; p < m.size(); p++) {
			const Vector v = first(b.velocityOf(p))
			        + dt * (first(b.loadOf(p)) / b.massOf(p) + Vector(0, -9.81, 0)),
			             w = second(b.velocityOf(p)) + dt * second(b.loadOf(p)) / b.inertiaOf(p);
			EXPECT_NEAR((first(m.velocityOf(p)) - v).norm(), 0, 1e-14 * (1 + v.norm()));
			EXPECT_NEAR((second(m.velocityOf(p)) - w).norm(), 0, 1e-14 * (1 + w.norm()));
			EXPECT_NEAR(
			        (first(m.poseOf(p)) - first(b.poseOf(p)) - dt * v).norm(), 0,
			        1e-14 * (1 + dt * v.norm()));
			const double* const q = b.poseOf(p) + 4;
			const Quaternion    turned = Quaternion(Eigen::AngleAxisd(dt * w.norm(), w.normalized()))
			        * Quaternion(q[0], q[1], q[2], q[3]);
			const double* const r = m.poseOf(p) + 4;
			EXPECT_NEAR(std::abs(turned.dot(Quaternion(r[0], r[1], r[2], r[3]))), 1, 1e-14);
			EXPECT_NEAR((turned.coeffs() - Quaternion(r[0], r[1], r[2], r[3]).coeffs()).norm(), 0, 2e-13);
			fastest = std::max(fastest, v.squaredNorm());
		}
		EXPECT_DOUBLE_EQ(sums.speedSquared, fastest);
	}
}

TEST(SphereMotion, keepsTheLawOfEnergy)
{
	// kinetic energy of leapfrog, v(-½)·v(+½)/2, changes from one instant to the next by the work of the mean loads
	SphereMotion m = sample(37);
	SphereStep   step;
	step.dt         = 1e-3;
	step.gravity[2] = 3;
	step.damping    = 0.3;
	step.energy     = true;
	SphereSums sums = m.step(step);
	for (int n = 0; n < 20; n++) {
		double work = 0; // of the same loads in the half steps before and after an instant
		for (std::size_t p = 0; p < m.size(); p++)
			work += step.dt
			        * (first(m.loadOf(p)).dot(first(m.velocityOf(p)))
			           + second(m.loadOf(p)).dot(second(m.velocityOf(p))));
		const SphereSums next = m.step(step);
		const double     gain = next.translation + next.rotation - sums.translation - sums.rotation;
		EXPECT_NEAR(
		        gain,
		        work + 0.5 * (sums.gravityWork + next.gravityWork)
		                - 0.5 * (sums.dampingLoss + next.dampingLoss),
		        1e-3 * std::abs(work));
		sums = next;
	}
}

TEST(SphereMotion, leavesWhatIsBlocked)
{
	for (unsigned axes = 0; axes < 64; axes++) {
		SphereMotion m = sample(5);
		m.block(3, axes);
		const SphereMotion b = m;
		SphereStep         step;
		step.dt         = 1e-3;
		step.damping    = 0.2;
		step.gravity[0] = step.gravity[1] = step.gravity[2] = 5;
		m.step(step);
		for (int c = 0; c < 3; c++) {
			EXPECT_EQ(m.velocityOf(3)[c] == b.velocityOf(3)[c], bool(axes & (1u << c)));
			EXPECT_EQ(m.velocityOf(3)[4 + c] == b.velocityOf(3)[4 + c], bool(axes & (8u << c)));
			EXPECT_NE(m.velocityOf(4)[c], b.velocityOf(4)[c]);
		}
	}
}

TEST(SphereMotion, hasNoHoldOnWhatHasNoMass)
{
	SphereMotion m = sample(5);
	m.setMass(2, 0, 0);
	const Vector v = first(m.velocityOf(2)), x = first(m.poseOf(2));
	SphereStep   step;
	step.dt         = 0.1;
	step.gravity[0] = 5;
	step.energy     = true;
	m.step(step);
	EXPECT_EQ(first(m.velocityOf(2)), v);
	EXPECT_NEAR((first(m.poseOf(2)) - x - 0.1 * v).norm(), 0, 1e-15);
}

TEST(SphereMotion, noticesWhatIsNotANumber)
{
	for (const double bad : { std::nan(""), std::numeric_limits<double>::infinity() })
		for (const std::size_t p : { 0, 1, 6 }) {
			SphereMotion m = sample(7);
			m.loadOf(p)[1] = bad;
			SphereStep step;
			step.dt = 1e-3;
			EXPECT_FALSE(m.step(step).finite);
		}
}

TEST(SphereMotion, dragIsThatOfTheDamper)
{
	SphereMotion        m = sample(300);
	const SphereMotion  b = m;
	const double        dt = 0.1;
	const ViscousDamper linear(2, dt), angular(3, dt);
	const double        loss     = m.drag(2, 3, dt, true);
	double              expected = 0;
	for (std::size_t p = 0; p < m.size(); p++)
		for (int c = 0; c < 3; c++) {
			const double v = b.velocityOf(p)[c], w = b.velocityOf(p)[4 + c], f = b.loadOf(p)[c],
			             t = b.loadOf(p)[4 + c];
			EXPECT_EQ(m.loadOf(p)[c], f + linear.load(v, f, b.massOf(p)));
			EXPECT_EQ(m.loadOf(p)[4 + c], t + angular.load(w, t, b.inertiaOf(p)));
			expected += linear.loss(v, f, b.massOf(p)) + angular.loss(w, t, b.inertiaOf(p));
		}
	EXPECT_NEAR(loss, expected, 1e-12 * std::abs(expected));
}

TEST(SphereMotion, doesNotDependOnThreadsAndInstructions)
{
	SphereStep step;
	step.dt      = 0.05;
	step.damping = 0.2;
	step.energy  = true;
	const int           threads = omp_get_max_threads();
	std::vector<double> pose;
	SphereSums          sums;
	for (const int n : { 1, 2, 3 }) {
		omp_set_num_threads(n);
		SphereMotion     m     = sample(1000);
		const SphereSums found = m.step(step);
		if (n == 1) {
			pose = m.pose;
			sums = found;
		}
		EXPECT_EQ(m.pose, pose);
		EXPECT_EQ(found.translation, sums.translation);
		EXPECT_EQ(found.rotation, sums.rotation);
		EXPECT_EQ(found.dampingLoss, sums.dampingLoss);
	}
	omp_set_num_threads(threads);
	// one by one, without wide registers
	SphereMotion       m = sample(1000);
	std::vector<double> mass, inertia;
	for (std::size_t p = 0; p < m.size(); p++) {
		mass.push_back(m.massOf(p));
		inertia.push_back(m.inertiaOf(p));
	}
	const SphereArrays arrays { m.pose.data(), m.velocity.data(), m.load.data(),
		                    mass.data(),   inertia.data(),    nullptr };
	sphereLoopFor<Scalar, double>(SphereEffects::Damping | SphereEffects::Energy)(arrays, 0, m.size(), step);
	for (std::size_t k = 0; k < pose.size(); k++)
		EXPECT_NEAR(m.pose[k], pose[k], 1e-14);
}

} // namespace
