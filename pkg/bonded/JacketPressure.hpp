// GPL v2 or later, see LICENSE.
// Pressure of a flexible jacket on spheres, as in a triaxial cell.
#pragma once

#include <pkg/bonded/kernel/Membrane.hpp>
#include <pkg/ddem/YadeInclude.hpp>

namespace yade {

class BondedSpheres;

class JacketPressure : public GlobalEngine {
public:
	virtual ~JacketPressure() = default;
	void action() override;
	void postLoad(JacketPressure&);
	/// Pressure at a time [Pa].
	Real pressureAt(Real time) const;
	Real pyPresent() const { return pressureAt(Omega::instance().getScene()->time); }
	Real pyVolume();
	Real pyArea();
	Real pyTurned();
	std::vector<Vector3r> pyNodes();

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(JacketPressure, GlobalEngine,
		"Pressure of a flexible jacket on spheres beneath it, as in a triaxial cell: a membrane of triangles "
		"whose nodes move with spheres, each with the weighted mean of those next to it. "
		"``ddem.bonded.jacket`` makes one around a sample.\n\n"
		"Each face is pushed by the pressure times its present area, against its normal, a third at each node, "
		"so that what the pressure does on a closed membrane is exactly :math:`-p\\,\\mathrm dV`. Each sphere "
		"feels its share of its nodes at its centre: the membrane is smooth and exerts no moment on it, nor "
		"all of it about the specimen's :yref:`axis<JacketPressure.axis>`: what moment the forces have about "
		"it, as they act beside the nodes, is taken away by the smallest change of them. The pressure grows "
		"from 0 as :math:`\\tfrac12(1-\\cos\\pi\\tau)`, :math:`\\tau` from 0 to 1 in "
		":yref:`rampTime<JacketPressure.rampTime>`, and stays.\n\n"
		"A sphere that breaks off keeps its share of its nodes: the membrane holds it, and follows it. "
		"Place the engine between the interaction loop and :yref:`ViscousBodyDamping` or "
		":yref:`NewtonIntegrator`. Its work is *jacketWork* in :yref:`O.energy<Omega.energy>` (negative: "
		"it comes from outside).\n\n"
		"Errors: ValueError for numbers out of range, columns that differ in length, nodes or spheres that are "
		"not there; RuntimeError for a place in O.engines where its forces would be lost, for a sphere that "
		"has been erased, and where more than :yref:`largestTurned<JacketPressure.largestTurned>` of the "
		"membrane is inside out. Limits: no stiffness, mass or friction of the rubber; spheres that carry "
		"no node are not held where they get out between others.",
		((Real,pressure,0,Attr::triggerPostLoad,"Pressure that presses inwards, after the ramp [Pa]"))
		((Real,rampTime,0,Attr::triggerPostLoad,"Time in which it grows from 0 [s]; 0: at once"))
		((Real,startTime,NaN,,"Time at which it begins to grow [s]; NaN: at the engine's first step"))
		((vector<Body::id_t>,ids,,Attr::triggerPostLoad,"Spheres that carry nodes"))
		((vector<Vector3r>,offsets,,Attr::triggerPostLoad,
			"From the weighted mean of its spheres' centres to each node [m]; keeps its direction in "
			"space"))
		((vector<Vector2i>,supports,,Attr::triggerPostLoad,
			"Pairs of a node and a sphere that carries it, a place in *ids*"))
		((vector<Real>,weights,,Attr::triggerPostLoad,
			"Share of each of these in the node [-]; those of a node add up to 1"))
		((vector<Vector3i>,faces,,Attr::triggerPostLoad,
			"Nodes of each face, so that the normal of the right hand points out"))
		((vector<Vector3i>,ends,,Attr::triggerPostLoad,
			"Faces that close the membrane, as faces; platens keep the pressure from them"))
		((vector<Vector3r>,normals,,Attr::triggerPostLoad,
			"Outward normal of each face as it was made [any length]"))
		((Vector3r,axis,Vector3r(0,1,0),Attr::triggerPostLoad,
			"Of the specimen, from end to end [-]; the jacket exerts no moment about it"))
		((Real,largestTurned,0.1,Attr::triggerPostLoad,
			"Share of the area that may be inside out, measured against *normals*, before the run "
			"stops [-]"))
		((int,lookEvery,100,Attr::triggerPostLoad,"Steps between two looks at that"))
		((Real,work,0,Attr::readonly,"Work done on the spheres so far [J], booked while energy is tracked"))
		((vector<Vector3r>,forces,,(Attr::readonly|Attr::hidden),"On the spheres in the last step [N]"))
		((int,workIx,-1,(Attr::hidden|Attr::noSave),"Place of jacketWork in the energy tracker")),
		/*ctor*/,
		.add_property("present",&JacketPressure::pyPresent,"Pressure at the present time [Pa]")
		.add_property("volume",&JacketPressure::pyVolume,"Volume within the membrane and its ends [m³]")
		.add_property("area",&JacketPressure::pyArea,"Area under pressure [m²]")
		.def("nodes",&JacketPressure::pyNodes,"Present places of the nodes [m]")
		.add_property("turned",&JacketPressure::pyTurned,"Share of that area that is inside out [-]")
	);
	// clang-format on

private:
	void build();
	void requirePlace() const;
	void readCentres(const BondedSpheres* arrays);
	void readState();
	Real addForces(BondedSpheres* arrays);
	void stopIfTurned() const;

	ddem::Membrane        membrane;
	std::vector<Vector3r> centres, now;
	bool                  built = false;
};
REGISTER_SERIALIZABLE(JacketPressure);

} // namespace yade
