// GPL v2 or later, see LICENSE.
// The law of bonded particles: elastic bond, Mohr-Coulomb failure, frictional contact.
#include <pkg/bonded/BondedArrays.hpp>
#include <pkg/bonded/BondedInteractionLoop.hpp>
#include <pkg/bonded/BondedTimeStep.hpp>
#include <pkg/bonded/Law2_ScGeom_BondedPhys_Bonded.hpp>
#include <pkg/ddem/kernel/algebra/EigenSpace.hpp>

#include <algorithm>
#include <map>

namespace yade {

DDEM_PLUGIN((Law2_ScGeom_BondedPhys_Bonded))

namespace {

	/// From the first body to the second, or to its image where they meet across the border of a periodic cell.
	Vector3r branchIn(const Scene& scene, const Interaction& I)
	{
		const BodyContainer& bodies = *scene.bodies;
		const Vector3r       branch = bodies[I.getId2()]->state->pos - bodies[I.getId1()]->state->pos;
		return scene.isPeriodic ? Vector3r(branch + scene.cell->intrShiftPos(I.cellDist)) : branch;
	}

	/// Work per time of loads of a pair [W], with the velocities of the last half step.
	/// \param velocity2 of the second one, or of its periodic image
	Real pairPower(
	        const Vector3r& force, const Vector3r& moment1, const Vector3r& moment2, const State& state1,
	        const State& state2, const Vector3r& velocity2)
	{
		return force.dot(state1.vel - velocity2) + moment1.dot(state1.angVel) + moment2.dot(state2.angVel);
	}

} // namespace

void Law2_ScGeom_BondedPhys_Bonded::postLoad(Law2_ScGeom_BondedPhys_Bonded&)
{
	if (convention != "consistent" && convention != "esys")
		throw std::invalid_argument(
		        "Law2_ScGeom_BondedPhys_Bonded: convention = '" + convention
		        + "' is unknown; use 'consistent' or 'esys'");
	esys = convention == "esys";
	requireSingleProcess(); // in words here: what is thrown in the loop of InteractionLoop ends the program
}

Vector3r Law2_ScGeom_BondedPhys_Bonded::branchOf(const Interaction& I) const { return branchIn(*scene, I); }

bool Law2_ScGeom_BondedPhys_Bonded::go(shared_ptr<IGeom>& iGeom, shared_ptr<IPhys>& iPhys, Interaction* I)
{
	process.require(*scene); // an InteractionLoop offers no other place to look
	auto& phys = static_cast<BondedPhys&>(*iPhys);
	if (!phys.bonded) return advanceContact(*I);
	if (esys && failsInEsys(phys)) return replaceBond(*I, { phys.normalStress, phys.shearStress });
	const State &state1 = *Body::byId(I->getId1(), scene)->state, &state2 = *Body::byId(I->getId2(), scene)->state;
	const Vector3r            branch = branchOf(*I), normal = branch.normalized();
	ddem::BreakableBond       bond   = phys.bond(static_cast<const ScGeom&>(*iGeom));
	ddem::BondAnswer          answer {};
	const ddem::BondLoads     loads = loadsOf(bond, branch, state1, state2, answer);
	phys.setMemory(bond.memory);
	if (scene->trackEnergy && answer.lost != 0)
		energy.add(*scene->energy, BondedEnergy::BondSoftening, answer.lost);
	if (!esys && answer.overload > 0) return replaceBond(*I, answer.stress);

	const Vector3r force = ddem::eigenVector(loads.force);
	phys.normalForce     = -force.dot(normal) * normal;
	phys.shearForce      = -force - phys.normalForce;
	phys.normalStress    = answer.stress.normal;
	phys.shearStress     = answer.stress.shear;
	applyLoads(*I, force, ddem::eigenVector(loads.moment1), ddem::eigenVector(loads.moment2));
	if (scene->trackEnergy) bookBondEnergy(loads.energy, 0);
	return true;
}

ddem::BondLoads Law2_ScGeom_BondedPhys_Bonded::loadsOf(
        ddem::BreakableBond& bond, const Vector3r& branch, const State& state1, const State& state2,
        ddem::BondAnswer& answer) const
{
	const ddem::BondSection section(bond.bond.sectionRadius);
	return ddem::bondLoads(
	        bondConvention(), bond.bond, ddem::spaceVector(branch), ddem::rotation(state1.ori),
	        ddem::rotation(state2.ori), [&](ddem::BondResultants& load) {
		        answer = bond.criterion->advance(
		                bond.strength, bond.memory, section, bond.bond.stiffness, load);
	        });
}

bool Law2_ScGeom_BondedPhys_Bonded::failsInEsys(const BondedPhys& phys)
{
	try {
		ddem::requireKnown(ddem::BondConvention::Esys, phys.breaks());
	} catch (const std::invalid_argument& error) {
		stopAfterStep(*scene, error.what());
		return false;
	}
	const ddem::BondStress stress { phys.normalStress, phys.shearStress };
	ddem::BondStrength     strength {};
	std::copy_n(phys.strengthNumbers.data(), ddem::mostStrengths, strength.begin());
	using Criterion = ddem::MohrCoulomb;
	return Criterion::overload(ddem::fromNumbers<Criterion::Strength<Real>>(strength.data()), stress) > 0;
}

bool Law2_ScGeom_BondedPhys_Bonded::replaceBond(Interaction& I, const ddem::BondStress& stress)
{
	applyContact(I, breakBond(I, stress));
	return touching(I);
}

ddem::ContactLoads Law2_ScGeom_BondedPhys_Bonded::breakBond(Interaction& I, const ddem::BondStress& stress)
{
	const auto&           geom   = static_cast<const ScGeom&>(*I.geom);
	auto&                 phys   = static_cast<BondedPhys&>(*I.phys);
	const State &state1 = *Body::byId(I.getId1(), scene)->state, &state2 = *Body::byId(I.getId2(), scene)->state;
	const Vector3r        branch = branchOf(I);
	ddem::BreakableBond   bond   = phys.bond(geom); // damage has grown already: the loads are what is left of them
	ddem::BondAnswer      answer {};
	const ddem::BondLoads loads = loadsOf(bond, branch, state1, state2, answer);
	const Real reach = geom.radius1 + geom.radius2;
	// Where particles were bonded with an overlap it bears no load, before and after the bond breaks;
	// ESyS-Particle's rest length is always the sum of the radii.
	const ddem::BondFailure mode = bond.criterion->mode(bond.strength, bond.memory, stress);
	phys.part(esys ? reach : math::min(reach, phys.bondLength));
	const ddem::ContactLoads contact = contactLoadsOf(I);

	auto parted          = boost::make_shared<BrokenBond>();
	parted->id1          = std::min(I.getId1(), I.getId2());
	parted->id2          = std::max(I.getId1(), I.getId2());
	parted->pos          = state1.pos + branch / 2;
	parted->normal       = ddem::eigenVector(loads.axis);
	parted->radius       = phys.bondRadius;
	parted->mode         = int(mode);
	parted->normalStress = stress.normal;
	parted->shearStress  = stress.shear;
	// What the contact does not take over. Leapfrog's work between two steps is the mean of their loads times the
	// motion, so the jump of the loads counts half.
	const Vector3r velocity2 = scene->isPeriodic
	        ? Vector3r(state2.vel + scene->cell->intrShiftVel(I.cellDist)) : state2.vel;
	const Real bondPower = pairPower(
	        ddem::eigenVector(loads.force), ddem::eigenVector(loads.moment1), ddem::eigenVector(loads.moment2),
	        state1, state2, velocity2);
	const Real contactPower
	        = pairPower(contact.force, contact.moment1, contact.moment2, state1, state2, velocity2);
	parted->energy          = loads.energy - contact.energy - contact.dissipated - contact.damped
	        + 0.5 * scene->dt * (bondPower - contactPower);
	if (scene->trackEnergy) energy.add(*scene->energy, BondedEnergy::BondBroken, parted->energy);
	parted->energy += bond.criterion->lostBy(bond.memory);
	record(parted);
	return contact;
}

bool Law2_ScGeom_BondedPhys_Bonded::touching(const Interaction& I) const
{
	const auto& geom = static_cast<const ScGeom&>(*I.geom);
	if (!isSphere(*Body::byId(I.getId1(), scene)) || !isSphere(*Body::byId(I.getId2(), scene)))
		return geom.penetrationDepth > 0;
	// A pair that was bonded with an overlap may have a shorter reach than its radii: it stays for as long as the
	// spheres touch, or a new contact would know nothing of that.
	return branchOf(I).norm() < geom.radius1 + geom.radius2;
}

ddem::ContactLoads Law2_ScGeom_BondedPhys_Bonded::contactLoadsOf(const Interaction& I)
{
	const auto&    geom   = static_cast<const ScGeom&>(*I.geom);
	auto&          phys   = static_cast<BondedPhys&>(*I.phys);
	const State &  state1 = *Body::byId(I.getId1(), scene)->state, &state2 = *Body::byId(I.getId2(), scene)->state;
	const bool     sphere1 = isSphere(*Body::byId(I.getId1(), scene)),
	           sphere2 = isSphere(*Body::byId(I.getId2(), scene)), spheres = sphere1 && sphere2;
	const Real     share = spheres ? phys.contactReach / (geom.radius1 + geom.radius2) : 1,
	               radius1 = sphere1 ? share * geom.radius1 : 0, radius2 = sphere2 ? share * geom.radius2 : 0;
	const Vector3r branch   = branchOf(I);
	const Real     distance = spheres ? branch.norm() : radius1 + radius2 - geom.penetrationDepth;
	const Vector3r normal   = spheres ? Vector3r(branch / distance) : geom.normal;
	// of other shapes: the surface at the contact, which a periodic image of body 2 has elsewhere
	const Vector3r shift = scene->isPeriodic ? scene->cell->intrShiftPos(I.cellDist) : Vector3r::Zero();
	const Vector3r arm1 = geom.contactPoint - state1.pos, arm2 = geom.contactPoint - state2.pos - shift;
	const Vector3r velocity1 = sphere1 ? state1.vel : Vector3r(state1.vel + state1.angVel.cross(arm1));
	Vector3r       velocity2 = sphere2 ? state2.vel : Vector3r(state2.vel + state2.angVel.cross(arm2));
	if (scene->isPeriodic) velocity2 += scene->cell->intrShiftVel(I.cellDist);

	const ddem::ContactMotion motion { normal,        distance,     radius1, radius2, velocity2 - velocity1,
		                           state1.angVel, state2.angVel };
	BondedContact contact
	        = phys.contactNow(moverOf(*scene, I.getId1()).state->mass, moverOf(*scene, I.getId2()).state->mass);
	ddem::ContactLoads loads = advance(contact, motion);
	phys.setContact(contact.memory, loads.force, normal);
	if (!sphere1) loads.moment1 = arm1.cross(loads.force);
	if (!sphere2) loads.moment2 = -arm2.cross(loads.force);
	return loads;
}

bool Law2_ScGeom_BondedPhys_Bonded::advanceContact(Interaction& I)
{
	applyContact(I, contactLoadsOf(I));
	return touching(I);
}

void Law2_ScGeom_BondedPhys_Bonded::applyLoads(
        const Interaction& I, const Vector3r& force, const Vector3r& moment1, const Vector3r& moment2)
{
	scene->forces.addForce(I.getId1(), force);
	scene->forces.addForce(I.getId2(), -force);
	scene->forces.addTorque(I.getId1(), moment1);
	scene->forces.addTorque(I.getId2(), moment2);
}

void Law2_ScGeom_BondedPhys_Bonded::applyContact(const Interaction& I, const ddem::ContactLoads& loads)
{
	if (loads.touching) applyLoads(I, loads.force, loads.moment1, loads.moment2);
	if (scene->trackEnergy) bookContact(loads);
}

void Law2_ScGeom_BondedPhys_Bonded::bookContact(const ddem::ContactLoads& loads)
{
	energy.add(*scene->energy, BondedEnergy::ContactElastic, loads.energy);
	energy.add(*scene->energy, BondedEnergy::Friction, loads.dissipated);
	if (loads.damped != 0) energy.add(*scene->energy, BondedEnergy::ContactDamping, loads.damped);
}

void Law2_ScGeom_BondedPhys_Bonded::record(const shared_ptr<BrokenBond>& bond)
{
	bond->iter = scene->iter;
	bond->time = scene->time;

	const std::lock_guard<std::mutex> lock(recording);
	const auto                        later = [&bond](const shared_ptr<BrokenBond>& other) {
                return other->iter == bond->iter && std::tie(other->id1, other->id2) > std::tie(bond->id1, bond->id2);
	};
	auto place = broken.end(); // threads come in any order; only this step's records can be out of order
	while (place != broken.begin() && later(*std::prev(place)))
		--place;
	broken.insert(place, bond);
}

boost::python::list Law2_ScGeom_BondedPhys_Bonded::brokenBonds() const
{
	std::vector<shared_ptr<BrokenBond>> now;
	{
		const std::lock_guard<std::mutex> lock(recording);
		now = broken;
	}
	boost::python::list list;
	for (const auto& bond : now)
		list.append(bond);
	return list;
}

long Law2_ScGeom_BondedPhys_Bonded::brokenCount() const
{
	const std::lock_guard<std::mutex> lock(recording);
	return long(broken.size());
}

long Law2_ScGeom_BondedPhys_Bonded::brokenAmong(const boost::python::object& ids) const
{
	const std::vector<Body::id_t> those = bodyIdsOf(ids);
	std::vector<char> among(size_t(those.empty() ? 0 : *std::max_element(those.begin(), those.end()) + 1));
	for (const auto id : those)
		if (id >= 0) among[size_t(id)] = 1;
	const auto has = [&](int id) { return id >= 0 && size_t(id) < among.size() && among[size_t(id)]; };
	const std::lock_guard<std::mutex> lock(recording);
	return std::count_if(
	        broken.begin(), broken.end(), [&](const auto& bond) { return has(bond->id1) && has(bond->id2); });
}

boost::python::dict Law2_ScGeom_BondedPhys_Bonded::brokenArrays() const
{
	std::vector<shared_ptr<BrokenBond>> now;
	{
		const std::lock_guard<std::mutex> lock(recording);
		now = broken;
	}
	return yade::brokenArrays(now);
}

namespace {

	/// Bonds that hold in the current scene, as of the last step.
	std::vector<BondNow> bondsOfScene()
	{
		const auto current = Omega::instance().getScene();
		auto* const loop   = BondedInteractionLoop::in(*current);
		if (loop) {
			auto all = loop->bondsNow();
			if (!all.empty() && Omega::instance().isRunning()) return all;
			loop->expose();
		}
		std::vector<BondNow>              all;
		const std::lock_guard<std::mutex> lock(current->interactions->drawloopmutex); // a run may begin now
		for (const auto& I : *current->interactions) {
			const auto* phys = dynamic_cast<const BondedPhys*>(I->phys.get());
			const auto* geom = dynamic_cast<const ScGeom*>(I->geom.get());
			if (phys && geom && phys->bonded)
				all.push_back({ I->getId1(), I->getId2(), phys->normalStress, phys->shearStress,
				                phys->bondRadius, -phys->normalForce.dot(geom->normal),
				                phys->shearForce.norm() });
		}
		return all;
	}

} // namespace

boost::python::dict Law2_ScGeom_BondedPhys_Bonded::bondArrays() const { return yade::bondArrays(bondsOfScene()); }

boost::python::dict Law2_ScGeom_BondedPhys_Bonded::bonds() const
{
	std::map<std::pair<int, int>, BondNow> all;
	for (const BondNow& bond : bondsOfScene())
		all[std::minmax(bond.id1, bond.id2)] = bond;
	std::vector<Vector2i> ids;
	std::vector<Real>     normalStress, shearStress, radius;
	for (const auto& [pair, bond] : all) {
		ids.emplace_back(pair.first, pair.second);
		normalStress.push_back(bond.normalStress);
		shearStress.push_back(bond.shearStress);
		radius.push_back(bond.radius);
	}
	boost::python::dict result;
	result["ids"]          = ids;
	result["normalStress"] = normalStress;
	result["shearStress"]  = shearStress;
	result["radius"]       = radius;
	return result;
}

boost::python::dict Law2_ScGeom_BondedPhys_Bonded::largestStresses() const
{
	const auto current = Omega::instance().getScene();
	for (const auto& engine : current->engines)
		if (auto* loop = dynamic_cast<BondedInteractionLoop*>(engine.get())) loop->expose();
	Real tension = 0, bending = 0, shear = 0, torsion = 0;
	const std::lock_guard<std::mutex> lock(current->interactions->drawloopmutex); // a run may begin now
	for (const auto& I : *current->interactions) {
		const auto* phys = dynamic_cast<const BondedPhys*>(I->phys.get());
		if (!phys || !phys->bonded || !I->geom) continue;
		const State&          state1 = *(*current->bodies)[I->getId1()]->state;
		const State&          state2 = *(*current->bodies)[I->getId2()]->state;
		const Vector3r        branch = branchIn(*current, *I);
		ddem::BreakableBond   bond   = phys->bond(static_cast<const ScGeom&>(*I->geom));
		ddem::BondAnswer      answer {};
		const ddem::BondLoads   loads = loadsOf(bond, branch, state1, state2, answer);
		const ddem::BondSection section(phys->bondRadius);
		const auto &            force = loads.section.force, &moment = loads.section.moment;
		tension = math::max(tension, math::abs(force.x) / section.area);
		shear   = math::max(shear, std::hypot(force.y, force.z) / section.area);
		bending = math::max(bending, std::hypot(moment.y, moment.z) / section.bendingModulus);
		torsion = math::max(torsion, math::abs(moment.x) / section.torsionModulus);
	}
	boost::python::dict result;
	result["tension"] = tension;
	result["bending"] = bending;
	result["shear"]   = shear;
	result["torsion"] = torsion;
	return result;
}

Real Law2_ScGeom_BondedPhys_Bonded::criticalTimeStep()
{
	return bondedStableStep(*Omega::instance().getScene()).step;
}

} // namespace yade
