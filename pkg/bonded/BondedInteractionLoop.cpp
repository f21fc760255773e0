// GPL v2 or later, see LICENSE.
// An InteractionLoop that computes all bonds together.
#include <pkg/bonded/BondedInteractionLoop.hpp>
#include <pkg/bonded/BondedNewtonIntegrator.hpp>
#include <pkg/bonded/ViscousBodyDamping.hpp>

#include <pkg/ddem/kernel/algebra/EigenSpace.hpp>

#include <pkg/common/InsertionSortCollider.hpp>
#include <pkg/dem/Ig2_Sphere_Sphere_ScGeom.hpp>

#include <algorithm>
#include <exception>
#include <set>
#include <sstream>
#include <typeinfo>

namespace yade {

DDEM_PLUGIN((BondedInteractionLoop))

bool BondedInteractionLoop::neverLooksAtBonds(const Engine& engine)
{
	static const std::set<std::string> names { "ForceResetter", "NewtonIntegrator",      "BondedNewtonIntegrator",
		                                   "ForceEngine",   "InsertionSortCollider", "BondedInteractionLoop",
		                                   "TorqueEngine",  "DeformableTimeStepper", "DeformableEngine",
		                                   "JacketPressure" };
	return names.count(engine.getClassName()) > 0 || dynamic_cast<const KinematicEngine*>(&engine)
	        || dynamic_cast<const ViscousBodyDamping*>(&engine);
}

namespace {

	Collider* colliderOf(const Scene& scene)
	{
		for (const auto& engine : scene.engines)
			if (auto* collider = dynamic_cast<Collider*>(engine.get())) return collider;
		return nullptr;
	}

	/// How often a collider has acted, -1 where it does not tell.
	long runsOf(const Collider* collider)
	{
		const auto* const sorting = dynamic_cast<const InsertionSortCollider*>(collider);
		return sorting ? sorting->numAction : -1;
	}

} // namespace

BondedInteractionLoop* BondedInteractionLoop::in(const Scene& scene)
{
	for (const auto& engine : scene.engines)
		if (auto* loop = dynamic_cast<BondedInteractionLoop*>(engine.get())) return loop;
	return nullptr;
}

Law2_ScGeom_BondedPhys_Bonded* BondedInteractionLoop::law() const
{
	for (const auto& functor : lawDispatcher->functors)
		if (auto* found = dynamic_cast<Law*>(functor.get())) return found;
	return nullptr;
}

bool BondedInteractionLoop::oneByOne() const
{
	return !callbacks.empty() || loopOnSortedInteractions || ompThreads > 0 || scene->isPeriodic;
}

void BondedInteractionLoop::action()
{
	pythonLooks::watched(); // takes Python's own lock once, so not while others may wait for ours
	pythonLooks::end(*this);
	process.require(*scene);
	Law* const bondLaw = law();
	batched            = bondLaw && !oneByOne();
	if (batched) {
		try {
			return actBatched(*bondLaw);
		} catch (...) {
			leaveBatched(); // for who looks for the cause
			throw;
		}
	}
	leaveBatched();
	if (bondLaw && guard.isDue(*scene, false)) guard.check(*scene);
	InteractionLoop::action();
	throwFailure();
}

/// Hands bonds and spheres back to YADE's objects.
void BondedInteractionLoop::leaveBatched()
{
	const std::lock_guard<std::mutex> lock(busy);
	if (system.size() == held.size()) writeBack();
	spheres.leave();
	held.clear();
	contacts.clear();
	exposed = true;
	known   = -1;
}

void BondedInteractionLoop::actBatched(Law& bondLaw)
{
	const auto* const integrator = BondedNewtonIntegrator::in(*scene);
	lawDispatcher->scene = physDispatcher->scene = geomDispatcher->scene = scene;
	geomDispatcher->updateScenePtr();
	physDispatcher->updateScenePtr();
	lawDispatcher->updateScenePtr();
	{
		const std::lock_guard<std::mutex> lock(busy);
		poseAtLook.clear();
		const bool fromState = spheres.update(*scene, integrator);
		if (fromState || !interactionsAreKnown()) collect(bondLaw);
	}
	spheres.release();
	if (guard.isDue(*scene, true)) {
		spheres.showPicture();
		guard.check(*scene);
	}
	{
		const std::lock_guard<std::mutex> lock(busy);
		advance(bondLaw);
	}
	actOnOthers();
	throwFailure();
	const std::lock_guard<std::mutex> lock(busy);
	spheres.showGuestLoads(scene->forces);
	if (integrator && looksBetween(*scene, *this, *integrator, neverLooksAtBonds, 0.01)) {
		spheres.moveLoads(scene->forces);
		spheres.showToAll();
	}
	const Onlooker who  = onlooker(*scene, *this, showings, neverLooksAtBonds, 0.01);
	const bool     lags = who == Onlooker::Python && pythonLooks::watched();
	if (lags) {
		poseAtLook = spheres.motion.pose;
		pythonLooks::begin(*this);
	}
	if (lags ? showings.due() : who != Onlooker::Nobody) {
		showings.begin();
		writeBack();
		showings.end();
	}
}

void BondedInteractionLoop::stopAfterStep(const std::string& text)
{
	const std::lock_guard<std::mutex> lock(failing);
	if (stopping.empty()) stopping = text;
}

void BondedInteractionLoop::throwFailure()
{
	const std::lock_guard<std::mutex> lock(failing);
	if (!stopping.empty()) throw std::runtime_error(std::exchange(stopping, {}));
}

void stopAfterStep(Scene& scene, const std::string& text)
{
	if (auto* const loop = BondedInteractionLoop::in(scene)) return loop->stopAfterStep(text);
	std::cerr << "ERROR: " << text << std::endl; // an InteractionLoop ends the program where a functor throws
	Omega::instance().pause();
}

bool BondedInteractionLoop::colliderIsDue() const
{
	Collider* const collider = colliderOf(*scene);
	return collider && !collider->dead && (!collider->scene || collider->isActivated());
}

/// Whether the interactions of the scene are those that were collected.
bool BondedInteractionLoop::interactionsAreKnown()
{
	InteractionContainer& all = *scene->interactions;
	if (known != BondedPhys::bondsMade || knownScene != scene || all.size() != knownSize
	    || 8 * broken > held.size())
		return false;
	const long runs = runsOf(colliderOf(*scene));
	if (runs != colliderRuns) return false;
	if (!exposed && runs >= 0) return true; // nobody had a chance to change any
	const auto isThere = [&all](const shared_ptr<Interaction>& I) {
		const auto place = size_t(I->linIx);
		return place < all.size() && all[place] == I;
	};
	for (size_t j = 0; j < held.size(); j++)
		if (const auto& I = held[j].interaction;
		    I && (!isThere(I) || I->phys.get() != held[j].phys || !I->geom || (exposed && !constantsHold(j))))
			return false;
	for (const Pair& pair : pairs)
		if (!isThere(pair.interaction) || pair.interaction->phys.get() != pair.phys) return false;
	for (const Contact& contact : contacts) { // somebody who looked may have changed its springs
		const BondedPhys& phys = *pairs[size_t(contact.pair)].phys;
		if (phys.kn != contact.state.stiffness.normal || phys.ks != contact.state.stiffness.shear) return false;
	}
	for (const auto& I : others)
		if (!isThere(I)) return false;
	return true;
}

/// Whether what the system was made from is still so; somebody who looked may have changed it.
bool BondedInteractionLoop::constantsHold(size_t bond) const
{
	const BondedPhys& phys = *held[bond].phys;
	const auto&       geom = static_cast<const ScGeom&>(*held[bond].interaction->geom);
	const auto        is
	        = [&](ddem::BondSystem::Constant which, Real value) { return system.constant(which, bond) == value; };
	using System           = ddem::BondSystem;
	return phys.bonded && is(System::Normal, phys.kn) && is(System::Shear, phys.ks)
	        && is(System::Radius1, geom.radius1) && is(System::Radius2, geom.radius2);
}

/// What InteractionLoop does, for all interactions that are not followed here.
void BondedInteractionLoop::actOnOthers()
{
	startContacts();
	spheres.show(otherRows);
	InteractionContainer& all          = *scene->interactions;
	const bool            removeUnseen = all.iterColliderLastRun >= 0 && all.iterColliderLastRun == scene->iter;
	const long            size         = long(others.size());
	std::exception_ptr    failure; // none may leave a parallel loop
#pragma omp parallel for schedule(guided) if (size > 20)
	for (long i = 0; i < size; i++) {
		const shared_ptr<Interaction>& I = others[size_t(i)];
		try {
			if ((removeUnseen && !I->isReal() && I->iterLastSeen < scene->iter) || !act(I))
				all.requestErase(I);
		} catch (...) {
#pragma omp critical(BondedInteractionLoopFailure)
			failure = std::current_exception();
		}
	}
	if (failure) std::rethrow_exception(failure);
}

/// Lets functors make the contact of pairs that have begun to touch; it acts from the same step on.
void BondedInteractionLoop::startContacts()
{
	for (const std::int32_t p : fresh) {
		Pair&              pair  = pairs[size_t(p)];
		const std::int32_t first = search.firstOf(size_t(p)), second = search.secondOf(size_t(p));
		spheres.show({ first, second });
		spheres.addForeign(first, second);
		if (!act(pair.interaction)) scene->interactions->requestErase(pair.interaction);
		pair.phys = pair.interaction->isReal() ? dynamic_cast<BondedPhys*>(pair.interaction->phys.get())
		                                       : nullptr;
		if (!pair.phys) continue;
		pair.reach = pair.phys->contactReach;
		followContact(size_t(p));
	}
	fresh.clear();
}

/// \returns whether the interaction may stay
bool BondedInteractionLoop::act(const shared_ptr<Interaction>& I)
{
	const auto& bodies = *scene->bodies;
	if (!bodies.exists(I->getId1()) || !bodies.exists(I->getId2())) return false;
	Body *body1 = bodies[I->getId1()].get(), *body2 = bodies[I->getId2()].get();
	if (body1->isClump() || body2->isClump() || !body1->shape || !body2->shape || !I->functorCache.geomExists)
		return true;
	auto& functors = I->functorCache;
	bool  swap     = false;
	if (!functors.geom) {
		functors.geom       = geomDispatcher->getFunctor2D(body1->shape, body2->shape, swap);
		functors.geomExists = bool(functors.geom);
		if (!functors.geom) return true; // for ever without interaction
		if (swap) {
			I->swapOrder();
			std::swap(body1, body2);
		}
	}
	const bool wasReal = I->isReal();
	if (!functors.geom->go(body1->shape, body2->shape, *body1->state, *body2->state, Vector3r::Zero(), false, I))
		return !wasReal;
	if (!functors.phys) functors.phys = physDispatcher->getFunctor2D(body1->material, body2->material, swap);
	if (!functors.phys)
		throw std::runtime_error(
		        "BondedInteractionLoop has no Ip2 functor for " + body1->material->getClassName() + " and "
		        + body2->material->getClassName());
	functors.phys->go(body1->material, body2->material, I);
	if (!wasReal) {
		I->iterMadeReal = scene->iter;
		guard.see(*scene, *I);
	}
	if (!functors.constLaw) functors.constLaw = lawDispatcher->getFunctor2D(I->geom, I->phys, swap);
	if (!functors.constLaw)
		throw std::runtime_error(
		        "BondedInteractionLoop has no Law2 functor for " + I->geom->getClassName() + " and "
		        + I->phys->getClassName());
	return functors.constLaw->go(I->geom, I->phys, I.get());
}

/// Whether pairs of spheres are those of YADE's usual geometry, which is that of the search.
bool BondedInteractionLoop::followsPairs() const
{
	for (const auto& functor : geomDispatcher->functors)
		if (const auto* geometry = dynamic_cast<const Ig2_Sphere_Sphere_ScGeom*>(functor.get()))
			return typeid(*geometry) == typeid(Ig2_Sphere_Sphere_ScGeom)
			        && geometry->interactionDetectionFactor == 1;
	return false;
}

void BondedInteractionLoop::collect(Law& bondLaw)
{
	writeBack();
	held.clear();
	pairs.clear();
	others.clear();
	std::vector<Pair> found;
	following = followsPairs();
	for (const auto& I : *scene->interactions) {
		const std::int32_t first = spheres.rowOf(I->getId1()), second = spheres.rowOf(I->getId2());
		auto* const phys = I->isReal() ? dynamic_cast<BondedPhys*>(I->phys.get()) : nullptr;
		if (phys && phys->bonded && first >= 0 && second >= 0) held.push_back({ I, phys });
		else if (following && first >= 0 && second >= 0 && (phys ? !phys->bonded : !I->isReal())
		         && I->functorCache.geomExists
		         && !spheres.isClumpMember(size_t(first)) && !spheres.isClumpMember(size_t(second)))
			found.push_back({ I, phys, spheres.radius[size_t(first)], spheres.radius[size_t(second)],
			          phys ? phys->contactReach : 0 });
		else
			others.push_back(I);
	}
	// Interactions lie in an order that depends on the past; sums must not.
	const auto byIds = [](const auto& a, const auto& b) { return *a.interaction < *b.interaction; };
	std::sort(held.begin(), held.end(), byIds);
	std::sort(found.begin(), found.end(), byIds);

	takeUpBonds(bondLaw, std::exchange(held, {}));
	system.assemble(spheres.ids.size());
	held.resize(system.size());
	search.clear();
	contacts.clear();
	fresh.clear();
	for (Pair& pair : found) {
		const Interaction& I = *pair.interaction;
		follow(pair, spheres.rowOf(I.getId1()), spheres.rowOf(I.getId2()));
	}
	std::set<std::int32_t> rows;
	for (const auto& I : others)
		for (const auto id : { I->getId1(), I->getId2() })
			if (spheres.rowOf(id) >= 0) rows.insert(spheres.rowOf(id));
	otherRows.assign(rows.begin(), rows.end());
	spheres.setForeign(otherRows);

	colliderRuns = runsOf(colliderOf(*scene));
	spheres.boundsAreNew();
	broken     = 0;
	known      = BondedPhys::bondsMade;
	knownScene = scene;
	knownSize  = scene->interactions->size();
	exposed    = true;
}

/// Fills the system with bonds, those of one criterion after the other, and `held` with what they belong to.
void BondedInteractionLoop::takeUpBonds(Law& bondLaw, std::vector<Held> bonds)
{
	system.clear();
	overloaded.clear();
	const bool esys = bondLaw.bondConvention() == ddem::BondConvention::Esys;
	std::stable_sort(bonds.begin(), bonds.end(), [](const Held& a, const Held& b) {
		return a.phys->criterion < b.phys->criterion;
	});
	for (const Held& bond : bonds) {
		const Interaction& I     = *bond.interaction;
		const auto         place = system.add(
                        spheres.rowOf(I.getId1()), spheres.rowOf(I.getId2()),
                        bond.phys->bond(static_cast<const ScGeom&>(*I.geom)));
		held.resize(place + 1); // places that hold no bond stay empty
		held[place] = bond;
		if (esys && bondLaw.failsInEsys(*bond.phys)) overloaded.push_back(std::int32_t(place));
	}
}

/// Takes a pair into the search; it is followed from now on if it touches.
void BondedInteractionLoop::follow(Pair pair, std::int32_t first, std::int32_t second)
{
	const auto place = pairs.size();
	search.add(first, second, pair.radius1 + pair.radius2);
	pairs.push_back(std::move(pair));
	if (pairs.back().phys) followContact(place);
}

void BondedInteractionLoop::followContact(std::size_t place)
{
	const Pair& pair   = pairs[place];
	const auto  massOf = [this](std::int32_t r) { return (*scene->bodies)[spheres.ids[size_t(r)]]->state->mass; };
	search.follow(place, true);
	contacts.push_back({ std::int32_t(place),
	                     pair.phys->contactNow(massOf(search.firstOf(place)), massOf(search.secondOf(place))),
	                     {},
	                     false });
	ordered = false;
}

/// Sums must not depend on when contacts have begun: after loading nobody knows.
void BondedInteractionLoop::orderContacts()
{
	if (std::exchange(ordered, true)) return;
	const auto rows = [this](const Contact& contact) {
		const auto place = size_t(contact.pair);
		return std::make_pair(search.firstOf(place), search.secondOf(place));
	};
	std::sort(contacts.begin(), contacts.end(), [&](const Contact& a, const Contact& b) {
		return rows(a) < rows(b);
	});
}

void BondedInteractionLoop::advance(Law& bondLaw)
{
	const bool        esys   = bondLaw.bondConvention() == ddem::BondConvention::Esys, book = scene->trackEnergy;
	orderContacts();
	const std::size_t before = contacts.size();
	parted.clear();
	if (esys) breakOverloaded(bondLaw, overloaded); // ESyS-Particle tests the loads of the last step
	double* const load   = spheres.motion.load.data();
	const auto energies = system.step(bondLaw.bondConvention(), book, spheres.motion.pose.data(), load, overloaded);
	exposed              = false;
	for (const std::int32_t bond : overloaded) {
		const auto& row = system.row(size_t(bond));
		if (!held[size_t(bond)].interaction) continue; // broken, but one of its bodies has lost its place
		if (!std::isfinite(row.normalStress) || !std::isfinite(row.shearStress)) stopAtNotFinite(bond);
	}
	Real broke = 0; // what was stored in bonds that break now
	if (!esys) {
		for (const std::int32_t bond : overloaded)
			if (held[size_t(bond)].interaction) broke += system.row(size_t(bond)).energy;
		breakOverloaded(bondLaw, overloaded);
	}
	if (book) bondLaw.bookBondEnergy(energies.stored - broke, energies.lost);
	search.find(spheres.motion.pose.data(), spheres.takeWay(), fresh);
	advanceContacts(bondLaw, before);
	for (const Parted& pair : parted)
		addLoads(pair.first, pair.second, pair.loads);
}

/// One step of the contacts that there were at its beginning.
void BondedInteractionLoop::advanceContacts(Law& bondLaw, std::size_t count)
{
#pragma omp parallel for schedule(static) if (count > 100) // else waking threads takes longer
	for (std::ptrdiff_t k = 0; k < std::ptrdiff_t(count); k++) {
		Contact& contact = contacts[size_t(k)];
		contact.loads    = bondLaw.advance(contact.state, motionOf(size_t(contact.pair)));
		contact.ahead    = true;
	}
	// one thread, in order: sums do not depend on threads
	const bool  book = scene->trackEnergy;
	std::size_t kept = 0;
	for (std::size_t k = 0; k < contacts.size(); k++) {
		const auto place = size_t(contacts[k].pair);
		if (k < count) {
			const ddem::ContactLoads& loads = contacts[k].loads;
			addLoads(search.firstOf(place), search.secondOf(place), loads);
			if (book) bondLaw.bookContact(loads);
			if (!loads.touching && !touches(place)) {
				scene->interactions->requestErase(pairs[place].interaction);
				pairs[place].phys = nullptr;
				search.follow(place, false);
				continue;
			}
		}
		if (kept != k) contacts[kept] = contacts[k];
		kept++;
	}
	contacts.resize(kept);
}

/// Whether the spheres of a pair overlap; those that were bonded with an overlap may have a shorter reach than that.
bool BondedInteractionLoop::touches(std::size_t place) const
{
	const double* const x1 = spheres.motion.poseOf(size_t(search.firstOf(place)));
	const double* const x2 = spheres.motion.poseOf(size_t(search.secondOf(place)));
	return Vector3r(x2[0] - x1[0], x2[1] - x1[1], x2[2] - x1[2]).norm() < search.reachOf(place);
}

ddem::ContactMotion BondedInteractionLoop::motionOf(std::size_t place) const
{
	const auto          first = size_t(search.firstOf(place)), second = size_t(search.secondOf(place));
	const double *const x1 = spheres.motion.poseOf(first), *const x2 = spheres.motion.poseOf(second);
	const double *const v1 = spheres.motion.velocityOf(first), *const v2 = spheres.motion.velocityOf(second);
	const Vector3r      branch(x2[0] - x1[0], x2[1] - x1[1], x2[2] - x1[2]);
	const Pair&         pair = pairs[place];
	const Real distance = branch.norm(), share = pair.reach / (pair.radius1 + pair.radius2);
	return { branch / distance,
		 distance,
		 share * pair.radius1,
		 share * pair.radius2,
		 { v2[0] - v1[0], v2[1] - v1[1], v2[2] - v1[2] },
		 { v1[4], v1[5], v1[6] },
		 { v2[4], v2[5], v2[6] } };
}

void BondedInteractionLoop::addLoads(std::int32_t first, std::int32_t second, const ddem::ContactLoads& loads)
{
	if (!loads.touching) return;
	double *const a = spheres.motion.loadOf(size_t(first)), *const b = spheres.motion.loadOf(size_t(second));
	for (int axis = 0; axis < 3; axis++) {
		a[axis] += loads.force[axis];
		b[axis] -= loads.force[axis];
		a[4 + axis] += loads.moment1[axis];
		b[4 + axis] += loads.moment2[axis];
	}
}

void BondedInteractionLoop::breakOverloaded(Law& bondLaw, const std::vector<std::int32_t>& bonds)
{
	for (const std::int32_t bond : bonds) {
		const auto place = size_t(bond);
		Held&      h     = held[place];
		if (!h.interaction) continue;
		const auto& row = system.row(place);
		const ddem::BondStress last = exposed ? ddem::BondStress { h.phys->normalStress, h.phys->shearStress }
		                                      : ddem::BondStress { row.normalStress, row.shearStress };
		const std::int32_t first = system.firstOf(place), second = system.secondOf(place);
		exposeGeometry(*h.interaction);
		h.phys->setMemory(system.memoryOf(place));
		spheres.show({ first, second });
		const ddem::ContactLoads loads = bondLaw.breakBond(*h.interaction, last);
		if (scene->trackEnergy) bondLaw.bookContact(loads);
		parted.push_back({ first, second, loads });
		const auto& geom = static_cast<const ScGeom&>(*h.interaction->geom);
		Pair        pair { h.interaction, h.phys, geom.radius1, geom.radius2, h.phys->contactReach };
		if (!bondLaw.touching(*h.interaction)) {
			scene->interactions->requestErase(h.interaction);
			pair.phys = nullptr;
		}
		if (following && !spheres.isClumpMember(size_t(first)) && !spheres.isClumpMember(size_t(second)))
			follow(pair, first, second);
		else
			known = -1; // its functors come from the next step on
		system.remove(place, spheres.motion.load.data());
		h = {};
		broken++;
	}
}

void BondedInteractionLoop::expose()
{
	const std::lock_guard<std::mutex> lock(busy);
	writeBack();
	spheres.showPicture();
}

/// Where Python reads or writes what belongs to an interaction, while it looks. Without a lock: other threads of Python
/// wait for Python's own, and action() begins with the end of the look.
void BondedInteractionLoop::showAll() { writeBack(); }

boost::python::object BondedInteractionLoop::sphereArray(const boost::python::object& ids, const std::string& name)
{
	const auto        current = Omega::instance().getScene();
	auto* const       loop    = in(*current);
	const auto        lock    = loop ? std::unique_lock<std::mutex>(loop->busy) : std::unique_lock<std::mutex>();
	return yade::sphereArray(*current, loop ? &loop->spheres : nullptr, ids, name);
}

std::vector<BondNow> BondedInteractionLoop::bondsNow() const
{
	const std::lock_guard<std::mutex> lock(busy);
	std::vector<BondNow>              result;
	result.reserve(held.size());
	for (size_t j = 0; j < held.size(); j++) {
		const auto& I = held[j].interaction;
		if (!I || !I->geom) continue;
		const auto&    row   = system.row(j);
		const Vector3r force = ddem::eigenVector(row.force),
		               along = exposed ? static_cast<const ScGeom&>(*I->geom).normal
		                               : Vector3r((placeOf(I->getId2()) - placeOf(I->getId1())).normalized());
		const Real     axial = force.dot(along); // on the first body: tension pulls it along the branch
		result.push_back(
		        { I->getId1(), I->getId2(), row.normalStress, row.shearStress, held[j].phys->bondRadius, axial,
		          (force - axial * along).norm() });
	}
	return result;
}

/// Where a sphere was when its bonds were computed.
Vector3r BondedInteractionLoop::placeOf(Body::id_t id) const
{
	const auto&         pose = poseAtLook.empty() ? spheres.motion.pose : poseAtLook;
	const double* const x    = pose.data() + ddem::sphereRow * spheres.rowOf(id);
	return { x[0], x[1], x[2] };
}

void BondedInteractionLoop::writeBack()
{
	if (exposed) return;
	exposed = true;
	for (size_t j = 0; j < held.size(); j++) {
		// broken, or erased by somebody
		if (!held[j].interaction || !held[j].interaction->geom
		    || held[j].interaction->phys.get() != held[j].phys)
			continue;
		exposeGeometry(*held[j].interaction);
		BondedPhys&    phys  = *held[j].phys;
		const auto&    geom  = static_cast<const ScGeom&>(*held[j].interaction->geom);
		const auto&    row   = system.row(j);
		const Vector3r force = ddem::eigenVector(row.force);
		phys.normalForce     = -force.dot(geom.normal) * geom.normal;
		phys.shearForce      = -force - phys.normalForce;
		phys.normalStress    = row.normalStress;
		phys.shearStress     = row.shearStress;
		phys.setMemory(system.memoryOf(j));
	}
	for (Contact& contact : contacts) {
		const Pair& pair = pairs[size_t(contact.pair)];
		if (!contact.ahead || !pair.interaction->geom || pair.interaction->phys.get() != pair.phys) continue;
		exposeGeometry(*pair.interaction);
		pair.phys->setContact(
		        contact.state.memory, contact.loads.force,
		        static_cast<const ScGeom&>(*pair.interaction->geom).normal);
		contact.ahead = false;
	}
}

void BondedInteractionLoop::exposeGeometry(Interaction& I) const
{
	auto&          geom     = static_cast<ScGeom&>(*I.geom);
	const Vector3r branch   = placeOf(I.getId2()) - placeOf(I.getId1());
	const Real     distance = branch.norm();
	geom.normal             = branch / distance;
	geom.penetrationDepth   = geom.radius1 + geom.radius2 - distance;
	geom.contactPoint       = placeOf(I.getId1()) + (geom.radius1 - geom.penetrationDepth / 2) * geom.normal;
}

void BondedInteractionLoop::stopAtNotFinite(std::int32_t bond) const
{
	const Interaction& I = *held[size_t(bond)].interaction;
	const Vector3r     x = (*scene->bodies)[I.getId1()]->state->refPos;
	std::ostringstream text;
	text << "the bond of bodies #" << I.getId1() << " and #" << I.getId2()
	     << " became infinite or not a number in step " << scene->iter << ", t = " << scene->time << " s; #"
	     << I.getId1() << " was at (" << x[0] << ", " << x[1] << ", " << x[2]
	     << ") m at the start; check O.dt = " << scene->dt
	     << " s against ddem.bonded.critical_time_step(), and what moves these bodies";
	throw std::runtime_error(text.str());
}

} // namespace yade
