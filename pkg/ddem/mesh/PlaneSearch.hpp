// GPL v2 or later, see LICENSE
// Order and conflicts of points, segments and triangles in the plane, with exact predicates.
#pragma once

#include <pkg/ddem/mesh/Mesher.hpp>

#include <optional>

namespace yade::ddem::mesh {

/// Indices of the points in their order along a Hilbert curve; the same for the same points in every process.
std::vector<int> hilbertOrder(const std::vector<Point>&);

/// Two segments without a common point (by index) that cross, touch or overlap, and where.
struct Crossing {
	int   first, second; // indices of segments, first < second
	Point at;            // [m]
};
std::optional<Crossing> firstCrossing(const std::vector<Point>&, const std::vector<std::array<int, 2>>& segments);

/// Two counter-clockwise triangles whose interiors overlap (node < 0), or a node of the first that lies inside an edge
/// of the second ("hanging node").
struct Conflict {
	int first, second; // indices of triangles
	int node;
};
/// `relativeGap`: a node hangs on an edge when it is closer to it than this times the edge's length.
std::optional<Conflict>
firstConflict(const std::vector<Point>&, const std::vector<std::array<int, 3>>& triangles, double relativeGap);

} // namespace yade::ddem::mesh
