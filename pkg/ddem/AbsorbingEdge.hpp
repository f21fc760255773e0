// GPL v2 or later, see LICENSE.
// The engine that lets waves leave through edges of deformable triangles.
#pragma once

#include <pkg/ddem/EdgeEngine.hpp>

namespace yade {

class AbsorbingEdge : public EdgeEngine {
public:
	virtual ~AbsorbingEdge() = default;

	void act(const OwnEdges&, Real time, ddem::Motion&) const override;

	void postLoad(AbsorbingEdge&);

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS(AbsorbingEdge, EdgeEngine,
		"Viscous dashpots on outer edges of deformable triangles, which let waves leave the sample "
		"[Lysmer1969]_: the traction on an edge is\n\n"
		".. math:: \\mathbf t=-\\rho c_p\\,v_n\\,\\mathbf n-\\rho c_s\\,v_s\\,\\mathbf s,\\qquad "
		"c_p=\\sqrt{(K+\\tfrac43G)/\\rho},\\quad c_s=\\sqrt{G/\\rho}\n\n"
		"with density and undamaged moduli of the edge's triangle and directions of the beginning. Waves of "
		"normal incidence are absorbed but for what the mesh disperses; those that come at an angle are "
		"reflected in part (:doc:`/models/loads`).\n\n"
		"Dashpots bear no load that lasts: where a support is taken away for them, its reactions are to go on "
		"as :yref:`forces<AbsorbingEdge.forces>`; ``ddem.loading.absorb`` does that. A wave that comes from "
		"outside is the traction :math:`2\\rho c_p v` of an :yref:`EdgeTraction` on the same edges, :math:`v` "
		"being its velocity.\n\n"
		"Dashpots see the mean of the velocities before and after, so that the critical time step is that "
		"without them. With O.trackEnergy they book *edgeAbsorption* [J], and the work of the forces "
		"*edgeWork* (negative: it comes from outside).\n\n"
		"Errors: forces that are not as many as nodes, or on a node of none of the edges; those of "
		":yref:`EdgeEngine`. Limits: directions and moduli are those of the beginning; at rest nothing holds "
		"the edge in place, so that it drifts when the load changes.",
		((vector<Body::id_t>,nodes,,Attr::triggerPostLoad,"Nodes of the edges on which a force is kept"))
		((vector<Vector2r>,forces,,Attr::triggerPostLoad,"Forces kept on these nodes (x, y) [N]"))
	);
	// clang-format on
};
REGISTER_SERIALIZABLE(AbsorbingEdge);

} // namespace yade
