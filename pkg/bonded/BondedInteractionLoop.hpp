// GPL v2 or later, see LICENSE.
// An InteractionLoop that computes all bonds together.
#pragma once

#include <pkg/bonded/BondedArrays.hpp>
#include <pkg/bonded/BondedSpheres.hpp>
#include <pkg/bonded/BondedTimeStep.hpp>
#include <pkg/bonded/Law2_ScGeom_BondedPhys_Bonded.hpp>

#include <pkg/bonded/kernel/SpherePairs.hpp>
#include <pkg/ddem/Onlookers.hpp>

namespace yade {

class BondedInteractionLoop : public InteractionLoop, private LaggingState {
public:
	virtual ~BondedInteractionLoop() { pythonLooks::end(*this); }
	void action() override;

	/// Brings geometry and physics of the bonds' interactions up to the last step.
	void expose();
	/// Bonds that hold, as of the last step; safe while a run goes on. Empty where bonds are computed one by one.
	std::vector<BondNow> bondsNow() const;
	/// One quantity of spheres of the current scene, see yade::sphereArray.
	static boost::python::object sphereArray(const boost::python::object& ids, const std::string& name);
	/// Ids of bodies of the current scene that are there, see existingBodies.
	static boost::python::object existing(const boost::python::object& ids)
	{
		return existingBodies(*Omega::instance().getScene(), ids);
	}
	void preSave(BondedInteractionLoop&) { expose(); }
	/// Throws a runtime_error once all functors of this step have returned, as none may throw among them.
	void stopAfterStep(const std::string& text);

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(BondedInteractionLoop, InteractionLoop,
		"An :yref:`InteractionLoop`, with the same arguments, that computes bonds of :yref:`BondedPhys` all "
		"together instead of one by one: some at a time in SIMD lanes, then every particle collects the loads "
		"of its bonds in a fixed order. Pairs of spheres that may touch are searched and followed in the same "
		"arrays: what bonds and contacts of spheres do does not depend on the number of threads, bit by bit. "
		"All other interactions, as those with walls, run through the functors as usual; their sums depend on "
		"threads in the last digits, as in all of YADE.\n\n"
		"With a :yref:`BondedNewtonIntegrator` the spheres are moved in these arrays, too. With YADE's own "
		":yref:`NewtonIntegrator` their State is read and their loads are added to "
		":yref:`O.forces<Omega.forces>` in every step, which takes two and a half to four times as long.\n\n"
		":yref:`Interaction.geom`, forces and stresses of bonds are written back whenever somebody may look "
		"(end of a run, O.step, periodic engines that are due, engines of unknown kind; a :yref:`PyRunner` "
		"where it reads an interaction's geometry or physics). After O.pause() of "
		"a run in the background they may be a few steps old until "
		":yref:`bonds<Law2_ScGeom_BondedPhys_Bonded.bonds>` is called. Stiffnesses and radii changed by "
		"hand are taken up after such a look.\n\n"
		"Bonds are computed one by one where the base class must be asked: "
		"with :yref:`callbacks<InteractionLoop.callbacks>`, "
		":yref:`loopOnSortedInteractions<InteractionLoop.loopOnSortedInteractions>`, a number of threads of "
		"its own, or periodic boundaries.\n\n"
		"Errors: RuntimeError naming the bond where forces become infinite or not a number; naming the pair "
		"where O.dt is above the critical step "
		"(:yref:`criticalTimeStep<Law2_ScGeom_BondedPhys_Bonded.criticalTimeStep>`); "
		"and under mpirun with several processes.",
		/*attrs*/,
		/*ctor*/,
		.def("sphereArray",&BondedInteractionLoop::sphereArray,(boost::python::arg("ids"),
			boost::python::arg("name")),
			"One quantity of spheres of the scene, of any material, as a numpy array, a row for each id: "
			"*position*, *displacement* [m], *velocity* [m/s], *spin* [rad/s], *rotation* (vector, "
			"of a length up to π) [rad], *radius* [m]. Works without such an engine, too, and costs about "
			"10 ns a number.")
		.staticmethod("sphereArray")
		.def("existing",&BondedInteractionLoop::existing,(boost::python::arg("ids")),
			"Those of some ids of bodies that have not been erased, as a numpy array.")
		.staticmethod("existing")
	);
	// clang-format on

	/// That of a scene, or null.
	static BondedInteractionLoop* in(const Scene& scene);
	/// Engines that look at neither bonds nor bonded spheres.
	static bool neverLooksAtBonds(const Engine& engine);
	/// Spheres that a BondedNewtonIntegrator moves in this step; null where there are none.
	BondedSpheres* spheresInArrays() { return batched && spheres.movedHere() > 0 ? &spheres : nullptr; }
	/// Whether a collider acts at the beginning of the next step and reads where spheres are.
	bool colliderIsDue() const;

	/// Held while bonds are computed, collected or written back: Python may ask at any time.
	mutable std::mutex busy;

private:
	struct Held {
		shared_ptr<Interaction> interaction; ///< null once the bond is broken
		BondedPhys*             phys;
	};
	/// Two spheres that have no bond, but may touch.
	struct Pair {
		shared_ptr<Interaction> interaction;
		BondedPhys*             phys; ///< null while they do not touch
		Real                    radius1, radius2;
		Real                    reach; ///< of the contact; where they do not touch, of no meaning
	};
	/// What a bond leaves in the step in which it breaks.
	struct Parted {
		std::int32_t       first, second; ///< rows
		ddem::ContactLoads loads;
	};
	using Law = Law2_ScGeom_BondedPhys_Bonded;

	Law* law() const;
	bool oneByOne() const;
	void throwFailure();
	void actBatched(Law& law);
	void leaveBatched();
	bool interactionsAreKnown();
	void collect(Law& law);
	void takeUpBonds(Law& law, std::vector<Held> bonds);
	bool followsPairs() const;
	void actOnOthers();
	bool act(const shared_ptr<Interaction>& I);
	void advance(Law& law);
	void advanceContacts(Law& law, std::size_t count);
	bool touches(std::size_t pair) const;
	void startContacts();
	ddem::ContactMotion motionOf(size_t pair) const;
	void addLoads(std::int32_t first, std::int32_t second, const ddem::ContactLoads& loads);
	void follow(Pair pair, std::int32_t first, std::int32_t second);
	void followContact(std::size_t pair);
	void orderContacts();
	void breakOverloaded(Law& law, const std::vector<std::int32_t>& bonds);
	bool constantsHold(size_t bond) const;
	void writeBack();
	void exposeGeometry(Interaction& I) const;
	Vector3r placeOf(Body::id_t id) const;
	void show(const State*) override { }
	void showAll() override;
	[[noreturn]] void stopAtNotFinite(std::int32_t bond) const;

	ddem::BondSystem                      system;
	std::vector<Held>                     held;       ///< of every bond of the system
	std::vector<std::int32_t>             overloaded; ///< bonds found beyond their strength in the last step
	std::size_t                           broken = 0; ///< of the held ones
	ddem::SpherePairs                     search;
	std::vector<Pair>                     pairs;   ///< of the search
	/// A pair that touches, its state being ahead of that of its object.
	struct Contact {
		std::int32_t       pair;
		BondedContact      state;
		ddem::ContactLoads loads;         ///< of the last step
		bool               ahead = false; ///< whether it has made a step since its object was written
	};
	std::vector<Contact>                  contacts; ///< by rows, but for those that have begun in this step
	bool                                  ordered = true;   ///< whether they are
	std::vector<std::int32_t>             fresh;    ///< pairs that have begun to touch in this step
	std::vector<Parted>                   parted;       ///< bonds that have broken in this step
	bool                                  following = false; ///< whether pairs of spheres are followed here
	std::vector<shared_ptr<Interaction>>  others;   ///< interactions that YADE's functors compute
	std::vector<std::int32_t>             otherRows; ///< spheres in them
	BondedSpheres                         spheres;
	bool                                  batched = false; ///< whether bonds are computed together
	long                                  known  = -1; ///< BondedPhys::bondsMade when they were collected
	const Scene*                          knownScene = nullptr;
	std::size_t                           knownSize  = 0; ///< interactions of the scene
	long                                  colliderRuns = -1;
	bool                                  exposed = true;
	std::vector<double>                   poseAtLook; ///< of the spheres before they move on, while Python looks
	BondedStepGuard                       guard;
	std::mutex                            failing;  ///< held for the text
	std::string                           stopping; ///< what stops the run after this step
	SingleProcess                         process;
	Showings                              showings;
};
REGISTER_SERIALIZABLE(BondedInteractionLoop);

/// Stops the run from within a functor: with an error where the scene has a BondedInteractionLoop; else it says so and
/// pauses.
void stopAfterStep(Scene& scene, const std::string& text);

} // namespace yade
