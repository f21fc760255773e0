// GPL v2 or later, see LICENSE.
// Bond loops for AVX2 and FMA; compiled with these instructions, chosen at run time only where the processor has them.
#include <pkg/bonded/kernel/BondLoopBodies.hpp>

namespace yade::ddem {

#if defined(__AVX2__) && defined(__FMA__)
namespace {
	struct Avx2;
	using Batch = xsimd::batch<double, xsimd::fma3<xsimd::avx2>>;
}
BondLoop selectBondLoopAvx2(BondConvention convention, const BondCriterion& criterion)
{
	return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")
	        ? BondLoopOf<Avx2, Batch> { convention, criterion }.find()
	        : nullptr;
}
#else
BondLoop selectBondLoopAvx2(BondConvention, const BondCriterion&) { return nullptr; }
#endif

} // namespace yade::ddem
