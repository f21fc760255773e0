# GPL v2 or later, see LICENSE.
"""Ladders: one scene, run with settings that cost more and more, or that stand for one another.

A ladder of one's own is a few lines, in a file that ``accuracy_cost.py --ladders FILE`` reads::

	from yade.ddem.accuracy.ladders import Ladder, Quantity, each

	def beam(size, rotation="corotational"):          # runs a scene; what it returns is compared
		...
		return {"deflection": (found, expected)}      # or the value alone, where nothing exact is known

	LADDERS = [
		Ladder(
			"my_beam", "mesh size", beam, each("size", 0.02, 0.01, 0.005),
			[Quantity("deflection", "displacement", "m")], refined="size"
		),
	]

A scene is a function of its settings, a verification case by its name, whose records count, or :data:`UCS`, the
specimens of :mod:`studies.virtualtest`. The setting ``threads`` is not the scene's, but that of its YADE.
"""
import os
from dataclasses import dataclass

UCS = "ucs"  #: the scene of both models' compression tests

#: kinds of quantities, in the order of the page
QUANTITIES = (
	"displacement", "stress", "frequency", "wave arrival", "crack energy", "UCS", "E", "energy book"
)
REFINED = ("mesh size", "number of particles")  #: kinds of ladders whose rungs are finer and finer
#: kinds whose rungs stand for one another; the last of each is the most complete one
COMPARED = ("rotation treatment", "rotation stiffness", "law and effects", "flowInterval", "energy book")
#: kinds of ladders, in the order of the page
KINDS = (*REFINED, *COMPARED[:3], "time-step fraction", "loading rate", *COMPARED[3:], "threads")


@dataclass(frozen=True)
class Quantity:
	"""What is compared."""
	name: str  # for people
	kind: str  # one of QUANTITIES
	unit: str = "-"
	# of a verification case: how its records' quantity begins, "…" for what varies;
	# else the key of what the scene gives
	record: str = ""
	source: str = ""  # of the reference, where the scene does not say

	@property
	def key(self):
		"""What the scene calls it."""
		return self.record or self.name


@dataclass(frozen=True, eq=False)
class Ladder:
	"""One scene with several settings, and what is compared."""
	name: str
	kind: str  # what changes from rung to rung, one of KINDS
	scene: object  # function, name of a verification case, or UCS
	rungs: tuple  # dicts of settings
	quantities: tuple  # of Quantity
	base: dict = None  # settings of all rungs
	refined: str = ""  # setting that tends to zero, in which errors have an order; of a pair its mean counts
	seeds: tuple = ()  # the scene is run with each, as setting "seed"; its values scatter
	# the rung that the scene takes where nothing is said, with which the other ladders run; None: the last
	usual: dict = None

	def __post_init__(self):
		object.__setattr__(self, "rungs", tuple(dict(rung) for rung in self.rungs))
		object.__setattr__(self, "quantities", tuple(self.quantities))
		object.__setattr__(self, "base", dict(self.base or {}))
		if self.rungs and self.usual is None:
			object.__setattr__(self, "usual", self.rungs[-1])
		if self.kind not in KINDS:
			raise ValueError(
				f"ladder '{self.name}': kind '{self.kind}' is unknown; there are {', '.join(KINDS)}"
			)
		unknown = [q.kind for q in self.quantities if q.kind not in QUANTITIES]
		if unknown:
			raise ValueError(
				f"ladder '{self.name}': quantity of kind '{unknown[0]}' is unknown; there are "
				f"{', '.join(QUANTITIES)}"
			)
		if not self.rungs or not self.quantities:
			raise ValueError(f"ladder '{self.name}' needs rungs and quantities")
		if len({label(rung) for rung in self.rungs}) < len(self.rungs):
			raise ValueError(f"ladder '{self.name}' has the same rung twice")
		if self.usual not in self.rungs:
			raise ValueError(
				f"ladder '{self.name}': its usual rung, {label(self.usual)}, is none of its rungs"
			)
		if self.refined and any(self.refined not in self.settings(rung) for rung in self.rungs):
			raise ValueError(
				f"ladder '{self.name}': not every rung has the setting '{self.refined}' that is refined"
			)

	def settings(self, rung):
		"""All settings of a rung."""
		return {**self.base, **rung}

	def step(self, rung):
		"""What is refined, as a number; None where nothing is."""
		if not self.refined:
			return None
		value = self.settings(rung)[self.refined]
		return sum(value) / len(value) if isinstance(value, (list, tuple)) else value


def each(setting, *values):
	"""Rungs that differ in one setting."""
	return tuple({setting: value} for value in values)


def label(rung):
	"""A rung in a few words: "size 5 mm", "cosserat"."""
	return ", ".join(_words(name, value) for name, value in rung.items())


_NAMES = {"rotationStiffness": "β_φ"}  # of settings, for people; of others their own with spaces


def _words(name, value):
	if name in ("size", "fine", "radius"):
		return f"{1e3 * value:.4g} mm"
	if name == "velocity":
		return f"{value:g} m/s"
	name = _NAMES.get(name, name.replace("_", " "))
	if isinstance(value, bool):
		return f"{name} {'on' if value else 'off'}"
	if isinstance(value, dict):
		return label(value) or "all effects"
	if name == "radii":
		return f"radii {' to '.join(f'{1e3 * v:.3g}' for v in value)} mm"
	if isinstance(value, (list, tuple)):
		return f"{name} {' to '.join(f'{v:g}' if isinstance(v, float) else str(v) for v in value)}"
	if isinstance(value, str):
		return f"no {name}" if value == "none" else value
	return f"{name} {value:g}"


_MESH = (0.0125, 0.01, 0.00625, 0.005, 0.003125, 0.0025)  # with the half of each, for the two errors of fracture
_STRENGTH = (
	Quantity("strength", "UCS", "Pa", "ucs"), Quantity("Young's modulus", "E", "Pa", "young"),
	Quantity("energy book", "energy book", "-", "energy_error", "first law")
)
_BLOCK = {"model": "deformable", "specimen": "block", "size": 0.008}
_SPEEDS = (2.0, 1.0, 0.5, 0.25, 0.125, 0.0625)
_SLOW = {**_BLOCK, "rotation": "corotational"}  # below 0.1 m/s cosserat cores lose strength, more the longer it takes
_BAND = "material point of a band 10 mm wide"
_CORES = len(os.sched_getaffinity(0))
_THREADS = tuple(dict.fromkeys((*(2**k for k in range(_CORES.bit_length())), _CORES)))  # 1, 2, 4 … and all

LADDERS = (
	Ladder(
		"cantilever", "mesh size", "cantilever", each("size", 0.025, 0.0125, 0.00625, 0.004), (
			Quantity("deflection", "displacement", "m", "deflection of the tip, 2D elasticity"),
			Quantity("first frequency", "frequency", "Hz", "first frequency, 2D elasticity"),
		), refined="size"
	),
	Ladder(
		"kirsch", "mesh size", "kirsch", each("fine", 0.0008, 0.00055, 0.0004), (
			Quantity("stress at the hole's flank", "stress", "-", "stress along the hole at its flank"),
			Quantity("displacement", "displacement", "-", "displacement of the nodes, largest error"),
		), refined="fine"
	),
	Ladder(
		"brazilian", "mesh size", "brazilian", each("size", 0.008, 0.004, 0.002), (
			Quantity("stress along the diameter", "stress", "-", "σ_xx along the diameter"),
		), refined="size"
	),
	Ladder(
		"plane_waves", "mesh size", "plane_waves", each("size", 0.016, 0.008, 0.004, 0.002), (
			Quantity("P wave, crossed", "wave arrival", "m/s", "speed, compression, crossed"),
			Quantity("S wave, crossed", "wave arrival", "m/s", "speed, shear, crossed"),
		), refined="size"
	),
	Ladder(
		"rayleigh_wave", "mesh size", "rayleigh_wave", each("cells", 12, 24, 48), (
			Quantity("Rayleigh speed", "wave arrival", "-", "c_R/c_s at ν = 0.25 ["),
		)
	),
	Ladder(
		"spinning_disc", "mesh size", "spinning_disc", each("size", 0.014, 0.007, 0.0035), (
			Quantity(
				"stress, corotational",
				"stress",
				"-",
				"stress, mean over … corotational, root",
			),
			Quantity("stress, cosserat", "stress", "-", "stress, mean over … cosserat, root"),
		), refined="size"
	),
	Ladder(
		"ucs_mesh", "mesh size", UCS, each("size", *_MESH), _STRENGTH, {**_BLOCK}, refined="size",
		seeds=(1, 2, 3)
	),
	Ladder(
		"ucs_spheres", "number of particles", UCS,
		tuple({"radii": (r, 2.5 * r)} for r in (0.002, 0.0016, 0.0013, 0.001)), _STRENGTH,
		{"model": "rigid", "specimen": "block"}, refined="radii", seeds=(1, 2, 3)
	),
	Ladder(
		"crack_band", "mesh size", "crack_band", each("size", 0.012, 0.008, 0.006, 0.004, 0.003), (
			Quantity("energy, crack band", "crack energy", "J/m²", "energy until 0.1 mm with the", _BAND),
			Quantity("energy, per volume", "crack energy", "J/m²", "energy until 0.1 mm without", _BAND),
		), refined="size"
	),
	Ladder(
		"ucs_rotation", "rotation treatment", UCS, each("rotation", "none", "corotational", "cosserat"),
		_STRENGTH,
		_BLOCK
	),
	Ladder(
		"ucs_beta", "rotation stiffness", UCS,
		tuple({"values": {"rotationStiffness": beta}} for beta in (20, 0, 2)), _STRENGTH, _BLOCK
	),
	Ladder(
		"ucs_effects", "law and effects", UCS, (
			{"values": {"equationOfState": False, "rateDependence": False}},
			{"values": {"rateDependence": False}},
			{"values": {"equationOfState": False}}, {"values": {}}
		), _STRENGTH, _BLOCK
	),
	Ladder(
		"ucs_step", "time-step fraction", UCS, each("safety", 0.9, 0.8, 0.4, 0.2, 0.1), _STRENGTH, _BLOCK,
		refined="safety", usual={"safety": 0.8}
	),
	Ladder(
		"ucs_rate", "loading rate", UCS, each("velocity", *_SPEEDS), _STRENGTH, _SLOW, refined="velocity",
		usual={"velocity": 1.0}
	),
	Ladder(
		"ucs_rate_inertia", "loading rate", UCS, each("velocity", *_SPEEDS), _STRENGTH,
		{**_SLOW, "values": {"rateDependence": False}}, refined="velocity", usual={"velocity": 1.0}
	),
	Ladder(
		"ucs_book", "energy book", UCS, each("energy_book", False, True), _STRENGTH[:2],
		{**_BLOCK, "size": 0.00625}, seeds=(1, 2, 3)
	),
	Ladder("ucs_threads", "threads", UCS, each("threads", *_THREADS), _STRENGTH[:1], {**_BLOCK, "size": 0.005}),
	Ladder(
		"ucs_threads_fine", "threads", UCS, each("threads", *_THREADS), _STRENGTH[:1],
		{**_BLOCK, "size": 0.004}
	),
	Ladder(
		"ucs_flow", "flowInterval", UCS, each("flow_interval", 8, 4, 2, 1), _STRENGTH,
		{**_BLOCK, "values": {"equationOfState": False}}
	),
)


def find(name, ladders=LADDERS):
	"""The ladders of that name, or of that scene.

	:raises ValueError: there is none, with the names that there are
	"""
	found = [ladder for ladder in ladders if name in (ladder.name, ladder.scene)]
	if not found:
		raise ValueError(f"no ladder '{name}'; there are {', '.join(ladder.name for ladder in ladders)}")
	return found
