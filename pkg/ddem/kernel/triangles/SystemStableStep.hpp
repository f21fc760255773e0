// GPL v2 or later, see LICENSE.
// The time step that a whole system of triangles bears in its present state.
#pragma once

#include <pkg/ddem/kernel/triangles/StableStep.hpp>
#include <pkg/ddem/kernel/triangles/TriangleSystem.hpp>

#include <limits>

namespace yade::ddem {

struct SystemStableStep {
	double      step     = std::numeric_limits<double>::infinity(); ///< [s]
	std::size_t triangle = 0;                                       ///< the one that sets it
};

/** Bound on the time step in the present state: at the present pressure where an equation of state stiffens the
 * triangles, and in their present shape where their cores or frames rotate.
 * Undamaged moduli, since a crack may close at any time.
 *
 * Triangles whose frequency can have grown by less than 2 % (frequencyGrowth) count with that, the others with their
 * own (highestFrequency). Only those that may set the bound are asked for it.
 * \param restFrequency highest frequency of every triangle at rest [rad/s]
 * \param vertexShare share of the mass that sits in the vertices [-]
 * \param enough triangles whose step is surely at least this are not looked at more closely [s];
 * a result of at least this says no more
 */
SystemStableStep stableStep(
        const TriangleSystem& system, const std::vector<double>& restFrequency, double vertexShare,
        double enough = std::numeric_limits<double>::infinity());

} // namespace yade::ddem
