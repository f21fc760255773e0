// GPL v2 or later, see LICENSE.
// Damage of concrete piece by piece: damage parameter, strength, growth, degraded elasticity, closing cracks.
#include "../ConcreteSamples.hpp"

#include <gtest/gtest.h>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::test;

const PreparedConcrete concrete;
const double           lambda = concrete.lambda, twoShear = concrete.twoShear;

PreparedConcrete with(double ConcreteParameters::* parameter, double value)
{
	ConcreteParameters parameters;
	parameters.*parameter = value;
	return PreparedConcrete(parameters);
}

TEST(ConcreteDamage, parameterFollowsTheNormOfTheTensor) // η_0 = Ω_D²/(1 + Ω_D²), up to the residual of 1e-6
{
	// Ω:Ω = 0.36 + 2·0.32 = 1
	const auto one = measureDamage(concrete, PlaneTensor { 0.6, 0, 0, 0.4 * std::sqrt(2.) });
	EXPECT_NEAR(one.integrity, 0.5, 1e-6);
	EXPECT_NEAR(norm(one.loss), 0.5, 1e-6);
	EXPECT_NEAR(measureDamage(concrete, PlaneTensor { 3, 0, 0, 0 }).integrity, 0.1, 1e-6);
	EXPECT_EQ(measureDamage(concrete, PlaneTensor { 0, 0, 0, 0 }).integrity, 1);
	EXPECT_EQ(norm(measureDamage(concrete, PlaneTensor { 0, 0, 0, 0 }).loss), 0);
	const auto cubic = measureDamage(with(&ConcreteParameters::damageExponent, 3), PlaneTensor { 0, 2, 0, 0 });
	EXPECT_NEAR(cubic.integrity, 1. / 9, 1e-6);
	EXPECT_NEAR(cubic.loss.yy, 8. / 9, 1e-6);
	const auto root = measureDamage(with(&ConcreteParameters::damageExponent, 0.5), PlaneTensor { 0, 4, 0, 0 });
	EXPECT_NEAR(root.integrity, 1. / 3, 1e-6);
}

TEST(ConcreteDamage, lossPointsAlongTheDamage)
{
	Random random(7);
	for (int i = 0; i < 200; ++i) {
		const PlaneTensor omega = random.damage(5);
		const auto        d     = measureDamage(concrete, omega);
		EXPECT_LT(norm(norm(d.loss) * omega - norm(omega) * d.loss), 1e-12);
		EXPECT_NEAR(norm(d.loss), 1 - d.integrity, 1e-14);
	}
}

TEST(ConcreteDamage, leavesTheResidualWhenComplete)
{
	for (const double n : { 2., 0.7, 9. })
		for (const double size : { 1e6, 1e100 }) { // η_0 from 1 − 1e-12 up to powers that overflow
			const auto d = measureDamage(
			        with(&ConcreteParameters::damageExponent, n), PlaneTensor { size, 0, 0, 0 });
			EXPECT_NEAR(d.integrity, 1e-6, 1e-4) << n;
			EXPECT_GE(d.integrity, 1e-6);
			EXPECT_LE(d.loss.xx, 1 - 1e-6);
		}
	EXPECT_NEAR(
	        measureDamage(with(&ConcreteParameters::residual, 1e-3), PlaneTensor { 1e9, 0, 0, 0 }).integrity, 1e-3,
	        1e-12);
}

TEST(ConcreteDamage, growthFollowsEquation8)
{
	const PlaneTensor direction { 1.66, 0, 0.34, 0.1 };
	const PlaneTensor open = damageGrowth(concrete, 80e3, direction, 1., 400.); // ½ M_c · 400/80e3
	EXPECT_LT(norm(open - 0.0025 * direction), 1e-16);
	// ξ_c0 = 0.5 in a closed crack
	EXPECT_LT(norm(damageGrowth(concrete, 80e3, direction, 0., 400.) - 0.5 * open), 1e-16);
	EXPECT_LT(norm(damageGrowth(concrete, 40e3, direction, 1., 400.) - 2. * open), 1e-16);
	// a drawn fracture energy that is no energy: very brittle, not NaN
	for (const double drawn : { 0., -3e3, double(NAN) })
		EXPECT_NEAR(damageGrowth(concrete, drawn, direction, 1., 400.).xx, 0.5 * 1.66 * 400 / 0.08, 1e-6);
}

TEST(ConcreteDamage, degradedStressIsTheTensorFormula) // λ Δ (Δ:ε) + 2μ Δ.ε.Δ with full matrices
{
	Random random(8);
	for (int i = 0; i < 300; ++i) {
		const PlaneTensor loss = measureDamage(concrete, random.damage(4)).loss, strain = random.tensor(1e-3);
		const double          effect = random.number(0, 1);
		const Eigen::Matrix3d delta = Eigen::Matrix3d::Identity() - effect * matrixOf(loss),
		                      e = matrixOf(strain);
		const Eigen::Matrix3d stress
		        = lambda * delta * (delta.array() * e.array()).sum() + twoShear * delta * e * delta;
		EXPECT_LT((matrixOf(degradedStress(lambda, twoShear, effect, loss, strain)) - stress).norm(), 1e-6);
	}
}

TEST(ConcreteDamage, degradedElasticityIsSymmetricAndPositive)
{
	Random random(9);
	for (int i = 0; i < 300; ++i) {
		const PlaneTensor loss = measureDamage(concrete, random.damage(1e3)).loss, a = random.tensor(1e-3),
		                  b  = random.tensor(1e-3);
		const PlaneTensor ca = degradedStress(lambda, twoShear, 1., loss, a),
		                  cb = degradedStress(lambda, twoShear, 1., loss, b);
		EXPECT_NEAR(doubleDot(ca, b), doubleDot(cb, a), 1e-10);
		EXPECT_GE(doubleDot(ca, a), -1e-12);
	}
}

TEST(ConcreteDamage, oneCrackLosesItsNormalAndShearStiffness)
{
	const PlaneTensor loss { 0, 0.8, 0, 0 };
	const PlaneTensor normal = degradedStress(lambda, twoShear, 1., loss, PlaneTensor { 0, 1e-3, 0, 0 });
	EXPECT_NEAR(normal.yy, (lambda + twoShear) * 0.04e-3, 1e-6); // (1 − η)²
	EXPECT_NEAR(normal.xx, lambda * 0.2e-3, 1e-6);
	EXPECT_NEAR(
	        degradedStress(lambda, twoShear, 1., loss, PlaneTensor { 0, 0, 0, 1e-3 }).xy, twoShear * 0.2e-3, 1e-6);
	// along: intact
	EXPECT_NEAR(
	        degradedStress(lambda, twoShear, 1., loss, PlaneTensor { 1e-3, 0, 0, 0 }).xx,
	        (lambda + twoShear) * 1e-3, 1e-6);
}

double normalStress(
        const PreparedConcrete& material, const DamageMeasure<double>& damage, const PlaneTensor& strain, double open)
{
	const PlaneTensor stress
	        = degradedStress(lambda, twoShear, stiffnessEffect(material, open), damage.loss, strain);
	return doubleDot(damage.loss, stress) / norm(damage.loss);
}

TEST(ConcreteCrack, opensInTensionAndClosesInCompression)
{
	const auto damage = measureDamage(concrete, PlaneTensor { 0, 2, 0, 0 });
	EXPECT_EQ(crackOpenness(concrete, damage, PlaneTensor { 0, 1e-4, 0, 0 }), 1);
	EXPECT_EQ(crackOpenness(concrete, damage, PlaneTensor { 0, 0, 0, 0 }), 1);
	EXPECT_EQ(crackOpenness(concrete, damage, PlaneTensor { 0, -1e-4, 0, 0 }), 0);
	EXPECT_EQ(
	        crackOpenness(
	                concrete, measureDamage(concrete, PlaneTensor { 0, 0, 0, 0 }), PlaneTensor { 0, -1e-4, 0, 0 }),
	        1)
	        << "no crack, none closed";
	EXPECT_DOUBLE_EQ(stiffnessEffect(concrete, 1.), 1);
	EXPECT_DOUBLE_EQ(stiffnessEffect(concrete, 0.), 0.1); // ξ_c1
}

TEST(ConcreteCrack, agreesWithItsOwnNormalStressWhereThatHasOneAnswer)
{
	const PreparedConcrete sharp = with(&ConcreteParameters::closureBand, 0);
	Random                 random(11);
	int                    compared = 0;
	for (int i = 0; i < 2000; ++i) {
		const auto        damage    = measureDamage(sharp, random.damage(4));
		const PlaneTensor strain    = random.tensor(1e-3);
		const bool staysOpen = normalStress(sharp, damage, strain, 1) >= 0,
		           staysClosed = normalStress(sharp, damage, strain, 0) < 0;
		if (staysOpen == staysClosed) continue; // both or neither
		++compared;
		EXPECT_EQ(crackOpenness(sharp, damage, strain), staysOpen ? 1 : 0);
	}
	EXPECT_GT(compared, 1500);
}

TEST(ConcreteCrack, closesOverTheBand)
{
	const PreparedConcrete banded = with(&ConcreteParameters::closureBand, 10e6);
	const auto             damage = measureDamage(banded, PlaneTensor { 0, 2, 0, 0 });
	// strain at σ_Ω = −10 MPa
	const double           full   = 10e6 / (std::pow(1 - 0.1 * norm(damage.loss), 2) * (lambda + twoShear));
	EXPECT_NEAR(crackOpenness(banded, damage, PlaneTensor { 0, -0.25 * full, 0, 0 }), 0.75, 1e-12);
	EXPECT_NEAR(crackOpenness(banded, damage, PlaneTensor { 0, -0.75 * full, 0, 0 }), 0.25, 1e-12);
	EXPECT_EQ(crackOpenness(banded, damage, PlaneTensor { 0, -1.01 * full, 0, 0 }), 0);
}

// a sheared crack that closes: without the band its shear stress jumps
TEST(ConcreteCrack, bandKeepsTheStressContinuous)
{
	const auto largestJump = [&](double band) {
		const PreparedConcrete material = with(&ConcreteParameters::closureBand, band);
		const auto             damage   = measureDamage(material, PlaneTensor { 0, 2, 0, 0 });
		PlaneTensor            last { 0, 0, 0, 0 };
		double                 jump = 0;
		for (int i = 0; i <= 4000; ++i) {
			const PlaneTensor strain { 0, 2e-4 - 1e-7 * i, 0, 1e-3 };
			const PlaneTensor stress = degradedStress(
			        lambda, twoShear, stiffnessEffect(material, crackOpenness(material, damage, strain)),
			        damage.loss, strain);
			if (i > 0) jump = std::max(jump, norm(stress - last));
			last = stress;
		}
		return jump;
	};
	EXPECT_GT(largestJump(0), 40e6);
	EXPECT_LT(largestJump(5e6), 0.1 * largestJump(0));
}

TEST(LocalisedDamage, isReachedAtTheSameDamageWithAnyResidualAndExponent)
{
	for (const double residual : { 1e-6, 0.2, 0.9 })
		for (const double exponent : { 1., 2., 3.5 }) {
			ConcreteParameters p;
			p.residual       = residual;
			p.damageExponent = exponent;
			const PreparedConcrete other(p);
			// Ω_D = 0.5
			EXPECT_NEAR(
			        other.localisedIntegrity,
			        measureDamage(other, PlaneTensor { 0.4, 0.3, 0, 0 }).integrity, 1e-15);
		}
}

} // namespace
