# GPL v2 or later, see LICENSE.
"""What a kind of test of bonded spheres has to say; see :class:`BondedTest`."""
from ... import bonded
from ...shapes import flattened_disc
from ..uniaxial import CompressionTest


class Fracture(CompressionTest):
	"""Ends when the stress has fallen once bonds have broken: spheres that first touch rattle, and the peaks of
	that are none to fall from."""

	def _record(self):
		stop, self.stop = self.stop, self.stop if self.specimen.damage > 0 else 0
		super()._record()
		self.stop = stop


class BondedTest:
	"""A kind of test; this one: two elastic walls along y. A new kind overrides what differs.

	Every method takes the options of the command line, with defaults filled in. What :meth:`load` returns first has
	what :class:`uniaxial.CompressionTest` reads: ``sample``, ``strain``, ``stress``, ``force_top``,
	``force_bottom``, ``height``, ``area``.
	"""

	name = None  #: of --test
	about = None  #: for the help of --test
	velocity = 0.125  #: of each wall, unless told otherwise [m/s]
	strain = 5e-3  #: largest one, unless told otherwise [-]
	stop = 0.2  #: the test ends when the stress stays below this part of the peak, unless told otherwise; 0: never
	shape = "prism"  #: of the sample, unless told otherwise
	size = (0.010, 0.020, 0.010)  #: width, height and depth of a generated sample, unless told otherwise [m]
	prism_only = False  #: whether walls on all sides need one
	bonded_walls = False  #: whether the ends are bonded to the walls, unless told otherwise
	#: options of its own, name -> default; None: it has none. Their parser's default is argparse.SUPPRESS.
	own = {}
	two_walls = True  #: whether --drive says which of two walls moves
	sense = 1  #: -1: the walls pull
	record = CompressionTest  #: keeps the record and stops the test

	def add_options(self, group):
		"""Add the options in :attr:`own` to a group of a parser."""

	def check(self, options, refuse):
		"""Call *refuse* with a text about options that do not go together."""

	def wall_stiffness(self, options):
		"""Of walls, unless told otherwise [Pa]."""
		return 100e9

	def motion(self, options):
		"""Whose speed it is."""
		moving = "each wall" if options.drive == "both" else "the upper wall, the lower stands"
		return f"of {moving}"

	def disc(self, options):
		"""What a disc is filled of: with flat ends."""
		diameter, _, length = options.size
		return flattened_disc(diameter, length)

	def packing(self, options, packing):
		"""The packing that is tested, made of the generated one or that from files."""
		return packing

	def load(self, options, sample):
		"""Make walls on the sample; what is measured, and all loads for :func:`bonded.engines`."""
		platens = self.platens(options, sample)
		return platens, platens

	def platens(self, options, sample, area=None):
		"""The two walls along y."""
		return bonded.platens(
			sample, self.sense * options.velocity, options.ramp, stiffness=options.wall_stiffness,
			both=options.drive == "both",
			bonded=options.bonded_walls, shear_stiffness=options.wall_shear_stiffness, area=area
		)

	def duration(self, options, platens):
		"""Time in which the largest strain is reached [s]."""
		return options.strain * platens.height / closing_speed(options) + 0.5 * options.ramp

	def title(self):
		"""Heading of the report."""
		return f"Uniaxial {self.name} of bonded spheres"

	def figures(self, run, platens):
		"""Further figures for summary.json, by name; *run*: the finished :class:`runs.Run`."""
		return {}

	def settings(self, options, platens):
		"""Rows (name, value, meaning) for the report, of this kind alone."""
		return []

	def notes(self, options, run):
		"""Sentences for the report, of this kind alone; *run*: the finished :class:`runs.Run`."""
		return []


def closing_speed(options):
	"""Speed at which the walls approach [m/s]."""
	return options.velocity * (2 if options.drive == "both" else 1)
