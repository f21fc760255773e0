// GPL v2 or later, see LICENSE.
// Random packings of touching spheres by insertion.
#pragma once

#include <pkg/bonded/kernel/packing/SpecimenWalls.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace yade::ddem {

struct PackingOrder {
	double        smallest, largest;  ///< radii [m]
	std::uint64_t seed;               ///< same seed, same bits, on any machine
	std::uint64_t fails;              ///< it is finished when so many points in a row gave no sphere
	std::function<void()> tick = {};  ///< called now and then; may throw
};

struct InsertionPacking {
	std::vector<PackedSphere> spheres; ///< seeds first
	std::size_t               seeds;   ///< how many; every other sphere touches dimension + 1 of those before it
	                                   ///< or of the walls
};

/** Fills a convex specimen with spheres that touch but do not overlap [Place & Mora 2001, in: Bifurcation and
 * Localisation Theory in Geomechanics, 295-307], as the packer of GenGeo does.
 *
 * Seeds, a close packing of the largest spheres that is jittered and shrunk at random to at most the mean radius,
 * then insertions: the four spheres or walls (three in a layer) closest to a random point determine a sphere, which
 * stays where its radius is in the range and where it is clear of all others. */
InsertionPacking fillSpecimen(const Specimen& specimen, const PackingOrder& order);

} // namespace yade::ddem
