// GPL v2 or later, see LICENSE.
// Why, when and where a bond broke.
#pragma once

#include <pkg/bonded/kernel/BondStress.hpp>
#include <pkg/ddem/YadeInclude.hpp>

namespace yade {

class BrokenBond : public Serializable {
public:
	virtual ~BrokenBond() = default;

	ddem::BondFailure failure() const { return ddem::BondFailure(mode); }
	std::string modeName() const { return failure() == ddem::BondFailure::Tension ? "tension" : "shear"; }

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(BrokenBond, Serializable,
		"Record of a broken bond, see :yref:`Law2_ScGeom_BondedPhys_Bonded.brokenBonds`.",
		((int,id1,-1,Attr::readonly,":yref:`Id<Body.id>` of the first particle"))
		((int,id2,-1,Attr::readonly,":yref:`Id<Body.id>` of the second particle"))
		((long,iter,-1,Attr::readonly,"Step in which it broke"))
		((Real,time,NaN,Attr::readonly,"Time at which it broke [s]"))
		((Vector3r,pos,Vector3r::Zero(),Attr::readonly,"Middle of the bond [m]"))
		((Vector3r,normal,Vector3r::Zero(),Attr::readonly,"Axis of the bond, the normal of its crack [-]"))
		((Real,radius,NaN,Attr::readonly,"Radius of its cross-section [m]"))
		((int,mode,0,(Attr::readonly|Attr::hidden),"How it failed, a ddem::BondFailure"))
		((Real,normalStress,NaN,Attr::readonly,"Normal stress when it broke, tension positive [Pa]"))
		((Real,shearStress,NaN,Attr::readonly,"Shear stress when it broke [Pa]"))
		((Real,energy,NaN,Attr::readonly,
			"Energy lost, beyond what the contact left behind keeps: elastic, and what softening had "
			"taken [J]")),
		/*ctor*/,
		.add_property("mode",&BrokenBond::modeName,
			"'tension' or 'shear', as its criterion tells: for :yref:`BondedMat` which of them used up "
			"more of the envelope, and always 'tension' beyond the cut-off")
	);
	// clang-format on
};
REGISTER_SERIALIZABLE(BrokenBond);

} // namespace yade
