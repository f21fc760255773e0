// GPL v2 or later, see LICENSE.
// State of deformable bodies apart from their arrays: by body id and name of field.
#pragma once

#include <pkg/ddem/YadeInclude.hpp>
#include <pkg/ddem/kernel/triangles/TriangleSystem.hpp>

#include <array>
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace yade {

/** Carries state into new arrays, from older ones or from a saved scene. Bodies are known by their ids, so it fits
 * a scene to which bodies have been added; what a law remembers is known by the names of its fields, so it fits
 * a law whose effects have been changed. */
class StateStore {
public:
	struct Point {
		unsigned            blocked = 0; ///< State::blockedDOFs
		/// lastVelocity: of the last step, where it is prescribed
		std::array<Real, 2> position {}, velocity {}, force {}, lastVelocity {};
	};
	struct Core : Point {
		bool spins = false;
		Real angle = 0, spin = 0, moment = 0, lastSpin = 0;
	};
	std::map<Body::id_t, Point> nodes;
	std::map<Body::id_t, Core>  cores;
	std::array<Real, 5>         pendingWork {};   ///< of the energy book [J]: gravity, external, damping, edges'
	                                              ///< work and absorption
	Real                        lastTimeStep = 0; ///< [s]
	ddem::LawGroup::FlowClock   flowClock;        ///< of all groups

	/// Takes what the law of a triangle remembers.
	void keep(Body::id_t id, const ddem::LawGroup& group, std::size_t triangle);
	/// Gives it to a triangle of a group: fields of the same name and kind. \returns the names of those that
	/// the group does not know.
	std::set<std::string> give(Body::id_t id, ddem::LawGroup& group, std::size_t triangle) const;

	/// Names of the fields that a triangle's group has and that are not known of it.
	std::set<std::string> missing(Body::id_t id, const ddem::LawGroup& group) const;

	/// Takes the state of other bodies; works that wait for the energy book add up.
	void take(StateStore&& other);

	/// Whether any law remembers anything.
	bool hasMemories() const { return !memories.empty(); }

	/// Names and numbers for a file.
	struct Saved {
		std::vector<std::string> names;
		std::vector<Real>        numbers;
	};
	Saved saved() const;
	/// \param works how many works the file has of pendingWork, the first ones.
	/// \throws std::runtime_error if they cannot be such a state.
	static StateStore fromSaved(const Saved& saved, std::size_t works);

private:
	/// What a law's fields are called, in order, with all their numbers of a sub-element.
	struct Fields {
		std::vector<std::string> names;
		std::vector<std::size_t> components;
		std::size_t              numbers = 0; ///< of a sub-element
	};
	struct Memory {
		std::size_t       fields; ///< place in kinds
		std::vector<Real> numbers;
	};
	std::vector<Fields>                    kinds;
	std::unordered_map<Body::id_t, Memory> memories;

	std::size_t kindOf(const ddem::LawGroup& group);
};

} // namespace yade
