// GPL v2 or later, see LICENSE.
// Loops over the triangles of one group: internal forces of elastic and concrete elements.
#pragma once

#include <pkg/ddem/kernel/laws/ConcreteBlock.hpp>
#include <pkg/ddem/kernel/triangles/TriangleSystem.hpp>

namespace yade::ddem {

/// What an element loop reads and writes, as plain pointers.
struct ElementArrays {
	const std::int32_t*     vertex[3];
	const double*           arm[4];
	const double*           nodePosition;
	const double*           corePosition;
	const double*           coreAngle;      ///< null unless cores rotate
	double*                 cornerForce[3]; ///< x, y of corner e of every triangle
	double*                 coreForce;
	double*                 coreMoment; ///< null unless cores rotate
	const PreparedConcrete* concrete;   ///< of concrete groups
	ConcreteBlockUpdate     update;
	ConcreteState*          state; ///< first state of the group
	const double*           fractureEnergy;
	const double*           bandEnergy; ///< null unless a crack band is asked for
	double                  dt;
};

using ElementLoop = void (*)(const ElementArrays&, const TriangleGroup&, std::size_t begin, std::size_t end, StepEnergy&);

/// The loop for a law, a rotation treatment, with or without the energy book; elastic loops use the widest SIMD unit of the processor they run on.
ElementLoop selectElementLoop(TriangleGroup::Law law, RotationTreatment rotation, bool energy);

/// Elastic loops for any processor.
ElementLoop selectElasticLoopBaseline(RotationTreatment rotation, bool energy);

/// Elastic loops compiled for processors with AVX2 and FMA; null elsewhere.
ElementLoop selectElasticLoopAvx2(RotationTreatment rotation, bool energy);

} // namespace yade::ddem
