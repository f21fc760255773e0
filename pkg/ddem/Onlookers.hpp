// GPL v2 or later, see LICENSE.
// Whether anybody may look at what an engine keeps to itself while a run goes on.
#pragma once

#include <pkg/ddem/YadeInclude.hpp>

#include <chrono>

namespace yade {

/// Who may look at State before an engine's next turn.
enum class Onlooker {
	Nobody,
	OtherThreads, ///< a window, or a shell beside a run: they see a picture now and then, and change nothing
	Python,       ///< commands of PyRunner only, unless one of them changes which engines act
	Anybody       ///< the end of a run, or an engine that may read and change bodies
};

/// When State was last shown to other threads, and what that took: a picture may cost a small part of the time only.
class Showings {
public:
	/// \returns whether it is time for the next.
	bool due() const;
	void begin() { started = std::chrono::steady_clock::now(); }
	void end() { finished = std::chrono::steady_clock::now(); }

private:
	std::chrono::steady_clock::time_point started {}, finished {};
};

/** Who may look at state that an engine computes in arrays of its own, after this step.
 * \param self the engine; where it stands in O.engines says who acts in this step and who in the next
 * \param showings when State was last made visible
 * \param neverLooks engines that are known not to look
 * \param clockSlack how long before it is due an engine counts that acts by the clock [s]: while others act, it may
 * become so; infinity: such an engine always counts
 * \param until the engine, before self in O.engines, whose turn ends the time in question; null: self's next turn
 */
Onlooker onlooker(
        const Scene& scene, const Engine& self, const Showings& showings, bool (*neverLooks)(const Engine&),
        Real clockSlack, const Engine* until = nullptr);

/// Whether anybody may look between the turns of two engines in the same step.
bool looksBetween(
        const Scene& scene, const Engine& first, const Engine& second, bool (*neverLooks)(const Engine&),
        Real clockSlack);

} // namespace yade
