// GPL v2 or later, see LICENSE.
// The engine that moves nodes as one, by a table of forces and displacements.
#pragma once

#include <pkg/ddem/Exposure.hpp>
#include <pkg/ddem/kernel/triangles/RigidPlaten.hpp>

#include <boost/weak_ptr.hpp>

namespace yade {

class ServoPlaten : public GlobalEngine {
public:
	virtual ~ServoPlaten() = default;

	/// Nothing but a look whether anybody heeds the engine: DeformableEngine moves the platen in its own step.
	void action() override;
	/** Sets the platen for the next step of a sample; \returns whether its nodes belong to it.
	 * \throws std::invalid_argument for nodes that are none, that are not held along the axis, or that another
	 * engine drives, and for a table that cannot be. */
	bool prepare(const Scene& scene, Exposure& sample, ddem::RigidPlaten& platen);
	/// Takes up what the step has done.
	void finish(const Scene& scene, const ddem::RigidPlaten& platen);
	/// O.engines has changed.
	void lookAgain() { changed = true; }
	bool done() const { return leg >= Real(targets.size()); }

	void postLoad(ServoPlaten&);

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(ServoPlaten, GlobalEngine,
		"A rigid platen on nodes of deformable triangles: it moves them as one along "
		":yref:`direction<ServoPlaten.direction>`, by a table of legs that end at a force or at "
		"a displacement. The nodes must be held in that direction (``block.hold``); across it they are held or "
		"free as usual. ``ddem.servo`` makes one with stresses and strains.\n\n"
		"In a leg to a force it moves as the force, its dashpot and its mass have it,\n\n"
		".. math:: M\\dot v=F-P-c\\,v,\\qquad |v|\\le v_{max}\n\n"
		"with the force *P* of the sample and the mass of the nodes and "
		":yref:`mass<ServoPlaten.mass>`. Such a platen lowers no critical time step and has no gain: "
		":yref:`DeformableEngine` moves it within its own step, at the forces of then. In a leg to a "
		"displacement it moves as prescribed. Both go from what is there at the start of the leg to its target "
		"by :math:`\\tfrac12(1-\\cos\\pi\\tau)`, :math:`\\tau` from 0 to 1 in the duration, so that legs begin "
		"and end without a jolt; after the last it keeps the last force or stands still.\n\n"
		"Where the sample gives way, the platen in force control runs at its limit: once its force has fallen "
		"to :yref:`failure<ServoPlaten.failure>` times what is asked for and has not grown for a twentieth of "
		"the leg, it stops for good and :yref:`failed<ServoPlaten.failed>` is true. Its place in O.engines "
		"does not matter. Its work is *externalWork* in O.energy.\n\n"
		"Errors: tables whose columns differ in length, targets, durations, a limit, a mass or a dashpot out "
		"of range; a direction that is not along x or y; nodes that are not held or that a kinematic engine "
		"drives as well. Limits: a force lags behind by the dashpot's, *c v*.",
		((vector<Body::id_t>,ids,,Attr::triggerPostLoad,"Nodes that the platen moves"))
		((Vector3r,direction,Vector3r(0,-1,0),Attr::triggerPostLoad,
			"Way along which forces and displacements count, ±x or ±y; into the sample: compression "
			"positive"))
		((vector<string>,kinds,,Attr::triggerPostLoad,"Kind of each leg's target: 'force' or 'displacement'"))
		((vector<Real>,targets,,Attr::triggerPostLoad,
			"Force [N] or displacement since the start [m] at the end of each leg"))
		((vector<Real>,durations,,Attr::triggerPostLoad,"Duration of each leg [s]"))
		((Real,velocity,0.1,Attr::triggerPostLoad,"Largest speed in legs to a force [m/s]"))
		((Real,dashpot,0,Attr::triggerPostLoad,
			"Dashpot *c* [N·s/m]; that of the sample's waves, ρ c_p times the area, lets none come back"))
		((Real,mass,0,Attr::triggerPostLoad,"Mass of the platen's own [kg], beside that of its nodes"))
		((Real,failure,0,Attr::triggerPostLoad,
			"Share [-] of the force asked for below which a platen at its largest speed stops; 0: never"))
		((bool,failed,false,,"Whether the sample has given way and the platen stands still"))
		((Real,force,0,Attr::readonly,
			"Force of the sample on the platen in the last step [N], against its way, with weight and "
			"other loads of its nodes"))
		((Real,speed,0,Attr::readonly,"Speed of the platen along its way [m/s]"))
		((int,leg,0,Attr::readonly,"Present leg, from 0 on; the number of legs after the last"))
		((Real,legStart,NaN,Attr::readonly,"Time at which the present leg began [s]; NaN: it has not"))
		((Real,legFrom,0,(Attr::readonly|Attr::hidden),"Force or displacement at which it began"))
		((bool,idle,false,(Attr::readonly|Attr::hidden),"Whether all legs were done in the last step"))
		((Real,borne,0,(Attr::readonly|Attr::hidden),
			"Force when it last grew, in the sense of what is asked for [N]"))
		((Real,grewAt,NaN,(Attr::readonly|Attr::hidden),"Time at which it grew [s]"))
		((bool,legBegins,true,(Attr::readonly|Attr::hidden),"Whether that is still to be found")),
		/*ctor*/,
		.add_property("done",&ServoPlaten::done,"Whether all legs are done")
	);
	// clang-format on

private:
	boost::weak_ptr<ddem::TriangleSystem> known; ///< in which the nodes were looked up
	std::vector<std::size_t>            rows;
	bool                                changed = true;

	bool isForce(int ofLeg) const { return kinds[std::size_t(ofLeg)] == "force"; }
	void lookUp(const Scene& scene, Exposure& sample);
	void nextLegs(Real time);
};
REGISTER_SERIALIZABLE(ServoPlaten);

} // namespace yade
