# GPL v2 or later, see LICENSE.
"""Three-point bending of a beam of bonded spheres."""
from argparse import SUPPRESS
from dataclasses import replace

from ... import bonded
from ... import packing as packings
from ..commandline import positive
from ..wording import Column, Wording
from .kind import BondedTest, Fracture

_SPAN = 0.8  # of the supports, of the beam's length


class Bent(Fracture):
	"""Records the bending of a beam."""

	kind = "bending"
	wording = Wording(
		strength="flexural_MPa",
		peak="flexural strength",
		rows=(
			("flexural_MPa", "flexural strength", "MPa", 1, "{:.2f}"),
			("flexural_modulus_GPa", "flexural modulus", "GPa", 1, "{:.1f}"),
		),
		modulus="flexural_modulus_GPa",
		modulus_name="the flexural modulus",
		stress="bending stress 3PL/(2bh²)",
		strain="bending strain 6δh/L²",
		where="at the lower face of an elastic beam ",
		digits=3,
		loads="load",
		ends=("load", "both supports"),
		force="force",
		curve=(
			"Bending stress over bending strain, which is that of the neutral axis at mid-span against "
			"the supports."
		),
		forces=(
			"Load and sum of the reactions. Where they agree the beam is in equilibrium; their difference "
			"is its inertia."
		),
		definition=(
			"Stress: 3<i>PL</i>/(2<i>bh</i>²), <i>P</i> the load, <i>L</i> the span, "
			"<i>b</i> and <i>h</i> depth and height of the section (above the notch, where there is one); "
			"strain: 6<i>δh</i>/<i>L</i>² with the whole height, <i>δ</i> the deflection of the neutral "
			"axis at mid-span against that above the supports. The flexural modulus, of a beam without "
			"a notch, is the slope between 20 % and 60 % of the strength, as if there were no shear."
		),
		also=(
			Column("force_top", "N", "load [N]"),
			Column("deflection", "m", "deflection at mid-span [µm]", 1e6),
		),
		also_text="Load over the deflection of the neutral axis at mid-span against that above the supports.",
		face="2 b h²/(3 L), so that a force over it is 3PL/(2bh²)",
	)

	def __init__(self, bending, *arguments, **more):
		super().__init__(bending, *arguments, **more)
		if bending.notch:  # whose slope is no modulus
			self.wording = replace(self.wording, modulus=None, rows=self.wording.rows[:1])


class ThreePointBending(BondedTest):
	"""A load that bends a beam on two supports."""

	name = "bending"
	about = "a load in the middle of a beam on two supports, --span apart"
	velocity = 0.05
	strain = 4e-3
	size = (0.050, 0.0125, 0.0125)
	prism_only = True
	two_walls = False
	own = {"span": None, "notch": 0.0, "strip": None}
	record = Bent

	def add_options(self, group):
		group.add_argument(
			"--span", type=positive, default=SUPPRESS, metavar="M",
			help=(
				"distance of the supports in a bending test (default: 0.8 of the width, which is "
				"along the beam)"
			)
		)
		group.add_argument(
			"--notch", type=positive, default=SUPPRESS, metavar="M",
			help="depth of a notch beneath the load in a bending test: no bond crosses it (default: none)"
		)

		group.add_argument(
			"--strip", type=positive, default=SUPPRESS, metavar="M",
			help=(
				"width along the beam of supports and load in a bending test; a strip must hold a "
				"sphere of the face (default: two mean radii, or a tenth of the height if that is more)"
			)
		)

	def check(self, options, refuse):
		if options.bonded_walls:
			refuse("argument --bonded-walls: there are no walls in a bending test")
		if options.particles:
			return
		width, height, _ = options.size
		if width < 2 * height:
			refuse(
				f"argument --size: {width:g} x {height:g} m is no beam: its width must be twice its "
				"height at least"
			)
		if options.span and options.span >= width:
			refuse(f"argument --span: {options.span:g} m must be below the beam's length, {width:g} m")
		if options.notch >= height:
			refuse(f"argument --notch: {options.notch:g} m must be below the beam's height, {height:g} m")

	def packing(self, options, packing):
		return packings.notched(packing, options.notch, gap=None if packing.bonds is not None else options.gap
		) if options.notch else packing

	def wall_stiffness(self, options):
		return 0.1 * options.young

	def motion(self, options):
		return "of the load"

	def load(self, options, sample):
		options.span = options.span or _SPAN * float(sample.upper[0] - sample.lower[0])
		bending = bonded.three_point_bending(
			sample, options.span, options.velocity, options.ramp, options.strip, options.wall_stiffness,
			notch=options.notch
		)
		return bending, bending

	def duration(self, options, bending):
		# twice the way of an elastic beam's middle: supports and load press into it as well
		way = options.strain * bending.span**2 / (6 * bending.height)
		return 2 * way / options.velocity + 0.5 * options.ramp

	def title(self):
		return "Three-point bending of bonded spheres"

	def figures(self, run, bending):
		return {"span_m": bending.span, "notch_m": bending.notch, "strip_m": bending.strip}

	def settings(self, options, bending):
		depth, height = bending.section
		rows = [
			(
				"L",
				f"{1e3 * bending.span:.4g} mm",
				f"span; load and supports are strips {1e3 * bending.strip:.3g} mm wide",
			),
			("b, h", f"{1e3 * depth:.4g}, {1e3 * height:.4g} mm", "depth and height of the section"),
		]
		if bending.notch:
			rows.append(("a", f"{1e3 * bending.notch:.4g} mm", "depth of the notch, beneath this section"))
		return rows

	def notes(self, options, run):
		return [
			(
				"Bending. Load and supports hold the spheres at the face by springs across it alone, "
				"so that all forces are vertical and the ends free to slide. A beam a few spheres "
				"high bends more than one of the sample's modulus in compression, since its outer "
				"half spheres bear nothing."
			)
		]


TEST = ThreePointBending()
