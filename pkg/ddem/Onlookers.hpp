// GPL v2 or later, see LICENSE.
// Whether anybody may look at what an engine keeps to itself while a run goes on.
#pragma once

#include <pkg/ddem/YadeInclude.hpp>

#include <chrono>

namespace yade {

/** Whether state that an engine computes in arrays of its own must be visible after this step: at the end of a run, for engines that act before its next turn and may look,
 * and now and then for other threads.
 * \param self the engine; where it stands in O.engines says who acts in this step and who in the next
 * \param lastExposure when the state was last made visible
 * \param neverLooks engines that are known not to look
 */
bool somebodyMayLook(const Scene& scene, const Engine& self, std::chrono::steady_clock::time_point lastExposure, bool (*neverLooks)(const Engine&));

} // namespace yade
