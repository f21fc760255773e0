# GPL v2 or later, see LICENSE.
"""Evaluations of a model, each written down when it is done: a repeated start does not repeat them. Needs no YADE.

A *point* is a set of parameters. It is measured in one or several *cases* (kinds of test, seeds),
each of which is an evaluation of its own::

	cases, settings = [{"seed": 1}, {"seed": 2}], {"specimen": "prism"}
	with Bench(evaluate, cases, settings, path="out/evaluations.jsonl") as bench:
		first, second = bench.measure([{"young": 40e9}, {"young": 44e9}])
		print(first.measured, second.error)

A function is evaluated at once; something with a submit(), as :class:`virtualtest.SeparateYade`, sends its evaluations
to :mod:`workers`, several at a time.
The file has a line of JSON an evaluation, with all settings, parameters, and what was measured or went wrong.
"""
import concurrent.futures
import datetime
import fcntl
import hashlib
import json
import math
import os
import signal
import time
from dataclasses import dataclass

from .. import provenance
from .interrupts import held_back

ABOUT = "about"  #: key, beside the measures, of how they were made: "seconds", and "node" and "processor" on which
EFFECTS = "effects"  #: key, beside the measures, of what the scene simulated (:meth:`effect_table.EffectTable.rows`)
FORMAT = 1  #: of the lines; evaluations in another format are made again


@dataclass(frozen=True)
class Point:
	"""A set of parameters and what was measured there."""
	values: dict  # parameter -> value
	measured: dict  # measure -> mean over the cases that have it; empty where a case failed
	scatter: dict  # measure -> standard deviation over those cases; None for a single one
	error: str = None  # what went wrong in the first case that failed
	reused: bool = False  # whether all of it had been measured before
	seconds: float = 0.0  # of all its evaluations together, when they were made [s]


class Store:
	"""A file of evaluations, locked against a second process; None keeps them in memory.

	:param path: JSON lines, made when missing
	:raises OSError: the file cannot be written
	:raises RuntimeError: another process writes into it
	"""

	def __init__(self, path=None):
		self.path, self._lines, self._file = path, {}, None
		#: (number, reason) of lines that were not understood; their evaluations are made again
		self.unreadable = []
		if path is None:
			return
		os.makedirs(os.path.dirname(os.path.abspath(path)), exist_ok=True)
		self._file = open(path, "a+b")
		try:
			fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
		except OSError:
			self._file.close()
			raise RuntimeError(
				f"{path} is in use by another run; wait for it, or choose another folder"
			) from None
		self._read()

	def get(self, key):
		"""The record of a successful evaluation, or None."""
		return self._lines.get(key)

	def add(self, record):
		"""Keep a record, and write it to the disk before returning."""
		if record["error"] is None:
			self._lines[record["key"]] = record
		if self._file:
			line = {**record, provenance.KEY: provenance.record()}
			self._file.write(json.dumps(line, allow_nan=False).encode() + b"\n")
			self._file.flush()
			os.fsync(self._file.fileno())

	def close(self):
		if self._file:
			self._file.close()

	def _read(self):
		self._file.seek(0)
		text = self._file.read()
		if text and not text.endswith(b"\n"):
			# what comes next must not be glued to the rest of a line that was cut off
			self._file.write(b"\n")
		for number, line in enumerate(text.splitlines(), 1):
			if not line.strip():
				continue
			try:
				record = json.loads(line)
				if record["format"] != FORMAT:
					raise ValueError(f"format {record['format']} where this version has {FORMAT}")
				if record["error"] is None:
					if not all(math.isfinite(value) for value in record["measured"].values()):
						raise ValueError("a measure is not finite")
					self._lines[record["key"]] = record
			except (ValueError, KeyError, TypeError, AttributeError) as error:
				self.unreadable.append(
					(
						number,
						str(error)
						if isinstance(error, ValueError)
						else f"{type(error).__name__} {error}",
					)
				)


class Bench:
	"""Measures points in all cases, and keeps every evaluation.

	:param evaluate: ``evaluate(values, case)`` returns a dict of finite measures, and under :data:`EFFECTS`
		what the scene simulated, under :data:`ABOUT` how, or raises; or an object whose ``submit(values,
		case)`` returns a concurrent.futures.Future of that. Its ``stop()`` is called when the run is
		interrupted, and must end what is running.
	:param cases: list of dicts that can be written as JSON, as {"test": "compression", "seed": 1}
	:param settings: whatever else the result depends on, as plain data; evaluations made with other settings are
		not reused
	:param path: file of a :class:`Store`
	:param budget: no evaluation is started beyond this number of new ones; None: no limit
	"""

	def __init__(self, evaluate, cases=({}, ), settings=None, path=None, budget=None):
		if not cases:
			raise ValueError("a bench needs at least one case")
		self.evaluate, self.cases, self.settings, self.budget = (
			evaluate, [dict(case) for case in cases], dict(settings or {}), budget
		)
		self.store = Store(path)
		self.ran = self.failed = 0  #: evaluations made now, and those that failed among them
		self._made, self._reused = set(), set()
		self.seconds = 0.0  #: of the evaluations made now, added up [s]

	def __enter__(self):
		return self

	def __exit__(self, *_):
		self.store.close()

	@property
	def reused(self):
		"""Number of evaluations that had been made before."""
		return len(self._reused)

	def measure(self, points):
		"""Measure points, each a dict parameter -> value, and return a list of :class:`Point`.

		An evaluation that fails makes its point an error, nothing more. The result does not depend on how many
		are made at the same time.

		:raises OutOfBudget: it would take more new evaluations than are left; none was started
		:raises Lost: what evaluates is gone; what was finished is kept
		"""
		jobs = {
			fingerprint(self.settings, values, case): (values, case)
			for values in points
			for case in self.cases
		}
		known = {key: self.store.get(key) for key in jobs}
		missing = {key: job for key, job in jobs.items() if known[key] is None}
		if self.budget is not None and self.ran + len(missing) > self.budget:
			raise OutOfBudget(f"{self.budget} evaluations are used up")
		self._reused |= jobs.keys() - missing.keys() - self._made
		known.update(self._run(missing))
		return [self._point(values, known) for values in points]

	def knows(self, points):
		"""Whether all of these points have been measured before, so that measuring them takes no time."""
		return all(
			self.store.get(fingerprint(self.settings, values, case))
			for values in points
			for case in self.cases
		)

	def effects(self, values):
		"""What the scene of a point simulated, in the first case that says so; empty where none does."""
		records = (self.store.get(fingerprint(self.settings, values, case)) or {} for case in self.cases)
		return next((record[EFFECTS] for record in records if record.get(EFFECTS)), [])

	def _run(self, jobs):
		"""Key -> record of evaluations that are made now."""
		submit = getattr(self.evaluate, "submit", self._at_once)
		records, running = {}, {}

		def keep(future):
			key, begun = running.pop(future)
			records[key] = self._record(key, *jobs[key], future, time.perf_counter() - begun)

		try:
			for key, (values, case) in jobs.items():
				begun = time.perf_counter()
				future = submit(dict(values), dict(case))
				running[future] = key, begun
				if future.done():  # it is kept before the next one is begun
					keep(future)
			for future in concurrent.futures.as_completed(list(running)):
				keep(future)
		except BaseException:
			done = [future for future in running if future.done() and not future.cancelled()]
			getattr(self.evaluate, "stop", lambda: None)()
			for future in done:
				if future in running and future.exception() is None:
					keep(future)
			raise
		return records

	def _at_once(self, values, case):
		future = concurrent.futures.Future()
		try:
			future.set_result(self.evaluate(values, case))
		except Exception as error:
			future.set_exception(error)
		return future

	def _record(self, key, values, case, future, waited):
		"""Write down what an evaluation gave, and return that."""
		record = {
			"format": FORMAT, "key": key, "case": case, "parameters": values, "settings": self.settings,
			"measured": None, "error": None
		}
		about = {}
		try:
			answer = dict(future.result())
			about = answer.pop(ABOUT, about)
			record.update({EFFECTS: answer.pop(EFFECTS)} if EFFECTS in answer else {})
			measured = {name: float(value) for name, value in answer.items()}
			wrong = [f"{name} = {value}" for name, value in measured.items() if not math.isfinite(value)]
			if wrong:
				raise ValueError(f"measured {', '.join(wrong)}")
			record["measured"] = measured
		except Lost:
			raise
		except EvaluationError as error:
			record["error"] = str(error)
		except Exception as error:
			record["error"] = f"{type(error).__name__}: {error}"
		record["seconds"] = round(waited, 3)
		record.update(about)
		record["finished"] = datetime.datetime.now().astimezone().isoformat(timespec="seconds")
		with held_back(signal.SIGINT, signal.SIGTERM, signal.SIGHUP):  # written and counted, or neither
			self.store.add(record)
			self._made.add(key)
			self.ran += 1
			self.seconds += record["seconds"]
			self.failed += record["error"] is not None
		return record

	def _point(self, values, known):
		keys = [fingerprint(self.settings, values, case) for case in self.cases]
		records = [known[key] for key in keys]
		reused, seconds = not self._made & set(keys), sum(record["seconds"] for record in records)
		for record in records:
			if record["error"] is not None:
				where = ", ".join(f"{name} {value}" for name, value in record["case"].items())
				return Point(
					values, {}, {}, f"{where}: {record['error']}" if where else record["error"],
					reused, seconds
				)
		found = {}
		for record in records:
			for name, value in record["measured"].items():
				found.setdefault(name, []).append(value)
		mean = {name: math.fsum(samples) / len(samples) for name, samples in found.items()}
		scatter = {name: _deviation(samples, mean[name]) for name, samples in found.items()}
		return Point(values, mean, scatter, None, reused, seconds)


class EvaluationError(RuntimeError):
	"""An evaluation that failed for a reason its text says in full."""


class Lost(OSError):
	"""What evaluates is gone, as the scheduler of a cluster: no evaluation has failed, and none can be made."""


class OutOfBudget(RuntimeError):
	"""No evaluations are left."""


def fingerprint(settings, values, case):
	"""The same text for the same settings, parameters and case, whatever their order."""
	text = json.dumps([FORMAT, settings, values, case], sort_keys=True, allow_nan=False)
	return hashlib.sha256(text.encode()).hexdigest()[:24]


def _deviation(samples, mean):
	return (
		math.sqrt(math.fsum((value - mean)**2 for value in samples) / (len(samples) - 1))
		if len(samples) > 1
		else None
	)
