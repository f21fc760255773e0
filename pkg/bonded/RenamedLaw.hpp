// GPL v2 or later, see LICENSE.
// A clear error for scripts that use the law's name of version 0.1.
#pragma once

#include <pkg/ddem/YadeInclude.hpp>

namespace yade {

class Law2_ScGeom_BondedPhys_MohrCoulomb : public LawFunctor {
public:
	virtual ~Law2_ScGeom_BondedPhys_MohrCoulomb() = default;
	void pyHandleCustomCtorArgs(boost::python::tuple&, boost::python::dict&) override { refuse(); }
	void postLoad(Law2_ScGeom_BondedPhys_MohrCoulomb&) { refuse(); }

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS(Law2_ScGeom_BondedPhys_MohrCoulomb, LawFunctor,
		"The name that :yref:`Law2_ScGeom_BondedPhys_Bonded` had when bonds could break by Mohr-Coulomb only. "
		"RuntimeError whenever it is made or loaded.",
		((std::string,convention,,Attr::triggerPostLoad,"No longer used"))
	);
	// clang-format on

private:
	[[noreturn]] static void refuse()
	{
		throw std::runtime_error(
		        "Law2_ScGeom_BondedPhys_MohrCoulomb is now Law2_ScGeom_BondedPhys_Bonded; how bonds break is "
		        "said by their material: BondedMat breaks them by Mohr-Coulomb as before");
	}
};
REGISTER_SERIALIZABLE(Law2_ScGeom_BondedPhys_MohrCoulomb);

} // namespace yade
