# GPL v2 or later, see LICENSE.
"""What the points of a study say, in sentences. Needs no YADE."""
import math

from . import convergence

_TARGETS = (0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001, 1e-4, 1e-5)
_NOTHING = 0.001  #: a setting that changes a quantity by less changes nothing
REFINED = ("mesh size", "number of particles")
COMPARED = ("rotation treatment", "law and effects", "flowInterval")  #: kinds whose rungs stand for one another


def per_cent(value):
	"""A share as "2 %"."""
	return f"{100 * value:.2g} %" if value < 0.995 else f"{100 * value:.0f} %"


def seconds(value):
	"""A time as "14 s" or "3 min"."""
	if value < 100:
		return f"{value:.2g} s"
	return f"{value / 60:.2g} min" if value < 6000 else f"{value / 3600:.2g} h"


def grouped(points):
	"""(ladder, quantity) -> its points, in order."""
	groups = {}
	for point in points:
		groups.setdefault((point.ladder, point.quantity), []).append(point)
	return groups


def known(point):
	"""The error that can be told of a point: no less than that of its reference."""
	return max(point.error, point.reference_error)


def prices(points):
	"""What errors cost, for the points of one ladder and quantity: "2 % in strength costs 14 s (4 mm); 1 % costs
	95 s (2.5 mm)". Empty where nothing has an error."""
	front = [p for p in points if p.pareto]
	if not front:
		return ""
	told, last = [], None
	for target in _TARGETS:
		reached = next((p for p in front if known(p) <= target), None)
		if reached is None:
			break
		if last is not None and reached is last[1]:
			told[-1] = (target, reached)
		else:
			told.append((target, reached))
		last = (target, reached)
	if not told:
		best = min(front, key=known)
		return (
			f"{best.quantity}: no setting is closer than {per_cent(known(best))}, which costs "
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
	good = sorted((p for p in points if not p.failed and p.scatter is not None), key=lambda p: -p.step)
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
		change = (point.value - last.value) / abs(last.value) if last.value else math.nan
		price = point.cpu_s / last.cpu_s
		what = (
			"changes nothing"
			if abs(change) < _NOTHING
			else f"changes {point.quantity} by {100 * change:+.2g} %"
		)
		told.append(f"{point.rung} {what} and costs {price:.2g} times")
	return f"Against {last.rung}: {'; '.join(told)}."


def threads(points):
	"""What more threads save, by the clock, and whether they change anything."""
	good = [p for p in points if not p.failed]
	if len(good) < 2:
		return ""
	first, told = good[0], []
	for point in good[1:]:
		same = "the same" if point.value == first.value else "another"
		told.append(
			f"{point.rung} take {point.cost['wall_s'] / first.cost['wall_s']:.2g} of its time by the clock "
			f"and {point.cpu_s / first.cpu_s:.2g} of its processor time, for {same} {point.quantity}"
		)
	return f"Against {first.rung}: {'; '.join(told)}."


def slow_enough(points):
	"""Whether loading was slow enough: what halving a rate changes, and costs."""
	good = [p for p in points if not p.failed]
	told = [
		(
			f"{a.rung} to {b.rung} moves {a.quantity} by {100 * (b.value - a.value) / abs(a.value):+.2g} "
			f"% and costs {b.cpu_s / a.cpu_s:.2g} times"
		)
		for a, b in zip(good, good[1:])
	]
	return f"Loading: {'; '.join(told)}." if told else ""


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


def failures(points):
	"""Settings that failed, each once, with the reason."""
	return list(dict.fromkeys(f"{p.ladder}, {p.rung}: {p.failed}" for p in points if p.failed and not p.skipped))


def skipped(points):
	"""Settings that were not run, each once, with the reason."""
	return list(dict.fromkeys(f"{p.ladder}, {p.rung}: {p.failed}" for p in points if p.skipped))


def all_of(points):
	"""All sentences, those of what refines first."""
	told = []
	for group in grouped(points).values():
		kind, of = group[0].kind, group[0].of
		if kind in REFINED or kind == "time-step fraction":
			told.append(prices(group))
		if kind in REFINED and of == "UCS":
			told.append(hidden(group))
		elif kind == "loading rate" and of == "UCS":
			told.append(slow_enough(group))
		elif kind == "threads" and of == "UCS":
			told.append(threads(group))
		elif kind in COMPARED and of in ("UCS", "displacement"):
			told.append(changes(group))
	return [text for text in (*told, never_worth(points)) if text]
