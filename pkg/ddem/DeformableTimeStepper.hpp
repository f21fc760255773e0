// GPL v2 or later, see LICENSE.
// The engine that keeps O.dt below the critical time step of the deformable triangles.
#pragma once

#include <pkg/ddem/YadeInclude.hpp>

#include <core/TimeStepper.hpp>

namespace yade {

class DeformableTimeStepper : public TimeStepper {
public:
	virtual ~DeformableTimeStepper() = default;
	void computeTimeStep(Scene*) override;
	void postLoad(DeformableTimeStepper&);

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR(DeformableTimeStepper, TimeStepper,
		"Keeps O.dt below :yref:`safety<DeformableTimeStepper.safety>` times the critical time step of deformable triangles (:yref:`DeformableEngine.criticalTimeStep`), which falls where they stretch to "
		"a multiple of their size and where pressure stiffens them, and rises again afterwards. It never sets more than :yref:`largest<DeformableTimeStepper.largest>`, by default O.dt as it is when the stepper first acts.\n\n"
		"Place it before :yref:`DeformableEngine`, right after :yref:`ForceResetter`. It looks every :yref:`timeStepUpdateInterval<TimeStepper.timeStepUpdateInterval>` steps (100); a scene whose triangles stay small in strain is not changed by it.\n\n"
		"Errors: safety outside (0, 1], largest below 0. Limits: O.dt set by hand during a run is taken back at the next look unless largest is set as well.",
		((Real,safety,0.8,Attr::triggerPostLoad,"Part of the critical time step [-], above 0 and at most 1"))
		((Real,largest,0,Attr::triggerPostLoad,"Largest time step [s]; 0: O.dt when the stepper first acts")),
		timeStepUpdateInterval = 100;
	);
	// clang-format on
	DECLARE_LOGGER;
};
REGISTER_SERIALIZABLE(DeformableTimeStepper);

} // namespace yade
