// GPL v2 or later, see LICENSE.
#include <pkg/ddem/kernel/triangles/SystemStableStep.hpp>

#include <algorithm>
#include <cmath>

namespace yade::ddem {

namespace {

	constexpr double smallGrowth = 0.02; ///< of the frequency: up to here its bound is as good as itself

	/// A triangle that may set the step, once its own frequency is known.
	struct Candidate {
		double      atLeast; ///< its step is not smaller [s]
		std::size_t triangle;
		double      stiffening; ///< √ of the factor on its moduli [-]
	};

	/// √ of the factor by which pressure raises the moduli of a triangle.
	double stiffening(const TriangleSystem& system, const TriangleGroup& g, std::size_t i)
	{
		if (g.law != TriangleGroup::Law::Concrete) return 1;
		const ConcreteGroupLaw& law = system.concrete[g.concrete];
		if (!(law.effects & ConcreteEffects::EquationOfState)) return 1;
		const ConcreteState* state    = &system.concreteState[TriangleSystem::stateIndex(g, i)];
		double               stiffest = 1;
		for (int k = 0; k < 3; k++)
			stiffest = std::max(stiffest, stiffnessFactor(law.parameters, state[k]));
		return std::sqrt(stiffest);
	}

	TriangleStiffness stiffnessOf(const TriangleGroup& g) { return { g.lambda + 2. / 3 * g.mu, g.mu, g.rotationModulus / g.mu }; }

	LumpedMass massOf(const TriangleSystem& system, double vertexShare, std::size_t i)
	{
		return { system.core.mass[i] * vertexShare / (3 * (1 - vertexShare)), system.core.mass[i], system.spin.size() ? system.spin.inertia[i] : 0 };
	}

} // namespace

SystemStableStep stableStep(const TriangleSystem& system, const std::vector<double>& restFrequency, double vertexShare, double enough)
{
	struct Growth {
		double frequency, stiffening;
	};
	std::vector<Growth> growth(system.triangles());
	for (const TriangleGroup& g : system.group) {
		const TriangleStiffness stiffness = stiffnessOf(g);
#pragma omp parallel for schedule(static)
		for (std::ptrdiff_t j = std::ptrdiff_t(g.begin); j < std::ptrdiff_t(g.end); j++) {
			const auto i        = std::size_t(j);
			growth[i].frequency = system.rotation == RotationTreatment::None
			        ? 0
			        : frequencyGrowth(
			                system.reference(i), stiffness, g.thickness, massOf(system, vertexShare, i), system.rotation, system.relativeDisplacements(i));
			growth[i].stiffening = stiffening(system, g, i);
		}
	}
	SystemStableStep       best;
	std::vector<Candidate> candidates;
	for (std::size_t i = 0; i < system.triangles(); i++) {
		const double step = 2 / (growth[i].stiffening * (restFrequency[i] + growth[i].frequency));
		if (!(step < std::min(best.step, enough))) continue;
		if (growth[i].frequency <= smallGrowth * restFrequency[i])
			best = { step, i };
		else
			candidates.push_back({ step, i, growth[i].stiffening });
	}
	std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) { return a.atLeast < b.atLeast; });
	for (const Candidate& c : candidates) {
		if (c.atLeast >= best.step) break;
		const TriangleGroup& g   = system.groupOf(c.triangle);
		const double         own = highestFrequency(
                        system.reference(c.triangle),
                        stiffnessOf(g),
                        g.thickness,
                        massOf(system, vertexShare, c.triangle),
                        system.rotation,
                        system.relativeDisplacements(c.triangle));
		const double step = 2 / (c.stiffening * own);
		if (step < best.step) best = { step, c.triangle };
	}
	return best;
}

} // namespace yade::ddem
