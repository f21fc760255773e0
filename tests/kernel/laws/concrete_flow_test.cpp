// GPL v2 or later, see LICENSE.
// Flow of concrete piece by piece: friction, flow tensors, rate factor, and the implicit solve against a root finder.
#include "../ConcreteSamples.hpp"

#include <boost/math/tools/toms748_solve.hpp>
#include <gtest/gtest.h>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::test;

const PreparedConcrete concrete;
constexpr double       tolerance = 0.05;

TEST(ConcreteFriction, decaysWithPressure)
{
	EXPECT_DOUBLE_EQ(frictionAt(concrete, 0.), 0.66);
	EXPECT_DOUBLE_EQ(frictionAt(concrete, -50e6), 0.66); // constant in tension
	EXPECT_NEAR(frictionAt(concrete, 600e6), 0.66 / std::sqrt(2), 1e-15);
	EXPECT_NEAR(frictionAt(concrete, 1800e6), 0.33, 1e-15);
	ConcreteParameters constant;
	constant.frictionPressureExponent = 0;
	EXPECT_DOUBLE_EQ(frictionAt(PreparedConcrete(constant), 600e6), 0.66);
}

TEST(ConcreteFlow, tensorsHaveTheSameSquare) // Zubelewicz (2018), after eq. 8: (M_p)² = (M_c)²
{
	Random random(5);
	for (int i = 0; i < 300; ++i) {
		const auto p = principalStresses(random.tensor(50e6), 1e-9);
		const auto a = flowTensor(p, 0.66), b = damageTensor(p, 0.66);
		EXPECT_LT(norm(symmetricProduct(a, a) - symmetricProduct(b, b)), 1e-12);
	}
}

TEST(ConcreteFlow, equivalentStressOfSimpleStates)
{
	const double s = 10e6, q = 0.66;
	const auto eq = [&](const PlaneTensor& stress) {
		return equivalentStress(flowTensor(principalStresses(stress, tolerance), q), stress);
	};
	EXPECT_NEAR(eq({ 0, s, 0, 0 }), 0.5 * (1 + q) * s, 1e-6); // tension
	// compression: 1 : (1+q)/(1−q) is the ratio of strengths
	EXPECT_NEAR(eq({ 0, -s, 0, 0 }), 0.5 * (1 - q) * s, 1e-6);
	EXPECT_NEAR(eq({ 0, 0, 0, s }), s, 1e-6);                  // shear: ½[(1+q) s + (1−q) s]
	EXPECT_NEAR(eq({ s, s, s, 0 }), q * s, 1e-6);              // equal tension
	EXPECT_NEAR(eq({ -s, -s, -s, 0 }), -q * s, 1e-6);          // pressure: no flow
}

TEST(ConcreteFlow, dilatesWithFriction) // tr M_p = 2 q
{
	const auto p = principalStresses(PlaneTensor { 3e6, -8e6, 1e6, 2e6 }, tolerance);
	EXPECT_NEAR(trace(flowTensor(p, 0.66)), 1.32, 1e-14);
	EXPECT_NEAR(trace(damageTensor(p, 0.66)), 2, 1e-14);
}

TEST(ConcreteFlow, rateFactor)
{
	EXPECT_DOUBLE_EQ(rateFactor<true>(concrete, 1.), 6.7);
	EXPECT_NEAR(rateFactor<true>(concrete, 1e3), 6.7 * std::pow(1e3, 0.96), 1e-9);
	EXPECT_DOUBLE_EQ(rateFactor<false>(concrete, 1e3), 6.7e3);
	EXPECT_EQ(rateFactor<true>(concrete, 0.), 0);
	// √(½·2·5²): half the engineering shear rate
	EXPECT_DOUBLE_EQ(strainRateMeasure(PlaneTensor { 0, 0, 0, 5 }), 5);
	ConcreteParameters minutes; // the same law with another time scale: ė_0^(1−ω) enters
	minutes.referenceRate = 1. / 60;
	EXPECT_NEAR(rateFactor<true>(PreparedConcrete(minutes), 1.), 6.7 / 60 * std::pow(60, 0.96), 1e-12);
}

/// The root by an independent, bracketing method, in y = x/trial for a good scale.
double referenceRoot(double n, double trial, double relaxation, double strength)
{
	const auto f = [&](double y) { return y - 1 + relaxation / trial * std::pow(y * trial / strength, n); };
	if (f(1) == 0) return trial;
	std::uintmax_t iterations = 500;
	const auto bracket = boost::math::tools::toms748_solve(
	        f, 0., 1., boost::math::tools::eps_tolerance<double>(52), iterations);
	return trial * 0.5 * (bracket.first + bracket.second);
}

TEST(ConcreteFlowSolve, agreesWithRootFinder)
{
	Random random(6);
	for (const double n : { 0.5, 1., 0.2, 0.35, 0.8, 1.7, 3., 8. })
		for (int i = 0; i < 300; ++i) {
			const double strength = random.logarithmic(1e3, 1e9), trial = random.logarithmic(1, 1e10),
			             relaxation = random.logarithmic(1e-3, 1e13);
			const auto   solution  = solveFlow(Power(n), trial, relaxation, strength);
			const double reference = referenceRoot(n, trial, relaxation, strength);
			EXPECT_NEAR(solution.equivalent, reference, 1e-11 * reference + 1e-15 * trial)
			        << "n " << n << " trial " << trial << " relaxation " << relaxation;
			EXPECT_GE(solution.equivalent, 0);
			EXPECT_LE(solution.equivalent, trial * (1 + 1e-15));
			const double intensity = std::pow(solution.equivalent / strength, n);
			EXPECT_NEAR(solution.intensity, intensity, 1e-11 * intensity);
		}
}

TEST(ConcreteFlowSolve, limits)
{
	for (const double n : { 0.5, 1., 0.3, 2.5 }) {
		EXPECT_DOUBLE_EQ(solveFlow(Power(n), 5e6, 0., 140e6).equivalent, 5e6) << "no time, no relaxation";
		EXPECT_LT(solveFlow(Power(n), 5e6, 1e30, 140e6).equivalent, 1) << "ages relax everything";
		const auto vanishing = solveFlow(Power(n), 5e6, 1e6, 1e-9); // strength of complete damage
		EXPECT_TRUE(std::isfinite(vanishing.equivalent) && std::isfinite(vanishing.intensity));
		EXPECT_GE(vanishing.equivalent, 0);
	}
}

} // namespace
