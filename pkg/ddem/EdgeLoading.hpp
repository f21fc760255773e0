// GPL v2 or later, see LICENSE.
// Edge engines of a scene and the arrays of one DeformableEngine: which edge is where.
#pragma once

#include <pkg/ddem/EdgeEngine.hpp>
#include <pkg/ddem/Exposure.hpp>

#include <vector>

namespace yade {

class EdgeLoading {
public:
	/** Sets the loads of the nodes for a step.
	 * \param engines all in O.engines; those that are dead are left out.
	 * \throws std::invalid_argument for an edge that is no outer edge. */
	void apply(const Scene& scene, Exposure& sample, const std::vector<const EdgeEngine*>& engines);
	/// The arrays are new.
	void restart() { known.clear(); }
	/// Whether anything is loaded.
	bool active() const { return !known.empty(); }

private:
	using Version = std::pair<const EdgeEngine*, unsigned long>;
	std::vector<Version>  known; ///< engines whose edges were looked up, as they were then
	std::vector<OwnEdges> found; ///< theirs, in these arrays

	void lookUp(const Scene& scene, Exposure& sample);
};

} // namespace yade
