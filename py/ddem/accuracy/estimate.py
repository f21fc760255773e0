# GPL v2 or later, see LICENSE.
"""What a run will take, before it is run."""
import dataclasses
import math
from dataclasses import dataclass, field

from yade import DeformableEngine, O, ddem

from .. import meter
from . import ladders, prediction, scene_cost, sentences, study


@dataclass(frozen=True)
class Estimate:
	"""What :func:`estimate` found; ``print`` shows it."""
	steps: int
	particles: int
	kind: str  # of the particles
	ns_now: float  # processor time of a step over the particles, in the state that the scene is in [ns]
	ns_strained: float  # the same where all of it is strained, or half of the bonds have broken [ns]
	memory_MB: float  # of this process at the end
	dt: float  # [s]
	critical: float  # critical time step [s]
	ruling: int = None  # id of the triangle that rules it, None where there are none
	place: tuple = None  # where it is [m]
	effects: dict = field(default_factory=dict)  # switch of a material -> share of the strained step that it costs
	left_out: tuple = ()  # labels or names of engines that were not measured
	# of prediction.Prediction, one a quantity of the ladder: errors of this scene, and of one that meets the target
	expected: tuple = ()
	needed: tuple = ()

	@property
	def seconds(self):
		"""Core-seconds of the run: from those of the present state to those of a strained one."""
		each = 1e-9 * self.steps * self.particles
		return tuple(sorted((each * self.ns_now, each * self.ns_strained)))

	def __str__(self):
		low, high = self.seconds
		between = f"{low:.3g}" if high < 1.05 * low else f"{low:.3g} to {high:.3g}"
		later = "where all is strained" if self.kind == "triangle" else "where half of the bonds have broken"
		lines = [
			f"{self.steps} steps of {self.particles} {self.kind}s: {between} core-seconds "
			f"({meter.nanoseconds(self.ns_now)} a {self.kind}-step now, "
			f"{meter.nanoseconds(self.ns_strained)} {later}), {self.memory_MB:.0f} MB",
			f"time step {self.dt:.3g} s, {self.dt / self.critical:.2f} of the critical one",
		]
		if self.ruling is not None:
			lines[1] += (
				f", which triangle {self.ruling} at ({self.place[0]:.4g}, {self.place[1]:.4g}) m rules"
			)
		lines += [f"{name} is {100 * share:.0f} % of a strained step" for name, share in self.effects.items()]
		if self.left_out:
			lines.append(f"without {', '.join(self.left_out)}")
		for found in self.expected:
			lines.append(
				(
					f"expected error of {found.quantity}: {sentences.per_cent(found.error)}, "
					f"order {found.order:.2g}"
				)
				+ (
					", which has not settled: within a factor of two or three"
					if found.settled is False
					else ""
				)
			)
		for found in self.needed:
			lines.append(
				f"{sentences.per_cent(found.error)} in {found.quantity} needs {found.step:.3g}: "
				f"{sentences.seconds(found.cpu_s)} of processor time, {found.memory_MB:.0f} MB more "
				"than YADE"
			)
		return "\n".join(lines)


def estimate(until=None, steps=None, target=None, ladder=None, rung=None, bench=2.0, budget=60.0, fresh=False):
	"""What a run of the present scene will take: its steps are timed in a copy of it, in a YADE of its own, once as
	it is and once with all particles moving at random, as they will when the load has reached them (spheres: with
	half of their bonds broken); then with each effect of its materials off. What was measured is kept,
	see :mod:`scene_cost`.

	::

		print(ddem.estimate(until=1e-3))
		ddem.run(until=1e-3)

	Where the scene belongs to a ladder, its error is expected by the order that cheaper rungs show, which are run
	where they have not been::

		print(ddem.estimate(until=1e-3, ladder="cantilever", rung={"size": 0.005}, target=0.01))

	:param until: time to run to [s]; or
	:param steps: number of steps
	:param ladder: :class:`ladders.Ladder`, or the name of one of ``accuracy_cost.py``, that refines something
	:param rung: the settings of it that this scene has
	:param target: error that is wanted [-]; says what that needs
	:param bench: time for the measurement of the steps [s]
	:param budget: time for rungs of the ladder that have not been run [s]
	:param fresh: time the steps also where they have been
	:returns: :class:`Estimate`
	:raises ValueError: neither or both of until and steps, a time that has passed, no time step; a target without a
		ladder, a ladder without an order
	:raises RuntimeError: the copy does not run

	Limits: the number of steps holds for the present O.dt; a :yref:`DeformableTimeStepper` lowers it where
	triangles are stretched or compressed, and adds steps. PyRunners and recorders are left out. What softens or
	breaks lies between the two times, and so does what spreads through a scene at rest.
	"""
	if (until is None) == (steps is None):
		raise ValueError("give either until= [s] or steps=")
	if not (O.dt > 0 and math.isfinite(O.dt)):
		raise ValueError(f"O.dt = {O.dt} s must be positive; set O.dt = ddem.time_step(0.8)")
	if steps is None:
		if not O.time <= until < math.inf:
			raise ValueError(f"until = {until} s must not lie before the present time, {O.time} s")
		steps = math.ceil((until - O.time) / O.dt - 1e-9)
	expected, needed = _errors(target, ladder, rung, budget)
	engines = [engine for engine in O.engines if isinstance(engine, DeformableEngine)]
	ruling = min((engine.rulingTriangle() for engine in engines), key=lambda found: found[1], default=None)
	critical = ruling[1] if engines else ddem.bonded.critical_time_step()
	found = scene_cost.measured(bench, fresh)
	grown = found["grown_MB"] if O.iter == 0 else 0.0
	return Estimate(
		steps, meter.particles(), "triangle" if engines else "sphere", found["ns_now"], found["ns_strained"],
		meter.memory() / 2**20 + grown, O.dt, critical, ruling and ruling[0],
		ruling and tuple(O.bodies[ruling[0]].state.pos)[:2],
		{name.partition(":")[2]: share for name, share in found.items() if name.startswith("effect:")},
		tuple(
			engine.label or type(engine).__name__
			for engine in O.engines
			if type(engine).__name__ in scene_cost.APART
		),
		expected, needed
	)


def _errors(target, ladder, rung, budget):
	"""Predictions for a rung of a ladder, and for a target error, one a quantity."""
	if ladder is None:
		if target is not None or rung is not None:
			raise ValueError(
				"an error is expected by the rungs of a ladder: give ladder= and rung= beside "
				"target=, see ddem.accuracy.ladders"
			)
		return (), ()
	if isinstance(ladder, str):
		(ladder, ) = ladders.find(ladder)
	if rung is None or not ladder.refined:
		raise ValueError(
			f"ladder '{ladder.name}': give rung= with the setting that it refines, which must be one"
		)
	step = ladder.step(rung)
	coarser = tuple(one for one in ladder.rungs if ladder.step(one) > 1.001 * step)
	if len(coarser) < 2:
		raise ValueError(
			f"ladder '{ladder.name}': an order needs two rungs that are coarser than "
			f"{ladders.label(rung)}, and there are {len(coarser)}"
		)
	work = study.Study(
		[dataclasses.replace(ladder, rungs=coarser, usual=coarser[-1])], scene_cost.cache("rungs"),
		threads=O.numThreads,
		budget=budget
	)
	points, found, needed = work.run(), [], []
	for name in dict.fromkeys(point.quantity for point in points):
		laws = prediction.Laws([point for point in points if point.quantity == name])
		found.append(laws.at(step))
		if target is not None:
			needed.append(laws.reaching(target))
	return tuple(found), tuple(needed)
