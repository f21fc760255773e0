// GPL v2 or later, see LICENSE.
// Frictional contact: springs, static and dynamic friction, conservation.
#include <pkg/bonded/kernel/BondContact.hpp>
#include <pkg/bonded/kernel/BondDamping.hpp>
#include <pkg/bonded/kernel/BondWall.hpp>

#include <gtest/gtest.h>

#include <random>

namespace {

using namespace yade::ddem;
using Eigen::Vector3d;

/// Two spheres of 1 mm with the constants of ESyS-Particle's tutorial, 2 µm into each other, sliding in steps of 10 nm.
class SlidingContact : public testing::Test {
protected:
	const BondElasticity   elasticity { 100e9, 0.25 };
	const ContactStiffness stiffness = contactStiffness(elasticity, 2e-3);
	ContactFriction        friction { 0.6, 0.4 };
	ContactMotion motion { Vector3d::UnitX(), 1.998e-3,        1e-3, 1e-3, Vector3d(0, 0.01 * 1.998 / 2, 0),
		               Vector3d::Zero(),  Vector3d::Zero() };
	const double           dt = 1e-6;
	ContactMemory          memory;

	ContactLoads step() { return contactLoads(stiffness, friction, motion, dt, memory); }
};

TEST_F(SlidingContact, hasTheSpringsOfTheBondItReplaces)
{
	const BondStiffness bond = bondStiffness(elasticity, BondSection(1e-3), 2e-3);
	EXPECT_DOUBLE_EQ(stiffness.normal, bond.normal);
	EXPECT_DOUBLE_EQ(stiffness.shear, bond.shear);
}

TEST_F(SlidingContact, sticksUntilStaticFrictionThenSlidesWithDynamic)
{
	const double normal = 314.159265; // π E R/2 · 2 µm;
	                                  // ESyS-Particle 2.3.5 gives 188.50 N at the limit and 125.66 N after it
	for (int i = 1; i < 300; i++) {   // the limit is 300 steps of slip
		const double expected = stiffness.shear * 1e-8 * i;
		EXPECT_NEAR(step().force.y(), expected * 2 / 1.998, 1e-9 * expected) << i;
	}
	EXPECT_NEAR(memory.shear.norm() * 300 / 299, 188.50, 0.01);
	EXPECT_FALSE(memory.sliding);
	step();
	for (int i = 0; i < 500; i++) { // no saw-tooth: the contact remembers that it slides
		step();
		EXPECT_NEAR(memory.shear.norm(), 0.4 * normal, 1e-6);
		EXPECT_TRUE(memory.sliding);
	}
}

TEST_F(SlidingContact, dissipatesTheWorkOfSliding)
{
	friction        = { 0.4, 0.4 };
	const int slips = 400;
	double    lost = 0, stored = 0;
	for (int i = 0; i < slips; i++) {
		const ContactLoads loads = step();
		lost += loads.dissipated;
		stored = loads.energy;
	}
	const double normal = 0.5 * stiffness.normal * 4e-12, limit = 0.4 * stiffness.normal * 2e-6;
	EXPECT_NEAR(stored, normal + 0.5 * limit * limit / stiffness.shear, 1e-9 * stored);
	EXPECT_NEAR(lost + stored - normal, limit * (slips * 1e-8 - 0.5 * limit / stiffness.shear), 1e-9 * lost);
}

TEST_F(SlidingContact, forgetsSlipWhenItOpens)
{
	for (int i = 0; i < 320; i++)
		step();
	motion.distance = 2.0001e-3;
	EXPECT_EQ(step().force, Vector3d::Zero());
	motion.distance = 1.998e-3;
	EXPECT_NEAR(step().force.y(), stiffness.shear * 1e-8, 1e-2 * stiffness.shear * 1e-8);
	EXPECT_FALSE(memory.sliding);
}

TEST_F(SlidingContact, normalCyclesLeaveNoTangentialForce)
{
	motion.relativeVelocity = { 1e-3, 0, 0 };
	memory.normal           = motion.normal;
	memory.shear            = { 0, 10, 0 };
	for (int i = 0; i < 1000; i++) {
		motion.relativeVelocity.x() *= -1;
		motion.distance += 1e-9 * (i % 2 ? 1 : -1);
		step();
	}
	EXPECT_NEAR((memory.shear - Vector3d(0, 10, 0)).norm(), 0, 1e-12);
}

TEST_F(SlidingContact, rollingDoesNotSlip)
{
	motion.radius2          = 2e-3;
	motion.distance         = 2.998e-3;
	motion.relativeVelocity = Vector3d::Zero();
	motion.angularVelocity1 = { 0, 0, 2 };
	motion.angularVelocity2 = { 0, 0, -1 };
	EXPECT_NEAR(step().force.tail<2>().norm(), 0, 1e-15);
}

// eq. 7 of the report: F_T = μ F_N (1 - (1 - |δ|/δ_max)^{3/2}), then dynamic friction
TEST_F(SlidingContact, growsGraduallyWhereAsked)
{
	friction             = { 0.6, 0.4, true };
	// π E R/2 · 2 µm; δ_max = 3 μ F_N/(2 k_s)
	const double normal  = 314.159265, largest = 1.5 * 0.6 * normal / stiffness.shear;
	const int    sliding = int(std::ceil(largest / 1e-8));                           // steps of 10 nm
	for (int i = 1; i < sliding; i++) {
		step();
		EXPECT_NEAR(memory.force, 0.6 * normal * (1 - std::pow(1 - i * 1e-8 / largest, 1.5)), 1e-6 * normal)
		        << i;
		if (i == 1) {
			// starts as stiff as the linear law
			EXPECT_NEAR(memory.force, stiffness.shear * 1e-8, 2e-3 * memory.force);
		}
	}
	EXPECT_FALSE(memory.sliding);
	for (int i = 0; i < 100; i++) {
		step();
		EXPECT_TRUE(memory.sliding);
		EXPECT_NEAR(memory.force, 0.4 * normal, 1e-6 * normal);
	}
	motion.relativeVelocity *= -1; // back: it unloads along the same curve
	const double before = memory.force;
	step();
	EXPECT_LT(memory.force, before);
	EXPECT_TRUE(memory.sliding);
}

/// Speed after over speed before a collision of two equal free spheres, head-on or past each other without friction,
/// of a given damping ratio.
double restitution(double ratio)
{
	const double           mass = 2e-5, dt = 1e-9; // reduced mass mass/2
	const ContactStiffness stiffness = contactStiffness({ 100e9, 0.25 }, 2e-3);
	const ContactDamping   damping { 2 * ratio * std::sqrt(mass / 2 * stiffness.normal), 0 };
	ContactMemory          memory;
	double                 distance = 2e-3 - 1e-15, opening = -1, energy = mass / 2 * 0.5, lost = 0;
	for (bool touching = true; touching;) {
		const ContactLoads l = contactLoads(
		        stiffness, { 0, 0 },
		        { Vector3d::UnitX(),
		          distance,
		          1e-3,
		          1e-3,
		          { opening, 0, 0 },
		          Vector3d::Zero(),
		          Vector3d::Zero() },
		        dt, memory, damping);
		touching = l.touching;
		lost += l.damped;
		opening -= 2 * l.force.x() / mass * dt;
		distance += opening * dt;
	}
	EXPECT_NEAR(lost, energy - mass / 2 * 0.5 * opening * opening, 2e-3 * energy) << "energy book at ζ = " << ratio;
	return opening;
}

// e = exp(-πζ/√(1-ζ²)) where the contact ends with the overlap's half period
TEST(ContactDamping, givesTheRestitutionOfALinearDashpot)
{
	for (const double ratio : { 0., 0.05, 0.2, 0.5 })
		EXPECT_NEAR(restitution(ratio), std::exp(-M_PI * ratio / std::sqrt(1 - ratio * ratio)), 2e-3) << ratio;
}

TEST_F(SlidingContact, isDampedWhileItSticksOnly)
{
	const ContactDamping damping { 0, 3 };
	const ContactLoads   sticking = contactLoads(stiffness, friction, motion, dt, memory, damping);
	EXPECT_NEAR(memory.viscousShear.y(), 3 * 0.01, 1e-12); // c_t times the slip rate of the surfaces
	EXPECT_NEAR(sticking.force.y() * 1.998 / 2, memory.shear.y() + 0.03, 1e-12);
	for (int i = 0; i < 400; i++)
		contactLoads(stiffness, friction, motion, dt, memory, damping);
	EXPECT_TRUE(memory.sliding);
	EXPECT_EQ(memory.viscousShear, Vector3d::Zero());
}

class WorkOfAContact : public SlidingContact, public testing::WithParamInterface<std::pair<bool, ContactDamping>> { };

// a random motion of unequal spheres; the sum misses only the trapezoidal rule's error
TEST_P(WorkOfAContact, goesIntoSpringsFrictionAndDamping)
{
	friction.gradual = GetParam().first;
	std::mt19937_64                        engine { 3 };
	std::uniform_real_distribution<double> unit { -1, 1 };
	const auto vector = [&] { return Vector3d(unit(engine), unit(engine), unit(engine)); };
	double                                 error[2];
	for (int refined : { 0, 1 }) {
		engine.seed(3);
		memory                    = ContactMemory();
		const double   h          = refined ? 1e-8 : 2e-8;
		const Vector3d amplitude1 = vector(), amplitude2 = vector(), amplitude3 = vector();
		Vector3d       branch(3e-3 - 4e-6, 0, 0), oldForce = Vector3d::Zero(), oldMoment1 = Vector3d::Zero(),
		                                    oldMoment2 = Vector3d::Zero();
		double         work = 0, lost = 0, stored = 0, start = -1;
		motion.radius2 = 2e-3;
		for (double t = 0; t < 1e-4; t += h) {
			const double phase      = 2e5 * (t - h / 2);
			motion.relativeVelocity = 0.3 * amplitude1 * std::cos(phase);
			motion.angularVelocity1 = 2000 * amplitude2 * std::sin(0.7 * phase);
			motion.angularVelocity2 = 3000 * amplitude3 * std::cos(0.3 * phase);
			branch += motion.relativeVelocity * h;
			motion.distance      = branch.norm();
			motion.normal        = branch / motion.distance;
			const ContactLoads l = contactLoads(stiffness, friction, motion, h, memory, GetParam().second);
			ASSERT_GT(l.energy, 0);
			if (start >= 0) {
				work -= 0.5 * h
				        * (-(l.force + oldForce).dot(motion.relativeVelocity)
				           + (l.moment1 + oldMoment1).dot(motion.angularVelocity1)
				           + (l.moment2 + oldMoment2).dot(motion.angularVelocity2));
				lost += l.dissipated + l.damped;
			} else
				start = l.energy;
			stored     = l.energy;
			oldForce   = l.force;
			oldMoment1 = l.moment1;
			oldMoment2 = l.moment2;
			EXPECT_LT((l.moment1 + l.moment2 - branch.cross(l.force)).norm(), 1e-15 * (l.force.norm()));
			// the gradual law stores and gives back a little when the normal force changes
			if (!friction.gradual) {
				EXPECT_GE(l.dissipated, -1e-12 * stored);
			}
		}
		EXPECT_GT(lost, 0.1 * stored);
		error[refined] = std::abs(start + work - lost - stored) / lost;
	}
	EXPECT_LT(error[1], 1e-3);
	EXPECT_LT(error[1], 0.6 * error[0]);
}

INSTANTIATE_TEST_SUITE_P(
        Laws,
        WorkOfAContact,
        testing::Values(
                std::make_pair(false, ContactDamping {}),
                std::make_pair(true, ContactDamping {}),
                std::make_pair(false, ContactDamping { 20, 10 }),
                std::make_pair(true, ContactDamping { 20, 10 })));

TEST(FollowContact, keepsTheLengthAndThePlane)
{
	const Vector3d from = Vector3d(1, 2, 3).normalized(), to = Vector3d(1.1, 1.9, 3.2).normalized(),
	               force  = from.cross(Vector3d::UnitX());
	const Vector3d turned = followContact(force, from, to, 0.1);
	EXPECT_NEAR(turned.norm(), force.norm(), 1e-15);
	EXPECT_NEAR(turned.dot(to), 0, 1e-15);
	EXPECT_NEAR(followContact(force, from, from, 1e-3).dot(force) / force.squaredNorm(), std::cos(1e-3), 1e-12);
}

TEST(WallRepulsion, isPiTimesRadiusTimesStiffnessTimesOverlap)
{
	// ESyS-Particle 2.3.5: radius 0.7 mm, K 1e5 N/mm², overlap 0.0014 mm gives 307.876 N
	EXPECT_NEAR(wallRepulsion(0.7e-3, 100e9, 0.7e-3 - 1.4e-6), 307.876, 1e-3);
	EXPECT_EQ(wallRepulsion(0.7e-3, 100e9, 0.7e-3), 0);
	EXPECT_EQ(wallRepulsion(0.7e-3, 100e9, 1), 0);
}

TEST(BondedWall, isASpringInBothDirections)
{
	const SpaceVector<double> normal { 0, -1, 0 }, displacement { 2e-6, 3e-6, -1e-6 };
	const auto                force = bondedWallForce(0.7e-3, 100e9, 40e9, displacement, normal);
	const double              along = M_PI * 0.7e-3 * 40e9, across = M_PI * 0.7e-3 * 100e9;
	EXPECT_NEAR(force.x, -along * 2e-6, 1e-9);
	EXPECT_NEAR(force.y, -across * 3e-6, 1e-9);
	EXPECT_NEAR(force.z, along * 1e-6, 1e-9);
}

TEST(ViscousDamper, slowsDownExponentiallyAndBooksItsEnergyExactly)
{
	const double        mass = 2, viscosity = 5, dt = 1e-3, load = 0.3;
	const ViscousDamper damper(viscosity, dt);
	double              velocity = 1, lost = 0, pushed = 0;
	for (int i = 0; i < 1000; i++) {
		const double drag = damper.load(velocity, load, mass), next = velocity + dt * (load + drag) / mass,
		             mean = 0.5 * (velocity + next);
		EXPECT_NEAR(drag, -viscosity * mass * mean, 1e-12);
		lost += damper.loss(velocity, load, mass);
		pushed += load * mean * dt;
		velocity = next;
	}
	const double terminal = load / (viscosity * mass);
	EXPECT_NEAR(velocity, terminal + (1 - terminal) * std::exp(-viscosity), 1e-6);
	EXPECT_NEAR(0.5 * mass * velocity * velocity + lost - pushed, 0.5 * mass, 1e-12);
}

TEST(ViscousDamper, isStableHoweverStrong)
{
	double velocity = 1;
	for (int i = 0; i < 10; i++)
		velocity += ViscousDamper(1e9, 1).load(velocity, 0, 1);
	EXPECT_LE(std::abs(velocity), 1);
}

} // namespace
