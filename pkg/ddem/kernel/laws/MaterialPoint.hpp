// GPL v2 or later, see LICENSE.
// Material-point driver: one point of concrete along a path of prescribed strains and stresses.
#pragma once

#include <pkg/ddem/kernel/laws/ConcreteLaw.hpp>

#include <array>
#include <vector>

namespace yade::ddem {

/// What a component of a path prescribes.
enum class Control { Strain, Stress };

/// One leg of a path: every component goes linearly from where it is to its target, as a strain [-] or as a stress [Pa], within `duration` [s].
/// Uniaxial stress is yy by strain and xx, zz by stress; plane strain has zz by strain, target 0.
struct PathLeg {
	std::array<Control, 4> control;  ///< of xx, yy, zz, xy
	PlaneTensor            target;   ///< strains or stresses at the end of the leg
	double                 duration; ///< [s], > 0
	std::size_t            steps;    ///< > 0
};

/// State of the point at one instant.
struct PathPoint {
	double        time; ///< [s]
	ConcreteState state;
};

/// Drives advanceConcrete along legs. Strains that the path leaves free are found in every step by Newton's method so that their stresses meet the
/// path within `stressTolerance`; a step that does not converge, or in which a free strain changes by more than 2e-5, is halved.
class MaterialPoint {
public:
	/// `effects` is a mask of ConcreteEffects; `damage` is Ω_0, pre-existing damage (positive semi-definite); `bandFactor` multiplies the fracture energy once flow
	/// has localised, see FractureEnergyOf. Throws std::invalid_argument for a bad parameter, effect, damage or factor.
	explicit MaterialPoint(
	        const ConcreteParameters& parameters = ConcreteParameters(),
	        unsigned                  effects    = ConcreteEffects::All,
	        const PlaneTensor&        damage     = PlaneTensor { 0, 0, 0, 0 },
	        double                    bandFactor = 1);

	/// Runs a leg and returns the point after every `every`-th step and at the end. Throws std::invalid_argument for a bad leg and std::runtime_error,
	/// with the time and the component, where no strain gives the stress asked for (more than the material bears). The point then stays where the
	/// last step that worked left it.
	std::vector<PathPoint> run(const PathLeg& leg, std::size_t every = 1);

	const ConcreteState&    state() const { return point_.state; }
	double                  time() const { return point_.time; } ///< [s]
	const PreparedConcrete& concrete() const { return concrete_; }

	double stressTolerance; ///< Largest error of a prescribed stress [Pa]; 1e-10 of the strength unless set

private:
	using Components = std::array<double, 4>;

	bool step(const PathLeg& leg, const Components& strain, const Components& stress, double dt, int halvings);

	PreparedConcrete         concrete_;
	FractureEnergyOf<double> fractureEnergy_;
	ConcreteUpdate   update_;
	PathPoint        point_;
	Components       freeRate_; // strain rate of the last step [1/s], the first guess of the next
};

} // namespace yade::ddem
