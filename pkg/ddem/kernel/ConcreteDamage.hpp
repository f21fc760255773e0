// GPL v2 or later, see LICENSE.
// Damage of concrete: damage parameter, strength, closing cracks and the degraded elasticity.
#pragma once

#include <pkg/ddem/kernel/ConcreteParameters.hpp>
#include <pkg/ddem/kernel/ElasticLaw.hpp>
#include <pkg/ddem/kernel/PlaneTensor.hpp>

#include <algorithm>

namespace yade::ddem {

/// What a damage tensor Ω means. η_0 N_Ω = η_0 Ω/Ω_D needs no division by Ω_D and is defined, zero, where N_Ω is not.
template <class Number> struct DamageMeasure {
	PlaneTensorOf<Number> loss;      ///< η_0 N_Ω [-]
	Number                integrity; ///< 1 − η_0 [-]
};

/// η_0 = (1 − r) Ω_D^n_f/(1 + Ω_D^n_f), Ω_D = √(Ω:Ω), with the residual r that keeps strength and stiffness above zero (r = 0 in Zubelewicz (2018)).
template <class Number> inline DamageMeasure<Number> measureDamage(const PreparedConcrete& concrete, const PlaneTensorOf<Number>& damage)
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
        const PreparedConcrete& concrete, const Number& fractureEnergy, const PlaneTensorOf<Number>& damageTensor, const Number& openness, const Number& work)
{
	const ConcreteParameters& c      = concrete.parameters;
	const Number              effect = c.closedGrowth + (1 - c.closedGrowth) * openness;
	const Number              energy = select(fractureEnergy > concrete.smallestEnergy, fractureEnergy, Number(concrete.smallestEnergy)); // also for NaN
	return (0.5 * effect * work / energy) * damageTensor;
}

/// Degraded stress λ Δ (Δ:ε) + 2μ Δ.ε.Δ [Pa] with Δ = 1 − effect·loss: Zubelewicz (2018), section 3.
template <class Number>
inline PlaneTensorOf<Number>
degradedStress(double lambda, double twoShear, const Number& effect, const PlaneTensorOf<Number>& loss, const PlaneTensorOf<Number>& strain)
{
	const PlaneTensorOf<Number> delta = { 1 - effect * loss.xx, 1 - effect * loss.yy, 1 - effect * loss.zz, -effect * loss.xy };
	return (lambda * doubleDot(delta, strain)) * delta + twoShear * sandwich(delta, strain);
}

/// Crack-normal stress loss:σ [Pa] (the sign of σ_Ω = N_Ω:σ) as a quadratic polynomial in the effect, which is not known before it.
template <class Number> struct CrackNormalStress {
	Number constant, linear, quadratic;

	Number at(const Number& effect) const { return constant + effect * (linear + effect * quadratic); }
};

template <class Number>
inline CrackNormalStress<Number> crackNormalStress(double lambda, double twoShear, const PlaneTensorOf<Number>& loss, const PlaneTensorOf<Number>& strain)
{
	// Δ:ε = tr ε − effect·loss:ε and loss:Δ = tr loss − effect·loss:loss; likewise loss:(Δ.ε.Δ)
	const PlaneTensorOf<Number> squared = symmetricProduct(loss, loss), cubed = sandwich(loss, loss);
	const Number                volumetric = trace(strain), along = doubleDot(loss, strain), size = trace(loss), square = trace(squared);
	const Number                l = lambda * along;
	return { lambda * size * volumetric + twoShear * along,
		 -l * size - lambda * square * volumetric - 2 * twoShear * doubleDot(squared, strain),
		 l * square + twoShear * doubleDot(cubed, strain) };
}

/// How open the crack is, from 0 (closed: σ_Ω < 0) to 1 (open: σ_Ω ≥ 0): Zubelewicz (2018), section 3.
/// σ_Ω depends on the openness, because an open crack is the softer one. So the openness is solved for: `closed`, `middle`, `open` are σ_Ω [Pa] with the
/// openness 0, ½, 1 (σ_Ω is quadratic in it).
/// - One state agrees with its own σ_Ω: that one.
/// - Neither does (lateral compression shuts the crack when it is soft, and not when it is stiff): the crack faces touch without stress, σ_Ω = 0. A plain
/// switch would flip at every step here.
/// - Both do: it stays what it was (`wasOpen`).
/// With `band` > 0 [Pa] the openness falls linearly from 1 at σ_Ω = 0 to 0 at σ_Ω = −band.
template <class Number, class Bool>
inline Number crackOpenness(const Number& closed, const Number& middle, const Number& open, const Number& band, const Bool& wasOpen)
{
	using std::max;
	using std::min;
	using std::sqrt;
	const auto canOpen = open >= 0, canClose = closed < -band;
	// where closed ≥ −band and open < 0 there is one root in [0, 1] of constant + linear o + quadratic o², which falls from ≥ 0 to < 0
	const Number constant    = closed + band;
	const Number quadratic   = 2 * (open + closed) - 4 * middle;
	const Number linear      = open - closed - quadratic - band;
	const Number denominator = sqrt(max(linear * linear - 4 * quadratic * constant, Number(0))) - linear;
	const Number touching    = select(denominator > 0, max(Number(0), min(2 * constant / denominator, Number(1))), Number(0));
	return select(canOpen && (wasOpen || !canClose), Number(1), select(canClose, Number(0), touching));
}

/// Openness of the crack [-] at an elastic strain.
template <class Number, class Bool>
inline Number openCrack(const PreparedConcrete& concrete, const DamageMeasure<Number>& damage, const PlaneTensorOf<Number>& elasticStrain, const Bool& wasOpen)
{
	const CrackNormalStress<Number> normal = crackNormalStress(concrete.lambda, concrete.twoShear, damage.loss, elasticStrain);
	const Number                    closed = stiffnessEffect(concrete, Number(0)), open = stiffnessEffect(concrete, Number(1));
	return crackOpenness(
	        normal.at(closed),
	        normal.at(0.5 * (closed + open)),
	        normal.at(open),
	        (1 - damage.integrity) * concrete.parameters.closureBand, // the normal stress carries the factor η_0
	        wasOpen);
}

} // namespace yade::ddem
