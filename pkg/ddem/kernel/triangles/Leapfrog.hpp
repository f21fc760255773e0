// GPL v2 or later, see LICENSE.
// Leapfrog motion of points and spins, with the effects a scene calls for picked at compile time.
#pragma once

#include <pkg/ddem/kernel/algebra/LocalDamping.hpp>
#include <pkg/ddem/kernel/triangles/Motion.hpp>

namespace yade::ddem {

/// Effects of the motion; each combination is a function of its own, so that an effect that is off costs nothing.
namespace MotionEffects {
	enum : unsigned { External = 1, Gravity = 2, Damping = 4, Energy = 8, Combinations = 16 };
	inline unsigned select(const StepSettings& settings)
	{
		return (settings.external ? unsigned(External) : 0)
		        | (settings.gravity.x != 0 || settings.gravity.y != 0 ? unsigned(Gravity) : 0)
		        | (settings.damping != 0 ? unsigned(Damping) : 0) | (settings.energy ? unsigned(Energy) : 0);
	}
}

/// One degree of freedom: returns its new velocity and books its work. inverseMass 0 keeps the velocity.
template <unsigned effects>
inline double accelerate(
        double velocity, double force, double external, double gravity, double mass, double inverseMass,
        const StepsAround& dt, double damping, MotionSums& sums)
{
	using namespace MotionEffects;
	double total = force;
	if constexpr (effects & External) total += external;
	if constexpr (effects & Gravity) total += mass * gravity;
	double                  acceleration = total * inverseMass;
	[[maybe_unused]] double damp         = 0;
	if constexpr (effects & Damping) {
		const double scale = localDamping(damping, acceleration, velocity, dt.between());
		damp               = (scale - 1) * total;
		acceleration *= scale;
	}
	const double next = velocity + dt.between() * acceleration;
	if constexpr (effects & Energy) {
		const bool                    blocked = inverseMass == 0; // belongs to the outside
		[[maybe_unused]] const double before = blocked ? 0 : 0.5 * dt.before,
		                              after = blocked ? 0 : 0.5 * dt.after;
		// as if the step had not changed
		sums.before.kinetic += blocked ? 0 : 0.5 * mass * velocity * (velocity + dt.before * acceleration);
		if constexpr (effects & External) {
			sums.before.externalWork += before * external * velocity;
			sums.after.externalWork += after * external * next;
		}
		if constexpr (effects & Gravity) {
			sums.before.gravityWork += before * mass * gravity * velocity;
			sums.after.gravityWork += after * mass * gravity * next;
		}
		if constexpr (effects & Damping) {
			sums.before.dampingLoss -= before * damp * velocity;
			sums.after.dampingLoss -= after * damp * next;
		}
	}
	return next;
}

/// Sum of squares, in four strands so that it does not wait for one addition after the other.
inline double sumOfSquares(const double* values, std::size_t n)
{
	double      strand[4] = { 0, 0, 0, 0 };
	std::size_t i         = 0;
	for (; i + 4 <= n; i += 4)
		for (std::size_t k = 0; k < 4; k++)
			strand[k] += values[i + k] * values[i + k];
	for (; i < n; i++)
		strand[0] += values[i] * values[i];
	return (strand[0] + strand[1]) + (strand[2] + strand[3]);
}

// Sums are kept in a local variable during a loop: no array can alias it, so it stays in registers.

template <unsigned effects>
void movePoints(
        Points& points, std::size_t begin, std::size_t end, const StepSettings& settings, const StepsAround& steps,
        MotionSums& sums)
{
	const bool         external      = (effects & MotionEffects::External) && !points.external.empty();
	const StepsAround  dt            = steps;
	const double       damping       = settings.damping;
	const double       g[2]          = { settings.gravity.x, settings.gravity.y };
	double* __restrict position      = points.position.data();
	double* __restrict velocity      = points.velocity.data();
	const double* __restrict force   = points.force.data();
	const double* __restrict inverse = points.inverseMass.data();
	const double* __restrict mass    = points.mass.data();
	MotionSums local;
	for (std::size_t p = begin; p < end; p++)
		for (std::size_t c = 0; c < 2; c++) {
			const std::size_t i = 2 * p + c;
			const double next = accelerate<effects>(
			        velocity[i], force[i], external ? points.external[i] : 0., g[c], mass[p], inverse[i],
			        dt, damping, local);
			velocity[i] = next;
			position[i] += dt.after * next;
		}
	local.speedSquared = sumOfSquares(velocity + 2 * begin, 2 * (end - begin));
	sums += local;
}

template <unsigned effects>
void moveSpins(
        Spins& spins, std::size_t begin, std::size_t end, const StepSettings& settings, const StepsAround& steps,
        MotionSums& sums)
{
	// gravity has no moment about the mass centre
	constexpr unsigned here          = effects & ~unsigned(MotionEffects::Gravity);
	const bool         external      = (effects & MotionEffects::External) && !spins.external.empty();
	const StepsAround  dt            = steps;
	const double       damping       = settings.damping;
	double* __restrict angle         = spins.angle.data();
	double* __restrict velocity      = spins.velocity.data();
	const double* __restrict moment  = spins.moment.data();
	const double* __restrict inverse = spins.inverseInertia.data();
	const double* __restrict inertia = spins.inertia.data();
	MotionSums local;
	for (std::size_t i = begin; i < end; i++) {
		const double next = accelerate<here>(
		        velocity[i], moment[i], external ? spins.external[i] : 0., 0., inertia[i], inverse[i], dt,
		        damping, local);
		velocity[i]       = next;
		angle[i] += dt.after * next;
	}
	local.speedSquared = sumOfSquares(velocity + begin, end - begin);
	sums += local;
}

} // namespace yade::ddem
