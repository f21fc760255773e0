// GPL v2 or later, see LICENSE.
// Loops over bonds, compiled for several instruction sets.
#pragma once

#include <pkg/bonded/kernel/BondSystem.hpp>

namespace yade::ddem {

/// What a bond loop reads and writes, as plain pointers.
struct BondArrays {
	const std::int32_t* first;
	const std::int32_t* second;
	const double*       pose;
	const double*       constant[BondSystem::ConstantCount];
	const double*       strength[mostStrengths];
	double*             memory[mostMemories];
	double*             rows;
	double*             overload; ///< written only where a bond of a batch is beyond its strength
	double*             lost;     ///< written only by criteria with a memory
};

/// Computes bonds begin … end - 1 and, rounded up to whole SIMD batches, some after them. \returns whether any of
/// them is beyond its strength
using BondLoop = bool (*)(const BondArrays&, std::size_t begin, std::size_t end);

/// The loop of a criterion for the widest SIMD unit of the processor it runs on; null for a criterion that the
/// convention does not know.
BondLoop selectBondLoop(BondConvention convention, const BondCriterion& criterion);
/// Loops compiled for processors with AVX2 and FMA; null elsewhere, too.
BondLoop selectBondLoopAvx2(BondConvention convention, const BondCriterion& criterion);

} // namespace yade::ddem
