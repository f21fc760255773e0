# GPL v2 or later, see LICENSE.
"""Direct shear: Coulomb's law on a plane, Mohr's line of intact blocks, balance of forces and work."""
import math

import numpy as np
import pytest

from yade import BondedMat, ElasticWallMat, O, ServoWall, ddem
from yade.ddem.energy import EnergyBalance

RADIUS = 0.5e-3  # of the lattice
SIZE = (0.016, 0.010, 0.008)


def lattice(friction):
	"""Two blocks of equal spheres, one on top of the other, sphere on sphere, bonded within each block alone."""
	O.materials.append(
		BondedMat(label="rock", young=50e9, cohesion=1e12, frictionStatic=friction, frictionDynamic=friction)
	)
	places = [[(2 * n + 1) * RADIUS for n in range(count)] for count in (8, 6, 4)]
	centres = np.stack(np.meshgrid(*places, indexing="ij"), axis=-1).reshape(-1, 3)
	packing = ddem.packing.Packing(centres, [RADIUS] * len(centres))
	pairs = packing.neighbours(1e-6)
	below = packing.centres[pairs][:, :, 1] < 6 * RADIUS
	packing.bonds = pairs[below[:, 0] == below[:, 1]]
	return ddem.bonded.append(packing, "rock")


@pytest.mark.filterwarnings("ignore:.*pieces")
@pytest.mark.parametrize("friction", [0.3, 0.6])
def test_a_plane_slips_at_coulombs_friction(friction):
	"""Spheres that stand on spheres touch in a plane: T = μ N when they begin to slip, whatever the rest of the box
	does. They lean by u/2R then, which is below 0.4 % here, and the moment of T presses on
	some more than on others."""
	sample = lattice(friction)
	shear = ddem.bonded.direct_shear(sample, 5e6, 0.05, ramp=1e-4, gap=0.5 * RADIUS, normal_velocity=1.0)
	O.engines = ddem.bonded.engines(shear, 1e4)
	O.dt = ddem.bonded.time_step(0.6)
	ratios = []
	while shear.displacement < 7e-3 * RADIUS:
		O.run(50, True)
		ratios.append(shear.stress / shear.normal_stress if O.time > shear.begins else 0)
	assert max(ratios) == pytest.approx(friction, rel=0.025)
	assert shear.normal_stress == pytest.approx(5e6, rel=0.01)
	assert shear.force_top == pytest.approx(shear.force_bottom, rel=0.05)  # it slips and sticks


def sheared(normal_stress, way=0.2e-3, seed=1, friction=0.5):
	"""Records (displacement, shear and normal stress, forces above and below) of a block,
	the box and the energy book."""
	O.reset()
	O.materials.append(
		BondedMat(label="rock", young=50e9, cohesion=120e6, frictionStatic=friction, frictionDynamic=friction)
	)
	block = ddem.packing.fill(ddem.packing.Box((0, 0, 0), SIZE), 0.7e-3, 1.6e-3, seed=seed)
	sample = ddem.bonded.append(block, "rock")
	shear = ddem.bonded.direct_shear(sample, normal_stress, 0.35, ramp=2e-5)
	O.engines = ddem.bonded.engines(shear, 1e4)
	O.dt = ddem.bonded.time_step(0.7)
	book, rows = EnergyBalance(), []
	while shear.displacement < way:
		O.run(200, True)
		book.record()
		rows.append(
			(shear.displacement, shear.stress, shear.normal_stress, shear.force_top, shear.force_bottom)
		)
	return np.array(rows), shear, book


def test_three_normal_stresses_are_on_a_line():
	"""Mohr and Coulomb: the peaks of intact blocks grow linearly, here by tan 5° to tan 25° (samples of spheres
	that roll have little internal friction; a triaxial test gives 16° or so). What is left after them is friction
	of broken spheres whose contacts have 0.5: rolling takes some of it, dilation adds, most at a low normal stress,
	where the halves still interlock."""
	stresses, peaks = (5e6, 15e6, 30e6), []
	for stress in stresses:
		rows, shear, _ = sheared(stress)
		peaks.append(rows[:, 1].max())
		last = rows[:, 0] > 0.13e-3
		residual, normal = rows[last, 1].mean(), rows[last, 2].mean()
		assert normal == pytest.approx(stress, rel=0.15)
		assert residual < 0.7 * peaks[-1]
		assert 0.2 < residual / normal < (1.5 if stress == 5e6 else 0.8)
	slope, cohesion = np.polyfit(stresses, peaks, 1)
	assert math.tan(math.radians(5)) < slope < math.tan(math.radians(25))
	np.testing.assert_allclose(peaks, cohesion + slope * np.array(stresses), rtol=0.06)
	assert 0.1 * 120e6 < cohesion < 0.5 * 120e6


def test_forces_of_the_halves_and_works_agree():
	"""Until bonds break both halves feel the same force; all along the book of works closes, and the work of the
	lower half is the area below the curve."""
	rows, shear, book = sheared(15e6, way=0.1e-3)
	peak = int(rows[:, 1].argmax())
	steady = rows[:peak][rows[:peak, 1] > 0.3 * rows[peak, 1]]
	steady = steady[steady[:, 1] < 0.7 * rows[peak, 1]]
	np.testing.assert_allclose(steady[:, 3], steady[:, 4], rtol=0.03)
	assert book.largest < 5e-3
	drive = shear.engines[1]
	# of forces at every 200th step, which swing once bonds break
	assert drive.work == pytest.approx(np.trapezoid(rows[:, 4], rows[:, 0]), rel=0.1)
	assert -O.energy["externalWork"] == pytest.approx(drive.work + shear.engines[0].work, rel=1e-9)


def test_an_elastic_block_balances_forces_and_moments():
	O.materials.append(BondedMat(label="rock", young=50e9, cohesion=1e12))
	block = ddem.packing.fill(ddem.packing.Box((0, 0, 0), SIZE), 0.7e-3, 1.6e-3)
	shear = ddem.bonded.direct_shear(ddem.bonded.append(block, "rock"), 20e6, 0.02, ramp=1e-5)
	O.engines = ddem.bonded.engines(shear, 5e4)
	O.dt = ddem.bonded.time_step(0.7)
	O.run(int(1.5e-4 / O.dt), True)
	assert shear.stress > 1e6
	assert shear.force_top == pytest.approx(shear.force_bottom, rel=0.02)
	assert shear.normal_stress == pytest.approx(20e6, rel=0.01)
	assert shear.normal_stress_below == pytest.approx(20e6, rel=0.01)


@pytest.mark.parametrize("arguments, words", [
	(dict(normal_stress=-1), "normal_stress = -1 Pa must be positive"),
	(dict(velocity=0), "velocity = 0 m/s must be"),
	(dict(ramp=-1), "ramp = -1 s must not be negative"),
	(dict(gap=0.006), "gap = 0.006 m must lie between 0 and half"),
	(dict(normal_ramp=0), "normal_ramp = 0 s"), (dict(normal_velocity=math.inf), "normal_velocity = inf m/s"),
	(dict(stiffness=0), "stiffness = 0 Pa"),
])
def test_what_is_refused_appends_nothing(arguments, words):
	O.materials.append(BondedMat(label="rock"))
	block = ddem.packing.fill(ddem.packing.Box((0, 0, 0), SIZE), 0.8e-3, 2e-3)
	sample = ddem.bonded.append(block, "rock")
	bodies = len(O.bodies)
	with pytest.raises(ValueError, match=words):
		ddem.bonded.direct_shear(sample, **{"normal_stress": 1e6, "velocity": 0.1, **arguments})
	assert len(O.bodies) == bodies and not any(isinstance(m, ElasticWallMat) for m in O.materials)


def test_only_prisms_fit_into_the_box():
	O.materials.append(BondedMat(label="rock"))
	core = ddem.packing.Cylinder((0, 0, 0), (0, 0.02, 0), 0.005)
	sample = ddem.bonded.append(ddem.packing.fill(core, 0.8e-3, 2e-3), "rock")
	with pytest.raises(ValueError, match="the sample must be a prism"):
		ddem.bonded.direct_shear(sample, 1e6, 0.1)


def test_a_loaded_scene_has_its_shear_box_again(tmp_path):
	O.materials.append(BondedMat(label="rock", young=50e9, cohesion=1e12))
	sample = ddem.bonded.append(ddem.packing.fill(ddem.packing.Box((0, 0, 0), SIZE), 0.7e-3, 1.6e-3), "rock")
	load, lines = ddem.bonded.direct_shear(sample, 5e6, 0.35, ramp=2e-5, normal_ramp=2e-5), []
	O.engines = ddem.bonded.engines(load, 1e4)
	O.dt = ddem.bonded.time_step(0.7)
	O.run(200, True)
	O.save(str(tmp_path / "half.yade.gz"))
	results = []
	for again in (False, True):
		if again:
			O.reset()
			O.load(str(tmp_path / "half.yade.gz"))
			load = ddem.bonded.DirectShear.from_scene(ddem.bonded.BondedSample.from_scene())
		O.run(200, True)
		results.append(
			[
				getattr(load, name)
				for name in (
					"stress", "normal_stress", "displacement", "dilation", "gap", "begins", "area"
				)
			]
			+ [len(load.engines)]
		)
		lines.append(np.concatenate(load.outlines))
	assert results[0] == results[1] and results[0][0] != 0
	assert np.array_equal(*lines)
	O.engines = [engine for engine in O.engines if not isinstance(engine, ServoWall)]
	with pytest.raises(RuntimeError, match="O.engines has 0 ServoWall of the bodies"):
		ddem.bonded.DirectShear.from_scene(load.sample)
