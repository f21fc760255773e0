// GPL v2 or later, see LICENSE.
// Loops over moving spheres, compiled for several instruction sets.
#pragma once

#include <pkg/bonded/kernel/SphereMotion.hpp>

namespace yade::ddem {

/// What a loop over spheres reads and writes, as plain pointers.
struct SphereArrays {
	double*       pose;
	double*       velocity;
	const double* load;
	const double* mass;
	const double* inertia;
	const double* free; ///< null where no degree of freedom is blocked
};

/// Moves spheres begin … end - 1, a whole number of SIMD batches.
using SphereLoop = SphereSums (*)(const SphereArrays&, std::size_t begin, std::size_t end, const SphereStep&);

/// Effects of the motion; each combination is a loop of its own, so that an effect that is off costs nothing.
namespace SphereEffects {
	enum : unsigned { Blocked = 1, Damping = 2, Energy = 4, Combinations = 8 };
}

/// The loop for the widest SIMD unit of the processor it runs on.
SphereLoop selectSphereLoop(unsigned effects);
/// Loops compiled for processors with AVX2 and FMA; null elsewhere.
SphereLoop selectSphereLoopAvx2(unsigned effects);

} // namespace yade::ddem
