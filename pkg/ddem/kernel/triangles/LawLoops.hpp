// GPL v2 or later, see LICENSE.
// The loops over a tile that a law has: one for every mask of effects, rotation treatment and instruction set.
#pragma once

#include <pkg/ddem/kernel/triangles/ElementArrays.hpp>
#include <pkg/ddem/kernel/triangles/StepEnergy.hpp>

#include <cstddef>

namespace yade::ddem {

/// Bit of a law's mask that every law has: keep the energy book. A law's own effects start at 2.
namespace LawEffects {
	enum : unsigned { Energy = 1 };
}

/// Energies per volume [J/m³] of a sub-element.
template <class Number> struct EnergyDensities {
	Number stored, plastic, damage;
};

constexpr std::size_t mostProperties = 4; ///< numbers that triangles of one law may have of their own

/// A law's parameters and the state of one tile, as plain pointers.
template <class Law> struct TileState {
	const typename Law::Prepared* law;
	double*                       columns; ///< see StateColumns
	std::size_t                   stride;
	const double*                 property[mostProperties];     ///< of the tile's first triangle
	std::size_t                   propertyStep[mostProperties]; ///< 0 where all triangles share one value
};

/// Advances the triangles [begin, end), rows of the arrays, by dt [s]; fills forces, and the energies where the mask has Energy.
template <class Law>
using TileLoop = void (*)(
        const ElementArrays&,
        const GroupConstants&,
        const TileState<Law>&,
        double      dt,
        std::size_t begin,
        std::size_t end,
        StepEnergy&);

/// Instruction sets that loops are compiled for.
struct Baseline;
struct Avx2;

/// The loops of one law, frame and instruction set. Compiled in files of their own, see LawLoops.cpp.in.
template <class Law, class Frame, class InstructionSet> struct LawLoops {
	/// The loop for a mask of effects; null where this build has no such instructions.
	static TileLoop<Law> select(unsigned effects);
};

/// Whether the processor this runs on has AVX2 and FMA.
bool processorHasAvx2();

/// The loop in the widest instructions that the processor has.
template <class Law> TileLoop<Law> selectTileLoop(unsigned effects, RotationTreatment rotation, bool widest = true)
{
	const auto of = [&](auto frame) {
		using Frame         = decltype(frame);
		TileLoop<Law> found = widest && processorHasAvx2() ? LawLoops<Law, Frame, Avx2>::select(effects) : nullptr;
		return found ? found : LawLoops<Law, Frame, Baseline>::select(effects);
	};
	switch (rotation) {
		case RotationTreatment::None: return of(FrameNone());
		case RotationTreatment::Corotational: return of(FrameCorotational());
		default: return of(FrameCosserat());
	}
}

} // namespace yade::ddem
