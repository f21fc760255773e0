// GPL v2 or later, see LICENSE.
// Block update of the concrete law for AVX2 and FMA; compiled with these instructions, chosen at run time only where the processor has them.
#include <pkg/ddem/kernel/laws/ConcreteBlockBodies.hpp>

namespace yade::ddem {

#if defined(__AVX2__) && defined(__FMA__)
namespace {
	using Batch            = xsimd::batch<double, xsimd::fma3<xsimd::avx2>>;
	constexpr auto updates = blockUpdates<Batch>(std::make_index_sequence<ConcreteEffects::All + 1>());
}

ConcreteBlockUpdate concreteBlockUpdateAvx2(unsigned effects)
{
	return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? updates[effects] : nullptr;
}
#else
ConcreteBlockUpdate concreteBlockUpdateAvx2(unsigned) { return nullptr; }
#endif

} // namespace yade::ddem
