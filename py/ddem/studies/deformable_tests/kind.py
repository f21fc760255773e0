# GPL v2 or later, see LICENSE.
"""What a kind of test of deformable triangles has to say; see :class:`DeformableTest`."""
from ... import loading, mesh
from ...triangle_confinement import plane_strain_modulus
from ..uniaxial import CompressionTest


class DeformableTest:
	"""A kind of test; this one: two platens along y on a rectangle. A new kind overrides what differs.

	Every method takes the options of the command line, with defaults filled in. What :meth:`load` returns has what
	:class:`uniaxial.CompressionTest` reads: ``sample``, ``strain``, ``stress``, ``force_top``, ``force_bottom``,
	``height``, ``area``; and ``engines``.
	"""

	name = None  #: of --test
	about = None  #: for the help of --test
	velocity = 1.0  #: of what moves, unless told otherwise [m/s]; see ``strain``
	ramp = 1e-4  #: time over which that speed grows, unless told otherwise [s]
	strain = 1e-2  #: largest one, unless told otherwise [-]
	stop = 0.2  #: the test ends when the stress stays below this part of the peak, unless told otherwise; 0: never
	size = (0.10, 0.20, 0.02)  #: width, height and thickness, unless told otherwise [m]
	#: options of its own, name -> default; their parser's default is argparse.SUPPRESS
	own = {}
	cells = 20  #: triangles along the smaller of width and height, unless told otherwise
	ends = "rough"  #: of the platens, unless told otherwise; None: --ends says nothing here
	two_platens = True  #: whether --drive says which of two platens moves
	sense = 1  #: -1: the platens pull
	record = CompressionTest  #: keeps the record and stops the test
	modulus = "E/(1 − ν²)"  #: what ``elastic_modulus`` is

	def add_options(self, group):
		"""Add the options in ``own`` to a group of a parser."""

	def check(self, options, refuse):
		"""Call *refuse* with a text about options that do not go together."""

	def mesh(self, options):
		"""A rectangle, its lower left corner at the origin."""
		extra = {"seed": options.seed} if options.pattern == "unstructured" else {}
		return mesh.rectangle(
			*options.size[:2], options.edge, pattern=options.pattern, regions=self.regions(options), **extra
		)

	def regions(self, options):
		"""Regions of the rectangle, see :func:`mesh.rectangle`."""
		return None

	def materials(self, material):
		"""What :func:`block.append` gives the mesh, made of the material that is tested."""
		return material

	def initial_stress(self, options):
		"""Of the sample, as :func:`block.append` takes it."""
		return None

	def load(self, options, block):
		"""What loads the block and is measured."""
		return loading.platens(
			block, self.sense * options.velocity, options.ramp, self.lateral(options),
			options.drive == "both"
		)

	def lateral(self, options):
		"""What :func:`loading.platens` calls the ends."""
		return "free" if options.ends == "smooth" else "fixed"

	def motion(self, options):
		"""Whose speed it is."""
		return "of each platen" if options.drive == "both" else "of the top platen, the bottom stands"

	def duration(self, options, load):
		"""Time in which the largest strain is reached [s]."""
		return options.strain * load.height / self.closing_speed(options) + 0.5 * options.ramp

	def closing_speed(self, options):
		"""Speed at which the sample changes its height [m/s]."""
		return options.velocity * (2 if self.two_platens and options.drive == "both" else 1)

	def elastic_modulus(self, load, young, poisson):
		"""Slope of stress over strain of an elastic sample under that load [Pa], see ``modulus``;
		None where there is none."""
		return plane_strain_modulus(young, poisson)

	def title(self):
		"""Heading of the report."""
		return f"Uniaxial {self.name} of deformable triangles"

	def figures(self, run, load):
		"""Further figures for summary.json, by name; *run*: the finished :class:`runs.Run`."""
		return {}

	def settings(self, options, load):
		"""Rows (name, value, meaning) for the report, of this kind alone."""
		return []

	def notes(self, options, run):
		"""Sentences for the report, of this kind alone; *run*: the finished :class:`runs.Run`."""
		return []
