# GPL v2 or later, see LICENSE.
"""scripts/ucs_bonded.py: exact strengths of a column, a sample with a known result, everything it writes,
what it refuses."""
import json
import math
import os
import re
import shutil
import struct
import subprocess
import xml.etree.ElementTree as ET

import numpy as np
import origins
import pytest
import script_modules
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from yade.ddem import broken_bonds, packing
from yade.ddem.disc_stress import hondros, pressed
from yade.ddem.series import Series
from yade.ddem.studies.uniaxial import CompressionTest

DATA = os.path.join(os.path.dirname(__file__), "..", "data", "esys")
SMALL = ["--radii", "1e-3", "4e-3", "--fails", "500", "--no-progress"]  # 62 spheres
BARE = ["--no-pictures", "--no-vtk", "--no-progress"]
PICTURES = {
	"stress_strain", "wall_forces", "damage", "broken_bonds", "energy", "final_damage", "evolution", "rotation",
	"engines"
}
TENSION, SHEAR = 1, 2  # in ParaView files


@pytest.fixture(scope="module")
def job():
	return script_modules.load("ucs_bonded")


@pytest.fixture
def perform(job, monkeypatch, tmp_path):
	"""Runs the script and returns the summary of its run, and the folder."""

	def run(*arguments):
		folder = tmp_path / "out"
		script_modules.run(job, monkeypatch, "--out", folder, *arguments)
		with open(folder / "summary.json") as file:
			return json.load(file)["models"]["rigid"], folder

	return run


@pytest.fixture(scope="module")
def small(tmp_path_factory):
	"""What a user gets on two threads: the folder and the text on the terminal."""
	folder = tmp_path_factory.mktemp("small")
	command = [
		shutil.which("yade"), "-n", "-x", script_modules.path("ucs_bonded"), "--convention", "esys",
		"--threads", "2", *SMALL
	]
	done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
	assert done.returncode == 0, done.stderr
	return folder / "out" / "ucs_bonded", done.stdout


# ---- exact cases ----

RADIUS, COUNT = 1e-3, 5  # of the column's spheres
YOUNG, WALL = 50e9, 20e9


@pytest.fixture
def column(tmp_path):
	"""Options for a column of equal spheres, in mm, that is loaded so slowly that all its bonds feel the same
	force. The viscosity ends the swinging after it breaks, and its drag, at most 0.02 m/s · 3e5 /s · 1e-5 kg
	a sphere, is a thousandth of the force that breaks a bond."""
	spheres = packing.Packing([[0, (2 * row + 1) * RADIUS, 0] for row in range(COUNT)], [RADIUS] * COUNT)
	spheres.bonds = spheres.neighbours(1e-6)
	spheres.write(tmp_path / "particles.csv", tmp_path / "bonds.csv", length_unit="mm")
	files = ["--particles", tmp_path / "particles.csv", "--bonds", tmp_path / "bonds.csv", "--length-unit", "mm"]
	material = [
		"--young", YOUNG, "--wall-stiffness", WALL, "--density", "2600", "--mass-law", "solid", "--viscosity",
		"3e5"
	]
	return [*files, *material, "--velocity", "0.02", "--ramp", "1e-4", "--strain", "0.006", *BARE]


@pytest.mark.parametrize("convention", ["consistent", "esys"])
@pytest.mark.parametrize("options, limit", [
	(["--tan-phi", "1"], 100e6), (["--tan-phi", "2"], 50e6), (["--phi", "30"], 100e6 / math.tan(math.radians(30))),
	(["--tensile-strength", "30e6"], 30e6)
])
def test_column_in_tension_breaks_at_the_tensile_limit_of_its_bonds(column, perform, convention, options, limit):
	"""A bond of radius R = d0/2 = r carries F = σ π r²; it breaks at σ = C/tan φ, or at the cut-off (paper, eq. 8).
	The sample's stress is F/A, A = (2r)² (eq. 9)."""
	figures, folder = perform("--test", "tension", "--convention", convention, *column, *options)
	broken = broken_bonds.read(folder / "rigid_broken_bonds.csv")
	first = broken[0]
	assert first["mode"] == "tension" and first["radius"] == pytest.approx(RADIUS, rel=1e-12)
	assert limit < first["normal_stress"] < limit * (1 + 2e-3)  # what a step adds
	assert first["shear_stress"] < 1e-3 * limit
	assert figures["tensile_MPa"] == pytest.approx(1e-6 * limit * math.pi / 4, rel=2.5e-3)
	assert figures["ucs_MPa"] is None and figures["test"] == "tension"
	assert np.abs(np.abs(first["normal"]) - [0, 1, 0]).max() < 1e-6


@pytest.mark.parametrize("test", ["compression", "tension"])
def test_stiffness_of_a_column(column, perform, test):
	"""Springs in a row: bonds of E A/d0 = π E r/2 between the spheres, π r K at both walls,
	over the height of 2 r n."""
	figures, _ = perform("--test", test, *column)
	compliance = (COUNT - 1) / (math.pi * YOUNG * RADIUS / 2) + 2 / (math.pi * RADIUS * WALL)
	assert figures["young_GPa"] == pytest.approx(
		1e-9 * 2 * RADIUS * COUNT / (compliance * (2 * RADIUS)**2), rel=1e-6
	)


def test_column_in_compression_does_not_break(column, perform):
	"""There is no limit in pure compression; the stress never falls."""
	figures, folder = perform(*column, "--strain", "0.002")
	assert not figures["peak_passed"] and figures["stopped"] == "largest strain reached"
	assert len(broken_bonds.read(folder / "rigid_broken_bonds.csv")) == 0
	assert figures["strain_at_end"] == pytest.approx(0.002, rel=0.01)


# ---- a sample from files, with a result of ESyS-Particle ----


def test_sample_from_files_in_the_convention_of_esys(perform):
	"""Run coarse_s1_D of tests/data/esys: ESyS-Particle 2.3.5 itself has 83.9 GPa on this sample,
	whose box is 10 x 20 x 10 mm."""
	particles, bonds = (os.path.join(DATA, f"sample_coarse_s1_{part}.csv") for part in ("particles", "bonds"))
	files = ["--particles", particles, "--bonds", bonds, "--length-unit", "mm"]
	figures, folder = perform(
		"--convention", "esys", "--safety", "0.4", *files, "--box", "-0.005", "0", "-0.005", "0.005", "0.02",
		"0.005", *BARE
	)
	assert (figures["particles"], figures["bonds"]) == (241, 707)
	assert figures["young_GPa"] == pytest.approx(83.9, rel=0.003)
	# chaotic after the first bonds; equal steps are compared elsewhere
	assert figures["ucs_MPa"] == pytest.approx(143.5, rel=0.03)
	with open(folder / "summary.json") as file:
		options = json.load(file)["options"]
	assert (options["mass_law"], options["density"], options["velocity"]) == ("cube", 1e6, 0.125)
	assert not {"radii", "seed", "size", "fails"} & options.keys()  # of generated samples


# ---- files ----


def test_summary(small):
	folder, text = small
	with open(folder / "summary.json") as file:
		summary = json.load(file)
	figures = summary["models"]["rigid"]
	assert summary["machine"]["threads"] == 2 == summary["options"]["threads"]
	for name in (
		"particles", "degrees_of_freedom", "dt_s", "steps", "wall_s", "ns_per_particle_step", "ucs_MPa",
		"tensile_MPa", "young_GPa", "strain_at_peak",
		"damage_at_peak", "damage_at_end", "energy_error", "bonds", "broken_in_tension", "broken_in_shear"
	):
		assert name in figures
	assert figures["degrees_of_freedom"] == 6 * figures["particles"] > 300
	assert figures["tensile_MPa"] is None
	assert figures["dt_over_critical"] == pytest.approx(0.8)
	assert summary["versions"]["YADE"].startswith("20") and len(summary["versions"]["plugin"]) == 12
	assert "strength (UCS) [MPa]" in text and "deformable" not in text


def test_series_obeys_the_definitions(small):
	"""Eq. 9: both forces over twice the face of 10 x 10 mm. Young's modulus:
	least squares between 20 and 60 % of the strength."""
	folder, _ = small
	with open(folder / "summary.json") as file:
		figures = json.load(file)["models"]["rigid"]
	series = Series.read(folder / "rigid.csv")
	strain, stress = series["strain"], series["stress"]
	np.testing.assert_allclose(
		stress, (series["force_top"] + series["force_bottom"]) / (2 * 1e-4), rtol=1e-12, atol=1e-3
	)
	assert stress.max() == 1e6 * figures["ucs_MPa"]
	rows = slice(int(np.argmax(stress >= 0.2 * stress.max())), int(np.argmax(stress >= 0.6 * stress.max())) + 1)
	assert np.polyfit(strain[rows], stress[rows], 1)[0] == pytest.approx(1e9 * figures["young_GPa"], rel=1e-9)
	# eq. 11 with walls of 0.125 m/s, which have reached their speed after 50 µs
	late = series["time"] > 5.5e-5
	step = 0.25 * figures["dt_s"] / 0.02  # walls have moved on after the forces were found
	np.testing.assert_allclose(
		strain[late], 0.25 * (series["time"][late] - 2.5e-5) / 0.02, rtol=1e-9, atol=2 * step
	)


def test_broken_bonds(small):
	folder, _ = small
	with open(folder / "summary.json") as file:
		figures = json.load(file)["models"]["rigid"]
	broken, series = broken_bonds.read(folder / "rigid_broken_bonds.csv"), Series.read(folder / "rigid.csv")
	assert len(broken) == figures["broken_in_tension"] + figures["broken_in_shear"] > 20
	assert (broken["mode"] == "shear").sum() == figures["broken_in_shear"]
	np.testing.assert_allclose(
		broken_bonds.counts(broken, series["time"])[:-1], (figures["bonds"] * series["damage"])[:-1], atol=1.01
	)
	assert (np.diff(broken["step"]) >= 0).all() and len(
		{(a, b) for a, b in zip(broken["id1"], broken["id2"])}
	) == len(broken)
	# every bond was beyond the envelope τ = C - σ tan φ, with C = 100 MPa and tan φ = 1
	assert (broken["shear_stress"] + broken["normal_stress"] > 100e6).all()
	np.testing.assert_allclose(np.linalg.norm(broken["normal"], axis=1), 1, rtol=1e-9)
	assert (broken["position"] > [-1e-3, -1e-3, -6e-3]).all() and (broken["position"] < [11e-3, 21e-3, 6e-3]).all()


def test_list_of_broken_bonds_survives_the_file(tmp_path):
	records = np.zeros(2, broken_bonds.DTYPE)
	records["mode"], records["time"], records["normal_stress"] = ["tension", "shear"], [1 / 3, 2e-7], [1e8, -1 / 7]
	records["position"] = [[1, 2, 3], [0.1, -0.2, 1e-9]]
	broken_bonds.write(records, tmp_path / "broken.csv")
	assert (broken_bonds.read(tmp_path / "broken.csv") == records).all()
	broken_bonds.write(records[:0], tmp_path / "none.csv")
	assert len(broken_bonds.read(tmp_path / "none.csv")) == 0
	text = (tmp_path / "broken.csv").read_text()
	for wrong, message in (
		(text.replace("0.1,", "a,"), "line 3: position"),
		(text[10:], "line 1"),
		(text + "1,2\n", "line 5: 2 fields"),
	):
		(tmp_path / "wrong.csv").write_text(wrong)
		with pytest.raises(ValueError, match=message):
			broken_bonds.read(tmp_path / "wrong.csv")


def test_page_and_pictures(small):
	folder, _ = small
	page = (folder / "report.html").read_text(encoding="utf-8")
	assert page.count("data:image/png;base64,") == len(PICTURES)
	for text in (
		"Uniaxial compression of bonded spheres", "of their", "rigid_broken_bonds.csv",
		"as in ESyS-Particle 2.3.5", "packed by GenGeo", "--threads 2"
	):
		assert text in page
	body = re.sub(r"base64,[^\"]*|<!-- provenance: .*-->", "", page[page.index("<body>"):])
	for text in ("deformable", "both models", "each model", "None", "nan"):
		assert text not in body
	for name in PICTURES:
		with open(folder / f"{name}.png", "rb") as file:
			data = file.read()
		width, height = struct.unpack(">II", data[16:24])
		assert width > 500 and height > 350 and len(data) > 10_000, name


def test_paraview_files(small):
	folder, _ = small
	with open(folder / "summary.json") as file:
		figures = json.load(file)["models"]["rigid"]
	last = {}
	for part in ("spheres", "bonds", "broken"):
		entries = ET.parse(folder / "paraview" / f"rigid-{part}.pvd").getroot().findall("Collection/DataSet")
		assert len(entries) > 10 and float(entries[0].get("timestep")) == 0
		reader = vtkXMLUnstructuredGridReader()
		reader.SetFileName(str(folder / "paraview" / entries[-1].get("file")))
		reader.Update()
		last[part] = reader.GetOutput()
	assert last["spheres"].GetNumberOfPoints() == figures["particles"]
	assert last["bonds"].GetNumberOfCells() == figures["bonds"]
	state = vtk_to_numpy(last["bonds"].GetCellData().GetArray("state (0 holds, 1 tension, 2 shear)"))
	assert [(state == mode).sum() for mode in (TENSION, SHEAR)] == [
		figures["broken_in_tension"],
		figures["broken_in_shear"],
	]
	broken = broken_bonds.read(folder / "rigid_broken_bonds.csv")
	stress = vtk_to_numpy(last["broken"].GetPointData().GetArray("normal stress [Pa]"))
	np.testing.assert_array_equal(stress, broken["normal_stress"])


def test_tension_of_a_packing(perform):
	figures, folder = perform("--test", "tension", "--velocity", "0.1", *SMALL, *BARE)
	series, broken = Series.read(folder / "rigid.csv"), broken_bonds.read(folder / "rigid_broken_bonds.csv")
	assert 5 < figures["tensile_MPa"] < 100  # the bonds have 100
	assert series["strain"][-1] > 0 and series["force_top"].max() > 0
	assert (broken["mode"] == "tension").mean() > 0.5 and (
		broken["normal_stress"][broken["mode"] == "tension"] > 0
	).all()
	page = (folder / "report.html").read_text(encoding="utf-8")
	for text in (
		"Uniaxial tension of bonded spheres", "MPa in tension", "tension positive", "moved apart",
		"tensile strength", "they pull"
	):
		assert text in page
	assert "strength (UCS)" not in page


def test_pressure_on_the_sides_strengthens(perform):
	quick = ["--velocity", "0.5", "--seed", "2", *SMALL, *BARE]
	alone, _ = perform(*quick)
	peaks = [alone["ucs_MPa"]]
	for pressure in ("10e6", "40e6"):
		figures, folder = perform("--test", "triaxial", "--pressure", pressure, *quick)
		series = Series.read(folder / "rigid.csv")
		assert series["stress"].max() == pytest.approx(1e6 * figures["ucs_MPa"], rel=1e-6)
		reached = np.argmin(abs(series["time"] - 1e-4))
		assert series["stress"][reached] == pytest.approx(float(pressure), rel=0.1)
		peaks.append(figures["ucs_MPa"])
	assert peaks[0] < peaks[1] < peaks[2]


def test_sides_that_stand_still_stiffen(perform):
	quick = ["--velocity", "0.5", "--cohesion", "1e12", "--viscosity", "1e4", "--strain", "1e-3", *SMALL, *BARE]
	free, _ = perform(*quick)
	held, folder = perform("--test", "oedometer", *quick)
	assert 1.0 < held["young_GPa"] / free["young_GPa"] < 1.5  # (1-ν)/((1+ν)(1-2ν)): 1.1 for ν = 0.2
	assert "one-dimensional compression" in (folder / "report.html").read_text(encoding="utf-8")


def test_a_brazilian_disc_splits(perform):
	"""Of bonds whose sample bears 13 times in compression what it bears in tension;
	others crush beneath the walls."""
	strong = [
		"--criterion", "parallel", "--moment-contribution", "0", "--cohesion", "400e6", "--tensile-strength",
		"20e6",
		"--radii", "0.8e-3", "2e-3", "--velocity", "0.25", *BARE
	]
	split, folder = perform("--test", "brazilian", "--size", "0.03", "0.03", "0.008", *strong)
	page = (folder / "report.html").read_text(encoding="utf-8")
	pulled, _ = perform("--test", "tension", "--size", "0.015", "0.03", "0.008", "--generator", "fill", *strong)
	assert 0.8 < split["splitting_MPa"] / pulled["tensile_MPa"] < 2.5
	assert split["broken_in_tension"] > 2 * split["broken_in_shear"]
	# of the flat ends that the sample has, not of others
	assert split["angle_degree"] == pytest.approx(30) and split["centre_over_nominal"] == pressed(30)[0]
	assert "30° wide" in page and f"{hondros(30)[0]:.3f}" in page and "0.96" not in page


STRONG = [
	"--criterion", "parallel", "--moment-contribution", "0", "--cohesion", "400e6", "--tensile-strength", "20e6",
	"--radii", "0.8e-3", "2e-3"
]


def test_jaws_of_the_brazilian_test(perform):
	"""All three split the disc at stresses of the same kind; the report says which it was."""
	strengths = {}
	for jaws, words in (("curved", "of 18 mm radius"), ("flat", "on a round disc")):
		figures, folder = perform(
			"--test", "brazilian", "--jaws", jaws, "--size", "0.024", "0.024", "0.008", "--velocity",
			"0.25",
			*STRONG,
			*BARE
		)
		page = (folder / "report.html").read_text(encoding="utf-8")
		for text in ("Brazilian test of bonded spheres", "splitting tensile strength", words):
			assert text in page
		assert figures["test"] == "brazilian" and figures["young_GPa"] is None and figures["ucs_MPa"] is None
		strengths[jaws] = figures["splitting_MPa"]
	assert 0.5 < strengths["flat"] / strengths["curved"] < 1.5


def test_bending_and_its_notch(perform):
	quick = [
		"--test", "bending", "--size", "0.036", "0.009", "0.009", "--radii", "0.7e-3", "1.6e-3", "--generator",
		"fill",
		"--velocity", "0.3", *BARE
	]
	whole, folder = perform(*quick)
	series = Series.read(folder / "rigid.csv")
	# 3PL/(2bh²) of the default span, 0.8 of the length; 6δh/L²
	np.testing.assert_allclose(
		series["stress"], 3 * series["force_top"] * 0.0288 / (2 * 0.009**3), rtol=1e-9, atol=1
	)
	np.testing.assert_allclose(
		series["strain"], 6 * series["deflection"] * 0.009 / 0.0288**2, rtol=1e-9, atol=1e-12
	)
	assert whole["flexural_MPa"] == pytest.approx(1e-6 * series["stress"].max())
	assert whole["flexural_modulus_GPa"] > 20 and whole["young_GPa"] is None and whole["span_m"] == 0.0288
	assert whole["broken_in_tension"] > whole["broken_in_shear"]
	page = (folder / "report.html").read_text(encoding="utf-8")
	for text in (
		"Three-point bending of bonded spheres",
		"flexural strength",
		"flexural modulus",
		"speed of the load",
	):
		assert text in page
	assert "UCS" not in page and "Uniaxial" not in page
	wide, _ = perform(*quick, "--strip", "0.003")
	assert wide["strip_m"] == 0.003 > whole["strip_m"] > 0
	notched, folder = perform(*quick, "--notch", "0.003")
	assert notched["bonds"] < whole["bonds"] and "flexural_modulus_GPa" not in notched
	assert Series.read(folder / "rigid.csv")["force_top"].max() < 0.85 * series["force_top"].max()
	assert "depth of the notch" in (folder / "report.html").read_text(encoding="utf-8")


def test_direct_shear(perform):
	quick = [
		"--test", "shear", "--size", "0.016", "0.01", "0.008", "--radii", "0.7e-3", "1.6e-3", "--generator",
		"fill",
		"--velocity", "0.4", "--strain", "0.015", "--viscosity", "1e4", *BARE
	]
	peaks = []
	for stress in ("5e6", "30e6"):
		figures, folder = perform(*quick, "--normal-stress", stress)
		series = Series.read(folder / "rigid.csv")
		assert figures["shear_MPa"] == pytest.approx(1e-6 * series["stress"].max())
		assert figures["normal_stress_MPa"] == pytest.approx(1e-6 * float(stress))
		assert series["displacement"][-1] == pytest.approx(0.015 * 0.016, rel=0.02)
		last = series["strain"] >= 0.8 * series["strain"].max()
		assert figures["residual_MPa"] == pytest.approx(1e-6 * series["stress"][last].mean())
		assert figures["residual_MPa"] < figures["shear_MPa"]
		peaks.append(figures["shear_MPa"])
	assert peaks[0] < peaks[1]
	page = (folder / "report.html").read_text(encoding="utf-8")
	for text in (
		"Direct shear of bonded spheres",
		"peak shear strength",
		"residual shear stress",
		"kept by a servo",
	):
		assert text in page


def test_cylinders_and_criteria(perform):
	figures, folder = perform(
		"--shape", "cylinder", "--criterion", "softening", "--scatter", "6", "--tension-energy", "200",
		"--velocity",
		"0.5", "--radii", "0.5e-3", "2e-3", "--fails", "500", "--cohesion", "40e6", *BARE
	)
	page = (folder / "report.html").read_text(encoding="utf-8")
	assert f"{1e6 * math.pi / 4 * 0.01**2:.4g} mm²" in page
	assert "Weibull modulus" in page and "SofteningBondMat" in page
	assert 5 < figures["ucs_MPa"] < 500


def test_kept_packing_gives_the_same_test(perform, tmp_path):
	keep = ["--packings", tmp_path / "kept"]
	results = [origins.numbers(perform(*SMALL, *BARE, *options)[1] / "rigid.csv") for options in ([], keep, keep)]
	assert results[0] == results[1] == results[2]
	assert len(os.listdir(tmp_path / "kept")) == 1


def test_options_reach_the_model(job, monkeypatch):
	"""Every parameter of material, walls and damping, as the scene has it."""
	from yade import O
	arguments = [
		"--young", "3e10", "--poisson", "0.1", "--cohesion", "4e7", "--phi", "20", "--tensile-strength", "2e7",
		"--friction", "0.5", "0.3", "--gradual-friction",
		"--contact-damping", "0.1", "0.2", "--density", "3000", "--mass-law", "cube", "--wall-stiffness",
		"7e10", "--bonded-walls", "--wall-shear-stiffness", "5e9",
		"--viscosity", "3", "--rotational-viscosity", "4", "--dt", "2e-8", "--velocity", "0.3", "--ramp",
		"1e-6", "--drive", "top"
	]
	monkeypatch.setattr("sys.argv", ["scripts/ucs_bonded.py", *SMALL, *arguments])
	options, _ = job.read_options()
	platens, _, _ = job.make(options)
	bonds = O.materials["bonds"]
	assert (bonds.young, bonds.poisson, bonds.cohesion, bonds.tensileStrength, bonds.density) == (
		3e10, 0.1, 4e7, 2e7, 3000
	)
	assert math.degrees(bonds.bondFrictionAngle) == pytest.approx(20)
	assert (
		bonds.frictionStatic, bonds.frictionDynamic, bonds.gradualFriction, bonds.normalDamping,
		bonds.shearDamping
	) == (0.5, 0.3, True, 0.1, 0.2)
	sphere = O.bodies[int(platens.sample.ids[0])]
	assert sphere.state.mass == pytest.approx(3000 * sphere.shape.radius**3)
	wall = O.bodies[platens.top].mat
	assert (wall.stiffness, wall.shearStiffness) == (7e10, 5e9)
	damping = next(engine for engine in O.engines if engine.label == "bodyDamping")
	assert (damping.viscosity, damping.rotationalViscosity) == (3, 4)
	drive, = platens.engines
	assert (drive.velocity, drive.rampTime, list(drive.ids)) == (-0.3, 1e-6, [platens.top])
	assert O.dt == 2e-8


# ---- what is refused ----


@pytest.mark.parametrize("arguments, message", [
	(["--test", "torsion"], "--test: invalid choice: 'torsion'"),
	(["--test", "triaxial"], "--pressure: it belongs to --test triaxial, which needs it"),
	(["--pressure", "1e6"], "--pressure: it belongs to --test triaxial"),
	(
		["--test", "triaxial", "--pressure", "1e6", "--shape", "disc"],
		"--shape: rigid walls enclose a prism; --confinement jacket takes cylinders, too"
	),
	(
		["--test", "triaxial", "--pressure", "1e6", "--shape", "disc", "--confinement", "jacket"],
		"--shape: a jacket goes around a prism or a cylinder, not a disc"
	),
	(["--test", "oedometer", "--shape", "cylinder"], "--shape: --test oedometer needs a prism"),
	(["--test", "brazilian", "--size", "0.03", "0.02", "0.01"], "--size: a disc of 0.03 m has that height as well"),
	(["--shape", "disc", "--size", "0.03", "0.02", "0.01"], "give W and H the same"),
	(["--test", "bending", "--strip", "1e-9"], "widen the strip"),
	(["--strip", "1e-3"], "--strip: it belongs to --test bending"),
	(["--test", "brazilian", "--shape", "prism"], "--shape: the Brazilian test splits a disc"),
	(["--test", "bending", "--span", "0.05"], "--span: 0.05 m must be below the beam's length, 0.05 m"),
	(["--test", "bending", "--span", "0.049"], "do not lie below a beam 0.05 m long"),
	(["--test", "bending", "--size", "0.01", "0.02", "0.01"], "--size: 0.01 x 0.02 m is no beam"),
	(["--test", "bending", "--notch", "0.02"], "--notch: 0.02 m must be below the beam's height, 0.0125 m"),
	(["--test", "bending", "--shape", "cylinder"], "--shape: --test bending needs a prism"),
	(["--test", "bending", "--drive", "top"], "--drive: --test bending has no two walls that move"),
	(["--test", "bending", "--bonded-walls"], "--bonded-walls: there are no walls in a bending test"),
	(["--test", "shear"], "--normal-stress: it belongs to --test shear, which needs it"),
	(["--test", "shear", "--normal-stress", "-1"], "--normal-stress: -1 must be positive"),
	(
		["--test", "shear", "--normal-stress", "1e6", "--box-gap", "0.01"],
		"gap = 0.01 m must lie between 0 and half",
	),
	(["--span", "0.03"], "--span: it belongs to --test bending"),
	(["--jaws", "flat"], "--jaws: it belongs to --test brazilian"),
	(["--test", "brazilian", "--jaws", "round"], "--jaws: invalid choice: 'round'"),
	(["--convention", "esys", "--criterion", "softening"], "--criterion: bonds of the convention esys"),
	(["--criterion", "softening", "--tension-energy", "1e-3"], "tensionEnergy = 0.001 J/m² is not above"),
	(["--convention", "esis"], "--convention: invalid choice: 'esis'"),
	(["--young", "-1"], "--young: -1 must be positive"),
	(["--velocity", "inf"], "--velocity: inf must be positive"),
	(["--threads", "0"], "--threads: 0 must be at least 1"),
	(["--seed", "-1"], "--seed: -1 must not be negative"),
	(["--safety", "0"], "--safety: 0 leaves no time step"),
	(["--safety", "1.5"], "--safety: 1.5 must be a part"),
	(["--rows", "10"], "--rows: 10 must be at least 100"),
	(["--tan-phi", "1", "--phi", "45"], "not allowed with argument --tan-phi"),
	(["--bonds", "b.csv"], "--bonds: a file of bonds goes with a file of particles"),
	(["--box", "0", "0", "0", "1", "1", "1"], "--box: it belongs to a file of particles"),
	(["--length-unit", "mm"], "--length-unit: it belongs to a file of particles"),
	(["--particles", "nowhere.csv"], "No such file or directory: 'nowhere.csv'"),
	(["--particles", "p.csv", "--radii", "1", "2"], "--radii: it belongs to a generated sample"),
	(
		["--particles", "p.csv", "--box", "0", "0", "0", "1", "-1", "1"],
		"--box: its second corner must be above the first",
	),
	(["--test", "tension", "--no-bonded-walls"], "--no-bonded-walls: walls that are not bonded only push"),
	(["--wall-shear-stiffness", "1e9"], "--wall-shear-stiffness: only bonded walls have one"),
	(["--poisson", "0.7"], "poisson"),
	(["--phi", "90"], "bondFrictionAngle"),
	(["--convention", "esys", "--gradual-friction"], "gradualFriction"),
	(["--dt", "1e-3"], "above the critical time step"),
	(["--radii", "1e-3", "6e-3"], "does not fit into"),
	(["--radii", "2e-3", "1e-3"], "above rmax"),
	(["--out", "/proc/nowhere"], "--out: cannot write into /proc/nowhere"),
])
def test_bad_options_are_refused_before_anything_runs(job, monkeypatch, capsys, tmp_path, arguments, message):
	monkeypatch.setattr(CompressionTest, "run", lambda *_, **__: pytest.fail("the test was started"))
	monkeypatch.chdir(tmp_path)
	quick = [] if {"--radii", "--particles"} & set(arguments) else SMALL
	with pytest.raises(SystemExit) as stopped:
		script_modules.run(job, monkeypatch, *quick, *arguments)
	assert stopped.value.code == 2
	assert message in capsys.readouterr().err


def test_threads_that_cannot_be_had(job, monkeypatch, capsys):
	"""The number of threads is fixed when YADE starts; a second start that has not helped is said, not repeated."""
	monkeypatch.setenv("YADE_DDEM_RESTARTED", "1")
	with pytest.raises(SystemExit) as stopped:
		script_modules.run(job, monkeypatch, *SMALL, "--threads", "64")
	assert stopped.value.code == 2
	assert "threads, not on 64" in capsys.readouterr().err


def test_help_explains_every_option_with_its_default(job, monkeypatch, capsys):
	with pytest.raises(SystemExit) as stopped:
		script_modules.run(job, monkeypatch, "--help")
	assert stopped.value.code == 0
	text = capsys.readouterr().out
	options = [line.strip() for line in text.splitlines() if line.strip().startswith("--")]
	assert len(options) >= 40
	assert text.count("(default:") == len(options)
