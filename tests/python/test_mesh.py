# GPL v2 or later, see LICENSE.
"""The mesh itself: quality figures, borders, regions, order in memory, and what validate() refuses."""
import numpy as np
import pytest
from ddem import mesh
from mesh_samples import BAR, HOLE, towards_hole

# A rectangle of 4 m x 3 m in two 3-4-5 triangles
NODES = [(0, 0), (4, 0), (4, 3), (0, 3)]
TRIANGLES = [(0, 1, 2), (0, 2, 3)]


@pytest.fixture
def halves():
	return mesh.Mesh(NODES, TRIANGLES, regions=[0, 1], region_names=("", "upper"))


# ---- figures ----


def test_figures_of_a_345_triangle(halves):
	assert halves.areas == pytest.approx([6, 6])
	assert halves.edge_lengths.tolist() == [[4, 3, 5], [5, 4, 3]]
	assert halves.heights == pytest.approx([2.4, 2.4])
	assert halves.sizes == pytest.approx([4, 4])
	assert halves.angles[0] == pytest.approx([36.8698976, 90, 53.1301024])  # atan(3/4)
	assert halves.centroids.tolist() == [[8 / 3, 1], [4 / 3, 2]]


def test_quality_names_the_worst_triangles():
	nodes = [*NODES, (6, 0.5), (20, 3)]  # triangle 2 is the lowest, triangle 3 the sharpest
	quality = mesh.Mesh(nodes, [*TRIANGLES, (1, 4, 2), (2, 4, 5)]).quality()
	assert (quality.ruling_triangle, quality.smallest_angle_triangle, quality.largest_aspect_triangle) == (2, 3, 3)
	assert quality.smallest_height == pytest.approx(6 / np.hypot(2, 2.5))
	assert quality.smallest_angle == pytest.approx(np.degrees(np.arctan2(2.5, 14)))
	assert quality.shortest_edge == pytest.approx(np.hypot(2, 0.5))
	assert quality.longest_edge == 16
	assert quality.smallest_area == pytest.approx(3)
	assert quality.largest_area == pytest.approx(20)
	assert quality.regions[""] == (4, pytest.approx(35))
	text = str(quality)
	assert (
		"smallest height 1.874 m, triangle 2 at (4.667, 1.167) m" in text
		and "triangle 3 at (10, 2.167) m" in text
	)


def test_aspect_of_an_equilateral_triangle_is_one():
	assert mesh.Mesh([(0, 0), (1, 0), (0.5, np.sqrt(0.75))], [(0, 1, 2)]).quality().largest_aspect == pytest.approx(
		1
	)


def test_quality_does_not_choose_among_equals_by_round_off():
	assert mesh.rectangle(0.1, 0.2, size=0.01).quality().ruling_triangle == 0


# ---- border and regions ----


def test_sides_of_the_border():
	block = mesh.rectangle(0.1, 0.2, size=0.01)
	x, y = block.nodes.T
	assert len(block.boundary()) == 60
	for side, chosen in (("bottom", y == 0), ("top", y == y.max()), ("left", x == 0), ("right", x == x.max())):
		assert block.boundary(side).tolist() == np.flatnonzero(chosen).tolist()
	assert block.boundary(lambda x, y: (y == 0) & (x > 0.049)).tolist() == [5, 6, 7, 8, 9, 10]
	plate = mesh.polygon(mesh.box(0, 0, 0.1, 0.2), holes=[HOLE], size=towards_hole)
	rim = plate.nodes[plate.boundary(lambda x, y: np.hypot(x - 0.05, y - 0.15) < 0.02)]
	assert len(rim) >= 48
	assert np.hypot(*(rim - (0.05, 0.15)).T) == pytest.approx(0.01, rel=0.003)


def test_unknown_side_and_wrong_predicate():
	block = mesh.rectangle(1, 1, size=0.5)
	with pytest.raises(ValueError, match="unknown side 'upper'; use one of left, right, bottom, top"):
		block.boundary("upper")
	with pytest.raises(ValueError, match="8 values.*int64"):
		block.boundary(lambda x, y: np.arange(len(x)))


def test_region_and_select():
	block = mesh.rectangle(0.1, 0.2, size=0.01, regions={"steel": BAR})
	assert block.region("steel").tolist() == block.select(BAR).tolist()
	assert len(block.region("")) == 792
	assert repr(block) == "Mesh(431 nodes, 800 triangles, steel 8)"
	with pytest.raises(ValueError, match="no region 'stele' in this mesh; it has '', 'steel'"):
		block.region("stele")


def test_a_mesh_cannot_be_changed_in_place(halves):
	for array in (halves.nodes, halves.triangles, halves.regions):
		with pytest.raises(ValueError, match="read-only"):
			array[0] = 0
	nodes = np.array(NODES, dtype=float)
	m = mesh.Mesh(nodes, TRIANGLES)
	nodes[0] = 99
	assert m.nodes[0].tolist() == [0, 0]


# ---- order ----


def index_distances(m):
	"""How far apart neighbours are in the list of triangles."""
	own = np.repeat(np.arange(len(m.neighbours)), 3).reshape(-1, 3)
	return np.abs(own - m.neighbours)[m.neighbours >= 0]


def shuffled(m, seed):
	random = np.random.default_rng(seed)
	nodes, triangles = random.permutation(len(m.nodes)), random.permutation(len(m.triangles))
	return mesh.Mesh(
		m.nodes[nodes], np.argsort(nodes)[m.triangles[triangles]], m.regions[triangles], m.region_names
	)


def corners(m):
	"""What does not depend on numbering: each triangle's corners (from its lowest one on) and region."""
	return sorted(
		(min(shape[k:] + shape[:k] for k in range(3)), region)
		for shape, region in zip(m.nodes[m.triangles].tolist(), m.regions.tolist())
	)


def test_reordered_brings_neighbours_together():
	block = mesh.rectangle(0.1, 0.2, size=0.002, regions={"steel": mesh.box(0.042, 0.092, 0.058, 0.108)})
	mixed = shuffled(block, 1)
	order = mixed.reordered()
	# On a Hilbert curve neighbours are about √m apart on average and mostly very near; in random order they are m/3
	# apart. A regular mesh row by row has a small mean too, but from each row to the next the way is long.
	assert index_distances(order).mean() < 1.2 * np.sqrt(len(block.triangles))
	assert index_distances(order).mean() < 0.02 * index_distances(mixed).mean()
	assert np.median(index_distances(order)) <= 3
	assert (index_distances(order) > 64).mean() < 0.6 * (index_distances(block) > 64).mean()


def test_reordered_is_the_same_mesh_in_a_canonical_order():
	block = mesh.rectangle(
		0.1, 0.2, size=0.005, pattern="unstructured",
		regions={"steel": BAR, "core": mesh.box(0.047, 0.097, 0.053, 0.103)}
	)
	first, again, other = block.reordered(), block.reordered(), shuffled(block, 2).reordered()
	assert corners(first) == corners(block)
	assert first.triangles.tobytes() == again.triangles.tobytes() and first.nodes.tobytes() == again.nodes.tobytes()
	assert first.centroids == pytest.approx(other.centroids)  # whatever the order was before
	assert (np.diff(first.regions) >= 0).all()
	assert [first.regions[0], first.regions[-1]] == [0, 2]
	_, appearance = np.unique(first.triangles.ravel(), return_index=True)
	assert (np.diff(appearance) > 0).all()  # nodes in order of first use


# ---- validity ----


@pytest.mark.parametrize(
	"nodes, triangles, message",
	[
		(
			[*NODES, (2, 0)],
			[*TRIANGLES, (0, 4, 1)],
			r"triangle 2 with corners \(0, 0\) \(2, 0\) \(4, 0\) m has no area; remove it",
		),
		(NODES, [*TRIANGLES, (0, 0, 1)], r"triangle 2 .* has no area"),
		(
			NODES,
			[(0, 1, 2), (0, 3, 2)],
			(
				r"triangle 1 with corners \(0, 0\) \(0, 3\) \(4, 3\) m is clockwise; "
				r".*mesh.flipped\(\).*orient=True"
			),
		),
		(NODES, [(2, 1, 0), (0, 3, 2)], r"triangle 0 .* is clockwise \(and 1 more\)"),
		(NODES, [*TRIANGLES, (2, 0, 1)], r"triangle 2 .* is the same as triangle 0; remove one"),
		([*NODES, (9, 9)], TRIANGLES, r"node 4 at \(9, 9\) m belongs to no triangle"),
		(
			[*NODES, (4, 3), (0, 0)],
			[(0, 1, 2), (5, 4, 3)],
			r"nodes 0 and 5 are both at \(0, 0\) m \(and 1 more\)",
		),
		([*NODES, (4, 3 + 1e-12), (4, 6)], [*TRIANGLES, (3, 4, 5)], r"nodes 2 and 4 are both at \(4, 3\) m"),
		([*NODES, (2, 4), (3, 5)], [*TRIANGLES, (0, 2, 4)], r"belongs to no triangle"),
		(
			[*NODES, (2, 4), (3, 5)],
			[*TRIANGLES, (0, 2, 4), (0, 2, 5)],
			(
				r"edge between nodes 0 and 2, \(0, 0\) m to \(4, 3\) m, belongs to 4 triangles \(0, "
				r"1, 2, 3\); at most two"
			),
		),
		([*NODES, (2, 1), (3, 1), (3, 2)], [*TRIANGLES, (4, 5, 6)], r"triangle 0 .* overlaps triangle 2"),
		# and triangle 1
		([*NODES, (1, 1.2), (2.5, 1), (2, 2.3)], [*TRIANGLES, (4, 5, 6)], r"triangle 0 .* overlaps triangle 2"),
		([*NODES, (2, 1), (6, 1), (6, 2)], [*TRIANGLES, (4, 5, 6)], r"triangle 0 .* overlaps triangle 2"),
		(
			[*NODES, (4, 1), (6, 1)],
			[*TRIANGLES, (1, 5, 4)],
			r"node 4 at \(4, 1\) m of triangle 2 lies on an edge of triangle 0 .* split that triangle",
		),
		(
			[*NODES, (4 + 1e-12, 1), (6, 1)],
			[*TRIANGLES, (1, 5, 4)],
			r"node 4 at \(4, 1\) m of triangle 2 lies on an edge of triangle 0",
		),
		([(0, 0), (1, 0), (0.5, 1e-11)], [(0, 1, 2)], r"has no area"),
	],
)
def test_invalid_meshes_are_refused_with_triangle_and_place(nodes, triangles, message):
	with pytest.raises(ValueError, match=message):
		mesh.Mesh(nodes, triangles).validate()


@pytest.mark.parametrize(
	"arguments, message", [
		(
			dict(nodes=[(0, 0), (1, np.nan), (0, 1)], triangles=[(0, 1, 2)]),
			r"node 1 is at \(1, nan\) m: coordinates must be finite",
		),
		(
			dict(nodes=[(0, 0, 0)] * 3, triangles=[(0, 1, 2)]),
			r"nodes must be \(n, 2\) coordinates \[m\], not an array of shape \(3, 3\)",
		),
		(
			dict(nodes=NODES, triangles=[(0, 1, 4)]),
			r"triangle 0 has nodes \(0, 1, 4\), but nodes are numbered from 0 to 3",
		),
		(dict(nodes=NODES, triangles=[(0, 1, 2), (0, -1, 2)]), r"triangle 1 has nodes \(0, -1, 2\)"),
		(dict(nodes=NODES, triangles=[(0, 1, 2.5)]), r"integer node indices, not float64"),
		(dict(nodes=NODES, triangles=[(0, 1, 2, 3)]), r"of shape \(1, 4\)"),
		(dict(nodes=NODES, triangles=np.empty((0, 3), dtype=int)), r"at least one triangle"),
		(
			dict(nodes=NODES, triangles=TRIANGLES, regions=[0]),
			r"one integer a triangle \(2\), not .* of shape \(1,\)",
		),
		(
			dict(nodes=NODES, triangles=TRIANGLES, regions=[0, 1]),
			r"triangle 1 is in region 1, but region_names has 1 names",
		),
		(
			dict(nodes=NODES, triangles=TRIANGLES, region_names=("steel",)),
			r"region_names must be different strings, the first of them \"\"",
		),
		(
			dict(nodes=NODES, triangles=TRIANGLES, region_names=("", "a", "a")),
			r"region_names must be different strings",
		),
	]
)
def test_arrays_of_the_wrong_kind_are_refused(arguments, message):
	with pytest.raises(ValueError, match=message):
		mesh.Mesh(**arguments)


def test_slivers_and_meeting_corners_are_valid():
	mesh.Mesh([(0, 0), (1, 0), (0.5, 1e-7)], [(0, 1, 2)]).validate()
	mesh.Mesh([*NODES, (5, 3), (5, 4)], [*TRIANGLES, (2, 4, 5)]).validate()  # joined at one node
	mesh.Mesh([*NODES, (5, 0), (6, 0), (5, 1)], [*TRIANGLES, (4, 5, 6)]).validate()  # in two pieces


def test_flipped_and_orient_turn_only_clockwise_triangles():
	wrong = mesh.Mesh(NODES, [(0, 1, 2), (0, 3, 2)], regions=[0, 1], region_names=("", "upper"))
	for right in (
		wrong.flipped().validate(),
		mesh.Mesh(NODES, wrong.triangles, [0, 1], ("", "upper"), orient=True).validate(),
	):
		assert right.triangles.tolist() == [[0, 1, 2], [2, 3, 0]]
		assert right.areas == pytest.approx([6, 6])
		assert right.region("upper").tolist() == [1]
