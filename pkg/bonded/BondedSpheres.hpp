// GPL v2 or later, see LICENSE.
// The link between YADE's bodies and the arrays of bonded spheres: which body is which row,
// and state carried both ways.
#pragma once

#include <pkg/bonded/kernel/SphereMotion.hpp>
#include <pkg/ddem/PythonLooks.hpp>

#include <set>
#include <unordered_map>
#include <vector>

namespace yade {

/** All spheres of BondedMat of a scene, a row each, in the order of their ids.
 *
 * Rows that a BondedNewtonIntegrator moves are ahead of State, which is brought up to date for who looks. *Guests* are
 * moved by YADE: members of clumps, bodies that kinematic engines drive or a mask leaves out, and all spheres where
 * there is no BondedNewtonIntegrator; they are read from State in every step, and get their loads through O.forces.
 */
class BondedSpheres : private LaggingState {
public:
	~BondedSpheres() override { pythonLooks::end(*this); }

	/// Whether a body belongs here.
	static bool has(const Body& body);

	/** Takes up what has been changed in the scene since the last step, or reads it anew.
	 * \param mover the engine that moves rows in these arrays; null: YADE moves them
	 * \returns whether rows are others than before
	 * \throws std::runtime_error naming a body without mass */
	bool update(Scene& scene, const NewtonIntegrator* mover);
	/** To be called after an update, without locks that a Python thread may wait for: lets go of bodies that are no
	 * longer there. The last owner of an object that Python made must have Python's own lock. */
	void release();
	/** Takes up what engines have changed between the interactions and the motion.
	 * \returns whether that could be done: false where bodies, shapes or engines are others than before.
	 * Then State has all, and this step is YADE's. */
	bool takeUpChanges(const Scene& scene);
	/// For good, or until the next update: State of all.
	void leave();

	ddem::SphereMotion      motion;
	std::vector<Body::id_t> ids; ///< of the rows, ascending
	std::vector<double>     radius;
	/// Row of a body, -1 if it has none.
	std::int32_t rowOf(Body::id_t id) const
	{
		return id >= 0 && size_t(id) < row.size() ? row[size_t(id)] : -1;
	}
	/// Whether these arrays move a body.
	bool isMovedHere(Body::id_t id) const
	{
		const std::int32_t r = rowOf(id);
		return r >= 0 && !guest[size_t(r)];
	}
	bool isClumpMember(size_t r) const { return bodies[r]->isClumpMember(); }
	/// Number of rows that are moved here.
	long movedHere() const { return long(ids.size() - guests.size()); }
	/// Ids of all bodies that these arrays do not move.
	const std::vector<Body::id_t>& others() const { return otherIds; }

	/// How far any sphere may have moved since the last call at most [m].
	Real takeWay() { return std::exchange(way, 0); }
	/// Tells how far spheres have come in a step.
	void come(Real distance)
	{
		way += distance;
		wayOfBounds += distance;
	}
	/// Whether a sphere has left the bound that the collider knows; costs something only where one may have.
	bool leavesBounds();
	/// To be called when the collider has acted.
	void boundsAreNew() { slackOfBounds = -1; }

	// ---- forces

	/// To be called when loads of the step are complete: puts those of guests into the container.
	void showGuestLoads(ForceContainer& forces);
	/// Puts the loads of all into the container, for who looks there before the motion.
	void moveLoads(ForceContainer& forces);
	/// Adds the loads of all to the container after the motion, for who looks.
	void showLoads(ForceContainer& forces) const;
	/// Rows on which interactions act that YADE's functors compute, until the next call.
	void setForeign(std::vector<std::int32_t> rows);
	/// Two more, in this step.
	void addForeign(std::int32_t first, std::int32_t second);
	/// Adds what the container has for rows; only what is new where it is called again in a step.
	void takeForces(ForceContainer& forces);

	// ---- State

	/// Whether State of a body is behind the arrays.
	bool isAhead(Body::id_t id) const;
	/// Position, orientation and velocities of such a body.
	void copyTo(State& state, Body::id_t id) const { copy(size_t(rowOf(id)), state); }
	/// Writes State of some rows, of any order, for functors that read it.
	void show(const std::vector<std::int32_t>& rows) const;
	void show(size_t r) const;
	/// Writes State of all for others who change nothing.
	void showPicture() const;
	/// The same for those who may change it.
	void showToAll();
	/// State lags from here on, until Python touches it, at any time before the next update, also where a run was
	/// paused.
	void hide();
	/// A command acts before the next step, and may add forces.
	void expectCommand() { commanded = true; }

private:
	enum class Shown { Nothing, Touched, All };

	bool isOrdinary(const Body& body) const;
	bool isSame(const Scene& scene, const NewtonIntegrator* mover);
	bool matches(const Scene& scene, size_t r) const;
	bool sameEngines(const Scene& scene);
	void readAll(Scene& scene, const NewtonIntegrator* mover);
	void readMass(const Body& body, size_t r);
	void copy(size_t r, State& to) const;
	/// \returns how far it has moved
	Real import(size_t r);
	void importShown();
	void show(const State* state) override;
	void showAll() override;
	template <class Act> void forForeign(const Act& act) const;

	std::vector<shared_ptr<Body>>     bodies; ///< by row
	std::vector<shared_ptr<State>>    states;
	std::vector<shared_ptr<Shape>>    shapes;
	std::vector<shared_ptr<Material>> materials;
	std::vector<shared_ptr<void>>     dropped; ///< what is to be released
	std::vector<std::int32_t>         row;    ///< by id
	std::vector<char>                 guest;  ///< by row
	std::vector<std::int32_t>         guests; ///< rows
	std::vector<Body::id_t>           otherIds;
	std::set<Body::id_t>              driven; ///< by kinematic engines
	std::vector<std::int32_t>         loaded; ///< rows to which engines add forces
	const Scene*                      known       = nullptr;
	const NewtonIntegrator*           knownMover  = nullptr;
	size_t                            sceneBodies = 0;
	bool                              inArrays    = false;
	int                               mask        = -1; ///< of the mover
	Real                              way = 0, wayOfBounds = 0, slackOfBounds = -1;

	std::vector<std::int32_t> foreign;      ///< rows, of the others' interactions
	std::vector<std::int32_t> foreignNow;   ///< rows, of this step
	std::vector<double>       taken;        ///< rows of loads from the container, as far as they have been taken
	bool                      allForeign = true;
	bool                      commanded  = false; ///< a command acts before the next step

	Shown                                          shown = Shown::All;
	std::unordered_map<const State*, std::int32_t> rowOfState; ///< made when Python first touches State in a look
	std::vector<std::int32_t>                      touched;    ///< rows, in this look
	std::vector<char>                              wasTouched; ///< by row
};

} // namespace yade
