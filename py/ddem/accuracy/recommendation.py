# GPL v2 or later, see LICENSE.
"""The cheapest combination of settings for an error, from the points of all ladders of a scene. Needs no YADE.

A ladder changes one setting, and leaves the others as the scene has them. Its costs are carried over to other sizes as
ratios to its usual rung, its errors as they are; errors of a combination add up, as if none made up for another. That
is an estimate: nobody has run the combination.
"""
import itertools
import math
from dataclasses import dataclass

#: kinds of settings that are combined with a size; without the energy book nothing says that a run is sound
COMBINED = ("rotation treatment", "law and effects", "time-step fraction", "flowInterval")
_SAVES = 0.03  #: a setting that saves a smaller part of the time is not taken for that


@dataclass(frozen=True)
class Combination:
	"""Settings together, and what they give."""
	points: tuple  # that of the size first, then one of each ladder that is combined with it
	error: float  # sum of their errors [-]
	cpu_s: float  # [s]

	@property
	def measured(self):
		"""Whether it has been run: all but the size is as usual."""
		return all(point.usual for point in self.points[1:])


def companions(group, groups, kinds):
	"""Ladders of these kinds that change a setting of the same scene.

	:param group: points of one ladder and quantity that refines
	:param groups: list of such lists
	:returns: those of *groups* that give the same quantity and whose usual rung has a result
	"""
	sized = group[0]
	shared = _without(sized, sized.change)
	return [
		other for other in groups
		if other[0].kind in kinds and (other[0].scene, other[0].quantity) == (sized.scene, sized.quantity)
		and _within(shared, other[0].settings) and usual(other)
	]


def usual(group):
	"""The point of a ladder with which other ladders of its scene run; None where it has no result."""
	return next((p for p in group if p.usual and not p.failed), None)


def cheapest(target, group, groups):
	"""The cheapest :class:`Combination` whose errors add up to no more than a target.

	:param target: relative error [-]
	:param group: points of one quantity of a ladder that refines
	:param groups: points of the other ladders, as :func:`companions` takes them
	:returns: None where there is none
	"""
	sizes = [(p, p.known, p.cpu_s) for p in group if not p.failed and math.isfinite(p.error)]
	others = [_choices(other) for other in companions(group, groups, COMBINED)]
	best = None
	for (size, error, seconds), *chosen in itertools.product(sizes, *others):
		error += sum(own for _, own, _ in chosen)
		seconds *= math.prod(ratio for _, _, ratio in chosen)
		points = (size, *(point for point, _, _ in chosen))
		# a sum of errors that is the target itself must not fail by its last digit
		near = error <= target or math.isclose(error, target)
		if near and (best is None or seconds < best.cpu_s) and _fit(points):
			best = Combination(points, error, seconds)
	return best


def _choices(group):
	"""(point, error, part of the usual time) of what can be taken instead of the usual rung, and of that."""
	standard = usual(group)
	found = []
	for point in group:
		if point.failed:
			continue
		error, ratio = _error(point), point.ratio(standard)
		if point.usual or ratio < 1 - _SAVES or error < _error(standard):
			found.append((point, error, ratio))
	return found


def _error(point):
	"""Of a point; none for that against which the others are measured."""
	return point.known if math.isfinite(point.error) else point.reference_error


def _fit(points):
	"""Whether what each unusual setting has been run with is what all of them together have."""
	together = {}
	for point in points[1:]:
		if not point.usual:
			_merge(together, point.change)
	together = {**points[0].settings, **together}
	return all(point.usual or _within(_without(point, points[0].change), together) for point in points[1:])


def _without(point, names):
	return {name: value for name, value in point.settings.items() if name not in names}


def _merge(into, change):
	for name, value in change.items():
		into[name] = {**into.get(name, {}), **value} if isinstance(value, dict) else value


def _within(part, whole):
	return all(
		_within(value, whole.get(name, {})) if isinstance(value, dict) else whole.get(name) == value
		for name, value in part.items()
	)
