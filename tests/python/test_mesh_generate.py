# GPL v2 or later, see LICENSE.
"""Meshes that the package makes: exact areas, conformity, angle and size bounds, regions, determinism, bad input."""
import math
import warnings
from collections import Counter

import numpy as np
import pytest
from ddem import mesh
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from mesh_samples import ANGLED, BAR, HOLE, SAMPLES, circumference, shoelace, towards_hole

# degrees; CGAL manual, "2D Conforming Triangulations and Meshes": sin² of the smallest angle is at least 1/8
GUARANTEED_ANGLE = 20.6


@pytest.fixture(params=SAMPLES, scope="module")
def sample(request):
	return SAMPLES[request.param]()


def edge_counts(triangles):
	return Counter(frozenset(edge) for a, b, c in triangles.tolist() for edge in ((a, b), (b, c), (c, a)))


def loops(directed):
	"""Closed chains of the border's edges; fails when they are not closed."""
	following, count = {a: b for a, b in directed.tolist()}, 0
	assert len(following) == len(directed)
	while following:
		start = at = next(iter(following))
		count += 1
		while True:
			at = following.pop(at)
			if at == start:
				break
	return count


# ---- every mesh ----


def test_area_is_exact(sample):
	wanted = shoelace(sample.outline) - sum(shoelace([*hole]) for hole in sample.holes)
	assert sample.mesh.areas.sum() == pytest.approx(wanted, rel=1e-12)


def test_triangles_are_counter_clockwise(sample):
	assert (sample.mesh.areas > 0).all()


def test_inner_edges_have_two_triangles_and_the_border_is_closed(sample):
	counts = edge_counts(sample.mesh.triangles)
	assert set(counts.values()) <= {1, 2}
	assert sum(1 for count in counts.values() if count == 1) == len(sample.mesh.boundary_edges())
	assert loops(sample.mesh.boundary_edges()) == 1 + len(sample.holes)


def test_euler_characteristic(sample):
	nodes, edges, triangles = (
		len(sample.mesh.nodes),
		len(edge_counts(sample.mesh.triangles)),
		len(sample.mesh.triangles),
	)
	assert nodes - edges + triangles == 1 - len(sample.holes)


def test_border_has_the_length_of_the_outline(sample):
	a, b = np.moveaxis(sample.mesh.nodes[sample.mesh.boundary_edges()], 1, 0)
	wanted = sum(circumference([*ring]) for ring in (sample.outline, *sample.holes))
	assert np.linalg.norm(b - a, axis=1).sum() == pytest.approx(wanted, rel=1e-9)


def test_mesh_lies_on_the_left_of_its_border(sample):
	a, b = np.moveaxis(sample.mesh.nodes[sample.mesh.boundary_edges()], 1, 0)
	enclosed = 0.5 * (a[:, 0] * b[:, 1] - b[:, 0] * a[:, 1]).sum()  # Green's theorem
	assert enclosed == pytest.approx(sample.mesh.areas.sum(), rel=1e-9)


def test_generated_meshes_are_valid(sample):
	assert sample.mesh.validate() is sample.mesh


def test_smallest_angle(sample):
	# atan(1/2) where odd cells are not square
	assert sample.mesh.angles.min() >= (GUARANTEED_ANGLE if sample.generated else 26.5)


def test_regions_are_exact(sample):
	for name, shape in sample.regions.items():
		taken = sum(shoelace([*hole]) for hole in sample.holes) if name == "lining" else 0
		assert sample.mesh.areas[sample.mesh.region(name)].sum() == pytest.approx(
			shoelace([*shape]) - taken, rel=1e-9
		)


def test_neighbours_share_an_edge_and_know_each_other(sample):
	triangles, neighbours = sample.mesh.triangles.tolist(), sample.mesh.neighbours.tolist()
	for t, others in enumerate(neighbours):
		for k, other in enumerate(others):
			if other >= 0:
				assert {triangles[t][k], triangles[t][(k + 1) % 3]} <= set(triangles[other])
				assert t in neighbours[other]
	assert sum(other < 0 for others in neighbours for other in others) == len(sample.mesh.boundary_edges())


# ---- regular meshes ----


def test_meshes_of_the_paper():
	# Zubelewicz (2018), sections 4.2 and 4.3: 1600 triangles; 800 triangles, 8 of them a rebar of 1.4 cm x 1.4 cm
	assert len(mesh.rectangle(0.1, 0.4, size=0.01).triangles) == 1600
	block = mesh.rectangle(0.1, 0.2, size=0.01, regions={"steel": BAR})
	assert len(block.triangles) == 800
	steel = block.region("steel")
	assert len(steel) == 8
	centre = np.flatnonzero(np.abs(block.nodes - (0.05, 0.1)).max(axis=1) < 1e-12)
	assert (block.triangles[steel] == centre).any(axis=1).all()  # the eight around the middle
	assert block.areas[steel].sum() == pytest.approx(2e-4, rel=1e-12)


@pytest.mark.parametrize("pattern, per_cell, heights", [("crossed", 4, 0.5), ("alternating", 2, math.sqrt(0.5))])
def test_cells_of_a_regular_mesh(pattern, per_cell, heights):
	block = mesh.rectangle(0.3, 0.2, size=0.0333, pattern=pattern)
	assert len(block.triangles) == 9 * 6 * per_cell
	assert block.heights == pytest.approx(heights * 0.3 / 9)
	assert mesh.rectangle(0.3, 0.2, nx=9, ny=6, pattern=pattern).triangles.tolist() == block.triangles.tolist()


def test_alternating_diagonals_meet_in_every_other_node():
	block = mesh.rectangle(4, 4, nx=4, ny=4, pattern="alternating")
	valence = Counter(block.triangles.ravel().tolist())
	inner = set(range(25)) - set(block.boundary().tolist())
	assert sorted(valence[node] for node in inner) == [4] * 4 + [8] * 5


def test_no_direction_is_preferred():
	# The second moment of the edge directions, Σ L² (t⊗t), is isotropic for both patterns on square cells.
	for pattern in ("crossed", "alternating"):
		block = mesh.rectangle(1, 1, nx=4, ny=4, pattern=pattern)
		edges = np.roll(block.nodes[block.triangles], -1, axis=1) - block.nodes[block.triangles]
		moment = np.einsum("tki,tkj->ij", edges, edges)
		assert moment == pytest.approx(moment[0, 0] * np.eye(2), abs=1e-12)


def test_warning_when_regular_mesh_misses_a_region():
	with pytest.warns(UserWarning, match=r"'steel'.* 0.00015 m² instead of 0.000196 m² \(-23.5%\).*unstructured"):
		mesh.rectangle(0.1, 0.2, size=0.005, regions={"steel": BAR})
	with warnings.catch_warnings():
		warnings.simplefilter("error")
		mesh.rectangle(0.1, 0.2, size=0.01, regions={"steel": BAR[::-1]})  # 2 % too large
		mesh.rectangle(0.1, 0.2, size=0.007 / 3, regions={"steel": mesh.box(0.042, 0.084, 0.056, 0.112)})
		mesh.rectangle(0.1, 0.2, size=0.005, pattern="unstructured", regions={"steel": BAR})


@given(
	st.integers(1, 12), st.integers(1, 12), st.floats(0.01, 100), st.floats(0.01, 100),
	st.sampled_from(["crossed", "alternating"])
)
@settings(max_examples=25)
def test_any_regular_mesh(nx, ny, width, height, pattern):
	block = mesh.rectangle(width, height, nx=nx, ny=ny, pattern=pattern)
	assert block.areas == pytest.approx(width * height / len(block.triangles), rel=1e-9)
	assert block.nodes.min(axis=0).tolist() == [0, 0]
	assert block.nodes.max(axis=0) == pytest.approx([width, height])
	assert len(block.boundary()) == 2 * (nx + ny)


# ---- irregular meshes ----


@pytest.mark.parametrize("smoothing", [0, 10])
def test_mean_edge_length_is_the_size(smoothing):
	for outline in (mesh.box(0, 0, 0.1, 0.2), mesh.disc(0, 0, 0.07, 200), ANGLED):
		quality = mesh.polygon(outline, size=0.003, smoothing=smoothing).quality()
		assert quality.mean_edge == pytest.approx(0.003, rel=0.05)
		assert quality.longest_edge <= 1.8 * 0.003


def test_border_is_cut_evenly():
	# Halving 0.1 m until it is short enough would give pieces of 6.25 mm.
	block = mesh.polygon(mesh.box(0, 0, 0.1, 0.1), size=0.005)
	assert np.linalg.norm(np.diff(block.nodes[block.boundary_edges()], axis=1)[:, 0], axis=1) == pytest.approx(
		0.005
	)
	wedge = mesh.polygon(mesh.box(0, 0, 0.1, 0.1), size=lambda x, y: 0.002 + 0.1 * x)
	ends = wedge.nodes[wedge.boundary_edges()]
	pieces = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / (0.002 + 0.1 * ends[:, :, 0].mean(axis=1))
	assert np.median(pieces) == pytest.approx(1, abs=0.05)
	assert (pieces < 1.2).all()


@pytest.mark.parametrize("smoothing", [0, 10])
def test_size_field_is_followed(smoothing):
	plate = mesh.polygon(mesh.box(0, 0, 0.1, 0.2), holes=[HOLE], size=towards_hole, smoothing=smoothing)
	wanted = np.array([towards_hole(x, y) for x, y in plate.centroids])
	assert wanted.max() / wanted.min() > 20
	assert (plate.edge_lengths.max(axis=1) <= 1.8 * wanted).all()
	middle = np.median(plate.sizes / wanted)
	assert 0.8 < middle < 1.2
	# not finer than asked for, in no part of the range
	for low, high in ((0, 0.002), (0.002, 0.005), (0.005, 0.05)):
		part = (wanted > low) & (wanted <= high)
		assert part.sum() > 50
		assert 0.75 < np.mean(plate.sizes[part] / wanted[part]) < 1.25


def test_angle_bound_is_what_keeps_slivers_away():
	sharp = [(0, 0), (1, 0), (1, 0.5), (0.5, 0.501), (0, 0.5)]
	bar = {"thin": mesh.box(0.3, 0.2, 0.7, 0.21)}
	assert mesh.polygon(sharp, size=0.3, min_angle=0, smoothing=0, regions=bar).angles.min() < 10
	assert mesh.polygon(sharp, size=0.3, smoothing=0, regions=bar).angles.min() >= GUARANTEED_ANGLE
	assert mesh.polygon(sharp, size=0.3, smoothing=10, regions=bar).angles.min() >= GUARANTEED_ANGLE


def test_smoothing_evens_angles_out():
	rough, smooth = (mesh.polygon(mesh.box(0, 0, 1, 1), size=0.05, smoothing=steps) for steps in (0, 10))
	assert np.percentile(smooth.angles.min(axis=1), 5) > np.percentile(rough.angles.min(axis=1), 5) + 2


@pytest.mark.parametrize("smoothing", [3, 10, 40])
def test_angle_bound_holds_after_smoothing_of_steep_fields(smoothing):
	# Smoothing alone leaves angles down to 16 degrees here.
	for corners in range(5, 12):
		m = mesh.polygon(
			mesh.disc(0, 0, 1, corners),
			size=lambda x, y: 0.02 + 0.9 * math.hypot(x - 0.1, y),
			smoothing=smoothing,
		)
		assert m.angles.min() >= GUARANTEED_ANGLE


def test_smoothing_keeps_to_the_size_field():
	plate = mesh.polygon(mesh.box(0, 0, 0.1, 0.2), holes=[HOLE], size=towards_hole, smoothing=40)
	relative = plate.sizes / [towards_hole(x, y) for x, y in plate.centroids]
	assert np.log(relative).std() < 0.15  # 0.11; nodes that forget the field make it 0.22


def test_nested_regions_and_borders_in_common():
	regions = {
		"outer": mesh.box(0, 0, 0.6, 1),
		"inner": mesh.box(0.2, 0.2, 0.4, 0.4),
		"beside": mesh.box(0.6, 0.5, 1, 1),
		"slanted": [(0.7, 0.1), (0.9, 0.2), (0.8, 0.4)],
	}
	plate = mesh.polygon(mesh.box(0, 0, 1, 1), size=0.1, regions=regions)
	areas = {name: plate.areas[plate.region(name)].sum() for name in plate.region_names}
	assert areas == pytest.approx(
		{"": 0.2 - 0.025, "outer": 0.6 - 0.04, "inner": 0.04, "beside": 0.2, "slanted": 0.025}
	)


def test_region_corner_on_a_slanted_edge_makes_no_sliver():
	# A corner that lies on the outline only to round-off must not leave a gap of 1e-17 m.
	a, b = np.array([0.1, 0.0]), np.array([1.0, 0.7])
	corners = [a + t * (b - a) for t in (1 / 3, 2 / 3)]
	plate = mesh.polygon([(0, 0), a, b, (0, 1)], size=0.1, regions={"patch": [*corners, (0.3, 0.5)]})
	assert plate.angles.min() >= GUARANTEED_ANGLE
	assert plate.areas[plate.region("patch")].sum() == pytest.approx(shoelace([*corners, (0.3, 0.5)]), rel=1e-9)


def test_same_input_gives_the_same_mesh():
	make = lambda **options: mesh.polygon(
		mesh.disc(0, 0, 1, 40), holes=[mesh.disc(0.3, 0, 0.2, 20)], size=0.08, **options
	)
	first = make()
	# so that memory is laid out differently
	others = [mesh.rectangle(1, 1, size=0.03 + 0.001 * i, pattern="unstructured") for i in range(3)]
	again = make()
	assert (
		others
		and first.nodes.tobytes() == again.nodes.tobytes()
		and first.triangles.tobytes() == again.triangles.tobytes()
	)
	drawn, redrawn, other = make(seed=1), make(seed=1), make(seed=2)
	assert drawn.nodes.tobytes() == redrawn.nodes.tobytes()
	assert len({m.nodes.tobytes() for m in (first, drawn, other)}) == 3
	for m in (drawn, other):
		assert m.quality().mean_edge == pytest.approx(first.quality().mean_edge, rel=0.03)


@given(
	st.integers(6, 12).flatmap(lambda n: st.lists(st.floats(0.7, 1.3), min_size=n, max_size=n)),
	st.floats(0.1, 10),
	st.floats(0.05, 3),
)
@settings(max_examples=30)
def test_any_convex_polygon(gaps, radius, relative_size):
	directions = 2 * math.pi * np.cumsum(gaps) / sum(gaps)
	corners = radius * np.column_stack([np.cos(directions), 0.8 * np.sin(directions)])
	sides = np.roll(corners, -1, axis=0) - corners
	corner_angles = [
		180 - math.degrees(math.atan2(a[0] * b[1] - a[1] * b[0], a @ b))
		for a, b in zip(sides, np.roll(sides, -1, axis=0))
	]
	assume(min(corner_angles) >= 60)  # the guarantee's condition
	m = mesh.polygon(corners, size=relative_size * radius)
	m.validate()
	assert m.areas.sum() == pytest.approx(shoelace([*corners]), rel=1e-9)
	assert m.angles.min() >= GUARANTEED_ANGLE
	assert len(m.nodes) - len(m.edges) + len(m.triangles) == 1


@given(
	st.integers(3, 9).flatmap(
		lambda n: st.lists(st.tuples(st.floats(0.5, 1.5), st.floats(0.3, 1)), min_size=n, max_size=n)
	),
	st.floats(0.1, 1),
)
@settings(max_examples=30)
def test_any_star_shaped_polygon(arms, size):
	# Corners as sharp and as deep as they come: no angle is promised, but the mesh is a proper one.
	directions = 2 * math.pi * np.cumsum([gap for gap, _ in arms]) / sum(gap for gap, _ in arms)
	assume(np.diff(np.append(directions, directions[0] + 2 * math.pi)).max() < 3)
	corners = np.array([length for _, length in arms])[:, None] * np.column_stack(
		[np.cos(directions), np.sin(directions)]
	)
	m = mesh.polygon(corners, size=size)
	m.validate()
	assert m.areas.sum() == pytest.approx(shoelace([*corners]), rel=1e-9)
	assert len(m.nodes) - len(m.edges) + len(m.triangles) == 1


def test_needle():
	# A corner of 2 degrees: refinement ends, and only triangles there are sharp.
	needle = [(0, 0), (1, -math.tan(math.radians(1))), (1, math.tan(math.radians(1)))]
	m = mesh.polygon(needle, size=0.02)
	assert m.areas.sum() == pytest.approx(math.tan(math.radians(1)))
	assert m.angles.min() == pytest.approx(2, rel=0.01)
	assert len(m.triangles) < 2000


# ---- bad input ----

SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]


@pytest.mark.parametrize(
	"call, message", [
		(lambda: mesh.rectangle(0, 1, 0.1), r"width is 0 m.*positive"),
		(lambda: mesh.rectangle(1, math.nan, 0.1), r"height is nan m"),
		(lambda: mesh.rectangle("1", 1, 0.1), r"width is '1' m"),
		(lambda: mesh.rectangle(1, 1, -0.1), r"size.* is -0.1 m"),
		(lambda: mesh.rectangle(1, 1, math.inf), r"size.* is inf m"),
		(lambda: mesh.rectangle(1, 1), r"size \(or give nx\) is None m"),
		(
			lambda: mesh.rectangle(1, 1, 0.1, pattern="hexagons"),
			r"pattern 'hexagons'; use one of crossed, alternating, unstructured",
		),
		(lambda: mesh.rectangle(1, 1, nx=2.5, ny=1), r"nx is 2.5; .*whole number"),
		(lambda: mesh.rectangle(1, 1, nx=0, ny=1), r"nx is 0"),
		(
			lambda: mesh.rectangle(1, 1, 1e-5),
			r"1e\+05 x 1e\+05|100000 x 100000 cells would give about 4e\+10 triangles",
		),
		(lambda: mesh.rectangle(1, 1, 1e-300), r"limit"),
		(lambda: mesh.rectangle(1, 1, lambda x, y: 0.1), r"size field needs pattern=\"unstructured\""),
		(lambda: mesh.rectangle(1, 1, 0.1, smoothing=3), r"smoothing only for pattern=\"unstructured\""),
		(lambda: mesh.rectangle(1, 1, 0.1, pattern="unstructured", nx=3), r"nx and ny"),
		(
			lambda: mesh.rectangle(1, 1, 0.1, regions={"a": mesh.box(0.5, 0.5, 1.5, 0.7)}),
			r"outline and region 'a' cross at \(1, 0.[57]\) m",
		),
		(
			lambda: mesh.rectangle(1, 1, 0.1, regions={"a": mesh.box(2, 0, 3, 1)}),
			(
				r"region 'a' lies outside of the outline at \(2.5, 0\) m; the outline spans \(0, 0\) "
				r"to \(1, 1\) m"
			),
		),
		(
			lambda: mesh.rectangle(
				1, 1, 0.1, regions={"a": [(0.2, 0.2), (0.8, 0.2), (0.2, 0.8), (0.9, 0.8)]}
			),
			r"region 'a' crosses itself",
		),
		(
			lambda: mesh.rectangle(1, 1, 0.5, regions={"a": mesh.box(0.01, 0.01, 0.02, 0.02)}),
			r"region 'a'.* no triangle's centroid; use a smaller size",
		),
		(lambda: mesh.rectangle(1, 1, 0.1, regions={"": BAR}), r"region name ''"),
		(lambda: mesh.polygon(SQUARE, size=0), r"size is 0 m"),
		(lambda: mesh.polygon(SQUARE, size=math.nan), r"size is nan m"),
		(lambda: mesh.polygon(SQUARE), r"size is None m"),
		(
			lambda: mesh.polygon(SQUARE, size=lambda x, y: x - 0.5),
			r"size field gives -?[0-9.e-]+ m at \(.*\) m",
		),
		(lambda: mesh.polygon(SQUARE, size=lambda x, y: "small"), r"size field gives nan m"),
		(lambda: mesh.polygon(SQUARE, size=0.1, min_angle=25), r"min_angle is 25 degrees; .* 20.70 degrees"),
		(lambda: mesh.polygon(SQUARE, size=0.1, min_angle=math.nan), r"min_angle is nan degrees"),
		(lambda: mesh.polygon(SQUARE, size=0.1, smoothing=-1), r"smoothing is -1"),
		(lambda: mesh.polygon(SQUARE, size=0.1, seed=-1), r"seed is -1"),
		(
			lambda: mesh.polygon(SQUARE, size=1e-5),
			(
				r"size 1e-05 m would give about 2.4e\+10 triangles, more than the limit of 5e\+06; "
				r"use a larger size"
			),
		),
		(lambda: mesh.polygon(SQUARE, size=0.1, limit=10), r"more than the limit of 10"),
		(lambda: mesh.polygon(SQUARE[:2], size=0.1), r"outline: 2 different corners"),
		(lambda: mesh.polygon("square", size=0.1), r"outline: needs a list of corners"),
		(lambda: mesh.polygon([(0, 0), (1, 1), (2, 2)], size=0.1), r"outline: its area is zero"),
		(
			lambda: mesh.polygon([(0, 0), (1, math.nan), (1, 1)], size=0.1),
			r"outline: corner 1 is \(1.0, nan\) m",
		),
		(
			lambda: mesh.polygon([(0, 0), (1, 0), (0, 1), (2, 1)], size=0.1),
			r"outline crosses itself at \(0.666667, 0.333333\) m",
		),
		(
			lambda: mesh.polygon([(0, 0), (1, 0), (1, 1), (0.5, 0), (0, 1)], size=0.1),
			r"outline touches itself at \(0.5, 0\) m",
		),
		(
			lambda: mesh.polygon([(0, 0), (1, 0), (0.5, 0.5), (1, 1), (0, 1), (0.5, 0.5)], size=0.1),
			r"outline touches itself at corner 5, \(0.5, 0.5\) m",
		),
		(
			lambda: mesh.polygon(SQUARE, holes=[mesh.disc(2, 2, 0.1)], size=0.1),
			r"hole 0 lies outside of the outline at \(2",
		),
		(
			lambda: mesh.polygon(SQUARE, holes=[mesh.disc(1, 0.5, 0.1)], size=0.1),
			r"outline and hole 0 cross at|hole 0 touches outline at",
		),
		(
			lambda: mesh.polygon(SQUARE, holes=[mesh.box(0.5, 0, 0.6, 0.2)], size=0.1),
			r"hole 0 touches outline at \(0.5, 0\) m",
		),
		(
			lambda: mesh.polygon(
				SQUARE, holes=[mesh.disc(0.4, 0.5, 0.1), mesh.disc(0.5, 0.5, 0.1, 47)], size=0.1
			),
			r"hole 0 and hole 1 cross",
		),
		(
			lambda: mesh.polygon(
				SQUARE, holes=[mesh.disc(0.5, 0.5, 0.3), mesh.disc(0.5, 0.5, 0.1)], size=0.1
			),
			r"hole 1 lies in hole 0",
		),
		(
			lambda: mesh.polygon(SQUARE, size=0.1, regions={"a": mesh.box(2, 2, 3, 3)}),
			r"region 'a' lies outside of the outline",
		),
		(
			lambda: mesh.polygon(SQUARE, size=0.1, regions={"a": mesh.box(0.5, 0.5, 3, 0.6)}),
			r"outline and region 'a' cross at \(1, 0.[56]\) m",
		),
		(
			lambda: mesh.polygon(
				SQUARE,
				size=0.1,
				regions={"a": mesh.box(0.2, 0.2, 0.6, 0.6), "b": mesh.box(0.5, 0.5, 0.8, 0.8)},
			),
			r"region 'a' and region 'b' cross",
		),
		(
			lambda: mesh.polygon(
				SQUARE,
				size=0.1,
				holes=[mesh.disc(0.5, 0.5, 0.2)],
				regions={"a": mesh.disc(0.5, 0.5, 0.1)},
			),
			r"region 'a' lies in hole 0",
		),
		(
			lambda: mesh.polygon(
				SQUARE,
				size=0.1,
				holes=[mesh.disc(0.5, 0.5, 0.2)],
				regions={"a": mesh.disc(0.5, 0.5, 0.2)},
			),
			r"region 'a'.* no triangle",
		),
		(
			lambda: mesh.polygon(
				ANGLED, size=0.01, regions={"a": [(0.1, 0.04), (0.04, 0.1), (0.04, 0.04)]}
			),
			r"region 'a' lies outside of the outline at \(0.07, 0.07\) m",
		),
		(lambda: mesh.box(1, 0, 0, 1), r"box\(1, 0, 0, 1\) m"),
		(lambda: mesh.disc(0, 0, -1), r"radius is -1 m"),
		(lambda: mesh.disc(0, 0, 1, 2), r"2 corners"),
	]
)
def test_bad_input_is_refused_with_value_and_place(call, message):
	with pytest.raises(ValueError, match=message):
		call()


def test_a_field_finer_than_expected_stops_at_the_limit():
	# The spot slips through the estimate's grid of points; refinement itself must notice.
	spot = lambda x, y: 1e-5 if math.hypot(x - 0.5, y - 0.5) < 0.006 else 0.02
	with pytest.raises(
		ValueError, match="more than 20000 triangles and is not finished; use a larger size, or raise limit="
	):
		mesh.polygon(SQUARE, size=spot, limit=20000, regions={"a": mesh.box(0.5, 0.5, 0.7, 0.7)})


def test_an_error_of_the_size_function_reaches_the_caller():
	with pytest.raises(ZeroDivisionError):
		mesh.polygon(SQUARE, size=lambda x, y: 0.1 if y in (0, 1) or x in (0, 1) else 0.1 / round(x))
