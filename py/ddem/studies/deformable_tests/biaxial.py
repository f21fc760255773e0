# GPL v2 or later, see LICENSE.
"""Biaxial compression of deformable triangles, in plane strain."""
from argparse import SUPPRESS

from ...triangle_confinement import biaxial
from ..commandline import positive
from .kind import DeformableTest


class Biaxial(DeformableTest):
	"""Platens that push, and a pressure on the sides."""

	name = "biaxial"
	about = "platens that push, with --pressure on the sides; plane strain, the plane sister of a triaxial test"
	strain = 2e-2
	own = {"pressure": None}

	def add_options(self, group):
		group.add_argument(
			"--pressure", type=positive, default=SUPPRESS, metavar="PA",
			help=(
				"on all sides, from the start and while the sample is crushed (default: none; biaxial "
				"needs it)"
			)
		)

	def check(self, options, refuse):
		if options.pressure is None:
			refuse("argument --pressure: it belongs to --test biaxial, which needs it")

	def initial_stress(self, options):
		return -options.pressure, -options.pressure, 0

	def load(self, options, block):
		return biaxial(
			block, options.pressure, options.velocity, options.ramp, self.lateral(options),
			options.drive == "both"
		)

	def title(self):
		return "Biaxial compression of deformable triangles"

	def figures(self, run, load):
		return {
			"deviator_MPa": 1e-6 * (run.strength.ucs - load.pressure) if run.has_strength else None
		}

	def settings(self, options, load):
		return [
			(
				"p",
				f"{options.pressure / 1e6:g} MPa",
				"pressure on the sides, and of the sample at the start",
			)
		]

	def notes(self, options, run):
		return [
			(
				f"Biaxial. The sample is under {options.pressure / 1e6:g} MPa from the start, as if "
				"it had been loaded slowly and elastically, with the stress out of plane that plane "
				"strain asks for. The stress is the whole axial one and begins there, strain counts "
				"from there; the pressure follows the sides."
			)
		]


TEST = Biaxial()
