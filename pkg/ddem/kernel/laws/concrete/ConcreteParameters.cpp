// GPL v2 or later, see LICENSE.
// Parameters of the concrete damage model: checks and preparation.
#include <pkg/ddem/kernel/laws/concrete/ConcreteParameters.hpp>
#include <pkg/ddem/kernel/algebra/ElasticModuli.hpp>

#include <cmath>
#include <limits>

namespace yade::ddem {

void ConcreteParameters::validate() const
{
	ElasticModuli { bulk, shear }.validate();
	checkParameters("concrete", entries(), this);
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
        , patientSquare(
                  p.residual + patientDamage < 1
                          ? std::pow(patientDamage / (1 - p.residual - patientDamage), 2 / p.damageExponent)
                          : std::numeric_limits<double>::infinity())
        , smallestEnergy(1e-6 * p.fractureEnergy)
        , eosPower(p.eosExponent)
        , flowPower(p.flowExponent)
        , ratePower(p.rateExponent)
        , frictionPower(p.frictionPressureExponent)
        , damagePower(p.damageExponent)
{
}

} // namespace yade::ddem
