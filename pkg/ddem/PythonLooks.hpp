// GPL v2 or later, see LICENSE.
// What Python reads of State that lags behind an engine's arrays: brought up to date when it is read, as far as it is
// read, so that a PyRunner costs what it looks at.
#pragma once

#include <pkg/ddem/YadeInclude.hpp>

#include <mutex>

namespace yade {

/** Bodies whose State lags behind the arrays of an engine.
 * Their class says what is shown; when, is decided here: whatever Python code does to a body goes through a function
 * that Boost.Python made, and those are watched. Functions that touch State of one body show that one, and so does any
 * function that gets its velocity or spin, which Python has by reference and may have kept. Functions known
 * to touch none (yade.ddem.looks lists them) show nothing. Any other function shows everything before it acts, so that
 * a function nobody thought of costs time and is never wrong.
 */
class LaggingState {
public:
	virtual ~LaggingState() = default;
	/// Brings the State at this address up to date, if it is of these bodies.
	virtual void show(const State* state) = 0;
	/// Brings all of them up to date that have not been shown one by one.
	virtual void showAll() = 0;
};

namespace pythonLooks {

	/** Whether calls from Python are watched; the first call sees to it.
	 * \returns false where that cannot be, with a warning: then State must not lag. */
	bool watched();
	/// From now on Python's calls show the bodies ...
	void begin(LaggingState& bodies);
	/// ... until here. Nothing is shown to any thread once this has returned.
	void end(LaggingState& bodies);
	/// Held while State is shown.
	std::unique_lock<std::mutex> lock();
	/// Whether this process was forked by one in which calls were watched.
	bool inForkedProcess();

} // namespace pythonLooks

} // namespace yade
