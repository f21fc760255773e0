# GPL v2 or later, see LICENSE.
"""The periodic cell of a scene: its sides, nearest images, and what has no place in it."""
import numpy as np

from yade import O


def sides():
	"""Sides of the scene's periodic cell (3, 3), one a column [m]; None where the scene is not periodic."""
	return np.array(O.cell.hSize, float).reshape(3, 3) if O.periodic else None


def nearest(branch):
	"""Vectors (n, 3) [m] between places, to the nearest image of the second; as they are without a cell."""
	cell = sides()
	return branch if cell is None else branch - np.round(branch @ np.linalg.inv(cell).T) @ cell.T


def require_faces():
	"""Refuse a periodic cell, for loads that need a sample with faces.

	:raises ValueError: saying what loads a cell
	"""
	if O.periodic:
		raise ValueError(
			"a sample in a periodic cell has no faces for walls: load the cell, by O.cell.velGrad or "
			"PeriTriaxController (see the manual), or set O.periodic = False before the sample is made"
		)
