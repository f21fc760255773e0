# GPL v2 or later, see LICENSE.
"""What the points of a study say, in sentences. Needs no YADE."""
import math
from statistics import median

from . import convergence, prediction, recommendation
from .ladders import COMPARED, REFINED, label

_TARGETS = (0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001, 1e-4, 1e-5)
_NOTHING = 0.001  #: a setting that changes a quantity by less changes nothing


def per_cent(value):
	"""A share as "2 %"."""
	return f"{100 * value:.2g} %" if value < 0.995 else f"{100 * value:.0f} %"


def seconds(value):
	"""A time as "14 s" or "3 min"."""
	if value < 100:
		return f"{value:.2g} s"
	return f"{value / 60:.2g} min" if value < 6000 else f"{value / 3600:.2g} h"


def amount(value, unit):
	"""A value with its unit."""
	return f"{value / 1e6:.3g} MPa" if unit == "Pa" else f"{value:.3g} {unit}"


def grouped(points):
	"""(ladder, quantity) -> its points, in order."""
	groups = {}
	for point in points:
		groups.setdefault((point.ladder, point.quantity), []).append(point)
	return groups


def supported(point):
	"""The error of a rung with seeds that its numbers support: no less than the standard error of their mean, nor
	than that of its reference, which is all that is known where the rung is the reference itself."""
	of_mean = point.scatter / math.sqrt(len(point.errors)) if point.scatter is not None else 0.0
	error = point.reference_error if math.isnan(point.error) else point.known
	return error if math.isnan(error) else max(error, of_mean)


def prices(points):
	"""What errors cost, for the points of one ladder and quantity: "2 % in strength costs 14 s (4 mm); 1 % costs
	95 s (2.5 mm)". Empty where nothing has an error."""
	front = [p for p in points if p.pareto]
	if not front:
		return ""
	told, last = [], None
	for target in _TARGETS:
		reached = next((p for p in front if p.known <= target), None)
		if reached is None:
			break
		if last is not None and reached is last[1]:
			told[-1] = (target, reached)
		else:
			told.append((target, reached))
		last = (target, reached)
	if not told:
		best = min(front, key=lambda p: p.known)
		return (
			f"{best.quantity}: no setting is closer than {per_cent(best.known)}, which costs "
			f"{seconds(best.cpu_s)} ({best.rung})."
		)
	first, *others = told
	text = f"{per_cent(first[0])} in {first[1].quantity} costs {seconds(first[1].cpu_s)} ({first[1].rung})"
	for target, point in others:
		text += f"; {per_cent(target)} costs {seconds(point.cpu_s)} ({point.rung})"
	return text + "."


def two_errors(points):
	"""Sizes and both errors of fracture, for the points of a ladder with seeds: (h, error of discretisation,
	scatter). The first is the difference of the means on h and on h/2, which needs no limit; only sizes whose half
	has been run count."""
	good = sorted((p for p in points if not p.failed and p.scatter is not None and p.step), key=lambda p: -p.step)
	pairs = [(p, half) for p in good for half in good if abs(half.step / p.step - 0.5) < 0.01]
	if len(pairs) < 2:
		return [], [], []
	return (
		[p.step for p, _ in pairs], [abs(p.value - half.value) / abs(half.value) for p, half in pairs],
		[p.scatter for p, _ in pairs]
	)


def recommended(points):
	"""The size at which the scatter of samples hides the mesh, and that scatter;
	None where the two do not cross."""
	h, discretisation, scatter = two_errors(points)
	if not h:
		return None
	size = convergence.crossing(h, discretisation, scatter)
	if size is None:
		return None
	constant, exponent = convergence.power_law(h, scatter)
	return size, constant * size**exponent


def hidden(points):
	"""The sentence of :func:`recommended`."""
	name = points[0].quantity
	h, discretisation, scatter = two_errors(points)
	if not h:
		return ""
	found = recommended(points)
	if found is None:
		of = f"{per_cent(min(scatter))} to {per_cent(max(scatter))}"
		if max(discretisation) < min(scatter):
			return f"Scatter of samples ({of} in {name}) hides the mesh at every size that was run."
		return (
			f"In {name} the mesh counts at every size that was run: its errors do not meet the scatter of "
			f"samples ({of})."
		)
	size, error = found
	return (
		f"Below {per_cent(error)} in {name} the scatter of samples hides the mesh: {1e3 * size:.2g} mm is "
		"fine enough for one sample."
	)


def changes(points):
	"""What the other settings of a ladder change, against its most careful one."""
	good = [p for p in points if not p.failed]
	if len(good) < 2 or points[-1].failed:
		return ""
	last, told = good[-1], []
	for point in good[:-1]:
		change = _change(point, last)
		what = (
			"changes nothing"
			if abs(change) < _NOTHING
			else f"changes {point.quantity} by {100 * change:+.2g} %"
		)
		told.append(f"{point.rung} {what} and costs {point.ratio(last):.2g} times")
	return f"Against {last.rung}: {'; '.join(told)}."


def _change(point, other):
	return (point.value - other.value) / abs(other.value) if other.value else math.nan


def threads(points):
	"""What more threads save, by the clock, and whether they change anything."""
	good = [p for p in points if not p.failed]
	if len(good) < 2:
		return ""
	first, told = good[0], []
	for point in good[1:]:
		same = "the same" if point.value == first.value else "another"
		clock = point.cost["wall_s"] / first.cost["wall_s"]
		share = first.settings["threads"] / (point.settings["threads"] * clock)
		told.append(
			f"{point.rung} take {clock:.2g} of its time by the clock (efficiency {100 * share:.0f} %) and "
			f"{point.ratio(first):.2g} of its processor time, for {same} {point.quantity}"
		)
	return f"Against {first.rung} of {first.cost['particles']:.0f} particles: {'; '.join(told)}."


def quasistatic(points):
	"""What a quantity tends to as loading slows down, a :class:`convergence.Limit`; None where the rungs show no
	order between half of one and four, or there are fewer than three."""
	good = [p for p in points if not p.failed]
	if len({p.step for p in good}) < 3:
		return None
	limit = convergence.richardson([p.step for p in good], [p.value for p in good])
	return limit if limit.value and 0.5 <= limit.order <= 4 else None


def slow_enough(points):
	"""Whether loading was slow enough: what it tends to, how far the usual speed is from that, which speed is near
	enough and what that costs; where no limit shows, what every slower speed changes."""
	good = sorted((p for p in points if not p.failed), key=lambda p: -(p.step or 0))
	name, limit = points[0].quantity, quasistatic(points)
	if len(good) < 2:
		return ""
	standard = recommendation.usual(points) or good[0]
	begin = f"Loading ({points[0].ladder}): "
	if limit is None:
		pairs = list(zip(good, good[1:]))
		told = [
			(
				f"{a.rung} to {b.rung} moves {name} by {100 * _change(b, a):+.2g} % and costs "
				f"{b.ratio(a):.2g} times"
			)
			for a, b in pairs
			if a is standard or b is good[-1]
		]
		return (
			f"{begin}{'; '.join(told)}. These speeds show no limit of the {name}: none is known to be slow "
			"enough."
		)
	own, change = limit.error / abs(limit.value), standard.value / limit.value - 1
	text = (
		f"{begin}as it slows down, {name} tends to {amount(limit.value, points[0].unit)} (order "
		f"{limit.order:.2g}, itself within {per_cent(own)}); {standard.rung}"
		f"{' as usual' if standard.usual else ''} is {per_cent(abs(change))} {_side(change)}"
	)
	return f"{text}; {'; '.join(_slow_for(target, good, standard, limit) for target in (0.02, 0.01))}."


def _side(change):
	return "above" if change > 0 else "below"


def _slow_for(target, good, standard, limit):
	"""Which speed is slow enough for a target, of those that were run or by their power laws."""
	found = next((p for p in good if p.known <= target), None)
	if found is not None:
		return f"{found.rung} is slow enough for {per_cent(target)} and costs {found.ratio(standard):.2g} times"
	last = good[-1]
	error = abs(last.value - limit.value) / abs(limit.value)
	speed = last.step * min(1.0, target / error)**(1 / limit.order)
	_, growth = convergence.power_law([p.step for p in good[-2:]], [p.cpu_s for p in good[-2:]])
	times = last.ratio(standard) * (speed / last.step)**growth
	return (
		f"none that was run is known to be slow enough for {per_cent(target)}, which by these laws takes a "
		f"speed {standard.step / speed:.2g} times lower and {times:.2g} times the cost"
	)


def mesh_dependence(points):
	"""How a quantity that should not depend on the mesh does."""
	good = sorted((p for p in points if not p.failed and p.value > 0), key=lambda p: -p.step)
	if len(good) < 2:
		return ""
	_, exponent = convergence.power_law([p.step for p in good], [p.value for p in good])
	first, last = good[0], good[-1]
	return (
		f"From {first.rung} to {last.rung} {first.quantity} goes from {amount(first.value, first.unit)} to "
		f"{amount(last.value, last.unit)}, as size^{exponent:.2f}; {first.source}: "
		f"{amount(first.reference, first.unit)}."
	)


def headline(group, groups):
	"""What an error costs with all settings chosen for it, and what counts beside them: "2 % in strength costs
	about 14 s: 4 mm, corotational, safety 0.8; 1 % costs about 95 s: 2.5 mm, …; below 0.7 % the scatter of samples
	hides the mesh; the energy book is 6 % of it; β_φ changes nothing here." A clause whose ladder was not run is
	left out; empty where no other ladder of the scene was.

	:param group: points of one quantity of a ladder that refines
	:param groups: points of all ladders, a list each
	"""
	beside = recommendation.companions(group, groups, (*COMPARED, "time-step fraction", "loading rate"))
	if not beside:
		return ""
	told, name = [], group[0].quantity
	for target in _TARGETS:
		found = recommendation.cheapest(target, group, groups)
		if found is None:
			break
		if told and told[-1][1].points == found.points:
			told.pop()
		told.append((target, found))
	clauses = [
		f"{per_cent(target)} {f'in {name} ' if number == 0 else ''}costs {'' if found.measured else 'about '}"
		f"{seconds(found.cpu_s)}: {', '.join(_named(found.points))}"
		for number, (target, found) in enumerate(told)
	]
	crossed = recommended(group)
	if crossed:
		clauses.append(f"below {per_cent(crossed[1])} the scatter of samples hides the mesh")
	clauses += [clause for other in beside if (clause := _beside(other, group[0]))]
	text = "; ".join(clauses)
	return f"{text[0].upper()}{text[1:]}." if text else ""


def _named(points):
	"""Rungs of a combination; effects and flow only where they are not as usual."""
	return [p.rung for p in points if not (p.usual and p.kind in ("law and effects", "flowInterval"))]


def _beside(points, sized):
	"""A clause on what is not combined with a size; empty where there is nothing to say."""
	standard, kind = recommendation.usual(points), points[0].kind
	others = [p for p in points if not p.failed and p is not standard]
	if not others:
		return ""
	if kind == "energy book":
		shares = [1 - ratio for ratio in others[0].ratios(standard)]
		if min(shares) <= 0:
			return "the energy book costs no more than times scatter"
		return f"the energy book is {per_cent(median(shares))} of it"
	if kind == "rotation stiffness":
		change = max((_change(p, standard) for p in others), key=abs)
		if abs(change) < _NOTHING:
			return "β_φ changes nothing here"
		return f"β_φ changes {points[0].quantity} by no more than {per_cent(abs(change))}"
	limit = quasistatic(points) if kind == "loading rate" else None
	if limit is None:
		return ""
	change = standard.value / limit.value - 1
	shared = {**sized.settings, **standard.change}
	own = label({name: value for name, value in standard.settings.items() if name not in shared})
	return (
		f"all at {standard.rung}, where {points[0].quantity} is {per_cent(abs(change))} "
		f"{_side(change)} that of slow loading{f' ({own})' if own else ''}"
	)


def foretold(points):
	"""How well the coarser settings of a ladder foretell its finest one, for the points of one quantity: error and
	processor time that their laws give it, beside those it has. Empty where they show no order, or its reference is
	no better known."""
	good = sorted((p for p in points if not p.failed and p.step is not None), key=lambda p: p.step)
	if len(good) < 3 or not good[0].error > max(good[0].reference_error, 0):
		return ""
	finest = good[0]
	try:
		said = prediction.Laws(good[1:]).at(finest.step)
	except ValueError:
		return ""
	return (
		f"By coarser settings {finest.rung} would have {per_cent(said.error)} in {finest.quantity} for "
		f"{seconds(said.cpu_s)} (order {said.order:.2g}{', not settled' if said.settled is False else ''}); "
		f"it has {per_cent(finest.error)} for {seconds(finest.cpu_s)}."
	)


def never_worth(points):
	"""Rungs that cost more than another of their ladder that is at least as close, in every quantity; those against
	which others are compared are none of them."""
	beaten = {}
	for point in points:
		if not point.failed:
			beaten.setdefault((point.ladder, point.rung), []).append(
				math.isfinite(point.error) and not point.pareto
			)
	names = [f"{rung} ({ladder})" for (ladder, rung), all_ in beaten.items() if all(all_)]
	return f"Never worth it here: {', '.join(names)}." if names else ""


def engines(points):
	"""Where the time goes in the last setting that gave a result: "Where the time goes at 5 mm: triangles 96 %,
	…". Empty where no engine was timed."""
	good = [p for p in points if not p.failed and p.cost.get("engines")]
	if not good:
		return ""
	taken = good[-1].cost["engines"]
	total = sum(taken.values()) or 1.0
	told = [f"{name} {per_cent(ns / total)}" for name, ns in taken.items() if ns > 0.005 * total]
	return f"Where the time goes at {good[-1].rung}: {', '.join(told)}."


def of_one(points):
	"""What the finest sample of a ladder with seeds costs, beside its error of discretisation and the scatter of
	samples, for the points of one quantity: "Strength with 3 mm: …". Empty where it gave no result."""
	good = [p for p in points if not p.failed and p.step is not None]
	if not good:
		return ""
	finest = min(good, key=lambda p: p.step)
	name = finest.quantity[:1].upper() + finest.quantity[1:]
	told = f"{name} with {finest.rung}: {seconds(finest.cpu_s)} of processor time a sample"
	error = supported(finest)
	if math.isfinite(error) and finest.source:
		bound = "up to " if math.isnan(finest.error) else ""
		told += f", error of discretisation {bound}{per_cent(error)} ({finest.source})"
	else:
		told += ", error of discretisation not known: there is no coarser sample to compare with"
	if finest.scatter is None:
		return told + "."
	told += f", scatter of samples {per_cent(finest.scatter)}"
	if not (math.isfinite(error) and finest.source):
		return told + "."
	if math.isnan(finest.error):  # the bound on the error is then that of what scatters
		return told + ": sizes show no trend, so more seeds come first."
	more, less = ("more seeds", "a finer sample") if finest.scatter > error else ("a finer sample", "more seeds")
	return f"{told}: {more} would show more than {less}."


def failures(points):
	"""Settings that failed, each once, with the reason."""
	return list(dict.fromkeys(f"{p.ladder}, {p.rung}: {p.failed}" for p in points if p.failed and not p.skipped))


def skipped(points):
	"""Settings that were not run, each once, with the reason."""
	return list(dict.fromkeys(f"{p.ladder}, {p.rung}: {p.failed}" for p in points if p.skipped))


def all_of(points):
	"""All sentences, those of all settings together first."""
	groups = list(grouped(points).values())
	told = [headline(group, groups) for group in groups if group[0].kind in REFINED and group[0].of == "UCS"]
	for group in groups:
		kind, of = group[0].kind, group[0].of
		if of == "crack energy" and kind in REFINED:
			told.append(mesh_dependence(group))
		elif kind in REFINED or kind == "time-step fraction":
			told.append(prices(group))
		if kind in REFINED and of not in ("crack energy", "energy book"):
			told.append(foretold(group))
		if kind in REFINED and of == "UCS":
			told.append(hidden(group))
		elif kind == "loading rate" and of == "UCS":
			told.append(slow_enough(group))
		elif kind == "threads" and of == "UCS":
			told.append(threads(group))
		elif kind in COMPARED and of in ("UCS", "displacement"):
			told.append(changes(group))
	return [text for text in (*told, never_worth(points)) if text]
