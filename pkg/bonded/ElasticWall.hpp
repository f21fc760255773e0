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
		"Material of a :yref:`Wall` that repels particles of :yref:`BondedMat` without friction, as the walls of ESyS-Particle do.\n\nErrors: ValueError for a stiffness that is not positive.",
		((Real,stiffness,100e9,Attr::triggerPostLoad,"Stiffness :math:`K` of the wall [Pa]; the spring of a contact with a sphere of radius :math:`r` is :math:`\\pi r K`")),
		createIndex();,
		.def("validate",&ElasticWallMat::validate,"ValueError naming the parameter if one is out of range; checked when parameters are set by the constructor, and again when bonds are made.")
	);
	// clang-format on
	REGISTER_CLASS_INDEX(ElasticWallMat, Material);
};
REGISTER_SERIALIZABLE(ElasticWallMat);

class ElasticWallPhys : public NormPhys {
public:
	virtual ~ElasticWallPhys() = default;
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR(ElasticWallPhys, NormPhys,
		"Contact of a sphere with a wall of :yref:`ElasticWallMat`.",
		((Real,wallStiffness,0,Attr::readonly,"Stiffness :math:`K` of the wall [Pa]")),
		createIndex();
	);
	// clang-format on
	REGISTER_CLASS_INDEX(ElasticWallPhys, NormPhys);
};
REGISTER_SERIALIZABLE(ElasticWallPhys);

class Ip2_ElasticWallMat_BondedMat_ElasticWallPhys : public IPhysFunctor {
public:
	virtual ~Ip2_ElasticWallMat_BondedMat_ElasticWallPhys() = default;
	void go(const shared_ptr<Material>&, const shared_ptr<Material>&, const shared_ptr<Interaction>&) override;

	FUNCTOR2D(ElasticWallMat, BondedMat);
	// clang-format off
	YADE_CLASS_BASE_DOC(Ip2_ElasticWallMat_BondedMat_ElasticWallPhys, IPhysFunctor, "Makes :yref:`ElasticWallPhys` where a wall meets a bonded particle.");
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
		"Repulsion of spheres by a :yref:`Wall`, :math:`F=\\pi r K (r-g)` along its normal while the centre's distance :math:`g` from it is less than the radius (ESyS-Particle's NRotElasticWall "
		"[Weatherley2014]_). No friction, no moment. With :yref:`Wall.sense` set, a centre that has passed the wall is pushed back all the more; with sense 0 the wall acts on both sides.\n\n"
		"With :yref:`O.trackEnergy<Omega.trackEnergy>` it books *wallElastic* [J]."
	);
	// clang-format on

private:
	BondedEnergy energy;
};
REGISTER_SERIALIZABLE(Law2_ScGeom_ElasticWallPhys_Repulsion);

} // namespace yade
