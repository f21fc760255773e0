// GPL v2 or later, see LICENSE.
// An InteractionLoop that computes all bonds together.
#pragma once

#include <pkg/bonded/BondedTimeStep.hpp>
#include <pkg/bonded/Law2_ScGeom_BondedPhys_MohrCoulomb.hpp>

#include <pkg/ddem/Onlookers.hpp>

namespace yade {

/// What is known of a bond that holds.
struct BondNow {
	Real normalStress, shearStress, radius;
};

class BondedInteractionLoop : public InteractionLoop {
public:
	virtual ~BondedInteractionLoop() = default;
	void action() override;

	/// Brings geometry and physics of the bonds' interactions up to the last step.
	void expose();
	/// Bonds that hold, by the ids of their bodies, as of the last step; safe while a run goes on.
	/// Empty where bonds are computed one by one.
	std::map<std::pair<int, int>, BondNow> bondsNow() const;
	void preSave(BondedInteractionLoop&) { expose(); }
	/// Throws a runtime_error once all functors of this step have returned, as none may throw among them.
	void stopAfterStep(const std::string& text);

	// clang-format off
	YADE_CLASS_BASE_DOC(BondedInteractionLoop, InteractionLoop,
		"An :yref:`InteractionLoop`, with the same arguments, that computes bonds of :yref:`BondedPhys` all "
		"together instead of one by one: some at a time in SIMD lanes, then every particle collects the loads "
		"of its bonds in a fixed order: what bonds do does not depend on the number of threads, bit by bit. "
		"Contacts, and all other interactions, run through the functors as usual; their sums depend on threads "
		"in the last digits, as in all of YADE.\n\n"
		":yref:`Interaction.geom`, forces and stresses of bonds are written back whenever somebody may look "
		"(end of a run, O.step, periodic engines that are due, engines of unknown kind). After O.pause() of "
		"a run in the background they may be a few steps old until "
		":yref:`bonds<Law2_ScGeom_BondedPhys_MohrCoulomb.bonds>` is called. Stiffnesses and radii changed by "
		"hand are taken up after such a look.\n\n"
		"Bonds are computed one by one where the base class must be asked: "
		"with :yref:`callbacks<InteractionLoop.callbacks>`, "
		":yref:`loopOnSortedInteractions<InteractionLoop.loopOnSortedInteractions>`, a number of threads of "
		"its own, or periodic boundaries.\n\n"
		"Errors: RuntimeError naming the bond where forces become infinite or not a number; naming the pair "
		"where O.dt is above the critical step "
		"(:yref:`criticalTimeStep<Law2_ScGeom_BondedPhys_MohrCoulomb.criticalTimeStep>`); "
		"and under mpirun with several processes."
	);
	// clang-format on

private:
	struct Held {
		shared_ptr<Interaction> interaction; ///< null once the bond is broken
		BondedPhys*             phys;
	};
	using Law = Law2_ScGeom_BondedPhys_MohrCoulomb;

	Law* law() const;
	bool oneByOne() const;
	void throwFailure();
	bool locateHeld();
	void actOnOthers();
	bool act(const shared_ptr<Interaction>& I);
	void collect(Law& law);
	void fetchPoses();
	void advance(Law& law);
	void breakOverloaded(Law& law, const std::vector<std::int32_t>& bonds);
	void applyLoads();
	bool constantsHold(size_t bond) const;
	void writeBack();
	void exposeGeometry(size_t bond);
	[[noreturn]] void stopAtNotFinite(std::int32_t bond) const;

	ddem::BondSystem                      system;
	std::vector<Held>                     held;       ///< of every bond of the system
	std::vector<char>                     isHeld;     ///< of every interaction of the scene
	std::vector<Body::id_t>               particles;  ///< of every particle of the system
	std::vector<std::int32_t>             overloaded; ///< bonds found beyond their strength in the last step
	std::size_t                           broken = 0; ///< of the held ones
	long                                  known  = -1; ///< BondedPhys::bondsMade when they were collected
	const Scene*                          knownScene = nullptr;
	bool                                  exposed = true;
	BondedStepGuard                       guard;
	std::mutex                            failing;  ///< held for the text
	std::string                           stopping; ///< what stops the run after this step
	SingleProcess                         process;
	mutable std::mutex                    busy;            ///< held while bonds are computed, collected or written
	                                                       ///< back: Python may ask at any time
	Showings                              showings;
};
REGISTER_SERIALIZABLE(BondedInteractionLoop);

/// Stops the run from within a functor: with an error where the scene has a BondedInteractionLoop; else it says so and
/// pauses.
void stopAfterStep(Scene& scene, const std::string& text);

} // namespace yade
