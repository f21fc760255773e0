// GPL v2 or later, see LICENSE.
#include <pkg/ddem/DeformableElastMat.hpp>

#include <pkg/ddem/kernel/triangles/LawGroup.hpp>

#include <sstream>
#include <typeinfo>

namespace yade {

DDEM_PLUGIN((DeformableElastMat))

std::string DeformableElastMat::where() const
{
	return getClassName() + (label.empty() ? "" : " '" + label + "'") + ": ";
}

void DeformableElastMat::requirePositive(const char* name, Real value, const char* unit) const
{
	if (value > 0 && std::isfinite(value)) return;
	std::ostringstream text;
	text << where() << name << " = " << value << " " << unit << " must be positive and finite";
	throw std::invalid_argument(text.str());
}

void DeformableElastMat::setModuli(Real newBulk, Real newShear)
{
	requirePositive("bulk", newBulk, "Pa");
	requirePositive("shear", newShear, "Pa");
	young   = 9 * newBulk * newShear / (3 * newBulk + newShear);
	poisson = (3 * newBulk - 2 * newShear) / (2 * (3 * newBulk + newShear));
}

void DeformableElastMat::validate() const
{
	requirePositive("young", young, "Pa");
	requirePositive("density", density, "kg/m³");
	std::ostringstream text;
	if (!(poisson > -1 && poisson < 0.5))
		text << where() << "poisson = " << poisson
		     << " must lie between -1 and 0.5; at 0.5 the material is incompressible and the stable time step "
		        "is zero (use 0.499 at most)";
	else if (!(rotationStiffness >= 0 && std::isfinite(rotationStiffness)))
		text << where() << "rotationStiffness = " << rotationStiffness
		     << " must be zero or positive (2 in the report)";
	if (!text.str().empty()) throw std::invalid_argument(text.str());
	try {
		law().check(); // what else the law asks of its parameters
	} catch (const std::invalid_argument& error) {
		throw std::invalid_argument(where() + error.what());
	}
}

LawOfMaterial DeformableElastMat::law() const
{
	ddem::ElasticParameters p;
	copyElasticity(p);
	return lawOf<ddem::Elastic>(typeid(DeformableElastMat), p, 0);
}

LawOfMaterial DeformableElastMat::ownLaw() const
{
	LawOfMaterial own = law();
	if (own.material == typeid(*this)) return own;
	throw std::logic_error(
	        getClassName() + " does not say which law it has and would run as " + own.name
	        + ": its class needs DDEM_LAW_OF_MATERIAL, see pkg/ddem/LawMaterial.hpp");
}

boost::python::dict DeformableElastMat::pyEffects(bool book) const
{
	const std::unique_ptr<ddem::LawGroup> group = ownLaw().makeGroup();
	if (book) group->keepBook(true, [](std::size_t) { return std::array<ddem::PlaneTensor, 3> {}; });
	boost::python::list on, off, fields;
	std::size_t         numbers = 0; // of a sub-element
	for (const ddem::LawEffect& effect : group->effectsOfLaw())
		(group->effects() & effect.bit ? on : off).append(std::string(effect.name));
	for (const ddem::StateField& field : group->fields()) {
		fields.append(boost::python::make_tuple(field.name, field.unit, field.components()));
		numbers += field.components();
	}
	boost::python::dict result;
	result["law"]        = std::string(group->name());
	result["effects"]    = on;
	result["effectsOff"] = off;
	result["fields"]     = fields;
	result["bytes"]      = 3 * numbers * sizeof(double);
	return result;
}

void DeformableElastMat::pyHandleCustomCtorArgs(boost::python::tuple& /*args*/, boost::python::dict& kw)
{
	const bool hasBulk = kw.has_key("bulk"), hasShear = kw.has_key("shear");
	if (!hasBulk && !hasShear) return;
	if (!hasBulk || !hasShear || kw.has_key("young") || kw.has_key("poisson"))
		throw std::invalid_argument(
		        getClassName()
		        + ": give the elasticity either as bulk and shear [Pa] or as young [Pa] and poisson [-], both "
		          "numbers of one pair");
	setModuli(boost::python::extract<Real>(kw["bulk"]), boost::python::extract<Real>(kw["shear"]));
	boost::python::delitem(kw, boost::python::object("bulk"));
	boost::python::delitem(kw, boost::python::object("shear"));
	if (boost::python::len(kw) == 0) validate(); // otherwise the remaining keywords are set and validated
}

} // namespace yade
