// GPL v2 or later, see LICENSE.
// The elastic bond: forces and moments on two particles from their positions and orientations.
//
// The bond is one element of the geometrically exact beam between the particles' centres (Simo, Comput. Methods Appl.
// Mech. Eng. 49, 1985), with one integration point at its middle, which keeps a short beam free of shear locking
// (Hughes, Taylor, Kanoknukulchai, Int. J. Numer. Meth. Eng. 11, 1977).
// To first order it is the bond of ESyS-Particle (Wang, Acta Geotechnica 4, 2009):
// shear = (u2 - u1)_t - (d0/2)(φ1 + φ2) × n, bending and twist = φ2 - φ1.
//
// The frames Λ1, Λ2 turn with the particles and coincide when the bond is made, first axis along the bond. The middle
// frame Λ is half way between them:
//   Γ = Λᵀ(x2 - x1) - d0 e1                    stretch and shear,
//   θ = rotation vector of Λ1ᵀΛ2               torsion and bending,
//   U = ½ (kn Γ1² + ks (Γ2² + Γ3²)) + ½ (kt θ1² + kb (θ2² + θ3²)).
// Forces and moments are the exact derivatives of U. So the bond is conservative for any radii and any rotation below
// π, and because U does not change when both particles move and turn together, linear and angular momentum are
// conserved to round-off (objectivity: Crisfield, Jelenić, Proc. R. Soc. A 455, 1999). Loads are total, not
// incremental: nothing drifts. No acos or asin is taken: at small angles they lose half of the digits.
#pragma once

#include <pkg/bonded/kernel/BondSection.hpp>
#include <pkg/ddem/kernel/algebra/Select.hpp>
#include <pkg/ddem/kernel/algebra/SpaceVector.hpp>

namespace yade::ddem {

/// What a bond remembers of the moment it was made, frames in the axes of its particles.
template <class Number> struct BondOf {
	BondStiffnessOf<Number> stiffness;
	Number                  length;           ///< d0 [m]
	Number                  radius1, radius2; ///< of the particles [m]
	Number                  sectionRadius;    ///< R [m]
	SpaceRotation<Number>        frame1;           ///< the bond's frame in the axes of particle 1, first
	                                               ///< axis from particle 1 to 2
	SpaceRotation<Number>        frame2;           ///< the same frame in the axes of particle 2
};
using Bond = BondOf<double>;

/// Loads of the cross-section in the middle of the bond, along its axes; the first is the bond's own. Tension positive.
template <class Number> struct BondResultantsOf {
	SpaceVector<Number> force;  ///< normal force, two shear forces [N]
	SpaceVector<Number> moment; ///< torsion, two bending moments [N·m]
};
using BondResultants = BondResultantsOf<double>;

/// What the bond does to its particles. The force on particle 2 is -force.
template <class Number> struct BondLoadsOf {
	SpaceVector<Number>      force;   ///< on particle 1 [N]
	SpaceVector<Number>      moment1; ///< on particle 1, about its centre [N·m]
	SpaceVector<Number>      moment2; ///< on particle 2, about its centre [N·m]
	SpaceVector<Number>      axis;    ///< the bond's direction [-]
	BondResultantsOf<Number> section;
	Number                   energy; ///< stored [J]
};
using BondLoads = BondLoadsOf<double>;

/// The shortest rotation that takes the x axis into a direction. \param direction unit vector
inline SpaceRotation<double> rotationFromX(const SpaceVector<double>& direction)
{
	const double cosine = direction.x, half = std::sqrt(0.5 * (1 + cosine));
	if (half < 1e-8) return { 0, 0, 0, 1 }; // half a turn about z
	return { half, 0, -direction.z / (2 * half), direction.y / (2 * half) };
}

/// A bond without load between particles at rest in these orientations, with ESyS-Particle's section of radius d0/2.
/// \param branch x2 - x1 [m], not zero
inline Bond makeBond(
        const BondStiffness&       stiffness,
        double                     radius1,
        double                     radius2,
        const SpaceVector<double>& branch,
        const SpaceRotation<double>&    orientation1,
        const SpaceRotation<double>&    orientation2)
{
	const double           length = norm(branch);
	const SpaceRotation<double> frame  = rotationFromX((1 / length) * branch);
	return { stiffness,
		 length,
		 radius1,
		 radius2,
		 0.5 * length,
		 inverse(orientation1) * frame,
		 inverse(orientation2) * frame };
}

/// Factors that turn the vector part v of a unit quaternion into its rotation vector: θ = 2 f v with f = asin|v|/|v|,
/// and (1 - f)/|v|² for its derivative.
template <class Number> struct HalfAngle {
	Number factor;     ///< f
	Number complement; ///< (1 - f)/|v|²
};

/// \param scalar scalar part of the quaternion, not negative \param squared |v|²
template <class Number> inline HalfAngle<Number> halfAngle(const Number& scalar, const Number& squared)
{
	using std::atan2;
	using std::sqrt;
	// The series is exact to the last digit below 1e-3, and needs no special case at zero.
	const Number series
	        = -(1. / 6
	            + squared * (3. / 40 + squared * (15. / 336 + squared * (105. / 3456 + squared * 945. / 42240))));
	const auto   large      = squared > Number(1e-3);
	HalfAngle<Number> small = { 1. - squared * series, series };
	if (!any(large)) return small;
	const Number sine = sqrt(select(large, squared, Number(1.))), factor = atan2(sine, scalar) / sine;
	return { select(large, factor, small.factor), select(large, (1. - factor) / squared, small.complement) };
}

/// Leaves the loads of an elastic bond as they are.
struct AllElastic {
	template <class Number> void operator()(BondResultantsOf<Number>&) const { }
};

/** Loads of a bond.
 * \param branch x2 - x1 [m]
 * \param orientation1,orientation2 unit quaternions, body to world
 * \param weaken called with the elastic loads of the section, of which it may take away
 */
template <class Number, class Weaken = AllElastic>
inline BondLoadsOf<Number> bondLoads(
        const BondOf<Number>& bond, const SpaceVector<Number>& branch, const SpaceRotation<Number>& orientation1,
        const SpaceRotation<Number>& orientation2, const Weaken& weaken = {})
{
	const SpaceRotation<Number> end1 = orientation1 * bond.frame1, other = orientation2 * bond.frame2;
	// the shorter of the two rotations between the ends
	const Number              sign     = select(dot(end1, other) < Number(0.), Number(-1.), Number(1.));
	const SpaceRotation<Number>    end2     = sign * other;
	const SpaceRotation<Number>    relative = inverse(end1) * end2;
	const SpaceVector<Number> v        = relative.vector();
	// the bond's axes: the sum of two quaternions is, but for its length, the rotation half way between
	const Axes<Number>        middle   = axesOf(end1 + end2);

	const SpaceVector<Number> local = middle.components(branch);
	const HalfAngle<Number>   half  = halfAngle(relative.w, dot(v, v));
	const SpaceVector<Number> stretch { local.x - bond.length, local.y, local.z };
	const SpaceVector<Number> rotation = (2. * half.factor) * v;

	const BondStiffnessOf<Number>& k = bond.stiffness;
	BondLoadsOf<Number>            loads;
	loads.section.force  = { k.normal * stretch.x, k.shear * stretch.y, k.shear * stretch.z };
	loads.section.moment = { k.torsion * rotation.x, k.bending * rotation.y, k.bending * rotation.z };
	weaken(loads.section);
	loads.energy         = 0.5 * (dot(loads.section.force, stretch) + dot(loads.section.moment, rotation));

	// δU = force·δΓ + moment·δθ. With spins w1, w2 of the ends, in the middle frame: δθ = v v·w (1 - f)/|v|² + f w
	// for w = w2 - w1, and the middle frame spins with ½(w1 + w2) - ½ g × (w2 - w1),
	// g = v/(1 + scalar) = tan(θ/4) along the axis.
	const SpaceVector<Number> conjugate
	        = half.factor * loads.section.moment + (half.complement * dot(loads.section.moment, v)) * v;
	const SpaceVector<Number> couple    = Number(0.5) * cross(local, loads.section.force);
	const SpaceVector<Number> swing     = (1. / (1. + relative.w)) * cross(couple, v) + conjugate;
	loads.force                         = middle.vector(loads.section.force);
	loads.moment1                       = middle.vector(couple + swing);
	loads.moment2                       = middle.vector(couple - swing);
	loads.axis                          = middle.first;
	return loads;
}

} // namespace yade::ddem
