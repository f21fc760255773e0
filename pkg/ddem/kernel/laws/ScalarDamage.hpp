// GPL v2 or later, see LICENSE.
// Isotropic damage: Mazars' equivalent strain, exponential softening, crack band.
//
// σ = (1 − d) C:ε, d = d(κ), where κ is the largest equivalent strain so far, ε̃ = √(Σ⟨ε_i⟩²) over the principal
// strains (Mazars 1984), and
//
//     1 − d = κ_0/κ exp(−(κ − κ_0)/κ_s)   for κ > κ_0 = f_t/E, else 1
//
// (Peerlings et al. 1998 with α = 1, β = 1/κ_s). In uniaxial stress ε̃ is the strain, and σ = f_t exp(−(κ − κ_0)/κ_s)
// takes f_t (κ_0/2 + κ_s) per volume. A crack opens in one row of triangles, of width h; that it takes the fracture
// energy G_F per area gives κ_s = G_F/(h f_t) − κ_0/2 (crack band; Bažant and Oh 1983). h = √(2 S) for a linear
// triangle of area S (Rots 1988): the height of a row of right-angled ones.
#pragma once

#include <pkg/ddem/kernel/algebra/ElasticModuli.hpp>
#include <pkg/ddem/kernel/triangles/LawGroup.hpp>

#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace yade::ddem {

/// P(name, default, unit, bounds, way out, doc string); defaults of an ordinary concrete.
#define SCALAR_DAMAGE_PARAMETERS(P) \
	P(tensileStrength, 3e6, "Pa", above(0), \
	  "Concrete has 2e6 to 5e6 Pa; for a material that does not break, use an elastic one.", \
	  "Strength :math:`f_t` in uniaxial tension.") \
	P(fractureEnergy, 100, "J/m²", above(0), "It is an energy per area of crack; concrete has about 100 J/m².", \
	  "Fracture energy :math:`G_F` per area of crack; :yref:`DeformableTriangle.fractureEnergy`, here in J/m², " \
	  "overrides it for one triangle.") \
	P(residual, 1e-9, "-", strictlyBetween(0, 1), "It is a share of the initial stiffness, 1e-9 or so.", \
	  "Share of the stiffness that no damage takes.")

/// It has no part that could be left out.
#define SCALAR_DAMAGE_EFFECTS(E)

/// Mazars' equivalent strain √(Σ⟨ε_i⟩²) [-]. zz is a principal strain, the other two follow from Mohr's circle.
template <class Number> inline Number mazarsStrain(const PlaneTensorOf<Number>& strain)
{
	using std::max;
	using std::sqrt;
	const Number zero(0.), mean = 0.5 * (strain.xx + strain.yy), half = 0.5 * (strain.xx - strain.yy);
	const Number radius = sqrt(half * half + strain.xy * strain.xy);
	const Number first = max(mean + radius, zero), second = max(mean - radius, zero), out = max(strain.zz, zero);
	return sqrt(first * first + second * second + out * out);
}

struct ScalarDamage : LawDefaults {
	static constexpr const char* name = "ScalarDamage";
	static constexpr bool        damages(unsigned) { return true; }

	struct Parameters : ElasticParameters {
		SCALAR_DAMAGE_PARAMETERS(DDEM_MEMBER)
		DDEM_ENTRIES(Parameters, ElasticParameters, SCALAR_DAMAGE_PARAMETERS)

		Parameters()
		{
			bulk  = 16.7e9; // with these E = 30 GPa, ν = 0.2
			shear = 12.5e9;
		}
	};

	struct Prepared {
		Prepared(const Parameters& p) // NOLINT: parameters are meant to become prepared ones
		        : parameters(p)
		        , lambda(ElasticModuli { p.bulk, p.shear }.lambda())
		        , twoShear(2 * p.shear)
		        , firstStrain(p.tensileStrength / ElasticModuli { p.bulk, p.shear }.young())
		{
			checkParameters(name, Parameters::entries(), &p);
			ElasticModuli { p.bulk, p.shear }.validate();
		}
		Parameters parameters;
		double     lambda, twoShear; ///< [Pa]
		double     firstStrain;      ///< κ_0, from which damage grows [-]
	};

	template <class Number> struct State {
		Number                largestStrain;     ///< κ [-]; zero until κ_0 is passed
		PlaneTensorOf<Number> strain;            ///< ε of the step before [-]
		Number                damageDissipation; ///< elastic energy that damage has released [J/m³]
	};
	template <unsigned effects, class S, class Visit> static void fields(S& s, Visit&& visit)
	{
		visit.scalar("largestStrain", "-", s.largestStrain);
		if constexpr (effects & LawEffects::Energy) {
			visit.inPlane("strain", "-", s.strain);
			visit.scalar("damageDissipation", "J/m³", s.damageDissipation);
		}
	}
	/// \throws std::invalid_argument for damage that is there at the start, which as a tensor is not this law's.
	static State<double> virgin(const Prepared&, const TriangleProperties& triangle)
	{
		if (norm(triangle.initialDamage) > 0)
			throw std::invalid_argument(
			        std::string(name) + ": initialDamage = " + std::to_string(norm(triangle.initialDamage))
			        + " [-] (its norm) must be zero: this law's damage is a number, not a tensor. For weak "
			          "places give "
			          "triangles a fractureEnergy of their own, or a material of less tensileStrength.");
		return {};
	}

	template <class Number> struct Properties {
		Number softeningStrain; ///< κ_s [-]
		Number fractureEnergy;  ///< G_F [J/m²], only to be read
	};
	template <unsigned effects, class P, class Visit> static void properties(P& own, Visit&& visit)
	{
		visit("softeningStrain", "-", own.softeningStrain);
		visit("fractureEnergy", "J/m²", own.fractureEnergy);
	}
	/// A triangle without area is a point of a crack of no width, which keeps its strength.
	/// \throws std::invalid_argument for a triangle so large that even a drop to zero stress would take more than
	/// its fracture energy, and for a band factor.
	static Properties<double> propertiesOf(const Prepared& law, const TriangleProperties& triangle)
	{
		const Parameters& p = law.parameters;
		if (triangle.bandFactor != 1) // NaN too
			throw std::invalid_argument(
			        std::string(name) + ": bandFactor = " + std::to_string(triangle.bandFactor)
			        + " [-] must be 1: this law makes its crack band from the area of the triangle; leave "
			          "crack_band out.");
		const double energy = triangle.fractureEnergy > 0 ? triangle.fractureEnergy : p.fractureEnergy;
		if (triangle.area == 0) return { std::numeric_limits<double>::infinity(), energy };
		const double width  = std::sqrt(2 * triangle.area);
		const double strain = energy / (width * p.tensileStrength) - 0.5 * law.firstStrain;
		if (strain > 0) return { strain, energy };
		std::ostringstream text;
		text << name << ": a triangle of area " << triangle.area << " m² is a crack band " << width
		     << " m wide, which stores " << 0.5 * p.tensileStrength * law.firstStrain * width
		     << " J/m² at its tensileStrength of " << p.tensileStrength
		     << " Pa, more than its fracture energy of " << energy
		     << " J/m²: stress would have to snap back. Keep √(2·area) below "
		     << 2 * energy / (p.tensileStrength * law.firstStrain)
		     << " m, well below for a crack that softens in steps.";
		throw std::invalid_argument(text.str());
	}

	static constexpr bool hasThreshold(unsigned) { return true; }
	/// Where ε̃ may be above κ_0, without a root: with mean m and radius r of Mohr's circle, ε̃² = 2 (m² + r²)
	/// where both principal strains are positive, m > r, and else ε̃ = m + r > κ_0 where r > κ_0 − m. A touch
	/// early, so that rounding does not matter.
	template <unsigned effects, class Number>
	static auto beyondThreshold(const Prepared& law, const Properties<Number>&, const PlaneTensorOf<Number>& strain)
	{
		using std::max;
		const double first = 2 * (1 - 1e-12) * law.firstStrain; // of the circle's diameter, as all below
		const Number sum = strain.xx + strain.yy, difference = strain.xx - strain.yy, shear = 2 * strain.xy;
		const Number square  = difference * difference + shear * shear;
		const Number tension = max(sum, Number(0.)), left = max(first - sum, Number(0.));
		const Number tensionSquare = tension * tension;
		return (tensionSquare > square && tensionSquare + square > 0.5 * first * first)
		        || !(square < left * left); // NaN is beyond
	}

	/// 1 − d [-]
	template <class Number>
	static Number integrity(const Prepared& law, const Properties<Number>& own, const Number& largestStrain)
	{
		using std::exp;
		using std::max;
		const Number first(law.firstStrain);
		const Number left = first / largestStrain * exp((first - largestStrain) / own.softeningStrain);
		return select(largestStrain > first, max(left, Number(law.parameters.residual)), Number(1.));
	}

	template <unsigned effects, class Number>
	static PlaneTensorOf<Number>
	advance(const Prepared&              law,
	        const Properties<Number>&    own,
	        const PlaneTensorOf<Number>& strain,
	        double,
	        State<Number>& s)
	{
		using std::max;
		const PlaneTensorOf<Number> elastic = elasticStress(law.lambda, law.twoShear, strain);
		const Number                before = s.largestStrain, here = mazarsStrain(strain);
		const Number                first  = Number(law.firstStrain);
		// nothing is remembered below κ_0, which may be another one after a change of parameters
		const Number now = select(here > max(before, first), here, before);
		Number                      left(1.);
		if (any(now > law.firstStrain)) {
			left = integrity(law, own, now);
			if constexpr (effects & LawEffects::Energy) {
				// ½(σ_old + σ_new):Δε = Δ(½σ:ε) + ½ (d_new − d_old) ε_old:C:ε_new, whatever the step
				const Number released = integrity(law, own, before) - left;
				s.damageDissipation
				        = s.damageDissipation + 0.5 * released * doubleDot(s.strain, elastic);
			}
		}
		s.largestStrain = now;
		if constexpr (effects & LawEffects::Energy) s.strain = strain;
		return left * elastic;
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
		return { 0.5 * doubleDot(stress, strain), Number(0.), s.damageDissipation };
	}
	static double damage(const Prepared& law, const Properties<double>& own, const State<double>& s)
	{
		return 1 - integrity(law, own, s.largestStrain);
	}
};

} // namespace yade::ddem
