# GPL v2 or later, see LICENSE.
"""ddem.effects(): each line says what runs and why, what it takes, and whether it changed anything."""
import itertools
import json
import math

import numpy as np
import pytest
from deformable_samples import bodies, elastic, start, steps

from yade import (
	BondedMat, ConcreteDamageMat, DeformableEngine, ForceEngine, ForceResetter, Matrix3, NewtonIntegrator, O,
	Quaternion,
	ScalarDamageMat, Vector3, VonMisesMat, ddem
)
from yade.ddem import bonded, packing
from yade.ddem.effect_entries import NOTHING
from yade.ddem.reports.uniaxial import Report
from yade.ddem.studies import uniaxial

SWITCHES = ("viscoplasticFlow", "rateDependence", "damage", "equationOfState")
#: numbers of a sub-element that each effect of concrete needs, from the fields in ConcreteDamage.hpp: strain and
#: plastic strain (3 + 4) for flow and for damage alike, damage and closure (4 + 1), stiffening (1)
SHARED, NUMBERS = 7, {"damage": 5, "equationOfState": 1}
BAR = ddem.mesh.box(0.01, 0.01, 0.02, 0.03)


def concrete(label="concrete", **changes):
	material = ConcreteDamageMat(label=label, **changes)
	O.materials.append(material)
	return material


def block(material="concrete", regions=None, **options):
	mesh = ddem.mesh.rectangle(0.03, 0.04, size=0.01, regions=regions or {})
	return ddem.append(mesh, material, **options)


def stretched(sample, engine, strain):
	"""The sample under a homogeneous vertical strain, reached at once and held for a step."""
	for body in bodies([*sample.node_ids, *sample.triangle_ids]):
		body.state.pos = (body.state.refPos[0], body.state.refPos[1] * (1 + strain), 0)
	steps(1)
	return ddem.effects()[engine]


def states(group):
	return {effect.name: effect.state for effect in group.effects}


# ---- what runs, and why ----


def test_every_line_of_concrete_beside_steel():
	concrete(rateDependence=False, rateExponent=0.9)
	elastic("steel")
	block({"": "concrete", "bar": "steel"}, {"bar": BAR}, seed=1, crack_band=0.01)
	start(damping=0.1, gravity=Vector3(0, -9.81, 0))
	table = ddem.effects()
	whole, first, second = table
	assert [group.name for group in table] == [
		"DeformableEngine", "ConcreteDamageMat 'concrete'", "DeformableElastMat 'steel'"
	]
	assert whole.count == first.count + second.count and second.count == 1 * 2 * 4  # cells of four
	assert states(whole) == {
		"rotation": "on", "rotation stiffness": "on", "gravity": "on", "damping": "on",
		"forces of other engines": "off", "energy book": "off"
	}
	assert states(first) == {
		"law": "on", "viscoplasticFlow": "on", "rateDependence": "off", "damage": "on", "equationOfState": "on",
		"fracture energies": "on", "crack band": "on", "energy book": "off"
	}
	assert states(second) == {"law": "on", "crack band": "off", "energy book": "off"}
	assert second["crack band"].why.endswith("without effect: DeformableElastMat 'steel' has no fracture energy")
	why = {effect.name: effect.why for group in (whole, first) for effect in group.effects}
	assert why["rotation"] == "rotation = 'cosserat' of DeformableEngine"
	assert "rotationStiffness = 2 of" in why["rotation stiffness"]
	assert why["gravity"] == "DeformableEngine.gravity = (0, -9.81, 0) m/s²"
	assert why["damping"] == "DeformableEngine.damping = 0.1"
	named = "of ConcreteDamageMat 'concrete'"
	assert why["viscoplasticFlow"] == f"strength = 1.4e+08 Pa {named}, viscoplasticFlow = True"
	assert why["rateDependence"] == f"rateDependence = False {named}; rateExponent = 0.9 has no effect"
	assert why["damage"] == f"fractureEnergy = 80000 J/m³ {named}, damage = True"
	assert why["equationOfState"] == f"eosPressure = 1.1e+09 Pa {named}, equationOfState = True"
	assert f"of {first.count} of {first.count} triangles" in why["fracture energies"]
	assert second["law"].why == "Elastic, the law of DeformableElastMat 'steel'" and second.bytes == 0


@pytest.mark.parametrize("changes, why", [
	({"rateExponent": 1}, "rateExponent = 1 of ConcreteDamageMat 'concrete' makes it none"),
	(
		{"viscoplasticFlow": False},
		"viscoplasticFlow = False of ConcreteDamageMat 'concrete': "
		"without flow there is nothing that a rate could change"
	),
	({"rateDependence": False}, "rateDependence = False of ConcreteDamageMat 'concrete'"),
])
def test_rate_that_does_not_run_says_why(changes, why):
	concrete(**changes)
	block()
	start()
	rate = ddem.effects()["concrete"]["rateDependence"]
	assert (rate.state, rate.why, rate.bytes) == ("off", why, 0)
	assert ddem.effects()["concrete"].bytes == ConcreteDamageMat(**changes).effects()["bytes"]


@pytest.mark.parametrize("changes, effect, vain", [
	({"equationOfState": False, "eosPressure": 2e9}, "equationOfState", "eosPressure = 2e+09 has no effect"),
	(
		{"damage": False, "fractureEnergy": 9e3, "damageExponent": 3}, "damage",
		"fractureEnergy = 9000, damageExponent = 3 have no effect"
	),
	({"viscoplasticFlow": False, "strength": 1e8}, "viscoplasticFlow", "strength = 1e+08 has no effect"),
])
def test_parameters_of_an_effect_that_is_off_have_no_effect(changes, effect, vain):
	concrete(**changes)
	block()
	start()
	line = ddem.effects()["concrete"][effect]
	assert line.state == "off" and line.why.endswith("; " + vain)


def test_damage_that_cannot_grow_and_was_not_there_is_named():
	concrete(viscoplasticFlow=False)
	block()
	start()
	assert "it cannot grow, and no triangle has initialDamage" in ddem.effects()["concrete"]["damage"].why
	O.reset()
	concrete(viscoplasticFlow=False)
	bodies(block().triangle_ids)[0].shape.initialDamage = Matrix3(0.5, 0, 0, 0, 0, 0, 0, 0, 0)
	start()
	steps(1)
	group = ddem.effects()["concrete"]
	assert "cannot grow" not in group["damage"].why
	assert group["damage at the start"].state == "on" and "of 1 triangles" in group["damage at the start"].why
	# with damageExponent = 2: 1 - 1/(1 + 0.5²), of the damage that is there
	assert group["damage"].bound == pytest.approx(0.2, abs=1e-5)


@pytest.mark.parametrize("changes, reason", [
	({"damage": False}, "damage = False"), ({"viscoplasticFlow": False}, "viscoplasticFlow = False"),
	({switch: False for switch in SWITCHES}, "viscoplasticFlow = False and damage = False")
])
def test_what_triangles_have_of_their_own_is_without_effect_where_damage_cannot_grow(changes, reason):
	concrete(**changes)
	sample = block(seed=1, crack_band=0.01)
	bodies(sample.triangle_ids)[0].shape.bandFactor = 3
	start()
	group = ddem.effects()["concrete"]
	for name in ("fracture energies", "crack band"):
		assert group[name].state == "off"
		assert group[name].why.endswith(f", without effect: {reason} of ConcreteDamageMat 'concrete'")


def test_damage_at_the_start_of_what_has_no_damage_is_without_effect():
	concrete(damage=False)
	elastic()
	for material, reason in (
		("concrete", "damage = False of ConcreteDamageMat 'concrete'"),
		("elastic", "DeformableElastMat 'elastic' has no damage")
	):
		for body in bodies(block(material, position=(len(O.bodies), 0, 0)).triangle_ids):
			body.shape.initialDamage = Matrix3(0.1, 0, 0, 0, 0, 0, 0, 0, 0)
		start()
		line = ddem.effects()[f"'{material}'"]["damage at the start"]
		assert line.state == "off" and line.why.endswith(f"without effect: {reason}")


def test_crack_band_where_nothing_can_break_is_an_error():
	elastic()
	said = "crack_band = 0.01 m scales a fracture energy, and DeformableElastMat has none: leave"
	with pytest.raises(ValueError, match=said):
		block("elastic", crack_band=0.01)
	assert len(O.bodies) == 0


# ---- bytes ----


@pytest.mark.parametrize("on", itertools.product((False, True), repeat=4))
def test_bytes_are_what_the_effects_that_are_on_need(on):
	switches = dict(zip(SWITCHES, on))
	material = concrete(**switches)
	block()
	for book in (False, True):
		O.trackEnergy = book
		engine = start()
		group, told = ddem.effects()["concrete"], engine.groups()[0]
		components = {name: number for name, _, number in engine.fields()}
		assert group.bytes == told["bytes"] == 24 * sum(components[name] for name in told["fields"])
		# each byte has an effect that asks for it
		assert group["law"].bytes == 0
		assert group.bytes == sum(effect.bytes for effect in group.effects)
		assert all(effect.bytes == 0 for effect in group.effects if not effect.runs)
		assert material.effects(book)["bytes"] == told["bytes"]
		for name in ("law", "effects", "effectsOff"):
			assert material.effects(book)[name] == told[name]
		if not book:
			shared = SHARED if switches["viscoplasticFlow"] or switches["damage"] else 0
			assert group.bytes == 24 * (shared + sum(NUMBERS[name] for name in NUMBERS if switches[name]))
		asked = {name for name in SWITCHES if switches[name]}
		if not switches["viscoplasticFlow"]:
			asked.discard("rateDependence")
		assert {name for name in SWITCHES if group[name].runs} == asked


def test_a_book_that_was_closed_has_its_bytes_still():
	concrete()
	block()
	O.trackEnergy = True
	engine = start()
	steps(2)
	kept = ddem.effects()["concrete"]["energy book"].bytes
	O.trackEnergy = False
	steps(2)
	group = ddem.effects()["concrete"]
	assert group.bytes == engine.groups()[0]["bytes"] and group["law"].bytes == 0
	assert group["energy book"].bytes == kept > 0 and not group["energy book"].runs
	assert group["energy book"].why == "O.trackEnergy = False: its fields stay, from when it was on"


def test_numbers_that_triangles_have_of_their_own_count():
	concrete()
	block(seed=1)
	engine = start()
	group = ddem.effects()["concrete"]
	assert group["fracture energies"].bytes == 8  # a number
	assert group.bytes == engine.groups()[0]["bytes"] == sum(effect.bytes for effect in group.effects)


# ---- what it changed ----


def test_concrete_in_its_elastic_range_changes_nothing():
	concrete()
	sample = block(seed=1, crack_band=0.01)
	O.trackEnergy = True
	start()
	assert states(stretched(sample, "concrete", -1e-9)) == {
		"law": "on", "viscoplasticFlow": "idle", "rateDependence": "idle", "damage": "idle",
		"equationOfState": "idle", "fracture energies": "idle", "crack band": "idle", "energy book": "on"
	}


@pytest.mark.parametrize("strain, flow, stiffening", [(-1e-9, "idle", "idle"), (-2e-2, "on", "on")])
def test_small_and_large_compression_of_concrete(strain, flow, stiffening):
	"""The flow has no threshold, but 1e-9, 50 Pa of 140 MPa, is next to nothing; 2 % is far beyond strength."""
	concrete()
	sample = block()
	start()
	group = stretched(sample, "concrete", strain)
	assert (group["viscoplasticFlow"].state, group["equationOfState"].state) == (flow, stiffening)
	largest = np.abs(np.asarray(sample.field("stiffening"))).max()
	assert group["equationOfState"].bound == pytest.approx(largest)
	assert group["damage"].bound == pytest.approx(np.asarray(sample.sub_element_damage).max())
	assert f"largest stiffening now {largest:.2g}" in str(ddem.effects())
	assert str(ddem.effects()).count("changed nothing") >= (2 if flow == "idle" else 0)


def test_bound_of_an_idle_effect_holds():
	"""Without the effects that are said to have changed nothing, the stresses are the same within the threshold."""

	def stresses(**changes):
		O.reset()
		# so strong and stiff that neither flow nor pressure matter
		concrete(strength=1e15, eosPressure=1e15, **changes)
		sample = block()
		start()
		stretched(sample, "concrete", -1e-6)
		steps(20)
		return ddem.effects()["concrete"], np.array(sample.stress)

	group, full = stresses()
	idle = [name for name in SWITCHES if group[name].state == "idle"]
	assert set(idle) == set(SWITCHES)
	_, bare = stresses(**{name: False for name in idle})
	assert 0 < np.abs(full - bare).max() <= NOTHING * np.abs(full).max()


@pytest.mark.parametrize("make, small, large", [
	(VonMisesMat, 5e-4, 5e-3),  # yields at 270 MPa: beyond a strain of 1e-3
	(ScalarDamageMat, 5e-5, 5e-4),  # breaks at f_t/E = 1e-4
])
def test_laws_without_switches_say_whether_they_did_anything(make, small, large):
	for strain, state in ((small, "idle"), (large, "on")):
		O.reset()
		O.materials.append(make(label="one"))
		sample = block("one")
		start()
		group = stretched(sample, "'one'", strain)
		assert group["law"].state == state
		assert group.bytes == sum(effect.bytes for effect in group.effects) > 0


@pytest.mark.parametrize("rotation", ["none", "corotational", "cosserat"])
def test_rotation(rotation):
	elastic()
	sample = block("elastic")
	start(rotation=rotation)
	whole = ddem.effects()["DeformableEngine"]
	if rotation == "none":
		assert whole["rotation"].state == "off"
	if rotation != "cosserat":
		tie = whole["rotation stiffness"]
		assert tie.state == "off"
		assert "rotationStiffness = 2 of DeformableElastMat 'elastic' has no effect" in tie.why
	angle = 0.3
	sample.spin = angle / (10 * O.dt)
	steps(10)
	turned = ddem.effects()["DeformableEngine"]["rotation"]
	if rotation != "none":
		assert turned.state == "on" and turned.bound > 2 * 0.9 * angle


def test_moments_of_cores_keep_rotation_from_being_idle():
	"""Cosserat cores that are turned against their triangles, which stand still."""
	elastic()
	sample = block("elastic")
	O.trackEnergy = True
	start()
	for body in bodies(sample.triangle_ids):
		body.state.angVel = (0, 0, 1e-6 / O.dt)
	steps(1)
	whole = ddem.effects()["DeformableEngine"]
	assert whole["rotation stiffness"].state == "on" and whole["rotation"].state == "on"
	assert "corotational" not in whole["rotation stiffness"].measured


def test_stiffness_that_ties_cores_is_never_idle():
	"""Without it they would turn freely; where they bear no moment, 'corotational' does the same."""
	concrete()
	sample = block()
	O.trackEnergy = True
	start()
	stretched(sample, "concrete", -1e-9)
	whole = ddem.effects()["DeformableEngine"]
	assert (whole["rotation"].state, whole["rotation stiffness"].state) == ("idle", "on")
	assert whole["rotation stiffness"].measured.endswith("so that 'corotational' would give the same")


def test_gravity():
	elastic()
	sample = block("elastic")
	start(gravity=Vector3(0, 0, -9.81))
	line = ddem.effects()["DeformableEngine"]["gravity"]
	assert line.state == "off" and line.why.endswith("the z component, -9.81 m/s², has no effect in plane strain")
	O.engines = [ForceResetter(), DeformableEngine(), NewtonIntegrator(gravity=(0, -10, 0), damping=0)]
	line = ddem.effects()["DeformableEngine"]["gravity"]
	assert line.why == "NewtonIntegrator.gravity = (0, -10, 0) m/s²"
	steps(3)
	assert ddem.effects()["DeformableEngine"]["gravity"].state == "on"  # it falls, and nothing else happens
	# pulled apart: 10 m/s, against 10 m/s² in some microseconds
	sample.velocities = sample.reference_positions * 1000
	steps(3)
	assert ddem.effects()["DeformableEngine"]["gravity"].state == "idle"


def test_forces_of_other_engines():
	elastic()
	sample = block("elastic")
	node = int(sample.node_ids[0])
	start()
	assert ddem.effects()["DeformableEngine"]["forces of other engines"].state == "off"
	start(ForceEngine(ids=[node], force=(1, 0, 0), label="pull"))
	line = ddem.effects()["DeformableEngine"]["forces of other engines"]
	assert line.state == "on" and line.why.startswith("pull before DeformableEngine")


@pytest.mark.parametrize("track", [False, True])
def test_damping_is_measured_in_the_energy_book(track):
	elastic()
	sample = block("elastic")
	O.trackEnergy = track
	start(damping=0.5)
	sample.velocities = sample.reference_positions * 100
	steps(50)
	line = ddem.effects()["DeformableEngine"]["damping"]
	assert line.state == "on"
	assert (line.bound is not None) is track
	assert ("O.trackEnergy = True before the run" not in line.measured) is track


# ---- scenes ----


def test_cost_is_measured_where_asked_for():
	O.timingEnabled = False
	concrete()
	sample = block()
	engine = start()
	steps(2)
	whole = ddem.effects()["DeformableEngine"]
	assert whole.ns is None and whole.cost == "not measured: O.timingEnabled = True before the run"
	O.timingEnabled = True
	try:
		steps(3)
		whole = ddem.effects()["DeformableEngine"]
		assert whole.ns == pytest.approx(engine.execTime / engine.execCount / len(sample.triangle_ids))
		assert f"{whole.ns:.3g} ns per triangle and step" in str(ddem.effects())
	finally:
		O.timingEnabled = False


def test_scene_without_engine_says_what_would_run():
	concrete(equationOfState=False)
	elastic("steel")
	block({"": "concrete", "bar": "steel"}, {"bar": BAR}, seed=1)
	table = ddem.effects()
	assert [group.name for group in table] == [
		"ConcreteDamageMat 'concrete', no DeformableEngine in O.engines yet",
		"DeformableElastMat 'steel', no DeformableEngine in O.engines yet"
	]

	def told():
		return {e.name: (e.runs, e.why, e.bytes) for e in ddem.effects()["'concrete'"].effects}

	before = told()
	start()
	assert told() == before
	assert before["equationOfState"][0] is False and before["damage"][0] is True


def test_scene_with_nothing():
	assert ddem.effects().rows() == [] and "neither deformable triangles nor bonded spheres" in str(ddem.effects())


def test_several_engines_and_groups_of_one_material():
	concrete()
	first, second = block(), block(position=(1, 0, 0), thickness=0.5)
	third = block(position=(2, 0, 0))
	O.engines = [
		ForceResetter(), DeformableEngine(ids=[*first.triangle_ids, *second.triangle_ids], label="left"),
		DeformableEngine(ids=third.triangle_ids.tolist(), groupMask=1 << 21, rotation="none", label="right")
	]
	table = ddem.effects()
	assert [group.name for group in table] == [
		"DeformableEngine 'left'", "ConcreteDamageMat 'concrete' of DeformableEngine 'left', 1 m thick",
		"ConcreteDamageMat 'concrete' of DeformableEngine 'left', 0.5 m thick", "DeformableEngine 'right'",
		"ConcreteDamageMat 'concrete' of DeformableEngine 'right'"
	]
	count = len(first.triangle_ids)
	assert [group.count for group in table] == [2 * count, count, count, count, count]
	assert table["right"]["rotation"].state == "off" and table["left"]["rotation"].runs


def test_rows_are_plain_data():
	concrete()
	block()
	start()
	rows = ddem.effects().rows()
	assert json.loads(json.dumps(rows, allow_nan=False)) == rows
	keys = {"group", "effect", "state", "why", "bytes", "measured", "changed", "ns_per_particle_step"}
	assert keys <= rows[0].keys()
	assert len(rows) == sum(len(group.effects) for group in ddem.effects())


def test_lines_of_the_printed_table_fit():
	concrete()
	block(seed=1, crack_band=0.02)
	start()
	assert max(map(len, str(ddem.effects()).splitlines())) <= 120


# ---- bonded spheres ----


def column(**changes):
	"""Three touching spheres along y."""
	O.materials.append(BondedMat(label="rock", **changes))
	spheres = packing.Packing([(0, 2e-3 * k, 0) for k in range(3)], [1e-3] * 3, bonds=[(0, 1), (1, 2)])
	return bonded.append(spheres, "rock")


def run_bonded(sample, **options):
	O.engines = bonded.engines(**options)
	O.dt = bonded.time_step(0.5)
	return sample


def test_bonded_spheres_beside_triangles():
	elastic()
	block("elastic", position=(1, 0, 0))
	run_bonded(column())
	O.engines = [*O.engines[:-1], DeformableEngine(), O.engines[-1]]
	table = ddem.effects()
	assert [group.name for group in table] == ["DeformableEngine", "DeformableElastMat 'elastic'", "bonded spheres"]
	assert table["bonded"].count == 2 and table["bonded"].particle == "bond" and table["bonded"].bytes > 100


def test_lines_of_bonded_spheres():
	run_bonded(column(normalDamping=0.1, frictionStatic=0, frictionDynamic=0), viscosity=3)
	group = ddem.effects()["bonded spheres"]
	assert states(group) == {
		"tension and compression": "on", "shear": "on", "bending": "on", "torsion": "on",
		"failure criterion": "on", "tension cut-off": "off", "softening of bonds": "off",
		"convention of ESyS-Particle": "off",
		"contact": "on", "friction": "off", "gradual friction": "off", "normal contact damping": "on",
		"tangential contact damping": "off", "body damping": "on", "local damping": "off", "gravity": "off",
		"energy book": "off"
	}
	assert group["body damping"].why == "viscosity = 3 /s, rotationalViscosity = 3 /s of ViscousBodyDamping"
	vain = "tensileStrength = inf Pa of BondedMat 'rock', not below C/tan φ = 1e+08 Pa, has no effect"
	assert group["tension cut-off"].why == vain
	assert group["friction"].why == "frictionStatic = frictionDynamic = 0 of BondedMat"


def test_pull_along_a_column_bends_and_twists_nothing():
	sample = run_bonded(column(tensileStrength=50e6))
	bodies(sample.ids)[2].state.vel = (0, 1, 0)
	steps(5)
	group = ddem.effects()["bonded spheres"]
	for name in ("shear", "bending", "torsion", "failure criterion", "tension cut-off", "contact", "friction"):
		assert group[name].state == "idle", name
	assert group["failure criterion"].measured == "no bond broken"
	assert str(ddem.effects()).count("changed nothing") == 7


@pytest.mark.parametrize("axis, part, modulus, other", [
	((0, 1, 0), "torsion", 100e9 / 2.5, "bending"), ((0, 0, 1), "bending", 100e9, "torsion")
])
def test_twist_and_bend_are_shares_of_the_load(axis, part, modulus, other):
	"""A twist of θ makes G θ R/d0 at the rim, a bend E θ R/d0; G = E/2(1 + ν) = E/2.5."""
	sample = run_bonded(column(young=100e9, poisson=0.25))
	angle = 1e-5
	bodies(sample.ids)[2].state.ori = Quaternion(Vector3(*axis), angle)
	O.dt = 1e-12
	steps(1)
	stresses = bonded.law().largestStresses()
	assert stresses[part] == pytest.approx(modulus * angle * 1e-3 / 2e-3, rel=1e-4)
	group = ddem.effects()["bonded spheres"]
	assert group[part].bound == pytest.approx(stresses[part] / max(stresses.values()))
	assert (group[part].state, group[other].state) == ("on", "idle")


def test_broken_bond_is_no_idle_criterion():
	sample = run_bonded(column(tensileStrength=50e6))
	bodies(sample.ids)[2].state.vel = (0, 100, 0)
	while len(sample.bonds) == 2 and O.iter < 1000:
		steps(1)
	group = ddem.effects()["bonded spheres"]
	assert group["failure criterion"].state == "on" and group["tension cut-off"].state == "on"
	assert group["failure criterion"].measured == "1 bonds broken in tension, 0 in shear"
	assert group["contact"].state == "on" and group.count == 2


def test_convention_without_damping_says_so():
	run_bonded(column(normalDamping=0.1, gradualFriction=True), convention="esys")
	group = ddem.effects()["bonded spheres"]
	for name in ("normal contact damping", "gradual friction"):
		assert group[name].state == "off"
		assert group[name].why.endswith("has no effect: convention = 'esys' has none")
	assert group["convention of ESyS-Particle"].state == "on"


def test_bonded_spheres_before_engines():
	column()
	(group, ) = ddem.effects()
	assert group.name.endswith("no InteractionLoop with their law in O.engines yet")
	assert group["contact"].state == "off" and "no InsertionSortCollider" in group["contact"].why


# ---- reports ----


def test_report_and_summary_have_the_table(tmp_path):
	concrete()
	sample = block(seed=1, thickness=0.02)
	platens = ddem.platens(sample, 2.0, ramp=2e-5, both=True)
	O.engines = [ForceResetter(), *platens.engines, DeformableEngine(label="triangles")]
	O.dt = ddem.time_step(0.8)
	run = uniaxial.CompressionTest(platens, duration=2e-4, stop=0).run(progress=False)
	page = open(Report([run], tmp_path, "A title", pictures=False).write(), encoding="utf-8").read()
	with open(tmp_path / "summary.json", encoding="utf-8") as file:
		rows = json.load(file)["models"]["deformable"]["effects"]
	found = {(row["group"], row["effect"]): row for row in rows}
	flow = found["ConcreteDamageMat 'concrete'", "viscoplasticFlow"]
	assert flow["state"] == "on" and flow["changed"] is True and flow["bound"] > NOTHING  # crushed: 2 % of strain
	assert found["ConcreteDamageMat 'concrete'", "damage"]["changed"] is True
	assert found["DeformableEngine 'triangles'", "rotation"]["ns_per_particle_step"] > 0
	assert rows == ddem.effects().rows() and not any(math.isnan(row["bound"] or 0) for row in rows)
	for row in rows:
		assert row["effect"] in page
	assert "strength = 1.4e+08 Pa of ConcreteDamageMat &#39;concrete&#39;, viscoplasticFlow = True" in page


def test_flow_that_waits_is_told():
	concrete(equationOfState=False)
	block()
	start(flowInterval=4)
	why = ddem.effects()["concrete"]["viscoplasticFlow"].why
	assert "solved every 4 steps: flowInterval of DeformableEngine" in why
