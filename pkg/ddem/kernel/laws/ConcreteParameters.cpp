// GPL v2 or later, see LICENSE.
// Parameters of the concrete damage model: checks and preparation.
#include <pkg/ddem/kernel/laws/ConcreteParameters.hpp>
#include <pkg/ddem/kernel/laws/ElasticLaw.hpp>

#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace yade::ddem {

namespace {
	constexpr double unbounded = std::numeric_limits<double>::max();

	/// Bounds that a parameter must keep, and what to tell who broke them.
	struct Rule {
		const char* name;
		double      value;
		const char* unit;
		double      least, most;
		bool        includesLeast, includesMost;
		const char* wayOut;
	};

	void check(const Rule& rule)
	{
		const bool above = rule.includesLeast ? rule.value >= rule.least : rule.value > rule.least;
		const bool below = rule.includesMost ? rule.value <= rule.most : rule.value < rule.most;
		if (above && below) return; // a NaN is neither
		std::ostringstream message;
		message << "concrete: " << rule.name << " = " << rule.value << " " << rule.unit << " is not allowed; it must be "
		        << (rule.includesLeast ? "at least " : "above ") << rule.least;
		if (rule.most < unbounded) message << " and " << (rule.includesMost ? "at most " : "below ") << rule.most;
		message << ". " << rule.wayOut;
		throw std::invalid_argument(message.str());
	}
}

void ConcreteParameters::validate() const
{
	ElasticModuli { bulk, shear }.validate();

	const Rule rules[] = {
		{ "rotationStiffness", rotationStiffness, "[-]", 0, unbounded, true, true, "0 leaves rotations free, Zubelewicz (2018) uses 2." },
		{ "density", density, "kg/m³", 0, unbounded, false, true, "Concrete has about 2400 kg/m³." },
		{ "eosPressure", eosPressure, "Pa", 0, unbounded, false, true, "It is the pressure at which the moduli have doubled, 1.1e9 Pa for concrete." },
		{ "eosExponent", eosExponent, "[-]", 0, 1, false, false, "With 1 or more the pressure is infinite at a finite compression; concrete: 2/3." },
		{ "strength", strength, "Pa", 0, unbounded, false, true, "For a material that does not flow, use an elastic material." },
		{ "flowFactor", flowFactor, "[-]", 0, unbounded, false, true, "For a material that does not flow, use an elastic material." },
		{ "flowExponent", flowExponent, "[-]", 0, unbounded, false, true, "Concrete: 0.5." },
		{ "rateExponent", rateExponent, "[-]", 0, 1, true, true, "1 is rate independent; above 1 the strength would fall as the rate grows." },
		{ "frictionPressure", frictionPressure, "Pa", 0, unbounded, false, true, "For constant friction set frictionPressureExponent = 0." },
		{ "frictionPressureExponent", frictionPressureExponent, "[-]", 0, unbounded, true, true, "0 is constant friction; concrete: 0.5." },
		{ "friction", friction, "[-]", 0, 1, true, false, "It is a coefficient, not an angle in degrees; concrete: 0.66." },
		{ "closedGrowth", closedGrowth, "[-]", 0, 1, true, true, "It is relative to the open crack; concrete: 0.5." },
		{ "closedEffect", closedEffect, "[-]", 0, 1, true, true, "It is relative to the open crack; concrete: 0.1." },
		{ "fractureEnergy", fractureEnergy, "J/m³", 0, unbounded, false, true, "It is an energy per volume (not per area), 80e3 J/m³ for concrete." },
		{ "damageExponent", damageExponent, "[-]", 0, unbounded, false, true, "Concrete: 2." },
		{ "damageLimit", damageLimit, "[-]", 0, 1, true, true, "1 is complete loss of stiffness." },
		{ "referenceRate", referenceRate, "1/s", 0, unbounded, false, true, "Zubelewicz (2018) uses 1/s." },
		{ "sharingTolerance", sharingTolerance, "[-]", 0, 1, false, false, "It is relative to the largest principal stress, 0.05 for concrete." },
		{ "closureBand", closureBand, "Pa", 0, unbounded, true, true, "0 closes cracks at zero stress." },
		{ "residual", residual, "[-]", 0, 1, false, false, "It is the share of strength and stiffness that full damage leaves, 1e-6 or so." },
	};
	for (const Rule& rule : rules)
		check(rule);
}

namespace {
	const ConcreteParameters& checked(const ConcreteParameters& parameters)
	{
		parameters.validate();
		return parameters;
	}
}

Power::Power(double n)
        : exponent_(n)
        , kind_(Kind::General)
{
	if (n == 0) kind_ = Kind::Zero;
	if (n == 0.5) kind_ = Kind::Half;
	if (std::abs(n - 2. / 3) < 1e-12) kind_ = Kind::TwoThirds; // 2/3 arrives from tables and scripts with rounding
	if (n == 1) kind_ = Kind::One;
	if (n == 2) kind_ = Kind::Two;
}

PreparedConcrete::PreparedConcrete(const ConcreteParameters& p)
        : parameters(checked(p))
        , lambda(ElasticModuli { p.bulk, p.shear }.lambda())
        , twoShear(2 * p.shear)
        , perEosPressure(1 / p.eosPressure)
        , perFrictionPressure(1 / p.frictionPressure)
        , perReferenceRate(1 / p.referenceRate)
        , localisedIntegrity(p.residual + (1 - p.residual) / (1 + std::pow(localisedDamage, p.damageExponent)))
        , smallestEnergy(1e-6 * p.fractureEnergy)
        , eosPower(p.eosExponent)
        , flowPower(p.flowExponent)
        , ratePower(p.rateExponent)
        , frictionPower(p.frictionPressureExponent)
        , damagePower(p.damageExponent)
{
}

} // namespace yade::ddem
