// GPL v2 or later, see LICENSE.
// Loops over spheres for AVX2 and FMA; compiled with these instructions, chosen at run time only where the processor
// has them.
#include <pkg/bonded/kernel/SphereLoopBodies.hpp>

namespace yade::ddem {

#if defined(__AVX2__) && defined(__FMA__)
namespace {
	struct Avx2;
	using Batch = xsimd::batch<double, xsimd::fma3<xsimd::avx2>>;
}
SphereLoop selectSphereLoopAvx2(unsigned effects)
{
	return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? sphereLoopFor<Avx2, Batch>(effects)
	                                                                       : nullptr;
}
#else
SphereLoop selectSphereLoopAvx2(unsigned) { return nullptr; }
#endif

} // namespace yade::ddem
