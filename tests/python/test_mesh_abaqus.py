# GPL v2 or later, see LICENSE.
"""Input files of Abaqus and CalculiX, groups of other formats, and units of length."""
import meshio
import numpy as np
import pytest
from ddem import mesh
from mesh_samples import BAR

NODES = (
	"*HEADING\nfour triangles in two squares\n"
	"*NODE, NSET=all\n1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n5, 2, 0\n6, 2., 1.D0, 0.\n"
)
A_AND_B = NODES + (
	"*ELEMENT, type={0}, ELSET=Aggregate\n11, 1, 2, 3\n12, 1, 3, 4\n"
	"*ELEMENT, type={0}, ELSET=Mortar\n21, 2, 5, 3\n22, 5, 6, 3\n"
)
PLAIN = NODES + "*ELEMENT, TYPE=CPE3\n11, 1, 2, 3\n12, 1, 3, 4\n21, 2, 5, 3\n22, 5, 6, 3\n"


def read(folder, text, name="some.inp", **options):
	(folder / name).write_text(text)
	return mesh.read(folder / name, **options)


def regions(found):
	return {name: np.flatnonzero(found.regions == i).tolist() for i, name in enumerate(found.region_names) if name}


@pytest.mark.parametrize("kind", ["CPE3", "cpe3", "CPE3H", "CPS3", "S3", "S3R", "STRI3", "M3D3", "R3D3", "CPEG3"])
def test_triangles_of_every_kind_with_their_sets(tmp_path, kind):
	found = read(tmp_path, A_AND_B.format(kind))
	assert regions(found) == {"Aggregate": [0, 1], "Mortar": [2, 3]}
	assert found.areas.sum() == pytest.approx(2) and len(found.nodes) == 6


# meshio 5.3.5 gives wrong sets, or none, in each of these
SETS = {
	"bars before them": (
		NODES + "*ELEMENT, TYPE=T2D2\n1, 1, 2\n" + A_AND_B.format("CPE3")[len(NODES):],
		{"Aggregate": [0, 1], "Mortar": [2, 3]}
	),
	"some without a set": (
		NODES + "*ELEMENT, TYPE=CPE3\n11, 1, 2, 3\n*ELEMENT, TYPE=CPE3, ELSET=B\n12, 1, 3, 4\n", {"B": [1]}
	),
	"one set in two pieces": (
		NODES + "*ELEMENT, TYPE=CPE3, ELSET=A\n11, 1, 2, 3\n*ELEMENT, TYPE=CPE3, ELSET=B\n12, 1, 3, 4\n"
		"*ELEMENT, TYPE=CPE3, ELSET=a\n21, 2, 5, 3\n",
		{"A": [0, 2], "B": [1]}
	),
	"listed": (PLAIN + "*ELSET, ELSET=A\n11, 12,\n*Elset, elset=B\n21,\n22\n", {"A": [0, 1], "B": [2, 3]}),
	"listed in two pieces": (
		PLAIN + "*ELSET, ELSET=A\n11\n*ELSET, ELSET=B\n21\n*ELSET, ELSET=A\n12\n", {"A": [0, 1], "B": [2]}
	),
	"generated": (
		PLAIN + "*ELSET, ELSET=A, GENERATE\n11, 12, 1\n*ELSET, ELSET=B, GENERATE\n21, 21\n22, 22\n",
		{"A": [0, 1], "B": [2, 3]}
	),
	"sets of sets": (
		PLAIN + "*ELSET, ELSET=a1\n11\n*ELSET, ELSET=B\n21, 22\n*ELSET, ELSET=all\nA1, b, 12\n",
		{"a1": [0], "B": [2, 3]}
	),
	"before other elements": (
		NODES + "*ELEMENT, TYPE=CPE3\n11, 1, 2, 3\n*ELSET, ELSET=A\n11\n*ELEMENT, TYPE=CPE3\n12, 1, 3, 4\n",
		{"A": [0]}
	),
	"name over two lines": (NODES + "*ELEMENT, TYPE=CPE3,\n ELSET=\"A b\"\n11, 1, 2,\n3\n", {"A b": [0]}),
	"sections choose": (
		A_AND_B.format("CPE3") + "*ELSET, ELSET=edge\n12, 21\n*SOLID SECTION, ELSET=AGGREGATE, MATERIAL=a\n"
		"*SOLID SECTION, ELSET=Mortar, MATERIAL=m\n,\n",
		{"Aggregate": [0, 1], "Mortar": [2, 3]}
	),
	"internal sets": (
		A_AND_B.format("CPE3") + "*ELSET, ELSET=_Surf_S1, INTERNAL\n12, 21\n",
		{"Aggregate": [0, 1], "Mortar": [2, 3]}
	),
	"a part that is not moved": (
		"*PART, NAME=p\n" + A_AND_B.format("CPE3") +
		"*END PART\n*ASSEMBLY, NAME=a\n*INSTANCE, NAME=p-1, PART=p\n*END INSTANCE\n",
		{"Aggregate": [0, 1], "Mortar": [2, 3]}
	),
	"no sets": (PLAIN, {}),
}


@pytest.mark.parametrize("case", SETS)
def test_element_sets_become_regions(tmp_path, case):
	text, expected = SETS[case]
	assert regions(read(tmp_path, "** made by hand\n" + text)) == expected


def test_included_files(tmp_path):
	(tmp_path / "nodes.txt").write_text(NODES)
	assert regions(
		read(tmp_path, "*INCLUDE, INPUT=nodes.txt\n" + A_AND_B.format("CPE3")[len(NODES):])
	) == {"Aggregate": [0, 1], "Mortar": [2, 3]}


OVERLAP = A_AND_B.format("CPE3") + "*ELSET, ELSET=edge\n12, 21\n"


def test_sets_that_overlap_are_refused_until_one_says_which(tmp_path):
	with pytest.raises(
		ValueError,
		match=r"triangle 1 \(counted from 0\) belongs to the sets 'Aggregate', 'edge'.*regions=\[…\]\); "
		r"the file has "
		r"'Aggregate', 'Mortar', 'edge'"
	):
		read(tmp_path, OVERLAP)
	assert regions(read(tmp_path, OVERLAP, regions=["edge"])) == {"edge": [1, 2]}
	assert regions(
		read(tmp_path, OVERLAP, regions=["Mortar", "Aggregate"])
	) == {"Mortar": [2, 3], "Aggregate": [0, 1]}
	assert regions(read(tmp_path, OVERLAP, regions=[])) == {}
	with pytest.raises(ValueError, match="regions = .'Mortr'.*'Aggregate', 'Mortar', 'edge'"):
		read(tmp_path, OVERLAP, regions=["Mortr"])


def test_regions_are_chosen_in_gmsh_files_too(tmp_path):
	mesh.rectangle(
		0.1, 0.2, size=0.01, regions={"steel": BAR, "foot": mesh.box(0, 0, 0.1, 0.03)}
	).write(tmp_path / "a.msh")
	assert mesh.read(tmp_path / "a.msh", regions=["foot"]).region_names == ("", "foot")
	with pytest.raises(ValueError, match="give a list of names.*'steel', 'foot'"):
		mesh.read(tmp_path / "a.msh", regions="foot")


LAST = 1 + PLAIN.count("\n")
BAD = {
	"second order": (
		NODES + "*ELEMENT, TYPE=CPE6\n1, 1, 2, 3, 4, 5, 6\n", "line 10: elements of type CPE6; .*first order"
	),
	"quads": (
		NODES + "*ELEMENT, TYPE=CPE4R\n1, 1, 2, 3, 4\n",
		"line 10: elements of type CPE4R; only plane triangles.*CPE3, CPS3"
	),
	"axisymmetric": (NODES + "*ELEMENT, TYPE=CAX3\n1, 1, 2, 3\n", "elements of type CAX3; only plane"),
	"no type": (NODES + "*ELEMENT, ELSET=A\n1, 1, 2, 3\n", r"elements of type \(none\)"),
	"bars only": (NODES + "*ELEMENT, TYPE=T2D2\n1, 1, 2\n", "has no triangles"),
	"unknown node": (
		PLAIN + "*ELEMENT, TYPE=CPE3\n31, 1, 2, 9\n",
		f"line {LAST + 1}: element 31 has node 9, which is not in the file"
	),
	"unknown element": (PLAIN + "*ELSET, ELSET=A\n77\n", f"line {LAST + 1}: set A has element 77"),
	"unknown set": (PLAIN + "*ELSET, ELSET=A\nB\n", f"line {LAST + 1}: set A has 'B', which is neither"),
	"unknown section": (
		PLAIN + "*SOLID SECTION, ELSET=A, MATERIAL=m\n",
		f"line {LAST}: the section's element set A is not in the file"
	),
	"word": (PLAIN + "*ELEMENT, TYPE=CPE3\n31, 1, 2, x3\n", f"line {LAST + 1}: 'x3' is not a whole number"),
	"word in a node": ("*NODE\n1, 0, a\n", "line 2: 'a' is not a number"),
	"node of one coordinate": ("*NODE\n1, 0\n", "line 2: node 1 has 1 coordinates"),
	"node twice": (NODES + "*NODE\n3, 1, 1\n", "line 11: node 3 is there twice"),
	"element twice": (PLAIN + "*ELEMENT, TYPE=CPE3\n11, 1, 2, 3\n", f"line {LAST + 1}: element 11 is there twice"),
	"cut off": (PLAIN + "*ELEMENT, TYPE=CPE3\n31, 1, 2\n", f"line {LAST}: the elements have 3 numbers"),
	"two parts": ("*PART, NAME=a\n*END PART\n*PART, NAME=b\n", "line 3: a second .PART is not read"),
	"moved": ("*INSTANCE, NAME=a, PART=b\n1., 0., 0.\n*END INSTANCE\n", "line 1: an .INSTANCE that is moved"),
	"generated nodes": (NODES + "*NGEN\n1, 2, 1\n", "line 10: .NGEN is not read"),
	"generated set": (
		PLAIN + "*ELSET, ELSET=A, GENERATE\n11\n",
		f"line {LAST + 1}: a generated set needs first, last and step"
	),
	"set without a name": (PLAIN + "*ELSET\n11\n", f"line {LAST}: .ELSET has no name"),
	"missing include": ("*INCLUDE, INPUT=gone.inp\n", "line 1: the included file '.*gone.inp' does not exist"),
	"endless include": ("*INCLUDE, INPUT=some.inp\n", "includes itself"),
	"empty": ("", "has no triangles"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_files_are_refused_with_the_line(tmp_path, case):
	text, message = BAD[case]
	with pytest.raises(ValueError, match=f"some.inp'.*{message}"):
		read(tmp_path, text)


# ---- other formats ----


@pytest.mark.parametrize(
	"ending, key, kind",
	[("mesh", "medit:ref", None), ("bdf", "nastran:ref", None), ("avs", "avsucd:material", "avsucd")]
)
@pytest.mark.parametrize("numbers", [(3, 7), (5, 5)])
def test_numbers_of_materials_become_regions_where_there_are_several(tmp_path, ending, key, kind, numbers):
	box = mesh.rectangle(0.1, 0.2, size=0.02, regions={"half": mesh.box(0, 0, 0.1, 0.1)})
	points = np.column_stack([box.nodes, np.zeros(len(box.nodes))])
	meshio.write(
		tmp_path / f"a.{ending}",
		meshio.Mesh(
			points, [("triangle", box.triangles)], cell_data={key: [np.where(box.regions == 1, *numbers)]}
		),
		file_format=kind
	)
	found = mesh.read(tmp_path / f"a.{ending}")
	assert found.region_names == ("", "material 3", "material 7") if numbers == (3, 7) else ("",)
	if numbers == (3, 7):
		assert (found.regions == np.where(box.regions == 1, 1, 2)).all()


def test_physical_surfaces_of_the_same_name_are_one_region(tmp_path):
	points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0)]
	data = {"gmsh:physical": [np.array([1, 2, 3])], "gmsh:geometrical": [np.array([1, 2, 3])]}
	names = {"rock": np.array([1, 2])}
	meshio.write(
		tmp_path / "a.msh",
		meshio.Mesh(
			points, [("triangle", [(0, 1, 2), (0, 2, 3), (1, 4, 2)])], cell_data=data, field_data=names
		),
		file_format="gmsh22", binary=False
	)
	text = (tmp_path / "a.msh").read_text().replace("$PhysicalNames\n1\n", "$PhysicalNames\n2\n2 2 \"rock\"\n")
	assert regions(read(tmp_path, text, "b.msh"))["physical 3"] == [2]


# ---- units ----


@pytest.mark.parametrize("unit, factor", [("m", 1), ("cm", 1e-2), ("mm", 1e-3), ("um", 1e-6)])
@pytest.mark.parametrize("ending", ["msh", "vtu", "inp"])
def test_lengths_of_a_file_are_taken_to_metres(tmp_path, ending, unit, factor):
	path = tmp_path / f"a.{ending}"
	if ending == "inp":
		path.write_text(A_AND_B.format("CPE3"))
	else:
		mesh.rectangle(2, 1, size=0.25, regions={"Mortar": mesh.box(0, 0, 1, 1)}).write(path)
	found, plain = mesh.read(path, length_unit=unit), mesh.read(path)
	assert found.nodes == pytest.approx(factor * plain.nodes, rel=1e-15)
	assert found.nodes.max(axis=0) == pytest.approx((2 * factor, factor))
	assert found.region_names == plain.region_names


def test_unknown_unit(tmp_path):
	with pytest.raises(ValueError, match="length_unit = 'inch' is unknown; use one of m, cm, mm, um"):
		read(tmp_path, PLAIN, length_unit="inch")
