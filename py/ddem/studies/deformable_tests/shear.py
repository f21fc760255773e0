# GPL v2 or later, see LICENSE.
"""Simple shear of deformable triangles."""
from argparse import SUPPRESS

from ...triangle_shear import simple_shear
from ..commandline import positive
from ..uniaxial import CompressionTest
from ..wording import Column, Wording
from .kind import DeformableTest


class Sheared(CompressionTest):
	"""Records simple shear."""

	kind = "shear"
	wording = Wording(
		strength="shear_MPa",
		peak="shear strength",
		rows=(
			("shear_MPa", "shear strength", "MPa", 1, "{:.2f}"),
			("shear_modulus_GPa", "shear modulus", "GPa", 1, "{:.2f}"),
		),
		stress="shear stress",
		strain="shear γ",
		modulus="shear_modulus_GPa",
		modulus_name="the shear modulus",
		where="in shear ",
		digits=3,
		loads="border",
		ends=("top", "bottom"),
		force="shear force",
		curve="Shear stress, of the mean force of top and bottom, over the shear γ.",
		forces="Shear forces at top and bottom. Where they agree the sample is in equilibrium.",
		definition=(
			"Stress: (<i>T</i><sub>top</sub> + <i>T</i><sub>bottom</sub>)/(2<i>A</i>), <i>A</i> the area "
			"of top and bottom; strain: way of the top against the bottom over the height, γ. The modulus "
			"is the slope between 20 % and 60 % of the strength."
		),
		also=(
			Column("normal_stress", "Pa", "normal stress [MPa]", 1e-6),
			Column("strain", "-", "shear γ [%]", 100),
		),
		also_text="Normal stress on top and bottom, which are kept apart as they are, over the shear.",
		face="top",
	)


class SimpleShear(DeformableTest):
	"""A border that moves along x in proportion to its height."""

	name = "shear"
	about = "simple shear at constant volume: the border moves along x, in proportion to its height"
	velocity = 0.5
	strain = 1e-2
	size = (0.10, 0.10, 0.02)
	own = {"normal_stress": None}
	ends = None
	two_platens = False
	record = Sheared
	modulus = "G"

	def add_options(self, group):
		group.add_argument(
			"--normal-stress", type=positive, default=SUPPRESS, metavar="PA",
			help="of the sample at the start of a shear test, on all sides (default: none)"
		)

	def initial_stress(self, options):
		return (-options.normal_stress, -options.normal_stress, 0) if options.normal_stress else None

	def load(self, options, block):
		return simple_shear(block, options.velocity, options.ramp)

	def motion(self, options):
		return "of the top"

	def elastic_modulus(self, load, young, poisson):
		return young / (2 * (1 + poisson))

	def title(self):
		return "Simple shear of deformable triangles"

	def settings(self, options, load):
		if not options.normal_stress:
			return []
		return [("σ_n", f"{options.normal_stress / 1e6:g} MPa", "normal stress at the start")]

	def notes(self, options, run):
		return [
			(
				"Simple shear. All nodes of the border are driven, so that the sample shears "
				"uniformly until it fails, and cannot dilate: where its law does, the normal stress "
				"grows. A direct shear box, with halves and a constant normal stress, is there for "
				"bonded spheres."
			)
		]


TEST = SimpleShear()
