// GPL v2 or later, see LICENSE.
// Cross-section and stiffnesses of a bond: a round beam between the centres of two particles.
#pragma once

#include <cmath>

namespace yade::ddem {

/// Elastic constants of the cement.
struct BondElasticity {
	double young;                                                ///< E [Pa]
	double poisson;                                              ///< ν [-]
	double shear() const { return young / (2 * (1 + poisson)); } ///< G [Pa]
};

/// Round cross-section of radius R.
template <class Number> struct BondSectionOf {
	explicit BondSectionOf(const Number& bondRadius)
	        : radius(bondRadius)
	        , area(M_PI * bondRadius * bondRadius)
	        , inertia(0.25 * area * bondRadius * bondRadius)
	        , polarInertia(2. * inertia)
	        , bendingModulus(0.25 * area * bondRadius)
	        , torsionModulus(0.5 * area * bondRadius)
	{
	}
	Number radius;         ///< R [m]
	Number area;           ///< A = π R² [m²]
	Number inertia;        ///< I = π R⁴/4 [m⁴]
	Number polarInertia;   ///< J = π R⁴/2 [m⁴]
	Number bendingModulus; ///< I/R = π R³/4: moment per stress at the rim [m³]
	Number torsionModulus; ///< J/R = π R³/2 [m³]
};
using BondSection = BondSectionOf<double>;

/** Stiffnesses of a bond, loads per relative motion of its ends.
 * Normal, shear and torsion as in ESyS-Particle's BrittleBeam (Weatherley et al., ESyS-Particle tutorial); bending is
 * the full E I/d0 of beam theory.
 */
template <class Number> struct BondStiffnessOf {
	Number normal;  ///< E A/d0 [N/m]
	Number shear;   ///< G A/d0 [N/m]
	Number bending; ///< E I/d0 [N·m/rad]
	Number torsion; ///< G J/d0 [N·m/rad]
};
using BondStiffness = BondStiffnessOf<double>;

/// \param length distance d0 of the particles' centres when the bond was made [m]
inline BondStiffness bondStiffness(const BondElasticity& elasticity, const BondSection& section, double length)
{
	const double shear = elasticity.shear();
	return { elasticity.young * section.area / length,
		 shear * section.area / length,
		 elasticity.young * section.inertia / length,
		 shear * section.polarInertia / length };
}

} // namespace yade::ddem
