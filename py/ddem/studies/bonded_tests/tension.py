# GPL v2 or later, see LICENSE.
"""Uniaxial tension of bonded spheres."""
from ..uniaxial import TensionTest
from .kind import BondedTest


class Tension(BondedTest):
	"""Walls that hold the ends and pull."""

	name = "tension"
	about = "walls that hold the ends and pull"
	# The stress of the first wave, ρcv, has to stay well below the strength, which is small in tension.
	velocity = 0.125 / 4
	strain = 1e-3
	bonded_walls = True
	sense = -1
	record = TensionTest

	def check(self, options, refuse):
		if not options.bonded_walls:
			refuse(
				"argument --no-bonded-walls: walls that are not bonded only push, so there is "
				"no tension"
			)


TEST = Tension()
