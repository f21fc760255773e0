# GPL v2 or later, see LICENSE.
"""Mesh files: Gmsh's own, round trips, and files that are damaged or of the wrong kind."""
import math
import os
import re

import meshio
import numpy as np
import pytest
from ddem import mesh
from mesh_samples import BAR

DATA = os.path.join(os.path.dirname(__file__), "..", "data", "mesh")
GMSH_FILES = ["plate22.msh", "plate41.msh", "plate41_binary.msh"]


def content(name):
	with open(os.path.join(DATA, name), "rb") as file:
		return file.read()


def saved(folder, data, name="some.msh"):
	path = folder / name
	path.write_bytes(data)
	return path


@pytest.mark.parametrize("name", GMSH_FILES)
def test_gmsh_file(name):
	plate = mesh.read(os.path.join(DATA, name))
	assert plate.region_names == ("", "bar", "plate")
	assert plate.areas[plate.region("bar")].sum() == pytest.approx(0.25)
	# Gmsh puts about 2 pi r / size = 6.3 nodes on the circle, rounded up to an even number:
	# the hole is a regular polygon.
	rim = len(plate.boundary(lambda x, y: np.abs(np.hypot(x - 1.5, y - 0.5) - 0.25) < 1e-9))
	assert 6 <= rim <= 12
	assert plate.areas.sum() == pytest.approx(2 - 0.5 * rim * 0.25**2 * math.sin(2 * math.pi / rim))
	assert len(plate.nodes) - len(plate.edges) + len(plate.triangles) == 0


@pytest.mark.parametrize("ending", ["msh", "vtu", "vtk"])
def test_round_trip(tmp_path, ending):
	block = mesh.rectangle(
		0.1, 0.2, size=0.01, pattern="unstructured",
		regions={"steel bar": BAR, "foot": mesh.box(0, 0, 0.1, 0.03)}
	)
	block.write(tmp_path / f"block.{ending}")
	again = mesh.read(tmp_path / f"block.{ending}")
	assert again.nodes.tolist() == block.nodes.tolist()
	assert again.triangles.tolist() == block.triangles.tolist()
	assert again.regions.tolist() == block.regions.tolist()
	assert again.region_names == block.region_names


def test_gmsh_can_read_what_is_written(tmp_path):
	# The file names its physical surfaces and leaves the default region without one.
	mesh.rectangle(0.1, 0.2, size=0.01, regions={"steel": BAR}).write(tmp_path / "block.msh")
	text = (tmp_path / "block.msh").read_text()
	assert re.search(r"\$PhysicalNames\s+1\s+2 1 \"steel\"\s+\$EndPhysicalNames", text)
	assert len(re.findall(r"^\d+ 2 2 1 2 ", text, re.M)) == 8


def test_nameless_groups_and_unused_points(tmp_path):
	points = [(9, 9, 0), (0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
	tags = {
		"gmsh:physical": [np.array([7]), np.array([0, 7])],
		"gmsh:geometrical": [np.array([1]), np.array([1, 1])],
	}
	meshio.write(
		tmp_path / "a.msh",
		meshio.Mesh(points, [("line", [(1, 2)]), ("triangle", [(1, 2, 3), (1, 3, 4)])], cell_data=tags),
		file_format="gmsh22",
	)
	square = mesh.read(tmp_path / "a.msh")
	assert square.nodes.tolist() == [[0, 0], [1, 0], [1, 1], [0, 1]]
	assert square.region_names == ("", "physical 7")
	assert square.regions.tolist() == [0, 1]


# ---- damaged files ----


@pytest.mark.parametrize("name", GMSH_FILES)
@pytest.mark.parametrize("part", np.linspace(0.02, 0.98, 25).round(2))
def test_truncated_gmsh_file(tmp_path, name, part):
	data = content(name)[:int(part * len(content(name)))]
	with pytest.raises(ValueError, match="cut.msh.*(truncated|damaged|no triangles|line [0-9]+)"):
		mesh.read(saved(tmp_path, data, "cut.msh"))


def test_truncated_file_names_section_and_line(tmp_path):
	lines = content("plate22.msh").splitlines(keepends=True)
	opened = lines.index(b"$Nodes\n") + 1
	with pytest.raises(
		ValueError,
		match=(
			rf"line {opened + 21}: the file ends within \$Nodes, which began in line {opened}; "
			rf"it is truncated"
		),
	):
		mesh.read(saved(tmp_path, b"".join(lines[:opened + 20])))


def test_missing_line_is_noticed(tmp_path):
	lines = content("plate22.msh").splitlines(keepends=True)
	opened = lines.index(b"$Elements\n") + 1
	del lines[opened + 10]
	with pytest.raises(
		ValueError, match=rf"line {opened + 1}: \$Elements announces [0-9]+ lines, but [0-9]+ follow"
	):
		mesh.read(saved(tmp_path, b"".join(lines)))


@pytest.mark.parametrize("name", ["plate22.msh", "plate41.msh"])
@pytest.mark.parametrize("section", [b"$Nodes\n", b"$Elements\n"])
def test_word_among_numbers_names_the_line(tmp_path, name, section):
	lines = content(name).splitlines(keepends=True)
	bad = lines.index(section) + 7
	lines[bad] = lines[bad].replace(b" ", b" 1.5x ", 1) if b" " in lines[bad] else b"1.5x\n"
	with pytest.raises(ValueError, match=rf"line {bad + 1}: 'x' in \{section.decode().strip()} is not a number"):
		mesh.read(saved(tmp_path, b"".join(lines)))


def test_truncated_vtu_names_the_line(tmp_path):
	mesh.rectangle(1, 1, size=0.2).write(tmp_path / "a.vtu")
	data = (tmp_path / "a.vtu").read_bytes()
	with pytest.raises(ValueError, match="cut.vtu.*truncated, damaged.*line [0-9]+"):
		mesh.read(saved(tmp_path, data[:len(data) // 2], "cut.vtu"))


def test_unknown_kind_is_not_written(tmp_path):
	with pytest.raises(ValueError, match="cannot write mesh file '.*a.xyzzy'"):
		mesh.rectangle(1, 1, size=0.5).write(tmp_path / "a.xyzzy")


def test_missing_file_and_unknown_kind(tmp_path):
	with pytest.raises(ValueError, match="nowhere.msh' does not exist"):
		mesh.read(tmp_path / "nowhere.msh")
	with pytest.raises(ValueError, match="notes.txt'; .*Could not deduce file format"):
		mesh.read(saved(tmp_path, b"nodes and triangles", "notes.txt"))
	with pytest.raises(ValueError, match="empty.msh'; it is truncated"):
		mesh.read(saved(tmp_path, b"", "empty.msh"))


# ---- the wrong kind of mesh ----

FLAT = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]


@pytest.mark.parametrize(
	"points, cells, message", [
		(FLAT, [("quad", [(0, 1, 2, 3)])], r"cells of type quad; only plane triangles can be used; split them"),
		(
			[*FLAT, (0.5, 0, 0), (1, 0.5, 0), (0.5, 0.5, 0)],
			[("triangle6", [(0, 1, 2, 4, 5, 6)])],
			r"cells of type triangle6; .*first order",
		),
		(FLAT, [("line", [(0, 1)])], r"has no triangles"),
		(
			[(0, 0, 0), (1, 0, 0), (1, 1, 0.1)],
			[("triangle", [(0, 1, 2)])],
			r"not in the x-y plane: z goes from 0 to 0.1 m; only plane",
		),
		(
			[(0, 0, 0), (1, 0, 0), (1, 0, 1)],
			[("triangle", [(0, 1, 2)])],
			r"z goes from 0 to 1 m; the mesh lies in another plane",
		),
		(FLAT, [("triangle", [(0, 2, 1)])], r"triangle 0 with corners .* is clockwise"),
		(FLAT, [("triangle", [(0, 1, 2), (0, 1, 3)])], r"triangle 0 .* overlaps triangle 1"),
	]
)
def test_unusable_meshes_are_refused(tmp_path, points, cells, message):
	meshio.write(tmp_path / "a.vtu", meshio.Mesh(points, [(kind, np.array(nodes)) for kind, nodes in cells]))
	with pytest.raises(ValueError, match="a.vtu.*" + message):
		mesh.read(tmp_path / "a.vtu")


def test_clockwise_file_can_be_oriented(tmp_path):
	meshio.write(
		tmp_path / "a.vtu",
		meshio.Mesh([(x, y, 5) for x, y, _ in FLAT], [("triangle", np.array([(0, 2, 1), (0, 2, 3)]))]),
	)
	assert mesh.read(tmp_path / "a.vtu", orient=True).areas == pytest.approx([0.5, 0.5])
