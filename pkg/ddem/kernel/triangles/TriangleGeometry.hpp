// GPL v2 or later, see LICENSE.
// Reference geometry of a deformable triangle: centroid, lever arms, area, and what makes a triangle unusable.
#pragma once

#include <pkg/ddem/kernel/algebra/PlaneVector.hpp>

#include <array>

namespace yade::ddem {

/** Stress-free geometry of a triangle, seen from its mass centre.
 *
 * Vertices are counter-clockwise. The lever arms r_e = X_e − X_i of eq. 1 sum to zero, so two of them and the
 * thickness describe the whole element, and the three sub-elements (centre, X_k, X_k+1) have the same area S/3.
 */
template <class Number> struct TriangleReference {
	std::array<PlaneVector<Number>, 3> arm; ///< r_e [m]

	TriangleReference() = default;
	TriangleReference(const PlaneVector<Number>& first, const PlaneVector<Number>& second)
	        : arm { first, second, -(first + second) }
	{
	}
	/// Twice the area of one sub-element [m²]: r_k × r_k+1, the same for all three.
	Number twiceSubArea() const { return cross(arm[0], arm[1]); }
	/// Area S of the triangle [m²].
	Number area() const { return Number(1.5) * twiceSubArea(); }
};

/// Mass centre of a triangle [m].
inline PlaneVector<double> centroid(const std::array<PlaneVector<double>, 3>& vertex)
{
	return { (vertex[0].x + vertex[1].x + vertex[2].x) / 3, (vertex[0].y + vertex[1].y + vertex[2].y) / 3 };
}

/** Reference geometry from the vertices' stress-free positions [m].
 * \throws std::invalid_argument for coordinates that are not finite, for clockwise order, and for a triangle whose
 * smallest height is less than 1e-10 of its longest edge (its strain would be round-off).
 * The message says which, with the coordinates.
 */
TriangleReference<double> makeReference(const std::array<PlaneVector<double>, 3>& vertex);

/// Smallest height of the triangle [m]: twice the area over the longest edge.
double smallestHeight(const TriangleReference<double>& reference);

} // namespace yade::ddem
