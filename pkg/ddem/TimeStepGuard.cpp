// GPL v2 or later, see LICENSE.
#include <pkg/ddem/TimeStepGuard.hpp>

#include <pkg/ddem/DeformableTimeStepper.hpp>

#include <sstream>

namespace yade {

namespace {

	// Steps between looks: against shape, and against pressure, which may rise faster.
	constexpr long shapeInterval = 50, pressureInterval = 10;

	// A leapfrog whose step goes up and down is unstable well below the bound on a constant one (parametric
	// resonance of vibrations whose period is about that of the change).
	// A stepper that follows the bound turns now and then; this is more.
	constexpr int  mostTurns   = 6;
	constexpr long turnsWithin = 24; ///< steps

} // namespace

void TimeStepGuard::restart(bool stiffens)
{
	stable   = 0;
	interval = stiffens ? pressureInterval : shapeInterval;
}

void TimeStepGuard::checkAlternation(const Scene& scene)
{
	const Real change = scene.dt - last;
	const bool known  = last > 0;
	last              = scene.dt;
	if (!known || change == 0) return;
	const Real sign = change > 0 ? 1 : -1;
	if (sign * direction < 0) {
		if (turns == 0 || scene.iter - firstTurn > turnsWithin) {
			turns     = 0;
			firstTurn = scene.iter;
		}
		turns++;
	}
	direction = sign;
	if (turns < mostTurns) return;
	std::ostringstream text;
	text << "O.dt has gone up and down " << turns << " times since step " << firstTurn << " and is " << scene.dt
	     << " s in step " << scene.iter
	     << ": steps that alternate excite vibrations well below the critical step; keep O.dt constant for "
	        "a while, or let DeformableTimeStepper() in O.engines choose it";
	turns = 0;
	throw std::runtime_error(text.str());
}

std::string TimeStepGuard::check(
        const Scene& scene, const Exposure& sample, const DeformableTimeStepper* stepper, const Engine* other,
        bool stopAtInverted)
{
	std::string warning;
	if (scene.dt == stable && scene.iter % interval != 0) return warning;
	if (!(scene.dt > 0 && std::isfinite(scene.dt))) {
		std::ostringstream text;
		text << "O.dt = " << scene.dt << " s must be positive and finite: set O.dt = ddem.time_step(0.8)";
		throw std::runtime_error(text.str());
	}
	if (!stepper) checkAlternation(scene);
	const auto inverted = sample.system->mostInverted();
	if (inverted.ratio <= 0 && (stopAtInverted || !warned)) {
		std::ostringstream text;
		text << "triangle " << placeOf(*sample.cores[inverted.triangle]) << " is inside out in step "
		     << scene.iter << ", t = " << scene.time << " s: its area is " << inverted.ratio
		     << " of what it was; the load is more than this mesh can follow: load it slower, remesh that "
		        "place, or end the run before (DeformableEngine.inverted = 'warn' lets it go on)";
		if (stopAtInverted) throw std::runtime_error(text.str());
		warning = text.str();
		warned  = true;
	}
	const auto [step, triangle] = sample.timeStep(scene.dt);
	if (scene.dt <= step) {
		stable = scene.dt;
		return warning;
	}
	stable = 0; // a second try is checked, too
	std::ostringstream text;
	text << "O.dt = " << scene.dt << " s is above the critical time step " << step << " s, set by triangle "
	     << placeOf(*sample.cores[triangle]) << " in step " << scene.iter << "; the simulation would blow up: ";
	if (other)
		text << other->getClassName()
		     << " sets O.dt and does not know deformable triangles: put DeformableTimeStepper() in its place, "
		        "with largest = the step that the other bodies need";
	else if (stepper)
		text << "set O.dt = 0.8*engine.criticalTimeStep(), or remesh that place; DeformableTimeStepper looks "
		        "every "
		     << stepper->timeStepUpdateInterval << " steps: let it look more often";
	else
		text << "set O.dt = 0.8*engine.criticalTimeStep(), or remesh that place; where triangles stretch or "
		        "pressure rises, let DeformableTimeStepper() in O.engines lower it";
	throw std::runtime_error(text.str());
}

} // namespace yade
