// GPL v2 or later, see LICENSE.
// The concrete damage model: quantities for output.
#include <pkg/ddem/kernel/laws/concrete/ConcreteLaw.hpp>

namespace yade::ddem {

double stiffnessFactor(const PreparedConcrete& concrete, const ConcreteState& state)
{
	return tangentFactor(concrete, state.stiffening);
}

double damageRatio(const PreparedConcrete& concrete, const ConcreteState& state)
{
	return 1 - measureDamage(concrete, state.damage).integrity;
}

} // namespace yade::ddem
