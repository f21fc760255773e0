// GPL v2 or later, see LICENSE.
// Elastic repulsion of a particle by a wall.
#pragma once

#include <cmath>

namespace yade::ddem {

/** Spring of a sphere against a wall [N/m]: π r K. The wall's stiffness K is a pressure, as ESyS-Particle reads the report's "1e5 N/mm²".
 * \param radius r [m] \param wallStiffness K [Pa]
 */
inline double wallSpring(double radius, double wallStiffness) { return M_PI * radius * wallStiffness; }

/// Force of the wall on the sphere along the wall's normal [N]: π r K (r - g) while the centre's distance g from the wall is less than r, else 0.
inline double wallRepulsion(double radius, double wallStiffness, double distance)
{
	return distance < radius ? wallSpring(radius, wallStiffness) * (radius - distance) : 0.;
}

} // namespace yade::ddem
