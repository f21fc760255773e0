// GPL v2 or later, see LICENSE.
// The concrete damage model of Zubelewicz (2018): state of a sub-element and one explicit step of it.
#pragma once

#include <pkg/ddem/kernel/ConcreteParameters.hpp>
#include <pkg/ddem/kernel/PlaneTensor.hpp>

namespace yade {
namespace ddem {

	/*! State of one sub-element: plain doubles only, all zero at the start (`damage` may start at Ω_0, pre-existing defects).
	The energies are filled only where ConcreteEffects::Energy is on. */
	struct ConcreteState {
		PlaneTensor stress;             //!< σ [Pa], tension positive
		PlaneTensor strain;             //!< ε [-]
		PlaneTensor plasticStrain;      //!< ε_p [-]
		PlaneTensor damage;             //!< Ω [-], positive semi-definite
		double      plasticDissipation; //!< Work of the stress on plastic strain [J/m³]
		double      damageDissipation;  //!< Elastic energy released by damage [J/m³]
		double      stiffeningEnergy;   //!< Stored energy beyond ½σ:ε_e, from the equation of state and from cracks that close [J/m³]
	};

	//! Effects that a group of elements simulates, a bit mask. One that is off costs nothing.
	namespace ConcreteEffects {
		enum : unsigned {
			Flow            = 1,  //!< Viscoplastic flow; off: no principal stresses, no damage growth
			Rate            = 2,  //!< Rate dependence of the flow; off: ω_p = 1
			Damage          = 4,  //!< Damage: growth (with Flow), strength loss, elastic degradation; off: Δ = 1
			EquationOfState = 8,  //!< Moduli that grow with pressure; off: constant
			Energy          = 16, //!< Book of stored and dissipated energy
			All             = 31
		};
	}

	/*! One explicit step of a sub-element to the strain `newStrain` within `dt` [s] > 0. `fractureEnergy` [J/m³] is the element's own G_f. */
	template <unsigned effects>
	void advanceConcrete(const PreparedConcrete& concrete, double fractureEnergy, const PlaneTensor& newStrain, double dt, ConcreteState& state);

	using ConcreteUpdate = void (*)(const PreparedConcrete&, double fractureEnergy, const PlaneTensor& newStrain, double dt, ConcreteState&);

	/*! advanceConcrete for a mask known at run time; pick it once per group of elements. Throws std::invalid_argument for an unknown bit. */
	ConcreteUpdate concreteUpdate(unsigned effects);

	/*! Largest tangent modulus over the reference modulus, ≥ 1, for a bound on the time step: the equation of state stiffens under pressure;
	damage only softens. */
	double stiffnessFactor(const PreparedConcrete& concrete, const ConcreteState& state);

	/*! Damage parameter η_0 [-], 0 (intact) … 1, that Zubelewicz (2018), Figure 7, plots as η/η_max. */
	double damageRatio(const PreparedConcrete& concrete, const ConcreteState& state);

	/*! Stored energy [J/m³]: ½σ:ε_e + stiffeningEnergy. */
	double storedEnergy(const ConcreteState& state);

} // namespace ddem
} // namespace yade
