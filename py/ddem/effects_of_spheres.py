# GPL v2 or later, see LICENSE.
"""Effects of bonded spheres; see :mod:`effect_table`."""
import math

from yade import (
	BondedMat, BondedPhys, ElasticWallMat, InsertionSortCollider, InteractionLoop, Law2_ScGeom_BondedPhys_Bonded,
	NewtonIntegrator, O, SofteningBondMat, Sphere, Vector3, ViscousBodyDamping
)

from .effect_entries import Group, cost_of, share_of, values_of


def groups_of_spheres():
	"""The group of the bonded spheres of the present scene; none where there are none."""
	spheres = [b for b in O.bodies if b and isinstance(b.shape, Sphere) and isinstance(b.mat, BondedMat)]
	if not spheres:
		return []
	materials = list({b.mat.id: b.mat for b in spheres}.values())
	loop = next((e for e in O.engines if isinstance(e, InteractionLoop)), None)
	functors = loop.lawDispatcher.functors if loop else []
	law = next((f for f in functors if isinstance(f, Law2_ScGeom_BondedPhys_Bonded)), None)
	pairs = [i for i in O.interactions.all() if isinstance(i.phys, BondedPhys)]
	held = sum(i.phys.bonded for i in pairs)
	contacts = sum(not i.phys.bonded and i.isReal for i in pairs)
	broken = law.brokenBonds() if law else []
	bonds = held + len(broken)
	name = "bonded spheres" if law else "bonded spheres, no InteractionLoop with their law in O.engines yet"
	movers = [e for e in O.engines if isinstance(e, (NewtonIntegrator, ViscousBodyDamping, InsertionSortCollider))]
	ns, cost = cost_of([loop] if loop else [], max(held + contacts, 1), "bond")
	if ns:
		each = {e.label or type(e).__name__: cost_of([e], len(spheres), "sphere")[0] for e in movers}
		parts = ", ".join(f"{label} {time:.3g} ns" for label, time in each.items() if time)
		cost += f"; per sphere and step: {parts}" if parts else ""
	group = Group(name, "bond", bonds, Law2_ScGeom_BondedPhys_Bonded.bytesPerBond(), cost, ns)
	_bond(group, materials, law, held, broken)
	_contacts(group, materials, law, contacts, broken)
	damping = [e for e in movers if isinstance(e, ViscousBodyDamping) and not e.dead]
	if damping and (damping[0].viscosity or damping[0].rotationalViscosity):
		said = f"viscosity = {damping[0].viscosity:g} /s, "
		said += f"rotationalViscosity = {damping[0].rotationalViscosity:g} /s of ViscousBodyDamping"
		group.add("body damping", True, said, 0, *share_of("bodyDamping"))
	else:
		why = "viscosity = 0 of ViscousBodyDamping" if damping else "no ViscousBodyDamping in O.engines"
		group.add("body damping", False, why)
	newton = next((e for e in movers if isinstance(e, NewtonIntegrator)), None)
	local, pull = (newton.damping, newton.gravity) if newton else (0, Vector3.Zero)
	no_newton = "" if newton else "no NewtonIntegrator in O.engines"
	group.add(
		"local damping", bool(local), no_newton or f"NewtonIntegrator.damping = {local:g}", 0,
		*(share_of("nonviscDamp") if local else ())
	)
	weighs = pull != Vector3.Zero
	said = no_newton or f"NewtonIntegrator.gravity = ({pull[0]:g}, {pull[1]:g}, {pull[2]:g}) m/s²"
	group.add("gravity", weighs, said, 0, *(share_of("gravWork") if weighs else ()))
	group.add("energy book", O.trackEnergy, f"O.trackEnergy = {O.trackEnergy}")
	return [group]


def _bond(group, materials, law, held, broken):
	"""The bond's loads and its failure."""
	group.add("tension and compression", True, "part of every bond, EA/d0: " + values_of(materials, "young", "Pa"))
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
	softening = [m for m in materials if isinstance(m, SofteningBondMat)]
	modes = [b.mode for b in broken]
	said = "no bond broken"
	if broken:
		said = f"{modes.count('tension')} bonds broken in tension, {modes.count('shear')} in shear"
	angle = values_of(materials, "bondFrictionAngle", "rad")
	names = ", ".join(sorted({m.criterion for m in materials}))
	why = f"{names}, {values_of(materials, 'cohesion', 'Pa')}, {angle}"
	# a single bond may decide: no share is small
	group.add("failure criterion", True, why, 0, *((said, 1.0 if broken else 0.0) if moved else ()))
	if cut:
		torn = sum(b.mode == "tension" for b in broken)
		measured = (f"{torn} bonds broken in tension", None) if torn else ("no bond broken in tension", 0.0)
		why = values_of(cut, "tensileStrength", "Pa")
		group.add("tension cut-off", True, why, 0, *(measured if moved else ()))
	else:
		apex = min(_apex(m) for m in materials)
		said = values_of(materials, "tensileStrength", "Pa")
		said += f", not below C/tan φ = {apex:.3g} Pa, has no effect"
		group.add("tension cut-off", False, said)
	if softening:
		why = values_of(softening, "tensionEnergy", "J/m²") + ", " + values_of(softening, "shearEnergy", "J/m²")
		group.add("softening of bonds", True, why, 0, *(share_of("bondSoftening") if moved else ()))
	else:
		group.add("softening of bonds", False, "no SofteningBondMat: bonds break at once")
	convention = law.convention if law else "consistent"
	group.add(
		"convention of ESyS-Particle", convention == "esys",
		f"convention = '{convention}' of Law2_ScGeom_BondedPhys_Bonded"
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
		said = f"{values_of(materials, 'frictionStatic')}, {values_of(materials, 'frictionDynamic')}"
		group.add("friction", True, said, 0, *(measured if idle else share_of("friction")))
	else:
		group.add("friction", False, "frictionStatic = frictionDynamic = 0 of BondedMat")
	for name, what in (
		("gradualFriction", "gradual friction"), ("normalDamping", "normal contact damping"),
		("shearDamping", "tangential contact damping")
	):
		asks = [m for m in materials if getattr(m, name)]
		if asks and esys:
			group.add(what, False, f"{values_of(asks, name)} has no effect: convention = 'esys' has none")
		elif asks:
			share = () if name == "gradualFriction" else share_of("contactDamping")
			group.add(what, True, values_of(asks, name), 0, *(measured if idle or not share else share))
		else:
			group.add(what, False, values_of(materials, name))
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
