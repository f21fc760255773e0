// GPL v2 or later, see LICENSE.
// The law of bonded particles: bonds that break by a criterion of their own, and frictional contacts.
#pragma once

#include <pkg/bonded/BondedEnergy.hpp>
#include <pkg/bonded/BondedPhys.hpp>
#include <pkg/bonded/BrokenBond.hpp>
#include <pkg/bonded/kernel/BondSystem.hpp>
#include <pkg/bonded/kernel/EsysContact.hpp>
#include <pkg/ddem/SingleProcess.hpp>

#include <mutex>

namespace yade {

class Law2_ScGeom_BondedPhys_Bonded : public LawFunctor {
public:
	virtual ~Law2_ScGeom_BondedPhys_Bonded() = default;
	bool go(shared_ptr<IGeom>&, shared_ptr<IPhys>&, Interaction*) override;

	ddem::BondConvention bondConvention() const
	{
		return esys ? ddem::BondConvention::Esys : ddem::BondConvention::Consistent;
	}
	/// Replaces a bond that has failed under these stresses by a contact and records it.
	/// \returns the contact's loads in this step, for the caller to apply and to book
	ddem::ContactLoads breakBond(Interaction& I, const ddem::BondStress& stress);
	/// One step of a contact. \returns its loads, for the caller to apply and to book
	ddem::ContactLoads advance(BondedContact& contact, const ddem::ContactMotion& motion) const
	{
		return esys ? ddem::esysContactLoads(
		               contact.stiffness, contact.friction, motion, scene->dt, contact.memory)
		            : ddem::contactLoads(
		                    contact.stiffness, contact.friction, motion, scene->dt, contact.memory,
		                    contact.damping);
	}
	/// Whether the pair still touches.
	bool touching(const Interaction& I) const;
	/// Adds the energies of a contact to the book.
	void bookContact(const ddem::ContactLoads& loads);
	/// Adds energies of bonds to the book: stored now, and taken by their criteria in this step [J].
	void bookBondEnergy(Real stored, Real lost)
	{
		energy.add(*scene->energy, BondedEnergy::BondElastic, stored);
		if (lost != 0) energy.add(*scene->energy, BondedEnergy::BondSoftening, lost);
	}
	/// Whether the loads of the last step break a bond, which is when ESyS-Particle looks.
	bool failsInEsys(const BondedPhys& phys);
	void postLoad(Law2_ScGeom_BondedPhys_Bonded&);

	boost::python::list brokenBonds() const;
	long                brokenCount() const;
	/// Broken bonds between bodies of a list.
	long brokenAmong(const boost::python::object& ids) const;
	boost::python::dict brokenArrays() const;
	boost::python::dict bonds() const;
	boost::python::dict bondArrays() const;
	/// Largest stresses of the bonds that hold, by what makes them [Pa].
	boost::python::dict largestStresses() const;
	/// Bytes of YADE's objects for a bond.
	static long bytesPerBond() { return long(sizeof(Interaction) + sizeof(ScGeom) + sizeof(BondedPhys)); }
	/// Bound on the time step of the current scene [s], see bondedStableStep.
	static Real criticalTimeStep();

	FUNCTOR2D(ScGeom, BondedPhys);
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(Law2_ScGeom_BondedPhys_Bonded, LawFunctor,
		"Forces and moments of bonds, their failure, and friction of pairs that are not or no longer bonded, "
		"after the bonds of ESyS-Particle [Wang2009]_ [Weatherley2014]_.\n\n"
		"**Bond.** A round beam of radius :math:`R=d_0/2` between the centres, :math:`d_0` apart when it was "
		"made, with stiffnesses :math:`EA/d_0` (normal), :math:`GA/d_0` (shear), :math:`EI/d_0` (bending), "
		":math:`GJ/d_0` (torsion). Loads follow from positions and orientations, not from increments: "
		"one element of the geometrically exact beam [Simo1985]_ with one integration point. They derive from "
		"an energy, so the bond is exactly conservative, for unequal radii and large rotations too. The rest "
		"length is :math:`d_0`.\n\n"
		"**Failure** is a criterion that the material says, and bonds of several may be in one scene. "
		":yref:`BondedMat`: Mohr-Coulomb, with :math:`\\sigma=F_n/A+|M_b|R/I`, :math:`\\tau=|F_s|/A+|M_t|R/J` "
		"the bond breaks in the step in which :math:`\\tau>C-\\sigma\\tan\\varphi` or :math:`\\sigma` exceeds "
		"the tension limit; there is no limit in pure compression. :yref:`ParallelBondMat`: strengths in "
		"tension and shear free of each other. :yref:`SofteningBondMat`: softens over stated energies.\n\n"
		"**Convention.** With :yref:`convention<Law2_ScGeom_BondedPhys_Bonded.convention>` *esys* bonds "
		"and contacts are those of ESyS-Particle 2.3.5, to compare with it: half of the bending moment, rest "
		"length :math:`r_1+r_2`, moment arms that are not conservative for unequal radii (the stiffness is not "
		"symmetric: a sample left alone slowly begins to shake, at any time step), failure one step later, "
		"friction that sticks again after every slip; gradual friction and contact damping have no effect, "
		"other criteria than Mohr-Coulomb are refused.\n\n"
		"**Contact.** Springs equal to those of a bond, Coulomb's friction with a static coefficient until the "
		"first slip and a dynamic one from then on. A bond of spheres that touched and that breaks under "
		"compression keeps its normal force; its tangential force starts from zero. Gradual friction and "
		"viscous damping are options of :yref:`BondedMat`.\n\n"
		"**Energy.** With :yref:`O.trackEnergy<Omega.trackEnergy>`: *bondElastic*, *contactElastic* (now "
		"stored), *bondBroken* (elastic energy lost with broken bonds), *bondSoftening* (taken by bonds that "
		"soften), *friction*, *contactDamping* (dissipated) [J].\n\n"
		"**Speed.** In a :yref:`BondedInteractionLoop` all bonds are computed together, several times as fast "
		"as one by one in an :yref:`InteractionLoop`.\n\n"
		"**Geometry.** Contacts take every :yref:`ScGeom`: spheres, clump members, :yref:`Wall`, :yref:`Box`, "
		":yref:`Facet`. What is no sphere has its springs by the sphere's image, and slips where it is "
		"touched. A sphere on the edge that two facets share touches both, as in all of YADE. :yref:`ScGeom6D` "
		"works as well, its relative rotations are not used; :yref:`ScGridCoGeom` is refused.\n\n"
		"**Saving.** Bonds and the list of broken bonds are saved with the scene. "
		"**Limits:** one process with threads: under mpirun with several it refuses to be made, loaded or run.",
		((std::string,convention,"consistent",Attr::triggerPostLoad,
			"'consistent', or 'esys' for the bonds and contacts of ESyS-Particle; to be chosen before the "
			"first step"))
		((vector<shared_ptr<BrokenBond>>,broken,,(Attr::readonly|Attr::hidden),
			"Records of broken bonds, in order of step and ids")),
		/*ctor*/,
		.def("brokenBonds",&Law2_ScGeom_BondedPhys_Bonded::brokenBonds,
			"List of :yref:`BrokenBond`, in order of step, then ids, whatever the number of threads.")
		.def("brokenCount",&Law2_ScGeom_BondedPhys_Bonded::brokenCount,"Number of broken bonds.")
		.def("brokenAmong",&Law2_ScGeom_BondedPhys_Bonded::brokenAmong,(boost::python::arg("ids")),
			"Number of broken bonds between bodies of a list or array of ids.")
		.def("brokenArrays",&Law2_ScGeom_BondedPhys_Bonded::brokenArrays,
			"What :yref:`brokenBonds<Law2_ScGeom_BondedPhys_Bonded.brokenBonds>` lists, "
			"as a dictionary of numpy arrays, a row a record: *id1*, *id2*, *step*, *time* [s], "
			"*position* [m] and *normal* of the crack, *radius* [m], *mode* (1 tension, 2 shear), "
			"*normal_stress*, *shear_stress* [Pa], *energy* [J].")
		.def("bonds",&Law2_ScGeom_BondedPhys_Bonded::bonds,
			"All bonds that hold, in order of ids, as a dictionary of lists: *ids* (pairs), "
			"*normalStress*, *shearStress* [Pa] of the last step, *radius* [m].")
		.def("bondArrays",&Law2_ScGeom_BondedPhys_Bonded::bondArrays,
			"The same as numpy arrays, many times as fast, with *axialForce* (tension positive) and "
			"*shearForce* (its size) [N].")
		.def("largestStresses",&Law2_ScGeom_BondedPhys_Bonded::largestStresses,
			"Largest stress that each part of its load makes in any bond that holds, at the present "
			"positions, as a dictionary [Pa]: *tension* :math:`|F_n|/A` (either sign), "
			"*bending* :math:`|M_b|R/I`, *shear* :math:`|F_s|/A`, "
			"*torsion* :math:`|M_t|R/J`. All zero without bonds.")
		.def("bytesPerBond",&Law2_ScGeom_BondedPhys_Bonded::bytesPerBond,
			"Bytes that YADE's objects for a bond take: its Interaction, geometry and physics, without the "
			"arrays of a :yref:`BondedInteractionLoop`.")
		.staticmethod("bytesPerBond")
		.def("criticalTimeStep",&Law2_ScGeom_BondedPhys_Bonded::criticalTimeStep,
			"Rigorous bound on the time step [s] for the bonds and contacts of the current scene, those of "
			"other laws with two springs included, and for its elastic walls: :math:`2/\\omega` of the "
			"worst pair, each particle's mass shared out between its springs; about a tenth below the "
			"exact value. That holds for small overlaps and the consistent convention; the stiffness of "
			"the other one is not symmetric. Infinite without springs. Contacts that form later may lower "
			"it: use 0.8 of it where much breaks.")
		.staticmethod("criticalTimeStep")
	);
	// clang-format on

private:
	/// One step of the contact that a pair has instead of a bond. \returns whether it may stay
	bool advanceContact(Interaction& I);
	/// Breaks a bond and lets the contact act at once. \returns whether it may stay
	bool replaceBond(Interaction& I, const ddem::BondStress& stress);
	/// Loads of a contact, of any geometry, and what it remembers of them.
	ddem::ContactLoads contactLoadsOf(const Interaction& I);
	Vector3r branchOf(const Interaction& I) const;
	/// Loads of a bond, one step of its criterion included.
	ddem::BondLoads
	loadsOf(ddem::BreakableBond& bond, const Vector3r& branch, const State& state1, const State& state2,
	        ddem::BondAnswer& answer) const;
	void applyLoads(const Interaction& I, const Vector3r& force, const Vector3r& moment1, const Vector3r& moment2);
	void applyContact(const Interaction& I, const ddem::ContactLoads& loads);
	void record(const shared_ptr<BrokenBond>& bond);

	bool         esys = false;
	BondedEnergy energy;
	SingleProcess process;
	mutable std::mutex recording;
};
REGISTER_SERIALIZABLE(Law2_ScGeom_BondedPhys_Bonded);

} // namespace yade
