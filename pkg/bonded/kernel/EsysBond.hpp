// GPL v2 or later, see LICENSE.
// The elastic bond as ESyS-Particle 2.3.5 computes it (class CRotBondedInteraction; Wang, Acta Geotechnica 4, 2009),
// to compare with that program.
//
// It differs from the consistent bond of BondLaw.hpp in
//  - its rest length, the sum r0 of the radii: a bond made across a gap starts under tension;
//  - bending, ½ E I/d0 per relative rotation instead of E I/d0;
//  - kinematics with the half length r0/2 for both particles but moment arms r1 and r2: for unequal radii it does not
//    derive from an energy.
// Like the other it is total, not incremental. Angles are taken from atan2 where ESyS takes them from acos,
// which has a noise of 1.5e-8 rad.
#pragma once

#include <pkg/bonded/kernel/BondLaw.hpp>

namespace yade::ddem {

/// v·angle/sin(angle) for a vector v of length sin(angle): a vector as long as the angle.
template <class Number> inline SpaceVector<Number> lengthenedToAngle(const SpaceVector<Number>& v, const Number& cosine)
{
	using std::atan2;
	using std::sqrt;
	const Number squared = dot(v, v);
	const auto   turned  = squared > Number(1e-30);
	const Number sine    = sqrt(select(turned, squared, Number(1.)));
	return select(turned, atan2(sine, cosine) / sine, Number(1.)) * v;
}

/// Loads of a bond; arguments as for bondLoads.
template <class Number>
inline BondLoadsOf<Number> esysBondLoads(
        const BondOf<Number>& bond, const SpaceVector<Number>& branch, const SpaceRotation<Number>& orientation1,
        const SpaceRotation<Number>& orientation2)
{
	using std::atan2;
	// All in the axes of particle 1, turned so that the first one lies along the bond as it was made.
	const SpaceRotation<Number>    end1 = orientation1 * bond.frame1;
	const Axes<Number>        axes = axesOf(end1);
	const SpaceRotation<Number>    turn = inverse(end1) * (orientation2 * bond.frame2);
	const SpaceVector<Number> rb   = axes.components(branch);
	const Number              L = norm(rb), r0 = bond.radius1 + bond.radius2;
	const SpaceVector<Number> n = (1. / L) * rb;

	// shear by motion of the centres: γ t, from the first direction of the bond to the present one
	const SpaceVector<Number> across { n.x * n.x - 1., n.x * n.y, n.x * n.z };
	const SpaceVector<Number> gamma = lengthenedToAngle(across, n.x);
	// relative rotation, swing θ e and twist ψ about n
	const SpaceVector<Number> v     = turn.vector();
	const SpaceVector<Number> swept = cross(v, n);
	const SpaceVector<Number> image = n + (2. * turn.w) * swept + Number(2.) * cross(v, swept);
	const Number              along = dot(image, n);
	const SpaceVector<Number> theta = lengthenedToAngle(image - along * n, along);
	const Number              sign  = select(turn.w < Number(0.), Number(-1.), Number(1.));
	// half a turn about an axis across n has no twist, and in lanes atan2(0, 0) is not a number
	const Number psi = 2.
	        * atan2(sign * dot(v, n),
	                select(turn.w * turn.w + dot(v, n) * dot(v, n) > Number(0.), sign * turn.w, Number(1.)));

	const BondStiffnessOf<Number>& k      = bond.stiffness;
	const Number                   normal = k.normal * (L - r0);
	const SpaceVector<Number>      slip   = r0 * (gamma - Number(0.5) * theta);
	const SpaceVector<Number>      shear  = k.shear * slip;
	const SpaceVector<Number>      bend   = (0.5 * k.bending) * cross(n, theta);
	const Number                   twist  = k.torsion * psi;
	const SpaceVector<Number>      couple = L * cross(n, shear), bothMoments = bend + twist * n;

	BondLoadsOf<Number> loads;
	loads.force          = axes.vector(normal * n + shear);
	loads.moment1        = axes.vector(bothMoments + (bond.radius1 / r0) * couple);
	loads.moment2        = axes.vector((bond.radius2 / r0) * couple - bothMoments);
	loads.axis           = axes.vector(n);
	loads.section.force  = { normal, norm(shear), Number(0.) };
	loads.section.moment = { twist, norm(bend), Number(0.) };
	loads.energy = 0.5 * (normal * (L - r0) + dot(shear, slip) + 0.5 * k.bending * dot(theta, theta) + twist * psi);
	return loads;
}

} // namespace yade::ddem
