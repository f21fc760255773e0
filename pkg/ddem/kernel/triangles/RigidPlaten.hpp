// GPL v2 or later, see LICENSE.
// Nodes that a rigid platen moves as one along an axis, under a force.
#pragma once

#include <pkg/ddem/kernel/triangles/Motion.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace yade::ddem {

/** A rigid platen in force control: M v' = F − P − c v along its way, with the force P of the sample.
 *
 * Its nodes are blocked along the axis and have one velocity. The mass M is theirs and its own. Constraints and mass
 * never raise the highest frequency of a system (Rayleigh's quotient over fewer displacements, or over more mass),
 * and the dashpot sees the mean of the velocities before and after, as in LoadedNode.hpp: so the bound on the time
 * step is that without a platen, and there is no gain to be tuned. A velocity above the limit is cut off. */
struct RigidPlaten {
	std::size_t              axis = 0; ///< 0: x, 1: y
	double                   sign = 1; ///< of its way along the axis
	std::vector<std::size_t> nodes;    ///< in ascending order
	double                   mass     = 0; ///< of its own [kg]
	double                   dashpot  = 0; ///< c [N·s/m]
	double                   limit    = 0; ///< of |v| [m/s]
	bool                     driven   = false; ///< by velocity: it goes on as its nodes do
	bool                     begins   = false; ///< from the force that it finds
	double from = 0, to = 0, share = 1; ///< F = from + share (to − from) [N]; `from` is found where it begins

	double force    = 0; ///< P of the last step [N], of the sample on the platen against its way
	double velocity = 0; ///< after the last step [m/s]
	bool   limited  = false;

	/// Force of the sample against its way [N]: of triangles, loads and other forces on its nodes, at the positions
	/// of the last step, and their mass [kg].
	void look(const Motion& motion, const StepSettings& settings, double& resistance, double& inertia) const
	{
		const Points& node = motion.node;
		const double  g    = axis == 0 ? settings.gravity.x : settings.gravity.y;
		double        sum  = 0;
		inertia            = mass;
		for (const std::size_t v : nodes) {
			const std::size_t i = 2 * v + axis;
			sum += node.force[i] + node.mass[v] * g;
			if (settings.external && !node.external.empty()) sum += node.external[i];
			inertia += node.mass[v];
			const std::size_t place = motion.loads.place(v);
			if (place == motion.loads.size()) continue;
			const NodeLoad& load = *(motion.loads.begin() + std::ptrdiff_t(place));
			if (load.node != v) continue;
			const PlaneVector<double> felt = load.force + load.resistance;
			sum += axis == 0 ? felt.x : felt.y;
		}
		resistance = -sign * sum;
	}

	/// To be called when all others have moved in a step, its nodes with the velocity that they had.
	void move(Motion& motion, const StepSettings& settings, const StepsAround& steps)
	{
		double inertia = 0;
		look(motion, settings, force, inertia);
		const double before = sign * motion.node.velocity[2 * nodes.front() + axis];
		velocity            = before;
		limited             = false;
		if (driven) return;
		if (begins) from = force + dashpot * before;
		begins               = false;
		const double applied = from + share * (to - from), rate = inertia / steps.between();
		const double wanted
		        = ((rate - 0.5 * dashpot) * before + applied - force) / (rate + 0.5 * dashpot);
		velocity = std::clamp(wanted, -limit, limit);
		limited  = velocity != wanted;
		for (const std::size_t v : nodes) {
			const std::size_t i = 2 * v + axis;
			motion.node.position[i] += steps.after * (sign * velocity - motion.node.velocity[i]);
			motion.node.velocity[i] = sign * velocity;
		}
	}
};

} // namespace yade::ddem
