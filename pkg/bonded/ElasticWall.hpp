// GPL v2 or later, see LICENSE.
// Walls that repel bonded particles elastically: material, physics and the functors between them.
#pragma once

#include <pkg/bonded/BondedEnergy.hpp>
#include <pkg/bonded/BondedMat.hpp>

namespace yade {

class ElasticWallMat : public Material {
public:
	virtual ~ElasticWallMat() = default;
	void validate() const;
	void postLoad(ElasticWallMat&) { validate(); }

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(ElasticWallMat, Material,
		"Material of a :yref:`Wall`, :yref:`RoundPlaten`, :yref:`Box` or :yref:`Facet` that repels particles "
		"of :yref:`BondedMat` without friction; a wall also holds those that are bonded to it, as the walls of "
		"ESyS-Particle do.\n\n"
		"Errors: ValueError for a stiffness that is not positive, or a negative shear stiffness.",
		((Real,stiffness,100e9,Attr::triggerPostLoad,
			"Stiffness :math:`K` of the wall [Pa]; the spring of a contact with a sphere of radius "
			":math:`r` is :math:`\\pi r K`"))
		((Real,shearStiffness,0,Attr::triggerPostLoad,
			"Stiffness :math:`K_s` along the wall [Pa], for bonded spheres only; 0: they slide along it")),
		createIndex();,
		.def("validate",&ElasticWallMat::validate,
			"ValueError naming the parameter if one is out of range; checked when parameters are set by "
			"the constructor, and again when bonds are made.")
	);
	// clang-format on
	REGISTER_CLASS_INDEX(ElasticWallMat, Material);
};
REGISTER_SERIALIZABLE(ElasticWallMat);

class ElasticWallPhys : public NormShearPhys {
public:
	virtual ~ElasticWallPhys() = default;
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR(ElasticWallPhys, NormShearPhys,
		"Contact of a sphere with a wall of :yref:`ElasticWallMat`. :yref:`ks<NormShearPhys.ks>` and "
		":yref:`shearForce<NormShearPhys.shearForce>` are zero unless the sphere is bonded to it.",
		((Real,wallStiffness,0,Attr::readonly,"Stiffness :math:`K` of the wall [Pa]"))
		((Real,shearStiffness,0,Attr::readonly,"Stiffness :math:`K_s` along the wall [Pa], where bonded"))
		((bool,bonded,false,Attr::readonly,"Whether the sphere is bonded to the wall"))
		((Vector3r,bondedBranch,Vector3r::Zero(),(Attr::readonly|Attr::hidden),
			"From the wall's position to the sphere's when it was bonded [m]")),
		createIndex();
	);
	// clang-format on
	REGISTER_CLASS_INDEX(ElasticWallPhys, NormShearPhys);
};
REGISTER_SERIALIZABLE(ElasticWallPhys);

class Ip2_ElasticWallMat_BondedMat_ElasticWallPhys : public IPhysFunctor {
public:
	virtual ~Ip2_ElasticWallMat_BondedMat_ElasticWallPhys() = default;
	void go(const shared_ptr<Material>&, const shared_ptr<Material>&, const shared_ptr<Interaction>&) override;

	/// Bonds spheres of the current scene to a wall; all of them, or none on error.
	void bond(int wall, const std::vector<int>& spheres);

	FUNCTOR2D(ElasticWallMat, BondedMat);
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(Ip2_ElasticWallMat_BondedMat_ElasticWallPhys, IPhysFunctor,
		"Makes :yref:`ElasticWallPhys` where a wall meets a bonded particle.",
		/*attrs*/, /*ctor*/,
		.def("bond",&Ip2_ElasticWallMat_BondedMat_ElasticWallPhys::bond,(boost::python::arg("wall"),
			boost::python::arg("spheres")),
			"Bond spheres to a wall, given by their ids, where they are now, without load. Such a bond "
			"never breaks. ValueError, and nothing bonded, for bodies that are no wall of "
			":yref:`ElasticWallMat` or no spheres of :yref:`BondedMat`, or are bonded already.")
	);
	// clang-format on
};
REGISTER_SERIALIZABLE(Ip2_ElasticWallMat_BondedMat_ElasticWallPhys);

class Law2_ScGeom_ElasticWallPhys_Repulsion : public LawFunctor {
public:
	virtual ~Law2_ScGeom_ElasticWallPhys_Repulsion() = default;
	bool go(shared_ptr<IGeom>&, shared_ptr<IPhys>&, Interaction*) override;

	FUNCTOR2D(ScGeom, ElasticWallPhys);
	// clang-format off
	YADE_CLASS_BASE_DOC(Law2_ScGeom_ElasticWallPhys_Repulsion, LawFunctor,
		"Repulsion of spheres by a :yref:`Wall`, :math:`F=\\pi r K (r-g)` along its normal while the centre's "
		"distance :math:`g` from it is less than the radius (ESyS-Particle's NRotElasticWall "
		"[Weatherley2014]_). No friction, no moment. With :yref:`Wall.sense` set, a centre that has passed the "
		"wall is pushed back all the more; with sense 0 the wall acts on both sides. A "
		":yref:`RoundPlaten`, a :yref:`Box` or a :yref:`Facet` of that material repels with the overlap of its "
		"geometry.\n\n"
		"A sphere that is bonded to the wall feels :math:`-\\pi r(K u_n+K_s u_t)` instead, of its displacement "
		":math:`u` relative to the wall, in both directions, at its centre; it never breaks (NRotBondedWall, "
		"where :math:`K_s=K`).\n\n"
		"With :yref:`O.trackEnergy<Omega.trackEnergy>` it books *wallElastic* [J]."
	);
	// clang-format on

private:
	BondedEnergy energy;
};
REGISTER_SERIALIZABLE(Law2_ScGeom_ElasticWallPhys_Repulsion);

} // namespace yade
