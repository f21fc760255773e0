// GPL v2 or later, see LICENSE.
// State of a sub-element of concrete, and the effects that a step may simulate.
#pragma once

#include <pkg/ddem/kernel/algebra/PlaneTensor.hpp>

namespace yade::ddem {

/// State of one sub-element: plain numbers only, all zero at the start (`damage` may start at Ω_0, pre-existing
/// defects). The energies are filled only where ConcreteEffects::Energy is on.
template <class Number> struct ConcreteStateOf {
	PlaneTensorOf<Number> stress;             ///< σ [Pa], tension positive
	PlaneTensorOf<Number> strain;             ///< ε when the law was last evaluated [-]
	PlaneTensorOf<Number> lastStrain; ///< ε of the last step, which may have been held [-]; for the book of flow
	PlaneTensorOf<Number> plasticStrain;      ///< ε_p [-]
	PlaneTensorOf<Number> damage;             ///< Ω [-], positive semi-definite
	Number                stiffening;         ///< B/B_0 − 1 of the equation of state [-], ≥ 0
	Number                closure;            ///< How closed its crack was in the last step [-],
	                                          ///< 0 (open) to 1 (closed)
	Number                plasticDissipation; ///< Work of the stress on flow [J/m³]
	Number                damageDissipation;  ///< Elastic energy released by damage and by cracks
	                                          ///< that close or open [J/m³]
	Number                stiffeningEnergy;   ///< Stored energy beyond ½σ:ε_e, from the equation of state [J/m³];
	                                          ///< below zero under pressure
};

using ConcreteState = ConcreteStateOf<double>;

/// Effects that a scene may leave out: E(switch of the material, its bit, doc string).
#define CONCRETE_EFFECTS(E) \
	E(viscoplasticFlow, ConcreteEffects::Flow, \
	  "Simulate viscoplastic flow (eqs. 5-7); off: elastic, and damage cannot grow.") \
	E(rateDependence, ConcreteEffects::Rate, \
	  "Let the flow depend on the strain rate (eq. 7); off: as if :math:`\\omega_p` = 1.") \
	E(damage, ConcreteEffects::Damage, "Simulate damage: growth (eq. 8), loss of strength and of stiffness.") \
	E(equationOfState, ConcreteEffects::EquationOfState, "Let the moduli grow with pressure.")

/// Effects that a group of elements simulates, a bit mask. One that is off costs nothing.
namespace ConcreteEffects {
	enum : unsigned {
		Energy          = 1,  ///< LawEffects::Energy: book of stored and dissipated energy
		Flow            = 2,  ///< Viscoplastic flow; off: no principal stresses, no damage growth
		Rate            = 4,  ///< Rate dependence of the flow; off: ω_p = 1
		Damage          = 8,  ///< Damage: growth (with Flow), strength loss, elastic degradation; off: Δ = 1
		EquationOfState = 16, ///< Moduli that grow with pressure; off: constant
		All             = 31
	};
}

/// Stored energy [J/m³] of a step in which the law was evaluated: ½σ:ε_e + stiffeningEnergy.
template <class Number> inline Number storedEnergy(const ConcreteStateOf<Number>& state)
{
	return 0.5 * doubleDot(state.stress, state.strain - state.plasticStrain) + state.stiffeningEnergy;
}

} // namespace yade::ddem
