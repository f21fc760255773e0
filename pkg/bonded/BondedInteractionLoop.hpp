// GPL v2 or later, see LICENSE.
// An InteractionLoop that computes all bonds together.
#pragma once

#include <pkg/bonded/Law2_ScGeom_BondedPhys_MohrCoulomb.hpp>

#include <chrono>

namespace yade {

class BondedInteractionLoop : public InteractionLoop {
public:
	virtual ~BondedInteractionLoop() = default;
	void action() override;

	/// Brings geometry and physics of the bonds' interactions up to the last step.
	void expose();
	void preSave(BondedInteractionLoop&) { expose(); }

	// clang-format off
	YADE_CLASS_BASE_DOC(BondedInteractionLoop, InteractionLoop,
		"An :yref:`InteractionLoop`, with the same arguments, that computes bonds of :yref:`BondedPhys` all together instead of one by one: some at a time in SIMD lanes, then every particle "
		"collects the loads of its bonds in a fixed order, so that results are equal, bit by bit, for any number of threads that share the bonds. What bonds do is the same; contacts, and all "
		"other interactions, run through the functors as usual.\n\n"
		":yref:`Interaction.geom`, forces and stresses of bonds are written back whenever somebody may look (end of a run, O.step, periodic engines that are due, engines of unknown kind). "
		"Bonds are computed one by one where that is asked of an InteractionLoop: with :yref:`callbacks<InteractionLoop.callbacks>`, periodic boundaries, or bodies of several MPI subdomains.\n\n"
		"Errors: RuntimeError naming the bond where forces become infinite or not a number."
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
	bool locateHeld();
	void actOnOthers();
	bool act(const shared_ptr<Interaction>& I);
	void collect(Law& law);
	void fetchPoses();
	void advance(Law& law);
	void breakOverloaded(Law& law, const std::vector<std::int32_t>& bonds);
	void applyLoads();
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
	std::chrono::steady_clock::time_point lastExposure {};
};
REGISTER_SERIALIZABLE(BondedInteractionLoop);

} // namespace yade
