# GPL v2 or later, see LICENSE.
"""What the steps of the present scene cost, measured in a copy of it in a YADE of its own, and kept for the next time.

Kept in the cache, in ``yade-ddem/steps.jsonl`` below $XDG_CACHE_HOME or ~/.cache, under the machine's name, the plugin
and all that the cost depends on: kinds of particles, effects, settings of the engines, threads, and the number of
particles within a tenth.
"""
import math
import os
import random
import tempfile

from yade import DeformableEngine, DeformableTriangle, O, Sphere, ddem

from .. import meter
from ..studies.evaluations import Bench
from ..studies.questions import Questions

APART = ("PyRunner", "SnapshotEngine", "VTKRecorder", "TorqueRecorder", "ForceRecorder")  #: engines left out
_EFFECT = "effect:"
_COUNTERS = ("execTime", "execCount", "realLast")  # of engines: differ from run to run
_SAMPLES = 3


def cache(name):
	"""Path of a file or folder in the cache of this user."""
	home = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
	return os.path.join(home, "yade-ddem", name)


def measured(seconds, fresh=False):
	"""What steps of the present scene cost.

	:param seconds: time for the measurement [s]
	:param fresh: measure it also where it is known
	:returns: ns_now and ns_strained [ns], processor time of a step over the particles, as the scene is and where
		all of it is strained (spheres: half of their bonds have broken); grown_MB, memory that the first steps
		take; effect:NAME, the share of a strained step that each switch of a material costs [-]
	:raises RuntimeError: the copy does not run
	"""
	evaluate = _Copy(seconds)
	path = None if fresh else cache("steps.jsonl")
	try:
		bench = Bench(evaluate, settings=evaluate.settings(), path=path)
	except (OSError, RuntimeError):  # it cannot be written, or another estimate is at work
		bench = Bench(evaluate, settings=evaluate.settings())
	with bench:
		(point, ) = bench.measure([_composition()])
	if point.error is not None:
		raise RuntimeError(f"a copy of the scene does not run: {point.error}")
	return point.measured


class _Copy:
	"""Evaluates the present scene, for :class:`evaluations.Bench`."""

	def __init__(self, seconds):
		self._seconds, self._questions = seconds, Questions(__name__, threads=O.numThreads)

	def settings(self):
		from ..studies.workers import Here
		from ..studies.yade_process import identity
		versions = {name: identity()[name] for name in ("yade", "plugin")}
		return {
			"machine": Here(alike="node").machine,
			"threads": O.numThreads,
			"seconds": self._seconds,
			**versions,
		}

	def submit(self, values, case):
		with tempfile.TemporaryDirectory(prefix="ddem-") as folder:
			scene = os.path.join(folder, "scene.bin")
			O.save(scene, quiet=True)
			answered = self._questions.submit({"scene": scene, "seconds": self._seconds})
			answered.exception()  # it has read the file before that goes
		return answered


def _composition():
	"""What the cost of a step depends on."""
	groups = [
		[row["group"], row["effect"], row["runs"], row["why"], _size(row["count"])]
		for row in ddem.effects().rows()
	]
	engines = [
		[
			type(engine).__name__,
			sorted(
				(name, str(value))
				for name, value in engine.dict().items()
				if isinstance(value, (bool, str, int, float)) and name not in _COUNTERS
			),
		]
		for engine in O.engines
		if type(engine).__name__ not in APART
	]
	return {"groups": groups, "engines": engines, "particles": _size(meter.particles()), "moved": O.iter > 0}


def _size(count):
	"""The same for numbers within about a tenth."""
	return round(math.log(max(count, 1), 1.2))


# ---- in the YADE of the copy ----


def measure(asked):
	"""What the YADE of the copy does: times the steps of a saved scene."""
	O.load(asked["scene"], quiet=True)
	O.engines = [engine for engine in O.engines if type(engine).__name__ not in APART]
	switches = _switches()
	share = asked["seconds"] / (2 + len(switches))
	before = meter.memory()
	_cpu(3)  # what is read and allocated at the first step
	grown = max(0, meter.memory() - before)
	found = {"ns_now": _ns(share), "grown_MB": grown / 2**20}
	if any(isinstance(engine, DeformableEngine) for engine in O.engines):
		_agitate()
	else:
		_break_half()
	found["ns_strained"] = strained = _ns(share)
	for material, name in switches:
		setattr(material, name, False)
		name_of = f"{_EFFECT}{name} of {material.label or type(material).__name__}"
		found[name_of] = 1 - min(1.0, _ns(share) / strained)
		setattr(material, name, True)
	return found


def _switches():
	"""Switches that are on, of the materials of triangles;
	those of bonded spheres are in their contacts already."""
	materials = {
		body.mat.id: body.mat for body in O.bodies if body and isinstance(body.shape, DeformableTriangle)
	}
	return [
		(material, name)
		for material in materials.values()
		for name, value in material.dict().items()
		if value is True
	]


def _ns(seconds):
	"""Processor time of a particle-step [ns]: the median of several pieces, together of about so many seconds."""
	steps = max(5, round(seconds / (_SAMPLES + 1) / max(_cpu(5) / 5, 1e-7)))
	pieces = sorted(_cpu(steps) for _ in range(_SAMPLES))
	return 1e9 * pieces[_SAMPLES // 2] / (steps * meter.particles())


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


def _break_half():
	"""Every second bond is gone; what it held touches or not."""
	for interaction in list(O.interactions)[::2]:
		if all(isinstance(O.bodies[i].shape, Sphere) for i in (interaction.id1, interaction.id2)):
			O.interactions.erase(interaction.id1, interaction.id2)
