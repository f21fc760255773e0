// GPL v2 or later, see LICENSE.
#include <pkg/ddem/EdgeTraction.hpp>

#include <lib/smoothing/LinearInterpolate.hpp>

#include <sstream>

namespace yade {

DDEM_PLUGIN((EdgeTraction))

void EdgeTraction::postLoad(EdgeTraction&)
{
	// attributes are set one after the other, so sizes are compared in each step
	for (std::size_t i = 0; i < times.size(); i++)
		if (!std::isfinite(times[i]) || (i > 0 && times[i] <= times[i - 1])) {
			std::ostringstream text;
			text << "EdgeTraction.times: " << times[i] << " s at place " << i
			     << " must be finite and later than the time before";
			throw std::invalid_argument(text.str());
		}
	for (const Real value : factors)
		if (!std::isfinite(value))
			throw std::invalid_argument("EdgeTraction.factors must be finite numbers [-]");
	for (const Vector2r& one : tractions)
		if (!one.allFinite()) throw std::invalid_argument("EdgeTraction.tractions must be finite numbers [Pa]");
	for (const Vector2r& pair : profile)
		if (!pair.allFinite())
			throw std::invalid_argument("EdgeTraction.profile must be finite numbers [-], a pair per edge");
}

Real EdgeTraction::factor(Real time) const
{
	if (times.size() != factors.size())
		throw std::invalid_argument(
		        "EdgeTraction: " + std::to_string(times.size()) + " times and " + std::to_string(factors.size())
		        + " factors; the course needs a factor for each time");
	if (times.empty()) return 1;
	std::size_t place = 0;
	return linearInterpolate(time, times, factors, place);
}

Real EdgeTraction::presentFactor() const { return factor(Omega::instance().getScene()->time); }

void EdgeTraction::act(const OwnEdges& own, Real time, ddem::Motion& motion) const
{
	if (!profile.empty() && profile.size() != edges.size())
		throw std::invalid_argument(
		        "EdgeTraction.profile has " + std::to_string(profile.size()) + " pairs for "
		        + std::to_string(edges.size()) + " edges; give a pair of factors for each edge, or none");
	if (!tractions.empty() && tractions.size() != 2 * edges.size())
		throw std::invalid_argument(
		        "EdgeTraction.tractions has " + std::to_string(tractions.size()) + " entries for "
		        + std::to_string(edges.size()) + " edges; give two for each edge, or none");
	if (!std::isfinite(pressure) || !std::isfinite(shear) || !traction.allFinite()) {
		std::ostringstream text;
		text << "EdgeTraction: pressure = " << pressure << " Pa, shear = " << shear << " Pa, traction = ("
		     << traction[0] << ", " << traction[1] << ") Pa must be finite numbers";
		throw std::invalid_argument(text.str());
	}
	const Real             f = factor(time);
	const ddem::EdgeStress stress { f * pressure, f * shear, { f * traction[0], f * traction[1] } };
	for (const OuterEdge& edge : own.edges) {
		ddem::EdgeProfile share;
		if (!profile.empty()) {
			const Vector2r& given = profile[edge.given];
			share                 = { given[edge.turned ? 1 : 0], given[edge.turned ? 0 : 1] };
		}
		const auto   along  = follower ? edge.now(motion.node) : edge.reference;
		const double length = follower ? std::hypot(along.x, along.y) : edge.length;
		const auto   forces = ddem::edgeForces(stress, share, along, length, edge.thickness);
		auto &       start = motion.loads[edge.atStart].force, &end = motion.loads[edge.atEnd].force;
		start = start + forces.start;
		end   = end + forces.end;
		if (tractions.empty()) continue;
		const auto stressAt = [&](bool second) {
			const Vector2r& t = tractions[2 * edge.given + (second != edge.turned ? 1 : 0)];
			return ddem::EdgeStress { 0, 0, { f * t[0], f * t[1] } };
		};
		// linear: one falls from the start to nothing, the other grows to the end
		const auto first = ddem::edgeForces(stressAt(false), { share.start, 0 }, along, length, edge.thickness);
		const auto second = ddem::edgeForces(stressAt(true), { 0, share.end }, along, length, edge.thickness);
		start             = start + first.start + second.start;
		end               = end + first.end + second.end;
	}
}

} // namespace yade
