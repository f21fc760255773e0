# GPL v2 or later, see LICENSE.
"""One-dimensional compression of deformable triangles."""
from ...triangle_confinement import constrained_modulus, oedometer
from .kind import DeformableTest


class Oedometer(DeformableTest):
	"""Smooth platens that push, and sides that do not move."""

	name = "oedometer"
	about = "smooth platens that push, with sides that do not move"
	strain = 5e-3
	ends = None
	modulus = "E(1 − ν)/((1 + ν)(1 − 2ν))"

	def load(self, options, block):
		return oedometer(block, options.velocity, options.ramp, options.drive == "both")

	def elastic_modulus(self, load, young, poisson):
		return constrained_modulus(young, poisson)

	def title(self):
		return "Oedometer test of deformable triangles"


TEST = Oedometer()
