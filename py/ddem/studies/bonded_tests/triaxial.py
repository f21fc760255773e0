# GPL v2 or later, see LICENSE.
"""Triaxial compression of a prism of bonded spheres, with rigid walls."""
from argparse import SUPPRESS

from ... import bonded
from ..commandline import positive
from .kind import BondedTest


class Triaxial(BondedTest):
	"""Walls that push, and walls that keep a pressure on the sides."""

	name = "triaxial"
	about = "walls that push, with --pressure on the sides"
	velocity = 0.25
	strain = 1e-2
	prism_only = True
	own = {"pressure": None, "pressure_ramp": 1e-4}

	def add_options(self, group):
		group.add_argument(
			"--pressure", type=positive, default=SUPPRESS, metavar="PA",
			help=(
				"on all sides, before and while the sample is crushed (default: none; a triaxial test "
				"needs it)"
			)
		)
		group.add_argument(
			"--pressure-ramp", type=positive, default=SUPPRESS, metavar="S",
			help="time over which it grows in a triaxial test (default: 0.0001)"
		)

	def check(self, options, refuse):
		if options.pressure is None:
			refuse("argument --pressure: it belongs to --test triaxial, which needs it")

	def load(self, options, sample):
		height = float(sample.upper[1] - sample.lower[1])
		platens = bonded.triaxial(
			sample, options.pressure, options.strain, options.strain * height / (2 * options.velocity),
			options.pressure_ramp, 4 * options.velocity, options.wall_stiffness
		)
		return platens, platens

	def duration(self, options, platens):
		return super().duration(options, platens) + options.pressure_ramp

	def title(self):
		return "Triaxial compression of bonded spheres"

	def settings(self, options, platens):
		return [("p", f"{options.pressure / 1e6:g} MPa", "pressure on the sides")]

	def notes(self, options, run):
		return [
			f"Triaxial. A pressure of {options.pressure / 1e6:g} MPa on all sides grows over "
			f"{1e6 * options.pressure_ramp:g} µs; then the walls on the sides keep it by servo while the "
			"platens approach. The stress is the whole axial one, strain counts from the start."
		]


TEST = Triaxial()
