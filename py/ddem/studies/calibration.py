# GPL v2 or later, see LICENSE.
"""Calibration: parameters of a model tuned until what is measured on it meets its targets. Needs no YADE;
the model is any function.

::

	from yade.ddem.studies.calibration import Calibration, Parameter, Target
	from yade.ddem.studies.evaluations import Bench

	def measure(values, case):                        # or virtualtest.SeparateYade, a virtual test
		return {"young": 0.6 * values["young"], "ucs": 0.8 * values["cohesion"]**0.9}

	with Bench(measure, path="out/evaluations.jsonl") as bench:
		outcome = Calibration(
			[Parameter("young", 50e9, 5e9, 500e9, {"young": 1}), Parameter("cohesion",
			50e6, 5e6, 500e6, {"ucs": 1})], [Target("young", 40e9, 0.02), Target("ucs", 60e6, 0.02)], bench,
		).run()
	print(outcome.reached, outcome.best.values, outcome.why)

Everything is done in logarithms of parameters and measures, in which scaling laws are straight lines: a sensitivity is
an elasticity d ln(measure)/d ln(parameter), and the 1 of "Young's modulus of the sample grows in proportion to that of
its bonds" needs no evaluation. So the search starts with steps by the scaling laws of the parameters, as long as each
halves the largest miss, by these laws and when it is measured. Then elasticities are measured by finite differences,
all at the same time, and a response surface takes over (Box and Wilson 1951): a plane through all points so far, near
ones counting more, leads to the next point by scipy's bounded least squares. Breaking of bonds is chaotic: neighbouring
parameters give strengths that differ by a per cent or two. So steps of finite differences are large, and planes average
over what scatters where a Jacobian or a simplex would follow it. The search stops at the first point that meets all
targets.

Beside other searches (``scripts/compare_optimisers.py``; a prism of bonded spheres, two packings, tolerance 2 %, at
most 60 points): Young's modulus and strength take 3 points in the median of 8 searches, without scaling laws 5, SciPy's
least_squares 10, Optuna's Gaussian process 14.5, Nelder and Mead's simplex 22; Optuna's TPE and CMA-ES and differential
evolution do not get there in most. With a strength in tension as well it takes 11, and meets 6 of 8, as many as all
together, where least_squares meets 3, the Gaussian process and the simplex 2, the others none.
"""
import itertools
import math
import time
from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import lsq_linear

from .evaluations import EvaluationError, OutOfBudget, Point

#: significant digits of parameters that are tried: more would say nothing,
#: and keep a repeated start from recognising them
DIGITS = 6
_HALF = 0.5  # a step that leaves more than this of what was missed is a poor one
_NOTHING = 0.05  # elasticities below it do not count
# two targets answer alike if their misses can only be brought together by a larger change of the parameters' logarithms
_FAR = 2.0
_NEAR = 0.01  # a parameter this close to a bound, in its logarithm, has hit it
_SMALLEST_STEP = 2e-3  # a step of parameters below it leads nowhere, far below what finite differences see
# of steps by the response surface: no parameter changes by more than a factor of two; less where a point failed
_RADIUS = 0.7
_PATIENCE = 8  # so many steps in a row that bring it less than a tenth closer end the search
_PASSES = 3  # a model is made anew around the point to which it leads
_SCATTER = 0.01  # of measures between neighbouring points, expected when points are weighted
_CURVATURE = 0.5  # of measures over parameters, expected likewise
_SPARE = 2  # points more than a plane needs, before their scatter about it says something


@dataclass(frozen=True)
class Parameter:
	"""A positive parameter to tune, between bounds. *laws* are the elasticities that scaling laws give it:
	measure -> d ln(measure)/d ln(parameter)."""
	name: str
	start: float
	lower: float
	upper: float
	laws: dict = field(default_factory=dict)

	def __post_init__(self):
		if not all(math.isfinite(value) and value > 0 for value in (self.start, self.lower, self.upper)):
			raise ValueError(
				f"parameter {self.name}: start {self.start}, bounds {self.lower} and {self.upper} "
				"must be positive and finite"
			)
		if not self.lower < self.upper:
			raise ValueError(
				f"parameter {self.name}: the lower bound, {self.lower:g}, must be below the upper "
				f"one, {self.upper:g}"
			)
		if not self.lower <= self.start <= self.upper:
			raise ValueError(
				f"parameter {self.name}: the start, {self.start:g}, must lie between the bounds, "
				f"{self.lower:g} and {self.upper:g}"
			)


@dataclass(frozen=True)
class Target:
	"""A positive value that a measure is to reach, within a relative tolerance."""
	name: str
	value: float
	tolerance: float

	def __post_init__(self):
		if not (math.isfinite(self.value) and self.value > 0):
			raise ValueError(f"target {self.name} = {self.value} must be positive and finite")
		if not 0 < self.tolerance < 1:
			raise ValueError(
				f"target {self.name}: tolerance = {self.tolerance} must be a part of the target, "
				"between 0 and 1 (0.02 for 2 %)"
			)

	def miss(self, point):
		"""Relative distance of a point from the target [-]."""
		return point.measured[self.name] / self.value - 1


@dataclass
class Step:
	"""A point the search looked at, and why."""
	number: int
	purpose: str  # "start", "scaling", "search" (by the response surface), or "sensitivity" (a finite difference)
	point: Point
	parameter: str = None  # the one that was changed, for a sensitivity


@dataclass
class Outcome:
	"""What a calibration found."""
	reached: bool
	best: Point  # the point closest to the targets; None when none could be measured
	why: list  # sentences on why it ended
	steps: list  # all of :class:`Step`, in order
	# d ln(target)/d ln(parameter) around the best point, a row a target, a column a parameter;
	# None when not measured
	elasticities: np.ndarray
	# their standard errors, from the scatter of all points about the response surface;
	# NaN where there are too few points
	errors: np.ndarray
	parameters: list
	targets: list
	seconds: float  # of the search [s]
	hit: dict = field(default_factory=dict)  # parameter -> "lower" or "upper", the bounds at which the search ended


class Calibration:
	"""Searches for the parameters; :meth:`run` does it.

	:param parameters: list of :class:`Parameter`
	:param targets: list of :class:`Target`, named after the measures of the bench
	:param bench: :class:`evaluations.Bench`
	:param step: relative step of finite differences [-]; above the noise of the model
	:param sensitivities: measure elasticities in the end where the search did not do so nearby
	:param tell: called with every :class:`Step`
	"""

	def __init__(self, parameters, targets, bench, step=0.08, sensitivities=True, tell=None):
		for kind, items in (("parameter", parameters), ("target", targets)):
			names = [item.name for item in items]
			if not names:
				raise ValueError(f"a calibration needs at least one {kind}")
			if len(set(names)) < len(names):
				raise ValueError(f"a {kind} is given twice: {', '.join(names)}")
		if not 0 < step < 1:
			raise ValueError(
				f"step = {step} of finite differences must be a part of the parameters, between 0 and 1"
			)
		self.parameters, self.targets, self.bench, self.step, self.sensitivities = (
			list(parameters), list(targets), bench, step, sensitivities
		)
		self.tell = tell or (lambda step: None)
		# _around: log-parameters where finite differences were taken last
		self.steps, self.best, self._around = [], None, None
		self._lower, self._upper = (
			np.array([math.log(getattr(p, name)) for p in self.parameters]) for name in ("lower", "upper")
		)

	def run(self):
		"""Search, and return an :class:`Outcome`; a target that is out of reach is no error."""
		begin, reached, why = time.perf_counter(), True, []
		try:
			start = self._scale(np.log([p.start for p in self.parameters]))
			self._respond(start)
			reached, why = False, self._explain()
		except _Reached:
			pass
		except (OutOfBudget, EvaluationError) as error:
			reached, why = False, [str(error)]
		if reached and self.sensitivities and self._far_from_differences():
			try:
				self._differences(self._logs(self.best.values), stop=False)
			except (OutOfBudget, EvaluationError) as error:
				why.append(f"sensitivities could not be measured: {error}")
		elasticities, errors = (
			self.response(self._logs(self.best.values))[1:]
			if self._around is not None and self._spanned()
			else (None, None)
		)
		return Outcome(
			reached, self.best, why, self.steps, elasticities, errors, self.parameters, self.targets,
			time.perf_counter() - begin,
			{} if self.best is None else self._bounds_hit(self._logs(self.best.values))
		)

	# --- the search
	def _scale(self, x):
		"""Steps by the scaling laws, from log-parameters *x*; returns the best point as log-parameters."""
		laws = np.array([[p.laws.get(target.name, 0.0) for p in self.parameters] for target in self.targets])
		tolerances = np.array([target.tolerance for target in self.targets])
		point = self._look([x], "start")[0]
		if point.error:
			raise EvaluationError(f"the first evaluation failed: {point.error}")
		while laws.any():
			step = np.linalg.lstsq(laws, -self._misses(point), rcond=None)[0]
			following = np.clip(x + step, self._lower, self._upper)
			if np.abs(following - x).max() < _SMALLEST_STEP:
				break
			# what the laws cannot bring together, as a ratio of strengths, they would leave as it is
			expected = np.abs((self._misses(point) + laws @ (following - x)) / tolerances).max()
			if expected > _HALF * self._worst(point):
				break
			further = self._look([following], "scaling")[0]
			if further.error or self._worst(further) >= self._worst(point):
				break
			good = self._worst(further) <= _HALF * self._worst(point)
			x, point = self._logs(further.values), further
			if not good:
				break
		return x

	def _respond(self, x):
		"""Steps by the response surface, from log-parameters *x*, until nothing more is gained."""
		self._differences(x)
		tolerances = np.array([target.tolerance for target in self.targets])
		radius, idle = _RADIUS, 0
		while idle < _PATIENCE:
			distance = self._rank(self.best)[1]
			there, expected = self._aim(self._logs(self.best.values), radius, tolerances)
			near = (
				min(np.abs(self._logs(step.point.values) - there).max() for step in self.steps)
				< _SMALLEST_STEP
			)
			if near and np.abs(expected / tolerances).max() > 1:
				return  # it leads nowhere new, and not to the targets either
			known = len(self.steps)
			point = self._look([there], "search")[0]
			if len(self.steps) == known:
				return
			if point.error:
				radius *= 0.5
			idle = 0 if self._rank(self.best)[1] < 0.9 * distance else idle + 1

	def _aim(self, x, radius, tolerances):
		"""Log-parameters within *radius* of *x* and the bounds where the response, modelled around that place,
		comes closest to the targets; and its misses."""
		there = x
		for _ in range(_PASSES):
			misses, slopes, _ = self.response(there)
			wanted = (slopes @ (there - x) - misses) / tolerances
			bounds = np.maximum(self._lower - x, -radius), np.minimum(self._upper - x, radius)
			step = lsq_linear(slopes / tolerances[:, None], wanted, bounds=bounds).x
			there, expected = x + step, misses + slopes @ (x + step - there)
		return there, expected

	def response(self, x):
		"""Logarithmic misses at log-parameters *x*, elasticities around it, and their standard errors, of the
		plane through all points in the sense of weighted least squares.

		A point counts less the farther it is: what bends away from the plane grows with the square of the
		distance, what scatters does not.
		"""
		points = [step.point for step in self.steps if not step.point.error]
		away = np.array([self._logs(point.values) for point in points]) - x
		weights = 1 / np.hypot(_SCATTER, _CURVATURE * (away**2).sum(axis=1))
		matrix = np.column_stack([np.ones(len(points)), away]) * weights[:, None]
		values = np.array([self._misses(point) for point in points]) * weights[:, None]
		plane = np.linalg.lstsq(matrix, values, rcond=None)[0]
		spare = len(points) - matrix.shape[1]
		error = np.full(plane.shape, np.nan)
		if spare >= _SPARE:
			variance = ((values - matrix @ plane)**2).sum(axis=0) / spare
			error = np.sqrt(np.outer(np.diag(np.linalg.pinv(matrix.T @ matrix)), variance))
		return plane[0], plane[1:].T + 0.0, error[1:].T  # no negative zeros

	def _far_from_differences(self):
		"""Whether no finite differences were taken near the best point."""
		return self._around is None or np.abs(
			self._logs(self.best.values) - self._around
		).max() > 1.5 * math.log1p(self.step)

	def _spanned(self):
		"""Whether points differ in every parameter, by more than rounding,
		so that a plane through them has all slopes."""
		logs = np.array([self._logs(step.point.values) for step in self.steps if not step.point.error])
		return np.linalg.matrix_rank(logs - logs.mean(axis=0), tol=1e-3) == len(self.parameters)

	def _differences(self, x, stop=True):
		"""Measure the elasticities around log-parameters *x*: one further point a parameter, all at the same
		time, to the other side where a bound is near or a point fails."""
		base = self._look([x], "search", stop)[0]
		x, width = self._logs(base.values), math.log1p(self.step)
		signs = [1 if x[k] + width <= self._upper[k] else -1 for k in range(len(x))]
		moved = [x + np.eye(len(x))[k] * signs[k] * width for k in range(len(x))]
		self._around = x
		points = self._look(moved, "sensitivity", stop)
		for k in [k for k, point in enumerate(points) if point.error]:
			points[k] = self._look([x - np.eye(len(x))[k] * signs[k] * width], "sensitivity", stop, [k])[0]
			if points[k].error:
				raise EvaluationError(
					"evaluations on both sides of "
					f"{self.parameters[k].name} = {base.values[self.parameters[k].name]:g} "
					f"failed: {points[k].error}"
				)
	# --- points
	def _look(self, logs, purpose, stop=True, columns=None):
		"""Measure points given as log-parameters; raises _Reached at one that meets all targets,
		unless told not to *stop*."""
		values = [
			{
				p.name: min(max(_rounded(value), p.lower), p.upper)
				for p, value in zip(self.parameters, np.exp(x).tolist())
			}
			for x in logs
		]
		seen = [step.point for step in self.steps]
		points = self.bench.measure(values)
		for k, point in enumerate(points):
			if not point.error:
				missing = [target.name for target in self.targets if target.name not in point.measured]
				if missing:
					raise ValueError(
						f"nothing measures the target {missing[0]}; there are "
						f"{', '.join(point.measured) or 'no measures'}"
					)
				if not all(point.measured[target.name] > 0 for target in self.targets):
					points[k] = point = Point(
						point.values, {}, {},
						"a measure is not positive: "
						+ ", ".join(f"{n} = {v:g}" for n, v in point.measured.items())
					)
			if any(point.values == other.values for other in seen):
				continue  # told already
			parameter = (
				self.parameters[(columns or range(len(points)))[k]].name
				if purpose == "sensitivity"
				else None
			)
			self.steps.append(Step(len(self.steps) + 1, purpose, point, parameter))
			if (
				not point.error
				and (self.best is None or self._rank(point) < self._rank(self.best))
				and stop
			):
				self.best = point
			self.tell(self.steps[-1])
		if stop and self.best and self._worst(self.best) <= 1:
			raise _Reached
		return points

	def _logs(self, values):
		return np.log([values[p.name] for p in self.parameters])

	def _misses(self, point):
		"""Logarithmic distances from the targets."""
		return np.log([point.measured[target.name] / target.value for target in self.targets])

	def _rank(self, point):
		"""Points that meet all targets come first, then those whose distances over tolerances have the
		smallest sum of squares."""
		return self._worst(point) > 1, math.hypot(
			*(target.miss(point) / target.tolerance for target in self.targets)
		)

	def _worst(self, point):
		"""The largest distance from a target over its tolerance; all targets are met up to 1."""
		return max(abs(target.miss(point)) / target.tolerance for target in self.targets)

	# --- why it ended
	def _bounds_hit(self, x):
		"""Parameter -> "lower" or "upper" for those of log-parameters *x* that are at a bound."""
		hit = {}
		for k, parameter in enumerate(self.parameters):
			if min(x[k] - self._lower[k], self._upper[k] - x[k]) < _NEAR:
				hit[parameter.name] = (
					"lower" if x[k] - self._lower[k] < self._upper[k] - x[k] else "upper"
				)
		return hit

	def _explain(self):
		"""Sentences on why the search ended at the best point without meeting all targets."""
		x, misses, why = self._logs(self.best.values), self._misses(self.best), []
		tolerances = np.array([target.tolerance for target in self.targets])
		slopes = self.response(x)[1]
		there, expected = self._aim(x, math.inf, tolerances)  # where the response would lead at last
		missed, unmet = np.flatnonzero(np.abs(misses) > tolerances), np.abs(expected) > tolerances
		size = np.abs(slopes).max(axis=1)
		if unmet.any():
			for name, side in self._bounds_hit(there).items():
				k = [p.name for p in self.parameters].index(name)
				if np.abs(slopes[unmet, k]).max() > _NOTHING:
					why.append(
						f"the {side} bound of {name}, {getattr(self.parameters[k], side):g}, "
						"keeps it from going further"
					)
		for i in missed:
			if size[i] < _NOTHING:
				why.append(
					f"no tuned parameter moves {self.targets[i].name} (all elasticities are below "
					f"{_NOTHING:g}): tune another one"
				)
		for a, b in itertools.combinations(np.flatnonzero(size >= _NOTHING), 2):
			if {a, b} & set(missed) and abs(misses[a] - misses[b]) > _FAR * np.linalg.norm(
				slopes[a] - slopes[b]
			):
				names = f"{self.targets[a].name} and {self.targets[b].name}"
				why.append(
					f"{names} answer alike to the tuned parameters, so they cannot be met "
					"independently: tune another parameter as well"
				)
		return why or [
			(
				"no step brought it closer: neighbouring parameters may differ by more than the "
				"tolerance, as where breaking is chaotic; average several seeds, allow a larger "
				"tolerance, or start elsewhere"
			)
		]


class _Reached(Exception):
	"""All targets are met."""


def _rounded(value):
	return float(f"{value:.{DIGITS - 1}e}")
