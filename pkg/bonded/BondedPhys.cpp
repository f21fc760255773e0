// GPL v2 or later, see LICENSE.
// One bond, or the frictional contact that is left of it.
#include <pkg/bonded/BondedPhys.hpp>

#include <pkg/ddem/kernel/algebra/EigenSpace.hpp>

namespace yade {

DDEM_PLUGIN((BondedPhys))

std::atomic<long> BondedPhys::bondsMade { 0 };

void BondedPhys::join(const State& state1, const State& state2, const Vector3r& branch)
{
	const Real                length = branch.norm();
	const ddem::BondSection   section(length / 2); // ESyS-Particle's mean radius, d0/2
	const ddem::BondStiffness stiffness = ddem::bondStiffness(elasticity(), section, length);
	const ddem::Bond made = ddem::makeBond(
	        stiffness, 0, 0, ddem::spaceVector(branch), ddem::rotation(state1.ori), ddem::rotation(state2.ori));

	bonded     = true;
	bondLength = length;
	bondRadius = section.radius;
	kn         = stiffness.normal;
	ks         = stiffness.shear;
	kb         = stiffness.bending;
	kt         = stiffness.torsion;
	frame1     = ddem::eigenQuaternion(made.frame1);
	frame2     = ddem::eigenQuaternion(made.frame2);
	bondsMade++;
}

void BondedPhys::part(Real reach)
{
	bonded       = false;
	normalStress = shearStress = 0;
	sliding                    = false;
	contactNormal = contactShear = viscousShear = Vector3r::Zero();
	contactForce = contactEnergy = viscousNormal = 0;
	contactReach                                 = reach;
	setContactStiffness();
}

void BondedPhys::setContactStiffness()
{
	const ddem::ContactStiffness stiffness = ddem::contactStiffness(elasticity(), contactReach);
	kn                                     = stiffness.normal;
	ks                                     = stiffness.shear;
}

ddem::Bond BondedPhys::bond(const ScGeom& geom) const
{
	return { { kn, ks, kb, kt },    bondLength, geom.radius1, geom.radius2, ddem::rotation(frame1),
		 ddem::rotation(frame2) };
}

ddem::ContactDamping BondedPhys::contactDamping(Real mass1, Real mass2) const
{
	if (normalDamping == 0 && shearDamping == 0) return {};
	const Real reduced = mass1 * mass2 / (mass1 + mass2);
	return { 2 * normalDamping * math::sqrt(reduced * kn), 2 * shearDamping * math::sqrt(reduced * ks) };
}

} // namespace yade
