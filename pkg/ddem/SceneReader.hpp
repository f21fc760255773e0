// GPL v2 or later, see LICENSE.
// Reads deformable bodies of a scene into arrays.
#pragma once

#include <pkg/ddem/Exposure.hpp>
#include <pkg/ddem/StateStore.hpp>

namespace yade {

/// What an engine says about the triangles that it moves.
struct SampleSettings {
	ddem::RotationTreatment rotation    = ddem::RotationTreatment::Cosserat;
	Real                    vertexShare = 1. / 6;
	int                     groupMask   = 0;     ///< bit of its bodies
	std::vector<Body::id_t> ids;                 ///< its triangles; empty: those with its bit, and those with none
	int                     otherBits   = 0;     ///< of the other engines in the scene
	std::vector<Body::id_t> otherIds;            ///< taken by other engines
	bool                    shared      = false; ///< another engine takes bodies without a bit as well
	bool                    energy      = false; ///< whether the energy book is open
	int                     flowInterval = 1;    ///< see ddem::LawGroup::flowInterval
};

/// The triangles that an engine takes, in the order of their ids. \throws std::invalid_argument as readScene does.
std::vector<shared_ptr<Body>> trianglesOf(const Scene& scene, const SampleSettings& settings);

/** Builds arrays from the deformable bodies that an engine takes. Triangles of a kind (material, thickness) stand
 * together, in the order of their ids; nodes in the order of theirs. Bodies known from `known` keep that state;
 * the others start from State. Nothing is changed in the scene before all bodies have been checked.
 * \throws std::invalid_argument naming the body for: missing or wrong node bodies, wrong material, degenerate,
 * clockwise or duplicate triangles, nodes without triangles or at the same place, coordinates that are not finite,
 * nodes of two engines, no triangles at all.
 */
shared_ptr<Exposure> readScene(const Scene& scene, const SampleSettings& settings, const StateStore& known);

} // namespace yade
