# GPL v2 or later, see LICENSE.
"""Runs ladders: what has been run is kept, a budget is kept to, and a wanted error is predicted before it is run."""
import math
import os
import time
from dataclasses import replace

from yade import config

from ..studies.commandline import plugin
from ..studies.evaluations import Bench
from ..studies.workers import Here
from . import points, rungs
from .ladders import COMPARED, label
from .prediction import predict

STORE = "rungs.jsonl"  #: in the folder of a study
#: growth of the cost from rung to rung, where no two of a ladder have been run: of one that refines, and of others
_GROWTH, _ALIKE = 8.0, 2.0


class Study:
	"""Ladders, run in one folder. What is there from this machine and this plugin is not run again.

	:param ladders: list of :class:`ladders.Ladder`
	:param folder: where results are kept
	:param threads: OpenMP threads of every rung
	:param workers: :class:`workers.Workers` of one node, as times are compared; None: one rung after another.
		More than one at the same time on a node disturb each other's time
	:param budget: [s]; a rung that would end later, by what cheaper ones took, is not started. None: no limit
	:param report: called with a line of text for every rung
	"""

	def __init__(
		self, ladders, folder, threads=1, workers=None, budget=None, report=lambda text: None, evaluate=None
	):
		os.makedirs(folder, exist_ok=True)
		self.ladders, self.budget, self.report = list(ladders), budget, report
		workers = workers or Here(alike="node")
		self.machine = workers.machine
		settings = {"yade": config.version, "plugin": plugin(), "machine": self.machine, "threads": threads}
		evaluate = evaluate or rungs.SeparateRung(threads, workers)
		self._make = lambda: Bench(evaluate, settings=settings, path=os.path.join(folder, STORE))
		self.outcomes = {}  # (ladder's name, number of the rung) -> list of outcomes, one a seed
		self._took = {}  # (ladder's name, number of the rung) -> wall time of all its seeds [s]
		self.predictions = []  # of (ladder, prediction.Prediction, point that was measured)
		self._began = time.perf_counter()

	def run(self, target=None):
		"""Run all rungs that fit the budget, cheap ones first, and return all points.

		:param target: relative error; then ladders whose errors fall with a power of what they refine are
			refined to it, where the budget has room: predicted before, measured after
		"""
		with self._make() as self._bench:
			left = {ladder: 0 for ladder in self.ladders}  # the next rung of each
			while left:
				ladder = min(left, key=lambda one: self._expected(one, left[one]))
				self._rung(ladder, left[ladder])
				left[ladder] += 1
				if left[ladder] == len(ladder.rungs):
					del left[ladder]
			if target is not None:
				self.ladders = [self._refined(ladder, target) for ladder in self.ladders]
		return [point for ladder in self.ladders for point in self.points(ladder)]

	def points(self, ladder):
		"""What a ladder has given so far."""
		outcomes = [self.outcomes[ladder.name, place] for place in range(len(ladder.rungs))]
		return points.of_ladder(ladder, outcomes, rungs.scene_name(ladder.scene))

	@property
	def left(self):
		"""Of the budget [s]."""
		return math.inf if self.budget is None else self.budget - (time.perf_counter() - self._began)

	def _rung(self, ladder, place):
		seeds = [{"seed": seed} for seed in ladder.seeds] or [{}]
		settings = [{**ladder.settings(ladder.rungs[place]), **seed} for seed in seeds]
		expected = self._expected(ladder, place)
		self._bench.cases = [{"scene": rungs.scene_name(ladder.scene)}]
		if expected > self.left and not self._bench.knows(settings):
			left = max(0.0, self.left)
			text = (
				f"{points.NOT_RUN}it would take about {expected:.0f} s of a budget of which "
				f"{left:.0f} s are left"
			)
			self.outcomes[ladder.name, place] = [text] * len(seeds)
		else:
			found = self._bench.measure(settings)
			self.outcomes[ladder.name, place] = [p.measured if p.error is None else p.error for p in found]
			steps = sum(p.measured["wall_s"] for p in found if p.error is None)
			# with making the sample
			self._took[ladder.name, place] = max(steps, sum(p.seconds for p in found))
		self.report(f"{ladder.name}: {label(ladder.rungs[place])}: {self._told(ladder, place)}")

	def _expected(self, ladder, place):
		"""Wall time of a rung, of all its seeds and with what comes before their steps,
		by the rungs before it [s]."""
		took = [
			self._took[ladder.name, before]
			for before in range(place)
			if (ladder.name, before) in self._took
		]
		if not took:
			return 0.0
		assumed = _ALIKE if ladder.kind in (*COMPARED, "threads") else _GROWTH
		return took[-1] * (max(1.0, took[-1] / took[-2]) if len(took) > 1 else assumed)

	def _told(self, ladder, place):
		outcome = self.outcomes[ladder.name, place][0]
		if isinstance(outcome, str):
			return outcome
		return (
			f"{outcome['cpu_s']:.3g} core-seconds, {outcome['particles']:.0f} particles, "
			f"{outcome['ns_per_particle_step']:.0f} ns a particle-step"
		)

	def _refined(self, ladder, target):
		"""The ladder with a rung that is to reach the target, which is run."""
		if not ladder.refined or any(isinstance(rung[ladder.refined], (tuple, list)) for rung in ladder.rungs):
			return ladder
		predicted = predict([p for p in self.points(ladder) if p.quantity == ladder.quantities[0].name], target)
		if predicted is None or predicted.cpu_s * max(1, len(ladder.seeds)) > self.left:
			return ladder
		more = replace(ladder, rungs=(*ladder.rungs, {**ladder.rungs[-1], ladder.refined: predicted.step}))
		self._rung(more, len(more.rungs) - 1)
		self.predictions.append((more, predicted, self.points(more)[len(more.rungs) - 1]))
		return more
