# GPL v2 or later, see LICENSE.
# Velocities and spins of whole blocks, and what a block says before it has an engine.
import math
import sys

import numpy as np
import pytest
from yade import DeformableEngine, ForceResetter, O, PyRunner, ddem

from deformable_samples import (
	TREATMENTS, agitate, angular_momentum, bodies, elastic, kinetic_energy, momentum, place, skewed_mesh, start,
	state_positions, state_velocities, steps)


def two_materials():
	"""A block whose mass centre is not that of its area, away from the origin."""
	mesh = ddem.mesh.rectangle(0.05, 0.04, size=0.01, regions={"heavy": ddem.mesh.box(0, 0, 0.02, 0.04)})
	elastic("light")
	elastic("heavy", density=8000)
	return ddem.append(mesh, {"": "light", "heavy": "heavy"}, thickness=0.3, position=(0.2, -0.1, 0))


def total(engine):
	"""Mass, centre of mass, velocity of it, angular momentum about it, from the engine's own arrays."""
	mass = np.concatenate([engine.array("nodeMass"), engine.array("coreMass")])
	x = np.vstack([engine.array("nodePosition"), engine.array("corePosition")])
	centre = mass @ x / mass.sum()
	velocity = momentum(engine) / mass.sum()
	about = angular_momentum(engine) - mass.sum() * (centre[0] * velocity[1] - centre[1] * velocity[0])
	return mass, x, centre, velocity, about


@pytest.mark.parametrize("when", ["before O.engines", "before the first step", "between runs"])
@pytest.mark.parametrize("treatment", TREATMENTS)
def test_a_thrown_block_flies_with_the_velocity_it_was_given(when, treatment):
	block = two_materials()
	throw = lambda: setattr(block, "velocity", (3, -2))
	if when == "before O.engines":
		throw()
		assert block.velocity == pytest.approx((3, -2), rel=1e-14)
	start(rotation=treatment)
	if when == "between runs":
		O.run(20, True)
	if when != "before O.engines":
		throw()
	assert (block.velocities == (3, -2)).all() and (state_velocities(block.triangle_ids) == (3, -2)).all()
	before = state_positions([*block.node_ids, *block.triangle_ids])
	time = O.time
	O.run(200, True)
	moved = state_positions([*block.node_ids, *block.triangle_ids]) - before
	assert moved == pytest.approx(np.tile(np.array([3, -2]) * (O.time - time), (len(moved), 1)), rel=1e-9)
	assert block.velocity == pytest.approx((3, -2), rel=1e-12)
	assert np.abs(block.strain).max() < 1e-12


@pytest.mark.parametrize("in_engines", [False, True])
def test_a_spin_turns_the_block_about_its_centre_of_mass_on_top_of_its_velocity(in_engines):
	"""In either order, and with the momenta that the engine's own arrays have."""
	found = []
	for order in ("velocity first", "spin first"):
		O.reset()
		block = two_materials()
		if in_engines:
			start()
		for name in ("velocity", "spin") if order == "velocity first" else ("spin", "velocity"):
			setattr(block, name, (3, -2) if name == "velocity" else -40)
		assert block.velocity == pytest.approx((3, -2), rel=1e-12)
		assert block.spin == pytest.approx(-40, rel=1e-12)
		engine = start()
		mass, x, centre, velocity, about = total(engine)
		assert velocity == pytest.approx((3, -2), rel=1e-12)
		arm = x - centre
		inertia = (mass * (arm**2).sum(axis=1)).sum() + sum(
			b.state.inertia[2] for b in bodies(block.triangle_ids)
		)
		assert about == pytest.approx(-40 * inertia, rel=1e-10)
		assert kinetic_energy(engine) + 0.5 * sum(
			b.state.inertia[2] for b in bodies(block.triangle_ids)
		) * 40**2 == pytest.approx(
			0.5 * mass.sum() * 13 + 0.5 * inertia * 40**2, rel=1e-10)
		found.append(np.vstack([engine.array("nodeVelocity"), engine.array("coreVelocity")]))
	assert found[0] == pytest.approx(found[1], rel=1e-11, abs=1e-11)
	quarter = round(math.pi / 2 / 40 / O.dt)
	O.run(quarter, True)
	assert block.spin == pytest.approx(-40, rel=1e-3)  # the turning block is stretched a little by itself
	turned = block.positions - block.positions.mean(axis=0)
	start_shape = block.reference_positions - block.reference_positions.mean(axis=0)
	assert turned == pytest.approx(np.column_stack([start_shape[:, 1], -start_shape[:, 0]]), abs=1e-4)


def test_reading_motion_gives_what_moves_in_any_state():
	"""Momentum over mass and angular momentum over inertia, though nodes and cores move at random."""
	for treatment in TREATMENTS:
		O.reset()
		block = two_materials()
		agitate(block, 5)
		without = block.velocity, block.spin
		engine = start(rotation=treatment)
		steps(3)
		mass, x, centre, velocity, about = total(engine)
		inertia = (mass * ((x - centre)**2).sum(axis=1)).sum()
		if treatment == "cosserat":
			inertia += sum(b.state.inertia[2] for b in bodies(block.triangle_ids))
		assert block.velocity == pytest.approx(velocity, rel=1e-10)
		assert block.spin == pytest.approx(about / inertia, rel=1e-8)
		if treatment == "cosserat":  # momenta do not change in the steps
			assert without[0] == pytest.approx(velocity, rel=1e-9)
			assert without[1] == pytest.approx(block.spin, rel=1e-3)


def test_setting_spin_keeps_momentum_and_the_other_way_round():
	block = two_materials()
	agitate(block, 5)
	velocity, spin = block.velocity, block.spin
	block.spin = spin
	assert block.velocity == pytest.approx(velocity, rel=1e-10) and block.spin == pytest.approx(spin, rel=1e-10)
	block.velocity = (0, 0)
	assert block.spin == pytest.approx(spin, rel=1e-10)
	block.spin = 0
	assert np.abs(state_velocities([*block.node_ids, *block.triangle_ids])).max() < 1e-12


@pytest.mark.parametrize("ready", [False, True])
def test_velocities_of_nodes_take_the_cores_along(ready):
	"""A linear field is one of nodes, cores and spins, whatever the mesh and the shape it has now."""
	block = two_materials()
	if ready:
		start()
		place(block, lambda x, y: (1.02 * x + 0.01 * y, y - 0.03 * x))
	gradient, at_origin = np.array([[20.0, -70.0], [30.0, 50.0]]), np.array([3.0, -2.0])
	field = lambda x: at_origin + x @ gradient.T
	block.velocities = field(block.positions)
	for ids in (block.node_ids, block.triangle_ids):
		assert state_velocities(ids) == pytest.approx(field(state_positions(ids)), rel=1e-10)
	assert [
		b.state.angVel[2] for b in bodies(block.triangle_ids)
	] == pytest.approx([(30 + 70) / 2] * len(block.triangle_ids))
	if not ready:
		assert block.velocities == pytest.approx(field(block.positions))
		block.velocities = (1, 0)
		assert block.velocity == pytest.approx((1, 0)) and block.spin == pytest.approx(0, abs=1e-12)


def test_what_is_held_keeps_its_prescribed_velocity_when_the_block_is_thrown():
	block = ddem.append(ddem.mesh.rectangle(0.02, 0.04, size=0.01), elastic())
	block.hold(block.boundary("bottom"), "y")
	block.drive(block.boundary("top"), (5, None))
	block.velocity = (1, -3)
	rows = lambda side: block.mesh.boundary(side)
	assert (block.velocities[rows("bottom")] == (1, 0)).all()
	assert (block.velocities[rows("top")] == (5, -3)).all()
	block.spin = 10
	assert (block.velocities[rows("bottom"), 1] == 0).all() and (block.velocities[rows("top"), 0] == 5).all()
	block.spin = 0
	driven = block.velocities[rows("top")]
	# what is driven is no spin of the block
	assert driven == pytest.approx(np.tile((5.0, -3.0), (len(driven), 1)), rel=1e-12)
	block.velocities = np.tile((2, 7), (len(block.node_ids), 1))  # every node is told, the held ones too
	assert (block.velocities == (2, 7)).all()


def test_velocity_is_set_by_a_pyrunner_in_a_run_and_refused_beside_one():
	block = two_materials()
	sys.modules["__main__"].throw = lambda: setattr(block, "velocity", (3, -2))
	runner = PyRunner(command="throw()", iterPeriod=10, firstIterRun=10, nDo=1)
	start(runner)
	O.run(20, True)
	assert block.velocity == pytest.approx((3, -2), rel=1e-12)
	O.run()
	try:
		with pytest.raises(RuntimeError, match="a run is going on.*O.pause"):
			block.spin = 3
	finally:
		O.pause()
		O.wait()


@pytest.mark.parametrize(
	"name, value, message", [
		("velocity", 3, "two finite numbers"), ("velocity", (1, 2, 3), r"\(1, 2, 3\).*two finite numbers"),
		("velocity", (math.nan, 0), "nan.*two finite numbers.*m/s"),
		("spin", (1, 2), r"spin = \(1, 2\).*finite number.*rad/s"), ("spin", math.inf, "inf.*finite"),
		("velocities", np.zeros((3, 2)), r"\(3, 2\)"),
		("velocities", (math.nan, 1), "1 values that are not finite"), ("velocities", 5, "one pair")
	]
)
def test_bad_motion_is_refused_and_changes_nothing(name, value, message):
	block = two_materials()
	block.velocity = (1, 1)
	with pytest.raises(ValueError, match=message):
		setattr(block, name, value)
	assert (state_velocities([*block.node_ids, *block.triangle_ids]) == 1).all()


# --- before O.engines is set

FROM_STATE = (
	"positions", "displacements", "reference_positions", "velocities", "velocity", "spin", "area",
	"degrees_of_freedom"
)
FROM_ENGINE = ("node_forces", "stress", "strain", "plastic_strain", "sub_element_damage", "damage", "rotation")


@pytest.mark.parametrize("name", FROM_STATE)
def test_what_state_and_mesh_know_can_be_read_without_an_engine(name):
	block = two_materials()
	block.velocity = (3, -2)
	block.spin = 20
	without = getattr(block, name)
	start()
	assert without == pytest.approx(getattr(block, name), rel=1e-12, abs=1e-13)
	O.engines = []
	assert getattr(block, name) == pytest.approx(without, rel=1e-12, abs=1e-13)


@pytest.mark.parametrize("name", FROM_ENGINE)
def test_what_the_engine_computes_says_so_without_one(name):
	block = two_materials()
	with pytest.raises(
		RuntimeError,
		match=rf"block\.{name} is computed by a DeformableEngine, and O.engines has none yet: set O.engines = "
	):
		getattr(block, name)
	O.engines = [ForceResetter(), DeformableEngine()]
	assert np.abs(getattr(block, name)).max() < 1  # Pa, N, -: nothing but round-off of positions


def test_positions_without_an_engine_are_current_after_a_run():
	block = two_materials()
	start()
	agitate(block, 5)
	O.run(30, True)
	positions, velocities = block.positions.copy(), block.velocities.copy()
	O.engines = []
	assert np.array_equal(block.positions, positions) and np.array_equal(block.velocities, velocities)


def test_pictures_without_an_engine(tmp_path):
	block = two_materials()
	block.plot("region", file=str(tmp_path / "region.png"))
	assert (tmp_path / "region.png").stat().st_size > 1000
	with pytest.raises(RuntimeError, match="block.damage is computed by a DeformableEngine"):
		block.plot("damage")
	with pytest.raises(RuntimeError, match="computed by a DeformableEngine"):
		ddem.platens(block, velocity=1).force_top
	assert ddem.platens(block, velocity=1).strain == 0


@pytest.mark.parametrize("name", FROM_STATE[:6])
def test_a_block_of_a_former_scene_says_so_without_an_engine_too(name):
	block = ddem.append(skewed_mesh(), elastic())
	O.reset()
	for new in (lambda: None, lambda: ddem.append(ddem.mesh.rectangle(0.02, 0.04, size=0.01), elastic())):
		new()
		with pytest.raises(
			RuntimeError,
			match="body [0-9]+ of this block is not in the present scene; append the mesh again"
		):
			getattr(block, name)


def test_rows_follow_ids_wherever_they_stand():
	"""The engine may keep its rows in another order than that of the bodies."""
	from yade.ddem.block import _rows
	ids = ddem.append(skewed_mesh(), elastic()).node_ids[3:9]
	for others in (range(40), [*range(8, -1, -1), *range(9, 40)], np.random.default_rng(2).permutation(40)):
		every = np.array(others)
		rows = _rows(every, ids)
		assert every[rows].tolist() == ids.tolist()
	assert isinstance(_rows(np.arange(40), ids), slice)
	with pytest.raises(RuntimeError, match="body 5 of this block"):
		_rows(np.array([3, 4, 6, 7, 8]), ids)
