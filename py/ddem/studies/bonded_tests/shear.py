# GPL v2 or later, see LICENSE.
"""Direct shear of a prism of bonded spheres between two half boxes."""
from argparse import SUPPRESS

from ... import bonded
from ..commandline import not_negative, positive
from ..wording import Column, Wording
from .kind import BondedTest, Fracture

_RESIDUAL = 0.2  # part of the record at its end over which the residual shear stress is the mean


class Sheared(Fracture):
	"""Records the shear of a block."""

	kind = "shear"
	wording = Wording(
		strength="shear_MPa",
		peak="peak shear strength",
		rows=(
			("shear_MPa", "peak shear strength", "MPa", 1, "{:.2f}"),
			("residual_MPa", "residual shear stress", "MPa", 1, "{:.2f}"),
			("normal_stress_at_peak_MPa", "normal stress at the peak", "MPa", 1, "{:.2f}"),
		),
		stress="shear stress",
		strain="shear displacement over length",
		modulus=None,
		where="in shear ",
		digits=3,
		loads="box",
		ends=("upper half", "lower half"),
		force="shear force on half box",
		curve=(
			"Shear stress, of the mean force of both halves, over the displacement of the lower half in "
			"per cent of the sample's length."
		),
		forces="Shear forces on both halves of the box. Where they agree the sample is in equilibrium.",
		definition=(
			"Stress: (<i>T</i><sub>upper</sub> + <i>T</i><sub>lower</sub>)/(2<i>A</i>), <i>T</i> the "
			"shear force on a half box, end plate and sides together, <i>A</i> the area of the plane of "
			"shear at the start; strain: way of the lower half over the sample's length. The residual "
			"stress is the mean of the last fifth of the displacement."
		),
		also=(
			Column("normal_stress", "Pa", "normal stress [MPa]", 1e-6),
			Column("dilation", "m", "rise of the upper half [µm]", 1e6),
			Column("displacement", "m", "shear displacement [mm]", 1e3),
		),
		also_text="Normal stress and rise of the upper half over the shear displacement.",
		face="plane of shear",
	)


class DirectShearTest(BondedTest):
	"""Two half boxes that shear a block."""

	name = "shear"
	about = "two half boxes that shear a block, with --normal-stress on it"
	velocity = 0.25
	strain = 5e-2
	stop = 0.0  # what it bears in the end is wanted
	size = (0.020, 0.012, 0.012)
	prism_only = True
	two_walls = False
	own = {"normal_stress": None, "box_gap": None}
	record = Sheared

	def add_options(self, group):
		group.add_argument(
			"--normal-stress", type=positive, default=SUPPRESS, metavar="PA",
			help=(
				"on the plane of shear, before and while the block is sheared (default: none; direct "
				"shear needs it)"
			)
		)
		group.add_argument(
			"--box-gap", type=not_negative, default=SUPPRESS, metavar="M",
			help="between the halves of a shear box (default: two mean radii)"
		)

	def check(self, options, refuse):
		if options.normal_stress is None:
			refuse("argument --normal-stress: it belongs to --test shear, which needs it")
		if options.bonded_walls:
			refuse("argument --bonded-walls: a shear box always holds its ends")

	def wall_stiffness(self, options):
		return options.young

	def motion(self, options):
		return "of the lower half of the box"

	def load(self, options, sample):
		shear = bonded.direct_shear(
			sample, options.normal_stress, options.velocity, options.ramp, options.box_gap,
			options.wall_stiffness
		)
		return shear, shear

	def duration(self, options, shear):
		return shear.begins + options.strain * shear.length / options.velocity + 0.5 * options.ramp

	def title(self):
		return "Direct shear of bonded spheres"

	def figures(self, run, shear):
		"""Residual shear stress and mean normal stress there."""
		strain = run.series["strain"]
		last = strain >= (1 - _RESIDUAL) * strain.max()
		residual, normal = (
			float(run.series["stress"][last].mean()),
			float(run.series["normal_stress"][last].mean()),
		)
		peak = run.strength.peak
		return {
			"normal_stress_MPa": 1e-6 * shear.normal_target,
			"normal_stress_at_peak_MPa": 1e-6 * float(run.series["normal_stress"][peak]),
			"residual_MPa": 1e-6 * residual,
			"residual_over_normal": residual / normal if normal > 0 else None,
			"dilation_at_peak_m": float(run.series["dilation"][peak]),
		}

	def settings(self, options, shear):
		return [
			("σ_n", f"{1e-6 * shear.normal_target:g} MPa", "normal stress, kept by a servo"),
			("gap", f"{1e3 * shear.gap:.3g} mm", "between the halves of the box"),
		]

	def notes(self, options, run):
		ratio = run.extra["residual_over_normal"]
		return [
			(
				"Direct shear. The normal stress grows first; then the lower half moves, while the "
				"upper one carries the load and is free to rise. The outermost spheres are bonded to "
				"the end plates, as a specimen is cast into its box; side plates, front and back are "
				"smooth. Over the last fifth of the displacement the shear stress is "
				f"{run.extra['residual_MPa']:.2f} MPa"
			)
			+ (f", {ratio:.2f} of the normal stress there." if ratio is not None else ".")
		]


TEST = DirectShearTest()
