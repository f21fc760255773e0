# GPL v2 or later, see LICENSE.
"""What a run will take, before it is run."""
import math
import os
import random
import tempfile
from dataclasses import dataclass, field

from yade import DeformableEngine, O, ddem

from .. import meter
from ..studies.questions import Questions

_APART = ("PyRunner", "SnapshotEngine", "VTKRecorder", "TorqueRecorder", "ForceRecorder")  #: engines left out


@dataclass(frozen=True)
class Estimate:
	"""What :func:`estimate` found; ``print`` shows it."""
	steps: int
	particles: int
	kind: str  # of the particles
	ns_now: float  # processor time of a step over the particles, in the state that the scene is in [ns]
	ns_strained: float  # the same where all of it is strained, which laws that rest at first cost in the end [ns]
	memory_MB: float  # of the process with the scene, YADE included
	dt: float  # [s]
	critical: float  # critical time step [s]
	ruling: int = None  # id of the triangle that rules it, None where there are none
	place: tuple = None  # where it is [m]
	effects: dict = field(default_factory=dict)  # switch of a material -> share of the strained step that it costs
	left_out: tuple = ()  # labels or names of engines that were not measured

	@property
	def seconds(self):
		"""Core-seconds of the run: from those of the present state to those of a strained one."""
		each = 1e-9 * self.steps * self.particles
		return tuple(sorted((each * self.ns_now, each * self.ns_strained)))

	def __str__(self):
		low, high = self.seconds
		between = f"{low:.3g}" if high < 1.05 * low else f"{low:.3g} to {high:.3g}"
		lines = [
			f"{self.steps} steps of {self.particles} {self.kind}s: {between} core-seconds "
			f"({meter.nanoseconds(self.ns_now)} a {self.kind}-step now, "
			f"{meter.nanoseconds(self.ns_strained)} where all is strained), "
			f"{self.memory_MB:.0f} MB",
			f"time step {self.dt:.3g} s, {self.dt / self.critical:.2f} of the critical one",
		]
		if self.ruling is not None:
			lines[1] += (
				f", which triangle {self.ruling} at ({self.place[0]:.4g}, {self.place[1]:.4g}) m rules"
			)
		lines += [f"{name} is {100 * share:.0f} % of a strained step" for name, share in self.effects.items()]
		if self.left_out:
			lines.append(f"without {', '.join(self.left_out)}")
		return "\n".join(lines)


def estimate(until=None, steps=None, bench=2.0):
	"""What a run of the present scene will take: its steps are timed in a copy of it, in a YADE of its own, once as
	it is and once with all particles moving at random, as they will when the load has reached them; then with each
	effect of its materials off.

	::

		print(ddem.estimate(until=1e-3))
		ddem.run(until=1e-3)

	:param until: time to run to [s]; or
	:param steps: number of steps
	:param bench: time for each of these measurements together [s]
	:returns: :class:`Estimate`
	:raises ValueError: neither or both of them, a time that has passed, no time step
	:raises evaluations.EvaluationError: the copy does not run

	Limits: the number of steps holds for the present O.dt; a :yref:`DeformableTimeStepper` lowers it where
	triangles are stretched or compressed, and adds steps. Bonds are measured as they hold now.
	PyRunners and recorders are left out.
	"""
	if (until is None) == (steps is None):
		raise ValueError("give either until= [s] or steps=")
	if not (O.dt > 0 and math.isfinite(O.dt)):
		raise ValueError(f"O.dt = {O.dt} s must be positive; set O.dt = ddem.time_step(0.8)")
	if steps is None:
		if not O.time <= until < math.inf:
			raise ValueError(f"until = {until} s must not lie before the present time, {O.time} s")
		steps = math.ceil((until - O.time) / O.dt - 1e-9)
	engines = [engine for engine in O.engines if isinstance(engine, DeformableEngine)]
	ruling = min((engine.rulingTriangle() for engine in engines), key=lambda found: found[1], default=None)
	critical = ruling[1] if engines else ddem.bonded.critical_time_step()
	with tempfile.TemporaryDirectory(prefix="ddem-") as folder:
		scene = os.path.join(folder, "scene.bin")
		O.save(scene, quiet=True)
		found = Questions(__name__, threads=O.numThreads).ask({"scene": scene, "seconds": bench})
	return Estimate(
		steps, meter.particles(), "triangle" if engines else "sphere", found["now"], found["strained"],
		found["memory_MB"],
		O.dt, critical, ruling and ruling[0], ruling and tuple(O.bodies[ruling[0]].state.pos)[:2],
		found["effects"],
		tuple(engine.label or type(engine).__name__ for engine in O.engines if type(engine).__name__ in _APART)
	)


# ---- in the YADE of the copy ----


def measure(asked):
	"""What the YADE of the copy does: times the steps of a saved scene."""
	O.load(asked["scene"], quiet=True)
	O.engines = [engine for engine in O.engines if type(engine).__name__ not in _APART]
	switches = _switches()
	share = asked["seconds"] / (2 + len(switches))
	now = _ns(share)
	memory = meter.memory() / 2**20
	_agitate()
	strained = _ns(share)
	effects = {}
	for material, name in switches:
		setattr(material, name, False)
		effects[f"{name} of {material.label or type(material).__name__}"] = 1 - min(1.0, _ns(share) / strained)
		setattr(material, name, True)
	return {"now": now, "strained": strained, "memory_MB": memory, "effects": effects}


def _switches():
	"""Switches of the materials in use that are on."""
	materials = {body.mat.id: body.mat for body in O.bodies if body and body.mat}
	return [
		(material, name)
		for material in materials.values()
		for name, value in material.dict().items()
		if value is True
	]


def _ns(seconds):
	"""Processor time of a particle-step [ns], from about so many seconds of them."""
	_cpu(3)  # what is read and allocated at the first step
	steps = max(5, round(seconds / 3 / max(_cpu(5) / 5, 1e-7)))
	_cpu(steps)
	return 1e9 * _cpu(2 * steps) / (2 * steps * meter.particles())


def _cpu(steps):
	"""Processor time of a run [s]."""
	with meter.StepMeter() as clock:
		O.run(steps, True)
	return clock.cpu_s


def _agitate():
	"""Random velocities of a tenth of a metre a second, so that nothing rests."""
	draw = random.Random(1)
	for body in O.bodies:
		if body and not body.state.blockedDOFs.startswith("xy"):
			body.state.vel = body.state.vel + (draw.uniform(-0.1, 0.1), draw.uniform(-0.1, 0.1), 0)
