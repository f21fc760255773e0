// GPL v2 or later, see LICENSE.
// Moves walls by a table of forces and displacements.
#include <pkg/bonded/ServoWall.hpp>

#include <algorithm>
#include <sstream>

namespace yade {

DDEM_PLUGIN((ServoWall))

void ServoWall::postLoad(ServoWall&)
{
	const auto refuse = [](const std::string& what, Real value, const std::string& complaint) {
		std::ostringstream text;
		text << "ServoWall: " << what << " = " << value << " " << complaint;
		throw std::invalid_argument(text.str());
	};
	if (!(direction.norm() > 0) || !direction.allFinite())
		refuse("length of direction", direction.norm(), "[-] must be positive and finite");
	direction.normalize();
	for (const auto& [name, value, unit] :
	     { std::make_tuple("velocity", velocity, "m/s"), std::make_tuple("mass", mass, "kg") })
		if (!(value > 0 && std::isfinite(value)))
			refuse(name, value, unit + std::string(" must be positive and finite"));
	if (!(dashpot >= 0 && std::isfinite(dashpot))) refuse("dashpot", dashpot, "N·s/m must not be negative");
	if (!(failure >= 0 && failure < 1))
		refuse("failure", failure, "[-] must be a share of the force, from 0 to below 1");
	for (const auto& kind : kinds)
		if (kind != "force" && kind != "displacement")
			throw std::invalid_argument(
			        "ServoWall: kind '" + kind + "' is unknown; use 'force' or 'displacement'");
	for (const Real target : targets)
		if (!std::isfinite(target)) refuse("target", target, "[N, m] must be finite");
	for (const Real duration : durations)
		if (!(duration > 0 && std::isfinite(duration)))
			refuse("duration", duration, "s must be positive and finite");
}

Real ServoWall::share(Real time) const
{
	if (done()) return 1;
	const Real part = (time - legStart) / durations[size_t(leg)];
	return 0.5 * (1 - math::cos(Mathr::PI * std::clamp(part, Real(0), Real(1))));
}

Real ServoWall::forceWanted(Real found)
{
	if (legBegins && !done()) legFrom = found + dashpot * speed;
	return legFrom + share(scene->time) * (targets[size_t(std::min(leg, int(targets.size()) - 1))] - legFrom);
}

/// Of a rigid mass under the force and its dashpot, which sees the mean of the velocities before and after: stable
/// whatever they are.
Real ServoWall::speedWanted(Real wanted) const
{
	const Real rate = mass / scene->dt;
	return ((rate - 0.5 * dashpot) * speed + wanted - force) / (rate + 0.5 * dashpot);
}

/// Which leg it is. Time counts while the engine acts and the sample has not failed.
void ServoWall::keepTime()
{
	if (math::isnan(legStart) || (idle && !done())) {
		legStart  = scene->time;
		legBegins = true;
	} else if (lastIter >= 0 && scene->iter != lastIter + 1)
		legStart += scene->time - lastTime - scene->dt;
	if (failed) legStart += scene->dt;
	lastIter = scene->iter;
	lastTime = scene->time;
	while (!done() && scene->time >= legStart + durations[size_t(leg)] * (1 - 1e-12)) {
		legStart += durations[size_t(leg)];
		leg++;
		legBegins = true;
	}
	idle = done();
}

Real ServoWall::place(const Scene& of) const
{
	Real sum = 0, count = 0;
	for (const auto id : ids)
		if (of.bodies->exists(id)) {
			const State& state = *(*of.bodies)[id]->state;
			sum += (state.pos - state.refPos).dot(direction);
			count++;
		}
	return count > 0 ? sum / count : 0;
}

/// Before the interactions it would see no forces, and push for ever.
void ServoWall::requireOrder() const
{
	for (auto engine = scene->engines.rbegin(); engine != scene->engines.rend() && engine->get() != this; ++engine)
		if (dynamic_cast<const InteractionLoop*>(engine->get()))
			throw std::runtime_error(
			        "wrong order in O.engines: ServoWall comes before InteractionLoop and would miss its "
			        "forces; put it after, before NewtonIntegrator");
}

void ServoWall::apply(const vector<Body::id_t>& bodies)
{
	if (kinds.size() != targets.size() || durations.size() != targets.size() || targets.empty())
		throw std::invalid_argument(
		        "ServoWall has " + std::to_string(kinds.size()) + " kinds, " + std::to_string(targets.size())
		        + " targets and " + std::to_string(durations.size())
		        + " durations; each leg needs all three, and there must be one");
	requireOrder();
	const Real before = force;
	force             = 0;
	scene->forces.sync();
	for (const auto id : bodies)
		if (Body::byId(id, scene)) force -= scene->forces.getForce(id).dot(direction);
	if (scene->trackEnergy) { // between two steps leapfrog moves at one speed and sees the mean of their forces
		const Real worked = 0.5 * (before + force) * speed * scene->dt;
		work += worked;
		scene->energy->add(-worked, "externalWork", workIx, false);
	}

	keepTime();
	if (failed) speed = 0;
	else if (isForce()) {
		const Real wanted = forceWanted(force), free = speedWanted(wanted), sign = wanted < 0 ? -1 : 1;
		speed  = std::clamp(free, -velocity, velocity);
		if (borne * sign < 0) borne = 0;
		// the largest of this sense: a wall that has not met the sample yet runs, too
		if (force * sign > borne * sign) borne = force;
		failed = speed != free && force * sign < failure * math::min(wanted * sign, borne * sign);
	} else {
		const Real now = place(*scene);
		if (legBegins && !done()) legFrom = now;
		const Real target = targets[size_t(std::min(leg, int(targets.size()) - 1))];
		speed             = (legFrom + share(scene->time + scene->dt) * (target - legFrom) - now) / scene->dt;
	}
	legBegins = legBegins && done();
	for (const auto id : bodies)
		if (const auto& body = Body::byId(id, scene)) body->state->vel += speed * direction;
}

} // namespace yade
