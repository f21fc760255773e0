# GPL v2 or later, see LICENSE.
"""One-dimensional compression of a prism of bonded spheres."""
from ... import bonded
from .kind import BondedTest


class Oedometer(BondedTest):
	"""Walls that push, and walls on the sides that stand still."""

	name = "oedometer"
	about = "walls that push, with sides that do not move"
	velocity = 0.25
	prism_only = True

	def load(self, options, sample):
		platens = self.platens(options, sample)
		return platens, [platens, bonded.confine(sample, stiffness=options.wall_stiffness)]

	def title(self):
		return "Oedometer test of bonded spheres"

	def notes(self, options, run):
		return [
			"Oedometer. The walls on the sides stand still; the modulus is that of one-dimensional "
			"compression."
		]


TEST = Oedometer()
