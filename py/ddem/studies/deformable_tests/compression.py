# GPL v2 or later, see LICENSE.
"""Uniaxial compression of deformable triangles."""
from .kind import DeformableTest


class Compression(DeformableTest):
	"""Platens that push."""

	name = "compression"
	about = "platens that push"

	def notes(self, options, run):
		if options.ends == "smooth":
			return []
		return [
			(
				"Rough ends. They keep the sample from widening, so its slope is a little above "
				"E/(1 − ν²): by 2 % for a block twice as high as wide and ν = 0.2."
			)
		]


TEST = Compression()
