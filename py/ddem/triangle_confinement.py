# GPL v2 or later, see LICENSE.
"""Blocks of deformable triangles that are compressed with their sides held or under pressure: oedometric and biaxial
tests, in plane strain::

	press = ddem.oedometer(block, velocity=0.5, ramp=1e-4)
	O.engines = [ForceResetter(), *press.engines, DeformableEngine()]

	block = ddem.append(mesh, "concrete", initial_stress=(-5e6, -5e6, 0))
	press = ddem.biaxial(block, 5e6, velocity=0.5, ramp=1e-4)

An elastic block has the slope :func:`constrained_modulus` in the first, :func:`plane_strain_modulus` in the second.
"""
import numpy as np

from yade import O

from .edge_loads import pressure as pressure_on
from .loading import platens

_SIDES = ("left", "right")


def oedometer(block, velocity, ramp=0.0, both=False):
	"""Smooth platens on the ends of a block, and sides that do not move across.

	:param block: :class:`Block`, a rectangle
	:param velocity, ramp, both: as for :func:`loading.platens`
	:returns: :class:`loading.Platens`
	:raises ValueError: as :func:`loading.platens`; a side that is none. Nothing is held then.
	"""
	sides = [block.boundary(side) for side in _SIDES]
	made = platens(block, velocity, ramp, "free", both)
	for ids in sides:
		block.hold(ids, "x")
	return made


def biaxial(block, pressure, velocity, ramp=0.0, lateral="free", both=False):
	"""Platens on the ends of a block whose sides bear a pressure that stays.

	The block is under that pressure before anything moves: it has been appended with ``initial_stress=(-p, -p,
	0)``, so that nothing has to be loaded slowly first. Out of plane it has the stress that plane strain asks for,
	−2νp. Stress is the whole one and begins at p, strain counts from there.

	:param block: :class:`Block`, a rectangle
	:param pressure: p, on both sides [Pa]
	:param velocity, ramp, lateral, both: as for :func:`loading.platens`
	:returns: :class:`loading.Platens` with the pressure among its ``engines``, and as ``pressure`` [Pa]
	:raises ValueError: as :func:`loading.platens`; a pressure that is not positive, or another one than that of the
		block. Nothing is held then.
	"""
	if not 0 < pressure < np.inf:
		raise ValueError(f"biaxial: pressure = {pressure} Pa must be positive and finite")
	for i in block.triangle_ids:
		stress = O.bodies[i].shape.initialStress
		if not stress or any(
			abs(part[0, 0] + pressure) + abs(part[1, 1] + pressure) + abs(part[0, 1]) > 1e-6 * pressure
			for part in stress
		):
			raise ValueError(
				f"biaxial: triangle #{i} is not under the pressure of {pressure:g} Pa at the start; "
				f"append the block with initial_stress=({-pressure:g}, {-pressure:g}, 0)"
			)
	loads = [pressure_on(block, side, pressure) for side in _SIDES]
	made = platens(block, velocity, ramp, lateral, both)
	made.engines, made.pressure = [*made.engines, *loads], pressure
	return made


def constrained_modulus(young, poisson):
	"""Slope of stress over strain where the sides do not move, E(1−ν)/((1+ν)(1−2ν)) [Pa]."""
	return young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson))


def plane_strain_modulus(young, poisson):
	"""Slope of stress over strain where the stress on the sides stays, in plane strain, E/(1−ν²) [Pa]."""
	return young / (1 - poisson**2)
