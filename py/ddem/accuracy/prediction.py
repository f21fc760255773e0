# GPL v2 or later, see LICENSE.
"""What a rung that nobody has run will cost, and how far off it will be: power laws of the rungs that were run.
Needs no YADE."""
import math
from dataclasses import dataclass

from . import convergence

_LOWEST_ORDER = 0.3  #: of an error in what is refined; less is no order that could be relied on


@dataclass(frozen=True)
class Prediction:
	"""A rung that nobody has run."""
	quantity: str
	step: float  # of what is refined
	error: float  # [-]
	cpu_s: float  # [s]
	memory_MB: float
	order: float  # observed, of the error in the step [-]
	settled: bool  # whether three rungs show the same order, within a fourth; None where there are but two


class Laws:
	"""Laws of error, processor time and memory in what a ladder refines, through the finest two rungs.

	Errors and memory follow a power law with the exponent observed. Processor time is steps times the time of
	a step: numbers of steps and particles grow with whole powers, that of steps at least with the first where
	particles do, since the stable step falls with the smallest one; a step takes a time of its own and a share for
	each particle, which small samples do not show in a power law.

	:param points: of one ladder and one quantity
	:raises ValueError: fewer than two of them have an error, or it does not fall where the cost grows
	"""

	def __init__(self, points):
		good = sorted(
			(
				p
				for p in points
				if not p.failed and p.step is not None and math.isfinite(p.error) and p.error > 0
			),
			key=lambda p: p.step
		)
		self.quantity = points[0].quantity if points else "nothing"
		if len({p.step for p in good}) < 2:
			raise ValueError(
				f"{self.quantity}: an order needs two rungs with an error, and there are {len(good)}"
			)
		self.best = good[0]
		self.order = self._exponent(good[:2], lambda p: p.error)
		self._growth = self._exponent(good[:2], self._work(good[:2]))
		self._second = good[1]
		self._bytes = self._exponent(good[:2], lambda p: p.cost.get("memory_MB", math.nan))
		self.settled = None
		if len(good) > 2:
			before = self._exponent(good[1:3], lambda p: p.error)
			self.settled = abs(before - self.order) <= 0.25 * self.order
		if not (self.order > _LOWEST_ORDER and self._growth < 0):
			raise ValueError(f"{self.quantity}: the errors of its rungs do not fall with what they cost")

	@staticmethod
	def _work(points):
		"""What grows with the cost: particle steps, which no clock disturbs;
		seconds where they are the same."""
		counted = lambda p: p.cost.get("steps", 0) * p.cost.get("particles", 0)
		counts = {counted(p) for p in points}
		return counted if len(counts) == len(points) and 0 not in counts else lambda p: p.cpu_s

	@staticmethod
	def _exponent(points, value):
		return float(convergence.power_law([p.step for p in points], [value(p) for p in points])[1])

	def _seconds(self, finer):
		"""Processor time at so many times the finest step [s]."""
		fine, coarse = self.best.cost, self._second.cost
		if not all(one.get(name, 0) > 0 for one in (fine, coarse) for name in ("steps", "particles")):
			return self.best.cpu_s * finer**self._growth  # of seconds, as nothing is counted
		pair = (self.best, self._second)
		of_particles, of_steps = (
			round(self._exponent(pair, lambda p, name=name: p.cost[name]))
			for name in ("particles", "steps")
		)
		if of_particles < 0:
			of_steps = min(of_steps, -1)
		each, before = self.best.cpu_s / fine["steps"], self._second.cpu_s / coarse["steps"]  # of a step
		more = fine["particles"] - coarse["particles"]
		share = (each - before) / more if more > 0.01 * fine["particles"] else 0.0
		share = min(max(share, 0.0), each / fine["particles"])
		particles = fine["particles"] * finer**of_particles
		return fine["steps"] * finer**of_steps * (each + share * (particles - fine["particles"]))

	def at(self, step):
		"""The :class:`Prediction` for a step."""
		finer = step / self.best.step
		memory = self.best.cost.get("memory_MB", math.nan)
		return Prediction(
			self.quantity, step, self.best.error * finer**self.order, self._seconds(finer),
			memory * finer**self._bytes if math.isfinite(self._bytes) else memory, self.order, self.settled
		)

	def reaching(self, error):
		"""The :class:`Prediction` for the coarsest step that has at most this error [-]."""
		return self.at(self.best.step * (error / self.best.error)**(1 / self.order))


def predict(points, target):
	"""The coarsest rung that reaches a target error; None where errors do not fall,
	or one is good enough already."""
	try:
		laws = Laws(points)
	except ValueError:
		return None
	return None if laws.best.error <= target else laws.reaching(target)
