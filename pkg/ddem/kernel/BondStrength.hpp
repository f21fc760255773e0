// GPL v2 or later, see LICENSE.
// When a bond breaks: Mohr-Coulomb failure of its cross-section.
#pragma once

#include <pkg/ddem/kernel/BondLaw.hpp>

#include <limits>

namespace yade::ddem {

/// Strength of the cement: shear strength C - σ tan φ (tension positive; eq. 8 of the report with σ_N = -σ) and a limit in tension.
struct MohrCoulomb {
	double cohesion;                                                  ///< C [Pa]
	double frictionCoefficient;                                       ///< tan φ [-]
	double tensileStrength = std::numeric_limits<double>::infinity(); ///< cut-off below the apex C/tan φ of the envelope [Pa]
	double tensionLimit() const { return std::min(tensileStrength, cohesion / frictionCoefficient); } ///< largest σ the bond can bear [Pa]
};

/// Largest stresses at the rim of the cross-section in the middle of the bond.
struct BondStress {
	double normal; ///< σ = N/A + |M_b| R/I [Pa], tension positive; bending always adds tension somewhere on the rim
	double shear;  ///< τ = |F_s|/A + |M_t| R/J [Pa]
};

/// How a bond broke.
enum class BondFailure {
	None,
	Tension, ///< σ passed the tension limit, or used up more of the envelope than τ did: σ tan φ > τ
	Shear
};

inline BondStress bondStress(const BondSection& section, const BondResultants& load)
{
	const double bending = load.moment.tail<2>().norm(), shear = load.force.tail<2>().norm();
	return { load.force.x() / section.area + bending / section.bendingModulus, shear / section.area + std::abs(load.moment.x()) / section.torsionModulus };
}

/// There is no limit in pure compression, as in ESyS-Particle. Both criteria meet at the apex, so without a lower cut-off the larger share names the mode.
inline BondFailure bondFailure(const MohrCoulomb& strength, const BondStress& stress)
{
	if (stress.normal > strength.tensionLimit()) return BondFailure::Tension;
	const double tensionShare = stress.normal * strength.frictionCoefficient;
	if (stress.shear > strength.cohesion - tensionShare) return tensionShare > stress.shear ? BondFailure::Tension : BondFailure::Shear;
	return BondFailure::None;
}

} // namespace yade::ddem
