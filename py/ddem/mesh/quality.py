# GPL v2 or later, see LICENSE.
"""Quality figures of a mesh."""
from dataclasses import dataclass, field

import numpy as np


@dataclass(frozen=True)
class Quality:
	"""What a mesh is like; made by :meth:`Mesh.quality`. Triangles are given by index."""
	nodes: int
	triangles: int
	area: float  # total [m²]
	smallest_angle: float  # [degree]
	smallest_angle_triangle: int
	largest_angle: float  # [degree]
	shortest_edge: float  # [m]
	mean_edge: float  # [m], each edge counted once
	longest_edge: float  # [m]
	smallest_area: float  # [m²]
	largest_area: float  # [m²]
	largest_aspect: float  # longest edge over smallest height, 1 for an equilateral triangle (scaled by √3/2)
	largest_aspect_triangle: int
	smallest_height: float  # [m]
	ruling_triangle: int  # the one with the smallest height: it rules the time step where the material is the same
	regions: dict  # name -> (number of triangles, area [m²])
	_places: dict = field(repr=False, default_factory=dict)

	@classmethod
	def of(cls, mesh):
		aspect = np.sqrt(0.75) * mesh.edge_lengths.max(axis=1) / mesh.heights
		edges = np.linalg.norm(np.diff(mesh.nodes[mesh.edges], axis=1)[:, 0], axis=1)
		sharpest, widest, ruling = (
			_first_smallest(mesh.angles.min(axis=1)),
			_first_smallest(1 / aspect),
			_first_smallest(mesh.heights),
		)
		return cls(
			nodes=len(mesh.nodes),
			triangles=len(mesh.triangles),
			area=float(mesh.areas.sum()),
			smallest_angle=float(mesh.angles[sharpest].min()),
			smallest_angle_triangle=sharpest,
			largest_angle=float(mesh.angles.max()),
			shortest_edge=float(edges.min()),
			mean_edge=float(edges.mean()),
			longest_edge=float(edges.max()),
			smallest_area=float(mesh.areas.min()),
			largest_area=float(mesh.areas.max()),
			largest_aspect=float(aspect[widest]),
			largest_aspect_triangle=widest,
			smallest_height=float(mesh.heights[ruling]),
			ruling_triangle=ruling,
			regions={
				name: (
					int(np.count_nonzero(mesh.regions == i)),
					float(mesh.areas[mesh.regions == i].sum()),
				)
				for i, name in enumerate(mesh.region_names)
			},
			_places={t: mesh.centroids[t] for t in (sharpest, widest, ruling)},
		)

	def __str__(self):

		def at(triangle):
			x, y = self._places[triangle]
			return f"triangle {triangle} at ({x:.4g}, {y:.4g}) m"

		rows = [
			("size", f"{self.nodes} nodes, {self.triangles} triangles, {self.area:.6g} m²"),
			(
				"angles",
				(
					f"{self.smallest_angle:.1f}° … {self.largest_angle:.1f}°, smallest in "
					f"{at(self.smallest_angle_triangle)}"
				),
			),
			("edges", f"{self.shortest_edge:.4g} … {self.longest_edge:.4g} m, mean {self.mean_edge:.4g} m"),
			("areas", f"{self.smallest_area:.4g} … {self.largest_area:.4g} m²"),
			(
				"aspect",
				f"up to {self.largest_aspect:.2f} (equilateral: 1), {at(self.largest_aspect_triangle)}",
			),
			("ruling", f"smallest height {self.smallest_height:.4g} m, {at(self.ruling_triangle)}"),
		]
		for name, (count, area) in self.regions.items():
			if count:
				rows.append(
					(f"region {name!r}" if name else "default", f"{count} triangles, {area:.6g} m²")
				)
		width = max(len(head) for head, _ in rows)
		return "\n".join(f"{head:<{width}}  {text}" for head, text in rows)


def _first_smallest(values):
	# In a regular mesh many triangles are alike; round-off must not choose among them.
	return int(np.flatnonzero(values <= values.min() * (1 + 1e-9))[0])
