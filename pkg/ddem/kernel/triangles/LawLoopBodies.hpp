// GPL v2 or later, see LICENSE.
// Body of the loops over tiles, written once for all laws, frames, effects and instruction sets. Included only by the
// files that LawLoops.cpp.in makes.
#pragma once

#include <pkg/ddem/kernel/triangles/LawLoops.hpp>
#include <pkg/ddem/kernel/triangles/StateColumns.hpp>

#include <array>
#include <type_traits>
#include <utility>

namespace yade::ddem {

/// Reads the numbers that a triangle has of its own.
template <class Law, class Number> struct LoadProperties {
	const TileState<Law>& tile;
	std::size_t           lane;
	std::size_t           next = 0;

	void operator()(const char*, const char*, Number& to)
	{
		to = Lanes<Number>::load(tile.property[next] + tile.propertyStep[next] * lane);
		next++;
	}
};

/// Rotation part of the forces and of the energy [J], eqs. 2–3; nothing where cores do not rotate.
template <class Frame, bool energy, class Number>
inline void addRotation(
        const GroupConstants& g, const LoadedElement<Number>& element, RelativeDisplacements<Number>& q, Number& stored)
{
	if constexpr (Frame::coreRotates) {
		const Number strain = rotationStrain(element.reference, element.du);
		const Number stress = Number(g.rotationModulus) * strain;
		addRotationForces(element.reference, stress, Number(g.thickness), q);
		if constexpr (energy) stored = Number(0.5 * g.thickness) * element.reference.area() * stress * strain;
	}
}

/// Numbers of a batch by lane, of which those beyond `count` do not count.
template <class Number> inline double sumOfFirst(const Number& value, std::size_t count)
{
	double lane[Lanes<Number>::width];
	Lanes<Number>::store(lane, value);
	double sum = 0;
	for (std::size_t i = 0; i < count; i++)
		sum += lane[i];
	return sum;
}

/// Bound on the change of a strain at rest [-], see LawLoops.hpp.
template <class Number> inline Number restBound(const LoadedElement<Number>& element, double rest)
{
	const auto   size = [](const PlaneVector<Number>& v) { return abs(v.x) + abs(v.y); };
	const auto&  arm  = element.reference.arm;
	const Number arms = size(arm[0]) + size(arm[1]) + size(arm[2]);
	return (Number(rest) * (size(element.centre) + arms) * arms) * (Number(1) / element.reference.twiceSubArea());
}

/// Stress and state of a sub-element (or of a batch of them) whose law may be held; its columns begin at `column`.
/// `state` has been loaded.
template <class Law, unsigned effects, class Number>
inline PlaneTensorOf<Number> holdOrAdvance(
        const TileState<Law>&                            tile,
        const typename Law::template Properties<Number>& own,
        const PlaneTensorOf<Number>&                     strain,
        const Number&                                    bound,
        double                                           dt,
        double*                                          column,
        typename Law::template State<Number>&            state)
{
	using std::max;
	constexpr bool              energy = effects & LawEffects::Energy;
	const auto&                 law    = *tile.law;
	const std::size_t           stride = 3 * tile.stride;
	const PlaneTensorOf<Number> change = strain - Law::evaluatedStrain(state);
	auto                  lanes = !(max(max(abs(change.xx), abs(change.yy)), abs(change.xy)) <= bound); // NaN moves
	auto                  later = lanes;
	bool                  again = false, every = all(lanes);
	double                time = dt;
	PlaneTensorOf<Number> stress {};
	if (__builtin_expect(!every || tile.held.flowWaits, false)) {
		if (tile.held.flowWaits) { // those that may wait have another time behind them than the others
			const auto patient = Law::template flowMayWait<effects>(law, state);
			later              = lanes & !patient;
			if (tile.held.flowIsDue) {
				lanes = lanes & patient;
				time  = tile.held.flowTime;
				again = any(later);
			} else
				lanes = later;
			every = all(lanes);
		}
		if (!every) {
			stress          = Law::template hold<effects>(law, own, strain, state);
			const bool none = !any(lanes);
			if constexpr (energy) {
				auto kept = state;
				Law::template bookHeld<effects>(strain, stress, kept);
				if (none && !again) { // all of the batch stays
					Law::template fields<effects>(kept, StoreFields<Number> { column, stride });
					state = kept;
					return stress;
				}
				// those that move book their step themselves
				const auto stay = !(lanes | later);
				Law::template fields<effects>(
				        kept, StoreSomeFields<Number, decltype(lanes)> { column, stride, stay });
			}
			if (none) {
				if (!again) return stress;
				lanes = later;
				time  = dt;
				again = false;
			}
		}
	}
	for (;;) {
		const PlaneTensorOf<Number> s = Law::template advance<effects>(law, own, strain, time, state);
		if (__builtin_expect(every, true)) {
			Law::template fields<effects>(state, StoreFields<Number> { column, stride });
			return s;
		}
		Law::template fields<effects>(
		        state, StoreSomeFields<Number, decltype(lanes)> { column, stride, lanes });
		stress = select(lanes, s, stress);
		if (energy || again)
			Law::template fields<effects>(state, LoadFields<Number> { column, stride, strain.zz });
		if (!again) return stress;
		lanes = later;
		time  = dt;
		again = false;
	}
}

/// Strain of a sub-element's initial stress, whose columns lie `step` numbers apart.
template <class Number> inline PlaneTensorOf<Number> initialStrain(const double* column, std::size_t step)
{
	using L = Lanes<Number>;
	return { L::load(column), L::load(column + step), L::load(column + 2 * step), L::load(column + 3 * step) };
}

/** Whole batches: rows of `a` from `begin` on, places in the tile from `lane` on. Of the last batch `real` lanes
 * count in the energies. `below`: of a virgin tile below the law's threshold; \returns false as soon as that is
 * reached. InstructionSet is only a tag that keeps the functions of different instruction sets apart; flatten
 * inlines everything, so that no shared inline function is emitted with the instructions of one of them; one copy
 * of the code gives every batch the same bits. */
template <class Law, unsigned effects, bool below, class Frame, class Number, class InstructionSet>
__attribute__((noinline, noclone, flatten)) bool advanceBatches(
        const ElementArrays&  a,
        const GroupConstants& g,
        const TileState<Law>& tile,
        double                dt,
        std::size_t           begin,
        std::size_t           lane,
        std::size_t           batches,
        std::size_t           real,
        StepEnergy&           sum)
{
	constexpr bool        energy = effects & LawEffects::Energy, dissipates = Law::dissipates(effects);
	constexpr bool        holds  = !below && Law::holds(effects);
	constexpr std::size_t width  = Lanes<Number>::width;
	const std::size_t     stride = tile.stride;
	const auto&           law    = *tile.law;
	Number                stored(0.), turned(0.), plastic(0.), damage(0.);
	for (std::size_t b = 0; b < batches; b++) {
		const std::size_t           i = begin + b * width, place = lane + b * width;
		const LoadedElement<Number> element = loadElement<Frame, Number>(a, i);
		const auto                  strains = subElementStrains(element.reference, element.du);

		typename Law::template Properties<Number> own;
		Law::template properties<effects>(own, LoadProperties<Law, Number> { tile, place });
		SubElementTensors<Number> stress;
		auto                      beyond = Number(0.) > Number(0.); // no lane
		Number                    volume(0.), storedHere(0.), turnedHere(0.), plasticHere(0.), damageHere(0.);
		if constexpr (energy) volume = Number(0.5 * g.thickness) * element.reference.twiceSubArea();
		Number bound(0.);
		if constexpr (holds) bound = restBound(element, tile.held.rest);
		for (std::size_t k = 0; k < 3; k++) {
			double* const                        column = tile.columns + k * stride + place;
			typename Law::template State<Number> state {};
			PlaneTensorOf<Number> strain { strains[k].xx, strains[k].yy, Number(0.), strains[k].xy };
			if constexpr (!below)
				if (tile.initialStrain)
					strain = strain
					        + initialStrain<Number>(
					                 tile.initialStrain + k * stride + place, 3 * stride);
			PlaneTensorOf<Number>       s;
			if constexpr (below) {
				s      = elasticStress(law.lambda, law.twoShear, strain);
				beyond = beyond || Law::template beyondThreshold<effects>(law, own, strain);
			} else {
				Law::template fields<effects>(
				        state, LoadFields<Number> { column, 3 * stride, strain.zz });
				if constexpr (holds)
					s = holdOrAdvance<Law, effects>(tile, own, strain, bound, dt, column, state);
				else {
					s = Law::template advance<effects>(law, own, strain, dt, state);
					Law::template fields<effects>(
					        state, StoreFields<Number> { column, 3 * stride });
				}
			}
			stress[k] = { s.xx, s.yy, s.xy };
			if constexpr (energy) {
				const auto densities = Law::template energies<effects>(law, strain, s, state);
				storedHere           = storedHere + volume * densities.stored;
				if constexpr (dissipates) {
					plasticHere = plasticHere + volume * densities.plastic;
					damageHere  = damageHere + volume * densities.damage;
				}
			}
		}
		if constexpr (below)
			if (any(beyond)) return false;
		RelativeDisplacements<Number> q = stressForces(element.reference, stress, Number(g.thickness));
		addRotation<Frame, energy>(g, element, q, turnedHere);
		storeForces<Frame>(a, i, element, q);
		if constexpr (energy) {
			if (b + 1 == batches && real < width) {
				sum.elastic += sumOfFirst(storedHere, real);
				sum.rotation += sumOfFirst(turnedHere, real);
				if constexpr (dissipates) {
					sum.plastic += sumOfFirst(plasticHere, real);
					sum.damage += sumOfFirst(damageHere, real);
				}
			} else {
				stored = stored + storedHere;
				turned = turned + turnedHere;
				if constexpr (dissipates) {
					plastic = plastic + plasticHere;
					damage  = damage + damageHere;
				}
			}
		}
	}
	if constexpr (energy) {
		sum.elastic += Lanes<Number>::sum(stored);
		sum.rotation += Lanes<Number>::sum(turned);
		if constexpr (dissipates) {
			sum.plastic += Lanes<Number>::sum(plastic);
			sum.damage += Lanes<Number>::sum(damage);
		}
	}
	return true;
}

template <class Law, unsigned effects, bool below, class Frame, class Number, class InstructionSet>
bool tileLoop(
        const ElementArrays&  a,
        const GroupConstants& g,
        const TileState<Law>& tile,
        double                dt,
        std::size_t           begin,
        std::size_t           end,
        StepEnergy&           sum)
{
	constexpr std::size_t width   = Lanes<Number>::width;
	const std::size_t     batches = (end - begin) / width, done = batches * width, rest = end - begin - done;
	static constexpr auto advance = &advanceBatches<Law, effects, below, Frame, Number, InstructionSet>;
	static_assert(
	        !(below && (effects & LawEffects::Energy)),
	        "a step that is taken again must not have added its energies");
	if (!advance(a, g, tile, dt, begin, 0, batches, width, sum)) return false;
	if (rest == 0) return true;
	FilledBatch filled(a, begin + done, rest, Frame::coreRotates);
	if (!advance(filled.arrays(), g, tile, dt, 0, done, 1, rest, sum)) return false;
	filled.handOver();
	return true;
}

template <class Law, unsigned effects, class Frame, class Number, class InstructionSet>
constexpr TileLoops<Law> loopsOfMask()
{
	TileLoops<Law> loops { &tileLoop<Law, effects, false, Frame, Number, InstructionSet>, nullptr };
	if constexpr (Law::hasThreshold(effects) && !(effects & LawEffects::Energy))
		loops.below = &tileLoop<Law, effects, true, Frame, Number, InstructionSet>;
	return loops;
}

template <class Law, class Frame, class Number, class InstructionSet, std::size_t... masks>
constexpr std::array<TileLoops<Law>, sizeof...(masks)> tileLoops(std::index_sequence<masks...>)
{
	return { { loopsOfMask<Law, Law::distinct(unsigned(masks)), Frame, Number, InstructionSet>()... } };
}

/// The batches of an instruction set; none where this file is compiled without it.
template <class InstructionSet> struct BatchOf {
	using Type = void;
};
template <> struct BatchOf<Baseline> {
	using Type = xsimd::make_sized_batch_t<double, 2>;
};
#if defined(__AVX2__) && defined(__FMA__)
template <> struct BatchOf<Avx2> {
	using Type = xsimd::batch<double, xsimd::fma3<xsimd::avx2>>;
};
#endif

template <class Law, class Frame, class InstructionSet>
TileLoops<Law> LawLoops<Law, Frame, InstructionSet>::select(unsigned effects)
{
	using Batch = typename BatchOf<InstructionSet>::Type;
	if constexpr (std::is_void_v<Batch>) return {};
	else {
		// masks that do the same share one loop
		static constexpr auto loops
		        = tileLoops<Law, Frame, Batch, InstructionSet>(std::make_index_sequence<Law::allEffects + 1>());
		return loops.at(effects);
	}
}

} // namespace yade::ddem
