// GPL v2 or later, see LICENSE.
// Viscous damping of translation and rotation of every particle.
#pragma once

#include <pkg/ddem/YadeInclude.hpp>

namespace yade {

class ViscousBodyDamping : public GlobalEngine {
public:
	virtual ~ViscousBodyDamping() = default;
	void action() override;
	void postLoad(ViscousBodyDamping&);

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR(ViscousBodyDamping, GlobalEngine,
		"Force :math:`-\\gamma m \\bar v` and moment :math:`-\\gamma_r I \\bar\\omega` on every body that "
		":yref:`NewtonIntegrator` moves, like LinDamping and RotDamping of ESyS-Particle [Weatherley2014]_; "
		":math:`\\bar v` is the mean of the velocities before and after the step, so that damping is stable "
		"for any coefficient. A free body slows down as :math:`e^{-\\gamma t}`.\n\n"
		"Place it after all engines that add forces and right before NewtonIntegrator, whose own "
		":yref:`damping<NewtonIntegrator.damping>` (0.2 by default) should then be 0. With "
		":yref:`O.trackEnergy<Omega.trackEnergy>` it books *bodyDamping* [J].\n\n"
		"Errors: ValueError for negative coefficients; an engine order in which forces would be missed stops "
		"the run. Limits: spheres (equal moments of inertia) and clump-free scenes.",
		((Real,viscosity,2,Attr::triggerPostLoad,
			"Coefficient :math:`\\gamma` of translation [1/s]. The default is ESyS-Particle's 0.002 /ms."))
		((Real,rotationalViscosity,2,Attr::triggerPostLoad,"Coefficient :math:`\\gamma_r` of rotation [1/s]"))
		((Real,lastLoss,0,(Attr::readonly|Attr::hidden),"Energy taken away in the last step [J]"))
		((int,lossIx,-1,(Attr::hidden|Attr::noSave),"Place of bodyDamping in the energy tracker")),
		/*ctor*/
	);
	// clang-format on

private:
	/// \throws std::runtime_error unless this engine stands between the interactions and NewtonIntegrator
	const NewtonIntegrator& checkedIntegrator() const;
};
REGISTER_SERIALIZABLE(ViscousBodyDamping);

} // namespace yade
