// GPL v2 or later, see LICENSE.
// Material of rigid particles joined by breakable bonds.
#include <pkg/bonded/BondedMat.hpp>

#include <sstream>

namespace yade {

DDEM_PLUGIN((BondedMat))

namespace {

	/// Throws "BondedMat 'rock': name = value unit complaint" unless `good`.
	void
	require(bool good, const BondedMat& material, const char* name, Real value, const char* unit,
	        const char* complaint)
	{
		if (good) return;
		std::ostringstream text;
		text << material.getClassName();
		if (!material.label.empty()) text << " '" << material.label << "'";
		text << ": " << name << " = " << value << " " << unit << " " << complaint;
		throw std::invalid_argument(text.str());
	}

} // namespace

void BondedMat::validate() const
{
	const auto positive = [this](const char* name, Real value, const char* unit) {
		require(value > 0 && std::isfinite(value), *this, name, value, unit, "must be positive and finite");
	};
	positive("young", young, "Pa");
	positive("density", density, "kg/m³");
	positive("cohesion", cohesion, "Pa");
	require(poisson > -1 && poisson < 0.5, *this, "poisson", poisson, "[-]", "must lie between -1 and 0.5");
	require(!(bondFrictionAngle >= Mathr::PI / 2),
	        *this,
	        "bondFrictionAngle",
	        bondFrictionAngle,
	        "rad",
	        "is a right angle or more: given in degrees? Use radians(…)");
	require(bondFrictionAngle >= 0, *this, "bondFrictionAngle", bondFrictionAngle, "rad", "must not be negative");
	require(tensileStrength > 0,
	        *this,
	        "tensileStrength",
	        tensileStrength,
	        "Pa",
	        "must be positive (infinite: the cut-off is cohesion/tan(bondFrictionAngle))");
	require(frictionDynamic >= 0 && std::isfinite(frictionDynamic), *this, "frictionDynamic", frictionDynamic,
	        "[-]", "must not be negative");
	for (const auto& [name, value] :
	     { std::make_pair("normalDamping", normalDamping), std::make_pair("shearDamping", shearDamping) })
		require(value >= 0 && std::isfinite(value), *this, name, value, "[-]", "must not be negative");
	require(frictionStatic >= frictionDynamic && std::isfinite(frictionStatic),
	        *this,
	        "frictionStatic",
	        frictionStatic,
	        "[-]",
	        "must not be below frictionDynamic");
}

} // namespace yade
