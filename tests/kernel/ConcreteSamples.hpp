// GPL v2 or later, see LICENSE.
// What the tests of the concrete law share: random tensors, rotated axes, full 3×3 matrices.
#pragma once

#include <pkg/ddem/kernel/laws/ConcreteDamage.hpp>
#include <pkg/ddem/kernel/triangles/PointOf.hpp>

#include <Eigen/Dense>

#include <cmath>
#include <random>

namespace yade::ddem::test {

using MaterialPoint = PointOf<ConcreteDamage>;
using PathPoint     = MaterialPoint::PathPoint;

/// advanceConcrete for a mask known at run time.
using ConcreteUpdate = void (*)(
        const PreparedConcrete&, const FractureEnergyOf<double>&, const PlaneTensor& strain, double dt, ConcreteState&);
inline ConcreteUpdate concreteUpdate(unsigned effects)
{
	return withMask<ConcreteDamage>(
	        effects, [](auto mask) -> ConcreteUpdate { return &advanceConcrete<mask(), double>; });
}

inline Eigen::Matrix3d matrixOf(const PlaneTensor& t)
{
	Eigen::Matrix3d m;
	m << t.xx, t.xy, 0, t.xy, t.yy, 0, 0, 0, t.zz;
	return m;
}

using yade::ddem::tensorOf;
inline PlaneTensor tensorOf(const Eigen::Matrix3d& m)
{
	return { m(0, 0), m(1, 1), m(2, 2), 0.5 * (m(0, 1) + m(1, 0)) };
}

inline double distance(const PlaneTensor& a, const PlaneTensor& b) { return norm(a - b); }

/// Components in axes turned by `angle` about z.
inline PlaneTensor turned(const PlaneTensor& t, double angle)
{
	const Eigen::Matrix3d r = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
	return tensorOf(r.transpose() * matrixOf(t) * r);
}

inline bool isFinite(const PlaneTensor& t) { return std::isfinite(t.xx + t.yy + t.zz + t.xy); }

inline bool isFinite(const ConcreteState& s)
{
	return isFinite(s.stress) && isFinite(s.strain) && isFinite(s.plasticStrain) && isFinite(s.damage)
	        && std::isfinite(s.stiffening + s.plasticDissipation + s.damageDissipation + s.stiffeningEnergy);
}

/// Repeatable random numbers and tensors.
class Random {
public:
	explicit Random(unsigned seed)
	        : engine_(seed)
	{
	}
	double      number(double from, double to) { return std::uniform_real_distribution<double>(from, to)(engine_); }
	double      logarithmic(double from, double to) { return std::exp(number(std::log(from), std::log(to))); }
	PlaneTensor tensor(double size)
	{
		return { number(-size, size), number(-size, size), number(-size, size), number(-size, size) };
	}
	/// Positive semi-definite, as a damage tensor is.
	PlaneTensor damage(double size)
	{
		const PlaneTensor a = tensor(1);
		return (number(0, size))*symmetricProduct(a, a);
	}

private:
	std::mt19937_64 engine_;
};

/// A smooth random strain path of the given amplitude, starting from zero; the parameter runs from 0 to 1.
class RandomPath {
public:
	RandomPath(Random& random, double amplitude, bool planeStrain)
	{
		for (int wave = 0; wave < 3; ++wave) {
			amplitudes_[wave] = random.tensor(amplitude / 3);
			if (planeStrain) amplitudes_[wave].zz = 0;
			phases_[wave]      = random.number(0, 6.28);
			frequencies_[wave] = random.number(1, 12);
		}
	}
	PlaneTensor at(double t) const
	{
		PlaneTensor strain { 0, 0, 0, 0 };
		for (int wave = 0; wave < 3; ++wave)
			strain = strain
			        + (std::sin(frequencies_[wave] * t + phases_[wave]) - std::sin(phases_[wave]))
			                * amplitudes_[wave];
		return strain;
	}

private:
	PlaneTensor amplitudes_[3];
	double      phases_[3], frequencies_[3];
};

} // namespace yade::ddem::test
