// GPL v2 or later, see LICENSE.
// Mohr-Coulomb failure of a bond's cross-section, at once and for good (eq. 8 of the report;
// ESyS-Particle's BrittleBeam).
//
// Shear strength is C - σ tan φ (tension positive; the report's σ_N is -σ), with a limit in tension: the cut-off,
// or the apex C/tan φ of the envelope where that is lower. There is no limit in pure compression.
#pragma once

#include <pkg/bonded/kernel/BondCriterion.hpp>

#include <algorithm>
#include <limits>

namespace yade::ddem {

/// P(name, default, unit, bounds, way out, doc string); defaults of ESyS-Particle's tutorial.
#define MOHR_COULOMB_PARAMETERS(P) \
	P(cohesion, 100e6, "Pa", above(0), "Rock has 1e6 to 2e8 Pa between its grains.", \
	  "Shear strength :math:`C` of a bond without normal stress.") \
	P(bondFrictionAngle, M_PI / 4, "rad", fromBelow(0, M_PI / 2), "Given in degrees? Use radians(…).", \
	  "Angle of internal friction :math:`\\varphi` of bonds.") \
	P(tensileStrength, std::numeric_limits<double>::infinity(), "Pa", aboveOrInfinite(0), \
	  "Infinite, the default: the cut-off is cohesion/tan(bondFrictionAngle).", \
	  "Tension cut-off of bonds; above :math:`C/\\tan\\varphi` it has no effect.")

struct MohrCoulomb {
	static constexpr const char* name = "MohrCoulomb";

	struct Parameters : NoParameters {
		MOHR_COULOMB_PARAMETERS(DDEM_MEMBER)
		DDEM_ENTRIES(Parameters, NoParameters, MOHR_COULOMB_PARAMETERS)

		double tensionLimit() const
		{
			return std::min(tensileStrength, cohesion / std::tan(bondFrictionAngle));
		}
	};

	/// What a bond keeps of them.
	template <class Number> struct Strength {
		Number cohesion;     ///< C [Pa]
		Number friction;     ///< tan φ [-]
		Number tensionLimit; ///< largest σ that the bond can bear [Pa]
		static constexpr std::array<const char*, 3> names { "cohesion", "friction", "tensionLimit" };
	};
	template <class Number> using Memory = NoBondMemory<Number>;

	static Strength<double> strengthOf(const Parameters& p, const BondMaking&)
	{
		return { p.cohesion, std::tan(p.bondFrictionAngle), p.tensionLimit() };
	}
	static Parameters scaled(Parameters p, double factor)
	{
		p.cohesion *= factor;
		p.tensileStrength *= factor;
		return p;
	}
	static Parameters weaker(const Parameters& a, const Parameters& b) { return lowest(a, b); }
	static double radius(const Parameters&, const BondMaking& bond) { return 0.5 * bond.length; }

	/// How far a bond is beyond its strength [Pa]; it breaks above zero.
	template <class Number>
	static Number overload(const Strength<Number>& strength, const BondStressOf<Number>& stress)
	{
		const Number tension = stress.normal - strength.tensionLimit,
		             shear   = stress.shear - (strength.cohesion - stress.normal * strength.friction);
		return select(tension > shear, tension, shear);
	}
	template <class Number>
	static BondAnswerOf<Number> advance(
	        const Strength<Number>& strength, Memory<Number>&, const BondSectionOf<Number>& section,
	        const BondStiffnessOf<Number>&, BondResultantsOf<Number>& load)
	{
		const BondStressOf<Number> stress = bondStress(section, load);
		return { stress, overload(strength, stress), Number(0.) };
	}

	/// The envelope and the limit in tension meet at the apex, so without a lower cut-off the larger share of the
	/// envelope names the mode.
	static BondFailure mode(const Strength<double>& strength, const Memory<double>&, const BondStress& stress)
	{
		return stress.normal > strength.tensionLimit || stress.normal * strength.friction > stress.shear
		        ? BondFailure::Tension
		        : BondFailure::Shear;
	}
};

} // namespace yade::ddem
