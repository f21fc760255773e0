// GPL v2 or later, see LICENSE.
// One bond, or the frictional contact that is left of it.
#pragma once

#include <pkg/bonded/BondedMat.hpp>
#include <pkg/bonded/kernel/BondSystem.hpp>

#include <atomic>

namespace yade {

/// Whether its shape is a sphere or a kind of it.
inline bool isSphere(const Body& body)
{
	return body.shape->getClassIndex() == Sphere::getClassIndexStatic()
	        || dynamic_cast<const Sphere*>(body.shape.get());
}

/// A contact apart from its object: what it is and what it remembers.
struct BondedContact {
	ddem::ContactStiffness stiffness;
	ddem::ContactFriction  friction;
	ddem::ContactDamping   damping;
	ddem::ContactMemory    memory;
};

class BondedPhys : public RotStiffFrictPhys {
public:
	virtual ~BondedPhys() = default;

	/// A contact between two materials. \param between the material of such pairs, or null
	/// \param reach sum of the radii [m], see reachOf
	static shared_ptr<BondedPhys>
	contact(const BondedMat& a, const BondedMat& b, const BondedMat* between, Real reach);
	/// Sum of the radii of an interaction [m], which sets its springs.
	/// What is no sphere counts as the sphere's image.
	static Real reachOf(const Interaction& I);
	/** Joins the two particles as they are now.
	 * \param breaks the criterion \param strength,radius as it gives them [m]
	 * \param branch from the centre of particle 1 to that of 2 [m]
	 */
	void
	join(const ddem::BondCriterion& breaks, const ddem::BondStrength& strength, Real radius, const State& state1,
	     const State& state2, const Vector3r& branch);
	/// Leaves a frictional contact in place of the bond. \param reach distance of the centres
	/// below which it acts [m]
	void part(Real reach);
	/// Springs of the contact for its present reach.
	void setContactStiffness();

	ddem::BondElasticity  elasticity() const { return { young, poisson }; }
	ddem::ContactFriction friction() const { return { frictionStatic, frictionDynamic, gradualFriction }; }
	/// The bond as the kernel knows it. \param geom gives the radii of its particles
	ddem::BreakableBond bond(const ScGeom& geom) const;
	/// How the bond breaks. \throws std::invalid_argument where it is none
	const ddem::BondCriterion& breaks() const;
	/// Takes up what a step has made the bond remember.
	void setMemory(const ddem::BondMemory& remembered);
	boost::python::dict pyStrength() const;
	boost::python::dict pyMemory() const;
	/// The contact between particles of these masses [kg].
	BondedContact contactNow(Real mass1, Real mass2) const;
	/// Takes up what a step has made of it.
	void setContact(const ddem::ContactMemory& memory, const Vector3r& force, const Vector3r& normal);
	/// Coefficients of viscous damping of the contact between particles of these masses [kg].
	ddem::ContactDamping contactDamping(Real mass1, Real mass2) const;

	/// Grows whenever a bond is made anywhere, so that lists of bonds know when they are out of date.
	static std::atomic<long> bondsMade;
	void                     postLoad(BondedPhys&) { bondsMade++; }

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(BondedPhys, RotStiffFrictPhys,
		"Interaction of two particles of :yref:`BondedMat`: an elastic bond while *bonded*, else a frictional "
		"contact. :yref:`kn<NormPhys.kn>` and :yref:`ks<NormShearPhys.ks>` [N/m] are those of the bond or of "
		"the contact, whichever acts; :yref:`kr<RotStiffFrictPhys.kr>` and :yref:`ktw<RotStiffFrictPhys.ktw>` "
		"are *kb* and *kt* while the bond holds, for YADE's :yref:`GlobalStiffnessTimeStepper`.",
		((bool,bonded,false,Attr::readonly,"Whether the bond holds"))
		((bool,sliding,false,Attr::readonly,
			"Whether the contact has slipped before, so that dynamic friction applies"))
		((Real,young,NaN,Attr::readonly,"Young's modulus of cement and contact [Pa]"))
		((Real,poisson,NaN,Attr::readonly,"Poisson's ratio of cement and contact [-]"))
		((std::string,criterion,,Attr::readonly,
			"Name of the criterion by which the bond breaks; empty for a pair that never was bonded"))
		((Vector6r,strengthNumbers,Vector6r::Zero(),(Attr::readonly|Attr::hidden),
			"Numbers that the criterion keeps of its parameters"))
		((vector<Real>,memoryNumbers,,(Attr::readonly|Attr::hidden),
			"Numbers that the criterion remembers; empty where it remembers none"))
		((Real,frictionStatic,NaN,Attr::readonly,"Static coefficient of friction [-]"))
		((Real,frictionDynamic,NaN,Attr::readonly,"Dynamic coefficient of friction [-]"))
		((Real,kb,0,Attr::readonly,"Bending stiffness of the bond [N·m/rad]"))
		((Real,kt,0,Attr::readonly,"Torsion stiffness of the bond [N·m/rad]"))
		((Real,bondLength,0,Attr::readonly,
			"Distance of the centres when the bond was made [m]; 0 for a pair that never was bonded"))
		((Real,bondRadius,0,Attr::readonly,"Radius of the bond's cross-section [m]"))
		((Real,contactReach,0,Attr::readonly,
			"Distance of the centres below which the contact acts [m]: the sum of the radii, or less where "
			"particles were bonded with an overlap"))
		((Quaternionr,frame1,Quaternionr::Identity(),(Attr::readonly|Attr::hidden),
			"The bond's frame in the axes of particle 1"))
		((Quaternionr,frame2,Quaternionr::Identity(),(Attr::readonly|Attr::hidden),
			"The bond's frame in the axes of particle 2"))
		((bool,gradualFriction,false,Attr::readonly,
			"Whether the tangential force of the contact grows gradually"))
		((Real,normalDamping,0,Attr::readonly,"Normal damping of the contact, part of the critical one [-]"))
		((Real,shearDamping,0,Attr::readonly,"Tangential damping of the contact, part of the critical one [-]"))
		((Vector3r,contactNormal,Vector3r::Zero(),(Attr::readonly|Attr::hidden),
			"Normal of the contact in the last step"))
		((Vector3r,contactShear,Vector3r::Zero(),(Attr::readonly|Attr::hidden),
			"Force that a linear tangential spring of the contact had in the last step [N]"))
		((Real,contactForce,0,(Attr::readonly|Attr::hidden),
			"Force of the contact's tangential spring in the last step [N]"))
		((Real,contactEnergy,0,(Attr::readonly|Attr::hidden),"Energy of the contact's tangential spring [J]"))
		((Real,viscousNormal,0,(Attr::readonly|Attr::hidden),
			"Normal damping force of the contact in the last step [N]"))
		((Vector3r,viscousShear,Vector3r::Zero(),(Attr::readonly|Attr::hidden),
			"Tangential damping force of the contact in the last step [N]"))
		((Real,normalStress,0,Attr::readonly,
			"Largest normal stress of the bond's section, tension positive: :math:`F_n/A + |M_b|R/I` [Pa]"))
		((Real,shearStress,0,Attr::readonly,
			"Largest shear stress of the bond's section: :math:`|F_s|/A + |M_t|R/J` [Pa]")),
		createIndex();,
		.add_property("strength",&BondedPhys::pyStrength,
			"What the bond can bear, a dictionary whose keys depend on its criterion; empty for a contact")
		.add_property("memory",&BondedPhys::pyMemory,
			"What the bond's criterion remembers, a dictionary, as damage; empty where it remembers "
			"nothing")
	);
	// clang-format on
	REGISTER_CLASS_INDEX(BondedPhys, RotStiffFrictPhys);

private:
	mutable const ddem::BondCriterion* found = nullptr; ///< that of the name
};
REGISTER_SERIALIZABLE(BondedPhys);

} // namespace yade
