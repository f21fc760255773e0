# GPL v2 or later, see LICENSE.
"""Sides of meshes: straight, uneven, with gaps, or none at all."""
import numpy as np
import pytest
from ddem import mesh

def turned(shape, degrees):
	angle = np.radians(degrees)
	return mesh.Mesh(
		shape.nodes @ np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]),
		shape.triangles
	)


def on(shape, side):
	"""Nodes exactly on a side of the bounding box."""
	axis, value = {"left": (0, min), "right": (0, max), "bottom": (1, min), "top": (1, max)}[side]
	return np.flatnonzero(shape.nodes[:, axis] == value(shape.nodes[:, axis]))


@pytest.mark.parametrize("side", ["top", "bottom", "left", "right"])
@pytest.mark.parametrize(
	"options",
	[{"size": 0.01}, {"size": 0.007, "pattern": "unstructured"}, {"nx": 1, "ny": 1}, {"nx": 40, "ny": 3}], ids=str
)
def test_sides_of_boxes(options, side):
	box = mesh.rectangle(0.1, 0.2, **options)
	assert box.boundary(side).tolist() == on(box, side).tolist()


@pytest.mark.parametrize("side", ["top", "bottom", "left", "right"])
@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("amplitude", [1e-12, 1e-6, 0.01, 0.1])
def test_sides_of_uneven_boxes_are_those_of_the_even_ones(side, seed, amplitude):
	box = mesh.rectangle(0.1, 0.2, size=0.01, pattern="unstructured")
	nodes, border = box.nodes.copy(), box.boundary()
	nodes[border] += amplitude * box.edge_lengths.min() * np.random.default_rng(seed).uniform(
		-1, 1, (len(border), 2)
	)
	assert mesh.Mesh(nodes, box.triangles).validate().boundary(side).tolist() == on(box, side).tolist()


@pytest.mark.parametrize("side", ["top", "right"])
@pytest.mark.parametrize(
	"angle, whole",
	[(0.001, True), (0.1, True), (2, False), (5, False), (20, False), (45, False), (-0.1, True), (-5, False)]
)
def test_a_box_that_is_turned_a_little_keeps_its_sides(side, angle, whole):
	"""It slants by 0.17 of an edge at 0.1 degrees and over 100 of them."""
	box = mesh.rectangle(1, 1, size=0.01 if abs(angle) < 1 else 0.1, pattern="alternating")
	if whole:
		assert turned(box, angle).boundary(side).tolist() == on(box, side).tolist()
	else:
		with pytest.raises(
			ValueError,
			match=f"no straight {side} side.*turning by 0 degrees|no straight {side} side.*no edge joins"
		):
			turned(box, angle).boundary(side)


@pytest.mark.parametrize("phase", [0, 0.5])
@pytest.mark.parametrize("corners", [14, 16, 24, 32, 72, 300])
@pytest.mark.parametrize("size", [0.2, 0.05])
def test_a_disc_has_no_sides_however_it_is_turned_and_meshed(corners, size, phase):
	disc = turned(mesh.polygon(mesh.disc(0, 0, 1, corners), size=size), 360 / corners * phase)
	for side in ("top", "left"):
		with pytest.raises(
			ValueError,
			match=rf"boundary\('{side}'\): the mesh has no straight {side} side.*Name the nodes by"
		) as error:
			disc.boundary(side)
		example = str(error.value).split("example boundary(")[1].rstrip(")")
		assert len(disc.boundary(eval(example))) >= 2  # the way out that it names is one


def test_polygons_of_few_corners_have_sides():
	octagon = turned(mesh.polygon(mesh.disc(0, 0, 1, 8), size=0.2), 22.5)
	for side in ("top", "bottom", "left", "right"):
		found = octagon.nodes[octagon.boundary(side)]
		assert len(octagon.border_between(octagon.boundary(side))) == len(found) - 1
		assert np.linalg.norm(np.ptp(found, axis=0)) == pytest.approx(2 * np.sin(np.pi / 8), rel=1e-9)


@pytest.mark.parametrize("angle, whole", [(45, True), (40, True), (30, False)])
def test_a_chamfer_of_less_than_35_degrees_is_no_corner(angle, whole):
	drop = 0.2 * np.tan(np.radians(angle))
	shape = mesh.polygon([(0, 0), (1, 0), (1, 1 - drop), (0.8, 1), (0, 1)], size=0.1)
	if whole:
		assert shape.boundary("top").tolist() == on(shape, "top").tolist()
	else:
		with pytest.raises(ValueError, match=r"at \(0.8, 1\) m the border goes on, turning by 30 degrees only"):
			shape.boundary("top")


def test_a_side_may_have_gaps_and_a_mesh_holes():
	notched = mesh.polygon(
		[(0, 0), (1, 0), (1, 1), (0.6, 1), (0.5, 0.5), (0.4, 1), (0, 1)], holes=[mesh.disc(0.2, 0.8, 0.1, 24)],
		size=0.1
	)
	top = notched.boundary("top")
	assert top.tolist() == on(notched, "top").tolist()
	between = notched.border_between(top)
	lengths = np.linalg.norm(np.diff(notched.nodes[between], axis=1)[:, 0], axis=1)
	assert lengths.sum() == pytest.approx(0.8)


def test_a_function_that_finds_nothing_says_where_the_border_is():
	box = mesh.rectangle(0.1, 0.2, size=0.01)
	with pytest.raises(
		ValueError,
		match="true at none of the 60 nodes.*x from 0 to 0.1 m and y from 0 to 0.2 m; compare with a tolerance"
	):
		box.boundary(lambda x, y: y == 0.2001)
	assert len(box.boundary(lambda x, y: (y == 0) & (x == 0))) == 1  # one named node is one


def test_an_apex_is_no_side():
	roof = mesh.polygon([(0, 0), (1, 0), (0.5, 0.6)], size=0.1)
	with pytest.raises(
		ValueError,
		match=r"y = 0.6 m, lies 1 node of the border, x from 0.5 to 0.5 m, and no edge joins the one at "
		r"\(0.5, 0.6\) m"
	):
		roof.boundary("top")


# ---- scale ----


def test_a_scaled_mesh():
	box = mesh.rectangle(100, 200, size=10, regions={"steel": mesh.box(40, 90, 60, 110)})
	small = box.scaled(1e-3)
	assert small.nodes == pytest.approx(box.nodes * 1e-3, rel=1e-15)
	assert small.region_names == box.region_names and (small.regions == box.regions).all() and (
		small.triangles == box.triangles
	).all()
	assert small.areas.sum() == pytest.approx(0.02)
	for factor in (0, -1, np.nan, np.inf, "1e-3", None):
		with pytest.raises(ValueError, match="factor = .* positive, finite"):
			box.scaled(factor)
