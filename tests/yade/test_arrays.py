# GPL v2 or later, see LICENSE.
# Ids that samples hand out go wherever YADE takes ids; other arrays cannot be written to in vain.
import random

import numpy as np
import pytest
from yade import (
	BondedMat, DeformableEngine, ForceEngine, ForceResetter, InteractionLoop, O, RadialForceEngine,
	RampedTranslationEngine, TranslationEngine, Vector3i, ddem, utils)

from deformable_samples import elastic, skewed_mesh


def block_ids():
	block = ddem.append(ddem.mesh.rectangle(0.02, 0.04, size=0.01), elastic())
	return {
		"node_ids": block.node_ids, "triangle_ids": block.triangle_ids, "boundary": block.boundary("top"),
		"platens": ddem.platens(block, velocity=1).top
	}


def sphere_ids():
	O.materials.append(BondedMat(label="rock"))
	centres = [(0.001 * i, 0, 0) for i in range(6)]
	sample = ddem.bonded.append(ddem.packing.Packing(centres, np.full(6, 0.0005)), "rock")
	O.engines = ddem.bonded.engines()
	return {
		"ids": sample.ids, "from_scene": ddem.bonded.BondedSample.from_scene().ids,
		"row of bonds": sample.bonds[0]
	}


OWNERS = {
	"block": (block_ids, ("node_ids", "triangle_ids", "boundary", "platens")),
	"spheres": (sphere_ids, ("ids", "from_scene", "row of bonds"))
}
CASES = [(owner, name) for owner, (_, names) in OWNERS.items() for name in names]


def handed_out(owner, name):
	return OWNERS[owner][0]()[name]


@pytest.mark.parametrize("owner, name", CASES)
def test_ids_are_taken_by_everything_of_yade_that_takes_ids(owner, name):
	ids = handed_out(owner, name)
	expected = ids.tolist()
	assert len(expected) >= 2
	assert [O.bodies[i].id for i in ids] == expected
	assert O.bodies[ids[0]].id == expected[0] and O.bodies[ids[-1]].id == expected[-1]
	for engine in (TranslationEngine, RampedTranslationEngine, ForceEngine, RadialForceEngine):
		assert list(engine(ids=ids).ids) == expected
		made = engine()
		made.ids = ids
		assert list(made.ids) == expected
	O.forces.addF(ids[0], (1, 0, 0))
	O.forces.setPermF(ids[1], (1, 0, 0))
	assert O.forces.f(ids[0], sync=True)[0] == 1 and O.forces.permF(ids[1])[0] == 1
	assert utils.sumForces(list(ids), (1, 0, 0)) == 2  # one for the moment, one for good
	assert not O.interactions.has(ids[0], ids[0])
	assert Vector3i(ids[0], ids[1], ids[0])[1] == expected[1]
	assert random.Random(1).choice(ids) in expected
	assert O.bodies.erase(ids[-1])


@pytest.mark.parametrize("owner, name", CASES)
def test_what_is_taken_from_ids_are_ids(owner, name):
	ids = handed_out(owner, name)
	whole = ids.tolist()
	for found, expected in (
		(ids[1:], whole[1:]), (ids[::-1], whole[::-1]), (ids[[0, -1]], [whole[0], whole[-1]]),
		(ids[np.asarray(ids) > whole[0]], [i for i in whole if i > whole[0]]),
		(np.concatenate([ids[:1], ids[1:]]), whole), (np.setdiff1d(ids, ids[:1]), sorted(set(whole[1:]))),
		(np.intersect1d(ids, ids[:1]), whole[:1]),
		(np.union1d(ids, ids), sorted(whole)), (np.unique(ids), sorted(whole)), (np.sort(ids), sorted(whole)),
		(ids.copy(), whole), (ids.take([0]), whole[:1]),
	):
		assert list(ForceEngine(ids=found).ids) == expected
		assert [O.bodies[i].id for i in found] == expected
	assert O.bodies[ids.max()].id == max(whole) and O.bodies[ids.min()].id == min(whole)


def test_a_bond_is_found_by_a_row_of_bonds():
	sphere_ids()
	sample = ddem.bonded.BondedSample.from_scene()
	assert len(sample.bonds) == 5
	for i, j in sample.bonds:
		assert O.interactions[i, j].isReal


def test_ids_index_arrays_and_what_arithmetic_makes_of_them_are_plain():
	ids = handed_out("block", "node_ids")
	values = np.arange(100.0)
	assert values[ids].tolist() == [float(i) for i in ids]
	for made in (ids == 3, ids + 1, np.isin(ids, [3])):
		assert type(made) is np.ndarray
	with pytest.raises(ValueError, match="read-only"):
		ids[0] = 7


def test_a_block_takes_ids_of_any_kind_and_one_alone():
	block = ddem.append(ddem.mesh.rectangle(0.02, 0.04, size=0.01), elastic())
	first, second = block.node_ids[:2]
	for given in (first, np.int64(first), [first], np.array([first], dtype=np.int32), (first,), []):
		O.bodies[first].state.blockedDOFs = "zXYZ"
		block.drive(given, (2, None))
		assert O.bodies[first].state.blockedDOFs == ("xzXYZ" if np.size(given) else "zXYZ")
		assert O.bodies[second].state.blockedDOFs == "zXYZ"
	for wrong in (1.5, [1.0], ["top"], [None]):
		with pytest.raises(ValueError, match="ids of bodies must be whole numbers, not"):
			block.hold(wrong)


BLOCK_ARRAYS = (
	"positions", "displacements", "reference_positions", "velocities", "velocity", "node_forces", "stress",
	"strain", "plastic_strain", "sub_element_damage", "damage", "rotation",
	"area", "node_ids", "triangle_ids"
)


@pytest.mark.parametrize("steps", [0, 5])
@pytest.mark.parametrize("name", BLOCK_ARRAYS)
def test_no_array_of_a_block_can_be_written_to_in_vain(name, steps):
	block = ddem.append(skewed_mesh(), elastic())
	O.engines = [ForceResetter(), DeformableEngine()]
	O.dt = ddem.time_step(0.8)
	block.velocity = (3, 4)
	for _ in range(steps):
		O.step()
	array = getattr(block, name)
	before = array.copy()
	with pytest.raises(ValueError, match="read-only"):
		array[:] = 1
	with pytest.raises(ValueError, match="read-only"):
		array += 1
	assert np.array_equal(getattr(block, name), before)


@pytest.mark.parametrize(
	"name",
	["positions", "displacements", "velocities", "radii", "bonds", "bond_stresses", "broken", "damage", "ids"]
)
def test_no_array_of_bonded_spheres_can_be_written_to_in_vain(name):
	sphere_ids()
	assert any(isinstance(e, InteractionLoop) for e in O.engines)
	array = getattr(ddem.bonded.BondedSample.from_scene(), name)
	with pytest.raises(ValueError, match="read-only"):
		array[:] = array.copy()
	assert not array.flags.writeable


def test_plain_numpy_integers_are_what_yade_refuses():
	"""Why all this is needed; once YADE takes them it is not."""
	i = O.bodies.append(utils.sphere((0, 0, 0), 1))
	with pytest.raises(Exception, match="numpy.int64|did not match"):
		ForceEngine(ids=np.array([i]))
