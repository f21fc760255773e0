// GPL v2 or later, see LICENSE.
// All triangles and nodes of a scene as structure of arrays, and one explicit step of them.
#pragma once

#include <pkg/ddem/kernel/laws/ConcreteLaw.hpp>
#include <pkg/ddem/kernel/triangles/ElementFrame.hpp>
#include <pkg/ddem/kernel/triangles/LumpedMass.hpp>
#include <pkg/ddem/kernel/algebra/TensorRotation.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace yade::ddem {

/// A run of consecutive triangles that share one law, so that the law is picked once and not per element.
struct TriangleGroup {
	enum class Law { Elastic, Concrete };

	std::size_t begin = 0, end = 0; ///< triangles [begin, end)
	Law         law    = Law::Elastic;
	double      lambda = 0, mu = 0;  ///< Lamé constants [Pa] (elastic law)
	double      rotationModulus = 0; ///< μ β_φ [Pa]
	double      thickness       = 1; ///< [m]
	std::size_t concrete        = 0; ///< index into TriangleSystem::concrete (concrete law)
	std::size_t firstState      = 0; ///< index of the first sub-element's state in TriangleSystem::concreteState
};

/// A concrete material prepared for the loop.
struct ConcreteGroupLaw {
	PreparedConcrete parameters;
	unsigned         effects = 0; ///< mask of ConcreteEffects; Energy is added while the energy book is kept
};

/// What a step has to do beyond internal forces and motion; what is off is not evaluated.
struct StepSettings {
	double              dt = 0;           ///< [s]
	PlaneVector<double> gravity { 0, 0 }; ///< [m/s²]
	double              damping  = 0;     ///< Cundall's local damping coefficient [-], as in NewtonIntegrator
	bool                external = false; ///< add TriangleSystem::external forces
	bool                energy   = false; ///< fill StepEnergy; works are complete while it is on in every step
};

/** Energies of one step [J]. Works are what forces did up to the instant of the positions the step started from; kinetic energy is the leapfrog's conserved
 * product ½ m v(n−½)·v(n+½), which together with the elastic energy is constant to round-off in a linear system while the time step is. */
struct StepEnergy {
	double kinetic = 0, elastic = 0, rotation = 0, plastic = 0, damage = 0;
	double gravityWork = 0, externalWork = 0, dampingLoss = 0; ///< increments since the last step

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
		return *this;
	}
};

/// Translations of one kind of point (nodes or cores), interleaved x, y.
struct Points {
	std::vector<double> position, velocity; ///< [m], [m/s]; 2 per point
	std::vector<double> inverseMass;        ///< [1/kg], 2 per point; 0 where the degree of freedom is blocked
	std::vector<double> mass;               ///< [kg], 1 per point
	std::vector<double> force;              ///< internal force of the last step [N], 2 per point
	std::vector<double> external;           ///< force from outside [N], 2 per point; empty if there is none

	std::size_t size() const { return mass.size(); }
	void        resize(std::size_t n);
};

/// Rotations of the cores; empty where cores do not rotate.
struct Spins {
	std::vector<double> angle, velocity; ///< [rad] (unwrapped), [rad/s]
	std::vector<double> inverseInertia;  ///< [1/(kg·m²)]; 0 where blocked
	std::vector<double> inertia;         ///< [kg·m²]
	std::vector<double> moment;          ///< internal moment of the last step [N·m]
	std::vector<double> external;        ///< moment from outside [N·m]; empty if there is none

	std::size_t size() const { return angle.size(); }
	void        resize(std::size_t n);
};

/// A blocked degree of freedom and the velocity it had in the last step: its reaction does the external work.
struct Constraint {
	std::size_t index    = 0; ///< place in Points::velocity or Spins::velocity
	double      velocity = 0; ///< velocity of the last step [m/s, rad/s]
};

/** State of all deformable triangles, owner of their motion.
 *
 * A step computes element forces at the current positions and then moves cores and nodes by leapfrog, with the scheme of NewtonIntegrator (velocities live at
 * half steps); where the step changes, forces act for half of the last and half of the next, which keeps it of second order; it should change seldom, since a step that alternates
 * excites vibrations well below the bound on a constant one. Forces on a node are gathered from its triangles' corners in a fixed order, so results do not depend on the number of threads, bit by bit.
 */
class TriangleSystem {
public:
	// --- topology and reference, fixed after build()
	std::array<std::vector<std::int32_t>, 3> vertex; ///< node of corner e of every triangle, counter-clockwise
	std::array<std::vector<double>, 4>       arm;    ///< r_1x, r_1y, r_2x, r_2y of every triangle [m]; r_3 = −r_1 − r_2
	std::vector<TriangleGroup>               group;  ///< in order, covering all triangles
	std::vector<ConcreteGroupLaw>            concrete;
	std::vector<double>                      fractureEnergy; ///< G_f of every triangle [J/m³]; only read in concrete groups, empty if there are none
	std::vector<double>                      bandEnergy;     ///< the same once flow has localised; empty unless a crack band is asked for
	RotationTreatment                        rotation = RotationTreatment::Cosserat;

	// --- state
	Points                     node, core;
	Spins                      spin;          ///< of the cores; empty unless they rotate
	std::vector<ConcreteState> concreteState; ///< 3 per concrete triangle
	double                     lastTimeStep = 0; ///< of the last step [s]; velocities are half of it before the positions. 0: equal to the next

	std::size_t triangles() const { return vertex[0].size(); }
	void        addTriangle(const std::array<std::int32_t, 3>& nodes, const TriangleReference<double>& reference);

	/** Completes the system after topology, groups, masses and positions are set: adjacency and work arrays.
	 * \throws std::logic_error if sizes disagree or a node index is out of range. */
	void build();

	/// Tells the energy book which degrees of freedom are blocked now (inverse mass 0); call after changing any, and before their velocities are changed.
	void collectConstraints();

	/** One explicit step. \throws std::domain_error if a velocity is not finite (see firstNotFinite). */
	StepEnergy step(const StepSettings& settings);

	/// What the energy book needs to go on after a restart: works of the half step after the last positions, and for every degree of freedom the velocity of the
	/// last step, which differs from the present one where it is prescribed.
	struct Book {
		double              gravityWork = 0, externalWork = 0, dampingLoss = 0; ///< [J]
		std::vector<double> nodeVelocity, coreVelocity, spinVelocity;           ///< [m/s, rad/s], as Points::velocity and Spins::velocity
	};
	Book book() const;
	/// \throws std::logic_error if the sizes are not those of this system.
	void setBook(const Book& saved);

	/// The first node or core whose state is not finite.
	struct Place {
		bool        isNode = true;
		std::size_t index  = 0;
		bool        found  = false;
	};
	Place firstNotFinite() const;

	TriangleReference<double> reference(std::size_t triangle) const;
	/// Δu_e of the vertices in the element's frame at the current positions [m].
	RelativeDisplacements<double> relativeDisplacements(std::size_t triangle) const;
	/// Stress of the three sub-elements in the element's frame [Pa]: at the current positions (elastic), of the last step (concrete).
	std::array<PlaneTensor, 3> stress(std::size_t triangle) const;
	/// Strain of the three sub-elements in the element's frame at the current positions [-].
	std::array<PlaneTensor, 3> strain(std::size_t triangle) const;
	/// Rotation of the element's frame [rad]; unwrapped only where cores rotate.
	double               frameAngle(std::size_t triangle) const;
	const TriangleGroup& groupOf(std::size_t triangle) const;
	/// The three sub-element states of a concrete triangle; null for an elastic one.
	const ConcreteState* concreteStates(std::size_t triangle) const;
	/// Damage η/η_max of the three sub-elements [-]; 0 in elastic triangles.
	std::array<double, 3> subElementDamage(std::size_t triangle) const;
	/// Index in concreteState of a triangle's first sub-element; its group must be concrete.
	static std::size_t stateIndex(const TriangleGroup& g, std::size_t triangle) { return g.firstState + 3 * (triangle - g.begin); }

private:
	struct Chunk {
		std::size_t group, begin, end;
	};
	std::vector<Chunk>         chunk;
	std::vector<std::size_t>   cornerStart; ///< nodes + 1: where a node's corners begin in corner
	std::vector<std::uint32_t> corner;      ///< e·triangles + triangle, by node
	std::vector<double>        cornerForce; ///< x, y of every corner [N], in the order of corner's values
	std::vector<Constraint>    nodeConstraint, coreConstraint, spinConstraint;
	StepEnergy                 pending; ///< works of the half step after the last positions

	PlaneRotation<double>              frame(std::size_t triangle) const;
	RelativeDisplacements<double> fromCentre(std::size_t triangle) const;
};

} // namespace yade::ddem
