# GPL v2 or later, see LICENSE.
# Platens that follow stresses and strains: what they reach, unloading, failure, and the biaxial test.
import math

import numpy as np
import pytest
from yade import DeformableEngine, ForceResetter, O, RampedTranslationEngine, ServoPlaten, VonMisesMat, ddem
from yade.ddem.materialpoint import MaterialPoint

from deformable_samples import elastic, start, steps

WIDTH, HEIGHT = 0.02, 0.04


def block_of(material, **options):
	return ddem.append(ddem.mesh.rectangle(WIDTH, HEIGHT, 0.005), material, **options)


def run_to(time):
	while O.time < time:
		steps(1)


def modulus(material):
	"""Of plane strain with free sides."""
	return material.young / (1 - material.poisson**2)


def test_a_table_of_stresses_and_strains_is_followed():
	"""Legs of many wave times, so that the sample follows: loading, unloading, a strain, pulling."""
	material = elastic()
	block = block_of(material)
	legs = [("stress", 20e6, 1e-3), ("stress", 5e6, 5e-4), ("strain", 1e-4, 5e-4), ("stress", -1e6, 5e-4)]
	press = ddem.servo(block, legs, velocity=1)
	O.engines = [ForceResetter(), *press.engines, DeformableEngine(damping=0.1)]
	O.dt = ddem.time_step(0.8)
	time, wanted = 0, []
	for kind, target, duration in legs:
		time += duration
		run_to(time + (0 if len(wanted) < 3 else 2e-4))
		wanted.append(target)
		seen = press.stress_top if kind == "stress" else press.strain
		assert seen == pytest.approx(target, rel=0.01, abs=1e-3 * (20e6 if kind == "stress" else 1e-4))
		assert press.stress_top == pytest.approx(modulus(material) * press.strain, rel=0.02, abs=2e4)
	assert press.done and not press.failed
	assert press.platen.force == pytest.approx(press.force_top, rel=1e-6)


def test_the_force_between_legs_has_no_jump():
	block = block_of(elastic())
	press = ddem.servo(block, [("strain", 2e-4, 3e-4), ("stress", 4e6, 3e-4), ("strain", 3e-4, 3e-4)], velocity=1)
	O.engines = [ForceResetter(), *press.engines, DeformableEngine()]
	O.dt = ddem.time_step(0.8)
	forces = []
	while not press.done:
		steps(1)
		forces.append(press.platen.force)
	# the steepest slope of a leg, twice for the waves in the sample
	steepest = 0.5 * math.pi * max(forces) / 3e-4 * O.dt
	assert np.abs(np.diff(forces)).max() < 4 * steepest


def test_it_begins_at_the_initial_stress():
	block = block_of(elastic(), initial_stress=(0, -5e6, 0))
	press = ddem.servo(block, [("stress", 5e6, 1e-4)], velocity=1)
	start(*press.engines)
	steps(500)
	assert press.stress_top == pytest.approx(5e6, rel=1e-9)
	assert np.abs(block.velocities).max() < 1e-9


def biaxial(material, confinement, strain):
	"""Highest axial stress [Pa] in a biaxial test: pressure on the sides, then the strain of the platen."""
	block = block_of(material, initial_stress=(-confinement, -confinement, 0))
	sides = [ddem.pressure(block, side, confinement) for side in ("left", "right")]
	press = ddem.servo(block, [("strain", strain, 2e-3)], velocity=1)
	O.engines = [ForceResetter(), *sides, *press.engines, DeformableEngine(rotation="corotational", damping=0.1)]
	O.dt = ddem.time_step(0.8)
	highest = 0
	while not press.done:
		steps(20)
		highest = max(highest, press.stress)
	return highest, block, press


@pytest.mark.parametrize("confinement", (10e6, 50e6))
def test_a_biaxial_test_of_a_metal_ends_at_the_closed_form(confinement):
	"""Plane strain, von Mises without hardening: sigma_1 = sigma_3 + 2 sigma_y/sqrt(3) (Hill 1950), whatever the
	confinement. The material point comes to the same."""
	yield_stress = 100e6
	O.materials.append(VonMisesMat(label="m", yieldStress=yield_stress))
	highest, block, _ = biaxial("m", confinement, 3e-3)
	exact = confinement + 2 / math.sqrt(3) * yield_stress
	assert highest == pytest.approx(exact, rel=0.01)
	assert block.field("accumulatedPlasticStrain").min() > 0
	point = MaterialPoint(O.materials["m"])
	path = point.path(duration=1.0, strain={"yy": -3e-3, "zz": 0}, stress={"xx": 0, "xy": 0})
	assert -path.stress[-1][1] + confinement == pytest.approx(exact, rel=0.005)


def test_a_biaxial_test_of_an_elastic_block():
	"""From a stress of -p all around: sigma_y = p + E' eps."""
	material = elastic()
	highest, block, press = biaxial(material, 10e6, 1e-4)
	assert highest == pytest.approx(10e6 + modulus(material) * 1e-4, rel=0.01)
	assert block.stress[..., 0].mean() == pytest.approx(-10e6, rel=0.01)


def test_a_platen_that_lags_behind_has_not_failed():
	block = block_of(elastic())
	press = ddem.servo(block, [("stress", 20e6, 1e-3)], velocity=0.005, failure=0.9)
	O.engines = [ForceResetter(), *press.engines, DeformableEngine(damping=0.1)]
	O.dt = ddem.time_step(0.8)
	run_to(1e-3)
	assert 1e6 < press.stress_top < 15e6
	run_to(3e-3)
	assert not press.failed
	assert press.stress_top == pytest.approx(20e6, rel=1e-3)  # late, but there


def test_legs_appended_later_begin_then():
	block = block_of(elastic())
	press = ddem.servo(block, [("strain", 1e-4, 2e-4)], velocity=1)
	O.engines = [ForceResetter(), *press.engines, DeformableEngine(damping=0.1)]
	O.dt = ddem.time_step(0.8)
	run_to(4e-4)
	platen = press.platen
	platen.kinds, platen.targets = platen.kinds + ["displacement"], platen.targets + [3e-4 * press.height]
	platen.durations = platen.durations + [2e-4]
	fastest = 0
	while O.time < 7e-4:
		steps(1)
		fastest = max(fastest, platen.speed)
	assert fastest == pytest.approx(2e-4 * press.height * math.pi / 2 / 2e-4, rel=0.02)
	assert press.strain == pytest.approx(3e-4, rel=1e-6)


def test_a_platen_stops_where_the_sample_gives_way():
	"""More stress than a metal bears: it yields, the platen runs at its limit, and stops."""
	O.materials.append(VonMisesMat(label="m", yieldStress=100e6))
	block = block_of("m")
	press = ddem.servo(block, [("stress", 300e6, 1e-3)], velocity=2, failure=0.9)
	O.engines = [ForceResetter(), *press.engines, DeformableEngine(damping=0.1, rotation="corotational")]
	O.dt = ddem.time_step(0.8)
	while not press.failed and O.time < 2e-3:
		steps(10)
	assert press.failed and not press.done
	assert press.stress_top == pytest.approx(2 / math.sqrt(3) * 100e6, rel=0.05)
	where = press.strain
	steps(50)
	assert press.strain == pytest.approx(where, abs=2e-6) and press.platen.speed == pytest.approx(0, abs=1e-9)


def test_a_saved_scene_goes_on_with_the_same_bits(tmp_path):
	block = block_of(elastic())
	press = ddem.servo(block, [("strain", 1e-4, 2e-5), ("stress", 9e6, 5e-5)], velocity=1)
	O.trackEnergy = True
	start(*press.engines)
	run_to(3e-5)
	path = str(tmp_path / "scene.xml.gz")
	O.save(path)
	results = []
	for load in (False, True):
		if load:
			O.reset()
			O.load(path)
		steps(100)
		engine = O.engines[-1]
		results.append(
			[engine.values("stress"), O.engines[1].force, O.engines[1].leg, O.energy["externalWork"]]
		)
	for first, second in zip(*results):
		assert np.array_equal(first, second)


def test_the_energy_book_closes():
	block = block_of(elastic())
	press = ddem.servo(block, [("stress", 20e6, 1e-4), ("strain", 0, 1e-4)], velocity=1)
	book = ddem.EnergyBalance()
	start(*press.engines, rotation="none")
	while not press.done:
		steps(10)
		book.record()
	assert book.largest < 1e-9


REFUSED = {
	"legs is empty": dict(legs=[]),
	"must be \\('stress'": dict(legs=[("force", 1, 1)]),
	"0 s must be positive": dict(legs=[("stress", 1, 0)]),
	"velocity = 0 m/s": dict(velocity=0),
	"failure = 1": dict(failure=1),
	"unknown; use 'fixed'": dict(lateral="no"),
	"targets must be finite": dict(legs=[("stress", math.nan, 1)]),
}


@pytest.mark.parametrize("words", REFUSED)
def test_unusable_tables_are_refused_and_nothing_is_held(words):
	block = block_of(elastic())
	with pytest.raises(ValueError, match=words):
		ddem.servo(block, **{"legs": [("stress", 1e6, 1e-3)], "velocity": 1, **REFUSED[words]})
	assert {O.bodies[i].state.blockedDOFs for i in block.node_ids} == {"zXYZ"}


def test_platens_that_cannot_move_stop_the_run():
	for change, words in (
		(dict(ids=lambda block: [0, 0]), "names a node twice"),
		(dict(ids=lambda block: []), "ids is empty"),
		(dict(ids=lambda block: [block.triangle_ids[0]]), "is no DeformableNode"),
		(dict(ids=lambda block: list(block.boundary("left"))), "is free along the platen's way"),
		(dict(targets=lambda block: [1, 2]), "each leg needs all three"),
	):
		O.reset()
		block = block_of(elastic())
		press = ddem.servo(block, [("stress", 1e6, 1e-3)], velocity=1)
		for name, value in change.items():
			setattr(press.platen, name, value(block))
		start(*press.engines)
		with pytest.raises(ValueError, match=words):
			O.step()
	O.reset()
	block = block_of(elastic())
	press = ddem.servo(block, [("stress", 1e6, 1e-3)], velocity=1)
	drive = RampedTranslationEngine(ids=list(press.top), translationAxis=(0, 1, 0), velocity=1)
	start(drive, *press.engines)
	with pytest.raises(ValueError, match="driven by RampedTranslationEngine as well"):
		O.step()
	O.reset()
	O.engines = [ForceResetter(), ServoPlaten()]
	with pytest.raises(RuntimeError, match="moved by a DeformableEngine"):
		O.step()
