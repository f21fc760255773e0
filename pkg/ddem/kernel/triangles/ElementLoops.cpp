// GPL v2 or later, see LICENSE.
#include <pkg/ddem/kernel/triangles/ElementLoopBodies.hpp>

#include <algorithm>
#include <array>

namespace yade::ddem {

namespace {

	struct Baseline;

	/// Concrete elements, some at a time: their strains, one update of all their sub-elements in SIMD lanes, their forces.
	template <class Frame, bool energy>
	void concreteLoop(const ElementArrays& a, const TriangleGroup& g, std::size_t begin, std::size_t end, StepEnergy& sum)
	{
		constexpr std::size_t                   most = 16;
		std::array<LoadedElement<double>, most> element;
		std::array<PlaneTensor, 3 * most>       strain;
		std::array<double, 3 * most>            fractureEnergy, bandEnergy;
		const FractureEnergies                  energies(fractureEnergy.data(), a.bandEnergy ? bandEnergy.data() : fractureEnergy.data());
		for (std::size_t first = begin; first < end; first += most) {
			const std::size_t count = std::min(most, end - first);
			for (std::size_t j = 0; j < count; j++) {
				element[j]         = loadElement<Frame, double>(a, first + j);
				const auto strains = subElementStrains(element[j].reference, element[j].du);
				for (std::size_t k = 0; k < 3; k++) {
					strain[3 * j + k]         = { strains[k].xx, strains[k].yy, 0, strains[k].xy };
					fractureEnergy[3 * j + k] = a.fractureEnergy[first + j];
					if (a.bandEnergy) bandEnergy[3 * j + k] = a.bandEnergy[first + j];
				}
			}
			ConcreteState* state = a.state + 3 * (first - g.begin);
			a.update(*a.concrete, energies, strain.data(), a.dt, state, 3 * count);
			for (std::size_t j = 0; j < count; j++, state += 3) {
				SubElementTensors<double> stress;
				for (std::size_t k = 0; k < 3; k++)
					stress[k] = { state[k].stress.xx, state[k].stress.yy, state[k].stress.xy };
				RelativeDisplacements<double> q = stressForces(element[j].reference, stress, g.thickness);
				addRotation<Frame, energy>(g, element[j], q, sum.rotation);
				storeForces<Frame>(a, first + j, element[j], q);
				if constexpr (energy) {
					const double volume = 0.5 * g.thickness * element[j].reference.twiceSubArea();
					for (std::size_t k = 0; k < 3; k++) {
						sum.elastic += volume * storedEnergy(state[k]);
						sum.plastic += volume * state[k].plasticDissipation;
						sum.damage += volume * state[k].damageDissipation;
					}
				}
			}
		}
	}

	template <bool energy> ElementLoop concreteLoopFor(RotationTreatment rotation)
	{
		switch (rotation) {
			case RotationTreatment::None: return concreteLoop<FrameNone, energy>;
			case RotationTreatment::Corotational: return concreteLoop<FrameCorotational, energy>;
			default: return concreteLoop<FrameCosserat, energy>;
		}
	}

} // namespace

ElementLoop selectElementLoop(TriangleGroup::Law law, RotationTreatment rotation, bool energy)
{
	if (law == TriangleGroup::Law::Concrete) return energy ? concreteLoopFor<true>(rotation) : concreteLoopFor<false>(rotation);
	if (const ElementLoop wide = selectElasticLoopAvx2(rotation, energy)) return wide;
	return selectElasticLoopBaseline(rotation, energy);
}

ElementLoop selectElasticLoopBaseline(RotationTreatment rotation, bool energy)
{
	return energy ? elasticLoopFor<Baseline, double, true>(rotation) : elasticLoopFor<Baseline, double, false>(rotation);
}

} // namespace yade::ddem
