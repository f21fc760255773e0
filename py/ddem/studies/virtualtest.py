# GPL v2 or later, see LICENSE.
"""Virtual tests of a small specimen, of bonded spheres or of deformable triangles: what a calibration measures.

In a scene of one's own::

	from yade.ddem.studies import virtualtest

	setup = virtualtest.Setup.standard("rigid", "prism")
	measured = virtualtest.perform(setup, {"young": 40e9, "cohesion": 60e6}, {"test": "compression", "seed": 1})
	print(measured["ucs"], measured["young"])

or each in a YADE of its own, several at the same time, with :class:`SeparateYade`. SI units.
"""
import dataclasses
import math

from .. import packing
from .evaluations import EFFECTS, EvaluationError
from .questions import Questions

ROWS = 4000  #: records up to the largest strain, so that a peak at a twentieth of it is met within 0.5 %
ENERGY_ERROR = 0.05  #: an evaluation whose energy book is off by more is no measurement

_RIGID = ("radii", "fails", "held", "viscosity", "wall_factor", "convention")  # settings that only this model has
_DEFORMABLE = ("size", "mesh", "rotation", "flow_interval")


@dataclasses.dataclass(frozen=True)
class Setup:
	"""A specimen and its tests. Platens on both ends move at the same speed."""
	model: str  # "rigid" or "deformable"
	width: float  # [m]
	height: float  # [m]
	depth: float  # [m]
	rough: bool  # ends are held laterally; False: they can slide
	density: float  # of the specimen as a whole [kg/m³]
	velocity: float  # speed of each platen in compression [m/s]
	tension_velocity: float  # the same in tension [m/s]
	ramp: float  # time over which the platens reach their speed [s]
	strain: float = 0.01  # largest strain in compression [-]; half of it in tension
	stop: float = 0.7  # the test ends when the stress stays below this part of the peak
	safety: float = 0.8  # time step over the critical one
	radii: tuple = None  # smallest and largest radius of spheres [m]
	fails: int = 1000  # the packing is finished when so many spheres in a row found no place
	held: bool = False  # front and back layers of the spheres are held out of plane
	viscosity: float = 0.0  # of the damping of bodies [1/s]
	wall_factor: float = 10.0  # stiffness of the platens over Young's modulus of the bonds [-]
	convention: str = "consistent"  # of the bonds, or "esys"
	size: float = None  # of the triangles' mesh [m]
	mesh: str = "unstructured"  # its pattern
	rotation: str = "cosserat"  # treatment of the triangles' rotation
	flow_interval: int = 1  # steps from one solution of flow to the next
	energy_book: bool = True  # kept, and checked; False: no energy is measured, which saves its time

	def __post_init__(self):
		own = "size" if self.model == "deformable" else "wall_factor"
		for name in (
			"width", "height", "depth", "density", "velocity", "tension_velocity", "strain", "safety", own
		):
			if not (getattr(self, name) > 0 and math.isfinite(getattr(self, name))):
				raise ValueError(f"{name} = {getattr(self, name)} must be positive")
		if not self.safety <= 1:
			raise ValueError(f"safety = {self.safety} must not be above 1: the time step would be unstable")
		if not 0 < self.stop < 0.9:
			raise ValueError(
				f"stop = {self.stop} must lie between 0 and 0.9: only a stress that falls shows that "
				"the peak has passed"
			)
		if self.convention not in ("consistent", "esys"):
			raise ValueError(f"convention '{self.convention}' is unknown; there are consistent and esys")
		for name in ("ramp", "viscosity"):
			if not getattr(self, name) >= 0:
				raise ValueError(f"{name} = {getattr(self, name)} must not be negative")
		if self.model == "rigid":
			smallest, largest = self.radii
			if not 0 < smallest <= largest:
				raise ValueError(
					f"radii = {smallest:g} to {largest:g} m must be positive, the smaller one first"
				)
			if 4 * largest > min(self.width, self.height, self.depth):
				raise ValueError(
					f"radii up to {largest:g} m: fewer than two of the largest spheres fit across "
					f"the specimen of {1e3 * self.width:g} x {1e3 * self.height:g} "
					f"x {1e3 * self.depth:g} mm; choose smaller ones"
				)
		elif self.size > self.width / 4:
			raise ValueError(
				f"size = {self.size:g} m of the mesh is more than a quarter of the specimen's width "
				f"of {self.width:g} m"
			)

	@classmethod
	def standard(cls, model, specimen, **changes):
		"""The specimens that come with it; *changes* replace settings, None leaves one as it is.

		*prism*, 10 x 20 x 10 mm, of spheres: that of the tests of rigid particles (Weatherley et al.) with
		radii of 0.4 to 2 mm and platens of 0.125 m/s that let the ends slide. *block*, 100 x 200 x 20 mm,
		of either model: that of scripts/ucs_compare.py, in plane strain between rough platens of 1 m/s.
		In tension platens move at a quarter of the speed: the stress of the first wave, ρcv, must stay well
		below the strength, which is small there.
		"""
		if model not in ("rigid", "deformable"):
			raise ValueError(f"model '{model}' is unknown; there are rigid and deformable")
		if specimen not in SPECIMENS:
			raise ValueError(f"specimen '{specimen}' is unknown; there are {', '.join(SPECIMENS)}")
		if model == "deformable" and specimen == "prism":
			raise ValueError("the prism is for spheres; triangles are in plane strain: take the block")
		settings = {
			**SPECIMENS[specimen],
			**{name: value for name, value in changes.items() if value is not None},
		}
		settings.setdefault("tension_velocity", settings["velocity"] / 4)
		return cls(model=model, **settings)

	def plain(self):
		"""The settings that matter to this model, as plain data."""
		other = _DEFORMABLE if self.model == "rigid" else _RIGID
		return {
			name: list(value) if isinstance(value, tuple) else value
			for name, value in dataclasses.asdict(self).items()
			if name not in other
		}


SPECIMENS = {
	"prism": {
		"width": 0.010,
		"height": 0.020,
		"depth": 0.010,
		"rough": False,
		"density": 2400.0,
		"velocity": 0.125,
		"ramp": 20e-6,
		"radii": (0.4e-3, 2e-3),
	},
	"block": {
		"width": 0.10, "height": 0.20, "depth": 0.02, "rough": True, "held": True, "density": 2400.0,
		"velocity": 1.0, "ramp": 1e-4, "radii": (2e-3, 5e-3),
		"size": 5e-3
	},
}


def cases(targets, seeds):
	"""The tests that measure these targets ("young", "ucs", "tensile"), each with every seed."""
	kinds = [
		kind
		for kind, measures in (("compression", {"young", "ucs"}), ("tension", {"tensile"}))
		if measures & set(targets)
	]
	return [{"test": kind, "seed": seed} for kind in kinds for seed in seeds]


# ---- inside YADE ----


def perform(setup, values, case, cache=None):
	"""Make the specimen in an empty scene, test it, and return what was measured.

	:param setup: :class:`Setup`
	:param values: attribute -> value of the :yref:`BondedMat` or :yref:`ConcreteDamageMat`
	:param case: {"test": "compression" or "tension", "seed": whole number}
	:param cache: folder where packings are kept for the next time
	:returns: "ucs" or "tensile" [Pa], "young" [Pa], "strain_at_peak", "damage_at_peak" and, where the energy book
		is kept, "energy_error"; all but tensile with ``tension_`` in front where the test is in tension,
		so that the tests of a point do not mix
	:raises evaluations.EvaluationError: the specimen did not fail, or the run is not sound
	:raises ValueError: the material refuses its parameters
	"""
	from yade import O, ddem
	from yade.ddem.studies import uniaxial
	O.reset()
	tension = case["test"] == "tension"
	velocity, strain = (-setup.tension_velocity, 0.5 * setup.strain) if tension else (setup.velocity, setup.strain)
	platens, critical = {"rigid": _rigid, "deformable": _deformable}[setup.model](
		setup, values, case["seed"], velocity, cache
	)
	O.dt = setup.safety * critical
	duration = strain * setup.height / (2 * abs(velocity)) + 0.5 * setup.ramp
	test = (uniaxial.TensionTest if tension else uniaxial.CompressionTest)(
		platens, duration, stop=setup.stop, critical_dt=critical, rows=ROWS, snapshots=False,
		book=setup.energy_book
	)
	run = test.run(progress=False)
	measures = run.strength
	if not measures.peaked:
		raise EvaluationError(
			f"the {case['test']} test ended at a strain of {100 * run.series.last('strain'):.3g} % with "
			f"{run.series.last('stress') / 1e6:.3g} MPa before the stress had fallen from its largest "
			f"value, {measures.ucs / 1e6:.3g} MPa: allow a larger strain"
		)
	booked = setup.energy_book and setup.convention != "esys"  # which is not conservative
	if booked and not run.energy_error < ENERGY_ERROR:
		raise EvaluationError(
			f"the energy book is off by {100 * run.energy_error:.2g} %: the run is not sound; "
			f"take a smaller time step (safety = {setup.safety:g})"
		)
	if not math.isfinite(measures.young):
		raise EvaluationError(
			"fewer than three records between 20 and 60 % of the strength, none to fit Young's modulus: "
			"load slower, or less far"
		)
	figures = {
		"young": measures.young, "tensile" if tension else "ucs": measures.ucs,
		"strain_at_peak": measures.strain_at_peak,
		"damage_at_peak": float(run.series["damage"][measures.peak])
	}
	if setup.energy_book:
		figures["energy_error"] = run.energy_error
	return {
		f"tension_{name}" if tension and name != "tensile" else name: float(value)
		for name, value in figures.items()
	}


def perform_and_tell(setup, values, case, cache=None):
	"""The same as :func:`perform`, with what the steps cost (:meth:`meter.StepMeter.figures`), and under
	:data:`evaluations.EFFECTS` what the scene simulated."""
	from ..effect_table import effects
	from ..meter import StepMeter
	from .runs import RECORDER
	with StepMeter(apart=[RECORDER]) as meter:
		measured = perform(setup, values, case, cache)
	return {**measured, **meter.figures(), EFFECTS: effects().rows()}


def material(model, values, density):
	"""The material of these attributes; what else it has are the defaults of its class.

	:raises ValueError: naming an attribute that is unknown or out of range
	"""
	from yade import BondedMat, ConcreteDamageMat
	values = dict(values)
	kind = {"rigid": BondedMat, "deformable": ConcreteDamageMat}[model]
	if model == "deformable" and {"bulk", "shear", "young", "poisson"} & values.keys():
		known = kind()
		pair = ("young", "poisson") if {"young", "poisson"} & values.keys() else ("bulk", "shear")
		values = {**{name: getattr(known, name) for name in pair}, **values}
	try:
		return kind(density=density, **values)
	except AttributeError as error:
		raise ValueError(f"{kind.__name__}: {error}") from None


def _rigid(setup, values, seed, velocity, cache):
	from yade import O, ddem
	spheres = packing.prism(
		setup.width, setup.height, setup.depth, *setup.radii, seed=seed, fails=setup.fails, keep=cache
	)
	made = material("rigid", values, setup.density / spheres.solid_fraction)
	O.materials.append(made)
	sample = ddem.bonded.append(spheres, made)
	platens = ddem.bonded.platens(
		sample, velocity, setup.ramp, stiffness=setup.wall_factor * made.young, bonded=velocity < 0
	)
	faces = [(1, "x")] if setup.rough else []
	for axis, dof in faces + ([(2, "z")] if setup.held else []):
		sample.hold_faces(axis, dof)
	O.engines = ddem.bonded.engines(platens, setup.viscosity, convention=setup.convention)
	return platens, ddem.bonded.critical_time_step()


def _deformable(setup, values, seed, velocity, _):
	from yade import DeformableEngine, DeformableTimeStepper, ForceResetter, O, ddem
	made = material("deformable", values, setup.density)
	O.materials.append(made)
	extra = {"seed": seed} if setup.mesh == "unstructured" else {}
	mesh = ddem.mesh.rectangle(setup.width, setup.height, setup.size, pattern=setup.mesh, **extra)
	block = ddem.append(mesh, made, seed=seed, thickness=setup.depth)
	platens = ddem.platens(block, velocity, setup.ramp, lateral="fixed" if setup.rough else "free", both=True)
	O.engines = [
		ForceResetter(),
		*platens.engines,
		DeformableTimeStepper(safety=setup.safety),
		DeformableEngine(rotation=setup.rotation, flowInterval=setup.flow_interval),
	]
	return platens, O.engines[-1].criticalTimeStep()


# ---- each in a YADE of its own ----


class SeparateYade:
	"""Makes every evaluation in a YADE of its own, so that several run at the same time and a crash ends only one;
	for :class:`evaluations.Bench`.

	:param setup: :class:`Setup`
	:param fixed: attribute -> value of the material, what is not tuned
	:param cache: folder where packings are kept
	:param workers: :class:`workers.Workers`; None: one after another
	:param yade: see :class:`questions.Questions`
	"""

	def __init__(self, setup, fixed=None, cache=None, workers=None, yade=None):
		self.setup, self.fixed, self.cache = setup, dict(fixed or {}), cache
		self._questions = Questions(__name__, workers, yade)

	def settings(self):
		"""What a result depends on beside the tuned parameters, as plain data:
		specimen, test, fixed parameters, plugin, and machine."""
		from yade import config

		from .commandline import plugin
		made = {"yade": config.version, "plugin": plugin(), "machine": self._questions.workers.machine}
		return {**self.setup.plain(), "fixed": self.fixed, **made}

	def submit(self, values, case):
		"""A concurrent.futures.Future of what is measured."""
		return self._questions.submit(
			{
				"setup": dataclasses.asdict(self.setup),
				"values": {**self.fixed, **values},
				"case": case,
				"cache": self.cache,
			}
		)

	def stop(self):
		"""End what is running, and start nothing more."""
		self._questions.stop()


def measure(asked):
	"""What the YADE of an evaluation does: perform the test of a request, and return what it gave and simulated."""
	setup = asked["setup"]
	setup["radii"] = setup["radii"] and tuple(setup["radii"])
	return perform_and_tell(Setup(**setup), asked["values"], asked["case"], asked["cache"])
