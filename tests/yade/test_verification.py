# GPL v2 or later, see LICENSE.
"""Every verification case holds, and the framework tells when one does not."""
import json
import os
import re
import runpy

import numpy as np
import pytest

from yade import O
from yade.ddem import verification
from yade.ddem.materialpoint import concrete
from yade.ddem.verification import concrete_rates, concrete_theory, framework, page

SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, os.pardir, "scripts", "verify.py")
KEYS = ["case", "quantity", "value", "reference", "error", "tolerance", "passed", "source", "wall_s",
	"ns_per_particle_step", "bytes_per_particle", "provenance"
]


@pytest.mark.parametrize(
	"case",
	[
		pytest.param(case, id=case.name, marks=[pytest.mark.slow] if case.slow or case.needs else [])
		for case in verification.all_cases()
	]
)
def test_case(case):
	result = verification.run(case, pictures=True)
	assert not result.error, result.error
	assert result.passed, [record.plain() for record in result.records if not record.passed]
	assert result.pictures


# --- the framework


def made(function, group="statics", seconds=1):
	"""A case that is not in the package's list."""
	return framework.Case(function.__name__, group, seconds, function)


def right(check, shift=0.0):
	"""A title

	Some text
	over two lines.

		σ = E ε

	Reference: a book.
	"""
	check("length [m]", 2.002 + shift, 2.0, 2e-3, "ruler")
	check("stress [Pa]", -0.5, 0, 1e-3, "free sides", scale=1e3)


def wrong(check):
	"""It fails"""
	check("length [m]", 2.1, 2.0, 1e-2, "ruler")
	check("number", float("nan"), 2.0, 1e-2, "ruler")


def broken(check):
	"""It raises"""
	check("length [m]", 2, 2, 1e-2, "ruler")
	raise RuntimeError("no such luck")


def silent(check):
	"""It compares nothing"""


def test_errors_are_relative_to_the_reference_or_the_scale():
	result = verification.run(made(right))
	first, second = result.records
	assert first.error == pytest.approx(1e-3)
	assert second.error == pytest.approx(5e-4)
	assert result.passed
	assert not verification.run(made(right), shift=0.01).passed
	assert result.case.text == [
		("", "Some text over two lines.", False),
		("", "σ = E ε", True),
		("Reference", "a book.", False),
	]


@pytest.mark.parametrize("function, count", [(wrong, 2), (broken, 1), (silent, 0)])
def test_what_does_not_hold_fails(function, count):
	result = verification.run(made(function))
	assert not result.passed
	assert sum(not record.passed for record in result.records) == count
	assert ("no such luck" in result.error) == (function is broken)
	json.dumps([record.plain() for record in result.records], allow_nan=False)


def test_a_check_without_a_scale_is_refused():

	def zero(check):
		"""Zero"""
		check("stress [Pa]", 1, 0, 1e-3, "free sides")

	assert "give scale=" in verification.run(made(zero)).error


def test_mistakes_are_named():
	with pytest.raises(ValueError, match="did you mean settling"):
		verification.find("setling")
	with pytest.raises(ValueError, match="has no setting width; it has shift"):
		verification.run(made(right), width=1)
	with pytest.raises(ValueError, match="group 'nowhere'"):
		verification.case(group="nowhere", seconds=1)


def test_every_case_explains_itself():
	for case in verification.all_cases():
		labels = [label for label, _, _ in case.text]
		assert "Reference" in labels and "Expect" in labels, case.name
		assert len(case.title) <= 50 and not case.title.endswith("."), case.name


def test_page_holds_everything(tmp_path):
	results = [verification.run(made(function), pictures=True) for function in (right, wrong, broken)] + [
		verification.run("settling", pictures=True)
	]
	path = page.write(results, str(tmp_path / "new"), "run it --so", {"YADE": "1"})
	text = open(path, encoding="utf-8").read()
	for expected in (
		"3 of 11 checks failed", "run it --so", "A title", "σ = E ε", "no such luck", "0.001", "ruler", "–"
	):
		assert expected in text, expected
	assert "σ<sub>yy</sub>" in text
	assert text.count("data:image/png;base64,") == 2
	assert text.count("Effects of its last scene") == 1  # only settling has one
	assert "rotation = &#39;" in text
	assert sorted(os.listdir(tmp_path / "new")) == ["errors.png", "settling.png", "verification.html"]
	# self-contained: nothing is loaded from elsewhere
	assert not re.search(r"""(src|href)\s*=\s*["'](?!data:|#)|url\(|@import|<script|<link""", text)


# --- the script


@pytest.fixture
def verify(monkeypatch, capsys):
	"""Runs the script as YADE would, in this process: (exit code, what it printed)."""

	def call(*arguments):
		monkeypatch.setattr("sys.argv", [SCRIPT, *arguments])
		with pytest.raises(SystemExit) as end:
			runpy.run_path(SCRIPT, run_name="__main__")
		printed = capsys.readouterr()
		return end.value.code, printed.out + printed.err

	return call


def test_script_writes_the_promised_list(verify, tmp_path):
	code, printed = verify("--case", "settling", "rigid_motion", "--json", str(tmp_path / "deep" / "records.json"))
	assert code == 0, printed
	records = json.load(open(tmp_path / "deep" / "records.json", encoding="utf-8"))
	assert [list(record) for record in records] == [KEYS] * 10
	assert [record["case"] for record in records] == ["settling"] * 5 + ["rigid_motion"] * 5
	assert "10 of 10 checks passed, 2 cases" in printed
	assert all(record["ns_per_particle_step"] > 0 for record in records)
	each = re.findall(r"^  (\d+) steps of .* triangles: .+ ns a triangle-step", printed, re.MULTILINE)
	last = re.fullmatch(r"(\d+) steps of .* triangles: .+ ns a triangle-step.*", printed.strip().splitlines()[-1])
	assert len(each) == 2 and int(last[1]) == sum(map(int, each))


def test_script_fails_when_a_check_fails(verify, monkeypatch):
	monkeypatch.setattr(verification, "find", lambda name: made(wrong))
	code, printed = verify("--case", "wrong")
	assert code == 1
	assert "FAILED: wrong" in printed and "0 of 2 checks passed" in printed


def test_script_lists_the_cases(verify):
	code, printed = verify("--list")
	assert code == 0
	assert all(case.name in printed and case.title in printed for case in verification.all_cases())


def test_script_complains_about_wrong_calls(verify, tmp_path):
	code, printed = verify("--case", "setling")
	assert code == 2 and "did you mean settling" in printed
	(tmp_path / "file").write_text("")
	code, printed = verify("--case", "settling", "--report", str(tmp_path / "file"))
	assert code == 2 and "cannot write" in printed
	code, printed = verify("--case", "settling", "--json", str(tmp_path))
	assert code == 2 and "is a folder" in printed
	code, printed = verify("--list", "--report", str(tmp_path / "new"))
	assert code == 2 and "leave out one" in printed and not (tmp_path / "new").exists()


def test_a_case_named_twice_runs_once(verify):
	code, printed = verify("--case", "settling", "settling")
	assert code == 0 and "1 cases" in printed


# --- references


@pytest.mark.parametrize("tension, limit, jump", [(False, 30, 0.012), (True, 10, 0.001)])
def test_model_code_branches_meet(tension, limit, jump):
	"""The factors 0.012 and 0.0062 of the code are rounded: at 30 and 10 /s its branches give 1.2134 and
	1.2, 1.3366 and 1.3357."""
	below, above = concrete_theory.fib_factor(np.array([limit, limit * (1 + 1e-9)]), tension)
	assert 0 < 1 - above / below < jump
	assert concrete_theory.fib_factor(concrete_theory.FIB_STATIC[tension], tension) == pytest.approx(1)


def test_biaxial_tests():
	# 1.16 at equal stresses: Kupfer et al. (1969)
	assert concrete_theory.kupfer(np.array([0, 0.52, 1])) == pytest.approx([1, 1.254, 1.1625], abs=5e-4)


@pytest.mark.parametrize(
	"name, change",
	[
		("strength", 1.01), ("friction", 1.01), ("fractureEnergy", 1.01), ("closedGrowth", 1.02),
		("rateExponent", 1.001)
	],
)
def test_curves_tell_a_wrong_law(name, change):
	"""A parameter that is off by one per cent shows in a curve by far more than the tolerance of the case."""
	parameters = concrete()
	_, right = concrete_rates.RatePoint(parameters).uniaxial(-1, -0.006)
	_, wrong = concrete_rates.RatePoint({**parameters, name: parameters[name] * change}).uniaxial(-1, -0.006)
	assert concrete_rates.largest_difference(wrong[:, 1], right[:, 1]) > 1e-3


@pytest.mark.parametrize(
	"text, html", [
		("σ_xx and c_R", "σ<sub>xx</sub> and c<sub>R</sub>"),
		("N_Ω, ė_N, M_p ė_eq", "N<sub>Ω</sub>, ė<sub>N</sub>, M<sub>p</sub> ė<sub>eq</sub>"),
		(
			"(ė_N/ė_0)^ω_p)^(1/n_p)",
			"(ė<sub>N</sub>/ė<sub>0</sub>)<sup>ω<sub>p</sub></sup>)<sup>1/n<sub>p</sub></sup>",
		),
		("x^0.014, e^{ikx}.", "x<sup>0.014</sup>, e<sup>ikx</sup>."),
		("ddem.time_step and a < b", "ddem.time_step and a &lt; b")
	]
)
def test_indices_and_exponents_on_the_page(text, html):
	assert str(page._with_indices(text)) == html
