// GPL v2 or later, see LICENSE.
#include <pkg/ddem/ServoPlaten.hpp>

#include <pkg/ddem/DeformableEngine.hpp>
#include <pkg/ddem/DeformableNode.hpp>

#include <sstream>

namespace yade {

DDEM_PLUGIN((ServoPlaten))

namespace {

	[[noreturn]] void refusePlaten(const std::string& what)
	{
		throw std::invalid_argument("ServoPlaten" + what);
	}

	std::string numberOf(Real value)
	{
		std::ostringstream text;
		text << value;
		return text.str();
	}

} // namespace

void ServoPlaten::postLoad(ServoPlaten&)
{
	const bool alongX = std::abs(direction[0]) == 1 && direction[1] == 0,
	           alongY = std::abs(direction[1]) == 1 && direction[0] == 0;
	if ((!alongX && !alongY) || direction[2] != 0)
		refusePlaten(
		        ".direction = (" + numberOf(direction[0]) + ", " + numberOf(direction[1]) + ", "
		        + numberOf(direction[2]) + ") must be (±1, 0, 0) or (0, ±1, 0)");
	if (!(velocity > 0 && std::isfinite(velocity)))
		refusePlaten(
		        ".velocity = " + numberOf(velocity)
		        + " m/s must be positive and finite; it is the largest speed");
	if (!(dashpot >= 0 && std::isfinite(dashpot)) || !(mass >= 0 && std::isfinite(mass)))
		refusePlaten(": dashpot = " + numberOf(dashpot) + " N·s/m and mass = " + numberOf(mass)
		       + " kg must be finite and not negative");
	if (!(failure >= 0 && failure < 1))
		refusePlaten(".failure = " + numberOf(failure) + " must be a share of the force, from 0 to below 1");
	for (const auto& kind : kinds)
		if (kind != "force" && kind != "displacement")
			refusePlaten(".kinds: '" + kind + "' is unknown; use 'force' or 'displacement'");
	for (const Real target : targets)
		if (!std::isfinite(target)) refusePlaten(".targets must be finite [N, m]");
	for (const Real duration : durations)
		if (!(duration > 0 && std::isfinite(duration)))
			refusePlaten(".durations: " + numberOf(duration) + " s must be positive and finite");
	changed = true;
}

void ServoPlaten::action()
{
	if (DeformableEngine::in(*scene).empty())
		throw std::runtime_error("ServoPlaten is moved by a DeformableEngine, and O.engines has none: add "
		                         "DeformableEngine()");
}

void ServoPlaten::lookUp(const Scene& of, Exposure& sample)
{
	rows.clear();
	if (kinds.size() != targets.size() || durations.size() != targets.size())
		refusePlaten(" has " + std::to_string(kinds.size()) + " kinds, " + std::to_string(targets.size())
		       + " targets and " + std::to_string(durations.size()) + " durations; each leg needs all three");
	if (ids.empty()) refusePlaten(".ids is empty: give the nodes that it moves (block.boundary('top'))");
	std::size_t outside = 0;
	for (const auto id : ids) {
		const auto row = sample.rowOfNode(id);
		if (row >= 0) rows.push_back(std::size_t(row));
		else if (!of.bodies->exists(id) || !dynamic_cast<const DeformableNode*>((*of.bodies)[id]->shape.get()))
			refusePlaten(".ids: body " + std::to_string(id) + " is no DeformableNode of this scene");
		else
			outside++;
	}
	if (outside > 0 && !rows.empty())
		refusePlaten(".ids names nodes that two DeformableEngine move; a platen needs nodes of one");
	std::sort(rows.begin(), rows.end());
	if (std::adjacent_find(rows.begin(), rows.end()) != rows.end()) refusePlaten(".ids names a node twice");
	for (const auto& engine : of.engines)
		if (const auto* drive = dynamic_cast<const KinematicEngine*>(engine.get()); drive && !drive->dead)
			for (const auto id : drive->ids)
				if (std::find(ids.begin(), ids.end(), id) != ids.end())
					refusePlaten(
					        ".ids: node " + std::to_string(id) + " is driven by "
					        + drive->getClassName() + " as well; leave one of them out");
	known   = sample.system;
	changed = false;
}

void ServoPlaten::nextLegs(Real time)
{
	if (std::isnan(legStart) || (idle && !done())) { // legs that are appended later begin then
		legStart  = time;
		legBegins = true;
	}
	while (!done() && time >= legStart + durations[std::size_t(leg)] * (1 - 1e-12)) {
		legStart += durations[std::size_t(leg)];
		leg++;
		legBegins = true;
	}
	idle = done();
}

bool ServoPlaten::prepare(const Scene& of, Exposure& sample, ddem::RigidPlaten& platen)
{
	if (changed || known.lock() != sample.system) lookUp(of, sample);
	if (rows.empty()) return false;
	ddem::Points& node = sample.system->motion.node;
	platen             = {};
	platen.axis        = direction[0] != 0 ? 0 : 1;
	platen.sign        = direction[Eigen::Index(platen.axis)];
	platen.nodes       = rows;
	platen.mass        = mass;
	platen.dashpot     = dashpot;
	platen.limit       = velocity;
	for (const std::size_t row : rows)
		if (node.inverseMass[2 * row + platen.axis] != 0)
			refusePlaten(
			        ": node " + placeOf(*sample.nodes[row])
			        + " is free along the platen's way; hold it: block.hold(ids, '"
			        + (platen.axis ? "y" : "x") + "')");
	nextLegs(of.time);
	if (targets.empty()) return false;
	const int  now  = std::min(leg, int(targets.size()) - 1);
	const Real last = targets[std::size_t(now)], length = durations[std::size_t(now)];
	// legs meet without a jolt
	const auto share = [&](Real time) {
		return done() ? 1
		              : 0.5 * (1 - std::cos(M_PI * std::clamp((time - legStart) / length, Real(0), Real(1))));
	};
	if (!failed && isForce(now)) {
		platen.begins = legBegins && !done();
		platen.from   = legFrom;
		platen.to     = last;
		platen.share  = share(of.time);
		return true;
	}
	// as prescribed: to the place of the step's end
	Real place = 0;
	for (const std::size_t row : rows)
		place += platen.sign
		        * (node.position[2 * row + platen.axis]
		           - sample.nodes[row]->state->refPos[Eigen::Index(platen.axis)])
		        / Real(rows.size());
	if (legBegins && !done()) {
		legFrom   = place;
		legBegins = false;
	}
	platen.driven = true;
	const Real next = failed ? place : done() ? last : legFrom + share(of.time + of.dt) * (last - legFrom);
	for (const std::size_t row : rows)
		node.velocity[2 * row + platen.axis] = platen.sign * (next - place) / of.dt;
	return true;
}

void ServoPlaten::finish(const Scene& of, const ddem::RigidPlaten& platen)
{
	force = platen.force;
	speed = platen.velocity;
	if (platen.driven) return;
	legFrom   = platen.from;
	legBegins = false;
	const Real asked = platen.from + platen.share * (platen.to - platen.from), sign = asked < 0 ? -1 : 1;
	// as long as its force grows, a platen only lags behind what is asked
	if (std::isnan(grewAt) || borne * sign < 0 || force * sign > borne * sign + 1e-3 * std::abs(asked)) {
		borne  = force;
		grewAt = of.time;
	}
	const Real length = durations[std::size_t(std::min(leg, int(durations.size()) - 1))];
	if (platen.limited && of.time > grewAt + 0.05 * length && force * sign < failure * asked * sign) failed = true;
}

} // namespace yade
