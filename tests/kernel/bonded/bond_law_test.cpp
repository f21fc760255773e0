// GPL v2 or later, see LICENSE.
// The elastic bond: closed forms, exact derivatives of one energy, momentum, objectivity.
#include "bond_samples.hpp"

#include <gtest/gtest.h>

#include <random>

namespace {

using namespace bond_samples;

constexpr double     young = 100e9, poisson = 0.25, shearModulus = 40e9;
const BondElasticity cement { young, poisson };

struct Pose {
	Vector     position    = Vector::Zero();
	Quaternion orientation = Quaternion::Identity();
};

Quaternion turn(double angle, const Vector& axis) { return Quaternion(Eigen::AngleAxisd(angle, axis.normalized())); }

/// A bond of radius 1 mm and length 2 mm along x between particles at rest.
class StraightBond : public testing::Test {
protected:
	static constexpr double radius = 1e-3, length = 2e-3;
	const BondSection       section { radius };
	const BondStiffness     stiffness = bondStiffness(cement, section, length);
	const Bond bond = join(stiffness, { length, 0, 0 }, Quaternion::Identity(), Quaternion::Identity());
	Pose                    one, two { { length, 0, 0 }, Quaternion::Identity() };

	Loads loads() const { return loadsOf(bond, two.position - one.position, one.orientation, two.orientation); }
};

/// Bonds of any direction and orientation, particles displaced and turned up to `amplitude` of length and radian.
class RandomBond : public testing::Test {
protected:
	std::mt19937_64                        engine { 7 };
	std::uniform_real_distribution<double> unit { -1, 1 };
	const BondStiffness                    stiffness { 3e8, 1.2e8, 90, 70 };

	Vector     vector() { return { unit(engine), unit(engine), unit(engine) }; }
	Quaternion orientation()
	{
		return Quaternion(unit(engine), unit(engine), unit(engine), unit(engine)).normalized();
	}
	void       disturb(Pose& pose, double amplitude)
	{
		pose.position += amplitude * 1e-3 * vector();
		pose.orientation = turn(amplitude * unit(engine), vector()) * pose.orientation;
	}
	static Loads loads(const Bond& bond, const Pose& a, const Pose& b)
	{
		return loadsOf(bond, b.position - a.position, a.orientation, b.orientation);
	}
};

TEST(BondStiffness, followsFromRadiusWhenParticlesTouch) // d0 = 2R: kn = πER/2, ks = πGR/2, kb = πER³/8, kt = πGR³/4
{
	const double        r = 0.7e-3;
	const BondStiffness k = bondStiffness(cement, BondSection(r), 2 * r);
	EXPECT_DOUBLE_EQ(k.normal, M_PI * young * r / 2);
	EXPECT_DOUBLE_EQ(k.shear, M_PI * shearModulus * r / 2);
	EXPECT_DOUBLE_EQ(k.bending, M_PI * young * std::pow(r, 3) / 8);
	EXPECT_DOUBLE_EQ(k.torsion, M_PI * shearModulus * std::pow(r, 3) / 4);
}

TEST_F(StraightBond, isFreeOfLoadAtFirst)
{
	const Loads l = loads();
	EXPECT_EQ(l.energy, 0);
	EXPECT_EQ(l.force, Vector::Zero());
	EXPECT_EQ(l.moment1, Vector::Zero());
	EXPECT_EQ(l.moment2, Vector::Zero());
}

TEST_F(StraightBond, stretches)
{
	two.position.x() += 2e-6;
	const Loads l = loads();
	EXPECT_NEAR(l.force.x(), stiffness.normal * 2e-6, 1e-9 * l.force.x());
	EXPECT_NEAR(l.section.force.x, l.force.x(), 1e-12 * l.force.x()); // tension positive
	EXPECT_NEAR(l.energy, 0.5 * stiffness.normal * 4e-12, 1e-9 * l.energy);
}

TEST_F(StraightBond, shearsAndBalancesItsCoupleOnBothEnds)
{
	two.position.y() += 2e-6;
	const Loads l = loads();
	EXPECT_NEAR(l.force.y(), stiffness.shear * 2e-6, 1e-12 * l.force.y());
	EXPECT_NEAR(l.force.x(), 0, 1e-9 * l.force.y());
	EXPECT_NEAR(l.moment1.z(), l.force.y() * length / 2, 1e-12);
	EXPECT_NEAR(l.moment2.z(), l.force.y() * length / 2, 1e-12);
}

TEST_F(StraightBond, bendsWithFullEIOverLengthAtAnyAngle)
{
	for (double angle : { 1e-9, 0.004, 0.5, 2. }) {
		one.orientation   = turn(-angle / 2, Vector::UnitZ());
		two.orientation   = turn(angle / 2, Vector::UnitZ());
		const Loads l = loads();
		EXPECT_NEAR(l.moment1.z(), stiffness.bending * angle, 1e-12 * stiffness.bending * angle) << angle;
		EXPECT_NEAR(l.moment2.z(), -stiffness.bending * angle, 1e-12 * stiffness.bending * angle) << angle;
		EXPECT_NEAR(l.energy, 0.5 * stiffness.bending * angle * angle, 1e-12 * l.energy) << angle;
	}
	// E 1e5 MPa, R 1 mm, d0 2 mm, 0.004 rad: 157.08 N·mm by beam theory (ESyS-Particle's bond gives half of it)
	EXPECT_NEAR(stiffness.bending * 0.004, 157.08e-3, 1e-5);
}

TEST_F(StraightBond, twistsWithGJOverLengthAtAnyAngle)
{
	for (double angle : { 1e-9, 0.005, 0.5, 3. }) {
		two.orientation   = turn(angle, Vector::UnitX());
		const Loads l = loads();
		EXPECT_NEAR(l.moment1.x(), stiffness.torsion * angle, 1e-12 * stiffness.torsion * angle) << angle;
		EXPECT_NEAR(l.moment2.x(), -stiffness.torsion * angle, 1e-12 * stiffness.torsion * angle) << angle;
		EXPECT_NEAR(l.force.norm(), 0, 1e-12 * stiffness.normal * length);
	}
}

// to first order Fs = -ks (d0/2) φ, M1 = -ks (d0/2)² φ + kb φ, M2 = -ks (d0/2)² φ - kb φ
TEST_F(StraightBond, shearsWhenOneParticleTurns)
{
	const double angle    = 1e-6;
	two.orientation       = turn(angle, Vector::UnitZ());
	const Loads l     = loads();
	const double    shear = stiffness.shear * angle * length / 2;
	EXPECT_NEAR(l.force.y(), -shear, 1e-6 * shear);
	EXPECT_NEAR(l.moment1.z(), -shear * length / 2 + stiffness.bending * angle, 1e-6 * stiffness.bending * angle);
	EXPECT_NEAR(l.moment2.z(), -shear * length / 2 - stiffness.bending * angle, 1e-6 * stiffness.bending * angle);
}

TEST_F(StraightBond, keepsItsDigitsAtTinyAngles) // acos would know nothing below 1.5e-8 rad
{
	const double angle = 1e-13;
	two.orientation    = Quaternion(1, 0.5 * angle, 0, 0);
	EXPECT_NEAR(loads().moment1.x() / (stiffness.torsion * angle), 1, 1e-12);
}

TEST_F(StraightBond, doesNotCareForTheSignOfAQuaternion)
{
	two.position.y() += 1e-6;
	two.orientation       = turn(0.01, { 1, 2, 3 });
	const Loads plain = loads();
	two.orientation.coeffs() *= -1;
	EXPECT_EQ(loads().moment1, plain.moment1);
	EXPECT_EQ(loads().force, plain.force);
}

TEST(HalfAngle, seriesAndArcTangentMeet)
{
	for (double squared : { 1e-3 * (1 - 1e-12), 1e-3 }) {
		const double    sine = std::sqrt(squared);
		const HalfAngle<double> h    = halfAngle(std::sqrt(1 - squared), squared);
		EXPECT_NEAR(h.factor, std::asin(sine) / sine, 1e-15);
		EXPECT_NEAR(h.complement, (1 - std::asin(sine) / sine) / squared, 1e-12);
	}
}

TEST_F(RandomBond, loadsAreTheDerivativesOfTheEnergy)
{
	const double step = 1e-6; // of length in mm and of angle in rad
	for (int trial = 0; trial < 50; trial++) {
		Pose       a { 1e-3 * vector(), orientation() },
		           b { a.position + 2e-3 * vector().normalized(), orientation() };
		const Bond bond = join(stiffness, b.position - a.position, a.orientation, b.orientation);
		disturb(a, 0.7);
		disturb(b, 0.7);
		const Loads l     = loads(bond, a, b);
		const double    scale = stiffness.normal * 1e-3;
		for (int axis = 0; axis < 3; axis++) {
			const Vector direction = Vector::Unit(axis);
			const auto   slope     = [&](Pose& pose, bool rotate) {
                                const Pose kept = pose;
                                double     energy[2];
                                for (int side : { 0, 1 }) {
                                        const double sign = side ? 1 : -1;
                                        if (rotate) pose.orientation = turn(sign * step, direction) * kept.orientation;
                                        else
                                                pose.position = kept.position + sign * step * 1e-3 * direction;
                                        energy[side] = loads(bond, a, b).energy;
                                }
                                pose = kept;
                                return (energy[1] - energy[0]) / (2 * step * (rotate ? 1 : 1e-3));
			};
			EXPECT_NEAR(l.force[axis], -slope(a, false), 1e-8 * scale);
			EXPECT_NEAR(-l.force[axis], -slope(b, false), 1e-8 * scale);
			EXPECT_NEAR(l.moment1[axis], -slope(a, true), 1e-8 * scale * 2e-3);
			EXPECT_NEAR(l.moment2[axis], -slope(b, true), 1e-8 * scale * 2e-3);
		}
	}
}

TEST_F(RandomBond, conservesAngularMomentum)
{
	for (int trial = 0; trial < 1000; trial++) {
		Pose a { 1e-3 * vector(), orientation() },
		        b { a.position + 2e-3 * vector().normalized(), orientation() };
		const Bond bond = join(stiffness, b.position - a.position, a.orientation, b.orientation);
		disturb(a, 1);
		disturb(b, 1);
		const Loads l   = loads(bond, a, b);
		const Vector    sum = l.moment1 + l.moment2 - (b.position - a.position).cross(l.force);
		EXPECT_LT(sum.norm(), 1e-15 * (l.moment1.norm() + l.moment2.norm() + l.force.norm() * 1e-1));
	}
}

TEST_F(RandomBond, isObjective)
{
	for (int trial = 0; trial < 200; trial++) {
		Pose a { 1e-3 * vector(), orientation() },
		        b { a.position + 2e-3 * vector().normalized(), orientation() };
		const Bond bond = join(stiffness, b.position - a.position, a.orientation, b.orientation);
		disturb(a, 0.5);
		disturb(b, 0.5);
		const Loads  before = loads(bond, a, b);
		const Quaternion spin   = orientation();
		const Vector     shift  = vector();
		for (Pose* p : { &a, &b }) {
			p->position    = spin * p->position + 1e-3 * shift;
			p->orientation = spin * p->orientation;
		}
		const Loads after = loads(bond, a, b);
		const double    scale = stiffness.normal * 1e-3;
		EXPECT_LT((after.force - spin * before.force).norm(), 1e-12 * scale);
		EXPECT_LT((after.moment1 - spin * before.moment1).norm(), 1e-12 * scale * 1e-3);
		EXPECT_LT((after.moment2 - spin * before.moment2).norm(), 1e-12 * scale * 1e-3);
		EXPECT_NEAR(after.energy, before.energy, 1e-12 * before.energy);
	}
}

// both particles go round loops of ±0.2 lengths and radians; the midpoint rule is exact for periodic paths
TEST_F(RandomBond, doesNoWorkOnClosedPaths)
{
	const int steps = 400;
	for (int trial = 0; trial < 10; trial++) {
		const Pose   a0 { Vector::Zero(), orientation() }, b0 { 2e-3 * vector().normalized(), orientation() };
		const Bond   bond = join(stiffness, b0.position, a0.orientation, b0.orientation);
		const Vector s1 = vector(), s2 = vector(), s3 = vector(), s4 = vector(), u1 = vector(), u2 = vector(),
		             u3 = vector(), u4 = vector();
		const auto   at = [&](double t) {
                        Pose a = a0, b = b0;
                        a.position += 2e-4 * (std::sin(t) * s1 + std::sin(2 * t) * s2);
                        b.position += 2e-4 * (std::cos(t) * s3 + std::sin(3 * t) * s4);
                        a.orientation = turn(0.2 * std::sin(t), u1) * turn(0.2 * std::cos(2 * t), u2) * a0.orientation;
                        b.orientation = turn(0.2 * std::cos(t), u3) * turn(0.2 * std::sin(2 * t), u4) * b0.orientation;
                        return std::make_pair(a, b);
		};
		const auto rate = [](const Quaternion& from, const Quaternion& to) {
			return Vector(2 * (to * from.conjugate()).vec());
		};
		double       work = 0, gross = 0;
		const double h = 2 * M_PI / steps;
		for (int i = 0; i < steps; i++) {
			const auto [a, b]     = at(i * h);
			const auto [am, bm]   = at((i - 1e-3) * h);
			const auto [ap, bp]   = at((i + 1e-3) * h);
			const Loads l     = loads(bond, a, b);
			const double power = (l.force.dot((ap.position - am.position) - (bp.position - bm.position))
			                      + l.moment1.dot(rate(am.orientation, ap.orientation))
			                      + l.moment2.dot(rate(bm.orientation, bp.orientation)))
			        / 2e-3;
			work += power;
			gross += std::abs(power);
		}
		EXPECT_LT(std::abs(work), 1e-7 * gross);
	}
}

} // namespace
