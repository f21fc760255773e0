// GPL v2 or later, see LICENSE.
// The loops over a tile that a law has: one for every mask of effects, rotation treatment and instruction set.
//
// A law need not be evaluated in every step. In a *held* step of a sub-element its stress follows elastically from the
// present strain and the state of the last evaluation (plastic strain, damage, openness and stiffening stand), and the
// state stays as it is. What is held is decided for every sub-element by itself, from its own strain and state alone,
// never by its neighbours or by a history that is not saved: a triangle's forces have the same bits in any lane, tile
// or domain, and after loading. A batch in which all are held skips the law. There are two reasons to hold, both of
// laws with LawDefaults::holds:
//
// - *Rest*. The strain has changed since the last evaluation by no more than the round-off that it carries itself.
//   Positions are stored to ε|x|/2, ε = 2^-52, so strain, the change of relative displacements over arms r and twice
//   the area A2 of a sub-element, is known to about ε |x| Σ|r|/A2, and stress to E times this. The bound is
//   LawGroup::rest times that, with |x| = |x|₁ + Σ|r|₁ of the core. Within it the law would have added flow of at most
//   Λ_0 times the bound, and only because round-off makes strain jitter: a block at rest would creep by it. The first
//   step beyond the bound evaluates the law from the strain of the last evaluation, so no strain is lost, however
//   slowly it grows. Its time is that of the step that left the rest: a rate-dependent law that has slept for a second
//   must not take an impact for slow. Where strain creeps by n steps to a bound, its rate is then n times too high, and
//   flow, ∝ (ė_N)^(ω_p - 1) per strain, too low by n^(1-ω_p) (4 % for n = 3 in concrete); but a run of 10^7 steps that
//   all creep like this strains by less than 10^-5 in all. Measured: where nothing but round-off moves a block (0.1 m
//   wide, up to 30 m from the origin) strain stays within half of the bound, so that no law is evaluated.
// - *Flow waits*: LawGroup::flowInterval, see there.
//
// A law with a threshold, LawDefaults::hasThreshold, has a second loop, for tiles that are virgin: elastic, with a look
// whether any sub-element has reached the threshold. The tile then takes that same step again, with the law, and from
// then on always. Results have the bits of the law's own loop. It is not for steps with the energy book, which needs
// the strain of the step before the threshold.
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

/// Which sub-elements are held in a step.
struct HeldSteps {
	double rest      = 0;     ///< see LawGroup::rest, times ε [-]
	bool   flowWaits = false; ///< flow is not solved in every step
	bool   flowIsDue = true;  ///< it is in this one
	double flowTime  = 0;     ///< from the last solution of flow that waits to the end of this step [s]
};

/// A law's parameters and the state of one tile, as plain pointers.
template <class Law> struct TileState {
	const typename Law::Prepared* law;
	double*                       columns; ///< see StateColumns
	std::size_t                   stride;
	const double*                 property[mostProperties];     ///< of the tile's first triangle
	std::size_t                   propertyStep[mostProperties]; ///< 0 where all triangles share one value
	HeldSteps                     held;
	const double* initialStrain = nullptr; ///< columns xx, yy, zz, xy as those of the state;
	                                       ///< null where there is none
};

/// Advances the triangles [begin, end), rows of the arrays, by dt [s]; fills forces, and the energies where the mask
/// has Energy.
/// \returns false where a threshold was reached: the tile then has to take the step again with its law.
template <class Law>
using TileLoop = bool (*)(
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

/// The loops of one mask.
template <class Law> struct TileLoops {
	TileLoop<Law> law   = nullptr; ///< null where this build has no such instructions
	TileLoop<Law> below = nullptr; ///< for virgin tiles below the law's threshold; null where it has none

	bool operator==(const TileLoops& other) const { return law == other.law && below == other.below; }
};

/// The loops of one law, frame and instruction set. Compiled in files of their own, see LawLoops.cpp.in.
template <class Law, class Frame, class InstructionSet> struct LawLoops {
	/// The loops for a mask of effects.
	static TileLoops<Law> select(unsigned effects);
};

/// Whether the processor this runs on has AVX2 and FMA.
bool processorHasAvx2();

/// The loops in the widest instructions that the processor has.
template <class Law> TileLoops<Law> selectTileLoops(unsigned effects, RotationTreatment rotation, bool widest = true)
{
	const auto of = [&](auto frame) {
		using Frame = decltype(frame);
		TileLoops<Law> found;
		if (widest && processorHasAvx2()) found = LawLoops<Law, Frame, Avx2>::select(effects);
		return found.law ? found : LawLoops<Law, Frame, Baseline>::select(effects);
	};
	switch (rotation) {
		case RotationTreatment::None: return of(FrameNone());
		case RotationTreatment::Corotational: return of(FrameCorotational());
		default: return of(FrameCosserat());
	}
}

} // namespace yade::ddem
