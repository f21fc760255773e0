// GPL v2 or later, see LICENSE.
// Concrete: the viscoplastic damage material of deformable triangles.
#pragma once

#include <pkg/ddem/DeformableElastMat.hpp>
#include <pkg/ddem/kernel/laws/ConcreteLaw.hpp>

namespace yade {

class ConcreteDamageMat : public DeformableElastMat {
public:
	virtual ~ConcreteDamageMat() = default;

	/// The parameters as the kernel takes them.
	ddem::ConcreteParameters parameters() const;
	/// The effects that are on, a mask of ddem::ConcreteEffects.
	unsigned effects() const;
	void     validate() const override;
	void     postLoad(ConcreteDamageMat&) { validate(); }

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(ConcreteDamageMat, DeformableElastMat,
		"Concrete of :yref:`DeformableTriangle`: viscoplastic Mohr-Coulomb flow, tensorial damage, degradation of elasticity, equation of state [Zubelewicz2018]_, section 3. "
		"Defaults are the report's Tables 1 and 2: a high-strength concrete, about 91 MPa in compression and 10 MPa in tension at 1/s.\n\n"
		"An effect that is switched off is not evaluated. Three things are not printed in the report and closed here so that its Table 2, unchanged, gives its strengths: the strain rate "
		"of eq. 7 is :math:`\\dot e_N=\\sqrt{\\dot\\varepsilon:\\dot\\varepsilon/2}`, friction decays as :math:`q_D=q_0(1+\\langle p\\rangle/p_{q0})^{-n_q}`, and equal principal stresses share the flow.\n\n"
		"Limits: small strain in the element's frame; fracture energy is per volume, so the energy of a crack scales with the size of the elements.",
		((Real,eosPressure,1.1e9,Attr::triggerPostLoad,"Pressure :math:`p_{EOS}` [Pa] at which the moduli have doubled."))
		((Real,eosExponent,2./3,Attr::triggerPostLoad,"Exponent :math:`n_{EOS}` [-] of the equation of state."))
		((Real,strength,140e6,Attr::triggerPostLoad,"Strength :math:`\\sigma_{p0}` [Pa] of the undamaged material in the flow rule (eq. 7)."))
		((Real,flowFactor,6.7,Attr::triggerPostLoad,"Factor :math:`\\Lambda_0` [-] of the flow rate (eq. 7)."))
		((Real,flowExponent,.5,Attr::triggerPostLoad,"Exponent :math:`n_p` [-] of the equivalent stress (eq. 7)."))
		((Real,rateExponent,.96,Attr::triggerPostLoad,"Exponent :math:`\\omega_p` [-] of the strain rate (eq. 7); 1 means no rate dependence."))
		((Real,frictionPressure,600e6,Attr::triggerPostLoad,"Pressure :math:`p_{q0}` [Pa] that scales the decay of friction."))
		((Real,frictionPressureExponent,.5,Attr::triggerPostLoad,"Exponent :math:`n_q` [-] of the decay of friction with pressure."))
		((Real,friction,.66,Attr::triggerPostLoad,"Friction :math:`q_0` [-] without pressure (eq. 5); a number below 1, not an angle."))
		((Real,closedGrowth,.5,Attr::triggerPostLoad,"Growth of damage :math:`\\xi_{c0}` [-] in a closed crack, relative to an open one (eq. 8)."))
		((Real,closedEffect,.1,Attr::triggerPostLoad,"Effect of damage on elasticity :math:`\\xi_{c1}` [-] in a closed crack, relative to an open one."))
		((Real,fractureEnergy,80e3,Attr::triggerPostLoad,"Fracture energy :math:`G_f` [J/m³] (eq. 8); :yref:`DeformableTriangle.fractureEnergy` overrides it for one triangle."))
		((Real,damageExponent,2,Attr::triggerPostLoad,"Exponent :math:`n_f` [-] of the damage parameter."))
		((Real,damageLimit,1,Attr::triggerPostLoad,"Largest loss of stiffness :math:`\\eta_{max}` [-], at most 1."))
		((Real,closureBand,1e6,Attr::triggerPostLoad,"Crack-normal stress [Pa] over which a closing crack recovers; 0: at once."))
		((Real,referenceRate,1,Attr::triggerPostLoad,"Strain rate :math:`\\dot e_0` [1/s] that scales the strain rate (eq. 7)."))
		((Real,sharingTolerance,.05,Attr::triggerPostLoad,"Principal stresses closer than this share [-] of the largest share the flow, so that its direction does not jitter where they coincide."))
		((Real,residual,1e-6,Attr::triggerPostLoad,"Share [-] of strength and stiffness that complete damage leaves, so that nothing divides by zero."))
		((bool,viscoplasticFlow,true,,"Simulate viscoplastic flow (eqs. 5-7); off: elastic, and damage cannot grow."))
		((bool,rateDependence,true,,"Let the flow depend on the strain rate (eq. 7); off: as if :math:`\\omega_p` = 1."))
		((bool,damage,true,,"Simulate damage: growth (eq. 8), loss of strength and of stiffness."))
		((bool,equationOfState,true,,"Let the moduli grow with pressure.")),
		createIndex(); setModuli(30e9, 26e9); density = 2400;,
	);
	// clang-format on
	REGISTER_CLASS_INDEX(ConcreteDamageMat, DeformableElastMat);
};
REGISTER_SERIALIZABLE(ConcreteDamageMat);

} // namespace yade
