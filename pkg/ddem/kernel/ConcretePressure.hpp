// GPL v2 or later, see LICENSE.
// Equation of state of concrete: moduli that grow with pressure.
#pragma once

#include <pkg/ddem/kernel/ConcreteParameters.hpp>

#include <algorithm>

namespace yade {
namespace ddem {

	/*! B/B_0 = μ/μ_0 = 1 + (p/p_EOS)^n_EOS at a pressure [Pa]; 1 in tension (a fractional power of a negative pressure does not exist):
	Zubelewicz (2018), section 3. */
	inline double modulusFactorAt(const PreparedConcrete& concrete, double pressure)
	{
		return pressure > 0 ? 1 + concrete.eosPower(pressure / concrete.parameters.eosPressure) : 1;
	}

	/*! The same factor from the pressure [Pa] that the elastic strain gives with the reference moduli. The factor f multiplies that pressure too, so it
	solves f = 1 + (f a)^n, a = p_reference/p_EOS. Solving it makes the stress a function of the elastic strain alone: a factor taken from the step
	before lags behind the strain and feeds energy into every vibration. For n = 2/3 it is a cubic in (p/p_EOS)^(1/3), by Cardano; otherwise Newton's
	method, which converges for 0 < n < 1. */
	inline double modulusFactorOf(const PreparedConcrete& concrete, double referencePressure)
	{
		if (!(referencePressure > 0)) return 1;
		const double a = referencePressure / concrete.parameters.eosPressure;
		if (concrete.eosPower.isTwoThirds()) { // y³ − a y² − a = 0 with y = (f a)^(1/3); all terms positive, no cancellation
			const double third = a / 3, cube = third * third * third;
			const double u = std::cbrt(0.5 * a + cube + std::sqrt(0.25 * a * a + a * cube));
			const double y = third + u + third * third / u;
			return 1 + y * y;
		}
		// g = ln f solves g = ln(1 + exp(n (g + ln a))): g minus that is convex decreasing in its curvature, slope 1 − n s/(1+s) > 1 − n > 0
		const double n = concrete.parameters.eosExponent, logA = std::log(a);
		double       g = 0;
		for (int iteration = 0; iteration < 100; ++iteration) {
			const double s = std::exp(n * (g + logA));
			const double change = (std::log1p(s) - g) / (1 - n * s / (1 + s));
			g += change;
			if (std::abs(change) <= 1e-15 * (1 + g)) break;
		}
		return std::exp(g);
	}

	/*! Tangent bulk modulus over the reference one at a pressure [Pa], ≥ 1. With s = (p/p_EOS)^n: (1+s)²/(1+s−n s), above the secant factor 1+s.
	It bounds the isotropic tangent: the deviatoric coupling that a pressure-dependent shear modulus adds is triangular, so it leaves the eigenvalues
	alone. */
	inline double tangentFactorAt(const PreparedConcrete& concrete, double pressure)
	{
		const double factor = modulusFactorAt(concrete, pressure);
		return factor * factor / (factor - concrete.parameters.eosExponent * (factor - 1));
	}

} // namespace ddem
} // namespace yade
