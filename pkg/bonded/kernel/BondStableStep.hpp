// GPL v2 or later, see LICENSE.
// Bound on the time step of particles joined by bonds, contacts and walls.
#pragma once

#include <vector>

namespace yade::ddem {

/// One elastic connection of two particles, linearised about rest: bond, contact or wall.
struct PairSpring {
	int    first, second;    ///< places of the particles in the lists of masses;
	                         ///< second = -1 for a wall that nothing moves
	double normal, shear;    ///< [N/m]
	double bending, torsion; ///< [N·m/rad]
	double arm1, arm2;       ///< from each centre to the point where slip is measured [m]; d0/2 for a bond
};

/// A free rigid sphere.
struct ParticleMass {
	double mass;    ///< [kg]
	double inertia; ///< moment of inertia [kg·m²]
};

/** Longest stable step of leapfrog, 2/ω [s]; infinity without springs.
 *
 * Each particle's mass and inertia is shared out between its springs, in proportion to their stiffness. No system of
 * such pairs can have a higher frequency than its worst pair with the masses it was given (Irons and Treharne 1971, as
 * for finite elements), so the bound is rigorous about rest whatever the shares. Here they leave it within about
 * a tenth of the exact value. Bonds under load σ shift frequencies by about σ/E.
 * \param ruling gets the spring of the worst pair, where there are springs
 */
double stableStep(
        const std::vector<ParticleMass>& particles, const std::vector<PairSpring>& springs,
        const PairSpring** ruling = nullptr);

/** Longest stable step with viscous dampers, whose forces leapfrog takes from the velocities of the last half step [s]:
 * h² ω² + 2 h λ ≤ 4, λ the highest damping rate.
 * \param undamped stableStep of the springs
 * \param ofDampers stableStep of the dampers, coefficients in place of stiffnesses: 2/√λ; infinity without
 */
double dampedStableStep(double undamped, double ofDampers);

} // namespace yade::ddem
