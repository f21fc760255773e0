// GPL v2 or later, see LICENSE.
// The spheres that touch given spheres and walls: the problem of Apollonius, in closed form.
#pragma once

#include <pkg/ddem/kernel/algebra/SpaceVector.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace yade::ddem {

struct PackedSphere {
	SpaceVector<double> centre; ///< [m]
	double              radius; ///< [m]
};

/** What a sphere is to touch from the outside of a sphere, the inside of a hollow ball or the inner side of a plane.
 * Its distance from a point x is |x - at| - size, where a hollow ball has a negative size, or at·x - size for a plane,
 * whose *at* is the inward normal. */
struct Touched {
	SpaceVector<double> at;
	double              size; ///< [m]
	bool                flat;

	double distance(const SpaceVector<double>& x) const { return flat ? dot(at, x) - size : distanceOfCurved(x); }

private:
	double distanceOfCurved(const SpaceVector<double>& x) const
	{
		const double way = norm(x - at);
		return size < 0 ? -size - way : way - size;
	}
};

/** A line u + t v of the space of (centre, radius), all points of which solve *dimension* linear equations of
 * dimension + 1 unknowns. */
template <int dimension> struct SolutionLine {
	static constexpr int                          unknowns = dimension + 1;
	using Row = std::array<double, std::size_t(unknowns) + 1>; ///< coefficients and right-hand side
	std::array<double, std::size_t(unknowns)> u {}, v {};

	/// Gauss-Jordan elimination with full pivoting; false where the equations depend on each other.
	bool solve(std::array<Row, std::size_t(dimension)> rows)
	{
		constexpr double                         depends = 1e-12; // of rows with largest coefficient 1
		std::array<std::size_t, std::size_t(unknowns)> order {};
		for (std::size_t k = 0; k < order.size(); k++)
			order[k] = k;
		for (Row& row : rows) {
			double largest = 0;
			for (std::size_t k = 0; k < order.size(); k++)
				largest = std::fmax(largest, std::fabs(row[k]));
			if (!(largest > 0)) return false;
			for (double& value : row)
				value /= largest;
		}
		for (std::size_t step = 0; step < rows.size(); step++) {
			std::size_t best = step, column = step;
			for (std::size_t i = step; i < rows.size(); i++)
				for (std::size_t k = step; k < order.size(); k++)
					if (std::fabs(rows[i][order[k]]) > std::fabs(rows[best][order[column]])) {
						best   = i;
						column = k;
					}
			std::swap(rows[step], rows[best]);
			std::swap(order[step], order[column]);
			const double pivot = rows[step][order[step]];
			if (!(std::fabs(pivot) > depends)) return false;
			for (double& value : rows[step])
				value /= pivot;
			for (std::size_t i = 0; i < rows.size(); i++) {
				if (i == step) continue;
				const double factor = rows[i][order[step]];
				for (std::size_t k = 0; k < rows[i].size(); k++)
					rows[i][k] -= factor * rows[step][k];
			}
		}
		const std::size_t free = order.back();
		for (std::size_t step = 0; step < rows.size(); step++) {
			u[order[step]] = rows[step].back();
			v[order[step]] = -rows[step][free];
		}
		u[free] = 0;
		v[free] = 1;
		return true;
	}
};

/** The spheres that touch dimension + 1 things, two at most, in a layer (2) in the plane z = 0.
 *
 * About the centre of one of the curved things, of size s, let ρ = r + s; then |c|² = ρ². Subtracting this from the
 * equation of another one at q, with a size larger by δ, leaves q·c + δ ρ = (|q|² - δ²)/2, and a plane is linear from
 * the start. What solves these lies on a line, which meets the cone |c|² = ρ² twice at most.
 * Roots may be of the other sign of a distance, so that what they touch has to be looked at.
 *
 * \returns how many are in *found* */
template <int dimension>
int tangentSpheres(
        const std::array<Touched, std::size_t(dimension) + 1>& things, std::array<PackedSphere, 2>& found)
{
	using Line              = SolutionLine<dimension>;
	constexpr std::size_t d = std::size_t(dimension);
	const auto            component = [](const SpaceVector<double>& a, std::size_t k) {
                return k == 0 ? a.x : k == 1 ? a.y : a.z;
	};
	std::size_t reference = 0; // the last plane, where there are only planes
	while (reference < d && things[reference].flat)
		reference++;
	const Touched&            about  = things[reference];
	const SpaceVector<double> origin = about.flat ? SpaceVector<double> { 0, 0, 0 } : about.at;
	const double              size   = about.flat ? 0 : about.size;

	std::array<typename Line::Row, d> rows;
	std::size_t                       next = 0;
	for (std::size_t i = 0; i <= d; i++) {
		if (i == reference) continue;
		const Touched&            thing = things[i];
		const SpaceVector<double> q     = thing.flat ? thing.at : thing.at - origin;
		const double              delta = thing.size - size;
		auto&                     row   = rows[next++];
		for (std::size_t k = 0; k < d; k++)
			row[k] = component(q, k);
		row[d]     = thing.flat ? -1 : delta;
		row[d + 1] = thing.flat ? delta - dot(q, origin) : 0.5 * (dot(q, q) - delta * delta);
	}
	Line line;
	if (!line.solve(rows)) return 0;

	std::array<double, 2> roots {};
	int                   count = 0;
	const auto&           u = line.u;
	const auto&           v = line.v;
	if (about.flat) {
		double along = -v[d], rest = about.size + u[d];
		for (std::size_t k = 0; k < d; k++) {
			along += component(about.at, k) * v[k];
			rest -= component(about.at, k) * u[k];
		}
		roots[std::size_t(count++)] = rest / along;
	} else {
		double a = -v[d] * v[d], b = -u[d] * v[d], c = -u[d] * u[d]; // a t² + 2 b t + c = 0
		for (std::size_t k = 0; k < d; k++) {
			a += v[k] * v[k];
			b += u[k] * v[k];
			c += u[k] * u[k];
		}
		const double discriminant = b * b - a * c;
		if (!(discriminant >= 0)) return 0;
		const double sum            = -(b + std::copysign(std::sqrt(discriminant), b));
		roots[std::size_t(count++)] = sum / a;
		roots[std::size_t(count++)] = c / sum;
	}
	int solutions = 0;
	for (int i = 0; i < count; i++) {
		const double t = roots[std::size_t(i)];
		if (!std::isfinite(t)) continue;
		const SpaceVector<double> centre { u[0] + t * v[0], u[1] + t * v[1], d > 2 ? u[2] + t * v[2] : 0 };
		found[std::size_t(solutions++)] = { origin + centre, u[d] + t * v[d] - size };
	}
	return solutions;
}

} // namespace yade::ddem
