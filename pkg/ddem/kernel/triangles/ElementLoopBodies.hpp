// GPL v2 or later, see LICENSE.
// Bodies of the element loops, written once for scalars and SIMD lanes. Included by the files that compile them for one instruction set each.
#pragma once

#include <pkg/ddem/kernel/triangles/ElementLoops.hpp>
#include <pkg/ddem/kernel/algebra/Lanes.hpp>

namespace yade::ddem {

/// An element (or a batch of them) as the loops see it.
template <class Number> struct LoadedElement {
	TriangleReference<Number>     reference;
	RelativeDisplacements<Number> fromCentre;
	PlaneRotation<Number>              frame;
	RelativeDisplacements<Number> du;
};

template <class Frame, class Number> inline LoadedElement<Number> loadElement(const ElementArrays& a, std::size_t i)
{
	using L = Lanes<Number>;
	LoadedElement<Number>     element;
	const PlaneVector<Number> first { L::load(a.arm[0] + i), L::load(a.arm[1] + i) };
	const PlaneVector<Number> second { L::load(a.arm[2] + i), L::load(a.arm[3] + i) };
	element.reference                = TriangleReference<Number>(first, second);
	const PlaneVector<Number> centre = L::loadPoints(a.corePosition + 2 * i);
	for (int e = 0; e < 3; e++)
		element.fromCentre[e] = L::gatherPoints(a.nodePosition, a.vertex[e] + i) - centre;
	Number angle(0);
	if constexpr (Frame::coreRotates) angle = L::load(a.coreAngle + i);
	element.frame = Frame::rotation(element.reference, element.fromCentre, angle);
	for (int e = 0; e < 3; e++)
		element.du[e] = relativeDisplacement(element.frame, element.fromCentre[e], element.reference.arm[e]);
	return element;
}

template <class Frame, class Number>
inline void storeForces(const ElementArrays& a, std::size_t i, const LoadedElement<Number>& element, const RelativeDisplacements<Number>& q)
{
	using L                           = Lanes<Number>;
	const ElementForces<Number> force = Frame::distribute(element.reference, element.fromCentre, element.frame, element.du, q);
	for (int e = 0; e < 3; e++)
		L::storePoints(a.cornerForce[e] + 2 * i, force.vertex[e]);
	L::storePoints(a.coreForce + 2 * i, force.core);
	if constexpr (Frame::coreRotates) L::store(a.coreMoment + i, force.moment);
}

/// Rotation part of the forces and of the energy [J], eqs. 2–3; nothing where cores do not rotate.
template <class Frame, bool energy, class Number>
inline void addRotation(const TriangleGroup& g, const LoadedElement<Number>& element, RelativeDisplacements<Number>& q, Number& rotationEnergy)
{
	if constexpr (Frame::coreRotates) {
		const Number strain = rotationStrain(element.reference, element.du);
		const Number stress = Number(g.rotationModulus) * strain;
		addRotationForces(element.reference, stress, Number(g.thickness), q);
		if constexpr (energy) rotationEnergy = rotationEnergy + Number(0.5 * g.thickness) * element.reference.area() * stress * strain;
	}
}

template <class Frame, bool energy, class Number>
inline void elasticElement(const ElementArrays& a, const TriangleGroup& g, std::size_t i, Number& elasticEnergy, Number& rotationEnergy)
{
	const LoadedElement<Number>     element = loadElement<Frame, Number>(a, i);
	const SubElementTensors<Number> strain  = subElementStrains(element.reference, element.du);
	SubElementTensors<Number>       stress;
	for (int k = 0; k < 3; k++)
		stress[k] = elasticStress(strain[k], Number(g.lambda), Number(g.mu));
	RelativeDisplacements<Number> q = stressForces(element.reference, stress, Number(g.thickness));
	if constexpr (energy)
		for (int k = 0; k < 3; k++)
			elasticEnergy = elasticEnergy + Number(0.5 * g.thickness) * element.reference.twiceSubArea() * energyDensity(stress[k], strain[k]);
	addRotation<Frame, energy>(g, element, q, rotationEnergy);
	storeForces<Frame>(a, i, element, q);
}

/** All elastic elements of [begin, end): SIMD batches, then the rest one by one. Arch is only a tag that keeps the instantiations of different instruction sets
 * apart; flatten inlines everything, so that no shared inline function is emitted with the instructions of one of them. */
template <class Arch, class Number, class Frame, bool energy>
__attribute__((flatten)) void elasticLoop(const ElementArrays& a, const TriangleGroup& g, std::size_t begin, std::size_t end, StepEnergy& sum)
{
	std::size_t i = begin;
	Number      elasticLanes(0), rotationLanes(0);
	for (; i + Lanes<Number>::width <= end; i += Lanes<Number>::width)
		elasticElement<Frame, energy, Number>(a, g, i, elasticLanes, rotationLanes);
	double elasticRest = 0, rotationRest = 0;
	for (; i < end; i++)
		elasticElement<Frame, energy, double>(a, g, i, elasticRest, rotationRest);
	if constexpr (energy) {
		sum.elastic += Lanes<Number>::sum(elasticLanes) + elasticRest;
		sum.rotation += Lanes<Number>::sum(rotationLanes) + rotationRest;
	}
}

template <class Arch, class Number, bool energy> inline ElementLoop elasticLoopFor(RotationTreatment rotation)
{
	switch (rotation) {
		case RotationTreatment::None: return elasticLoop<Arch, Number, FrameNone, energy>;
		case RotationTreatment::Corotational: return elasticLoop<Arch, Number, FrameCorotational, energy>;
		default: return elasticLoop<Arch, Number, FrameCosserat, energy>;
	}
}

} // namespace yade::ddem
