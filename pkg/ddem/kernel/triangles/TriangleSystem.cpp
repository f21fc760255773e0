// GPL v2 or later, see LICENSE.
#include <pkg/ddem/kernel/triangles/TriangleSystem.hpp>

#include <pkg/ddem/kernel/triangles/LoadedNode.hpp>
#include <pkg/ddem/kernel/triangles/TileSums.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace yade::ddem {

namespace {

	using MovePoints
	        = void (*)(Points&, std::size_t, std::size_t, const StepSettings&, const StepsAround&, MotionSums&);
	using MoveSpins
	        = void (*)(Spins&, std::size_t, std::size_t, const StepSettings&, const StepsAround&, MotionSums&);

	using MoveLoaded = void (*)(Points&, NodeLoad&, const StepSettings&, const StepsAround&, MotionSums&);

	struct Movers {
		MovePoints points;
		MoveSpins  spins;
		MoveLoaded loaded;
	};

	template <unsigned... effects> Movers selectMovers(unsigned wanted, std::integer_sequence<unsigned, effects...>)
	{
		static constexpr Movers table[]
		        = { { movePoints<effects>, moveSpins<effects>, moveLoaded<effects> }... };
		return table[wanted];
	}

} // namespace

void TriangleSystem::build()
{
	const std::size_t n = triangles();
	if (motion.core.size() != n || (rotation == RotationTreatment::Cosserat && motion.spin.size() != n))
		throw std::logic_error("TriangleSystem: one core per triangle");
	motion.requireComplete();
	topology.connect(motion.node.size());
	std::size_t covered = 0;
	for (const auto& g : group) {
		if (g->begin != covered || g->end < covered)
			throw std::logic_error("TriangleSystem: groups must cover the triangles in order");
		covered = g->end;
	}
	if (covered != n) throw std::logic_error("TriangleSystem: groups must cover all triangles");
	tile.clear();
	tileStart.clear();
	for (std::size_t g = 0; g < group.size(); g++) {
		LawGroup& own = *group[g];
		if (own.state().triangles() != own.triangles())
			throw std::logic_error(
			        "TriangleSystem: a group's states are not those of its triangles; start it first");
		for (std::size_t t = 0; t < own.tiles(); t++) {
			tile.push_back({ g, t });
			tileStart.push_back(own.begin + t * tileSize);
		}
		own.prepare(rotation);
	}
	cornerForce.assign(6 * n, 0.);
	motion.restartBook();
}

ElementArrays TriangleSystem::arrays()
{
	const std::size_t n = triangles();
	ElementArrays     a {};
	for (std::size_t e = 0; e < 3; e++) {
		a.vertex[e]      = topology.vertex[e].data();
		a.cornerForce[e] = cornerForce.data() + 2 * e * n;
	}
	for (std::size_t c = 0; c < 4; c++)
		a.arm[c] = topology.arm[c].data();
	a.nodePosition = motion.node.position.data();
	a.corePosition = motion.core.position.data();
	a.coreAngle    = motion.spin.angle.data();
	a.coreForce    = motion.core.force.data();
	a.coreMoment   = motion.spin.moment.data();
	return a;
}

void TriangleSystem::keepBook(bool energy)
{
	for (auto& g : group)
		g->keepBook(energy, [&](std::size_t i) { return strain(g->begin + i); });
}

StepEnergy TriangleSystem::step(const StepSettings& settings)
{
	keepBook(settings.energy);
	for (auto& g : group)
		g->beginStep(settings.dt);
	Points&           node  = motion.node;
	const std::size_t tiles = tile.size(), nodeTiles = motion.nodeTiles();
	const StepsAround steps { motion.lastTimeStep > 0 ? motion.lastTimeStep : settings.dt, settings.dt };
	const Movers      move = selectMovers(
                MotionEffects::select(settings), std::make_integer_sequence<unsigned, MotionEffects::Combinations>());
	const ElementArrays     elements = arrays();
	const bool              rotates  = rotation == RotationTreatment::Cosserat;
	std::vector<MotionSums> sums(tiles + nodeTiles);
#pragma omp parallel
	{
#pragma omp for schedule(dynamic, 4)
		for (std::ptrdiff_t j = 0; j < std::ptrdiff_t(tiles); j++) {
			const Tile&       piece = tile[std::size_t(j)];
			LawGroup&         g     = *group[piece.group];
			MotionSums&       sum   = sums[std::size_t(j)];
			const std::size_t begin = tileStart[std::size_t(j)], end = std::min(begin + tileSize, g.end);
			g.advance(piece.inGroup, elements, settings.dt, sum.before);
			// a core feels only its own triangle
			move.points(motion.core, begin, end, settings, steps, sum);
			if (rotates) move.spins(motion.spin, begin, end, settings, steps, sum);
		}
#pragma omp for schedule(static)
		for (std::ptrdiff_t j = 0; j < std::ptrdiff_t(nodeTiles); j++) {
			const std::size_t begin = std::size_t(j) * Motion::nodesPerTile,
			                  end = std::min(begin + Motion::nodesPerTile, node.size());
			for (std::size_t v = begin; v < end; v++) {
				double     x = 0, y = 0;
				const auto corners = topology.corners(v);
				for (const CornerIndex* c = corners.first; c != corners.second; c++) {
					const double* force = cornerForce.data() + 2 * std::size_t(*c);
					x += force[0];
					y += force[1];
				}
				node.force[2 * v]     = x;
				node.force[2 * v + 1] = y;
			}
			MotionSums& sum  = sums[tiles + std::size_t(j)];
			std::size_t from = begin; // nodes between loaded ones move together
			for (std::size_t l = motion.loads.place(begin);
			     l < motion.loads.size() && motion.loads[l].node < end; l++) {
				NodeLoad& load = motion.loads[l];
				if (load.node > from) move.points(node, from, load.node, settings, steps, sum);
				move.loaded(node, load, settings, steps, sum);
				from = load.node + 1;
			}
			if (from < end) move.points(node, from, end, settings, steps, sum);
		}
	}

	for (RigidPlaten& platen : platens)
		platen.move(motion, settings, steps);
	for (auto& g : group)
		g->endStep();
	motion.lastTimeStep = settings.dt;
	double speedSquared = 0;
	for (const auto& sum : sums)
		speedSquared += sum.speedSquared;
	if (!std::isfinite(speedSquared))
		throw std::domain_error("a velocity of the deformable triangles is not finite");
	if (settings.energy) return motion.closeBook(sums, tileStart, steps);
	motion.dropBook();
	return {};
}

RelativeDisplacements<double> TriangleSystem::fromCentre(std::size_t i) const
{
	RelativeDisplacements<double> result;
	for (std::size_t e = 0; e < 3; e++) {
		const std::size_t v    = std::size_t(topology.vertex[e][i]);
		const auto &      node = motion.node.position, &core = motion.core.position;
		result[e] = { node[2 * v] - core[2 * i], node[2 * v + 1] - core[2 * i + 1] };
	}
	return result;
}

PlaneRotation<double> TriangleSystem::frame(std::size_t i) const
{
	switch (rotation) {
		case RotationTreatment::None: return FrameNone::rotation(topology.reference(i), fromCentre(i), 0.);
		case RotationTreatment::Corotational:
			return FrameCorotational::rotation(topology.reference(i), fromCentre(i), 0.);
		default: return FrameCosserat::rotation(topology.reference(i), fromCentre(i), motion.spin.angle[i]);
	}
}

double TriangleSystem::frameAngle(std::size_t i) const
{
	if (rotation == RotationTreatment::Cosserat) return motion.spin.angle[i];
	const PlaneRotation<double> r = frame(i);
	return std::atan2(r.s, r.c);
}

std::size_t TriangleSystem::groupIndex(std::size_t i) const
{
	const auto after = std::upper_bound(
	        group.begin(), group.end(), i, [](std::size_t value, const GroupPointer& g) { return value < g->end; });
	return std::size_t(after - group.begin());
}

std::array<double, 3> TriangleSystem::damage(std::size_t i) const
{
	const LawGroup& g = groupOf(i);
	return g.damage(i - g.begin);
}

TriangleSystem::Inverted TriangleSystem::mostInverted() const
{
	Inverted    most;
	const auto& x = motion.node.position;
	for (std::size_t i = 0; i < triangles(); i++) {
		const auto at = [&](std::size_t e) {
			const auto v = std::size_t(topology.vertex[e][i]);
			return PlaneVector<double> { x[2 * v], x[2 * v + 1] };
		};
		const double ratio = 0.5 * cross(at(1) - at(0), at(2) - at(0)) / topology.reference(i).area();
		if (ratio < most.ratio) most = { i, ratio };
	}
	return most;
}

RelativeDisplacements<double> TriangleSystem::relativeDisplacements(std::size_t i) const
{
	const TriangleReference<double> ref  = topology.reference(i);
	const PlaneRotation<double>          turn = frame(i);
	RelativeDisplacements<double>   du   = fromCentre(i);
	for (std::size_t e = 0; e < 3; e++)
		du[e] = relativeDisplacement(turn, du[e], ref.arm[e]);
	return du;
}

std::array<PlaneTensor, 3> TriangleSystem::strain(std::size_t i) const
{
	std::array<PlaneTensor, 3> result {};
	const auto                 strains = subElementStrains(topology.reference(i), relativeDisplacements(i));
	for (std::size_t k = 0; k < 3; k++)
		result[k] = { strains[k].xx, strains[k].yy, 0, strains[k].xy };
	return result;
}

std::array<PlaneTensor, 3> TriangleSystem::stress(std::size_t i, double dt) const
{
	const LawGroup& g = groupOf(i);
	return g.stress(i - g.begin, strain(i), dt);
}

} // namespace yade::ddem
