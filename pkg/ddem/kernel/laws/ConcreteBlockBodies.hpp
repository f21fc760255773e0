// GPL v2 or later, see LICENSE.
// Body of the block update of the concrete law, compiled once per instruction set.
#pragma once

#include <pkg/ddem/kernel/laws/ConcreteBlock.hpp>

#include <xsimd/xsimd.hpp>

#include <array>
#include <utility>

namespace yade::ddem {

/// One tensor of each of Batch::size elements, `stride` doubles apart, transposed into batches of components.
template <class Batch> inline PlaneTensorOf<Batch> loadTensors(const double* first, std::size_t stride)
{
	constexpr std::size_t width = Batch::size;
	static_assert(width == 2 || width == 4, "a tensor has four components");
	Batch rows[4];
	for (std::size_t block = 0; block < 4; block += width) {
		for (std::size_t lane = 0; lane < width; ++lane)
			rows[block + lane] = Batch::load_unaligned(first + lane * stride + block);
		xsimd::transpose(rows + block, rows + block + width);
	}
	return { rows[0], rows[1], rows[2], rows[3] };
}

/// The inverse of loadTensors.
template <class Batch> inline void storeTensors(const PlaneTensorOf<Batch>& tensor, double* first, std::size_t stride)
{
	constexpr std::size_t width   = Batch::size;
	Batch                 rows[4] = { tensor.xx, tensor.yy, tensor.zz, tensor.xy };
	for (std::size_t block = 0; block < 4; block += width) {
		xsimd::transpose(rows + block, rows + block + width);
		for (std::size_t lane = 0; lane < width; ++lane)
			rows[block + lane].store_unaligned(first + lane * stride + block);
	}
}

template <class Batch> inline Batch loadNumbers(const double* first, std::size_t stride)
{
	alignas(Batch) double lane[Batch::size];
	for (std::size_t i = 0; i < Batch::size; ++i)
		lane[i] = first[i * stride];
	return Batch::load_aligned(lane);
}

template <class Batch> inline void storeNumbers(const Batch& value, double* first, std::size_t stride)
{
	alignas(Batch) double lane[Batch::size];
	value.store_aligned(lane);
	for (std::size_t i = 0; i < Batch::size; ++i)
		first[i * stride] = lane[i];
}

/// Batch::size sub-elements at once; memory that the effects do not use is neither read nor written.
template <unsigned effects, class Batch>
inline void advanceBatch(const PreparedConcrete& concrete, const FractureEnergies& fractureEnergy, const PlaneTensor* newStrain, double dt, ConcreteState* state)
{
	constexpr std::size_t stride   = sizeof(ConcreteState) / sizeof(double);
	constexpr bool        flows    = effects & ConcreteEffects::Flow;
	constexpr bool        damages  = effects & ConcreteEffects::Damage;
	constexpr bool        stiffens = effects & ConcreteEffects::EquationOfState;
	constexpr bool        books    = effects & ConcreteEffects::Energy;
	const Batch           zero(0.);

	ConcreteStateOf<Batch> s;
	s.stress        = loadTensors<Batch>(&state->stress.xx, stride);
	s.strain        = loadTensors<Batch>(&state->strain.xx, stride);
	s.plasticStrain = loadTensors<Batch>(&state->plasticStrain.xx, stride);
	s.damage        = damages ? loadTensors<Batch>(&state->damage.xx, stride) : PlaneTensorOf<Batch> { zero, zero, zero, zero };
	s.closure       = damages ? loadNumbers<Batch>(&state->closure, stride) : zero;
	s.stiffening    = stiffens ? loadNumbers<Batch>(&state->stiffening, stride) : zero;
	if constexpr (books) {
		s.plasticDissipation = loadNumbers<Batch>(&state->plasticDissipation, stride);
		s.damageDissipation  = loadNumbers<Batch>(&state->damageDissipation, stride);
		s.stiffeningEnergy   = loadNumbers<Batch>(&state->stiffeningEnergy, stride);
	} else
		s.plasticDissipation = s.damageDissipation = s.stiffeningEnergy = zero;

	FractureEnergyOf<Batch> energy(zero);
	if constexpr (flows && damages) energy = { Batch::load_unaligned(fractureEnergy.spread), Batch::load_unaligned(fractureEnergy.band) };
	advanceConcrete<effects>(concrete, energy, loadTensors<Batch>(&newStrain->xx, 4), dt, s);

	storeTensors(s.stress, &state->stress.xx, stride);
	storeTensors(s.strain, &state->strain.xx, stride);
	if constexpr (flows || damages) storeTensors(s.plasticStrain, &state->plasticStrain.xx, stride);
	if constexpr (flows && damages) storeTensors(s.damage, &state->damage.xx, stride);
	if constexpr (damages) storeNumbers(s.closure, &state->closure, stride);
	if constexpr (stiffens) storeNumbers(s.stiffening, &state->stiffening, stride);
	if constexpr (books) {
		storeNumbers(s.plasticDissipation, &state->plasticDissipation, stride);
		storeNumbers(s.damageDissipation, &state->damageDissipation, stride);
		storeNumbers(s.stiffeningEnergy, &state->stiffeningEnergy, stride);
	}
}

template <unsigned effects, class Batch>
void advanceBlock(
        const PreparedConcrete& concrete, const FractureEnergies& fractureEnergy, const PlaneTensor* newStrain, double dt, ConcreteState* state, std::size_t count)
{
	constexpr std::size_t width = Batch::size;
	std::size_t           i     = 0;
	for (; i + width <= count; i += width)
		advanceBatch<effects, Batch>(concrete, fractureEnergy.from(i), newStrain + i, dt, state + i);
	if (i == count) return;

	// the rest goes through a full batch too, with its last element repeated: the same instructions give the same result at any place
	double        spread[width], band[width];
	PlaneTensor   strains[width];
	ConcreteState states[width];
	for (std::size_t lane = 0; lane < width; ++lane) {
		const std::size_t from = i + lane < count ? i + lane : count - 1;
		spread[lane]           = fractureEnergy.spread[from];
		band[lane]             = fractureEnergy.band[from];
		strains[lane]          = newStrain[from];
		states[lane]           = state[from];
	}
	advanceBatch<effects, Batch>(concrete, { spread, band }, strains, dt, states);
	for (std::size_t lane = 0; i + lane < count; ++lane)
		state[i + lane] = states[lane];
}

/// The block updates of all masks.
template <class Batch, std::size_t... masks> constexpr std::array<ConcreteBlockUpdate, sizeof...(masks)> blockUpdates(std::index_sequence<masks...>)
{
	return { { &advanceBlock<static_cast<unsigned>(masks), Batch>... } };
}

} // namespace yade::ddem
