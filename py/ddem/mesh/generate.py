# GPL v2 or later, see LICENSE.
"""Mesh generation: regular rectangles, and irregular meshes of any polygon by CGAL."""
import math
import warnings

import numpy as np

from .. import _mesh, provenance
from .outline import Rings, box, distance, inside, signed_area
from .triangles import Mesh

PATTERNS = ("crossed", "alternating", "unstructured")
# triangles; about 15 GB in a YADE scene, whose bodies take 2.5 kB a triangle before the engine takes its part
LIMIT = 5_000_000

# With this bound on the longest edge, CGAL's meshes have the wanted size as their mean edge length (within 5 %,
# measured on rectangles and discs).
_LONGEST_EDGE = 1.45
# Triangles per (area / size²) at that bound; 4/√3 = 2.31 for equilateral triangles.
_DENSITY = 2.38
# A regular mesh may miss a region's area by this much without a warning: two triangles of a hundred.
_AREA_TOLERANCE = 0.025


def rectangle(width, height, size=None, pattern="crossed", regions=None, nx=None, ny=None, **unstructured):
	"""Mesh of a rectangle whose lower left corner is the origin.

	:param width, height: [m]
	:param size: side of the cells [m], rounded so that whole cells fit; for "unstructured", the wanted edge
		length [m], or a function of x and y
	:param pattern: "crossed": each cell cut into four triangles by both diagonals (no preferred direction);
		"alternating": each cell cut into two, the direction of the diagonal alternating like the
		stripes of a union jack;
		"unstructured": :func:`polygon`, which also takes holes=, min_angle=, smoothing=, seed= and limit=
	:param regions: name -> polygon, as for :func:`polygon`; but in a regular mesh a triangle belongs to a region
		when its centroid lies in it, so the region's border follows the nearest mesh lines; a warning gives the
		error of its area above 2.5 %. An unstructured mesh has exact borders.
	:param nx, ny: number of cells, instead of size

	The meshes of Zubelewicz (2018) are "crossed" with 10 mm cells: 0.1 m x 0.4 m gives its 1600 triangles,
	0.1 m x 0.2 m its 800, and box(0.043, 0.093, 0.057, 0.107) the 8 triangles of its rebar (2 cm²,
	2 % more than the 1.4 cm x 1.4 cm it names).
	"""
	for name, value in (("width", width), ("height", height)):
		_positive(value, f"rectangle: {name}")
	if pattern not in PATTERNS:
		raise ValueError(f"rectangle: unknown pattern {pattern!r}; use one of {', '.join(PATTERNS)}")
	if pattern == "unstructured":
		if nx is not None or ny is not None:
			raise ValueError(
				"rectangle: nx and ny count the cells of a regular mesh; give size [m] for "
				"pattern=\"unstructured\""
			)
		return polygon(box(0, 0, width, height), size=size, regions=regions, **unstructured)
	limit = unstructured.pop("limit", LIMIT)
	if unstructured:
		raise ValueError(
			f"rectangle: {', '.join(unstructured)} only for pattern=\"unstructured\", not for {pattern!r}"
		)
	nx, ny = _cells(width, size, nx, "nx"), _cells(height, size, ny, "ny")
	_check_count(nx * ny * (4 if pattern == "crossed" else 2), limit, f"rectangle: {nx} x {ny} cells")

	nodes, triangles = (_crossed if pattern == "crossed" else _alternating)(nx, ny)
	mesh = Mesh(nodes * (width / nx, height / ny), triangles)
	rings = Rings.assemble(box(0, 0, width, height), [], _named(regions))
	shapes = dict(zip(_named(regions), (rings.points[chain] for chain in rings.chains[1:])))
	result = _with_regions(mesh, shapes)
	for name, shape in shapes.items():
		wanted, found = signed_area(shape), mesh.areas[inside(mesh.centroids, shape)].sum()
		if abs(found / wanted - 1) > _AREA_TOLERANCE:
			warnings.warn(
				(
					f"region {name!r}: the triangles with their centroid in it cover {found:.4g} "
					f"m² instead of {wanted:.4g} m² ({found / wanted - 1:+.1%}); choose a size "
					"whose mesh lines meet its border, or pattern=\"unstructured\", which "
					"follows it exactly"
				),
				stacklevel=2,
			)
	return result


def polygon(outline, holes=(), size=None, regions=None, min_angle=20.6, smoothing=10, seed=None, limit=LIMIT):
	"""Irregular mesh of a polygon with holes, by Delaunay refinement (CGAL) and Lloyd smoothing,
	renumbered for locality.

	:param outline: corners [m] in order; either direction
	:param holes: polygons inside the outline; they may not touch it or each other
	:param size: wanted edge length [m]: a number, or a function of x and y [m]. The mean edge length is the size
		within 5 %, no edge is longer than 1.8 times the size at the centroid of its triangle. A function should
		change by less than about 0.3 m per m; the mesh cannot follow it faster.
	:param regions: name -> polygon inside the outline; its border consists of triangle edges, so its area is exact.
		Borders may touch (share corners and edges) but not cross; of nested regions the later one wins.
	:param min_angle: bound on the smallest angle [degree], at most 20.7, kept except where borders meet at less
		than 60 degrees. Typical meshes reach 28.
	:param smoothing: number of smoothing steps; 0 for none
	:param seed: a whole number draws another, equally good mesh; the same input and seed always give the same mesh
	:param limit: raise ValueError when more triangles are needed
	"""
	regions = _named(regions)
	rings = Rings.assemble(outline, list(holes), regions)
	_check_angle(min_angle)
	if int(smoothing) != smoothing or smoothing < 0:
		raise ValueError(f"polygon: smoothing is {smoothing}; it must be a whole number of steps, 0 or more")
	field = _SizeField(size)
	shapes = [rings.points[chain] for chain in rings.chains]
	_check_count(
		_expected(shapes[: rings.holes + 1], field),
		limit,
		f"polygon: size {field}" if field.uniform else "polygon: the size field",
	)

	points, segments, pieces = _divided(rings, field)
	if seed is not None:
		provenance.note_seed(seed)
		points = np.vstack([points, _scattered(shapes[:rings.holes + 1], points[segments], field, seed)])
	holes = [np.array(pieces[i], dtype=np.int32) for i in range(1, rings.holes + 1)]
	nodes, triangles = _mesh.triangulate(
		points, segments, holes, field.size if field.uniform else field, _LONGEST_EDGE, math.radians(min_angle),
		int(smoothing), int(limit)
	)
	mesh = Mesh(np.frombuffer(nodes).reshape(-1, 2), np.frombuffer(triangles, dtype=np.int32).reshape(-1, 3))
	return _with_regions(mesh, dict(zip(regions, shapes[rings.holes + 1:]))).reordered()


# ---- regular meshes, on cells of side 1 ----


def _grid(nx, ny):
	x, y = np.meshgrid(np.arange(nx + 1), np.arange(ny + 1))
	nodes = np.column_stack([x.ravel(), y.ravel()]).astype(float)
	column, row = np.meshgrid(np.arange(nx), np.arange(ny))
	a = (row * (nx + 1) + column).ravel()  # lower left corner of each cell
	return nodes, a, a + 1, a + nx + 2, a + nx + 1, (row + column).ravel()


def _crossed(nx, ny):
	nodes, a, b, c, d, _ = _grid(nx, ny)
	centre = len(nodes) + np.arange(nx * ny)
	triangles = np.stack(
		[np.column_stack(t) for t in ((a, b, centre), (b, c, centre), (c, d, centre), (d, a, centre))], axis=1
	)
	return np.vstack([nodes, nodes[a] + 0.5]), triangles.reshape(-1, 3)


def _alternating(nx, ny):
	nodes, a, b, c, d, parity = _grid(nx, ny)
	rising = [np.column_stack(t) for t in ((a, b, c), (a, c, d))]
	falling = [np.column_stack(t) for t in ((a, b, d), (b, c, d))]
	triangles = np.stack([np.where((parity % 2 == 0)[:, None], r, f) for r, f in zip(rising, falling)], axis=1)
	return nodes, triangles.reshape(-1, 3)


def _cells(length, size, number, name):
	if number is not None:
		if int(number) != number or number < 1:
			raise ValueError(
				f"rectangle: {name} is {number}; it must be a whole number of cells, at least 1"
			)
		return int(number)
	if callable(size):
		raise ValueError("rectangle: a size field needs pattern=\"unstructured\"; a regular mesh has one size")
	_positive(size, f"rectangle: size (or give {name})")
	return max(1, round(min(length / size, 1e9)))


# ---- irregular meshes ----


class _SizeField:
	"""The wanted edge length as a function, whether the user gave a number or a function."""

	def __init__(self, size):
		self.uniform = not callable(size)
		if self.uniform:
			_positive(size, "polygon: size")
		self.size = float(size) if self.uniform else size

	def __str__(self):
		return f"{self.size:g} m" if self.uniform else "field"

	def __call__(self, x, y):
		if self.uniform:
			return self.size
		value = self.size(x, y)
		try:
			value = float(value)
		except (TypeError, ValueError):
			value = math.nan
		if not (value > 0 and math.isfinite(value)):
			raise ValueError(
				f"size field gives {value} m at ({x:.6g}, {y:.6g}) m; it must be a positive "
				"length [m] everywhere in the outline"
			)
		return value

	def at(self, points):
		return np.array([self(x, y) for x, y in points.tolist()])


def _divided(rings, field):
	"""Points, segments and rings with every edge cut into even pieces of the wanted size;
	left to the mesh generator, edges would be halved."""
	points, cuts = [*rings.points], {}
	for a, b in rings.segments().tolist():
		start, end = rings.points[a], rings.points[b]
		middle = []
		for part in _cut(start, end, field):
			points.append(start + part * (end - start))
			middle.append(len(points) - 1)
		cuts[a, b] = [a, *middle, b]
	segments = [pair for chain in cuts.values() for pair in zip(chain, chain[1:])]
	pieces = []
	for chain in rings.chains:
		edges = zip(chain.tolist(), np.roll(chain, -1).tolist())
		pieces.append([index for a, b in edges for index in (cuts[a, b][:-1] if a < b else cuts[b, a][:0:-1])])
	return np.array(points), np.array(segments, dtype=np.int32), pieces


def _cut(start, end, field):
	"""Where to cut an edge (fractions of its length): equal shares of the integral of 1/size along it."""
	length = np.linalg.norm(end - start)
	samples = 1 if field.uniform else 64
	while True:
		part = np.linspace(0, 1, samples + 1)
		sizes = field.at(start + part[:, None] * (end - start))
		if samples * sizes.min() >= length or field.uniform or samples > 100_000:
			break
		samples *= 2
	share = np.concatenate([[0], np.cumsum(0.5 * (1 / sizes[1:] + 1 / sizes[:-1])) * length / samples])
	pieces = max(1, round(share[-1]))
	return np.interp(share[-1] * np.arange(1, pieces) / pieces, share, part)


def _expected(shapes, field, grid=64):
	"""Number of triangles to expect, from the field on a grid of points."""
	area = signed_area(shapes[0]) - sum(signed_area(hole) for hole in shapes[1:])
	if field.uniform:
		return _DENSITY * area / field.size / field.size
	low, span = shapes[0].min(axis=0), np.ptp(shapes[0], axis=0)
	x, y = np.meshgrid((np.arange(grid) + 0.5) / grid, (np.arange(grid) + 0.5) / grid)
	points = low + span * np.column_stack([x.ravel(), y.ravel()])
	points = points[_in_domain(points, shapes)]
	sizes = field.at(points if len(points) else shapes[0])
	return _DENSITY * area * float((sizes**-2).mean())


def _in_domain(points, shapes):
	result = inside(points, shapes[0])
	for hole in shapes[1:]:
		result &= ~inside(points, hole)
	return result


def _scattered(shapes, segments, field, seed):
	"""A few random inner nodes far from each other and from the borders: the refinement starts differently,
	with the same guarantees."""
	if int(seed) != seed or seed < 0:
		raise ValueError(f"polygon: seed is {seed}; it must be a whole number, 0 or more")
	random = np.random.default_rng(int(seed))
	low, span = shapes[0].min(axis=0), np.ptp(shapes[0], axis=0)
	candidates = low + span * random.random((int(min(2000, 20 + _expected(shapes, field) / 4)), 2))
	candidates = candidates[_in_domain(candidates, shapes)]
	chosen = np.empty((0, 2))
	for point, size in zip(candidates, field.at(candidates)):
		clear = distance(point[None], segments[:, 0], segments[:, 1])[0].min() > 1.5 * size
		if clear and np.linalg.norm(chosen - point, axis=1).min(initial=np.inf) > 3 * size:
			chosen = np.vstack([chosen, point])
	return chosen


# ---- shared ----


def _with_regions(mesh, shapes):
	numbers = np.zeros(len(mesh.triangles), dtype=np.int32)
	for number, (name, shape) in enumerate(shapes.items(), start=1):
		chosen = inside(mesh.centroids, shape)
		if not chosen.any():
			raise ValueError(
				f"region {name!r} between ({shape[:, 0].min():.6g}, {shape[:, 1].min():.6g}) and "
				f"({shape[:, 0].max():.6g}, {shape[:, 1].max():.6g}) m holds no triangle's centroid; "
				"use a smaller size, or pattern=\"unstructured\""
			)
		numbers[chosen] = number
	return Mesh(mesh.nodes, mesh.triangles, numbers, ("", *shapes))


def _named(regions):
	regions = dict(regions or {})
	for name in regions:
		if not isinstance(name, str) or not name:
			raise ValueError(
				f"region name {name!r}: it must be a text that is not empty (\"\" means what is in "
				"no region)"
			)
	return regions


def _positive(value, name):
	if (
		isinstance(value, bool)
		or not isinstance(value, (int, float, np.integer, np.floating))
		or not (value > 0 and math.isfinite(value))
	):
		raise ValueError(f"{name} is {value!r} m; it must be a positive length [m]")


def _check_angle(min_angle):
	largest = math.degrees(_mesh.guaranteedAngle())
	if not 0 <= min_angle <= largest:
		raise ValueError(
			f"polygon: min_angle is {min_angle} degrees; the mesh generator guarantees angles from 0 to "
			f"{largest:.2f} degrees"
		)


def _check_count(count, limit, what):
	if not limit > 0:
		raise ValueError(f"limit is {limit} triangles; it must be positive")
	if count > limit:
		raise ValueError(
			f"{what} would give about {count:.2g} triangles, more than the limit of {limit:.2g}; "
			"use a larger size, or raise limit= (a scene needs about 3 kB a triangle)"
		)
