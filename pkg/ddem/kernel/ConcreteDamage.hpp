// GPL v2 or later, see LICENSE.
// Damage of concrete: damage parameter, strength, closing cracks and the degraded elasticity.
#pragma once

#include <pkg/ddem/kernel/ConcreteParameters.hpp>
#include <pkg/ddem/kernel/ElasticLaw.hpp>
#include <pkg/ddem/kernel/PlaneTensor.hpp>

#include <algorithm>

namespace yade {
namespace ddem {

	/*! What a damage tensor Ω means: its unit direction N_Ω = Ω/Ω_D (zero while there is no damage) and the integrity 1 − η_0. */
	struct DamageMeasure {
		PlaneTensor direction;
		double      integrity; //!< 1 − η_0 = 1/(1 + Ω_D^n_f) [-], at least ConcreteParameters::residual
		bool        any;       //!< Ω ≠ 0
	};

	inline DamageMeasure measureDamage(const PreparedConcrete& concrete, const PlaneTensor& damage)
	{
		const double size = norm(damage);
		if (!(size > 0)) return { { 0, 0, 0, 0 }, 1, false };
		return { (1 / size) * damage, std::max(1 / (1 + concrete.damagePower(size)), concrete.parameters.residual), true };
	}

	//! σ_p = σ_p0 (1 − η_0) [Pa]
	inline double damagedStrength(const PreparedConcrete& concrete, const DamageMeasure& damage) { return concrete.parameters.strength * damage.integrity; }

	//! η = η_max ξ_c1 η_0 [-]; `openness` from 0 (crack closed) to 1 (open)
	inline double stiffnessLoss(const PreparedConcrete& concrete, const DamageMeasure& damage, double openness)
	{
		const ConcreteParameters& c = concrete.parameters;
		return c.damageLimit * (1 - damage.integrity) * (c.closedEffect + (1 - c.closedEffect) * openness);
	}

	//! Growth of Ω [-] when a work `work` = σ_eq ė_eq dt [J/m³] is done: ½ M_c ξ_c0 σ_eq ė_eq dt/G_f, Zubelewicz (2018), eq. 8
	inline PlaneTensor damageGrowth(const PreparedConcrete& concrete, double fractureEnergy, const PlaneTensor& damageTensor, double openness, double work)
	{
		const ConcreteParameters& c      = concrete.parameters;
		const double              effect = c.closedGrowth + (1 - c.closedGrowth) * openness;
		return (0.5 * effect * work / std::max(concrete.smallestEnergy, fractureEnergy)) * damageTensor; // this order of max ignores a NaN
	}

	/*! Degraded stress σ = λ Δ (Δ:ε) + 2μ Δ.ε.Δ with Δ = 1 − η N: a quadratic polynomial in η. Keeping it as one makes the stress cheap for any η, which the
	crack closure asks for before η is known. */
	struct DegradedStress {
		PlaneTensor constant, linear, quadratic; // [Pa]

		PlaneTensor at(double eta) const { return constant + eta * (linear + eta * quadratic); }
	};

	inline DegradedStress degradedStress(double lambda, double twoShear, const PlaneTensor& direction, const PlaneTensor& strain)
	{
		const double      along = doubleDot(direction, strain), volumetric = trace(strain);
		const double      l     = lambda * along;
		const PlaneTensor cross = symmetricProduct(direction, strain);
		return { elasticStress(lambda, twoShear, strain),
			 PlaneTensor { -l, -l, -l, 0 } - (lambda * volumetric) * direction - (2 * twoShear) * cross,
			 l * direction + twoShear * sandwich(direction, strain) };
	}

	//! M:C:M [Pa] of the degraded elasticity, the stiffness against flow along M
	inline double degradedStiffnessAlong(double lambda, double twoShear, double eta, const PlaneTensor& direction, const PlaneTensor& m)
	{
		const PlaneTensor delta = { 1 - eta * direction.xx, 1 - eta * direction.yy, 1 - eta * direction.zz, -eta * direction.xy };
		const double      along = doubleDot(delta, m);
		return lambda * along * along + twoShear * doubleDot(m, sandwich(delta, m));
	}

	/*! How open the crack is, from 0 (closed: σ_Ω < 0) to 1 (open: σ_Ω ≥ 0), where σ_Ω = N_Ω:σ is the crack-normal stress; Zubelewicz (2018), section 3.
	σ_Ω depends on the openness, because an open crack is the softer one. So the openness is solved for: `closed`, `middle`, `open` are σ_Ω [Pa] with the
	openness 0, ½, 1 (σ_Ω is quadratic in it).
	- One state agrees with its own σ_Ω: that one.
	- Neither does (lateral compression shuts the crack when it is soft, and not when it is stiff): the crack faces touch without stress, σ_Ω = 0. A plain
	  switch would flip at every step here.
	- Both do: it stays what it was (`wasOpen`).
	With `band` > 0 [Pa] the openness falls linearly from 1 at σ_Ω = 0 to 0 at σ_Ω = −band. */
	inline double crackOpenness(double closed, double middle, double open, double band, bool wasOpen)
	{
		const bool canOpen = open >= 0, canClose = closed < -band;
		if (canOpen && (wasOpen || !canClose)) return 1;
		if (canClose) return 0;
		// closed ≥ −band and open < 0: one root in [0, 1] of constant + linear o + quadratic o², which falls from ≥ 0 to < 0
		const double constant  = closed + band;
		const double quadratic = 2 * (open + closed) - 4 * middle;
		const double linear    = open - closed - quadratic - band;
		const double root      = std::sqrt(std::max(0., linear * linear - 4 * quadratic * constant));
		const double openness  = 2 * constant / (root - linear); // the falling branch; never divides by zero because constant + linear + quadratic < 0
		return std::min(1., std::max(0., openness));
	}

} // namespace ddem
} // namespace yade
