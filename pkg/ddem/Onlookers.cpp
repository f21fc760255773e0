// GPL v2 or later, see LICENSE.
#include <pkg/ddem/Onlookers.hpp>

#include <core/TimeStepper.hpp>
#include <pkg/common/PyRunner.hpp>

#include <typeinfo>

namespace yade {

namespace {

	/// other threads see no older state where that is cheap
	constexpr auto shortestUnseen = std::chrono::milliseconds(200);
	constexpr int  shareOfTime    = 50; ///< a showing may take one part in so many of the time between

	/// Whether a periodic engine may act at the given step and times, as PeriodicEngine::isActivated decides;
	/// `early` by so much of real time rather than late.
	bool isDue(const PeriodicEngine& e, long iter, Real time, Real early)
	{
		if (e.firstIterRun > 0 && e.nDone == 0) return e.firstIterRun == iter;
		const long done = iter < e.iterLast ? 0 : e.nDone;
		const bool due  = (e.virtPeriod > 0 && time - e.virtLast >= e.virtPeriod)
		        || (e.realPeriod > 0 && PeriodicEngine::getClock() + early - e.realLast >= e.realPeriod)
		        || (e.iterPeriod > 0 && iter - e.iterLast >= e.iterPeriod);
		return ((e.nDo < 0 || done < e.nDo) && due) || (done == 0 && e.initRun);
	}

	/// Whether an engine acts at the given step and times and is not known to leave alone what others compute.
	bool looks(const Engine& e, bool (*neverLooks)(const Engine&), long iter, Real time, Real clockSlack)
	{
		if (e.dead || neverLooks(e)) return false;
		const auto* periodic = dynamic_cast<const PeriodicEngine*>(&e);
		if (periodic && !isDue(*periodic, iter, time, clockSlack)) return false;
		const auto* stepper = dynamic_cast<const TimeStepper*>(&e); // as TimeStepper::isActivated decides
		return !stepper || (stepper->active && iter % stepper->timeStepUpdateInterval == 0);
	}

} // namespace

bool Showings::due() const
{
	const auto since = std::chrono::steady_clock::now() - finished, cost = finished - started;
	return since > shortestUnseen && since > shareOfTime * cost;
}

Onlooker onlooker(
        const Scene& scene, const Engine& self, const Showings& showings, bool (*neverLooks)(const Engine&),
        Real clockSlack, const Engine* until)
{
	const long next = scene.iter + 1;
	const Real then = scene.time + scene.dt;
	if (!Omega::instance().isRunning()) return Onlooker::Anybody; // O.step, or a pause was asked for
	if (!scene._nextEngines.empty()) return Onlooker::Anybody;     // others act in the next step
	if (scene.stopAtIter > 0 && next >= scene.stopAtIter) return Onlooker::Anybody;
	if (scene.stopAtTime > 0 && then >= scene.stopAtTime * (1 - 1e-12)) return Onlooker::Anybody;
	bool before = true; // engines before this one act next in the next step
	bool within = true; // the time in question
	bool python = false;
	for (const auto& e : scene.engines) {
		if (e.get() == until) within = false;
		if (e.get() == &self) {
			before = false;
			within = true;
			continue;
		}
		if (!within
		    || !looks(*e, neverLooks, before ? next : scene.iter, before ? then : scene.time, clockSlack))
			continue;
		if (typeid(*e) != typeid(PyRunner)) return Onlooker::Anybody;
		python = true;
	}
	if (python) return Onlooker::Python;
	return showings.due() ? Onlooker::OtherThreads : Onlooker::Nobody;
}

bool looksBetween(
        const Scene& scene, const Engine& first, const Engine& second, bool (*neverLooks)(const Engine&),
        Real clockSlack)
{
	if (scene.subStepping) return true;
	bool within = false;
	for (const auto& e : scene.engines) {
		if (e.get() == &second) return false;
		if (e.get() == &first) within = true;
		else if (within && looks(*e, neverLooks, scene.iter, scene.time, clockSlack))
			return true;
	}
	return false;
}

} // namespace yade
