// GPL v2 or later, see LICENSE.
#include <pkg/bonded/BondedInteractionLoop.hpp>
#include <pkg/bonded/BondedNewtonIntegrator.hpp>

#include <pkg/common/Collider.hpp>

#include <sstream>

namespace yade {

DDEM_PLUGIN((BondedNewtonIntegrator))

BondedNewtonIntegrator* BondedNewtonIntegrator::in(const Scene& scene)
{
	for (const auto& engine : scene.engines) {
		auto* const found = dynamic_cast<BondedNewtonIntegrator*>(engine.get());
		if (!found) continue;
		const bool usual = !found->dead && !found->densityScaling && !scene.isPeriodic;
		return usual ? found : nullptr;
	}
	return nullptr;
}

BondedSpheres* BondedNewtonIntegrator::spheres(const Scene& of) const
{
	auto* const loop = BondedInteractionLoop::in(of);
	return loop && !loop->dead && BondedNewtonIntegrator::in(of) == this ? loop->spheresInArrays() : nullptr;
}

void BondedNewtonIntegrator::action()
{
	pythonLooks::watched(); // takes Python's own lock once, so not while others may wait for ours
	auto* const loop = BondedInteractionLoop::in(*scene);
	for (const auto& engine : scene->engines) {
		if (engine.get() == loop) break;
		if (engine.get() == this && loop)
			throw std::runtime_error(
			        "wrong order in O.engines: BondedNewtonIntegrator comes before BondedInteractionLoop, "
			        "so that it would not use its forces; put it after");
	}
	auto* const spheresHere = spheres(*scene);
	inArrays                = spheresHere ? spheresHere->movedHere() : 0;
	if (!spheresHere) return NewtonIntegrator::action();
	const std::lock_guard<std::mutex> lock(loop->busy);
	if (!spheresHere->takeUpChanges(*scene)) {
		inArrays = 0;
		spheresHere->showLoads(scene->forces); // such as damping that came to the arrays alone
		return NewtonIntegrator::action();
	}
	try {
		moveInArrays(*loop, *spheresHere);
	} catch (...) {
		spheresHere->showToAll(); // for who looks for the cause
		throw;
	}
}

void BondedNewtonIntegrator::moveInArrays(BondedInteractionLoop& loop, BondedSpheres& spheresHere)
{
	moveOthers(spheresHere.others());
	spheresHere.takeForces(scene->forces);

	ddem::SphereStep step;
	step.dt          = scene->dt;
	step.damping     = damping;
	step.dampGravity = dampGravity;
	step.energy      = scene->trackEnergy;
	for (int axis = 0; axis < 3; axis++)
		step.gravity[axis] = gravity[axis];
	const ddem::SphereSums sums = spheresHere.motion.step(step);
	if (!sums.finite) stopAtNotFinite(spheresHere);
	if (step.energy) book(sums);
	spheresHere.come(scene->dt * std::sqrt(sums.speedSquared));
	// what a collider asks for: below 1 nothing has left its bound; 0 would be taken for no answer
	maxVelocitySq = math::max(maxVelocitySq, Real(spheresHere.leavesBounds() ? 2 : 0.5));
	show(loop, spheresHere);
}

/// What the base class does, with these bodies alone.
void BondedNewtonIntegrator::moveOthers(const std::vector<Body::id_t>& others)
{
	scene->forces.sync(); // would leave out what is redirected
	BodyContainer& all = *scene->bodies;
	// YADE's own redirection, as it loops over what erasures have left
	const bool redirected = std::exchange(all.useRedirection, true), dirty = std::exchange(all.dirty, false);
	std::vector<Body::id_t> real = std::exchange(all.realBodies, others);
	const auto              back = [&] {
                all.useRedirection = redirected;
                all.dirty          = dirty;
                all.realBodies.swap(real);
	};
	try {
		NewtonIntegrator::action();
	} catch (...) {
		back();
		throw;
	}
	back();
}

void BondedNewtonIntegrator::book(const ddem::SphereSums& sums)
{
	EnergyTracker& energy = *scene->energy;
	if (kinSplit) {
		energy.add(sums.translation, "kinTrans", kinEnergyTransIx, true);
		energy.add(sums.rotation, "kinRot", kinEnergyRotIx, true);
	} else
		energy.add(sums.translation + sums.rotation, "kinetic", kinEnergyIx, true);
	energy.add(-sums.gravityWork, "gravWork", fieldWorkIx, false);
	if (damping != 0) energy.add(sums.dampingLoss, "nonviscDamp", nonviscDampIx, false);
}

void BondedNewtonIntegrator::show(BondedInteractionLoop& loop, BondedSpheres& spheres)
{
	const Onlooker who = onlooker(*scene, *this, showings, BondedInteractionLoop::neverLooksAtBonds, 0.01, &loop);
	const bool     watched = pythonLooks::watched();
	if (who == Onlooker::Anybody || !watched) {
		spheres.showToAll();
		if (who != Onlooker::Nobody) spheres.showLoads(scene->forces);
		return;
	}
	// the collider reads positions, and changes none
	const bool python  = who == Onlooker::Python,
	           picture = who == Onlooker::OtherThreads || (python && showings.due());
	if (picture || loop.colliderIsDue()) {
		showings.begin();
		spheres.showPicture();
		showings.end();
	}
	if (python) {
		spheres.showLoads(scene->forces);
		spheres.expectCommand();
	}
	spheres.hide();
}

void BondedNewtonIntegrator::stopAtNotFinite(const BondedSpheres& spheres) const
{
	for (size_t r = 0; r < spheres.ids.size(); r++) {
		const double *const x = spheres.motion.poseOf(r), *const v = spheres.motion.velocityOf(r);
		bool finite = true;
		for (int k = 0; k < 7; k++)
			finite = finite && std::isfinite(v[k]) && std::isfinite(x[k]);
		if (finite) continue;
		const Vector3r     at = (*scene->bodies)[spheres.ids[r]]->state->refPos;
		std::ostringstream text;
		text << "the motion of the bonded sphere #" << spheres.ids[r] << ", at (" << at[0] << ", " << at[1]
		     << ", " << at[2] << ") m at the start, became infinite or not a number in step " << scene->iter
		     << ", t = " << scene->time << " s; check O.dt = " << scene->dt
		     << " s against ddem.bonded.critical_time_step(), and what moves this body";
		throw std::runtime_error(text.str());
	}
	throw std::runtime_error("the motion of bonded spheres became infinite or not a number");
}

} // namespace yade
