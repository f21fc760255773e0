// GPL v2 or later, see LICENSE.
// Frictional contact of two particles that are not, or no longer, bonded.
//
// Slip is measured along the surfaces of the two rolling spheres, so that it does not depend on the overlap and a cycle of the normal force leaves no
// tangential force behind (no ratcheting: McNamara, García-Rojo, Herrmann, Phys. Rev. E 77, 031304, 2008). The force is its exact conjugate.
#pragma once

#include <pkg/ddem/kernel/BondSection.hpp>

#include <Eigen/Geometry>

namespace yade::ddem {

/// Static friction until the first slip of a contact, dynamic friction from then on, for as long as the contact lasts.
struct ContactFriction {
	double staticCoefficient;  ///< [-]
	double dynamicCoefficient; ///< [-]
};

/// Springs of a contact [N/m].
struct ContactStiffness {
	double normal, shear;
};

/** Springs of a contact that opens at the distance `reach` of the centres: those of a bond of radius reach/2 and length reach (ESyS-Particle), so that a
 * compressed bond that breaks keeps its normal force.
 */
inline ContactStiffness contactStiffness(const BondElasticity& elasticity, double reach)
{
	const BondStiffness bond = bondStiffness(elasticity, BondSection(reach / 2), reach);
	return { bond.normal, bond.shear };
}

/// Motion of two touching spheres; the radii share the reach of the contact, r1 + r2 = reach.
struct ContactMotion {
	Eigen::Vector3d normal;                             ///< unit vector from particle 1 to 2
	double          distance;                           ///< of the centres [m]
	double          radius1, radius2;                   ///< [m]
	Eigen::Vector3d relativeVelocity;                   ///< v2 - v1 [m/s]
	Eigen::Vector3d angularVelocity1, angularVelocity2; ///< [rad/s]
};

/// What a contact remembers between steps.
struct ContactMemory {
	Eigen::Vector3d normal  = Eigen::Vector3d::Zero(); ///< of the last step; zero for a new contact
	Eigen::Vector3d shear   = Eigen::Vector3d::Zero(); ///< spring force of the last step, on particle 1 [N]
	bool            sliding = false;                   ///< has slipped before
};

/// What the contact does to its particles. The force on particle 2 is -force.
struct ContactLoads {
	Eigen::Vector3d force;      ///< on particle 1 [N]
	Eigen::Vector3d moment1;    ///< on particle 1 [N·m]
	Eigen::Vector3d moment2;    ///< on particle 2 [N·m]
	double          energy;     ///< stored in both springs [J]
	double          dissipated; ///< by sliding in this step [J]
	bool            touching;
};

/// Turns a vector that lies in the plane of `from` into the plane of `to` by the smallest rotation, then about `to` by `spin` [rad]; keeps its length.
inline Eigen::Vector3d followContact(const Eigen::Vector3d& vector, const Eigen::Vector3d& from, const Eigen::Vector3d& to, double spin)
{
	const Eigen::Vector3d tilted = vector - (from + to) * (vector.dot(to) / (1 + from.dot(to)));
	const double          t = spin / 2, cosine = (1 - t * t) / (1 + t * t), sine = 2 * t / (1 + t * t);
	return cosine * tilted + sine * to.cross(tilted);
}

/// One step of a contact of spheres. A pair further apart than its reach bears nothing and forgets its slip.
inline ContactLoads
contactLoads(const ContactStiffness& stiffness, const ContactFriction& friction, const ContactMotion& motion, double dt, ContactMemory& memory)
{
	using Eigen::Vector3d;
	const double reach = motion.radius1 + motion.radius2, overlap = reach - motion.distance;
	if (!(overlap > 0)) {
		memory = ContactMemory();
		return { Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero(), 0, 0, false };
	}
	const Vector3d& n     = motion.normal;
	const double    scale = reach / motion.distance; // turns the centres' relative velocity into one of the surfaces
	Vector3d slip = dt * (scale * motion.relativeVelocity - (motion.radius1 * motion.angularVelocity1 + motion.radius2 * motion.angularVelocity2).cross(n));
	slip -= n.dot(slip) * n;

	const double   spin   = 0.5 * dt * n.dot(motion.angularVelocity1 + motion.angularVelocity2);
	const Vector3d before = memory.normal.isZero(0) ? Vector3d::Zero() : followContact(memory.shear, memory.normal, n, spin);
	Vector3d       shear  = before + stiffness.shear * slip;

	const double pressure = stiffness.normal * overlap, trial = shear.norm();
	double       dissipated = 0;
	if (trial > (memory.sliding ? friction.dynamicCoefficient : friction.staticCoefficient) * pressure) {
		memory.sliding = true;
		shear *= friction.dynamicCoefficient * pressure / trial;
		// what the spring lost and what its ends brought in since the last step, trapezoidal as leapfrog sees it
		dissipated = (before.squaredNorm() - shear.squaredNorm()) / (2 * stiffness.shear) + 0.5 * (before + shear).dot(slip);
	}
	memory.normal = n;
	memory.shear  = shear;

	const Vector3d couple = n.cross(shear);
	return { scale * shear - pressure * n,
		 motion.radius1 * couple,
		 motion.radius2 * couple,
		 0.5 * (pressure * overlap + shear.squaredNorm() / stiffness.shear),
		 dissipated,
		 true };
}

} // namespace yade::ddem
