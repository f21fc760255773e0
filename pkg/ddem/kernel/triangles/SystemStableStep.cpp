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

	LumpedMass massOf(const TriangleSystem& system, double vertexShare, std::size_t i)
	{
		return { system.motion.core.mass[i] * vertexShare / (3 * (1 - vertexShare)), system.motion.core.mass[i],
			 system.motion.spin.size() ? system.motion.spin.inertia[i] : 0 };
	}

} // namespace

SystemStableStep
stableStep(const TriangleSystem& system, const std::vector<double>& restFrequency, double vertexShare, double enough)
{
	struct Growth {
		double frequency, stiffening;
	};
	std::vector<Growth> growth(system.triangles());
	for (const GroupPointer& pointer : system.group) {
		const LawGroup&         g         = *pointer;
		const TriangleStiffness stiffness = g.stiffness();
#pragma omp parallel for schedule(static)
		for (std::ptrdiff_t j = std::ptrdiff_t(g.begin); j < std::ptrdiff_t(g.end); j++) {
			const auto i        = std::size_t(j);
			growth[i].frequency = system.rotation == RotationTreatment::None
			        ? 0
			        : frequencyGrowth(
			                system.topology.reference(i), stiffness, g.constants.thickness,
			                massOf(system, vertexShare, i), system.rotation,
			                system.relativeDisplacements(i));
			growth[i].stiffening = std::sqrt(g.stiffening(i - g.begin));
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
	std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
		return a.atLeast < b.atLeast;
	});
	for (const Candidate& c : candidates) {
		if (c.atLeast >= best.step) break;
		const LawGroup& g   = system.groupOf(c.triangle);
		const double         own = highestFrequency(
                        system.topology.reference(c.triangle),
                        g.stiffness(),
                        g.constants.thickness,
                        massOf(system, vertexShare, c.triangle),
                        system.rotation,
                        system.relativeDisplacements(c.triangle));
		const double step = 2 / (c.stiffening * own);
		if (step < best.step) best = { step, c.triangle };
	}
	return best;
}

} // namespace yade::ddem
