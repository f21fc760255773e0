// GPL v2 or later, see LICENSE.
// What the other engines of a scene mean for deformable triangles:
// their order, and settings that triangles would not feel.
#pragma once

#include <pkg/ddem/YadeInclude.hpp>

#include <vector>

namespace yade {

class DeformableEngine;
class DeformableTimeStepper;
class EdgeEngine;
class ServoPlaten;

/// What stands in O.engines, checked once and again when it has changed.
class EngineOrder {
public:
	/** Looks at O.engines if it has changed since the last call. \returns whether it looked.
	 * \throws std::runtime_error for engines that are missing, in the wrong order,
	 * or have settings that triangles would not feel. */
	bool check(const Scene& scene, const DeformableEngine& self);
	/// Forgets what was checked.
	void forget() { checked.clear(); }

	const DeformableTimeStepper*         stepper = nullptr;     ///< the one in O.engines, if any
	/// an active engine of another kind that sets O.dt
	const Engine*                        otherStepper = nullptr;
	/// whether an engine before may add forces to bodies
	bool                                 collectForces = false;
	std::vector<const NewtonIntegrator*> integrators;
	std::vector<const EdgeEngine*>       edgeEngines;
	std::vector<ServoPlaten*>            platens;

	/** Acceleration that triangles feel [m/s²]: the engine's, or NewtonIntegrator's where the engine has none.
	 * \throws std::runtime_error where the two differ, and where NewtonIntegrator damps and the engine does
	 * not say whether it does. */
	Vector3r gravityFelt(const DeformableEngine& self) const;

	/// Whether an engine neither adds forces to deformable bodies nor moves or reads free ones.
	static bool neverLooks(const Engine& engine);
	/// Takes the group bit out of NewtonIntegrator.mask. \throws std::runtime_error if nothing would be left.
	static void maskIntegrators(const Scene& scene, int groupMask);
	/// \throws std::runtime_error in a periodic cell, which triangles would not feel.
	static void requireOpenCell(const Scene& scene);
	/// \throws std::runtime_error if a kinematic engine drives a node whose degrees of freedom are free.
	static void checkDrivenNodes(const Scene& scene);

private:
	std::vector<const Engine*> checked;
};

} // namespace yade
