// GPL v2 or later, see LICENSE.
// The models compute a sample in one process, with threads: the check that it is one.
#include <pkg/ddem/SingleProcess.hpp>

#include <cstdlib>

namespace yade {

namespace {

#ifdef YADE_MPI
	bool mpiIsAtWork()
	{
		int started = 0, finished = 0;
		MPI_Initialized(&started);
		MPI_Finalized(&finished);
		return started && !finished;
	}

	void abortIfAtWork()
	{
		if (mpiIsAtWork()) MPI_Abort(MPI_COMM_WORLD, 1);
	}

	/// Ends the other processes with this one: they may wait for it in a collective call, as its MPI_Finalize does
	/// for them. Python calls this before MPI_Finalize of mpi4py, which was registered first.
	void endTogether()
	{
		static const int registered = Py_AtExit(abortIfAtWork);
		(void)registered;
	}
#endif

	[[noreturn]] void refuse(const std::string& why)
	{
#ifdef YADE_MPI
		if (mpiIsAtWork()) endTogether();
#endif
		throw std::runtime_error(
		        "not under mpirun yet: " + why
		        + "; run it as one process with threads, without mpirun: yade -jN SCRIPT, "
		          "or scripts/ddem run --threads N SCRIPT");
	}

	/// Of this program; 1 without MPI.
	int numberOfProcesses()
	{
#ifdef YADE_MPI
		if (mpiIsAtWork()) {
			int size = 1;
			MPI_Comm_size(MPI_COMM_WORLD, &size);
			return size;
		}
#endif
		// YADE starts MPI late or never, so the launcher is asked: Open MPI, MPICH and its kin, MVAPICH.
		// Slurm's variables do not count: SLURM_NTASKS is there for a single process in an allocation, too, and
		// what srun starts need not be MPI.
		for (const char* name : { "OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MV2_COMM_WORLD_SIZE" }) {
			const char* const value = std::getenv(name);
			if (value && std::atoi(value) > 0) return std::atoi(value);
		}
		return 1;
	}

} // namespace

void requireSingleProcess()
{
	const int processes = numberOfProcesses();
	if (processes > 1)
		refuse("every process would compute the whole sample (this is one of " + std::to_string(processes)
		       + ")");
}

void requireSingleProcess(const Scene& scene)
{
	requireSingleProcess();
#ifdef YADE_MPI
	if (scene.subdomain != 0 || scene.subD->getClassName() == "Subdomain")
		refuse(
		        "the scene is divided into subdomains of MPI (this is number " + std::to_string(scene.subdomain)
		        + "), and what reaches over their borders would be lost");
#else
	(void)scene;
#endif
}

} // namespace yade
