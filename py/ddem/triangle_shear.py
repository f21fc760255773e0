# GPL v2 or later, see LICENSE.
"""Simple shear of a block of deformable triangles::

	shear = ddem.simple_shear(block, velocity=0.5, ramp=1e-4)
	O.engines = [ForceResetter(), *shear.engines, DeformableEngine()]

The block shears along x. SI units; normal stresses on the top are positive in compression.
"""
import math

import numpy as np

from yade import RampedTranslationEngine


def simple_shear(block, velocity, ramp=0.0):
	"""Move all nodes of the border along x, in proportion to their height above the bottom, and hold them along y.

	So the sample shears at constant volume, and uniformly until it fails: the border does not choose where.
	A normal stress is there where the block has been appended with an initial_stress; it changes as a sample that
	cannot dilate makes it.

	:param block: :class:`Block` with a flat bottom and top
	:param velocity: of the top [m/s]
	:param ramp: time over which it grows linearly from zero [s]
	:returns: :class:`SimpleShear`; put its ``engines`` into O.engines before the DeformableEngine.
	:raises ValueError: numbers out of range, a block without flat top and bottom. Nothing is held then.
	"""
	if not (math.isfinite(velocity) and velocity != 0):
		raise ValueError(f"simple_shear: velocity = {velocity} m/s must be a number other than zero")
	if not 0 <= ramp < math.inf:
		raise ValueError(f"simple_shear: ramp = {ramp} s must be finite and not negative")
	return SimpleShear(block, velocity, ramp)


class SimpleShear:
	"""A block in simple shear: what drives it and what it feels; see :func:`simple_shear`.
	It serves wherever platens do."""

	def __init__(self, block, velocity, ramp):
		mesh, self.sample = block.mesh, block
		self._top, self._bottom = mesh.boundary("top"), mesh.boundary("bottom")
		heights = mesh.nodes[:, 1] - mesh.nodes[self._bottom, 1].mean()
		self.height = float(heights[self._top].mean())  #: of the block [m]
		self.length = float(np.ptp(mesh.nodes[self._top, 0]))  #: of its top [m]
		self.area = self.length * block.thickness  #: of the plane of shear [m²]
		border = mesh.boundary()
		block.hold(block.node_ids[border], "xy")
		# nodes of one height have one engine
		level = np.round(heights[border] / self.height, 9)
		self.engines = [
			RampedTranslationEngine(
				ids=[int(i) for i in block.node_ids[border[level == part]]], translationAxis=(1, 0, 0),
				velocity=velocity * part, rampTime=ramp
			) for part in np.unique(level) if part != 0
		]

	@property
	def force_top(self):
		"""Shear force at the top, against its motion [N]."""
		return float(-self.sample.node_forces[self._top, 0].sum())

	@property
	def force_bottom(self):
		"""Shear force at the bottom [N]."""
		return float(self.sample.node_forces[self._bottom, 0].sum())

	@property
	def stress(self):
		"""Shear stress, of the mean of both forces [Pa]."""
		return 0.5 * (self.force_top + self.force_bottom) / self.area

	@property
	def strain(self):
		"""Way of the top against the bottom over the height, γ [-]."""
		moved = self.sample.displacements[:, 0]
		return float(moved[self._top].mean() - moved[self._bottom].mean()) / self.height

	@property
	def normal_stress(self):
		"""Of top and bottom, compression positive [Pa]."""
		forces = self.sample.node_forces[:, 1]
		return float(forces[self._top].sum() - forces[self._bottom].sum()) / (2 * self.area)
