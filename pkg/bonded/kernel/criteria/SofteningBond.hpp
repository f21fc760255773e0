// GPL v2 or later, see LICENSE.
// A bond that softens over stated energies per area instead of breaking at once.
//
// Up to the envelope of MohrCoulomb the bond is elastic. How far elastic stresses (those without damage) are beyond it,
//
//     λ_t = σ/σ_t,   λ_s = (τ + ⟨σ⟩ tan φ)/(C + ⟨-σ⟩ tan φ),
//
// with the largest values so far, gives a damage D_i = (1 - 1/λ_i) λ_u/(λ_u - 1) each, and the larger of them scales
// all loads by 1 - D, but a normal force in compression. In pure tension (shear) stress then falls along a straight
// line with the separation, from the strength at λ = 1 to zero at λ_u = 2 G E/(σ_t² d0) (2 G_II G/(C² d0)), where the
// bond is gone: it has taken the energy G A. Where a bond stores more than that at its strength it would snap back;
// such bonds are refused. The damaged bond is elastic with a potential of its own, (1 - D) U, so D alone dissipates:
// ψ dD >= 0. (Scalar damage with a secant stiffness, as cohesive elements have it: Camanho and Dávila, NASA/TM-2002-
// 211737.) Bending alone takes a quarter of G A, as its stress is largest at the rim only.
#pragma once

#include <pkg/bonded/kernel/criteria/MohrCoulomb.hpp>

#include <sstream>

namespace yade::ddem {

#define SOFTENING_BOND_PARAMETERS(P) \
	P(tensionEnergy, 100, "J/m²", above(0), "Concrete has about 100 J/m², rock 10 to 200.", \
	  "Energy per area :math:`G_I` that a bond takes in tension.") \
	P(shearEnergy, 1000, "J/m²", above(0), "Usually several times that in tension.", \
	  "Energy per area :math:`G_{II}` that a bond takes in shear without normal stress.")

struct SofteningBond {
	static constexpr const char* name = "SofteningBond";

	struct Parameters : MohrCoulomb::Parameters {
		SOFTENING_BOND_PARAMETERS(DDEM_MEMBER)
		DDEM_ENTRIES(Parameters, MohrCoulomb::Parameters, SOFTENING_BOND_PARAMETERS)

		Parameters()
		{
			cohesion        = 20e6;
			tensileStrength = 10e6;
			bondFrictionAngle = M_PI / 6;
		}
	};

	template <class Number> struct Strength {
		Number cohesion;        ///< C [Pa]
		Number friction;        ///< tan φ [-]
		Number tensionLimit;    ///< σ_t [Pa]
		Number tensionDuctility; ///< λ_u in tension [-]
		Number shearDuctility;   ///< λ_u in shear [-]
		static constexpr std::array<const char*, 5> names {
			"cohesion", "friction", "tensionLimit", "tensionDuctility", "shearDuctility"
		};
	};
	template <class Number> struct Memory {
		Number tension; ///< largest λ_t [-]
		Number shear;   ///< largest λ_s [-]
		Number driving; ///< ψ of the last step [J]
		Number lost;    ///< energy that damage has taken [J]
		static constexpr std::array<const char*, 4> names { "tension", "shear", "driving", "lost" };
	};

	/// \throws std::invalid_argument for a bond that stores more than it may take
	static Strength<double> strengthOf(const Parameters& p, const BondMaking& bond)
	{
		const double limit   = p.tensionLimit();
		const double tension = ductility("tensionEnergy", p.tensionEnergy, bond.elasticity.young, limit, bond),
		             shear = ductility("shearEnergy", p.shearEnergy, bond.elasticity.shear(), p.cohesion, bond);
		return { p.cohesion, std::tan(p.bondFrictionAngle), limit, tension, shear };
	}
	/// Separations stay as they are: energies follow strengths.
	static Parameters scaled(Parameters p, double factor)
	{
		for (double* value : { &p.cohesion, &p.tensileStrength, &p.tensionEnergy, &p.shearEnergy })
			*value *= factor;
		return p;
	}
	static Parameters weaker(const Parameters& a, const Parameters& b) { return lowest(a, b); }
	static double radius(const Parameters&, const BondMaking& bond) { return 0.5 * bond.length; }

	/// Above 1 once the bond is gone.
	template <class Number> static Number damageOf(const Number& share, const Number& ductility)
	{
		return select(
		        share > Number(1.), ductility / (ductility - 1.) * (1. - 1. / share), Number(0.));
	}
	template <class Number> static Number damageOf(const Strength<Number>& strength, const Memory<Number>& memory)
	{
		const Number tension = damageOf(memory.tension, strength.tensionDuctility),
		             shear   = damageOf(memory.shear, strength.shearDuctility);
		return select(tension > shear, tension, shear);
	}

	template <class Number>
	static BondAnswerOf<Number> advance(
	        const Strength<Number>& strength, Memory<Number>& memory, const BondSectionOf<Number>& section,
	        const BondStiffnessOf<Number>& stiffness, BondResultantsOf<Number>& load)
	{
		const Number               zero(0.), one(1.);
		const BondStressOf<Number> elastic = bondStress(section, load);
		const Number pull = select(elastic.normal > zero, elastic.normal, zero), press = pull - elastic.normal;
		const Number tension = pull / strength.tensionLimit,
		             shear   = (elastic.shear + pull * strength.friction)
		        / (strength.cohesion + press * strength.friction);
		const auto squareOver = [](const Number& a, const Number& k) { return a * a / k; };
		const Number pulling = select(load.force.x > zero, load.force.x, zero);
		const Number driving = 0.5
		        * (squareOver(pulling, stiffness.normal)
		           + (load.force.y * load.force.y + load.force.z * load.force.z) / stiffness.shear
		           + squareOver(load.moment.x, stiffness.torsion)
		           + (load.moment.y * load.moment.y + load.moment.z * load.moment.z) / stiffness.bending);

		const auto   clipped = [&](const Number& damage) { return select(damage > one, one, damage); };
		const Number before  = clipped(damageOf(strength, memory));
		memory.tension       = select(tension > memory.tension, tension, memory.tension);
		memory.shear         = select(shear > memory.shear, shear, memory.shear);
		const Number damage = damageOf(strength, memory), after = clipped(damage), left = one - after;
		// leapfrog's work between two steps is the mean of their loads times the motion
		const Number lost = (after - before) * 0.5 * (driving + memory.driving);
		memory.lost       = memory.lost + lost;
		memory.driving    = driving;

		load.force.x = select(load.force.x > zero, left * load.force.x, load.force.x);
		load.force.y = left * load.force.y;
		load.force.z = left * load.force.z;
		load.moment  = left * load.moment;
		// comparisons above drop what is not a number; the sum keeps it
		return { bondStress(section, load), damage - one + 0. * (elastic.normal + elastic.shear), lost };
	}

	static BondFailure mode(const Strength<double>& strength, const Memory<double>& memory, const BondStress&)
	{
		return damageOf(memory.tension, strength.tensionDuctility)
		                >= damageOf(memory.shear, strength.shearDuctility)
		        ? BondFailure::Tension
		        : BondFailure::Shear;
	}

private:
	static double
	ductility(const char* energy, double given, double modulus, double stress, const BondMaking& bond)
	{
		if (!std::isfinite(stress))
			throw std::invalid_argument(
			        "SofteningBond: without bondFrictionAngle the tensileStrength must be finite: "
			        "such a bond would never break in tension");
		const double stored = 0.5 * stress * stress * bond.length / modulus; // per area, at its strength
		if (given > 1.001 * stored) return given / stored;
		std::ostringstream text;
		text << "SofteningBond: " << energy << " = " << given << " J/m² is not above the " << stored
		     << " J/m² that a bond of " << bond.length << " m stores at its strength of " << stress
		     << " Pa, so it would break at once: use more energy, less strength, or a brittle material";
		throw std::invalid_argument(text.str());
	}
};

} // namespace yade::ddem
