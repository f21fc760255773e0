// GPL v2 or later, see LICENSE.
// Isotropic elasticity: checks of the moduli.
#include <pkg/ddem/kernel/algebra/ElasticModuli.hpp>

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace yade::ddem {

namespace {
	void requirePositive(double value, const char* name)
	{
		if (std::isfinite(value) && value > 0) return;
		std::ostringstream message;
		message << name << " must be a positive number of pascals, got " << value
		        << " Pa; concrete has about 30e9 Pa, steel 2e11 Pa.";
		throw std::invalid_argument(message.str());
	}
}

ElasticModuli ElasticModuli::fromYoung(double young, double poisson)
{
	requirePositive(young, "Young's modulus");
	if (!(poisson > -1 && poisson < 0.5)) {
		std::ostringstream message;
		message << "Poisson's ratio must lie between -1 and 0.5, got " << poisson
		        << " [-]; at 0.5 the bulk modulus is infinite: use at most 0.499, or give bulk and shear "
		           "modulus.";
		throw std::invalid_argument(message.str());
	}
	const ElasticModuli moduli { young / (3 * (1 - 2 * poisson)), young / (2 * (1 + poisson)) };
	moduli.validate();
	return moduli;
}

void ElasticModuli::validate() const
{
	requirePositive(bulk, "bulk modulus");
	requirePositive(shear, "shear modulus");
	if (bulk > largestBulkToShear * shear) {
		std::ostringstream message;
		message << "bulk modulus " << bulk << " Pa is " << bulk / shear << " times the shear modulus " << shear
		        << " Pa (Poisson's ratio " << poisson()
		        << "): the material is incompressible for all purposes and its stable time step goes to zero; "
		           "keep the ratio below "
		        << largestBulkToShear << ".";
		throw std::invalid_argument(message.str());
	}
}

} // namespace yade::ddem
