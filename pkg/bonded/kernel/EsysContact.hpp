// GPL v2 or later, see LICENSE.
// Frictional contact as ESyS-Particle 2.3.5 computes it (class CRotFrictionInteraction), to compare with that program.
//
// It differs from the contact of BondContact.hpp in
//  - its memory: after a slip, which drops the force to dynamic friction, it sticks again until static friction is
//    reached (a saw-tooth);
//  - its tangential force, which does not turn with the pair, and slip taken at the contact point,
//    which depends on the overlap.
#pragma once

#include <pkg/bonded/kernel/BondContact.hpp>

namespace yade::ddem {

/// One step of a contact; arguments as for contactLoads.
inline ContactLoads esysContactLoads(
        const ContactStiffness& stiffness, const ContactFriction& friction, const ContactMotion& motion, double dt,
        ContactMemory& memory)
{
	using Eigen::Vector3d;
	const double    reach = motion.radius1 + motion.radius2, overlap = reach - motion.distance;
	const Vector3d& n = motion.normal;
	ContactLoads    loads;
	if (!(overlap > 0)) {
		loads.dissipated = memory.energy;
		memory           = ContactMemory();
		return loads;
	}
	// to the contact point, along the branch
	const auto arm = [&](double radius) { return motion.ofSpheres() ? radius / reach * motion.distance : radius; };
	const double arm1 = arm(motion.radius1), arm2 = arm(motion.radius2);
	Vector3d     slip = dt
	        * (motion.relativeVelocity
	           - (arm1 * motion.angularVelocity1 + arm2 * motion.angularVelocity2).cross(n));
	slip -= n.dot(slip) * n;

	const Vector3d before = memory.shear;
	Vector3d       shear  = before + stiffness.shear * slip;
	const double   pressure = stiffness.normal * overlap, trial = shear.norm();
	if (trial > friction.staticCoefficient * pressure) {
		shear *= friction.dynamicCoefficient * pressure / trial;
		memory.sliding = true;
	} else
		memory.sliding = false;
	memory.normal = n;
	memory.shear  = shear;
	memory.force  = shear.norm();
	loads.dissipated = memory.energy + 0.5 * (before + shear).dot(slip);
	memory.energy    = 0.5 * shear.squaredNorm() / stiffness.shear;
	loads.dissipated -= memory.energy;

	const Vector3d couple = n.cross(shear);
	loads.force           = shear - pressure * n;
	loads.moment1         = arm1 * couple;
	loads.moment2         = arm2 * couple;
	loads.energy          = 0.5 * pressure * overlap + memory.energy;
	loads.touching        = true;
	return loads;
}

} // namespace yade::ddem
