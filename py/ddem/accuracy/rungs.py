# GPL v2 or later, see LICENSE.
"""One rung of a ladder: its scene run with its settings, in this YADE or in one of its own,
and what that gave and cost."""
import importlib.util
import math
import sys

from ..studies.evaluations import EvaluationError
from ..studies.questions import Questions
from .ladders import UCS


def scene_name(scene):
	"""How a scene is called in files: the name of a case, UCS, or FILE:FUNCTION.

	:raises ValueError: a function of the running script, which other YADEs would have to run as a whole
	"""
	if getattr(scene, "__module__", "") == "__main__":
		raise ValueError(
			f"scene {scene.__name__}() is part of the running script; put it into a file of its own and "
			"import that"
		)
	return scene if isinstance(scene, str) else f"{sys.modules[scene.__module__].__file__}:{scene.__name__}"


def perform(scene, settings):
	"""Run a scene in this YADE.

	:param scene: as :func:`scene_name` gives it
	:param settings: of the scene; "seed" among them where it has one
	:returns: value:NAME, and reference:NAME and error:NAME [-] where there is a reference, of everything that the
		scene compares; what :meth:`meter.StepMeter.figures` has; memory_MB, threads
	"""
	from yade import O

	from ..meter import StepMeter, memory
	from ..studies.runs import RECORDER
	O.reset()
	before, O.timingEnabled = memory(), True
	with StepMeter(apart=[RECORDER]) as meter:
		outcome = _scene(scene)(**settings)
	found = {}
	for name, (value, reference, error) in outcome.items():
		found[f"value:{name}"] = float(value)
		if reference is not None:
			found[f"reference:{name}"] = float(reference)
		if error is not None:
			found[f"error:{name}"] = float(error)
	if not meter.steps:
		raise EvaluationError("the scene made no step")
	memory_MB = max(0, memory() - before) / 2**20
	return {**found, **meter.figures(), "memory_MB": memory_MB, "threads": O.numThreads}


def _scene(name):
	"""The function of a scene: settings -> {name: (value, reference or None, relative error or None)}."""
	if name == UCS:
		return _compression
	path, _, function = name.rpartition(":")
	if path:
		spec = importlib.util.spec_from_file_location("ddem_ladders_of_user", path)
		module = importlib.util.module_from_spec(spec)
		sys.modules[spec.name] = module
		spec.loader.exec_module(module)
		return _of_user(getattr(module, function))
	return _verification(name)


def _of_user(function):

	def run(**settings):
		outcome = {}
		for name, value in function(**settings).items():
			value, reference = value if isinstance(value, tuple) else (value, None)
			error = None
			if reference is not None:
				if not abs(reference) > 0:
					raise ValueError(
						f"{name}: a reference of {reference} makes no relative error; compare "
						"a difference"
					)
				error = abs(value - reference) / abs(reference)
			outcome[name] = (value, reference, error)
		return outcome

	return run


def _verification(name):
	from .. import verification

	def run(**settings):
		result = verification.run(name, **settings)
		if result.error:
			raise EvaluationError(result.error.strip().splitlines()[-1])
		return {record.quantity: (record.value, record.reference, record.error) for record in result.records}

	return run


def _compression(model, specimen, values=None, seed=1, **changes):
	from ..studies import virtualtest
	setup = virtualtest.Setup.standard(model, specimen, **changes)
	rock = {"young": 50e9, "cohesion": 80e6, "bondFrictionAngle": math.radians(45)} if model == "rigid" else {}
	measured = virtualtest.perform(setup, {**rock, **(values or {})}, {"test": "compression", "seed": seed})
	exact = {"energy_error": 0.0}
	return {
		name: (value, exact.get(name), value if name in exact else None) for name, value in measured.items()
	}


# ---- each in a YADE of its own ----


class SeparateRung:
	"""Runs rungs, each in a YADE of its own; for :class:`evaluations.Bench`, whose case is {"scene": its name,
	…} and whose parameters are the settings.

	:param threads: OpenMP threads of each
	:param workers: :class:`workers.Workers`; None: one after another
	:param yade: see :class:`questions.Questions`
	"""

	def __init__(self, threads=1, workers=None, yade=None):
		self._questions = Questions(__name__, workers, yade, threads)

	def submit(self, values, case):
		"""A concurrent.futures.Future of what :func:`perform` returns."""
		settings = dict(values)
		threads = settings.pop("threads", None)
		return self._questions.submit({"scene": case["scene"], "settings": settings}, threads)

	def stop(self):
		"""End what is running, and start nothing more."""
		self._questions.stop()


def measure(asked):
	"""What the YADE of a rung does."""
	return perform(asked["scene"], asked["settings"])
