# GPL v2 or later, see LICENSE.
"""The Brazilian test: stress in the middle of a disc against the closed form, curved jaws, what is refused."""
import math

import numpy as np
import pytest

from yade import BondedMat, ElasticWallMat, O, ParallelBondMat, RoundPlaten, ddem
from yade.ddem.bonded_jaws import disc_stress

DIAMETER, LENGTH = 0.020, 0.006


def disc(seed=1, **material):
	O.reset()
	O.materials.append(BondedMat(**{**dict(label="rock", young=50e9, cohesion=1e12), **material}))
	body = ddem.packing.Cylinder((0, 0, -LENGTH / 2), (0, 0, LENGTH / 2), DIAMETER / 2)
	return ddem.bonded.append(ddem.packing.fill(body, 0.5e-3, 1.2e-3, seed=seed), "rock")


def press(sample, jaws, seconds, viscosity=3e4):
	load = ddem.bonded.brazilian(sample, 0.2, jaws, ramp=2e-5)
	O.engines = ddem.bonded.engines(load, viscosity)
	O.dt = ddem.bonded.time_step(0.6)
	O.run(int(seconds / O.dt), True)
	return load


@pytest.mark.parametrize("jaws", ["curved", "flat"])
def test_stress_in_the_middle_of_the_disc(jaws):
	"""Mean over a quarter of the radius to each side against the elastic solution for line loads; in the very
	middle that is 2 P/(π D L) across and three times as much along.
	Of two packings, as a few spheres are no continuum."""
	half, found = DIAMETER / 8, []
	for seed in (1, 2):
		sample = disc(seed)
		load = press(sample, jaws, 1.2e-4)
		force = 0.5 * (load.force_top + load.force_bottom)
		assert load.force_top == pytest.approx(load.force_bottom, rel=0.02)
		stress = ddem.bonded.mean_stress(sample, (-half, -half, -LENGTH / 2), (half, half, LENGTH / 2))
		places = (np.arange(20) - 9.5) / 10 * half
		closed = disc_stress(force, DIAMETER, LENGTH, *np.meshgrid(places, places)).mean(axis=(1, 2))
		found.append((stress[0, 0] / closed[0], stress[1, 1] / closed[1]))
		assert abs(stress[0, 1]) < 0.1 * abs(closed[1]) and abs(stress[2, 2]) < 0.1 * abs(closed[1])
		assert load.stress == pytest.approx(2 * force / (math.pi * DIAMETER * LENGTH), rel=1e-12)
	across, along = np.mean(found, axis=0)
	assert across == pytest.approx(1, abs=0.12)
	assert along == pytest.approx(1, abs=0.1)


def test_the_closed_form():
	"""In the middle σ_x = 2P/πDL, σ_y = -6P/πDL; no load on the rim; along the loaded diameter σ_x is constant;
	any cut across it carries P."""
	unit = 2 / (math.pi * DIAMETER * LENGTH)
	assert disc_stress(1, DIAMETER, LENGTH, 0, 0) == pytest.approx([unit, -3 * unit, 0])
	assert disc_stress(1, DIAMETER, LENGTH, 0, 0.3 * DIAMETER)[0] == pytest.approx(unit)
	for angle in (0.1, 0.9, -0.7):
		n = np.array([math.cos(angle), math.sin(angle)])
		xx, yy, xy = disc_stress(1, DIAMETER, LENGTH, *(0.5 * DIAMETER * n))
		assert np.array([[xx, xy], [xy, yy]]) @ n == pytest.approx([0, 0], abs=1e-9 * unit)
	x = (np.arange(4000) + 0.5) / 4000 * DIAMETER - DIAMETER / 2
	assert disc_stress(1, DIAMETER, LENGTH, x, 0 * x)[1].mean() * DIAMETER * LENGTH == pytest.approx(-1, rel=1e-6)


def test_curved_jaws_are_half_as_curved_again_and_touch_the_disc():
	sample = disc()
	load = ddem.bonded.brazilian(sample, 0.2, ramp=2e-5)
	shapes = [O.bodies[jaw].shape for jaw in (load.bottom, load.top)]
	assert all(isinstance(s, RoundPlaten) and s.concave for s in shapes)
	assert [s.radius for s in shapes] == pytest.approx([0.75 * DIAMETER] * 2)
	bottom, top = (O.bodies[jaw].state.pos[1] for jaw in (load.bottom, load.top))
	assert top + 0.75 * DIAMETER == pytest.approx(sample.upper[1]) and bottom - 0.75 * DIAMETER == pytest.approx(
		sample.lower[1]
	)
	assert load.height == pytest.approx(DIAMETER) and load.strain == 0
	O.engines = ddem.bonded.engines(load)
	O.dt = ddem.bonded.time_step(0.6)
	O.run(int(5e-5 / O.dt), True)
	assert load.strain == pytest.approx(0.4 * 4e-5 / DIAMETER, rel=0.01)


def test_a_disc_splits_along_the_loaded_diameter():
	"""Of bonds whose sample bears 13 times in compression what it bears in tension: the share of cracks that open
	across the load, and near the loaded diameter."""
	O.reset()
	O.materials.append(
		ParallelBondMat(label="rock", young=50e9, cohesion=400e6, tensileStrength=20e6, momentContribution=0)
	)
	body = ddem.packing.Cylinder((0, 0, -LENGTH / 2), (0, 0, LENGTH / 2), DIAMETER / 2)
	sample = ddem.bonded.append(ddem.packing.fill(body, 0.5e-3, 1.2e-3), "rock")
	load = ddem.bonded.brazilian(sample, 0.15, ramp=2e-5)
	O.engines = ddem.bonded.engines(load, 2e3)
	O.dt = ddem.bonded.time_step(0.7)
	stress = []
	while O.time < 8e-4 and (O.time < 2e-4 or stress[-1] > 0.6 * max(stress)):
		O.run(100, True)
		stress.append(load.stress)
	broken = sample.broken
	assert stress[-1] < 0.6 * max(stress) and len(broken) > 20
	assert (broken["mode"] == "tension").mean() > 0.6
	assert abs(broken["position"][:, 0]).mean() < 0.2 * DIAMETER
	assert 1e6 < max(stress) < 20e6  # below the strength of the bonds


@pytest.mark.parametrize("arguments, words", [
	(dict(jaws="round"), "jaws = 'round' is unknown; use 'curved' or 'flat'"),
	(dict(velocity=-1), "velocity = -1 m/s must be positive"),
	(dict(ramp=math.nan), "ramp = nan s must not be negative"),
	(dict(stiffness=0), "stiffness = 0 Pa must be positive"),
])
def test_what_is_refused_appends_nothing(arguments, words):
	sample = disc()
	bodies = len(O.bodies)
	with pytest.raises(ValueError, match=words):
		ddem.bonded.brazilian(sample, **{"velocity": 0.1, **arguments})
	assert len(O.bodies) == bodies and not any(isinstance(m, ElasticWallMat) for m in O.materials)


def test_curved_jaws_want_a_disc():
	O.materials.append(BondedMat(label="rock"))
	flat = ddem.bonded.append(ddem.packing.fill(ddem.packing.flattened_disc(0.02, 0.008), 0.8e-3, 2e-3), "rock")
	with pytest.raises(ValueError, match="curved jaws need a disc on its side"):
		ddem.bonded.brazilian(flat, 0.1)
	assert ddem.bonded.brazilian(flat, 0.1, "flat").area == pytest.approx(
		math.pi / 2 * float((flat.upper - flat.lower)[0]) * 0.008
	)


def test_a_loaded_scene_has_its_jaws_again(tmp_path):
	load, lines = press(disc(), "curved", 2e-5), []
	O.save(str(tmp_path / "half.yade.gz"))
	results = []
	for again in (False, True):
		if again:
			O.reset()
			O.load(str(tmp_path / "half.yade.gz"))
			load = ddem.bonded.Jaws.from_scene(ddem.bonded.BondedSample.from_scene())
		O.run(100, True)
		results.append(
			[
				getattr(load, name)
				for name in (
					"stress", "strain", "force_top", "force_bottom", "area", "height", "bottom"
				)
			]
			+ [len(load.engines)]
		)
		lines.append(np.concatenate(load.outlines))
	assert results[0] == results[1] and results[0][0] != 0
	assert np.array_equal(*lines)
	O.bodies.erase(load.top)
	with pytest.raises(RuntimeError, match="the scene has 1 concave RoundPlatens, where curved jaws are two"):
		ddem.bonded.Jaws.from_scene(load.sample)
