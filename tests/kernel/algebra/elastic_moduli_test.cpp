// GPL v2 or later, see LICENSE.
// Isotropic elasticity: moduli, closed forms, bad moduli.
#include <pkg/ddem/kernel/algebra/ElasticModuli.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace {

using namespace yade::ddem;

const ElasticModuli concrete { 30e9, 26e9 }; // Zubelewicz (2018), Table 1

TEST(ElasticLaw, moduliConvertBothWays)
{
	EXPECT_NEAR(concrete.poisson(), (3 * 30. - 2 * 26) / (2 * (3 * 30 + 26)), 1e-15);
	const ElasticModuli again = ElasticModuli::fromYoung(concrete.young(), concrete.poisson());
	EXPECT_NEAR(again.bulk, 30e9, 1e-4);
	EXPECT_NEAR(again.shear, 26e9, 1e-4);
}

TEST(ElasticLaw, waveSpeedsOfConcrete) // c_0 5022, c_p 5191, c_s 3291 m/s for 2400 kg/m³: ρ c² = E, B + 4/3 μ, μ
{
	EXPECT_NEAR(std::sqrt(concrete.young() / 2400), 5022, 0.5);
	EXPECT_NEAR(std::sqrt(concrete.planeWave() / 2400), 5191, 0.5);
	EXPECT_NEAR(std::sqrt(concrete.shear / 2400), 3291, 0.5);
}

TEST(ElasticLaw, uniaxialStressFollowsYoungAndPoisson)
{
	const double      nu = concrete.poisson(), along = 1e-3;
	const PlaneTensor stress = elasticStress(
	        concrete.lambda(), 2 * concrete.shear, PlaneTensor { -nu * along, along, -nu * along, 0 });
	EXPECT_NEAR(stress.yy, concrete.young() * along, 1e-6);
	EXPECT_NEAR(stress.xx, 0, 1e-6);
	EXPECT_NEAR(stress.zz, 0, 1e-6);
}

TEST(ElasticLaw, pureShearAndPureVolume)
{
	// 2 μ ε_xy
	EXPECT_DOUBLE_EQ(elasticStress(concrete.lambda(), 2 * concrete.shear, PlaneTensor { 0, 0, 0, 1e-3 }).xy, 52e6);
	EXPECT_DOUBLE_EQ(
	        pressure(elasticStress(concrete.lambda(), 2 * concrete.shear, PlaneTensor { -1e-3, -1e-3, -1e-3, 0 })),
	        90e6);
}

TEST(ElasticLaw, energyIsHalfStressTimesStrain)
{
	const PlaneTensor strain { 1e-3, -2e-3, 0.4e-3, 0.7e-3 };
	const double      lambda = concrete.lambda(), twoShear = 2 * concrete.shear;
	EXPECT_NEAR(
	        elasticEnergy(lambda, twoShear, strain),
	        0.5 * doubleDot(elasticStress(lambda, twoShear, strain), strain), 1e-9);
}

TEST(ElasticLaw, badModuliAreRefusedWithValueAndUnit)
{
	const auto message = [](const auto& make) -> std::string {
		try {
			make();
		} catch (const std::invalid_argument& error) {
			return error.what();
		}
		return "";
	};
	EXPECT_NE(
	        message([] {
		        ElasticModuli { -1e9, 1e9 }.validate();
	        }).find("bulk modulus must be a positive number of pascals, got -1e+09 Pa"),
	        std::string::npos);
	EXPECT_NE(message([] { ElasticModuli { 1e9, 0 }.validate(); }).find("shear modulus"), std::string::npos);
	EXPECT_NE(message([] { ElasticModuli { NAN, 1e9 }.validate(); }).find("nan"), std::string::npos);
	EXPECT_NE(message([] { ElasticModuli { 1e9, INFINITY }.validate(); }).find("inf"), std::string::npos);
	EXPECT_NE(message([] { ElasticModuli { 1e14, 1e9 }.validate(); }).find("incompressible"), std::string::npos);
	for (const double poisson : { 0.5, 0.7, -1., double(NAN) })
		EXPECT_NE(
		        message([&] { ElasticModuli::fromYoung(30e9, poisson); }).find("Poisson's ratio"),
		        std::string::npos)
		        << poisson;
	EXPECT_NE(message([] { ElasticModuli::fromYoung(0, 0.2); }).find("Young's modulus"), std::string::npos);
	EXPECT_NO_THROW((ElasticModuli { 1000e9, 1e9 }.validate())); // B/μ = 1000 is a hard case, not an error
}

} // namespace
