// GPL v2 or later, see LICENSE.
// Equation of state of concrete: moduli that grow with pressure.
#pragma once

#include <pkg/ddem/kernel/laws/concrete/ConcreteParameters.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace yade::ddem {

/// Root s ≥ 0 of s = ((1 + s) a)^n for 0 < n < 1, a ≥ 0, by Newton's method; a batch goes one number at a time.
double solveStiffening(double n, double a);

template <class Batch> inline Batch solveStiffening(double n, const Batch& a)
{
	alignas(Batch) double lane[Batch::size];
	a.store_aligned(lane);
	for (double& value : lane)
		value = solveStiffening(n, value);
	return Batch::load_aligned(lane);
}

/// Stiffening s = B/B_0 − 1 = μ/μ_0 − 1 = (p/p_EOS)^n_EOS [-], Zubelewicz (2018), section 3, from the pressure [Pa]
/// that the elastic strain gives with the reference moduli; 0 in tension (a fractional power of a negative
/// pressure does not exist).
/// The pressure p itself is 1 + s times that one, so s = ((1 + s) a)^n with a = p_reference/p_EOS. Solving this makes
/// the stress a function of the elastic strain alone: a factor taken from the step before lags behind the strain and
/// feeds energy into every vibration. For n = 2/3 it is a cubic in (p/p_EOS)^(1/3), by Cardano.
/// Limit: moduli that depend on pressure but not through an energy are not conservative. A closed cycle of shear and
/// pressure gains or loses energy, either sign by its sense of rotation and none on average; in random cycles at
/// 0.1 p_EOS up to an eighth of the largest stored energy a cycle.
template <class Number>
inline Number modulusStiffening(const PreparedConcrete& concrete, const Number& referencePressure)
{
	using std::cbrt;
	using std::max;
	using std::sqrt;
	const Number a = max(referencePressure, Number(0)) * concrete.perEosPressure;
	// y³ − a y² − a = 0 with y = (p/p_EOS)^(1/3); all terms positive, no cancellation
	if (concrete.eosPower.isTwoThirds()) {
		const Number third = (1. / 3) * a, cube = third * third * third;
		const Number u = cbrt(0.5 * a + cube + sqrt(a * (0.25 * a + cube)));
		const Number y = third + u + select(u > 0, third * third / u, Number(0));
		return y * y;
	}
	return solveStiffening(concrete.parameters.eosExponent, a);
}

/// Tangent bulk modulus over the reference one, ≥ 1, at a stiffening s: (1+s)²/(1+s−n s), above the secant factor 1+s.
/// It bounds the tangent of pure changes of pressure. A change of pressure changes deviatoric stress as well, so that
/// the tangent is not symmetric; under shear of the size of the pressure frequencies can be 7 % higher, with little
/// pressure and much shear more. Flow keeps concrete from most such states.
inline double tangentFactor(const PreparedConcrete& concrete, double stiffening)
{
	const double factor = 1 + stiffening;
	return factor * factor / (factor - concrete.parameters.eosExponent * stiffening);
}

} // namespace yade::ddem
