// GPL v2 or later, see LICENSE.
// Frictional contact of two particles that are not, or no longer, bonded.
//
// Slip is measured along the surfaces of the two rolling spheres, so that it does not depend on the overlap and a cycle
// of the normal force leaves no tangential force behind (no ratcheting: McNamara, García-Rojo, Herrmann,
// Phys. Rev. E 77, 031304, 2008). The force is its exact conjugate.
#pragma once

#include <pkg/bonded/kernel/BondSection.hpp>

#include <Eigen/Geometry>

#include <algorithm>

namespace yade::ddem {

/// Static friction until the first slip of a contact, dynamic friction from then on, for as long as the contact lasts.
struct ContactFriction {
	double staticCoefficient;  ///< [-]
	double dynamicCoefficient; ///< [-]
	/** Whether the tangential force grows gradually, F_T = μ F_N (1 - (1 - |δ|/δ_max)^{3/2}) up to gross sliding
	 * at |δ| = δ_max (eq. 7 of the report), instead of linearly, F_T = k_s |δ| up to μ F_N. The report leaves
	 * δ_max open; here it is 3 μ F_N/(2 k_s), so that both start with the same stiffness k_s.
	 */
	bool gradual = false;
};

/// Coefficients of viscous contact damping [N·s/m], eq. 6 of the report: F_n = F_N - c_n v_n, F_t = F_T - c_t v_t;
/// the latter only while the contact does not slide.
struct ContactDamping {
	double normal = 0, shear = 0;
};

/// Springs of a contact [N/m].
struct ContactStiffness {
	double normal, shear;
};

/** Springs of a contact that opens at the distance `reach` of the centres: those of a bond of radius reach/2 and length
 * reach (ESyS-Particle), so that a compressed bond that breaks keeps its normal force.
 */
inline ContactStiffness contactStiffness(const BondElasticity& elasticity, double reach)
{
	const BondStiffness bond = bondStiffness(elasticity, BondSection(reach / 2), reach);
	return { bond.normal, bond.shear };
}

/** Motion of two touching spheres; the radii share the reach of the contact, r1 + r2 = reach.
 *
 * A particle that is no sphere (a wall, a facet, a polyhedron) has the radius 0: the distance is then measured from
 * its surface, its velocity is that of its surface at the contact, and its moment is that of the force there, which is
 * left to the caller.
 */
struct ContactMotion {
	Eigen::Vector3d normal;                             ///< unit vector from particle 1 to 2
	double          distance;                           ///< of the centres [m]
	double          radius1, radius2;                   ///< [m]
	Eigen::Vector3d relativeVelocity;                   ///< v2 - v1 [m/s]
	Eigen::Vector3d angularVelocity1, angularVelocity2; ///< [rad/s]

	bool ofSpheres() const { return radius1 > 0 && radius2 > 0; }
};

/// What a contact remembers between steps.
struct ContactMemory {
	Eigen::Vector3d normal  = Eigen::Vector3d::Zero(); ///< of the last step; zero for a new contact
	Eigen::Vector3d shear   = Eigen::Vector3d::Zero(); ///< k_s times the elastic slip of the last step: the force
	                                                   ///< of a linear spring on particle 1 [N]
	double          force   = 0;                       ///< magnitude of the tangential spring's
	                                                   ///< force in the last step [N]
	double          energy  = 0;                       ///< stored in that spring [J]
	bool            sliding = false;                   ///< has slipped before
	/// normal damping force of the last step, tension positive [N]
	double          viscousNormal = 0;
	/// tangential damping force of the last step, on particle 1 [N]
	Eigen::Vector3d viscousShear  = Eigen::Vector3d::Zero();
};

/// What the contact does to its particles. The force on particle 2 is -force.
struct ContactLoads {
	Eigen::Vector3d force      = Eigen::Vector3d::Zero(); ///< on particle 1 [N]
	Eigen::Vector3d moment1    = Eigen::Vector3d::Zero(); ///< on particle 1 [N·m]
	Eigen::Vector3d moment2    = Eigen::Vector3d::Zero(); ///< on particle 2 [N·m]
	double          energy     = 0;                       ///< stored in both springs [J]
	double          dissipated = 0;                       ///< by sliding in this step [J]
	double          damped     = 0;                       ///< by damping in this step [J]
	bool            touching   = false;
};

/// Turns a vector that lies in the plane of `from` into the plane of `to` by the smallest rotation, then about `to` by
/// `spin` [rad]; keeps its length.
inline Eigen::Vector3d
followContact(const Eigen::Vector3d& vector, const Eigen::Vector3d& from, const Eigen::Vector3d& to, double spin)
{
	const Eigen::Vector3d tilted = vector - (from + to) * (vector.dot(to) / (1 + from.dot(to)));
	const double          t = spin / 2, cosine = (1 - t * t) / (1 + t * t), sine = 2 * t / (1 + t * t);
	return cosine * tilted + sine * to.cross(tilted);
}

/// A tangential spring at the force that a linear one would have.
struct TangentialSpring {
	double force;  ///< [N]
	double energy; ///< stored [J]
	double limit;  ///< force of the linear spring at which gross sliding starts [N]
};

/// \param linear k_s |δ| [N], at most `limit` \param strength μ F_N [N]
inline TangentialSpring tangentialSpring(bool gradual, double linear, double strength, double stiffness)
{
	if (!gradual) return { linear, 0.5 * linear * linear / stiffness, strength };
	const double limit = 1.5 * strength, left = limit > 0 ? std::max(0., 1 - linear / limit) : 0,
	             root = std::sqrt(left);
	return { strength * (1 - left * root), strength * (linear + 0.4 * limit * (left * left * root - 1)) / stiffness,
		 limit };
}

/// One step of a contact. A pair further apart than its reach bears nothing and forgets its slip.
inline ContactLoads contactLoads(
        const ContactStiffness& stiffness,
        const ContactFriction&  friction,
        const ContactMotion&    motion,
        double                  dt,
        ContactMemory&          memory,
        const ContactDamping&   damping = {})
{
	using Eigen::Vector3d;
	const double    reach = motion.radius1 + motion.radius2, overlap = reach - motion.distance;
	const Vector3d& n     = motion.normal;
	// Turns the centres' relative velocity into one of the surfaces: on a sphere the contact moves less far than
	// the other centre, on a plane as far.
	const double    scale = motion.ofSpheres() ? reach / motion.distance : 1;
	Vector3d        slip  = dt
	        * (scale * motion.relativeVelocity
	           - (motion.radius1 * motion.angularVelocity1 + motion.radius2 * motion.angularVelocity2).cross(n));
	slip -= n.dot(slip) * n;
	const double opening = dt * n.dot(motion.relativeVelocity);

	const double   spin = 0.5 * dt * n.dot(motion.angularVelocity1 + motion.angularVelocity2);
	const Vector3d old
	        = memory.normal.isZero(0) ? Vector3d::Zero() : followContact(memory.shear, memory.normal, n, spin);
	const double   size = old.norm();

	// What springs lose and dampers take between the last step and this one is the mean of their forces times the
	// motion, as leapfrog sees it.
	ContactLoads   loads;
	const Vector3d oldForce = size > 0 ? Vector3d(memory.force / size * old) : Vector3d::Zero();
	loads.dissipated        = memory.energy + 0.5 * oldForce.dot(slip);
	loads.damped            = 0.5 * (memory.viscousNormal * opening + memory.viscousShear.dot(slip));
	if (!(overlap > 0)) {
		memory = ContactMemory();
		return loads;
	}

	Vector3d         shear    = old + stiffness.shear * slip;
	const double     pressure = stiffness.normal * overlap, trial = shear.norm();
	const auto spring = [&](double linear) {
		return tangentialSpring(
		        friction.gradual, linear,
		        (memory.sliding ? friction.dynamicCoefficient : friction.staticCoefficient) * pressure,
		        stiffness.shear);
	};
	TangentialSpring tangential = spring(trial);
	const bool       slides     = trial > tangential.limit;
	if (slides) {
		memory.sliding = true;
		tangential     = spring(spring(0).limit);
		shear *= tangential.limit / trial;
	}
	const double   length = slides ? tangential.limit : trial;
	const Vector3d force  = length > 0 ? Vector3d(tangential.force / length * shear) : Vector3d::Zero();
	loads.dissipated
	        = slides || friction.gradual ? loads.dissipated - tangential.energy + 0.5 * force.dot(slip) : 0;

	memory.normal        = n;
	memory.shear         = shear;
	memory.force         = tangential.force;
	memory.energy        = tangential.energy;
	memory.viscousNormal = damping.normal * opening / dt;
	memory.viscousShear  = slides ? Vector3d::Zero() : Vector3d(damping.shear / dt * slip);
	loads.damped += 0.5 * (memory.viscousNormal * opening + memory.viscousShear.dot(slip));

	const Vector3d surface = force + memory.viscousShear, couple = n.cross(surface);
	loads.force            = scale * surface + (memory.viscousNormal - pressure) * n;
	loads.moment1          = motion.radius1 * couple;
	loads.moment2          = motion.radius2 * couple;
	loads.energy           = 0.5 * pressure * overlap + tangential.energy;
	loads.touching         = true;
	return loads;
}

} // namespace yade::ddem
