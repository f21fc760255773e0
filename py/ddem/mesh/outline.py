# GPL v2 or later, see LICENSE.
"""Closed polygons: outlines, holes and regions, and how they fit together without crossing."""
import math
from dataclasses import dataclass

import numpy as np

from .. import _mesh

_SNAP = 1e-9  # corners nearer to each other, or to an edge, than this times the outline's extent are the same


def box(x0, y0, x1, y1):
	"""Corners of the rectangle between (x0, y0) and (x1, y1) [m]."""
	if not (x0 < x1 and y0 < y1):
		raise ValueError(f"box({x0}, {y0}, {x1}, {y1}) m: needs x0 < x1 and y0 < y1")
	return np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], dtype=float)


def disc(x, y, r, n=48):
	"""Corners of the regular polygon with n corners on the circle about (x, y) with radius r [m]."""
	if not (r > 0 and math.isfinite(r)):
		raise ValueError(f"disc: radius is {r} m; it must be positive")
	if n < 3 or int(n) != n:
		raise ValueError(f"disc: {n} corners; it needs a whole number of at least 3")
	angle = 2 * np.pi * np.arange(int(n)) / n
	return np.column_stack([x + r * np.cos(angle), y + r * np.sin(angle)])


def ring(corners, name):
	"""Corners of a polygon as a counter-clockwise (n, 2) array without the repeated last one, checked."""
	try:
		points = np.array(corners, dtype=float)
	except (TypeError, ValueError):
		points = np.empty(0)
	if points.ndim != 2 or points.shape[1] != 2:
		raise ValueError(f"{name}: needs a list of corners (x, y) [m]")
	if not np.isfinite(points).all():
		index = int(np.flatnonzero(~np.isfinite(points).all(axis=1))[0])
		raise ValueError(
			f"{name}: corner {index} is ({points[index, 0]}, {points[index, 1]}) m; coordinates must be "
			"finite numbers"
		)
	if len(points) > 1 and (points[0] == points[-1]).all():
		points = points[:-1]
	if len(points) < 3:
		raise ValueError(f"{name}: {len(points)} different corners; a polygon has at least 3")
	area = signed_area(points)
	if abs(area) <= _SNAP * np.ptp(points, axis=0).max()**2:
		raise ValueError(f"{name}: its area is zero; give its corners in order along the border")
	return points if area > 0 else points[::-1].copy()


def signed_area(points):
	x, y = points.T
	return 0.5 * float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


def inside(points, corners):
	"""Which points lie in a polygon (even-odd rule); points on the border may count either way."""
	x, y = points.T
	result = np.zeros(len(points), dtype=bool)
	for (xa, ya), (xb, yb) in zip(corners, np.roll(corners, -1, axis=0)):
		if ya != yb:
			result ^= ((ya > y) != (yb > y)) & (x < xa + (y - ya) * (xb - xa) / (yb - ya))
	return result


def distance(points, a, b):
	"""Distance [m] of each point from each segment a[j]–b[j], and how far along it (0 to 1) the nearest place is:
	two (points, segments) arrays."""
	edge = b - a
	along = np.clip(((points[:, None] - a) * edge).sum(axis=2) / (edge**2).sum(axis=1), 0, 1)
	return np.linalg.norm(points[:, None] - a - along[:, :, None] * edge, axis=2), along


@dataclass
class Rings:
	"""An outline, its holes and its regions as one planar graph:
	corners shared, edges split where another polygon's corner lies on them."""
	names: list  # of each ring, for messages: "outline", "hole 0", "region 'steel'"
	points: np.ndarray  # (p, 2) [m]
	chains: list  # of each ring, its closed sequence of point indices
	holes: int  # rings 1 … holes are holes, the others after them are regions

	@classmethod
	def assemble(cls, outline, holes, regions):
		"""Raise ValueError, naming the polygon and the place, unless holes and regions fit in the outline
		and no borders cross."""
		names = (
			["outline"]
			+ [f"hole {i}" for i in range(len(holes))]
			+ [f"region {name!r}" for name in regions]
		)
		shapes = [ring(corners, name) for corners, name in zip([outline, *holes, *regions.values()], names)]
		rings = cls(names, *_join(shapes, names), len(holes))
		rings._check_crossings()
		rings._check_places()
		return rings

	def segments(self):
		"""(s, 2) point indices of all edges, each once."""
		return np.unique(np.sort(np.vstack([_edges(chain) for chain in self.chains]), axis=1), axis=0).astype(
			np.int32
		)

	def _check_crossings(self):
		owned = [(i, edge) for i, chain in enumerate(self.chains) for edge in _edges(chain)]
		# an edge that two rings share is no crossing
		_, kept = np.unique([np.sort(edge) for _, edge in owned], axis=0, return_index=True)
		owned = [owned[k] for k in np.sort(kept)]
		crossing = _mesh.firstCrossing(self.points, np.array([edge for _, edge in owned], dtype=np.int32))
		if crossing is None:
			return
		first, second = (self.names[owned[k][0]] for k in crossing[:2])
		at = f"({crossing[2]:.6g}, {crossing[3]:.6g}) m"
		if first == second:
			raise ValueError(f"{first} crosses itself at {at}; give its corners in order along the border")
		raise ValueError(
			f"{first} and {second} cross at {at}; move or cut one of them so that their borders only touch"
		)

	def _check_places(self):
		outline, shapes = self.points[self.chains[0]], [self.points[chain] for chain in self.chains]
		taken = {int(point): self.names[0] for point in self.chains[0]}
		for i in range(1, self.holes + 1):
			for point in self.chains[i]:
				if int(point) in taken:
					raise ValueError(
						f"{self.names[i]} touches {taken[int(point)]} at "
						f"({self.points[point, 0]:.6g}, {self.points[point, 1]:.6g}) m; "
						"make it part of that one, or move it"
					)
			taken.update({int(point): self.names[i] for point in self.chains[i]})
		for i in range(1, len(self.chains)):
			edges = _edges(self.chains[i])
			middles = self.points[edges].mean(axis=1)
			for j in range(0, self.holes + 1):
				if i == j:
					continue
				apart = ~_shared(edges, _edges(self.chains[j]))
				wrong = apart & (inside(middles, shapes[j]) == (j > 0))
				if wrong.any():
					x, y = middles[np.flatnonzero(wrong)[0]]
					raise ValueError(
						f"{self.names[i]} lies "
						f"{'outside of the outline' if j == 0 else 'in ' + self.names[j]} at "
						f"({x:.6g}, {y:.6g}) m; the outline spans ({outline[:, 0].min():.6g}, "
						f"{outline[:, 1].min():.6g}) to ({outline[:, 0].max():.6g}, "
						f"{outline[:, 1].max():.6g}) m"
					)


def _edges(chain):
	return np.column_stack([chain, np.roll(chain, -1)])


def _shared(edges, others):
	known = {tuple(edge) for edge in np.sort(others, axis=1).tolist()}
	return np.array([tuple(edge) in known for edge in np.sort(edges, axis=1).tolist()])


def _join(shapes, names):
	# Common points first (the first polygon's position counts, so the outline's), then edges split where a corner
	# of another ring lies on them.
	from scipy.spatial import cKDTree  # slow to import
	near = _SNAP * np.ptp(shapes[0], axis=0).max()
	corners = np.vstack(shapes)
	first = np.arange(len(corners))
	for a, b in sorted(cKDTree(corners).query_pairs(near)):
		first[b] = first[a]
	kept, index = np.unique(first, return_inverse=True)
	points, chains = corners[kept], np.split(index.reshape(-1), np.cumsum([len(shape) for shape in shapes])[:-1])
	for chain, name in zip(chains, names):
		again = np.setdiff1d(np.arange(len(chain)), np.unique(chain, return_index=True)[1])
		if len(again):
			x, y = points[chain[again[0]]]
			raise ValueError(
				f"{name} touches itself at corner {again[0]}, ({x:.6g}, {y:.6g}) m; each corner must "
				"occur once"
			)
	tree = cKDTree(points)
	return points, [_split(points, tree, chain, name, near) for chain, name in zip(chains, names)]


def _split(points, tree, chain, name, near):
	edges, result = _edges(chain), []
	start, end = points[edges[:, 0]], points[edges[:, 1]]
	around = tree.query_ball_point((start + end) / 2, np.linalg.norm(end - start, axis=1) / 2 + near)
	for (a, b), close in zip(edges.tolist(), around):
		result.append(a)
		others = np.array([index for index in sorted(close) if index not in (a, b)], dtype=int)
		if len(others) == 0:
			continue
		gap, along = distance(points[others], points[[a]], points[[b]])
		touching = gap[:, 0] <= near
		on = others[touching]
		for own in np.intersect1d(on, chain):
			raise ValueError(
				f"{name} touches itself at ({points[own, 0]:.6g}, {points[own, 1]:.6g}) m; its border "
				"must not meet itself"
			)
		result.extend(on[np.argsort(along[touching, 0])])
	return np.array(result, dtype=np.int32)
