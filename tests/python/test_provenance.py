# GPL v2 or later, see LICENSE.
"""The record of where a result comes from, and the files that hold it. Whole scripts: tests/yade/test_results.py."""
import csv
import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from ddem import packing, plots, provenance
from ddem.series import Series
from ddem.studies.evaluations import Store


@pytest.fixture(autouse=True)
def run(monkeypatch, tmp_path):
	"""A script with an argument, in a folder of its own; afterwards nothing is noted."""
	(tmp_path / "script.py").write_text("print(1)\n")
	monkeypatch.chdir(tmp_path)
	monkeypatch.setattr(sys, "argv", ["script.py", "--load", "10"])
	provenance.begin()
	yield
	provenance.begin()


def inputs(**options):
	return provenance.record(**options)["inputs_sha256"]


def test_record_has_everything():
	found = provenance.record(seed=3)
	assert found["command"].endswith("script.py --load 10") and found["seed"] == 3
	assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", found["written"])
	assert found["versions"]["numpy"] == np.__version__ and found["versions"]["Python"] == sys.version.split()[0]
	assert re.fullmatch(r"\d+(\.\d+)+", found["plugin"]["version"])
	assert re.fullmatch("[0-9a-f]{12}", found["plugin"]["code"])
	assert found["plugin"]["revision"] is None or re.fullmatch("[0-9a-f]{40}", found["plugin"]["revision"])
	assert [one["file"] for one in found["files"]] == ["script.py"]
	# of "print(1)\n", by sha256sum
	assert found["files"][0]["sha256"] == "cc42155088fca5730758db72b2a5bca33112a941dfaa2d43098ec422ce4ea213"
	assert json.loads(json.dumps(found)) == found


def test_same_inputs_same_hash(monkeypatch, tmp_path):
	first = inputs()
	provenance.begin()
	assert inputs() == first
	monkeypatch.setattr(sys, "argv", ["script.py", "--load", "11"])
	assert inputs() != first


@pytest.mark.parametrize("change", [
	lambda: provenance.begin({"load": 11, "seed": 1}), lambda: provenance.begin({"load": 10, "seed": 2}),
	lambda: provenance.begin({"load": 10}),
	lambda: provenance.note_file("data.csv"), lambda: open("script.py", "a").write("#\n"),
])
def test_any_other_input_another_hash(change):
	with open("data.csv", "w") as file:
		file.write("1\n")
	provenance.begin({"load": 10, "seed": 1})
	first = inputs()
	change()
	assert inputs() != first


def test_where_files_go_and_how_many_threads_work_change_nothing():
	hashes = set()
	for out, threads in (("a", 1), ("b", 2)):
		provenance.begin({"load": 10, "out": out, "threads": threads, "pictures": out == "a"})
		hashes.add(inputs())
	assert len(hashes) == 1


def test_file_that_changes_is_hashed_anew():
	for text in ("1\n", "2\n"):
		with open("data.csv", "w") as file:
			file.write(text)
		provenance.note_file("data.csv")
	with_two = inputs()
	with open("data.csv", "w") as file:
		file.write("333\n")
	assert inputs() != with_two


def test_seeds_are_noted_once_each_and_those_of_the_options_come_first():
	provenance.note_seed(4)
	provenance.note_seed(None)
	assert provenance.record()["seed"] == 4
	provenance.note_seed(np.int64(5))
	provenance.note_seed(4)
	assert provenance.record()["seed"] == [4, 5]
	provenance.begin({"seeds": (1, 2)})
	provenance.note_seed(9)
	assert provenance.record()["seed"] == [1, 2]


def test_options_of_any_kind_are_hashed_the_same_in_any_process():
	text = (
		"import sys; sys.path[:] = {path!r}; from ddem import provenance\n"
		"class Odd: pass\n"
		"provenance.begin({{'a': Odd(), 'b': {{3, 1, 2}}, 'c': max, 'd': None, 'e': (1.5, 'x')}})\n"
		"print(provenance.record()['parameters_sha256'])"
	)
	folder = str(provenance._HERE.parent)
	command = [sys.executable, "-c", text.format(path=[folder, *sys.path])]
	found = {subprocess.run(command, capture_output=True, text=True).stdout for _ in range(2)}
	assert len(found) == 1 and len(found.pop().strip()) == 64


def test_command_names_no_folder_of_this_machine(monkeypatch, tmp_path):
	arguments = ["/secret/place/particles.csv", f"--out={tmp_path}/results", "--bonds=/secret/bonds.csv", "a=b"]
	monkeypatch.setattr(sys, "argv", [str(tmp_path / "script.py"), *arguments])
	assert provenance.command().endswith("script.py particles.csv --out=results --bonds=bonds.csv a=b")


def test_interactive_session_has_no_command(monkeypatch):
	monkeypatch.setattr(sys, "argv", [""])
	assert provenance.command() is None and provenance.record()["files"] == []


def test_missing_file_is_an_error(tmp_path):
	provenance.note_file(tmp_path / "gone.csv")
	with pytest.raises(FileNotFoundError, match="gone.csv"):
		provenance.record()


# --- files


@pytest.fixture
def series():
	made = Series(time="s", stress="Pa")
	for k in range(3):
		made.append(time=k, stress=k * 1e6)
	return made


def test_csv_stays_readable(series):
	series.write("series.csv")
	assert provenance.read("series.csv")["command"].endswith("script.py --load 10")
	assert list(Series.read("series.csv")["stress"]) == [0, 1e6, 2e6]
	assert list(np.genfromtxt("series.csv", delimiter=",", names=True)["time_s"]) == [0, 1, 2]
	assert np.loadtxt("series.csv", delimiter=",", skiprows=1).shape == (3, 2)
	pandas = pytest.importorskip("pandas")
	table = pandas.read_csv("series.csv", comment="#")
	assert list(table.columns) == ["time [s]", "stress [Pa]"] and len(table) == 3


def test_comments_anywhere_in_a_csv_file_are_skipped_and_lines_counted(series):
	series.write("series.csv")
	with open("series.csv") as file:
		text = "# written by hand\n" + file.read()
	with open("series.csv", "w") as file:
		file.write(text)
	assert len(Series.read("series.csv")) == 3
	with open("series.csv", "a") as file:
		file.write("1,2,3\n")
	with pytest.raises(ValueError, match="line 7: 3 fields"):
		Series.read("series.csv")


def test_input_that_was_written_again_with_the_same_numbers_has_the_same_hash():
	sample = packing.Packing(np.array([[0.0, 0, 0], [0, 2, 0]]), np.ones(2), (-1, -1, -1), (1, 3, 1))
	hashes = set()
	for load in "12":
		sys.argv[2] = load  # another run writes it, so that the line that says so differs
		provenance.begin({})
		sample.write("particles.csv")
		assert len(packing.read("particles.csv")) == 2
		hashes.add(inputs())
	assert len(hashes) == 1


@pytest.mark.parametrize("ending", ["png", "pdf", "svg"])
def test_pictures(ending):
	plots.save(plots.figure(), f"picture.{ending}")
	with open(f"picture.{ending}", "rb") as file:
		data = file.read()
	assert b"yade-ddem" in data and b"inputs_sha256" in data
	if ending == "png":
		assert provenance.read("picture.png")["files"]


@pytest.mark.parametrize("data", [{"a": 1}, [{"a": 1}, {"a": 2}]])
def test_json_keeps_its_keys(data):
	provenance.write_json("data.json", data)
	with open("data.json") as file:
		again = json.load(file)
	several = isinstance(data, list)
	for one, before in zip(again if several else [again], data if several else [data], strict=True):
		assert one.pop("provenance")["plugin"] and one == before
	assert provenance.read("data.json")["inputs_sha256"] == inputs()


def test_json_that_cannot_be_written_leaves_no_file(tmp_path):
	with pytest.raises(ValueError):
		provenance.write_json("data.json", {"a": float("nan")}, allow_nan=False)
	assert not (tmp_path / "data.json").exists()


def test_evaluations():
	store = Store("evaluations.jsonl")
	store.add({"format": 1, "key": "k", "error": None, "measured": {"ucs": 1.0}})
	store.close()
	assert provenance.read("evaluations.jsonl")["inputs_sha256"] == inputs()


def test_comment_can_stand_in_xml(monkeypatch):
	monkeypatch.setattr(sys, "argv", ["script.py", "--a", "----", "-->"])
	text = provenance.comment()
	assert "--" not in text
	assert json.loads(text.partition(": ")[2])["command"].endswith("script.py --a ---- '-->'")


OTHERS = [("a.csv", "x\n1\n"), ("a.json", "{}"), ("a.json", "[]"), ("a.html", "<p>"), ("a.txt", "x"), ("a.jsonl", "")]


@pytest.mark.parametrize("name, text", OTHERS)
def test_file_of_somebody_else_says_so(name, text):
	with open(name, "w") as file:
		file.write(text)
	with pytest.raises(ValueError, match=f"{name} does not say where it comes from"):
		provenance.read(name)


# --- the revision, without git


def test_revision_of_a_checkout(tmp_path):
	commit, other = "1" * 40, "2" * 40
	git = tmp_path / "checkout" / ".git"
	(git / "refs" / "heads").mkdir(parents=True)
	assert provenance.revision_of(tmp_path / "nowhere") is None
	(git / "HEAD").write_text("ref: refs/heads/main\n")
	(git / "packed-refs").write_text(f"# pack-refs\n{other} refs/heads/mainline\n{commit} refs/heads/main\n")
	assert provenance.revision_of(tmp_path / "checkout") == commit
	(git / "refs" / "heads" / "main").write_text(other + "\n")
	assert provenance.revision_of(tmp_path / "checkout") == other
	(git / "HEAD").write_text(commit + "\n")
	assert provenance.revision_of(tmp_path / "checkout") == commit


def test_revision_of_a_work_tree(tmp_path):
	common = tmp_path / "repository" / ".git"
	(common / "worktrees" / "tree").mkdir(parents=True)
	(common / "refs" / "heads").mkdir(parents=True)
	(common / "refs" / "heads" / "branch").write_text("3" * 40 + "\n")
	(common / "worktrees" / "tree" / "HEAD").write_text("ref: refs/heads/branch\n")
	(common / "worktrees" / "tree" / "commondir").write_text("../..\n")
	(tmp_path / "tree").mkdir()
	(tmp_path / "tree" / ".git").write_text(f"gitdir: {common / 'worktrees' / 'tree'}\n")
	assert provenance.revision_of(tmp_path / "tree") == "3" * 40


def test_version_of_a_checkout(tmp_path):
	assert provenance.version_of(tmp_path) is None
	text = "cmake_minimum_required(VERSION 3.25)\nproject(yade-ddem VERSION 1.2.3 LANGUAGES CXX)\n"
	(tmp_path / "CMakeLists.txt").write_text(text)
	assert provenance.version_of(tmp_path) == "1.2.3"


def test_rows_skip_comments_only(tmp_path):
	with open("a.csv", "w", newline="") as file:
		writer = csv.writer(file)
		writer.writerows([["a", "b"], ["# no", "1"], [" # yes", "2"]])
	with open("a.csv", newline="") as file:
		assert list(provenance.csv_rows(file)) == [(1, ["a", "b"]), (3, [" # yes", "2"])]


# --- nobody writes around it

WRITES = re.compile(
	r"\.savefig\(|csv\.(?:Dict)?[wW]riter\(|json\.dump\(|np\.save\w*\(|XMLUnstructuredGridWriter\(\)|<AppendedData"
)
#: files that write by themselves: how many times, and why they may
KNOWN = {
	"provenance.py": (1, "the one place for CSV"),
	"plots.py": (1, "with metadata"),
	"vtk.py": (1, "with a text in the field data"),
	"verification/framework.py": (1, "with metadata"),
	"verification/freefem.py": (1, "what FreeFem++ reads, in a temporary folder"),
	"studies/yade_process.py": (1, "what two processes hand each other"),
	"studies/esys/__init__.py": (1, "what ESyS-Particle reads"),
	"studies/esys/compression.py": (1, "what ESyS-Particle hands back, in its own Python"),
}


def test_results_are_written_in_the_shared_places():
	root = Path(__file__).resolve().parents[2]
	found = {}
	for folder in (root / "py" / "ddem", root / "scripts"):
		for path in folder.rglob("*.py"):
			writes = len(WRITES.findall(path.read_text(encoding="utf-8")))
			if writes:
				found[path.relative_to(folder).as_posix()] = writes
	unknown = "a result file says where it comes from: write it through provenance, Series, plots.save or vtk.write"
	assert found == {name: times for name, (times, _) in KNOWN.items()}, unknown
