// GPL v2 or later, see LICENSE.
// Material-point driver: Newton's method on the strains that a path leaves free.
#include <pkg/ddem/kernel/laws/MaterialPoint.hpp>

#include <Eigen/LU>

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace yade::ddem {

namespace {
	using Components = std::array<double, 4>;

	constexpr const char* names[] = { "xx", "yy", "zz", "xy" };

	/// Largest change of a free strain in one step [-]. Cracked concrete dilates, and a free strain may change ten times as fast as the driven one: the elastic
	/// predictor of a larger step opens a closed crack, and Newton's method then finds another strain with the stress asked for, 6 MPa away in what is driven.
	constexpr double freeStrainLimit = 2e-5;

	Components  componentsOf(const PlaneTensor& t) { return { { t.xx, t.yy, t.zz, t.xy } }; }
	PlaneTensor tensorOf(const Components& c) { return { c[0], c[1], c[2], c[3] }; }

	bool isFinite(const PlaneTensor& t) { return std::isfinite(t.xx) && std::isfinite(t.yy) && std::isfinite(t.zz) && std::isfinite(t.xy); }

	void checkDamage(const PlaneTensor& damage)
	{
		const bool semiDefinite = damage.xx >= 0 && damage.yy >= 0 && damage.zz >= 0 && damage.xx * damage.yy >= damage.xy * damage.xy;
		if (semiDefinite && isFinite(damage)) return;
		std::ostringstream message;
		message << "pre-existing damage (xx, yy, zz, xy) = (" << damage.xx << ", " << damage.yy << ", " << damage.zz << ", " << damage.xy
		        << ") [-] must be finite and positive semi-definite: diagonal at least 0 and xy² at most xx yy.";
		throw std::invalid_argument(message.str());
	}

	void checkLeg(const PathLeg& leg, std::size_t every)
	{
		if (!(std::isfinite(leg.duration) && leg.duration > 0))
			throw std::invalid_argument("path: duration must be a positive number of seconds, got " + std::to_string(leg.duration) + " s.");
		if (leg.steps == 0 || every == 0) throw std::invalid_argument("path: the number of steps and of steps per record must be at least 1.");
		if (!isFinite(leg.target)) throw std::invalid_argument("path: a target is not a finite number.");
	}
}

MaterialPoint::MaterialPoint(const ConcreteParameters& parameters, unsigned effects, const PlaneTensor& damage, double bandFactor)
        : stressTolerance(1e-10 * parameters.strength)
        , concrete_(parameters)
        , fractureEnergy_(parameters.fractureEnergy, parameters.fractureEnergy * bandFactor)
        , update_(concreteUpdate(effects))
        , point_ {}
        , freeRate_ {}
{
	checkDamage(damage);
	if (!(std::isfinite(bandFactor) && bandFactor > 0))
		throw std::invalid_argument("bandFactor = " + std::to_string(bandFactor) + " [-] must be a positive number; 1 leaves the fracture energy as it is.");
	point_.state.damage = damage;
}

std::vector<PathPoint> MaterialPoint::run(const PathLeg& leg, std::size_t every)
{
	checkLeg(leg, every);
	const PathPoint  start  = point_;
	const Components target = componentsOf(leg.target), strain = componentsOf(start.state.strain), stress = componentsOf(start.state.stress);

	std::vector<PathPoint> points;
	points.reserve(leg.steps / every + 1);
	const double dt = leg.duration / static_cast<double>(leg.steps);
	for (std::size_t i = 1; i <= leg.steps; ++i) {
		const double share     = static_cast<double>(i) / static_cast<double>(leg.steps);
		Components   newStrain = componentsOf(point_.state.strain), newStress {};
		for (int k = 0; k < 4; ++k) {
			if (leg.control[k] == Control::Strain) newStrain[k] = strain[k] + share * (target[k] - strain[k]);
			else
				newStress[k] = stress[k] + share * (target[k] - stress[k]);
		}
		const PathPoint before = point_;
		if (!step(leg, newStrain, newStress, dt, 12)) {
			point_ = before;
			std::ostringstream message;
			message << "path: at " << point_.time << " s no strain gives the prescribed stress of";
			for (int k = 0; k < 4; ++k)
				if (leg.control[k] == Control::Stress) message << " " << names[k] << " = " << newStress[k] << " Pa";
			message << "; the material bears less. Prescribe a strain there, or a smaller stress.";
			throw std::runtime_error(message.str());
		}
		point_.time = start.time + share * leg.duration;
		if (i % every == 0 || i == leg.steps) points.push_back(point_);
	}
	return points;
}

bool MaterialPoint::step(const PathLeg& leg, const Components& strain, const Components& stress, double dt, int halvings)
{
	int unknowns[4], count = 0;
	for (int k = 0; k < 4; ++k)
		if (leg.control[k] == Control::Stress) unknowns[count++] = k;

	const Components before = componentsOf(point_.state.strain);
	Components       now    = strain;
	for (int u = 0; u < count; ++u)
		now[unknowns[u]] = before[unknowns[u]] + freeRate_[unknowns[u]] * dt;

	using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 4, 1>;
	using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 4, 4>;
	ConcreteState trial;
	const auto    residualAt = [&](const Components& at) {
                trial = point_.state;
                update_(concrete_, fractureEnergy_, tensorOf(at), dt, trial);
                const Components reached = componentsOf(trial.stress);
                Vector           residual(count);
                for (int u = 0; u < count; ++u)
                        residual[u] = reached[unknowns[u]] - stress[unknowns[u]];
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
		Matrix           tangent(count, count);
		for (int u = 0; u < count; ++u) {
			Components shifted = now;
			shifted[unknowns[u]] += probe;
			tangent.col(u) = (residualAt(shifted) - residual) / probe;
		}
		const Vector change = tangent.fullPivLu().solve(-residual);
		if (!change.allFinite()) break;
		// halve the correction until the residual falls: the law has kinks where flow starts and cracks close
		double     scale = 1;
		Components next  = now;
		for (int search = 0; search < 12; ++search, scale *= 0.5) {
			for (int u = 0; u < count; ++u)
				next[unknowns[u]] = now[unknowns[u]] + scale * change[u];
			const Vector tried = residualAt(next);
			if (tried.norm() < residual.norm() || search == 11) {
				residual = tried;
				break;
			}
		}
		now = next;
	}
	for (int u = 0; u < count && converged && halvings > 0; ++u)
		converged = std::abs(now[unknowns[u]] - before[unknowns[u]]) <= freeStrainLimit;
	if (converged) {
		residualAt(now); // leaves `trial` at the solution
		for (int k = 0; k < 4; ++k)
			freeRate_[k] = (now[k] - before[k]) / dt;
		point_.state = trial;
		return true;
	}
	if (halvings == 0) return false;
	const Components from = componentsOf(point_.state.stress);
	Components       halfStrain, halfStress;
	for (int k = 0; k < 4; ++k) {
		halfStrain[k] = 0.5 * (before[k] + strain[k]);
		halfStress[k] = 0.5 * (from[k] + stress[k]);
	}
	return step(leg, halfStrain, halfStress, 0.5 * dt, halvings - 1) && step(leg, strain, stress, 0.5 * dt, halvings - 1);
}

} // namespace yade::ddem
