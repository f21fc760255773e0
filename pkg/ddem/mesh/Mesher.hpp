// GPL v2 or later, see LICENSE
// Conforming triangulation of a polygonal region by CGAL's Delaunay mesh generator.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace yade::ddem::mesh {

struct Point {
	double x, y; // [m]
};

/// A planar straight-line graph and the parts of it that stay empty. Segments may meet only in common points.
struct Domain {
	std::vector<Point>              points;   // [m]; points of no segment become inner nodes
	std::vector<std::array<int, 2>> segments; // indices into points;
	                                          // each segment is a union of triangle edges of the result
	std::vector<std::vector<int>>   holes;    // closed simple rings, as indices into points
};

/// What the triangles must satisfy.
struct Criteria {
	// no edge is longer than this times the size at the triangle's centroid
	double                                longestEdgeFactor;
	double                                smallestAngle; // [rad], at most guaranteedAngle()
	// wanted edge length [m] at (x, y) [m], positive; what it throws ends the meshing
	std::function<double(double, double)> size;
	int                                   smoothing;         // number of Lloyd iterations
	std::size_t                           largestCount;      // give up beyond so many triangles
	std::function<void()>                 tick;              // called now and then; may throw to stop
};

/// Triangles are counter-clockwise; every node belongs to a triangle.
struct Triangulation {
	std::vector<Point>              nodes;
	std::vector<std::array<int, 3>> triangles;
};

/// The largest bound on the smallest angle [rad] for which Ruppert's refinement is sure to end (where segments meet at
/// 60 degrees or more): sin² = 1/8.
double guaranteedAngle();

/// Fill the region bounded by the outermost segments, without the holes, with triangles.
/// Nodes on segments do not move during smoothing, and the angle bound is restored after it. Near two segments that
/// meet at less than 60 degrees the bound may be missed (no mesh can keep it there).
/// Throws std::invalid_argument when the count is exceeded.
/// Sources: CGAL manual, "2D Conforming Triangulations and Meshes"; Shewchuk, Comput. Geom. 22 (2002) 21.
Triangulation triangulate(const Domain&, const Criteria&);

} // namespace yade::ddem::mesh
