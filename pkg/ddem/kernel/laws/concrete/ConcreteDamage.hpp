// GPL v2 or later, see LICENSE.
// Damage of concrete: damage parameter, strength, closing cracks and the degraded elasticity.
#pragma once

#include <pkg/ddem/kernel/laws/concrete/ConcreteParameters.hpp>
#include <pkg/ddem/kernel/algebra/ElasticModuli.hpp>
#include <pkg/ddem/kernel/algebra/PlaneTensor.hpp>

#include <algorithm>

namespace yade::ddem {

/// What a damage tensor Ω means. η_0 N_Ω = η_0 Ω/Ω_D needs no division by Ω_D and is defined, zero, where N_Ω is not.
template <class Number> struct DamageMeasure {
	PlaneTensorOf<Number> loss;      ///< η_0 N_Ω [-]
	Number                integrity; ///< 1 − η_0 [-]
};

/// G_f of a sub-element [J/m³]: while flow is spread over the material, and once it has localised in a band of one row
/// of elements. They differ where a crack band is asked for: then the energy of a crack per area does not depend on the
/// size of the elements (Bažant and Oh 1983), nor does the strength of what has its peak before, which the first rules.
template <class Number> struct FractureEnergyOf {
	Number spread, band;

	FractureEnergyOf(const Number& both) // NOLINT: a number is meant to do for both
	        : spread(both)
	        , band(both)
	{
	}
	FractureEnergyOf(const Number& first, const Number& second)
	        : spread(first)
	        , band(second)
	{
	}
};

/// η_0 = (1 − r) Ω_D^n_f/(1 + Ω_D^n_f), Ω_D = √(Ω:Ω), with the residual r that keeps strength and stiffness above zero
/// (r = 0 in Zubelewicz (2018)).
template <class Number>
inline DamageMeasure<Number> measureDamage(const PreparedConcrete& concrete, const PlaneTensorOf<Number>& damage)
{
	using std::sqrt;
	const double residual = concrete.parameters.residual;
	const Number square = doubleDot(damage, damage), size = sqrt(square);
	if (concrete.damagePower.isTwo()) { // η_0/Ω_D = Ω_D/(1 + Ω_D²)
		const Number intact = 1 / (1 + square);
		return { ((1 - residual) * size * intact) * damage, residual + (1 - residual) * intact };
	}
	const Number power = concrete.damagePower(size);
	const Number ratio = (1 - residual) / (1 + 1 / power); // η_0; finite for powers that underflow or overflow
	return { select(size > 0, ratio / size, Number(0)) * damage, residual + (1 - residual) / (1 + power) };
}

/// Share η_max ξ_c1 of η_0 that the stiffness loses [-]; `openness` from 0 (crack closed) to 1 (open)
template <class Number> inline Number stiffnessEffect(const PreparedConcrete& concrete, const Number& openness)
{
	const ConcreteParameters& c = concrete.parameters;
	return c.damageLimit * (c.closedEffect + (1 - c.closedEffect) * openness);
}

/// Growth of Ω [-] when flow does the work σ_eq ė_eq dt [J/m³]: ½ M_c ξ_c0 σ_eq ė_eq dt/G_f, Zubelewicz (2018), eq. 8
template <class Number>
inline PlaneTensorOf<Number> damageGrowth(
        const PreparedConcrete& concrete, const Number& fractureEnergy, const PlaneTensorOf<Number>& damageTensor,
        const Number& openness, const Number& work)
{
	const ConcreteParameters& c      = concrete.parameters;
	const Number              effect = c.closedGrowth + (1 - c.closedGrowth) * openness;
	// also for NaN
	const Number energy
	        = select(fractureEnergy > concrete.smallestEnergy, fractureEnergy, Number(concrete.smallestEnergy));
	return (0.5 * effect * work / energy) * damageTensor;
}

/// Degraded stress λ Δ (Δ:ε) + 2μ Δ.ε.Δ [Pa] with Δ = 1 − effect·loss: Zubelewicz (2018), section 3.
template <class Number>
inline PlaneTensorOf<Number> degradedStress(
        double lambda, double twoShear, const Number& effect, const PlaneTensorOf<Number>& loss,
        const PlaneTensorOf<Number>& strain)
{
	const PlaneTensorOf<Number> delta
	        = { 1 - effect * loss.xx, 1 - effect * loss.yy, 1 - effect * loss.zz, -effect * loss.xy };
	return (lambda * doubleDot(delta, strain)) * delta + twoShear * sandwich(delta, strain);
}

/// How open the crack is, from 0 (closed: σ_Ω < 0) to 1 (open: σ_Ω ≥ 0), σ_Ω = N_Ω:σ being the crack-normal stress:
/// Zubelewicz (2018), section 3.
/// σ_Ω depends on the openness itself, because an open crack is the softer one: under lateral stress both states may
/// agree with their own σ_Ω, or neither, and a switch that looks at the stress of the step before then flips at every
/// step. Here σ_Ω is the stress that the closed crack would carry. That makes the openness, and so the stress, a unique
/// function of the elastic strain, and agrees with the definition wherever that has one answer.
/// The openness falls linearly to 0 at σ_Ω = −closureBand: closing at once makes the shear stress jump.
template <class Number>
inline Number crackOpenness(
        const PreparedConcrete& concrete, const DamageMeasure<Number>& damage,
        const PlaneTensorOf<Number>& elasticStrain)
{
	using std::max;
	const Number                closed = stiffnessEffect(concrete, Number(0));
	const PlaneTensorOf<Number> stress
	        = degradedStress(concrete.lambda, concrete.twoShear, closed, damage.loss, elasticStrain);
	// both times η_0
	const Number normal = doubleDot(damage.loss, stress),
	             band = (1 - damage.integrity) * concrete.parameters.closureBand;
	return select(normal >= 0, Number(1), max(Number(0), 1 + normal / band));
}

/// Share [-], at most 1, of the elastic strain that stays elastic when the stiffness changes because a crack closes or
/// opens; the rest becomes permanent slip. The report's stiffness comes back at once when a crack closes, in all
/// directions. At fixed elastic strain that would create the energy ½ ε:(C_now − C_before):ε in every closure, and
/// a broken sample whose cracks chatter would feed on it without end. So a change of openness may lower the stored
/// energy, never raise it: where it would rise, the elastic strain shrinks until it does not. Where only the
/// crack-normal stress acts it is zero at closure, and nothing slips.
template <class Number>
inline Number keptElasticShare(
        const PreparedConcrete&      concrete,
        const DamageMeasure<Number>& damage,
        const Number&                effectBefore,
        const Number&                effectNow,
        const PlaneTensorOf<Number>& elasticStrain)
{
	using std::sqrt;
	const auto twiceEnergy = [&](const Number& effect) {
		return doubleDot(
		        degradedStress(concrete.lambda, concrete.twoShear, effect, damage.loss, elasticStrain),
		        elasticStrain);
	};
	const Number before = twiceEnergy(effectBefore), now = twiceEnergy(effectNow);
	return select(now > before, sqrt(before / now), Number(1));
}

} // namespace yade::ddem
