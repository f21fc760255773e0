// GPL v2 or later, see LICENSE.
#include <pkg/ddem/EngineOrder.hpp>

#include <pkg/ddem/DeformableEngine.hpp>
#include <pkg/ddem/DeformableNode.hpp>
#include <pkg/ddem/DeformableTimeStepper.hpp>
#include <pkg/ddem/EdgeEngine.hpp>
#include <pkg/ddem/ServoPlaten.hpp>
#include <pkg/ddem/SingleProcess.hpp>

#include <core/TimeStepper.hpp>

#include <set>
#include <sstream>

namespace yade {

namespace {

	/// Engines that neither look at deformable bodies nor add forces to them.
	bool isQuiet(const Engine& engine)
	{
		static const std::set<std::string> names { "ForceResetter",
			                                   "NewtonIntegrator",
			                                   "BondedNewtonIntegrator",
			                                   "InsertionSortCollider",
			                                   "InteractionLoop",
			                                   "BondedInteractionLoop",
			                                   "ViscousBodyDamping",
			                                   "GlobalStiffnessTimeStepper",
			                                   "DeformableTimeStepper",
			                                   "DeformableEngine" };
		return names.count(engine.getClassName()) > 0 || dynamic_cast<const EdgeEngine*>(&engine)
		        || dynamic_cast<const ServoPlaten*>(&engine);
	}

	/// Engines that add forces to the bodies that they name, in every step.
	const PartialEngine* loader(const Engine& engine)
	{
		const auto* partial = dynamic_cast<const PartialEngine*>(&engine);
		return partial && !dynamic_cast<const KinematicEngine*>(&engine) ? partial : nullptr;
	}

	std::string number(Real value)
	{
		std::ostringstream text;
		text << value;
		return text.str();
	}

	bool isDeformable(const Body& b)
	{
		return dynamic_cast<const DeformableTriangle*>(b.shape.get())
		        || dynamic_cast<const DeformableNode*>(b.shape.get());
	}

	constexpr Real dampingOfYade = 0.2; ///< NewtonIntegrator's default

} // namespace

bool EngineOrder::neverLooks(const Engine& engine)
{
	static const std::set<std::string> names { "ForceEngine", "TorqueEngine" };
	return isQuiet(engine) || names.count(engine.getClassName()) > 0
	        || dynamic_cast<const KinematicEngine*>(&engine);
}

void EngineOrder::maskIntegrators(const Scene& of, int groupMask)
{
	for (const auto& e : of.engines)
		if (auto* newton = dynamic_cast<NewtonIntegrator*>(e.get())) {
			const int mask
			        = (newton->mask > 0 ? newton->mask : std::numeric_limits<int>::max()) & ~groupMask;
			if (mask == 0)
				throw std::runtime_error(
				        "NewtonIntegrator.mask has only the bit of DeformableEngine.groupMask, so it "
				        "would move no body or move deformable ones twice; remove its mask");
			newton->mask = mask;
		}
}

void EngineOrder::checkDrivenNodes(const Scene& scene)
{
	for (const auto& e : scene.engines) {
		const auto* drive = dynamic_cast<const KinematicEngine*>(e.get());
		if (!drive || drive->dead) continue;
		for (const auto id : drive->ids) {
			const shared_ptr<Body> b = Body::byId(id, const_cast<Scene*>(&scene));
			if (b && dynamic_cast<const DeformableNode*>(b->shape.get())
			    && !(b->state->blockedDOFs & (State::DOF_X | State::DOF_Y)))
				throw std::runtime_error(
				        drive->getClassName() + " drives deformable node " + placeOf(*b)
				        + ", whose degrees of freedom are free; block those that are driven: "
				          "block.hold(ids, 'y')");
		}
	}
}

void EngineOrder::requireOpenCell(const Scene& scene)
{
	if (!scene.isPeriodic) return;
	throw std::runtime_error(
	        "deformable triangles do not feel a periodic cell: set O.periodic = False and drive the sides of the "
	        "block (block.drive, ddem.platens)");
}

bool EngineOrder::check(const Scene& scene, const DeformableEngine& self)
{
	std::vector<const Engine*> now;
	for (const auto& e : scene.engines)
		now.push_back(e.get());
	if (now == checked) return false;
	requireSingleProcess(scene); // mpy adds engines where it divides a scene
	long mine = -1, resetter = -1, interactions = -1;
	for (std::size_t i = 0; i < now.size(); i++) {
		const std::string name = now[i]->getClassName();
		if (now[i] == &self) mine = long(i);
		if (name == "ForceResetter") resetter = long(i);
		if (dynamic_cast<const InteractionLoop*>(now[i])) interactions = long(i);
	}
	if (resetter < 0)
		throw std::runtime_error("O.engines has no ForceResetter: forces and energies would pile up from step "
		                         "to step; put ForceResetter() first");
	if (resetter > mine)
		throw std::runtime_error("wrong order in O.engines: ForceResetter comes after DeformableEngine and "
		                         "would wipe forces before they are used; put it first");
	if (interactions > mine)
		throw std::runtime_error("wrong order in O.engines: InteractionLoop comes after DeformableEngine, so "
		                         "contact forces would be used one step late; put DeformableEngine after it");
	stepper           = nullptr;
	otherStepper      = nullptr;
	long timeSteppers = 0;
	for (std::size_t i = 0; i < now.size(); i++) {
		const auto* setsStep = dynamic_cast<const TimeStepper*>(now[i]);
		if (!setsStep) continue;
		timeSteppers++;
		if (setsStep->active && !setsStep->dead && !dynamic_cast<const DeformableTimeStepper*>(setsStep))
			otherStepper = setsStep;
		if (const auto* found = dynamic_cast<const DeformableTimeStepper*>(now[i])) {
			stepper = found;
			if (long(i) > mine)
				throw std::runtime_error(
				        "wrong order in O.engines: DeformableTimeStepper comes after DeformableEngine, "
				        "which would run with the step before; put it right after ForceResetter");
		}
	}
	if (stepper && timeSteppers > 1)
		throw std::runtime_error("O.engines has more than one engine that sets O.dt, and YADE allows one: "
		                         "where the scene has spheres as well, remove the other and set "
		                         "DeformableTimeStepper.largest to the step that they need");
	collectForces = false;
	integrators.clear();
	edgeEngines.clear();
	platens.clear();
	for (std::size_t i = 0; i < now.size(); i++) {
		const bool between = long(i) > resetter && long(i) < mine;
		if (between && !isQuiet(*now[i]) && !dynamic_cast<const KinematicEngine*>(now[i])) collectForces = true;
		if (const auto* edges = dynamic_cast<const EdgeEngine*>(now[i])) edgeEngines.push_back(edges);
		if (auto* platen = dynamic_cast<ServoPlaten*>(scene.engines[i].get())) platens.push_back(platen);
		if (const auto* newton = dynamic_cast<const NewtonIntegrator*>(now[i])) {
			integrators.push_back(newton);
			if (long(i) < mine && (newton->mask <= 0 || (newton->mask & self.groupMask)))
				throw std::runtime_error(
				        "wrong order in O.engines: NewtonIntegrator comes before DeformableEngine and "
				        "has moved deformable bodies in this step; put it after");
		}
	}
	for (std::size_t i = 0; i < now.size(); i++) {
		if (const auto* load = long(i) > mine ? loader(*now[i]) : nullptr)
			for (const auto id : load->ids) {
				const auto b = scene.bodies->exists(id) ? (*scene.bodies)[id] : nullptr;
				if (b && isDeformable(*b))
					throw std::runtime_error(
					        "wrong order in O.engines: " + now[i]->getClassName()
					        + " comes after DeformableEngine, and its force on deformable body "
					        + std::to_string(id)
					        + " would be wiped before it is used; put it before DeformableEngine");
			}
	}
	checked = now;
	return true;
}

Vector3r EngineOrder::gravityFelt(const DeformableEngine& self) const
{
	Vector3r felt = self.gravity;
	for (const auto* newton : integrators) {
		if (newton->dead) continue;
		if (self.damping < 0 && newton->damping != 0 && newton->damping != dampingOfYade)
			throw std::runtime_error(
			        "NewtonIntegrator.damping = " + number(newton->damping)
			        + " does not act on deformable triangles: set DeformableEngine.damping as well (0: "
			          "triangles are not damped)");
		if (newton->gravity == Vector3r::Zero() || newton->gravity == felt) continue;
		if (felt != Vector3r::Zero())
			throw std::runtime_error(
			        "NewtonIntegrator.gravity and DeformableEngine.gravity differ [m/s²]; leave out one of "
			        "them: triangles feel NewtonIntegrator's where DeformableEngine has none");
		felt = newton->gravity;
	}
	return felt;
}

} // namespace yade
