// GPL v2 or later, see LICENSE.
#include <pkg/ddem/SceneReader.hpp>

#include <pkg/ddem/DeformableNode.hpp>
#include <pkg/ddem/kernel/triangles/StableStep.hpp>

#include <algorithm>
#include <set>
#include <sstream>

namespace yade {

namespace {

	[[noreturn]] void reject(const Body& b, const std::string& why)
	{
		throw std::invalid_argument(placeOf(b) + ": " + why);
	}

	void requireNumbers(const Body& b)
	{
		const State& s = *b.state;
		if (!s.pos.allFinite() || !s.refPos.allFinite() || !s.vel.allFinite() || !s.angVel.allFinite()
		    || !s.ori.coeffs().allFinite())
			reject(b,
			       "position, velocity or orientation is not finite; set State.pos, State.refPos, "
			       "State.vel to numbers [m, m/s]");
	}

	const DeformableTriangle& triangleOf(const Body& b) { return static_cast<const DeformableTriangle&>(*b.shape); }

	const DeformableElastMat& materialOf(const Body& b)
	{
		const auto* material = dynamic_cast<const DeformableElastMat*>(b.material.get());
		if (!material)
			reject(b,
			       "a DeformableTriangle needs a DeformableElastMat or ConcreteDamageMat (or another class "
			       "that derives from the first), not "
			               + (b.material ? b.material->getClassName() : std::string("no material")));
		material->validate();
		return *material;
	}

	ddem::PlaneTensor initialDamage(const Body& b)
	{
		const Matrix3r& m = triangleOf(b).initialDamage;
		if (!m.allFinite() || m(0, 2) != 0 || m(1, 2) != 0 || m(2, 0) != 0 || m(2, 1) != 0
		    || m(0, 1) != m(1, 0))
			reject(b, "initialDamage must be a symmetric tensor [-] with zero xz and yz components");
		const Real mean = (m(0, 0) + m(1, 1)) / 2, radius = std::hypot((m(0, 0) - m(1, 1)) / 2, m(0, 1));
		if (mean - radius < -1e-12 * (mean + radius) || m(2, 2) < 0)
			reject(b, "initialDamage has a negative principal value; damage is zero or positive");
		return { m(0, 0), m(1, 1), m(2, 2), m(0, 1) };
	}

	/** Stress of the sub-elements that is in equilibrium with the weight of nodes and core, where the given one is
	 * linear in space and in equilibrium with a weight of the volume.
	 *
	 * Sub-elements k of stress σ_k push the core with h Σ σ_k n_k L_k/2. With stress as it is at centre + s (middle
	 * of edge − centre) this is s/2 of the volume's weight, and the core has 1 − α of it: s = 2 (1 − α). Nodes are
	 * then in equilibrium as well, since forces do the right work for every linear displacement. The
	 * given stresses are those of the centroids, s = 2/3. */
	std::array<ddem::PlaneTensor, 3> initialStress(const Body& b, Real vertexShare)
	{
		const auto&                      given = triangleOf(b).initialStress;
		std::array<ddem::PlaneTensor, 3> stress {};
		if (given.empty()) return stress;
		if (given.size() != 1 && given.size() != 3)
			reject(b,
			       "initialStress has " + std::to_string(given.size())
			               + " tensors; give one [Pa] for the triangle, one for each of the three "
			                 "sub-elements, or none");
		for (std::size_t k = 0; k < 3; k++) {
			const Matrix3r& m = given[given.size() == 1 ? 0 : k];
			if (!m.allFinite() || m(0, 2) != 0 || m(1, 2) != 0 || m(2, 0) != 0 || m(2, 1) != 0
			    || m(0, 1) != m(1, 0))
				reject(b,
				       "initialStress must be finite symmetric tensors [Pa] with zero xz and yz "
				       "components");
			stress[k] = { m(0, 0), m(1, 1), m(2, 2), m(0, 1) };
		}
		if (given.size() == 1) return stress;
		const ddem::PlaneTensor mean = (1. / 3) * (stress[0] + stress[1] + stress[2]);
		for (ddem::PlaneTensor& s : stress)
			s = mean + (3 * (1 - vertexShare)) * (s - mean);
		return stress;
	}

	ddem::TriangleProperties propertiesOf(const Body& b, double area, Real vertexShare)
	{
		const DeformableTriangle& shape = triangleOf(b);
		const Real                own   = shape.fractureEnergy;
		if (!std::isfinite(own) || own == 0)
			reject(b,
			       "fractureEnergy = " + std::to_string(own)
			               + " must be positive, in the unit of its material's (J/m³ for concrete), or "
			                 "negative for the material's");
		if (!(std::isfinite(shape.bandFactor) && shape.bandFactor > 0))
			reject(b,
			       "bandFactor = " + std::to_string(shape.bandFactor)
			               + " must be positive (1: no crack band)");
		ddem::TriangleProperties properties { area, own, shape.bandFactor, initialDamage(b) };
		properties.initialStress = initialStress(b, vertexShare);
		return properties;
	}

	/// Starts a point from what is known of it, else from State; returns its blocked degrees of freedom.
	unsigned startPoint(const Body& b, const StateStore::Point* known, ddem::Points& to, std::size_t i)
	{
		for (std::size_t c = 0; c < 2; c++) {
			to.position[2 * i + c] = known ? known->position[c] : b.state->pos[Eigen::Index(c)];
			to.velocity[2 * i + c] = known ? known->velocity[c] : b.state->vel[Eigen::Index(c)];
			to.force[2 * i + c]    = known ? known->force[c] : 0;
		}
		return known ? known->blocked : b.state->blockedDOFs;
	}

	template <class Map> auto* knownIn(const Map& map, Body::id_t id)
	{
		const auto found = map.find(id);
		return found == map.end() ? nullptr : &found->second;
	}

	/// Sorts triangles so that those of a kind (material, thickness) stand together;
	/// kinds in the order in which they come.
	void sortByKind(std::vector<shared_ptr<Body>>& triangles)
	{
		using Kind = std::pair<const Material*, Real>;
		std::map<Kind, std::size_t> order;
		std::vector<std::size_t>    rank;
		const auto kindOf = [](const Body& b) { return Kind { b.material.get(), triangleOf(b).thickness }; };
		for (const auto& b : triangles)
			order.emplace(kindOf(*b), order.size());
		std::stable_sort(triangles.begin(), triangles.end(), [&](const auto& a, const auto& b) {
			return order[kindOf(*a)] < order[kindOf(*b)];
		});
	}

} // namespace

std::vector<shared_ptr<Body>> trianglesOf(const Scene& scene, const SampleSettings& settings)
{
	const std::set<Body::id_t> mine(settings.ids.begin(), settings.ids.end()),
	        others(settings.otherIds.begin(), settings.otherIds.end());
	std::vector<shared_ptr<Body>> found;
	for (const auto& b : *scene.bodies) {
		if (!b || !dynamic_cast<const DeformableTriangle*>(b->shape.get())) continue;
		if (!mine.empty()) {
			if (mine.count(b->getId())) found.push_back(b);
			continue;
		}
		if (others.count(b->getId())) continue;
		const bool ours = b->groupMask & settings.groupMask;
		if (!ours && (b->groupMask & settings.otherBits)) continue;
		if (!ours && settings.shared)
			reject(*b,
			       "O.engines has several DeformableEngine and nothing says which moves it: give the "
			       "engines' ids (DeformableEngine.ids = block.triangle_ids), or the bodies the bit of one "
			       "engine's groupMask");
		found.push_back(b);
	}
	for (const Body::id_t id : mine)
		if (!scene.bodies->exists(id)
		    || !dynamic_cast<const DeformableTriangle*>((*scene.bodies)[id]->shape.get()))
			throw std::invalid_argument(
			        "DeformableEngine.ids: body " + std::to_string(id)
			        + " is not a DeformableTriangle of the scene; give ids of triangles "
			          "(block.triangle_ids)");
	if (found.empty())
		throw std::invalid_argument(
		        settings.otherBits
		                ? "DeformableEngine: the other engines in O.engines take all triangles; append a mesh "
		                  "for this one, give its ids, or remove it"
		                : "DeformableEngine: the scene has no DeformableTriangle; append a mesh first "
		                  "(ddem.append), or remove the engine");
	return found;
}

shared_ptr<Exposure> readScene(const Scene& scene, const SampleSettings& settings, const StateStore& known)
{
	const auto made   = shared_ptr<Exposure>(new Exposure);
	made->countBodies(scene);
	made->vertexShare = settings.vertexShare;
	made->cores       = trianglesOf(scene, settings);
	sortByKind(made->cores);

	// nodes: those of these triangles, and, where no other engine has any, all the others,
	// which then belong to no triangle
	std::vector<char> used(scene.bodies->size(), 0);
	for (const auto& b : made->cores)
		for (int e = 0; e < 3; e++) {
			const int id = triangleOf(*b).nodes[e];
			if (id < 0 || std::size_t(id) >= used.size() || !(*scene.bodies)[id]
			    || !dynamic_cast<const DeformableNode*>((*scene.bodies)[id]->shape.get()))
				reject(*b,
				       "its node body " + std::to_string(id)
				               + " is missing or has no DeformableNode shape; DeformableTriangle.nodes "
				                 "needs three ids of node bodies");
			used[std::size_t(id)] = 1;
		}
	const bool alone = settings.ids.empty() && settings.otherBits == 0 && settings.otherIds.empty();
	std::vector<shared_ptr<Body>> unused;
	std::vector<std::int32_t>     nodeRow(scene.bodies->size(), -1);
	for (const auto& b : *scene.bodies) {
		if (!b || !dynamic_cast<const DeformableNode*>(b->shape.get())) continue;
		const auto id = std::size_t(b->getId());
		if (!used[id]) {
			if (alone) unused.push_back(b);
			continue;
		}
		if (b->groupMask & settings.otherBits)
			reject(*b,
			       "this node has triangles of two DeformableEngine; a block of triangles that share nodes "
			       "needs one engine");
		requireNumbers(*b);
		nodeRow[id] = std::int32_t(made->nodes.size());
		made->nodes.push_back(b);
	}

	made->system              = shared_ptr<ddem::TriangleSystem>(new ddem::TriangleSystem);
	ddem::TriangleSystem& s   = *made->system;
	ddem::Motion&         m   = s.motion;
	const std::size_t     n   = made->cores.size();
	const bool            rotates = settings.rotation == ddem::RotationTreatment::Cosserat;
	s.rotation                = settings.rotation;
	m.node.resize(made->nodes.size(), ddem::Topology::nodeCapacity(n));
	m.core.resize(n);
	if (rotates) m.spin.resize(n);
	std::set<std::array<std::int32_t, 3>>               triples;
	std::vector<std::vector<ddem::TriangleProperties>>  properties;
	const Body*                                         last = nullptr;
	for (std::size_t i = 0; i < n; i++) {
		const Body&               b        = *made->cores[i];
		const DeformableTriangle& shape    = triangleOf(b);
		const DeformableElastMat& material = last && last->material == b.material
		        ? static_cast<const DeformableElastMat&>(*b.material)
		        : materialOf(b);
		requireNumbers(b);
		std::array<std::int32_t, 3>              rows;
		std::array<ddem::PlaneVector<double>, 3> place;
		for (int e = 0; e < 3; e++) {
			rows[std::size_t(e)]  = nodeRow[std::size_t(shape.nodes[e])];
			const Vector3r& p     = made->nodes[std::size_t(rows[std::size_t(e)])]->state->refPos;
			place[std::size_t(e)] = { p[0], p[1] };
		}
		double area = 0;
		try {
			const auto             reference = ddem::makeReference(place);
			const ddem::LumpedMass mass = ddem::lumpMass(
			        reference, material.density, shape.thickness, settings.vertexShare, settings.rotation);
			s.topology.addTriangle(rows, reference);
			area = reference.area();
			for (const auto row : rows)
				m.node.mass[std::size_t(row)] += mass.vertex;
			m.core.mass[i] = mass.core;
			if (rotates) m.spin.inertia[i] = mass.inertia;
			const ddem::TriangleStiffness stiffness { material.bulk(), material.shear(),
				                                  material.rotationStiffness };
			made->restFrequency.push_back(
			        ddem::highestFrequency(reference, stiffness, shape.thickness, mass, settings.rotation));
		} catch (const std::invalid_argument& error) {
			reject(b, error.what());
		}
		std::array<std::int32_t, 3> key = rows;
		std::sort(key.begin(), key.end());
		if (!triples.insert(key).second)
			reject(b, "another DeformableTriangle has the same three nodes; remove one of them");

		made->shapeValues.push_back(shape.values());
		const bool ofLast
		        = last && last->material == b.material && triangleOf(*last).thickness == shape.thickness;
		if (!ofLast) {
			const LawOfMaterial law   = material.ownLaw();
			auto                group = law.makeGroup();
			group->begin              = i;
			if (settings.flowInterval > 1 && group->stiffensInRuns())
				reject(b,
				       "DeformableEngine.flowInterval = " + std::to_string(settings.flowInterval)
				               + " with an equation of state: moduli that change only every so many "
				                 "steps shake the sample; set equationOfState = False in the material, "
				                 "or flowInterval = 1");
			group->flowInterval       = unsigned(settings.flowInterval);
			group->flowClock          = known.flowClock;
			group->constants          = { shape.thickness, material.shear() * material.rotationStiffness };
			s.group.emplace_back(std::move(group));
			properties.emplace_back();
			if (!last || last->material != b.material) made->materials.emplace_back(b.material, law.values);
		}
		made->coreMaterial.push_back(made->materials.size() - 1);
		properties.back().push_back(propertiesOf(b, area, settings.vertexShare));
		s.group.back()->end = i + 1;
		last                = &b;
	}
	for (const auto& b : unused)
		reject(*b, "this DeformableNode belongs to no DeformableTriangle, so it has no mass; erase it");
	for (std::size_t g = 0; g < s.group.size(); g++)
		try {
			s.group[g]->start(properties[g]);
		} catch (const ddem::RefusedTriangle& error) {
			reject(*made->cores[s.group[g]->begin + error.triangle], error.what());
		}

	for (const auto& b : made->nodes)
		made->nodeId.push_back(b->getId());
	for (const auto& b : made->cores)
		made->coreId.push_back(b->getId());
	made->nodeBlocked.resize(made->nodes.size());
	made->coreBlocked.resize(n);
	for (std::size_t i = 0; i < made->nodes.size(); i++)
		made->nodeBlocked[i] = startPoint(*made->nodes[i], knownIn(known.nodes, made->nodeId[i]), m.node, i);
	// with the book's own fields, which may be among what is known
	const auto virgin = [](std::size_t) { return std::array<ddem::PlaneTensor, 3> {}; };
	if (settings.energy || known.hasMemories())
		for (auto& group : s.group)
			group->keepBook(true, virgin);
	std::set<std::string> forgotten;
	for (std::size_t i = 0; i < n; i++) {
		const Body& b        = *made->cores[i];
		const auto* core     = knownIn(known.cores, b.getId());
		made->coreBlocked[i] = startPoint(b, core, m.core, i);
		if (rotates) {
			const bool spun    = core && core->spins;
			m.spin.angle[i]    = spun ? core->angle : 2 * std::atan2(b.state->ori.z(), b.state->ori.w());
			m.spin.velocity[i] = spun ? core->spin : b.state->angVel[2];
			m.spin.moment[i]   = spun ? core->moment : 0;
		}
		ddem::LawGroup& group = s.groupOf(i);
		const auto      lost  = known.give(b.getId(), group, i - group.begin);
		forgotten.insert(lost.begin(), lost.end());
	}
	for (auto& group : s.group) {
		group->fillUp();
		group->keepBook(settings.energy, virgin);
	}
	made->forgotten = forgotten;
	made->applyBlockedDegreesOfFreedom();
	s.build();
	for (std::size_t i = 0; i < n; i++) { // where a law, an effect or the energy book begins in the midst of a run
		if (!knownIn(known.cores, made->coreId[i])) continue;
		ddem::LawGroup& group   = s.groupOf(i);
		const auto      missing = known.missing(made->coreId[i], group);
		if (!missing.empty()) group.beginAt(i - group.begin, missing, s.strain(i));
	}
	for (auto& group : s.group)
		group->fillUp();

	ddem::Motion::Book book = m.book();
	book.gravityWork        = known.pendingWork[0];
	book.externalWork       = known.pendingWork[1];
	book.dampingLoss        = known.pendingWork[2];
	book.edgeWork           = known.pendingWork[3];
	book.edgeAbsorption     = known.pendingWork[4];
	const auto lastVelocity = [](std::vector<double>& to, std::size_t i, const StateStore::Point& from) {
		std::copy(from.lastVelocity.begin(), from.lastVelocity.end(), &to[2 * i]);
	};
	for (std::size_t i = 0; i < made->nodes.size(); i++)
		if (const auto* node = knownIn(known.nodes, made->nodeId[i])) lastVelocity(book.nodeVelocity, i, *node);
	for (std::size_t i = 0; i < n; i++)
		if (const auto* core = knownIn(known.cores, made->coreId[i])) {
			lastVelocity(book.coreVelocity, i, *core);
			if (rotates && core->spins) book.spinVelocity[i] = core->lastSpin;
		}
	m.setBook(book);
	m.lastTimeStep = known.lastTimeStep;
	return made;
}

} // namespace yade
