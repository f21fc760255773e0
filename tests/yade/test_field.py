# GPL v2 or later, see LICENSE.
"""Values of all triangles, whose sums go through the tree over tiles."""
import copy
import pickle

import numpy as np
import pytest

from deformable_samples import agitate, elastic, start, steps
from yade import ConcreteDamageMat, DeformableElastMat, O, ddem
from yade.ddem.field import TILE, Field, tree_sum


def by_hand(values, places):
	"""The tree as the kernel's TileSums.hpp describes it, one number after the other."""
	tiles = []
	for tile in range(int(places.max()) // TILE + 1):
		lanes = [0.0] * TILE
		for value, place in zip(values, places):
			if place // TILE == tile:
				lanes[place % TILE] = value
		while len(lanes) > 1:
			half = len(lanes) // 2
			lanes = [lanes[i] + lanes[half + i] for i in range(half)]
		tiles.append(lanes[0])
	while len(tiles) > 1:
		pairs = [tiles[i] + tiles[i + 1] if i + 1 < len(tiles) else tiles[i] for i in range(0, len(tiles), 2)]
		tiles = pairs
	return tiles[0]


@pytest.mark.parametrize("count, last", ((1, 0), (10, 400), (700, 1300)))
def test_sums_follow_the_tree(count, last):
	random = np.random.default_rng(1)
	places = np.sort(random.choice(last + 1, count, replace=False))
	values = random.normal(size=count) * 10.0**random.integers(-8, 8, count)
	field = Field(values, places)
	assert field.sum() == by_hand(values, places)
	assert field.mean() == by_hand(values, places) / count
	assert field.min() == values.min() and field.max() == values.max()
	assert np.max(field) == values.max()
	assert np.mean(field) == field.mean() and np.sum(field) == field.sum()


def test_a_domain_may_sum_any_rows_and_add_zeros_for_the_rest():
	random = np.random.default_rng(2)
	values, places = random.normal(size=900), np.arange(900)
	mine = random.random(900) < 0.5
	assert tree_sum(values[mine], places[mine]) == tree_sum(np.where(mine, values, 0.0), places)


def test_numpy_takes_it_as_an_array():
	values = np.arange(12.0).reshape(2, 2, 3)
	field = Field(values, np.array([0, 300]))
	assert field.shape == (2, 2, 3) and len(field) == 2 and field.dtype == float
	assert (2 * field + 1 == 2 * values + 1).all() and type(2 * field) is np.ndarray
	assert (field[1] == values[1]).all() and (field[..., 0] == values[..., 0]).all()
	assert (field.sum(axis=0) == values.sum(axis=0)).all() and (field.mean(axis=2) == values.mean(axis=2)).all()
	assert (np.maximum(field, 5) == np.maximum(values, 5)).all()
	assert (field > 3).sum() == 8
	assert np.concatenate([field, field]).shape == (4, 2, 3)
	assert (np.asarray(field) == values).all() and (copy.copy(field)[:] == values).all()
	assert pickle.loads(pickle.dumps(field)).sum() == field.sum()
	with pytest.raises(ValueError, match="read-only"):
		field[0] = 1
	with pytest.raises(AttributeError):
		field.no_such_thing


def test_what_a_block_says_of_its_triangles_are_fields():
	O.materials.append(ConcreteDamageMat(label="concrete"))
	O.materials.append(DeformableElastMat(bulk=151e9, shear=81e9, density=8030, label="steel"))
	mesh = ddem.mesh.rectangle(0.1, 0.2, 0.01, regions={"steel": ddem.mesh.box(0.043, 0.093, 0.057, 0.107)})
	block = ddem.append(mesh, {"": "concrete", "steel": "steel"}, seed=1)
	start()
	agitate(block, 2)
	steps(20)
	for name in ("damage", "stress", "strain", "plastic_strain", "sub_element_damage", "rotation", "area"):
		assert isinstance(getattr(block, name), Field), name
	assert block.damage.mean() == pytest.approx(np.asarray(block.damage).mean(), rel=1e-12)
	assert block.area.sum() == pytest.approx(0.02, rel=1e-12)
	assert (block.area > 0).all()
