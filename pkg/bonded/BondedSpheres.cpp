// GPL v2 or later, see LICENSE.
#include <pkg/bonded/BondedMat.hpp>
#include <pkg/bonded/BondedPhys.hpp>
#include <pkg/bonded/BondedSpheres.hpp>

#include <lib/pyutil/gil.hpp>

#include <algorithm>
#include <limits>
#include <sstream>
#include <tuple>

namespace yade {

namespace {

	/// Degrees of freedom as SphereMotion counts them.
	unsigned axesOf(unsigned blockedDOFs)
	{
		unsigned axes = 0;
		for (int axis = 0; axis < 3; axis++) {
			if (blockedDOFs & State::axisDOF(axis, false)) axes |= 1u << axis;
			if (blockedDOFs & State::axisDOF(axis, true)) axes |= 8u << axis;
		}
		return axes;
	}

	Vector3r force(const double* load) { return { load[0], load[1], load[2] }; }
	Vector3r moment(const double* load) { return { load[4], load[5], load[6] }; }

} // namespace

bool BondedSpheres::has(const Body& body)
{
	return body.shape && !body.isClump() && isSphere(body) && dynamic_cast<const BondedMat*>(body.material.get());
}

// ---- reading --------------------------------------------------------------------------------------------------------

bool BondedSpheres::sameEngines(const Scene& scene)
{
	std::set<Body::id_t>      drivenNow;
	std::vector<std::int32_t> loadedNow;
	for (const auto& engine : scene.engines) {
		const auto* partial = engine->dead ? nullptr : dynamic_cast<const PartialEngine*>(engine.get());
		if (!partial) continue;
		const bool drives = dynamic_cast<const KinematicEngine*>(partial);
		for (const auto id : partial->ids) {
			if (drives) drivenNow.insert(id);
			else if (const auto r = rowOf(id); r >= 0)
				loadedNow.push_back(r);
		}
	}
	loaded          = std::move(loadedNow);
	const bool same = driven == drivenNow;
	driven          = std::move(drivenNow);
	return same;
}

/// Whether the motion of a sphere is one of SphereMotion: unequal moments of inertia turn as no sphere does, and what
/// nothing moves may have no mass.
bool BondedSpheres::isOrdinary(const Body& body) const
{
	const State& s = *body.state;
	return s.isDamped && s.inertia[0] == s.inertia[1] && s.inertia[1] == s.inertia[2]
	        && s.blockedDOFs != State::DOF_ALL && (mask <= 0 || body.maskCompatible(mask));
}

bool BondedSpheres::matches(const Scene& scene, size_t r) const
{
	const auto& body = (*scene.bodies)[ids[r]];
	return body && body == bodies[r] && body->state == states[r] && body->shape == shapes[r]
	        && body->material == materials[r] && body->isClumpMember() == (guest[r] == 2)
	        && static_cast<const Sphere&>(*body->shape).radius == radius[r]
	        && (guest[r] || isOrdinary(*body));
}

void BondedSpheres::readMass(const Body& body, size_t r)
{
	const State& s = *body.state;
	if (guest[r]) return motion.setMass(r, 0, 0);
	if (!(s.mass > 0) || !(s.inertia.minCoeff() > 0)) {
		std::ostringstream text;
		text << "bonded sphere #" << ids[r] << " has a mass of " << s.mass << " kg and moments of inertia of "
		     << s.inertia.transpose() << " kg·m², which must be positive; block all its degrees of freedom "
		     << "(State.blockedDOFs = 'xyzXYZ') if it is to stay where it is";
		throw std::runtime_error(text.str());
	}
	motion.setMass(r, s.mass, s.inertia[0]);
}

void BondedSpheres::readAll(Scene& scene, const NewtonIntegrator* mover)
{
	leave();
	inArrays   = mover;
	knownMover = mover;
	mask       = mover ? mover->mask : -1;
	ids.clear();
	for (auto& body : bodies)
		dropped.push_back(std::move(body));
	for (auto& state : states)
		dropped.push_back(std::move(state));
	for (auto& shape : shapes)
		dropped.push_back(std::move(shape));
	for (auto& material : materials)
		dropped.push_back(std::move(material));
	bodies.clear();
	states.clear();
	shapes.clear();
	materials.clear();
	otherIds.clear();
	row.assign(scene.bodies->size(), -1);
	for (const auto& body : *scene.bodies)
		if (has(*body)) {
			row[size_t(body->getId())] = std::int32_t(ids.size());
			ids.push_back(body->getId());
			bodies.push_back(body);
			states.push_back(body->state);
			shapes.push_back(body->shape);
			materials.push_back(body->material);
		}
	sameEngines(scene);
	motion.resize(ids.size());
	radius.resize(ids.size());
	guest.assign(ids.size(), 0);
	guests.clear();
	for (size_t r = 0; r < ids.size(); r++) {
		const Body& body = *bodies[r];
		if (body.isClumpMember()) guest[r] = 2;
		else if (!mover || !isOrdinary(body) || driven.count(ids[r]))
			guest[r] = 1;
		if (guest[r]) guests.push_back(std::int32_t(r));
		radius[r] = static_cast<const Sphere&>(*body.shape).radius;
		readMass(body, r);
	}
	for (const auto& body : *scene.bodies) {
		const auto r = rowOf(body->getId());
		if (r < 0 || guest[size_t(r)]) otherIds.push_back(body->getId());
	}
	for (size_t r = 0; r < ids.size(); r++)
		import(r);
	wasTouched.assign(ids.size(), 0);
	touched.clear();
	known         = &scene;
	sceneBodies   = scene.bodies->size();
	slackOfBounds = -1;
	foreign.clear();
}

Real BondedSpheres::import(size_t r)
{
	const State&  s  = *states[r];
	double* const to = motion.poseOf(r);
	double* const v  = motion.velocityOf(r);
	Real          square = 0;
	for (int axis = 0; axis < 3; axis++) {
		const Real by = s.pos[axis] - to[axis];
		square += by * by;
		to[axis]    = s.pos[axis];
		v[axis]     = s.vel[axis];
		v[4 + axis] = s.angVel[axis];
	}
	to[4] = s.ori.w();
	to[5] = s.ori.x();
	to[6] = s.ori.y();
	to[7] = s.ori.z();
	if (!guest[r]) motion.block(r, axesOf(s.blockedDOFs));
	return square >= 0 ? std::sqrt(square) : std::numeric_limits<Real>::infinity();
}

void BondedSpheres::importShown()
{
	Real far = 0;
	if (shown == Shown::All) {
		const auto size = std::ptrdiff_t(ids.size());
		// what blocks degrees of freedom may make room for it: not at the same time
#pragma omp parallel for schedule(static) reduction(max : far)
		for (std::ptrdiff_t r = 0; r < size; r++) {
			if (guest[size_t(r)]) continue;
			const State& s = *states[size_t(r)];
			if (motion.blocked(size_t(r)) == axesOf(s.blockedDOFs)) far = std::max(far, import(size_t(r)));
		}
		for (size_t r = 0; r < ids.size(); r++)
			if (!guest[r] && motion.blocked(r) != axesOf(states[r]->blockedDOFs))
				far = std::max(far, import(r));
		for (size_t r = 0; r < ids.size(); r++)
			if (!guest[r]
			    && (motion.massOf(r) != states[r]->mass || motion.inertiaOf(r) != states[r]->inertia[0]))
				readMass(*bodies[r], r);
	} else
		for (const auto r : touched) {
			far = std::max(far, import(size_t(r)));
			readMass(*bodies[size_t(r)], size_t(r));
		}
	come(far);
}

/// Whether bodies and engines are those that were read, as far as anybody could have changed them.
bool BondedSpheres::isSame(const Scene& scene, const NewtonIntegrator* mover)
{
	if (known != &scene || inArrays != bool(mover) || (mover && mask != mover->mask)
	    || scene.bodies->size() != sceneBodies)
		return false;
	if (shown == Shown::Nothing) return true;
	bool same = sameEngines(scene);
	for (const auto id : otherIds)
		same = same && (*scene.bodies)[id];
	for (const auto r : touched)
		same = same && matches(scene, size_t(r));
	if (!same || shown != Shown::All) return same;
	const auto size = std::ptrdiff_t(ids.size());
#pragma omp parallel for schedule(static) reduction(&& : same)
	for (std::ptrdiff_t r = 0; r < size; r++)
		same = same && matches(scene, size_t(r));
	return same;
}

bool BondedSpheres::update(Scene& scene, const NewtonIntegrator* mover)
{
	pythonLooks::end(*this);
	const bool looked = shown != Shown::Nothing && (shown == Shown::All || !touched.empty());
	const bool same   = isSame(scene, mover);
	if (same) {
		if (looked && mover) importShown();
		Real       far  = 0;
		const auto size = std::ptrdiff_t(guests.size());
#pragma omp parallel for schedule(static) reduction(max : far) if (size > 200)
		for (std::ptrdiff_t k = 0; k < size; k++)
			far = std::max(far, import(size_t(guests[size_t(k)])));
		if (size > 0) come(far);
	} else
		readAll(scene, mover);
	for (const auto r : touched)
		wasTouched[size_t(r)] = 0;
	touched.clear();
	if (same)
		forForeign([this](size_t r) {
			std::fill_n(taken.data() + ddem::sphereRow * std::ptrdiff_t(r), ddem::sphereRow, 0.);
		});
	else
		taken.assign(size_t(ddem::sphereRow) * ids.size(), 0.);
	foreignNow = foreign;
	foreignNow.insert(foreignNow.end(), loaded.begin(), loaded.end());
	// a command may have added forces, whatever it has touched
	allForeign = looked || commanded || scene.forces.getPermForceUsed();
	commanded  = false;
	if (mover) shown = Shown::Nothing;
	return !same;
}

void BondedSpheres::release()
{
	if (dropped.empty()) return;
	const gilLock lock;
	dropped.clear();
}

bool BondedSpheres::takeUpChanges(const Scene& scene)
{
	if (shown == Shown::Nothing) return true;
	if (!isSame(scene, knownMover)) return false;
	importShown();
	allForeign = true;
	shown      = Shown::Nothing;
	return true;
}

void BondedSpheres::leave()
{
	pythonLooks::end(*this);
	showToAll();
}

// ---- the collider's bounds ------------------------------------------------------------------------------------------

bool BondedSpheres::leavesBounds()
{
	if (slackOfBounds >= 0 && wayOfBounds < slackOfBounds) return false;
	Real       slack = std::numeric_limits<Real>::infinity();
	const auto size  = std::ptrdiff_t(ids.size());
#pragma omp parallel for schedule(static) reduction(min : slack)
	for (std::ptrdiff_t r = 0; r < size; r++) {
		const auto& bound = bodies[size_t(r)]->bound;
		if (guest[size_t(r)] || !bound) continue;
		Real          far = 0; // as NewtonIntegrator::saveMaximaDisplacement measures it
		const double* x   = motion.poseOf(size_t(r));
		for (int axis = 0; axis < 3; axis++)
			far = std::max(far, std::abs(x[axis] - bound->refPos[axis]));
		slack = std::min(slack, far == 0 && bound->sweepLength == 0 ? slack : bound->sweepLength - far);
	}
	wayOfBounds   = 0;
	slackOfBounds = slack;
	return slack <= 0;
}

// ---- forces ---------------------------------------------------------------------------------------------------------

namespace {

	/// Adds the loads of some rows to a container that is in sync, as many at a time as there are threads: adding
	/// in the ordinary way would let threads wait for each other's memory. What others add later is added to it.
	template <class Load>
	void
	addLoads(ForceContainer& forces, const std::vector<Body::id_t>& ids, std::ptrdiff_t count, const Load& load)
	{
		forces.sync();
#pragma omp parallel for schedule(static) if (!pythonLooks::inForkedProcess())
		for (std::ptrdiff_t k = 0; k < count; k++) {
			const auto [row, f, m] = load(size_t(k));
			forces.addForceUnsynced(ids[row], f);
			forces.addTorqueUnsynced(ids[row], m);
		}
	}

} // namespace

void BondedSpheres::showGuestLoads(ForceContainer& forces)
{
	if (guests.empty()) return;
	addLoads(forces, ids, std::ptrdiff_t(guests.size()), [this](size_t k) {
		const auto          r    = size_t(guests[k]);
		const double* const load = motion.loadOf(r);
		return std::make_tuple(r, force(load), moment(load));
	});
}

void BondedSpheres::moveLoads(ForceContainer& forces)
{
	addLoads(forces, ids, std::ptrdiff_t(ids.size()), [this](size_t r) {
		double* const  load = motion.loadOf(r);
		const Vector3r f = force(load), m = moment(load);
		if (guest[r]) return std::make_tuple(r, Vector3r(Vector3r::Zero()), Vector3r(Vector3r::Zero()));
		std::fill_n(load, ddem::sphereRow, 0.);
		return std::make_tuple(r, f, m);
	});
	allForeign = true; // takeForces brings them back, with what others add
}

template <class Act> void BondedSpheres::forForeign(const Act& act) const
{
	if (allForeign)
		for (size_t r = 0; r < ids.size(); r++)
			act(r);
	else
		for (const auto r : foreignNow)
			act(size_t(r));
}

void BondedSpheres::takeForces(ForceContainer& forces)
{
	forces.sync();
	forForeign([&](size_t r) {
		if (guest[r]) return;
		const Vector3r f = forces.getForce(ids[r]), m = forces.getTorque(ids[r]);
		double *const        load   = motion.loadOf(r),
		              *const before = taken.data() + ddem::sphereRow * std::ptrdiff_t(r);
		for (int axis = 0; axis < 3; axis++) {
			load[axis] += f[axis] - std::exchange(before[axis], f[axis]);
			load[4 + axis] += m[axis] - std::exchange(before[4 + axis], m[axis]);
		}
	});
}

void BondedSpheres::showLoads(ForceContainer& forces) const
{
	addLoads(forces, ids, std::ptrdiff_t(ids.size()), [this](size_t r) {
		const double *const        load  = motion.loadOf(r),
		                    *const there = taken.data() + ddem::sphereRow * std::ptrdiff_t(r);
		if (guest[r]) return std::make_tuple(r, Vector3r(Vector3r::Zero()), Vector3r(Vector3r::Zero()));
		return std::make_tuple(r, Vector3r(force(load) - force(there)), Vector3r(moment(load) - moment(there)));
	});
}

void BondedSpheres::setForeign(std::vector<std::int32_t> rows)
{
	foreignNow.insert(foreignNow.end(), rows.begin(), rows.end());
	foreign = std::move(rows);
}

void BondedSpheres::addForeign(std::int32_t first, std::int32_t second)
{
	for (const auto r : { first, second })
		if (r >= 0) foreignNow.push_back(r);
}

// ---- State ----------------------------------------------------------------------------------------------------------

bool BondedSpheres::isAhead(Body::id_t id) const
{
	const auto r = rowOf(id);
	return r >= 0 && shown != Shown::All && !guest[size_t(r)] && !wasTouched[size_t(r)];
}

void BondedSpheres::copy(size_t r, State& to) const
{
	const double *const x = motion.poseOf(r), *const v = motion.velocityOf(r);
	to.pos    = Vector3r(x[0], x[1], x[2]);
	to.ori    = Quaternionr(x[4], x[5], x[6], x[7]);
	to.vel    = Vector3r(v[0], v[1], v[2]);
	to.angVel = Vector3r(v[4], v[5], v[6]);
}

void BondedSpheres::show(size_t r) const
{
	if (!guest[r]) copy(r, *states[r]);
}

void BondedSpheres::show(const std::vector<std::int32_t>& rows) const
{
	if (shown != Shown::Nothing) return;
	for (const auto r : rows)
		show(size_t(r));
}

void BondedSpheres::showPicture() const
{
	if (shown == Shown::All) return;
	const auto size = std::ptrdiff_t(ids.size());
#pragma omp parallel for schedule(static) if (!pythonLooks::inForkedProcess())
	for (std::ptrdiff_t r = 0; r < size; r++)
		if (!wasTouched[size_t(r)]) show(size_t(r));
}

void BondedSpheres::showToAll()
{
	showPicture();
	shown = Shown::All;
	rowOfState.clear(); // a body may get another State now
}

void BondedSpheres::hide()
{
	if (!inArrays) return;
	shown = Shown::Touched;
	pythonLooks::begin(*this);
}

void BondedSpheres::show(const State* state)
{
	if (shown != Shown::Touched) return;
	if (rowOfState.empty()) {
		rowOfState.reserve(ids.size());
		for (size_t r = 0; r < ids.size(); r++)
			rowOfState.emplace(states[r].get(), std::int32_t(r));
	}
	const auto found = rowOfState.find(state);
	if (found == rowOfState.end() || wasTouched[size_t(found->second)] || guest[size_t(found->second)]) return;
	show(size_t(found->second));
	wasTouched[size_t(found->second)] = 1;
	touched.push_back(found->second);
}

void BondedSpheres::showAll()
{
	if (shown == Shown::Touched) showToAll();
}

} // namespace yade
