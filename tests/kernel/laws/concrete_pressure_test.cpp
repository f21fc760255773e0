// GPL v2 or later, see LICENSE.
// Equation of state: the factor it solves for, its tangent, and that a pressure cycle gives back its energy.
#include "../ConcreteSamples.hpp"

#include <gtest/gtest.h>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::test;

PreparedConcrete withExponent(double n)
{
	ConcreteParameters parameters;
	parameters.eosExponent = n;
	return PreparedConcrete(parameters);
}

TEST(ConcretePressure, factorFollowsItsOwnPressure) // B = B_0 [1 + (p/p_EOS)^n] at p = B/B_0 · reference pressure
{
	for (const double n : { 2. / 3, 0.5, 0.25, 0.9 }) {
		const PreparedConcrete concrete = withExponent(n);
		for (const double reference : { 1., 1e5, 3e7, 1.1e9, 4e10 }) {
			const double stiffening = modulusStiffening(concrete, reference);
			EXPECT_NEAR(stiffening, std::pow((1 + stiffening) * reference / 1.1e9, n), 1e-12 * stiffening)
			        << "n " << n << " p " << reference;
		}
	}
}

TEST(ConcretePressure, doublesTheModuliAtItsPressure)
{
	EXPECT_NEAR(modulusStiffening(PreparedConcrete(), 0.55e9), 1, 1e-14); // p = 2·0.55 GPa = p_EOS
}

TEST(ConcretePressure, doesNothingInTension)
{
	for (const double n : { 2. / 3, 0.4 })
		for (const double p : { 0., -1e-300, -1e6, -1e12 })
			EXPECT_EQ(modulusStiffening(withExponent(n), p), 0);
}

TEST(ConcretePressure, tangentFactorIsTheSlope)
{
	const PreparedConcrete concrete;
	const auto             pressureAt
	        = [&](double reference) { return reference * (1 + modulusStiffening(concrete, reference)); };
	for (const double reference : { 1e6, 1e8, 1e9 }) {
		const double h     = 1e-5 * reference,
		             slope = (pressureAt(reference + h) - pressureAt(reference - h)) / (2 * h);
		EXPECT_NEAR(tangentFactor(concrete, modulusStiffening(concrete, reference)), slope, 1e-8 * slope);
	}
	EXPECT_EQ(tangentFactor(concrete, 0), 1);
}

TEST(ConcretePressure, cycleReturnsStressAndEnergy)
{
	const PreparedConcrete concrete;
	const auto             update = concreteUpdate(ConcreteEffects::EquationOfState | ConcreteEffects::Energy);
	ConcreteState          state {};
	double                 deepest = 0, work = 0;
	const int              steps = 2000;
	for (int i = 1; i <= steps; ++i) {
		const double        strain = -0.01 * std::sin(M_PI * i / steps);
		const ConcreteState before = state;
		update(concrete, 80e3, { strain, strain, strain, 0 }, 1e-6, state);
		work += 0.5 * doubleDot(before.stress + state.stress, state.strain - before.strain);
		if (i == steps / 2) deepest = storedEnergy(state);
	}
	EXPECT_LT(norm(state.stress), 1e-3);
	EXPECT_NEAR(storedEnergy(state), work, 1e-12 * deepest);
	// the trapezoidal sums of loading and unloading cancel
	EXPECT_LT(std::abs(storedEnergy(state)), 1e-10 * deepest);
	// ∫ p dθ with p = B_0 θ f: by Simpson's rule over the exact curve
	double       integral   = 0;
	const double end        = 0.03;
	const auto   pressureAt
	        = [&](double theta) { return 30e9 * theta * (1 + modulusStiffening(concrete, 30e9 * theta)); };
	for (int i = 0; i < 1000; ++i) {
		const double a = end * i / 1000, b = end * (i + 1) / 1000;
		integral += (b - a) / 6 * (pressureAt(a) + 4 * pressureAt(0.5 * (a + b)) + pressureAt(b));
	}
	EXPECT_NEAR(deepest, integral, 1e-5 * integral);
}

TEST(ConcretePressure, stiffnessFactorOfAState)
{
	const PreparedConcrete concrete;
	ConcreteState          state {};
	EXPECT_EQ(stiffnessFactor(concrete, state), 1);
	concreteUpdate(ConcreteEffects::All)(concrete, 80e3, { -0.01, -0.01, -0.01, 0 }, 1e-6, state);
	EXPECT_NEAR(state.stiffening, std::pow(pressure(state.stress) / 1.1e9, 2. / 3), 1e-12);
	EXPECT_GT(stiffnessFactor(concrete, state), 1 + state.stiffening);
	concreteUpdate(ConcreteEffects::All)(concrete, 80e3, { 0.01, 0.01, 0.01, 0 }, 1e-6, state);
	EXPECT_EQ(stiffnessFactor(concrete, state), 1);
}

} // namespace
