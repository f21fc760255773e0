// GPL v2 or later, see LICENSE.
// Change of axes of a plane-strain tensor.
#pragma once

#include <pkg/ddem/kernel/algebra/PlaneTensor.hpp>

namespace yade::ddem {

/// R·a·Rᵀ, R the rotation about z by `angle` [rad]: from an element's frame, turned by `angle`, to global axes.
inline PlaneTensor rotated(const PlaneTensor& a, double angle)
{
	const double c = std::cos(2 * angle), s = std::sin(2 * angle), mean = 0.5 * (a.xx + a.yy),
	             half  = 0.5 * (a.xx - a.yy);
	const double along = c * half - s * a.xy;
	return { mean + along, mean - along, a.zz, s * half + c * a.xy };
}

} // namespace yade::ddem
