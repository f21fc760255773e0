// GPL v2 or later, see LICENSE.
// The link between YADE's bodies and the arrays of deformable triangles: which body is which row, and state carried both ways.
#pragma once

#include <pkg/ddem/DeformableElastMat.hpp>
#include <pkg/ddem/DeformableTriangle.hpp>
#include <pkg/ddem/StateStore.hpp>
#include <pkg/ddem/kernel/triangles/SystemStableStep.hpp>

#include <boost/enable_shared_from_this.hpp>

#include <array>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace yade {

struct SampleSettings;

/// "body 12 at (0.1, 0.2) m", its reference position.
std::string placeOf(const Body& b);

class Exposure : public boost::enable_shared_from_this<Exposure> {
public:
	shared_ptr<ddem::TriangleSystem> system;
	std::vector<shared_ptr<Body>>    nodes, cores; ///< by row
	bool                             exposed = true; ///< whether State agrees with the arrays
	std::set<std::string>            forgotten;      ///< fields of the state before that no law here has

	/// The state of all bodies, to be carried into other arrays.
	StateStore store() const;

	/// Whether the scene has other deformable bodies than when it was read (cheap unless bodies were added).
	bool misses(const Scene& scene);
	/// Whether a material or what a triangle's shape says has been changed since the arrays were built.
	bool materialsChanged();

	/// Gives the bodies their masses and the group bit, and links shapes to their rows.
	void adopt(int groupMask);

	/// Writes positions, velocities and rotations into State; of all bodies, or only of those with blocked degrees of freedom.
	void exposeAll();
	void exposeConstrained() const;
	/** Takes up what was changed in State since exposeAll.
	 * \throws std::invalid_argument for values that are not finite and for bodies erased from the scene. */
	void importChanges(const Scene& scene);
	/// The same for one triangle and its nodes: costs the same in a sample of any size.
	void importTriangle(const Scene& scene, std::size_t row);
	/// Takes up the velocities of blocked degrees of freedom.
	void importPrescribed();
	/// Takes up forces and torques that other engines added; `wanted` false drops the arrays.
	void importForces(ForceContainer& forces, bool wanted);
	/// Adds internal forces of bodies with blocked degrees of freedom to the container, so that O.forces.f(id) shows reactions.
	void exposeReactions(ForceContainer& forces) const;

	/// Bound on the time step in the present state, see ddem::stableStep.
	ddem::SystemStableStep timeStep(Real enough = std::numeric_limits<Real>::infinity()) const
	{
		return ddem::stableStep(*system, restFrequency, vertexShare, enough);
	}
	/// Stress of the sub-elements at the current positions, in the element's frame [Pa].
	std::array<ddem::PlaneTensor, 3> stress(std::size_t row) const;
	/// Fracture energy that a triangle's law has for it, in the law's unit; that of its shape where the law has none.
	Real fractureEnergy(std::size_t row) const;

private:
	friend shared_ptr<Exposure> readScene(const Scene&, const SampleSettings&, const StateStore&);

	using Fingerprint = std::pair<shared_ptr<Material>, std::vector<double>>;
	std::vector<Fingerprint>         materials;           ///< parameters as they were when the arrays were built
	std::vector<std::size_t>         coreMaterial;        ///< place in materials of every triangle's
	std::vector<std::array<Real, 3>> shapeValues;         ///< what every triangle's shape says
	unsigned long                    shapeChanges = 0;    ///< DeformableTriangle::changes when they were last compared
	std::vector<Body::id_t>          nodeId, coreId;      ///< as read; erasing a body takes its id away
	std::vector<unsigned>            nodeBlocked, coreBlocked; ///< State::blockedDOFs as last taken up
	std::vector<std::size_t>         constrainedNodes, constrainedCores;
	std::vector<double>              restFrequency; ///< highest of every triangle [rad/s]
	Real                             vertexShare = 0;
	std::size_t                      sceneBodies = 0;         ///< all, as they were when deformable ones were last counted
	std::size_t                      sceneTriangles = 0, sceneNodes = 0;
	bool                             replaced    = false; ///< a body got another material


	void countBodies(const Scene& scene);
	void applyBlockedDegreesOfFreedom();
	void importNode(const Scene&, std::size_t row, bool driven, bool& blockedChanged);
	void importCore(const Scene&, std::size_t row, bool driven, bool& blockedChanged);
};

} // namespace yade
