# GPL v2 or later, see LICENSE.
"""The Brazilian test: a disc of bonded spheres that is split across a diameter."""
from argparse import SUPPRESS

from ... import bonded
from ...shapes import Cylinder
from ..wording import Wording
from .kind import BondedTest, Fracture

_ENDS = ("curved", "flat", "flat-ends")


class Split(Fracture):
	"""Records the splitting of a disc."""

	kind = "brazilian"
	wording = Wording(
		strength="splitting_MPa",
		peak="splitting strength",
		rows=(("splitting_MPa", "splitting tensile strength", "MPa", 1, "{:.2f}"),),
		stress="stress 2P/(πDL)",
		strain="shortening of the diameter",
		modulus=None,
		where="across the loaded diameter ",
		digits=3,
		loads="jaws",
		ends=("upper jaw", "lower jaw"),
		force="force on jaw",
		curve=(
			"Stress across the loaded diameter of an elastic disc, of the mean force of both jaws, over "
			"the approach of the jaws in per cent of the diameter."
		),
		forces="Forces on the two jaws. Where they agree the disc is in equilibrium.",
		definition=(
			"Stress: (<i>P</i><sub>upper</sub> + <i>P</i><sub>lower</sub>)/(π<i>D</i><i>L</i>), <i>D</i> "
			"the diameter, <i>L</i> the length of the disc; strain: approach of the jaws over <i>D</i>; "
			"compression positive."
		),
		face="π D L/2, so that a force over it is 2P/(πDL)",
	)


class Brazilian(BondedTest):
	"""Jaws that split a disc."""

	name = "brazilian"
	about = "--jaws that split a disc"
	velocity = 0.0625
	strain = 4e-3
	shape = "disc"
	own = {"jaws": "flat-ends"}
	record = Split

	def add_options(self, group):
		group.add_argument(
			"--jaws",
			choices=_ENDS,
			default=SUPPRESS,
			help=(
				"of a Brazilian test: curved, with 1.5 times the radius of the disc (ISRM 1978); "
				"flat; or flat on a disc with flat ends 30 degrees wide (default: flat-ends)"
			),
		)

	def check(self, options, refuse):
		if options.shape != "disc" and not options.particles:
			refuse("argument --shape: the Brazilian test splits a disc")
		if options.bonded_walls:
			refuse("argument --bonded-walls: jaws of a Brazilian test only push")

	def disc(self, options):
		if options.jaws == "flat-ends":
			return super().disc(options)
		diameter, _, length = options.size
		return Cylinder((0, 0, -length / 2), (0, 0, length / 2), diameter / 2)

	def load(self, options, sample):
		jaws = bonded.brazilian(
			sample, options.velocity, "curved" if options.jaws == "curved" else "flat", options.ramp,
			options.wall_stiffness, options.drive == "both"
		)
		return jaws, jaws

	def title(self):
		return "Brazilian test of bonded spheres"

	def settings(self, options, platens):
		meaning = {
			"curved": (
				f"of {1.5 * 0.5e3 * platens.height:.4g} mm radius, 1.5 times that of the disc "
				"(ISRM 1978)"
			),
			"flat": "on a round disc",
			"flat-ends": "on a disc with flat ends 30° wide (Wang et al. 2004)",
		}
		return [("jaws", options.jaws.replace("-", " "), meaning[options.jaws])]

	def notes(self, options, run):
		said = [
			(
				"Brazilian. The stress is 2 P/(π D L), which a disc of diameter D and length L has "
				"across its loaded diameter while it is elastic, so the strength is its tensile "
				"strength where the disc splits from its middle. Where bonds break beneath the jaws "
				"first, it is not: look at the cracks."
			)
		]
		if options.jaws == "flat-ends":
			said.append(
				"The flat ends bring the load in over 30°; the tensile strength is then 0.96 of this "
				"figure (Wang et al. 2004), which is not taken into account here."
			)
		return said


TEST = Brazilian()
