# GPL v2 or later, see LICENSE.
"""Uniaxial compression of bonded spheres."""
from .kind import BondedTest


class Compression(BondedTest):
	"""Walls that push."""

	name = "compression"
	about = "walls that push"

	def notes(self, options, run):
		return [
			"Stress is the mean of both walls (eq. 9). The script in the tutorial of ESyS-Particle "
			"divides by A instead of 2A, and so gives stresses, strengths and moduli twice as high."
		]


TEST = Compression()
