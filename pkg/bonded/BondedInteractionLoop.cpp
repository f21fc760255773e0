// GPL v2 or later, see LICENSE.
// An InteractionLoop that computes all bonds together.
#include <pkg/bonded/BondedInteractionLoop.hpp>
#include <pkg/bonded/ViscousBodyDamping.hpp>

#include <pkg/ddem/kernel/algebra/EigenSpace.hpp>

#include <algorithm>
#include <exception>
#include <set>
#include <sstream>

namespace yade {

DDEM_PLUGIN((BondedInteractionLoop))

namespace {

	/// Engines that look at no bond.
	bool neverLooksAtBonds(const Engine& engine)
	{
		static const std::set<std::string> names { "ForceResetter", "NewtonIntegrator", "InsertionSortCollider",
			                                   "ForceEngine",   "TorqueEngine",     "DeformableEngine" };
		return names.count(engine.getClassName()) > 0 || dynamic_cast<const KinematicEngine*>(&engine)
		        || dynamic_cast<const ViscousBodyDamping*>(&engine);
	}

} // namespace

Law2_ScGeom_BondedPhys_MohrCoulomb* BondedInteractionLoop::law() const
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
	process.require(*scene);
	Law* const bondLaw = law();
	if (!bondLaw || oneByOne()) {
		const std::lock_guard<std::mutex> lock(busy);
		writeBack();
		held.clear();
		known = -1;
	} else {
		const std::lock_guard<std::mutex> lock(busy);
		if (!locateHeld()) {
			collect(*bondLaw);
			locateHeld();
		}
	}
	if (bondLaw) guard.check(*scene, known >= 0);
	if (known < 0) {
		InteractionLoop::action();
		throwFailure();
		return;
	}
	actOnOthers();
	throwFailure();
	const std::lock_guard<std::mutex> lock(busy);
	advance(*bondLaw);
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
	for (const auto& engine : scene.engines)
		if (auto* loop = dynamic_cast<BondedInteractionLoop*>(engine.get())) return loop->stopAfterStep(text);
	std::cerr << "ERROR: " << text << std::endl; // an InteractionLoop ends the program where a functor throws
	Omega::instance().pause();
}

bool BondedInteractionLoop::locateHeld()
{
	if (known != BondedPhys::bondsMade || knownScene != scene || 8 * broken > held.size()) return false;
	InteractionContainer& all = *scene->interactions;
	isHeld.assign(all.size(), 0);
	for (const Held& h : held) {
		if (!h.interaction) continue;
		const auto place = size_t(h.interaction->linIx);
		// somebody has erased it
		if (place >= all.size() || all[place] != h.interaction || h.interaction->phys.get() != h.phys
		    || !h.interaction->geom)
			return false;
		if (exposed && !constantsHold(size_t(&h - held.data()))) return false;
		isHeld[place] = 1;
	}
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

/// What InteractionLoop does, for everything but the bonds.
void BondedInteractionLoop::actOnOthers()
{
	lawDispatcher->scene = physDispatcher->scene = geomDispatcher->scene = scene;
	geomDispatcher->updateScenePtr();
	physDispatcher->updateScenePtr();
	lawDispatcher->updateScenePtr();
	InteractionContainer& all          = *scene->interactions;
	const bool            removeUnseen = all.iterColliderLastRun >= 0 && all.iterColliderLastRun == scene->iter;
	const long            size         = long(all.size());
	std::exception_ptr    failure; // none may leave a parallel loop
#pragma omp parallel for schedule(guided)
	for (long i = 0; i < size; i++) {
		if (isHeld[size_t(i)]) continue;
		const shared_ptr<Interaction>& I = all[size_t(i)];
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

/// \returns whether the interaction may stay
bool BondedInteractionLoop::act(const shared_ptr<Interaction>& I)
{
	const auto& bodies = *scene->bodies;
	Body *body1 = bodies[I->getId1()].get(), *body2 = bodies[I->getId2()].get();
	if (!body1 || !body2) return false;
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

void BondedInteractionLoop::collect(Law& bondLaw)
{
	writeBack();
	held.clear();
	for (const auto& I : *scene->interactions) {
		auto* phys = I->isReal() ? dynamic_cast<BondedPhys*>(I->phys.get()) : nullptr;
		if (phys && phys->bonded) held.push_back({ I, phys });
	}
	// Interactions lie in an order that depends on the past; sums must not.
	std::sort(
	        held.begin(), held.end(), [](const Held& a, const Held& b) { return *a.interaction < *b.interaction; });

	system.clear();
	particles.clear();
	overloaded.clear();
	std::vector<std::int32_t> place(scene->bodies->size(), -1);
	const auto                placeOf = [&](Body::id_t id) {
                std::int32_t& p = place[size_t(id)];
                if (p < 0) {
                        p = std::int32_t(particles.size());
                        particles.push_back(id);
                }
                return p;
	};
	for (size_t j = 0; j < held.size(); j++) {
		const Interaction& I = *held[j].interaction;
		const BondedPhys&  phys = *held[j].phys;
		const std::int32_t first = placeOf(I.getId1()), second = placeOf(I.getId2());
		system.add(first, second, phys.bond(static_cast<const ScGeom&>(*I.geom)), phys.strength());
		if (bondLaw.bondConvention() == ddem::BondConvention::Esys
		    && ddem::bondFailure(phys.strength(), { phys.normalStress, phys.shearStress })
		            != ddem::BondFailure::None)
			overloaded.push_back(std::int32_t(j));
	}
	system.assemble(particles.size());
	broken     = 0;
	known      = BondedPhys::bondsMade;
	knownScene = scene;
	exposed    = true;
}

void BondedInteractionLoop::fetchPoses()
{
	const long size = long(particles.size());
#pragma omp parallel for schedule(static)
	for (long p = 0; p < size; p++) {
		const State&  state = *(*scene->bodies)[particles[size_t(p)]]->state;
		double* const to    = system.pose.data() + 8 * p;
		for (int axis = 0; axis < 3; axis++)
			to[axis] = state.pos[axis];
		to[4] = state.ori.w();
		to[5] = state.ori.x();
		to[6] = state.ori.y();
		to[7] = state.ori.z();
	}
}

void BondedInteractionLoop::advance(Law& bondLaw)
{
	const bool esys = bondLaw.bondConvention() == ddem::BondConvention::Esys;
	fetchPoses();
	if (esys) breakOverloaded(bondLaw, overloaded); // ESyS-Particle tests the loads of the last step
	const Real stored = system.step(bondLaw.bondConvention(), scene->trackEnergy, overloaded);
	exposed           = false;
	for (const std::int32_t bond : overloaded) {
		const auto& row = system.row(size_t(bond));
		if (!held[size_t(bond)].interaction) continue; // broken, but one of its bodies has lost its place
		if (!std::isfinite(row.normalStress) || !std::isfinite(row.shearStress)) stopAtNotFinite(bond);
	}
	Real lost = 0;
	if (!esys) {
		for (const std::int32_t bond : overloaded)
			if (held[size_t(bond)].interaction) lost += system.row(size_t(bond)).energy;
		breakOverloaded(bondLaw, overloaded);
	}
	applyLoads();
	if (scene->trackEnergy) bondLaw.bookBondEnergy(stored - lost);
	if (onlooker(*scene, *this, showings, neverLooksAtBonds, 0.01) != Onlooker::Nobody) {
		showings.begin();
		writeBack();
		showings.end();
	}
}

void BondedInteractionLoop::breakOverloaded(Law& bondLaw, const std::vector<std::int32_t>& bonds)
{
	for (const std::int32_t bond : bonds) {
		Held& h = held[size_t(bond)];
		if (!h.interaction) continue;
		const auto& row = system.row(size_t(bond));
		const ddem::BondStress last = exposed ? ddem::BondStress { h.phys->normalStress, h.phys->shearStress }
		                                      : ddem::BondStress { row.normalStress, row.shearStress };
		exposeGeometry(size_t(bond));
		if (!bondLaw.breakBond(*h.interaction, last)) scene->interactions->requestErase(h.interaction);
		system.remove(size_t(bond));
		h = {};
		broken++;
	}
}

void BondedInteractionLoop::applyLoads()
{
	const long size = long(particles.size());
#pragma omp parallel for schedule(static)
	for (long p = 0; p < size; p++) {
		const double* const load = system.load.data() + 6 * p;
		scene->forces.addForce(particles[size_t(p)], Vector3r(load[0], load[1], load[2]));
		scene->forces.addTorque(particles[size_t(p)], Vector3r(load[3], load[4], load[5]));
	}
}

void BondedInteractionLoop::expose()
{
	const std::lock_guard<std::mutex> lock(busy);
	writeBack();
}

std::map<std::pair<int, int>, BondNow> BondedInteractionLoop::bondsNow() const
{
	const std::lock_guard<std::mutex>      lock(busy);
	std::map<std::pair<int, int>, BondNow> result;
	for (size_t j = 0; j < held.size(); j++)
		if (const auto& I = held[j].interaction)
			result[std::minmax(I->getId1(), I->getId2())]
			        = { system.row(j).normalStress, system.row(j).shearStress, held[j].phys->bondRadius };
	return result;
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
		exposeGeometry(j);
		BondedPhys&    phys  = *held[j].phys;
		const auto&    geom  = static_cast<const ScGeom&>(*held[j].interaction->geom);
		const auto&    row   = system.row(j);
		const Vector3r force = ddem::eigenVector(row.force);
		phys.normalForce     = -force.dot(geom.normal) * geom.normal;
		phys.shearForce      = -force - phys.normalForce;
		phys.normalStress    = row.normalStress;
		phys.shearStress     = row.shearStress;
	}
}

void BondedInteractionLoop::exposeGeometry(size_t j)
{
	auto&          geom = static_cast<ScGeom&>(*held[j].interaction->geom);
	const double*  x1   = system.pose.data() + 8 * system.firstOf(j);
	const double*  x2   = system.pose.data() + 8 * system.secondOf(j);
	const Vector3r branch(x2[0] - x1[0], x2[1] - x1[1], x2[2] - x1[2]);
	const Real     distance = branch.norm();
	geom.normal             = branch / distance;
	geom.penetrationDepth   = geom.radius1 + geom.radius2 - distance;
	geom.contactPoint = Vector3r(x1[0], x1[1], x1[2]) + (geom.radius1 - geom.penetrationDepth / 2) * geom.normal;
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
