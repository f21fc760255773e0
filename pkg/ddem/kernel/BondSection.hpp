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
struct BondSection {
	explicit BondSection(double bondRadius)
	        : radius(bondRadius)
	        , area(M_PI * bondRadius * bondRadius)
	        , inertia(area * bondRadius * bondRadius / 4)
	        , polarInertia(2 * inertia)
	        , bendingModulus(inertia / bondRadius)
	        , torsionModulus(polarInertia / bondRadius)
	{
	}
	double radius;         ///< R [m]
	double area;           ///< A = π R² [m²]
	double inertia;        ///< I = π R⁴/4 [m⁴]
	double polarInertia;   ///< J = π R⁴/2 [m⁴]
	double bendingModulus; ///< I/R = π R³/4: moment per stress at the rim [m³]
	double torsionModulus; ///< J/R = π R³/2 [m³]
};

/** Stiffnesses of a bond, loads per relative motion of its ends.
 * Normal, shear and torsion as in ESyS-Particle's BrittleBeam (Weatherley et al., ESyS-Particle tutorial); bending is the full E I/d0 of beam theory.
 */
struct BondStiffness {
	double normal;  ///< E A/d0 [N/m]
	double shear;   ///< G A/d0 [N/m]
	double bending; ///< E I/d0 [N·m/rad]
	double torsion; ///< G J/d0 [N·m/rad]
};

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
