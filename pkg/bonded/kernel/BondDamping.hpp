// GPL v2 or later, see LICENSE.
// Viscous damping of a body's motion, linear or angular.
#pragma once

namespace yade::ddem {

/** Damping force -γ m v̄ for leapfrog, where v̄ is the mean of the velocities before and after the step
 * (ESyS-Particle's LinDamping and RotDamping take the velocity after it). Exact in energy and stable for every dt:
 * v' = v (1 - γ dt/2)/(1 + γ dt/2) without other forces.
 */
class ViscousDamper {
public:
	/// \param viscosity γ [1/s]
	ViscousDamper(double viscosity, double dt)
	        : rate(viscosity / (1 + 0.5 * viscosity * dt))
	        , step(dt)
	{
	}

	/** One component of the damping force or moment.
	 * \param velocity before the step [m/s or rad/s]
	 * \param otherLoad all other forces or moments [N or N·m]
	 * \param mass mass or moment of inertia [kg or kg·m²]
	 */
	double load(double velocity, double otherLoad, double mass) const
	{
		return -rate * (mass * velocity + 0.5 * step * otherLoad);
	}

	/// Energy that this component takes away in the step [J].
	double loss(double velocity, double otherLoad, double mass) const
	{
		const double drag = load(velocity, otherLoad, mass);
		return -drag * step * (velocity + 0.5 * step * (otherLoad + drag) / mass);
	}

private:
	double rate, step;
};

} // namespace yade::ddem
