# GPL v2 or later, see LICENSE.
"""Stresses at the centre of an elastic disc in a Brazilian test, the same for both models: by the angle over which jaws
touch it, under pressure (:func:`hondros`) or under rigid jaws (:func:`pressed`). Angles in degrees."""
import math

import numpy as np


def hondros(angle):
	"""Stresses at the centre of an elastic disc under uniform radial pressure p over two arcs, across and along the
	load, over 2P/(πDt) [-], tension positive (Hondros 1959): (sin 2α − α)/sin α and −(sin 2α + α)/sin α, with the
	force P = p D t sin α.

	:param angle: of each arc, 2α [degree]
	"""
	half = math.radians(angle) / 2
	return (math.sin(2 * half) - half) / math.sin(half), -(math.sin(2 * half) + half) / math.sin(half)


def pressed(angle):
	"""The same under smooth jaws that move as one: a rigid punch's force,
	dP/dx = P/(π √(a² − x²)) with a = D/2 sin α.

	A vertical force dP at the angle θ from the axis of the load gives dP cos θ (1 − 4 sin²θ) across and
	−dP cos θ (3 − 4 sin²θ) along, each times 2/(πDt): its part along the border gives nothing at the centre
	(Flamant's solution).

	:param angle: of each arc, 2α [degree]
	"""
	turned = math.sin(math.radians(angle) / 2) * np.sin((np.arange(200) + 0.5) * math.pi / 200 - math.pi / 2)
	share = np.sqrt(1 - turned**2)
	return float((share * (1 - 4 * turned**2)).mean()), float(-(share * (3 - 4 * turned**2)).mean())
