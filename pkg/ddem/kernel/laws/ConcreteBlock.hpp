// GPL v2 or later, see LICENSE.
// One step of the concrete law for many sub-elements at once, in the widest vectors that the processor has.
#pragma once

#include <pkg/ddem/kernel/laws/ConcreteLaw.hpp>

#include <cstddef>

namespace yade::ddem {

/// Fracture energies of consecutive sub-elements [J/m³], see FractureEnergyOf; both may be the same array.
struct FractureEnergies {
	const double *spread, *band;

	FractureEnergies(const double* both) // NOLINT: one array is meant to do for both
	        : spread(both)
	        , band(both)
	{
	}
	FractureEnergies(const double* first, const double* second)
	        : spread(first)
	        , band(second)
	{
	}
	FractureEnergies from(std::size_t i) const { return { spread + i, band + i }; }
};

/// advanceConcrete for `count` consecutive sub-elements: element i goes to the strain newStrain[i] with its own fracture energy.
/// What happens to one does not depend on its neighbours or on its place in the block, so the result does not depend on the order of elements.
using ConcreteBlockUpdate = void (*)(
        const PreparedConcrete& concrete, const FractureEnergies& fractureEnergy, const PlaneTensor* newStrain, double dt, ConcreteState* state, std::size_t count);

/// The block update for a mask of effects and this processor; pick it once per group of elements. Throws std::invalid_argument for an unknown bit.
ConcreteBlockUpdate concreteBlockUpdate(unsigned effects);

/// The block update in the instructions that every processor of the architecture has.
ConcreteBlockUpdate concreteBlockUpdateBaseline(unsigned effects);

/// The AVX2 block update, or null where the processor or the build has none.
ConcreteBlockUpdate concreteBlockUpdateAvx2(unsigned effects);

} // namespace yade::ddem
