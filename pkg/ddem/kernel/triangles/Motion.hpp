// GPL v2 or later, see LICENSE.
// What moves: nodes, cores and the cores' rotations, with the book of works on their constraints.
#pragma once

#include <pkg/ddem/kernel/algebra/PlaneVector.hpp>
#include <pkg/ddem/kernel/algebra/ReservedArray.hpp>
#include <pkg/ddem/kernel/triangles/NodeLoads.hpp>
#include <pkg/ddem/kernel/triangles/StepEnergy.hpp>

#include <cstddef>
#include <vector>

namespace yade::ddem {

/// What a step has to do beyond internal forces and motion; what is off is not evaluated.
struct StepSettings {
	double              dt = 0;           ///< [s]
	PlaneVector<double> gravity { 0, 0 }; ///< [m/s²]
	double              damping  = 0;     ///< Cundall's local damping coefficient [-], as in NewtonIntegrator
	bool                external = false; ///< add external forces
	bool                energy   = false; ///< fill StepEnergy; works are complete while it is on in every step
};

/// Translations of one kind of point (nodes or cores), interleaved x, y.
struct Points {
	ReservedArray<double> position, velocity; ///< [m], [m/s]; 2 per point
	ReservedArray<double> inverseMass;        ///< [1/kg], 2 per point; 0 where the degree of freedom is blocked
	ReservedArray<double> mass;               ///< [kg], 1 per point
	ReservedArray<double> force;              ///< internal force of the last step [N], 2 per point
	std::vector<double>   external;           ///< force from outside [N], 2 per point; empty if there is none

	std::size_t size() const { return mass.size(); }
	/// So many points at rest in the origin, without mass, with address space for `capacity` of them.
	void resize(std::size_t n, std::size_t capacity = 0);
};

/// Rotations of the cores; empty where cores do not rotate.
struct Spins {
	ReservedArray<double> angle, velocity; ///< [rad] (unwrapped), [rad/s]
	ReservedArray<double> inverseInertia;  ///< [1/(kg·m²)]; 0 where blocked
	ReservedArray<double> inertia;         ///< [kg·m²]
	ReservedArray<double> moment;          ///< internal moment of the last step [N·m]
	std::vector<double>   external;        ///< moment from outside [N·m]; empty if there is none

	std::size_t size() const { return angle.size(); }
	void        resize(std::size_t n);
};

/// A blocked degree of freedom and the velocity it had in the last step: its reaction does the external work.
struct Constraint {
	std::size_t index    = 0; ///< place in Points::velocity or Spins::velocity
	double      velocity = 0; ///< velocity of the last step [m/s, rad/s]
};

/// Time steps on both sides of the present positions. Velocities live half a step from them,
/// so what accelerates acts for half of each.
struct StepsAround {
	double before, after; ///< [s]

	double between() const { return 0.5 * (before + after); }
};

/// Sums over a range of degrees of freedom; works are split into the half steps before and after the current positions.
struct MotionSums {
	double     speedSquared = 0; ///< not finite as soon as any velocity is not
	StepEnergy before, after;    ///< before holds the kinetic energy as well

	MotionSums& operator+=(const MotionSums& other)
	{
		speedSquared += other.speedSquared;
		before += other.before;
		after += other.after;
		return *this;
	}
};

/// State of motion of all triangles of a system.
class Motion {
public:
	Points node, core;
	/// on nodes, beside the forces from outside; their works are booked apart
	NodeLoads loads;
	Spins  spin;             ///< of the cores; empty unless they rotate
	double lastTimeStep = 0; ///< of the last step [s]; velocities are half of it before the positions.
	                         ///< 0: equal to the next

	/// \throws std::logic_error unless every node, core and spin has all its numbers.
	void requireComplete() const;

	/// Tells the energy book which degrees of freedom are blocked now (inverse mass 0); call after changing any,
	/// and before their velocities are changed.
	void collectConstraints();

	/// Nodes that threads share out in one piece.
	static constexpr std::size_t nodesPerTile = 1024;
	std::size_t                  nodeTiles() const { return (node.size() + nodesPerTile - 1) / nodesPerTile; }

	/** Closes the book of a step whose forces and motion are done: adds what reactions did, and keeps the works
	 * of the second half step for the next.
	 * \param tiles sums of the triangles' tiles, then of the nodes'.
	 * \param tileStart first triangle of every tile. */
	StepEnergy
	closeBook(std::vector<MotionSums>& tiles, const std::vector<std::size_t>& tileStart, const StepsAround& steps);
	/// Works of a step without the book are not known.
	void dropBook() { pending = StepEnergy(); }
	/// Forgets what the half step after the last positions did.
	void restartBook()
	{
		collectConstraints();
		dropBook();
	}

	/// What the energy book needs to go on after a restart: works of the half step after the last positions, and
	/// for every degree of freedom the velocity of the last step, which differs from the present
	/// one where it is prescribed.
	struct Book {
		double gravityWork = 0, externalWork = 0, dampingLoss = 0, edgeWork = 0, edgeAbsorption = 0; ///< [J]
		/// [m/s, rad/s], as Points::velocity and Spins::velocity
		std::vector<double> nodeVelocity, coreVelocity, spinVelocity;
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

private:
	std::vector<Constraint> nodeConstraint, coreConstraint, spinConstraint;
	StepEnergy              pending; ///< works of the half step after the last positions
};

} // namespace yade::ddem
