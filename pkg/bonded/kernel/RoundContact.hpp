// GPL v2 or later, see LICENSE.
// Where a sphere touches a round surface: a roller from outside, a curved jaw from inside.
#pragma once

#include <pkg/ddem/kernel/algebra/SpaceVector.hpp>

#include <cmath>

namespace yade::ddem {

/// A rigid part of a cylinder's surface, by its axis.
struct RoundSurface {
	double radius;    ///< [m]
	double length;    ///< along the axis, half of it to each side [m]
	bool   concave;   ///< touched from inside
	double halfAngle; ///< of a concave one, to each side of its middle [rad]
};

struct RoundTouch {
	bool                there;  ///< whether the sphere's centre is opposite to the surface
	double              depth;  ///< overlap, negative where they are apart [m]
	SpaceVector<double> normal; ///< from the surface to the centre of the sphere
};

/** Overlap of a sphere and a round surface.
 * With d the distance of the centre from the axis, it is R + r - d outside of a roller, d + r - R inside of a jaw.
 * \param centre of the sphere, from the middle of the axis, which is z; y points to the middle of a jaw [m]
 * \param sphereRadius r [m]
 * A sphere beyond an end or an edge is not opposite to the surface: neither has an edge that touches. Nor is one whose
 * centre is on the axis, where no way leads out.
 */
inline RoundTouch touchOf(const RoundSurface& surface, const SpaceVector<double>& centre, double sphereRadius)
{
	const double              distance = std::hypot(centre.x, centre.y);
	const bool                within   = std::abs(centre.z) <= 0.5 * surface.length && distance > 0
	        && (!surface.concave || std::abs(std::atan2(centre.x, centre.y)) <= surface.halfAngle);
	const SpaceVector<double> outward { distance > 0 ? centre.x / distance : 0,
		                            distance > 0 ? centre.y / distance : 0, 0 };
	if (surface.concave) return { within, distance + sphereRadius - surface.radius, -outward };
	return { within, surface.radius + sphereRadius - distance, outward };
}

} // namespace yade::ddem
