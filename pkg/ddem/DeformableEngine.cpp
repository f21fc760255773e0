// GPL v2 or later, see LICENSE.
#include <pkg/ddem/DeformableEngine.hpp>

#include <pkg/ddem/DeformableNode.hpp>
#include <pkg/ddem/DeformableTimeStepper.hpp>
#include <pkg/ddem/Onlookers.hpp>
#include <pkg/ddem/SampleArrays.hpp>
#include <pkg/ddem/SceneReader.hpp>

#include <algorithm>
#include <limits>
#include <set>
#include <sstream>

namespace yade {

DDEM_PLUGIN((DeformableEngine))
CREATE_LOGGER(DeformableEngine);

namespace {

	constexpr int stateVersion = 3; ///< 2: 0.1.0, without names

} // namespace

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
	throw std::invalid_argument("DeformableEngine.rotation = '" + rotation + "' is unknown; use 'cosserat', 'corotational' or 'none'");
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
			        "O.engines has two DeformableEngine with the same bit, groupMask = " + std::to_string(groupMask)
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
		throw std::invalid_argument("DeformableEngine.inverted = '" + inverted + "' is unknown; use 'stop' or 'warn'");
	if (flowInterval < 1)
		throw std::invalid_argument(
		        "DeformableEngine.flowInterval = " + std::to_string(flowInterval) + " steps must be at least 1 (1: flow in every step)");
	if (groupMask <= 0) throw std::invalid_argument("DeformableEngine.groupMask = " + std::to_string(groupMask) + " must be a positive bit mask");
	stale = true; // read anew at the next step; the state is kept
}

StateStore DeformableEngine::stateToCarry(const Scene& of) const
{
	if (sample) return sample->store();
	if (savedVersion != 0) {
		if (savedVersion != stateVersion)
			throw std::runtime_error(
			        "the scene was saved with version " + std::to_string(savedVersion)
			        + " of the state of deformable triangles" + (savedVersion == 2 ? " (plugin 0.1.0)" : "") + "; this plugin reads version "
			        + std::to_string(stateVersion) + ": load it with the plugin that saved it");
		return StateStore::fromSaved({ savedFields, savedState });
	}
	// a new engine in a scene that another one has run: what only arrays hold is still with the shapes; positions are in State
	StateStore carried;
	for (const auto& b : *of.bodies) {
		const auto* shape = b ? dynamic_cast<const DeformableTriangle*>(b->shape.get()) : nullptr;
		if (!shape || !shape->system) continue;
		const ddem::TriangleSystem& s    = *shape->system;
		const ddem::Spins&          spin = s.motion.spin;
		carried.lastTimeStep             = s.motion.lastTimeStep;
		StateStore::Core& core           = carried.cores[b->getId()];
		core.blocked                     = b->state->blockedDOFs;
		for (std::size_t c = 0; c < 2; c++) {
			core.position[c] = b->state->pos[Eigen::Index(c)];
			core.velocity[c] = core.lastVelocity[c] = b->state->vel[Eigen::Index(c)];
		}
		core.spins = spin.size() > 0;
		if (core.spins) {
			core.angle = spin.angle[shape->row];
			core.spin = core.lastSpin = b->state->angVel[2];
		}
		const ddem::LawGroup& group = s.groupOf(shape->row);
		carried.keep(b->getId(), group, shape->row - group.begin);
	}
	return carried;
}

bool DeformableEngine::upToDate(Scene& of)
{
	if (stale || !sample) return false;
	if (exposed && sample->materialsChanged()) return false;
	return !sample->misses(of);
}

void DeformableEngine::readIfNeeded(Scene& of)
{
	scene = &of;
	if (upToDate(of)) return;
	virgin       = !sample && savedVersion == 0;
	sample       = yade::readScene(of, settings(of), stateToCarry(of));
	sample->adopt(groupMask);
	std::vector<Real>().swap(savedState);
	savedFields.clear();
	savedVersion = 0;
	stale        = false;
	const auto& groups = sample->system->group;
	guard.restart(std::any_of(groups.begin(), groups.end(), [](const ddem::GroupPointer& g) { return g->stiffensInRuns(); }));
	EngineOrder::maskIntegrators(of, groupMask);
	for (const std::string& name : sample->forgotten)
		if (!of.trackEnergy || !std::set<std::string> { "lastStress" }.count(name))
			LOG_WARN("no law of these triangles remembers '" << name << "' any more, since an effect was switched off or the law changed: what it was is lost");
	for (const auto& b : sample->cores)
		if (rotation == "cosserat" && static_cast<const DeformableElastMat&>(*b->material).rotationStiffness < 1e-3) {
			LOG_WARN("rotationStiffness of material '" << b->material->label << "' is below 1e-3: cores are tied to their vertices by it, and a free core lets go of tension; use rotation='corotational' for a classic continuum");
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
		if (engine->exposed) {
			sample->importTriangle(now, row);
			if (!engine->upToDate(now)) return nullptr; // its body has got another material
		} else
			engine->current();
		return sample;
	}
	return sample; // of a scene that is gone, or of an engine taken out of it
}

Exposure& DeformableEngine::current()
{
	Scene&     now  = *Omega::instance().getScene();
	const bool mine = std::any_of(now.engines.begin(), now.engines.end(), [this](const shared_ptr<Engine>& e) { return e.get() == this; });
	if (!mine && sample) return *sample; // of a scene that is gone, or an engine taken out of it
	if (!mine) throw std::runtime_error("this DeformableEngine is not in O.engines, so it has no triangles; put it there first");
	readIfNeeded(now);
	if (Omega::instance().isRunning()) return *sample;
	if (exposed) {
		sample->importChanges(now);
		readIfNeeded(now); // where a body has got another material
	} else // paused between two looks
		sample->exposeAll();
	exposed = true;
	return *sample;
}

void DeformableEngine::checkStart() const
{
	// velocities given to all nodes of a sample and to none of its cores, which have most of the mass
	const ddem::Motion& m = sample->system->motion;
	for (std::size_t i = 0; i < sample->cores.size(); i++) {
		if (m.core.velocity[2 * i] != 0 || m.core.velocity[2 * i + 1] != 0 || m.core.inverseMass[2 * i] == 0) return;
		for (const auto& list : sample->system->topology.vertex) {
			const auto first = std::size_t(sample->system->topology.vertex[0][i]), v = std::size_t(list[i]);
			for (std::size_t c = 0; c < 2; c++)
				if (m.node.velocity[2 * v + c] != m.node.velocity[2 * first + c] || m.node.inverseMass[2 * v + c] == 0) return;
			if (m.node.velocity[2 * v] == 0 && m.node.velocity[2 * v + 1] == 0) return;
		}
	}
	std::ostringstream text;
	text << "all nodes have a velocity, (" << m.node.velocity[0] << ", " << m.node.velocity[1]
	     << ") m/s at " << placeOf(*sample->nodes[0]) << ", and no triangle core has one; cores have " << 1 - vertexShare
	     << " of the mass: give the whole block its velocity, block.velocity = (vx, vy)";
	throw std::runtime_error(text.str());
}

void DeformableEngine::action()
{
	// before anything is read from bodies that an engine in the wrong place may have spoilt
	if (order.check(*scene, *this)) EngineOrder::checkDrivenNodes(*scene);
	readIfNeeded(*scene);
	if (exposed) {
		sample->importChanges(*scene);
		readIfNeeded(*scene); // where a body has got another material
		EngineOrder::checkDrivenNodes(*scene);
	}
	EngineOrder::requireOpenCell(*scene);
	if (flowInterval > 1 && scene->trackEnergy)
		throw std::runtime_error(
		        "O.trackEnergy with DeformableEngine.flowInterval = " + std::to_string(flowInterval)
		        + ": the energy book does not close where flow waits; set flowInterval = 1, or "
		          "O.trackEnergy = False");
	if (virgin) checkStart();
	virgin = false;
	for (const auto* newton : order.integrators)
		if (newton->mask <= 0 || (newton->mask & groupMask)) EngineOrder::maskIntegrators(*scene, groupMask);
	sample->importPrescribed();
	const std::string warning = guard.check(*scene, *sample, order.stepper, order.otherStepper, inverted == "stop");
	if (!warning.empty()) LOG_WARN(warning);
	const bool forces = order.collectForces || scene->forces.getPermForceUsed();
	sample->importForces(scene->forces, forces);

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
	} catch (const std::domain_error&) {
		stopAtNotFinite();
	}
	const Onlooker who = onlooker(*scene, *this, showings, EngineOrder::neverLooks);
	exposed            = who == Onlooker::Script;
	if (who == Onlooker::Nobody) return sample->exposeConstrained();
	showings.begin();
	sample->exposeAll();
	if (scene->forces.lastReset == scene->iter) sample->exposeReactions(scene->forces);
	showings.end();
}

void DeformableEngine::stopAtNotFinite()
{
	const auto         place = sample->system->motion.firstNotFinite();
	std::ostringstream text;
	text << "DeformableEngine: the state became infinite or not a number in step " << scene->iter << ", t = " << scene->time << " s";
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
	book.add(e.kinetic, "kinetic", ids_[0], true);
	book.add(e.elastic, "elastPotential", ids_[1], true);
	book.add(e.rotation, "elastRotation", ids_[2], true);
	book.add(e.plastic, "plasticFlow", ids_[3], true);
	book.add(e.damage, "damage", ids_[4], true);
	book.add(-e.gravityWork, "gravWork", ids_[5], false);
	book.add(-e.externalWork, "externalWork", ids_[6], false);
	book.add(e.dampingLoss, "nonviscDamp", ids_[7], false);
}

// ---- saving --------------------------------------------------------------------------------------------------------------------

void DeformableEngine::preSave(DeformableEngine&)
{
	if (!sample) return; // nothing yet, or loaded and not run: then savedState still holds the state
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

// ---- what Python sees ------------------------------------------------------------------------------------------------------------

Real DeformableEngine::criticalTimeStep() { return current().timeStep().step; }

bool DeformableEngine::timeStepUnchecked(Scene& of) { return !upToDate(of) || guard.unchecked(of); }

Real DeformableEngine::stableStep(Scene& of, Real enough)
{
	readIfNeeded(of);
	if (exposed) {
		sample->importChanges(of);
		readIfNeeded(of); // where a body has got another material
	}
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
