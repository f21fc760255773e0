# GPL v2 or later, see LICENSE.
"""Simple shear of triangles: G γ, and von Mises' limit."""
import math

import pytest
from deformable_samples import elastic

from yade import DeformableEngine, ForceResetter, O, VonMisesMat, ddem


def sheared(material, gamma, rest=True, **options):
	"""Sheared slowly so far, and brought to rest."""
	mesh = ddem.mesh.rectangle(0.04, 0.02, size=0.004, pattern="unstructured")
	block = ddem.append(mesh, material, thickness=0.03, **options)
	shear = ddem.simple_shear(block, velocity=0.5)
	O.engines = [ForceResetter(), *shear.engines, DeformableEngine(rotation="corotational")]
	O.dt = ddem.time_step(0.8)
	O.run(round(gamma * shear.height / 0.5 / O.dt), True)
	if rest:
		for engine in shear.engines:
			engine.velocity = 0
		ddem.relax(1e-6)
	return shear


def test_an_elastic_block_bears_g_gamma():
	shear = sheared(elastic(shear=12e9, bulk=16e9), 2e-4)
	assert shear.strain == pytest.approx(2e-4, rel=0.02)
	# uniform shear, which any mesh has exactly; the frame of elements turns by half of it
	assert shear.stress == pytest.approx(12e9 * shear.strain, rel=2e-4)
	assert shear.force_top == pytest.approx(shear.force_bottom, rel=1e-3)
	assert abs(shear.normal_stress) < 2 * shear.strain * shear.stress
	assert shear.area == pytest.approx(0.04 * 0.03)


def test_a_metal_bears_its_yield_stress_over_the_root_of_three():
	"""von Mises in pure shear (Simo and Hughes 1998)."""
	steel = VonMisesMat(label="steel", yieldStress=300e6)
	O.materials.append(steel)
	shear = sheared(steel, 0.01, rest=False)
	assert shear.stress == pytest.approx(300e6 / math.sqrt(3), rel=5e-3)


def test_the_normal_stress_is_the_initial_one():
	shear = sheared(elastic(), 1e-5, initial_stress=(-2e6, -2e6, 0))
	assert shear.normal_stress == pytest.approx(2e6, rel=1e-3)


def test_bad_numbers_are_refused_and_nothing_is_held():
	block = ddem.append(ddem.mesh.rectangle(0.02, 0.02, size=0.01), elastic())
	for options, message in (
		({"velocity": 0}, "velocity = 0 m/s"), ({"velocity": 1, "ramp": -1}, "ramp = -1 s must be finite")
	):
		with pytest.raises(ValueError, match=message):
			ddem.simple_shear(block, **options)
	assert not any(set("xy") & set(O.bodies[i].state.blockedDOFs) for i in block.node_ids)
