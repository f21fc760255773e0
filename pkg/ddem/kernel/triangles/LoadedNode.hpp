// GPL v2 or later, see LICENSE.
// Leapfrog motion of a node with a load and a damper.
#pragma once

#include <pkg/ddem/kernel/triangles/Leapfrog.hpp>
#include <pkg/ddem/kernel/triangles/NodeLoads.hpp>

namespace yade::ddem {

/** Moves one node as movePoints does, with a load's force and damper, and books their works apart.
 *
 * The damper sees the mean of the velocities before and after, so the two directions of the node are solved
 * together:
 *   (M/Δt + C/2)(v⁺ − v⁻) = S (F − C v⁻),
 * with S the factors of local damping. The bound on the time step is then that without dampers: the energy
 * ½ v⁺·(M − Δt²K/4)·v⁺ + ½ x̄·K·x̄, x̄ = (x + x⁺)/2, changes by −Δt v̄·C·v̄ ≤ 0 in a step of an elastic system, and
 * it is positive for Δt < 2/ω. (A damper that sees v⁻ alone would lower the bound to (√(1 + ξ²) − ξ) 2/ω.) */
template <unsigned effects>
void moveLoaded(
        Points& points, NodeLoad& load, const StepSettings& settings, const StepsAround& dt, MotionSums& sums)
{
	using namespace MotionEffects;
	const std::size_t first    = 2 * load.node;
	const double      mass     = points.mass[load.node];
	const bool        external = (effects & External) && !points.external.empty();
	double* const     velocity = &points.velocity[first];
	const double      own[2] = { load.force.x, load.force.y }, g[2] = { settings.gravity.x, settings.gravity.y };
	const PlaneVector<double> before { velocity[0], velocity[1] };
	const PlaneVector<double> drag   = load.damper * before;
	const double              slow[2] = { drag.x, drag.y }, diagonal[2] = { load.damper.xx, load.damper.yy };
	bool                      free[2];
	double                    total[2], damp[2], from[2], inertia[2];
	for (std::size_t c = 0; c < 2; c++) {
		const double inverse = points.inverseMass[first + c];
		free[c]              = inverse != 0;
		from[c]              = external ? points.external[first + c] : 0.;
		total[c]             = points.force[first + c] + from[c] + own[c] + mass * g[c] - slow[c];
		damp[c]              = 0;
		if constexpr (effects & Damping) {
			const double scale
			        = localDamping(settings.damping, total[c] * inverse, velocity[c], dt.between());
			damp[c] = (scale - 1) * total[c];
		}
		inertia[c] = mass / dt.between() + 0.5 * diagonal[c];
	}
	PlaneVector<double> gain { 0, 0 };
	const double        fx = total[0] + damp[0], fy = total[1] + damp[1], coupling = 0.5 * load.damper.xy;
	if (free[0] && free[1]) {
		const double determinant = inertia[0] * inertia[1] - coupling * coupling;
		gain = { (inertia[1] * fx - coupling * fy) / determinant,
			 (inertia[0] * fy - coupling * fx) / determinant };
	} else {
		if (free[0]) gain.x = fx / inertia[0];
		if (free[1]) gain.y = fy / inertia[1];
	}
	const PlaneVector<double> after = before + gain;
	load.resistance                 = -(load.damper * (0.5 * (before + after)));
	const double was[2] = { before.x, before.y }, now[2] = { after.x, after.y }, step[2] = { gain.x, gain.y },
	             resistance[2] = { load.resistance.x, load.resistance.y };
	double speedSquared        = 0;
	for (std::size_t c = 0; c < 2; c++) {
		velocity[c] = now[c];
		points.position[first + c] += dt.after * now[c];
		speedSquared += now[c] * now[c];
		if constexpr (effects & Energy) {
			if (!free[c]) continue; // belongs to the outside, see Motion::closeBook
			// as in accelerate()
			sums.before.kinetic += 0.5 * mass * was[c] * (was[c] + dt.before / dt.between() * step[c]);
			const auto book = [&](StepEnergy& half, double weight, double speed) {
				half.edgeWork += weight * own[c] * speed;
				half.edgeAbsorption -= weight * resistance[c] * speed;
				if constexpr (effects & External) half.externalWork += weight * from[c] * speed;
				if constexpr (effects & Gravity) half.gravityWork += weight * mass * g[c] * speed;
				if constexpr (effects & Damping) half.dampingLoss -= weight * damp[c] * speed;
			};
			book(sums.before, 0.5 * dt.before, was[c]);
			book(sums.after, 0.5 * dt.after, now[c]);
		}
	}
	sums.speedSquared += speedSquared;
}

} // namespace yade::ddem
