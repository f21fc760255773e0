// GPL v2 or later, see LICENSE.
// Motion of all spheres of a sample in arrays, by the leapfrog of YADE's NewtonIntegrator.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace yade::ddem {

/// Numbers that a sphere has in each of the arrays: two quads, of translation and of rotation.
constexpr std::ptrdiff_t sphereRow = 8;

/// What moves spheres besides the loads on them.
struct SphereStep {
	double dt         = 0;           ///< [s]
	double gravity[3] = { 0, 0, 0 }; ///< [m/s²]
	/// Cundall's local damping [-], which in YADE acts on gravity, too, unless told otherwise
	double damping     = 0;
	bool   dampGravity = true;
	bool   energy      = false; ///< whether to book energies
};

/// What a step of the motion adds to the energy book, and how fast the fastest sphere is.
struct SphereSums {
	double translation = 0; ///< kinetic energy [J], ½ m v(-½)·v(+½), which belongs to the instant between the two
	double rotation    = 0; ///< the same of rotation [J]
	double gravityWork = 0; ///< [J]
	double dampingLoss = 0; ///< by local damping [J]
	double speedSquared = 0; ///< largest, after the step [m²/s²]
	bool   finite       = true; ///< whether all places and velocities are numbers

	SphereSums& operator+=(const SphereSums& other)
	{
		translation += other.translation;
		rotation += other.rotation;
		gravityWork += other.gravityWork;
		dampingLoss += other.dampingLoss;
		speedSquared = speedSquared > other.speedSquared ? speedSquared : other.speedSquared;
		finite       = finite && other.finite;
		return *this;
	}
};

class SphereMotion {
public:
	/// Places for spheres, all at rest at the origin, without mass: nothing moves them until it is given.
	void resize(std::size_t spheres);
	std::size_t size() const { return count; }

	/// \param mass,inertia [kg, kg·m²]; 0: keeps its velocity and has no energy, as a sphere that others move
	void setMass(std::size_t sphere, double mass, double inertia);
	/// Takes away degrees of freedom: bits 0 to 2 are x, y, z, bits 3 to 5 rotation about them.
	void block(std::size_t sphere, unsigned axes);
	unsigned blocked(std::size_t sphere) const { return axesBlocked[sphere]; }

	/// Moves all spheres by their loads.
	SphereSums step(const SphereStep& settings);

	/** Adds viscous damping to the loads, see ViscousDamper; to be called when they are complete.
	 * \param translation,rotation coefficients [1/s]
	 * \param book whether to add up the loss
	 * \returns energy that it takes away in the coming step [J] */
	double drag(double translation, double rotation, double dt, bool book);

	/// Rows of position x, y, z [m] and orientation w, x, y, z; the fourth number of each is the inverse mass.
	std::vector<double> pose;
	/// Rows of velocity [m/s] and angular velocity [rad/s]; the fourth number of each is the inverse moment of
	/// inertia, the last is not used.
	std::vector<double> velocity;
	/// Rows of force [N] and moment about the centre [N·m]; the fourth and the last number are not used.
	std::vector<double> load;

	double* poseOf(std::size_t sphere) { return pose.data() + sphereRow * std::ptrdiff_t(sphere); }
	const double* poseOf(std::size_t sphere) const { return pose.data() + sphereRow * std::ptrdiff_t(sphere); }
	double* velocityOf(std::size_t sphere) { return velocity.data() + sphereRow * std::ptrdiff_t(sphere); }
	const double* velocityOf(std::size_t sphere) const
	{
		return velocity.data() + sphereRow * std::ptrdiff_t(sphere);
	}
	double* loadOf(std::size_t sphere) { return load.data() + sphereRow * std::ptrdiff_t(sphere); }
	const double* loadOf(std::size_t sphere) const { return load.data() + sphereRow * std::ptrdiff_t(sphere); }
	double massOf(std::size_t sphere) const { return mass[sphere]; }
	double inertiaOf(std::size_t sphere) const { return inertia[sphere]; }

private:
	std::size_t               count = 0;
	std::vector<double>       mass, inertia;
	std::vector<std::uint8_t> axesBlocked;
	std::vector<double>       free; ///< rows of 1, or 0 where blocked; empty where nothing is
};

} // namespace yade::ddem
