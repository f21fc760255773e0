# GPL v2 or later, see LICENSE.
"""Loads on bonded spheres: servo walls, triaxial and oedometric tests, loading axes."""
import math

import numpy as np
import pytest

from yade import BondedMat, ElasticWallMat, O, ServoWall, Vector3, ddem
from yade.ddem.energy import EnergyBalance

SIZE = (0.012, 0.016, 0.012)


def specimen(size=SIZE, seed=1, **material):
	"""A prism of some 500 spheres, which does not break unless told."""
	O.reset()
	O.materials.append(BondedMat(**{**dict(label="rock", young=50e9, cohesion=1e12), **material}))
	return ddem.bonded.append(ddem.packing.prism(*size, 0.7e-3, 2e-3, seed=seed, fails=1000), "rock")


def run(loads, seconds, viscosity=3e4, safety=0.5):
	O.engines = ddem.bonded.engines(loads, viscosity)
	O.dt = ddem.bonded.time_step(safety)
	O.run(int(seconds / O.dt), True)


def test_legs_end_at_their_stresses_and_strains():
	sample = specimen()
	press = ddem.bonded.servo(
		sample, [("stress", 10e6, 4e-4), ("stress", 3e6, 2e-4), ("strain", 1e-3, 2e-4)], velocity=1.0
	)
	for seconds, stress in ((4e-4, 10e6), (2e-4, 3e6)):
		run(press, seconds)
		assert press.stress == pytest.approx(stress, rel=5e-3)
	run(press, 2.1e-4)
	assert press.done and not press.failed
	assert press.strain == pytest.approx(1e-3, rel=1e-9)
	assert press.engines[0].displacement == pytest.approx(0.5e-3 * press.height, rel=1e-9)
	run(press, 1e-4)
	assert press.strain == pytest.approx(1e-3, rel=1e-9)


def test_an_elastic_cycle_comes_back():
	sample = specimen()
	press = ddem.bonded.servo(sample, [("stress", p, 4e-4) for p in (1e6, 20e6, 1e6)], velocity=1.0)
	strains = []
	for _ in range(3):
		run(press, 4e-4)
		strains.append(press.strain)
	assert strains[1] > 3e-4
	assert strains[2] == pytest.approx(strains[0], abs=0.01 * strains[1])


def test_force_control_takes_the_work_it_does():
	"""Without damping: work of both walls = energy that the sample has."""
	sample = specimen()
	press = ddem.bonded.servo(sample, [("stress", 15e6, 3e-4)], velocity=1.0)
	O.engines = ddem.bonded.engines(press)
	O.dt = ddem.bonded.time_step(0.3)
	book = EnergyBalance()
	for _ in range(10):
		O.run(int(3e-5 / O.dt), True)
		book.record()
	assert sum(wall.work for wall in press.engines) == pytest.approx(-O.energy["externalWork"], rel=1e-12)
	assert book.largest < 1e-4


def test_load_control_stops_where_the_sample_gives_way():
	sample = specimen(cohesion=30e6)
	press = ddem.bonded.servo(sample, [("stress", 500e6, 1e-3)], velocity=0.5, failure=0.5)
	run(press, 1.2e-3, viscosity=0)
	assert press.failed
	assert sample.broken_fraction > 0.02
	assert press.strain < 0.05  # without the stop the walls would have met the rubble at 1 m/s


def test_legs_appended_later_begin_then():
	sample = specimen()
	press = ddem.bonded.servo(sample, [("strain", 2e-4, 2e-4)], velocity=1.0)
	run(press, 4e-4)
	assert press.done
	for wall in press.engines:
		wall.kinds, wall.targets = wall.kinds + ["displacement"], wall.targets + [0.5e-3 * press.height]
		wall.durations = wall.durations + [2e-4]
	speeds = []
	for _ in range(30):
		O.run(int(1e-5 / O.dt), True)
		speeds.append(abs(press.engines[0].speed))
	assert max(speeds) == pytest.approx(0.5 * 8e-4 * press.height * math.pi / 2 / 2e-4, rel=0.02)
	assert press.strain == pytest.approx(1e-3, rel=1e-9)


def test_time_stands_still_for_a_dead_wall():
	sample = specimen()
	press = ddem.bonded.servo(sample, [("strain", 1e-3, 2e-4)], velocity=1.0)
	run(press, 1e-4)
	for dead in (True, False):
		for wall in press.engines:
			wall.dead = dead
			O.bodies[wall.ids[0]].state.vel = (0, 0, 0)
		O.run(int(1e-4 / O.dt) if dead else 3, True)
	assert press.engines[0].speed < 0.1
	O.run(int(1.1e-4 / O.dt), True)
	assert press.strain == pytest.approx(1e-3, rel=1e-9)


def pulled(velocity, target, **material):
	"""Bonded walls that pull by force, and their sample."""
	sample = specimen(size=(0.01, 0.012, 0.01), **material)
	walls = ddem.bonded.platens(sample, velocity=-0.1, bonded=True)
	servos = [
		ServoWall(
			ids=[wall], direction=(0, sense, 0), kinds=["force"], targets=[target * walls.area],
			durations=[2e-4], velocity=velocity, failure=0.5, mass=1e-3, dashpot=1e3
		) for wall, sense in ((walls.bottom, 1), (walls.top, -1))
	]
	walls.engines = servos
	run(walls, 3e-4)
	return sample, walls, servos


def test_failure_in_tension_is_one_of_the_sample():
	sample, walls, servos = pulled(velocity=0.004, target=-5e6)  # too slow to follow
	assert walls.stress < 0 and not any(wall.failed for wall in servos)
	sample, walls, servos = pulled(velocity=2.0, target=-50e6, cohesion=2e6)
	assert sample.broken_fraction > 0.05 and all(wall.failed for wall in servos)


def test_a_servo_before_the_interactions_is_refused():
	sample = specimen(size=(0.008, 0.008, 0.008))
	press = ddem.bonded.servo(sample, [("stress", 5e6, 2e-4)], velocity=1.0)
	engines = ddem.bonded.engines()
	O.engines = engines[:1] + press.engines + engines[1:]
	O.dt = ddem.bonded.time_step(0.5)
	with pytest.raises(RuntimeError, match="ServoWall must come between InteractionLoop and NewtonIntegrator"):
		ddem.bonded.check()
	with pytest.raises(RuntimeError, match="ServoWall comes before InteractionLoop"):
		O.step()
		O.step()


def test_a_wall_that_has_not_met_the_sample_has_not_failed():
	sample = specimen()
	press = ddem.bonded.servo(sample, [("stress", 5e6, 1e-4)], velocity=2.0, failure=0.5)
	for wall in press.engines:
		O.bodies[wall.ids[0]].state.pos -= 1e-4 * wall.direction  # 0.1 mm away
	run(press, 3e-4)
	assert not press.failed
	assert press.stress == pytest.approx(5e6, rel=0.02)


def elastic_constants(sample):
	"""Young's modulus and Poisson's ratio across, of a sample between smooth platens along y (x and z free)."""
	press = ddem.bonded.servo(sample, [("stress", 10e6, 6e-4)], velocity=1.0)
	run(press, 8e-4)
	centres = sample.positions - sample.displacements
	across = [np.polyfit(centres[:, axis], sample.displacements[:, axis], 1)[0] for axis in (0, 2)]
	along = -np.polyfit(centres[:, 1], sample.displacements[:, 1], 1)[0]
	return press.stress / along, across[0] / along, across[1] / along


def test_oedometer_is_hookes_law_with_the_samples_own_constants():
	"""For equal constants along all axes σ_x/σ_y = ν/(1-ν), σ_y/ε_y = E (1-ν)/((1+ν)(1-2ν)); packings are somewhat
	anisotropic, and their faces soft."""
	young, nu_x, nu_z = elastic_constants(specimen())
	nu = 0.5 * (nu_x + nu_z)
	assert 0.05 < nu < 0.35
	sample = specimen()
	around = ddem.bonded.confine(sample)
	press = ddem.bonded.servo(sample, [("stress", 10e6, 6e-4)], velocity=1.0)
	run([press, around], 8e-4)
	ratio = np.mean(list(around.stress.values())) / press.stress
	assert ratio == pytest.approx(nu / (1 - nu), rel=0.25)
	assert all(strain == 0 for strain in around.strain.values())
	centres = sample.positions - sample.displacements
	along = -np.polyfit(centres[:, 1], sample.displacements[:, 1], 1)[0]
	assert press.stress / along == pytest.approx(young * (1 - nu) / ((1 + nu) * (1 - 2 * nu)), rel=0.06)


def test_triaxial_pressure_is_kept_and_strengthens():
	strengths = []
	for pressure in (2e6, 20e6):
		sample = specimen(size=(0.01, 0.02, 0.01), cohesion=40e6)
		test = ddem.bonded.triaxial(sample, pressure, strain=0.012, duration=1e-3, ramp=1e-4, velocity=2.0)
		run(test, 1e-4, viscosity=1e4, safety=0.7)
		assert [test.stress, *test.confinement.stress.values()] == pytest.approx([pressure] * 3, rel=0.05)
		largest = 0.0
		for _ in range(50):
			O.run(int(2e-5 / O.dt), True)
			largest = max(largest, test.stress)
		assert np.mean(list(test.confinement.stress.values())) == pytest.approx(pressure, rel=0.3)
		strengths.append(largest)
	# spheres that roll have little internal friction: 16° or so, tan²(45° + 8°) = 1.8
	assert 1.5 * 18e6 < strengths[1] - strengths[0] < 5 * 18e6


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_platens_along_any_axis(axis):
	sample = specimen(size=(0.012, 0.013, 0.014))
	platens = ddem.bonded.platens(sample, velocity=0.2, ramp=2e-5, axis=axis)
	number = "xyz".index(axis)
	assert platens.height == pytest.approx((0.012, 0.013, 0.014)[number], rel=1e-12)
	assert platens.area == pytest.approx(0.012 * 0.013 * 0.014 / platens.height, rel=1e-12)
	run(platens, 1e-4)
	assert platens.stress == pytest.approx(0.5 * (platens.force_top + platens.force_bottom) / platens.area)
	assert platens.strain == pytest.approx(0.4 * 0.9e-4 / platens.height, rel=0.02)
	moduli = platens.stress / platens.strain
	assert 15e9 < moduli < 60e9
	again = ddem.bonded.Platens.from_scene(sample, axis=axis)
	assert (again.stress, again.strain, len(again.engines)) == (platens.stress, platens.strain, 2)


@pytest.mark.parametrize("arguments, words", [
	(dict(legs=[]), "legs is empty"),
	(dict(legs=[("force", 1, 1)]), "must be \\('stress', target"),
	(dict(legs=[("stress", 1e6, -1)]), "duration = -1 s must be positive"),
	(dict(legs=[("stress", math.nan, 1)]), "target = nan"),
	(dict(legs=[("stress", 1e6, 1), ("stress", -1e6, 1)]), "target = -1000000.0 Pa must not be negative"),
	(dict(legs=[("stress", 1e6, 1)], velocity=0), "velocity = 0 m/s must be positive"),
	(dict(legs=[("stress", 1e6, 1)], failure=1), "failure = 1"),
	(dict(legs=[("stress", 1e6, 1)], axis="w"), "axis = 'w' is unknown"),
	(dict(legs=[("stress", 1e6, 1)], area=1.0), "area = 1.0 m²"),
])
def test_bad_courses_append_nothing(arguments, words):
	sample = specimen(size=(0.008, 0.008, 0.008))
	bodies = len(O.bodies)
	with pytest.raises(ValueError, match=words):
		ddem.bonded.servo(sample, **{"velocity": 1.0, **arguments})
	assert len(O.bodies) == bodies and not any(isinstance(m, ElasticWallMat) for m in O.materials)


def test_bad_pressures():
	sample = specimen(size=(0.008, 0.008, 0.008))
	with pytest.raises(ValueError, match="pressure = -1 Pa must be positive"):
		ddem.bonded.confine(sample, -1)
	bodies = len(O.bodies)
	for arguments, words in (
		(dict(strain=0, duration=1e-3), "strain = 0"), (dict(strain=math.inf, duration=1e-3), "strain = inf"),
		(dict(strain=0.01, duration=math.inf), "duration = inf s"),
	):
		with pytest.raises(ValueError, match=words):
			ddem.bonded.triaxial(sample, 1e6, **arguments)
	with pytest.raises(ValueError, match="axes = 'xx' must name each axis once"):
		ddem.bonded.confine(sample, 1e6, axes="xx")
	assert len(O.bodies) == bodies


def test_engine_with_columns_that_differ():
	sample = specimen(size=(0.008, 0.008, 0.008))
	press = ddem.bonded.servo(sample, [("stress", 1e6, 1e-3)], velocity=1.0)
	press.engines[0].kinds = ["force", "force"]
	O.engines = ddem.bonded.engines(press)
	O.dt = ddem.bonded.time_step(0.5)
	with pytest.raises(ValueError, match="2 kinds, 1 targets and 1 durations"):
		O.step()
	with pytest.raises(ValueError, match="kind 'stress' is unknown"):
		ServoWall(kinds=["stress"])
	assert ServoWall(direction=(0, 0, 2)).direction == Vector3(0, 0, 1)


def test_saved_in_the_midst_of_a_leg_it_goes_on(tmp_path):
	results = []
	sample = specimen(size=(0.01, 0.012, 0.01))
	press = ddem.bonded.servo(sample, [("stress", 10e6, 3e-4), ("stress", 1e6, 1e-4)], velocity=1.0)
	O.engines = ddem.bonded.engines(press, 1e4)
	O.dt = ddem.bonded.time_step(0.5)
	O.run(500, True)
	O.save(str(tmp_path / "leg.xml"))
	for again in (False, True):
		if again:
			O.load(str(tmp_path / "leg.xml"))
			sample = ddem.bonded.BondedSample.from_scene()
			press = ddem.bonded.Platens.from_scene(sample)
		O.run(1500, True)
		results.append((press.strain, press.force_top, press.force_bottom, [e.leg for e in press.engines]))
	assert results[0] == results[1]  # with damping, whose engine acts before the integrator knows its scene
