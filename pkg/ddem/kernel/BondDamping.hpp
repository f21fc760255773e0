// GPL v2 or later, see LICENSE.
// Viscous damping of a body's motion, linear or angular.
#pragma once

namespace yade::ddem {

/** Damping force -γ m v̄ for leapfrog, where v̄ is the mean of the velocities before and after the step (ESyS-Particle's LinDamping and RotDamping, which take
 * the velocity after it). Exact in energy and stable for every dt: v' = v (1 - γ dt/2)/(1 + γ dt/2) without other forces.
 * \param velocity before the step [m/s or rad/s]
 * \param load all other forces or moments [N or N·m]
 * \param mass mass or moment of inertia [kg or kg·m²]
 * \param viscosity γ [1/s]
 * \return force or moment, one component of it
 */
inline double viscousLoad(double velocity, double load, double mass, double viscosity, double dt)
{
	return -viscosity * (mass * velocity + 0.5 * dt * load) / (1 + 0.5 * viscosity * dt);
}

} // namespace yade::ddem
