// GPL v2 or later, see LICENSE.
// The concrete damage model: dispatch over effects and quantities for output.
#include <pkg/ddem/kernel/laws/ConcreteLaw.hpp>

#include <array>
#include <stdexcept>
#include <string>
#include <utility>

namespace yade::ddem {

namespace {
	template <std::size_t... masks> constexpr std::array<ConcreteUpdate, sizeof...(masks)> updatesOf(std::index_sequence<masks...>)
	{
		return { { &advanceConcrete<static_cast<unsigned>(masks), double>... } };
	}
	constexpr auto updates = updatesOf(std::make_index_sequence<ConcreteEffects::All + 1>());
}

ConcreteUpdate concreteUpdate(unsigned effects)
{
	if (effects >= updates.size())
		throw std::invalid_argument(
		        "unknown effect in the mask " + std::to_string(effects) + "; the largest mask is " + std::to_string(updates.size() - 1)
		        + " (all effects).");
	return updates[effects];
}

double stiffnessFactor(const PreparedConcrete& concrete, const ConcreteState& state) { return tangentFactor(concrete, state.stiffening); }

double damageRatio(const PreparedConcrete& concrete, const ConcreteState& state) { return 1 - measureDamage(concrete, state.damage).integrity; }

} // namespace yade::ddem
