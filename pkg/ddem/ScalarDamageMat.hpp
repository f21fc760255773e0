// GPL v2 or later, see LICENSE.
// Quasi-brittle material of deformable triangles: isotropic damage.
#pragma once

#include <pkg/ddem/LawMaterial.hpp>
#include <pkg/ddem/kernel/laws/ScalarDamage.hpp>

namespace yade {

class ScalarDamageMat : public DeformableElastMat {
public:
	virtual ~ScalarDamageMat() = default;
	DDEM_LAW_OF_MATERIAL(ScalarDamageMat, ddem::ScalarDamage, SCALAR_DAMAGE_PARAMETERS, SCALAR_DAMAGE_EFFECTS)

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR(ScalarDamageMat, DeformableElastMat,
		"Quasi-brittle material of :yref:`DeformableTriangle`: isotropic damage with Mazars' equivalent "
		"strain (Mazars 1984), exponential softening and crack band (Bažant and Oh 1983). Defaults are an "
		"ordinary concrete.\n\n"
		"Stress is :math:`(1-d)\\,C:\\varepsilon`; damage grows with the largest equivalent strain "
		":math:`\\kappa=\\max\\sqrt{\\sum\\langle\\varepsilon_i\\rangle^2}` beyond :math:`\\kappa_0=f_t/E` "
		"as :math:`1-d=(\\kappa_0/\\kappa)\\exp(-(\\kappa-\\kappa_0)/\\kappa_s)`, with "
		":math:`\\kappa_s=G_F/(hf_t)-\\kappa_0/2`, :math:`h=\\sqrt{2S}` and S the area of the triangle.\n\n"
		"Errors: ValueError for a parameter out of bounds; for triangles so large that stress would have to "
		"snap back (:math:`h\\ge2G_FE/f_t^2`, 0.67 m with the defaults); for an initialDamage or a "
		"bandFactor, which this law has not.\n\n"
		"Limits: small strain in the element's frame; no rate. It is for tension: unconfined compression "
		"breaks at :math:`f_t/(\\sqrt2\\nu)`, 3.5 :math:`f_t` with the defaults, where concrete bears 10, "
		"and cracks that close do not get their stiffness back. :math:`f_t` and :math:`G_F` hold in uniaxial "
		"stress; in plane strain with free sides both are :math:`1/(1-\\nu^2)` of that. Strain may gather in "
		"some of a triangle's sub-elements: a crack takes two thirds or more of :math:`G_F`, whatever the "
		"size (from 20 to 5 mm 0.74 in alternating, 0.75 in unstructured and 0.91 to 1.05 in crossed meshes).",
		SCALAR_DAMAGE_PARAMETERS(DDEM_ATTRIBUTE) SCALAR_DAMAGE_EFFECTS(DDEM_SWITCH),
		createIndex(); takeElasticityOfLaw();
	);
	// clang-format on
	REGISTER_CLASS_INDEX(ScalarDamageMat, DeformableElastMat);
};
REGISTER_SERIALIZABLE(ScalarDamageMat);

} // namespace yade
