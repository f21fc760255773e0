// GPL v2 or later, see LICENSE.
// Elastic material of deformable triangles.
#pragma once

#include <pkg/ddem/YadeInclude.hpp>

#include <pkg/ddem/kernel/laws/Elastic.hpp>

#include <functional>
#include <memory>
#include <typeindex>
#include <vector>

namespace yade {

/// The law of a material with its parameters, as the engine asks for it.
struct LawOfMaterial {
	std::type_index                                  material; ///< class that says so
	std::string                                      name;     ///< of the law
	std::function<std::unique_ptr<ddem::LawGroup>()> makeGroup;
	std::function<void()>                            check; ///< throws std::invalid_argument for
	                                                        ///< a parameter out of bounds
	std::vector<double>                              values; ///< of all parameters, and the mask of effects
};

class DeformableElastMat : public FrictMat {
public:
	virtual ~DeformableElastMat() = default;

	Real bulk() const { return young / (3 * (1 - 2 * poisson)); }
	Real shear() const { return young / (2 * (1 + poisson)); }
	void setBulk(Real value) { setModuli(value, shear()); }
	void setShear(Real value) { setModuli(bulk(), value); }
	/// \throws std::invalid_argument unless both moduli [Pa] are positive and finite
	void setModuli(Real newBulk, Real newShear);

	/// Checks all parameters. \throws std::invalid_argument naming the parameter, its value,
	/// its unit and the material's label.
	void validate() const;

	/// The law of this material. A class that derives from another material and does not say its own
	/// (DDEM_LAW_OF_MATERIAL) is refused: it would run as the one it derives from.
	virtual LawOfMaterial law() const;
	/// \throws std::logic_error for a class that does not say its law.
	LawOfMaterial ownLaw() const;
	/// What ownLaw() would run, for Python; needs no engine. \param book whether the energy book is open
	boost::python::dict pyEffects(bool book) const;
	/// Mask of the law's effects that are switched on.
	virtual unsigned switchedOn() const { return 0; }

	void pyHandleCustomCtorArgs(boost::python::tuple& args, boost::python::dict& kw) override;
	void postLoad(DeformableElastMat&) { validate(); }

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(DeformableElastMat, FrictMat,
		"Isotropic, linear elastic material of :yref:`DeformableTriangle` in plane strain.\n\n"
		"Elasticity is given either by *young* [Pa] and *poisson* [-] or, as in [Zubelewicz2018]_, Table 1, by "
		"*bulk* [Pa] and *shear* [Pa], in the constructor or later; one pair is kept and the other computed "
		"from it.\n\n"
		"Errors: ValueError for moduli or density that are not positive, poisson outside (-1, 0.5), negative "
		"rotationStiffness, or anything not finite.",
		((Real,rotationStiffness,2,Attr::triggerPostLoad,
			"Stiffness :math:`\\beta_\\varphi` [-] of the rotation-induced strain as a multiple of the "
			"shear modulus; felt only with :yref:`DeformableEngine.rotation` 'cosserat'. 0 leaves rotation "
			"free.")),
		createIndex(); young = 79.4e9; poisson = 0.2; density = 2400;,
		.add_property("bulk",&DeformableElastMat::bulk,&DeformableElastMat::setBulk,
			"Bulk modulus [Pa], computed from :yref:`young<ElastMat.young>` and "
			":yref:`poisson<ElastMat.poisson>`; setting it keeps the shear modulus.")
		.add_property("shear",&DeformableElastMat::shear,&DeformableElastMat::setShear,
			"Shear modulus [Pa], computed from :yref:`young<ElastMat.young>` and "
			":yref:`poisson<ElastMat.poisson>`; setting it keeps the bulk modulus.")
		.def("effects",&DeformableElastMat::pyEffects,(boost::python::arg("book")=false),
			"What the law does with these parameters and switches, as a dict with law, effects (names of "
			"those that run), effectsOff, fields (name, unit, components) and bytes (of state per "
			"triangle, without what triangles have of their own), as "
			":yref:`DeformableEngine.groups` has them; *book*: with the fields of the energy book.")
	);
	// clang-format on
	REGISTER_CLASS_INDEX(DeformableElastMat, FrictMat);

protected:
	void copyElasticity(ddem::ElasticParameters& p) const
	{
		p.bulk              = bulk();
		p.shear             = shear();
		p.rotationStiffness = rotationStiffness;
		p.density           = density;
	}
	template <class Law>
	static LawOfMaterial
	lawOf(const std::type_info& material, const typename Law::Parameters& parameters, unsigned effects)
	{
		std::vector<double> values;
		for (const auto& entry : Law::Parameters::entries())
			values.push_back(entry.get(&parameters));
		values.push_back(effects);
		const unsigned effective = Law::effective(parameters, effects);
		const bool     plain     = Law::elasticWithoutEffects && effective == 0;
		const auto     make      = [=]() -> std::unique_ptr<ddem::LawGroup> {
                        if (plain) return ddem::makeGroup<ddem::Elastic>(parameters, 0);
                        return ddem::makeGroup<Law>(parameters, effective);
		};
		return { material, Law::name, make,
			 [=] {
			         typename Law::Prepared prepared(parameters);
			         (void)prepared;
			 },
			 values };
	}
	std::string where() const;
	void        requirePositive(const char* name, Real value, const char* unit) const;
};
REGISTER_SERIALIZABLE(DeformableElastMat);

} // namespace yade
