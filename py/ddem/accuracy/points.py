# GPL v2 or later, see LICENSE.
"""Points of work and precision: what every rung of a ladder cost, and how far off it was. Needs no YADE."""
import math
from dataclasses import dataclass, field, replace
from statistics import fmean, median, stdev

from . import convergence
from .ladders import COMPARED, label

NOT_RUN = "not run: "  #: how the outcome of a rung begins for which there was no time
#: costs that are averaged over seeds
_AVERAGED = (
	"cpu_s", "wall_s", "ns_per_particle_step", "bytes_per_particle", "memory_MB", "steps", "particles", "unknowns"
)


@dataclass(frozen=True)
class Point:
	"""A rung of a ladder and one quantity."""
	ladder: str
	kind: str  # of the ladder
	scene: str
	quantity: str
	of: str  # kind of the quantity
	unit: str
	rung: str  # in words
	settings: dict
	change: dict = field(default_factory=dict)  # of the settings, what this rung has of its own
	usual: bool = False  # whether the other ladders of the scene run with it
	step: float = None  # what is refined; None where nothing is
	value: float = math.nan  # mean over seeds
	scatter: float = None  # standard deviation over seeds, over the mean [-]
	error: float = math.nan  # of the mean; where the scene gives errors, their mean [-]
	errors: tuple = ()  # of every seed [-]
	reference: float = math.nan
	reference_error: float = 0.0  # of the reference itself [-]
	source: str = ""  # of the reference
	cost: dict = field(default_factory=dict)
	cpu_each: tuple = ()  # core-seconds of every seed [s]
	failed: str = ""  # why there is no result
	skipped: bool = False  # it was not run: there was no time
	pareto: bool = False  # whether no other rung of the ladder is both cheaper and closer

	@property
	def cpu_s(self):
		"""Core-seconds of its steps, mean over seeds."""
		return self.cost.get("cpu_s", math.nan)

	@property
	def cpu_range(self):
		"""Least and most core-seconds of the seeds [s]; empty where there are none."""
		return (min(self.cpu_each), max(self.cpu_each)) if self.cpu_each else ()

	@property
	def known(self):
		"""The error that can be told: no less than that of the reference [-]."""
		return max(self.error, self.reference_error)

	def ratios(self, other):
		"""Core-seconds over those of another rung [-], of every seed."""
		if len(self.cpu_each) == len(other.cpu_each) > 0:
			return [mine / its for mine, its in zip(self.cpu_each, other.cpu_each)]
		return [self.cpu_s / other.cpu_s]

	def ratio(self, other):
		"""Core-seconds over those of another rung [-]: the median of the seeds, since machines are noisy."""
		return median(self.ratios(other))

	def plain(self):
		"""For cost.json; None where a number is not finite."""
		row = {
			"case": self.scene,
			"ladder": self.ladder,
			"kind": self.kind,
			"quantity": self.quantity,
			"of": self.of,
			"unit": self.unit,
			"rung": self.rung,
			"settings": self.settings,
			"h": self.step,
			"value": self.value,
			"scatter": self.scatter,
			"error": self.error,
			"errors": list(self.errors),
			"reference": self.reference,
			"reference_error": self.reference_error,
			"source": self.source,
			**{name: self.cost.get(name) for name in (*_AVERAGED, "dt_s", "threads", "engines")},
			"cpu_range_s": list(self.cpu_range),
			"digits_of_accuracy": convergence.digits(self.error),
			"digits_of_size": -convergence.digits(self.cost.get("unknowns", math.nan)),
			"digits_of_efficacy": convergence.efficacy(self.error, self.cpu_s),
			"pareto": self.pareto,
			"failed": self.failed or None,
		}
		return {
			name: None if isinstance(value, float) and not math.isfinite(value) else value
			for name, value in row.items()
		}


def of_ladder(ladder, outcomes, scene):
	"""All points of a ladder.

	:param outcomes: for each rung a list of what its seeds gave: a dict as :func:`rungs.perform` returns it, or the
		text of an error
	:param scene: its name
	"""
	found = []
	for quantity in ladder.quantities:
		points = [
			_measured(ladder, quantity, rung, outcome, scene)
			for rung, outcome in zip(ladder.rungs, outcomes, strict=True)
		]
		found += _on_front(_with_errors(ladder, points))
	return found


def _measured(ladder, quantity, rung, outcome, scene):
	point = Point(
		ladder.name, ladder.kind, scene, quantity.name, quantity.kind, quantity.unit, label(rung),
		ladder.settings(rung), rung, rung == ladder.usual, ladder.step(rung), source=quantity.source
	)
	wrong = [text for text in outcome if isinstance(text, str)]
	if wrong:
		return replace(point, failed=wrong[0], skipped=wrong[0].startswith(NOT_RUN))
	samples = [_entry(one, quantity.key) for one in outcome]
	if None in samples:
		names = sorted(name.partition(":")[2] for name in outcome[0] if name.startswith("value:"))
		return replace(point, failed=f"the scene gives no '{quantity.key}', but {', '.join(names)}")
	values = [value for value, _, _ in samples]
	mean = fmean(values)
	names = [name for name in _AVERAGED if all(name in one for one in outcome)]  # bytes are not known of all scenes
	cost = {name: fmean(one[name] for one in outcome) for name in names}
	cost["engines"] = _engines(outcome)
	cost.update(dt_s=outcome[0]["dt_s"], threads=outcome[0]["threads"])
	known = [error for _, _, error in samples]
	point = replace(
		point, value=mean, scatter=stdev(values) / abs(mean) if len(values) > 1 and mean else None,
		cost=cost, cpu_each=tuple(one["cpu_s"] for one in outcome)
	)
	if None in known:
		return replace(point, errors=tuple(values))  # values so far: their reference is not known yet
	return replace(
		point, error=fmean(known), errors=tuple(known), reference=samples[0][1],
		source=point.source or "the case's reference"
	)


def _engines(outcome):
	"""Engine -> ns a particle-step by the clock, mean over seeds, the largest first."""
	names = dict.fromkeys(name for one in outcome for name in one if name.startswith("engine:"))
	found = {name.partition(":")[2]: fmean(one.get(name, 0.0) for one in outcome) for name in names}
	return dict(sorted(found.items(), key=lambda item: -item[1]))


def _entry(outcome, key):
	"""(value, reference, error) of the entry that begins with a key, in which "…" stands for anything; None where
	there is none."""
	begin, *others = key.split("…")
	for name, value in outcome.items():
		if name.startswith(f"value:{begin}") and all(part in name for part in others):
			rest = name.partition(":")[2]
			return value, outcome.get(f"reference:{rest}", math.nan), outcome.get(f"error:{rest}")
	return None


def _with_errors(ladder, points):
	"""Errors of quantities that have no reference: against what they tend to,
	else against the most careful rung."""
	open_ = [p for p in points if not p.failed and math.isnan(p.error)]
	if not open_ or (points[-1].failed and not ladder.refined):
		return points  # what the others stand against is not there
	limit, own, source = open_[-1].value, math.nan, f"the ladder's last rung, {open_[-1].rung}"
	steps = [p.step for p in open_]
	if ladder.refined and len(set(steps)) > 2:
		found = convergence.richardson(steps, [p.value for p in open_])
		# where samples scatter, the limit is no better known than the mean of the finest
		finest = min(open_, key=lambda p: p.step)
		scatter = (finest.scatter or 0.0) / math.sqrt(max(1, len(finest.errors)))
		limit, own = found.value, found.error / abs(found.value) + scatter
		order = (
			f"observed order {found.order:.2g}"
			if math.isfinite(found.order)
			else "no order observed: the finest"
		)
		source = f"Richardson's limit of this ladder, {order}"
	elif ladder.kind in COMPARED:
		own = 0.0  # the most complete setting is what the others are measured by
	elif len(open_) > 1:
		own = abs(open_[-1].value - open_[-2].value) / abs(limit)

	def closed(point):
		if point not in open_:
			return point
		error = abs(point.value - limit) / abs(limit)
		return replace(
			point, error=error if point.value != limit else math.nan,
			errors=tuple(abs(value - limit) / abs(limit) for value in point.errors), reference=limit,
			reference_error=own,
			source=source
		)

	return [closed(point) for point in points]


def _on_front(points):
	places = convergence.front([p.cpu_s for p in points], [p.error for p in points])
	return [replace(point, pareto=place in places) for place, point in enumerate(points)]
