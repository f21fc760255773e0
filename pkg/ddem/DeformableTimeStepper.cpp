// GPL v2 or later, see LICENSE.
#include <pkg/ddem/DeformableTimeStepper.hpp>

#include <pkg/ddem/DeformableEngine.hpp>

namespace yade {

DDEM_PLUGIN((DeformableTimeStepper))
CREATE_LOGGER(DeformableTimeStepper);

namespace {

	// A leapfrog whose step alternates is unstable well below the bound on a constant step (parametric resonance), so the step changes seldom.
	constexpr Real worthRaising = 1.05; ///< a step that could grow by less stays as it is
	constexpr Real slack        = 0.1;  ///< part of the rest up to the critical step that is used up before the step is lowered: small strains change nothing

} // namespace

void DeformableTimeStepper::postLoad(DeformableTimeStepper&)
{
	if (!(safety > 0 && safety <= 1)) throw std::invalid_argument("DeformableTimeStepper.safety = " + std::to_string(safety) + " must lie above 0 and not above 1; 0.8 is a good choice");
	if (!(largest >= 0)) throw std::invalid_argument("DeformableTimeStepper.largest = " + std::to_string(largest) + " s must not be negative; 0 takes O.dt when the stepper first acts");
}

bool DeformableTimeStepper::isActivated()
{
	if (!active) return false;
	for (const auto& e : scene->engines)
		if (auto* engine = dynamic_cast<DeformableEngine*>(e.get()))
			if (engine->timeStepUnchecked(*scene)) return true; // triangles have come, or somebody has set O.dt
	return TimeStepper::isActivated();
}

void DeformableTimeStepper::computeTimeStep(Scene* now)
{
	if (largest == 0) largest = now->dt;
	const Real bound = DeformableEngine::ofCurrentScene().stableStep(*now, largest / safety), wanted = std::min(largest, safety * bound);
	if (now->dt > largest || now->dt > (safety + slack * (1 - safety)) * bound || wanted > worthRaising * now->dt) now->dt = wanted;
}

} // namespace yade
