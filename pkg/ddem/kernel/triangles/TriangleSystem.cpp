// GPL v2 or later, see LICENSE.
#include <pkg/ddem/kernel/triangles/TriangleSystem.hpp>

#include <pkg/ddem/kernel/triangles/ElementLoops.hpp>
#include <pkg/ddem/kernel/triangles/Leapfrog.hpp>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace yade::ddem {

namespace {

	// Sizes of the pieces that threads share out; fixed, so that sums do not depend on the number of threads. Element pieces fit the level-2 cache.
	constexpr std::size_t trianglesPerChunk = 256, nodesPerChunk = 1024;

	using MovePoints = void (*)(Points&, std::size_t, std::size_t, const StepSettings&, const StepsAround&, MotionSums&);
	using MoveSpins  = void (*)(Spins&, std::size_t, std::size_t, const StepSettings&, const StepsAround&, MotionSums&);

	struct Motion {
		MovePoints points;
		MoveSpins  spins;
	};

	template <unsigned... effects> Motion selectMotion(unsigned wanted, std::integer_sequence<unsigned, effects...>)
	{
		static constexpr Motion table[] = { { movePoints<effects>, moveSpins<effects> }... };
		return table[wanted];
	}

	/** Lists the blocked degrees of freedom; keeps the last velocity of those known before.
	 * \param share degrees of freedom per entry of mass.
	 * \return the work of the change [J]: one that becomes blocked takes its kinetic energy out of the book, one that is released brings it in. */
	double
	collect(const std::vector<double>& inverseMass,
	        const std::vector<double>& mass,
	        std::size_t                share,
	        const std::vector<double>& velocity,
	        std::vector<Constraint>&   list)
	{
		std::vector<Constraint> old;
		old.swap(list);
		double     work    = 0;
		auto       known   = old.begin();
		const auto kinetic = [&](const Constraint& c) { return 0.5 * mass[c.index / share] * c.velocity * c.velocity; };
		for (std::size_t i = 0; i < inverseMass.size(); i++) {
			const bool wasBlocked = known != old.end() && known->index == i;
			if (inverseMass[i] == 0) {
				list.push_back(wasBlocked ? *known : Constraint { i, velocity[i] });
				if (!wasBlocked) work -= kinetic(list.back());
			} else if (wasBlocked)
				work += kinetic(*known);
			if (wasBlocked) ++known;
		}
		return work;
	}

	/// Work done on the system by what prescribes velocities: the reaction is minus the internal force. The trailing half step used the last velocity.
	void bookReactions(
	        std::vector<Constraint>& list, const std::vector<double>& velocity, const std::vector<double>& force, const StepsAround& dt, double& before, double& after)
	{
		for (auto& c : list) {
			before -= 0.5 * dt.before * force[c.index] * c.velocity;
			c.velocity = velocity[c.index];
			after -= 0.5 * dt.after * force[c.index] * c.velocity;
		}
	}

	void requireComplete(std::size_t n, std::size_t share, std::initializer_list<const std::vector<double>*> parts, const std::vector<double>& external)
	{
		for (const auto* part : parts)
			if (part->size() != share * n)
				throw std::logic_error("TriangleSystem: position, velocity, mass and force of every node, core and spin are needed");
		if (!external.empty() && external.size() != share * n)
			throw std::logic_error("TriangleSystem: external forces must be given for all or for none");
	}

	std::size_t firstBad(const std::vector<double>& values)
	{
		return std::size_t(std::find_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); }) - values.begin());
	}

} // namespace

void Points::resize(std::size_t n)
{
	for (auto* v : { &position, &velocity, &inverseMass, &force })
		v->assign(2 * n, 0.);
	mass.assign(n, 0.);
	external.clear();
}

void Spins::resize(std::size_t n)
{
	for (auto* v : { &angle, &velocity, &inverseInertia, &inertia, &moment })
		v->assign(n, 0.);
	external.clear();
}

void TriangleSystem::addTriangle(const std::array<std::int32_t, 3>& nodes, const TriangleReference<double>& ref)
{
	for (std::size_t e = 0; e < 3; e++)
		vertex[e].push_back(nodes[e]);
	for (std::size_t e = 0; e < 2; e++) {
		arm[2 * e].push_back(ref.arm[e].x);
		arm[2 * e + 1].push_back(ref.arm[e].y);
	}
}

void TriangleSystem::build()
{
	const std::size_t n = triangles();
	if (core.size() != n || (rotation == RotationTreatment::Cosserat && spin.size() != n)) throw std::logic_error("TriangleSystem: one core per triangle");
	for (const auto& list : vertex)
		if (list.size() != n) throw std::logic_error("TriangleSystem: three corners per triangle");
	for (const auto& list : arm)
		if (list.size() != n) throw std::logic_error("TriangleSystem: two arms per triangle");
	requireComplete(node.mass.size(), 2, { &node.position, &node.velocity, &node.inverseMass, &node.force }, node.external);
	requireComplete(core.mass.size(), 2, { &core.position, &core.velocity, &core.inverseMass, &core.force }, core.external);
	requireComplete(spin.angle.size(), 1, { &spin.velocity, &spin.inverseInertia, &spin.inertia, &spin.moment }, spin.external);
	if (3 * n > std::numeric_limits<std::uint32_t>::max()) throw std::logic_error("TriangleSystem: too many triangles for 32-bit corner indices");
	std::size_t covered = 0;
	chunk.clear();
	for (std::size_t g = 0; g < group.size(); g++) {
		if (group[g].begin != covered || group[g].end < covered) throw std::logic_error("TriangleSystem: groups must cover the triangles in order");
		covered = group[g].end;
		if (group[g].law == TriangleGroup::Law::Concrete
		    && (group[g].concrete >= concrete.size() || group[g].firstState + 3 * (group[g].end - group[g].begin) > concreteState.size()
		        || fractureEnergy.size() < group[g].end || (!bandEnergy.empty() && bandEnergy.size() < group[g].end)))
			throw std::logic_error("TriangleSystem: a concrete group needs its material, states and fracture energies");
		for (std::size_t begin = group[g].begin; begin < group[g].end; begin += trianglesPerChunk)
			chunk.push_back({ g, begin, std::min(begin + trianglesPerChunk, group[g].end) });
	}
	if (covered != n) throw std::logic_error("TriangleSystem: groups must cover all triangles");

	cornerStart.assign(node.size() + 1, 0);
	for (const auto& list : vertex)
		for (const std::int32_t v : list) {
			if (v < 0 || std::size_t(v) >= node.size()) throw std::logic_error("TriangleSystem: node index out of range");
			cornerStart[std::size_t(v) + 1]++;
		}
	for (std::size_t v = 0; v < node.size(); v++)
		cornerStart[v + 1] += cornerStart[v];
	corner.assign(3 * n, 0);
	std::vector<std::size_t> next(cornerStart.begin(), cornerStart.end() - 1);
	for (std::size_t i = 0; i < n; i++)
		for (std::size_t e = 0; e < 3; e++)
			corner[next[std::size_t(vertex[e][i])]++] = std::uint32_t(e * n + i);
	cornerForce.assign(6 * n, 0.);
	collectConstraints();
	pending = StepEnergy();
}

void TriangleSystem::collectConstraints()
{
	pending.externalWork += collect(node.inverseMass, node.mass, 2, node.velocity, nodeConstraint);
	pending.externalWork += collect(core.inverseMass, core.mass, 2, core.velocity, coreConstraint);
	pending.externalWork += collect(spin.inverseInertia, spin.inertia, 1, spin.velocity, spinConstraint);
}

StepEnergy TriangleSystem::step(const StepSettings& settings)
{
	const std::size_t n = triangles(), nodeChunks = (node.size() + nodesPerChunk - 1) / nodesPerChunk;
	const StepsAround steps { lastTimeStep > 0 ? lastTimeStep : settings.dt, settings.dt };
	const Motion      move = selectMotion(MotionEffects::select(settings), std::make_integer_sequence<unsigned, MotionEffects::Combinations>());

	ElementArrays arrays {};
	for (std::size_t e = 0; e < 3; e++) {
		arrays.vertex[e]      = vertex[e].data();
		arrays.cornerForce[e] = cornerForce.data() + 2 * e * n;
	}
	for (std::size_t c = 0; c < 4; c++)
		arrays.arm[c] = arm[c].data();
	arrays.nodePosition   = node.position.data();
	arrays.corePosition   = core.position.data();
	arrays.coreAngle      = spin.angle.data();
	arrays.coreForce      = core.force.data();
	arrays.coreMoment     = spin.moment.data();
	arrays.fractureEnergy = fractureEnergy.data();
	arrays.bandEnergy     = bandEnergy.empty() ? nullptr : bandEnergy.data();
	arrays.dt             = settings.dt;

	struct GroupLoop {
		ElementLoop         loop;
		ConcreteBlockUpdate update;
	};
	std::vector<GroupLoop> loops(group.size());
	for (std::size_t g = 0; g < group.size(); g++) {
		loops[g].loop = selectElementLoop(group[g].law, rotation, settings.energy);
		if (group[g].law == TriangleGroup::Law::Concrete)
			loops[g].update = concreteBlockUpdate(concrete[group[g].concrete].effects | (settings.energy ? unsigned(ConcreteEffects::Energy) : 0));
	}

	std::vector<MotionSums> sums(chunk.size() + nodeChunks);
	const auto              elementChunks = std::ptrdiff_t(chunk.size()), allNodeChunks = std::ptrdiff_t(nodeChunks);
	const bool              rotates = rotation == RotationTreatment::Cosserat;
#pragma omp parallel
	{
#pragma omp for schedule(dynamic, 4)
		for (std::ptrdiff_t j = 0; j < elementChunks; j++) {
			const Chunk&         piece = chunk[std::size_t(j)];
			const TriangleGroup& g     = group[piece.group];
			ElementArrays        own   = arrays;
			if (g.law == TriangleGroup::Law::Concrete) {
				own.concrete = &concrete[g.concrete].parameters;
				own.state    = concreteState.data() + g.firstState;
				own.update   = loops[piece.group].update;
			}
			MotionSums& sum = sums[std::size_t(j)];
			loops[piece.group].loop(own, g, piece.begin, piece.end, sum.before);
			move.points(core, piece.begin, piece.end, settings, steps, sum); // a core feels only its own triangle
			if (rotates) move.spins(spin, piece.begin, piece.end, settings, steps, sum);
		}
#pragma omp for schedule(static)
		for (std::ptrdiff_t j = 0; j < allNodeChunks; j++) {
			const std::size_t begin = std::size_t(j) * nodesPerChunk, end = std::min(begin + nodesPerChunk, node.size());
			for (std::size_t v = begin; v < end; v++) {
				double x = 0, y = 0;
				for (std::size_t k = cornerStart[v]; k < cornerStart[v + 1]; k++) {
					const double* force = cornerForce.data() + 2 * std::size_t(corner[k]);
					x += force[0];
					y += force[1];
				}
				node.force[2 * v]     = x;
				node.force[2 * v + 1] = y;
			}
			move.points(node, begin, end, settings, steps, sums[chunk.size() + std::size_t(j)]);
		}
	}

	lastTimeStep = settings.dt;
	StepEnergy energy;
	double     speedSquared = 0;
	for (const auto& sum : sums)
		speedSquared += sum.speedSquared;
	if (!std::isfinite(speedSquared)) throw std::domain_error("a velocity of the deformable triangles is not finite");
	if (settings.energy) {
		energy.gravityWork  = pending.gravityWork;
		energy.externalWork = pending.externalWork;
		energy.dampingLoss  = pending.dampingLoss;
		pending             = StepEnergy();
		for (const auto& sum : sums) {
			energy += sum.before;
			pending += sum.after;
		}
		bookReactions(nodeConstraint, node.velocity, node.force, steps, energy.externalWork, pending.externalWork);
		bookReactions(coreConstraint, core.velocity, core.force, steps, energy.externalWork, pending.externalWork);
		bookReactions(spinConstraint, spin.velocity, spin.moment, steps, energy.externalWork, pending.externalWork);
	} else
		pending = StepEnergy(); // works of a step without the book are not known
	return energy;
}

TriangleSystem::Book TriangleSystem::book() const
{
	Book saved { pending.gravityWork, pending.externalWork, pending.dampingLoss, node.velocity, core.velocity, spin.velocity };
	for (const auto& c : nodeConstraint)
		saved.nodeVelocity[c.index] = c.velocity;
	for (const auto& c : coreConstraint)
		saved.coreVelocity[c.index] = c.velocity;
	for (const auto& c : spinConstraint)
		saved.spinVelocity[c.index] = c.velocity;
	return saved;
}

void TriangleSystem::setBook(const Book& saved)
{
	if (saved.nodeVelocity.size() != node.velocity.size() || saved.coreVelocity.size() != core.velocity.size() || saved.spinVelocity.size() != spin.velocity.size())
		throw std::logic_error("TriangleSystem: the energy book belongs to another system");
	pending.gravityWork  = saved.gravityWork;
	pending.externalWork = saved.externalWork;
	pending.dampingLoss  = saved.dampingLoss;
	for (auto& c : nodeConstraint)
		c.velocity = saved.nodeVelocity[c.index];
	for (auto& c : coreConstraint)
		c.velocity = saved.coreVelocity[c.index];
	for (auto& c : spinConstraint)
		c.velocity = saved.spinVelocity[c.index];
}

TriangleSystem::Place TriangleSystem::firstNotFinite() const
{
	for (const Points* points : { &node, &core })
		for (const auto* values : { &points->velocity, &points->position }) {
			const std::size_t i = firstBad(*values);
			if (i < values->size()) return { points == &node, i / 2, true };
		}
	for (const auto* values : { &spin.velocity, &spin.angle }) {
		const std::size_t i = firstBad(*values);
		if (i < values->size()) return { false, i, true };
	}
	return {};
}

TriangleReference<double> TriangleSystem::reference(std::size_t i) const
{
	return TriangleReference<double>({ arm[0][i], arm[1][i] }, { arm[2][i], arm[3][i] });
}

RelativeDisplacements<double> TriangleSystem::fromCentre(std::size_t i) const
{
	RelativeDisplacements<double> result;
	for (std::size_t e = 0; e < 3; e++) {
		const std::size_t v = std::size_t(vertex[e][i]);
		result[e]           = { node.position[2 * v] - core.position[2 * i], node.position[2 * v + 1] - core.position[2 * i + 1] };
	}
	return result;
}

PlaneRotation<double> TriangleSystem::frame(std::size_t i) const
{
	switch (rotation) {
		case RotationTreatment::None: return FrameNone::rotation(reference(i), fromCentre(i), 0.);
		case RotationTreatment::Corotational: return FrameCorotational::rotation(reference(i), fromCentre(i), 0.);
		default: return FrameCosserat::rotation(reference(i), fromCentre(i), spin.angle[i]);
	}
}

double TriangleSystem::frameAngle(std::size_t i) const
{
	if (rotation == RotationTreatment::Cosserat) return spin.angle[i];
	const PlaneRotation<double> r = frame(i);
	return std::atan2(r.s, r.c);
}

const TriangleGroup& TriangleSystem::groupOf(std::size_t i) const
{
	return *(std::upper_bound(group.begin(), group.end(), i, [](std::size_t value, const TriangleGroup& g) { return value < g.end; }));
}

const ConcreteState* TriangleSystem::concreteStates(std::size_t i) const
{
	const TriangleGroup& g = groupOf(i);
	return g.law == TriangleGroup::Law::Concrete ? &concreteState[stateIndex(g, i)] : nullptr;
}

std::array<double, 3> TriangleSystem::subElementDamage(std::size_t i) const
{
	std::array<double, 3> result {};
	if (const ConcreteState* state = concreteStates(i))
		for (std::size_t k = 0; k < 3; k++)
			result[k] = damageRatio(concrete[groupOf(i).concrete].parameters, state[k]);
	return result;
}

RelativeDisplacements<double> TriangleSystem::relativeDisplacements(std::size_t i) const
{
	const TriangleReference<double> ref  = reference(i);
	const PlaneRotation<double>          turn = frame(i);
	RelativeDisplacements<double>   du   = fromCentre(i);
	for (std::size_t e = 0; e < 3; e++)
		du[e] = relativeDisplacement(turn, du[e], ref.arm[e]);
	return du;
}

std::array<PlaneTensor, 3> TriangleSystem::strain(std::size_t i) const
{
	std::array<PlaneTensor, 3> result {};
	const auto                 strains = subElementStrains(reference(i), relativeDisplacements(i));
	for (std::size_t k = 0; k < 3; k++)
		result[k] = { strains[k].xx, strains[k].yy, 0, strains[k].xy };
	return result;
}

std::array<PlaneTensor, 3> TriangleSystem::stress(std::size_t i) const
{
	const TriangleGroup&       g = groupOf(i);
	std::array<PlaneTensor, 3> result {};
	if (g.law == TriangleGroup::Law::Concrete) {
		for (std::size_t k = 0; k < 3; k++)
			result[k] = concreteState[stateIndex(g, i) + k].stress;
		return result;
	}
	result = strain(i);
	for (auto& t : result) {
		const double pressure = g.lambda * (t.xx + t.yy);
		t                     = { pressure + 2 * g.mu * t.xx, pressure + 2 * g.mu * t.yy, pressure, 2 * g.mu * t.xy };
	}
	return result;
}

} // namespace yade::ddem
