# GPL v2 or later, see LICENSE.
"""Every file that a script writes says where it comes from, and the same inputs have the same hash."""
import json
import os
import shutil

import numpy as np
import origins
import pytest
import script_modules
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from yade import ConcreteDamageMat, DeformableEngine, O, ddem
from yade.ddem import provenance

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "data")
SAMPLE = ("esys/sample_coarse_s1_particles.csv", "esys/sample_coarse_s1_bonds.csv")
SMALL = [
	"--size", "0.025", "--radii", "0.005", "0.01", "--depth", "0.04", "--velocity", "8", "--strain", "1e-3",
	"--no-progress",
]
BARE = ["--no-pictures", "--no-vtk"]


@pytest.fixture
def perform(monkeypatch, tmp_path):
	"""Runs a script and returns {file: what it says}."""

	def run(name, *arguments, out="out"):
		O.reset()
		script_modules.run(script_modules.load(name), monkeypatch, *arguments, "--out", tmp_path / out)
		return origins.of_all(tmp_path / out)

	return run


def hashes(found):
	return {one["inputs_sha256"] for one in found.values()}


def test_every_kind_of_file_of_the_main_job(perform, tmp_path):
	found = perform("ucs_compare", *SMALL, "--pdf", "--seed", "7")
	kinds = {path.suffix for path in tmp_path.rglob("*") if path.is_file()}
	assert kinds == {".json", ".csv", ".html", ".png", ".pdf", ".pvd", ".vtu"}
	assert len(hashes(found)) == 1
	for one in found.values():
		assert one["seed"] == 7 and one["machine"]["threads"] == O.numThreads
		assert "ucs_compare.py" in one["command"] and "--seed 7" in one["command"]
		assert [os.path.basename(file["file"]) for file in one["files"]] == ["ucs_compare.py"]
	with open(tmp_path / "out" / "summary.json") as file:
		assert {"models", "options", "versions", "provenance"} <= set(json.load(file))
	page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
	assert f"Inputs SHA-256 {hashes(found).pop()}" in page.partition("<footer>")[2]


def test_same_inputs_same_hash_wherever_it_is_written(perform):
	runs = ((1, "a"), (1, "b"), (2, "c"))
	one, two, other = (perform("ucs_compare", *SMALL, *BARE, "--seed", seed, out=out) for seed, out in runs)
	assert hashes(one) == hashes(two) and len(hashes(one)) == 1
	assert hashes(one) != hashes(other)


def test_changed_file_changes_the_hash_and_a_moved_one_does_not(perform, tmp_path):
	arguments = ["--convention", "esys", "--strain", "1e-5", "--length-unit", "mm", "--no-progress", *BARE]

	def crush(folder, change=""):
		os.makedirs(tmp_path / folder)
		places = [tmp_path / folder / os.path.basename(name) for name in SAMPLE]
		for name, place in zip(SAMPLE, places):
			shutil.copy(os.path.join(DATA, name), place)
		places[0].write_text(places[0].read_text() + change)
		sample = ["--particles", places[0], "--bonds", places[1]]
		return perform("ucs_bonded", *sample, *arguments, out=folder + "-out")

	one, moved, changed = crush("one"), crush("moved"), crush("changed", "\n")
	assert hashes(one) == hashes(moved) and len(hashes(one)) == 1
	assert not hashes(one) & hashes(changed)
	names = [os.path.basename(file["file"]) for file in next(iter(one.values()))["files"]]
	assert names == ["ucs_bonded.py", *map(os.path.basename, SAMPLE)]


def test_verification(monkeypatch, tmp_path):
	arguments = ["--case", "settling", "--json", tmp_path / "records.json", "--report", tmp_path / "page"]
	assert script_modules.run(script_modules.load("verify"), monkeypatch, *arguments) == 0
	found = origins.of_all(tmp_path)
	assert {path.suffix for path in found} == {".json", ".html", ".png"}
	assert len(hashes(found)) == 1
	with open(tmp_path / "records.json", encoding="utf-8") as file:
		assert all(record["case"] == "settling" and record["provenance"] for record in json.load(file))


def test_script_of_a_user_has_to_do_nothing(tmp_path):
	provenance.begin()
	ddem.mesh.rectangle(0.1, 0.1, 0.05).write(tmp_path / "square.msh")
	mesh = ddem.mesh.read(tmp_path / "square.msh")
	O.materials.append(ConcreteDamageMat(label="concrete"))
	block = ddem.append(mesh, "concrete", seed=5)
	O.engines = [DeformableEngine()]
	block.plot("damage", file=tmp_path / "damage.png")
	found = provenance.read(str(tmp_path / "damage.png"))
	assert found["seed"] == 5
	assert [file["file"] for file in found["files"]][-1] == "square.msh"


def test_vtk_files_keep_their_arrays(tmp_path):
	"""The text in the field data stands beside VTK's own TimeValue and is read back with it."""
	data = ddem.vtk.grid(np.eye(3), [[0, 1, 2]], ddem.vtk.VTK_TRIANGLE, {"value": np.arange(3.0)})
	ddem.vtk.write(data, str(tmp_path / "one.vtu"), time=0.5)
	ddem.vtk.write(data, str(tmp_path / "one.vtu"), time=0.75)  # again: not twice in it
	reader = vtkXMLUnstructuredGridReader()
	reader.SetFileName(str(tmp_path / "one.vtu"))
	reader.Update()
	fields = reader.GetOutput().GetFieldData()
	assert fields.GetNumberOfArrays() == 2 and fields.GetArray("TimeValue").GetValue(0) == 0.75
	assert json.loads(ddem.vtk.field_text(str(tmp_path / "one.vtu"), "provenance"))["plugin"]
	assert ddem.vtk.field_text(str(tmp_path / "one.vtu"), "other") is None
