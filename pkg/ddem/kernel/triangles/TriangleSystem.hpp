// GPL v2 or later, see LICENSE.
// All triangles and nodes of a sample as structure of arrays, and one explicit step of them.
#pragma once

#include <pkg/ddem/kernel/algebra/TensorRotation.hpp>
#include <pkg/ddem/kernel/triangles/ElementFrame.hpp>
#include <pkg/ddem/kernel/triangles/LawGroup.hpp>
#include <pkg/ddem/kernel/triangles/Motion.hpp>
#include <pkg/ddem/kernel/triangles/RigidPlaten.hpp>
#include <pkg/ddem/kernel/triangles/Topology.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace yade::ddem {

/** State of all deformable triangles, owner of their motion.
 *
 * A step computes element forces at the current positions and then moves cores and nodes by leapfrog, with the scheme
 * of NewtonIntegrator (velocities live at half steps); where the step changes, forces act for half of the last and
 * half of the next, which keeps it of second order; it should change seldom, since a step that alternates excites
 * vibrations well below the bound on a constant one. Forces on a node are gathered from its triangles' corners in
 * a fixed order and sums go through a fixed tree over tiles, so results do not depend on the number of threads,
 * bit by bit.
 */
class TriangleSystem {
public:
	Topology                  topology;
	Motion                    motion;
	std::vector<GroupPointer> group; ///< in order of their rows, covering all triangles
	RotationTreatment         rotation = RotationTreatment::Cosserat;
	std::vector<RigidPlaten>  platens; ///< that move in the next step

	std::size_t triangles() const { return topology.triangles(); }

	/** Completes the system after topology, groups, masses and positions are set: adjacency and work arrays.
	 * \throws std::logic_error if sizes disagree or a node index is out of range. */
	void build();

	/** One explicit step. \throws std::domain_error if a velocity is not finite (see Motion::firstNotFinite). */
	StepEnergy step(const StepSettings& settings);

	/// Δu_e of the vertices in the element's frame at the current positions [m].
	RelativeDisplacements<double> relativeDisplacements(std::size_t triangle) const;
	/// Strain of the three sub-elements in the element's frame at the current positions [-].
	std::array<PlaneTensor, 3> strain(std::size_t triangle) const;
	/// Stress of the three sub-elements in the element's frame at the current positions, for every law: what a step
	/// of dt [s] from the state of the last step gives [Pa].
	std::array<PlaneTensor, 3> stress(std::size_t triangle, double dt) const;
	/// The same for a step as long as the last one.
	std::array<PlaneTensor, 3> stress(std::size_t triangle) const { return stress(triangle, motion.lastTimeStep); }
	/// Rotation of the element's frame [rad]; unwrapped only where cores rotate.
	double frameAngle(std::size_t triangle) const;
	/// Damage of the three sub-elements [-], 0 intact to 1; 0 where the law knows none.
	std::array<double, 3> damage(std::size_t triangle) const;
	/// The triangle whose vertices span the smallest part of its reference area [-];
	/// zero or less: it is inside out.
	struct Inverted {
		std::size_t triangle = 0;
		double      ratio    = 1;
	};
	Inverted mostInverted() const;
	/// The group of a triangle.
	LawGroup&       groupOf(std::size_t triangle) { return *group[groupIndex(triangle)]; }
	const LawGroup& groupOf(std::size_t triangle) const { return *group[groupIndex(triangle)]; }

private:
	struct Tile {
		std::size_t group, inGroup;
	};
	std::vector<Tile>        tile;
	std::vector<std::size_t> tileStart;   ///< first triangle of every tile
	std::vector<double>      cornerForce; ///< x, y of every corner [N], by CornerIndex

	std::size_t                   groupIndex(std::size_t triangle) const;
	PlaneRotation<double>         frame(std::size_t triangle) const;
	RelativeDisplacements<double> fromCentre(std::size_t triangle) const;
	ElementArrays                 arrays();
	void                          keepBook(bool energy);
};

} // namespace yade::ddem
