// GPL v2 or later, see LICENSE.
#include <pkg/ddem/EdgeLoading.hpp>

#include <pkg/ddem/DeformableNode.hpp>

namespace yade {

namespace {

	[[noreturn]] void reject(const EdgeEngine& engine, const Vector2i& edge, const std::string& why)
	{
		throw std::invalid_argument(
		        engine.getClassName() + ".edges: between bodies " + std::to_string(edge[0]) + " and "
		        + std::to_string(edge[1]) + " there is no outer edge: " + why
		        + "; give pairs of node ids of the border, as block.edges('right') does");
	}

	void requireNode(const Scene& scene, const EdgeEngine& engine, const Vector2i& edge, Body::id_t id)
	{
		if (!scene.bodies->exists(id) || !dynamic_cast<const DeformableNode*>((*scene.bodies)[id]->shape.get()))
			reject(engine, edge, "body " + std::to_string(id) + " is no DeformableNode of this scene");
	}

	/// The one triangle of an edge, and its corner at which the edge starts.
	OuterEdge outerEdge(
	        const Exposure& sample, const EdgeEngine& engine, const Vector2i& ids, std::size_t a, std::size_t b)
	{
		const ddem::Topology& topology = sample.system->topology;
		const std::size_t     n        = topology.triangles();
		OuterEdge             edge {};
		int                   triangles = 0;
		const auto            corners   = topology.corners(a);
		for (const auto* corner = corners.first; corner != corners.second; corner++) {
			const std::size_t e = *corner / n, i = *corner % n;
			const bool        onwards   = std::size_t(topology.vertex[(e + 1) % 3][i]) == b;
			const bool        backwards = std::size_t(topology.vertex[(e + 2) % 3][i]) == b;
			if (!onwards && !backwards) continue;
			triangles++;
			edge.triangle = i;
			edge.turned   = backwards;
		}
		if (triangles != 1)
			reject(engine, ids,
			       triangles ? "two triangles share it" : "these nodes are not corners of one triangle");
		edge.start = edge.turned ? b : a;
		edge.end   = edge.turned ? a : b;
		return edge;
	}

} // namespace

void EdgeLoading::lookUp(const Scene& scene, Exposure& sample)
{
	ddem::TriangleSystem&    system = *sample.system;
	std::vector<std::size_t> nodes;
	found.assign(known.size(), {});
	for (std::size_t k = 0; k < known.size(); k++) {
		const EdgeEngine& engine = *known[k].first;
		for (std::size_t j = 0; j < engine.edges.size(); j++) {
			const Vector2i& ids = engine.edges[j];
			for (const int id : { ids[0], ids[1] })
				requireNode(scene, engine, ids, id);
			const auto a = sample.rowOfNode(ids[0]), b = sample.rowOfNode(ids[1]);
			if (a < 0 && b < 0) continue; // of another DeformableEngine
			if (a < 0 || b < 0)
				reject(engine, ids, "its nodes belong to two engines");
			OuterEdge edge = outerEdge(sample, engine, ids, std::size_t(a), std::size_t(b));
			edge.given     = j;
			const auto place = [&](std::size_t row) { return sample.nodes[row]->state->refPos; };
			const Vector3r along = place(edge.end) - place(edge.start);
			edge.reference       = { along[0], along[1] };
			edge.length          = std::hypot(along[0], along[1]);
			edge.thickness       = system.groupOf(edge.triangle).constants.thickness;
			const auto& material
			        = static_cast<const DeformableElastMat&>(*sample.cores[edge.triangle]->material);
			const Real normal = material.bulk() + 4. / 3 * material.shear(); // ρ c_p²
			edge.impedance    = { std::sqrt(material.density * normal),
				              std::sqrt(material.density * material.shear()) };
			nodes.insert(nodes.end(), { edge.start, edge.end });
			found[k].edges.push_back(edge);
		}
	}
	system.motion.loads.assign(nodes);
	for (OwnEdges& own : found)
		for (OuterEdge& edge : own.edges) {
			const auto place = [&](std::size_t row) {
				const std::size_t at                        = system.motion.loads.place(row);
				own.place[sample.nodes[row]->getId()] = at;
				return at;
			};
			edge.atStart = place(edge.start);
			edge.atEnd   = place(edge.end);
		}
}

void EdgeLoading::apply(const Scene& scene, Exposure& sample, const std::vector<const EdgeEngine*>& engines)
{
	std::vector<Version> now;
	for (const EdgeEngine* engine : engines)
		if (!engine->dead) now.emplace_back(engine, engine->changes());
	if (now != known) {
		known = now;
		try {
			lookUp(scene, sample);
		} catch (...) {
			known.clear(); // refused again in the next step
			sample.system->motion.loads.assign({});
			throw;
		}
	}
	if (known.empty()) return;
	sample.system->motion.loads.clear();
	for (std::size_t k = 0; k < known.size(); k++)
		known[k].first->act(found[k], scene.time, sample.system->motion);
}

} // namespace yade
