# GPL v2 or later, see LICENSE.
"""The script that calibrates: what it refuses, what it finds, how it goes on, and what it says when it cannot."""
import json
import os
import re
import shutil
import signal
import subprocess
import sys

import origins
import pytest
import script_modules

from yade import ddem
from yade.ddem.studies import virtualtest
from yade.ddem.studies.workers import Here

from waiting import until

SCRIPT = script_modules.path("calibrate")
SMALL = ["--model", "deformable", "--size", "0.025", "--velocity", "2"]
AIM = ["--young", "30e9", "--ucs", "60e6"]


@pytest.fixture(scope="module")
def job():
	"""The script as a module, to call its parts."""
	return script_modules.load("calibrate")


@pytest.fixture
def here(monkeypatch):
	"""Evaluations in this YADE, one after the other; returns the list of what was asked."""
	asked = []

	def submit(self, values, case):
		asked.append(values)
		return Here().submit(
			virtualtest.perform_and_tell, self.setup, {**self.fixed, **values}, case, self.cache
		)

	monkeypatch.setattr(virtualtest.SeparateYade, "submit", submit)
	return asked


def run(job, monkeypatch, folder, *arguments):
	"""Exit code of the script."""
	handlers = {number: signal.getsignal(number) for number in (signal.SIGTERM, signal.SIGHUP)}
	monkeypatch.setattr(sys, "argv", ["scripts/calibrate.py", *arguments, "--jobs", "1", "--out", str(folder)])
	try:
		with pytest.raises(SystemExit) as ended:
			job.main()
	finally:
		for number, handler in handlers.items():
			signal.signal(number, handler)
	return ended.value.code


def summary(folder):
	with open(os.path.join(folder, "calibration.json")) as file:
		return json.load(file)


def test_targets_are_met_and_a_second_start_uses_the_file(job, here, monkeypatch, tmp_path, capsys):
	assert run(job, monkeypatch, tmp_path, *SMALL, *AIM) == 0
	text = capsys.readouterr().out
	assert "All targets are met after" in text and "- met" in text
	assert "O.materials.append(ConcreteDamageMat(label=\"concrete\", young=" in text
	found = summary(tmp_path)
	assert found["reached"] is True
	assert found["targets"]["young"]["measured"] == pytest.approx(30e9, rel=0.02)
	assert found["targets"]["ucs"]["measured"] == pytest.approx(60e6, rel=0.02)
	# what is found does give the targets, in a test of its own
	setup = virtualtest.Setup.standard("deformable", "block", size=0.025, velocity=2.0)
	again = virtualtest.perform(
		setup,
		{name: parameter["value"] for name, parameter in found["parameters"].items()},
		{"test": "compression", "seed": 1},
	)
	assert again["ucs"] == pytest.approx(found["targets"]["ucs"]["measured"], rel=1e-9)
	assert {
		"calibration.html", "calibration.json", "convergence.png", "evaluations.jsonl", "sensitivities.png"
	} <= set(os.listdir(tmp_path))
	assert len({origin["inputs_sha256"] for origin in origins.of_all(tmp_path).values()}) == 1
	# every report says what the steps cost, and where the time goes
	line = re.fullmatch(
		r"(\d+) steps of (\d+) triangles: .+ ns a triangle-step, \S+ s of .*", text.splitlines()[-1]
	)
	measured, made = found["measured"], len(here)
	each = {json.dumps(step["values"]): step["measured"]["steps"] for step in found["steps"]}
	assert int(line[1]) == sum(each.values()) and len(each) == made
	mesh = ddem.mesh.rectangle(0.1, 0.2, 0.025, pattern="unstructured", seed=1)
	assert int(line[2]) == measured["particles"] == len(mesh.triangles)
	assert measured["ns_per_particle_step"] > 0 and measured["bytes_per_particle"] > 0
	page = (tmp_path / "calibration.html").read_text(encoding="utf-8")
	assert "Where the time goes" in page and "<th>DeformableEngine</th>" in page
	assert run(job, monkeypatch, tmp_path, *SMALL, *AIM) == 0
	assert len(here) == made
	text = capsys.readouterr().out
	assert f"after 0 evaluations and {made} from the file" in text and "triangle-step" not in text


def test_target_out_of_reach(job, here, monkeypatch, tmp_path, capsys):
	assert (
		run(
			job, monkeypatch, tmp_path, *SMALL, "--ucs", "160e6", "--bounds", "strength=50e6:120e6",
			"--start", "strength=100e6", "--no-pictures"
		)
		== 1
	)
	text = capsys.readouterr().out
	assert (
		(
			"The targets are NOT met: the upper bound of strength, 1.2e+08, keeps it from going further. "
			"The nearest is shown"
		)
		in text
	)
	found = summary(tmp_path)
	assert found["reached"] is False
	assert found["parameters"]["strength"]["bound_hit"] == "upper"
	assert found["targets"]["ucs"]["miss"] < -0.02


def test_failed_evaluations_are_reported_and_kept(job, monkeypatch, tmp_path, capsys):
	# in another YADE: its words must arrive
	assert run(job, monkeypatch, tmp_path, *SMALL, "--ucs", "60e6", "--strain", "2e-4", "--budget", "2") == 1
	text = capsys.readouterr().out
	assert "FAILED: test compression, seed 1: the compression test ended at a strain of" in text
	assert "Nothing could be measured: the first evaluation failed" in text
	with open(tmp_path / "evaluations.jsonl") as file:
		record = json.loads(file.readline())
	assert "allow a larger strain" in record["error"] and record["settings"]["strain"] == 2e-4


@pytest.mark.parametrize("arguments, message", [
	([], "nothing to aim at: give at least one of --young, --ucs and --tensile"),
	(["--ucs", "-60e6"], "expected at least one argument"),
	(["--ucs", "0"], "--ucs: 0 must be positive"),
	(["--ucs", "60e6", "0.02", "3"], "--ucs takes a value and, if it has one of its own, a tolerance"),
	(["--ucs", "60e6", "5"], "tolerance = 5.0 must be a part of the target"),
	(
		["--ucs", "60e6", "--tune", "kohesion"],
		"'kohesion' cannot be tuned in the rigid model; there are young, poisson, cohesion",
	),
	(["--ucs", "60e6", "--tune", "strength"], "'strength' cannot be tuned in the rigid model"),
	(["--ucs", "60e6", "--set", "cohesion=5e6"], "--set cohesion: it is tuned"),
	(["--ucs", "60e6", "--set", "frictionAngle=0.5"], "frictionAngle"),
	(["--ucs", "60e6", "--set", "poisson=0.6"], "poisson = 0.6"),
	(["--ucs", "60e6", "--start", "young=5e9"], "--start young: it is not tuned; tuned are cohesion"),
	(["--ucs", "60e6", "--bounds", "cohesion=5e6"], "'cohesion=5e6' must be NAME=LOW:HIGH"),
	(["--ucs", "60e6", "--bounds", "cohesion=90e6:20e6"], "lower bound, 9e+07, must be below"),
	(["--ucs", "60e6", "--bounds", "cohesion=1e6:2e6"], "the start, 6e+07, must lie between the bounds"),
	(["--ucs", "60e6", "--model", "deformable", "--specimen", "prism"], "the prism is for spheres"),
	(["--ucs", "60e6", "--model", "deformable", "--tune", "young", "bulk"], "say the same twice"),
	(["--ucs", "60e6", "--radii", "0.002", "0.001"], "the smaller one first"),
	(["--ucs", "60e6", "--jobs", "0"], "--jobs"),
	(["--ucs", "60e6", "--step", "0"], "finite differences need a step"),
	(["--ucs", "60e6", "--stop", "0.95"], "stop = 0.95"),
	(["--ucs", "60e6", "--out", "/proc/nowhere"], "--out: cannot write into /proc/nowhere"),
	(["--ucs", "60e6", "--uncertainty", "1"], "unrecognized arguments"),
])
def test_bad_options_are_refused_before_anything_runs(job, monkeypatch, tmp_path, capsys, arguments, message):
	monkeypatch.setattr(virtualtest.SeparateYade, "submit", lambda *_: pytest.fail("a test was started"))
	monkeypatch.setattr(
		sys, "argv", ["scripts/calibrate.py", "--jobs", "1", "--out", str(tmp_path / "out"), *arguments]
	)
	with pytest.raises(SystemExit) as ended:
		job.main()
	assert ended.value.code == 2
	assert message in capsys.readouterr().err
	assert not os.path.exists(tmp_path / "out" / "evaluations.jsonl")


def test_help_explains_every_option(job, monkeypatch, tmp_path, capsys):
	assert run(job, monkeypatch, tmp_path, "--help") == 0
	text = capsys.readouterr().out
	for group in ("targets", "model", "specimen", "tests", "search", "output"):
		assert f"\n{group}" in text
	assert "None" not in text and "[]" not in text and "SUPPRESS" not in text


def test_bulk_and_shear_take_the_place_of_young(job, monkeypatch, tmp_path):
	monkeypatch.setattr(
		sys,
		"argv",
		["x", "--model", "deformable", "--young", "30e9", "--tune", "bulk", "shear", "--out", str(tmp_path)],
	)
	options, _ = job.read_options()
	setup, targets, tuned, fixed, _ = job.prepare(options)
	assert [p.name for p in tuned] == ["bulk", "shear"]
	assert tuned[0].start / tuned[1].start == pytest.approx(30 / 26)  # Table 1 of Zubelewicz (2018)
	assert not {"young", "poisson", "bulk", "shear"} & set(fixed)
	assert virtualtest.material(
		"deformable", {**fixed, **{p.name: p.start for p in tuned}}, 2400
	).young == pytest.approx(30e9)


def lines(path):
	"""Lines of a file that are whole, while another process writes into it."""
	try:
		with open(path) as file:
			return [json.loads(line) for line in file if line.endswith("\n")]
	except FileNotFoundError:
		return []


def processes(text):
	"""Whether a process has this text in its command line."""
	found = []
	for number in filter(str.isdigit, os.listdir("/proc")):
		try:
			with open(f"/proc/{number}/cmdline") as file:
				found += [number] if text in file.read() else []
		except OSError:
			pass
	return found


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_interrupted_run_ends_its_processes_and_goes_on(tmp_path, number):
	command = [
		shutil.which("yade"), "-n", "-x", SCRIPT, *AIM, *SMALL, "--jobs", "2", "--out", str(tmp_path / "out"),
		"--seeds", "1", "2", "3", "4"  # enough to do when it is interrupted, however late
	]
	environment = {**os.environ, "TMPDIR": str(tmp_path)}  # evaluations are found by it
	process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment)

	def at_work():
		assert process.poll() is None, process.communicate()
		return lines(tmp_path / "out" / "evaluations.jsonl") and processes(f"{tmp_path}/ddem-")

	until(at_work)
	process.send_signal(number)
	output, errors = process.communicate()
	assert process.returncode == 130, errors
	kept = lines(tmp_path / "out" / "evaluations.jsonl")
	assert f"Interrupted after {len(kept)} evaluations; the same command goes on from there." in output
	assert "Traceback" not in errors
	assert all(record["error"] is None for record in kept)
	assert processes(f"{tmp_path}/ddem-") == []
	done = subprocess.run(command, capture_output=True, text=True, env=environment)
	assert done.returncode == 0, done.stderr
	assert f"and {len(kept)} from the file" in done.stdout
