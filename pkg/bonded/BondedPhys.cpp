// GPL v2 or later, see LICENSE.
// One bond, or the frictional contact that is left of it.
#include <pkg/bonded/BondedPhys.hpp>

#include <pkg/ddem/kernel/algebra/EigenSpace.hpp>

#include <algorithm>

namespace yade {

DDEM_PLUGIN((BondedPhys))

std::atomic<long> BondedPhys::bondsMade { 0 };

shared_ptr<BondedPhys>
BondedPhys::contact(const BondedMat& first, const BondedMat& second, const BondedMat* between, Real reach)
{
	const BondedMat &      a = between ? *between : first, &b = between ? *between : second;
	auto phys             = boost::make_shared<BondedPhys>();
	phys->young           = 2 * a.young * b.young / (a.young + b.young); // two halves in series
	phys->poisson         = (a.poisson + b.poisson) / 2;
	phys->frictionStatic  = math::min(a.frictionStatic, b.frictionStatic);
	phys->frictionDynamic = math::min(a.frictionDynamic, b.frictionDynamic);
	phys->gradualFriction = a.gradualFriction || b.gradualFriction;
	phys->normalDamping   = (a.normalDamping + b.normalDamping) / 2;
	phys->shearDamping    = (a.shearDamping + b.shearDamping) / 2;
	phys->contactReach    = reach;
	phys->tangensOfFrictionAngle = phys->frictionStatic;
	phys->setContactStiffness();
	return phys;
}

Real BondedPhys::reachOf(const Interaction& I)
{
	const auto& geom    = static_cast<const ScGeom&>(*I.geom);
	const bool  sphere1 = isSphere(*Body::byId(I.getId1())), sphere2 = isSphere(*Body::byId(I.getId2()));
	if (sphere1 == sphere2) return geom.radius1 + geom.radius2;
	return 2 * (sphere1 ? geom.radius1 : geom.radius2);
}

void BondedPhys::join(
        const ddem::BondCriterion& breaks, const ddem::BondStrength& given, Real radius, const State& state1,
        const State& state2, const Vector3r& branch)
{
	const Real                length    = branch.norm();
	const ddem::BondStiffness stiffness = ddem::bondStiffness(elasticity(), ddem::BondSection(radius), length);
	const ddem::Bond made = ddem::makeBond(
	        stiffness, 0, 0, ddem::spaceVector(branch), ddem::rotation(state1.ori), ddem::rotation(state2.ori));

	bonded     = true;
	criterion  = breaks.name();
	found      = &breaks;
	strengthNumbers = Eigen::Map<const Vector6r>(given.data());
	memoryNumbers.assign(breaks.memoryNames().empty() ? 0 : ddem::mostMemories, 0.);
	bondLength = length;
	bondRadius = radius;
	kn         = stiffness.normal;
	ks         = stiffness.shear;
	kb         = stiffness.bending;
	kt         = stiffness.torsion;
	kr         = kb;
	ktw        = kt;
	frame1     = ddem::eigenQuaternion(made.frame1);
	frame2     = ddem::eigenQuaternion(made.frame2);
	bondsMade++;
}

const ddem::BondCriterion& BondedPhys::breaks() const
{
	if (!found) found = &ddem::bondCriterion(criterion);
	return *found;
}

void BondedPhys::setMemory(const ddem::BondMemory& remembered)
{
	if (!memoryNumbers.empty()) memoryNumbers.assign(remembered.begin(), remembered.end());
}

namespace {

	boost::python::dict named(const std::vector<std::string>& names, const Real* values)
	{
		boost::python::dict result;
		for (size_t i = 0; i < names.size(); i++)
			result[names[i]] = values[i];
		return result;
	}

} // namespace

boost::python::dict BondedPhys::pyStrength() const
{
	return bonded ? named(breaks().strengthNames(), strengthNumbers.data()) : boost::python::dict();
}

boost::python::dict BondedPhys::pyMemory() const
{
	return bonded ? named(breaks().memoryNames(), memoryNumbers.data()) : boost::python::dict();
}

void BondedPhys::part(Real reach)
{
	bonded       = false;
	memoryNumbers.clear();
	kr = ktw     = 0;
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

ddem::BreakableBond BondedPhys::bond(const ScGeom& geom) const
{
	ddem::BreakableBond result { { { kn, ks, kb, kt },
		                       bondLength,
		                       geom.radius1,
		                       geom.radius2,
		                       bondRadius,
		                       ddem::rotation(frame1),
		                       ddem::rotation(frame2) },
		                     &breaks(),
		                     {},
		                     {} };
	std::copy_n(strengthNumbers.data(), ddem::mostStrengths, result.strength.begin());
	std::copy(memoryNumbers.begin(), memoryNumbers.end(), result.memory.begin());
	return result;
}

BondedContact BondedPhys::contactNow(Real mass1, Real mass2) const
{
	return { { kn, ks },
		 friction(),
		 contactDamping(mass1, mass2),
		 { contactNormal, contactShear, contactForce, contactEnergy, sliding, viscousNormal, viscousShear } };
}

void BondedPhys::setContact(const ddem::ContactMemory& memory, const Vector3r& force, const Vector3r& normal)
{
	contactNormal = memory.normal;
	contactShear  = memory.shear;
	contactForce  = memory.force;
	contactEnergy = memory.energy;
	sliding       = memory.sliding;
	viscousNormal = memory.viscousNormal;
	viscousShear  = memory.viscousShear;
	normalForce   = -force.dot(normal) * normal;
	shearForce    = -force - normalForce;
}

ddem::ContactDamping BondedPhys::contactDamping(Real mass1, Real mass2) const
{
	if (normalDamping == 0 && shearDamping == 0) return {};
	// bodies that nothing moves have no mass, as facets, or stand for an infinite one
	const Real reduced = mass1 > 0 && mass2 > 0 ? mass1 * mass2 / (mass1 + mass2) : math::max(mass1, mass2);
	return { 2 * normalDamping * math::sqrt(reduced * kn), 2 * shearDamping * math::sqrt(reduced * ks) };
}

} // namespace yade
