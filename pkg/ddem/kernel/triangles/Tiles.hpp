// GPL v2 or later, see LICENSE.
// Tiles: the pieces of a group of triangles that threads (and later domains) share out.
#pragma once

#include <cstddef>

namespace yade::ddem {

/// Triangles of a tile. Fixed, so that no result depends on the number of threads;
/// the state of a tile fits the level-2 cache.
constexpr std::size_t tileSize = 256;

/// Triangles of the widest batch. The last tile of a group is filled up to whole batches with copies of its last
/// triangle, so that every triangle is computed by the same instructions, whatever its place.
constexpr std::size_t widestBatch = 8;

/// Rows that a tile of so many triangles has room for.
constexpr std::size_t padded(std::size_t triangles)
{
	return (triangles + widestBatch - 1) / widestBatch * widestBatch;
}

constexpr std::size_t tilesOf(std::size_t triangles) { return (triangles + tileSize - 1) / tileSize; }

} // namespace yade::ddem
