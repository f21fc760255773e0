# GPL v2 or later, see LICENSE.
# Walls that are bonded to spheres: tension tests.
import math

import numpy as np
import pytest

from yade import BondedMat, ElasticWallMat, Ip2_ElasticWallMat_BondedMat_ElasticWallPhys, O, Vector3, utils
from yade.ddem import bonded, packing

from recording import run_recording

RADIUS, COHESION, YOUNG = 1e-3, 50e6, 100e9


@pytest.fixture(autouse=True)
def clean_scene():
	O.reset()
	yield
	O.reset()


def column(count=6, velocity=-1e-3, shear_stiffness=0.0, **material):
	"""A column of touching spheres between bonded walls."""
	O.reset()
	O.materials.append(
		BondedMat(
			label="rock",
			**{**dict(young=YOUNG, cohesion=COHESION, bondFrictionAngle=math.atan(0.5)), **material},
		)
	)
	spheres = packing.Packing(
		[(0, (2 * i + 1) * RADIUS, 0) for i in range(count)],
		[RADIUS] * count,
		lower=(-RADIUS, 0, -RADIUS),
		upper=(RADIUS, 2 * count * RADIUS, RADIUS),
	)
	sample = bonded.append(spheres, "rock")
	platens = bonded.platens(
		sample, velocity=velocity, ramp=0, stiffness=200e9, bonded=True, shear_stiffness=shear_stiffness
	)
	O.engines = bonded.engines(platens, viscosity=1e5)
	O.dt = bonded.time_step(0.5)
	return sample, platens


@pytest.mark.parametrize("convention", ["consistent", "esys"])
def test_a_column_stretches_as_springs_in_series_and_breaks_at_the_tension_limit(convention):
	sample, platens = column()
	O.engines = bonded.engines(platens, viscosity=1e5, convention=convention)
	bond, wall = math.pi * YOUNG * RADIUS / 2, math.pi * RADIUS * 200e9
	stiffness = 1 / (5 / bond + 2 / wall)
	pulled = []

	def record():
		pulled.append((-platens.strain * platens.height, -platens.force_top, -platens.force_bottom))
		if bonded.law().brokenCount():
			O.pause()

	run_recording(200_000, 200, record)
	way, top, bottom = np.array(pulled[:-1]).T
	slow = top > 0.3 * top.max()
	assert top[slow] == pytest.approx(stiffness * way[slow], rel=0.01)
	assert bottom[slow] == pytest.approx(top[slow], rel=0.01)
	limit = COHESION / 0.5 * math.pi * RADIUS**2
	assert 0.98 * limit < top.max() <= 1.01 * limit
	broken, = bonded.law().brokenBonds()[:1]
	assert broken.mode == "tension" and broken.normalStress == pytest.approx(COHESION / 0.5, rel=1e-3)


def test_the_strength_of_a_column_is_that_of_its_tension_cut_off():
	_, platens = column(tensileStrength=20e6)
	forces = []

	def record():
		forces.append(-platens.force_top)
		if bonded.law().brokenCount():
			O.pause()

	run_recording(200_000, 50, record)
	assert max(forces) == pytest.approx(20e6 * math.pi * RADIUS**2, rel=0.02)


def test_ends_contract_unless_walls_hold_them():
	for shear_stiffness, held in ((0.0, False), (200e9, True)):
		sample, platens = column(velocity=-1e-9, shear_stiffness=shear_stiffness)
		O.bodies[int(sample.ids[0])].state.pos += Vector3(1e-7, 0, 0)
		O.step()
		side = O.forces.f(platens.bottom)[0]
		assert side == pytest.approx(math.pi * RADIUS * 200e9 * 1e-7 if held else 0, rel=1e-9)


def test_time_step_counts_the_walls_springs():
	sample, _ = column(shear_stiffness=1e13)
	stiff = bonded.critical_time_step()
	O.dt = 0.9 * stiff
	O.bodies[int(sample.ids[0])].state.pos += Vector3(1e-9, 0, 0)
	O.run(500, True)
	assert np.abs(sample.velocities).max() < 1
	O.dt = 1.01 * stiff
	with pytest.raises(RuntimeError, match="above the critical time step"):
		O.run(500, True)
	column()
	assert stiff < 0.3 * bonded.critical_time_step()


@pytest.mark.parametrize("bonded_walls", [True, False])
def test_yade_s_own_functions_understand_walls(bonded_walls):
	"""utils.getStress and others take the physics of every contact for NormShearPhys."""
	O.materials.append(BondedMat(label="rock"))
	spheres = packing.Packing(
		[(0, RADIUS, 0), (0, 3 * RADIUS, 0)],
		[RADIUS] * 2,
		lower=(-RADIUS, 0, -RADIUS),
		upper=(RADIUS, 4 * RADIUS, RADIUS),
	)
	sample = bonded.append(spheres, "rock")
	platens = bonded.platens(sample, velocity=0.01, bonded=bonded_walls)
	O.engines = bonded.engines(platens, viscosity=1e5)
	O.dt = bonded.time_step(0.5)
	O.run(2000, True)
	volume = 16 * RADIUS**3
	stress = utils.getStress(volume)
	assert stress[1, 1] == pytest.approx(-platens.force_top * 4 * RADIUS / volume, rel=0.05)
	assert abs(stress[0, 0]) < 1e-6 * abs(stress[1, 1])
	assert 0 <= utils.unbalancedForce() < 1


def test_only_spheres_at_the_wall_are_bonded_to_it():
	sample, platens = column()
	held = {i.id2 for i in O.interactions if hasattr(i.phys, "wallStiffness") and i.phys.bonded}
	assert held == {int(sample.ids[0]), int(sample.ids[-1])}


def test_walls_go_on_holding_after_the_collider_has_run():
	sample, platens = column(cohesion=1e12, velocity=-5)
	O.run(2000, True)
	assert -platens.strain * platens.height > 0.05 * RADIUS  # stretched far beyond the boxes of the collider
	assert sum(1 for i in O.interactions if i.isReal and hasattr(i.phys, "wallStiffness")) == 2
	assert platens.force_top < 0 and platens.force_bottom < 0


def test_bonded_walls_push_as_well():
	_, platens = column(velocity=1e-3)
	O.run(2000, True)
	assert platens.force_top > 0 and platens.force_bottom > 0


def test_bad_input():
	O.materials.append(BondedMat(label="rock"))
	sample = bonded.append(
		packing.Packing(
			[(0, RADIUS, 0), (0, 3 * RADIUS, 0)],
			[RADIUS] * 2,
			lower=(-RADIUS, 0, -RADIUS),
			upper=(RADIUS, 5 * RADIUS, RADIUS),
		),
		"rock",
	)
	with pytest.raises(ValueError, match="no sphere is within 1.1 radii of the upper face"):
		bonded.platens(sample, velocity=-1, bonded=True)
	with pytest.raises(ValueError, match="bonded=True makes walls that pull"):
		bonded.platens(sample, velocity=-1)
	with pytest.raises(ValueError, match="shearStiffness = -1 Pa must not be negative"):
		bonded.platens(sample, velocity=-1, bonded=True, shear_stiffness=-1)
	assert len(O.bodies) == 2
	bond = Ip2_ElasticWallMat_BondedMat_ElasticWallPhys().bond
	with pytest.raises(ValueError, match="#0: it is no Wall of ElasticWallMat"):
		bond(0, [1])
	wall = O.bodies.append(utils.wall(0.0, axis=1, material=ElasticWallMat()))
	for spheres, words in (
		([wall], f"body #{wall} is no sphere of BondedMat"),
		([99], "body #99 is no sphere"),
		([0, 0], "sphere #0 is bonded to it already"),
	):
		with pytest.raises(ValueError, match=words):
			bond(wall, spheres)
	assert all(wall not in (i.id1, i.id2) for i in O.interactions)
	bond(wall, [0])
	with pytest.raises(ValueError, match="sphere #0 is bonded to it already"):
		bond(wall, [0])
