# GPL v2 or later, see LICENSE.
"""A campaign: many runs of a script with different options, each in a YADE and a folder of its own,
some at the same time; what is finished is kept.

::

	cases = [campaign.Case(f"seed{n}", ["--seed", str(n)]) for n in (1, 2, 3)]
	runs = campaign.Campaign("scripts/ucs_bonded.py", cases, "out/campaign", jobs=2)
	for case, folder in runs.run().items():
		...

The script needs an option --out for its folder, and must leave a summary.json there with the versions
of commandline.versions().
"""
import concurrent.futures
import json
import os
import shutil
import time
from dataclasses import dataclass

from yade import config

from .. import provenance
from .commandline import plugin
from .processes import Stopped, YadeProcesses, ending, tail

_SHOWN = 3  # failures that an error shows

FINISHED = "finished.json"  #: in the folder of a run that is finished: what it was made with


@dataclass(frozen=True)
class Case:
	"""A run of the script."""
	name: str  # of its folder
	arguments: tuple  # of the script, all but --out


class Failed(RuntimeError):
	"""Runs have failed; the message says which, and why."""


class Campaign:
	"""Runs all cases that are not finished yet.

	:param script: path of the script
	:param cases: list of :class:`Case`, in the order in which they are to start
	:param folder: where every case gets a folder of its name
	:param jobs: runs at the same time
	:param report: called with case, folder, and seconds (None where it was finished before) when a case is finished
	:param yade: the program, see :class:`processes.YadeProcesses`
	"""

	def __init__(self, script, cases, folder, jobs=1, report=lambda case, folder, seconds: None, yade=None):
		names = [case.name for case in cases]
		if len(set(names)) < len(names):
			raise ValueError(
				"two cases have the same name: "
				f"{', '.join(sorted(name for name in set(names) if names.count(name) > 1))}"
			)
		if jobs < 1:
			raise ValueError(f"jobs = {jobs} must be at least 1")
		self.script, self.cases, self.folder, self.jobs, self.report = (
			os.path.abspath(script), list(cases), str(folder), jobs, report
		)
		self.processes = YadeProcesses(yade)
		self._current = {"YADE": config.version, "plugin": plugin()}

	def folder_of(self, case):
		return os.path.join(self.folder, case.name)

	def finished(self, case):
		"""Whether a run with the same options and the same plugin is there already."""
		try:
			with open(os.path.join(self.folder_of(case), FINISHED)) as file:
				stamp = json.load(file)
			stamp.pop(provenance.KEY, None)
			return stamp == _stamp(case, self._current)
		except (OSError, ValueError, AttributeError):
			return False

	def run(self):
		"""Run what is missing, and return {case: its folder}.

		:raises Failed: a run has failed; the others are finished first, and are kept
		"""
		missing = []
		for case in self.cases:
			if self.finished(case):
				self.report(case, self.folder_of(case), None)
			else:
				missing.append(case)
		failures = []
		pool = concurrent.futures.ThreadPoolExecutor(max_workers=self.jobs)
		try:
			started = {pool.submit(self._one, case): case for case in missing}
			for done in concurrent.futures.as_completed(started):
				seconds, error = done.result()
				if error:
					failures.append(f"{started[done].name}: {error}")
				else:
					self.report(started[done], self.folder_of(started[done]), seconds)
		except BaseException:
			pool.shutdown(wait=False, cancel_futures=True)
			self.processes.stop()
			raise
		finally:
			pool.shutdown()
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

	def _one(self, case):
		"""Seconds it took, and what went wrong or None."""
		folder, start = self.folder_of(case), time.perf_counter()
		shutil.rmtree(folder, ignore_errors=True)
		os.makedirs(folder)
		log = os.path.join(folder, "log.txt")
		try:
			code = self.processes.run(self.script, [*case.arguments, "--out", folder], log)
		except Stopped as error:
			return 0.0, str(error)
		if code != 0:
			return 0.0, f"YADE {ending(code)}; its last lines, of {log}: {tail(log)}"
		try:
			with open(os.path.join(folder, "summary.json")) as file:
				versions = json.load(file)["versions"]
		except (OSError, ValueError, KeyError) as error:
			return 0.0, f"no summary.json that can be read in {folder}: {error}"
		unfinished = os.path.join(folder, FINISHED + ".unfinished")
		provenance.write_json(unfinished, _stamp(case, versions), indent="\t")
		os.replace(unfinished, os.path.join(folder, FINISHED))
		return time.perf_counter() - start, None


def _stamp(case, versions):
	"""What a run depends on."""
	return {"YADE": versions["YADE"], "plugin": versions["plugin"], "arguments": list(case.arguments)}
