// GPL v2 or later, see LICENSE.
// Moves bodies along an axis, with a speed that grows linearly to its full value.
#pragma once

#include <pkg/ddem/YadeInclude.hpp>

namespace yade {

class RampedTranslationEngine : public TranslationEngine {
public:
	virtual ~RampedTranslationEngine() = default;
	void apply(const vector<Body::id_t>& ids) override;

	/// Present speed [m/s]; steps before the start have none.
	Real speed(Real time) const;
	Real currentSpeed() const;

	void postLoad(RampedTranslationEngine&);

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(RampedTranslationEngine, TranslationEngine,
		"Translation with a speed that grows linearly, :math:`v=\\min(t/t_r,1)\\,v_{max}`, :math:`t` from the "
		"engine's first step, so that a specimen is not hit. It sets :yref:`State.vel` of any bodies: platens, "
		"spheres, nodes of deformable triangles (block their DOFs). Place it after the engines that add forces "
		"and before :yref:`NewtonIntegrator`.\n\n"
		"With :yref:`O.trackEnergy<Omega.trackEnergy>` the work of the bodies' motion against the forces on "
		"them enters *externalWork* [J] (negative: it comes from outside), except for bodies that "
		":yref:`NewtonIntegrator.mask` leaves out, whose own engine books it.\n\n"
		"Errors: ValueError for a negative rampTime.",
		((Real,rampTime,0,Attr::triggerPostLoad,"Time over which the speed grows [s]; 0: full speed at once"))
		((Real,startTime,NaN,,"Time at which the motion starts [s]; NaN: at the engine's first step"))
		((bool,ahead,false,,
			"Whether the bodies are a step ahead: in each step they reach the place that they would "
			"otherwise have at its end before forces act, as the walls of ESyS-Particle do"))
		((Real,work,0,Attr::readonly,
			"Work done on the rest of the scene so far [J], booked while energy is tracked"))
		((Real,lastForce,0,(Attr::readonly|Attr::hidden),
			"Force along the axis that the bodies exerted in the last step [N]"))
		((int,workIx,-1,(Attr::hidden|Attr::noSave),"Place of externalWork in the energy tracker")),
		/*ctor*/ translationAxis = Vector3r(0,1,0); velocity = 0;,
		.add_property("speed",&RampedTranslationEngine::currentSpeed,
			"Speed at the present time [m/s], along "
			":yref:`translationAxis<TranslationEngine.translationAxis>`")
	);
	// clang-format on
};
REGISTER_SERIALIZABLE(RampedTranslationEngine);

} // namespace yade
