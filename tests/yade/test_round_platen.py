# GPL v2 or later, see LICENSE.
"""RoundPlaten: spheres on rollers and in jaws. Overlaps, forces and directions follow from plane geometry."""
import math

import numpy as np
import pytest

from yade import Body, BondedMat, ElasticWallMat, FrictMat, O, Quaternion, RoundPlaten, Vector3, ddem, utils

RADIUS, YOUNG, STIFFNESS = 1e-3, 60e9, 40e9  # of the sphere [m], its modulus, the platen's stiffness [Pa]
ROUND = 8e-3  # radius of the platen [m]
TURN = Quaternion(Vector3(0.3, -0.5, 0.8).normalized(), 0.7)  # its axis is along none of the scene's


def touching(concave, angle, overlap, material="plate", along=0.0, **sphere):
	"""A sphere that is so far in a platen at an angle from its local y; ids of both, direction from the axis."""
	O.materials.append(BondedMat(label="rock", young=YOUNG, density=2600))
	O.materials.append(ElasticWallMat(label="plate", stiffness=STIFFNESS))
	O.materials.append(FrictMat(label="steel", young=200e9, poisson=0.3, frictionAngle=0.3, density=7800))
	body = Body()
	body.shape = RoundPlaten(radius=ROUND, length=0.02, concave=concave, halfAngle=0.5)
	body.material = O.materials[material]
	body.state.pos, body.state.ori = Vector3(0.1, 0.2, -0.1), TURN
	body.dynamic = False
	platen = O.bodies.append(body)
	outward = TURN * Vector3(math.sin(angle), math.cos(angle), 0)
	distance = ROUND - RADIUS + overlap if concave else ROUND + RADIUS - overlap
	place = body.state.pos + distance * outward + TURN * Vector3(0, 0, along)
	ball = O.bodies.append(utils.sphere(place, RADIUS, material="rock", **sphere))
	O.engines = ddem.bonded.engines()
	O.dt = 1e-9
	return ball, platen, outward


@pytest.mark.parametrize("concave, angle", [(False, 0.0), (False, 2.5), (True, 0.0), (True, -0.45)])
def test_force_and_direction(concave, angle):
	ball, platen, outward = touching(concave, angle, 1e-6)
	O.step()
	push = math.pi * RADIUS * STIFFNESS * 1e-6 * (-outward if concave else outward)
	assert np.allclose(O.forces.f(ball), push, rtol=1e-8, atol=1e-8 * push.norm())
	assert np.allclose(O.forces.f(platen), -push, rtol=1e-8, atol=1e-8 * push.norm())
	assert O.forces.t(platen).norm() < 1e-6 * push.norm() * ROUND  # the force goes through the axis


@pytest.mark.parametrize("concave, angle, along", [(False, 0.0, 0.0101), (True, 0.51, 0.0), (True, math.pi, 0.0)])
def test_beyond_ends_and_edges_nothing_touches(concave, angle, along):
	touching(concave, angle, 1e-6, along=along)
	O.step()
	assert not any(i.isReal for i in O.interactions)


@pytest.mark.parametrize("concave", [False, True])
def test_what_flies_against_it_comes_back_as_fast(concave):
	"""Found by the collider on its way: the box around a platen holds all that it may touch."""
	ball, _, outward = touching(concave, 0.3, -2e-5)
	state = O.bodies[ball].state
	inward = outward if concave else -outward
	state.vel = 1.0 * inward
	period = math.pi * math.sqrt(state.mass / (math.pi * RADIUS * STIFFNESS))  # half of one, in contact
	O.dt = period / 500
	O.run(int((period + 4.2e-5) / O.dt), True)
	assert state.vel.dot(inward) == pytest.approx(-1, rel=1e-4)
	assert (state.vel - state.vel.dot(inward) * inward).norm() < 1e-6


def test_with_friction_it_takes_twice_mu_of_the_normal_speed():
	"""Along its axis, sliding all the time: v_t' = v_t - 2 μ v_n (μ = tan 0.3 of steel)."""
	ball, _, outward = touching(False, 0.0, 0, material="steel")
	state = O.bodies[ball].state
	state.pos += 1e-9 * outward
	along = TURN * Vector3(0, 0, 1)
	state.vel = -1.0 * outward + 2.0 * along
	O.dt = 1e-9
	O.run(6000, True)
	assert state.vel.dot(outward) == pytest.approx(1, rel=2e-3)
	assert state.vel.dot(along) == pytest.approx(2 - 2 * math.tan(0.3), rel=0.02)


def test_the_time_step_counts_platens_ahead():
	"""A sphere close to a platen has its spring in the bound before it touches:
	2/ω with half of the mass's share."""
	ball, _, _ = touching(False, 0.0, -0.5e-3)
	spring = math.pi * RADIUS * STIFFNESS
	bound = ddem.bonded.critical_time_step()
	assert bound == pytest.approx(2 * math.sqrt(O.bodies[ball].state.mass / spring), rel=1e-6)


def test_a_sphere_that_is_through_stops_the_run():
	ball, _, outward = touching(True, 0.0, 0)
	O.bodies[ball].state.pos += 2.5e-3 * outward
	with pytest.raises(RuntimeError, match="behind the platen #0"):
		O.step()


@pytest.mark.parametrize("wrong, words", [
	(dict(radius=0, length=1), "radius = 0 m must be positive"),
	(dict(radius=1), "length = nan m must be positive"),
	(dict(radius=1, length=1, halfAngle=2), "halfAngle = 2 rad must lie between 0 and π/2"),
])
def test_bad_numbers(wrong, words):
	with pytest.raises(ValueError, match=words):
		RoundPlaten(**wrong)


def test_it_survives_saving(tmp_path):
	ball, platen, _ = touching(True, 0.2, 1e-6)
	O.step()
	force = Vector3(O.forces.f(ball))
	O.save(str(tmp_path / "jaw.xml"))
	O.load(str(tmp_path / "jaw.xml"))
	shape = O.bodies[platen].shape
	assert (shape.radius, shape.length, shape.concave, shape.halfAngle) == (ROUND, 0.02, True, 0.5)
	O.step()
	assert np.allclose(O.forces.f(ball), force, rtol=1e-3)
