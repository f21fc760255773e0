# GPL v2 or later, see LICENSE.
# Deformable triangles as part of a YADE scene: what Python sees and changes, other bodies and engines,
# bodies that come later, order and threads.
import os
import shutil
import subprocess

import numpy as np
import pytest

from yade import (
	ConcreteDamageMat, DeformableEngine, ForceEngine, ForceResetter, NewtonIntegrator, O, PyRunner,
	RadialForceEngine, Vector3, ddem
)
from yade.utils import sphere

from deformable_samples import (
	TREATMENTS, agitate, append_bodies, bodies, elastic, in_main, momentum, place, set_velocity, skewed_mesh, start,
	state_positions, state_velocities, steps
)
from waiting import BackgroundRun, until


def crushed_block(velocity=10.0, size=0.005):
	"""A small concrete block under platens, with its engines set."""
	O.materials.append(ConcreteDamageMat(label="concrete"))
	block = ddem.append(ddem.mesh.rectangle(0.02, 0.04, size=size), "concrete", seed=4)
	platens = ddem.platens(block, velocity=velocity, ramp=5e-6)
	return block, start(*platens.engines)


def staleness(block):
	"""How far State is from the engine's arrays [m], [m/s]."""
	moved = np.abs(state_positions(block.node_ids) - block.positions).max()
	return max(moved, np.abs(state_velocities(block.node_ids) - block.velocities).max())


# --- what Python sees


@pytest.mark.parametrize("treatment", TREATMENTS)
def test_state_is_current_after_steps_and_runs(treatment):
	block = ddem.append(skewed_mesh(), elastic())
	engine = start(rotation=treatment)
	agitate(block, 5)
	before = state_positions(block.node_ids)
	for advance in (O.step, lambda: O.run(20, True), lambda: O.run(1, True)):
		advance()
		assert staleness(block) == 0
		assert np.abs(state_positions(block.triangle_ids) - engine.array("corePosition")).max() == 0
		angles = [2 * np.arctan2(b.state.ori[2], b.state.ori[3]) for b in bodies(block.triangle_ids)]
		assert angles == pytest.approx(list(block.rotation), abs=1e-15)
		assert [b.shape.rotation for b in bodies(block.triangle_ids)] == list(block.rotation)
	assert np.abs(state_positions(block.node_ids) - before).max() > 1e-6


def test_state_is_current_at_the_end_time():
	block = ddem.append(skewed_mesh(), elastic())
	start()
	agitate(block, 5)
	O.stopAtTime = 100.5 * O.dt
	O.run(wait=True)
	assert O.iter == 101
	assert staleness(block) == 0


PERIODS = {
	"steps": {"iterPeriod": 7},
	"time": {"virtPeriod": 1.3e-6},
	"clock": {"realPeriod": 1e-9},  # has gone by at every look, on the fastest machine as well
	"twice": {"iterPeriod": 11, "nDo": 3},  # YADE counts the first look at the period, too
	"from a step on": {"iterPeriod": 50, "firstIterRun": 13},
	"start": {"iterPeriod": 50, "initRun": True},
}


@pytest.mark.parametrize("place_of_runner", ("before", "after"))
@pytest.mark.parametrize("period", PERIODS)
def test_state_is_current_in_a_pyrunner(period, place_of_runner):
	block = ddem.append(skewed_mesh(), elastic())
	seen = []
	runner = PyRunner(command=in_main("look", lambda: seen.append(staleness(block))), **PERIODS[period])
	start(*([runner] if place_of_runner == "before" else []))
	if place_of_runner == "after":
		O.engines = O.engines + [runner]
	agitate(block, 5)
	steps(1)
	O.run(400, True)
	assert len(seen) > 1 and max(seen) == 0


def test_state_is_current_in_a_pyrunner_that_is_added_later():
	block = ddem.append(skewed_mesh(), elastic())
	start()
	agitate(block, 5)
	O.run(40, True)
	seen = []
	O.engines = O.engines + [
		PyRunner(command=in_main("look", lambda: seen.append((O.iter, staleness(block)))), iterPeriod=7)
	]
	O.run(20, True)
	assert seen[0][0] == 40  # YADE runs it at once, since 40 steps have gone by since step 0
	assert max(stale for _, stale in seen) == 0


def test_engines_that_read_state_see_it_current():
	"""A force along the radius from the origin depends on State.pos at every step, whoever else looks."""
	results = []
	for look in (False, True):
		O.reset()
		block = ddem.append(skewed_mesh(), elastic())
		start(
			RadialForceEngine(
				ids=[int(i) for i in block.node_ids],
				axisPt=(0.02, 0.4, 0),
				axisDir=(0, 0, 1),
				fNorm=2000,
			)
		)
		set_velocity(block, lambda x, y: (800, 0))
		steps(200) if look else O.run(200, True)
		results.append(block.positions.copy())
	assert np.array_equal(*results)


def test_state_is_current_after_a_pause_and_renewed_during_a_run():
	block = ddem.append(skewed_mesh(), elastic())
	start()
	set_velocity(block, lambda x, y: (1, 0))
	node = O.bodies[int(block.node_ids[0])].state
	seen = {node.pos[0]}
	run = BackgroundRun()

	def renewed():
		seen.add(node.pos[0])
		return len(seen) > 3

	until(renewed)
	run.pause()
	block.positions  # reading anything from the engine brings State up to date
	assert staleness(block) == 0


def test_views_are_the_engine_s_own_memory_and_outlive_the_scene():
	block = ddem.append(skewed_mesh(), elastic())
	engine = start()
	agitate(block, 5)
	steps(1)
	views = {
		name: engine.array(name)
		for name in (
			"nodePosition", "nodeVelocity", "nodeForce", "corePosition", "coreVelocity", "coreForce",
			"coreRotation", "coreSpin"
		)
	}
	before = {name: view.copy() for name, view in views.items()}
	O.run(10, True)
	for name, view in views.items():
		assert np.shares_memory(view, engine.array(name)), name
		assert not np.array_equal(view, before[name]), name
	assert np.shares_memory(block.positions, views["nodePosition"])
	last = views["nodePosition"].copy()
	O.reset()
	assert np.array_equal(views["nodePosition"], last)
	assert np.array_equal(engine.array("nodePosition"), last)  # also through the engine that the user still holds


def test_arrays_follow_state_at_once():
	"""What Python sets in State is what Python reads from the engine, before any step."""
	block = ddem.append(skewed_mesh(), elastic())
	engine = start()
	set_velocity(block, lambda x, y: (3, 0))
	place(block, lambda x, y: (1.01 * x, y))
	assert np.array_equal(engine.array("nodeVelocity"), state_velocities(block.node_ids))
	assert block.displacements[:, 0] == pytest.approx(0.01 * block.reference_positions[:, 0], abs=1e-15)
	assert block.strain[..., 0] == pytest.approx(0.01, rel=1e-9)


# --- what Python changes


def test_positions_set_between_runs_are_taken_up():
	block = ddem.append(skewed_mesh(), elastic())
	start()
	steps(5)
	place(block, lambda x, y: (x + 0.5, y))
	O.run(5, True)
	assert block.displacements == pytest.approx(np.tile((0.5, 0), (len(block.node_ids), 1)), abs=1e-12)
	for body in bodies([*block.node_ids, *block.triangle_ids]):
		body.state.blockedDOFs, body.state.vel = "xyzXYZ", Vector3.Zero
	place(block, lambda x, y: (1.001 * x, y))
	O.run(1, True)
	assert block.strain[..., 0] == pytest.approx(1e-3, rel=1e-9)


@pytest.mark.parametrize("when", ("between runs", "in a PyRunner"))
def test_velocities_set_by_python_are_taken_up(when):
	block = ddem.append(skewed_mesh(), elastic())
	change = lambda: set_velocity(block, lambda x, y: (2, -1))
	runner = PyRunner(command=in_main("change", change), iterPeriod=10, firstIterRun=10, nDo=1)
	engine = start(*([runner] if when == "in a PyRunner" else []))
	O.run(10, True)
	if when == "between runs":
		change()
	O.run(10, True)
	mass = engine.array("nodeMass").sum() + engine.array("coreMass").sum()
	assert momentum(engine) == pytest.approx(mass * np.array([2, -1]), rel=1e-12)


@pytest.mark.parametrize("treatment", ["none", "corotational", "cosserat"])
def test_driven_nodes_that_are_free_to_slide_do_not_feel_who_looks(treatment):
	"""Kinematic engines wipe the whole velocity of their nodes, of which only the driven direction is theirs."""
	ends = []
	for period in (None, 1, 4):
		O.reset()
		O.materials.append(ConcreteDamageMat(label="concrete", density=2400))
		block = ddem.append(ddem.mesh.rectangle(width=0.04, height=0.08, size=0.01), "concrete")
		platens = ddem.platens(block, velocity=1.0, ramp=1e-5, lateral="free")
		O.engines = [ForceResetter(), *platens.engines, DeformableEngine(rotation=treatment)] + (
			[PyRunner(command="1", iterPeriod=period)] if period else []
		)
		O.dt = ddem.time_step(0.8)
		O.run(200, True)
		ends.append(block.positions.tolist())
	assert ends[1] == ends[0] and ends[2] == ends[0]
	top = block.positions[block.mesh.boundary("top")]
	assert np.ptp(top[:, 0]) > 0.04 * (1 + 1e-5)  # it has slid apart


def test_nodes_are_held_and_released_between_runs():
	block = ddem.append(skewed_mesh(), elastic())
	start()
	agitate(block, 5)
	state = O.bodies[int(block.node_ids[0])].state
	steps(3)
	state.blockedDOFs, state.vel = "y", (state.vel[0], 0, 0)
	held = state.pos[1]
	O.run(50, True)
	assert state.pos[1] == held
	assert state.vel[0] != 0
	state.blockedDOFs = ""
	O.run(50, True)
	assert abs(state.pos[1] - held) > 1e-6


# --- other bodies


def test_rigid_spheres_fall_with_newton_and_triangles_are_not_moved_twice():
	g = Vector3(0, -10, 0)
	block = ddem.append(skewed_mesh(), elastic())
	ball = O.bodies.append(sphere((0.5, 0, 0), 0.01))
	start(gravity=g)
	O.engines = O.engines + [NewtonIntegrator(gravity=g, damping=0)]
	O.run(100, True)
	fall = g[1] * O.dt**2 * 100 * 101 / 2
	assert O.bodies[ball].state.pos[1] == pytest.approx(fall, rel=1e-12)
	fallen = state_positions(block.node_ids) - block.reference_positions
	assert np.abs(fallen - (0, fall)).max() < 1e-15


def test_newton_keeps_the_mask_it_was_given():
	block = ddem.append(skewed_mesh(), elastic())
	falling, standing = O.bodies.append([sphere((0.5, 0, 0), 0.01), sphere((0.6, 0, 0), 0.01)])
	O.bodies[falling].groupMask, O.bodies[standing].groupMask = 2, 4
	newton = NewtonIntegrator(gravity=(0, -10, 0), damping=0, mask=2)
	start()
	O.engines = O.engines + [newton]
	steps(20)
	assert newton.mask == 2
	assert O.bodies[falling].state.pos[1] < 0 == O.bodies[standing].state.pos[1]
	newton.mask = 0  # everybody: the engine takes its bodies out again, or says that it cannot
	try:
		steps(20)
	except RuntimeError as error:
		assert "mask" in str(error)
		return
	assert O.bodies[standing].state.pos[1] < 0
	# triangles feel its gravity, too, and once
	assert block.displacements[:, 1] == pytest.approx(-10 * O.dt**2 * 40 * 41 / 2, rel=1e-9)


# --- bodies that come later


def test_a_second_block_leaves_the_state_of_the_first():
	block, engine = crushed_block()
	O.run(250, True)
	names = (
		"nodePosition", "nodeVelocity", "nodeForce", "corePosition", "coreVelocity", "coreForce",
		"coreRotation", "coreSpin"
	)
	arrays = lambda: [
		engine.array(name)[: len(block.node_ids) if name.startswith("node") else len(block.triangle_ids)].copy()
		for name in names
	]
	values = lambda: [
		engine.values(name)[: len(block.triangle_ids)]
		for name in ("stress", "strain", "plasticStrain", "damageTensor", "damage", "rotation")
	]
	before = arrays() + values()
	assert block.damage.max() > 0.01
	ddem.append(ddem.mesh.rectangle(0.02, 0.04, size=0.005), "concrete", position=(1, 0, 0))
	assert len(engine.array("nodePosition")) == 2 * len(block.node_ids)
	for name, old, new in zip(
		names + ("stress", "strain", "plasticStrain", "damageTensor", "damage", "rotation"),
		before,
		arrays() + values(),
	):
		assert np.array_equal(old, new), name


def test_a_second_block_far_away_does_not_change_what_the_first_does():
	results = []
	for second in (False, True):
		O.reset()
		block, engine = crushed_block()
		book = ddem.EnergyBalance()
		O.run(150, True)
		if second:
			ddem.append(ddem.mesh.rectangle(0.02, 0.04, size=0.005), "concrete", position=(1, 0, 0))
		O.run(150, True)
		results.append((block.positions.copy(), block.damage, dict(O.energy.items())))
	assert np.array_equal(results[0][0], results[1][0])
	assert np.array_equal(results[0][1], results[1][1])
	assert results[1][2] == pytest.approx(results[0][2], rel=1e-9)  # the book goes on, too


def test_a_finer_block_that_comes_later_is_checked_for_its_time_step_at_once():
	ddem.append(skewed_mesh(), elastic())
	start()
	steps(7)
	ddem.append(skewed_mesh(size=0.003), "elastic", position=(1, 0, 0))
	with pytest.raises(RuntimeError, match="above the critical time step"):
		steps(1)


def test_a_sphere_that_comes_later_does_not_disturb():
	block = ddem.append(skewed_mesh(), elastic())
	engine = start()
	agitate(block, 5)
	steps(5)
	view = engine.array("nodePosition")
	O.bodies.append(sphere((0.5, 0, 0), 0.01))
	steps(5)
	assert np.shares_memory(view, engine.array("nodePosition"))


# --- engines and materials that change


@pytest.mark.parametrize("flow_interval", (1, 4))
def test_a_new_engine_takes_over_the_state_of_the_old_one(flow_interval):
	"""All of it: what flow has waited for, forces, and works that the energy book has yet to take from them."""
	results = []
	for change in (False, True):
		O.reset()
		O.materials.append(ConcreteDamageMat(label="concrete", equationOfState=False))
		block = ddem.append(ddem.mesh.rectangle(0.02, 0.04, size=0.005), "concrete", seed=4)
		platens = ddem.platens(block, velocity=10, ramp=5e-6)
		start(*platens.engines, flowInterval=flow_interval, damping=0.1)
		O.trackEnergy = True
		O.run(202, True)
		if change:
			O.engines = [*O.engines[:-1], DeformableEngine(flowInterval=flow_interval, damping=0.1)]
		O.run(100, True)
		results.append(
			[block.positions.copy(), np.array(block.stress), [v for _, v in sorted(O.energy.items())]]
		)
	for kept, renewed in zip(*results):
		assert np.array_equal(kept, renewed)


def test_material_parameters_changed_between_runs_take_effect():
	material = elastic()
	block = ddem.append(skewed_mesh(), material)
	start(rotation="none", step=0.4)
	for body in bodies([*block.node_ids, *block.triangle_ids]):
		body.state.blockedDOFs = "xyzXYZ"
	place(block, lambda x, y: (1.001 * x, y))
	steps(1)
	before, forces = block.stress, block.node_forces.copy()
	material.young *= 2
	assert block.stress == pytest.approx(2 * before, rel=1e-12, abs=1)
	steps(1)
	assert block.stress == pytest.approx(2 * before, rel=1e-12, abs=1)
	assert block.node_forces == pytest.approx(2 * forces, rel=1e-12, abs=1e-3)
	for change in (
		lambda: setattr(material, "density", 100),
		lambda: setattr(material, "young", 100 * material.young),
	):
		change()  # both make the critical time step smaller
		with pytest.raises(RuntimeError, match="above the critical time step"):
			steps(1)


def test_a_block_of_a_former_scene_says_so():
	block = ddem.append(skewed_mesh(), elastic())
	O.reset()
	ddem.append(ddem.mesh.rectangle(0.02, 0.04, size=0.01), elastic())
	start()
	with pytest.raises(RuntimeError, match="not in the present scene"):
		block.positions


# --- order and threads


@pytest.mark.parametrize("kind, speed, tolerance", [("elastic", 10, 1e-12), ("concrete", 1, 1e-7)])
def test_result_does_not_depend_on_the_order_of_nodes_and_bodies(kind, speed, tolerance):
	"""Up to round-off, which cracks that open and close magnify."""
	mesh = skewed_mesh(size=0.007)
	random = np.random.default_rng(8)
	results = []
	for shuffled in (False, True):
		O.reset()
		material = elastic() if kind == "elastic" else ConcreteDamageMat()
		node_order = random.permutation(len(mesh.nodes)) if shuffled else np.arange(len(mesh.nodes))
		triangle_order = random.permutation(len(mesh.triangles)) if shuffled else np.arange(len(mesh.triangles))
		number = np.argsort(node_order)
		triangles = [
			np.roll(number[mesh.triangles[t]], random.integers(3) if shuffled else 0)
			for t in triangle_order
		]
		node_ids, triangle_ids = append_bodies(mesh.nodes[node_order], triangles, material)
		engine = start()
		for body in bodies([*node_ids, *triangle_ids]):
			x, y = body.state.pos[0], body.state.pos[1]
			# to strains of some 1e-3 times speed
			body.state.vel = (speed * 3 * np.sin(200 * y), speed * (4 * x - 20 * y), 0)
		O.run(300, True)
		results.append(
			(
				engine.array("nodePosition")[number] - mesh.nodes,
				engine.values("stress").mean(axis=1)[np.argsort(triangle_order)],
				engine.values("damage").mean(),
			)
		)
	(moved, stress, damage), (moved_again, stress_again, damage_again) = results
	assert np.abs(moved - moved_again).max() < tolerance * np.abs(moved).max()
	assert np.abs(stress - stress_again).max() < 100 * tolerance * np.abs(stress).max()  # differences of positions
	if kind == "concrete":
		assert damage > 1e-3
		assert damage_again == pytest.approx(damage, rel=100 * tolerance)


THREADS_SCRIPT = """
import sys
import numpy as np
from yade import ddem
O.materials.append(ConcreteDamageMat(label="concrete"))
O.materials.append(DeformableElastMat(label="steel", bulk=151e9, shear=81e9, density=8030))
# 2244 triangles: work for both threads
mesh = ddem.mesh.rectangle(0.1, 0.2, size=0.006, regions={"steel": ddem.mesh.box(0.04, 0.08, 0.06, 0.12)})
block = ddem.append(mesh, {"": "concrete", "steel": "steel"}, seed=1)
platens = ddem.platens(block, velocity=60, ramp=2e-6)
engine = DeformableEngine(label="deformable", damping=0.1, gravity=(0, -10, 0))
O.engines = [ForceResetter()] + platens.engines + [engine]
O.trackEnergy = True
O.dt = ddem.time_step(0.5)
O.run(120, True)
energy = [value for _, value in sorted(O.energy.items())]
arrays = {"position": block.positions, "stress": block.stress, "damage": block.damage, "rotation": block.rotation}
np.savez(sys.argv[1], energy=energy, **arrays)
"""


def test_two_threads_give_bitwise_what_one_gives(tmp_path):
	script = tmp_path / "threads.py"
	script.write_text(THREADS_SCRIPT)
	found = []
	runs = []
	for threads in (1, 2):
		output = tmp_path / f"threads{threads}.npz"
		command = [shutil.which("yade"), "-n", "-x", f"-j{threads}", str(script), str(output)]
		# both run at once: threads that wait should not spin
		environment = {**os.environ, "OMP_WAIT_POLICY": "passive"}
		runs.append(
			(
				output,
				subprocess.Popen(
					command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
					text=True
				),
			)
		)
	for output, run in runs:
		text, _ = run.communicate()
		assert run.returncode == 0, text
		found.append(np.load(output))
	assert found[0]["damage"].max() > 0.1
	for name in found[0].files:
		assert np.array_equal(found[0][name], found[1][name]), name
