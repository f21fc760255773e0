// GPL v2 or later, see LICENSE.
#include <pkg/ddem/DeformableEngine.hpp>

#include <boost/python/numpy.hpp>

#include <cstring>
#include <set>
#include <sstream>

namespace yade {

DDEM_PLUGIN((DeformableEngine))
CREATE_LOGGER(DeformableEngine);

namespace {

	constexpr int  stateVersion   = 1;
	constexpr long boundInterval  = 50; ///< steps between checks of the time step against the equation of state
	constexpr auto longestUnseen  = std::chrono::milliseconds(200); ///< State is no older than this for other threads while a run goes on

	/// Engines that neither look at deformable bodies nor add forces to them.
	bool isQuiet(const Engine& engine)
	{
		static const std::set<std::string> names { "ForceResetter", "NewtonIntegrator", "InsertionSortCollider", "InteractionLoop", "GlobalStiffnessTimeStepper", "DeformableEngine" };
		return names.count(engine.getClassName()) > 0;
	}

	/// Whether a periodic engine may act at the given step and times; early by `slack` of real time rather than late.
	bool isDue(const PeriodicEngine& e, long iter, Real time, Real slack)
	{
		if (e.nDo >= 0 && e.nDone >= e.nDo) return false;
		if (e.nDone == 0) return e.initRun || (e.firstIterRun > 0 && e.firstIterRun == iter);
		return (e.virtPeriod > 0 && time - e.virtLast >= e.virtPeriod) || (e.realPeriod > 0 && PeriodicEngine::getClock() + slack - e.realLast >= e.realPeriod)
		        || (e.iterPeriod > 0 && iter - e.iterLast >= e.iterPeriod);
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

void DeformableEngine::assembleIfNeeded()
{
	if (!scene) scene = Omega::instance().getScene().get();
	if (!stale && assembly.upToDate(*scene)) return;
	DeformableAssembly made = DeformableAssembly::fromScene(*scene, rotationTreatment(), vertexShare, assembly);
	assembly                = std::move(made);
	stale                   = false;
	restoreSaved();
	assembly.adopt(groupMask);
	checkedEngines.clear();
}

const shared_ptr<ddem::TriangleSystem>& DeformableEngine::system()
{
	assembleIfNeeded();
	return assembly.system;
}

void DeformableEngine::checkEngines()
{
	std::vector<const Engine*> now;
	for (const auto& e : scene->engines)
		now.push_back(e.get());
	if (now == checkedEngines) return;
	ofCurrentScene(); // exactly one
	long mine = -1, resetter = -1, interactions = -1;
	for (std::size_t i = 0; i < now.size(); i++) {
		const std::string name = now[i]->getClassName();
		if (now[i] == this) mine = long(i);
		if (name == "ForceResetter") resetter = long(i);
		if (name == "InteractionLoop") interactions = long(i);
	}
	if (resetter > mine)
		throw std::runtime_error("wrong order in O.engines: ForceResetter comes after DeformableEngine and would wipe forces before they are used; put it first");
	if (interactions > mine)
		throw std::runtime_error("wrong order in O.engines: InteractionLoop comes after DeformableEngine, so contact forces would be used one step late; put DeformableEngine after it");
	collectForces = false;
	for (std::size_t i = 0; i < now.size(); i++) {
		const bool between = long(i) > resetter && (long(i) < mine || resetter < 0);
		if (between && !now[i]->dead && !isQuiet(*now[i])) collectForces = true;
		if (const auto* newton = dynamic_cast<const NewtonIntegrator*>(now[i])) {
			const int mask = (newton->mask > 0 ? newton->mask : std::numeric_limits<int>::max()) & ~groupMask;
			if (mask == 0)
				throw std::runtime_error("NewtonIntegrator.mask has only the bit of DeformableEngine.groupMask, so it would move no body or move deformable ones twice; remove its mask");
			const_cast<NewtonIntegrator*>(newton)->mask = mask;
		}
	}
	checkedEngines = now;
}

void DeformableEngine::checkTimeStep()
{
	const auto [step, triangle] = assembly.timeStep();
	if (scene->dt <= step) return;
	std::ostringstream text;
	text << "O.dt = " << scene->dt << " s is above the critical time step " << step << " s, set by triangle " << placeOf(*assembly.cores[triangle]) << " in step " << scene->iter
	     << "; the simulation would blow up: set O.dt = 0.8*engine.criticalTimeStep(), or remesh that place";
	throw std::runtime_error(text.str());
}

void DeformableEngine::action()
{
	assembleIfNeeded();
	checkEngines();
	if (exposed) assembly.importChanges();
	assembly.importPrescribed();
	if (scene->dt != checkedStep || scene->iter % boundInterval == 0) {
		checkTimeStep();
		checkedStep = scene->dt;
	}
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
	exposed = somebodyMayLook();
	if (exposed) {
		assembly.exposeAll();
		if (scene->forces.lastReset == scene->iter) assembly.exposeReactions(scene->forces);
		lastExposure = std::chrono::steady_clock::now();
	} else
		assembly.exposeConstrained();
}

bool DeformableEngine::somebodyMayLook() const
{
	const long next = scene->iter + 1;
	const Real then = scene->time + scene->dt;
	if (!Omega::instance().isRunning()) return true; // O.step, or a pause was asked for
	if (scene->stopAtIter > 0 && next >= scene->stopAtIter) return true;
	if (scene->stopAtTime > 0 && then >= scene->stopAtTime * (1 - 1e-12)) return true;
	if (std::chrono::steady_clock::now() - lastExposure > longestUnseen) return true;
	bool before = true; // engines before this one act next in the next step
	for (const auto& e : scene->engines) {
		if (e.get() == this) {
			before = false;
			continue;
		}
		if (e->dead || isQuiet(*e) || dynamic_cast<const PartialEngine*>(e.get())) continue; // a PartialEngine acts on the bodies it names, whose motion is prescribed
		const auto* periodic = dynamic_cast<const PeriodicEngine*>(e.get());
		if (!periodic || isDue(*periodic, before ? next : scene->iter, before ? then : scene->time, 0.01)) return true;
	}
	return false;
}

void DeformableEngine::stopAtNotFinite()
{
	const auto         place = assembly.system->firstNotFinite();
	std::ostringstream text;
	text << "DeformableEngine: the state became infinite or not a number in step " << scene->iter << ", t = " << scene->time << " s";
	if (place.found) text << ", first at " << (place.isNode ? "node " : "triangle ") << placeOf(place.isNode ? *assembly.nodes[place.index] : *assembly.cores[place.index]);
	text << "; check forces on it, prescribed velocities and O.dt = " << scene->dt << " s";
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

namespace {

	std::vector<Real> joined(std::initializer_list<const std::vector<double>*> parts)
	{
		std::vector<Real> all;
		for (const auto* part : parts)
			all.insert(all.end(), part->begin(), part->end());
		return all;
	}

	void split(const std::vector<Real>& all, std::initializer_list<std::vector<double>*> parts, const char* what)
	{
		std::size_t size = 0;
		for (const auto* part : parts)
			size += part->size();
		if (all.size() != size)
			throw std::runtime_error(
			        std::string("the saved state of deformable ") + what + " has " + std::to_string(all.size()) + " numbers where " + std::to_string(size)
			        + " are needed: the file does not fit its bodies (or comes from another version of the plugin)");
		auto from = all.begin();
		for (auto* part : parts) {
			std::copy(from, from + std::ptrdiff_t(part->size()), part->begin());
			from += std::ptrdiff_t(part->size());
		}
	}

	constexpr std::size_t concreteDoubles = sizeof(ddem::ConcreteState) / sizeof(double);

} // namespace

void DeformableEngine::preSave(DeformableEngine&)
{
	if (!assembly.system) return;
	const ddem::TriangleSystem& s = *assembly.system;
	savedVersion                  = stateVersion;
	savedNodes                    = joined({ &s.node.position, &s.node.velocity, &s.node.force });
	savedCores                    = joined({ &s.core.position, &s.core.velocity, &s.core.force, &s.spin.angle, &s.spin.velocity, &s.spin.moment });
	savedConcrete.resize(concreteDoubles * s.concreteState.size());
	if (!savedConcrete.empty()) std::memcpy(savedConcrete.data(), s.concreteState.data(), savedConcrete.size() * sizeof(double));
	savedBook = s.bookState();
}

void DeformableEngine::postSave(DeformableEngine&)
{
	for (auto* saved : { &savedNodes, &savedCores, &savedConcrete, &savedBook })
		std::vector<Real>().swap(*saved);
	savedVersion = 0;
}

void DeformableEngine::restoreSaved()
{
	if (savedVersion == 0) return;
	if (savedVersion != stateVersion)
		throw std::runtime_error(
		        "the scene was saved with version " + std::to_string(savedVersion) + " of the state of deformable triangles; this plugin reads version " + std::to_string(stateVersion)
		        + ": load it with the plugin that saved it");
	ddem::TriangleSystem& s = *assembly.system;
	split(savedNodes, { &s.node.position, &s.node.velocity, &s.node.force }, "nodes");
	split(savedCores, { &s.core.position, &s.core.velocity, &s.core.force, &s.spin.angle, &s.spin.velocity, &s.spin.moment }, "triangles");
	std::vector<double> concrete(concreteDoubles * s.concreteState.size());
	split(savedConcrete, { &concrete }, "concrete");
	if (!concrete.empty()) std::memcpy(static_cast<void*>(s.concreteState.data()), concrete.data(), concrete.size() * sizeof(double));
	s.restoreBook(savedBook);
	postSave(*this);
}

// ---- what Python sees ----------------------------------------------------------------------------------------------------------------------------------

Real DeformableEngine::criticalTimeStep()
{
	assembleIfNeeded();
	return assembly.timeStep().first;
}

boost::python::tuple DeformableEngine::rulingTriangle()
{
	assembleIfNeeded();
	const auto [step, triangle] = assembly.timeStep();
	return boost::python::make_tuple(assembly.cores[triangle]->getId(), step);
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
	const auto& s = system();
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
	const ddem::TriangleSystem& s = *system();
	const std::size_t           n = s.triangles();
	if (name == "nodeIds") return bodyIds(assembly.nodes);
	if (name == "triangleIds") return bodyIds(assembly.cores);
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
