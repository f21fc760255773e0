# GPL v2 or later, see LICENSE.
"""scripts/compare_optimisers.py: what counts as a point, what each search does with a smooth function, what is written;
slow, Optuna's."""
import json
import math
import os
import shutil
import subprocess

import numpy as np
import origins
import pytest
import script_modules

from yade.ddem.studies.evaluations import Bench, EvaluationError, OutOfBudget

OF_SCIPY = ["least_squares", "nelder_mead", "differential_evolution"]
OF_OPTUNA = ["gaussian_process", "tpe", "cma_es"]


@pytest.fixture(scope="module")
def job():
	"""The script as a module, to call its parts."""
	return script_modules.load("compare_optimisers")


@pytest.fixture
def problem(job):
	return draw(job, ("young", "ucs"), 1, 3)[0]


def draw(job, measures, number, seed):
	with Bench(job.Analytic()) as bench:
		return job.problems(bench, measures, number, 0.02, np.random.default_rng(seed))


def summary(folder):
	with open(os.path.join(folder, "comparison.json"), encoding="utf-8") as file:
		return json.load(file)


@pytest.mark.parametrize(
	"arguments, message", [
		(["--methods", "best"], "invalid choice: 'best'"), (["--budget", "0"], "0 must be at least 1"),
		(["--tolerance", "0"], "0 must lie between 1e-06 and 0.5"),
		(["--radii", "0", "1"], "0 must be positive")
	]
)
def test_wrong_options_are_refused(job, monkeypatch, capsys, arguments, message):
	with pytest.raises(SystemExit) as stopped:
		script_modules.run(job, monkeypatch, *arguments)
	assert stopped.value.code == 2 and message in capsys.readouterr().err


def test_targets_are_of_rock_and_the_same_for_the_same_seed(job):
	measures = ("young", "ucs", "tensile")
	drawn = [draw(job, measures, 20, seed) for seed in (1, 1, 2)]
	assert drawn[0] == drawn[1] != drawn[2]
	with Bench(job.Analytic()) as bench:
		low, high = np.array(job.ratios(bench)) + [-0.01, 0.01]  # targets have three digits
	assert high > 1.3 * low
	for one in drawn[0]:
		young, ucs, tensile = (target.value for target in one.targets)
		assert 20e9 <= young <= 60e9 and 30e6 <= ucs <= 150e6 and low < ucs / tensile < high
		assert [p.name for p in one.parameters] == ["young", "cohesion", "bondFrictionAngle"]
		assert one.parameters[0].upper == pytest.approx(25 * one.parameters[0].lower)


def test_the_control_has_the_elasticities_that_it_says(job):
	model, values = job.Analytic(), {"young": 40e9, "cohesion": 60e6, "bondFrictionAngle": math.radians(45)}
	assert model(values, {}) == pytest.approx({"young": 30e9, "ucs": 75e6, "tensile": 26e6})
	further = model({**values, "cohesion": 60e6 * math.e}, {})
	assert further == pytest.approx(
		{"young": 30e9 * math.exp(0.02), "ucs": 75e6 * math.exp(0.93), "tensile": 26e6 * math.e}
	)


def test_a_point_counts_once_and_also_where_another_method_has_measured_it(job, problem):
	with Bench(job.Analytic()) as bench:
		first, second = (job.Tries(bench, problem, 3) for _ in range(2))
		for tries in (first, second):
			for shift in (0.0, 0.7, 0.7):  # the last one again
				tries.residuals(tries.start + shift)
		assert len(first.misses) == len(second.misses) == 2
		assert bench.ran == 2
		first.residuals(first.start - 0.7)
		with pytest.raises(OutOfBudget, match="^3 points were tried$"):
			first.residuals(first.start - 0.8)
		assert len(first.misses) == bench.ran == 3


def test_residuals_are_logarithmic_misses_over_tolerances(job, problem):
	with Bench(job.Analytic()) as bench:
		tries = job.Tries(bench, problem, 9)
		found = tries.residuals([0.7, -0.7])
		values = {p.name: p.start * math.exp(shift) for p, shift in zip(problem.parameters, (0.7, -0.7))}
		measured = job.Analytic()(values, {})
		wanted = [math.log(measured[t.name] / t.value) / 0.02 for t in problem.targets]
		assert found == pytest.approx(wanted, abs=1e-3)  # six digits of parameters
		assert tries.misses == [pytest.approx(max(abs(math.expm1(0.02 * miss)) for miss in wanted), rel=1e-4)]
		assert tries.distance([0.7, -0.7]) == pytest.approx(sum(miss**2 for miss in wanted), rel=1e-4)


def test_a_point_whose_test_fails_counts_and_is_far_away(job, problem):

	def breaks(values, case):
		raise EvaluationError("no peak")

	with Bench(breaks) as bench:
		tries = job.Tries(bench, problem, 9)
		assert tries.residuals(tries.start) == pytest.approx(math.log(10) / 0.02)
		assert tries.misses == [math.inf] and not tries.reached
		for method in ("ours", "nelder_mead"):
			reached, misses = job.search(method, bench, problem, 9, 1)
			assert not reached and misses and set(misses) == {None}


@pytest.mark.parametrize("measures", [("young", "ucs"), ("young", "ucs", "tensile")])
@pytest.mark.parametrize("method, most", [
	# of a smooth function: elasticities take a point a parameter, a step or two lead to the targets
	("ours", 10), ("ours_without_laws", 10), ("least_squares", 13), ("nelder_mead", 60),
])  # yapf: disable
def test_a_smooth_function_is_met(job, method, most, measures):
	for problem in draw(job, measures, 5, 5):
		with Bench(job.Analytic()) as bench:
			reached, misses = job.search(method, bench, problem, 60, 1)
		assert reached and len(misses) <= most
		assert misses[-1] <= 0.02 and misses == sorted(misses, reverse=True)


def test_no_method_tries_more_than_it_may_and_all_stay_within_the_bounds(job, problem):
	for method in ("ours", "ours_without_laws", *OF_SCIPY):
		with Bench(job.Analytic()) as bench:
			narrow = [type(t)(t.name, t.value, 1e-9) for t in problem.targets]
			hard = job.Problem(narrow, problem.parameters)
			tries = job.Tries(bench, hard, 12)
			try:
				job.METHODS[method][1](tries, 1)
			except OutOfBudget:
				pass
		assert 2 < len(tries.misses) <= 12 and not tries.reached, method
		for values in map(dict, tries.seen):
			assert all(p.lower <= values[p.name] <= p.upper for p in problem.parameters), method


def test_summary_counts_a_search_that_fails_as_endless(job):
	targets = {"young": 3e10, "ucs": 5e7}
	made = lambda reached, points: job.Search("prism", "ours", 1, targets, reached, points, [0.1])
	[row] = job.summary([made(True, 4), made(False, 60), made(True, 6)])
	assert (row["median"], row["worst"], row["failed"], row["searches"]) == (6, None, 1, 3)
	[row] = job.summary([made(True, 4), made(True, 6)])
	assert (row["median"], row["worst"], row["failed"]) == (5, 6, 0)
	assert job.summary([made(False, 60)] * 3)[0]["median"] is None


def test_files_and_a_second_start_that_measures_nothing(job, monkeypatch, tmp_path, capsys):
	arguments = ["--targets", 1, "--seeds", 1, "--methods", "ours", *OF_SCIPY, "--out", tmp_path]
	assert script_modules.run(job, monkeypatch, "--models", "analytic", *arguments) == 0
	lines = (tmp_path / "evaluations.jsonl").read_text().splitlines()
	assert script_modules.run(job, monkeypatch, "--models", "analytic", *arguments) == 0
	assert (tmp_path / "evaluations.jsonl").read_text().splitlines() == lines
	found = summary(tmp_path)
	assert len(found["searches"]) == len(found["summary"]) == 2 * 4
	# all begin at the same start
	for targets in (2, 3):
		assert len({one["misses"][0] for one in found["searches"] if len(one["targets"]) == targets}) == 1
	points = sum(one["points"] for one in found["searches"])
	assert len(lines) < points  # the start at least is measured once for all
	assert set(found["versions"]) == {"scipy"} and found["options"]["budget"] == 60
	told = origins.of_all(tmp_path)
	assert {"comparison.json", "analytic.png"} <= {os.path.basename(name) for name in told}
	text = capsys.readouterr().out
	assert "SciPy Nelder–Mead" in text and "not met" in text


def test_the_prism_is_crushed(job, monkeypatch, tmp_path):
	chosen = ["--models", "prism", "--methods", "ours", "--targets", 1, "--seeds", 1, "--radii", 0.001, 0.002]
	assert script_modules.run(job, monkeypatch, *chosen, "--fails", 200, "--budget", 8, "--out", tmp_path) == 0
	searches = summary(tmp_path)["searches"]
	assert [len(one["targets"]) for one in searches] == [2, 3]
	assert all(one["misses"][-1] < 0.3 for one in searches)  # scaling laws alone lead so far
	with open(tmp_path / "evaluations.jsonl", encoding="utf-8") as file:
		made = [json.loads(line) for line in file]
	assert {one["case"]["test"] for one in made} == {"compression", "tension"}
	assert all(one["settings"]["radii"] == [0.001, 0.002] for one in made)


@pytest.mark.slow
def test_optuna(tmp_path):
	"""As a user runs it: Optuna's searches of the control."""
	yade = [shutil.which("yade"), "-n", "-x", script_modules.path("compare_optimisers")]
	options = ["--models", "analytic", "--methods", "ours", *OF_OPTUNA, "--targets", "2", "--out", str(tmp_path)]
	done = subprocess.run([*yade, *options], cwd=tmp_path, capture_output=True, text=True)
	assert done.returncode == 0, done.stderr
	found = summary(tmp_path)
	assert set(found["versions"]) == {"scipy", "optuna"}
	rows = {(row["method"], row["targets"]): row for row in found["summary"]}
	assert rows["gaussian_process", 2]["failed"] == 0
	for one in found["searches"]:
		assert one["points"] <= 60 and one["misses"][-1] < one["misses"][0]
		if one["method"] == "ours":
			assert one["reached"]
