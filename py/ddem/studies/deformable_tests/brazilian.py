# GPL v2 or later, see LICENSE.
"""The Brazilian test: a disc of deformable triangles that is split across a diameter."""
import dataclasses
from argparse import SUPPRESS

from ...disc_stress import pressed
from ...triangle_jaws import brazilian, brazilian_disc
from ..bonded_tests.brazilian import Split
from ..commandline import positive
from ..wording import Column
from .kind import DeformableTest

_ANGLES = {"curved": 10.0, "flat-ends": 30.0}  # 2α of each kind of jaws, unless told otherwise [degree]


class SplitDisc(Split):
	"""Records the splitting of a disc, and the stress at its centre."""

	wording = dataclasses.replace(
		Split.wording,
		also=(
			Column("splitting_stress", "Pa", "stress across the load at the centre [MPa]", 1e-6),
			Column("strain", "-", "shortening of the diameter [%]", 100),
		),
		also_text="Stress across the load at the centre of the disc, over the approach of the jaws.",
	)


class Brazilian(DeformableTest):
	"""Jaws that split a disc."""

	name = "brazilian"
	about = "--jaws that split a disc"
	velocity = 0.05
	strain = 4e-3
	size = (0.05, 0.05, 0.02)
	own = {"jaws": "flat-ends", "angle": None}
	ends = None
	record = SplitDisc

	def add_options(self, group):
		group.add_argument(
			"--jaws",
			choices=tuple(_ANGLES),
			default=SUPPRESS,
			help=(
				"of a Brazilian test: curved, on a round disc, an arc of nodes that moves as one and "
				"stays as wide, not a jaw of 1.5 times the radius as that of ucs_bonded.py; "
				"or on a disc with flat ends (default: flat-ends)"
			),
		)
		group.add_argument(
			"--angle", type=positive, default=SUPPRESS, metavar="DEGREES",
			help="over which each jaw touches the disc (default: curved 10, flat-ends 30)"
		)

	def check(self, options, refuse):
		options.angle = options.angle or _ANGLES[options.jaws]
		if options.angle > 60:
			refuse(f"argument --angle: {options.angle:g} must not exceed 60 degrees")
		width, height, _ = options.size
		if width != height:
			refuse(
				f"argument --size: a disc of {width:g} m has that height as well, not {height:g} m: "
				"give W and H the same"
			)
		if options.pattern != "unstructured":
			refuse("argument --mesh: discs have unstructured meshes")

	def mesh(self, options):
		return brazilian_disc(
			options.size[0], options.edge, options.angle, options.jaws == "flat-ends", options.seed
		)

	def load(self, options, block):
		return brazilian(
			block, options.size[0], options.angle, options.velocity, options.ramp, options.drive == "both"
		)

	def motion(self, options):
		return super().motion(options).replace("platen", "jaw")

	def elastic_modulus(self, load, young, poisson):
		return None

	def title(self):
		return "Brazilian test of deformable triangles"

	def figures(self, run, load):
		peak = run.strength.peak
		return {
			"angle_degree": load.angle,
			"centre_over_nominal": pressed(load.angle)[0],
			"centre_stress_at_peak_MPa": 1e-6 * float(run.series["splitting_stress"][peak]),
		}

	def settings(self, options, load):
		about = "on a round disc" if options.jaws == "curved" else "on flat ends of the disc"
		return [("jaws", options.jaws.replace("-", " "), f"{about}, {options.angle:g}° wide, smooth")]

	def notes(self, options, run):
		said = [
			(
				"Brazilian. The stress is 2P/(πDt), what line loads make across the loaded diameter "
				f"of an elastic disc. Jaws {options.angle:g}° wide that move as one make "
				f"{run.extra['centre_over_nominal']:.3f} of it at the centre; at the peak it was "
				f"{run.extra['centre_stress_at_peak_MPa']:.2f} MPa there. The strength is that in "
				"tension only where the disc splits from its middle: look at the damage."
			)
		]
		if options.jaws == "curved":
			said.append(
				"A curved jaw is here an arc of nodes that moves as one and stays as wide; that of "
				"bonded spheres is a rigid body of 1.5 times the disc's radius, which touches more of "
				"the disc as it flattens (ISRM 1978)."
			)
		return said


TEST = Brazilian()
