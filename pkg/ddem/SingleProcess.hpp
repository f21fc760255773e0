// GPL v2 or later, see LICENSE.
// The models compute a sample in one process, with threads: the check that it is one.
#pragma once

#include <pkg/ddem/YadeInclude.hpp>

#include <atomic>

namespace yade {

/** Refuses to run where several MPI processes would each compute the whole sample: those of MPI itself where it has
 * been started, else those that mpirun or mpiexec say they have started.
 * \throws std::runtime_error with their number and the way out
 */
void requireSingleProcess();

/** The same, and refuses a scene that YADE's mpy has divided among processes: what reaches over the borders, bonds and
 * triangles, would be lost.
 */
void requireSingleProcess(const Scene& scene);

/// The same check for every step or bond: it asks again only for another scene or once the scene has been divided.
class SingleProcess {
public:
	void require(const Scene& scene)
	{
		const void* const whole = wholeOf(scene);
		if (whole == passed.load(std::memory_order_relaxed)) return;
		requireSingleProcess(scene);
		passed.store(whole, std::memory_order_relaxed);
	}

private:
	/// Stands for a scene as it is: mpy gives it a subdomain of its own.
	static const void* wholeOf(const Scene& scene)
	{
#ifdef YADE_MPI
		return scene.subD.get();
#else
		return &scene;
#endif
	}

	std::atomic<const void*> passed { nullptr };
};

} // namespace yade
