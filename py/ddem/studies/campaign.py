# GPL v2 or later, see LICENSE.
"""A campaign: many runs of a script with different options, each in a YADE and a folder of its own,
some at the same time; what is finished is kept.

::

	cases = [campaign.Case(f"seed{n}", ["--seed", str(n)]) for n in (1, 2, 3)]
	with workers.Workers(jobs=2) as work:
		runs = campaign.Campaign("scripts/ucs_bonded.py", cases, "out/campaign", work)
		for case, folder in runs.run().items():
			...

The script needs an option --out for its folder, and must leave a summary.json there with the versions
of commandline.versions(). Workers of a cluster must see the script and the folder under the same paths.
"""
import concurrent.futures
import contextlib
import hashlib
import json
import os
from dataclasses import dataclass

from yade import config

from .. import provenance
from . import yade_process
from .commandline import plugin
from .evaluations import Lost

_SHOWN = 3  # failures that an error shows

LOG = "log.txt"  #: in the folder of a run: what its YADE has said
FINISHED = "finished.json"  #: in the folder of a run that is finished: what it was made with


@dataclass(frozen=True)
class Case:
	"""A run of the script."""
	name: str  # of its folder
	arguments: tuple  # of the script, all but --out


class Failed(RuntimeError):
	"""Runs have failed; the message says which, and why."""


class Campaign:
	"""Runs all cases that are not finished yet, with this script, YADE and plugin, on such a machine.

	:param script: path of the script
	:param cases: list of :class:`Case`, in the order in which they are to start
	:param folder: where every case gets a folder of its name
	:param workers: :class:`workers.Workers`
	:param report: called with case, folder, and seconds (None where it was finished before) when a case is finished
	:param yade: the program, see :class:`questions.Questions`
	"""

	def __init__(self, script, cases, folder, workers, report=lambda case, folder, seconds: None, yade=None):
		names = [case.name for case in cases]
		if len(set(names)) < len(names):
			raise ValueError(
				"two cases have the same name: "
				f"{', '.join(sorted(name for name in set(names) if names.count(name) > 1))}"
			)
		self.script, self.cases, self.folder, self.workers, self.report = (
			os.path.abspath(script), list(cases), os.path.abspath(folder), workers, report
		)
		self.yade = yade or (None if workers.cluster else yade_process.running())
		with open(self.script, "rb") as file:
			text = hashlib.sha256(file.read()).hexdigest()[:12]
		self._current = {
			"YADE": config.version, "plugin": plugin(), "machine": workers.machine,
			"script": f"{os.path.basename(self.script)} {text}"
		}

	def folder_of(self, case):
		return os.path.join(self.folder, case.name)

	def finished(self, case):
		"""Whether a run with the same options and the same plugin is there already."""
		try:
			with open(os.path.join(self.folder_of(case), FINISHED)) as file:
				stamp = json.load(file)
			stamp.pop(provenance.KEY, None)
			return stamp == self._stamp(case)
		except (OSError, ValueError, AttributeError):
			return False

	def run(self):
		"""Run what is missing, and return {case: its folder}.

		:raises Failed: a run has failed; the others are finished first, and are kept
		:raises evaluations.Lost: the scheduler of the cluster is gone; what is finished is kept
		"""
		missing = []
		for case in self.cases:
			if self.finished(case):
				self.report(case, self.folder_of(case), None)
			else:
				missing.append(case)
		failures, started = [], {}

		def finish(done):
			case = started.pop(done)
			try:
				code, seconds = done.result()
				self._finish(case, code)
			except Lost:
				raise
			except Exception as error:  # its workers died, or it has left nothing
				failures.append(f"{case.name}: {error}")
			else:
				self.report(case, self.folder_of(case), seconds)

		try:
			for case in missing:
				arguments = [*case.arguments, "--out", self.folder_of(case)]
				future = self.workers.submit(
					yade_process.run_in_folder, self.script, arguments, self.folder_of(case), LOG,
					self.yade, self.workers.owner, os.getcwd()
				)
				started[future] = case
			for done in concurrent.futures.as_completed(list(started)):
				finish(done)
		except BaseException:
			ended = [(done, case) for done, case in started.items() if done.done() and not done.exception()]
			self.workers.stop()
			for done, case in ended:  # not to be made again
				with contextlib.suppress(RuntimeError):
					self._finish(case, done.result()[0])
			raise
		if failures:
			more = [f"and {len(failures) - _SHOWN} more"] if len(failures) > _SHOWN else []
			raise Failed(
				"\n".join(
					[
						f"{len(failures)} of {len(self.cases)} runs failed",
						*sorted(failures)[:_SHOWN],
						*more,
					]
				)
			)
		return {case: self.folder_of(case) for case in self.cases}

	def _finish(self, case, code):
		"""Mark a run as finished whose script has ended with this exit code.

		:raises RuntimeError: it has failed, or another YADE or plugin has made it
		"""
		folder = self.folder_of(case)
		if code != 0:
			log = os.path.join(folder, LOG)
			raise RuntimeError(
				f"YADE {yade_process.ending(code)}; its last lines, of {log}: {yade_process.tail(log)}"
			)
		try:
			with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
				versions = json.load(file)["versions"]
		except (OSError, ValueError, KeyError) as error:
			raise RuntimeError(f"no summary.json that can be read in {folder}: {error}") from None
		for name in ("YADE", "plugin"):
			if versions[name] != self._current[name]:
				raise RuntimeError(
					f"a worker has {name} {versions[name]} in place of {self._current[name]}: "
					"results are not mixed; install the same there"
				)
		unfinished = os.path.join(folder, FINISHED + ".unfinished")
		provenance.write_json(unfinished, self._stamp(case), indent="\t")
		os.replace(unfinished, os.path.join(folder, FINISHED))

	def _stamp(self, case):
		"""What a run depends on."""
		return {**self._current, "arguments": list(case.arguments)}
