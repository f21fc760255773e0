# GPL v2 or later, see LICENSE.
# Convex shapes, and what it means to fill one with spheres.
import hashlib
import json
import math

import numpy as np
import pytest

from ddem import packing, shapes

_TOUCHING = 1.1e-10  # of the largest radius: what packing.fill promises, and a little for rounding here

BOX = shapes.Box((0, -1, 2), (4, 7, 6))
CYLINDER = shapes.Cylinder((1, 0, 0), (1, 8, 0), 2.5)
TILTED = shapes.Cylinder((0, 0, 0), (3, 4, 12), 3)
BALL = shapes.Ball((1, 2, 3), 4)
TETRAHEDRON = shapes.Polyhedron([(0, 0, 0), (9, 0, 0), (0, 9, 0), (0, 0, 9)])
RECTANGLE = shapes.Rectangle((-1, 0), (9, 20))
DISC = shapes.Disc((3, 4), 7)
TRAPEZIUM = shapes.Polygon([(0, 0), (12, 0), (9, 8), (2, 8)])
ALL = (BOX, CYLINDER, TILTED, BALL, TETRAHEDRON, RECTANGLE, DISC, TRAPEZIUM)


def depth(shape, points):
	"""Distance from the closest wall, by formulas of their own."""
	if isinstance(shape, shapes.Ball):
		return shape.radius - np.linalg.norm(points - shape.centre, axis=1)
	if isinstance(shape, shapes.Cylinder):
		along = (points - shape.bottom) @ shape.axis
		across = np.linalg.norm(np.cross(points - shape.bottom, shape.axis), axis=1)
		return np.min([shape.radius - across, along, shape.height - along], axis=0)
	return (shape.offsets - points @ shape.normals.T).min(axis=1)


@pytest.mark.parametrize("shape", ALL, ids=str)
def test_filled_shapes_hold_spheres_that_touch_but_do_not_overlap(shape):
	spheres = packing.fill(shape, 0.25, 1, seed=3, fails=2000)
	assert (depth(shape, spheres.centres) >= spheres.radii - _TOUCHING).all()
	assert spheres.radii.min() >= 0.25 and spheres.radii.max() <= 1
	pairs = spheres.neighbours(0.01)
	first, second = pairs.T
	gaps = np.linalg.norm(spheres.centres[first] - spheres.centres[second], axis=1)
	gaps -= spheres.radii[first] + spheres.radii[second]
	assert gaps.min() > -_TOUCHING
	# every insertion makes as many contacts, with spheres or walls, as a sphere there has unknowns
	walls = (depth(shape, spheres.centres) < spheres.radii + _TOUCHING).sum()
	assert (gaps < _TOUCHING).sum() + 3 * walls > 0.9 * (shape.dimension + 1) * len(spheres) - 60
	assert spheres.flat == (shape.dimension == 2)
	if not spheres.flat:
		assert 0.5 < spheres.solid_fraction < 0.74
	assert spheres.shape is shape
	assert (spheres.lower[:shape.dimension] == shape.lower[:shape.dimension]).all()


def test_neighbours_lie_close_in_memory():
	"""Half of the pairs that touch are less than a hundredth of the rows apart;
	in the order of insertion a third."""
	spheres = packing.fill(BOX, 0.06, 0.12, seed=1, fails=200)
	pairs = spheres.neighbours(1e-4)
	assert np.median(abs(pairs[:, 0] - pairs[:, 1])) < 0.01 * len(spheres)


def digest(spheres):
	rows = np.column_stack([spheres.centres, spheres.radii])
	return hashlib.sha256(rows.astype("<f8").tobytes()).hexdigest()[:16]


@pytest.mark.parametrize("shape, expected", [
	(BOX, "05dfef79597e188b"), (CYLINDER, "0f316151dc2180aa"), (DISC, "3fc4579da068c95f"),
], ids=str)
def test_the_same_seed_gives_the_same_bits_on_any_machine(shape, expected):
	"""The digests were recorded once; another one means that packings which a seed stands for have changed."""
	assert digest(packing.fill(shape, 0.3, 1, seed=2, fails=500)) == expected
	assert digest(packing.fill(shape, 0.3, 1, seed=3, fails=500)) != expected


def test_more_fails_make_a_denser_packing():
	fractions = [packing.fill(BOX, 0.25, 1, fails=fails).solid_fraction for fails in (10, 200, 4000)]
	assert fractions == sorted(fractions)


def test_a_packing_grows_with_its_shape():
	"""Lengths are of no size of their own: a power of two changes no digit."""
	small = packing.fill(BOX, 0.25, 1, fails=300)
	tiny = packing.fill(shapes.Box(BOX.lower / 1024, BOX.upper / 1024), 0.25 / 1024, 1 / 1024, fails=300)
	assert np.array_equal(small.centres, 1024 * tiny.centres) and np.array_equal(small.radii, 1024 * tiny.radii)


def test_volumes_and_inner_radii_are_those_of_geometry():
	assert BOX.volume == 128 and BOX.inner == 2
	assert CYLINDER.volume == pytest.approx(math.pi * 2.5**2 * 8) and CYLINDER.inner == 2.5
	assert TILTED.volume == pytest.approx(math.pi * 9 * 13) and TILTED.inner == 3
	assert BALL.volume == pytest.approx(4 / 3 * math.pi * 64)
	assert TETRAHEDRON.volume == pytest.approx(9**3 / 6)
	assert TETRAHEDRON.inner == pytest.approx(9 / (3 + math.sqrt(3)), rel=1e-6)
	assert RECTANGLE.volume == 200 and RECTANGLE.inner == 5
	assert DISC.volume == pytest.approx(49 * math.pi) and TRAPEZIUM.volume == pytest.approx(8 * (12 + 7) / 2)


def test_a_tilted_cylinder_lies_in_its_box():
	angle = np.linspace(0, 2 * math.pi, 1000)
	across = np.linalg.svd(TILTED.axis[None])[2][1:]
	rim = TILTED.radius * (np.cos(angle)[:, None] * across[0] + np.sin(angle)[:, None] * across[1])
	points = np.concatenate([TILTED.bottom + rim, TILTED.top + rim])
	assert points.min(axis=0) == pytest.approx(TILTED.lower, abs=1e-4)
	assert points.max(axis=0) == pytest.approx(TILTED.upper, abs=1e-4)


def test_half_spaces_are_the_polyhedron_of_their_corners():
	cut = shapes.Polyhedron.from_half_spaces(
		[(-2, 0, 0), (0, -1, 0), (0, 0, -1), (3, 3, 3), (1, 0, 0)], [0, 0, 0, 27, 100]
	)
	assert cut.volume == pytest.approx(TETRAHEDRON.volume) and len(cut.corners) == 4  # the last one cuts nothing
	assert cut.upper == pytest.approx(TETRAHEDRON.upper)
	cube = shapes.Polyhedron([(x, y, z) for x in (0, 3) for y in (0, 3) for z in (0, 3)])
	assert len(cube.walls) == 6  # Qhull's twelve triangles


def test_faces_are_what_platens_load():
	assert [BOX.face(axis) for axis in range(3)] == [32, 16, 32]
	assert CYLINDER.face(1) == pytest.approx(math.pi * 2.5**2)
	assert shapes.Cylinder((0, 0, 0), (0, -1, 0), 1).face(1) == pytest.approx(math.pi)
	frustum = shapes.Polyhedron([(x * s, y, z * s) for y, s in ((0, 2), (5, 1)) for x in (-1, 1) for z in (-1, 1)])
	assert frustum.face(1) == pytest.approx(4)  # the smaller one
	assert RECTANGLE.face(1) == 10 and RECTANGLE.face(0) == 20 and RECTANGLE.face(2) == 200
	assert TRAPEZIUM.face(1) == pytest.approx(7)
	for shape, axis in ((BALL, 0), (DISC, 1), (CYLINDER, 0), (TETRAHEDRON, 1), (TRAPEZIUM, 0), (TILTED, 2)):
		with pytest.raises(ValueError, match=f"no flat face at its (low|upp)er end across {'xyz'[axis]}"):
			shape.face(axis)


def test_areas_and_volumes_of_packings_are_those_of_their_shapes():
	spheres = packing.fill(CYLINDER, 0.5, 1, fails=50)
	assert spheres.area() == CYLINDER.face(1) and spheres.volume == CYLINDER.volume
	layer = packing.fill(RECTANGLE, 0.5, 1, fails=50)
	assert layer.size == pytest.approx([10, 20, 2]) and layer.area() == 20 and layer.volume == 400
	assert layer.area(0) == 40 and layer.area(2) == 200
	plain = packing.Packing(layer.centres, layer.radii, layer.lower, layer.upper)
	assert plain.area() == layer.area() and plain.solid_fraction == pytest.approx(layer.solid_fraction)
	with pytest.raises(ValueError, match="axis = 3 must be 0, 1 or 2"):
		plain.area(3)


@pytest.mark.parametrize("make, words", [
	(lambda: shapes.Box((0, 0, 0), (1, 0, 1)), "upper y = 0.0 m must be above lower y = 0.0 m"),
	(lambda: shapes.Box((0, 0), (1, 1)), "must be 3 finite coordinates"),
	(lambda: shapes.Rectangle((0, 0), (1, float("nan"))), "must be 2 finite coordinates"),
	(lambda: shapes.Ball((0, 0, 0), -1), "radius = -1 m must be positive"),
	(lambda: shapes.Cylinder((0, 0, 0), (0, 0, 0), 1), "are the same point"),
	(lambda: shapes.Polyhedron([(0, 0, 0), (1, 0, 0), (0, 1, 0)]), "at least 4 corners"),
	(lambda: shapes.Polyhedron([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)]), "lie in one plane"),
	(lambda: shapes.Polygon([(0, 0), (1, 0), (2, 0)]), "lie in one line"),
	(lambda: shapes.Polygon([(0, 0), (2, 0), (2, 2), (1.5, 0.5)]), r"corner 3 at .1.5, 0.5. m lies .* convex"),
	(lambda: shapes.Polyhedron.from_half_spaces([(1, 0, 0), (-1, 0, 0)], [0, -1]), "no point in common"),
	(lambda: shapes.Polyhedron.from_half_spaces([(-1, 0, 0), (1, 1, 1)], [0, 1]), "no end towards -y"),
	(lambda: shapes.Polyhedron.from_half_spaces([(0, 0, 0)], [0]), "the normals not zero"),
])
def test_bad_shapes_are_refused(make, words):
	with pytest.raises(ValueError, match=words):
		make()


@pytest.mark.parametrize("change, words", [
	({"shape": None}, "NoneType is no shape to fill"), ({"rmax": 3}, "largest sphere that fits into the box of"),
	({"rmin": 2}, "rmin = 2 m is above rmax = 1 m"), ({"rmin": 0}, "rmin = 0 m must be positive"),
	({"seed": -1}, "seed = -1 must be a whole number"), ({"seed": 1.5}, "seed = 1.5 must be a whole number"),
	({"fails": 0}, "fails = 0 must be a whole number from 1"),
])
def test_bad_orders_are_refused(change, words):
	with pytest.raises(ValueError, match=words):
		packing.fill(**{**dict(shape=BOX, rmin=0.5, rmax=1), **change})


@pytest.mark.parametrize("arguments, words", [
	((0.02, 0.008, 30), r"flat = 30 rad must lie between 0 and π/2; degrees\? Then math.radians\(30\)"),
	((0.02, 0.008, 0), "flat = 0 rad must lie between 0 and π/2$"), ((0.02, 0.008, math.nan), "flat = nan rad"),
	((-0.02, 0.008), "diameter = -0.02 m must be positive"), ((0.02, 0), "length = 0 m must be positive"),
])
def test_a_flattened_disc_of_bad_numbers_is_refused(arguments, words):
	with pytest.raises(ValueError, match=words):
		shapes.flattened_disc(*arguments)


@pytest.mark.parametrize("shape", [BOX, TILTED, BALL, TETRAHEDRON, RECTANGLE, DISC, TRAPEZIUM], ids=str)
def test_a_shape_comes_back_from_its_record(shape):
	"""Through JSON, to the last bit."""
	again = shapes.from_record(json.loads(json.dumps(shape.as_record())))
	assert type(again) is type(shape) and again.volume == shape.volume
	assert (again.lower == shape.lower).all() and (again.upper == shape.upper).all()


def test_a_record_of_another_kind_is_refused():
	with pytest.raises(ValueError, match="kind = 'Torus' is no shape"):
		shapes.from_record({"kind": "Torus"})
