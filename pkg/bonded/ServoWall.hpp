// GPL v2 or later, see LICENSE.
// Moves walls by a table of forces and displacements.
#pragma once

#include <pkg/ddem/YadeInclude.hpp>

namespace yade {

class ServoWall : public KinematicEngine {
public:
	virtual ~ServoWall() = default;
	void apply(const vector<Body::id_t>& ids) override;
	void postLoad(ServoWall&);
	/// Mean way of the bodies since the start [m].
	Real place(const Scene& of) const;
	Real pyDisplacement() const { return place(*Omega::instance().getScene()); }
	bool done() const { return leg >= int(targets.size()); }

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(ServoWall, KinematicEngine,
		"A rigid platen on bonded spheres or other bodies: it moves walls, boxes or facets as one along "
		":yref:`direction<ServoWall.direction>`, by a table of legs that end at a force or at a displacement. "
		"``ddem.bonded.servo`` makes one with stresses and strains; :yref:`ServoPlaten` is the same for "
		"deformable triangles.\n\n"
		"In a leg to a force it moves as the force, its dashpot and its mass have it,\n\n"
		".. math:: M\\dot v=F-P-c\\,v,\\qquad |v|\\le v_{max}\n\n"
		"with the force *P* of the sample on it. With a mass well above that of a sphere it lowers no critical "
		"time step, and there is no gain to be tuned. In a leg to a displacement it moves as prescribed. "
		"Both go from what is there at the start of the leg to its target by "
		":math:`\\tfrac12(1-\\cos\\pi\\tau)`, :math:`\\tau` from 0 to 1 in the duration, so that legs begin "
		"and end without a jolt; after the last it keeps the last force or stands still. Place it after the "
		"engines that add forces and before :yref:`NewtonIntegrator`. Its work on the sample is *externalWork* "
		"in :yref:`O.energy<Omega.energy>`.\n\n"
		"Where the sample gives way, a wall in force control runs at its limit: once its force has fallen "
		"to :yref:`failure<ServoWall.failure>` times what is asked for and has been borne before, it stops for "
		"good and :yref:`failed<ServoWall.failed>` is true.\n\n"
		"Errors: RuntimeError for a place in O.engines where it sees no forces; ValueError for columns of the "
		"table that differ in length, unknown kinds, numbers out of range, a direction of no length. Limits: "
		"a force lags behind by the dashpot's, *c v*.",
		((Vector3r,direction,Vector3r(0,-1,0),Attr::triggerPostLoad,
			"Way along which forces and displacements count [-], into the sample: compression positive"))
		((vector<std::string>,kinds,,Attr::triggerPostLoad,
			"Kind of each leg's target: 'force' or 'displacement'"))
		((vector<Real>,targets,,Attr::triggerPostLoad,
			"Force [N] or displacement since the start [m] at the end of each leg"))
		((vector<Real>,durations,,Attr::triggerPostLoad,"Duration of each leg [s]"))
		((Real,velocity,0.1,Attr::triggerPostLoad,"Largest speed in legs to a force [m/s]"))
		((Real,mass,1,Attr::triggerPostLoad,
			"Mass *M* of the platen [kg]; half that of the sample is a good one"))
		((Real,dashpot,0,Attr::triggerPostLoad,
			"Dashpot *c* [N·s/m]; that of the sample's waves, ρ c_p times the area, lets none come back"))
		((Real,failure,0,Attr::triggerPostLoad,
			"Share [-] of the force asked for below which a platen at its largest speed stops; 0: never"))
		((bool,failed,false,,"Whether the sample has given way and the platen stands still"))
		((Real,force,0,Attr::readonly,
			"Force of the sample on the platen in the last step [N], against its way"))
		((Real,speed,0,Attr::readonly,"Speed of the platen along its way [m/s]"))
		((Real,work,0,Attr::readonly,"Work done on the sample so far [J], booked while energy is tracked"))
		((int,leg,0,Attr::readonly,"Present leg, from 0 on; the number of legs after the last"))
		((Real,legStart,NaN,Attr::readonly,"Time at which the present leg began [s]; NaN: it has not"))
		((Real,legFrom,0,(Attr::readonly|Attr::hidden),"Force or displacement at which it began"))
		((Real,borne,0,(Attr::readonly|Attr::hidden),
			"Largest force so far, in the sense of what is asked for [N]"))
		((bool,idle,false,(Attr::readonly|Attr::hidden),"Whether all legs were done in the last step"))
		((Real,lastTime,NaN,(Attr::readonly|Attr::hidden),"Time of the last step [s]"))
		((long,lastIter,-1,(Attr::readonly|Attr::hidden),"Number of the last step"))
		((bool,legBegins,true,(Attr::readonly|Attr::hidden),"Whether that is still to be found"))
		((int,workIx,-1,(Attr::hidden|Attr::noSave),"Place of externalWork in the energy tracker")),
		/*ctor*/,
		.add_property("displacement",&ServoWall::pyDisplacement,"Way of the platen since the start [m]")
		.add_property("done",&ServoWall::done,"Whether all legs are done")
	);
	// clang-format on

private:
	Real forceWanted(Real found);
	Real speedWanted(Real found) const;
	void keepTime();
	void requireOrder() const;
	Real share(Real time) const;
	bool isForce() const { return kinds[size_t(std::min(leg, int(kinds.size()) - 1))] == "force"; }
};
REGISTER_SERIALIZABLE(ServoWall);

} // namespace yade
