// GPL v2 or later, see LICENSE.
// Parameters of concrete: the tables, every bad value, powers.
#include <pkg/ddem/kernel/laws/concrete/ConcreteParameters.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace {

using namespace yade::ddem;
using Parameter = double ConcreteParameters::*;

std::string complaint(Parameter parameter, double value)
{
	ConcreteParameters parameters;
	parameters.*parameter = value;
	try {
		PreparedConcrete prepared(parameters);
	} catch (const std::invalid_argument& error) {
		return error.what();
	}
	return "";
}

TEST(ConcreteParameters, defaultsAreTheTables) // Zubelewicz (2018), Tables 1 and 2
{
	const ConcreteParameters c;
	EXPECT_EQ(c.bulk, 30e9);
	EXPECT_EQ(c.shear, 26e9);
	EXPECT_EQ(c.rotationStiffness, 2);
	EXPECT_EQ(c.density, 2400);
	EXPECT_EQ(c.eosPressure, 1.1e9);
	EXPECT_DOUBLE_EQ(c.eosExponent, 2. / 3);
	EXPECT_EQ(c.strength, 140e6);
	EXPECT_EQ(c.flowFactor, 6.7);
	EXPECT_EQ(c.flowExponent, 0.5);
	EXPECT_EQ(c.rateExponent, 0.96);
	EXPECT_EQ(c.frictionPressure, 600e6);
	EXPECT_EQ(c.frictionPressureExponent, 0.5);
	EXPECT_EQ(c.friction, 0.66);
	EXPECT_EQ(c.closedGrowth, 0.5);
	EXPECT_EQ(c.closedEffect, 0.1);
	EXPECT_EQ(c.fractureEnergy, 80e3);
	EXPECT_EQ(c.damageExponent, 2);
	EXPECT_NO_THROW(c.validate());
}

struct BadValue {
	const char* name;
	Parameter   parameter;
	double      value;
	const char* unit;
};

class BadParameter : public testing::TestWithParam<BadValue> { };

TEST_P(BadParameter, isRefusedWithNameValueUnitAndWayOut)
{
	const BadValue&   bad     = GetParam();
	const std::string message = complaint(bad.parameter, bad.value);
	EXPECT_NE(message.find(bad.name), std::string::npos) << message;
	EXPECT_NE(message.find(bad.unit), std::string::npos) << message;
	EXPECT_GT(message.size(), 60u) << "says what to do: " << message;
	for (const double never : { std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity() })
		EXPECT_NE(complaint(bad.parameter, never), "") << bad.name << " = " << never;
}

using P = ConcreteParameters;
INSTANTIATE_TEST_SUITE_P(
        All,
        BadParameter,
        testing::Values(
                BadValue { "bulk", &P::bulk, 0, "Pa" },
                BadValue { "bulk", &P::bulk, 26e9 * 2e4, "Pa" },
                BadValue { "shear", &P::shear, -26e9, "Pa" },
                BadValue { "rotationStiffness", &P::rotationStiffness, -1, "[-]" },
                BadValue { "density", &P::density, 0, "kg/m³" },
                BadValue { "eosPressure", &P::eosPressure, -1.1e9, "Pa" },
                BadValue { "eosExponent", &P::eosExponent, 1, "[-]" },
                BadValue { "eosExponent", &P::eosExponent, 0, "[-]" },
                BadValue { "strength", &P::strength, 0, "Pa" },
                BadValue { "flowFactor", &P::flowFactor, 0, "[-]" },
                BadValue { "flowExponent", &P::flowExponent, -0.5, "[-]" },
                BadValue { "rateExponent", &P::rateExponent, 1.1, "[-]" },
                BadValue { "rateExponent", &P::rateExponent, -0.1, "[-]" },
                BadValue { "frictionPressure", &P::frictionPressure, 0, "Pa" },
                BadValue { "frictionPressureExponent", &P::frictionPressureExponent, -0.5, "[-]" },
                BadValue { "friction", &P::friction, 33, "[-]" },
                BadValue { "friction", &P::friction, -0.1, "[-]" },
                BadValue { "closedGrowth", &P::closedGrowth, 1.5, "[-]" },
                BadValue { "closedEffect", &P::closedEffect, -0.1, "[-]" },
                BadValue { "fractureEnergy", &P::fractureEnergy, 0, "J/m³" },
                BadValue { "damageExponent", &P::damageExponent, 0, "[-]" },
                BadValue { "damageLimit", &P::damageLimit, 1.01, "[-]" },
                BadValue { "referenceRate", &P::referenceRate, 0, "1/s" },
                BadValue { "sharingTolerance", &P::sharingTolerance, 0, "[-]" },
                BadValue { "closureBand", &P::closureBand, -1, "Pa" },
                BadValue { "residual", &P::residual, 0, "[-]" }));

TEST(ConcreteParameters, frictionInDegreesIsRecognised)
{
	EXPECT_NE(complaint(&P::friction, 33).find("not an angle"), std::string::npos);
}

TEST(ConcretePower, agreesWithTheGeneralPower)
{
	for (const double n : { 0., 0.5, 2. / 3, 1., 2., 0.96, 0.37, 3.2 })
		for (const double x : { 0., 1e-12, 0.3, 1., 7., 1e8 })
			EXPECT_NEAR(Power(n)(x), std::pow(x, n), 1e-14 * std::pow(x, n)) << x << "^" << n;
	EXPECT_TRUE(Power(0.6666666666666).isTwoThirds()); // as scripts round it
}

} // namespace
