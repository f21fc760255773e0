# GPL v2 or later, see LICENSE.
"""What a sample looks like at an instant, as plain arrays that outlive the scene; pictures are drawn from these."""
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class TriangleSnapshot:
	"""Deformable triangles at an instant."""
	time: float  # [s]
	nodes: np.ndarray  # positions (n, 2) [m]
	triangles: np.ndarray  # rows of nodes (m, 3)
	damage: np.ndarray  # of the sub-elements (m, 3) [-]
	rotation: np.ndarray  # of the triangles (m,) [rad]
	border: np.ndarray  # rows of nodes (b, 2) along the border of regions other than the default one

	@classmethod
	def of(cls, block, time):
		mesh = block.mesh
		inner = (
			(mesh.neighbours >= 0)
			& (mesh.regions[mesh.neighbours] != mesh.regions[:, None])
			& (mesh.regions[:, None] > 0)
		)
		edges = np.stack([mesh.triangles, np.roll(mesh.triangles, -1, axis=1)], axis=2)
		return cls(
			time, np.array(block.positions), mesh.triangles, np.array(block.sub_element_damage),
			np.array(block.rotation), edges[inner]
		)


@dataclass(frozen=True)
class SphereSnapshot:
	"""Bonded spheres at an instant."""
	time: float  # [s]
	centres: np.ndarray  # (n, 3) [m]
	radii: np.ndarray  # (n,) [m]
	damage: np.ndarray  # broken share of the bonds of each sphere (n,) [-]
	rotation: np.ndarray  # about z (n,) [rad]
	# traces in the plane of the picture of the broken bonds' sections, which moved with their spheres (k, 2, 2) [m]
	cracks: np.ndarray
	tension: np.ndarray  # whether the bond failed in tension (k,)
	loads: tuple = ()  # lines (n, 2) that show in pictures what loads it [m]

	@classmethod
	def of(cls, sample, time, loads=()):
		return SphereMotion.of(sample, time, loads).snapshot(sample.bond_records)


@dataclass(frozen=True)
class SphereMotion:
	"""Where bonded spheres are at an instant: what of a :class:`SphereSnapshot` must be kept then, as the records
	of bonds, in the order in which they broke, say at any later time which were the first."""
	time: float  # [s]
	ids: np.ndarray  # of the bodies (n,)
	centres: np.ndarray  # (n, 3) [m]
	radii: np.ndarray  # (n,) [m]
	rotation: np.ndarray  # about z (n,) [rad]
	broken: int  # number of bonds
	loads: tuple = ()  # see SphereSnapshot

	@classmethod
	def of(cls, sample, time, loads=()):
		return cls(
			time, sample.ids, sample.positions, sample.radii, sample.rotations[:, 2], sample.broken_count,
			tuple(loads)
		)

	def snapshot(self, bonds):
		"""The :class:`SphereSnapshot`, by records of bonds (:attr:`bonded.BondedSample.bond_records`) of this
		instant or of a later one."""
		from ..bonded import HOLDS, TENSION, broken_share
		gone = np.zeros(len(bonds), bool)
		gone[np.flatnonzero(bonds["mode"] != HOLDS)[:self.broken]] = True
		broken = bonds[gone]
		row = np.full(max(int(bonds[name].max(initial=-1)) for name in ("id1", "id2")) + 1, -1)
		own = np.asarray(self.ids)
		row[own[own < len(row)]] = np.flatnonzero(own < len(row))
		rows = np.column_stack([row[broken["id1"]], row[broken["id2"]]])
		there = (rows >= 0).all(axis=1)  # not of a sphere that was erased
		broken, rows = broken[there], rows[there]
		first, second = self.centres[rows].transpose(1, 0, 2)
		return SphereSnapshot(
			self.time, self.centres, self.radii, broken_share(bonds, gone, own), self.rotation,
			crack_traces(first, second, broken["radius"]), broken["mode"] == TENSION, self.loads
		)


def crack_traces(first, second, radius):
	"""Lines (k, 2, 2) in which the sections of bonds between the points *first* and *second* (k, 3) meet the plane
	z = const through their middles: cracks, as seen in a section of the sample.

	A section that lies in that plane has no trace; its line has no length.
	"""
	axis = (second - first)[:, :2]
	length = np.linalg.norm(axis, axis=1)
	along = np.column_stack([-axis[:, 1], axis[:, 0]]) / np.where(length > 0, length, 1)[:, None]
	half = np.where(length > 0, radius, 0)[:, None] * along
	middle = 0.5 * (first + second)[:, :2]
	return np.stack([middle - half, middle + half], axis=1)
