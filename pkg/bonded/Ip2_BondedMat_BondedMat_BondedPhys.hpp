// GPL v2 or later, see LICENSE.
// From two materials to a contact or a bond.
#pragma once

#include <pkg/bonded/BondedPhys.hpp>

namespace yade {

class Ip2_BondedMat_BondedMat_BondedPhys : public IPhysFunctor {
public:
	virtual ~Ip2_BondedMat_BondedMat_BondedPhys() = default;
	void go(const shared_ptr<Material>&, const shared_ptr<Material>&, const shared_ptr<Interaction>&) override;

	/// Joins pairs of spheres of the current scene; all of them, or none on error.
	/// \param factors of the strength of every pair, a sequence, or None
	void bond(const std::vector<Vector2i>& pairs, const boost::python::object& factors);

	FUNCTOR2D(BondedMat, BondedMat);
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(Ip2_BondedMat_BondedMat_BondedPhys, IPhysFunctor,
		"Makes :yref:`BondedPhys` of two :yref:`BondedMat`. New interactions are frictional contacts; "
		"bonds exist only where :yref:`bond<Ip2_BondedMat_BondedMat_BondedPhys.bond>` makes them, so a broken "
		"bond never heals.",
		/*attrs*/, /*ctor*/,
		.def("bond",&Ip2_BondedMat_BondedMat_BondedPhys::bond,(boost::python::arg("pairs"),
			boost::python::arg("factors")=boost::python::object()),
			"Bond pairs of spheres, given as a list of (id1, id2), at their present distance and "
			"orientation, without load. *factors* are of the strength of every pair [-], or None. "
			"Needs no engines, and bonds need no help from the collider: they exist until they break, "
			"whatever the gap. In a periodic cell the closest images are bonded. ValueError, and nothing "
			"bonded, if a pair is not of two different spheres of :yref:`BondedMat`, is bonded already, or "
			"is half a periodic cell apart or more.")
	);
	// clang-format on
};
REGISTER_SERIALIZABLE(Ip2_BondedMat_BondedMat_BondedPhys);

class Ip2_FrictMat_BondedMat_BondedPhys : public IPhysFunctor {
public:
	virtual ~Ip2_FrictMat_BondedMat_BondedPhys() = default;
	void go(const shared_ptr<Material>&, const shared_ptr<Material>&, const shared_ptr<Interaction>&) override;

	FUNCTOR2D(FrictMat, BondedMat);
	// clang-format off
	YADE_CLASS_BASE_DOC(Ip2_FrictMat_BondedMat_BondedPhys, IPhysFunctor,
		"Makes :yref:`BondedPhys` of a :yref:`FrictMat` and a :yref:`BondedMat`: a frictional contact, so that "
		"steel balls, boxes and facets of machines meet bonded rock. Young's modulus is the harmonic mean of "
		"both, friction the lower of :yref:`frictionAngle<FrictMat.frictionAngle>` and that of the bonded "
		"particle. Poisson's ratio and damping are the bonded particle's: what FrictMat calls "
		":yref:`poisson<ElastMat.poisson>` is a ratio of springs."
	);
	// clang-format on
};
REGISTER_SERIALIZABLE(Ip2_FrictMat_BondedMat_BondedPhys);

} // namespace yade
