// GPL v2 or later, see LICENSE.
// Engines that act on outer edges of deformable triangles.
#pragma once

#include <pkg/ddem/YadeInclude.hpp>
#include <pkg/ddem/kernel/triangles/EdgeTraction.hpp>
#include <pkg/ddem/kernel/triangles/Motion.hpp>

#include <map>
#include <vector>

namespace yade {

/// An edge of an EdgeEngine as the arrays of triangles have it.
struct OuterEdge {
	std::size_t               given;      ///< place in EdgeEngine.edges
	bool                      turned;     ///< whether it was given from end to start
	std::size_t               start, end; ///< rows of its nodes; the material lies on the left
	std::size_t               atStart, atEnd; ///< places of these nodes in Motion::loads
	std::size_t               triangle;       ///< its row
	ddem::PlaneVector<double> reference;      ///< from start to end at the beginning [m]
	double                    length, thickness; ///< at the beginning [m]
	ddem::WaveImpedance       impedance;         ///< of its triangle's material, undamaged

	/// From start to end now [m].
	ddem::PlaneVector<double> now(const ddem::Points& node) const
	{
		return { node.position[2 * end] - node.position[2 * start],
			 node.position[2 * end + 1] - node.position[2 * start + 1] };
	}
};

/// Those of an EdgeEngine's edges that belong to the arrays of one DeformableEngine.
struct OwnEdges {
	std::vector<OuterEdge>            edges;
	std::map<Body::id_t, std::size_t> place; ///< of their nodes in Motion::loads
};

class EdgeEngine : public GlobalEngine {
public:
	virtual ~EdgeEngine() = default;

	/// Nothing but a look whether anybody heeds the engine: DeformableEngine asks it within its own step.
	void action() override;
	/// Adds what acts at a time [s] on those of the edges that belong to these arrays.
	virtual void act(const OwnEdges&, Real, ddem::Motion&) const { }
	/// Changes whenever edges do; no two engines have the same.
	unsigned long changes() const { return counter; }

	void postLoad(EdgeEngine&);

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS(EdgeEngine, GlobalEngine,
		"What acts on outer edges of :yref:`DeformableTriangle` bodies: the part that :yref:`EdgeTraction` and "
		":yref:`AbsorbingEdge` share; alone it does nothing. :yref:`DeformableEngine` asks it in each of its "
		"steps, so its place in O.engines does not matter, State is not written for it, and a scene without "
		"it pays nothing.\n\n"
		"Errors: an edge that is no outer edge of a triangle, or given twice; O.engines without a "
		"DeformableEngine.",
		((vector<Vector2i>,edges,,Attr::triggerPostLoad,
			"Outer edges, as pairs of body ids of their two nodes (``block.edges(\"right\")``); either "
			"order"))
	);
	// clang-format on

private:
	unsigned long counter = 0;
};
REGISTER_SERIALIZABLE(EdgeEngine);

} // namespace yade
