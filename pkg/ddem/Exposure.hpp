// GPL v2 or later, see LICENSE.
// The link between YADE's bodies and the arrays of deformable triangles: which body is which row,
// and state carried both ways.
#pragma once

#include <pkg/ddem/DeformableElastMat.hpp>
#include <pkg/ddem/DeformableTriangle.hpp>
#include <pkg/ddem/PythonLooks.hpp>
#include <pkg/ddem/StateStore.hpp>
#include <pkg/ddem/kernel/triangles/SystemStableStep.hpp>

#include <boost/enable_shared_from_this.hpp>

#include <array>
#include <limits>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace yade {

struct SampleSettings;

/// Which bodies are the rows of a system, -1 where none is, and their blocked degrees of freedom.
struct SampleIds {
	std::vector<Body::id_t> node, core;
	std::vector<unsigned>   nodeBlocked, coreBlocked;
};
/// The state of a system, by the ids of its bodies.
StateStore storeOf(const ddem::TriangleSystem& system, const SampleIds& ids);
/// That of triangles which an engine has moved that is gone: what only arrays hold is still with the shapes.
StateStore storeOfFormerEngines(const Scene& scene, const std::vector<shared_ptr<Body>>& triangles);

/// "body 12 at (0.1, 0.2) m", its reference position.
std::string placeOf(const Body& b);

/// How much of State agrees with the arrays, and is taken up from it before the next step.
enum class Shown {
	Constrained, ///< bodies with blocked degrees of freedom only, whose velocities are read
	Touched,     ///< and what Python has touched, see LaggingState
	All
};

class Exposure : public boost::enable_shared_from_this<Exposure>, private LaggingState {
public:
	~Exposure() override { pythonLooks::end(*this); }

	shared_ptr<ddem::TriangleSystem> system;
	std::vector<shared_ptr<Body>>    nodes, cores; ///< by row
	Shown                            shown = Shown::All;
	/// gravity in the last step [m/s²]; not finite before the first with these arrays
	ddem::PlaneVector<double>        lastGravity { NaN, NaN };
	std::set<std::string>            forgotten;      ///< fields of the state before that no law here has

	/// The state of all bodies, to be carried into other arrays.
	StateStore store() const;

	/// Whether the scene has other deformable bodies than when it was read (cheap unless bodies were added).
	bool misses(const Scene& scene);
	/** Whether a material or what a triangle's shape says has been changed since the arrays were built.
	 * \param started whether steps have been made with them: then initialDamage and
	 * initialStress can be changed no more
	 * \throws std::invalid_argument if it was */
	bool materialsChanged(bool started);

	/// Gives the bodies their masses and the group bit, and links shapes to their rows.
	void adopt(int groupMask);

	/// Writes positions, velocities and rotations into State, of all bodies.
	void exposeAll();
	/// Lets State be as it is, but for bodies with blocked degrees of freedom.
	void exposeConstrained();
	/// The same until Python touches it. Call endLook() before the arrays change.
	void beginLook();
	void endLook() { pythonLooks::end(*this); }
	/// Writes State as it is now for other threads, who change nothing.
	void showPicture() const;
	/// After a look that has ended otherwise than by a step:
	/// State of all, with what was changed meanwhile taken up.
	void finishLook(const Scene& scene);
	/// For good: State of all, but for what was changed meanwhile.
	void leave();
	/** Takes up what was changed in State, as far as it has been shown.
	 * \throws std::invalid_argument for values that are not finite and for bodies erased from the scene. */
	void importChanges(const Scene& scene);
	/// The same for one triangle and its nodes: costs the same in a sample of any size.
	void importTriangle(const Scene& scene, std::size_t row);
	/// Takes up the velocities of blocked degrees of freedom.
	void importPrescribed();
	/// Takes up forces and torques that other engines added; `wanted` false drops the arrays.
	void importForces(ForceContainer& forces, bool wanted);
	/// Adds internal forces of bodies with blocked degrees of freedom to the container,
	/// so that O.forces.f(id) shows reactions.
	void exposeReactions(ForceContainer& forces) const;

	/// Bound on the time step in the present state, see ddem::stableStep.
	ddem::SystemStableStep timeStep(Real enough = std::numeric_limits<Real>::infinity()) const
	{
		return ddem::stableStep(*system, restFrequency, vertexShare, enough);
	}
	/// Stress of the sub-elements at the current positions, in the element's frame [Pa].
	std::array<ddem::PlaneTensor, 3> stress(std::size_t row) const;
	/// Row of a node by its body id, -1 if it is none of these.
	std::ptrdiff_t rowOfNode(Body::id_t id) const;
	/// Fracture energy that a triangle's law has for it, in the law's unit;
	/// that of its shape where the law has none.
	Real fractureEnergy(std::size_t row) const;

private:
	friend shared_ptr<Exposure> readScene(const Scene&, const SampleSettings&, const StateStore&);

	using Fingerprint = std::pair<shared_ptr<Material>, std::vector<double>>;
	std::vector<Fingerprint>         materials;           ///< parameters as they were when the arrays were built
	std::vector<std::size_t>         coreMaterial;        ///< place in materials of every triangle's
	std::vector<DeformableTriangle::Values> shapeValues;  ///< what every triangle's shape says
	unsigned long                    shapeChanges = 0;    ///< DeformableTriangle::changes
	                                                      ///< when they were last compared
	std::vector<Body::id_t>          nodeId, coreId;      ///< as read; erasing a body takes its id away
	std::vector<unsigned>            nodeBlocked, coreBlocked; ///< State::blockedDOFs as last taken up
	std::vector<std::size_t>         constrainedNodes, constrainedCores;
	std::vector<double>              restFrequency; ///< highest of every triangle [rad/s]
	Real                             vertexShare = 0;
	/// all, as they were when deformable ones were last counted
	std::size_t                      sceneBodies = 0;
	std::size_t                      sceneTriangles = 0, sceneNodes = 0;
	bool                             replaced    = false; ///< a body got another material

	// a look: rows are those of nodes, then those of cores
	std::unordered_map<const State*, std::size_t> rowOfState; ///< made when Python first touches State in a look
	std::vector<unsigned>                         lookOfRow;  ///< the last look in which a row was touched
	std::vector<std::size_t>                      touched;    ///< rows, in this look
	std::vector<char> isConstrained; ///< by row: State has been written, and kinematic engines may have acted since
	unsigned                                      lookNumber = 0;

	void show(const State* state) override;
	void showAll() override;
	bool wasTouched(std::size_t row) const
	{
		return shown == Shown::Touched && row < lookOfRow.size() && lookOfRow[row] == lookNumber;
	}
	void expose(std::size_t row) const;
	void exposeUntouched() const;
	void allIsShown();

	void countBodies(const Scene& scene);
	void applyBlockedDegreesOfFreedom();
	void requireComplete(const Scene& scene) const;
	void importNode(const Scene&, std::size_t row, bool driven, bool& blockedChanged);
	void importCore(const Scene&, std::size_t row, bool driven, bool& blockedChanged);
};

} // namespace yade
