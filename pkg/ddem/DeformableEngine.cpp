// GPL v2 or later, see LICENSE.
#include <pkg/ddem/DeformableEngine.hpp>

#include <pkg/ddem/DeformableNode.hpp>
#include <pkg/ddem/DeformableTimeStepper.hpp>
#include <pkg/ddem/Onlookers.hpp>
#include <pkg/ddem/SampleArrays.hpp>
#include <pkg/ddem/SceneReader.hpp>
#include <pkg/ddem/ServoPlaten.hpp>

#include <algorithm>
#include <limits>
#include <set>
#include <sstream>

namespace yade {

DDEM_PLUGIN((DeformableEngine))
CREATE_LOGGER(DeformableEngine);

namespace {

	constexpr int stateVersion = 4; ///< 2: 0.1.0, without names; 3: without works of edges

} // namespace

DeformableEngine::~DeformableEngine()
{
	if (sample) sample->leave();
}

std::vector<DeformableEngine*> DeformableEngine::in(const Scene& scene)
{
	std::vector<DeformableEngine*> found;
	for (const auto& e : scene.engines)
		if (auto* engine = dynamic_cast<DeformableEngine*>(e.get())) found.push_back(engine);
	return found;
}

ddem::RotationTreatment DeformableEngine::rotationTreatment() const
{
	if (rotation == "cosserat") return ddem::RotationTreatment::Cosserat;
	if (rotation == "corotational") return ddem::RotationTreatment::Corotational;
	if (rotation == "none") return ddem::RotationTreatment::None;
	throw std::invalid_argument(
	        "DeformableEngine.rotation = '" + rotation + "' is unknown; use 'cosserat', 'corotational' or 'none'");
}

SampleSettings DeformableEngine::settings(const Scene& of) const
{
	SampleSettings s;
	s.rotation    = rotationTreatment();
	s.vertexShare = vertexShare;
	s.groupMask   = groupMask;
	s.ids         = ids;
	s.energy      = of.trackEnergy;
	s.flowInterval = flowInterval;
	for (const DeformableEngine* other : in(of)) {
		if (other == this) continue;
		if (other->groupMask & groupMask)
			throw std::invalid_argument(
			        "O.engines has two DeformableEngine with the same bit, groupMask = "
			        + std::to_string(groupMask)
			        + "; give each a bit of its own, for instance groupMask = 1<<21");
		s.otherBits |= other->groupMask;
		s.otherIds.insert(s.otherIds.end(), other->ids.begin(), other->ids.end());
		s.shared |= other->ids.empty() && ids.empty();
	}
	return s;
}

void DeformableEngine::postLoad(DeformableEngine&)
{
	rotationTreatment();
	if (inverted != "stop" && inverted != "warn")
		throw std::invalid_argument(
		        "DeformableEngine.inverted = '" + inverted + "' is unknown; use 'stop' or 'warn'");
	if (flowInterval < 1)
		throw std::invalid_argument(
		        "DeformableEngine.flowInterval = " + std::to_string(flowInterval)
		        + " steps must be at least 1 (1: flow in every step)");
	if (groupMask <= 0)
		throw std::invalid_argument(
		        "DeformableEngine.groupMask = " + std::to_string(groupMask) + " must be a positive bit mask");
	stale = true; // read anew at the next step; the state is kept
}

StateStore DeformableEngine::stateToCarry(const Scene& of) const
{
	if (sample && virgin) return {}; // State has everything, and the shapes what else there is at the start
	if (sample) return sample->store();
	if (savedVersion != 0) {
		if (savedVersion != stateVersion && savedVersion != 3)
			throw std::runtime_error(
			        "the scene was saved with version " + std::to_string(savedVersion)
			        + " of the state of deformable triangles" + (savedVersion == 2 ? " (plugin 0.1.0)" : "")
			        + "; this plugin reads version " + std::to_string(stateVersion)
			        + ": load it with the plugin that saved it");
		return StateStore::fromSaved({ savedFields, savedState }, savedVersion == 3 ? 3 : 5);
	}
	return storeOfFormerEngines(of, trianglesOf(of, settings(of)));
}

bool DeformableEngine::upToDate(Scene& of)
{
	if (stale || !sample) return false;
	if (agrees() && sample->materialsChanged(!virgin)) return false;
	return !sample->misses(of);
}

void DeformableEngine::readIfNeeded(Scene& of)
{
	scene = &of;
	if (upToDate(of)) return;
	if (sample && sample->shown == Shown::Touched) sample->finishLook(of);
	const bool       agreed = agrees();
	const StateStore known  = stateToCarry(of);
	virgin                  = known.cores.empty();
	sample                  = yade::readScene(of, settings(of), known);
	sample->shown           = agreed ? Shown::All : Shown::Constrained;
	sample->adopt(groupMask);
	std::vector<Real>().swap(savedState);
	savedFields.clear();
	savedVersion = 0;
	stale        = false;
	edgeLoading.restart();
	const auto& groups = sample->system->group;
	guard.restart(std::any_of(
	        groups.begin(), groups.end(), [](const ddem::GroupPointer& g) { return g->stiffensInRuns(); }));
	EngineOrder::maskIntegrators(of, groupMask);
	for (const std::string& name : sample->forgotten)
		if (!of.trackEnergy || !std::set<std::string> { "lastStress" }.count(name))
			LOG_WARN(
			        "no law of these triangles remembers '"
			        << name
			        << "' any more, since an effect was switched off or the law changed: what it was is "
			           "lost");
	for (const auto& b : sample->cores)
		if (rotation == "cosserat"
		    && static_cast<const DeformableElastMat&>(*b->material).rotationStiffness < 1e-3) {
			LOG_WARN(
			        "rotationStiffness of material '"
			        << b->material->label
			        << "' is below 1e-3: cores are tied to their vertices by it, and a free core lets go "
			           "of tension; use rotation='corotational' for a classic continuum");
			break;
		}
}

void DeformableEngine::readScene()
{
	Scene& now = *Omega::instance().getScene();
	for (DeformableEngine* engine : in(now))
		engine->readIfNeeded(now);
}

shared_ptr<Exposure> DeformableEngine::currentOf(const shared_ptr<Exposure>& sample, std::size_t row)
{
	if (!sample) return nullptr;
	Scene& now = *Omega::instance().getScene();
	for (DeformableEngine* engine : in(now)) {
		if (engine->sample != sample) continue;
		if (!engine->upToDate(now)) return nullptr;
		if (Omega::instance().isRunning()) return sample;
		const auto lock = engine->betweenSteps();
		if (engine->agrees()) {
			sample->importTriangle(now, row);
			if (!engine->upToDate(now)) return nullptr; // its body has got another material
		} else
			engine->takeUpEverything(now);
		return sample;
	}
	return sample; // of a scene that is gone, or of an engine taken out of it
}

Exposure& DeformableEngine::current()
{
	Scene&     now  = *Omega::instance().getScene();
	const bool mine = std::any_of(now.engines.begin(), now.engines.end(), [this](const shared_ptr<Engine>& e) {
		return e.get() == this;
	});
	if (!mine && sample) return *sample; // of a scene that is gone, or an engine taken out of it
	if (!mine)
		throw std::runtime_error(
		        "this DeformableEngine is not in O.engines, so it has no triangles; put it there first");
	if (Omega::instance().isRunning()) {
		readIfNeeded(now);
		return *sample;
	}
	const auto lock = betweenSteps();
	readIfNeeded(now);
	takeUpEverything(now);
	return *sample;
}

void DeformableEngine::checkStart() const
{
	// velocities given to all nodes of a sample and to none of its cores, which have most of the mass
	const ddem::Motion& m = sample->system->motion;
	for (std::size_t i = 0; i < sample->cores.size(); i++) {
		if (m.core.velocity[2 * i] != 0 || m.core.velocity[2 * i + 1] != 0 || m.core.inverseMass[2 * i] == 0)
			return;
		for (const auto& list : sample->system->topology.vertex) {
			const auto first = std::size_t(sample->system->topology.vertex[0][i]), v = std::size_t(list[i]);
			for (std::size_t c = 0; c < 2; c++)
				if (m.node.velocity[2 * v + c] != m.node.velocity[2 * first + c]
				    || m.node.inverseMass[2 * v + c] == 0)
					return;
			if (m.node.velocity[2 * v] == 0 && m.node.velocity[2 * v + 1] == 0) return;
		}
	}
	std::ostringstream text;
	text << "all nodes have a velocity, (" << m.node.velocity[0] << ", " << m.node.velocity[1] << ") m/s at "
	     << placeOf(*sample->nodes[0]) << ", and no triangle core has one; cores have " << 1 - vertexShare
	     << " of the mass: give the whole block its velocity, block.velocity = (vx, vy)";
	throw std::runtime_error(text.str());
}

void DeformableEngine::action()
{
	const std::lock_guard<std::mutex> lock(acting);
	if (sample) sample->endLook();
	// before anything is read from bodies that an engine in the wrong place may have spoilt
	if (order.check(*scene, *this)) {
		EngineOrder::checkDrivenNodes(*scene);
		for (ServoPlaten* platen : order.platens)
			platen->lookAgain();
	}
	readIfNeeded(*scene);
	const bool anythingDone = sample->shown == Shown::All; // by engines or Python, also to forces
	if (sample->shown != Shown::Constrained) {
		takeUpChanges(*scene);
		EngineOrder::checkDrivenNodes(*scene);
	}
	EngineOrder::requireOpenCell(*scene);
	if (virgin) checkStart();
	virgin = false;
	for (const auto* newton : order.integrators)
		if (newton->mask <= 0 || (newton->mask & groupMask)) EngineOrder::maskIntegrators(*scene, groupMask);
	sample->importPrescribed();
	const std::string warning = guard.check(*scene, *sample, order.stepper, order.otherStepper, inverted == "stop");
	if (!warning.empty()) LOG_WARN(warning);
	const bool forces = forcesAdded(anythingDone);
	sample->importForces(scene->forces, forces);
	if (!order.edgeEngines.empty() || edgeLoading.active()) edgeLoading.apply(*scene, *sample, order.edgeEngines);

	const std::vector<ServoPlaten*> platens = preparePlatens();
	const Vector3r     felt = order.gravityFelt(*this);
	ddem::StepSettings step;
	step.dt       = scene->dt;
	step.gravity  = { felt[0], felt[1] };
	step.damping  = std::max(Real(0), damping);
	step.external = forces;
	step.energy   = scene->trackEnergy;
	try {
		const ddem::StepEnergy energy = sample->system->step(step);
		if (step.energy) bookEnergy(energy);
		sample->lastGravity = step.gravity;
		for (std::size_t i = 0; i < platens.size(); i++)
			platens[i]->finish(*scene, sample->system->platens[i]);
	} catch (const std::domain_error&) {
		stopAtNotFinite();
	}
	show();
	syncs = scene->forces.syncCount;
}

std::vector<ServoPlaten*> DeformableEngine::preparePlatens()
{
	std::vector<ServoPlaten*> mine;
	auto&                     platens = sample->system->platens;
	platens.clear();
	for (ServoPlaten* engine : order.platens) {
		ddem::RigidPlaten platen;
		if (engine->dead || !engine->prepare(*scene, *sample, platen)) continue;
		platens.push_back(platen);
		mine.push_back(engine);
	}
	return mine;
}

std::unique_lock<std::mutex> DeformableEngine::betweenSteps()
{
	std::unique_lock<std::mutex> lock(acting, std::try_to_lock);
	if (!lock.owns_lock()) { // after O.pause() the step in hand goes on, and may need Python
		PyThreadState* const python = PyEval_SaveThread();
		lock.lock();
		PyEval_RestoreThread(python);
	}
	return lock;
}

void DeformableEngine::takeUpEverything(Scene& of)
{
	if (sample->shown == Shown::All)
		takeUpChanges(of);
	else // paused between two looks, or in one
		sample->finishLook(of);
}

void DeformableEngine::takeUpChanges(Scene& of)
{
	sample->importChanges(of);
	readIfNeeded(of); // where a body has got another material
}

bool DeformableEngine::forcesAdded(bool anythingDone) const
{
	const ForceContainer& f = scene->forces;
	if (f.getPermForceUsed()) return true;
	// an engine that may add forces need not do so: adding leaves the container unsynced, or synced once more
	const bool untouched = !anythingDone && f.lastReset == scene->iter && f.synced && f.syncCount == syncs;
	return order.collectForces && !untouched;
}

void DeformableEngine::show()
{
	const Onlooker who    = onlooker(
	        *scene, *this, showings, EngineOrder::neverLooks, std::numeric_limits<Real>::infinity());
	const bool     lags    = who == Onlooker::Python && pythonLooks::watched();
	const bool     picture = who == Onlooker::OtherThreads || (lags && showings.due());
	if (picture) {
		showings.begin();
		sample->showPicture();
		showings.end();
	}
	if (lags)
		sample->beginLook();
	else if (who == Onlooker::Anybody || who == Onlooker::Python)
		sample->exposeAll();
	else
		sample->exposeConstrained();
	if (who != Onlooker::Nobody && scene->forces.lastReset == scene->iter) sample->exposeReactions(scene->forces);
}

void DeformableEngine::stopAtNotFinite()
{
	const auto         place = sample->system->motion.firstNotFinite();
	std::ostringstream text;
	text << "DeformableEngine: the state became infinite or not a number in step " << scene->iter
	     << ", t = " << scene->time << " s";
	if (place.found)
		text << ", first at " << (place.isNode ? "node " : "triangle ")
		     << placeOf(place.isNode ? *sample->nodes[place.index] : *sample->cores[place.index]);
	text << "; check forces on it, prescribed velocities and O.dt = " << scene->dt
	     << " s (DeformableTimeStepper(timeStepUpdateInterval=1) follows fast changes of the critical one)";
	throw std::runtime_error(text.str());
}

void DeformableEngine::bookEnergy(const ddem::StepEnergy& e)
{
	// Called outside any parallel section, since EnergyTracker creates ids lazily and without a lock.
	EnergyTracker& book = *scene->energy;
	book.add(e.kinetic, "kinetic", entry.kinetic, true);
	book.add(e.elastic, "elastPotential", entry.elastic, true);
	book.add(e.rotation, "elastRotation", entry.rotation, true);
	book.add(e.plastic, "plasticFlow", entry.plastic, true);
	book.add(e.damage, "damage", entry.damage, true);
	book.add(-e.gravityWork, "gravWork", entry.gravityWork, false);
	book.add(-e.externalWork, "externalWork", entry.externalWork, false);
	book.add(e.dampingLoss, "nonviscDamp", entry.dampingLoss, false);
	if (e.edgeWork != 0 || entry.edgeWork >= 0) book.add(-e.edgeWork, "edgeWork", entry.edgeWork, false);
	if (e.edgeAbsorption != 0 || entry.edgeAbsorption >= 0)
		book.add(e.edgeAbsorption, "edgeAbsorption", entry.edgeAbsorption, false);
}

// ---- saving ---------------------------------------------------------------------------------------------------------

void DeformableEngine::preSave(DeformableEngine&)
{
	if (!sample) return; // nothing yet, or loaded and not run: then savedState still holds the state
	exposed          = agrees();
	savedVersion     = stateVersion;
	const auto saved = sample->store().saved();
	savedState       = saved.numbers;
	savedFields      = saved.names;
}

void DeformableEngine::postSave(DeformableEngine&)
{
	if (!sample) return;
	savedVersion = 0;
	savedFields.clear();
	std::vector<Real>().swap(savedState);
}

// ---- what Python sees -----------------------------------------------------------------------------------------------

Real DeformableEngine::criticalTimeStep() { return current().timeStep().step; }

bool DeformableEngine::timeStepUnchecked(Scene& of) { return !upToDate(of) || guard.unchecked(of); }

Real DeformableEngine::stableStep(Scene& of, Real enough)
{
	const std::lock_guard<std::mutex> lock(acting);
	readIfNeeded(of);
	if (sample->shown != Shown::Constrained) takeUpChanges(of);
	return sample->timeStep(enough).step;
}

Real DeformableEngine::timeStepOfScene() const
{
	const Scene& now = *Omega::instance().getScene();
	return yade::readScene(now, settings(now), StateStore())->timeStep().step;
}

boost::python::tuple DeformableEngine::rulingTriangle()
{
	const Exposure& parts       = current();
	const auto [step, triangle] = parts.timeStep();
	return boost::python::make_tuple(parts.cores[triangle]->getId(), step);
}

boost::python::object DeformableEngine::array(const std::string& name) { return sampleArray(current(), name); }
boost::python::object DeformableEngine::values(const std::string& name) { return sampleValues(current(), name); }
boost::python::list   DeformableEngine::fields() { return sampleFields(current()); }
boost::python::list   DeformableEngine::groups() { return sampleGroups(current()); }

} // namespace yade
