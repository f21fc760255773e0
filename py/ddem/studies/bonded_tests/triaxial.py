# GPL v2 or later, see LICENSE.
"""Triaxial compression of bonded spheres, between rigid walls or in a flexible jacket."""
from argparse import SUPPRESS

from ... import bonded
from ..commandline import positive
from .kind import BondedTest


class Triaxial(BondedTest):
	"""Walls that push, and walls or a jacket that keep a pressure on the sides."""

	name = "triaxial"
	about = "walls that push, with --pressure on the sides"
	velocity = 0.25
	strain = 1e-2
	own = {"pressure": None, "pressure_ramp": 1e-4, "confinement": "walls"}

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

		group.add_argument(
			"--confinement",
			choices=("walls", "jacket"),
			default=SUPPRESS,
			help=(
				"what keeps the pressure: rigid walls around a prism, or a flexible jacket, also "
				"around a cylinder (default: walls)"
			),
		)

	def check(self, options, refuse):
		if options.pressure is None:
			refuse("argument --pressure: it belongs to --test triaxial, which needs it")
		if options.confinement == "walls" and options.shape != "prism":
			refuse(
				"argument --shape: rigid walls enclose a prism; --confinement jacket takes cylinders, "
				"too"
			)
		if options.shape not in ("prism", "cylinder"):
			refuse(f"argument --shape: a jacket goes around a prism or a cylinder, not a {options.shape}")

	def load(self, options, sample):
		height = float(sample.upper[1] - sample.lower[1])
		platens = bonded.triaxial(
			sample, options.pressure, options.strain, options.strain * height / (2 * options.velocity),
			options.pressure_ramp, 4 * options.velocity, options.wall_stiffness,
			options.confinement
		)
		return platens, platens

	def duration(self, options, platens):
		return super().duration(options, platens) + options.pressure_ramp

	def title(self):
		return "Triaxial compression of bonded spheres"

	def settings(self, options, platens):
		return [("p", f"{options.pressure / 1e6:g} MPa", "pressure on the sides")]

	def notes(self, options, run):
		sides = (
			"a flexible jacket keeps it" if options.confinement == "jacket" else
			"the walls on the sides keep it by servo"
		)
		return [
			f"Triaxial. A pressure of {options.pressure / 1e6:g} MPa on all sides grows over "
			f"{1e6 * options.pressure_ramp:g} µs; then {sides} while the "
			"platens approach. The stress is the whole axial one, strain counts from the start."
		]


TEST = Triaxial()
