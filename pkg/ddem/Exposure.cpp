// GPL v2 or later, see LICENSE.
#include <pkg/ddem/Exposure.hpp>

#include <pkg/ddem/DeformableNode.hpp>

#include <algorithm>
#include <sstream>
#include <tuple>

namespace yade {

std::string placeOf(const Body& b)
{
	std::ostringstream text;
	text << "body " << b.getId() << " at (" << b.state->refPos[0] << ", " << b.state->refPos[1]
	     << ") m (reference position)";
	return text.str();
}

namespace {

	constexpr unsigned planeDofs = State::DOF_X | State::DOF_Y, coreDofs = planeDofs | State::DOF_RZ;

	void requireFinite(const Body& b)
	{
		const State& s = *b.state;
		if (s.pos.allFinite() && s.refPos.allFinite() && s.vel.allFinite() && s.angVel.allFinite()
		    && s.ori.coeffs().allFinite())
			return;
		throw std::invalid_argument(
		        placeOf(b)
		        + ": position, velocity or orientation is not finite; set State.pos, State.refPos, State.vel "
		          "to numbers [m, m/s]");
	}

	Real angleOf(const Quaternionr& q) { return 2 * std::atan2(q.z(), q.w()); }

	Quaternionr turnBy(Real angle) { return Quaternionr(std::cos(angle / 2), 0, 0, std::sin(angle / 2)); }

	const DeformableTriangle& triangleShape(const Body& b)
	{
		return static_cast<const DeformableTriangle&>(*b.shape);
	}

} // namespace

StateStore storeOf(const ddem::TriangleSystem& s, const SampleIds& ids)
{
	StateStore               carried;
	const ddem::Motion::Book book = s.motion.book();
	carried.lastTimeStep          = s.motion.lastTimeStep;
	carried.pendingWork           = { book.gravityWork, book.externalWork, book.dampingLoss,
		                          book.edgeWork, book.edgeAbsorption };
	carried.flowClock             = s.group.front()->flowClock; // all groups take the same steps
	const auto point = [](StateStore::Point& to, const ddem::Points& from, const std::vector<double>& last,
	                      unsigned blocked, std::size_t i) {
		to.blocked = blocked;
		for (std::size_t c = 0; c < 2; c++) {
			to.position[c]     = from.position[2 * i + c];
			to.velocity[c]     = from.velocity[2 * i + c];
			to.force[c]        = from.force[2 * i + c];
			to.lastVelocity[c] = last[2 * i + c];
		}
	};
	for (std::size_t i = 0; i < ids.node.size(); i++)
		if (ids.node[i] >= 0)
			point(carried.nodes[ids.node[i]], s.motion.node, book.nodeVelocity, ids.nodeBlocked[i], i);
	for (std::size_t i = 0; i < ids.core.size(); i++) {
		if (ids.core[i] < 0) continue;
		StateStore::Core& core = carried.cores[ids.core[i]];
		point(core, s.motion.core, book.coreVelocity, ids.coreBlocked[i], i);
		core.spins = s.motion.spin.size() > 0;
		if (core.spins) {
			core.angle    = s.motion.spin.angle[i];
			core.spin     = s.motion.spin.velocity[i];
			core.moment   = s.motion.spin.moment[i];
			core.lastSpin = book.spinVelocity[i];
		}
		const ddem::LawGroup& group = s.groupOf(i);
		carried.keep(ids.core[i], group, i - group.begin);
	}
	return carried;
}

StateStore Exposure::store() const { return storeOf(*system, { nodeId, coreId, nodeBlocked, coreBlocked }); }

StateStore storeOfFormerEngines(const Scene& scene, const std::vector<shared_ptr<Body>>& triangles)
{
	std::map<const ddem::TriangleSystem*, SampleIds> samples;
	for (const auto& b : triangles) {
		const DeformableTriangle& shape = triangleShape(*b);
		if (!shape.system) continue;
		if (const auto former = shape.exposure.lock()) former->leave(); // State may lag: a run was paused
		const ddem::TriangleSystem& s   = *shape.system;
		SampleIds&                  ids = samples[&s];
		if (ids.core.empty()) {
			ids.core.assign(s.motion.core.size(), -1);
			ids.node.assign(s.motion.node.size(), -1);
			ids.coreBlocked.resize(ids.core.size());
			ids.nodeBlocked.resize(ids.node.size());
		}
		ids.core[shape.row]        = b->getId();
		ids.coreBlocked[shape.row] = b->state->blockedDOFs;
		for (std::size_t e = 0; e < 3; e++) {
			const Body::id_t id   = shape.nodes[Eigen::Index(e)];
			const auto       node = std::size_t(s.topology.vertex[e][shape.row]);
			if (!scene.bodies->exists(id)) continue;
			ids.node[node]        = id;
			ids.nodeBlocked[node] = (*scene.bodies)[id]->state->blockedDOFs;
		}
	}
	StateStore carried;
	for (const auto& sample : samples)
		carried.take(storeOf(*sample.first, sample.second));
	return carried;
}

namespace {

	/// Deformable triangles and nodes of a scene.
	std::pair<std::size_t, std::size_t> countDeformable(const Scene& scene)
	{
		std::size_t triangles = 0, points = 0;
		for (const auto& b : *scene.bodies) {
			if (!b || !b->shape) continue;
			triangles += dynamic_cast<const DeformableTriangle*>(b->shape.get()) != nullptr;
			points += dynamic_cast<const DeformableNode*>(b->shape.get()) != nullptr;
		}
		return { triangles, points };
	}

} // namespace

void Exposure::countBodies(const Scene& scene)
{
	sceneBodies                             = scene.bodies->size();
	std::tie(sceneTriangles, sceneNodes) = countDeformable(scene);
}

bool Exposure::misses(const Scene& scene)
{
	if (scene.bodies->size() == sceneBodies) return false;
	requireComplete(scene); // one erased and one added leave their number as it was
	if (countDeformable(scene) != std::make_pair(sceneTriangles, sceneNodes)) return true;
	sceneBodies = scene.bodies->size(); // bodies of other kinds have come
	return false;
}

bool Exposure::materialsChanged(bool started)
{
	for (const auto& known : materials)
		if (static_cast<const DeformableElastMat&>(*known.first).ownLaw().values != known.second) return true;
	if (replaced) return true;
	if (shapeChanges == DeformableTriangle::changes) return false;
	bool changed = false;
	for (std::size_t i = 0; i < cores.size(); i++) {
		const auto now = triangleShape(*cores[i]).values();
		if (now == shapeValues[i]) continue;
		changed = true;
		if (started && now.initialDamage != shapeValues[i].initialDamage)
			throw std::invalid_argument(
			        placeOf(*cores[i])
			        + ": DeformableTriangle.initialDamage is the damage [-] at the start, and the run has "
			          "begun; give it before the first step (a material with less strength weakens "
			          "a triangle during a run)");
		if (started && now.initialStress != shapeValues[i].initialStress)
			throw std::invalid_argument(
			        placeOf(*cores[i])
			        + ": DeformableTriangle.initialStress is the stress [Pa] at the start, and the run has "
			          "begun; give it before the first step");
	}
	if (!changed) shapeChanges = DeformableTriangle::changes;
	return changed;
}

void Exposure::adopt(int groupMask)
{
	const ddem::Motion& motion = system->motion;
	for (std::size_t i = 0; i < nodes.size(); i++) {
		nodes[i]->groupMask   = groupMask;
		nodes[i]->state->mass = motion.node.mass[i];
	}
	for (std::size_t i = 0; i < cores.size(); i++) {
		cores[i]->groupMask      = groupMask;
		cores[i]->state->mass    = motion.core.mass[i];
		cores[i]->state->inertia = Vector3r(0, 0, motion.spin.size() ? motion.spin.inertia[i] : 0);
		auto& shape              = static_cast<DeformableTriangle&>(*cores[i]->shape);
		shape.system             = system;
		shape.exposure           = weak_from_this();
		shape.row                = i;
	}
	shapeChanges = DeformableTriangle::changes;
}

void Exposure::applyBlockedDegreesOfFreedom()
{
	const auto inverse = [](double mass, bool blocked) { return blocked ? 0 : 1 / mass; };
	const auto apply   = [&](ddem::Points& points, const std::vector<unsigned>& blocked,
                               std::vector<std::size_t>& constrained, unsigned relevant) {
                constrained.clear();
                for (std::size_t i = 0; i < blocked.size(); i++) {
                        points.inverseMass[2 * i]     = inverse(points.mass[i], blocked[i] & State::DOF_X);
                        points.inverseMass[2 * i + 1] = inverse(points.mass[i], blocked[i] & State::DOF_Y);
                        if (blocked[i] & relevant) constrained.push_back(i);
                }
	};
	apply(system->motion.node, nodeBlocked, constrainedNodes, planeDofs);
	apply(system->motion.core, coreBlocked, constrainedCores, coreDofs);
	for (std::size_t i = 0; i < system->motion.spin.size(); i++)
		system->motion.spin.inverseInertia[i]
		        = inverse(system->motion.spin.inertia[i], coreBlocked[i] & State::DOF_RZ);
	system->motion.collectConstraints();
	isConstrained.assign(nodes.size() + cores.size(), 0);
	for (const auto i : constrainedNodes)
		isConstrained[i] = 1;
	for (const auto i : constrainedCores)
		isConstrained[nodes.size() + i] = 1;
}

namespace {

	void exposePoint(const Body& b, const ddem::Points& points, std::size_t i)
	{
		State& s = *b.state;
		s.pos[0] = points.position[2 * i];
		s.pos[1] = points.position[2 * i + 1];
		s.vel[0] = points.velocity[2 * i];
		s.vel[1] = points.velocity[2 * i + 1];
	}

	void exposeRotation(const Body& b, const ddem::TriangleSystem& s, std::size_t i)
	{
		b.state->ori = turnBy(s.frameAngle(i));
		if (s.motion.spin.size()) b.state->angVel[2] = s.motion.spin.velocity[i];
	}

	/// Bodies that live kinematic engines drive. Those engines wipe the velocity of their bodies in every step,
	/// in free directions, too, before they set it.
	std::vector<char> drivenBodies(const Scene& scene)
	{
		std::vector<char> driven(scene.bodies->size(), 0);
		for (const auto& e : scene.engines)
			if (const auto* drive = dynamic_cast<const KinematicEngine*>(e.get()); drive && !drive->dead)
				for (const auto id : drive->ids)
					if (id >= 0 && std::size_t(id) < driven.size()) driven[std::size_t(id)] = 1;
		return driven;
	}

	/// \param driven whether velocities in free directions are to be left alone
	bool importPoint(const Body& b, ddem::Points& points, std::size_t i, bool driven)
	{
		const State& s       = *b.state;
		bool         changed = false;
		for (std::size_t c = 0; c < 2; c++) {
			const auto axis = Eigen::Index(c);
			changed |= s.pos[axis] != points.position[2 * i + c];
			points.position[2 * i + c] = s.pos[axis];
			if (driven && points.inverseMass[2 * i + c] > 0) continue;
			changed |= s.vel[axis] != points.velocity[2 * i + c];
			points.velocity[2 * i + c] = s.vel[axis];
		}
		if (changed) requireFinite(b);
		return changed;
	}

} // namespace

void Exposure::expose(std::size_t row) const
{
	if (row < nodes.size()) return exposePoint(*nodes[row], system->motion.node, row);
	const std::size_t i = row - nodes.size();
	exposePoint(*cores[i], system->motion.core, i);
	exposeRotation(*cores[i], *system, i);
}

void Exposure::showPicture() const
{
	// a process that a command has forked has none of the threads
	const auto rows = std::ptrdiff_t(nodes.size() + cores.size());
#pragma omp parallel for schedule(static) if (!pythonLooks::inForkedProcess())
	for (std::ptrdiff_t row = 0; row < rows; row++)
		expose(std::size_t(row));
}

void Exposure::exposeAll()
{
	showPicture();
	allIsShown();
}

void Exposure::allIsShown()
{
	shown = Shown::All;
	rowOfState.clear(); // a body may get another State now
}

void Exposure::exposeConstrained()
{
	for (const auto i : constrainedNodes)
		expose(i);
	for (const auto i : constrainedCores)
		expose(nodes.size() + i);
	shown = Shown::Constrained;
}

// ---- looks of Python ------------------------------------------------------------------------------------------------

void Exposure::beginLook()
{
	exposeConstrained();
	shown = Shown::Touched;
	touched.clear();
	lookNumber++;
	pythonLooks::begin(*this);
}

void Exposure::show(const State* state)
{
	if (shown != Shown::Touched) return;
	if (rowOfState.empty()) {
		rowOfState.reserve(nodes.size() + cores.size());
		for (std::size_t i = 0; i < nodes.size(); i++)
			rowOfState.emplace(nodes[i]->state.get(), i);
		for (std::size_t i = 0; i < cores.size(); i++)
			rowOfState.emplace(cores[i]->state.get(), nodes.size() + i);
		lookOfRow.resize(nodes.size() + cores.size());
	}
	const auto found = rowOfState.find(state);
	if (found == rowOfState.end() || wasTouched(found->second)) return;
	if (!isConstrained[found->second]) expose(found->second);
	lookOfRow[found->second] = lookNumber;
	touched.push_back(found->second);
}

void Exposure::exposeUntouched() const
{
	const auto rows = std::ptrdiff_t(nodes.size() + cores.size());
#pragma omp parallel for schedule(static) if (!pythonLooks::inForkedProcess())
	for (std::ptrdiff_t row = 0; row < rows; row++)
		if (!isConstrained[std::size_t(row)] && !wasTouched(std::size_t(row))) expose(std::size_t(row));
}

void Exposure::showAll()
{
	if (shown != Shown::Touched) return;
	exposeUntouched();
	allIsShown();
}

void Exposure::leave()
{
	endLook();
	if (shown == Shown::All) return;
	exposeUntouched();
	allIsShown();
}

void Exposure::finishLook(const Scene& scene)
{
	endLook();
	if (shown == Shown::Touched) importChanges(scene);
	exposeAll();
}

namespace {

	void requireInScene(const Scene& scene, const Body& b, Body::id_t id)
	{
		if (b.getId() == id && scene.bodies->exists(id)) return;
		std::ostringstream text;
		text << "body " << id << " at (" << b.state->refPos[0] << ", " << b.state->refPos[1]
		     << ") m was erased: deformable nodes and triangles cannot be erased during a simulation; "
		        "hold them, or build the scene without them";
		throw std::invalid_argument(text.str());
	}

} // namespace

void Exposure::requireComplete(const Scene& scene) const
{
	for (std::size_t i = 0; i < nodes.size(); i++)
		requireInScene(scene, *nodes[i], nodeId[i]);
	for (std::size_t i = 0; i < cores.size(); i++)
		requireInScene(scene, *cores[i], coreId[i]);
}

void Exposure::importNode(const Scene& scene, std::size_t i, bool driven, bool& blockedChanged)
{
	const Body& b = *nodes[i];
	requireInScene(scene, b, nodeId[i]);
	importPoint(b, system->motion.node, i, driven);
	blockedChanged |= b.state->blockedDOFs != nodeBlocked[i];
	nodeBlocked[i] = b.state->blockedDOFs;
}

void Exposure::importCore(const Scene& scene, std::size_t i, bool driven, bool& blockedChanged)
{
	const Body& b = *cores[i];
	requireInScene(scene, b, coreId[i]);
	importPoint(b, system->motion.core, i, driven);
	blockedChanged |= b.state->blockedDOFs != coreBlocked[i];
	coreBlocked[i] = b.state->blockedDOFs;
	replaced |= b.material != materials[coreMaterial[i]].first;
	ddem::Spins& spin = system->motion.spin;
	if (!spin.size()) return;
	const State& state = *b.state;
	if (state.ori.coeffs() != turnBy(spin.angle[i]).coeffs()) {
		requireFinite(b);
		spin.angle[i] = angleOf(state.ori);
	}
	spin.velocity[i] = state.angVel[2];
	if (!std::isfinite(spin.velocity[i])) requireFinite(b);
}

void Exposure::importChanges(const Scene& scene)
{
	if (shown == Shown::Constrained) return;
	// the look may still be open, to other threads as well
	const auto lock = shown == Shown::Touched ? pythonLooks::lock() : std::unique_lock<std::mutex>();
	if (shown == Shown::Touched && touched.empty()) return;
	bool       blockedChanged = false;
	const auto driven         = drivenBodies(scene);
	const auto isDriven = [&](Body::id_t id) { return std::size_t(id) < driven.size() && driven[std::size_t(id)]; };
	const auto import         = [&](std::size_t row) {
                if (row < nodes.size()) return importNode(scene, row, isDriven(nodeId[row]), blockedChanged);
                const std::size_t i = row - nodes.size();
                importCore(scene, i, isDriven(coreId[i]), blockedChanged);
	};
	if (shown == Shown::Touched)
		for (const std::size_t row : touched)
			import(row);
	else
		for (std::size_t row = 0; row < nodes.size() + cores.size(); row++)
			import(row);
	if (blockedChanged) applyBlockedDegreesOfFreedom();
}

void Exposure::importTriangle(const Scene& scene, std::size_t row)
{
	bool blockedChanged = false;
	for (const auto& list : system->topology.vertex)
		importNode(scene, std::size_t(list[row]), false, blockedChanged);
	importCore(scene, row, false, blockedChanged);
	if (blockedChanged) applyBlockedDegreesOfFreedom();
}

std::array<ddem::PlaneTensor, 3> Exposure::stress(std::size_t row) const
{
	// before the first step there is none whose length could be taken
	const Real last = system->motion.lastTimeStep, next = Omega::instance().getScene()->dt;
	return system->stress(row, last > 0 ? last : next > 0 && std::isfinite(next) ? next : 1e-8);
}

std::ptrdiff_t Exposure::rowOfNode(Body::id_t id) const
{
	const auto found = std::lower_bound(nodeId.begin(), nodeId.end(), id); // read in the order of ids
	return found != nodeId.end() && *found == id ? found - nodeId.begin() : -1;
}

Real Exposure::fractureEnergy(std::size_t row) const
{
	const ddem::LawGroup& group = system->groupOf(row);
	const Real            own   = group.property("fractureEnergy", row - group.begin);
	return own > 0 ? own : std::max(Real(0), triangleShape(*cores[row]).fractureEnergy);
}

void Exposure::importPrescribed()
{
	const auto take = [](const Body& b, ddem::Points& points, std::size_t i) {
		for (std::size_t c = 0; c < 2; c++)
			if (points.inverseMass[2 * i + c] == 0)
				points.velocity[2 * i + c] = b.state->vel[Eigen::Index(c)];
	};
	for (const auto i : constrainedNodes)
		take(*nodes[i], system->motion.node, i);
	for (const auto i : constrainedCores) {
		take(*cores[i], system->motion.core, i);
		if (system->motion.spin.size() && system->motion.spin.inverseInertia[i] == 0)
			system->motion.spin.velocity[i] = cores[i]->state->angVel[2];
	}
}

void Exposure::importForces(ForceContainer& forces, bool wanted)
{
	if (!wanted) {
		system->motion.node.external.clear();
		system->motion.core.external.clear();
		system->motion.spin.external.clear();
		return;
	}
	forces.sync();
	const auto take = [&forces](const std::vector<Body::id_t>& ids, ddem::Points& points) {
		points.external.resize(2 * ids.size());
		for (std::size_t i = 0; i < ids.size(); i++) {
			const Vector3r& f          = forces.getForce(ids[i]);
			points.external[2 * i]     = f[0];
			points.external[2 * i + 1] = f[1];
		}
	};
	take(nodeId, system->motion.node);
	take(coreId, system->motion.core);
	system->motion.spin.external.resize(system->motion.spin.size());
	for (std::size_t i = 0; i < system->motion.spin.size(); i++)
		system->motion.spin.external[i] = forces.getTorque(coreId[i])[2];
}

void Exposure::exposeReactions(ForceContainer& forces) const
{
	forces.sync();
	for (const auto i : constrainedNodes)
		forces.addForceUnsynced(
		        nodes[i]->getId(),
		        Vector3r(system->motion.node.force[2 * i], system->motion.node.force[2 * i + 1], 0));
	for (const auto i : constrainedCores)
		forces.addForceUnsynced(
		        cores[i]->getId(),
		        Vector3r(system->motion.core.force[2 * i], system->motion.core.force[2 * i + 1], 0));
}

} // namespace yade
