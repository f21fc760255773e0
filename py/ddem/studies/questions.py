# GPL v2 or later, see LICENSE.
"""Questions to a module of the plugin, each answered in a YADE of its own, by :mod:`workers` or here."""
import concurrent.futures

from . import yade_process
from .evaluations import ABOUT, EvaluationError, Lost
from .workers import Here


class Questions:
	"""Asks ``module.measure(request)`` in other YADEs.

	:param module: its name, as "yade.ddem.studies.virtualtest"
	:param workers: :class:`workers.Workers`; None: this process waits for each answer
	:param yade: the program; None: the one that is running, or that is found in the path; of a cluster, its own
	:param threads: OpenMP threads of each
	"""

	def __init__(self, module, workers=None, yade=None, threads=1):
		self.module, self.workers, self.threads = module, workers or Here(), threads
		self.yade = yade or (None if getattr(workers, "cluster", None) else yade_process.running())

	def submit(self, request, threads=None):
		"""A concurrent.futures.Future of what is measured for a request, both plain data, with
		:data:`evaluations.ABOUT`; *threads* in place of those of all. The future raises
		:class:`evaluations.EvaluationError` where nothing can be measured, :class:`evaluations.Lost` where the
		workers are gone.

		:raises evaluations.EvaluationError: the workers were told to stop
		"""
		try:
			asked = self.workers.submit(
				yade_process.ask, self.module, request, threads or self.threads, self.yade,
				self.workers.owner
			)
		except RuntimeError as error:
			raise EvaluationError(str(error)) from None
		answered = concurrent.futures.Future()
		asked.add_done_callback(lambda done: _settle(answered, done))
		return answered

	def ask(self, request, threads=None):
		"""The same, waited for, and without what is told about it."""
		measured = dict(self.submit(request, threads).result())
		del measured[ABOUT]
		return measured

	def stop(self):
		"""End what is running, and start nothing more."""
		self.workers.stop()


def _settle(answered, done):
	if isinstance(done.exception(), (Lost, EvaluationError)):
		answered.set_exception(done.exception())
	elif done.exception() is not None:
		answered.set_exception(EvaluationError(f"{type(done.exception()).__name__}: {done.exception()}"))
	else:
		try:
			answered.set_result(_checked(done.result()))
		except EvaluationError as error:
			answered.set_exception(error)


def _checked(found):
	"""What was measured, where it comes from the same YADE and plugin as those of this process."""
	own = yade_process.identity()
	by = found["by"] or own
	other = [f"{name} {by[name]} in place of {own[name]}" for name in ("yade", "plugin") if by[name] != own[name]]
	if other:
		raise EvaluationError(
			f"the worker on {by['node']} has {' and '.join(other)}: results are not mixed; install the "
			"same there"
		)
	if found["error"] is not None:
		raise EvaluationError(found["error"])
	return {
		**found["measured"],
		ABOUT: {"seconds": found["seconds"], "node": by["node"], "processor": by["processor"]}
	}
