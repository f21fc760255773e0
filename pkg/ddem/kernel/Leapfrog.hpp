// GPL v2 or later, see LICENSE.
// Leapfrog motion of points and spins, with the effects a scene calls for picked at compile time.
#pragma once

#include <pkg/ddem/kernel/TriangleSystem.hpp>

namespace yade::ddem {

/// Effects of the motion; each combination is a function of its own, so that an effect that is off costs nothing.
namespace MotionEffects {
	enum : unsigned { External = 1, Gravity = 2, Damping = 4, Energy = 8, Combinations = 16 };
	inline unsigned select(const StepSettings& settings)
	{
		return (settings.external ? unsigned(External) : 0) | (settings.gravity.x != 0 || settings.gravity.y != 0 ? unsigned(Gravity) : 0)
		        | (settings.damping != 0 ? unsigned(Damping) : 0) | (settings.energy ? unsigned(Energy) : 0);
	}
}

/// Sums over a range of degrees of freedom; works are split into the half steps before and after the current positions.
struct MotionSums {
	double     speedSquared = 0; ///< not finite as soon as any velocity is not
	StepEnergy before, after;    ///< before holds the kinetic energy as well
};

/// Factor by which Cundall's local damping scales an acceleration, as in NewtonIntegrator (cundallDamp2nd).
inline double localDamping(double damping, double acceleration, double velocity, double dt)
{
	const double power = acceleration * (velocity + 0.5 * dt * acceleration);
	return power > 0 ? 1 - damping : (power < 0 ? 1 + damping : 1);
}

/// One degree of freedom: returns its new velocity and books its work. inverseMass 0 keeps the velocity.
template <unsigned effects>
inline double accelerate(double velocity, double force, double external, double gravity, double mass, double inverseMass, const StepSettings& settings, MotionSums& sums)
{
	using namespace MotionEffects;
	double total = force;
	if constexpr (effects & External) total += external;
	if constexpr (effects & Gravity) total += mass * gravity;
	double acceleration = total * inverseMass;
	double damp         = 0;
	if constexpr (effects & Damping) {
		const double scale = localDamping(settings.damping, acceleration, velocity, settings.dt);
		damp               = (scale - 1) * total;
		acceleration *= scale;
	}
	const double next = velocity + settings.dt * acceleration;
	if constexpr (effects & Energy) {
		const double half = inverseMass == 0 ? 0 : 0.5 * settings.dt; // a blocked degree of freedom belongs to the outside
		sums.before.kinetic += inverseMass == 0 ? 0 : 0.5 * mass * velocity * next;
		sums.before.externalWork += half * external * velocity;
		sums.after.externalWork += half * external * next;
		sums.before.gravityWork += half * mass * gravity * velocity;
		sums.after.gravityWork += half * mass * gravity * next;
		sums.before.dampingLoss -= half * damp * velocity;
		sums.after.dampingLoss -= half * damp * next;
	}
	return next;
}

template <unsigned effects> void movePoints(Points& points, std::size_t begin, std::size_t end, const StepSettings& settings, MotionSums& sums)
{
	const bool     external = (effects & MotionEffects::External) && !points.external.empty();
	const double   g[2]     = { settings.gravity.x, settings.gravity.y };
	double         speed    = 0;
	double*        position = points.position.data();
	double*        velocity = points.velocity.data();
	const double*  force    = points.force.data();
	const double*  inverse  = points.inverseMass.data();
	for (std::size_t p = begin; p < end; p++)
		for (std::size_t c = 0; c < 2; c++) {
			const std::size_t i    = 2 * p + c;
			const double      next = accelerate<effects>(velocity[i], force[i], external ? points.external[i] : 0., g[c], points.mass[p], inverse[i], settings, sums);
			velocity[i]            = next;
			position[i] += settings.dt * next;
			speed += next * next;
		}
	sums.speedSquared += speed;
}

template <unsigned effects> void moveSpins(Spins& spins, std::size_t begin, std::size_t end, const StepSettings& settings, MotionSums& sums)
{
	constexpr unsigned here     = effects & ~unsigned(MotionEffects::Gravity); // gravity has no moment about the mass centre
	const bool         external = (effects & MotionEffects::External) && !spins.external.empty();
	double             speed    = 0;
	for (std::size_t i = begin; i < end; i++) {
		const double next = accelerate<here>(
		        spins.velocity[i], spins.moment[i], external ? spins.external[i] : 0., 0., spins.inertia[i], spins.inverseInertia[i], settings, sums);
		spins.velocity[i] = next;
		spins.angle[i] += settings.dt * next;
		speed += next * next;
	}
	sums.speedSquared += speed;
}

} // namespace yade::ddem
