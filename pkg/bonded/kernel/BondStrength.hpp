// GPL v2 or later, see LICENSE.
// When a bond breaks: Mohr-Coulomb failure of its cross-section.
#pragma once

#include <pkg/bonded/kernel/BondLaw.hpp>

#include <algorithm>
#include <limits>

namespace yade::ddem {

/// Strength of the cement: shear strength C - σ tan φ (tension positive;
/// eq. 8 of the report with σ_N = -σ) and a limit in tension.
struct MohrCoulomb {
	double cohesion;                                                  ///< C [Pa]
	double frictionCoefficient;                                       ///< tan φ [-]
	/// cut-off below the apex C/tan φ of the envelope [Pa]
	double tensileStrength = std::numeric_limits<double>::infinity();
	/// largest σ the bond can bear [Pa]
	double tensionLimit() const { return std::min(tensileStrength, cohesion / frictionCoefficient); }
};

/// Largest stresses at the rim of the cross-section in the middle of the bond.
template <class Number> struct BondStressOf {
	Number normal; ///< σ = N/A + |M_b| R/I [Pa], tension positive; bending always adds tension somewhere on the rim
	Number shear;  ///< τ = |F_s|/A + |M_t| R/J [Pa]
};
using BondStress = BondStressOf<double>;

/// How a bond broke.
enum class BondFailure {
	None,
	Tension, ///< σ passed the tension limit, or used up more of the envelope than τ did: σ tan φ > τ
	Shear
};

template <class Number>
inline BondStressOf<Number> bondStress(const BondSectionOf<Number>& section, const BondResultantsOf<Number>& load)
{
	using std::abs;
	using std::sqrt;
	const Number bending = sqrt(load.moment.y * load.moment.y + load.moment.z * load.moment.z),
	             shear   = sqrt(load.force.y * load.force.y + load.force.z * load.force.z);
	return { load.force.x / section.area + bending / section.bendingModulus,
		 shear / section.area + abs(load.moment.x) / section.torsionModulus };
}

/// How far a bond is beyond its strength [Pa]; it breaks above zero. There is no limit in pure compression,
/// as in ESyS-Particle.
template <class Number>
inline Number bondOverload(
        const Number& cohesion, const Number& frictionCoefficient, const Number& tensionLimit,
        const BondStressOf<Number>& stress)
{
	const Number tension = stress.normal - tensionLimit,
	             shear = stress.shear - (cohesion - stress.normal * frictionCoefficient);
	return select(tension > shear, tension, shear);
}

/// The mode of a bond that breaks. Both criteria meet at the apex, so without a lower cut-off
/// the larger share names it.
inline BondFailure failureMode(const MohrCoulomb& strength, const BondStress& stress)
{
	return stress.normal > strength.tensionLimit() || stress.normal * strength.frictionCoefficient > stress.shear
	        ? BondFailure::Tension
	        : BondFailure::Shear;
}

inline BondFailure bondFailure(const MohrCoulomb& strength, const BondStress& stress)
{
	return bondOverload(strength.cohesion, strength.frictionCoefficient, strength.tensionLimit(), stress) > 0
	        ? failureMode(strength, stress)
	        : BondFailure::None;
}

} // namespace yade::ddem
