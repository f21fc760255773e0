// GPL v2 or later, see LICENSE.
// Watches O.dt and the shape of triangles: stops a run before it blows up or goes on with triangles turned inside out.
#pragma once

#include <pkg/ddem/Exposure.hpp>

namespace yade {

class DeformableTimeStepper;

class TimeStepGuard {
public:
	/** To be called in every step; looks at all triangles only when O.dt has changed, and now and then.
	 * \param stepper the one in O.engines, if any; \param other another engine that sets O.dt, if any.
	 * \param stopAtInverted false: a triangle inside out is only warned of, once.
	 * \returns a warning, or nothing.
	 * \throws std::runtime_error for a step that is not positive and finite, above the critical one,
	 * or alternating, and for a triangle that is inside out. */
	std::string
	check(const Scene& scene, const Exposure& sample, const DeformableTimeStepper* stepper, const Engine* other,
	      bool stopAtInverted);
	/// The arrays are new: everything is to be looked at again. `stiffens` where pressure may raise the moduli.
	void restart(bool stiffens);
	/// Whether O.dt has not been compared with the bound yet.
	bool unchecked(const Scene& scene) const { return scene.dt != stable; }

private:
	Real stable   = 0; ///< time step that was last found stable [s]
	long interval = 1; ///< steps between looks

	// steps that go up and down
	Real last = 0, direction = 0; ///< last time step [s], and the sign of its last change
	long firstTurn = 0;
	int  turns     = 0;
	bool warned    = false; ///< of a triangle inside out

	void checkAlternation(const Scene& scene);
};

} // namespace yade
