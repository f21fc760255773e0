// GPL v2 or later, see LICENSE.
// Metal that yields: J2 plasticity with linear isotropic hardening, integrated by radial return.
//
// σ = C:(ε − ε_p). It yields where the deviator s has |s| = R = √(2/3) (σ_y + H α), along n = s/|s|, so that ε_p has no
// volume; α is the accumulated plastic strain, dα = √(2/3) |dε_p|. From an elastic predictor beyond R the return is
// along its own n,
//
//     Δγ = (|s| − R)/(2μ + 2H/3),  Δε_p = Δγ n,  Δα = √(2/3) Δγ,
//
// which meets the yield surface at the end of the step (Wilkins 1964; Simo and Hughes 1998, box 3.1).
#pragma once

#include <pkg/ddem/kernel/algebra/ElasticModuli.hpp>
#include <pkg/ddem/kernel/triangles/LawGroup.hpp>

#include <cmath>

namespace yade::ddem {

/// P(name, default, unit, bounds, way out, doc string); defaults, with the elasticity, of steel 304L.
#define VON_MISES_PARAMETERS(P) \
	P(yieldStress, 270e6, "Pa", above(0), \
	  "For a metal that does not yield, use an elastic material; steel 304L yields at 270e6 Pa.", \
	  "Stress :math:`\\sigma_y` at which uniaxial tension or compression first yields.") \
	P(hardening, 0, "Pa", atLeast(0), "0 is perfect plasticity; softening would gather in single triangles.", \
	  "Hardening :math:`H=d\\sigma_y/d\\alpha` by the accumulated plastic strain :math:`\\alpha`.")

/// It has no part that could be left out.
#define VON_MISES_EFFECTS(E)

struct VonMises : LawDefaults {
	static constexpr const char* name = "VonMises";

	struct Parameters : ElasticParameters {
		VON_MISES_PARAMETERS(DDEM_MEMBER)
		DDEM_ENTRIES(Parameters, ElasticParameters, VON_MISES_PARAMETERS)

		Parameters()
		{
			bulk    = 151e9;
			shear   = 81e9;
			density = 8030;
		}
	};

	struct Prepared {
		Prepared(const Parameters& p) // NOLINT: parameters are meant to become prepared ones
		        : parameters(p)
		        , lambda(ElasticModuli { p.bulk, p.shear }.lambda())
		        , twoShear(2 * p.shear)
		        , firstRadius(std::sqrt(2. / 3) * p.yieldStress)
		        , radiusSlope(std::sqrt(2. / 3) * p.hardening)
		        , perReturn(1 / (2 * p.shear + 2. / 3 * p.hardening))
		{
			checkParameters(name, Parameters::entries(), &p);
			ElasticModuli { p.bulk, p.shear }.validate();
		}
		Parameters parameters;
		double     lambda, twoShear;         ///< [Pa]
		double     firstRadius, radiusSlope; ///< R = firstRadius + radiusSlope α [Pa]
		double     perReturn;                ///< 1/(2μ + 2H/3) [1/Pa]
	};

	template <class Number> struct State {
		PlaneTensorOf<Number> plasticStrain;            ///< ε_p [-]
		Number                accumulatedPlasticStrain; ///< α [-]
		PlaneTensorOf<Number> strain;                   ///< ε of the step before [-]
		Number plasticDissipation; ///< work of the stress on ε_p, with what hardening keeps of it [J/m³]
	};
	template <unsigned effects, class S, class Visit> static void fields(S& s, Visit&& visit)
	{
		visit.tensor("plasticStrain", "-", s.plasticStrain);
		visit.scalar("accumulatedPlasticStrain", "-", s.accumulatedPlasticStrain);
		if constexpr (effects & LawEffects::Energy) {
			visit.inPlane("strain", "-", s.strain);
			visit.scalar("plasticDissipation", "J/m³", s.plasticDissipation);
		}
	}
	static State<double> virgin(const Prepared&, const TriangleProperties&) { return {}; }

	static constexpr bool hasThreshold(unsigned) { return true; }
	/// Where |s| may be above R; in plane strain (|s|/2μ)² = ε:ε − (tr ε)²/3. A touch early, so that rounding does
	/// not matter.
	template <unsigned effects, class Number>
	static auto beyondThreshold(const Prepared& law, const Properties<Number>&, const PlaneTensorOf<Number>& strain)
	{
		const double first = (1 - 1e-12) * law.firstRadius / law.twoShear;
		const Number sum   = strain.xx + strain.yy;
		const Number whole = strain.xx * strain.xx + strain.yy * strain.yy + 2 * (strain.xy * strain.xy);
		return !(whole - (1. / 3) * (sum * sum) < first * first); // NaN is beyond
	}

	template <unsigned effects, class Number>
	static PlaneTensorOf<Number>
	advance(const Prepared& law,
	        const Properties<Number>&,
	        const PlaneTensorOf<Number>& strain,
	        double,
	        State<Number>& s)
	{
		const PlaneTensorOf<Number> before = s.plasticStrain;
		PlaneTensorOf<Number>       stress = elasticStress(law.lambda, law.twoShear, strain - before);
		const Number                mean   = (1. / 3) * trace(stress);
		const PlaneTensorOf<Number> deviator {
			stress.xx - mean, stress.yy - mean, stress.zz - mean, stress.xy
		};
		const Number length = norm(deviator),
		             radius = law.firstRadius + law.radiusSlope * s.accumulatedPlasticStrain;
		const auto yields   = length > radius;
		if (any(yields)) {
			const Number amount = select(yields, law.perReturn * (length - radius), Number(0.)); // Δγ
			const PlaneTensorOf<Number> flow = select(yields, amount / length, Number(0.)) * deviator;
			s.plasticStrain                  = before + flow;
			s.accumulatedPlasticStrain       = s.accumulatedPlasticStrain + std::sqrt(2. / 3) * amount;

			const PlaneTensorOf<Number> returned
			        = elasticStress(law.lambda, law.twoShear, strain - s.plasticStrain);
			if constexpr (effects & LawEffects::Energy) {
				const auto old       = elasticStress(law.lambda, law.twoShear, s.strain - before);
				s.plasticDissipation = s.plasticDissipation + 0.5 * doubleDot(old + returned, flow);
			}
			stress = returned;
		}
		if constexpr (effects & LawEffects::Energy) s.strain = strain;
		return stress;
	}
	template <unsigned effects> static void openBook(const Prepared&, const PlaneTensor& strain, State<double>& s)
	{
		s.strain = strain;
	}
	template <unsigned effects, class Number>
	static EnergyDensities<Number> energies(
	        const Prepared&,
	        const PlaneTensorOf<Number>& strain,
	        const PlaneTensorOf<Number>& stress,
	        const State<Number>&         s)
	{
		return { 0.5 * doubleDot(stress, strain - s.plasticStrain), s.plasticDissipation, Number(0.) };
	}
};

} // namespace yade::ddem
