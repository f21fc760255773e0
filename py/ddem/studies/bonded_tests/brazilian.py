# GPL v2 or later, see LICENSE.
"""The Brazilian test: a disc of bonded spheres that is split across a diameter."""
import math
from argparse import SUPPRESS

from ... import bonded
from ...disc_stress import hondros, pressed
from ...shapes import Cylinder, flattened_disc
from ..wording import Wording
from .kind import BondedTest, Fracture

_ENDS = ("curved", "flat", "flat-ends")
_ANGLE = 30.0  # 2α of flat ends [degree]


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
	size = (0.010, 0.010, 0.010)
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
		diameter, _, length = options.size
		if options.jaws == "flat-ends":
			return flattened_disc(diameter, length, math.radians(_ANGLE))
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
			"flat-ends": f"{flat_angle(platens.sample):.3g}° wide, of the disc (Wang et al. 2004)",
		}
		return [("jaws", options.jaws.replace("-", " "), meaning[options.jaws])]

	def figures(self, run, platens):
		angle = flat_angle(platens.sample)
		return {"angle_degree": angle, "centre_over_nominal": pressed(angle)[0]} if angle else {}

	def notes(self, options, run):
		said = [
			(
				"Brazilian. The stress is 2 P/(π D L), which a disc of diameter D and length L has "
				"across its loaded diameter while it is elastic, so the strength is its tensile "
				"strength where the disc splits from its middle. Where bonds break beneath the jaws "
				"first, it is not: look at the cracks."
			)
		]
		if options.jaws == "flat-ends" and "angle_degree" in run.extra:
			angle = run.extra["angle_degree"]
			said.append(
				f"The flat ends are {angle:.3g}° wide. Jaws that press on them as one make "
				f"{run.extra['centre_over_nominal']:.3f} of this stress at the centre of an elastic "
				f"disc, as a rigid punch does; uniform pressure makes {hondros(angle)[0]:.3f} "
				"(Hondros 1959). The strength above does not take that into account."
			)
		if options.jaws == "curved":
			said.append(
				"The curved jaws are rigid bodies of 1.5 times the radius of the disc: they touch more "
				"of it as it flattens. Those of triangles are an arc of nodes that moves as one."
			)
		return said


def flat_angle(sample):
	"""Angle 2α that flat ends across y take of a disc, by the height of its box over its width [degree];
	0: none."""
	width, height = (float(side) for side in (sample.upper - sample.lower)[:2])
	return 2 * math.degrees(math.acos(height / width)) if height < width * (1 - 1e-6) else 0.0


TEST = Brazilian()
