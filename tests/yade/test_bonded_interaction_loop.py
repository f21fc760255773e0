# GPL v2 or later, see LICENSE.
# BondedInteractionLoop, which computes bonds all together, does what the functors do one by one in an InteractionLoop.

import numpy as np
import pytest

from yade import (
	BondedInteractionLoop, BondedMat, ForceResetter, Ig2_Sphere_Sphere_ScGeom, Ig2_Wall_Sphere_ScGeom,
	InteractionLoop, Ip2_BondedMat_BondedMat_BondedPhys, Ip2_ElasticWallMat_BondedMat_ElasticWallPhys,
	Law2_ScGeom_BondedPhys_Bonded, Law2_ScGeom_ElasticWallPhys_Repulsion, NewtonIntegrator, O, SumIntrForcesCb,
	Vector3, utils
)
from yade.ddem import bonded, packing

from recording import run_recording
from waiting import BackgroundRun, until

CONVENTIONS = ("consistent", "esys")


@pytest.fixture(autouse=True)
def clean_scene():
	O.reset()
	yield
	O.reset()


def specimen(convention="consistent", together=True, **material):
	O.reset()
	O.materials.append(BondedMat(label="rock", **material))
	sample = bonded.append(packing.prism(0.01, 0.02, 0.01, rmin=1e-3, rmax=2e-3, seed=1, fails=200), "rock")
	platens = bonded.platens(sample, velocity=2.0, ramp=10e-6)
	O.engines = bonded.engines(platens, viscosity=2, convention=convention)
	if not together:
		functors = (
			[Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],
			[Ip2_BondedMat_BondedMat_BondedPhys(), Ip2_ElasticWallMat_BondedMat_ElasticWallPhys()],
			[
				Law2_ScGeom_BondedPhys_Bonded(convention=convention),
				Law2_ScGeom_ElasticWallPhys_Repulsion(),
			]
		)
		O.engines = [e if not isinstance(e, InteractionLoop) else InteractionLoop(*functors) for e in O.engines]
		O.engines = O.engines[:-1] + [NewtonIntegrator(damping=0)]
	O.trackEnergy = True
	O.dt = bonded.time_step(0.5)
	return sample, platens


def loads(sample):
	return np.array([[*O.forces.f(int(i)), *O.forces.t(int(i))] for i in sample.ids])


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_equals_the_functors(convention):
	results = []
	for together in (False, True):
		sample, platens = specimen(convention, together)
		O.run(400, True)  # up to the first broken bonds
		pairs = bonded.law().bonds()
		pressed = [(i, j) for i, j in pairs["ids"][::50]]
		geometry = np.array(
			[
				[
					*O.interactions[i, j].geom.normal,
					O.interactions[i, j].geom.penetrationDepth,
					*O.interactions[i, j].geom.contactPoint,
				]
				for i, j in pressed
			]
		)
		forces = np.array(
			[
				[*O.interactions[i, j].phys.normalForce, *O.interactions[i, j].phys.shearForce]
				for i, j in pressed
			]
		)
		results.append(
			(
				sample.positions, loads(sample), np.array(pairs["normalStress"]), geometry, forces,
				sample.broken, platens.stress, dict(O.energy.items())
			)
		)
	one, all_ = results
	assert len(one[5]) > 0
	for name in ("id1", "id2", "step", "mode"):
		assert np.array_equal(one[5][name], all_[5][name])
	assert all_[5]["normal_stress"] == pytest.approx(one[5]["normal_stress"], rel=1e-4)
	assert all_[0] == pytest.approx(one[0], abs=1e-13)
	assert all_[1] == pytest.approx(one[1], abs=1e-5 * np.abs(one[1]).max())
	assert all_[2] == pytest.approx(one[2], abs=1e-4 * np.abs(one[2]).max())
	assert all_[3] == pytest.approx(one[3], abs=1e-9)
	assert all_[4] == pytest.approx(one[4], abs=1e-5 * np.abs(one[4]).max())
	assert all_[6] == pytest.approx(one[6], rel=1e-6)
	for entry, value in one[7].items():
		if entry == "kinetic":  # of another instant, see BondedNewtonIntegrator
			continue
		assert all_[7][entry] == pytest.approx(value, rel=1e-4, abs=1e-9 * one[7]["bondElastic"]), entry


def test_goes_back_to_the_functors_in_the_middle_of_a_run():
	sample, _ = specimen()
	O.run(300, True)
	together = O.engines
	O.engines = [
		InteractionLoop(e.geomDispatcher.functors, e.physDispatcher.functors, e.lawDispatcher.functors)
		if isinstance(e, BondedInteractionLoop)
		else e
		for e in O.engines
	]
	O.run(100, True)
	mixed = sample.positions
	sample, _ = specimen()
	O.run(400, True)
	assert mixed == pytest.approx(sample.positions, abs=1e-13)


def test_notices_bonds_made_and_erased_between_steps():
	O.materials.append(BondedMat(label="rock"))
	ids = O.bodies.append([utils.sphere((2e-3 * i, 0, 0), 1e-3, material="rock") for i in range(4)])
	bond = Ip2_BondedMat_BondedMat_BondedPhys().bond
	bond([(0, 1), (1, 2)])
	O.engines = bonded.engines()
	O.engines[-1].mask = 2  # nothing moves unless the test moves it
	O.dt = 1e-9

	def force(body):
		O.step()
		return O.forces.f(body)[0]

	O.bodies[3].state.pos += Vector3(1e-7, 0, 0)
	assert force(3) == 0
	O.bodies[3].state.pos -= Vector3(1e-7, 0, 0)
	bond([(2, 3)])
	O.bodies[3].state.pos += Vector3(1e-7, 0, 0)
	pulled = force(3)
	assert pulled < 0
	held = O.interactions[2, 3].phys  # keeps the bond's physics alive when the interaction is gone
	O.interactions.erase(2, 3)
	assert force(3) == 0 and held.bonded
	O.bodies[1].state.pos += Vector3(0, 1e-7, 0)
	assert O.forces.f(0)[1] == 0 and force(0) == 0 and O.forces.f(0)[1] > 0
	O.bodies.erase(1)
	assert force(0) == 0 and O.forces.f(0)[1] == 0
	assert len(bonded.law().bonds()["ids"]) == 0
	assert ids == [0, 1, 2, 3]


def test_shows_bonds_to_engines_that_may_look():
	sample, platens = specimen()
	seen = []
	pair = bonded.law().bonds()["ids"][10]
	run_recording(
		50,
		7,
		lambda: seen.append(
			(
				O.iter,
				O.interactions[pair].phys.normalForce.norm(),
				O.interactions[pair].geom.contactPoint[1],
			)
		),
	)
	rest = []
	sample, platens = specimen()
	for iteration, *_ in seen:
		O.run(iteration + 1 - O.iter, True)
		rest.append(
			(
				iteration,
				O.interactions[pair].phys.normalForce.norm(),
				O.interactions[pair].geom.contactPoint[1],
			)
		)
	assert len(seen) >= 7 and seen == rest


def test_does_not_depend_on_the_number_of_threads(subprocess_positions):
	one, two = (subprocess_positions(threads) for threads in (1, 2))
	assert len(one) == len(two) and one == two


@pytest.fixture
def subprocess_positions(tmp_path):
	"""Positions and number of broken bonds of the specimen after some steps,
	from a YADE of its own with the given threads."""
	import subprocess
	import sys
	script = tmp_path / "threads.py"
	script.write_text(
		"from yade import ddem\n"
		"from yade.ddem import bonded, packing\n"
		"O.materials.append(BondedMat(label='rock', cohesion=1e15))\n"
		"sample = bonded.append(packing.prism(0.01, 0.02, 0.01, rmin=1e-3, rmax=2e-3, seed=1, fails=200), "
		"'rock')\nO.engines = bonded.engines()\n"
		"O.dt = bonded.time_step(0.5)\n"
		"for i in sample.ids.tolist(): O.bodies[i].state.vel = Vector3(0, -50 * O.bodies[i].state.pos[1], 0)\n"
		"O.run(200, True)\n"
		"open('positions', 'w').write(repr(sample.positions.tolist()))\n"
	)

	def run(threads):
		command = [sys.executable, "/usr/bin/yade", "-n", "-x", f"-j{threads}", str(script)]
		subprocess.run(command, cwd=tmp_path, check=True, capture_output=True)
		return (tmp_path / "positions").read_text()

	return run


def test_stops_at_the_bond_that_is_not_a_number():
	sample, _ = specimen()
	O.run(3, True)
	body = int(sample.bonds[5][0])
	O.bodies[body].state.pos = Vector3(0, float("nan"), 0)
	with pytest.raises(
		RuntimeError,
		match=rf"the bond of bodies #.* became infinite or not a number in step .*, t = .* s; .* check O.dt",
	):
		O.step()


def test_stops_at_what_is_not_a_number_also_where_bonds_are_broken():
	sample, _ = specimen()
	one, two = sample.bonds[5].tolist()
	O.bodies[two].state.pos += Vector3(1e-3, 0, 0)
	O.step()
	assert bonded.law().brokenCount() > 0
	body = int(sample.broken["id1"][0])
	O.bodies[body].state.pos = Vector3(0, float("nan"), 0)
	with pytest.raises(RuntimeError, match="became infinite or not a number"):
		O.step()


def test_may_be_asked_for_bonds_at_any_time():
	sample, _ = specimen()
	counts = []
	run = BackgroundRun()
	while len(counts) < 100 or O.iter < 3000:
		assert O.running
		counts.append((len(sample.bonds), bonded.law().brokenCount(), len(sample.broken)))
	run.pause()
	held, broken, records = np.array(counts).T
	assert (np.diff(held) <= 0).all() and (np.diff(broken) >= 0).all() and (records >= broken).all()
	assert len(sample.bonds) + bonded.law().brokenCount() == sample.initial_bonds


def test_may_be_asked_for_bonds_while_the_first_step_begins():
	"""The collider fills the list of interactions then."""
	spheres = packing.prism(0.01, 0.02, 0.01, rmin=1e-3, rmax=2e-3, seed=1, fails=200)
	for _ in range(15):
		O.reset()
		O.materials.append(BondedMat(label="rock"))
		sample = bonded.append(spheres, "rock")
		O.engines = bonded.engines()
		O.dt = bonded.time_step(0.5)
		run = BackgroundRun()
		while O.iter < 3:
			assert len(sample.bonds) == sample.initial_bonds
		run.pause()


def test_survives_a_bond_erased_after_a_pause():
	sample, _ = specimen(cohesion=1e15)
	for _ in range(20):
		begin = O.iter
		run = BackgroundRun(100_000)
		until(lambda: O.iter > begin + 1)
		run.pause()
		before = len(bonded.law().bonds()["ids"])
		O.interactions.erase(*(int(i) for i in sample.bonds[3]))
		assert len(bonded.law().bonds()["ids"]) == before - 1
	O.step()
	assert len(sample.bonds) == sample.initial_bonds - 20


def test_takes_up_stiffnesses_changed_by_hand():
	O.materials.append(BondedMat(label="rock"))
	ids = O.bodies.append([utils.sphere((2e-3 * i, 0, 0), 1e-3, material="rock") for i in range(2)])
	Ip2_BondedMat_BondedMat_BondedPhys().bond([tuple(ids)])
	O.engines = bonded.engines()
	O.engines[-1].mask = 2
	O.dt = 1e-9
	O.bodies[1].state.pos += Vector3(1e-7, 0, 0)
	O.step()
	force = O.forces.f(0)[0]
	O.interactions[0, 1].phys.kn *= 2
	O.step()
	assert O.forces.f(0)[0] == pytest.approx(2 * force)


@pytest.mark.parametrize("change", ["callbacks", "sorted"])
def test_leaves_bonds_to_the_functors_where_the_base_class_must_be_asked(change):
	sample, _ = specimen(cohesion=1e15)
	O.run(50, True)
	loop = O.engines[2]
	if change == "callbacks":
		loop.callbacks = [SumIntrForcesCb()]
	else:
		loop.loopOnSortedInteractions = True
	O.run(50, True)
	mixed = sample.positions
	sample, _ = specimen(cohesion=1e15)
	O.run(100, True)
	assert mixed == pytest.approx(sample.positions, abs=1e-14)


def test_keeps_samples_apart():
	O.materials.append(BondedMat(label="rock"))
	samples = [
		bonded.append(packing.Packing([(0, y, 0), (2e-3, y, 0), (4e-3, y, 0)], [1e-3] * 3), "rock")
		for y in (0, 1)
	]
	O.engines = bonded.engines()
	O.engines[-1].mask = 2
	O.dt = 1e-9
	O.bodies[5].state.pos += Vector3(1e-3, 0, 0)
	O.step()
	assert [s.broken_fraction for s in samples] == [0, 0.5]
	assert [len(s.bonds) for s in samples] == [2, 1] and [len(s.broken) for s in samples] == [0, 1]


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_goes_on_after_saving(convention, tmp_path):
	sample, _ = specimen(convention)
	O.run(500, True)
	assert bonded.law().brokenCount() > 0
	O.save(str(tmp_path / "scene.yade.gz"))
	O.run(100, True)
	expected, broken = sample.positions, sample.broken
	O.load(str(tmp_path / "scene.yade.gz"))
	assert isinstance(O.engines[2], BondedInteractionLoop) and bonded.law().convention == convention
	O.run(100, True)
	again = bonded.BondedSample.from_scene()
	# contacts are summed in the order in which the collider has found them
	assert again.positions == pytest.approx(expected, abs=1e-12)
	assert np.array_equal(again.broken["id1"], broken["id1"]) and np.array_equal(
		again.broken["step"], broken["step"]
	)


def test_needs_functors_for_what_it_meets():
	O.materials.append(BondedMat(label="rock"))
	O.bodies.append(
		[utils.sphere((0, 0, 0), 1e-3, material="rock"), utils.sphere((1.9e-3, 0, 0), 1e-3, material="rock")]
	)
	loop = BondedInteractionLoop([Ig2_Sphere_Sphere_ScGeom()], [], [Law2_ScGeom_BondedPhys_Bonded()])
	O.engines = [ForceResetter(), bonded.engines()[1], loop, NewtonIntegrator()]
	O.dt = 1e-9
	with pytest.raises(RuntimeError, match="no Ip2 functor for BondedMat and BondedMat"):
		O.step()


def test_unknown_convention():
	with pytest.raises(ValueError, match="convention = 'mine' is unknown; use 'consistent' or 'esys'"):
		Law2_ScGeom_BondedPhys_Bonded(convention="mine")


def test_esys_has_no_gradual_friction():
	for option in ({"gradualFriction": True}, {"normalDamping": 0.1}, {"shearDamping": 0.1}):
		specimen("esys", **option)
		with pytest.raises(ValueError, match="'rock': the convention 'esys' has neither gradualFriction"):
			bonded.check()
