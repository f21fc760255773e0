// GPL v2 or later, see LICENSE.
// Bound on the time step of particles joined by bonds, contacts and walls.
#include <pkg/bonded/kernel/BondStableStep.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace yade::ddem {

namespace {

	struct Stiffness {
		double translation = 0, rotation = 0;
	};

	Stiffness ofFirst(const PairSpring& s)
	{
		return { std::max(s.normal, s.shear), std::max(s.bending, s.torsion) + s.shear * s.arm1 * s.arm1 };
	}
	Stiffness ofSecond(const PairSpring& s)
	{
		return { std::max(s.normal, s.shear), std::max(s.bending, s.torsion) + s.shear * s.arm2 * s.arm2 };
	}

	/// What a particle gives to one spring: 1/mass and 1/inertia of its share.
	struct Mobility {
		double translation = 0, rotation = 0;
	};

	Mobility share(const ParticleMass& particle, const Stiffness& own, const Stiffness& all)
	{
		Mobility result;
		if (own.translation > 0) result.translation = all.translation / (own.translation * particle.mass);
		if (own.rotation > 0) result.rotation = all.rotation / (own.rotation * particle.inertia);
		return result;
	}

	/// Square of the highest circular frequency of a single pair [1/s²].
	double highestEigenvalue(const PairSpring& s, const Mobility& a, const Mobility& b)
	{
		const double translation = a.translation + b.translation, rotation = a.rotation + b.rotation;
		// Shear and bending of one plane meet in the rotations: γ = u2 - u1 - arm1 φ1 - arm2 φ2, κ = φ2 - φ1.
		const double shear
		        = s.shear * (translation + s.arm1 * s.arm1 * a.rotation + s.arm2 * s.arm2 * b.rotation);
		const double bending  = s.bending * rotation;
		const double coupling = s.arm1 * a.rotation - s.arm2 * b.rotation;
		const double plane    = 0.5 * (shear + bending)
		        + std::hypot(0.5 * (shear - bending), std::sqrt(s.shear * s.bending) * coupling);
		return std::max({ s.normal * translation, s.torsion * rotation, plane });
	}

} // namespace

double stableStep(
        const std::vector<ParticleMass>& particles, const std::vector<PairSpring>& springs, const PairSpring** ruling)
{
	std::vector<Stiffness> total(particles.size());
	const auto             add = [&total](int particle, const Stiffness& stiffness) {
                if (particle < 0) return;
                Stiffness& sum = total[static_cast<std::size_t>(particle)];
                sum.translation += stiffness.translation;
                sum.rotation += stiffness.rotation;
	};
	for (const PairSpring& spring : springs) {
		add(spring.first, ofFirst(spring));
		add(spring.second, ofSecond(spring));
	}
	const auto mobility = [&](int particle, const Stiffness& own) {
		const auto place = static_cast<std::size_t>(particle);
		return particle < 0 ? Mobility() : share(particles[place], own, total[place]);
	};
	double highest = 0;
	for (const PairSpring& spring : springs) {
		const double own = highestEigenvalue(
		        spring, mobility(spring.first, ofFirst(spring)), mobility(spring.second, ofSecond(spring)));
		if (!(own > highest)) continue;
		highest = own;
		if (ruling) *ruling = &spring;
	}
	return highest > 0 ? 2 / std::sqrt(highest) : std::numeric_limits<double>::infinity();
}

double dampedStableStep(double undamped, double ofDampers)
{
	if (!std::isfinite(ofDampers)) return undamped;
	const double rate = 4 / (ofDampers * ofDampers), squared = 4 / (undamped * undamped);
	return (std::sqrt(rate * rate + 4 * squared) - rate) / squared;
}

} // namespace yade::ddem
