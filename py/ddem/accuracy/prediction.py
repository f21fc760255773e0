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
	settled: bool  # whether three rungs show the same order, within a fourth


class Laws:
	"""Power laws of error, processor time and memory in what a ladder refines, through the finest two rungs.

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
		self._growth = self._exponent(good[:2], lambda p: p.cpu_s)
		self._bytes = self._exponent(good[:2], lambda p: p.cost.get("memory_MB", math.nan))
		before = self._exponent(good[1:3], lambda p: p.error) if len(good) > 2 else math.nan
		self.settled = abs(before - self.order) <= 0.25 * self.order
		if not (self.order > _LOWEST_ORDER and self._growth < 0):
			raise ValueError(f"{self.quantity}: the errors of its rungs do not fall with what they cost")

	@staticmethod
	def _exponent(points, value):
		return float(convergence.power_law([p.step for p in points], [value(p) for p in points])[1])

	def at(self, step):
		"""The :class:`Prediction` for a step."""
		finer = step / self.best.step
		memory = self.best.cost.get("memory_MB", math.nan)
		return Prediction(
			self.quantity, step, self.best.error * finer**self.order, self.best.cpu_s * finer**self._growth,
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
