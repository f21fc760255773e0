# GPL v2 or later, see LICENSE.
"""The Brazilian test: a disc of bonded spheres that is split across a diameter."""
import math

from .kind import BondedTest


class Brazilian(BondedTest):
	"""Walls that split a disc."""

	name = "brazilian"
	about = "walls that split a disc"
	velocity = 0.0625
	strain = 4e-3
	shape = "disc"

	def check(self, options, refuse):
		if options.shape != "disc" and not options.particles:
			refuse("argument --shape: the Brazilian test splits a disc")

	def load(self, options, sample):
		# the stress is then 2 P/(π D L), the tensile strength of a disc
		diameter, _, length = sample.upper - sample.lower
		platens = self.platens(options, sample, math.pi / 2 * float(diameter * length))
		return platens, platens

	def notes(self, options):
		return [
			"Brazilian. The stress is 2 P/(π D L), which a disc of diameter D and length L has across its "
			"loaded diameter while it is elastic, so the strength is its tensile strength; the modulus "
			"has no meaning as a modulus of the material."
		]


TEST = Brazilian()
