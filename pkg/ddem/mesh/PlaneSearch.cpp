// GPL v2 or later, see LICENSE
// Order and conflicts of points, segments and triangles in the plane, with exact predicates.

#include <pkg/ddem/mesh/PlaneSearch.hpp>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/hilbert_sort.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <numeric>

namespace yade::ddem::mesh {

namespace {
	using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
	// a bounding box and the number of what it bounds
	using Box    = CGAL::Box_intersection_d::Box_with_info_d<double, 2, std::size_t>;

	std::vector<Kernel::Point_2> toKernel(const std::vector<Point>& points)
	{
		std::vector<Kernel::Point_2> result;
		result.reserve(points.size());
		for (const Point& p : points)
			result.emplace_back(p.x, p.y);
		return result;
	}

	// The lexicographically smallest of the pairs for which `conflict` says yes, so that the answer does not depend
	// on the order of the search.
	template <std::size_t corners, class Conflicts>
	std::optional<std::pair<std::size_t, std::size_t>> firstPair(
	        const std::vector<Kernel::Point_2>& points, const std::vector<std::array<int, corners>>& items,
	        const Conflicts& conflict)
	{
		std::vector<Box> boxes;
		boxes.reserve(items.size());
		for (std::size_t i = 0; i < items.size(); ++i) {
			CGAL::Bbox_2 bounds;
			for (const int corner : items[i])
				bounds += points[std::size_t(corner)].bbox();
			boxes.emplace_back(bounds, i);
		}
		std::optional<std::pair<std::size_t, std::size_t>> first;
		CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
			const std::pair<std::size_t, std::size_t> pair = std::minmax({ a.info(), b.info() });
			if ((!first || pair < *first) && conflict(pair.first, pair.second)) first = pair;
		});
		return first;
	}

	// Interiors of convex polygons are disjoint when the line through an edge of one of them separates them.
	bool separated(const std::array<Kernel::Point_2, 3>& a, const std::array<Kernel::Point_2, 3>& b)
	{
		for (std::size_t k = 0; k < 3; ++k) {
			if (std::none_of(b.begin(), b.end(), [&](const Kernel::Point_2& p) {
				    return CGAL::left_turn(a[k], a[(k + 1) % 3], p);
			    }))
				return true;
		}
		return false;
	}
}

std::vector<int> hilbertOrder(const std::vector<Point>& points)
{
	const auto               located = toKernel(points);
	std::vector<std::size_t> order(points.size());
	std::iota(order.begin(), order.end(), std::size_t(0));
	const auto place = CGAL::make_property_map(located);
	// The middle policy cuts cells in half geometrically: the true Hilbert curve, and unlike the median policy
	// indifferent to how points are spread.
	CGAL::hilbert_sort(
	        order.begin(), order.end(), CGAL::Spatial_sort_traits_adapter_2<Kernel, decltype(place)>(place),
	        CGAL::Hilbert_sort_middle_policy());
	return { order.begin(), order.end() };
}

std::optional<Crossing> firstCrossing(const std::vector<Point>& points, const std::vector<std::array<int, 2>>& segments)
{
	const auto located = toKernel(points);
	const auto segment = [&](std::size_t i) {
		return Kernel::Segment_2(located[std::size_t(segments[i][0])], located[std::size_t(segments[i][1])]);
	};

	const auto cross = [&](std::size_t i, std::size_t j) {
		for (const int end : segments[j]) {
			if (end == segments[i][0] || end == segments[i][1]) return false;
		}
		return CGAL::do_intersect(segment(i), segment(j));
	};
	const auto pair = firstPair(located, segments, cross);
	if (!pair) return std::nullopt;
	Kernel::Point_2 at = segment(pair->first).source();
	if (const auto common = CGAL::intersection(segment(pair->first), segment(pair->second))) {
		if (const auto* point = std::get_if<Kernel::Point_2>(&*common)) at = *point;
		else
			at = CGAL::midpoint(
			        std::get<Kernel::Segment_2>(*common).source(),
			        std::get<Kernel::Segment_2>(*common).target());
	}
	return Crossing { int(pair->first), int(pair->second), { at.x(), at.y() } };
}

std::optional<Conflict>
firstConflict(const std::vector<Point>& points, const std::vector<std::array<int, 3>>& triangles, double relativeGap)
{
	const auto located = toKernel(points);
	const auto corners = [&](std::size_t i) {
		const auto& t = triangles[i];
		return std::array<Kernel::Point_2, 3> { located[std::size_t(t[0])], located[std::size_t(t[1])],
			                                located[std::size_t(t[2])] };
	};
	// A node of triangle i inside an edge of triangle j, or -1.
	const auto hanging = [&](std::size_t i, std::size_t j) {
		for (const int node : triangles[i]) {
			const Kernel::Point_2& p = located[std::size_t(node)];
			for (std::size_t k = 0; k < 3; ++k) {
				const int a = triangles[j][k], b = triangles[j][(k + 1) % 3];
				if (node == a || node == b) continue;
				const auto edge = located[std::size_t(b)] - located[std::size_t(a)],
				           arm = p - located[std::size_t(a)];
				const double length2 = edge.squared_length(), along = edge * arm;
				if (along > 0 && along < length2
				    && std::abs(edge.x() * arm.y() - edge.y() * arm.x()) < relativeGap * length2)
					return node;
			}
		}
		return -1;
	};
	const auto conflict = [&](std::size_t i, std::size_t j) {
		const auto a = corners(i), b = corners(j);
		return (!separated(a, b) && !separated(b, a)) || hanging(i, j) >= 0 || hanging(j, i) >= 0;
	};
	const auto pair = firstPair(located, triangles, conflict);
	if (!pair) return std::nullopt;
	auto [i, j] = *pair;
	if (hanging(i, j) < 0 && hanging(j, i) >= 0) std::swap(i, j);
	return Conflict { int(i), int(j), hanging(i, j) };
}

} // namespace yade::ddem::mesh
