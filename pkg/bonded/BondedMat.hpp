// GPL v2 or later, see LICENSE.
// Material of rigid particles joined by breakable bonds.
#pragma once

#include <pkg/bonded/kernel/BondContact.hpp>
#include <pkg/bonded/kernel/BondCriterionOf.hpp>
#include <pkg/bonded/kernel/criteria/MohrCoulomb.hpp>
#include <pkg/ddem/ParameterAttributes.hpp>
#include <pkg/ddem/YadeInclude.hpp>

#include <typeindex>

namespace yade {

/// The criterion of a material's bonds with its parameters.
struct CriterionOfMaterial {
	std::type_index             material; ///< class that says so
	const ddem::BondCriterion*  criterion;
	ddem::BondCriterion::Values values;
};

/** What a material of bonds owes, made from its criterion's list of parameters. A new criterion is its header in
 * kernel/criteria and a pair of files:
 *
 *     class MyBondMat : public BondedMat {
 *     public:
 *             virtual ~MyBondMat() = default;
 *             DDEM_CRITERION_OF_MATERIAL(MyBondMat, ddem::MyBond, MY_BOND_PARAMETERS)
 *
 *             YADE_CLASS_BASE_DOC_ATTRS_CTOR(MyBondMat, BondedMat, "What it is …",
 *                     MY_BOND_PARAMETERS(DDEM_ATTRIBUTE), createIndex(); takeStrengthOfCriterion();
 *             );
 *             REGISTER_CLASS_INDEX(MyBondMat, BondedMat);
 *     };
 *     REGISTER_SERIALIZABLE(MyBondMat);
 */
#define DDEM_CRITERION_OF_MATERIAL(Class, Criterion, PARAMETERS) \
	CriterionOfMaterial criterion() const override \
	{ \
		Criterion::Parameters p; \
		copyStrength(p); \
		PARAMETERS(DDEM_COPY_PARAMETER) \
		return criterionOf<Criterion>(typeid(Class), p); \
	} \
	void postLoad(Class&) { validate(); } \
	void takeStrengthOfCriterion() { takeStrength(Criterion::Parameters()); }

class BondedMat : public ElastMat {
public:
	virtual ~BondedMat() = default;

	/// What breaks bonds of this material. A class that derives from it and does not say its own is refused: its
	/// bonds would break as those of the class it derives from.
	virtual CriterionOfMaterial criterion() const
	{
		ddem::MohrCoulomb::Parameters p;
		copyStrength(p);
		return criterionOf<ddem::MohrCoulomb>(typeid(BondedMat), p);
	}
	/// \throws std::logic_error for a class that does not say its criterion
	CriterionOfMaterial ownCriterion() const;
	std::string         criterionName() const { return ownCriterion().criterion->name(); }

	/// Checks all parameters. \throws std::invalid_argument naming the parameter, its value,
	/// its unit and the material's label.
	void validate() const;
	void postLoad(BondedMat&) { validate(); }

	ddem::ContactFriction friction() const { return { frictionStatic, frictionDynamic, gradualFriction }; }

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(BondedMat, ElastMat,
		"Material of rigid spheres that are joined by brittle bonds and touch with friction once bonds are "
		"broken, after the uniaxial compression test of the ESyS-Particle tutorial [Weatherley2014]_, whose "
		"parameters are the defaults.\n\n"
		":yref:`young<ElastMat.young>` [Pa] and :yref:`poisson<ElastMat.poisson>` [-] are those of the bond's "
		"cement, a round beam between the centres; contacts have the same springs. A bond breaks where "
		":math:`\\tau > C - \\sigma\\tan\\varphi` (tension positive) or :math:`\\sigma` exceeds the smaller of "
		"*tensileStrength* and :math:`C/\\tan\\varphi`. Where two materials meet, a bond has the harmonic mean "
		"of both elastic moduli, the mean Poisson's ratio and the lower strength and friction, unless a third "
		"material is :yref:`between<BondedMat.between>` them.\n\n"
		"Other criteria are materials that derive from this one: :yref:`ParallelBondMat`, "
		":yref:`SofteningBondMat`.\n\n"
		"Contacts may be damped, :math:`F_n=F_N-c_n v_n`, :math:`F_t=F_T-c_t v_t`, with "
		":math:`c=2\\zeta\\sqrt{\\bar m k}` of the pair's reduced mass and spring; the second only while the "
		"contact does not slide.\n\n"
		"Errors: ValueError for moduli, density or cohesion that are not positive, poisson outside (-1, 0.5), "
		"angles outside [0, pi/2), dynamic friction above static, negative damping, NaN.",
		MOHR_COULOMB_PARAMETERS(DDEM_ATTRIBUTE)
		((Real,frictionStatic,0.6,Attr::triggerPostLoad,
			"Coefficient of friction of a contact until its first slip [-]"))
		((Real,frictionDynamic,0.4,Attr::triggerPostLoad,
			"Coefficient of friction of a contact from its first slip on [-]"))
		((bool,gradualFriction,false,Attr::triggerPostLoad,
			"Whether the tangential force of contacts grows as "
			":math:`\\mu F_N(1-(1-|\\delta|/\\delta_{max})^{3/2})` with the slip :math:`\\delta`, instead "
			"of linearly; :math:`\\delta_{max}=3\\mu F_N/2k_s`, so that both start with the same "
			"stiffness"))
		((Real,normalDamping,0,Attr::triggerPostLoad,
			"Normal damping :math:`\\zeta_n` of contacts, part of the critical one [-]"))
		((Real,shearDamping,0,Attr::triggerPostLoad,
			"Tangential damping :math:`\\zeta_t` of contacts, part of the critical one [-]"))
		((vector<std::string>,between,,Attr::triggerPostLoad,
			"Labels of two materials: this one is of no body, but bonds and contacts between bodies of the "
			"two have all its parameters (aggregate and mortar, say). Empty: an ordinary material")),
		createIndex(); young = 100e9; poisson = 0.25; density = 2600;,
		.def("validate",&BondedMat::validate,
			"ValueError naming the parameter if one is out of range; checked when parameters are set by "
			"the constructor, and again when bonds are made.")
		.add_property("criterion",&BondedMat::criterionName,"Name of the criterion by which its bonds break")
	);
	// clang-format on
	REGISTER_CLASS_INDEX(BondedMat, ElastMat);

protected:
	void copyStrength(ddem::MohrCoulomb::Parameters& p) const { MOHR_COULOMB_PARAMETERS(DDEM_COPY_PARAMETER) }
	void takeStrength(const ddem::MohrCoulomb::Parameters& p)
	{
		cohesion          = p.cohesion;
		bondFrictionAngle = p.bondFrictionAngle;
		tensileStrength   = p.tensileStrength;
	}
	template <class Criterion>
	static CriterionOfMaterial
	criterionOf(const std::type_info& material, const typename Criterion::Parameters& parameters)
	{
		return { material, &ddem::bondCriterion<Criterion>(),
			 ddem::BondCriterionOf<Criterion>::valuesOf(parameters) };
	}
};
REGISTER_SERIALIZABLE(BondedMat);

/// The material between two others, or null: see BondedMat::between. \throws std::invalid_argument for two of them
const BondedMat* materialBetween(const Scene& scene, const BondedMat& a, const BondedMat& b);
/// \throws std::invalid_argument where a material is between others that there are not
void checkMaterialsBetween(const Scene& scene);

} // namespace yade
