// GPL v2 or later, see LICENSE.
// Material of rigid particles joined by breakable bonds.
#pragma once

#include <pkg/ddem/YadeInclude.hpp>
#include <pkg/bonded/kernel/BondContact.hpp>
#include <pkg/bonded/kernel/BondStrength.hpp>

namespace yade {

class BondedMat : public ElastMat {
public:
	virtual ~BondedMat() = default;

	/// Checks all parameters. \throws std::invalid_argument naming the parameter, its value,
	/// its unit and the material's label.
	void validate() const;
	void postLoad(BondedMat&) { validate(); }

	ddem::MohrCoulomb     strength() const { return { cohesion, math::tan(bondFrictionAngle), tensileStrength }; }
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
		"of both elastic moduli, the mean Poisson's ratio and the lower strength and friction.\n\n"
		"Contacts may be damped, :math:`F_n=F_N-c_n v_n`, :math:`F_t=F_T-c_t v_t`, with "
		":math:`c=2\\zeta\\sqrt{\\bar m k}` of the pair's reduced mass and spring; the second only while the "
		"contact does not slide.\n\n"
		"Errors: ValueError for moduli, density or cohesion that are not positive, poisson outside (-1, 0.5), "
		"angles outside [0, pi/2), dynamic friction above static, negative damping, NaN.",
		((Real,cohesion,100e6,Attr::triggerPostLoad,
			"Shear strength :math:`C` of a bond without normal stress [Pa]"))
		((Real,bondFrictionAngle,Mathr::PI/4,Attr::triggerPostLoad,
			"Angle of internal friction :math:`\\varphi` of bonds [rad]"))
		((Real,tensileStrength,std::numeric_limits<Real>::infinity(),Attr::triggerPostLoad,
			"Tension cut-off of bonds [Pa]; above :math:`C/\\tan\\varphi` (as by default) it has "
			"no effect"))
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
			"Tangential damping :math:`\\zeta_t` of contacts, part of the critical one [-]")),
		createIndex(); young = 100e9; poisson = 0.25; density = 2600;,
		.def("validate",&BondedMat::validate,
			"ValueError naming the parameter if one is out of range; checked when parameters are set by "
			"the constructor, and again when bonds are made.")
	);
	// clang-format on
	REGISTER_CLASS_INDEX(BondedMat, ElastMat);
};
REGISTER_SERIALIZABLE(BondedMat);

} // namespace yade
