# GPL v2 or later, see LICENSE.
"""Effects of deformable triangles; see :mod:`effect_table`."""
import math

import numpy as np

from yade import DeformableEngine, DeformableTriangle, KinematicEngine, Matrix3, NewtonIntegrator, O, Vector3

from .effect_entries import NOTHING, Effect, Group, cost_of, name_of, share_of

_LOCALISED = 0.5  # Ω_D from which the crack band acts, as in ConcreteParameters.hpp

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
	"ForceResetter", "NewtonIntegrator", "BondedNewtonIntegrator", "InsertionSortCollider", "InteractionLoop",
	"BondedInteractionLoop", "ViscousBodyDamping", "GlobalStiffnessTimeStepper", "DeformableTimeStepper",
	"DeformableEngine", "EdgeTraction", "AbsorbingEdge", "ServoPlaten"
}


def groups_of_triangles():
	"""Groups of the present scene: of each engine, and of its materials; none where there are no triangles."""
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
		name = f"{name_of(material)}, no DeformableEngine in O.engines yet"
		group = Group(name, "triangle", len(bodies), told["bytes"])
		_law(group, material, told, _Shapes(bodies), None)
		groups.append(group)
	return groups


def _of_engine(engine, several):
	ids, groups = engine.values("triangleIds"), engine.groups()
	name = "DeformableEngine" + (f" '{engine.label}'" if engine.label else "")
	if several and not engine.label:
		name += f" (groupMask {engine.groupMask})"
	ns, cost = cost_of([engine], len(ids), "triangle")
	state = _State(engine)
	whole = Group(name, "triangle", len(ids), 0, cost, ns)
	materials = [O.bodies[int(ids[told["first"]])].mat for told in groups]
	_rotation(whole, engine, materials, state)
	_gravity(whole, engine, materials, state)
	damping = engine.damping
	newton = next((e for e in O.engines if isinstance(e, NewtonIntegrator)), None)
	if damping > 0:
		whole.add("damping", True, f"DeformableEngine.damping = {damping:g}", 0, *share_of("nonviscDamp"))
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
		title = f"{name_of(material)}" + (f" of {name}" if several else "")
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

	law = Effect("law", True, f"{told['law']}, the law of {name_of(material)}")
	if told["law"] == "Elastic" and switches:
		law.why = f"Elastic: no effect of {name_of(material)} is on"
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
		return f"{effect} = True of {name_of(material)}"
	unit = _UNITS.get(first, "")
	value = f"{getattr(material, first):g}" + (f" {unit}" if unit else "")
	return f"{first} = {value} of {name_of(material)}, {effect} = True"


def _not_asked(material, effect, switches):
	"""Why an effect is off."""
	if getattr(material, effect):
		if effect == "rateDependence" and "viscoplasticFlow" in switches and not material.viscoplasticFlow:
			why = f"viscoplasticFlow = False of {name_of(material)}: "
			why += "without flow there is nothing that a rate could change"
		elif effect == "rateDependence" and material.rateExponent == 1:
			why = f"rateExponent = 1 of {name_of(material)} makes it none"
		else:
			why = f"{name_of(material)} has no use for it with these parameters"
	else:
		why = f"{effect} = False of {name_of(material)}"
	standard = type(material)()
	changed = [name for name in _PARAMETERS.get(effect, ()) if getattr(material, name) != getattr(standard, name)]
	vain = [text for text in (f"{name} = {getattr(material, name):g}" for name in changed) if text not in why]
	return why + (f"; {', '.join(vain)} {'has' if len(vain) == 1 else 'have'} no effect" if vain else "")


def _own(group, material, on, switches, shapes, measures):
	"""What triangles have of their own: fracture energies, a crack band, damage at the start."""
	grows = {"viscoplasticFlow", "damage"} <= on if "damage" in switches else hasattr(material, "fractureEnergy")
	lacks = [name for name in ("viscoplasticFlow", "damage") if name in switches and name not in on]
	why_not = f"{name_of(material)} has no fracture energy"
	if lacks:
		why_not = " and ".join(f"{name} = False" for name in lacks) + f" of {name_of(material)}"
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
			named = name_of(material)
			reason = f"damage = False of {named}" if "damage" in switches else f"{named} has no damage"
			group.add("damage at the start", False, f"{said}, without effect: {reason}")


def _rotation(whole, engine, materials, state):
	label = f"rotation = '{engine.rotation}' of DeformableEngine"
	tied = sorted({(material.rotationStiffness, name_of(material)) for material in materials}, key=str)
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
	says, share = share_of("elastRotation", of=("elastPotential", "elastRotation")) or ("", None)
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
