# GPL v2 or later, see LICENSE.
"""BondedNewtonIntegrator moves bonded spheres in arrays as NewtonIntegrator moves bodies, whatever else a scene has."""
import builtins
import math
import subprocess
import sys

import numpy as np
import pytest

from yade import (
	Bo1_Sphere_Aabb, BondedInteractionLoop, BondedMat, BondedNewtonIntegrator, ForceEngine, FrictMat, GravityEngine,
	HarmonicMotionEngine, Ip2_BondedMat_BondedMat_BondedPhys, NewtonIntegrator, O, PyRunner, RotationEngine,
	SpatialQuickSortCollider, TorqueEngine, TranslationEngine, TriaxialStressController, Vector3, utils
)
from yade import ddem
from yade.ddem import bonded, packing

from recording import run_recording
from waiting import BackgroundRun, until

RADIUS = 1e-3


@pytest.fixture(autouse=True)
def clean_scene():
	O.reset()
	yield
	O.reset()


def specimen(**material):
	O.materials.append(BondedMat(label="rock", **material))
	return bonded.append(packing.prism(0.01, 0.02, 0.01, rmin=1e-3, rmax=2e-3, seed=1, fails=200), "rock")


def motion(ids):
	"""Everything that State has of bodies, and the forces on them, each over its largest value."""
	states = [O.bodies[int(i)].state for i in ids]
	found = {
		"displacement": [s.displ() for s in states],
		"velocity": [s.vel for s in states],
		"rotation": [s.rot() for s in states],
		"spin": [s.angVel for s in states],
		"force": [O.forces.f(int(i)) for i in ids],
		"torque": [O.forces.t(int(i)) for i in ids],
	}
	return {name: np.array(values, float) for name, values in found.items()}


def with_both(build, steps, **newton):
	"""What both integrators make of a scene: motion of all spheres, and what *build* returns
	to be called at the end."""
	results = []
	for integrator in (NewtonIntegrator, BondedNewtonIntegrator):
		O.reset()
		sample, more = build()
		O.engines = [
			integrator(**{"damping": 0, "mask": e.mask, **newton}) if isinstance(e, NewtonIntegrator) else e
			for e in O.engines
		]
		for _ in range(2):  # between runs everything is written and read again
			O.run(steps // 2, True)
		results.append((motion(sample.ids), more()))
	return results


def agree(one, two, relative=1e-9):
	for name, values in one.items():
		assert two[name] == pytest.approx(values, abs=relative * max(np.abs(values).max(), 1e-300)), name


def shaken(**material):
	"""A sample whose spheres move in all directions, and turn."""
	sample = specimen(cohesion=1e15, **material)
	draw = np.random.default_rng(1)
	for i in sample.ids.tolist():
		O.bodies[i].state.vel = Vector3(*draw.uniform(-1, 1, 3))
		O.bodies[i].state.angVel = Vector3(*draw.uniform(-1e3, 1e3, 3))
	O.engines = bonded.engines()
	O.dt = bonded.time_step(0.5)
	return sample


# ---- alone ----


@pytest.mark.parametrize("settings", (
	{},
	{"damping": 0.3},
	{"gravity": Vector3(1, -9.81e5, 2)},
	{"damping": 0.3, "gravity": Vector3(1, -9.81e5, 2)},
	{"damping": 0.3, "gravity": Vector3(1, -9.81e5, 2), "dampGravity": False},
))
def test_moves_as_newton_integrator(settings):
	one, two = with_both(lambda: (shaken(), lambda: None), 100, **settings)
	agree(one[0], two[0])


def test_turns_a_free_sphere_by_its_spin():
	"""Small angles by a series, large ones exactly: after n steps the angle is n dt ω, mod 2π."""
	O.materials.append(BondedMat(label="rock"))
	for angle in (1e-4, 0.05, 0.19, 0.21, 3.0):
		O.bodies.clear()
		one = O.bodies.append(utils.sphere((0, 0, 0), RADIUS, material="rock"))
		O.engines = bonded.engines()
		O.dt = 1e-6
		axis = Vector3(1, -2, 3).normalized()
		O.bodies[one].state.angVel = angle / O.dt * axis
		O.run(50, True)
		turned = (50 * angle + math.pi) % (2 * math.pi) - math.pi
		assert np.allclose(O.bodies[one].state.rot(), turned * axis, atol=1e-11 * max(1, 50 * angle))


def test_blocked_directions_stay():
	def build():
		sample = shaken()
		for k, i in enumerate(sample.ids.tolist()):
			O.bodies[i].state.blockedDOFs = ("", "x", "yZ", "xyzXY", "XYZ", "xyzXYZ")[k % 6]
		return sample, lambda: None

	one, two = with_both(build, 100, damping=0.2, gravity=Vector3(0, -1e5, 0))
	agree(one[0], two[0])


def test_energy_of_a_vibrating_pair_stays_at_eight_tenths_of_the_bound():
	"""With v(-1/2) v(+1/2) the energy of leapfrog's oscillator is exact; with v(-1/2)² it is half wrong there."""
	O.materials.append(BondedMat(label="rock", cohesion=1e15))
	ids = O.bodies.append([utils.sphere((2 * RADIUS * i, 0, 0), RADIUS, material="rock") for i in range(2)])
	Ip2_BondedMat_BondedMat_BondedPhys().bond([tuple(ids)])
	O.engines = bonded.engines()
	O.dt = 0.8 * 2 / math.sqrt(2 * O.interactions[0, 1].phys.kn / O.bodies[0].state.mass)
	O.trackEnergy = True
	O.bodies[0].state.vel = Vector3(0.1, 0, 0)
	totals = []
	for _ in range(50):
		O.step()
		totals.append(O.energy.total())
	assert totals == pytest.approx([totals[0]] * 50, rel=1e-9)


def test_books_works_of_gravity_and_damping():
	"""Of spheres that fall: m g h, and what local damping takes of it."""
	sample = specimen(cohesion=1e15)
	O.engines = bonded.engines()
	newton = O.engines[-1]
	newton.gravity = Vector3(0, -9.81, 0)
	newton.damping = 0.2
	O.dt = bonded.time_step(0.5)
	O.trackEnergy = True
	O.run(400, True)
	weight = 9.81 * sum(O.bodies[i].state.mass for i in sample.ids.tolist())
	fallen = 0.5 * 9.81 * 0.8 * (O.dt * O.iter)**2
	assert sample.displacements[:, 1] == pytest.approx(-fallen, rel=3e-3)
	assert O.energy["gravWork"] == pytest.approx(-weight * fallen, rel=6e-3)
	assert O.energy["nonviscDamp"] == pytest.approx(0.2 * weight * fallen, rel=6e-3)
	assert abs(O.energy.total()) < 6e-3 * weight * fallen


# ---- with what else YADE has ----


def with_force_engines():
	sample = shaken()
	ids = sample.ids.tolist()
	O.engines = [
		*O.engines[:-1],
		ForceEngine(force=(0, 1e3, 0), ids=ids[:5]),
		TorqueEngine(moment=(0, 0, 1), ids=ids[3:8]), O.engines[-1]
	]
	return sample, lambda: None


def with_gravity_engine():
	sample = shaken()
	O.engines = [*O.engines[:-1], GravityEngine(gravity=(0, -1e5, 0)), O.engines[-1]]
	return sample, lambda: None


def with_permanent_forces():
	sample = shaken()
	for i in sample.ids[:5].tolist():
		O.forces.setPermF(i, Vector3(0, 1e3, 0))
	return sample, lambda: None


@pytest.mark.parametrize("engine", (
	lambda ids: TranslationEngine(translationAxis=(0, 1, 0), velocity=3, ids=ids),
	lambda ids: RotationEngine(rotationAxis=(0, 1, 0), angularVelocity=1e3, rotateAroundZero=True, ids=ids),
	lambda ids: HarmonicMotionEngine(A=(1e-5, 0, 0), f=(1e5, 0, 0), ids=ids),
))
def test_kinematic_engines_drive_spheres(engine):
	def build():
		sample = shaken()
		ids = sample.ids[:10].tolist()
		for i in ids:
			O.bodies[i].state.blockedDOFs = "xyzXYZ"
		O.engines = [*O.engines[:-1], engine(ids), O.engines[-1]]
		return sample, lambda: None

	one, two = with_both(build, 100)
	agree(one[0], two[0])


def with_a_kinematic_engine_on_free_spheres():
	sample = shaken()
	O.engines = [
		*O.engines[:-1],
		TranslationEngine(translationAxis=(1, 0, 0), velocity=3, ids=sample.ids[:10].tolist()),
		O.engines[-1],
	]
	return sample, lambda: None


def with_a_command_that_changes_spheres():
	sample = shaken()
	ids = sample.ids.tolist()

	def change():
		O.bodies[ids[3]].state.vel = Vector3(0, 2, 0)
		O.bodies[ids[4]].state.angVel[1] = 10.0
		O.bodies[ids[5]].state.pos += Vector3(1e-8, 0, 0)
		O.forces.addF(ids[6], Vector3(0, 0, 10))

	builtins.change_spheres = change
	O.engines = [*O.engines, PyRunner(command="change_spheres()", iterPeriod=7)]
	return sample, lambda: None


def with_a_command_before_the_motion():
	sample, more = with_a_command_that_changes_spheres()
	runner = O.engines[-1]
	O.engines = [*O.engines[:-2], runner, O.engines[-2]]
	return sample, more


def with_a_clump():
	sample = shaken()
	O.bodies.clump([int(i) for i in sample.bonds[10]])
	O.bodies.clump([int(i) for i in sample.bonds[200]])
	return sample, lambda: None


def with_a_mask_that_leaves_some_out():
	sample = shaken()
	for i in sample.ids[:20].tolist():
		O.bodies[i].mask = 4 | 1
	for i in sample.ids[20:].tolist():
		O.bodies[i].mask = 2 | 1
	O.engines[-1].mask = 2
	return sample, lambda: None


def with_a_ball_of_steel():
	sample = shaken()
	O.materials.append(FrictMat(label="steel", young=200e9, density=7800))
	ball = O.bodies.append(utils.sphere((0.005, 0.0243, 0.005), 0.004, material="steel"))
	O.bodies[ball].state.vel = Vector3(0, -20, 0)
	return sample, lambda: np.array([*O.bodies[ball].state.pos, *O.bodies[ball].state.vel])


def between_platens_with_damping():
	sample = specimen()
	platens = bonded.platens(sample, velocity=2.0, ramp=10e-6)
	O.engines = bonded.engines(platens, viscosity=2e3)
	O.dt = bonded.time_step(0.5)
	O.trackEnergy = True
	return sample, lambda: np.array([platens.stress, O.energy["bodyDamping"], O.energy["externalWork"]])


@pytest.mark.parametrize("build", (
	with_force_engines, with_gravity_engine, with_permanent_forces, with_a_kinematic_engine_on_free_spheres,
	with_a_command_that_changes_spheres, with_a_command_before_the_motion, with_a_clump,
	with_a_mask_that_leaves_some_out, with_a_ball_of_steel, between_platens_with_damping
))
def test_agrees_in_a_scene(build):
	one, two = with_both(build, 200)
	agree(one[0], two[0], 1e-7)
	if one[1] is not None:
		assert two[1] == pytest.approx(one[1], rel=1e-6)


def test_controllers_that_act_in_every_step():
	def build():
		sample = specimen()
		walls = O.bodies.append(utils.aabbWalls(thickness=1e-3, material="rock", oversizeFactor=1.2))
		control = TriaxialStressController(
			internalCompaction=False, stressMask=7, goal1=-2e6, goal2=-2e6, goal3=-2e6, max_vel=1,
			thickness=1e-3,
			**{
				f"wall_{name}_id": i
				for name, i in zip(("left", "right", "bottom", "top", "back", "front"), walls)
			}
		)
		O.engines = [*bonded.engines()[:-1], control, NewtonIntegrator()]
		O.dt = bonded.time_step(0.5)
		return sample, lambda: np.array(control.stress(0))

	one, two = with_both(build, 300)
	agree(one[0], two[0], 1e-7)
	assert two[1] == pytest.approx(one[1], rel=1e-6, abs=1)


# ---- looks ----


def test_a_command_sees_and_changes_what_it_touches():
	"""Positions in every step are those of a run that is looked at step by step."""
	seen, expected = [], []
	for together in (True, False):
		O.reset()
		sample = shaken()
		first = int(sample.ids[20])

		def record(to=seen if together else expected):
			state = O.bodies[first].state
			to.append((*state.pos, *state.vel, *state.ori, *O.forces.f(first)))

		if together:
			builtins.record_sphere = record
			O.engines = [*O.engines, PyRunner(command="record_sphere()", iterPeriod=1)]
			O.run(30, True)
		else:
			for _ in range(30):
				O.step()
				record()
	assert len(seen) >= 29
	assert np.array(seen) == pytest.approx(np.array(expected[-len(seen):]), rel=1e-9, abs=1e-15)


def test_arrays_are_those_of_state_without_writing_it():
	"""Whole-sample arrays come from where the spheres are; what a command has changed is in them."""
	sample = shaken()
	first = int(sample.ids[0])
	seen = []

	def look():
		O.bodies[first].state.vel = Vector3(1, 2, 3)
		arrays = {
			name: BondedInteractionLoop.sphereArray(sample.ids, name)
			for name in ("position", "displacement", "velocity", "spin", "rotation")
		}
		states = [O.bodies[i].state for i in sample.ids.tolist()]
		expected = (
			[s.pos for s in states], [s.displ() for s in states], [s.vel for s in states],
			[s.angVel for s in states], [s.rot() for s in states]
		)
		seen.append([np.array_equal(a, np.array(b, float)) for a, b in zip(arrays.values(), expected)])

	run_recording(20, 5, look)
	assert len(seen) >= 4 and np.all(seen)
	with pytest.raises(ValueError, match="'place' is unknown; there are position"):
		BondedInteractionLoop.sphereArray(sample.ids, "place")
	wall = O.bodies.append(utils.wall(0, axis=1, material="rock"))
	with pytest.raises(ValueError, match=f"body #{wall} is no sphere"):
		BondedInteractionLoop.sphereArray([wall], "position")


def test_bonds_as_arrays_are_those_of_the_interactions():
	"""Also in a command, which sees the bonds' geometry of the step although it is written only when read."""
	sample = shaken()
	seen = []

	def look():
		bonds = bonded.law().bondArrays()
		pairs = [O.interactions[int(i), int(j)] for i, j in bonds["ids"]]
		normal = np.array([i.geom.normal for i in pairs])
		force = np.array([i.phys.normalForce for i in pairs])
		shear = np.array([i.phys.shearForce.norm() for i in pairs])
		stress = np.array([(i.phys.normalStress, i.phys.shearStress) for i in pairs])
		scale = np.abs(bonds["axialForce"]).max()
		seen.append((
			abs(bonds["axialForce"] + (normal * force).sum(axis=1)).max() / scale,
			abs(bonds["shearForce"] - shear).max() / scale,
			np.array_equal(np.column_stack([bonds["normalStress"], bonds["shearStress"]]), stress),
		))

	run_recording(20, 5, look)
	for axial, shear, same in seen:
		assert axial < 1e-9 and shear < 1e-9 and same
	assert len(sample.bond_forces) == len(sample.bonds) == len(sample.bond_radii)


def test_all_is_written_at_the_end_of_a_run():
	sample = shaken()
	O.run(40, True)
	found = motion(sample.ids)
	mass = np.array([[O.bodies[i].state.mass] for i in sample.ids.tolist()])
	before = sample.velocities
	O.step()
	# the force that a step shows is the one that changed the velocity in it
	assert O.dt * motion(sample.ids)["force"] / mass == pytest.approx(sample.velocities - before, abs=1e-9)
	assert not np.allclose(found["velocity"], sample.velocities)


def test_contacts_follow_the_fragments():
	"""The collider acts in time: loose spheres that fly into each other bounce, at any Verlet distance."""
	O.materials.append(BondedMat(label="rock", frictionStatic=0, frictionDynamic=0))
	for verlet in (-0.5, -0.01, 0):
		O.bodies.clear()
		ids = O.bodies.append([utils.sphere((x, 0, 0), RADIUS, material="rock") for x in (0, 5e-3)])
		O.engines = bonded.engines()
		O.engines[1].verletDist = verlet
		O.bodies[ids[1]].state.vel = Vector3(-10, 0, 0)
		O.dt = 1e-8
		O.run(60_000, True)
		assert O.bodies[ids[0]].state.vel[0] == pytest.approx(-10, rel=1e-3)
		assert abs(O.bodies[ids[1]].state.vel[0]) < 1e-2


def test_goes_on_after_saving(tmp_path):
	sample = shaken()
	O.run(50, True)
	O.save(str(tmp_path / "scene.yade.gz"))
	O.run(50, True)
	expected = motion(sample.ids)
	O.load(str(tmp_path / "scene.yade.gz"))
	assert isinstance(O.engines[-1], BondedNewtonIntegrator)
	O.run(50, True)
	again = motion(bonded.BondedSample.from_scene().ids)
	for name, values in expected.items():
		assert np.array_equal(again[name], values), name


def test_crushing_does_not_depend_on_threads(tmp_path):
	"""Bonds, contacts of fragments, motion: bit by bit; no wall, whose forces YADE sums."""
	script = tmp_path / "threads.py"
	script.write_text(
		"from yade import ddem\n"
		"from yade.ddem import bonded, packing\n"
		"O.materials.append(BondedMat(label='rock', cohesion=20e6))\n"
		"sample = bonded.append(packing.prism(0.01, 0.02, 0.01, rmin=1e-3, rmax=2e-3, seed=1, fails=200), "
		"'rock')\nO.engines = bonded.engines()\n"
		"O.dt = bonded.time_step(0.5)\n"
		"for i in sample.ids.tolist():\n"
		"	O.bodies[i].state.vel = Vector3(0, -400 * (O.bodies[i].state.pos[1] - 0.01), 0)\n"
		"O.trackEnergy = True\n"
		"O.run(1500, True)\n"
		"print(bonded.law().brokenCount(), O.energy['friction'], file=open('crushed', 'w'))\n"
		"open('positions', 'w').write(repr(sample.positions.tolist()))\n"
	)
	found = []
	for threads in (1, 2):
		command = [sys.executable, "/usr/bin/yade", "-n", "-x", f"-j{threads}", str(script)]
		subprocess.run(command, cwd=tmp_path, check=True, capture_output=True)
		found.append((tmp_path / "positions").read_text())
	broken, friction = map(float, (tmp_path / "crushed").read_text().split())
	assert broken > 100 and friction > 1e-3
	assert found[0] == found[1]


def grow(ids):
	O.bodies[ids[3]].shape.radius *= 1.03


def mask_out(ids):
	O.bodies[ids[3]].mask = 4


def undamp(ids):
	O.bodies[ids[3]].state.isDamped = False


def make_heavy(ids):
	O.bodies[ids[3]].state.mass *= 2
	O.bodies[ids[4]].state.inertia = Vector3(1, 2, 3) * O.bodies[ids[4]].state.inertia[0]


def erase_others(ids):
	O.bodies.erase(max(b.id for b in O.bodies))
	O.bodies.erase(ids[7])


def add_one(ids):
	O.bodies.append(utils.sphere((0.005, 0.03 + 1e-4 * O.iter, 0), RADIUS, material="rock"))


def clump(ids):
	O.bodies.clump([ids[10], ids[11]])


def change_material(ids):
	O.bodies[ids[3]].mat = O.materials["other"]


@pytest.mark.parametrize("place", ("before the motion", "at the end"))
@pytest.mark.parametrize(
	"change", (grow, mask_out, undamp, make_heavy, erase_others, add_one, clump, change_material)
)
def test_a_command_may_change_bodies_and_the_scene(change, place):
	"""Now and then, not in every step: what it did must not be forgotten."""

	def build():
		sample = shaken()
		ids = sample.ids.tolist()
		O.materials.append(BondedMat(label="other", young=50e9))
		O.bodies.append(utils.sphere((0.05, 0.05, 0), RADIUS, material="rock"))
		done = []

		def command():
			if len(done) < 1:
				change(ids)
			done.append(1)

		builtins.change_scene = command
		runner = PyRunner(command="change_scene()", iterPeriod=20, firstIterRun=20)
		O.engines[-1].mask = 1
		last = O.engines[-1]
		O.engines = [*O.engines[:-1], *((runner, last) if place == "before the motion" else (last, runner))]
		return sample, lambda: len(done)

	one, two = with_both(build, 120, damping=0.2)
	agree(one[0], two[0], 1e-6)
	assert one[1] == two[1] >= 5


def test_a_loop_that_is_dead_moves_nothing():
	def build():
		sample = shaken()
		O.run(30, True)
		O.engines[2].dead = True
		return sample, lambda: O.engines[2].dead

	one, two = with_both(build, 60)
	agree(one[0], two[0], 1e-7)


def test_other_colliders_act_in_every_step():
	def build():
		sample = shaken()
		O.engines = [O.engines[0], SpatialQuickSortCollider([Bo1_Sphere_Aabb()]), *O.engines[2:]]
		return sample, lambda: None

	one, two = with_both(build, 40)
	agree(one[0], two[0], 1e-7)


def test_a_scene_that_loses_all_its_bodies_goes_on():
	shaken()
	O.run(10, True)
	O.bodies.clear()
	O.step()
	assert len(bonded.law().bondArrays()["ids"]) == 0


def test_bonds_may_be_asked_for_while_a_run_with_a_command_begins():
	"""Python's lock and ours are never taken in both orders."""
	sample = shaken()
	builtins.see_spheres = lambda: None
	O.engines = [*O.engines, PyRunner(command="see_spheres()", iterPeriod=50)]
	run = BackgroundRun()
	for _ in range(300):
		assert len(sample.bonds) == sample.initial_bonds
		assert sample.positions.shape == (len(sample), 3)
	until(lambda: O.iter > 500)
	run.pause()


def test_a_pause_shows_the_last_step_and_what_is_set_then_counts():
	sample = shaken()
	one = int(sample.ids[0])
	for _ in range(60):
		begin = O.iter
		run = BackgroundRun()
		until(lambda: O.iter > begin + 3)
		run.pause()
		assert np.array_equal(sample.positions[0], np.array(O.bodies[one].state.pos, float))
		O.bodies[one].state.vel = Vector3(1e3, 0, 0)
		O.step()
		assert O.bodies[one].state.vel[0] > 500
		O.bodies[one].state.vel = Vector3(0, 0, 0)


# ---- errors ----


def test_after_an_error_state_is_what_the_user_sees_and_sets():
	sample = shaken()
	O.run(30, True)
	right = O.dt
	O.dt = 100 * right
	with pytest.raises(RuntimeError, match="above the critical time step"):
		O.step()
	one = int(sample.ids[0])
	assert np.array_equal(sample.positions[0], np.array(O.bodies[one].state.pos, float))
	O.dt = right
	O.bodies[one].state.vel = Vector3(500, 0, 0)
	O.step()
	assert O.bodies[one].state.vel[0] == pytest.approx(500, rel=0.01)


def test_must_come_after_the_interactions():
	specimen()
	engines = bonded.engines()
	O.engines = [engines[0], engines[1], engines[3], engines[2]]
	O.dt = bonded.time_step(0.5)
	with pytest.raises(RuntimeError, match="BondedNewtonIntegrator comes before BondedInteractionLoop"):
		O.step()


def test_a_sphere_without_mass_is_named():
	sample = specimen()
	O.engines = bonded.engines()
	O.dt = bonded.time_step(0.5)
	O.bodies[int(sample.ids[3])].state.mass = 0
	with pytest.raises(RuntimeError, match=rf"bonded sphere #{sample.ids[3]} has a mass of 0 kg"):
		O.step()


def test_a_free_sphere_that_is_not_a_number_is_named():
	O.materials.append(BondedMat(label="rock"))
	one = O.bodies.append(utils.sphere((0, 0, 0), RADIUS, material="rock"))
	O.engines = bonded.engines()
	O.dt = 1e-6
	O.step()
	O.bodies[one].state.angVel = Vector3(0, math.nan, 0)
	with pytest.raises(
		RuntimeError, match=rf"motion of the bonded sphere #{one}, at .* became infinite or not a number"
	):
		O.step()


def test_without_a_bonded_loop_it_is_a_newton_integrator():
	O.materials.append(BondedMat(label="rock"))
	one = O.bodies.append(utils.sphere((0, 0, 0), RADIUS, material="rock"))
	O.engines = [bonded.engines()[0], BondedNewtonIntegrator(damping=0, gravity=(0, -10, 0))]
	O.dt = 1e-6
	O.run(10, True)
	assert O.bodies[one].state.vel[1] == pytest.approx(-10 * 10e-6)
	assert ddem.bonded.DEFAULT_GAP > 0
