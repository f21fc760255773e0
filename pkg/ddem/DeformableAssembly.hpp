// GPL v2 or later, see LICENSE.
// The link between YADE's bodies and the arrays of deformable triangles: assembles them, and carries state both ways.
#pragma once

#include <pkg/ddem/ConcreteDamageMat.hpp>
#include <pkg/ddem/DeformableTriangle.hpp>
#include <pkg/ddem/kernel/triangles/SystemStableStep.hpp>

#include <array>
#include <map>
#include <utility>
#include <vector>

namespace yade {

/** State of deformable bodies apart from their arrays: by body id, so that it fits a scene to which bodies have been added. Carries state into a new assembly, from
 * an older one or from a saved scene. */
struct CarriedState {
	struct Point {
		unsigned            blocked = 0;                                          ///< State::blockedDOFs
		std::array<Real, 2> position {}, velocity {}, force {}, lastVelocity {}; ///< lastVelocity: that of the last step, where it is prescribed
	};
	struct Core : Point {
		bool                             spins = false;
		Real                             angle = 0, spin = 0, moment = 0, lastSpin = 0;
		std::vector<ddem::ConcreteState> concrete; ///< three or none
	};
	std::map<Body::id_t, Point> nodes;
	std::map<Body::id_t, Core>  cores;
	std::array<Real, 3>         pendingWork {}; ///< of the energy book [J]: gravity, external, damping
	Real                        lastTimeStep = 0; ///< [s]

	/// One vector of numbers and back. \throws std::runtime_error if the numbers cannot be such a state.
	std::vector<Real>   numbers() const;
	static CarriedState fromNumbers(const std::vector<Real>& numbers);
};

class DeformableAssembly {
public:
	shared_ptr<ddem::TriangleSystem> system;
	std::vector<shared_ptr<Body>>    nodes, cores; ///< in the order of the arrays, which is that of the body ids

	/** Builds the arrays from all deformable bodies of the scene. Bodies known from `carried` keep that state; the others start from State.
	 * Nothing is changed in the scene before all bodies have been checked.
	 * \throws std::invalid_argument naming the body for: missing or wrong node bodies, wrong material, degenerate, clockwise or duplicate triangles, nodes without
	 * triangles or at the same place, coordinates that are not finite, no triangles at all.
	 */
	static DeformableAssembly fromScene(Scene& scene, ddem::RotationTreatment rotation, Real vertexShare, const CarriedState& carried);

	/// The state of all bodies, to be carried into another assembly.
	CarriedState carry() const;

	/// Whether the scene's deformable bodies are those of this assembly (cheap unless bodies were added).
	bool upToDate(const Scene& scene);
	/// Whether a material, a triangle's choice of one, or its shape's own values have been changed since the arrays were built.
	bool materialsChanged() const;

	/// Gives the bodies their masses and the group bit, and links shapes to the arrays.
	void adopt(int groupMask) const;

	/// Writes positions, velocities and rotations into State; of all bodies, or only of those with blocked degrees of freedom.
	void exposeAll();
	void exposeConstrained() const;
	/// Takes up what was changed in State since exposeAll. \throws std::invalid_argument for values that are not finite and for bodies erased from the scene.
	void importChanges(const Scene& scene);
	/// Takes up the velocities of blocked degrees of freedom.
	void importPrescribed();
	/// Takes up forces and torques that other engines added; `wanted` false drops the arrays.
	void importForces(ForceContainer& forces, bool wanted);
	/// Adds internal forces of bodies with blocked degrees of freedom to the container, so that O.forces.f(id) shows reactions.
	void exposeReactions(ForceContainer& forces) const;

	/// Bound on the time step in the present state, see ddem::stableStep.
	ddem::SystemStableStep timeStep(Real enough = std::numeric_limits<Real>::infinity()) const { return ddem::stableStep(*system, restFrequency, vertexShare, enough); }

private:
	using Fingerprint = std::pair<shared_ptr<Material>, std::vector<double>>;
	std::vector<Fingerprint> materials;                        ///< parameters as they were when the arrays were built
	std::vector<std::size_t> coreMaterial;                     ///< place in materials of every triangle's
	std::vector<std::array<Real, 3>> shapeValues;              ///< thickness, fracture energy and band factor of every triangle's shape
	std::vector<Body::id_t>  nodeId, coreId;                   ///< as assembled; erasing a body takes its id away
	std::vector<unsigned>    nodeBlocked, coreBlocked;         ///< State::blockedDOFs as last taken up
	std::vector<std::size_t> constrainedNodes, constrainedCores;
	std::vector<double>      restFrequency; ///< highest of every triangle [rad/s]
	Real                     vertexShare = 0;
	std::size_t              sceneBodies = 0;

	void applyBlockedDegreesOfFreedom();
};

} // namespace yade
