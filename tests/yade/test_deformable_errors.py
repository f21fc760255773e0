# GPL v2 or later, see LICENSE.
# Bad input to deformable triangles: each is an exception that says the value, the unit, the place and the way out,
# and leaves nothing half built.
import math

import numpy as np
import pytest

from yade import (
	Body, ConcreteDamageMat, DeformableElastMat, DeformableEngine, DeformableTriangle, ElastMat, ForceResetter,
	InteractionLoop, Matrix3, NewtonIntegrator, O, PyRunner, Vector3, ddem
)

from deformable_samples import append_bodies, bodies, elastic, skewed_mesh, start, steps

SQUARE = [(0, 0), (0.01, 0), (0.01, 0.01), (0, 0.01)]
TWO = [(0, 1, 2), (0, 2, 3)]


def message(error):
	return str(error.value)


def assert_says(error, *parts):
	"""The message has all parts, in any order."""
	missing = [part for part in parts if part not in message(error)]
	assert not missing, f"{missing} not in: {message(error)}"


# --- materials

BAD_MATERIALS = [
	({"young": 30e9, "poisson": 0.5}, ("poisson = 0.5", "between -1 and 0.5", "0.499")),
	({"young": 30e9, "poisson": 0.7}, ("poisson = 0.7", )),
	({"young": 30e9, "poisson": -1}, ("poisson = -1", )),
	({"young": 0}, ("young = 0 Pa", "positive")),
	({"young": -30e9}, ("young = -3e+10 Pa", "positive")),
	({"young": math.nan}, ("young = nan Pa", "positive")),
	({"density": 0}, ("density = 0 kg/m³", "positive")),
	({"density": -2400}, ("density = -2400 kg/m³", "positive")),
	({"density": math.inf}, ("density = inf kg/m³", "finite")),
	({"bulk": 0, "shear": 26e9}, ("bulk = 0 Pa", "positive")),
	({"bulk": 30e9, "shear": -26e9}, ("shear = -2.6e+10 Pa", "positive")),
	({"bulk": math.nan, "shear": 26e9}, ("bulk = nan Pa", "positive")),
	({"bulk": 30e9}, ("bulk and shear [Pa]", "young [Pa] and poisson [-]")),
	({"shear": 26e9}, ("bulk and shear [Pa]", "young [Pa] and poisson [-]")),
	({"bulk": 30e9, "shear": 26e9, "poisson": 0.2}, ("bulk and shear [Pa]", "young [Pa] and poisson [-]")),
	({"rotationStiffness": -1}, ("rotationStiffness = -1", "zero or positive")),
	({"rotationStiffness": math.nan}, ("rotationStiffness = nan", )),
]
BAD_CONCRETE = [
	({"strength": -1}, ("strength = -1 Pa", )),
	({"fractureEnergy": 0}, ("fractureEnergy = 0 J/m³", )),
	({"friction": 35}, ("friction = 35", )),  # degrees
	({"eosPressure": 0}, ("eosPressure = 0 Pa", )),
	({"flowExponent": 0}, ("flowExponent = 0", )),
	({"damageLimit": 1.5}, ("damageLimit = 1.5", )),
	({"residual": math.nan}, ("residual = nan", )),
]


@pytest.mark.parametrize(
	"kind, wrong, says",
	[(k, *bad) for k in (DeformableElastMat, ConcreteDamageMat) for bad in BAD_MATERIALS]
	+ [(ConcreteDamageMat, *bad) for bad in BAD_CONCRETE],
)
def test_a_bad_material_is_refused_when_it_is_made(kind, wrong, says):
	with pytest.raises(ValueError) as error:
		kind(label="mine", **wrong)
	assert_says(error, kind.__name__, *says)


def test_a_bad_material_is_refused_with_its_label_when_it_is_changed():
	material = ConcreteDamageMat(label="mine")
	for name, value in (("rotationStiffness", -2), ("strength", 0), ("bulk", -1), ("shear", math.nan)):
		with pytest.raises(ValueError) as error:
			setattr(material, name, value)
		assert_says(error, "'mine'", name)
		material = ConcreteDamageMat(label="mine")


@pytest.mark.parametrize(
	"name, value, says",
	[
		("young", -1, "young = -1 Pa"),
		("poisson", 0.5, "poisson = 0.5"),
		("density", 0, "density = 0 kg/m³"),
		("density", math.nan, "density = nan kg/m³"),
	],
)
def test_a_material_gone_bad_is_refused_before_the_run(name, value, says):
	material = elastic("mine")
	ddem.append(skewed_mesh(), material)
	setattr(material, name, value)  # attributes of stock YADE classes, which check nothing
	O.engines = [ForceResetter(), DeformableEngine()]
	with pytest.raises(ValueError) as error:
		ddem.time_step()
	assert_says(error, "'mine'", says)


# --- meshes and bodies


def test_bad_meshes_append_nothing():
	elastic()
	mesh = ddem.mesh.Mesh
	cases = [
		(mesh(SQUARE, [(0, 2, 1)]), "clockwise.*flipped"),
		(mesh(SQUARE[:2] + [(0.005, 0)], [(0, 1, 2)]), "no area"),
		(mesh(SQUARE, TWO + [(1, 2, 0)]), "same as triangle 0"),
		(mesh(SQUARE, [(0, 1, 2)]), "node 3 at .* belongs to no triangle"),
	]
	for bad, says in cases:
		with pytest.raises(ValueError, match=says):
			ddem.append(bad, "elastic")
		assert len(O.bodies) == 0


BAD_APPEND = [
	({"thickness": 0}, ("thickness = 0 m", "positive")),
	({"thickness": -1}, ("thickness = -1 m", "positive")),
	({"thickness": math.nan}, ("thickness = nan m", )),
	({"thickness": math.inf}, ("thickness = inf m", )),
	({"seed": -1}, ("seed = -1", "whole number")),
	({"seed": 1.5}, ("seed = 1.5", "whole number")),
	({"seed": "x"}, ("seed = 'x'", "whole number")),
	({"seed": 1, "spread": -0.1}, ("spread = -0.1", )),
	({"seed": 1, "spread": math.nan}, ("spread = nan", )),
	({"seed": 1, "spread": math.inf}, ("spread = inf", )),
	({"seed": 1, "floor": 0}, ("floor = 0", "(0, 1]")),
	({"seed": 1, "floor": 1.1}, ("floor = 1.1", "(0, 1]")),
	({"position": (0, 0)}, ("position = (0, 0)", "[m]")),
	({"position": (0, math.nan, 0)}, ("position", "[m]")),
	({"materials": "absent"}, ("region ''", "no material 'absent'", "append it first")),
	({"materials": 7}, ("region ''", "no material '7'", "append it first")),
	({"materials": {"steel": "concrete"}}, ("steel", "its regions are ['']")),
	({"materials": {}}, ("region ''", "has no material")),
	({"materials": "rigid"}, ("region ''", "DeformableElastMat or ConcreteDamageMat", "ElastMat")),
	({"materials": DeformableElastMat(label="loose")}, ("region ''", "'loose'", "not in O.materials")),
]


@pytest.mark.parametrize("wrong, says", BAD_APPEND)
def test_bad_arguments_append_nothing(wrong, says):
	O.materials.append(ConcreteDamageMat(label="concrete"))
	O.materials.append(ElastMat(label="rigid"))
	with pytest.raises(ValueError) as error:
		ddem.append(skewed_mesh(), **{"materials": "concrete", **wrong})
	assert_says(error, *says)
	assert len(O.bodies) == 0


def spoil_node_id(i):
	return lambda: setattr(O.bodies[4].shape, "nodes", (0, 1, i))


def spoil_shape(name, value):
	return lambda: setattr(O.bodies[4].shape, name, value)


def spoil_state(i, name, value):
	return lambda: setattr(O.bodies[i].state, name, value)


TRIANGLE = ("body 4", "(0.00666667, 0.00333333) m")
SPOILED = [
	(spoil_node_id(77), (*TRIANGLE, "node body 77", "missing")),
	(spoil_node_id(-1), (*TRIANGLE, "node body -1", "missing")),
	(spoil_node_id(5), (*TRIANGLE, "node body 5", "no DeformableNode")),
	(spoil_node_id(1), (*TRIANGLE, "degenerate", "remesh")),
	(lambda: setattr(O.bodies[4].shape, "nodes", (0, 2, 1)), (*TRIANGLE, "clockwise", "swap")),
	(lambda: setattr(O.bodies[5].shape, "nodes", (1, 2, 0)), ("body 5", "same three nodes", "remove")),
	(spoil_state(2, "refPos", (0.005, 0, 0)), (*TRIANGLE, "degenerate")),
	(spoil_state(2, "refPos", (math.nan, 0, 0)), ("body 2", "finite")),
	(spoil_state(2, "pos", (math.inf, 0, 0)), ("body 2", "finite", "[m")),
	(spoil_state(2, "vel", (0, math.nan, 0)), ("body 2", "finite", "m/s")),
	(spoil_shape("thickness", 0), (*TRIANGLE, "thickness = 0 m", "positive")),
	(spoil_shape("thickness", -2), (*TRIANGLE, "thickness = -2 m", "positive")),
	(spoil_shape("thickness", math.nan), (*TRIANGLE, "thickness = nan m")),
	(spoil_shape("fractureEnergy", 0), (*TRIANGLE, "fractureEnergy = 0", "J/m³", "positive")),
	(spoil_shape("fractureEnergy", math.nan), (*TRIANGLE, "fractureEnergy = nan", "J/m³")),
	(
		spoil_shape("initialDamage", Matrix3(0.1, 0.05, 0, 0, 0.1, 0, 0, 0, 0)),
		(*TRIANGLE, "initialDamage", "symmetric"),
	),
	(
		spoil_shape("initialDamage", Matrix3(0.1, 0, 0.1, 0, 0.1, 0, 0.1, 0, 0)),
		(*TRIANGLE, "initialDamage", "zero xz and yz"),
	),
	(
		spoil_shape("initialDamage", Matrix3(0.1, 0.2, 0, 0.2, 0.1, 0, 0, 0, 0)),
		(*TRIANGLE, "initialDamage", "negative principal value"),
	),
	(
		spoil_shape("initialDamage", Matrix3(-0.1, 0, 0, 0, 0.1, 0, 0, 0, 0)),
		(*TRIANGLE, "initialDamage", "negative"),
	),
	(spoil_shape("initialDamage", Matrix3(0, 0, 0, 0, 0, 0, 0, 0, -0.1)), (*TRIANGLE, "initialDamage", "negative")),
	(
		spoil_shape("initialDamage", Matrix3(math.nan, 0, 0, 0, 0, 0, 0, 0, 0)),
		(*TRIANGLE, "initialDamage", "symmetric"),
	),
	(
		lambda: setattr(O.bodies[4], "material", ElastMat()),
		(*TRIANGLE, "DeformableElastMat or ConcreteDamageMat", "not ElastMat"),
	),
	(lambda: setattr(O.bodies[4], "material", None), (*TRIANGLE, "no material")),
	(lambda: O.bodies.erase(4), ("body 1", "belongs to no DeformableTriangle", "erase it")),
	(lambda: O.bodies.erase(2), (*TRIANGLE, "node body 2", "missing")),
]


@pytest.mark.parametrize("spoil, says", SPOILED)
def test_bad_bodies_are_refused_with_their_place(spoil, says):
	append_bodies(SQUARE, TWO, ConcreteDamageMat())
	spoil()
	O.engines = [ForceResetter(), DeformableEngine()]
	for attempt in range(2):
		with pytest.raises(ValueError) as error:
			O.step()
		assert_says(error, *says)
	assert all(b.groupMask == 1 for b in O.bodies)  # nothing was taken over


def test_a_scene_without_triangles_is_refused():
	O.engines = [ForceResetter(), DeformableEngine()]
	with pytest.raises(ValueError, match="no DeformableTriangle; append a mesh"):
		O.step()


@pytest.mark.parametrize("erased", (0, 5))
def test_erasing_during_the_simulation_is_refused(erased):
	append_bodies(SQUARE, TWO, elastic())
	start()
	steps(3)
	O.bodies.erase(erased)
	with pytest.raises((RuntimeError, ValueError), match=f"(body|node|id) {erased}\\b"):
		steps(1)


# --- engine


def test_erasing_one_and_adding_another_is_refused():
	block = ddem.append(skewed_mesh(), elastic())
	start()
	O.run(3, True)
	first = O.bodies[int(block.triangle_ids[0])]
	again = Body()
	again.shape = DeformableTriangle(nodes=first.shape.nodes)
	again.state.pos = again.state.refPos = first.state.refPos
	again.material = first.material
	O.bodies.erase(int(block.triangle_ids[0]))
	O.bodies.append(again)
	with pytest.raises(RuntimeError, match=f"body {block.triangle_ids[0]} at .* was erased"):
		O.run(3, True)
		O.step()


def test_initial_damage_is_that_of_the_start():
	O.materials.append(ConcreteDamageMat(label="concrete"))
	block = ddem.append(skewed_mesh(), "concrete")
	start()  # asks for the time step, so the engine has read the scene
	shape = O.bodies[int(block.triangle_ids[2])].shape
	shape.initialDamage = 0.5 * Matrix3.Identity
	assert block.damage[2] > 0.3 and block.damage[3] == 0
	O.run(3, True)
	assert block.damage[2] > 0.3
	shape.initialDamage = 0.7 * Matrix3.Identity
	with pytest.raises(
		RuntimeError, match=f"body {block.triangle_ids[2]} .*initialDamage is the damage .* at the start"
	):
		O.run(3, True)
		O.step()


@pytest.mark.parametrize(
	"share, rotation",
	[
		(0, "none"), (1, "none"), (-0.1, "cosserat"), (0.25, "cosserat"), (0.4, "cosserat"),
		(math.nan, "corotational")
	],
)
def test_a_bad_vertex_share_is_refused(share, rotation):
	append_bodies(SQUARE, TWO, elastic())
	O.engines = [ForceResetter(), DeformableEngine(rotation=rotation, vertexShare=share)]
	with pytest.raises(ValueError) as error:
		O.step()
	assert_says(error, f"vertexShare = {share:g}", "between 0 and " + ("1/4" if rotation == "cosserat" else "1"))


def test_a_vertex_share_that_fits_without_rotating_cores_is_accepted():
	append_bodies(SQUARE, TWO, elastic())
	start(rotation="none", vertexShare=0.4)
	steps(1)


def test_an_unknown_rotation_treatment_is_refused():
	with pytest.raises(ValueError) as error:
		DeformableEngine(rotation="cosserrat")
	assert_says(error, "'cosserrat'", "'cosserat', 'corotational' or 'none'")
	engine = DeformableEngine()
	with pytest.raises(ValueError, match="'other' is unknown"):
		engine.rotation = "other"


def test_unknown_arrays_are_refused():
	append_bodies(SQUARE, TWO, elastic())
	engine = start()
	with pytest.raises(ValueError, match="'position'.* is unknown; there are nodePosition"):
		engine.array("position")
	with pytest.raises(ValueError, match="'sress'.* is unknown; there are .*stress"):
		engine.values("sress")


def test_a_time_step_above_the_critical_one_is_refused():
	_, triangles = append_bodies(SQUARE, TWO, elastic())
	engine = start()
	critical = engine.criticalTimeStep()
	O.dt = 1.001 * critical
	with pytest.raises(RuntimeError) as error:
		O.step()
	body, bound = engine.rulingTriangle()
	assert body in triangles and bound == critical
	assert_says(
		error, f"O.dt = {O.dt:g} s", f"critical time step {critical:g} s", f"body {body}",
		"0.8*engine.criticalTimeStep()"
	)
	assert O.iter == 0
	O.dt = 0.999 * critical
	steps(1)
	O.dt = 2 * critical  # changed later
	for _ in range(2):  # trying again does not help
		with pytest.raises(RuntimeError, match="above the critical"):
			steps(1)


WRONG_ENGINES = [
	(lambda: [DeformableEngine(), ForceResetter()], "wrong order.*ForceResetter.*put it first"),
	(
		lambda: [ForceResetter(), DeformableEngine(), InteractionLoop([], [], [])],
		"wrong order.*InteractionLoop.*put DeformableEngine after it",
	),
	(lambda: [ForceResetter(), DeformableEngine(), DeformableEngine()], "two DeformableEngine with the same bit"),
	(lambda: [DeformableEngine()], "no ForceResetter.*first"),
	(
		lambda: [ForceResetter(), DeformableEngine(), NewtonIntegrator(mask=1 << 20)],
		"NewtonIntegrator.mask.*remove",
	),
]


@pytest.mark.parametrize("engines, says", WRONG_ENGINES)
def test_order_and_number_of_engines_are_checked(engines, says):
	append_bodies(SQUARE, TWO, elastic())
	O.dt = 1e-9
	O.engines = engines()
	for attempt in range(2):
		with pytest.raises((RuntimeError, ValueError), match=says):
			O.step()
	O.engines = [ForceResetter(), DeformableEngine(), NewtonIntegrator()]
	O.step()
	assert O.iter == 1
	assert max((b.state.pos - b.state.refPos).norm() for b in O.bodies) < 1e-15


def test_a_newton_integrator_that_has_moved_the_bodies_is_refused():
	append_bodies(SQUARE, TWO, elastic())
	O.dt = 1e-9
	O.engines = [ForceResetter(), NewtonIntegrator(), DeformableEngine()]
	with pytest.raises(RuntimeError, match="wrong order.*NewtonIntegrator.*put it after"):
		O.step()


def test_a_newton_integrator_that_stands_first_is_accepted_once_it_knows():
	append_bodies(SQUARE, TWO, elastic())
	O.engines = [
		ForceResetter(),
		NewtonIntegrator(gravity=(0, -10, 0), damping=0),
		DeformableEngine(gravity=(0, -10, 0)),
	]
	O.dt = ddem.time_step()
	steps(10)
	for body in O.bodies:
		assert body.state.pos[1] - body.state.refPos[1] == pytest.approx(-10 * O.dt**2 * 10 * 11 / 2, rel=1e-6)


def test_a_run_without_the_engine_is_refused():
	append_bodies(SQUARE, TWO, elastic())
	O.engines = [ForceResetter(), NewtonIntegrator()]
	O.dt = 1e-9
	with pytest.raises(RuntimeError, match="no DeformableEngine.*add DeformableEngine"):
		ddem.run(steps=5)
	assert O.iter == 0


def test_translating_nodes_that_are_not_held_is_refused():
	from yade import TranslationEngine
	block = ddem.append(skewed_mesh(), elastic())
	start(TranslationEngine(ids=[int(block.node_ids[0])], translationAxis=(1, 0, 0), velocity=1))
	with pytest.raises(RuntimeError) as error:
		steps(1)
	assert_says(error, f"{block.node_ids[0]}", "TranslationEngine", "block.hold(")


# --- runs and platens

BAD_RUNS = [
	({}, "until= .* or steps="),
	({"until": 1, "steps": 1}, "until= .* or steps="),
	({"until": -1}, "until = -1 s"),
	({"until": math.nan}, "until = nan s"),
	({"steps": -1}, "steps = -1"),
	({"steps": 1.5}, "steps = 1.5"),
]


@pytest.mark.parametrize("wrong, says", BAD_RUNS)
def test_bad_runs_are_refused(wrong, says):
	append_bodies(SQUARE, TWO, elastic())
	start()
	with pytest.raises(ValueError, match=says):
		ddem.run(**wrong)
	O.dt = 0
	with pytest.raises(ValueError, match="O.dt = 0.* s must be positive"):
		ddem.run(steps=1)
	assert O.iter == 0


def test_a_run_ends_when_it_is_paused_or_fails():
	import sys
	block = ddem.append(skewed_mesh(), elastic())
	sys.modules["__main__"].stop_here = O.pause
	start(PyRunner(command="stop_here()", iterPeriod=25, firstIterRun=25))
	ddem.run(steps=1000, progress=False)
	assert 25 <= O.iter < 200
	O.engines = [e for e in O.engines if not isinstance(e, PyRunner)]
	O.bodies[int(block.node_ids[0])].state.vel = (math.nan, 0, 0)
	with pytest.raises(ValueError, match="body 0 .*finite"):
		ddem.run(steps=1000, progress=False)
	assert O.iter < 200


@pytest.mark.parametrize(
	"wrong, says", [
		({"velocity": 0}, "velocity = 0 m/s"), ({"velocity": math.nan}, "velocity = nan m/s"),
		({"velocity": 1, "ramp": -1}, "ramp = -1 s"),
		({"velocity": 1, "lateral": "loose"}, "'loose'.*'fixed'.*'free'")
	]
)
def test_bad_platens_are_refused(wrong, says):
	block = ddem.append(skewed_mesh(), elastic())
	with pytest.raises(ValueError, match=says):
		ddem.platens(block, **wrong)
	assert all(b.state.blockedDOFs == "zXYZ" for b in bodies(block.node_ids))


@pytest.mark.parametrize("safety", (0, -1, 1.01, math.nan))
def test_a_bad_safety_factor_is_refused(safety):
	append_bodies(SQUARE, TWO, elastic())
	with pytest.raises(ValueError, match=f"safety = {safety}"):
		ddem.time_step(safety)


def test_the_time_step_is_known_before_engines_are_set():
	append_bodies(SQUARE, TWO, elastic())
	early = ddem.time_step(0.5)
	engine = start()
	assert early == pytest.approx(0.5 * engine.criticalTimeStep(), rel=1e-15)
	steps(1)
	assert O.bodies[4].shape.damage == 0  # the shape is linked to the engine that runs


# --- numbers that are not finite during the run


def test_a_velocity_that_is_not_finite_is_refused_with_its_body_and_can_be_mended():
	append_bodies(SQUARE, TWO, elastic())
	start()
	steps(3)
	O.bodies[2].state.vel = (0, math.nan, 0)
	for attempt in range(2):
		with pytest.raises(ValueError) as error:
			O.step()
		assert_says(error, "body 2", "(0.01, 0.01) m", "finite", "m/s")
	O.bodies[2].state.vel = Vector3.Zero
	O.step()
	assert O.iter == 4


@pytest.mark.parametrize("value", (math.nan, math.inf))
@pytest.mark.parametrize("what", ("node", "core", "torque"))
def test_a_force_that_is_not_finite_stops_the_step_it_comes_in(what, value):
	append_bodies(SQUARE, TWO, elastic())
	start()
	steps(3)
	if what == "torque":
		O.forces.setPermT(5, (0, 0, value))
	else:
		O.forces.setPermF(2 if what == "node" else 5, (value, 0, 0))
	with pytest.raises(RuntimeError) as error:
		O.step()
	place = "(0.01, 0.01) m" if what == "node" else "(0.00333333, 0.00666667) m"
	assert_says(error, "step 3", "node body 2" if what == "node" else "triangle body 5", place, "O.dt")
	assert O.iter == 3


def test_a_prescribed_velocity_that_is_not_finite_stops_the_step_it_comes_in():
	import sys
	append_bodies(SQUARE, TWO, elastic())
	sys.modules["__main__"].spoil = lambda: setattr(O.bodies[1].state, "vel", (0, math.inf, 0))
	O.bodies[1].state.blockedDOFs = "xyzXYZ"
	start(PyRunner(command="spoil()", iterPeriod=20, firstIterRun=20))
	with pytest.raises(RuntimeError) as error:
		O.run(100, True)
	assert_says(error, "body 1", "(0.01, 0) m", "finite")
	assert O.iter == 20
