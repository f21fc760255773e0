// GPL v2 or later, see LICENSE.
// Material-point driver: one point of a law along a path of prescribed strains and stresses.
#pragma once

#include <pkg/ddem/kernel/triangles/GroupOf.hpp>
#include <pkg/ddem/kernel/triangles/PathLeg.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace yade::ddem {

/// Drives a law along legs. Strains that the path leaves free are found in every step by Newton's method so that their
/// stresses meet the path within `stressTolerance`; a step that does not converge, or in which a free strain changes by
/// more than 2e-5, is halved.
template <class Law> class PointOf {
public:
	using State      = typename Law::template State<double>;
	using Properties = typename Law::template Properties<double>;

	/// The point at one instant.
	struct PathPoint {
		double                  time = 0; ///< [s]
		PlaneTensor             strain {}, stress {}; ///< [-], [Pa]
		EnergyDensities<double> energies {};          ///< [J/m³]; with the book only
		State                   state {};
	};

	/** \param effects mask of the law's effects.
	 * \param properties what a triangle would tell: pre-existing damage, fracture energy, factor of a crack
	 * band, area.
	 * \throws std::invalid_argument for a bad parameter, effect, damage or factor. */
	explicit PointOf(
	        const typename Law::Parameters& parameters = typename Law::Parameters(),
	        unsigned                        effects    = Law::allEffects,
	        const TriangleProperties&       properties = TriangleProperties())
	        : stressTolerance(2e-13 * ElasticModuli { parameters.bulk, parameters.shear }.planeWave())
	        , prepared_(parameters)
	        , effects_(effects)
	        , own_(Law::propertiesOf(prepared_, properties))
	{
		checkInitialDamage(properties.initialDamage);
		if (!(std::isfinite(properties.bandFactor) && properties.bandFactor > 0))
			throw std::invalid_argument(
			        "bandFactor = " + std::to_string(properties.bandFactor)
			        + " [-] must be a positive number; 1 leaves the fracture energy as it is.");
		withMask<Law>(effects, [](auto) {}); // refuses an unknown effect
		point_.state = Law::virgin(prepared_, properties);
	}

	/// Runs a leg and returns the point after every `every`-th step and at the end. Throws std::invalid_argument
	/// for a bad leg and std::runtime_error, with the time and the component, where no strain gives the stress
	/// asked for (more than the material bears). The point then stays where the last step that worked left it.
	std::vector<PathPoint> run(const PathLeg& leg, std::size_t every = 1)
	{
		leg.validate(every);
		const PathPoint  start  = point_;
		const Components target = componentsOf(leg.target), strain = componentsOf(start.strain),
		                 stress = componentsOf(start.stress);

		std::vector<PathPoint> points;
		points.reserve(leg.steps / every + 1);
		const double dt = leg.duration / static_cast<double>(leg.steps);
		for (std::size_t i = 1; i <= leg.steps; ++i) {
			const double share     = static_cast<double>(i) / static_cast<double>(leg.steps);
			Components   newStrain = componentsOf(point_.strain), newStress {};
			for (std::size_t k = 0; k < 4; ++k) {
				if (leg.control[k] == Control::Strain)
					newStrain[k] = strain[k] + share * (target[k] - strain[k]);
				else
					newStress[k] = stress[k] + share * (target[k] - stress[k]);
			}
			const PathPoint before = point_;
			if (!step(leg, newStrain, newStress, dt, 12)) {
				point_ = before;
				throw std::runtime_error(leg.notBorne(before.time, newStress));
			}
			point_.time = start.time + share * leg.duration;
			if (i % every == 0 || i == leg.steps) points.push_back(point_);
		}
		return points;
	}

	const PathPoint&               point() const { return point_; }
	const State&                   state() const { return point_.state; }
	double                         time() const { return point_.time; } ///< [s]
	const typename Law::Prepared&  prepared() const { return prepared_; }
	const Properties&              properties() const { return own_; }
	unsigned                       effects() const { return effects_; }

	double stressTolerance; ///< Largest error of a prescribed stress [Pa]; 2e-13 of the P-wave modulus unless set

private:
	using Components = std::array<double, 4>;

	/// Largest change of a free strain in one step [-]. Cracked concrete dilates, and a free strain may change ten
	/// times as fast as the driven one: the elastic predictor of a larger step opens a closed crack, and Newton's
	/// method then finds another strain with the stress asked for, 6 MPa away in what is driven.
	static constexpr double freeStrainLimit = 2e-5;

	PathPoint advanced(const PathPoint& from, const PlaneTensor& strain, double dt) const
	{
		PathPoint to = from;
		to.strain    = strain;
		withMask<Law>(effects_, [&](auto mask) {
			to.stress   = Law::template advance<mask()>(prepared_, own_, strain, dt, to.state);
			to.energies = Law::template energies<mask()>(prepared_, strain, to.stress, to.state);
		});
		return to;
	}

	bool step(const PathLeg& leg, const Components& strain, const Components& stress, double dt, int halvings)
	{
		std::size_t unknowns[4], count = 0;
		for (std::size_t k = 0; k < 4; ++k)
			if (leg.control[k] == Control::Stress) unknowns[count++] = k;

		const Components before = componentsOf(point_.strain);
		Components       now    = strain;
		for (std::size_t u = 0; u < count; ++u)
			now[unknowns[u]] = before[unknowns[u]] + freeRate_[unknowns[u]] * dt;

		using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 4, 1>;
		using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 4, 4>;
		PathPoint  trial;
		const auto residualAt = [&](const Components& at) {
	                trial                    = advanced(point_, tensorOf(at), dt);
	                const Components reached = componentsOf(trial.stress);
	                Vector           residual(static_cast<Eigen::Index>(count));
	                for (std::size_t u = 0; u < count; ++u)
	                        residual[Eigen::Index(u)] = reached[unknowns[u]] - stress[unknowns[u]];
	                return residual;
		};

		Vector residual  = residualAt(now);
		bool   converged = count == 0;
		for (int iteration = 0; iteration < 25 && !converged; ++iteration) {
			if (residual.cwiseAbs().maxCoeff() <= stressTolerance) {
				converged = true;
				break;
			}
			// differences small against the stress tolerance's strain, large against round-off
			constexpr double probe = 1e-9;
			Matrix           tangent(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(count));
			for (std::size_t u = 0; u < count; ++u) {
				Components shifted = now;
				shifted[unknowns[u]] += probe;
				tangent.col(Eigen::Index(u)) = (residualAt(shifted) - residual) / probe;
			}
			const Vector change = tangent.fullPivLu().solve(-residual);
			if (!change.allFinite()) break;
			// halve the correction until the residual falls:
			// the law has kinks where flow starts and cracks close
			double     scale = 1;
			Components next  = now;
			for (int search = 0; search < 12; ++search, scale *= 0.5) {
				for (std::size_t u = 0; u < count; ++u)
					next[unknowns[u]] = now[unknowns[u]] + scale * change[Eigen::Index(u)];
				const Vector tried = residualAt(next);
				if (tried.norm() < residual.norm() || search == 11) {
					residual = tried;
					break;
				}
			}
			now = next;
		}
		for (std::size_t u = 0; u < count && converged && halvings > 0; ++u)
			converged = std::abs(now[unknowns[u]] - before[unknowns[u]]) <= freeStrainLimit;
		if (converged) {
			residualAt(now); // leaves `trial` at the solution
			for (std::size_t k = 0; k < 4; ++k)
				freeRate_[k] = (now[k] - before[k]) / dt;
			trial.time = point_.time;
			point_     = trial;
			return true;
		}
		if (halvings == 0) return false;
		const Components from = componentsOf(point_.stress);
		Components       halfStrain, halfStress;
		for (std::size_t k = 0; k < 4; ++k) {
			halfStrain[k] = 0.5 * (before[k] + strain[k]);
			halfStress[k] = 0.5 * (from[k] + stress[k]);
		}
		return step(leg, halfStrain, halfStress, 0.5 * dt, halvings - 1)
		        && step(leg, strain, stress, 0.5 * dt, halvings - 1);
	}

	typename Law::Prepared prepared_;
	unsigned               effects_;
	Properties             own_;
	PathPoint              point_;
	Components             freeRate_ {}; // strain rate of the last step [1/s], the first guess of the next
};

} // namespace yade::ddem
