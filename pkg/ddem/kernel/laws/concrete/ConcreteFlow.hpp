// GPL v2 or later, see LICENSE.
// Viscoplastic Mohr-Coulomb flow of concrete: friction, flow tensors, rate factor and the implicit solve.
#pragma once

#include <pkg/ddem/kernel/laws/concrete/ConcreteParameters.hpp>
#include <pkg/ddem/kernel/algebra/PrincipalStresses.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace yade::ddem {

/// Friction q_D [-] at a pressure [Pa, positive in compression]: q_0 (1 + p/p_q0)^(-n_q), constant in tension.
/// Zubelewicz (2018) does not print q_D(p); this form, with his constants untouched, gives the strengths he states.
template <class Number> inline Number frictionAt(const PreparedConcrete& concrete, const Number& pressure)
{
	using std::max;
	return concrete.parameters.friction
	        / concrete.frictionPower(1 + max(pressure, Number(0)) * concrete.perFrictionPressure);
}

/// Flow tensor M_p = (1+q) N1 − (1−q) N3: Zubelewicz (2018), eq. 5
template <class Number>
inline PlaneTensorOf<Number> flowTensor(const PrincipalStresses<Number>& principal, const Number& friction)
{
	return (1 + friction) * principal.n1 - (1 - friction) * principal.n3;
}

/// Complementary flow tensor M_c = (1+q) N1 + (1−q) N3, the orientation of damage growth: Zubelewicz (2018), eq. 8
template <class Number>
inline PlaneTensorOf<Number> damageTensor(const PrincipalStresses<Number>& principal, const Number& friction)
{
	return (1 + friction) * principal.n1 + (1 - friction) * principal.n3;
}

/// σ_eq = ½ M_p : σ [Pa]; there is flow only where it is positive
template <class Number>
inline Number equivalentStress(const PlaneTensorOf<Number>& flow, const PlaneTensorOf<Number>& stress)
{
	return 0.5 * doubleDot(flow, stress);
}

/// Strain rate ė_N = √(½ ε̇:ε̇) [1/s] of a strain rate tensor [1/s], or ė_N dt of a strain increment. It is the total
/// strain: the report leaves ė_N open.
template <class Number> inline Number strainRateMeasure(const PlaneTensorOf<Number>& strainRate)
{
	using std::sqrt;
	return sqrt(0.5 * doubleDot(strainRate, strainRate));
}

/// Factor Λ_0 ė_0 (ė_N/ė_0)^ω_p [1/s] of the flow rate: Zubelewicz (2018), eq. 7. Without rate dependence (ω_p = 1) it
/// is Λ_0 ė_N: the flow per strain increment does not depend on time.
template <bool rateDependent, class Number>
inline Number rateFactor(const PreparedConcrete& concrete, const Number& strainRate)
{
	const ConcreteParameters& c = concrete.parameters;
	if constexpr (rateDependent)
		return (c.flowFactor * c.referenceRate) * concrete.ratePower(strainRate * concrete.perReferenceRate);
	else
		return c.flowFactor * strainRate;
}

/// Outcome of the flow of one step.
template <class Number> struct FlowSolution {
	Number equivalent; ///< σ_eq after flow [Pa]
	Number intensity;  ///< (σ_eq/σ_p)^n_p [-]
};

/// solveFlow for exponents without a closed solution; a batch goes one number at a time.
FlowSolution<double> solveFlowByNewton(double flowExponent, double trial, double relaxation, double strength);

template <class Batch>
inline FlowSolution<Batch>
solveFlowByNewton(double flowExponent, const Batch& trial, const Batch& relaxation, const Batch& strength)
{
	alignas(Batch) double t[Batch::size], r[Batch::size], s[Batch::size];
	trial.store_aligned(t);
	relaxation.store_aligned(r);
	strength.store_aligned(s);
	for (std::size_t i = 0; i < Batch::size; ++i) {
		const FlowSolution<double> one = solveFlowByNewton(flowExponent, t[i], r[i], s[i]);
		t[i]                           = one.equivalent;
		r[i]                           = one.intensity;
	}
	return { Batch::load_aligned(t), Batch::load_aligned(r) };
}

/// Equivalent stress at the end of a step: the root x in [0, trial] of x + relaxation (x/strength)^n_p = trial.
/// `trial` > 0 is the equivalent stress of the elastic predictor [Pa]; `relaxation` = h dt A ≥ 0 [Pa], with
/// h = ¼ M_p:C:M_p, is what flow at full strength would take off it. It can neither overshoot nor fail. Closed for
/// n_p = ½ (quadratic in √x, in the form without cancellation) and 1.
template <class Number>
inline FlowSolution<Number>
solveFlow(const Power& flowPower, const Number& trial, const Number& relaxation, const Number& strength)
{
	using std::sqrt;
	if (flowPower.isHalf()) {
		const Number root = 2 * trial / (relaxation + sqrt(relaxation * relaxation + 4 * strength * trial));
		return { strength * root * root, root };
	}
	if (flowPower.isOne()) {
		const Number ratio = trial / (relaxation + strength);
		return { strength * ratio, ratio };
	}
	return solveFlowByNewton(flowPower.exponent(), trial, relaxation, strength);
}

} // namespace yade::ddem
