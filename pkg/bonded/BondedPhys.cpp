// GPL v2 or later, see LICENSE.
// One bond, or the frictional contact that is left of it.
#include <pkg/bonded/BondedPhys.hpp>

namespace yade {

DDEM_PLUGIN((BondedPhys))

void BondedPhys::join(const State& state1, const State& state2, const Vector3r& branch)
{
	const Real                length = branch.norm();
	const ddem::BondSection   section(length / 2); // ESyS-Particle's mean radius, d0/2
	const ddem::BondStiffness stiffness = ddem::bondStiffness(elasticity(), section, length);
	const ddem::Bond          bond      = ddem::makeBond(stiffness, branch, state1.ori, state2.ori);

	bonded       = true;
	bondLength   = length;
	bondRadius   = section.radius;
	kn           = stiffness.normal;
	ks           = stiffness.shear;
	kb           = stiffness.bending;
	kt           = stiffness.torsion;
	frame1       = bond.frame1;
	frame2       = bond.frame2;
	contactReach = math::min(contactReach, length); // an initial overlap bears no load, before and after the bond breaks
}

void BondedPhys::part()
{
	bonded       = false;
	normalStress = shearStress = 0;
	sliding                    = false;
	contactNormal = contactShear = Vector3r::Zero();
	setContactStiffness();
}

void BondedPhys::setContactStiffness()
{
	const ddem::ContactStiffness stiffness = ddem::contactStiffness(elasticity(), contactReach);
	kn                                     = stiffness.normal;
	ks                                     = stiffness.shear;
}

} // namespace yade
