# GPL v2 or later, see LICENSE.
"""Uniaxial tension of deformable triangles."""
from ..uniaxial import TensionTest
from .kind import DeformableTest


class Tension(DeformableTest):
	"""Platens that hold the ends and pull."""

	name = "tension"
	about = "platens that hold the ends and pull"
	# The stress of the first wave, ρcv, has to stay well below the strength, which is small in tension.
	velocity = 0.05
	strain = 1e-3
	ends = "smooth"
	sense = -1
	record = TensionTest


TEST = Tension()
