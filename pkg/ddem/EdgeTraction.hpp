// GPL v2 or later, see LICENSE.
// The engine that loads edges of deformable triangles by pressure and tractions.
#pragma once

#include <pkg/ddem/EdgeEngine.hpp>

namespace yade {

class EdgeTraction : public EdgeEngine {
public:
	virtual ~EdgeTraction() = default;

	void act(const OwnEdges&, Real time, ddem::Motion&) const override;
	/// The course's factor at a time [s].
	Real factor(Real time) const;
	Real presentFactor() const;

	void postLoad(EdgeTraction&);

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(EdgeTraction, EdgeEngine,
		"Loads outer edges of deformable triangles: the traction on an edge is\n\n"
		".. math:: \\mathbf t=f(t)\\,(-p\\,\\mathbf n+q\\,\\mathbf s+\\mathbf t_0)\n\n"
		"with the outward normal :math:`\\mathbf n`, the direction :math:`\\mathbf s` along the border that "
		"has the material on its left, and the course :math:`f` of :yref:`times<EdgeTraction.times>` and "
		":yref:`factors<EdgeTraction.factors>`. Its forces on the two nodes of an edge do the work of the "
		"traction for displacements that are linear along the edge, as those of the triangles are: a uniform "
		"pressure gives a uniform stress.\n\n"
		"pressure, shear, traction, times and factors may be changed at any time. With O.trackEnergy the work "
		"enters *edgeWork* [J] (negative: it comes from outside). ``ddem.loading.pressure`` makes one.\n\n"
		"Errors: values that are not finite; times that do not rise or are not as many as the factors; a "
		"profile that has not a pair for each edge, or tractions that are not two for each; those of "
		":yref:`EdgeEngine`. Limits: plane strain; a pressure that follows is in equilibrium with stresses of "
		"the deformed edges, so the nominal stress of a triangle differs from it by the strain.",
		((Real,pressure,0,,"Normal pressure *p* [Pa], positive compresses"))
		((Real,shear,0,,"Shear traction *q* [Pa] along the border, counter-clockwise about the material"))
		((Vector2r,traction,Vector2r::Zero(),,
			"Traction **t**\\ :sub:`0` [Pa] of a fixed direction (x, y), per length as pressure is"))
		((vector<Vector2r>,tractions,,Attr::triggerPostLoad,
			"Tractions [Pa] of each edge's own, added to the last: (x, y) at its first and at its second "
			"node, linear in between, so two for each edge; none: zero"))
		((bool,follower,true,,
			"Whether normal, direction and length are those of the edge as it is now (true), or of the "
			"beginning: a dead load"))
		((vector<Real>,times,,Attr::triggerPostLoad,
			"Times [s] of the course, rising; before and after them the first and the last factor hold"))
		((vector<Real>,factors,,Attr::triggerPostLoad,
			"Factor [-] of the load at each of :yref:`times<EdgeTraction.times>`, linear in between; none: "
			"1"))
		((vector<Vector2r>,profile,,Attr::triggerPostLoad,
			"Factors [-] at the two nodes of each edge, linear in between, such as those of a pressure "
			"that grows with depth; none: 1")),
		/*ctor*/,
		.add_property("factor",&EdgeTraction::presentFactor,"Factor of the course at the present time [-]")
	);
	// clang-format on
};
REGISTER_SERIALIZABLE(EdgeTraction);

} // namespace yade
