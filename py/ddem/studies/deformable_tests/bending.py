# GPL v2 or later, see LICENSE.
"""Three-point bending of a beam of deformable triangles."""
from argparse import SUPPRESS

from yade import DeformableElastMat, O

from ... import mesh as meshes
from ...triangle_bending import plane_strain_deflection, three_point_bending
from ..bonded_tests.bending import Bent
from ..commandline import positive
from .kind import DeformableTest

_SPAN = 0.8  # of the supports, of the beam's length
_PAD = 0.12  # half the width of what is elastic at supports and load, and its height, of the beam's height


class ThreePointBending(DeformableTest):
	"""A load that bends a beam on two supports."""

	name = "bending"
	about = "a load in the middle of a beam on two supports, --span apart"
	velocity = 0.05
	ramp = 1e-3  # three periods of the beam, so that it hardly swings
	strain = 1e-3
	size = (0.24, 0.05, 0.05)
	cells = 10
	own = {"span": None, "strip": None}
	ends = None
	two_platens = False
	record = Bent
	modulus = "of a thick elastic beam in plane strain"

	def add_options(self, group):
		group.add_argument(
			"--span", type=positive, default=SUPPRESS, metavar="M",
			help=(
				"distance of the supports in a bending test (default: 0.8 of the width, which is "
				"along the beam)"
			)
		)
		group.add_argument(
			"--strip",
			type=positive,
			default=SUPPRESS,
			metavar="M",
			help=(
				"width of the load along the beam in a bending test; a strip neither slides nor turns "
				"and so stiffens the beam (default: one node, as the supports have)"
			),
		)

	def check(self, options, refuse):
		width, height, _ = options.size
		if width < 2 * height:
			refuse(
				f"argument --size: {width:g} x {height:g} m is no beam: its width must be twice its "
				"height at least"
			)
		options.span = options.span or _SPAN * width
		if options.strip and options.strip >= options.span:
			refuse(f"argument --strip: {options.strip:g} m must be below the span, {options.span:g} m")
		if options.span > width:
			refuse(f"argument --span: {options.span:g} m must not exceed the beam's length, {width:g} m")

	def regions(self, options):
		if options.law == "elastic":
			return None
		(width, height, _), half = options.size, 0.5 * options.span
		pad = max(_PAD * height, 2 * options.edge)
		box = lambda x, y: meshes.box(max(0.0, x - pad), y, min(width, x + pad), y + pad)
		middle = 0.5 * width
		return {"left": box(middle - half, 0), "right": box(middle + half, 0), "top": box(middle, height - pad)}

	def materials(self, material):
		if type(material) is DeformableElastMat:
			return material
		pads = DeformableElastMat(
			label="pads", young=material.young, poisson=material.poisson, density=material.density
		)
		O.materials.append(pads)
		return {"": material, **dict.fromkeys(("left", "right", "top"), pads)}

	def load(self, options, block):
		# less than a triangle's edge: the node in the middle
		strip = options.strip or 1e-3 * options.edge
		return three_point_bending(block, options.span, options.velocity, options.ramp, strip)

	def motion(self, options):
		return "of the load"

	def duration(self, options, load):
		# a tenth more than the way of an elastic beam's middle: the load presses into it as well
		way = options.strain * load.span**2 / (6 * load.height)
		return 1.1 * way / options.velocity + 0.5 * options.ramp

	def elastic_modulus(self, load, young, poisson):
		span, (depth, height) = load.span, load.section
		deflection = plane_strain_deflection(1.0, span, young, poisson, depth, height)
		return span**3 / (4 * depth * height**3 * deflection)

	def title(self):
		return "Three-point bending of deformable triangles"

	def figures(self, run, load):
		return {"span_m": load.span, "strip_m": load.strip}

	def settings(self, options, load):
		depth, height = load.section
		return [
			("L", f"{1e3 * load.span:.4g} mm", "span"),
			("s", f"{1e3 * load.strip:.3g} mm", "width of the load; 0: a node"),
			("b, h", f"{1e3 * depth:.4g}, {1e3 * height:.4g} mm", "depth and height of the section"),
		]

	def notes(self, options, run):
		return [
			(
				"Bending. The beam stands on two nodes and is loaded at one, or at a strip that "
				"neither slides nor turns and stiffens it: in a span of four heights by 4 % where it "
				"is a quarter of the height wide. Around both the beam is elastic, so that it does "
				"not crush there. notched_beam.py bends a beam with a notch."
			)
		]


TEST = ThreePointBending()
