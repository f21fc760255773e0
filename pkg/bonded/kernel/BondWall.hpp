// GPL v2 or later, see LICENSE.
// Elastic repulsion of a particle by a wall.
#pragma once

#include <pkg/ddem/kernel/algebra/SpaceVector.hpp>

namespace yade::ddem {

/** Spring of a sphere against a wall [N/m]: π r K. The wall's stiffness K is a pressure, as ESyS-Particle reads the
 * report's "1e5 N/mm²".
 * \param radius r [m] \param wallStiffness K [Pa]
 */
inline double wallSpring(double radius, double wallStiffness) { return M_PI * radius * wallStiffness; }

/// Force of the wall on the sphere along the wall's normal [N]: π r K (r - g) while the centre's distance g from the
/// wall is less than r, else 0.
inline double wallRepulsion(double radius, double wallStiffness, double distance)
{
	return distance < radius ? wallSpring(radius, wallStiffness) * (radius - distance) : 0.;
}

/** Force on a sphere that is bonded to a wall, -π r (K u_n + K_s u_t) of its displacement u relative to the wall since
 * it was bonded. It acts at the centre and never breaks (ESyS-Particle's bonded walls; NRotBondedWall has K_s = K).
 * \param normal unit normal of the wall
 */
inline SpaceVector<double> bondedWallForce(
        double radius, double wallStiffness, double shearStiffness, const SpaceVector<double>& displacement,
        const SpaceVector<double>& normal)
{
	const SpaceVector<double> across = dot(displacement, normal) * normal;
	return -wallSpring(radius, wallStiffness) * across
	        - wallSpring(radius, shearStiffness) * (displacement - across);
}

} // namespace yade::ddem
