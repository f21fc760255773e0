// GPL v2 or later, see LICENSE.
// The engine that computes and moves deformable triangles of a scene.
#pragma once

#include <pkg/ddem/EdgeLoading.hpp>
#include <pkg/ddem/EngineOrder.hpp>
#include <pkg/ddem/Exposure.hpp>
#include <pkg/ddem/Onlookers.hpp>
#include <pkg/ddem/TimeStepGuard.hpp>

#include <mutex>

namespace yade {

struct SampleSettings;

class DeformableEngine : public GlobalEngine {
public:
	/// Leaves State as the arrays are: who comes after takes it from there.
	virtual ~DeformableEngine();

	void action() override;

	/// The sample with a triangle's row in the present scene, with what was changed in the triangle's State taken
	/// up; null where there is none.
	static shared_ptr<Exposure> currentOf(const shared_ptr<Exposure>& sample, std::size_t row);
	/// Lets all engines in O.engines read the scene, for what has not been read.
	static void readScene();
	/// The engines of this class in a scene.
	static std::vector<DeformableEngine*> in(const Scene& scene);

	/// Builds the arrays from the scene's bodies unless they are up to date.
	void readIfNeeded(Scene& of);
	/// What Python reads goes through here: the arrays, with what was changed in State taken up.
	Exposure& current();
	Real      criticalTimeStep();
	/// Bound on the time step [s] while a step is under way; a result of at least `enough` says no more.
	Real stableStep(Scene& of, Real enough);
	/// Whether the time step has yet to be compared with the bound of the present triangles:
	/// they or O.dt have changed.
	bool                  timeStepUnchecked(Scene& of);
	Real                  timeStepOfScene() const;
	boost::python::tuple  rulingTriangle();
	boost::python::object array(const std::string& name);
	boost::python::object values(const std::string& name);
	boost::python::list   fields();
	boost::python::list   groups();

	void preSave(DeformableEngine&);
	void postSave(DeformableEngine&);
	void postLoad(DeformableEngine&);

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(DeformableEngine, GlobalEngine,
		"Computes internal forces of all :yref:`DeformableTriangle` bodies and moves their cores and nodes by "
		"leapfrog, with the scheme of :yref:`NewtonIntegrator` [Zubelewicz2018]_.\n\n"
		"It keeps their state in arrays of its own and takes its bodies out of NewtonIntegrator (by "
		":yref:`NewtonIntegrator.mask`), which costs five to ten times as much. To the user bodies stay "
		"bodies: blockedDOFs, prescribed vel, forces that other engines add and changes made from Python are "
		"honoured; :yref:`State` is written back whenever somebody may look (end of a run, O.step, periodic "
		"engines that are due, engines of unknown kind). For the commands of :yref:`PyRunner` it is written "
		"back body by body, when Python reads it, so that a command costs what it looks at; functions that may "
		"read any body (utils.kineticEnergy, O.save …) have all written back.\n\n"
		"Place it after the engines that add forces and after :yref:`ForceResetter`. Results are the same, bit "
		"by bit, for any number of threads.\n\n"
		"Errors: a time step above :yref:`criticalTimeStep<DeformableEngine.criticalTimeStep>`, engines in the "
		"wrong order, unusable triangles and a state that is not finite stop the run with the body, its place "
		"and the way out.\n\n"
		"Limits: plane strain in the xy plane; topology is fixed once running (appending triangles is "
		"possible, erasing is not). While a run goes on in the background, State seen from other threads is up "
		"to 0.2 s old (older in large samples, so that showing it takes a fiftieth of the time at most); "
		"after O.pause(), reading anything from the engine brings it up to date.",
		((std::string,rotation,"cosserat",Attr::triggerPostLoad,
			"How elements follow rotation: 'cosserat' (cores rotate, tied by "
			":yref:`rotationStiffness<DeformableElastMat.rotationStiffness>`), 'corotational' (frame from "
			"the polar decomposition of the vertices' deformation, no rotational inertia) or 'none' (small "
			"rotations, cheapest)."))
		((Real,vertexShare,1./6,Attr::triggerPostLoad,
			"Share :math:`\\alpha` [-] of a triangle's mass that sits in its vertices, a third of it in "
			"each; below 1/4 with 'cosserat'. Governs the stable time step."))
		((Vector3r,gravity,Vector3r::Zero(),,
			"Acceleration [m/s²] of nodes and cores; the z component is ignored. Zero: that of "
			":yref:`NewtonIntegrator.gravity` where O.engines has one."))
		((Real,damping,-1,,
			"Coefficient [-] of Cundall's local non-viscous damping, as :yref:`NewtonIntegrator.damping`. "
			"Negative: none, and a NewtonIntegrator with a damping other than YADE's default is refused, "
			"since triangles would not feel it."))
		((int,groupMask,1<<20,Attr::triggerPostLoad,
			"Group bit given to deformable bodies (:yref:`Body.groupMask`) and taken out of "
			":yref:`NewtonIntegrator.mask`. Where O.engines has several DeformableEngine each needs a bit "
			"of its own."))
		((int,flowInterval,1,Attr::triggerPostLoad,
			"Steps from one solution of viscoplastic flow to the next; in between undamaged triangles are "
			"elastic with the plastic strain they have, and damaged ones flow in every step. Cheaper, and "
			"for monotone strain off by no more than the stress that the strain of so many steps makes "
			"(E m Δε); vibrations faster than the interval flow less. Refused above 1 with an equation of "
			"state, whose moduli would change in jumps and shake the sample."))
		((std::string,inverted,"stop",Attr::triggerPostLoad,
			"What to do when a triangle is inside out, that is, its vertices have changed their sense: "
			"'stop' the run with the triangle, its place and the ratio of its areas, or 'warn' once. "
			"Looked at every 50 steps (10 with an equation of state). A sample that is crushed beyond its "
			"bearing capacity may be let go on."))
		((std::vector<Body::id_t>,ids,,Attr::triggerPostLoad,
			"Ids of the triangles that this engine moves, with their nodes. Empty: those whose group mask "
			"has the engine's bit, and, where it is the only engine without ids, all that no other engine "
			"takes."))
		((vector<Real>,savedState,,Attr::hidden,"State of all deformable bodies in a saved scene"))
		((vector<string>,savedFields,,Attr::hidden,"Names of the fields of the laws' state in savedState"))
		((int,savedVersion,0,Attr::hidden,"Version of the saved state"))
		((bool,exposed,true,Attr::hidden,"Whether State agreed with the arrays when saved")),
		/*ctor*/,
		.def("criticalTimeStep",&DeformableEngine::criticalTimeStep,
			"Rigorous bound on a constant time step [s]: 2/ω of the stiffest element, in its present shape "
			"(cores of stretched elements need smaller steps) and at the present pressure of the equation "
			"of state, with undamaged moduli. Works before the first step; :yref:`DeformableTimeStepper` "
			"keeps O.dt below it. Limits: the stiffness that stress itself adds is left out (about "
			"σ/(μβ_φ) with a vertexShare from 0.2, nothing below); with the equation of state much shear "
			"under little pressure can raise frequencies by several per cent; a step that changes in every "
			"step is unstable well below the bound.")
		.def("timeStepOfScene",&DeformableEngine::timeStepOfScene,
			"The same bound [s] for the triangles of the scene, from this engine's settings, when the "
			"engine is not (yet) in O.engines.")
		.def("rulingTriangle",&DeformableEngine::rulingTriangle,
			"The triangle that rules the time step, as (body id, its own bound [s]).")
		.def("array",&DeformableEngine::array,(boost::python::arg("name")),
			"Numpy view, without a copy, of a state array of the whole sample; rows in the order of "
			":yref:`DeformableEngine.values` 'nodeIds' and 'triangleIds'.\n\n"
			"nodePosition, nodeVelocity, nodeForce (nodes, 2) [m, m/s, N]; nodeMass (nodes,) [kg]; "
			"corePosition, coreVelocity, coreForce (triangles, 2); coreMass (triangles,) [kg]; "
			"coreRotation, coreSpin (triangles,) [rad, rad/s] where cores rotate. Forces are the internal "
			"forces of the last step. A view shows the arrays as long as they are the same; "
			"where triangles are added or a material or setting changes, arrays are made anew and an older "
			"view keeps what it showed. Write to State rather than to a view.")
		.def("values",&DeformableEngine::values,(boost::python::arg("name")),
			"Numpy array, computed now, of a quantity of the whole sample.\n\n"
			"nodeIds (nodes,), triangleIds (triangles,): body ids; vertices (triangles, 3): row numbers of "
			"the nodes; reaction (nodes, 2) [N]: what held them in the last step, zero where they are "
			"free; area, rotation (triangles,) [m², rad]; stress, strain (triangles, 3, 4): xx, yy, "
			"zz, xy of the sub-elements in global axes [Pa, -], at the current positions; damage "
			"(triangles, 3) [-]: η/η_max; fractureEnergy (triangles,) [J/m³]; tilePlace (triangles,): "
			"place in the tiles, by which sums are taken. Any field that a law remembers, by its name "
			"(:yref:`DeformableEngine.fields`): (triangles, 3), or (triangles, 3, 4) in global axes for "
			"tensors; zero where a triangle's law has no such field.")
		.def("fields",&DeformableEngine::fields,
			"What the laws of this engine's triangles remember: a list of (name, unit, components).")
		.def("groups",&DeformableEngine::groups,
			"Groups of triangles that share law, effects and thickness: a list of dicts with law, material "
			"(label), thickness [m], first and count (rows), effects (names of those on), effectsOff, "
			"bytes (of state per triangle), fields.")
	);
	// clang-format on
	DECLARE_LOGGER;

private:
	shared_ptr<Exposure>                  sample;
	std::mutex                            acting; ///< held during a step
	EngineOrder                           order;
	TimeStepGuard                         guard;
	EdgeLoading                           edgeLoading;
	bool                                  stale   = true; ///< settings changed since the arrays were built
	bool                                  virgin  = false; ///< the arrays were built from State alone,
	                                                       ///< and no step was made
	unsigned long                         syncs   = 0;     ///< of O.forces,
	                                                       ///< as many as there were after the last step
	Showings                              showings;
	/// Places in O.energy, by the names of ddem::StepEnergy.
	struct {
		int kinetic = -1, elastic = -1, rotation = -1, plastic = -1, damage = -1, gravityWork = -1,
		    externalWork = -1, dampingLoss = -1, edgeWork = -1, edgeAbsorption = -1;
	} entry;

	ddem::RotationTreatment rotationTreatment() const;
	SampleSettings          settings(const Scene& of) const;
	StateStore              stateToCarry(const Scene&) const;
	bool                    upToDate(Scene& of);
	bool                    agrees() const { return sample ? sample->shown == Shown::All : exposed; }
	void                    takeUpChanges(Scene& of);
	void                    takeUpEverything(Scene& of);
	bool                    forcesAdded(bool anythingDone) const;
	/// To be held while arrays are read or changed from outside of a run.
	std::unique_lock<std::mutex> betweenSteps();
	/// Sets the platens of the next step; \returns theirs, in the order of the system's.
	std::vector<ServoPlaten*> preparePlatens();
	void                    show();
	void                    checkStart() const;
	void                    bookEnergy(const ddem::StepEnergy&);
	[[noreturn]] void       stopAtNotFinite();
};
REGISTER_SERIALIZABLE(DeformableEngine);

} // namespace yade
