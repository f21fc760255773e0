// GPL v2 or later, see LICENSE.
// Material of bonds that soften.
#pragma once

#include <pkg/bonded/BondedMat.hpp>
#include <pkg/bonded/kernel/criteria/SofteningBond.hpp>

namespace yade {

class SofteningBondMat : public BondedMat {
public:
	virtual ~SofteningBondMat() = default;
	DDEM_CRITERION_OF_MATERIAL(SofteningBondMat, ddem::SofteningBond, SOFTENING_BOND_PARAMETERS)

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR(SofteningBondMat, BondedMat,
		"Bonds that soften over stated energies per area instead of breaking at once.\n\n"
		"They are elastic up to the envelope of :yref:`BondedMat`. Beyond it stress falls along a straight "
		"line with the separation, by a damage that scales all loads but normal compression, until the bond "
		"has taken *tensionEnergy* per area in pure tension, *shearEnergy* in pure shear; then a frictional "
		"contact is left. Where both act the larger damage counts; under compression shear takes more, "
		"in proportion to the square of its strength; bending alone takes a quarter, since its stress is "
		"largest at the rim only. Unloading goes to the origin. :yref:`O.energy<Omega.energy>` books it as "
		"*bondSoftening*, and :yref:`BrokenBond.energy` includes it.\n\n"
		"Errors: ValueError when bonds are made that store more than that energy at their strength, "
		":math:`\\sigma^2d_0/2E` per area: they would break at once.\n\n"
		"Limits: the energies are those of a bond; a crack through a packing crosses fewer or more of their "
		"area than of its own.",
		SOFTENING_BOND_PARAMETERS(DDEM_ATTRIBUTE),
		createIndex(); takeStrengthOfCriterion();
	);
	// clang-format on
	REGISTER_CLASS_INDEX(SofteningBondMat, BondedMat);
};
REGISTER_SERIALIZABLE(SofteningBondMat);

} // namespace yade
