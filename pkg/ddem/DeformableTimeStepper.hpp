// GPL v2 or later, see LICENSE.
// The engine that lets O.dt follow the critical time step of the deformable triangles.
#pragma once

#include <pkg/ddem/YadeInclude.hpp>

#include <core/TimeStepper.hpp>

namespace yade {

class DeformableTimeStepper : public TimeStepper {
public:
	virtual ~DeformableTimeStepper() = default;
	bool isActivated() override;
	void computeTimeStep(Scene*) override;
	void postLoad(DeformableTimeStepper&);

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR(DeformableTimeStepper, TimeStepper,
		"Keeps O.dt near :yref:`safety<DeformableTimeStepper.safety>` times the critical time step of "
		"deformable triangles (:yref:`DeformableEngine.criticalTimeStep`), which falls where they stretch to "
		"a multiple of their size and where pressure stiffens them, and rises again afterwards. It never sets "
		"more than :yref:`largest<DeformableTimeStepper.largest>`, by default O.dt as it is when the stepper "
		"first acts.\n\n"
		"Place it before :yref:`DeformableEngine`, right after :yref:`ForceResetter`. It looks every "
		":yref:`timeStepUpdateInterval<TimeStepper.timeStepUpdateInterval>` steps (10, enough for impacts of "
		"10 m/s on concrete; take 1 for 50 m/s and more), and lowers O.dt once a tenth of what is left up to "
		"the critical step is used up (from 0.82 on with safety 0.8): a scene whose triangles stay small in "
		"strain is not changed by it, and steps that change all the time, which would excite vibrations, are "
		"avoided.\n\n"
		"Errors: safety outside (0, 1], largest below 0; a place after DeformableEngine or beside another "
		"engine that sets O.dt stops the run. Limits: O.dt set by hand during a run is taken back at the next "
		"look unless largest is set as well.",
		((Real,safety,0.8,Attr::triggerPostLoad,"Part of the critical time step [-], above 0 and at most 1"))
		((Real,largest,0,Attr::triggerPostLoad,"Largest time step [s]; 0: O.dt when the stepper first acts")),
		timeStepUpdateInterval = 10;
	);
	// clang-format on
	DECLARE_LOGGER;
};
REGISTER_SERIALIZABLE(DeformableTimeStepper);

} // namespace yade
