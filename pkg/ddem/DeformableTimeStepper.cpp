// GPL v2 or later, see LICENSE.
#include <pkg/ddem/DeformableTimeStepper.hpp>

#include <pkg/ddem/DeformableEngine.hpp>

#include <limits>

namespace yade {

DDEM_PLUGIN((DeformableTimeStepper))
CREATE_LOGGER(DeformableTimeStepper);

namespace {

	// A leapfrog whose step alternates is unstable well below the bound on a constant step (parametric resonance),
	// so the step changes seldom.
	constexpr Real dtOfYade     = 1e-8; ///< O.dt of a new scene [s]
	constexpr Real worthRaising = 1.05; ///< a step that could grow by less stays as it is
	constexpr Real slack        = 0.1;  ///< part of the rest up to the critical step that is used up before the
	                                    ///< step is lowered: small strains change nothing

} // namespace

void DeformableTimeStepper::postLoad(DeformableTimeStepper&)
{
	if (!(safety > 0 && safety <= 1))
		throw std::invalid_argument(
		        "DeformableTimeStepper.safety = " + std::to_string(safety)
		        + " must lie above 0 and not above 1; 0.8 is a good choice");
	if (!(largest >= 0))
		throw std::invalid_argument(
		        "DeformableTimeStepper.largest = " + std::to_string(largest)
		        + " s must not be negative; 0 takes O.dt when the stepper first acts");
}

bool DeformableTimeStepper::isActivated()
{
	if (!active) return false;
	for (const auto& e : scene->engines)
		if (auto* engine = dynamic_cast<DeformableEngine*>(e.get()))
			// triangles have come, or somebody has set O.dt
			if (engine->timeStepUnchecked(*scene)) return true;
	return TimeStepper::isActivated();
}

void DeformableTimeStepper::computeTimeStep(Scene* now)
{
	// O.dt as YADE starts with it is no choice of anybody's
	if (largest == 0) largest = now->dt == dtOfYade ? std::numeric_limits<Real>::infinity() : now->dt;
	Real bound = std::numeric_limits<Real>::infinity();
	const auto engines = DeformableEngine::in(*now);
	if (engines.empty())
		throw std::runtime_error(
		        "O.engines has no DeformableEngine, whose triangles DeformableTimeStepper looks at: "
		        "add DeformableEngine() after the engines that add forces");
	for (DeformableEngine* engine : engines)
		bound = std::min(bound, engine->stableStep(*now, largest / safety));
	const Real wanted = std::min(largest, safety * bound);
	if (!(now->dt > 0 && now->dt <= largest) || now->dt > (safety + slack * (1 - safety)) * bound
	    || wanted > worthRaising * now->dt)
		now->dt = wanted;
}

} // namespace yade
