# GPL v2 or later, see LICENSE.
"""The mesh itself: nodes, triangles, regions, and what follows from them."""
import math
import numbers
from dataclasses import InitVar, dataclass
from functools import cached_property

import numpy as np

from .. import _mesh
from . import checks, sides
from .outline import inside, ring
from .quality import Quality


@dataclass(frozen=True, eq=False, repr=False)
class Mesh:
	"""Plane triangle mesh; its arrays cannot be changed in place.

	:param nodes: (n, 2) positions [m]
	:param triangles: (m, 3) node indices, counter-clockwise
	:param regions: (m,) index of each triangle's region in region_names; all in the default region when left out
	:param region_names: names; the first is "", the default region, even when no triangle is in it
	:param orient: turn clockwise triangles over

	Making one checks types, shapes and ranges; :meth:`validate` checks the geometry.
	What this package makes or reads is valid.
	"""
	nodes: np.ndarray
	triangles: np.ndarray
	regions: np.ndarray = None
	region_names: tuple = ("",)
	orient: InitVar[bool] = False

	def __post_init__(self, orient):
		nodes, triangles, regions, names = checks.arrays(
			self.nodes, self.triangles, self.regions, self.region_names
		)
		if orient:
			triangles = np.where(
				(_doubled_areas(nodes, triangles) < 0)[:, None], triangles[:, ::-1], triangles
			)
		for name, value in (("nodes", nodes), ("triangles", triangles), ("regions", regions)):
			value.setflags(write=False)
			object.__setattr__(self, name, value)
		object.__setattr__(self, "region_names", names)

	def __repr__(self):
		counts = "".join(
			f", {name} {np.count_nonzero(self.regions == i)}"
			for i, name in enumerate(self.region_names)
			if name
		)
		return f"Mesh({len(self.nodes)} nodes, {len(self.triangles)} triangles{counts})"

	# ---- geometry, one value a triangle ----

	@cached_property
	def areas(self):
		"""(m,) areas [m²], negative where clockwise."""
		return 0.5 * _doubled_areas(self.nodes, self.triangles)

	@cached_property
	def centroids(self):
		"""(m, 2) centroids [m]."""
		return self.nodes[self.triangles].mean(axis=1)

	@cached_property
	def edge_lengths(self):
		"""(m, 3) lengths [m] of the edges from corner k to corner k+1."""
		corners = self.nodes[self.triangles]
		return np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)

	@cached_property
	def sizes(self):
		"""(m,) mean edge length [m] of each triangle."""
		return self.edge_lengths.mean(axis=1)

	@cached_property
	def heights(self):
		"""(m,) smallest height [m] of each triangle; the smallest of all rules the time step where the
		material is the same."""
		return 2 * np.abs(self.areas) / self.edge_lengths.max(axis=1)

	@cached_property
	def angles(self):
		"""(m, 3) angles [degree] at the corners."""
		a = np.roll(self.edge_lengths, -1, axis=1)  # the edge opposite to corner k
		b, c = np.roll(a, -1, axis=1), np.roll(a, -2, axis=1)
		return np.degrees(np.arctan2(4 * np.abs(self.areas)[:, None], b**2 + c**2 - a**2))

	def quality(self):
		"""Smallest angle, shortest edge, ruling triangle and the like; prints as a small table."""
		return Quality.of(self)

	# ---- neighbourhood ----

	@cached_property
	def _edge_table(self):
		# Edge 3 t + k goes from corner k of triangle t to corner k+1. unique: its undirected edge, count:
		# triangles at that one.
		directed = np.stack([self.triangles, np.roll(self.triangles, -1, axis=1)], axis=2).reshape(-1, 2)
		edges, unique, count = np.unique(
			np.sort(directed, axis=1), axis=0, return_inverse=True, return_counts=True
		)
		return directed, edges, unique.reshape(-1), count

	@property
	def edges(self):
		"""(e, 2) node indices of all edges, each once, the smaller index first."""
		return self._edge_table[1]

	@cached_property
	def neighbours(self):
		"""(m, 3) the triangle across the edge from corner k to corner k+1, or -1 at the border."""
		_, _, unique, count = self._edge_table
		result = np.full(unique.size, -1, dtype=np.int32)
		order = np.argsort(unique, kind="stable")
		first = order[np.flatnonzero(np.diff(unique[order]) == 0)]
		second = order[np.flatnonzero(np.diff(unique[order]) == 0) + 1]
		result[first], result[second] = second // 3, first // 3
		return result.reshape(-1, 3)

	def boundary_edges(self):
		"""(b, 2) node indices of the border's edges, directed so that the mesh lies on their left."""
		directed, _, unique, count = self._edge_table
		return directed[count[unique] == 1]

	def boundary(self, where=None):
		"""Sorted indices of nodes on the border.

		:param where: a side ("top", "bottom", "left", "right"; it may be uneven or slant by 0.3 of an edge), or
			a function of the arrays x, y [m] of border nodes that says which of them to take; all when left
			out
		:raises ValueError: unknown side, no such side because the border is round, slanted or rough there, a
			function that gives something else or finds no node
		"""
		nodes = np.unique(self.boundary_edges())
		if where is None:
			return nodes
		if not callable(where):
			if not isinstance(where, str) or where not in sides.SIDES:
				raise ValueError(
					f"boundary(): unknown side {where!r}; use one of {', '.join(sides.SIDES)}, or "
					"a function of x and y"
				)
			return sides.side(self, where)
		x, y = self.nodes[nodes].T
		chosen = np.asarray(where(x, y))
		if chosen.shape != x.shape or chosen.dtype != bool:
			raise ValueError(
				f"boundary(): the function must turn the arrays x, y ({len(x)} values) into as many "
				"true/false values, it "
				f"gave {chosen.dtype} of shape {chosen.shape}; combine conditions with & and |, not "
				"with and/or"
			)
		if not chosen.any():
			raise ValueError(
				f"boundary(): the function is true at none of the {len(x)} nodes of the border, which "
				f"spans x from {x.min():.6g} to {x.max():.6g} m and y from "
				f"{y.min():.6g} to {y.max():.6g} m; compare with a tolerance, such as np.abs(y - 0.1) "
				"< 1e-6"
			)
		return nodes[chosen]

	def border_between(self, nodes):
		"""(b, 2) those of :meth:`boundary_edges` both of whose ends are among the nodes with these indices."""
		edges = self.boundary_edges()
		return edges[np.isin(edges, nodes).all(axis=1)]

	# ---- regions ----

	def region(self, name):
		"""Indices of the triangles in a region."""
		if name not in self.region_names:
			raise ValueError(
				f"no region {name!r} in this mesh; it has {', '.join(map(repr, self.region_names))}"
			)
		return np.flatnonzero(self.regions == self.region_names.index(name))

	def select(self, polygon):
		"""Indices of the triangles whose centroid lies in a polygon, given by its corners [m]."""
		return np.flatnonzero(inside(self.centroids, ring(polygon, "select(): polygon")))

	# ---- other meshes ----

	def validate(self):
		"""Return this mesh, or raise ValueError at the first thing wrong with it,
		with its triangle or node and place."""
		checks.geometry(self)
		return self

	def flipped(self):
		"""The same mesh with clockwise triangles turned over."""
		return Mesh(self.nodes, self.triangles, self.regions, self.region_names, orient=True)

	def scaled(self, factor):
		"""The same mesh with all lengths times a factor: ``mesh.scaled(1e-3)`` for one that was drawn in
		millimetres.

		:raises ValueError: the factor is not a positive, finite number
		"""
		if not isinstance(factor, numbers.Real) or not 0 < factor < math.inf:
			raise ValueError(f"scaled(): factor = {factor!r} must be a positive, finite number [-]")
		return Mesh(self.nodes * factor, self.triangles, self.regions, self.region_names)

	def reordered(self):
		"""The same mesh renumbered for locality in memory.

		Triangles are grouped by region, in each along a Hilbert curve; nodes follow in the order of first use.
		The numbering before does not matter.
		"""
		plain = np.lexsort(self.centroids.T)  # the curve's order within its smallest cells is that of its input
		curve = plain[
			np.frombuffer(_mesh.hilbertOrder(np.ascontiguousarray(self.centroids[plain])), dtype=np.int32)
		]
		order = curve[np.argsort(self.regions[curve], kind="stable")]
		triangles = self.triangles[order]
		used, first = np.unique(triangles, return_index=True)
		old = used[np.argsort(first)]
		new = np.full(len(self.nodes), -1, dtype=np.int32)
		new[old] = np.arange(len(old))
		return Mesh(self.nodes[old], new[triangles], self.regions[order], self.region_names)

	def write(self, path):
		"""Write a file; its ending says the format (.msh, .vtu, .vtk …).
		Read it again with :func:`yade.ddem.mesh.read`."""
		from .files import write
		write(self, path)


def _doubled_areas(nodes, triangles):
	a, b, c = (nodes[triangles[:, k]] for k in range(3))
	return (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
