// GPL v2 or later, see LICENSE.
// What limits the time step in a scene of bonded spheres, and a guard that watches it.
#pragma once

#include <pkg/ddem/YadeInclude.hpp>

#include <atomic>

namespace yade {

/// What moves a body: itself, or its clump.
inline const Body& moverOf(const Scene& scene, Body::id_t id)
{
	const Body& body = *(*scene.bodies)[id];
	return body.isClumpMember() ? *(*scene.bodies)[body.clumpId] : body;
}

/// Bound on the time step [s], infinite without springs, and the bodies of the pair that sets it,
/// -1 where there is none.
struct BondedStableStep {
	Real       step;
	Body::id_t id1, id2;
};

/** The bound of ddem::stableStep for all bonds and contacts with two springs (NormShearPhys) of a scene, and for those
 * spheres that are about to touch an elastic wall. Where a load does not act through the centre of what moves (a box,
 * a member of a clump), its normal spring turns that as well: there the larger spring counts in all directions.
 */
BondedStableStep bondedStableStep(const Scene& scene);

/// Stops a run whose time step is above the bound.
class BondedStepGuard {
public:
	/** Whether it is time to \ref check; to be asked in every step. That is where O.dt has grown beyond the last
	 * bound, where bonds are new, soon after contacts have formed, and now and then.
	 * \param told whether contacts that form are told by \ref see
	 */
	bool isDue(const Scene& scene, bool told) const;
	/// Compares O.dt with the bound of the scene. \throws std::runtime_error naming the pair of bodies
	void check(const Scene& scene);
	/// A contact has formed; may be called by several threads.
	void see(const Scene& scene, const Interaction& I);

private:
	const Scene*      known    = nullptr;
	long              bonds    = -1; ///< BondedPhys::bondsMade at the last look
	Real              stable   = 0;  ///< last bound [s]
	long              lastLook = 0;  ///< step
	std::atomic<bool> formed { false };
	std::atomic<bool> above { false }; ///< a new contact's own bound is below O.dt
};

} // namespace yade
