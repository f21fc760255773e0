// GPL v2 or later, see LICENSE.
// Metal of deformable triangles that yields.
#pragma once

#include <pkg/ddem/LawMaterial.hpp>
#include <pkg/ddem/kernel/laws/VonMises.hpp>

namespace yade {

class VonMisesMat : public DeformableElastMat {
public:
	virtual ~VonMisesMat() = default;
	DDEM_LAW_OF_MATERIAL(VonMisesMat, ddem::VonMises, VON_MISES_PARAMETERS, VON_MISES_EFFECTS)

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR(VonMisesMat, DeformableElastMat,
		"Metal of :yref:`DeformableTriangle` that yields: von Mises (J2) plasticity with linear isotropic "
		"hardening, integrated by radial return (Simo and Hughes 1998). Defaults are the steel 304L of "
		"[Zubelewicz2018]_.\n\n"
		"It yields where :math:`\\sqrt{3/2}\\,|s|=\\sigma_y+H\\alpha`, s being the deviator of the stress "
		"and :math:`\\alpha` the accumulated plastic strain: in uniaxial stress at :math:`\\sigma_y`, then "
		"with the slope :math:`EH/(E+H)`; in shear at :math:`\\sigma_y/\\sqrt3`. Plastic strain has no "
		"volume. All work on it counts as dissipated, with the part :math:`\\tfrac12H\\alpha^2` that "
		"hardening keeps in the metal.\n\n"
		"Errors: ValueError for a parameter out of bounds.\n\n"
		"Limits: small strain in the element's frame; no rate, no kinematic hardening (reversed loads yield "
		"no sooner), no failure.",
		VON_MISES_PARAMETERS(DDEM_ATTRIBUTE) VON_MISES_EFFECTS(DDEM_SWITCH),
		createIndex(); takeElasticityOfLaw();
	);
	// clang-format on
	REGISTER_CLASS_INDEX(VonMisesMat, DeformableElastMat);
};
REGISTER_SERIALIZABLE(VonMisesMat);

} // namespace yade
