// GPL v2 or later, see LICENSE.
// Elastic loops for AVX2 and FMA; compiled with these instructions, chosen at run time only where the processor has them.
#include <pkg/ddem/kernel/triangles/ElementLoopBodies.hpp>

namespace yade::ddem {

#if defined(__AVX2__) && defined(__FMA__)
namespace {
	struct Avx2;
	using Batch = xsimd::batch<double, xsimd::fma3<xsimd::avx2>>;
}
ElementLoop selectElasticLoopAvx2(RotationTreatment rotation, bool energy)
{
	if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return nullptr;
	return energy ? elasticLoopFor<Avx2, Batch, true>(rotation) : elasticLoopFor<Avx2, Batch, false>(rotation);
}
#else
ElementLoop selectElasticLoopAvx2(RotationTreatment, bool) { return nullptr; }
#endif

} // namespace yade::ddem
