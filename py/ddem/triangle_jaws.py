# GPL v2 or later, see LICENSE.
"""The Brazilian test: a disc of deformable triangles that is split across a diameter::

	disc = ddem.append(ddem.brazilian_disc(0.05, size=0.001, angle=30), "concrete")
	jaws = ddem.brazilian(disc, diameter=0.05, angle=30, velocity=0.1, ramp=1e-4)
	O.engines = [ForceResetter(), *jaws.engines, DeformableEngine()]

Jaws press along y. An elastic disc has the stresses
:func:`disc_stress.pressed` at its centre, and those of :func:`disc_stress.hondros` under pressure.
SI units, angles in degrees.
"""
import math

import numpy as np

from . import mesh as meshes
from .loading import Platens

_PATCH = 0.3  # radius of the patch from which the stress at the centre is recovered, over that of the disc


def brazilian(block, diameter, angle, velocity, ramp=0.0, both=True):
	"""Jaws that press a disc at its top and its bottom, each over the nodes within an arc about the load.

	Curved jaws and flat ends differ by the mesh alone, see :func:`brazilian_disc`: the nodes of an arc, or of
	a flat, move down as one and are free across, as on smooth jaws;
	the ones on the axis of the load are held there. A curved jaw is no body: its arc neither grows nor opens
	as the disc flattens, unlike that of :func:`bonded_jaws.brazilian`, where a disc meets a jaw of 1.5 times its
	radius.

	:param block: :class:`Block` of a disc
	:param diameter: D [m]
	:param angle: of each arc, 2α [degree]; ISRM's curved jaws touch over about 10 where the disc fails, flat ends
		are 20 to 30 wide
	:param velocity, ramp, both: as for :func:`loading.platens`
	:returns: :class:`Jaws`
	:raises ValueError: numbers out of range; arcs without nodes, or with one. Nothing is held then.
	"""
	if not 0 < diameter < math.inf:
		raise ValueError(f"brazilian: diameter = {diameter} m must be positive and finite")
	if not 0 < angle < 90:
		raise ValueError(f"brazilian: angle = {angle} degrees must lie between 0 and 90")
	if not (math.isfinite(velocity) and velocity > 0):
		raise ValueError(f"brazilian: velocity = {velocity} m/s must be positive: jaws only push")
	if not 0 <= ramp < math.inf:
		raise ValueError(f"brazilian: ramp = {ramp} s must be finite and not negative")
	return Jaws(block, diameter, angle, velocity, ramp, both)


def brazilian_disc(diameter, size, angle, flat=True, seed=None):
	"""Mesh of a disc about the origin for jaws of that angle 2α: with flat ends, or round with a corner of the
	polygon at each end of the arcs. At the jaws triangles are so small that at least four lie side by side.

	:param diameter, size: of the disc, and of its triangles away from the jaws [m]
	:param angle: of each arc or flat, 2α [degree]
	:raises ValueError: numbers out of range
	"""
	if not 0 < size <= 0.25 * diameter:
		raise ValueError(
			f"brazilian_disc: size = {size} m must be positive and not above a quarter of the diameter of "
			f"{diameter} m"
		)
	if not 0 < angle < 90:
		raise ValueError(f"brazilian_disc: angle = {angle} degrees must lie between 0 and 90")
	radius, half = 0.5 * diameter, math.radians(angle) / 2
	fine = min(size, 0.5 * radius * half)
	side = np.linspace(half, math.pi - half, math.ceil(radius * (math.pi - 2 * half) / size) + 1)
	arcs = [side, side + math.pi]
	if not flat:
		jaw = np.linspace(-half, half, 5)[1:-1]
		arcs = [jaw, side, jaw + math.pi, side + math.pi]
	around = np.concatenate(arcs)
	near = lambda x, y: math.hypot(max(0.0, abs(x) - radius * math.sin(half)), radius * math.cos(half) - abs(y))
	return meshes.polygon(
		radius * np.column_stack([np.sin(around), np.cos(around)]),
		size=size if fine == size else lambda x, y: min(size, fine + 0.25 * near(x, y)), seed=seed
	)


class Jaws(Platens):
	"""Jaws on a disc: what they do and what they feel; see :func:`brazilian`. Compression is positive."""

	def __init__(self, block, diameter, angle, velocity, ramp, both):
		nodes = block.mesh.nodes
		centre = 0.5 * (nodes.min(axis=0) + nodes.max(axis=0))
		reach = 0.5 * diameter * math.sin(math.radians(angle) / 2) * (1 + 1e-6)
		near = lambda x, y: np.abs(x - centre[0]) <= reach
		super().__init__(
			block, velocity, ramp, "free", both, lambda x, y: near(x, y) & (y > centre[1]),
			lambda x, y: near(x, y) & (y < centre[1])
		)
		for rows in self._rows.values():
			row = rows[np.argmin(np.abs(nodes[rows, 0] - centre[0]))]
			block.hold(block.node_ids[[row]], "x")
		self.diameter = diameter  #: D [m]
		#: angle 2α of each arc [degree]
		self.angle = angle
		self.height = diameter  # strain is the approach over it
		self.area = self.area_bottom = 0.5 * math.pi * diameter * block.thickness  # stress is then 2P/(πDt)
		self._centre = centre

	@property
	def centre_stress(self):
		"""Stress across and along the load at the centre (2,) [Pa], tension positive."""
		return stress_at(self.sample, self._centre, _PATCH * 0.5 * self.diameter)

	@property
	def splitting_stress(self):
		"""Stress across the load at the centre [Pa], tension positive."""
		return float(self.centre_stress[0])


def stress_at(block, place, reach):
	"""Stress xx, yy at a place of the undeformed mesh (2,) [Pa], of a quadratic field fitted to the triangles
	within *reach* [m] of it, or to the twelve closest."""
	x, y = (block.mesh.centroids - place).T / reach
	rows = np.flatnonzero(np.hypot(x, y) <= 1)
	if len(rows) < 12:
		rows = np.argsort(np.hypot(x, y))[:12]
	x, y = x[rows], y[rows]
	weights = np.linalg.pinv(np.column_stack([np.ones_like(x), x, y, x * x, x * y, y * y]))[0]
	return weights @ block.stress[rows].mean(axis=1)[:, :2]
