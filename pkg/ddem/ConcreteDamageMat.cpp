// GPL v2 or later, see LICENSE.
#include <pkg/ddem/ConcreteDamageMat.hpp>

namespace yade {

DDEM_PLUGIN((ConcreteDamageMat))

ddem::ConcreteParameters ConcreteDamageMat::parameters() const
{
	ddem::ConcreteParameters p;
	p.bulk                     = bulk();
	p.shear                    = shear();
	p.rotationStiffness        = rotationStiffness;
	p.density                  = density;
	p.eosPressure              = eosPressure;
	p.eosExponent              = eosExponent;
	p.strength                 = strength;
	p.flowFactor               = flowFactor;
	p.flowExponent             = flowExponent;
	p.rateExponent             = rateExponent;
	p.frictionPressure         = frictionPressure;
	p.frictionPressureExponent = frictionPressureExponent;
	p.friction                 = friction;
	p.closedGrowth             = closedGrowth;
	p.closedEffect             = closedEffect;
	p.fractureEnergy           = fractureEnergy;
	p.damageExponent           = damageExponent;
	p.damageLimit              = damageLimit;
	p.closureBand              = closureBand;
	p.referenceRate            = referenceRate;
	p.sharingTolerance         = sharingTolerance;
	p.residual                 = residual;
	return p;
}

unsigned ConcreteDamageMat::effects() const
{
	using namespace ddem::ConcreteEffects;
	return (viscoplasticFlow ? unsigned(Flow) : 0) | (rateDependence ? unsigned(Rate) : 0) | (damage ? unsigned(Damage) : 0) | (equationOfState ? unsigned(EquationOfState) : 0);
}

void ConcreteDamageMat::validate() const
{
	DeformableElastMat::validate();
	try {
		parameters().validate();
	} catch (const std::invalid_argument& error) {
		throw std::invalid_argument(where() + error.what());
	}
}

} // namespace yade
