# GPL v2 or later, see LICENSE.
"""Where independent runs go: workers of Dask, processes of this machine or of a cluster.

::

	with workers.Workers(jobs=2) as work:                      # or cluster="tcp://node0:8786"
		futures = [work.submit(function, argument) for argument in (1, 2, 3)]
		print([future.result() for future in futures])

Functions are sent with their code, so they must not need the plugin: mostly :func:`yade_process.run` and
:func:`yade_process.ask`, which start a YADE. A worker that is killed takes its YADE with it, and another one makes what
it was at; a task whose workers die four times fails.
"""
import collections
import concurrent.futures
import contextlib
import os
import platform
import signal
import sys
import threading
import uuid

from ..provenance import processor
from . import yade_process
from .evaluations import EvaluationError, Lost
from .interrupts import held_back

_QUIET_LOOKS = 3  # at a cluster without a process of one's own, until all have ended
ANSWER, WAIT = 10, 60  #: time for a scheduler to answer, and for its first worker to come [s]
#: of the workers, for their own words: only errors; what their YADEs say is kept with each run
_QUIET = {"DASK_LOGGING__DISTRIBUTED": "critical"}


class Here:
	"""No workers: what is submitted is done at once, by the one who submits it.

	:param alike: see :class:`Workers`
	"""

	owner = ""
	cluster = None

	def __init__(self, alike="processor"):
		self.machine = _name(platform.node(), processor(), alike)

	def submit(self, function, *arguments):
		"""A concurrent.futures.Future that is done."""
		future = concurrent.futures.Future()
		try:
			future.set_result(function(*arguments))
		except Exception as error:
			future.set_exception(error)
		return future

	def stop(self):
		"""Nothing is running that could be stopped."""


class Workers:
	"""Workers of this machine, started when something is submitted first; or those of a cluster.

	Futures raise :class:`evaluations.Lost` where the scheduler goes, and what a function raises.

	Results of different machines are not mixed: of a cluster, only workers of one kind of machine are used, the one
	that has most of them.

	:param jobs: processes of this machine, where no cluster is named
	:param cluster: address of a Dask scheduler, as "tcp://node0:8786"; its workers must be able to start "yade"
		with this plugin, and see the same files
	:param alike: what makes two machines the same: "processor", for results; "node", for times
	:raises OSError: no scheduler answers there, or it has no workers within :data:`WAIT`
	"""

	def __init__(self, jobs=1, cluster=None, alike="processor"):
		if not (isinstance(jobs, int) and jobs >= 1):
			raise ValueError(f"jobs = {jobs!r} must be a whole number, 1 or more")
		if alike not in ("processor", "node"):
			raise ValueError(f"alike = '{alike}' is unknown; there are processor and node")
		self.jobs, self.cluster, self._alike = jobs, cluster, alike
		self.owner = uuid.uuid4().hex  #: of the processes that are started, see :func:`yade_process.end`
		self._client = self._local = None
		self._executors = []  # of all that was submitted
		# addresses of all workers of the cluster, hosts of those that are used
		self._known, self._own = set(), []
		self._stopped = False
		#: name of the machines that are used
		self.machine = _name(platform.node(), processor(), alike)
		#: names of other machines that the cluster has, and that are not used
		self.others = []
		if cluster is not None:
			self._connect()

	def __enter__(self):
		return self

	def __exit__(self, kind, *_):
		if kind is not None:
			self.stop()
		self.close()

	def told(self):
		"""How much happens at the same time, in words."""
		return f"{self.jobs} at the same time" if self.cluster is None else f"on the workers of {self.cluster}"

	def submit(self, function, *arguments):
		"""A concurrent.futures.Future of a call.

		:raises RuntimeError: they were told to stop
		"""
		if self._stopped:
			raise RuntimeError("the workers were told to stop")
		if self._client is None:
			self._start()
		hosts = {"workers": self._hosts(), "allow_other_workers": False} if self.cluster else {}
		executor = self._client.get_executor(pure=False, **hosts)
		self._executors.append(executor)
		answered = concurrent.futures.Future()
		executor.submit(ByValue(function), *arguments).add_done_callback(
			lambda done: self._settle(answered, done)
		)
		return answered

	def _settle(self, answered, done):
		"""Pass on what Dask says; it cancels what it cannot make any more."""
		if not done.cancelled():
			error = done.exception()
			answered.set_result(done.result()) if error is None else answered.set_exception(error)
		elif self._stopped:
			answered.set_exception(EvaluationError("interrupted"))
		else:
			answered.set_exception(Lost(f"the Dask scheduler at {self.cluster or 'this machine'} is gone"))

	def stop(self):
		"""End what is running, and start nothing more."""
		self._stopped = True
		if self.cluster is not None and self._client is not None:
			with contextlib.suppress(OSError):  # they are gone already
				for executor in self._executors:
					executor.shutdown(wait=False)  # cancels what is queued, which would start next
				quiet = 0
				while quiet < _QUIET_LOOKS:  # one may be starting just now
					ended = self._client.run(
						ByValue(yade_process.end), self.owner, on_error="ignore"
					)
					quiet = 0 if any(ended.values()) else quiet + 1
					threading.Event().wait(0.1)
		self.close()

	def close(self):
		"""End the workers of this machine, or the connection to those of a cluster."""
		client, local, self._client, self._local = self._client, self._local, None, None
		for one in (client, local):
			if one is not None:
				with held_back(signal.SIGINT):
					one.close()

	@property
	def workers(self):
		"""Numbers of the processes on this machine that work: address -> process."""
		return {} if self._client is None else self._client.run(os.getpid)

	def _start(self):
		from distributed import Client, Scheduler
		from distributed.deploy.spec import SpecCluster
		from distributed.deploy.subprocess import SubprocessWorker

		# a scheduler in this process ends with it, however it ends, and its workers end with the scheduler;
		# nannies replace workers that are killed; their memory is nothing beside that of their YADEs
		local = {"host": "127.0.0.1", "dashboard_address": "127.0.0.1:0"}  # any port that is free
		options = {**local, "nthreads": 1, "memory_limit": 0, "dashboard": False}
		worker = {"cls": SubprocessWorker, "options": {"worker_kwargs": options}}
		with held_back(signal.SIGINT), _environment(_QUIET):
			self._local = SpecCluster(
				scheduler={"cls": Scheduler, "options": {**local, "dashboard": False}},
				workers=dict.fromkeys(range(self.jobs), worker), silence_logs="CRITICAL"
			)
			self._client = Client(self._local)
			self._client.wait_for_workers(self.jobs)

	def _connect(self):
		from distributed import Client
		try:
			self._client = Client(self.cluster, timeout=ANSWER)
		except (OSError, ValueError) as error:
			raise OSError(
				f"no Dask scheduler answers at {self.cluster} ({error}); start one with "
				"'scripts/ddem shell dask scheduler'"
			) from None
		try:
			self._client.wait_for_workers(1, timeout=WAIT)
		except TimeoutError:
			self.close()
			raise OSError(
				f"the Dask scheduler at {self.cluster} has no workers; start some with "
				f"'scripts/ddem shell dask worker --nthreads 1 {self.cluster}'"
			) from None
		kinds = collections.Counter(self._machines().values())
		self.machine = max(sorted(kinds), key=kinds.get)
		self.others = sorted(set(kinds) - {self.machine})

	def _machines(self):
		"""Address of each worker -> name of its machine."""
		nodes, processors = self._client.run(ByValue(platform.node)), self._client.run(ByValue(processor))
		return {
			address: _name(node, processors[address], self._alike)
			for address, node in nodes.items()
			if address in processors
		}

	def _hosts(self):
		"""Hosts of the machines that are used, those that have come since included. Where they have all gone,
		the last ones: what is submitted waits for them, as no others may make it."""
		known = set(self._client.scheduler_info()["workers"])
		if known != self._known:
			from distributed.comm import get_address_host
			own = {get_address_host(one) for one, name in self._machines().items() if name == self.machine}
			self._known, self._own = known, sorted(own) or self._own
		return self._own


def _name(node, kind, alike):
	return kind if alike == "processor" else f"{node}, {kind}"


class ByValue:
	"""A function that is sent with its code and that of the functions of its module,
	where Dask by itself sends a name to import."""

	def __init__(self, function):
		self._function = function

	def __call__(self, *arguments):
		return self._function(*arguments)

	def __reduce__(self):
		import cloudpickle
		module = sys.modules[self._function.__module__]
		if module.__name__.partition(".")[0] not in ("yade", "ddem"):
			return cloudpickle.loads, (cloudpickle.dumps(self._function), )
		cloudpickle.register_pickle_by_value(module)
		try:
			return cloudpickle.loads, (cloudpickle.dumps(self._function), )
		finally:
			cloudpickle.unregister_pickle_by_value(module)


@contextlib.contextmanager
def _environment(more):
	"""Processes that are started now have these variables as well."""
	before = {name: os.environ.get(name) for name in more}
	os.environ.update(more)
	try:
		yield
	finally:
		for name, value in before.items():
			if value is None:
				del os.environ[name]
			else:
				os.environ[name] = value
