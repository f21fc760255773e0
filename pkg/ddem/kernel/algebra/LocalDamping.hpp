// GPL v2 or later, see LICENSE.
// Cundall's local damping.
#pragma once

#include <pkg/ddem/kernel/algebra/Select.hpp>

namespace yade::ddem {

/// Factor by which local damping scales an acceleration, as in NewtonIntegrator (cundallDamp2nd).
template <class Number>
inline Number localDamping(const Number& damping, const Number& acceleration, const Number& velocity, const Number& dt)
{
	const Number power = acceleration * (velocity + Number(0.5) * dt * acceleration);
	const Number none(0.), one(1.);
	return select(power > none, one - damping, select(power < none, one + damping, one));
}

} // namespace yade::ddem
