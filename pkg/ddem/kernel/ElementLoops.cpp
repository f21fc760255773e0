// GPL v2 or later, see LICENSE.
#include <pkg/ddem/kernel/ElementLoopBodies.hpp>

namespace yade::ddem {

namespace {

	struct Baseline;

	template <class Frame, bool energy>
	void concreteLoop(const ElementArrays& a, const TriangleGroup& g, std::size_t begin, std::size_t end, StepEnergy& sum)
	{
		ConcreteState* state = a.state + 3 * (begin - g.begin);
		for (std::size_t i = begin; i < end; i++, state += 3) {
			const LoadedElement<double>     element = loadElement<Frame, double>(a, i);
			const SubElementTensors<double> strain  = subElementStrains(element.reference, element.du);
			SubElementTensors<double>       stress;
			for (int k = 0; k < 3; k++) {
				a.update(*a.concrete, a.fractureEnergy[i], PlaneTensor { strain[k].xx, strain[k].yy, 0, strain[k].xy }, a.dt, state[k]);
				stress[k] = { state[k].stress.xx, state[k].stress.yy, state[k].stress.xy };
			}
			RelativeDisplacements<double> q        = stressForces(element.reference, stress, g.thickness);
			double                        rotation = 0;
			addRotation<Frame, energy>(g, element, q, rotation);
			storeForces<Frame>(a, i, element, q);
			if constexpr (energy) {
				const double volume = 0.5 * g.thickness * element.reference.twiceSubArea();
				sum.rotation += rotation;
				for (int k = 0; k < 3; k++) {
					sum.elastic += volume * storedEnergy(state[k]);
					sum.plastic += volume * state[k].plasticDissipation;
					sum.damage += volume * state[k].damageDissipation;
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
