# GPL v2 or later, see LICENSE.
# Deformable triangles move as mechanics says: patch test, rigid spin, momenta, energy, prescribed motion,
# forces of other engines, gravity, damping.
import math
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from yade import ForceEngine, O, PyRunner, RampedTranslationEngine, TranslationEngine, Vector3, ddem

from deformable_samples import (
	TABLE_1, TREATMENTS, agitate, angular_momentum, append_bodies, bodies, elastic, equilateral_mesh,
	kinetic_energy, lame, momentum, place, set_velocity, skewed_mesh, start, state_positions, steps
)

OBJECTIVE = ("corotational", "cosserat")


def polar(f):
	"""Rotation angle and stretch of a deformation gradient."""
	angle = math.atan2(f[1, 0] - f[0, 1], f[0, 0] + f[1, 1])
	turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
	return angle, turn, turn.T @ f


def expected_stress(f, treatment, material):
	"""Stress xx, yy, zz, xy of a homogeneous deformation, from the linear strain of the element's frame."""
	lam, mu = lame(material)
	turn, stretch = (np.eye(2), 0.5 * (f + f.T)) if treatment == "none" else polar(f)[1:]
	strain = stretch - np.eye(2)
	stress = turn @ (lam * np.trace(strain) * np.eye(2) + 2 * mu * strain) @ turn.T
	return np.array([stress[0, 0], stress[1, 1], lam * np.trace(strain), stress[0, 1]])


def impose(block, f, treatment):
	"""Deform the whole block by x → f x + a shift, cores turned with the material."""
	place(block, lambda x, y: f @ (x, y) + (0.01, -0.02))
	if treatment == "cosserat":
		half = 0.5 * polar(f)[0]
		for body in bodies(block.triangle_ids):
			body.state.ori = (Vector3(0, 0, 1), 2 * half)


# --- patch test

numbers = st.floats(-0.3, 0.3)


@pytest.mark.parametrize("treatment", TREATMENTS)
@given(st.tuples(numbers, numbers, numbers, numbers), st.floats(-3, 3))
@settings(max_examples=12, derandomize=True)
def test_patch_homogeneous_deformation_gives_its_exact_stress_everywhere(treatment, gradient, turn):
	O.reset()
	material = elastic()
	block = ddem.append(skewed_mesh(), material)
	f = np.eye(2) + np.reshape(gradient, (2, 2))
	if treatment != "none":
		f = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]]) @ f
	# what is held does not move in the one step that takes up the positions
	for body in bodies(block.triangle_ids):
		body.state.blockedDOFs = "xyzXYZ"
	block.hold(block.node_ids)
	start(rotation=treatment)
	impose(block, f, treatment)
	O.step()
	expected = expected_stress(f, treatment, material)
	# positions carry round-off, 1e-17 m over 3 mm
	assert np.abs(block.stress - expected).max() < 1e-13 * material.bulk


@pytest.mark.parametrize("treatment", TREATMENTS)
def test_patch_inner_nodes_feel_no_force(treatment):
	material = elastic()
	# elsewhere a strain turns the cores, see DeformableElastMat.rotationStiffness
	mesh = equilateral_mesh() if treatment == "cosserat" else skewed_mesh()
	block = ddem.append(mesh, material)
	start(rotation=treatment)
	impose(block, np.array([[1.1, -0.2], [0.3, 0.9]]), treatment)
	O.step()
	inner = np.setdiff1d(np.arange(len(block.node_ids)), block.mesh.boundary())
	force = np.linalg.norm(block.node_forces, axis=1)
	assert len(inner) > 5
	assert force[inner].max() < 1e-12 * force.max()


@pytest.mark.parametrize("treatment", ("none", "corotational"))
def test_patch_relaxes_from_any_start_to_the_homogeneous_state(treatment):
	material = elastic()
	block = ddem.append(skewed_mesh(), material)
	f = np.array([[1.03, -0.02], [0.04, 0.95]])
	start(rotation=treatment, damping=0.5)
	impose(block, f, treatment)
	edge = block.node_ids[block.mesh.boundary()]
	block.hold(edge)
	random = np.random.default_rng(2)
	free = np.setdiff1d(block.node_ids, edge)
	for body in bodies([*free, *block.triangle_ids]):
		body.state.pos += Vector3(*random.uniform(-2e-4, 2e-4, 2), 0)
	O.run(6000, True)
	expected = expected_stress(f, treatment, material)
	assert np.abs(block.stress - expected).max() < 1e-12 * material.bulk


# --- rotation and conservation


@pytest.mark.parametrize("treatment", OBJECTIVE)
def test_rigid_spin_through_more_than_a_turn_leaves_only_the_centrifugal_stress(treatment):
	material = elastic()
	block = ddem.append(skewed_mesh(), material)
	engine = start(rotation=treatment)
	centre = sum(
		(engine.array(k + "Mass")[:, None] * engine.array(k + "Position")).sum(axis=0) for k in ("node", "core")
	)
	centre /= engine.array("nodeMass").sum() + engine.array("coreMass").sum()
	spin = 300.0
	set_velocity(block, lambda x, y: (-spin * (y - centre[1]), spin * (x - centre[0])), spin)
	radius = np.linalg.norm(block.positions - centre, axis=1).max()
	O.run(math.ceil(2.2 * 2 * math.pi / spin / O.dt), True)
	turned = spin * O.time
	assert turned > 4 * math.pi
	# Statically the stress of a spinning disc is below ρ ω² R² (Timoshenko and Goodier, Theory of Elasticity,
	# art. 32: (3+ν)/8 of it); put on at once, below twice that.
	centrifugal = material.density * (spin * radius)**2
	assert 0.05 < np.abs(block.stress).max() / centrifugal < 2
	# the strain of that stress makes the block larger, so it turns less
	slower = turned * 2 * centrifugal / material.shear
	assert slower < 1e-3
	if treatment == "cosserat":  # counts full turns
		assert np.abs(block.rotation - turned).max() < slower
	else:
		assert np.abs(np.exp(1j * block.rotation) - np.exp(1j * turned)).max() < slower


@pytest.mark.parametrize("treatment", OBJECTIVE)
def test_free_flight_conserves_both_momenta_to_round_off(treatment):
	block = ddem.append(skewed_mesh(), elastic())
	engine = start(rotation=treatment)
	agitate(block, 20)  # strains of some 1e-2
	O.step()
	linear, angular = momentum(engine), angular_momentum(engine)
	scale = engine.array("nodeMass").sum() * 20
	O.run(2000, True)
	assert np.abs(block.strain).max() > 1e-3
	assert np.abs(momentum(engine) - linear).max() < 1e-12 * scale
	assert abs(angular_momentum(engine) - angular) < 1e-12 * scale * 0.06  # 0.06 m: size of the block


@pytest.mark.parametrize(
	"treatment, speed, tolerance",
	[("none", 20, 1e-11), ("corotational", 0.02, 1e-6), ("cosserat", 0.02, 1e-6), ("cosserat", 5, 1e-3)],
)
def test_energy_book_of_a_vibrating_block_closes(treatment, speed, tolerance):
	block = ddem.append(skewed_mesh(), elastic())
	start(rotation=treatment, step=0.9)
	agitate(block, speed)
	book = ddem.EnergyBalance()
	O.step()
	first = book.record()
	for _ in range(100):
		steps(17)
		book.record()
	parts = book.parts()
	assert book.largest < tolerance
	assert parts["elastPotential"] > 0.1 * first["kinetic"]
	if treatment == "cosserat":
		assert parts["elastRotation"] > 1e-3 * first["kinetic"]
	# what it closes on is the energy that it began with
	assert O.energy.total() == pytest.approx(first["kinetic"], rel=0.1)


# --- prescribed motion


def test_blocked_nodes_keep_their_velocity_and_others_follow():
	block = ddem.append(skewed_mesh(), elastic())
	start()
	before = block.positions.copy()
	block.drive(block.node_ids[:3], (0.5, None))
	O.run(250, True)
	assert np.abs(block.positions[:3, 0] - before[:3, 0] - 0.5 * O.time).max() < 1e-15
	assert np.abs(block.velocities[:3, 0] - 0.5).max() == 0
	assert (np.abs(block.velocities[3:]).min(axis=1) > 0).all()


@pytest.mark.parametrize("at_once", (True, False))
def test_translation_engines_move_held_nodes(at_once):
	block = ddem.append(skewed_mesh(), elastic())
	left, right = block.boundary(lambda x, y: x < 0), block.boundary(lambda x, y: x > 0.03)
	engines = [
		TranslationEngine(ids=[int(i) for i in left], translationAxis=(0.6, 0.8, 0), velocity=2),
		RampedTranslationEngine(
			ids=[int(i) for i in right], translationAxis=(1, 0, 0), velocity=-3, rampTime=2e-5
		),
	]
	start(*engines)
	block.hold([*left, *right])
	rows = lambda ids: np.searchsorted(block.node_ids, ids)
	before = block.positions.copy()
	count = 150
	assert 0.2 < 2e-5 / (count * O.dt) < 0.8  # both on the ramp and beyond
	if at_once:
		O.run(count, True)
	else:
		steps(count)
	times = O.dt * np.arange(count)
	moved = block.positions - before
	assert np.abs(moved[rows(left)] - 2 * O.time * np.array([0.6, 0.8])).max() < 1e-15
	ramped = -3 * O.dt * np.minimum(times / 2e-5, 1).sum()
	assert np.abs(moved[rows(right)] - (ramped, 0)).max() < 1e-15
	assert (np.abs(state_positions(block.node_ids) - block.positions) == 0).all()


# --- forces of others


def pushes(block, force):
	"""Each way YADE has to put a force on every node, by name: the engines to add and what to do before the run."""
	ids = [int(i) for i in block.node_ids]
	main = sys.modules["__main__"]
	main.push = lambda: [O.forces.addF(i, force) for i in ids]
	permanent = lambda: [O.forces.setPermF(i, force) for i in ids]
	return {
		"ForceEngine": ([ForceEngine(ids=ids, force=force)], lambda: None),
		"permanent": ([], permanent),
		"PyRunner": ([PyRunner(command="push()", iterPeriod=1, initRun=True)], lambda: None),
	}


@pytest.mark.parametrize("way", ("ForceEngine", "permanent", "PyRunner"))
def test_forces_of_others_accelerate_the_block(way):
	block = ddem.append(skewed_mesh(), elastic())
	force = Vector3(700, -400, 0)
	engines, prepare = pushes(block, force)[way]
	engine = start(*engines)
	prepare()
	book = ddem.EnergyBalance()
	O.run(400, True)
	total = np.array([force[0], force[1]]) * len(block.node_ids)
	assert momentum(engine) == pytest.approx(total * O.time, rel=1e-12)
	book.record()
	assert book.error < 1e-6
	assert -book.parts()["externalWork"] > 0.9 * (total @ total) * O.time**2 / (
		2 * (engine.array("nodeMass").sum() + engine.array("coreMass").sum())
	)


def test_a_torque_on_cores_turns_the_block():
	block = ddem.append(skewed_mesh(), elastic())
	engine = start()
	for i in block.triangle_ids:
		O.forces.setPermT(int(i), (0, 0, 30))
	O.run(300, True)
	assert angular_momentum(engine) == pytest.approx(30 * len(block.triangle_ids) * O.time, rel=1e-12)
	assert np.abs(momentum(engine)).max() < 1e-9 * kinetic_energy(engine)**0.5


def test_an_engine_that_was_dead_pushes_once_it_is_revived():
	block = ddem.append(skewed_mesh(), elastic())
	push = ForceEngine(ids=[int(i) for i in block.node_ids], force=(100, 0, 0), dead=True)
	engine = start(push)
	O.run(10, True)
	push.dead = False
	O.run(10, True)
	assert momentum(engine)[0] == pytest.approx(100 * len(block.node_ids) * 10 * O.dt, rel=1e-12)


# --- gravity and damping


@pytest.mark.parametrize("treatment", TREATMENTS)
def test_free_fall_is_exact(treatment):
	block = ddem.append(skewed_mesh(), elastic())
	start(rotation=treatment, gravity=(1.5, -9.81, 0))
	count = 300
	O.run(count, True)
	fall = 0.5 * count * (count + 1) * O.dt**2  # leapfrog from rest: v(n+½) = (n+1) g dt
	assert np.abs(block.displacements - fall * np.array([1.5, -9.81])).max() < 1e-15
	assert np.abs(block.stress).max() < 1e-12 * TABLE_1["bulk"]


@pytest.mark.parametrize("treatment", TREATMENTS)
def test_a_column_settles_to_the_stress_of_its_weight(treatment):
	width, height, g = 0.02, 0.05, 1e4
	material = elastic(rotationStiffness=0)
	block = ddem.append(ddem.mesh.rectangle(width, height, size=0.01), material)
	start(rotation=treatment, gravity=(0, -g, 0), damping=0.4)
	bottom = block.boundary("bottom")
	block.hold(bottom, "y")
	block.hold(bottom[:1], "x")
	O.run(8000, True)
	# The mean of σ_yy follows from the weight by virtual work with w_y = y, exactly in any mesh;
	# σ_xx and σ_xy vanish since the sides are free.
	mean = np.average(block.stress.mean(axis=1), axis=0, weights=block.area)
	# second order in the strain of 1e-5
	assert mean[1] == pytest.approx(-0.5 * material.density * g * height, rel=2e-5)
	assert np.abs(mean[[0, 3]]).max() < 2e-5 * abs(mean[1])
	weight = material.density * width * height * g
	# inner forces on the held nodes and their own weight press on the support
	felt = sum(O.forces.f(int(i))[1] for i in bottom)
	own = g * sum(O.bodies[int(i)].state.mass for i in bottom)
	assert felt - own == pytest.approx(-weight, rel=1e-9)


def test_damping_takes_all_energy_and_books_it():
	block = ddem.append(skewed_mesh(), elastic())
	start(damping=0.2)
	agitate(block, 0.02)
	book = ddem.EnergyBalance()
	O.step()
	first = O.energy["kinetic"]
	for _ in range(50):
		steps(100)
		book.record()
	assert book.parts()["nonviscDamp"] > 0.9 * first
	assert book.parts()["elastPotential"] < 1e-6 * first
	assert book.largest < 1e-6
