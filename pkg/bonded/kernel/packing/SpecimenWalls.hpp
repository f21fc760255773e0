// GPL v2 or later, see LICENSE.
// Walls of convex specimens: planes, and what is round about them.
#pragma once

#include <pkg/bonded/kernel/packing/TangentSphere.hpp>

#include <algorithm>
#include <limits>
#include <vector>

namespace yade::ddem {

enum class WallKind {
	Plane,   ///< its distance is normal·x - offset
	Ball,    ///< hollow
	Cylinder ///< hollow
};

/// A wall; the specimen is on the side where its distance is positive.
struct SpecimenWall {
	WallKind            kind;
	SpaceVector<double> at;                 ///< inward normal, or centre or a point on the axis [m]
	double              size;               ///< offset of a plane, radius [m]
	SpaceVector<double> axis = { 0, 0, 0 }; ///< of a cylinder, of length 1

	double distance(const SpaceVector<double>& x) const { return touchedNear(x).distance(x); }

	/** What a sphere near x is to touch. A cylinder is there the hollow ball that touches it all around at the
	 * height of x: the sphere's own equation once x is its centre. */
	Touched touchedNear(const SpaceVector<double>& x) const
	{
		if (kind == WallKind::Plane) return { at, size, true };
		if (kind == WallKind::Ball) return { at, -size, false };
		return { at + dot(x - at, axis) * axis, -size, false };
	}
};

/// A convex specimen, what lies inside of all walls. In a layer all of it is in the plane z = 0.
struct Specimen {
	int                       dimension; ///< 3, or 2 for a layer
	SpaceVector<double>       lower;     ///< corner of the box around it [m]
	SpaceVector<double>       upper;     ///< other corner [m]
	std::vector<SpecimenWall> walls;

	/// Distance of a point from the closest wall, negative outside [m].
	double depth(const SpaceVector<double>& x) const
	{
		double least = std::numeric_limits<double>::infinity();
		for (const SpecimenWall& wall : walls)
			least = std::min(least, wall.distance(x));
		return least;
	}
};

} // namespace yade::ddem
