// GPL v2 or later, see LICENSE.
#include <pkg/ddem/kernel/triangles/TriangleGeometry.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace yade::ddem {

namespace {

	double longestEdge(const TriangleReference<double>& reference)
	{
		double longest = 0;
		for (int e = 0; e < 3; e++) {
			const PlaneVector<double> edge = reference.arm[(e + 1) % 3] - reference.arm[e];
			longest                        = std::max(longest, std::hypot(edge.x, edge.y));
		}
		return longest;
	}

	std::string describe(const std::array<PlaneVector<double>, 3>& vertex)
	{
		std::ostringstream text;
		text.precision(9);
		for (const auto& v : vertex)
			text << " (" << v.x << ", " << v.y << ")";
		return text.str() + " m";
	}

} // namespace

double smallestHeight(const TriangleReference<double>& reference)
{
	return 2 * reference.area() / longestEdge(reference);
}

TriangleReference<double> makeReference(const std::array<PlaneVector<double>, 3>& vertex)
{
	for (const auto& v : vertex)
		if (!std::isfinite(v.x) || !std::isfinite(v.y))
			throw std::invalid_argument(
			        "a vertex of the triangle" + describe(vertex) + " is not a finite number");
	const PlaneVector<double>       centre = centroid(vertex);
	const TriangleReference<double> reference(vertex[0] - centre, vertex[1] - centre);
	const double                    longest  = longestEdge(reference);
	constexpr double                flatness = 1e-10;
	if (!(std::abs(2 * reference.area()) > flatness * longest * longest))
		throw std::invalid_argument(
		        "the triangle" + describe(vertex)
		        + " is degenerate: its vertices lie on a line (or coincide), so it has no area; remesh or "
		          "remove it");
	if (reference.area() < 0)
		throw std::invalid_argument(
		        "the triangle" + describe(vertex)
		        + " is clockwise; vertices must be counter-clockwise: swap two of them (mesh.flipped() does it "
		          "for a mesh)");
	return reference;
}

} // namespace yade::ddem
