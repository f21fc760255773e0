// GPL v2 or later, see LICENSE.
// Which nodes the triangles have, and which triangles meet at a node.
#pragma once

#include <pkg/ddem/kernel/algebra/ReservedArray.hpp>
#include <pkg/ddem/kernel/triangles/TriangleGeometry.hpp>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace yade::ddem {

/// Corner e of triangle i, as a number: triangles of corner 0 first, then those of corner 1, then of corner 2.
using CornerIndex = std::uint32_t;

/** Nodes of triangles, their reference shapes, and the corners of every node.
 * Address space is kept for three nodes a triangle, so that nodes may split without an array of nodes moving. */
class Topology {
public:
	std::array<std::vector<std::int32_t>, 3> vertex; ///< node of corner e of every triangle, counter-clockwise
	std::array<std::vector<double>, 4>       arm; ///< r_1x, r_1y, r_2x, r_2y of every triangle [m];
	                                              ///< r_3 = −r_1 − r_2

	std::size_t triangles() const { return vertex[0].size(); }
	std::size_t nodes() const { return cornerStart.empty() ? 0 : cornerStart.size() - 1; }
	/// Nodes that there will ever be at most: each corner has its own.
	static std::size_t nodeCapacity(std::size_t triangles) { return 3 * triangles; }

	void addTriangle(const std::array<std::int32_t, 3>& nodes, const TriangleReference<double>& reference);
	/// Lists the corners of every node. \throws std::logic_error if sizes disagree or a node index is out of range.
	void connect(std::size_t nodes);

	/// Corners of a node, in ascending order.
	std::pair<const CornerIndex*, const CornerIndex*> corners(std::size_t node) const
	{
		return { corner.data() + cornerStart[node], corner.data() + cornerStart[node + 1] };
	}
	CornerIndex cornerIndex(std::size_t triangle, std::size_t e) const
	{
		return CornerIndex(e * triangles() + triangle);
	}

	TriangleReference<double> reference(std::size_t triangle) const
	{
		return TriangleReference<double>(
		        { arm[0][triangle], arm[1][triangle] }, { arm[2][triangle], arm[3][triangle] });
	}

private:
	std::vector<std::size_t> cornerStart; ///< nodes + 1: where a node's corners begin in corner
	std::vector<CornerIndex> corner;      ///< by node
};

} // namespace yade::ddem
