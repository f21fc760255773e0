// GPL v2 or later, see LICENSE.
// The energy book of one step.
#pragma once

namespace yade::ddem {

/** Energies of one step [J]. Works are what forces did up to the instant of the positions the step started from;
 * kinetic energy is the leapfrog's conserved product ½ m v(n−½)·v(n+½), which together with the elastic energy is
 * constant to round-off in a linear system while the time step is. */
struct StepEnergy {
	double kinetic = 0, elastic = 0, rotation = 0, plastic = 0, damage = 0;
	double gravityWork = 0, externalWork = 0, dampingLoss = 0; ///< increments since the last step
	double edgeWork = 0, edgeAbsorption = 0; ///< of loads and dampers on nodes, see NodeLoads; increments, too

	StepEnergy& operator+=(const StepEnergy& other)
	{
		kinetic += other.kinetic;
		elastic += other.elastic;
		rotation += other.rotation;
		plastic += other.plastic;
		damage += other.damage;
		gravityWork += other.gravityWork;
		externalWork += other.externalWork;
		dampingLoss += other.dampingLoss;
		edgeWork += other.edgeWork;
		edgeAbsorption += other.edgeAbsorption;
		return *this;
	}
};

} // namespace yade::ddem
