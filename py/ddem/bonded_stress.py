# GPL v2 or later, see LICENSE.
"""Stress inside of a sample of bonded spheres."""
import itertools

import numpy as np

from yade import O

from . import cells


def mean_stress(sample, lower, upper):
	"""Mean stress tensor (3, 3) [Pa] in a box within the sample, tension positive, from the forces of all bonds
	that run through it.

	Each force acts along the line between two centres; the box gets the share of the line that lies in it:
	σ = (1/V) Σ l ⊗ f (Bagi 1996). Bonds of spheres of the sample alone count, contacts of broken surfaces do not.

	:param sample: :class:`bonded.BondedSample`
	:param lower, upper: corners of the box (3,) [m]; in a periodic cell that may lie anywhere, and what repeats
		in it counts as often
	:raises ValueError: an upper corner that is not above the lower one, a box with no bond in it

	Limits: of a box a few spheres wide it is the stress of these few.
	"""
	lower, upper = np.asarray(lower, float), np.asarray(upper, float)
	if not (upper > lower).all():
		raise ValueError(
			f"mean_stress: upper = {tuple(upper)} m must be above lower = {tuple(lower)} m in x, y and z"
		)
	pairs = sample.bonds
	rows = sample.rows(pairs)
	one, two = sample.positions[rows].transpose(1, 0, 2)
	one, two, images = _in_cell(one, two, lower, upper)
	share = sum(_share_within(one + shift, two + shift, lower, upper) for shift in images)
	if not (share > 0).any():
		raise ValueError(f"mean_stress: no bond runs through the box from {tuple(lower)} to {tuple(upper)} m")
	total = np.zeros((3, 3))
	for (i, j), part, branch in zip(pairs[share > 0], share[share > 0], (two - one)[share > 0]):
		bond = O.interactions[int(i), int(j)]
		# the force on the second body of the interaction, whichever of the two comes first
		force = np.array(bond.phys.normalForce + bond.phys.shearForce) * (1 if bond.id1 == i else -1)
		total -= part * np.outer(branch, force)
	return 0.5 * (total + total.T) / float((upper - lower).prod())


def _in_cell(one, two, lower, upper):
	"""Ends of bonds (n, 3), in a periodic cell the second one as the nearest image to the first, which is moved
	into the cell; and the shifts by which what repeats reaches a box."""
	cell = cells.sides()
	if cell is None:
		return one, two, [np.zeros(3)]
	inverse = np.linalg.inv(cell).T
	two = one + cells.nearest(two - one)
	into = -np.floor(one @ inverse) @ cell.T
	corners = np.array(list(itertools.product(*zip(lower, upper)))) @ inverse
	ranges = [range(int(np.floor(c.min())) - 1, int(np.ceil(c.max())) + 1) for c in corners.T]
	return one + into, two + into, [cell @ shift for shift in itertools.product(*ranges)]


def _share_within(one, two, lower, upper):
	"""Share (n,) of each line from *one* to *two* (n, 3) that lies in a box."""
	way = two - one
	with np.errstate(divide="ignore", invalid="ignore"):
		ends = np.stack([(lower - one) / way, (upper - one) / way])
	along = way == 0  # such a line lies between two faces, or beside them
	inside = (one >= lower) & (one <= upper)
	first = np.where(along, np.where(inside, 0, 2), ends.min(axis=0)).max(axis=1)
	last = np.where(along, np.where(inside, 1, -1), ends.max(axis=0)).min(axis=1)
	return np.maximum(np.minimum(last, 1) - np.maximum(first, 0), 0)
