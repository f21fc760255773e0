// GPL v2 or later, see LICENSE.
// J2 plasticity against closed forms: uniaxial stress, plane strain, shear, cycles; consistency; plastic volume.
#include "../TriangleSamples.hpp"

#include <pkg/ddem/kernel/laws/VonMises.hpp>
#include <pkg/ddem/kernel/triangles/PointOf.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::samples;

using SteelPoint = PointOf<VonMises>;
constexpr auto e = Control::Strain, s = Control::Stress;

VonMises::Parameters steel(double hardening = 0)
{
	VonMises::Parameters p;
	p.hardening = hardening;
	return p;
}

const double     young   = ElasticModuli { 151e9, 81e9 }.young(); // steel 304L, Zubelewicz (2018)
const double     poisson = ElasticModuli { 151e9, 81e9 }.poisson();
constexpr double first   = 270e6; // [Pa] where it yields

PlaneTensor deviator(const PlaneTensor& t)
{
	const double mean = trace(t) / 3;
	return { t.xx - mean, t.yy - mean, t.zz - mean, t.xy };
}
double equivalent(const PlaneTensor& stress) { return std::sqrt(1.5) * norm(deviator(stress)); }

TEST(VonMises, uniaxialStressHasTheSlopesOfYoungAndOfHardening)
{
	for (const double hardening : { 0., 2e9, 50e9 })
		for (const double sign : { 1., -1. }) {
			SteelPoint   point(steel(hardening));
			const double yield = first / young, slope = young * hardening / (young + hardening);
			for (const auto& at : point.run({ { s, e, s, e }, { 0, sign * 5 * yield, 0, 0 }, 1, 500 })) {
				const double strain = std::abs(at.strain.yy);
				const double wanted
				        = strain < yield ? young * strain : first + slope * (strain - yield);
				EXPECT_NEAR(at.stress.yy, sign * wanted, 1e-9 * first)
				        << hardening << " Pa, strain " << at.strain.yy;
			}
		}
}

TEST(VonMises,
     uniaxialStrainYieldsWhereTheTextbookSays) // Hugoniot elastic limit σ_y (1 − ν)/(1 − 2ν), then the bulk modulus
{
	SteelPoint   point(steel());
	const double wave = 151e9 + 4. / 3 * 81e9, limit = first * (1 - poisson) / (1 - 2 * poisson);
	for (const auto& at : point.run({ { e, e, e, e }, { -0.01, 0, 0, 0 }, 1, 1000 })) {
		const double strain = -at.strain.xx;
		const double wanted = strain < limit / wave ? wave * strain : 151e9 * strain + 2. / 3 * first;
		EXPECT_NEAR(-at.stress.xx, wanted, 1e-9 * first) << strain;
	}
}

TEST(VonMises, planeStrainTensionYieldsWhereTheTextbookSays) // σ_y/√(1 − ν + ν²), and at last 2σ_y/√3
{
	SteelPoint   point(steel());
	const double limit = first / std::sqrt(1 - poisson + poisson * poisson);
	for (const auto& at : point.run({ { e, s, e, e }, { 0.05, 0, 0, 0 }, 1, 5000 }))
		if (at.stress.xx < limit * (1 - 1e-9)) EXPECT_EQ(at.state.accumulatedPlasticStrain, 0) << at.stress.xx;
		else
			EXPECT_GT(at.state.accumulatedPlasticStrain, 0) << at.stress.xx;
	EXPECT_NEAR(point.point().stress.xx, 2 / std::sqrt(3.) * first, 1e-6 * first);
	EXPECT_NEAR(point.point().stress.zz, 1 / std::sqrt(3.) * first, 1e-3 * first);
}

TEST(VonMises, shearYieldsAtAThirdRootOfTheYieldStress) // τ_y = σ_y/√3, then the slope μ (H/3)/(μ + H/3) over the angle
{
	const double hardening = 10e9, shear = 81e9, limit = first / std::sqrt(3.);
	SteelPoint   point(steel(hardening));
	for (const auto& at : point.run({ { e, e, e, e }, { 0, 0, 0, 0.005 }, 1, 500 })) {
		const double angle = 2 * at.strain.xy, rest = angle - limit / shear;
		const double wanted
		        = rest < 0 ? shear * angle : limit + shear * hardening / 3 / (shear + hardening / 3) * rest;
		EXPECT_NEAR(at.stress.xy, wanted, 1e-9 * first) << angle;
		EXPECT_NEAR(at.stress.xx, 0, 1e-9 * first);
	}
}

// The elastic range is twice what was reached, on both sides, and grows in every half cycle.
TEST(VonMises, cyclesHardenIsotropically)
{
	const double hardening = 5e9, amplitude = 0.006;
	SteelPoint   point(steel(hardening));
	double       reached = first;
	for (int half = 0; half < 8; half++) {
		const double sign = half % 2 ? -1 : 1, from = point.point().strain.yy,
		             alpha       = point.state().accumulatedPlasticStrain;
		const double elasticPart = (half ? 2 * reached : reached) / young;
		const double now         = reached
		        + young * hardening / (young + hardening) * (std::abs(sign * amplitude - from) - elasticPart);
		point.run({ { s, e, s, e }, { 0, sign * amplitude, 0, 0 }, 1, 1200 });
		EXPECT_NEAR(point.point().stress.yy, sign * now, 1e-9 * first) << half;
		EXPECT_NEAR(point.state().accumulatedPlasticStrain - alpha, (now - reached) / hardening, 1e-12) << half;
		reached = now;
	}
}

TEST(VonMises, endsEveryStepOnTheYieldSurfaceWithoutPlasticVolume) // on random paths of any step
{
	samples::Random random(6);
	for (const double hardening : { 0., 3e9 })
		for (const double size : { 5e-4, 2e-3, 1e-1 }) {
			SteelPoint point(steel(hardening));
			int        yielded = 0;
			for (int i = 0; i < 300; i++) {
				const auto   c     = [&] { return random.uniform(-size, size); };
				const double alpha = point.state().accumulatedPlasticStrain;
				point.run({ { e, e, e, e },
				            point.point().strain + PlaneTensor { c(), c(), c(), c() },
				            1,
				            1 });
				const auto&  now   = point.point();
				const double limit = first + hardening * now.state.accumulatedPlasticStrain;
				// round-off of the strain's own stress
				const double tolerance = 1e-14 * (first + 162e9 * norm(now.strain));
				EXPECT_LE(equivalent(now.stress), limit + tolerance);
				if (now.state.accumulatedPlasticStrain > alpha) {
					yielded++;
					EXPECT_NEAR(equivalent(now.stress), limit, tolerance);
				}
				EXPECT_NEAR(trace(now.state.plasticStrain), 0, 1e-15 * (1 + 300 * size));
			}
			EXPECT_GT(yielded, 30) << size;
		}
}

TEST(VonMises, plasticWorkIsTheYieldStressTimesThePlasticStrain) // ∫σ dε_p = σ_y α + ½ H α²
{
	const double hardening = 5e9;
	SteelPoint   point(steel(hardening));
	point.run({ { s, e, s, e }, { 0, first / young, 0, 0 }, 1, 10 });
	const auto   now   = point.run({ { s, e, s, e }, { 0, 0.01, 0, 0 }, 1, 1000 }).back();
	const double alpha = now.state.accumulatedPlasticStrain;
	EXPECT_NEAR(now.energies.plastic, first * alpha + 0.5 * hardening * alpha * alpha, 1e-7 * now.energies.plastic);
	EXPECT_NEAR(now.energies.stored, now.stress.yy * now.stress.yy / (2 * young), 1e-9 * now.energies.stored);
	EXPECT_EQ(now.energies.damage, 0);
}

TEST(VonMises, isElasticBitByBitBelowTheYieldStress)
{
	SteelPoint      point(steel());
	samples::Random random(7);
	for (int i = 0; i < 200; i++) {
		const auto c = [&] { return random.uniform(-3e-4, 3e-4); };
		point.run({ { e, e, e, e }, { c(), c(), 0, c() }, 1, 1 });
		const auto& law = point.prepared();
		const auto& now = point.point();
		EXPECT_EQ(componentsOf(now.stress), componentsOf(elasticStress(law.lambda, law.twoShear, now.strain)));
	}
}

} // namespace
