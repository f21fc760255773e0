# GPL v2 or later, see LICENSE.
"""scripts/ucs_deformable.py: every kind of test against the elastic solution, strengths that laws state, everything it
writes, what it refuses."""
import json
import math
import os

import numpy as np
import pytest
import script_modules

from yade.ddem.materialpoint import MaterialPoint, concrete
from yade.ddem.series import Series
from yade.ddem.studies.deformable_laws import LAWS
from yade.ddem.studies.deformable_tests import TESTS
from yade.ddem.triangle_bending import plane_strain_deflection

BARE = ["--no-pictures", "--no-vtk", "--no-progress"]
ELASTIC = ["--law", "elastic", "--young", 30e9, "--poisson", 0.2, "--strain", 2e-4, "--rows", 200]


@pytest.fixture(scope="module")
def job():
	return script_modules.load("ucs_deformable")


@pytest.fixture
def perform(job, monkeypatch, tmp_path):
	"""Runs the script and returns the summary of its run, and the folder."""

	def run(*arguments):
		folder = tmp_path / "out"
		script_modules.run(job, monkeypatch, "--out", folder, *arguments)
		with open(folder / "summary.json") as file:
			return json.load(file)["models"]["deformable"], folder

	return run


# ---- elastic samples ----


@pytest.mark.parametrize(
	"test, options, error", [
		# uniform fields, which any mesh has; what is left are waves of the start
		("compression", ["--ends", "smooth"], 0.005), ("tension", [], 0.005), ("oedometer", [], 0.005),
		("biaxial", ["--pressure", 1e5], 0.01), ("shear", [], 0.005),
		# the beam that the script has: ten linear triangles over its height, a span of four heights
		("bending", [], 0.025)
	]
)
def test_an_elastic_sample_has_the_slope_that_hooke_gives(perform, test, options, error):
	coarse = [] if test == "bending" else ["--edge", 0.02]
	motion = ["--velocity", 0.05, "--ramp", 1e-3 if test == "bending" else 5e-4]
	figures, folder = perform("--test", test, *coarse, *options, *ELASTIC, *motion, *BARE)
	closed = {
		"compression": 30e9 / (1 - 0.2**2), "tension": 30e9 / (1 - 0.2**2), "biaxial": 30e9 / (1 - 0.2**2),
		"oedometer": 30e9 * 0.8 / (1.2 * 0.6), "shear": 30e9 / 2.4, "bending": None
	}[test]
	expected = figures["elastic_modulus_GPa"]
	if test == "bending":
		assert figures["span_m"] == pytest.approx(0.192, rel=0.03) and figures["strip_m"] == 0
	if closed:
		assert expected == pytest.approx(1e-9 * closed)
	name = TESTS[test].record.wording.modulus
	assert figures[name] == pytest.approx(expected, rel=error)
	assert figures["energy_error"] < 1e-6 and figures["damage_at_end"] == 0
	# what cannot fail has no strength
	assert figures[TESTS[test].record.wording.strength] is None and figures.get("deviator_MPa") is None
	assert "so that this is no strength" in (folder / "report.html").read_text()
	series = Series.read(folder / "deformable.csv")
	assert series["strain"].max() == pytest.approx(2e-4, rel=0.15) and series["stress"].max() > 0


@pytest.mark.parametrize("jaws", ["curved", "flat-ends"])
def test_an_elastic_disc_has_the_stress_of_a_rigid_punch_at_its_centre(perform, jaws):
	figures, folder = perform(
		"--test", "brazilian", "--jaws", jaws, "--angle", 20, "--edge", 0.003, *ELASTIC, *BARE
	)
	series = Series.read(folder / "deformable.csv")
	last = slice(len(series) // 2, None)
	ratio = (series["splitting_stress"][last] / series["stress"][last]).mean()
	assert figures["centre_over_nominal"] == pytest.approx(1 - 9 / 4 * math.radians(10)**2, abs=2e-3)
	# that the disc is no half plane, and triangles of a seventeenth of it: three per cent
	assert ratio == pytest.approx(figures["centre_over_nominal"], rel=0.04)
	assert figures["splitting_MPa"] is None and figures["angle_degree"] == 20
	page = (folder / "report.html").read_text()
	assert ("an arc of nodes that moves as one" in page) == (jaws == "curved")


# ---- strengths that laws state ----


def test_mazars_concrete_breaks_in_tension_at_its_strength(perform):
	"""In plane strain with free sides at f_t/(1 - ν²) (class documentation of ScalarDamageMat)."""
	figures, _ = perform(
		"--test", "tension", "--law", "scalar-damage", "--tensile-strength", 3e6, "--edge", 0.02, "--velocity",
		0.005, "--strain", 3e-4, "--ramp", 1e-3, *BARE
	)
	assert figures["peak_passed"]
	assert figures["tensile_MPa"] == pytest.approx(3 / (1 - 0.2**2), rel=0.02)
	assert figures["damage_at_end"] > 0.05


def test_concrete_breaks_in_tension_where_a_point_of_its_law_does(perform):
	"""Without scatter the sample is uniform until it breaks: a material point in plane strain with a free side that
	is strained as fast."""
	figures, _ = perform(
		"--test", "tension", "--spread", 0, "--edge", 0.025, "--velocity", 0.05, "--rows", 300, *BARE
	)
	duration, strain = 1e-3 / (2 * 0.05 / 0.2), 1e-3
	point = MaterialPoint(concrete()).path(duration, strain={"yy": strain}, stress={"xx": 0.0}, steps=2000)
	assert figures["tensile_MPa"] == pytest.approx(1e-6 * point.stress[:, 1].max(), rel=0.02)
	assert figures["strain_at_peak"] == pytest.approx(strain * point.stress[:, 1].argmax() / 2000, rel=0.1)


def test_a_metal_yields_at_the_stress_of_plane_strain(perform):
	"""2/√3 of the yield stress where plastic flow has no room out of plane (Hill 1950)."""
	figures, _ = perform(
		"--law", "von-mises", "--yield-stress", 300e6, "--ends", "smooth", "--edge", 0.02, "--velocity", 1,
		"--strain", 0.02, "--stop", 0, "--mesh", "crossed", "--rows", 200, *BARE
	)
	assert figures["stress_at_end_MPa"] == pytest.approx(300 * 2 / math.sqrt(3), rel=0.03)
	assert figures["ucs_MPa"] >= figures["stress_at_end_MPa"]  # it breaks nowhere, but has yielded


def test_pressure_makes_concrete_stronger(perform):
	strengths = []
	for test in (["compression"], ["biaxial", "--pressure", 20e6]):
		figures, _ = perform("--test", *test, "--edge", 0.02, "--velocity", 1, "--rows", 200, *BARE)
		assert figures["peak_passed"]
		strengths.append(figures["ucs_MPa"])
	# at least as much as the least friction of the law would add, 0.66 of the pressure on top of it (eq. 5)
	assert strengths[1] > strengths[0] + 1.66 * 20
	assert figures["deviator_MPa"] == pytest.approx(strengths[1] - 20, rel=1e-3)


# ---- files and options ----


def test_everything_that_is_written(perform):
	figures, folder = perform("--edge", 0.025, "--strain", 5e-4, "--law", "scalar-damage", "--test", "tension")
	found = {os.path.relpath(os.path.join(at, name), folder) for at, _, names in os.walk(folder) for name in names}
	assert {"report.html", "summary.json", "deformable.csv", "stress_strain.png", "final_damage.png"} <= found
	assert any(name.startswith(os.path.join("paraview", "deformable-")) for name in found)
	page = (folder / "report.html").read_text()
	assert "Uniaxial tension of deformable triangles" in page and "tensile strength" in page
	assert "plane strain" in page and np.isfinite(figures["elastic_modulus_GPa"])
	assert figures["test"] == "tension" and figures["particles"] > 50


def test_what_a_law_is_set_to_reaches_the_material_and_the_report(perform):
	"""Without rate dependence the law is a smaller one; numbers and switches are shown as they were given."""
	quick = ["--edge", 0.025, "--velocity", 1, "--strain", 2e-3, "--rows", 100, "--spread", 0, *BARE]
	figures, folder = perform(*quick, "--set", "damageExponent=1.5", "--set", "rateDependence=off")
	assert figures["parameters"]["damageExponent"] == "1.5" and figures["parameters"]["rateDependence"] == "off"
	changed = Series.read(folder / "deformable.csv")["stress"].max()
	usual, folder = perform(*quick)
	assert "rateDependence" not in usual["parameters"]
	assert changed < 0.99 * Series.read(folder / "deformable.csv")["stress"].max()


def test_two_beams_have_each_its_own_slope(job, monkeypatch, tmp_path):
	"""The slope of an elastic beam is that of the load at hand, with the span that its nodes have, and not that of
	the beam made last."""
	beams = []
	for span, edge in ((0.36, 0.0125), (0.30, 0.0121)):
		monkeypatch.setattr(
			"sys.argv", [
				"scripts/ucs_deformable.py", "--test", "bending", "--law", "elastic", "--size", "0.4",
				"0.05",
				"0.05", "--span", str(span), "--edge", str(edge), "--out", str(tmp_path)
			]
		)
		options, _ = job.read_options()
		load, _, material = job.make(options)
		# P over δ of the beam as it stands
		depth, height = load.section
		deflection = plane_strain_deflection(1, load.span, material.young, material.poisson, depth, height)
		beams.append((load, material, load.span**3 / (4 * depth * height**3 * deflection)))
	assert beams[1][0].span != 0.30  # no node lies there
	for load, material, slope in beams:
		said = TESTS["bending"].elastic_modulus(load, material.young, material.poisson)
		assert said == pytest.approx(slope, rel=1e-12)


def test_each_law_and_each_test_is_in_the_help(job, monkeypatch, capsys):
	with pytest.raises(SystemExit):
		script_modules.run(job, monkeypatch, "--help")
	said = " ".join(capsys.readouterr().out.split())
	for name in (*TESTS, *LAWS):
		assert name in said
	assert "an arc of nodes that moves as one" in said
	for option in ("--pressure PA", "--yield-stress PA", "--tensile-strength PA", "--angle DEGREES", "--span M"):
		assert option in said


@pytest.mark.parametrize(
	"arguments, message", [
		(["--test", "biaxial"], "--pressure: it belongs to --test biaxial, which needs it"),
		(["--pressure", "1e6"], "--pressure: it belongs to --test biaxial"),
		(["--ends", "rough", "--test", "oedometer"], "--test oedometer has no ends to choose"),
		(["--edge", "0.03"], "0.03 m is more than a quarter"),
		(["--law", "elastic", "--fracture-energy", "80"], "--fracture-energy: it belongs to --law"),
		(["--law", "elastic", "--spread", "0.5"], "--law elastic has no fracture energy"),
		(["--set", "colour=1"], "ConcreteDamageMat has no number 'colour'; it has"),
		(["--set", "damageExponnt=1"], "Did you mean damageExponent?"),
		(["--set", "id=3"], "has no number 'id'"), (["--set", "label=1"], "has no number 'label'"),
		(["--set", "young=1e9"], "'young' has an option of its own, --young"),
		(["--set", "fractureEnergy=9"], "an option of its own, --fracture-energy"),
		(["--set", "damageExponent=on"], "'damageExponent' of ConcreteDamageMat is a number, not on"),
		(["--set", "rateDependence=0"], "'rateDependence' of ConcreteDamageMat is on or off, not 0"),
		(["--set", "damageExponent=many"], "must be NAME=NUMBER"),
		(["--set", "damageExponent"], "must be NAME=NUMBER"),
		(["--set", "damageExponent=nan"], "must be NAME=NUMBER"),
		(["--set", "damageExponent=-1"], "damageExponent"), (["--poisson", "0.6"], "poisson"),
		(["--test", "bending", "--size", "0.1", "0.1", "0.1"], "is no beam"),
		(["--test", "bending", "--strip", "0.2"], "--strip: 0.2 m must be below the span, 0.192 m"),
		(["--strip", "0.01"], "--strip: it belongs to --test bending"),
		(["--test", "bending", "--span", "1"], "--span: 1 m must not exceed"),
		(["--test", "shear", "--drive", "top"], "--test shear has no two platens"),
		(["--test", "brazilian", "--size", "0.05", "0.06", "0.02"], "give W and H the same"),
		(["--test", "brazilian", "--angle", "80"], "must not exceed 60 degrees"),
		(["--velocity", "0"], "must be positive"), (["--safety", "0"], "leaves no time step"),
		(["--test", "biaxial", "--pressure", "1e9"], "stress"),
	]
)
def test_what_does_not_go_together_is_refused(job, monkeypatch, tmp_path, capsys, arguments, message):
	with pytest.raises(SystemExit) as stop:
		script_modules.run(job, monkeypatch, "--out", tmp_path / "out", *BARE, *arguments)
	assert stop.value.code == 2 and message in capsys.readouterr().err
	assert not (tmp_path / "out" / "summary.json").exists()
