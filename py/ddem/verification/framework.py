# GPL v2 or later, see LICENSE.
"""What a verification case is: how it is declared, found and run, and what it records. How to write one:
see the package's docstring."""
import dataclasses
import difflib
import importlib
import inspect
import io
import math
import pkgutil
import time
import traceback

from yade import O

from ..effect_table import effects
from ..meter import StepMeter
from ..studies.runs import engine_costs

#: groups of cases, in the order of the report
GROUPS = (
	"the element", "statics", "waves and vibration", "rotation", "dynamic relaxation", "concrete at a point",
	"concrete structures"
)
SLOW = 4.0  #: cases that take longer are slow [s]

_cases = {}  # name -> Case


@dataclasses.dataclass(frozen=True)
class Record:
	"""One comparison of a case; what the JSON file lists."""
	case: str
	quantity: str  # with its unit in brackets
	value: float
	reference: float
	error: float  # |value − reference| over |reference| or over the scale that the case gave [-]
	tolerance: float  # largest error that passes [-]
	passed: bool
	source: str  # of the reference
	wall_s: float  # wall time of the whole case, pictures left out [s]
	ns_per_particle_step: float = math.nan  # of the steps of the whole case, nan where it makes none; see meter
	bytes_per_particle: float = None  # of its largest scene, None where it is not known; see meter

	def plain(self):
		"""As a dict for JSON, None where a number is not finite."""
		return {
			name: None if isinstance(value, float) and not math.isfinite(value) else value
			for name, value in dataclasses.asdict(self).items()
		}


@dataclasses.dataclass(frozen=True)
class Case:
	"""A verification case: a function that gets a :class:`Check`, and what its docstring says."""
	name: str
	group: str
	seconds: float  # wall time it takes, about [s]
	function: object
	needs: str = ""  # program that it calls, of a Debian package that scripts/verify.py asks for

	@property
	def slow(self):
		"""Whether it runs with --all only."""
		return self.seconds > SLOW

	@property
	def title(self):
		"""First line of the docstring."""
		return inspect.getdoc(self.function).split("\n", 1)[0]

	@property
	def text(self):
		"""The other paragraphs of the docstring, as a list of (label, text, formula?): *Reference:* and
		*Expect:* are labels, indented paragraphs formulas."""
		result = []
		for paragraph in inspect.getdoc(self.function).split("\n\n")[1:]:
			formula = paragraph[:1].isspace()
			text = inspect.cleandoc(paragraph) if formula else " ".join(paragraph.split())
			label = next((word for word in ("Reference", "Expect") if text.startswith(word + ": ")), "")
			result.append((label, text[len(label) + 2:] if label else text, formula))
		return result

	@property
	def settings(self):
		"""Settings that may be changed, and their defaults."""
		return {
			name: parameter.default
			for name, parameter in list(inspect.signature(self.function).parameters.items())[1:]
		}


@dataclasses.dataclass(frozen=True)
class Picture:
	"""A picture of a case."""
	figure: object  # matplotlib's
	caption: str

	@property
	def width(self):
		"""On paper [mm]."""
		return round(25.4 * self.figure.get_figwidth())

	def png(self):
		"""As bytes of a PNG file."""
		from matplotlib import rc_context

		from .. import plots, provenance
		buffer = io.BytesIO()
		with rc_context(plots.STYLE):
			self.figure.savefig(buffer, format="png", dpi=200, metadata=provenance.metadata("png"))
		return buffer.getvalue()


@dataclasses.dataclass(frozen=True)
class Result:
	"""What running a case gave."""
	case: Case
	records: list  # of Record
	pictures: list  # of Picture
	notes: list  # sentences
	wall: float  # [s], pictures left out
	error: str = ""  # traceback of a case that raised
	# of the scene in which it ended, see effect_table.EffectTable.rows
	effects: list = dataclasses.field(default_factory=list)
	told: list = dataclasses.field(default_factory=list)  # what its steps cost, a line a kind of particle
	# (name, ns per particle and step, share) of each engine, see runs.engine_costs; of runs with pictures
	engines: list = dataclasses.field(default_factory=list)

	@property
	def passed(self):
		"""Whether the case compared something, and all of it within its tolerance."""
		return bool(self.records) and all(record.passed for record in self.records)


class Check:
	"""What a case writes its results into."""

	def __init__(self, case, pictures):
		self._case, self._wanted = case, pictures
		self._rows, self.pictures, self.notes = [], [], []
		self._began, self._drawing = time.perf_counter(), 0.0

	def __call__(self, quantity, value, reference, tolerance, source, scale=None):
		"""Record a comparison.

		:param quantity: what is compared, with its unit in brackets
		:param value: what this code gives
		:param reference: what it should be
		:param tolerance: largest error that passes [-]
		:param source: where the reference comes from
		:param scale: what the error is relative to; |reference| when left out
		"""
		value, reference = float(value), float(reference)
		scale = abs(reference) if scale is None else float(scale)
		if not scale > 0:
			raise ValueError(
				f"{self._case}, {quantity}: the error is relative to {scale}; give scale= where the "
				"reference is zero"
			)
		error = abs(value - reference) / scale
		self._rows.append(
			(quantity, value, reference, error, float(tolerance), bool(error <= tolerance), source)
		)

	def picture(self, draw, caption):
		"""Draw a picture where pictures are wanted;
		``draw()`` is called at once and returns a figure or axes."""
		if not self._wanted:
			return
		from matplotlib import rc_context

		from .. import plots
		began = time.perf_counter()
		with rc_context(plots.STYLE):
			drawn = draw()
		self.pictures.append(Picture(getattr(drawn, "figure", None) or drawn, caption))
		self._drawing += time.perf_counter() - began

	def note(self, text):
		"""A sentence for the report: what the numbers mean, a limit."""
		self.notes.append(" ".join(text.split()))

	def fail(self, error):
		"""The case raised an error."""
		self._rows.append(
			("runs to its end", math.nan, 1.0, math.nan, 0.0, False, f"{type(error).__name__}: {error}")
		)

	def result(self, case, meter, error=""):
		wall = time.perf_counter() - self._began - self._drawing
		cost = meter.ns_per_particle_step, meter.bytes_per_particle
		taken = [(name, seconds, 1) for name, seconds in meter.engines.items()]
		return Result(
			case,
			[Record(self._case, *row, wall, *cost) for row in self._rows],
			self.pictures,
			self.notes,
			wall,
			error,
			told=meter.told(),
			engines=engine_costs(taken, meter.particle_steps) if taken else [],
		)


def case(group, seconds, needs=""):
	"""Declare the decorated function to be a verification case; see the package's docstring.

	:param group: one of :data:`GROUPS`
	:param seconds: wall time that it takes, rounded up [s]
	:param needs: program that it calls, if any; such a case runs with the slow tests
	"""
	if group not in GROUPS:
		raise ValueError(f"group '{group}' is unknown; there are {', '.join(GROUPS)}")

	def declare(function):
		name = function.__name__
		if not function.__doc__:
			raise ValueError(
				f"case '{name}' needs a docstring: its title, what it shows, Reference: and Expect:"
			)
		if name in _cases and _cases[name].function.__module__ != function.__module__:
			raise ValueError(
				f"two cases are called '{name}': in {_cases[name].function.__module__} and in "
				f"{function.__module__}"
			)
		_cases[name] = Case(name, group, seconds, function, needs)
		return function

	return declare


def all_cases():
	"""All cases of the package, in the order of the report."""
	from . import cases as folder
	for module in sorted(module.name for module in pkgutil.iter_modules(folder.__path__)):
		importlib.import_module(f"{folder.__name__}.{module}")
	return sorted(_cases.values(), key=lambda case: GROUPS.index(case.group))


def find(name):
	"""The case of that name.

	:raises ValueError: there is none, with the names that are like it
	"""
	for found in all_cases():
		if found.name == name:
			return found
	close = difflib.get_close_matches(name, _cases, n=3, cutoff=0.4)
	raise ValueError(
		f"no case '{name}'" + (f"; did you mean {', '.join(close)}?" if close else "") + " --list shows all"
	)


def run(which, pictures=False, **settings):
	"""Run a case in an empty scene and return its :class:`Result`. A case that raises has failed;
	what it raised is in the result.

	:param which: a :class:`Case` or its name
	:param pictures: draw the pictures as well
	:param settings: for the case's function, instead of its defaults
	"""
	which = find(which) if isinstance(which, str) else which
	unknown = set(settings) - set(which.settings)
	if unknown:
		raise ValueError(
			f"case '{which.name}' has no setting {', '.join(sorted(unknown))}; it has "
			f"{', '.join(which.settings) or 'none'}"
		)
	O.reset()
	check, meter, timed = Check(which.name, pictures), StepMeter(), O.timingEnabled
	O.timingEnabled = timed or pictures
	try:
		with meter:
			which.function(check, **settings)
		result = check.result(which, meter)
		return dataclasses.replace(result, effects=effects().rows()) if pictures else result
	except Exception as error:  # the other cases still run
		check.fail(error)
		return check.result(which, meter, traceback.format_exc())
	finally:
		O.timingEnabled = timed
		O.reset()
