# GPL v2 or later, see LICENSE.
"""Report of a calibration of a model that is known in closed form."""
import json
import math
import re
import struct

import pytest
from ddem.reports.calibration import CalibrationReport, Progress, convergence, material_line, percent, sensitivities
from ddem.studies.calibration import Calibration, Target
from ddem.studies.calibration_quantities import parameters
from ddem.studies.evaluations import Bench, EvaluationError


#: a line of ddem.effects()
EFFECT = {
	"group": "bonded spheres", "particle": "bond", "count": 1234, "group_bytes": 500,
	"cost": "150 ns per bond and step", "effect": "bending", "state": "idle",
	"why": "part of every bond <EI>", "bytes": 8, "measured": "a share of 1e-6"
}


def bonded(values, case):
	"""Elasticities 1 and 0, 0.1 and 0.9; the second seed is 2 % stronger, and bonds above 300 MPa do not break."""
	if values["cohesion"] > 300e6:
		raise EvaluationError("the stress had not fallen")
	return {
		"young": 1.3 * values["young"],
		"ucs": 58e6
		* (values["young"] / 30e9)**0.1
		* (values["cohesion"] / 42e6)**0.9
		* (1 + 0.02 * (case["seed"] - 1)),
	}


def calibrated(ucs=60e6, seeds=(1, ), folder=None, bounds=None, evaluate=bonded):
	lines = []
	tuned = parameters("rigid", ["young", "cohesion"], {"young": 40e9, "cohesion": 100e6}, bounds)
	targets = [Target("young", 40e9, 0.01), Target("ucs", ucs, 0.02)]
	progress = Progress("rigid", tuned, targets, lines.append)
	progress.header()
	path = folder and folder / "evaluations.jsonl"
	with Bench(evaluate, [{"seed": seed} for seed in seeds], {"specimen": "prism"}, path) as bench:
		outcome = Calibration(tuned, targets, bench, tell=progress).run()
	report = CalibrationReport(
		outcome, bench, "rigid", folder or "", "A title", "O.materials.append(…)",
		[("specimen", "prism <small>", "a prism")], "run it --so", {"young": [40e9]},
		{"YADE": "1"}, ["A note."]
	)
	return report, "\n".join(lines).splitlines()


def test_progress_says_what_was_measured_and_how_far_it_is():
	_, lines = calibrated()
	assert re.search(r"young \[GPa\]\s+cohesion \[MPa\]\s+E \[GPa\]\s+UCS \[MPa\]", lines[0])
	assert re.search(r"40 ± 1 %\s+60 ± 2 %", lines[1])
	ucs = 58e6 * (4 / 3)**0.1 * (100 / 42)**0.9
	assert re.fullmatch(
		(
			rf"\s+1\s+start\s+40\s+100\s+52\s+{ucs / 1e6:.4g}\s+E \+30.0 %, UCS "
			rf"{re.escape(percent(ucs / 60e6 - 1))}"
		),
		lines[2],
	)
	assert sum("- met" in line for line in lines) >= 1
	assert any("moves cohesion" in line for line in lines)


def test_failed_point_says_why():
	_, lines = calibrated(ucs=900e6)
	assert any("FAILED: seed 1: the stress had not fallen" in line for line in lines)


def test_table_and_verdict():
	report, _ = calibrated(seeds=(1, 3))
	text = report.table()
	assert text.startswith(f"All targets are met after {report.bench.ran} evaluations in ")
	assert re.search(r"strength in compression\s+UCS\s+MPa\s+60\s+2 %", text)
	assert re.search(r"cohesion\s+C\s+MPa\s+[\d.]+\s+100\s+5 to 2000", text)
	row = next(line for line in text.splitlines() if line.startswith("UCS"))
	assert row.split()[0] == "UCS" and "+0.10" in row and "+0.90" in row
	# two seeds, 1 and 1.04 times the strength: standard deviation sqrt(2) 0.02 of a mean of 1.02
	assert report.target_rows()[1][-1] == f"{100 * math.sqrt(2) * 0.02 / 1.02:.2g} %"


def test_what_is_out_of_reach_is_said_with_the_nearest(tmp_path):
	report, _ = calibrated(folder=tmp_path, bounds={"cohesion": (50e6, 120e6)}, ucs=200e6)
	assert report.verdict().startswith(
		"The targets are NOT met: the upper bound of cohesion, 1.2e+08, keeps it from going further. "
		"The nearest is shown"
	)
	assert report.parameter_rows()[1][-1] == "at its upper bound"
	page = open(report.write(), encoding="utf-8").read()
	assert "NOT met" in page and "the nearest, which does not meet the targets" in page
	with open(tmp_path / "calibration.json") as file:
		summary = json.load(file)
	assert summary["reached"] is False and summary["parameters"]["cohesion"]["bound_hit"] == "upper"
	assert summary["targets"]["ucs"]["miss"] < -0.02


def test_files(tmp_path):
	report, _ = calibrated(folder=tmp_path, seeds=(1, 2))
	page = open(report.write(), encoding="utf-8").read()
	with open(tmp_path / "calibration.json") as file:
		summary = json.load(file)
	assert summary["reached"] is True
	assert summary["parameters"]["young"]["value"] == pytest.approx(40e9 / 1.3, rel=0.01)
	assert summary["elasticities"]["ucs"]["cohesion"] == pytest.approx(0.9, abs=1e-3)
	assert (
		summary["evaluations"]["made"]
		== report.bench.ran
		== len((tmp_path / "evaluations.jsonl").read_text().splitlines())
	)
	assert len(summary["steps"]) == len(report.outcome.steps)
	assert summary["settings"] == {"specimen": "prism"}
	for text in (
		"A title", "run it --so", "A note.", "prism &lt;small&gt;", "O.materials.append(…)",
		"evaluations.jsonl", "moves cohesion"
	):
		assert text in page
	assert page.count("data:image/png;base64,") == 2
	for name in ("convergence", "sensitivities"):
		width, _ = struct.unpack(">II", (tmp_path / f"{name}.png").read_bytes()[16:24])
		assert round(width / 300 * 25.4) == 85  # a column at 300 dpi
	# self-contained: nothing is loaded from elsewhere
	assert not re.search(r"""(src|href)\s*=\s*["'](?!data:)|url\(|@import|<script|<link""", page)


def test_effects_of_the_point_found_are_on_the_page(tmp_path):

	def evaluate(values, case):
		return {**bonded(values, case), "effects": [{**EFFECT, "values": values}]}

	report, _ = calibrated(folder=tmp_path, evaluate=evaluate)
	page = open(report.write(), encoding="utf-8").read()
	with open(tmp_path / "calibration.json") as file:
		assert json.load(file)["effects"] == [{**EFFECT, "values": report.outcome.best.values}]
	for text in (
		"bonded spheres:\n1\u202f234 bonds", "500 bytes of state each; cost 150 ns", "&lt;EI&gt; (8 bytes)",
		"1e-6: changed nothing"
	):
		assert text in page
	again, _ = calibrated(folder=tmp_path, evaluate=bonded)  # from the file
	assert again.bench.ran == 0 and again.effects == report.effects


def test_nothing_measured_is_a_report_too(tmp_path):
	report, _ = calibrated(folder=tmp_path)
	outcome = report.outcome
	outcome.best, outcome.elasticities, outcome.reached, outcome.why = (
		None,
		None,
		False,
		["the first evaluation failed: no specimen"],
	)
	page = open(report.write(), encoding="utf-8").read()
	assert "Nothing could be measured: the first evaluation failed: no specimen." in page
	assert "data:image" not in page
	assert "–" in report.table()


def test_pictures_show_every_point():
	report, _ = calibrated()
	ax = convergence(report.outcome).axes[0]
	drawn = [line for line in ax.get_lines() if len(line.get_xdata()) and line.get_marker() == "o"]
	filled = [line for line in drawn if line.get_fillstyle() == "full"]
	search = [step for step in report.outcome.steps if step.purpose != "sensitivity"]
	assert [list(line.get_xdata()) for line in filled] == [[step.number for step in search]] * 2
	assert list(filled[1].get_ydata()) == [100 * report.outcome.targets[1].miss(step.point) for step in search]
	assert "[%]" in ax.get_ylabel() and ax.get_xlabel() == "point"
	bars = sensitivities(report.outcome, "rigid").axes[0]
	assert sorted(bar.get_height() for bar in bars.patches) == pytest.approx(
		sorted(report.outcome.elasticities.ravel())
	)


def test_line_to_paste_is_the_material():
	line = material_line("rigid", {"young": 30.3909e9, "poisson": 0.25, "cohesion": 42134400.0}, 2400)
	assert (
		line
		== (
			"O.materials.append(BondedMat(label=\"rock\", young=30.3909e9, poisson=0.25, "
			"cohesion=42.1344e6, density=2400 / packing.solid_fraction))"
		)
	)
	made = []
	code = material_line(
		"deformable",
		{"strength": 94883012.3, "fractureEnergy": 80e3, "friction": 0.66, "damageExponent": 1234.5678},
		2400,
	)
	exec(code, {"ConcreteDamageMat": lambda **values: values, "O": type("O", (), {"materials": made})})
	assert made == [{
		"label": "concrete", "strength": pytest.approx(94883012.3, rel=1e-5), "fractureEnergy": 80e3,
		"friction": 0.66, "damageExponent": 1234.57,
		"density": 2400
	}]


@pytest.mark.parametrize(
	"part, text", [(0.0134, "+1.3 %"), (-0.024, "−2.4 %"), (-0.0001, "+0.0 %"), (12.3456, "+1235 %")]
)
def test_per_cent(part, text):
	assert percent(part) == text
