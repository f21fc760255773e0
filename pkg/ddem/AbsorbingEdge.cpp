// GPL v2 or later, see LICENSE.
#include <pkg/ddem/AbsorbingEdge.hpp>

#include <sstream>

namespace yade {

DDEM_PLUGIN((AbsorbingEdge))

void AbsorbingEdge::postLoad(AbsorbingEdge&)
{
	for (std::size_t i = 0; i < forces.size(); i++)
		if (!forces[i].allFinite()) {
			std::ostringstream text;
			text << "AbsorbingEdge.forces: (" << forces[i][0] << ", " << forces[i][1] << ") N at place "
			     << i << " must be finite";
			throw std::invalid_argument(text.str());
		}
}

void AbsorbingEdge::act(const OwnEdges& own, Real, ddem::Motion& motion) const
{
	if (nodes.size() != forces.size())
		throw std::invalid_argument(
		        "AbsorbingEdge: " + std::to_string(nodes.size()) + " nodes and " + std::to_string(forces.size())
		        + " forces; each node needs a force");
	for (const OuterEdge& edge : own.edges) {
		const auto damper = ddem::edgeDamper(edge.impedance, edge.reference, edge.length, edge.thickness);
		for (const std::size_t place : { edge.atStart, edge.atEnd }) {
			auto& sum = motion.loads[place].damper;
			sum       = { sum.xx + damper.xx, sum.yy + damper.yy, sum.xy + damper.xy };
		}
	}
	for (std::size_t i = 0; i < nodes.size(); i++) {
		const auto found = own.place.find(nodes[i]);
		if (found != own.place.end()) {
			auto& force = motion.loads[found->second].force;
			force       = force + ddem::PlaneVector<double> { forces[i][0], forces[i][1] };
			continue;
		}
		const bool elsewhere = std::any_of(edges.begin(), edges.end(), [&](const Vector2i& edge) {
			return edge[0] == nodes[i] || edge[1] == nodes[i];
		});
		if (!elsewhere)
			throw std::invalid_argument(
			        "AbsorbingEdge.nodes: body " + std::to_string(nodes[i])
			        + " is a node of none of the engine's edges");
	}
}

} // namespace yade
