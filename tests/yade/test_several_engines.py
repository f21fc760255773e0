# GPL v2 or later, see LICENSE.
"""Blocks of triangles with engines of their own in one scene."""
import numpy as np
import pytest

from deformable_samples import agitate, elastic, steps
from yade import ConcreteDamageMat, DeformableEngine, DeformableTimeStepper, ForceResetter, O, ddem

SIZE = dict(width=0.04, height=0.04, size=0.009)


def two_blocks():
	left = ddem.append(ddem.mesh.rectangle(**SIZE), elastic())
	O.materials.append(ConcreteDamageMat(label="concrete"))
	right = ddem.append(ddem.mesh.rectangle(**SIZE), "concrete", seed=3, position=(1, 0, 0))
	return left, right


def alone(which, rotation):
	"""Positions of one of the blocks in a scene of its own."""
	O.reset()
	block = two_blocks()[which]
	O.engines = [ForceResetter(), DeformableEngine(rotation=rotation)]
	O.dt = 2e-7
	agitate(block, 2, seed=which)
	steps(40)
	return block.positions.copy(), np.array(block.stress)


@pytest.mark.parametrize("by", ("ids", "bit", "one by ids"))
def test_each_moves_its_own_as_if_alone(by):
	expected = [alone(0, "corotational"), alone(1, "cosserat")]
	O.reset()
	blocks = two_blocks()
	first, second = (
		DeformableEngine(rotation="corotational"),
		DeformableEngine(rotation="cosserat", groupMask=1 << 21),
	)
	if by == "bit":
		for i in (*blocks[0].triangle_ids, *blocks[0].node_ids):
			O.bodies[i].groupMask = 1 << 20
		for i in (*blocks[1].triangle_ids, *blocks[1].node_ids):
			O.bodies[i].groupMask = 1 << 21
	else:
		first.ids = list(blocks[0].triangle_ids)
		if by == "ids":
			second.ids = list(blocks[1].triangle_ids)
	O.engines = [ForceResetter(), first, second]
	O.dt = 2e-7
	for which, block in enumerate(blocks):
		agitate(block, 2, seed=which)
	O.run(40, True)
	for block, (positions, stress) in zip(blocks, expected):
		assert np.array_equal(block.positions, positions)  # bit by bit
		assert np.array_equal(np.array(block.stress), stress)
		body = O.bodies[block.triangle_ids[3]]
		assert np.isclose(body.shape.stress[0][0, 0], block.stress[3, 0, 0], rtol=1e-12)


def test_saving_and_energies_are_of_all(tmp_path):
	blocks = two_blocks()
	O.engines = [
		ForceResetter(),
		DeformableEngine(ids=list(blocks[0].triangle_ids)),
		DeformableEngine(groupMask=1 << 21),
	]
	O.dt, O.trackEnergy = 2e-7, True
	for which, block in enumerate(blocks):
		agitate(block, 2, seed=which)
	steps(10)
	kinetic = sum(
		0.5 * (e.array(kind + "Mass")[:, None] * e.array(kind + "Velocity")**2).sum()
		for e in O.engines[1:]
		for kind in ("node", "core")
	)
	assert O.energy["kinetic"] == pytest.approx(kinetic, rel=0.2)  # of both; spins and half a step apart
	O.save(str(tmp_path / "two.yade.gz"))
	steps(10)
	expected = [block.positions.copy() for block in blocks]
	O.load(str(tmp_path / "two.yade.gz"))
	steps(10)
	for block, positions in zip(blocks, expected):
		assert np.array_equal(block.positions, positions)


def test_a_stepper_follows_the_stiffest_of_all():
	left = ddem.append(ddem.mesh.rectangle(**SIZE), elastic())
	fine = ddem.append(ddem.mesh.rectangle(0.02, 0.02, size=0.002), "elastic", position=(1, 0, 0))
	O.engines = [
		ForceResetter(),
		DeformableTimeStepper(),
		DeformableEngine(ids=list(left.triangle_ids)),
		DeformableEngine(groupMask=1 << 21),
	]
	O.dt = 1
	O.step()
	critical = [e.criticalTimeStep() for e in O.engines[2:]]
	assert critical[1] < 0.5 * critical[0]
	assert O.dt == pytest.approx(0.8 * critical[1], rel=1e-9)
	assert ddem.time_step(0.8) == pytest.approx(O.dt, rel=1e-9)
	assert len(fine.triangle_ids) > 0


def test_what_is_not_said_is_refused():
	blocks = two_blocks()
	O.dt = 1e-9
	O.engines = [ForceResetter(), DeformableEngine(), DeformableEngine(groupMask=1 << 21)]
	with pytest.raises(ValueError, match="nothing says which moves it.*ids"):
		O.step()
	O.engines = [ForceResetter(), DeformableEngine(ids=[blocks[0].node_ids[0]])]
	with pytest.raises(ValueError, match="is not a DeformableTriangle"):
		O.step()
	half = list(blocks[0].triangle_ids[:5])
	O.engines = [ForceResetter(), DeformableEngine(ids=half), DeformableEngine(groupMask=1 << 21)]
	with pytest.raises(ValueError, match="node has triangles of two DeformableEngine"):
		O.step()
