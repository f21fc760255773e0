// GPL v2 or later, see LICENSE.
// The concrete damage model of Zubelewicz (2018): one explicit step of a sub-element.
#pragma once

#include <pkg/ddem/kernel/laws/concrete/ConcreteDamage.hpp>
#include <pkg/ddem/kernel/laws/concrete/ConcreteFlow.hpp>
#include <pkg/ddem/kernel/laws/concrete/ConcreteParameters.hpp>
#include <pkg/ddem/kernel/laws/concrete/ConcretePressure.hpp>
#include <pkg/ddem/kernel/laws/concrete/ConcreteState.hpp>

namespace yade::ddem {

/// Adds the step from `old` to `now` to the energies, so that ½(σ_old + σ_new):dε = d(stored) + d(plastic) + d(damage)
/// holds to round-off in every step.
/// It rests on the identity, a and b being the elastic strains before and after, ½(σ_old + σ_new):(b − a) = d(½σ:ε_e)
/// − ½ a:(C_new − C_old):b. The last term is the energy that the change of stiffness releases at fixed elastic strain.
/// What of it the equation of state causes stays in store, to come back with the pressure. The rest, and the work on
/// the slip of closing cracks, is dissipated by damage. `flow` is the plastic strain that flow added. Between the last
/// evaluation and `oldStrain`, the strain of the step before, stress was elastic with the stiffness of then,
/// as `old.stress` is.
template <class Number>
inline void bookEnergy(
        const ConcreteStateOf<Number>& old,
        const PlaneTensorOf<Number>&   oldStrain,
        const PlaneTensorOf<Number>&   flow,
        ConcreteStateOf<Number>&       now)
{
	const PlaneTensorOf<Number> before = oldStrain - old.plasticStrain, after = now.strain - now.plasticStrain;
	const PlaneTensorOf<Number> mean = 0.5 * (old.stress + now.stress),
	                            slip = now.plasticStrain - old.plasticStrain - flow;
	const Number                across   = doubleDot(now.stress, before);
	const Number                released = 0.5 * (doubleDot(old.stress, after) - across);
	const Number                kept     = -0.5 * across * (now.stiffening - old.stiffening) / (1 + now.stiffening);

	now.plasticDissipation = old.plasticDissipation + doubleDot(mean, flow);
	now.stiffeningEnergy   = old.stiffeningEnergy + kept;
	now.damageDissipation  = old.damageDissipation + (released - kept + doubleDot(mean, slip));
}

/// What the flow of one step adds.
template <class Number> struct FlowIncrement {
	PlaneTensorOf<Number> plasticStrain, damage; // [-]
};

/// Flow from the elastic predictor: along its M_p, the amount implicit, and the damage that it does; Zubelewicz (2018),
/// eqs. 5-8. `stressOf` is the elasticity of the predictor, `strain` = ė_N dt.
template <unsigned effects, class Number, class Elasticity>
inline FlowIncrement<Number> flowIncrement(
        const PreparedConcrete&         concrete,
        const FractureEnergyOf<Number>& fractureEnergy,
        const PlaneTensorOf<Number>&    predicted,
        const Elasticity&            stressOf,
        const DamageMeasure<Number>& damage,
        const Number&                open,
        const Number&                strain,
        double                       dt)
{
	const Number                    zero(0), one(1);
	FlowIncrement<Number>           increment { { zero, zero, zero, zero }, { zero, zero, zero, zero } };
	const PrincipalStresses<Number> principal = principalStresses(predicted, concrete.parameters.sharingTolerance);
	const Number                    friction  = frictionAt(concrete, pressure(predicted));
	const PlaneTensorOf<Number>     flow      = flowTensor(principal, friction);
	const Number                    trial     = equivalentStress(flow, predicted);
	const auto                      yields    = trial > 0 && strain > 0;
	if (!any(yields)) return increment;

	// ė_eq dt at σ_eq = σ_p
	const Number amount     = dt * rateFactor<(effects & ConcreteEffects::Rate) != 0>(concrete, strain * (1 / dt));
	const Number relaxation = amount * (0.25 * doubleDot(flow, stressOf(flow)));
	const auto   solution
	        = solveFlow(concrete.flowPower, trial, relaxation, concrete.parameters.strength * damage.integrity);
	const Number plastic    = select(yields, amount * solution.intensity, zero); // ė_eq dt
	increment.plasticStrain = (0.5 * plastic) * flow;
	if constexpr ((effects & ConcreteEffects::Damage) != 0) {
		// where there is no damage yet, the largest stress says whether its crack would be open
		const Number growing = select(damage.integrity < 1, open, select(principal.s1 >= 0, one, zero));
		const Number work    = select(yields, solution.equivalent * plastic, zero);
		const Number energy = select(
		        damage.integrity > concrete.localisedIntegrity, fractureEnergy.spread, fractureEnergy.band);
		increment.damage     = damageGrowth(concrete, energy, damageTensor(principal, friction), growing, work);
	}
	return increment;
}

/// One explicit step of a sub-element to the strain `newStrain` within `dt` [s] > 0;
/// `fractureEnergy` [J/m³] is the element's own G_f.
/// Elastic predictor with the damage and the stiffening of the step before; flow; then the stress that follows from the
/// new elastic strain and damage. First order in the strain increment; finite for any finite strain and rate. A G_f at
/// or below zero counts as PreparedConcrete::smallestEnergy. Number is double or a SIMD batch;
/// a lane of a batch does not feel the others.
template <unsigned effects, class Number>
inline void advanceConcrete(
        const PreparedConcrete&                              concrete,
        const FractureEnergyOf<typename Same<Number>::Type>& fractureEnergy,
        const PlaneTensorOf<Number>&                         newStrain,
        double                                               dt,
        ConcreteStateOf<Number>&                             state)
{
	constexpr bool flows = effects & ConcreteEffects::Flow, damages = effects & ConcreteEffects::Damage,
	               stiffens = effects & ConcreteEffects::EquationOfState, books = effects & ConcreteEffects::Energy;
	PlaneTensorOf<Number> plasticStrain = state.plasticStrain, elasticStrain = newStrain - plasticStrain;

	DamageMeasure<Number> damage {}, grown {};
	Number                open(1), effect(0), factor(1);
	damage.integrity = Number(1);
	if constexpr (damages) {
		damage = grown            = measureDamage(concrete, state.damage);
		open                      = crackOpenness(concrete, damage, elasticStrain);
		effect                    = stiffnessEffect(concrete, open);
		const Number effectBefore = stiffnessEffect(concrete, 1 - state.closure);
		if (any(effect > effectBefore) || any(effect < effectBefore)) {
			const PlaneTensorOf<Number> before = state.strain - state.plasticStrain;
			plasticStrain                      = plasticStrain
			        + (1 - keptElasticShare(concrete, damage, effectBefore, effect, before)) * before;
			elasticStrain                      = newStrain - plasticStrain;
		}
	}
	const auto stressOf = [&](const DamageMeasure<Number>& with, const PlaneTensorOf<Number>& strain) {
		if constexpr (damages)
			return degradedStress(concrete.lambda, concrete.twoShear, effect, with.loss, strain);
		else
			return elasticStress(concrete.lambda, concrete.twoShear, strain);
	};
	PlaneTensorOf<Number>   stress = stressOf(damage, elasticStrain);
	ConcreteStateOf<Number> next   = state;
	next.strain                    = newStrain;
	next.plasticStrain             = plasticStrain;
	if constexpr (damages) next.closure = 1 - open;
	FlowIncrement<Number> increment {};

	if constexpr (flows) {
		const Number strain = strainRateMeasure(newStrain - state.strain); // ė_N dt
		if (any(strain > 0)) {
			if constexpr (stiffens) factor = 1 + state.stiffening;
			const auto predictor
			        = [&](const PlaneTensorOf<Number>& along) { return factor * stressOf(damage, along); };
			increment = flowIncrement<effects>(
			        concrete, fractureEnergy, factor * stress, predictor, damage, open, strain, dt);
			next.plasticStrain   = plasticStrain + increment.plasticStrain;
			if constexpr (damages) {
				next.damage = state.damage + increment.damage;
				grown       = measureDamage(concrete, next.damage);
			}
			stress = stressOf(grown, newStrain - next.plasticStrain);
		}
	}
	if constexpr (stiffens) {
		next.stiffening = modulusStiffening(concrete, pressure(stress));
		factor          = 1 + next.stiffening;
	}
	next.stress = factor * stress;
	if constexpr (books) {
		if constexpr (flows) next.lastStrain = newStrain;
		bookEnergy(state, flows ? state.lastStrain : state.strain, increment.plasticStrain, next);
	}
	state = next;
}

/// Largest tangent modulus over the reference modulus [-], ≥ 1, for a bound on the time step: the equation of state
/// stiffens under pressure, damage only softens. 1 where the equation of state is off.
double stiffnessFactor(const PreparedConcrete& concrete, const ConcreteState& state);

/// Damage parameter η_0 [-], 0 (intact) to 1: the η/η_max of Zubelewicz (2018),
/// Figure 7, without the factor of closed cracks.
double damageRatio(const PreparedConcrete& concrete, const ConcreteState& state);

} // namespace yade::ddem
