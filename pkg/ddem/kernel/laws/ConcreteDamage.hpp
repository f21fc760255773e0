// GPL v2 or later, see LICENSE.
// Concrete: viscoplastic Mohr-Coulomb flow, tensorial damage, equation of state (Zubelewicz 2018, section 3). Its parts
// are in concrete/.
#pragma once

#include <pkg/ddem/kernel/laws/concrete/ConcreteLaw.hpp>
#include <pkg/ddem/kernel/triangles/LawGroup.hpp>

namespace yade::ddem {

struct ConcreteDamage : LawDefaults {
	static constexpr const char* name                  = "ConcreteDamage";
	static constexpr unsigned    allEffects            = ConcreteEffects::All;
	static constexpr bool        elasticWithoutEffects = true;

	/// Masks that do the same: without flow there is nothing that a rate could change.
	static constexpr unsigned distinct(unsigned effects)
	{
		return effects & ConcreteEffects::Flow ? effects : effects & ~unsigned(ConcreteEffects::Rate);
	}
	static constexpr bool stiffens(unsigned effects) { return effects & ConcreteEffects::EquationOfState; }
	static constexpr bool damages(unsigned effects) { return effects & ConcreteEffects::Damage; }

	static const std::vector<LawEffect>& effects()
	{
		static const std::vector<LawEffect> all { CONCRETE_EFFECTS(DDEM_LAW_EFFECT) };
		return all;
	}

	/// A rate exponent of 1 is no rate dependence.
	static unsigned effective(const ConcreteParameters& p, unsigned effects)
	{
		return distinct(p.rateExponent == 1 ? effects & ~unsigned(ConcreteEffects::Rate) : effects);
	}

	using Parameters                     = ConcreteParameters;
	using Prepared                       = PreparedConcrete;
	template <class Number> using State  = ConcreteStateOf<Number>;

	template <unsigned effects, class S, class Visit> static void fields(S& s, Visit&& visit)
	{
		constexpr bool flows = effects & ConcreteEffects::Flow, damages = effects & ConcreteEffects::Damage;
		if constexpr (flows || damages) {
			visit.inPlane("strain", "-", s.strain);
			visit.tensor("plasticStrain", "-", s.plasticStrain);
		}
		if constexpr (damages) {
			visit.tensor("damageTensor", "-", s.damage);
			visit.scalar("closure", "-", s.closure);
		}
		if constexpr (effects & ConcreteEffects::EquationOfState) visit.scalar("stiffening", "-", s.stiffening);
		if constexpr (effects & ConcreteEffects::Energy) {
			if constexpr (!flows && !damages) visit.inPlane("strain", "-", s.strain);
			if constexpr (flows) visit.inPlane("lastStrain", "-", s.lastStrain);
			visit.tensor("lastStress", "Pa", s.stress);
			visit.scalar("plasticDissipation", "J/m³", s.plasticDissipation);
			visit.scalar("damageDissipation", "J/m³", s.damageDissipation);
			visit.scalar("stiffeningEnergy", "J/m³", s.stiffeningEnergy);
		}
	}

	template <class Number> struct Properties {
		Number fractureEnergy, bandFactor; ///< G_f [J/m³], and what a crack band multiplies it with
		                                   ///< once flow has localised [-]
	};
	template <unsigned effects, class P, class Visit> static void properties(P& own, Visit&& visit)
	{
		if constexpr ((effects & ConcreteEffects::Flow) && (effects & ConcreteEffects::Damage)) {
			visit("fractureEnergy", "J/m³", own.fractureEnergy);
			visit("bandFactor", "-", own.bandFactor);
		}
	}
	static Properties<double> propertiesOf(const Prepared& law, const TriangleProperties& triangle)
	{
		return { triangle.fractureEnergy > 0 ? triangle.fractureEnergy : law.parameters.fractureEnergy,
			 triangle.bandFactor };
	}
	static State<double> virgin(const Prepared&, const TriangleProperties& triangle)
	{
		State<double> s {};
		s.damage = triangle.initialDamage;
		return s;
	}

	/// Only flow is worth holding: it makes the law three times as dear as all that is left.
	static constexpr bool holds(unsigned effects) { return effects & ConcreteEffects::Flow; }
	template <unsigned effects, class Number>
	static PlaneTensorOf<Number>
	hold(const Prepared& law,
	     const Properties<Number>&,
	     const PlaneTensorOf<Number>& strain,
	     const State<Number>&         s)
	{
		const PlaneTensorOf<Number> elastic = strain - s.plasticStrain;
		PlaneTensorOf<Number>       stress  = elasticStress(law.lambda, law.twoShear, elastic);
		if constexpr (effects & ConcreteEffects::Damage) {
			const auto damaged = doubleDot(s.damage, s.damage) > 0;
			if (any(damaged)) {
				const PlaneTensorOf<Number> degraded = degradedStress(
				        law.lambda,
				        law.twoShear,
				        stiffnessEffect(law, 1 - s.closure),
				        measureDamage(law, s.damage).loss,
				        elastic);
				stress = select(damaged, degraded, stress);
			}
		}
		if constexpr (effects & ConcreteEffects::EquationOfState) return (1 + s.stiffening) * stress;
		else
			return stress;
	}
	template <class Number> static const PlaneTensorOf<Number>& evaluatedStrain(const State<Number>& s)
	{
		return s.strain;
	}
	/// Up to η_0 = patientDamage.
	template <unsigned effects, class Number> static auto flowMayWait(const Prepared& law, const State<Number>& s)
	{
		return doubleDot(s.damage, s.damage) <= law.patientSquare;
	}
	template <unsigned effects, class Number>
	static void bookHeld(const PlaneTensorOf<Number>& strain, const PlaneTensorOf<Number>& stress, State<Number>& s)
	{
		s.lastStrain = strain;
		s.stress     = stress;
	}

	/// Flow is a matter of rates: the strain that was there before it did not come in this step.
	template <unsigned effects> static void beginAt(const PlaneTensor& strain, State<double>& s)
	{
		if constexpr (effects & (ConcreteEffects::Flow | ConcreteEffects::Damage)) s.strain = strain;
	}
	/// The book begins where the law was last evaluated: the stress of then, which the book needs; and the strain,
	/// where only the book does.
	template <unsigned effects>
	static void openBook(const Prepared& law, const PlaneTensor& strain, State<double>& s)
	{
		if constexpr (!(effects & (ConcreteEffects::Flow | ConcreteEffects::Damage))) s.strain = strain;
		s.lastStrain = s.strain;
		s.stress     = hold<effects>(law, Properties<double>(), s.strain, s);
	}

	template <unsigned effects, class Number>
	static PlaneTensorOf<Number> advance(
	        const Prepared&              law,
	        const Properties<Number>&    own,
	        const PlaneTensorOf<Number>& strain,
	        double                       dt,
	        State<Number>&               s)
	{
		const FractureEnergyOf<Number> energy(own.fractureEnergy, own.fractureEnergy * own.bandFactor);
		advanceConcrete<effects>(law, energy, strain, dt, s);
		return s.stress;
	}
	template <unsigned effects, class Number>
	static EnergyDensities<Number> energies(
	        const Prepared&,
	        const PlaneTensorOf<Number>& strain,
	        const PlaneTensorOf<Number>& stress,
	        const State<Number>&         s)
	{
		return { 0.5 * doubleDot(stress, strain - s.plasticStrain) + s.stiffeningEnergy,
			 s.plasticDissipation,
			 s.damageDissipation };
	}
	static double damage(const Prepared& law, const Properties<double>&, const State<double>& s)
	{
		return damageRatio(law, s);
	}
	static double stiffening(const Prepared& law, const State<double>& s) { return stiffnessFactor(law, s); }
};

} // namespace yade::ddem
