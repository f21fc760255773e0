// GPL v2 or later, see LICENSE.
// Moves bodies along an axis, with a speed that grows linearly to its full value.
#include <pkg/bonded/RampedTranslationEngine.hpp>

namespace yade {

DDEM_PLUGIN((RampedTranslationEngine))

void RampedTranslationEngine::postLoad(RampedTranslationEngine&)
{
	translationAxis.normalize();
	if (!(rampTime >= 0))
		throw std::invalid_argument(
		        "RampedTranslationEngine: rampTime = " + std::to_string(rampTime) + " s must not be negative");
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
		const auto newton = std::find_if(scene->engines.begin(), scene->engines.end(), [](const auto& e) {
			return bool(dynamic_cast<NewtonIntegrator*>(e.get()));
		});
		const int mask
		        = newton == scene->engines.end() ? 0 : static_cast<const NewtonIntegrator&>(**newton).mask;
		Real      force = 0;
		scene->forces.sync();
		for (const auto id : bodies)
			if (const auto& body = Body::byId(id, scene); body && (mask <= 0 || body->maskCompatible(mask)))
				force -= scene->forces.getForce(id).dot(translationAxis);
		// Work up to the present positions: between two steps leapfrog moves at one speed and sees
		// the mean of their forces.
		const Real done = 0.5 * (lastForce + force) * speed(scene->time - scene->dt) * scene->dt;
		lastForce       = force;
		work += done;
		scene->energy->add(-done, "externalWork", workIx, false);
	}
	for (const auto id : bodies)
		// else it was erased
		if (const auto& body = Body::byId(id, scene)) body->state->vel += now * translationAxis;
}

} // namespace yade
