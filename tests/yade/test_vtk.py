# GPL v2 or later, see LICENSE.
"""ParaView files: what VTK reads back is the scene."""
import glob
import os
import shutil
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from deformable_samples import steps
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import VTK_LINE, VTK_TRIANGLE, VTK_VERTEX
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from yade import BondedMat, ConcreteDamageMat, DeformableElastMat, DeformableEngine, ForceResetter, O, PyRunner, ddem
from yade.ddem import bonded, packing, vtk

STATE, DAMAGE = "state (0 holds, 1 tension, 2 shear)", "damage (broken share of its bonds)"


def read(path):
	"""Points, cells as rows of points, kind of cell, point arrays, cell arrays and time of a .vtu file."""
	reader = vtkXMLUnstructuredGridReader()
	reader.SetFileName(str(path))
	reader.Update()
	grid = reader.GetOutput()
	count = grid.GetNumberOfCells()
	cells = (
		vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(count, -1)
		if count
		else np.zeros((0, 0), int)
	)
	kinds = {grid.GetCellType(i) for i in range(count)}
	assert len(kinds) <= 1
	arrays = [
		{data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
		for data in (grid.GetPointData(), grid.GetCellData())
	]
	points = vtk_to_numpy(grid.GetPoints().GetData()) if grid.GetNumberOfPoints() else np.zeros((0, 3))
	return (
		points, cells, kinds.pop() if kinds else None, *arrays,
		vtk_to_numpy(grid.GetFieldData().GetArray("TimeValue"))[0], grid
	)


def collection(path):
	"""(time, path of the file) of the entries of a .pvd file."""
	entries = ET.parse(path).getroot().findall("Collection/DataSet")
	return [(float(e.get("timestep")), os.path.join(os.path.dirname(path), e.get("file"))) for e in entries]


@pytest.fixture
def block():
	"""A small block with a steel core under compression, fast enough to be damaged after 60 steps."""
	O.materials.append(ConcreteDamageMat(label="concrete", fractureEnergy=8e3))
	O.materials.append(DeformableElastMat(label="steel", bulk=151e9, shear=81e9, density=8030))
	mesh = ddem.mesh.rectangle(0.04, 0.08, size=0.01, regions={"steel": ddem.mesh.box(0.01, 0.03, 0.03, 0.05)})
	block = ddem.append(mesh, {"": "concrete", "steel": "steel"}, seed=1, thickness=0.02)
	platens = ddem.platens(block, velocity=20)
	O.engines = [ForceResetter(), *platens.engines, DeformableEngine()]
	O.dt = ddem.time_step(0.8)
	return block


def test_triangles_are_those_of_the_scene(block, tmp_path):
	record = vtk.Recorder(block, str(tmp_path / "new" / "block"))
	record()
	steps(60)
	record()
	assert record.files == [str(tmp_path / "new" / "block.pvd")]
	entries = collection(record.files[0])
	assert [time for time, _ in entries] == [0, O.time]

	points, cells, kind, point, cell, time, grid = read(entries[1][1])
	assert (kind, time) == (VTK_TRIANGLE, O.time)
	np.testing.assert_allclose(points[:, :2], block.positions, rtol=1e-15)
	assert (points[:, 2] == 0).all()
	np.testing.assert_array_equal(cells, block.mesh.triangles)
	np.testing.assert_array_equal(point["displacement [m]"][:, :2], block.displacements)
	np.testing.assert_array_equal(point["velocity [m/s]"][:, :2], block.velocities)
	assert np.abs(point["velocity [m/s]"]).max() >= 20
	np.testing.assert_allclose(cell["damage"], block.damage, rtol=1e-14)
	assert block.damage.max() > 0.01
	np.testing.assert_array_equal(cell["rotation [rad]"], block.rotation)
	assert np.abs(block.rotation).max() > 0
	np.testing.assert_array_equal(cell["region"], block.mesh.regions)
	np.testing.assert_array_equal(cell["id"], block.triangle_ids)

	stress = grid.GetCellData().GetArray("stress [Pa]")
	assert [stress.GetComponentName(i) for i in range(6)] == ["XX", "YY", "ZZ", "XY", "YZ", "XZ"]
	body = O.bodies[int(block.triangle_ids[7])]
	mean = sum(np.array(tensor) for tensor in body.shape.stress) / 3
	assert cell["stress [Pa]"][7] == pytest.approx(
		[mean[0, 0], mean[1, 1], mean[2, 2], mean[0, 1], 0, 0], rel=1e-12
	)
	assert abs(mean[0, 1]) > 1e3
	strain = sum(np.array(tensor) for tensor in body.shape.strain) / 3
	assert cell["strain"][7] == pytest.approx(
		[strain[0, 0], strain[1, 1], strain[2, 2], strain[0, 1], 0, 0], rel=1e-12
	)

	undamaged = read(entries[0][1])
	assert np.abs(undamaged[4]["stress [Pa]"]).max() < 1  # Pa: round-off of 30 GPa
	assert np.abs(undamaged[3]["displacement [m]"]).max() == 0


def test_sub_elements_have_their_own_cells(block, tmp_path):
	steps(60)
	record = vtk.Recorder(block, str(tmp_path / "block"), sub_elements=True)
	record()
	points, cells, kind, point, cell, _, _ = read(tmp_path / "block-0000.vtu")
	count = len(block.triangle_ids)
	assert (kind, len(cells)) == (VTK_TRIANGLE, 3 * count)
	np.testing.assert_array_equal(cell["damage"], block.sub_element_damage.ravel())
	np.testing.assert_array_equal(cell["stress [Pa]"][:, :4], block.stress.reshape(-1, 4))
	# each cell: the core of its triangle, then two of its nodes, counter-clockwise
	for row in (0, 4, 3 * count - 1):
		core = np.array(O.bodies[int(block.triangle_ids[row // 3])].state.pos)
		np.testing.assert_allclose(points[cells[row, 0]], core, atol=1e-12)
		assert cells[row, 1:].tolist() == [block.mesh.triangles[row // 3][(row % 3 + i) % 3] for i in (0, 1)]
		a, b, c = points[cells[row], :2]
		assert np.cross([*(b - a), 0], [*(c - a), 0])[2] > 0
	np.testing.assert_allclose(
		points[:, :2] - point["displacement [m]"][:, :2],
		np.vstack([block.reference_positions, block.mesh.centroids]),
		atol=1e-15,
	)


def test_recorder_in_a_run_replaces_an_older_recording(block, tmp_path):
	older = vtk.Recorder(block, str(tmp_path / "block"))
	older()
	for name in ("block-0007.vtu", "block-12345.vtu"):
		shutil.copy(tmp_path / "block-0000.vtu", tmp_path / name)
	for name in ("block-notes.vtu", "other-0001.vtu"):
		(tmp_path / name).write_text("mine")
	import __main__
	__main__.record = vtk.Recorder(block, str(tmp_path / "block"))
	O.engines = O.engines + [PyRunner(command="record()", iterPeriod=10)]
	O.run(31, True)
	assert sorted(os.listdir(tmp_path)) == [
		"block-0000.vtu", "block-0001.vtu", "block-0002.vtu", "block-notes.vtu", "block.pvd", "other-0001.vtu"
	]
	times = [time for time, _ in collection(tmp_path / "block.pvd")]
	assert times == pytest.approx([10 * O.dt, 20 * O.dt, 30 * O.dt])
	del __main__.record


@pytest.mark.parametrize("foreign", ["row-bonds-0003.vtu", "row-broken.pvd"])
@pytest.mark.parametrize("steps_before", [0, 5])
def test_files_that_no_recorder_has_written_are_refused_and_stay(spheres, tmp_path, foreign, steps_before):
	vtk.Recorder(spheres, str(tmp_path / "row"))()
	content = '<VTKFile type="Collection"><Collection /></VTKFile>'
	(tmp_path / foreign).write_text(content)
	before = sorted(os.listdir(tmp_path))
	steps(steps_before)
	with pytest.raises(FileExistsError, match=foreign):
		vtk.Recorder(spheres, str(tmp_path / "row"))
	assert sorted(os.listdir(tmp_path)) == before and (tmp_path / foreign).read_text() == content


def test_a_recording_goes_on_in_a_scene_that_was_loaded(block, tmp_path):
	"""What lies after the present time is of a run that was given up; other series stay."""
	name = str(tmp_path / "series" / "block")
	record = vtk.Recorder(block, name)
	record()
	for k in range(5):
		O.run(10, True)
		record()
		if k == 2:
			O.save(str(tmp_path / "middle.yade.gz"))
	(tmp_path / "series" / "block-notes.vtu").write_text("mine")
	given_up = collection(name + ".pvd")
	assert len(given_up) == 6
	O.reset()
	O.load(str(tmp_path / "middle.yade.gz"))
	with pytest.warns(UserWarning, match="later files, 2 of them, are removed"):
		record = vtk.Recorder(ddem.Block.from_scene(), name)
	O.run(5, True)
	record()
	found = collection(name + ".pvd")
	assert found[:4] == given_up[:4] and len(found) == 5
	assert found[4][0] == pytest.approx(35 * O.dt) and found[4][1].endswith("block-0004.vtu")
	assert sorted(os.listdir(tmp_path / "series")) == [
		*(f"block-000{k}.vtu" for k in range(5)), "block-notes.vtu", "block.pvd"
	]
	assert read(found[4][1])[5] == O.time


def test_a_recorder_that_was_there_goes_on_when_its_scene_is_loaded(spheres, tmp_path):
	"""The same object, as a PyRunner calls it; an instant is in the series once."""
	record = vtk.Recorder(spheres, str(tmp_path / "row"))
	for k in range(4):
		record()
		O.save(str(tmp_path / f"{k}.yade.gz"))
		steps(3)
	record()
	assert len(collection(record.files[0])) == 5
	O.load(str(tmp_path / "2.yade.gz"))
	with pytest.warns(UserWarning, match="2 of them"):
		record()
	record()
	steps(1)
	record()
	for path in record.files:
		assert [time for time, _ in collection(path)] == pytest.approx([0, 3 * O.dt, 6 * O.dt, 7 * O.dt])
		assert [file[-8:] for _, file in collection(path)] == [f"{k:04d}.vtu" for k in range(4)]
		assert len(glob.glob(path[:-4] + "-*.vtu")) == 4
		assert all(read(file)[5] == time for time, file in collection(path))


def test_a_file_that_was_written_last_and_is_not_listed_is_part_of_the_recording(spheres, tmp_path):
	"""A process may end between a file and the list."""
	record = vtk.Recorder(spheres, str(tmp_path / "row"))
	record()
	steps(3)
	record()
	for path in record.files:
		with open(path) as file:
			lines = [line for line in file if "0001.vtu" not in line]
		with open(path, "w") as file:
			file.writelines(lines)
	steps(3)
	vtk.Recorder(spheres, str(tmp_path / "row"))()
	for path in record.files:
		assert [time for time, _ in collection(path)] == pytest.approx([0, 3 * O.dt, 6 * O.dt])


def test_grid_refuses_arrays_that_do_not_fit():
	with pytest.raises(ValueError, match="'heat' has 2 rows where the grid has 3"):
		vtk.grid(np.zeros((3, 2)), [[0, 1, 2]], VTK_TRIANGLE, {"heat": [1, 2]})


def test_unwritable_folder(block, tmp_path):
	(tmp_path / "file").write_text("")
	with pytest.raises(OSError):
		vtk.Recorder(block, str(tmp_path / "file" / "block"))


@pytest.fixture
def spheres():
	"""Ten spheres in a row; the bond in the middle breaks in tension, the others hold."""
	O.materials.append(BondedMat(label="rock", young=50e9, cohesion=10e6))
	row = packing.Packing([(2e-3 * i, 0, 0) for i in range(10)], np.full(10, 1e-3))
	sample = bonded.append(row, "rock")
	O.engines = bonded.engines()
	O.dt = bonded.time_step(0.05)  # small, so that stress spreads before the bond breaks
	for i in sample.ids[5:]:
		O.bodies[int(i)].state.vel = (1.5, 0, 0)
	for i in sample.ids[:5]:
		O.bodies[int(i)].state.vel = (-1.5, 0, 0)
	O.bodies[int(sample.ids[0])].state.angVel = (0, 0, 300)
	return sample


def test_spheres_bonds_and_broken_bonds(spheres, tmp_path):
	record = vtk.Recorder(spheres, str(tmp_path / "row"))
	record()
	while len(spheres.broken) == 0 and O.iter < 200:
		steps(1)
	record()
	broken = spheres.broken
	assert len(broken) == 1
	assert sorted(os.path.basename(path) for path in record.files) == [
		"row-bonds.pvd",
		"row-broken.pvd",
		"row-spheres.pvd",
	]

	points, cells, kind, point, _, time, _ = read(tmp_path / "row-spheres-0001.vtu")
	assert (kind, len(cells), time) == (VTK_VERTEX, 10, O.time)
	np.testing.assert_array_equal(points, spheres.positions)
	np.testing.assert_array_equal(point["radius [m]"], spheres.radii)
	np.testing.assert_array_equal(point["velocity [m/s]"], spheres.velocities)
	np.testing.assert_array_equal(point["displacement [m]"], spheres.displacements)
	np.testing.assert_array_equal(point[DAMAGE], spheres.damage)
	assert point[DAMAGE].max() == 0.5
	assert point["rotation [rad]"][0].tolist() == list(O.bodies[int(spheres.ids[0])].state.rot())
	assert point["rotation [rad]"][0, 2] > 1e-5

	points, cells, kind, _, bond, _, _ = read(tmp_path / "row-bonds-0001.vtu")
	assert (kind, len(cells)) == (VTK_LINE, 9)
	np.testing.assert_array_equal(points, spheres.positions)
	assert bond[STATE].tolist() == [bonded.HOLDS] * 8 + [bonded.TENSION]
	assert cells[-1].tolist() == [4, 5] and [4, 5] not in cells[:-1].tolist()
	assert bond["radius [m]"] == pytest.approx(1e-3)
	for row, (i, j) in enumerate(cells[:-1]):
		phys = O.interactions[int(spheres.ids[i]), int(spheres.ids[j])].phys
		along = (spheres.positions[j] - spheres.positions[i]) / np.linalg.norm(
			spheres.positions[j] - spheres.positions[i]
		)
		assert bond["axial force [N]"][row] == pytest.approx(-np.dot(phys.normalForce, along), rel=1e-12)
		assert bond["shear force [N]"][row] == pytest.approx(phys.shearForce.norm())
		assert bond["normal stress [Pa]"][row] == phys.normalStress
	# tension is positive: the spheres in the middle are held back by their neighbours
	assert bond["axial force [N]"][3] > 0 and bond["axial force [N]"][4] > 0
	assert np.isnan(bond["axial force [N]"][-1])
	when = bond["time of breaking [s]"]
	assert np.isnan(when[:-1]).all() and when[-1] == broken["time"][0]
	assert bond["normal stress [Pa]"][-1] == broken["normal_stress"][0] > 10e6

	points, cells, kind, point, _, _, _ = read(tmp_path / "row-broken-0001.vtu")
	assert (kind, len(cells)) == (VTK_VERTEX, 1)
	np.testing.assert_array_equal(points, broken["position"])
	assert point["time [s]"].tolist() == broken["time"].tolist()
	assert point["mode (1 tension, 2 shear)"].tolist() == [bonded.TENSION]
	assert np.abs(point["normal"][0]) == pytest.approx([1, 0, 0], abs=1e-3)

	points, cells, *_ = read(tmp_path / "row-broken-0000.vtu")
	assert len(points) == len(cells) == 0
