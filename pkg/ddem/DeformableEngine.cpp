// GPL v2 or later, see LICENSE.
#include <pkg/ddem/DeformableEngine.hpp>

#include <pkg/ddem/DeformableNode.hpp>
#include <pkg/ddem/DeformableTimeStepper.hpp>
#include <pkg/ddem/Onlookers.hpp>
#include <pkg/ddem/SingleProcess.hpp>

#include <boost/python/numpy.hpp>

#include <algorithm>
#include <limits>
#include <set>
#include <sstream>

namespace yade {

DDEM_PLUGIN((DeformableEngine))
CREATE_LOGGER(DeformableEngine);

namespace {

	constexpr int  stateVersion   = 2;
	constexpr long boundInterval = 50, pressureInterval = 10; ///< steps between checks of the time step against shape, and against pressure, which may rise faster

	/// Engines that neither look at deformable bodies nor add forces to them.
	bool isQuiet(const Engine& engine)
	{
		static const std::set<std::string> names { "ForceResetter", "NewtonIntegrator", "InsertionSortCollider", "InteractionLoop", "BondedInteractionLoop", "ViscousBodyDamping", "GlobalStiffnessTimeStepper", "DeformableTimeStepper", "DeformableEngine" };
		return names.count(engine.getClassName()) > 0;
	}

	/// Engines that may add forces, or move bodies that they name and whose motion is prescribed, but look at no free deformable body.
	bool neverLooks(const Engine& engine)
	{
		static const std::set<std::string> names { "ForceEngine", "TorqueEngine" };
		return isQuiet(engine) || names.count(engine.getClassName()) > 0 || dynamic_cast<const KinematicEngine*>(&engine);
	}

	std::string placeOf(const Body& b)
	{
		std::ostringstream text;
		text << "body " << b.getId() << " at (" << b.state->refPos[0] << ", " << b.state->refPos[1] << ") m (reference position)";
		return text.str();
	}

} // namespace

DeformableEngine& DeformableEngine::ofCurrentScene()
{
	DeformableEngine* found = nullptr;
	const auto        scene = Omega::instance().getScene();
	for (const auto& e : scene->engines)
		if (auto* engine = dynamic_cast<DeformableEngine*>(e.get())) {
			if (found) throw std::runtime_error("O.engines has more than one DeformableEngine; one moves all deformable triangles: remove the others");
			found        = engine;
			found->scene = scene.get();
		}
	if (!found) throw std::runtime_error("O.engines has no DeformableEngine, which keeps and moves deformable triangles: add DeformableEngine() after the engines that add forces");
	return *found;
}

ddem::RotationTreatment DeformableEngine::rotationTreatment() const
{
	if (rotation == "cosserat") return ddem::RotationTreatment::Cosserat;
	if (rotation == "corotational") return ddem::RotationTreatment::Corotational;
	if (rotation == "none") return ddem::RotationTreatment::None;
	throw std::invalid_argument("DeformableEngine.rotation = '" + rotation + "' is unknown; use 'cosserat', 'corotational' or 'none'");
}

void DeformableEngine::postLoad(DeformableEngine&)
{
	rotationTreatment();
	if (groupMask <= 0) throw std::invalid_argument("DeformableEngine.groupMask = " + std::to_string(groupMask) + " must be a positive bit mask");
	stale = true; // assembled anew at the next step; the state is kept
}

CarriedState DeformableEngine::stateToCarry(const Scene& of) const
{
	if (assembly.system) return assembly.carry();
	if (savedVersion != 0) {
		if (savedVersion != stateVersion)
			throw std::runtime_error(
			        "the scene was saved with version " + std::to_string(savedVersion) + " of the state of deformable triangles; this plugin reads version "
			        + std::to_string(stateVersion) + ": load it with the plugin that saved it");
		return CarriedState::fromNumbers(savedState);
	}
	// a new engine in a scene that another one has run: what only arrays hold is still with the shapes; positions are in State
	CarriedState carried;
	for (const auto& b : *of.bodies) {
		const auto* shape = b ? dynamic_cast<const DeformableTriangle*>(b->shape.get()) : nullptr;
		if (!shape || !shape->system) continue;
		const ddem::TriangleSystem& s    = *shape->system;
		carried.lastTimeStep             = s.lastTimeStep;
		CarriedState::Core&         core = carried.cores[b->getId()];
		core.blocked                     = b->state->blockedDOFs;
		for (std::size_t c = 0; c < 2; c++) {
			core.position[c] = b->state->pos[Eigen::Index(c)];
			core.velocity[c] = core.lastVelocity[c] = b->state->vel[Eigen::Index(c)];
		}
		core.spins = s.spin.size() > 0;
		if (core.spins) {
			core.angle = s.spin.angle[shape->slot];
			core.spin = core.lastSpin = b->state->angVel[2];
		}
		if (const ddem::ConcreteState* state = s.concreteStates(shape->slot)) core.concrete.assign(state, state + 3);
	}
	return carried;
}

void DeformableEngine::assembleIfNeeded(Scene& of)
{
	scene = &of;
	if (exposed && assembly.system && assembly.materialsChanged()) stale = true;
	if (!stale && assembly.upToDate(of)) return;
	assembly = DeformableAssembly::fromScene(of, rotationTreatment(), vertexShare, stateToCarry(of));
	assembly.adopt(groupMask);
	std::vector<Real>().swap(savedState);
	savedVersion = 0;
	stale        = false;
	checkedStep  = 0;
	const auto& laws = assembly.system->concrete;
	const bool  eos  = std::any_of(laws.begin(), laws.end(), [](const ddem::ConcreteGroupLaw& law) { return law.effects & ddem::ConcreteEffects::EquationOfState; });
	checkInterval    = eos ? pressureInterval : boundInterval;
	maskIntegrators(of);
	for (const auto& b : assembly.cores)
		if (rotation == "cosserat" && static_cast<const DeformableElastMat&>(*b->material).rotationStiffness < 1e-3) {
			LOG_WARN("rotationStiffness of material '" << b->material->label << "' is below 1e-3: cores are tied to their vertices by it, and a free core lets go of tension; use rotation='corotational' for a classic continuum");
			break;
		}
}

DeformableAssembly& DeformableEngine::current()
{
	Scene&     now  = *Omega::instance().getScene();
	const bool mine = std::any_of(now.engines.begin(), now.engines.end(), [this](const shared_ptr<Engine>& e) { return e.get() == this; });
	if (!mine && assembly.system) return assembly; // of a scene that is gone, or an engine taken out of it
	if (!mine) throw std::runtime_error("this DeformableEngine is not in O.engines, so it has no triangles; put it there first");
	assembleIfNeeded(now);
	if (Omega::instance().isRunning()) return assembly;
	if (exposed) assembly.importChanges(now);
	else // paused between two looks
		assembly.exposeAll();
	exposed = true;
	return assembly;
}

void DeformableEngine::maskIntegrators(const Scene& of) const
{
	for (const auto& e : of.engines)
		if (auto* newton = dynamic_cast<NewtonIntegrator*>(e.get())) {
			const int mask = (newton->mask > 0 ? newton->mask : std::numeric_limits<int>::max()) & ~groupMask;
			if (mask == 0)
				throw std::runtime_error("NewtonIntegrator.mask has only the bit of DeformableEngine.groupMask, so it would move no body or move deformable ones twice; remove its mask");
			newton->mask = mask;
		}
}

void DeformableEngine::checkDrivenNodes() const
{
	for (const auto& e : scene->engines) {
		const auto* drive = dynamic_cast<const KinematicEngine*>(e.get());
		if (!drive || drive->dead) continue;
		for (const auto id : drive->ids) {
			const shared_ptr<Body> b = Body::byId(id, scene);
			if (b && dynamic_cast<const DeformableNode*>(b->shape.get()) && !(b->state->blockedDOFs & (State::DOF_X | State::DOF_Y)))
				throw std::runtime_error(
				        drive->getClassName() + " drives deformable node " + placeOf(*b) + ", whose degrees of freedom are free; block those that are driven: block.hold(ids, 'y')");
		}
	}
}

void DeformableEngine::checkEngines()
{
	std::vector<const Engine*> now;
	for (const auto& e : scene->engines)
		now.push_back(e.get());
	if (now == checkedEngines) return;
	requireSingleProcess(*scene); // mpy adds engines where it divides a scene
	ofCurrentScene(); // exactly one
	long mine = -1, resetter = -1, interactions = -1;
	for (std::size_t i = 0; i < now.size(); i++) {
		const std::string name = now[i]->getClassName();
		if (now[i] == this) mine = long(i);
		if (name == "ForceResetter") resetter = long(i);
		if (dynamic_cast<const InteractionLoop*>(now[i])) interactions = long(i);
	}
	if (resetter < 0) throw std::runtime_error("O.engines has no ForceResetter: forces and energies would pile up from step to step; put ForceResetter() first");
	if (resetter > mine)
		throw std::runtime_error("wrong order in O.engines: ForceResetter comes after DeformableEngine and would wipe forces before they are used; put it first");
	if (interactions > mine)
		throw std::runtime_error("wrong order in O.engines: InteractionLoop comes after DeformableEngine, so contact forces would be used one step late; put DeformableEngine after it");
	stepper          = nullptr;
	long timeSteppers = 0;
	for (std::size_t i = 0; i < now.size(); i++) {
		if (!dynamic_cast<const TimeStepper*>(now[i])) continue;
		timeSteppers++;
		if (const auto* found = dynamic_cast<const DeformableTimeStepper*>(now[i])) {
			stepper = found;
			if (long(i) > mine)
				throw std::runtime_error("wrong order in O.engines: DeformableTimeStepper comes after DeformableEngine, which would run with the step before; put it right after ForceResetter");
		}
	}
	if (stepper && timeSteppers > 1)
		throw std::runtime_error(
		        "O.engines has more than one engine that sets O.dt, and YADE allows one: where the scene has spheres as well, remove the other and set DeformableTimeStepper.largest to the step that they need");
	collectForces = false;
	integrators.clear();
	for (std::size_t i = 0; i < now.size(); i++) {
		const bool between = long(i) > resetter && long(i) < mine;
		if (between && !isQuiet(*now[i]) && !dynamic_cast<const KinematicEngine*>(now[i])) collectForces = true;
		if (const auto* newton = dynamic_cast<const NewtonIntegrator*>(now[i])) {
			integrators.push_back(newton);
			if (long(i) < mine && (newton->mask <= 0 || (newton->mask & groupMask)))
				throw std::runtime_error("wrong order in O.engines: NewtonIntegrator comes before DeformableEngine and has moved deformable bodies in this step; put it after");
		}
	}
	maskIntegrators(*scene);
	checkDrivenNodes();
	checkedEngines = now;
}

void DeformableEngine::checkTimeStep()
{
	const auto [step, triangle] = assembly.timeStep(scene->dt);
	if (scene->dt <= step) {
		checkedStep = scene->dt;
		return;
	}
	checkedStep = 0; // a second try is checked, too
	std::ostringstream text;
	text << "O.dt = " << scene->dt << " s is above the critical time step " << step << " s, set by triangle " << placeOf(*assembly.cores[triangle]) << " in step " << scene->iter
	     << "; the simulation would blow up: set O.dt = 0.8*engine.criticalTimeStep(), or remesh that place; ";
	if (stepper)
		text << "DeformableTimeStepper looks every " << stepper->timeStepUpdateInterval << " steps: let it look more often";
	else
		text << "where triangles stretch or pressure rises, let DeformableTimeStepper() in O.engines lower it";
	throw std::runtime_error(text.str());
}

void DeformableEngine::action()
{
	checkEngines(); // before anything is read from bodies that an engine in the wrong place may have spoilt
	assembleIfNeeded(*scene);
	if (exposed) {
		assembly.importChanges(*scene);
		checkDrivenNodes();
	}
	for (const auto* newton : integrators)
		if (newton->mask <= 0 || (newton->mask & groupMask)) maskIntegrators(*scene);
	assembly.importPrescribed();
	if (scene->dt != checkedStep || scene->iter % checkInterval == 0) checkTimeStep();
	const bool forces = collectForces || scene->forces.getPermForceUsed();
	assembly.importForces(scene->forces, forces);

	ddem::StepSettings settings;
	settings.dt       = scene->dt;
	settings.gravity  = { gravity[0], gravity[1] };
	settings.damping  = damping;
	settings.external = forces;
	settings.energy   = scene->trackEnergy;
	try {
		const ddem::StepEnergy energy = assembly.system->step(settings);
		if (settings.energy) bookEnergy(energy);
	} catch (const std::domain_error&) {
		stopAtNotFinite();
	}
	exposed = somebodyMayLook(*scene, *this, lastExposure, neverLooks);
	if (exposed) {
		assembly.exposeAll();
		if (scene->forces.lastReset == scene->iter) assembly.exposeReactions(scene->forces);
		lastExposure = std::chrono::steady_clock::now();
	} else
		assembly.exposeConstrained();
}

void DeformableEngine::stopAtNotFinite()
{
	const auto         place = assembly.system->firstNotFinite();
	std::ostringstream text;
	text << "DeformableEngine: the state became infinite or not a number in step " << scene->iter << ", t = " << scene->time << " s";
	if (place.found) text << ", first at " << (place.isNode ? "node " : "triangle ") << placeOf(place.isNode ? *assembly.nodes[place.index] : *assembly.cores[place.index]);
	text << "; check forces on it, prescribed velocities and O.dt = " << scene->dt << " s (DeformableTimeStepper(timeStepUpdateInterval=1) follows fast changes of the critical one)";
	throw std::runtime_error(text.str());
}

void DeformableEngine::bookEnergy(const ddem::StepEnergy& e)
{
	// Called outside any parallel section, since EnergyTracker creates ids lazily and without a lock.
	EnergyTracker& book = *scene->energy;
	book.add(e.kinetic, "kinetic", ids[0], true);
	book.add(e.elastic, "elastPotential", ids[1], true);
	book.add(e.rotation, "elastRotation", ids[2], true);
	book.add(e.plastic, "plasticFlow", ids[3], true);
	book.add(e.damage, "damage", ids[4], true);
	book.add(-e.gravityWork, "gravWork", ids[5], false);
	book.add(-e.externalWork, "externalWork", ids[6], false);
	book.add(e.dampingLoss, "nonviscDamp", ids[7], false);
}

// ---- saving --------------------------------------------------------------------------------------------------------------------------------------------

void DeformableEngine::preSave(DeformableEngine&)
{
	if (!assembly.system) return; // nothing yet, or loaded and not run: then savedState still holds the state
	savedVersion = stateVersion;
	savedState   = assembly.carry().numbers();
}

void DeformableEngine::postSave(DeformableEngine&)
{
	if (!assembly.system) return;
	savedVersion = 0;
	std::vector<Real>().swap(savedState);
}

// ---- what Python sees ----------------------------------------------------------------------------------------------------------------------------------

Real DeformableEngine::criticalTimeStep() { return current().timeStep().step; }

Real DeformableEngine::stableStep(Scene& of, Real enough)
{
	assembleIfNeeded(of);
	if (exposed) assembly.importChanges(of);
	return assembly.timeStep(enough).step;
}

Real DeformableEngine::timeStepOfScene() const
{
	Scene& now = *Omega::instance().getScene();
	return DeformableAssembly::fromScene(now, rotationTreatment(), vertexShare, CarriedState()).timeStep().step;
}

boost::python::tuple DeformableEngine::rulingTriangle()
{
	const DeformableAssembly& a = current();
	const auto [step, triangle] = a.timeStep();
	return boost::python::make_tuple(a.cores[triangle]->getId(), step);
}

namespace {

	namespace np = boost::python::numpy;

	void startNumpy()
	{
		static const bool started = (np::initialize(), true);
		(void)started;
	}

	boost::python::tuple shapeOf(const std::vector<std::size_t>& sizes)
	{
		boost::python::list list;
		for (const auto size : sizes)
			list.append(size);
		return boost::python::tuple(list);
	}

	/// A view of an array of the system that keeps the system alive.
	np::ndarray view(const shared_ptr<ddem::TriangleSystem>& system, std::vector<double>& data, std::size_t columns)
	{
		using Owner      = shared_ptr<ddem::TriangleSystem>;
		PyObject* handle = PyCapsule_New(new Owner(system), nullptr, [](PyObject* capsule) { delete static_cast<Owner*>(PyCapsule_GetPointer(capsule, nullptr)); });
		const boost::python::object   owner { boost::python::handle<>(handle) };
		const std::size_t             rows = data.size() / columns;
		const std::vector<std::size_t> sizes = columns == 1 ? std::vector<std::size_t> { rows } : std::vector<std::size_t> { rows, columns };
		const boost::python::tuple     strides
		        = columns == 1 ? boost::python::make_tuple(sizeof(double)) : boost::python::make_tuple(columns * sizeof(double), sizeof(double));
		return np::from_data(data.data(), np::dtype::get_builtin<double>(), shapeOf(sizes), strides, owner);
	}

	/// A new array filled by value(i, column).
	template <class Number, class Value> np::ndarray filled(const std::vector<std::size_t>& sizes, std::size_t columns, Value value)
	{
		const np::ndarray result = np::empty(shapeOf(sizes), np::dtype::get_builtin<Number>());
		auto*             to     = reinterpret_cast<Number*>(result.get_data());
		for (std::size_t i = 0; i < sizes[0]; i++)
			value(i, to + i * columns);
		return result;
	}

	void store(const ddem::PlaneTensor& tensor, double angle, double* to)
	{
		const ddem::PlaneTensor t = ddem::rotated(tensor, angle);
		to[0]                     = t.xx;
		to[1]                     = t.yy;
		to[2]                     = t.zz;
		to[3]                     = t.xy;
	}

	template <class Tensors> np::ndarray tensors(const ddem::TriangleSystem& s, Tensors of)
	{
		return filled<double>({ s.triangles(), 3, 4 }, 12, [&](std::size_t i, double* to) {
			const std::array<ddem::PlaneTensor, 3> t     = of(i);
			const double                           angle = s.frameAngle(i);
			for (std::size_t k = 0; k < 3; k++)
				store(t[k], angle, to + 4 * k);
		});
	}

	np::ndarray concreteTensors(const ddem::TriangleSystem& s, ddem::PlaneTensor ddem::ConcreteState::*member)
	{
		return tensors(s, [&](std::size_t i) {
			std::array<ddem::PlaneTensor, 3> t {};
			if (const ddem::ConcreteState* state = s.concreteStates(i))
				for (std::size_t k = 0; k < 3; k++)
					t[k] = state[k].*member;
			return t;
		});
	}

	np::ndarray bodyIds(const std::vector<shared_ptr<Body>>& bodies)
	{
		return filled<long>({ bodies.size() }, 1, [&](std::size_t i, long* to) { *to = bodies[i]->getId(); });
	}

} // namespace

boost::python::object DeformableEngine::array(const std::string& name)
{
	startNumpy();
	const auto& s = current().system;
	if (name == "nodePosition") return view(s, s->node.position, 2);
	if (name == "nodeVelocity") return view(s, s->node.velocity, 2);
	if (name == "nodeForce") return view(s, s->node.force, 2);
	if (name == "nodeMass") return view(s, s->node.mass, 1);
	if (name == "corePosition") return view(s, s->core.position, 2);
	if (name == "coreVelocity") return view(s, s->core.velocity, 2);
	if (name == "coreForce") return view(s, s->core.force, 2);
	if (name == "coreMass") return view(s, s->core.mass, 1);
	if (name == "coreRotation") return view(s, s->spin.angle, 1);
	if (name == "coreSpin") return view(s, s->spin.velocity, 1);
	throw std::invalid_argument(
	        "DeformableEngine.array('" + name + "') is unknown; there are nodePosition, nodeVelocity, nodeForce, nodeMass, corePosition, coreVelocity, coreForce, coreMass, coreRotation, coreSpin");
}

boost::python::object DeformableEngine::values(const std::string& name)
{
	startNumpy();
	const DeformableAssembly&   parts = current();
	const ddem::TriangleSystem& s = *parts.system;
	const std::size_t           n = s.triangles();
	if (name == "nodeIds") return bodyIds(parts.nodes);
	if (name == "triangleIds") return bodyIds(parts.cores);
	if (name == "vertices")
		return filled<int>({ n, 3 }, 3, [&](std::size_t i, int* to) {
			for (std::size_t e = 0; e < 3; e++)
				to[e] = s.vertex[e][i];
		});
	if (name == "area") return filled<double>({ n }, 1, [&](std::size_t i, double* to) { *to = s.reference(i).area(); });
	if (name == "rotation") return filled<double>({ n }, 1, [&](std::size_t i, double* to) { *to = s.frameAngle(i); });
	if (name == "fractureEnergy") return filled<double>({ n }, 1, [&](std::size_t i, double* to) { *to = s.fractureEnergy[i]; });
	if (name == "damage")
		return filled<double>({ n, 3 }, 3, [&](std::size_t i, double* to) {
			const auto sub = s.subElementDamage(i);
			std::copy(sub.begin(), sub.end(), to);
		});
	if (name == "stress") return tensors(s, [&](std::size_t i) { return s.stress(i); });
	if (name == "strain") return tensors(s, [&](std::size_t i) { return s.strain(i); });
	if (name == "plasticStrain") return concreteTensors(s, &ddem::ConcreteState::plasticStrain);
	if (name == "damageTensor") return concreteTensors(s, &ddem::ConcreteState::damage);
	throw std::invalid_argument(
	        "DeformableEngine.values('" + name
	        + "') is unknown; there are nodeIds, triangleIds, vertices, area, rotation, fractureEnergy, damage, stress, strain, plasticStrain, damageTensor");
}

} // namespace yade
