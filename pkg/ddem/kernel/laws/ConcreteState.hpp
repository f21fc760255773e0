// GPL v2 or later, see LICENSE.
// State of a sub-element of concrete, and the effects that a step may simulate.
#pragma once

#include <pkg/ddem/kernel/algebra/PlaneTensor.hpp>

namespace yade::ddem {

/// State of one sub-element: plain numbers only, all zero at the start (`damage` may start at Ω_0, pre-existing defects).
/// The energies are filled only where ConcreteEffects::Energy is on.
template <class Number> struct ConcreteStateOf {
	PlaneTensorOf<Number> stress;             ///< σ [Pa], tension positive
	PlaneTensorOf<Number> strain;             ///< ε [-]
	PlaneTensorOf<Number> plasticStrain;      ///< ε_p [-]
	PlaneTensorOf<Number> damage;             ///< Ω [-], positive semi-definite
	Number                stiffening;         ///< B/B_0 − 1 of the equation of state [-], ≥ 0
	Number                closure;            ///< How closed its crack was in the last step [-], 0 (open) to 1 (closed)
	Number                plasticDissipation; ///< Work of the stress on flow [J/m³]
	Number                damageDissipation;  ///< Elastic energy released by damage and by cracks that close or open [J/m³]
	Number                stiffeningEnergy;   ///< Stored energy beyond ½σ:ε_e, from the equation of state [J/m³]; below zero under pressure
};

using ConcreteState = ConcreteStateOf<double>;

/// Effects that a group of elements simulates, a bit mask. One that is off costs nothing.
namespace ConcreteEffects {
	enum : unsigned {
		Flow            = 1,  ///< Viscoplastic flow; off: no principal stresses, no damage growth
		Rate            = 2,  ///< Rate dependence of the flow; off: ω_p = 1
		Damage          = 4,  ///< Damage: growth (with Flow), strength loss, elastic degradation; off: Δ = 1
		EquationOfState = 8,  ///< Moduli that grow with pressure; off: constant
		Energy          = 16, ///< Book of stored and dissipated energy
		All             = 31
	};
}

/// Stored energy [J/m³]: ½σ:ε_e + stiffeningEnergy.
inline double storedEnergy(const ConcreteState& state) { return 0.5 * doubleDot(state.stress, state.strain - state.plasticStrain) + state.stiffeningEnergy; }

} // namespace yade::ddem
