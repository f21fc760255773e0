// GPL v2 or later, see LICENSE.
// Block update of the concrete law: baseline instructions, and the choice of the widest.
#include <pkg/ddem/kernel/ConcreteBlockBodies.hpp>

namespace yade::ddem {

namespace {
	using Batch            = xsimd::batch<double, xsimd::sse2>;
	constexpr auto updates = blockUpdates<Batch>(std::make_index_sequence<ConcreteEffects::All + 1>());
}

ConcreteBlockUpdate concreteBlockUpdate(unsigned effects)
{
	concreteUpdate(effects); // throws for an unknown bit
	const ConcreteBlockUpdate wide = concreteBlockUpdateAvx2(effects);
	return wide ? wide : updates[effects];
}

} // namespace yade::ddem
