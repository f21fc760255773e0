# GPL v2 or later, see LICENSE.
"""Pictures of meshes and fields: what is drawn, its colours, sizes and labels."""
import struct

import numpy as np
import pytest
from ddem import mesh, plots
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgba
from mesh_samples import BAR


@pytest.fixture
def block():
	return mesh.rectangle(0.1, 0.2, size=0.01, regions={"steel": BAR})


def shapes(ax):
	return next(c for c in ax.collections if isinstance(c, PolyCollection))


def test_mesh_is_drawn_in_millimetres_with_its_regions(block):
	ax = plots.mesh(block)
	drawn = shapes(ax)
	assert len(drawn.get_paths()) == 800
	assert drawn.get_paths()[0].vertices[:3] == pytest.approx(1e3 * block.nodes[block.triangles[0]])
	steel = (drawn.get_facecolor() == to_rgba(plots.COLOURS[0])).all(axis=1)
	assert np.flatnonzero(steel).tolist() == block.region("steel").tolist()
	assert [text.get_text() for legend in ax.figure.legends for text in legend.get_texts()] == ["steel"]
	assert (ax.get_xlabel(), ax.get_ylabel(), ax.get_aspect()) == ("$x$ [mm]", "$y$ [mm]", 1)


@pytest.mark.parametrize("side, unit", [(30, "m"), (0.5, "mm"), (5e-4, "µm")])
def test_unit_follows_the_extent(side, unit):
	assert plots.mesh(mesh.rectangle(side, side, size=side / 2)).get_xlabel() == f"$x$ [{unit}]"


def test_picture_has_the_width_of_a_column(block, tmp_path):
	plots.field(block, block.areas, "area [m²]", file=tmp_path / "new" / "folder" / "a.png")
	width, height = struct.unpack(">II", (tmp_path / "new" / "folder" / "a.png").read_bytes()[16:24])  # PNG header
	assert width / 300 * 25.4 == pytest.approx(85, abs=0.2)
	assert height / 300 * 25.4 <= 110.2


@pytest.mark.parametrize(
	"count, shape", [(800, lambda m: m.centroids[:, 0]), (2400, lambda m: np.repeat(m.centroids[:, :1], 3, axis=1))]
)
def test_values_of_triangles_and_sub_elements(block, count, shape):
	values = shape(block)
	drawn = shapes(plots.field(block, values, "x [m]"))
	assert len(drawn.get_paths()) == count
	assert drawn.get_array().tolist() == values.ravel().tolist()
	assert drawn.get_clim() == (values.min(), values.max())


def test_sub_element_is_between_centroid_and_an_edge(block):
	values = np.zeros((800, 3))
	drawn = shapes(plots.field(block, values, "damage"))
	a, b, c = block.nodes[block.triangles[7]]
	assert drawn.get_paths()[3 * 7 + 1].vertices[:3] == pytest.approx(1e3 * np.array([(a + b + c) / 3, b, c]))


def test_deformed_shape_and_border_of_the_reference(block):
	move = np.column_stack([0.01 * block.nodes[:, 1], 0 * block.nodes[:, 0]])
	ax = plots.field(block, np.hypot(*move.T), "displacement [m]", displacement=move, scale=5)
	drawn, = [c for c in ax.collections if not isinstance(c, LineCollection)]
	assert max(path.vertices[:, 0].max() for path in drawn.get_paths()) == pytest.approx(100 + 5 * 2)  # mm
	border, = [c for c in ax.collections if isinstance(c, LineCollection)]
	assert len(border.get_segments()) == 60
	assert ax.get_title() == "displacement × 5"
	assert ax.get_xlim()[1] > 110


def test_signed_field_is_white_at_zero(block):
	drawn = shapes(plots.field(block, np.linspace(-1, 3, 800), "velocity [m/s]", signed=True))
	assert drawn.get_clim() == (-3, 3)
	assert min(drawn.cmap(drawn.norm(0.0))[:3]) > 0.95


def test_limits_mark_values_beyond_them(block):
	ax = plots.field(block, np.linspace(-1, 2, 800), "damage", limits=(0, 1))
	assert shapes(ax).get_clim() == (0, 1)
	assert ax.figure.axes[1].get_ylabel() == "damage"
	assert shapes(ax).colorbar.extend == "both"
	assert shapes(plots.field(block, np.linspace(0, 1, 800), "damage", limits=(0, 1))).colorbar.extend == "neither"


def test_wrong_shapes_are_refused(block):
	with pytest.raises(
		ValueError,
		match=(
			r"field 'damage': values of shape \(801,\) fit neither 431 nodes, nor 800 triangles, "
			r"nor \(800, 3\)"
		),
	):
		plots.field(block, np.zeros(801), "damage")
	with pytest.raises(
		ValueError, match=r"field 'damage': displacement has shape \(800, 2\) instead of \(431, 2\)"
	):
		plots.field(block, np.zeros(800), "damage", displacement=np.zeros((800, 2)))


def test_constant_and_missing_values(block):
	plots.field(block, np.full(800, 3.0), "damage")
	values = np.linspace(0, 1, 800)
	values[5] = np.nan
	assert shapes(plots.field(block, values, "damage")).get_clim() == (0, 1)
