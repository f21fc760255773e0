// GPL v2 or later, see LICENSE.
#include <pkg/ddem/DeformableAssembly.hpp>

#include <pkg/ddem/DeformableNode.hpp>
#include <pkg/ddem/kernel/triangles/StableStep.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

namespace yade {

namespace {

	constexpr unsigned planeDofs = State::DOF_X | State::DOF_Y, coreDofs = planeDofs | State::DOF_RZ;

	std::string describe(const Body& b, const Vector3r& place)
	{
		std::ostringstream text;
		text << "body " << b.getId() << " at (" << place[0] << ", " << place[1] << ") m";
		return text.str();
	}

	[[noreturn]] void reject(const Body& b, const std::string& why) { throw std::invalid_argument(describe(b, b.state->refPos) + ": " + why); }

	void requireFinite(const Body& b)
	{
		const State& s = *b.state;
		if (!s.pos.allFinite() || !s.refPos.allFinite() || !s.vel.allFinite() || !s.angVel.allFinite() || !s.ori.coeffs().allFinite())
			reject(b, "position, velocity or orientation is not finite; set State.pos, State.refPos, State.vel to numbers [m, m/s]");
	}

	Real angleOf(const Quaternionr& q) { return 2 * std::atan2(q.z(), q.w()); }

	Quaternionr turnBy(Real angle) { return Quaternionr(std::cos(angle / 2), 0, 0, std::sin(angle / 2)); }

	const DeformableTriangle& triangleShape(const Body& b) { return static_cast<const DeformableTriangle&>(*b.shape); }

	const DeformableElastMat& materialOf(const Body& b)
	{
		const auto* material = dynamic_cast<const DeformableElastMat*>(b.material.get());
		if (!material)
			reject(b, "a DeformableTriangle needs a DeformableElastMat or ConcreteDamageMat, not " + (b.material ? b.material->getClassName() : std::string("no material")));
		material->validate();
		return *material;
	}

	ddem::PlaneTensor initialDamage(const Body& b)
	{
		const Matrix3r& m = triangleShape(b).initialDamage;
		if (!m.allFinite() || m(0, 2) != 0 || m(1, 2) != 0 || m(2, 0) != 0 || m(2, 1) != 0 || m(0, 1) != m(1, 0))
			reject(b, "initialDamage must be a symmetric tensor [-] with zero xz and yz components");
		const Real mean = (m(0, 0) + m(1, 1)) / 2, radius = std::hypot((m(0, 0) - m(1, 1)) / 2, m(0, 1));
		if (mean - radius < -1e-12 * (mean + radius) || m(2, 2) < 0) reject(b, "initialDamage has a negative principal value; damage is zero or positive");
		return { m(0, 0), m(1, 1), m(2, 2), m(0, 1) };
	}

	bool sameGroup(const Body& a, const Body& b) { return a.material == b.material && triangleShape(a).thickness == triangleShape(b).thickness; }

	/// All parameters of a material that the arrays depend on.
	std::vector<double> fingerprint(const DeformableElastMat& material)
	{
		std::vector<double> values { material.young, material.poisson, material.density, material.rotationStiffness };
		if (const auto* concrete = dynamic_cast<const ConcreteDamageMat*>(&material)) {
			const ddem::ConcreteParameters p = concrete->parameters();
			static_assert(sizeof(p) % sizeof(double) == 0, "ConcreteParameters holds doubles only");
			const auto* first = reinterpret_cast<const double*>(&p);
			values.insert(values.end(), first, first + sizeof(p) / sizeof(double));
			values.push_back(concrete->effects());
		}
		return values;
	}

	/// What a triangle's shape says beside its nodes.
	std::array<Real, 3> valuesOf(const DeformableTriangle& shape) { return { shape.thickness, shape.fractureEnergy, shape.bandFactor }; }

	/// Starts a point from what is known of it, else from State; returns its blocked degrees of freedom.
	unsigned startPoint(const Body& b, const CarriedState::Point* known, ddem::Points& to, std::size_t i)
	{
		for (std::size_t c = 0; c < 2; c++) {
			to.position[2 * i + c] = known ? known->position[c] : b.state->pos[Eigen::Index(c)];
			to.velocity[2 * i + c] = known ? known->velocity[c] : b.state->vel[Eigen::Index(c)];
			to.force[2 * i + c]    = known ? known->force[c] : 0;
		}
		return known ? known->blocked : b.state->blockedDOFs;
	}

} // namespace

DeformableAssembly DeformableAssembly::fromScene(Scene& scene, ddem::RotationTreatment rotation, Real vertexShare, const CarriedState& carried)
{
	DeformableAssembly made;
	made.sceneBodies = scene.bodies->size();
	made.vertexShare = vertexShare;
	std::vector<std::int32_t> nodeRow(scene.bodies->size(), -1);
	for (const auto& b : *scene.bodies) {
		if (!b || !b->shape) continue;
		if (dynamic_cast<const DeformableNode*>(b->shape.get())) {
			nodeRow[std::size_t(b->getId())] = std::int32_t(made.nodes.size());
			made.nodes.push_back(b);
		} else if (dynamic_cast<const DeformableTriangle*>(b->shape.get()))
			made.cores.push_back(b);
	}
	if (made.cores.empty()) throw std::invalid_argument("DeformableEngine: the scene has no DeformableTriangle; append a mesh first (ddem.append), or remove the engine");
	for (const auto& b : made.nodes)
		requireFinite(*b);

	made.system                  = shared_ptr<ddem::TriangleSystem>(new ddem::TriangleSystem);
	ddem::TriangleSystem& s      = *made.system;
	const std::size_t     nCores = made.cores.size();
	s.rotation                   = rotation;
	s.node.resize(made.nodes.size());
	s.core.resize(nCores);
	if (rotation == ddem::RotationTreatment::Cosserat) s.spin.resize(nCores);
	std::map<const Material*, std::size_t> concreteOf;
	std::set<std::array<std::int32_t, 3>>  triples;
	for (std::size_t i = 0; i < nCores; i++) {
		const Body&               b        = *made.cores[i];
		const DeformableTriangle& shape    = triangleShape(b);
		const DeformableElastMat& material = materialOf(b);
		requireFinite(b);
		std::array<std::int32_t, 3>               rows;
		std::array<ddem::PlaneVector<double>, 3> place;
		for (int e = 0; e < 3; e++) {
			const int id = shape.nodes[e];
			if (id < 0 || std::size_t(id) >= nodeRow.size() || nodeRow[std::size_t(id)] < 0)
				reject(b, "its node body " + std::to_string(id) + " is missing or has no DeformableNode shape; DeformableTriangle.nodes needs three ids of node bodies");
			rows[std::size_t(e)]  = nodeRow[std::size_t(id)];
			const Vector3r& p     = made.nodes[std::size_t(rows[std::size_t(e)])]->state->refPos;
			place[std::size_t(e)] = { p[0], p[1] };
		}
		try {
			const auto             reference = ddem::makeReference(place);
			const ddem::LumpedMass mass      = ddem::lumpMass(reference, material.density, shape.thickness, vertexShare, rotation);
			s.addTriangle(rows, reference);
			for (const auto row : rows)
				s.node.mass[std::size_t(row)] += mass.vertex;
			s.core.mass[i] = mass.core;
			if (rotation == ddem::RotationTreatment::Cosserat) s.spin.inertia[i] = mass.inertia;
			const ddem::TriangleStiffness stiffness { material.bulk(), material.shear(), material.rotationStiffness };
			made.restFrequency.push_back(ddem::highestFrequency(reference, stiffness, shape.thickness, mass, rotation));
		} catch (const std::invalid_argument& error) {
			reject(b, error.what());
		}
		std::array<std::int32_t, 3> key = rows;
		std::sort(key.begin(), key.end());
		if (!triples.insert(key).second) reject(b, "another DeformableTriangle has the same three nodes; remove one of them");

		const auto remembered = std::find_if(made.materials.begin(), made.materials.end(), [&](const Fingerprint& other) { return other.first == b.material; });
		made.shapeValues.push_back(valuesOf(shape));
		made.coreMaterial.push_back(std::size_t(remembered - made.materials.begin()));
		if (remembered == made.materials.end()) made.materials.emplace_back(b.material, fingerprint(material));
		const auto* concrete = dynamic_cast<const ConcreteDamageMat*>(&material);
		const bool  plain    = !concrete || concrete->effects() == 0;
		if (i == 0 || !sameGroup(*made.cores[i - 1], b)) {
			ddem::TriangleGroup group;
			group.begin           = i;
			group.mu              = material.shear();
			group.lambda          = material.bulk() - 2. / 3 * material.shear();
			group.rotationModulus = material.shear() * material.rotationStiffness;
			group.thickness       = shape.thickness;
			if (!plain) {
				group.law        = ddem::TriangleGroup::Law::Concrete;
				group.firstState = s.concreteState.size();
				const auto found = concreteOf.emplace(&material, s.concrete.size());
				if (found.second) s.concrete.push_back({ ddem::PreparedConcrete(concrete->parameters()), concrete->effects() });
				group.concrete = found.first->second;
			}
			s.group.push_back(group);
		}
		s.group.back().end   = i + 1;
		const Real own       = shape.fractureEnergy;
		if (!std::isfinite(own) || own == 0) reject(b, "fractureEnergy = " + std::to_string(own) + " J/m³ must be positive (or negative for the material's)");
		s.fractureEnergy.push_back(own > 0 ? own : (concrete ? concrete->fractureEnergy : 0));
		if (!(std::isfinite(shape.bandFactor) && shape.bandFactor > 0)) reject(b, "bandFactor = " + std::to_string(shape.bandFactor) + " must be positive (1: no crack band)");
		s.bandEnergy.push_back(s.fractureEnergy.back() * shape.bandFactor);
		if (!plain)
			for (int k = 0; k < 3; k++) {
				ddem::ConcreteState state {};
				state.damage = initialDamage(b);
				s.concreteState.push_back(state);
			}
	}
	if (s.bandEnergy == s.fractureEnergy) std::vector<double>().swap(s.bandEnergy); // no crack band
	for (std::size_t i = 0; i < made.nodes.size(); i++)
		if (s.node.mass[i] == 0) reject(*made.nodes[i], "this DeformableNode belongs to no DeformableTriangle, so it has no mass; erase it");

	for (const auto& b : made.nodes)
		made.nodeId.push_back(b->getId());
	for (const auto& b : made.cores)
		made.coreId.push_back(b->getId());
	made.nodeBlocked.resize(made.nodes.size());
	made.coreBlocked.resize(nCores);
	for (std::size_t i = 0; i < made.nodes.size(); i++) {
		const auto known            = carried.nodes.find(made.nodes[i]->getId());
		made.nodeBlocked[i] = startPoint(*made.nodes[i], known == carried.nodes.end() ? nullptr : &known->second, s.node, i);
	}
	for (std::size_t i = 0; i < nCores; i++) {
		const Body& b               = *made.cores[i];
		const auto  found           = carried.cores.find(b.getId());
		const auto* known           = found == carried.cores.end() ? nullptr : &found->second;
		made.coreBlocked[i] = startPoint(b, known, s.core, i);
		if (s.spin.size()) {
			const bool spun    = known && known->spins;
			s.spin.angle[i]    = spun ? known->angle : angleOf(b.state->ori);
			s.spin.velocity[i] = spun ? known->spin : b.state->angVel[2];
			s.spin.moment[i]   = spun ? known->moment : 0;
		}
		const ddem::TriangleGroup& group = s.groupOf(i);
		if (known && !known->concrete.empty() && group.law == ddem::TriangleGroup::Law::Concrete)
			std::copy(known->concrete.begin(), known->concrete.end(), s.concreteState.begin() + std::ptrdiff_t(s.stateIndex(group, i)));
	}
	made.applyBlockedDegreesOfFreedom();
	s.build();

	ddem::TriangleSystem::Book book = s.book();
	book.gravityWork                = carried.pendingWork[0];
	book.externalWork               = carried.pendingWork[1];
	book.dampingLoss                = carried.pendingWork[2];
	const auto last                 = [](std::vector<double>& to, std::size_t i, const CarriedState::Point& from) { std::copy(from.lastVelocity.begin(), from.lastVelocity.end(), &to[2 * i]); };
	for (std::size_t i = 0; i < made.nodes.size(); i++)
		if (const auto known = carried.nodes.find(made.nodes[i]->getId()); known != carried.nodes.end()) last(book.nodeVelocity, i, known->second);
	for (std::size_t i = 0; i < nCores; i++)
		if (const auto known = carried.cores.find(made.cores[i]->getId()); known != carried.cores.end()) {
			last(book.coreVelocity, i, known->second);
			if (s.spin.size() && known->second.spins) book.spinVelocity[i] = known->second.lastSpin;
		}
	s.setBook(book);
	s.lastTimeStep = carried.lastTimeStep;
	return made;
}

CarriedState DeformableAssembly::carry() const
{
	CarriedState carried;
	if (!system) return carried;
	const ddem::TriangleSystem&      s     = *system;
	const ddem::TriangleSystem::Book book  = s.book();
	carried.lastTimeStep                   = s.lastTimeStep;
	carried.pendingWork                    = { book.gravityWork, book.externalWork, book.dampingLoss };
	const auto point                       = [](CarriedState::Point& to, const ddem::Points& from, const std::vector<double>& last, unsigned blocked, std::size_t i) {
                to.blocked = blocked;
                for (std::size_t c = 0; c < 2; c++) {
                        to.position[c]     = from.position[2 * i + c];
                        to.velocity[c]     = from.velocity[2 * i + c];
                        to.force[c]        = from.force[2 * i + c];
                        to.lastVelocity[c] = last[2 * i + c];
                }
	};
	for (std::size_t i = 0; i < nodes.size(); i++)
		point(carried.nodes[nodeId[i]], s.node, book.nodeVelocity, nodeBlocked[i], i);
	for (std::size_t i = 0; i < cores.size(); i++) {
		CarriedState::Core& core = carried.cores[coreId[i]];
		point(core, s.core, book.coreVelocity, coreBlocked[i], i);
		core.spins = s.spin.size() > 0;
		if (core.spins) {
			core.angle    = s.spin.angle[i];
			core.spin     = s.spin.velocity[i];
			core.moment   = s.spin.moment[i];
			core.lastSpin = book.spinVelocity[i];
		}
		if (const ddem::ConcreteState* state = s.concreteStates(i)) core.concrete.assign(state, state + 3);
	}
	return carried;
}

bool DeformableAssembly::materialsChanged() const
{
	for (const auto& known : materials)
		if (fingerprint(static_cast<const DeformableElastMat&>(*known.first)) != known.second) return true;
	for (std::size_t i = 0; i < cores.size(); i++)
		if (cores[i]->material != materials[coreMaterial[i]].first || valuesOf(triangleShape(*cores[i])) != shapeValues[i]) return true;
	return false;
}

bool DeformableAssembly::upToDate(const Scene& scene)
{
	if (!system) return false;
	if (scene.bodies->size() == sceneBodies) return true;
	std::size_t triangles = 0, points = 0; // bodies of other kinds may have come
	for (const auto& b : *scene.bodies) {
		if (!b || !b->shape) continue;
		triangles += dynamic_cast<const DeformableTriangle*>(b->shape.get()) != nullptr;
		points += dynamic_cast<const DeformableNode*>(b->shape.get()) != nullptr;
	}
	if (triangles != cores.size() || points != nodes.size()) return false;
	sceneBodies = scene.bodies->size();
	return true;
}

void DeformableAssembly::adopt(int groupMask) const
{
	for (std::size_t i = 0; i < nodes.size(); i++) {
		nodes[i]->groupMask   = groupMask;
		nodes[i]->state->mass = system->node.mass[i];
	}
	for (std::size_t i = 0; i < cores.size(); i++) {
		cores[i]->groupMask      = groupMask;
		cores[i]->state->mass    = system->core.mass[i];
		cores[i]->state->inertia = Vector3r(0, 0, system->spin.size() ? system->spin.inertia[i] : 0);
		auto& shape              = static_cast<DeformableTriangle&>(*cores[i]->shape);
		shape.system             = system;
		shape.slot               = i;
	}
}

void DeformableAssembly::applyBlockedDegreesOfFreedom()
{
	const auto inverse = [](double mass, bool blocked) { return blocked ? 0 : 1 / mass; };
	const auto apply   = [&](ddem::Points& points, const std::vector<unsigned>& blocked, std::vector<std::size_t>& constrained, unsigned relevant) {
                constrained.clear();
                for (std::size_t i = 0; i < blocked.size(); i++) {
                        points.inverseMass[2 * i]     = inverse(points.mass[i], blocked[i] & State::DOF_X);
                        points.inverseMass[2 * i + 1] = inverse(points.mass[i], blocked[i] & State::DOF_Y);
                        if (blocked[i] & relevant) constrained.push_back(i);
                }
	};
	apply(system->node, nodeBlocked, constrainedNodes, planeDofs);
	apply(system->core, coreBlocked, constrainedCores, coreDofs);
	for (std::size_t i = 0; i < system->spin.size(); i++)
		system->spin.inverseInertia[i] = inverse(system->spin.inertia[i], coreBlocked[i] & State::DOF_RZ);
	system->collectConstraints();
}

namespace {

	void expose(const Body& b, const ddem::Points& points, std::size_t i)
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
		if (s.spin.size()) b.state->angVel[2] = s.spin.velocity[i];
	}

	/// Bodies that live kinematic engines drive. Those engines wipe the velocity of their bodies in every step, in free directions, too, before they set it.
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

void DeformableAssembly::exposeAll()
{
	const auto nNodes = std::ptrdiff_t(nodes.size()), nCores = std::ptrdiff_t(cores.size());
#pragma omp parallel for schedule(static)
	for (std::ptrdiff_t i = 0; i < nNodes; i++)
		expose(*nodes[std::size_t(i)], system->node, std::size_t(i));
#pragma omp parallel for schedule(static)
	for (std::ptrdiff_t i = 0; i < nCores; i++) {
		expose(*cores[std::size_t(i)], system->core, std::size_t(i));
		exposeRotation(*cores[std::size_t(i)], *system, std::size_t(i));
	}
}

void DeformableAssembly::exposeConstrained() const
{
	for (const auto i : constrainedNodes)
		expose(*nodes[i], system->node, i);
	for (const auto i : constrainedCores) {
		expose(*cores[i], system->core, i);
		exposeRotation(*cores[i], *system, i);
	}
}

void DeformableAssembly::importChanges(const Scene& scene)
{
	bool       blockedChanged = false;
	const auto driven         = drivenBodies(scene);
	const auto take           = [&](const shared_ptr<Body>& b, Body::id_t id, ddem::Points& points, unsigned& blocked, std::size_t i) {
                if (b->getId() != id || !scene.bodies->exists(id)) {
                        std::ostringstream text;
                        text << "body " << id << " at (" << b->state->refPos[0] << ", " << b->state->refPos[1]
                             << ") m was erased: deformable nodes and triangles cannot be erased during a simulation; hold them, or build the scene without them";
                        throw std::invalid_argument(text.str());
                }
                importPoint(*b, points, i, driven[std::size_t(id)]);
                blockedChanged |= b->state->blockedDOFs != blocked;
                blocked = b->state->blockedDOFs;
	};
	for (std::size_t i = 0; i < nodes.size(); i++)
		take(nodes[i], nodeId[i], system->node, nodeBlocked[i], i);
	for (std::size_t i = 0; i < cores.size(); i++) {
		take(cores[i], coreId[i], system->core, coreBlocked[i], i);
		if (!system->spin.size()) continue;
		const State& state = *cores[i]->state;
		if (state.ori.coeffs() != turnBy(system->spin.angle[i]).coeffs()) {
			requireFinite(*cores[i]);
			system->spin.angle[i] = angleOf(state.ori);
		}
		system->spin.velocity[i] = state.angVel[2];
		if (!std::isfinite(system->spin.velocity[i])) requireFinite(*cores[i]);
	}
	if (blockedChanged) applyBlockedDegreesOfFreedom();
}

void DeformableAssembly::importPrescribed()
{
	const auto take = [](const Body& b, ddem::Points& points, std::size_t i) {
		for (std::size_t c = 0; c < 2; c++)
			if (points.inverseMass[2 * i + c] == 0) points.velocity[2 * i + c] = b.state->vel[Eigen::Index(c)];
	};
	for (const auto i : constrainedNodes)
		take(*nodes[i], system->node, i);
	for (const auto i : constrainedCores) {
		take(*cores[i], system->core, i);
		if (system->spin.size() && system->spin.inverseInertia[i] == 0) system->spin.velocity[i] = cores[i]->state->angVel[2];
	}
}

void DeformableAssembly::importForces(ForceContainer& forces, bool wanted)
{
	if (!wanted) {
		system->node.external.clear();
		system->core.external.clear();
		system->spin.external.clear();
		return;
	}
	forces.sync();
	const auto take = [&forces](const std::vector<shared_ptr<Body>>& bodies, ddem::Points& points) {
		points.external.resize(2 * bodies.size());
		for (std::size_t i = 0; i < bodies.size(); i++) {
			const Vector3r& f          = forces.getForce(bodies[i]->getId());
			points.external[2 * i]     = f[0];
			points.external[2 * i + 1] = f[1];
		}
	};
	take(nodes, system->node);
	take(cores, system->core);
	system->spin.external.resize(system->spin.size());
	for (std::size_t i = 0; i < system->spin.size(); i++)
		system->spin.external[i] = forces.getTorque(cores[i]->getId())[2];
}

void DeformableAssembly::exposeReactions(ForceContainer& forces) const
{
	forces.sync();
	for (const auto i : constrainedNodes)
		forces.addForceUnsynced(nodes[i]->getId(), Vector3r(system->node.force[2 * i], system->node.force[2 * i + 1], 0));
	for (const auto i : constrainedCores)
		forces.addForceUnsynced(cores[i]->getId(), Vector3r(system->core.force[2 * i], system->core.force[2 * i + 1], 0));
}

} // namespace yade
