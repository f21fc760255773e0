// GPL v2 or later, see LICENSE.
// The parallel bond of Potyondy and Cundall (Int. J. Rock Mech. Min. Sci. 41, 2004), known from PFC.
//
// It breaks in tension where σ = N/A + β |M_b| R/I exceeds σ_c, in shear where τ = |F_s|/A + β |M_t| R/J exceeds
// C - N/A tan φ. Both strengths are free, so that a sample's strength in compression over that in tension is.
// The moment contribution β (Potyondy, 2011) is 1 in the paper of 2004, and 0 where moments shall not break bonds;
// the radius is λ min(r1, r2).
#pragma once

#include <pkg/bonded/kernel/criteria/MohrCoulomb.hpp>

namespace yade::ddem {

#define PARALLEL_BOND_PARAMETERS(P) \
	P(momentContribution, 1, "-", between(0, 1), "Potyondy and Cundall (2004) have 1; 0 leaves moments out.", \
	  "Share :math:`\\beta` of the stress of bending and torsion that counts.") \
	P(radiusFactor, 1, "-", aboveAtMost(0, 1), "Potyondy and Cundall (2004) have 1.", \
	  "Radius of a bond over that of the smaller sphere, :math:`\\lambda`.")

struct ParallelBond {
	static constexpr const char* name = "ParallelBond";

	struct Parameters : MohrCoulomb::Parameters {
		PARALLEL_BOND_PARAMETERS(DDEM_MEMBER)
		DDEM_ENTRIES(Parameters, MohrCoulomb::Parameters, PARALLEL_BOND_PARAMETERS)

		Parameters()
		{
			cohesion          = 100e6;
			tensileStrength   = 30e6;
			bondFrictionAngle = 0;
		}
	};

	template <class Number> struct Strength {
		Number tension;  ///< σ_c [Pa]
		Number cohesion; ///< C [Pa]
		Number friction; ///< tan φ [-]
		Number moments;  ///< β [-]
		static constexpr std::array<const char*, 4> names { "tension", "cohesion", "friction", "moments" };
	};
	template <class Number> using Memory = NoBondMemory<Number>;

	static Strength<double> strengthOf(const Parameters& p, const BondMaking&)
	{
		return { p.tensileStrength, p.cohesion, std::tan(p.bondFrictionAngle), p.momentContribution };
	}
	static Parameters scaled(Parameters p, double factor)
	{
		p.cohesion *= factor;
		p.tensileStrength *= factor;
		return p;
	}
	static Parameters weaker(const Parameters& a, const Parameters& b)
	{
		Parameters result         = lowest(a, b);
		result.momentContribution = std::max(a.momentContribution, b.momentContribution);
		return result;
	}
	static double radius(const Parameters& p, const BondMaking& bond)
	{
		return p.radiusFactor * std::min(bond.radius1, bond.radius2);
	}

	template <class Number>
	static BondAnswerOf<Number> advance(
	        const Strength<Number>& strength, Memory<Number>&, const BondSectionOf<Number>& section,
	        const BondStiffnessOf<Number>&, BondResultantsOf<Number>& load)
	{
		const BondStressOf<Number> stress = bondStress(section, load, strength.moments);
		const Number               mean   = load.force.x / section.area;
		const Number tension = stress.normal - strength.tension,
		             shear   = stress.shear - (strength.cohesion - mean * strength.friction);
		return { stress, select(tension > shear, tension, shear), Number(0.) };
	}

	static BondFailure mode(const Strength<double>& strength, const Memory<double>&, const BondStress& stress)
	{
		return stress.normal > strength.tension ? BondFailure::Tension : BondFailure::Shear;
	}
};

} // namespace yade::ddem
