// GPL v2 or later, see LICENSE.
// Spheres of very different sizes, found by place.
#pragma once

#include <pkg/bonded/kernel/packing/TangentSphere.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace yade::ddem {

/// The few things closest to a point, in ascending order of the distance of their surfaces.
class ClosestThings {
public:
	explicit ClosestThings(std::size_t number) : wanted(number) { }

	void offer(double distance, std::int32_t thing)
	{
		if (!(distance < limit())) return;
		std::size_t place = count < wanted ? count++ : wanted - 1;
		for (; place > 0 && distances[place - 1] > distance; place--) {
			distances[place] = distances[place - 1];
			things[place]    = things[place - 1];
		}
		distances[place] = distance;
		things[place]    = thing;
	}
	/// Distance from which on nothing is wanted any more [m].
	double limit() const
	{
		return count < wanted ? std::numeric_limits<double>::infinity() : distances[wanted - 1];
	}
	bool         full() const { return count == wanted; }
	std::int32_t operator[](std::size_t i) const { return things[i]; }

private:
	std::size_t                 wanted, count = 0;
	std::array<double, 4>       distances {};
	std::array<std::int32_t, 4> things {};
};

/** Spheres in grids of cells, one for each octave of radii, whose cells are as wide as its largest sphere: a search
 * looks at few spheres, however much radii differ. */
class SphereGrid {
public:
	/// \param lower, upper corners of the box that holds all centres [m]
	/// \param smallest, largest bounds of the radii [m]
	SphereGrid(
	        int                        dimension,
	        const SpaceVector<double>& lower,
	        const SpaceVector<double>& upper,
	        double                     smallest,
	        double                     largest);

	void                             add(const PackedSphere& sphere);
	const std::vector<PackedSphere>& spheres() const { return all; }

	/// Offers the spheres whose surfaces are closer to a point than *reach* [m], and maybe others.
	void offerAround(const SpaceVector<double>& point, double reach, ClosestThings& closest) const;

	/// Whether a sphere overlaps another one by more than a tolerance [m].
	bool overlaps(const PackedSphere& sphere, double tolerance) const;

private:
	struct Member {
		PackedSphere sphere;
		std::int32_t number; ///< in the order of adding
		std::int32_t next;   ///< in the same cell, -1: none
	};
	struct Octave {
		double                      largest;  ///< radius [m]
		double                      perMetre; ///< cells [1/m]
		std::array<std::int64_t, 3> cells;
		std::vector<std::int32_t>   first; ///< member in each cell, -1: none
		std::vector<Member>         members;
	};
	struct CellRange {
		std::int64_t from, to; ///< both inclusive
	};
	CellRange range(const Octave& octave, int axis, double centre, double reach) const;
	template <class Visit>
	bool visit(const Octave& octave, const SpaceVector<double>& point, double reach, const Visit& look) const;

	SpaceVector<double>       lower;
	double                    largest;
	std::vector<Octave>       octaves; ///< of the largest spheres first
	std::vector<PackedSphere> all;
};

} // namespace yade::ddem
