// GPL v2 or later, see LICENSE.
// Moves bodies along an axis, with a speed that grows linearly to its full value.
#include <pkg/bonded/RampedTranslationEngine.hpp>

namespace yade {

DDEM_PLUGIN((RampedTranslationEngine))

void RampedTranslationEngine::postLoad(RampedTranslationEngine&)
{
	translationAxis.normalize();
	if (!(rampTime >= 0)) throw std::invalid_argument("RampedTranslationEngine: rampTime = " + std::to_string(rampTime) + " s must not be negative");
}

Real RampedTranslationEngine::speed(Real time) const
{
	const Real since = time - startTime + (ahead ? Omega::instance().getScene()->dt : 0);
	if (!(since >= 0)) return 0;
	return since < rampTime ? velocity * since / rampTime : velocity;
}

Real RampedTranslationEngine::currentSpeed() const { return speed(Omega::instance().getScene()->time); }

void RampedTranslationEngine::apply(const vector<Body::id_t>& bodies)
{
	if (math::isnan(startTime)) startTime = scene->time;
	const Real now = speed(scene->time);
	if (scene->trackEnergy) {
		// Mean of the speeds before and after this step: with forces at the step itself this is the work that leapfrog sees.
		const Real mean   = 0.5 * (speed(scene->time - scene->dt) + now);
		const auto newton = std::find_if(
		        scene->engines.begin(), scene->engines.end(), [](const auto& e) { return bool(dynamic_cast<NewtonIntegrator*>(e.get())); });
		const int mask  = newton == scene->engines.end() ? 0 : static_cast<const NewtonIntegrator&>(**newton).mask;
		Real      power = 0;
		scene->forces.sync();
		for (const auto id : bodies)
			if (mask <= 0 || Body::byId(id, scene)->maskCompatible(mask)) power -= scene->forces.getForce(id).dot(translationAxis) * mean;
		work += power * scene->dt;
		scene->energy->add(-power * scene->dt, "externalWork", workIx, false);
	}
	for (const auto id : bodies)
		Body::byId(id, scene)->state->vel += now * translationAxis;
}

} // namespace yade
