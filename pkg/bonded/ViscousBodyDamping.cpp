// GPL v2 or later, see LICENSE.
// Viscous damping of translation and rotation of every particle.
#include <pkg/bonded/BondedNewtonIntegrator.hpp>
#include <pkg/bonded/ViscousBodyDamping.hpp>
#include <pkg/bonded/kernel/BondDamping.hpp>

namespace yade {

DDEM_PLUGIN((ViscousBodyDamping))

namespace {

	/// Damping loads of one motion; none where it is blocked.
	Vector3r dragLoad(
	        const ddem::ViscousDamper& damper, const Vector3r& velocity, const Vector3r& load, const Vector3r& mass,
	        const State& state, bool rotation)
	{
		Vector3r drag;
		for (int axis = 0; axis < 3; axis++)
			drag[axis] = damper.load(velocity[axis], load[axis], mass[axis]);
		if (state.blockedDOFs)
			for (int axis = 0; axis < 3; axis++)
				if (state.blockedDOFs & State::axisDOF(axis, rotation)) drag[axis] = 0;
		return drag;
	}

	/// What they take away [J].
	Real dragLoss(
	        const ddem::ViscousDamper& damper, const Vector3r& velocity, const Vector3r& load, const Vector3r& mass,
	        const State& state, bool rotation)
	{
		Real loss = 0;
		for (int axis = 0; axis < 3; axis++)
			if (!(state.blockedDOFs & State::axisDOF(axis, rotation)))
				loss += damper.loss(velocity[axis], load[axis], mass[axis]);
		return loss;
	}

} // namespace

void ViscousBodyDamping::postLoad(ViscousBodyDamping&)
{
	for (const auto& [name, value] :
	     { std::make_pair("viscosity", viscosity), std::make_pair("rotationalViscosity", rotationalViscosity) })
		if (!(value >= 0) || !std::isfinite(value))
			throw std::invalid_argument(
			        "ViscousBodyDamping: " + std::string(name) + " = " + std::to_string(value)
			        + " 1/s must not be negative");
}

const NewtonIntegrator& ViscousBodyDamping::checkedIntegrator() const
{
	bool seen = false;
	for (const auto& engine : scene->engines) {
		if (engine.get() == this) seen = true;
		else if (seen && dynamic_cast<const InteractionLoop*>(engine.get()))
			throw std::runtime_error("wrong order in O.engines: ViscousBodyDamping comes before "
			                         "InteractionLoop and would miss its forces; put it right before "
			                         "NewtonIntegrator");
		else if (const auto* newton = dynamic_cast<const NewtonIntegrator*>(engine.get())) {
			if (!seen)
				throw std::runtime_error("wrong order in O.engines: ViscousBodyDamping comes after "
				                         "NewtonIntegrator, so it has no effect; put it right before");
			return *newton;
		}
	}
	throw std::runtime_error("ViscousBodyDamping needs NewtonIntegrator after it in O.engines");
}

void ViscousBodyDamping::action()
{
	const NewtonIntegrator&   integrator = checkedIntegrator();
	const int                 mask       = integrator.mask;
	const ddem::ViscousDamper linear(viscosity, scene->dt), angular(rotationalViscosity, scene->dt);
	const auto&               bodies = *scene->bodies;
	const auto* const         arrays = dynamic_cast<const BondedNewtonIntegrator*>(&integrator);
	BondedSpheres* const      moved  = arrays ? arrays->spheres(*scene) : nullptr;
	const long                size   = long(moved ? moved->others().size() : bodies.size());
	const bool                book   = scene->trackEnergy;
	Real                      loss   = 0;
	scene->forces.sync();
#pragma omp parallel for schedule(static) reduction(+ : loss)
	for (long i = 0; i < size; i++) {
		const Body::id_t id   = moved ? moved->others()[size_t(i)] : Body::id_t(i);
		const Body*      body = bodies[id].get();
		if (!body || body->isClumpMember() || body->isClump() || (mask > 0 && !body->maskCompatible(mask)))
			continue;
		const State& state = *body->state;
		if (state.blockedDOFs == State::DOF_ALL) continue;
		const Vector3r force = scene->forces.getForce(id), torque = scene->forces.getTorque(id),
		               mass = Vector3r::Constant(state.mass);
		scene->forces.addForceUnsynced(id, dragLoad(linear, state.vel, force, mass, state, false));
		scene->forces.addTorqueUnsynced(
		        id, dragLoad(angular, state.angVel, torque, state.inertia, state, true));
		if (book)
			loss += dragLoss(linear, state.vel, force, mass, state, false)
			        + dragLoss(angular, state.angVel, torque, state.inertia, state, true);
	}
	if (moved) {
		moved->takeForces(scene->forces);
		loss += moved->motion.drag(viscosity, rotationalViscosity, scene->dt, book);
	}
	if (!book) return;
	// Half of this step's loss comes after the present positions; see RampedTranslationEngine.
	scene->energy->add(0.5 * (lastLoss + loss), "bodyDamping", lossIx, false);
	lastLoss = loss;
}

} // namespace yade
