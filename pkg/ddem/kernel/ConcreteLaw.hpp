// GPL v2 or later, see LICENSE.
// The concrete damage model of Zubelewicz (2018): state of a sub-element and one explicit step of it.
#pragma once

#include <pkg/ddem/kernel/ConcreteDamage.hpp>
#include <pkg/ddem/kernel/ConcreteFlow.hpp>
#include <pkg/ddem/kernel/ConcreteParameters.hpp>
#include <pkg/ddem/kernel/ConcretePressure.hpp>
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

	/*! Stress of an elastic strain in a given state of damage, with what it took to find it. */
	struct ConcreteResponse {
		PlaneTensor stress;        //!< [Pa]
		double      modulusFactor; //!< Factor of the equation of state on the moduli [-]
		double      eta;           //!< Loss of stiffness η [-]
		double      openness;      //!< 1: crack open, 0: closed
	};

	/*! Stress as a function of elastic strain and damage (and, only where a crack could be open as well as closed, of what it was). */
	template <unsigned effects>
	inline ConcreteResponse
	concreteResponse(const PreparedConcrete& concrete, const DamageMeasure& damage, const PlaneTensor& elasticStrain, bool wasOpen)
	{
		ConcreteResponse r { { 0, 0, 0, 0 }, 1, 0, 1 };
		if ((effects & ConcreteEffects::Damage) && damage.any) {
			const DegradedStress stress = degradedStress(concrete.lambda, concrete.twoShear, damage.direction, elasticStrain);
			const double         s0 = doubleDot(damage.direction, stress.constant), s1 = doubleDot(damage.direction, stress.linear),
				     s2               = doubleDot(damage.direction, stress.quadratic);
			const double etaClosed = stiffnessLoss(concrete, damage, 0), etaOpen = stiffnessLoss(concrete, damage, 1);
			const auto   normalStress = [&](double eta) { return s0 + eta * (s1 + eta * s2); };
			r.openness                = crackOpenness(
                                normalStress(etaClosed), normalStress(0.5 * (etaClosed + etaOpen)), normalStress(etaOpen), concrete.parameters.closureBand, wasOpen);
			r.eta    = etaClosed + (etaOpen - etaClosed) * r.openness;
			r.stress = stress.at(r.eta);
		} else
			r.stress = elasticStress(concrete.lambda, concrete.twoShear, elasticStrain);

		if constexpr ((effects & ConcreteEffects::EquationOfState) != 0) {
			r.modulusFactor = modulusFactorOf(concrete, pressure(r.stress));
			r.stress *= r.modulusFactor;
		}
		return r;
	}

	/*! Adds the step from `old` to `now` to the energies, so that ½(σ_old + σ_new):dε = d(stored) + d(plastic) + d(damage) holds to round-off in every step.
	It rests on the identity, a and b being the elastic strains before and after, ½(σ_old + σ_new):(b − a) = d(½σ:ε_e) − ½ a:(C_new − C_old):b. The last
	term is the energy that the change of stiffness releases at fixed elastic strain; the part that the change of damage causes, at the new pressure and
	openness, is dissipation; the rest (pressure, cracks that close or open) stays in store. */
	template <unsigned effects>
	inline void bookEnergy(
	        const PreparedConcrete& concrete, const ConcreteState& old, const DamageMeasure& oldDamage, const ConcreteResponse& response, ConcreteState& now)
	{
		const PlaneTensor before = old.strain - old.plasticStrain, after = now.strain - now.plasticStrain;
		const double      released = 0.5 * (doubleDot(old.stress, after) - doubleDot(now.stress, before));

		double byDamage = 0;
		if constexpr ((effects & ConcreteEffects::Damage) && (effects & ConcreteEffects::Flow)) {
			const double eta = stiffnessLoss(concrete, oldDamage, response.openness);
			// before:C(old damage) at the new pressure and openness; C is symmetric
			const PlaneTensor undamaged
			        = response.modulusFactor * degradedStress(concrete.lambda, concrete.twoShear, oldDamage.direction, before).at(eta);
			byDamage = 0.5 * (doubleDot(undamaged, after) - doubleDot(now.stress, before));
		}
		now.plasticDissipation += 0.5 * doubleDot(old.stress + now.stress, now.plasticStrain - old.plasticStrain);
		now.damageDissipation += byDamage;
		now.stiffeningEnergy -= released - byDamage;
	}

	/*! One explicit step of a sub-element to the strain `newStrain` within `dt` [s] > 0; `fractureEnergy` [J/m³] is the element's own G_f.
	Elastic predictor with the damage of the step before; flow along M_p of the predictor, its amount implicit; then damage and the stress that follows from
	the new elastic strain and damage. First order in the strain increment; finite for any finite strain and rate.
	A G_f at or below zero counts as PreparedConcrete::smallestEnergy. */
	template <unsigned effects>
	inline void advanceConcrete(const PreparedConcrete& concrete, double fractureEnergy, const PlaneTensor& newStrain, double dt, ConcreteState& state)
	{
		constexpr bool flows = effects & ConcreteEffects::Flow, rates = effects & ConcreteEffects::Rate, damages = effects & ConcreteEffects::Damage,
			       books = effects & ConcreteEffects::Energy;

		const PlaneTensor increment = newStrain - state.strain;
		DamageMeasure     damage { { 0, 0, 0, 0 }, 1, false };
		bool              wasOpen = true;
		if constexpr (damages) {
			damage  = measureDamage(concrete, state.damage);
			wasOpen = doubleDot(damage.direction, state.stress) >= -0.5 * concrete.parameters.closureBand;
		}
		ConcreteState    next     = state;
		next.strain               = newStrain;
		ConcreteResponse response = concreteResponse<effects>(concrete, damage, newStrain - state.plasticStrain, wasOpen);
		next.stress               = response.stress;

		if constexpr (flows) {
			const double step = strainRateMeasure(increment); // ė_N dt
			if (step > 0) {
				const PrincipalStresses principal = principalStresses(response.stress, concrete.parameters.sharingTolerance);
				const double            friction  = frictionAt(concrete, pressure(response.stress));
				const PlaneTensor       flow      = flowTensor(principal, friction);
				const double            trial     = equivalentStress(flow, response.stress);
				if (trial > 0) {
					const double amount   = dt * rateFactor<rates>(concrete, step / dt); // flow at σ_eq = σ_p
					const double strength = damages ? damagedStrength(concrete, damage) : concrete.parameters.strength;
					const double along    = (damages && damage.any)
					           ? degradedStiffnessAlong(concrete.lambda, concrete.twoShear, response.eta, damage.direction, flow)
					           : 2 * elasticEnergy(concrete.lambda, concrete.twoShear, flow);
					const double stiffness = 0.25 * response.modulusFactor * along;
					const double equivalent = solveFlow(concrete.flowPower, trial, stiffness * amount, strength);
					const double plastic    = amount * concrete.flowPower(equivalent / strength); // ė_eq dt

					next.plasticStrain += (0.5 * plastic) * flow;
					DamageMeasure grown = damage;
					if constexpr (damages) {
						const double openness = damage.any ? response.openness : (principal.s1 >= 0 ? 1 : 0);
						next.damage += damageGrowth(concrete, fractureEnergy, damageTensor(principal, friction), openness, equivalent * plastic);
						grown = measureDamage(concrete, next.damage);
					}
					response    = concreteResponse<effects>(concrete, grown, newStrain - next.plasticStrain, response.openness >= 0.5);
					next.stress = response.stress;
				}
			}
		}
		if constexpr (books) bookEnergy<effects>(concrete, state, damage, response, next);
		state = next;
	}

	using ConcreteUpdate = void (*)(const PreparedConcrete&, double fractureEnergy, const PlaneTensor& newStrain, double dt, ConcreteState&);

	/*! advanceConcrete for a mask known at run time; pick it once per group of elements. Throws std::invalid_argument for an unknown bit. */
	ConcreteUpdate concreteUpdate(unsigned effects);

	/*! Largest tangent modulus over the reference modulus [-], ≥ 1, for a bound on the time step: the equation of state stiffens under pressure, damage only
	softens. Without the equation of state the factor is 1; do not ask. */
	double stiffnessFactor(const PreparedConcrete& concrete, const ConcreteState& state);

	/*! Damage parameter η_0 [-], 0 (intact) to 1: the η/η_max of Zubelewicz (2018), Figure 7, without the factor of closed cracks. */
	double damageRatio(const PreparedConcrete& concrete, const ConcreteState& state);

	/*! Stored energy [J/m³]: ½σ:ε_e + stiffeningEnergy. */
	double storedEnergy(const ConcreteState& state);

} // namespace ddem
} // namespace yade
