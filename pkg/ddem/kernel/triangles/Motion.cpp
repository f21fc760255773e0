// GPL v2 or later, see LICENSE.
#include <pkg/ddem/kernel/triangles/Motion.hpp>

#include <pkg/ddem/kernel/triangles/TileSums.hpp>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <stdexcept>

namespace yade::ddem {

namespace {

	/** Lists the blocked degrees of freedom; keeps the last velocity of those known before.
	 * \param share degrees of freedom per entry of mass.
	 * \return the work of the change [J]: one that becomes blocked takes its kinetic energy out of the book,
	 * one that is released brings it in. */
	double
	collect(const ReservedArray<double>& inverseMass,
	        const ReservedArray<double>& mass,
	        std::size_t                share,
	        const ReservedArray<double>& velocity,
	        std::vector<Constraint>&   list)
	{
		std::vector<Constraint> old;
		old.swap(list);
		double     work    = 0;
		auto       known   = old.begin();
		const auto kinetic
		        = [&](const Constraint& c) { return 0.5 * mass[c.index / share] * c.velocity * c.velocity; };
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

	/// Work done on the system by what prescribes velocities: the reaction is minus the internal force.
	/// The trailing half step used the last velocity. It goes to the tile of the point.
	template <class TileOf>
	void bookReactions(
	        std::vector<Constraint>&     list,
	        const ReservedArray<double>& velocity,
	        const ReservedArray<double>& force,
	        const StepsAround&           dt,
	        std::vector<MotionSums>&     tiles,
	        const TileOf&                tileOf,
	        const NodeLoads&             loads = NodeLoads())
	{
		auto load = loads.begin();
		for (auto& c : list) {
			MotionSums& sum = tiles[tileOf(c.index)];
			while (load != loads.end() && load->node < c.index / 2)
				++load;
			const bool   loaded = load != loads.end() && load->node == c.index / 2;
			const double own    = !loaded ? 0. : c.index % 2 ? load->force.y : load->force.x;
			const double resistance = !loaded ? 0. : c.index % 2 ? load->resistance.y : load->resistance.x;
			const double reaction   = -(force[c.index] + own + resistance);
			const auto   book       = [&](StepEnergy& half, double weight) {
                                half.externalWork += weight * reaction * c.velocity;
                                half.edgeWork += weight * own * c.velocity;
                                half.edgeAbsorption -= weight * resistance * c.velocity;
			};
			book(sum.before, 0.5 * dt.before);
			c.velocity = velocity[c.index];
			book(sum.after, 0.5 * dt.after);
		}
	}

	void requireNumbers(
	        std::size_t n, std::size_t share, std::initializer_list<const ReservedArray<double>*> parts,
	        const std::vector<double>& external)
	{
		for (const auto* part : parts)
			if (part->size() != share * n)
				throw std::logic_error("Motion: position, velocity, mass and force of every node, core "
				                       "and spin are needed");
		if (!external.empty() && external.size() != share * n)
			throw std::logic_error("Motion: external forces must be given for all or for none");
	}

	std::size_t firstBad(const ReservedArray<double>& values)
	{
		return std::size_t(
		        std::find_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); })
		        - values.begin());
	}

} // namespace

void Points::resize(std::size_t n, std::size_t capacity)
{
	for (auto* v : { &position, &velocity, &inverseMass, &force })
		v->assign(2 * n, 0., 2 * capacity);
	mass.assign(n, 0., capacity);
	external.clear();
}

void Spins::resize(std::size_t n)
{
	for (auto* v : { &angle, &velocity, &inverseInertia, &inertia, &moment })
		v->assign(n, 0.);
	external.clear();
}

void Motion::requireComplete() const
{
	requireNumbers(
	        node.mass.size(), 2, { &node.position, &node.velocity, &node.inverseMass, &node.force }, node.external);
	requireNumbers(
	        core.mass.size(), 2, { &core.position, &core.velocity, &core.inverseMass, &core.force }, core.external);
	requireNumbers(
	        spin.angle.size(), 1, { &spin.velocity, &spin.inverseInertia, &spin.inertia, &spin.moment },
	        spin.external);
}

void Motion::collectConstraints()
{
	pending.externalWork += collect(node.inverseMass, node.mass, 2, node.velocity, nodeConstraint);
	pending.externalWork += collect(core.inverseMass, core.mass, 2, core.velocity, coreConstraint);
	pending.externalWork += collect(spin.inverseInertia, spin.inertia, 1, spin.velocity, spinConstraint);
}

StepEnergy Motion::closeBook(
        std::vector<MotionSums>& tiles, const std::vector<std::size_t>& tileStart, const StepsAround& steps)
{
	const auto tileOfTriangle = [&](std::size_t i) {
		return std::size_t(std::upper_bound(tileStart.begin(), tileStart.end(), i) - tileStart.begin()) - 1;
	};
	const auto tileOfNode = [&](std::size_t i) { return tileStart.size() + i / nodesPerTile; };
	const auto half = [](const auto& tileOf) { return [&tileOf](std::size_t index) { return tileOf(index / 2); }; };
	bookReactions(nodeConstraint, node.velocity, node.force, steps, tiles, half(tileOfNode), loads);
	bookReactions(coreConstraint, core.velocity, core.force, steps, tiles, half(tileOfTriangle));
	bookReactions(spinConstraint, spin.velocity, spin.moment, steps, tiles, tileOfTriangle);

	// elements and nodes in a tree each, as domains will have them
	const auto middle = tiles.begin() + std::ptrdiff_t(tileStart.size());
	MotionSums sum    = treeSum(std::vector<MotionSums>(tiles.begin(), middle));
	sum += treeSum(std::vector<MotionSums>(middle, tiles.end()));
	StepEnergy energy = sum.before;
	energy.gravityWork += pending.gravityWork;
	energy.externalWork += pending.externalWork;
	energy.dampingLoss += pending.dampingLoss;
	energy.edgeWork += pending.edgeWork;
	energy.edgeAbsorption += pending.edgeAbsorption;
	pending = sum.after;
	return energy;
}

Motion::Book Motion::book() const
{
	const auto list
	        = [](const ReservedArray<double>& values) { return std::vector<double>(values.begin(), values.end()); };
	Book       saved { pending.gravityWork, pending.externalWork,   pending.dampingLoss,
		     pending.edgeWork,    pending.edgeAbsorption, list(node.velocity),
		     list(core.velocity), list(spin.velocity) };
	for (const auto& c : nodeConstraint)
		saved.nodeVelocity[c.index] = c.velocity;
	for (const auto& c : coreConstraint)
		saved.coreVelocity[c.index] = c.velocity;
	for (const auto& c : spinConstraint)
		saved.spinVelocity[c.index] = c.velocity;
	return saved;
}

void Motion::setBook(const Book& saved)
{
	if (saved.nodeVelocity.size() != node.velocity.size() || saved.coreVelocity.size() != core.velocity.size()
	    || saved.spinVelocity.size() != spin.velocity.size())
		throw std::logic_error("TriangleSystem: the energy book belongs to another system");
	pending.gravityWork  = saved.gravityWork;
	pending.externalWork = saved.externalWork;
	pending.dampingLoss  = saved.dampingLoss;
	pending.edgeWork       = saved.edgeWork;
	pending.edgeAbsorption = saved.edgeAbsorption;
	for (auto& c : nodeConstraint)
		c.velocity = saved.nodeVelocity[c.index];
	for (auto& c : coreConstraint)
		c.velocity = saved.coreVelocity[c.index];
	for (auto& c : spinConstraint)
		c.velocity = saved.spinVelocity[c.index];
}

Motion::Place Motion::firstNotFinite() const
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

} // namespace yade::ddem
