// GPL v2 or later, see LICENSE.
// Stresses of a bond's cross-section, and how a bond may break.
#pragma once

#include <pkg/bonded/kernel/BondLaw.hpp>

namespace yade::ddem {

/// Largest stresses at the rim of the cross-section in the middle of the bond.
template <class Number> struct BondStressOf {
	Number normal; ///< σ = N/A + |M_b| R/I [Pa], tension positive; bending always adds tension somewhere on the rim
	Number shear;  ///< τ = |F_s|/A + |M_t| R/J [Pa]
};
using BondStress = BondStressOf<double>;

/// How a bond broke.
enum class BondFailure { None, Tension, Shear };

/// \param share of the moments' stresses that counts [-]
template <class Number>
inline BondStressOf<Number> bondStress(
        const BondSectionOf<Number>& section, const BondResultantsOf<Number>& load,
        const Number& share = Number(1.))
{
	using std::abs;
	using std::sqrt;
	const Number bending = sqrt(load.moment.y * load.moment.y + load.moment.z * load.moment.z),
	             shear   = sqrt(load.force.y * load.force.y + load.force.z * load.force.z);
	return { load.force.x / section.area + share * bending / section.bendingModulus,
		 shear / section.area + share * abs(load.moment.x) / section.torsionModulus };
}

} // namespace yade::ddem
