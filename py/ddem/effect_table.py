# GPL v2 or later, see LICENSE.
"""What a scene simulates, and why: the table of effects of both models, with what each takes and what it changed.

::

	print(ddem.effects())         # before a run: what is asked for; after it: what it did as well

An effect is *on* (it runs), *off* (it does not: no instruction, no byte) or *idle*: it ran, and what it changed is not
above :data:`NOTHING` by a bound that is measured. An idle effect may be switched off, and the scene gives the same
within that bound. The bound is a relative change, of the stresses unless said otherwise:

=================================  ==================================================================================
effect                             bound
=================================  ==================================================================================
flow, yielding, rate               largest stress that plastic strain takes, :math:`|C:\\varepsilon_p|`, over the
                                   largest
damage, fracture energies          largest damage :math:`\\eta/\\eta_{max}`
equation of state                  largest stiffening :math:`B/B_0-1`
crack band                         0 until damage reaches the value from which it acts, see :mod:`crackband`
rotation                           :math:`2\\theta+\\theta^2/2\\varepsilon` of the largest rotation and elastic
                                   strain; with 'cosserat' also the share of *elastRotation* in the energy book
gravity of triangles               the larger of :math:`\\rho g L` over the largest stress and :math:`g t` over the
                                   largest velocity
energy losses, gravity of spheres  share of the energy book, where O.trackEnergy has kept it
shear, bending, torsion of bonds   largest stress that it makes over the largest of all parts, in the bonds that hold
failure criterion                  0 while no bond has broken, then 1
contacts, their damping            0 while no bond has broken and no spheres touch without one
=================================  ==================================================================================

The flow of concrete (eq. 7) has no threshold and its equation of state is steep at first: in the elastic range both
change some per mille, by which they are on. The bound stands beside each effect, for those who take another limit.

Limits: a bound compares states with the effect and without at the same strain; in motion, differences of motion add to
it. Rotations, stiffening, stresses and velocities are those of the moment, so ask under load; what a law remembers
(plastic strain, damage) is the whole history. A bond that broke is not in the shares of bending and torsion. Forces set
by O.forces.setPermF are felt and not listed: YADE does not say whether there are any. Before the first step, and where
nothing is known, nothing is claimed: an effect is idle only by a number.
"""
import math
import textwrap
from dataclasses import asdict, dataclass, field

import numpy as np

from yade import (
	BondedMat, BondedPhys, DeformableEngine, DeformableTriangle, ElasticWallMat, InsertionSortCollider,
	InteractionLoop, KinematicEngine, Law2_ScGeom_BondedPhys_MohrCoulomb, Matrix3, NewtonIntegrator, O, Sphere,
	Vector3, ViscousBodyDamping
)

from .energy import EXTERNAL

NOTHING = 1e-3  #: an effect whose measured bound is not above this changed nothing [-]

_WIDTH = 120  # of the table
_LOCALISED = 0.5  # Ω_D from which the crack band acts, as in ConcreteParameters.hpp
_NOT_TIMED = "not measured: O.timingEnabled = True before the run"
_NOT_BOOKED = "not measured: O.trackEnergy = True before the run"

#: parameters that an effect of a law has to itself; the first is what asks for it
_PARAMETERS = {
	"viscoplasticFlow": (
		"strength", "flowFactor", "flowExponent", "friction", "frictionPressure", "frictionPressureExponent",
		"sharingTolerance"
	),
	"rateDependence": ("rateExponent", "referenceRate"),
	"damage": ("fractureEnergy", "damageExponent", "damageLimit", "closedGrowth", "closedEffect", "closureBand"),
	"equationOfState": ("eosPressure", "eosExponent"),
}
_UNITS = {"strength": "Pa", "fractureEnergy": "J/m³", "eosPressure": "Pa"}
#: fields of a law's state by the effect that needs them; the first that is on pays for a field
_FIELDS = (
	("viscoplasticFlow", ("strain", "plasticStrain")),
	("damage", ("strain", "plasticStrain", "damageTensor", "closure")),
	("equationOfState", ("stiffening", )),
)
#: fields that only the energy book has
_BOOK = {"strain", "lastStrain", "lastStress", "plasticDissipation", "damageDissipation", "stiffeningEnergy"}
#: engines that add no forces to triangles, as in EngineOrder.cpp
_QUIET = {
	"ForceResetter", "NewtonIntegrator", "InsertionSortCollider", "InteractionLoop", "BondedInteractionLoop",
	"ViscousBodyDamping", "GlobalStiffnessTimeStepper", "DeformableTimeStepper", "DeformableEngine"
}


@dataclass
class Effect:
	"""A line of the table."""
	name: str  #: as the switch or setting is called, where there is one
	runs: bool  #: whether it is evaluated
	why: str  #: parameter or setting that asked for it, or why it is off
	bytes: int = 0  #: of state that it takes per particle, 0 where it is off
	measured: str = ""  #: what it did, in words
	bound: float = None  #: of the relative change it made [-], None where it is not known

	@property
	def changed(self):
		"""Whether it changed anything: False where it is off or idle, None where that is not known."""
		if not self.runs:
			return False
		return None if self.bound is None else self.bound > NOTHING

	@property
	def state(self):
		"""'on', 'off' or 'idle' (on, and changed nothing)."""
		return "off" if not self.runs else "idle" if self.changed is False else "on"


@dataclass
class Group:
	"""Effects of particles that share them: of an engine, of a group of triangles, of bonded spheres."""
	name: str
	particle: str  #: "triangle" or "bond"
	count: int  #: of particles
	bytes: int = 0  #: of state per particle
	cost: str = ""  #: in words, with the ns per particle and step where they were measured
	ns: float = None  #: of the engine per particle and step, None where not measured [ns]
	effects: list = field(default_factory=list)  #: of :class:`Effect`

	def __getitem__(self, name):
		"""The effect of that name."""
		for effect in self.effects:
			if effect.name == name:
				return effect
		raise KeyError(
			f"'{name}' is no effect of {self.name}; there are {', '.join(e.name for e in self.effects)}"
		)

	def __contains__(self, name):
		return any(effect.name == name for effect in self.effects)

	def add(self, *values, **more):
		"""Append an :class:`Effect`."""
		self.effects.append(Effect(*values, **more))


class EffectTable:
	"""What :func:`effects` returns; ``print`` shows it, :meth:`rows` gives it as plain data."""

	def __init__(self, groups):
		self.groups = groups  #: list of :class:`Group`

	def __len__(self):
		return len(self.groups)

	def __iter__(self):
		return iter(self.groups)

	def __getitem__(self, name):
		"""The group of that name, or the first whose name has it as a part."""
		for group in self.groups:
			if name == group.name:
				return group
		for group in self.groups:
			if name in group.name:
				return group
		raise KeyError(
			f"'{name}' is no group of this scene; there are "
			f"{', '.join(g.name for g in self.groups) or 'none'}"
		)

	def rows(self):
		"""A dict an effect: group, particle, count, group_bytes, cost, ns_per_particle_step, effect, state
		("on", "off", "idle"), runs, changed (None: not known), why, bytes, measured, bound. Plain
		values for JSON.
		"""
		rows = []
		for group in self.groups:
			shared = {
				"group": group.name, "particle": group.particle, "count": group.count,
				"group_bytes": group.bytes, "cost": group.cost, "ns_per_particle_step": group.ns
			}
			for effect in group.effects:
				plain = asdict(effect)
				plain["effect"] = plain.pop("name")
				bound = plain["bound"]
				plain["bound"] = float(bound) if bound is not None and math.isfinite(bound) else None
				changed = effect.changed
				plain["changed"] = None if changed is None else bool(changed)
				rows.append({**shared, **plain, "state": effect.state})
		return rows

	def __str__(self):
		if not self.groups:
			return "no effects: the scene has neither deformable triangles nor bonded spheres"
		widths = [max(len(e.name) for g in self.groups for e in g.effects), 4, 6]
		margin = " " * (2 + sum(widths) + 2 * len(widths))
		blocks = []
		for group in self.groups:
			count = f"{group.count:,d}".replace(",", "\u202f")
			head = f"{group.name}: {count} {group.particle}{'' if group.count == 1 else 's'}"
			head += f", {group.bytes} bytes of state each" if group.bytes else ""
			lines = [head]
			if group.cost:
				lines += textwrap.wrap(
					group.cost, _WIDTH, initial_indent="  cost: ", subsequent_indent="        "
				)
			for e in group.effects:
				taken = f"{e.bytes} B" if e.bytes else ""
				start = f"  {e.name:<{widths[0]}}  {e.state:<{widths[1]}}  {taken:>{widths[2]}}  "
				lines += textwrap.wrap(e.why, _WIDTH, initial_indent=start, subsequent_indent=margin)
				if e.measured:
					said = e.measured + (": changed nothing" if e.state == "idle" else "")
					lines += textwrap.wrap(
						said, _WIDTH, initial_indent=margin + "→ ",
						subsequent_indent=margin + "  "
					)
			blocks.append("\n".join(lines))
		return "\n\n".join(blocks)

	__repr__ = __str__


def effects():
	"""The table of effects of the present scene, as an :class:`EffectTable`: print it.

	Before O.engines is set it says what would run by the materials; before the first step what runs, why and how
	many bytes it takes; after a run also what it cost (where O.timingEnabled was on) and which effects changed
	nothing. Reads the whole sample once: call it at the end, not in every step.
	"""
	return EffectTable([*_triangles(), *_bonded()])


# ---- deformable triangles ----


def _triangles():
	if not any(b and isinstance(b.shape, DeformableTriangle) for b in O.bodies):
		return []
	engines = [e for e in O.engines if isinstance(e, DeformableEngine)]
	if not engines:
		return _by_materials()
	groups = []
	for engine in engines:
		groups += _of_engine(engine, len(engines) > 1)
	return groups


def _by_materials():
	"""What would run: groups by material, without an engine."""
	found = {}
	for b in O.bodies:
		if b and isinstance(b.shape, DeformableTriangle):
			found.setdefault((b.mat.id, b.mat.label, b.shape.thickness), []).append(b)
	groups = []
	for bodies in found.values():
		material, told = bodies[0].mat, bodies[0].mat.effects(O.trackEnergy)
		name = f"{_named(material)}, no DeformableEngine in O.engines yet"
		group = Group(name, "triangle", len(bodies), told["bytes"])
		_law(group, material, told, _Shapes(bodies), None)
		groups.append(group)
	return groups


def _of_engine(engine, several):
	ids, groups = engine.values("triangleIds"), engine.groups()
	name = "DeformableEngine" + (f" '{engine.label}'" if engine.label else "")
	if several and not engine.label:
		name += f" (groupMask {engine.groupMask})"
	ns, cost = _cost([engine], len(ids), "triangle")
	state = _State(engine)
	whole = Group(name, "triangle", len(ids), 0, cost, ns)
	materials = [O.bodies[int(ids[told["first"]])].mat for told in groups]
	_rotation(whole, engine, materials, state)
	_gravity(whole, engine, materials, state)
	damping = engine.damping
	newton = next((e for e in O.engines if isinstance(e, NewtonIntegrator)), None)
	if damping > 0:
		whole.add("damping", True, f"DeformableEngine.damping = {damping:g}", 0, *_share("nonviscDamp"))
	else:
		also = ""
		if newton and newton.damping:
			also = f"; NewtonIntegrator.damping = {newton.damping:g} acts on other bodies only"
		whole.add("damping", False, f"DeformableEngine.damping = {damping:g}: none{also}")
	_forces(whole, engine)
	book = O.trackEnergy
	whole.add("energy book", book, f"O.trackEnergy = {book}", 0)
	made = [whole]
	for material, told in zip(materials, groups):
		rows = slice(told["first"], told["first"] + told["count"])
		title = f"{_named(material)}" + (f" of {name}" if several else "")
		if sum(other is material or other.id == material.id for other in materials) > 1:
			title += f", {told['thickness']:g} m thick"
		group = Group(title, "triangle", told["count"], told["bytes"], f"in that of {name}" if ns else "", ns)
		told = {**told, "fields": [entry for entry in engine.fields() if entry[0] in told["fields"]]}
		_law(group, material, told, _Shapes([O.bodies[i] for i in ids[rows].tolist()]), state.of(rows))
		if engine.flowInterval > 1 and "viscoplasticFlow" in told["effects"]:
			waits = f"; solved every {engine.flowInterval} steps: flowInterval of {name}"
			group["viscoplasticFlow"].why += waits
		made.append(group)
	return made


class _State:
	"""What the triangles have gone through: largest values, of all or of some rows."""

	def __init__(self, engine, rows=slice(None), arrays=None):
		self.engine, self.rows = engine, rows
		self._known = {} if arrays is None else arrays  # of the whole engine, shared between groups

	def of(self, rows):
		return _State(self.engine, rows, self._known)

	def values(self, name):
		if name not in self._known:
			self._known[name] = self.engine.values(name)
		return self._known[name][self.rows]

	def largest(self, name):
		values = self.values(name)
		return float((_norm(values) if values.ndim == 3 else np.abs(values)).max())

	@property
	def elastic(self):
		"""Largest elastic strain, the norm of its tensor [-]."""
		return float(_norm(self.values("strain") - self.values("plasticStrain")).max())


def _norm(tensors):
	"""√(t:t) of tensors (…, 4): xx, yy, zz, xy."""
	return np.sqrt((tensors[..., :3]**2).sum(axis=-1) + 2 * tensors[..., 3]**2)


def _elastic_stress(material, strains):
	"""Stress of an undamaged material under strains (…, 4), in the same components [Pa]."""
	stress = 2 * material.shear * strains
	stress[..., :3] += (material.bulk - 2 / 3 * material.shear) * strains[..., :3].sum(axis=-1, keepdims=True)
	return stress


class _Shapes:
	"""What the shapes of triangles say beside their material."""

	def __init__(self, bodies):
		shapes = [body.shape for body in bodies]
		self.count = len(shapes)
		energies = np.array([shape.fractureEnergy for shape in shapes])
		self.energies = energies[energies > 0]
		self.bands = np.array([shape.bandFactor for shape in shapes])
		self.damaged = sum(shape.initialDamage != Matrix3.Zero for shape in shapes)
		# one value for all takes no room for each
		self.bytes = {
			"fracture energies": 8 * int((energies != energies[0]).any()),
			"crack band": 8 * int((self.bands != self.bands[0]).any())
		}


def _law(group, material, told, shapes, state):
	"""Lines of a law: itself, its effects, what triangles have of their own, and the book.

	:param told: of the engine's group or of the material: effects, fields
	:param state: None where there is no engine
	"""
	on = set(told["effects"])
	switches = [name for name, value in material.dict().items() if isinstance(value, bool)]
	bytes_of = {name: 24 * components for name, _, components in told["fields"]}
	paid = {}
	for effect, names in _FIELDS:
		if effect in on:
			paid[effect] = sum(bytes_of.pop(name, 0) for name in names)
	book = sum(bytes_of.pop(name) for name in list(bytes_of) if name in _BOOK)
	measures = _measures(material, told, state)

	law = Effect("law", True, f"{told['law']}, the law of {_named(material)}")
	if told["law"] == "Elastic" and switches:
		law.why = f"Elastic: no effect of {_named(material)} is on"
	elif told["law"] != "Elastic" and not switches and measures:
		known = [measures[name] for name in ("viscoplasticFlow", "damage") if name in measures]
		law.measured, law.bound = "; ".join(text for text, _ in known), max(bound for _, bound in known)
	group.effects.append(law)
	for effect in switches:
		if effect in on:
			says, bound = measures.get(effect, ("", None))
			group.add(effect, True, _asked(material, effect), paid.get(effect, 0), says, bound)
		else:
			group.add(effect, False, _not_asked(material, effect, switches))
	if "damage" in on and "viscoplasticFlow" not in on and "viscoplasticFlow" in switches and not shapes.damaged:
		vain = "; without viscoplasticFlow it cannot grow, and no triangle has initialDamage"
		group["damage"].why += f"{vain}: damage = False saves it"
	if "damage" in on and getattr(material, "damageLimit", 1) == 0:
		group["damage"].why += "; damageLimit = 0: it takes no stiffness"
	_own(group, material, on, switches, shapes, measures)
	if O.trackEnergy:
		group.add("energy book", True, "O.trackEnergy = True", book)
	else:
		stays = ": its fields stay, from when it was on" if book else ""
		group.add("energy book", False, f"O.trackEnergy = False{stays}", book)
	if state is None:  # the material knows nothing of what its triangles have of their own
		group.bytes += sum(group[name].bytes for name in shapes.bytes if name in group)
	law.bytes = group.bytes - sum(effect.bytes for effect in group.effects)  # what no effect has to itself


def _measures(material, told, state):
	"""Text and bound of each effect that can be measured, by its name; empty before there is a state."""
	if state is None or not O.iter or told["law"] == "Elastic":
		return {}
	names = {name for name, _, _ in told["fields"]}
	found = {}
	if "plasticStrain" in names:
		plastic, stress = state.largest("plasticStrain"), state.largest("stress")
		relaxed = float(_norm(_elastic_stress(material, state.values("plasticStrain"))).max())
		bound = relaxed / stress if stress > 0 else math.inf if plastic > 0 else 0.0
		text = "no plastic strain"
		if plastic:
			text = f"largest plastic strain {plastic:.2g}, which takes {bound:.2g} of the largest stress"
		found["viscoplasticFlow"] = text, bound
		# a rate acts by the flow; how much of that is the rate's is kept nowhere
		found["rateDependence"] = (text, bound) if bound <= NOTHING else (f"acts with the flow: {text}", None)
	damage = state.largest("damage")
	if "plasticStrain" not in names or damage > 0 or hasattr(material, "fractureEnergy"):
		found["damage"] = f"largest damage {damage:.2g}" if damage else "no damage", damage
	if "stiffening" in names:
		stiffening = state.largest("stiffening")
		found["equationOfState"] = f"largest stiffening now {stiffening:.2g}", stiffening
	return found


def _asked(material, effect):
	"""The parameter that asks for an effect that is on."""
	first = next(iter(_PARAMETERS.get(effect, ())), None)
	if first is None:
		return f"{effect} = True of {_named(material)}"
	unit = _UNITS.get(first, "")
	value = f"{getattr(material, first):g}" + (f" {unit}" if unit else "")
	return f"{first} = {value} of {_named(material)}, {effect} = True"


def _not_asked(material, effect, switches):
	"""Why an effect is off."""
	if getattr(material, effect):
		if effect == "rateDependence" and "viscoplasticFlow" in switches and not material.viscoplasticFlow:
			why = f"viscoplasticFlow = False of {_named(material)}: "
			why += "without flow there is nothing that a rate could change"
		elif effect == "rateDependence" and material.rateExponent == 1:
			why = f"rateExponent = 1 of {_named(material)} makes it none"
		else:
			why = f"{_named(material)} has no use for it with these parameters"
	else:
		why = f"{effect} = False of {_named(material)}"
	standard = type(material)()
	changed = [name for name in _PARAMETERS.get(effect, ()) if getattr(material, name) != getattr(standard, name)]
	vain = [text for text in (f"{name} = {getattr(material, name):g}" for name in changed) if text not in why]
	return why + (f"; {', '.join(vain)} {'has' if len(vain) == 1 else 'have'} no effect" if vain else "")


def _own(group, material, on, switches, shapes, measures):
	"""What triangles have of their own: fracture energies, a crack band, damage at the start."""
	grows = {"viscoplasticFlow", "damage"} <= on if "damage" in switches else hasattr(material, "fractureEnergy")
	lacks = [name for name in ("viscoplasticFlow", "damage") if name in switches and name not in on]
	why_not = f"{_named(material)} has no fracture energy"
	if lacks:
		why_not = " and ".join(f"{name} = False" for name in lacks) + f" of {_named(material)}"
	damage = measures.get("damage", ("", None))
	if len(shapes.energies):
		low, high = shapes.energies.min(), shapes.energies.max()
		said = f"DeformableTriangle.fractureEnergy of {len(shapes.energies)} of {shapes.count} triangles, "
		said += f"{low:.3g} to {high:.3g}"
		if grows:
			group.add("fracture energies", True, said, shapes.bytes["fracture energies"], *damage)
		else:
			group.add("fracture energies", False, f"{said}, without effect: {why_not}")
	elif hasattr(material, "fractureEnergy"):
		group.add("fracture energies", False, "all triangles have the material's: ddem.append(seed=None)")
	if (shapes.bands != 1).any():
		low, high = f"{shapes.bands.min():.3g}", f"{shapes.bands.max():.3g}"
		factors = low if low == high else f"{low} to {high}"
		said = f"ddem.append(crack_band=…): fracture energies times {factors}"
		if grows and "damage" in switches:
			says, bound = damage
			if bound is not None:
				left = 1 / (1 + _LOCALISED**material.damageExponent)
				first = 1 - (material.residual + (1 - material.residual) * left)
				says, bound = f"{says}; it acts from {first:.2g} on", 0.0 if bound < first else bound
			group.add("crack band", True, said, shapes.bytes["crack band"], says, bound)
		else:
			group.add("crack band", False, f"{said}, without effect: {why_not}")
	elif "damage" in switches:
		group.add("crack band", False, "ddem.append(crack_band=None): the fracture energy is per volume")
	if shapes.damaged:
		said = f"DeformableTriangle.initialDamage of {shapes.damaged} triangles"
		if "damage" in on:
			group.add("damage at the start", True, said, 0, *damage)
		else:
			named = _named(material)
			reason = f"damage = False of {named}" if "damage" in switches else f"{named} has no damage"
			group.add("damage at the start", False, f"{said}, without effect: {reason}")


def _rotation(whole, engine, materials, state):
	label = f"rotation = '{engine.rotation}' of DeformableEngine"
	tied = sorted({(material.rotationStiffness, _named(material)) for material in materials}, key=str)
	stiffness = ", ".join(f"{value:g} of {name}" for value, name in tied)
	if engine.rotation == "none":
		whole.add("rotation", False, f"{label}: rotations are small")
		whole.add(
			"rotation stiffness", False,
			f"{label}: cores do not rotate; rotationStiffness = {stiffness} has no effect"
		)
		return
	whole.add("rotation", True, label)
	if O.iter:
		turned, strain = state.largest("rotation"), state.elastic
		second = turned**2 / (2 * strain) if strain > 0 else math.inf
		whole["rotation"].bound = 2 * turned + second if turned else 0.0
		whole["rotation"].measured = f"largest rotation now {turned:.2g} rad"
	if engine.rotation == "corotational":
		whole.add(
			"rotation stiffness", False,
			f"{label}: cores have no spin; rotationStiffness = {stiffness} has no effect"
		)
		return
	if all(value == 0 for value, _ in tied):
		whole.add("rotation stiffness", False, f"rotationStiffness = {stiffness}: cores turn freely")
		return
	says, share = _share("elastRotation", of=("elastPotential", "elastRotation")) or ("", None)
	small = share is not None and share <= NOTHING
	if small:
		says += ", so that 'corotational' would give the same"
	# never idle: it is what ties cores to their triangles, and without it they turn freely
	whole.add("rotation stiffness", True, f"{label}, rotationStiffness = {stiffness}", 0, says)
	if whole["rotation"].changed is False and not small:
		whole["rotation"].bound = share
		whole["rotation"].measured += f"; moments of cores: {says}"


def _gravity(whole, engine, materials, state):
	felt, source = engine.gravity, "DeformableEngine.gravity"
	if felt == Vector3.Zero:
		for newton in O.engines:
			if isinstance(newton, NewtonIntegrator) and not newton.dead and newton.gravity != Vector3.Zero:
				felt, source = newton.gravity, "NewtonIntegrator.gravity"
	size = math.hypot(felt[0], felt[1])
	vain = f"; the z component, {felt[2]:g} m/s², has no effect in plane strain" if felt[2] else ""
	said = f"{source} = ({felt[0]:g}, {felt[1]:g}, {felt[2]:g}) m/s²{vain}"
	if not size:
		whole.add("gravity", False, said)
		return
	nodes = engine.array("nodePosition")
	along = nodes @ (np.array([felt[0], felt[1]]) / size)
	weight = max(material.density for material in materials) * size * float(np.ptp(along))
	if not O.iter:
		whole.add("gravity", True, said)
		return
	stress = float(np.abs(state.values("stress")).max())
	speed = float(np.hypot(*engine.array("nodeVelocity").T).max())
	parts = (weight / stress if stress else math.inf, size * O.time / speed if speed else math.inf)
	text = f"weight {weight:.2g} Pa of {stress:.2g} Pa, speed {size * O.time:.2g} m/s of {speed:.2g} m/s"
	whole.add("gravity", True, said, 0, text, max(parts))


def _forces(whole, engine):
	order = list(O.engines)
	# each has a bit of its own
	mine = next(
		i for i, e in enumerate(order) if isinstance(e, DeformableEngine) and e.groupMask == engine.groupMask
	)
	names = [
		e.label or type(e).__name__ for e in order[:mine]
		if type(e).__name__ not in _QUIET and not isinstance(e, KinematicEngine) and not e.dead
	]
	said = "no engine before DeformableEngine adds any"
	if names:
		said = f"{', '.join(names)} before DeformableEngine may add forces"
	whole.add("forces of other engines", bool(names), said)


# ---- bonded spheres ----


def _bonded():
	spheres = [b for b in O.bodies if b and isinstance(b.shape, Sphere) and isinstance(b.mat, BondedMat)]
	if not spheres:
		return []
	materials = list({b.mat.id: b.mat for b in spheres}.values())
	loop = next((e for e in O.engines if isinstance(e, InteractionLoop)), None)
	functors = loop.lawDispatcher.functors if loop else []
	law = next((f for f in functors if isinstance(f, Law2_ScGeom_BondedPhys_MohrCoulomb)), None)
	pairs = [i for i in O.interactions.all() if isinstance(i.phys, BondedPhys)]
	held = sum(i.phys.bonded for i in pairs)
	contacts = sum(not i.phys.bonded and i.isReal for i in pairs)
	broken = law.brokenBonds() if law else []
	bonds = held + len(broken)
	name = "bonded spheres" if law else "bonded spheres, no InteractionLoop with their law in O.engines yet"
	movers = [e for e in O.engines if isinstance(e, (NewtonIntegrator, ViscousBodyDamping, InsertionSortCollider))]
	ns, cost = _cost([loop] if loop else [], max(held + contacts, 1), "bond")
	if ns:
		each = {e.label or type(e).__name__: _cost([e], len(spheres), "sphere")[0] for e in movers}
		parts = ", ".join(f"{label} {time:.3g} ns" for label, time in each.items() if time)
		cost += f"; per sphere and step: {parts}" if parts else ""
	group = Group(name, "bond", bonds, Law2_ScGeom_BondedPhys_MohrCoulomb.bytesPerBond(), cost, ns)
	_bond(group, materials, law, held, broken)
	_contacts(group, materials, law, contacts, broken)
	damping = [e for e in movers if isinstance(e, ViscousBodyDamping) and not e.dead]
	if damping and (damping[0].viscosity or damping[0].rotationalViscosity):
		said = f"viscosity = {damping[0].viscosity:g} /s, "
		said += f"rotationalViscosity = {damping[0].rotationalViscosity:g} /s of ViscousBodyDamping"
		group.add("body damping", True, said, 0, *_share("bodyDamping"))
	else:
		why = "viscosity = 0 of ViscousBodyDamping" if damping else "no ViscousBodyDamping in O.engines"
		group.add("body damping", False, why)
	newton = next((e for e in movers if isinstance(e, NewtonIntegrator)), None)
	local, pull = (newton.damping, newton.gravity) if newton else (0, Vector3.Zero)
	no_newton = "" if newton else "no NewtonIntegrator in O.engines"
	group.add(
		"local damping", bool(local), no_newton or f"NewtonIntegrator.damping = {local:g}", 0,
		*(_share("nonviscDamp") if local else ())
	)
	weighs = pull != Vector3.Zero
	said = no_newton or f"NewtonIntegrator.gravity = ({pull[0]:g}, {pull[1]:g}, {pull[2]:g}) m/s²"
	group.add("gravity", weighs, said, 0, *(_share("gravWork") if weighs else ()))
	group.add("energy book", O.trackEnergy, f"O.trackEnergy = {O.trackEnergy}")
	return [group]


def _bond(group, materials, law, held, broken):
	"""The bond's loads and its failure."""
	group.add("tension and compression", True, "part of every bond, EA/d0: " + _values(materials, "young", "Pa"))
	moved = O.iter > 0 and law is not None
	stresses = law.largestStresses() if moved and held else {}
	largest = max(stresses.values(), default=0)
	stiffness = {"shear": "GA/d0", "bending": "EI/d0", "torsion": "GJ/d0"}
	if law and law.convention == "esys":
		stiffness["bending"] = "half of EI/d0, as in ESyS-Particle"
	for part, text in stiffness.items():
		says, bound = "", None
		if largest:
			bound = stresses[part] / largest
			says = f"largest {part} stress of a bond {stresses[part]:.2g} Pa, "
			says += f"{bound:.2g} of the largest of all parts"
		group.add(part, True, f"part of every bond, {text}", 0, says, bound)
	cut = [m for m in materials if m.tensileStrength < _apex(m)]
	modes = [b.mode for b in broken]
	said = "no bond broken"
	if broken:
		said = f"{modes.count('tension')} bonds broken in tension, {modes.count('shear')} in shear"
	angle = _values(materials, "bondFrictionAngle", "rad")
	why = f"Mohr-Coulomb, {_values(materials, 'cohesion', 'Pa')}, {angle}"
	# a single bond may decide: no share is small
	group.add("failure criterion", True, why, 0, *((said, 1.0 if broken else 0.0) if moved else ()))
	if cut:
		torn = sum(b.mode == "tension" for b in broken)
		measured = (f"{torn} bonds broken in tension", None) if torn else ("no bond broken in tension", 0.0)
		why = _values(cut, "tensileStrength", "Pa")
		group.add("tension cut-off", True, why, 0, *(measured if moved else ()))
	else:
		apex = min(_apex(m) for m in materials)
		said = _values(materials, "tensileStrength", "Pa")
		said += f", not below C/tan φ = {apex:.3g} Pa, has no effect"
		group.add("tension cut-off", False, said)
	convention = law.convention if law else "consistent"
	group.add(
		"convention of ESyS-Particle", convention == "esys",
		f"convention = '{convention}' of Law2_ScGeom_BondedPhys_MohrCoulomb"
	)


def _contacts(group, materials, law, contacts, broken):
	collider = any(isinstance(e, InsertionSortCollider) and not e.dead for e in O.engines)
	moved = O.iter > 0 and law is not None
	idle = moved and not contacts and not broken
	says = f"{contacts} contacts now" if moved else ""
	measured = (says, 0.0 if idle else None) if moved else ()
	esys = law is not None and law.convention == "esys"
	if collider:
		group.add("contact", True, "InsertionSortCollider in O.engines finds pairs that touch", 0, *measured)
	else:
		said = "O.engines has no InsertionSortCollider: new pairs are not found, "
		said += "only what is left of broken bonds acts"
		group.add("contact", bool(broken), said, 0, *measured)
	if any(m.frictionStatic or m.frictionDynamic for m in materials):
		said = f"{_values(materials, 'frictionStatic')}, {_values(materials, 'frictionDynamic')}"
		group.add("friction", True, said, 0, *(measured if idle else _share("friction")))
	else:
		group.add("friction", False, "frictionStatic = frictionDynamic = 0 of BondedMat")
	for name, what in (
		("gradualFriction", "gradual friction"), ("normalDamping", "normal contact damping"),
		("shearDamping", "tangential contact damping")
	):
		asks = [m for m in materials if getattr(m, name)]
		if asks and esys:
			group.add(what, False, f"{_values(asks, name)} has no effect: convention = 'esys' has none")
		elif asks:
			share = () if name == "gradualFriction" else _share("contactDamping")
			group.add(what, True, _values(asks, name), 0, *(measured if idle or not share else share))
		else:
			group.add(what, False, _values(materials, name))
	walls = {b.mat.id: b.mat for b in O.bodies if b and isinstance(b.mat, ElasticWallMat)}
	if walls:
		grip = [m for m in walls.values() if m.shearStiffness]
		stiffness = f"{grip[0].shearStiffness:g} Pa" if grip else "0"
		said = f"shearStiffness = {stiffness} of ElasticWallMat"
		group.add("shear of walls", bool(grip), said)


def _apex(material):
	"""Tension limit of Mohr and Coulomb, C/tan φ [Pa]."""
	slope = math.tan(material.bondFrictionAngle)
	return material.cohesion / slope if slope > 0 else math.inf


# ---- both ----


def _named(material):
	return f"{type(material).__name__} '{material.label}'" if material.label else type(material).__name__


def _values(materials, name, unit=""):
	"""name = value of material, …"""
	values = {}
	for material in materials:
		values.setdefault(getattr(material, name), []).append(_named(material))
	form = "{}" if isinstance(next(iter(values)), bool) else "{:g} " + unit
	shown = (f"{form.format(value).strip()} of {', '.join(names)}" for value, names in values.items())
	return f"{name} = {', '.join(shown)}"


def _cost(engines, particles, particle):
	"""ns per particle and step, and the same in words."""
	timed = [e for e in engines if e.execCount and e.execTime]
	if not timed or not particles:
		return None, _NOT_TIMED
	ns = float(sum(e.execTime / e.execCount for e in timed)) / particles
	return ns, f"{ns:.3g} ns per {particle} and step, the engine as a whole"


def _share(entry, of=None):
	"""What an entry of the energy book has of what went through it, in words and as a bound.

	:param of: entries that it is a share of; all where left out
	:returns: (text, share), nothing before the first step
	"""
	if not O.iter:
		return ()
	book = dict(O.energy.items()) if O.trackEnergy else {}
	if not book:
		return _NOT_BOOKED, None
	if of:
		through = sum(abs(book.get(name, 0.0)) for name in of)
	else:
		inner = sum(value for name, value in book.items() if name not in EXTERNAL)
		through = max(sum(abs(book.get(name, 0.0)) for name in EXTERNAL), inner)
	share = abs(book.get(entry, 0.0)) / through if through > 0 else 0.0
	return f"{entry} {book.get(entry, 0.0):.2g} J, {share:.2g} of the energy", share
