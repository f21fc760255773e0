// GPL v2 or later, see LICENSE.
// The law of bonded particles: elastic bond, Mohr-Coulomb failure, frictional contact.
#include <pkg/bonded/ElasticWall.hpp>
#include <pkg/bonded/Law2_ScGeom_BondedPhys_MohrCoulomb.hpp>
#include <pkg/ddem/kernel/BondStableStep.hpp>
#include <pkg/ddem/kernel/BondWall.hpp>

namespace yade {

DDEM_PLUGIN((Law2_ScGeom_BondedPhys_MohrCoulomb))

namespace {

	/// Work per time of loads of a pair [W], with the velocities of the last half step.
	template <class Loads> Real pairPower(const Loads& loads, const State& state1, const State& state2)
	{
		return loads.force.dot(state1.vel - state2.vel) + loads.moment1.dot(state1.angVel) + loads.moment2.dot(state2.angVel);
	}

	ddem::ContactLoads advanceContact(const ScGeom& geom, BondedPhys& phys, const State& state1, const State& state2, const Vector3r& branch, Real dt)
	{
		const Real                distance = branch.norm(), share = phys.contactReach / (geom.radius1 + geom.radius2);
		const Vector3r            normal = branch / distance;
		const ddem::ContactMotion motion { normal,        distance,     share * geom.radius1, share * geom.radius2, state2.vel - state1.vel,
			                           state1.angVel, state2.angVel };
		ddem::ContactMemory       memory { phys.contactNormal, phys.contactShear, phys.sliding };
		const ddem::ContactLoads  loads = ddem::contactLoads({ phys.kn, phys.ks }, { phys.frictionStatic, phys.frictionDynamic }, motion, dt, memory);
		phys.contactNormal              = memory.normal;
		phys.contactShear               = memory.shear;
		phys.sliding                    = memory.sliding;
		phys.normalForce                = -loads.force.dot(normal) * normal;
		phys.shearForce                 = -loads.force - phys.normalForce;
		return loads;
	}

} // namespace

bool Law2_ScGeom_BondedPhys_MohrCoulomb::go(shared_ptr<IGeom>& iGeom, shared_ptr<IPhys>& iPhys, Interaction* I)
{
	const auto&  geom   = static_cast<const ScGeom&>(*iGeom);
	auto&        phys   = static_cast<BondedPhys&>(*iPhys);
	const State &state1 = *Body::byId(I->getId1(), scene)->state, &state2 = *Body::byId(I->getId2(), scene)->state;
	Vector3r     branch = state2.pos - state1.pos;
	if (scene->isPeriodic) branch += scene->cell->intrShiftPos(I->cellDist);
	if (!phys.bonded) {
		const ddem::ContactLoads loads = advanceContact(geom, phys, state1, state2, branch, scene->dt);
		return applyContact(*I, loads);
	}

	const ddem::Bond        bond { { phys.kn, phys.ks, phys.kb, phys.kt }, phys.bondLength, phys.frame1, phys.frame2 };
	const ddem::BondLoads   loads  = ddem::bondLoads(bond, branch, state1.ori, state2.ori);
	const ddem::BondStress  stress = ddem::bondStress(ddem::BondSection(phys.bondRadius), loads.section);
	const ddem::BondFailure mode   = ddem::bondFailure(phys.strength(), stress);
	if (mode != ddem::BondFailure::None) {
		phys.part();
		const ddem::ContactLoads contact = advanceContact(geom, phys, state1, state2, branch, scene->dt);

		auto parted          = boost::make_shared<BrokenBond>();
		parted->id1          = std::min(I->getId1(), I->getId2());
		parted->id2          = std::max(I->getId1(), I->getId2());
		parted->pos          = state1.pos + branch / 2;
		parted->normal       = loads.axis;
		parted->radius       = phys.bondRadius;
		parted->tension      = mode == ddem::BondFailure::Tension;
		parted->normalStress = stress.normal;
		parted->shearStress  = stress.shear;
		// What the contact does not take over. Leapfrog's work between two steps is the mean of their loads times the motion, so the jump of the loads counts half.
		parted->energy = loads.energy - contact.energy - contact.dissipated
		        + 0.5 * scene->dt * (pairPower(loads, state1, state2) - pairPower(contact, state1, state2));
		record(parted);
		return applyContact(*I, contact);
	}
	phys.normalForce  = -loads.section.force.x() * loads.axis;
	phys.shearForce   = -loads.force - phys.normalForce;
	phys.normalStress = stress.normal;
	phys.shearStress  = stress.shear;
	applyLoads(*I, loads.force, loads.moment1, loads.moment2);
	if (scene->trackEnergy) energy.add(*scene->energy, BondedEnergy::BondElastic, loads.energy);
	return true;
}

void Law2_ScGeom_BondedPhys_MohrCoulomb::applyLoads(const Interaction& I, const Vector3r& force, const Vector3r& moment1, const Vector3r& moment2)
{
	scene->forces.addForce(I.getId1(), force);
	scene->forces.addForce(I.getId2(), -force);
	scene->forces.addTorque(I.getId1(), moment1);
	scene->forces.addTorque(I.getId2(), moment2);
}

bool Law2_ScGeom_BondedPhys_MohrCoulomb::applyContact(const Interaction& I, const ddem::ContactLoads& loads)
{
	if (!loads.touching) return false;
	applyLoads(I, loads.force, loads.moment1, loads.moment2);
	if (scene->trackEnergy) {
		energy.add(*scene->energy, BondedEnergy::ContactElastic, loads.energy);
		energy.add(*scene->energy, BondedEnergy::Friction, loads.dissipated);
	}
	return true;
}

void Law2_ScGeom_BondedPhys_MohrCoulomb::record(const shared_ptr<BrokenBond>& bond)
{
	bond->iter = scene->iter;
	bond->time = scene->time;
	if (scene->trackEnergy) energy.add(*scene->energy, BondedEnergy::BondBroken, bond->energy);

	const std::lock_guard<std::mutex> lock(recording);
	const auto                        later = [&bond](const shared_ptr<BrokenBond>& other) {
                return other->iter == bond->iter && std::tie(other->id1, other->id2) > std::tie(bond->id1, bond->id2);
	};
	auto place = broken.end(); // threads come in any order; only this step's records can be out of order
	while (place != broken.begin() && later(*std::prev(place)))
		--place;
	broken.insert(place, bond);
}

boost::python::list Law2_ScGeom_BondedPhys_MohrCoulomb::brokenBonds() const
{
	boost::python::list list;
	for (const auto& bond : broken)
		list.append(bond);
	return list;
}

boost::python::dict Law2_ScGeom_BondedPhys_MohrCoulomb::bonds() const
{
	std::map<std::pair<int, int>, const BondedPhys*> holding;
	for (const auto& I : *Omega::instance().getScene()->interactions) {
		const auto* phys = dynamic_cast<const BondedPhys*>(I->phys.get());
		if (phys && phys->bonded) holding[std::minmax(I->getId1(), I->getId2())] = phys;
	}
	std::vector<Vector2i> ids;
	std::vector<Real>     normalStress, shearStress, radius;
	for (const auto& [pair, phys] : holding) {
		ids.emplace_back(pair.first, pair.second);
		normalStress.push_back(phys->normalStress);
		shearStress.push_back(phys->shearStress);
		radius.push_back(phys->bondRadius);
	}
	boost::python::dict result;
	result["ids"]          = ids;
	result["normalStress"] = normalStress;
	result["shearStress"]  = shearStress;
	result["radius"]       = radius;
	return result;
}

Real Law2_ScGeom_BondedPhys_MohrCoulomb::criticalTimeStep()
{
	const Scene&                                     scene = *Omega::instance().getScene();
	std::vector<int>                                 place(scene.bodies->size(), -1); // bodies that cannot move stay -1
	std::vector<ddem::ParticleMass>                  particles;
	std::vector<ddem::PairSpring>                    springs;
	std::vector<std::pair<const Wall*, const Body*>> walls;
	for (const auto& body : *scene.bodies) {
		if (!body) continue;
		if (const auto* wall = dynamic_cast<const Wall*>(body->shape.get())) walls.emplace_back(wall, body.get());
		if (body->state->blockedDOFs == State::DOF_ALL || !(body->state->mass > 0)) continue;
		place[size_t(body->id)] = int(particles.size());
		particles.push_back({ body->state->mass, body->state->inertia.minCoeff() });
	}
	for (const auto& I : *scene.interactions) {
		const auto* phys = dynamic_cast<const BondedPhys*>(I->phys.get());
		if (!phys || !I->geom) continue;
		const auto&      geom  = static_cast<const ScGeom&>(*I->geom);
		const Real       share = phys->contactReach / (geom.radius1 + geom.radius2);
		ddem::PairSpring spring { place[size_t(I->getId1())], place[size_t(I->getId2())], phys->kn, phys->ks, 0, 0,
			                  share * geom.radius1,       share * geom.radius2 };
		if (phys->bonded) {
			spring.bending = phys->kb;
			spring.torsion = phys->kt;
			spring.arm1 = spring.arm2 = phys->bondLength / 2;
		}
		springs.push_back(spring);
	}
	for (const auto& [wall, wallBody] : walls) { // also those particles that are about to touch
		const auto* material = dynamic_cast<const ElasticWallMat*>(wallBody->material.get());
		if (!material) continue;
		for (const auto& body : *scene.bodies) {
			const auto* sphere = body ? dynamic_cast<const Sphere*>(body->shape.get()) : nullptr;
			if (!sphere || !dynamic_cast<const BondedMat*>(body->material.get())) continue;
			if (math::abs(body->state->pos[wall->axis] - wallBody->state->pos[wall->axis]) > 2 * sphere->radius) continue;
			springs.push_back({ place[size_t(body->id)], -1, ddem::wallSpring(sphere->radius, material->stiffness), 0, 0, 0, 0, 0 });
		}
	}
	return ddem::stableStep(particles, springs);
}

} // namespace yade
