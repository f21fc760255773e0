# GPL v2 or later, see LICENSE.
"""The Brazilian disc of triangles against Hondros and Hertz."""
import math

import numpy as np
import pytest
from deformable_samples import elastic

from yade import DeformableEngine, ForceResetter, O, ddem
from yade.ddem.disc_stress import hondros, pressed
from yade.ddem.triangle_jaws import stress_at

D, THICKNESS = 0.05, 0.02


def rested(block, engines):
	O.engines = [ForceResetter(), *engines, DeformableEngine(rotation="none")]
	O.dt = ddem.time_step(0.8)
	return block


def test_uniform_pressure_on_two_arcs_makes_the_stress_of_hondros():
	angle, pressure = 20, 10e6
	half = math.radians(angle) / 2
	block = ddem.append(ddem.brazilian_disc(D, 0.002, angle, flat=False), elastic(), thickness=THICKNESS)
	arcs = lambda x, y: np.abs(x) <= D / 2 * math.sin(half) + 1e-9
	x, y = block.mesh.nodes.T
	for end in (np.argmax(y), np.argmin(y)):
		block.hold(block.node_ids[[end]], "x")
	for end in (np.argmax(x), np.argmin(x)):  # by symmetry, without a force
		block.hold(block.node_ids[[end]], "y")
	rested(
		block, [ddem.pressure(block, lambda x, y, s=s: arcs(x, y) & (s * y > 0), pressure) for s in (-1, 1)]
	)
	ddem.relax(1e-5)
	# the polygon's edges say which arc bears the pressure
	edges = block.mesh.nodes[block.mesh.border_between(block.mesh.boundary(lambda x, y: arcs(x, y) & (y > 0)))]
	loaded = np.degrees(np.ptp(np.arctan2(edges[..., 0], edges[..., 1])))
	force = pressure * THICKNESS * np.ptp(edges[..., 0])
	unit = 2 * force / (math.pi * D * THICKNESS)
	assert stress_at(block, (0, 0), 0.15 * D) / unit == pytest.approx(hondros(loaded), rel=0.02)


@pytest.mark.parametrize("flat", [False, True])
def test_jaws_that_move_as_one_press_as_a_rigid_punch(flat):
	"""The force of a rigid punch on a half plane (Sadowsky 1928);
	that the disc is none adds up to three per cent."""
	angle = 20
	block = ddem.append(ddem.brazilian_disc(D, 0.002, angle, flat), elastic(), thickness=THICKNESS)
	jaws = ddem.brazilian(block, D, angle, velocity=0.05)
	rested(block, jaws.engines)
	O.run(200, True)
	for engine in jaws.engines:
		engine.velocity = 0
	ddem.relax(1e-5)
	assert jaws.force_top == pytest.approx(jaws.force_bottom, rel=1e-3)
	assert jaws.area == pytest.approx(math.pi / 2 * D * THICKNESS)
	assert jaws.centre_stress / jaws.stress == pytest.approx(pressed(angle), rel=0.03)
	assert jaws.splitting_stress == jaws.centre_stress[0] > 0


def test_bad_numbers_are_refused():
	block = ddem.append(ddem.brazilian_disc(D, 0.01, 20), elastic())
	for options, message in (
		({"angle": 90}, "angle = 90 degrees"), ({"diameter": 0.0}, "diameter = 0.0 m"),
		({"velocity": -1.0}, "only push"), ({"angle": 0.1}, "no edge of the border")
	):
		with pytest.raises(ValueError, match=message):
			ddem.brazilian(block, **{"diameter": D, "angle": 20, "velocity": 1.0, **options})
	assert not any(set("xy") & set(O.bodies[i].state.blockedDOFs) for i in block.node_ids)


def test_a_mesh_has_at_least_four_triangles_at_each_jaw_and_its_diameter():
	for flat in (False, True):
		mesh = ddem.brazilian_disc(D, 0.005, 10, flat)
		half = math.radians(5)
		across = D / 2 * math.sin(half) + 1e-9
		top = mesh.boundary(lambda x, y: (np.abs(x) <= across) & (y > 0))
		assert len(top) >= 5 and np.ptp(mesh.nodes[top, 0]) == pytest.approx(D * math.sin(half))
		assert np.ptp(mesh.nodes[:, 1]) == pytest.approx(D * (math.cos(half) if flat else 1))
	for options, message in (({"size": 0.02}, "size = 0.02 m"), ({"angle": 0}, "angle = 0 degrees")):
		with pytest.raises(ValueError, match=message):
			ddem.brazilian_disc(**{"diameter": D, "size": 0.002, "angle": 20, **options})
