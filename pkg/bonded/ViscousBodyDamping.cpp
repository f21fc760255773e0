// GPL v2 or later, see LICENSE.
// Viscous damping of translation and rotation of every particle.
#include <pkg/bonded/ViscousBodyDamping.hpp>
#include <pkg/ddem/kernel/BondDamping.hpp>

namespace yade {

DDEM_PLUGIN((ViscousBodyDamping))

namespace {

	/// Damping loads of the free components of one motion, and what they take away.
	struct Drag {
		Vector3r load = Vector3r::Zero();
		Real     loss = 0;
	};

	Drag drag(const Vector3r& velocity, const Vector3r& load, const Vector3r& mass, Real viscosity, Real dt, const State& state, bool rotation)
	{
		Drag result;
		for (int axis = 0; axis < 3; axis++) {
			if (state.blockedDOFs & State::axisDOF(axis, rotation)) continue;
			result.load[axis] = ddem::viscousLoad(velocity[axis], load[axis], mass[axis], viscosity, dt);
			result.loss -= result.load[axis] * dt * (velocity[axis] + 0.5 * dt * (load[axis] + result.load[axis]) / mass[axis]);
		}
		return result;
	}

} // namespace

void ViscousBodyDamping::postLoad(ViscousBodyDamping&)
{
	for (const auto& [name, value] : { std::make_pair("viscosity", viscosity), std::make_pair("rotationalViscosity", rotationalViscosity) })
		if (!(value >= 0) || !std::isfinite(value))
			throw std::invalid_argument("ViscousBodyDamping: " + std::string(name) + " = " + std::to_string(value) + " 1/s must not be negative");
}

const NewtonIntegrator& ViscousBodyDamping::checkedIntegrator() const
{
	bool seen = false;
	for (const auto& engine : scene->engines) {
		if (engine.get() == this) seen = true;
		else if (seen && engine->getClassName() == "InteractionLoop")
			throw std::runtime_error("wrong order in O.engines: ViscousBodyDamping comes before InteractionLoop and would miss its forces; put it "
			                         "right before NewtonIntegrator");
		else if (const auto* newton = dynamic_cast<const NewtonIntegrator*>(engine.get())) {
			if (!seen)
				throw std::runtime_error(
				        "wrong order in O.engines: ViscousBodyDamping comes after NewtonIntegrator, so it has no effect; put it right before");
			return *newton;
		}
	}
	throw std::runtime_error("ViscousBodyDamping needs NewtonIntegrator after it in O.engines");
}

void ViscousBodyDamping::action()
{
	const int  mask = checkedIntegrator().mask;
	const Real dt   = scene->dt;
	Real       loss = 0;
	scene->forces.sync();
	for (const auto& body : *scene->bodies) {
		if (!body || body->isClumpMember() || body->isClump() || (mask > 0 && !body->maskCompatible(mask))) continue;
		const State& state = *body->state;
		if (state.blockedDOFs == State::DOF_ALL) continue;
		const auto linear  = drag(state.vel, scene->forces.getForce(body->id), Vector3r::Constant(state.mass), viscosity, dt, state, false);
		const auto angular = drag(state.angVel, scene->forces.getTorque(body->id), state.inertia, rotationalViscosity, dt, state, true);
		scene->forces.addForceUnsynced(body->id, linear.load);
		scene->forces.addTorqueUnsynced(body->id, angular.load);
		loss += linear.loss + angular.loss;
	}
	if (scene->trackEnergy) scene->energy->add(loss, "bodyDamping", lossIx, false);
}

} // namespace yade
