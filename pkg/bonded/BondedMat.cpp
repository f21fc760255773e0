// GPL v2 or later, see LICENSE.
// Material of rigid particles joined by breakable bonds.
#include <pkg/bonded/BondedMat.hpp>

#include <algorithm>
#include <sstream>
#include <tuple>

namespace yade {

DDEM_PLUGIN((BondedMat))

namespace {

	std::string nameOf(const BondedMat& material)
	{
		return material.getClassName() + (material.label.empty() ? "" : " '" + material.label + "'");
	}

	/// Throws "BondedMat 'rock': name = value unit complaint" unless `good`.
	void
	require(bool good, const BondedMat& material, const char* name, Real value, const char* unit,
	        const char* complaint)
	{
		if (good) return;
		std::ostringstream text;
		text << nameOf(material) << ": " << name << " = " << value << " " << unit << " " << complaint;
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
	require(poisson > -1 && poisson < 0.5, *this, "poisson", poisson, "[-]", "must lie between -1 and 0.5");
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
	const CriterionOfMaterial own = ownCriterion();
	own.criterion->check(own.values, nameOf(*this));
	if (!between.empty() && (between.size() != 2 || between[0] == between[1]))
		throw std::invalid_argument(
		        nameOf(*this) + ": between must be two different labels of materials, or empty");
}

CriterionOfMaterial BondedMat::ownCriterion() const
{
	CriterionOfMaterial own = criterion();
	if (own.material == std::type_index(typeid(*this))) return own;
	throw std::logic_error(
	        getClassName()
	        + " derives from a material of bonds, but does not say its own criterion: its bonds "
	          "would break as those of "
	        + own.criterion->name() + "; see DDEM_CRITERION_OF_MATERIAL in BondedMat.hpp");
}

const BondedMat* materialBetween(const Scene& scene, const BondedMat& a, const BondedMat& b)
{
	const BondedMat* found = nullptr;
	if (&a == &b) return found;
	for (const auto& material : scene.materials) {
		const auto* bonded = dynamic_cast<const BondedMat*>(material.get());
		if (!bonded || bonded->between.size() != 2) continue;
		const auto& [one, other] = std::tie(bonded->between[0], bonded->between[1]);
		if (!((one == a.label && other == b.label) || (one == b.label && other == a.label))) continue;
		if (found)
			throw std::invalid_argument(
			        nameOf(*found) + " and " + nameOf(*bonded) + " are both between '" + a.label + "' and '"
			        + b.label + "'");
		found = bonded;
	}
	return found;
}

void checkMaterialsBetween(const Scene& scene)
{
	for (const auto& material : scene.materials) {
		const auto* bonded = dynamic_cast<const BondedMat*>(material.get());
		if (!bonded) continue;
		for (const std::string& label : bonded->between)
			if (std::none_of(scene.materials.begin(), scene.materials.end(), [&](const auto& other) {
				    return other && other->label == label
				            && dynamic_cast<const BondedMat*>(other.get());
			    }))
				throw std::invalid_argument(
				        nameOf(*bonded) + " is between '" + bonded->between[0] + "' and '"
				        + bonded->between[1] + "', but O.materials has no BondedMat '" + label + "'");
	}
}

} // namespace yade
