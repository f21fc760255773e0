// GPL v2 or later, see LICENSE.
// Viscoplastic Mohr-Coulomb flow of concrete: friction, flow tensors, rate factor and the implicit solve.
#pragma once

#include <pkg/ddem/kernel/ConcreteParameters.hpp>
#include <pkg/ddem/kernel/PrincipalStresses.hpp>

namespace yade {
namespace ddem {

	/*! Friction q_D [-] at a pressure [Pa, positive in compression]: q_0 (1 + p/p_q0)^(-n_q), constant in tension.
	Zubelewicz (2018) does not print q_D(p); this form, with his constants untouched, gives the strengths he states. */
	inline double frictionAt(const PreparedConcrete& concrete, double pressure)
	{
		const ConcreteParameters& c = concrete.parameters;
		return pressure > 0 ? c.friction / concrete.frictionPower(1 + pressure / c.frictionPressure) : c.friction;
	}

	//! Flow tensor M_p = (1+q) N1 − (1−q) N3: Zubelewicz (2018), eq. 5
	inline PlaneTensor flowTensor(const PrincipalStresses& principal, double friction) { return (1 + friction) * principal.n1 - (1 - friction) * principal.n3; }

	//! Complementary flow tensor M_c = (1+q) N1 + (1−q) N3, the orientation of damage growth: Zubelewicz (2018), eq. 8
	inline PlaneTensor damageTensor(const PrincipalStresses& principal, double friction) { return (1 + friction) * principal.n1 + (1 - friction) * principal.n3; }

	//! σ_eq = ½ M_p : σ [Pa]; there is flow only where it is positive
	inline double equivalentStress(const PlaneTensor& flow, const PlaneTensor& stress) { return 0.5 * doubleDot(flow, stress); }

	//! Strain rate ė_N = √(½ ε̇:ε̇) [1/s] of a strain rate tensor [1/s] (total strain; the report leaves ė_N open)
	inline double strainRateMeasure(const PlaneTensor& strainRate) { return std::sqrt(0.5 * doubleDot(strainRate, strainRate)); }

	/*! Factor Λ_0 ė_0 (ė_N/ė_0)^ω_p [1/s] of the flow rate: Zubelewicz (2018), eq. 7. Without rate dependence (ω_p = 1) it is Λ_0 ė_N: the flow per strain
	increment does not depend on time. */
	template <bool rateDependent> double rateFactor(const PreparedConcrete& concrete, double strainRate)
	{
		const ConcreteParameters& c = concrete.parameters;
		if constexpr (rateDependent) return c.flowFactor * c.referenceRate * concrete.ratePower(strainRate / c.referenceRate);
		else
			return c.flowFactor * strainRate;
	}

	/*! Equivalent stress [Pa] at the end of a step, the root x in [0, trial] of x + relaxation (x/strength)^n_p = trial.
	`trial` ≥ 0 is the equivalent stress of the elastic predictor [Pa]; `relaxation` = h dt A ≥ 0 [Pa], with h = ¼ M_p:C:M_p, is what flow at full
	strength would take off it. Closed for n_p = ½ and 1; otherwise Newton's method on a convex increasing function from the right of its root, which
	descends monotonically and cannot overshoot. */
	inline double solveFlow(const Power& flowPower, double trial, double relaxation, double strength)
	{
		if (flowPower.isHalf()) { // quadratic in √x, root in the form without cancellation
			const double linear = relaxation / std::sqrt(strength);
			const double root   = 2 * trial / (linear + std::sqrt(linear * linear + 4 * trial));
			return root * root;
		}
		if (flowPower.isOne()) return trial / (1 + relaxation / strength);

		// y = x/trial solves y + k y^n = 1; for n < 1 in terms of z = y^n, z^(1/n) + k z = 1, so that the power is above 1 and the function convex
		const double n = flowPower.exponent(), k = relaxation / trial * flowPower(trial / strength);
		if (!(k > 0)) return trial; // no flow, or trial = 0
		const bool   below  = n < 1;
		const double power  = below ? 1 / n : n;
		const double onRoot = below ? k : 1, onPower = below ? 1 : k; // onRoot z + onPower z^power = 1
		double       z = std::min(1 / onRoot, std::pow(onPower, -1 / power));
		for (int iteration = 0; iteration < 200; ++iteration) {
			const double raised = onPower * std::pow(z, power - 1);
			const double next   = z - (onRoot * z + raised * z - 1) / (onRoot + power * raised);
			if (!(next < z)) break; // round-off reached
			z = next;
		}
		return trial * (below ? std::pow(z, power) : z);
	}

} // namespace ddem
} // namespace yade
