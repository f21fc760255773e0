# GPL v2 or later, see LICENSE.
"""One material point: stress-strain curves of a law of deformable triangles,
by default that of :yref:`ConcreteDamageMat`, without a scene.

Crush a point of concrete at 1/s, first free and then in a pressure cell::

	from yade.ddem.materialpoint import MaterialPoint

	free = MaterialPoint().uniaxial(rate=-1, until=-0.02)
	print(free.peak)                                              # Peak(stress=-91.0e6, strain=-0.0026)
	cell = MaterialPoint().uniaxial(rate=-1, until=-0.02, confinement=40e6)
	plot(cell.axial_strain, cell.axial_stress)

Any path, mixed in strain and stress; the state goes on from one call to the next::

	point = MaterialPoint(concrete(fractureEnergy=40e3), effects={"viscoplasticFlow", "damage"})
	shear = point.path(duration=0.01, strain={"xy": 0.005}, stress={"yy": -10e6})

It works outside YADE too: append the directory that holds the package to the path (``sys.path.append("…/py/yade")``)
and write ``from ddem.materialpoint import …``. Tension is positive, SI units; xy is the tensor component of strain
(half the engineering shear).
"""
import difflib
import math
import numbers
from collections import namedtuple
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from . import _materialpoint

COMPONENTS = ("xx", "yy", "zz", "xy")
LAWS = tuple(_materialpoint.laws())
"""Names of the laws; a material's is its class without *Mat*."""
CONCRETE = "ConcreteDamage"
EFFECTS = tuple(_materialpoint.effects(CONCRETE))
"""Names of the effects, as :yref:`ConcreteDamageMat` has them."""

Peak = namedtuple("Peak", "stress strain")

_STEP = 1e-6  # default strain of a step [-]


def concrete(**changes):
	"""Parameters of the concrete of Zubelewicz (2018), Tables 1 and 2, with *changes*, as a dict by name.

	:raises ValueError: a name that does not exist (naming the nearest), or a value that is not allowed
		(naming value, unit and way out).
	"""
	return law_parameters(CONCRETE, **changes)


def law_parameters(law, **changes):
	"""Parameters of any law by name, with *changes*: a dict.

	:param law: one of :data:`LAWS`.
	:raises ValueError: as :func:`concrete`, and for a law that does not exist.
	"""
	parameters = {name: default for name, default, *_ in _materialpoint.parameters(law)}
	for name, value in changes.items():
		if name not in parameters:
			raise ValueError(
				f"unknown parameter {name!r}{_nearest(name, parameters)}; there are: "
				f"{', '.join(parameters)}"
			)
		parameters[name] = _number(value, name)
	_materialpoint.validate(law, parameters)
	return parameters


@dataclass(frozen=True)
class PathResult:
	"""What a point went through: arrays with a row per recorded step. Tensors have the columns xx, yy, zz, xy."""

	time: np.ndarray  # [s]
	strain: np.ndarray  # [-], (n, 4)
	stress: np.ndarray  # [Pa], (n, 4)
	stored_energy: np.ndarray  # [J/m³]
	plastic_dissipation: np.ndarray  # [J/m³]
	damage_dissipation: np.ndarray  # by damage and by closing and opening cracks [J/m³]
	damage_ratio: np.ndarray  # damage parameter, 0 intact to 1 [-]
	tangent_factor: np.ndarray  # largest tangent modulus over the initial one, for the time step [-]
	fields: dict  # what the law remembers, by name: (n,) or (n, components)
	axial_start: float = 0.0  # axial strain where axial loading began [-]

	@property
	def modulus_factor(self):
		"""Factor of the equation of state on the moduli [-]; 1 where the law has none."""
		return 1 + self.fields.get("stiffening", np.zeros(len(self.time)))

	@property
	def plastic_strain(self):
		"""Plastic strain [-], (n, 4); zero where the law has none."""
		return self.fields.get("plasticStrain", np.zeros_like(self.strain))

	@property
	def damage(self):
		"""Damage tensor [-], (n, 4); zero where the law has none."""
		return self.fields.get("damageTensor", np.zeros_like(self.strain))

	@property
	def axial_strain(self):
		"""Strain yy [-] counted from where axial loading began (after confinement)."""
		return self.strain[:, 1] - self.axial_start

	@property
	def axial_stress(self):
		"""Stress yy [Pa]."""
		return self.stress[:, 1]

	@property
	def peak(self):
		"""Axial stress [Pa] of largest magnitude and the axial strain [-] there."""
		at = np.argmax(np.abs(self.axial_stress))
		return Peak(float(self.axial_stress[at]), float(self.axial_strain[at]))

	@property
	def pressure(self):
		"""Pressure [Pa], positive in compression."""
		return -self.stress[:, :3].sum(axis=1) / 3


class MaterialPoint:
	"""A point that remembers its state.

	:param material: None for the law's defaults; a dict of parameters; or any object with attributes of these
		names, such as a :yref:`ConcreteDamageMat` (missing ones keep their default).
	:param effects: names of the law's effects to simulate, of :data:`EFFECTS` for concrete. None: those that the
		material switches on (all, for a dict).
	:param damage: pre-existing damage tensor Ω_0 (xx, yy, zz, xy) [-].
	:param band_factor: of a crack band, on the fracture energy once flow has localised [-], see :mod:`crackband`.
	:param law: one of :data:`LAWS`. None: that of the material's class, concrete for a dict.
	:param area: of the triangle, for laws that ask for its size [m²].
	:raises ValueError: bad parameter, effect, damage or factor.
	"""

	def __init__(self, material=None, effects=None, damage=(0, 0, 0, 0), band_factor=1.0, law=None, area=1e-4):
		self.law = _law(material, law)
		self.parameters = _parameters(self.law, material)
		bits = _materialpoint.effects(self.law)
		self.effects = _effects(tuple(bits), material, effects)
		self._point = _materialpoint.Point(
			law=self.law, parameters=self.parameters,
			effects=sum(bits[name] for name in self.effects) | _materialpoint.energy,
			damage=_tensor(damage, "damage"), bandFactor=_number(band_factor, "band_factor"),
			area=_number(area, "area")
		)

	@property
	def state(self):
		"""The present state, a :class:`PathResult` of one row."""
		return self._result([self._point.row()])

	def uniaxial(self, rate, until, confinement=0.0, step=None, every=1):
		"""Uniaxial stress: yy driven, xx and zz held at minus *confinement*.

		:param rate: axial strain rate [1/s], negative in compression.
		:param until: axial strain [-] at the end, counted from the confined state and of the sign of *rate*.
		:param confinement: pressure [Pa] that is put on all around first, in 200 steps at the same rate.
		:param step: strain per step [-]; with the default 1e-6 whole curves are within 0.15 % of the peak of
			those with 2e-7; see :meth:`path` for coarser ones.
		:param every: record every so many steps.
		:returns: :class:`PathResult` of the axial loading
		"""
		return self._axial("uniaxial", rate, until, confinement, step, every, free=("xx", "zz"))

	def plane_strain(self, rate, until, confinement=0.0, step=None, every=1):
		"""Plane strain: as :meth:`uniaxial`, but zz keeps its strain while yy is driven;
		only xx is held at minus *confinement*."""
		return self._axial("plane_strain", rate, until, confinement, step, every, free=("xx", ))

	def path(self, duration, strain=None, stress=None, steps=1000, every=1):
		"""A path in several components. Each goes linearly to its target, or through a sequence of targets,
		one leg each.

		:param duration: of a leg [s].
		:param strain: targets by component [-], e.g. ``{"yy": -0.01}`` or ``{"yy": [0.005, -0.005, 0.005]}``.
		:param stress: likewise [Pa]. Components named in neither keep their strain.
		:param steps: per leg. A step in which a strain under held stress changes by more than 2e-5 is halved,
			so coarse paths in compression stay within 0.5 % of the peak of fine ones, and steps of 1e-6
			within 0.1 %. Tension needs small steps: 1e-6 is within 0.15 % there, 1e-5 within 1.7, 1e-4
			within 11.
		:param every: record every so many steps.
		:raises ValueError: unknown component, one in both *strain* and *stress*, sequences of different length,
			bad number.
		:raises RuntimeError: the material does not bear a prescribed stress;
			the point then stays at the last step that worked.
		"""
		targets, control = _targets(strain or {}, stress or {}, self.state)
		return self._result([self._run(control, target, duration, steps, every) for target in targets])

	def _axial(self, name, rate, until, confinement, step, every, free):
		rate, until, confinement = (
			_number(value, f"{name}: {what}")
			for value, what in ((rate, "rate"), (until, "until"), (confinement, "confinement"))
		)
		if not (rate * until > 0 and math.isfinite(until)):
			raise ValueError(
				f"{name}: rate = {rate} 1/s and until = {until} must be finite and have the same "
				"sign, negative in compression"
			)
		if confinement < 0:
			raise ValueError(f"{name}: confinement = {confinement} Pa is a pressure and cannot be negative")
		step = _STEP if step is None else _number(step, f"{name}: step")
		if not step > 0:
			raise ValueError(f"{name}: step = {step} must be a positive strain")
		if confinement > 0:
			pressed = confinement / (3 * self.parameters["bulk"]) / abs(rate)
			self._run("ssss", (-confinement, -confinement, -confinement, 0), pressed, 200, 200)
		start = self.state.strain[0]
		target, control = start.copy(), ["e"] * 4
		target[1] += until
		for component in free:
			at = COMPONENTS.index(component)
			target[at], control[at] = -confinement, "s"
		steps = max(1, int(np.ceil(abs(until) / step - 1e-9)))
		return self._result([self._run("".join(control), target, until / rate, steps, every)], float(start[1]))

	def _result(self, blocks, axial_start=0.0):
		rows = np.concatenate(blocks)
		fields, column = {}, 14
		for name, _, components in self._point.fields():
			values = rows[:, column:column + components]
			fields[name] = values[:, 0] if components == 1 else values
			column += components
		return PathResult(
			rows[:, 0], rows[:, 1:5], rows[:, 5:9], *(rows[:, k] for k in range(9, 14)), fields, axial_start
		)

	def _run(self, control, target, duration, steps, every):
		return self._point.run(
			control=control,
			target=tuple(float(value) for value in target),
			duration=_number(duration, "duration"),
			steps=_count(steps, "steps"),
			every=_count(every, "every"),
		)


def _law(material, law):
	if law is None:
		name = type(material).__name__
		law = name[:-3] if name.endswith("Mat") and name[:-3] in LAWS else CONCRETE
	if law not in LAWS:
		raise ValueError(f"law {law!r} is unknown; there are {', '.join(LAWS)}")
	return law


def _parameters(law, material):
	if material is None:
		return law_parameters(law)
	if isinstance(material, Mapping):
		return law_parameters(law, **material)
	found = {
		name: getattr(material, name) for name, *_ in _materialpoint.parameters(law) if hasattr(material, name)
	}
	if not found:
		raise ValueError(
			f"{material!r} has none of the parameters of {'concrete' if law == CONCRETE else law}; "
			"give a dict, or an object with attributes such as bulk, shear, strength"
		)
	return law_parameters(law, **found)


def _effects(known, material, effects):
	if effects is None:
		if material is None or isinstance(material, Mapping):
			return known
		return tuple(name for name in known if getattr(material, name, True))
	unknown = sorted(set(effects) - set(known)) if not isinstance(effects, str) else [effects]
	if unknown:
		raise ValueError(f"effects: {unknown[0]!r} is unknown; give a set of {', '.join(known)}")
	return tuple(name for name in known if name in effects)


def _targets(strain, stress, state):
	"""Targets of all legs and the control letters of their components."""
	for component in (*strain, *stress):
		if component not in COMPONENTS:
			raise ValueError(f"path: component {component!r} is unknown; there are {', '.join(COMPONENTS)}")
	both = set(strain) & set(stress)
	if both:
		raise ValueError(
			f"path: component {both.pop()!r} is in both strain and stress; a component follows one of them"
		)
	if not strain and not stress:
		raise ValueError("path: give targets in strain or stress")
	given = {name: np.atleast_1d(np.asarray(values, float)) for name, values in {**strain, **stress}.items()}
	legs = {len(values) for values in given.values() if len(values) > 1} or {1}
	if len(legs) > 1 or any(values.ndim > 1 or not len(values) for values in given.values()):
		raise ValueError(
			"path: sequences of targets must have one length, got "
			f"{sorted(len(values) for values in given.values())}"
		)
	targets = np.tile(state.strain[0], (legs.pop(), 1))
	for name, values in given.items():
		targets[:, COMPONENTS.index(name)] = values
	return targets, "".join("s" if name in stress else "e" for name in COMPONENTS)


def _tensor(values, name):
	values = tuple(values)
	if len(values) != 4:
		raise ValueError(f"{name} = {values} must have the four components xx, yy, zz, xy")
	return tuple(_number(value, name) for value in values)


def _number(value, name):
	if not isinstance(value, numbers.Real):
		raise ValueError(f"{name} = {value!r} must be a number")
	return float(value)


def _count(value, name):
	if not isinstance(value, numbers.Integral) or value < 1:
		raise ValueError(f"{name} = {value!r} must be a whole number of at least 1")
	return int(value)


def _nearest(name, names):
	close = difflib.get_close_matches(name, list(names), 1)
	return f", did you mean {close[0]!r}?" if close else ""
