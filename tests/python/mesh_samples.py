# GPL v2 or later, see LICENSE.
"""Meshes that the tests share, with what is known about them."""
import math
from dataclasses import dataclass, field

import numpy as np

from ddem import mesh

BAR = mesh.box(0.043, 0.093, 0.057, 0.107)
HOLE = mesh.disc(0.05, 0.15, 0.01, 48)
ANGLED = [(0, 0), (0.1, 0), (0.1, 0.04), (0.04, 0.04), (0.04, 0.1), (0, 0.1)]


def shoelace(corners):
	"""Area of a polygon."""
	return 0.5 * abs(sum(xa * yb - xb * ya for (xa, ya), (xb, yb) in zip(corners, [*corners[1:], corners[0]])))


def circumference(corners):
	return sum(math.dist(a, b) for a, b in zip(corners, [*corners[1:], corners[0]]))


def towards_hole(x, y):
	"""A size field: 1 mm at the hole's border, growing by 0.2 m per m."""
	return 0.001 + 0.2 * max(0, math.hypot(x - 0.05, y - 0.15) - 0.01)


@dataclass
class Sample:
	mesh: mesh.Mesh
	outline: list
	holes: list = field(default_factory=list)
	regions: dict = field(default_factory=dict)  # those with exact borders
	generated: bool = True  # by CGAL


def _sample(outline, holes=(), regions=None, **options):
	return Sample(
		mesh.polygon(outline, holes=holes, regions=regions, **options),
		[*np.asarray(outline)],
		[*holes],
		regions or {},
	)


def _block(pattern, **options):
	return Sample(
		mesh.rectangle(0.1, 0.2, pattern=pattern, **options), [*mesh.box(0, 0, 0.1, 0.2)], generated=False
	)


SAMPLES = {
	"crossed": lambda: _block("crossed", size=0.01),
	"crossed, odd cells": lambda: _block("crossed", nx=3, ny=5),
	"alternating": lambda: _block("alternating", size=0.01),
	"alternating, odd cells": lambda: _block("alternating", nx=3, ny=5),
	"one cell": lambda: _block("alternating", size=1),
	"unstructured": lambda: _sample(mesh.box(0, 0, 0.1, 0.2), regions={"steel": BAR}, size=0.005),
	"not smoothed": lambda: _sample(mesh.box(0, 0, 0.1, 0.2), regions={"steel": BAR}, size=0.005, smoothing=0),
	"another draw": lambda: _sample(mesh.box(0, 0, 0.1, 0.2), size=0.005, seed=3),
	"hole and size field": lambda: _sample(
		mesh.box(0, 0, 0.1, 0.2),
		holes=[HOLE],
		size=towards_hole,
		regions={"lining": mesh.disc(0.05, 0.15, 0.02, 64)},
	),
	"three holes": lambda: _sample(
		mesh.disc(0, 0, 0.1, 90), holes=[mesh.disc(x, 0.01, 0.02, 30) for x in (-0.05, 0, 0.05)], size=0.008
	),
	"angled": lambda: _sample(
		ANGLED, regions={"foot": mesh.box(0, 0, 0.1, 0.02), "corner": mesh.box(0, 0.02, 0.04, 0.04)}, size=0.006
	),
	"clockwise outline": lambda: _sample(ANGLED[::-1], size=0.01),
	"coarser than the outline": lambda: _sample(mesh.disc(0, 0, 1, 7), size=5),
}
