// GPL v2 or later, see LICENSE.
// Concrete: the viscoplastic damage material of deformable triangles.
#pragma once

#include <pkg/ddem/LawMaterial.hpp>
#include <pkg/ddem/kernel/laws/ConcreteDamage.hpp>

namespace yade {

class ConcreteDamageMat : public DeformableElastMat {
public:
	virtual ~ConcreteDamageMat() = default;
	DDEM_LAW_OF_MATERIAL(ConcreteDamageMat, ddem::ConcreteDamage, CONCRETE_PARAMETERS, CONCRETE_EFFECTS)

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR(ConcreteDamageMat, DeformableElastMat,
		"Concrete of :yref:`DeformableTriangle`: viscoplastic Mohr-Coulomb flow, tensorial damage, degradation "
		"of elasticity, equation of state [Zubelewicz2018]_, section 3. Defaults are the report's Tables 1 and "
		"2: a high-strength concrete, about 91 MPa in compression and 10 MPa in tension at 1/s.\n\n"
		"An effect that is switched off is not evaluated. Three things are not printed in the report and "
		"closed here so that its Table 2, unchanged, gives its strengths: the strain rate of eq. 7 is "
		":math:`\\dot e_N=\\sqrt{\\dot\\varepsilon:\\dot\\varepsilon/2}`, friction decays as "
		":math:`q_D=q_0(1+\\langle p\\rangle/p_{q0})^{-n_q}`, and equal principal stresses share the flow.\n\n"
		"Limits: small strain in the element's frame; fracture energy is per volume, so the energy of a crack "
		"scales with the size of the elements.",
		CONCRETE_PARAMETERS(DDEM_ATTRIBUTE) CONCRETE_EFFECTS(DDEM_SWITCH),
		createIndex(); takeElasticityOfLaw();
	);
	// clang-format on
	REGISTER_CLASS_INDEX(ConcreteDamageMat, DeformableElastMat);
};
REGISTER_SERIALIZABLE(ConcreteDamageMat);

} // namespace yade
