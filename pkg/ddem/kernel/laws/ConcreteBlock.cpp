// GPL v2 or later, see LICENSE.
// Block update of the concrete law: baseline instructions, and the choice of the widest.
#include <pkg/ddem/kernel/laws/ConcreteBlockBodies.hpp>

namespace yade::ddem {

namespace {
	using Batch            = xsimd::make_sized_batch_t<double, 2>;
	constexpr auto updates = blockUpdates<Batch>(std::make_index_sequence<ConcreteEffects::All + 1>());
}

ConcreteBlockUpdate concreteBlockUpdateBaseline(unsigned effects)
{
	concreteUpdate(effects); // throws for an unknown bit
	return updates[effects];
}

ConcreteBlockUpdate concreteBlockUpdate(unsigned effects)
{
	const ConcreteBlockUpdate baseline = concreteBlockUpdateBaseline(effects), wide = concreteBlockUpdateAvx2(effects);
	return wide ? wide : baseline;
}

} // namespace yade::ddem
