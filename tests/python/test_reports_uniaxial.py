# GPL v2 or later, see LICENSE.
"""Tables, files and pictures of a report, made from runs that were computed by hand."""
import dataclasses
import json
import math
import os
import re
import struct

import numpy as np
import pytest
from ddem import broken_bonds, mesh, packing
from ddem.reports.figures import energy
from ddem.reports.uniaxial import Report
from ddem.series import Series
from ddem.studies.runs import Run, cost_ratios
from ddem.studies.snapshots import SphereSnapshot, TriangleSnapshot, crack_traces
from ddem.studies.wording import TENSION

KEYS = {
	"particles", "degrees_of_freedom", "dt_s", "steps", "wall_s", "ns_per_particle_step", "ucs_MPa", "young_GPa",
	"strain_at_peak", "damage_at_peak", "damage_at_end",
	"energy_error"
}


def curve(energies):
	"""Up to 60 MPa at 0.002 along 30 GPa, down to 6 MPa at 0.004; damage grows from 0 to 0.4."""
	series = Series(
		time="s",
		strain="-",
		stress="Pa",
		force_top="N",
		force_bottom="N",
		damage="-",
		energy_drift="J",
		**{f"energy_{name}": "J" for name in energies},
	)
	for strain in np.linspace(0, 0.004, 201):
		stress = 30e9 * strain if strain <= 0.002 else 60e6 - 27e9 * (strain - 0.002)
		row = dict(
			time=0.1 * strain, strain=strain, stress=stress, force_top=2e-3 * stress,
			force_bottom=2e-3 * stress, damage=100 * strain, energy_drift=1e-5 * strain
		)
		series.append(**row, **{f"energy_{name}": factor * strain for name, factor in energies.items()})
	return series


def deformable_run():
	sample = mesh.rectangle(0.1, 0.2, 0.02, regions={"steel": mesh.box(0.04, 0.08, 0.06, 0.12)})
	inner = np.zeros((0, 2), dtype=int)
	snapshots = [
		TriangleSnapshot(
			time, sample.nodes, sample.triangles, np.full((len(sample.triangles), 3), 1e3 * time),
			np.linspace(-time, time, len(sample.triangles)), inner
		)
		for time in np.linspace(0, 4e-4, 9)
	]
	return Run(
		"deformable", "deformable triangles", "triangle", len(sample.triangles), 711, 2e-7, 2.5e-7, 2000, 4.0,
		3.9, 1,
		curve({"externalWork": -1000, "elastPotential": 300, "plasticFlow": 700}), snapshots,
		[("deformable", 3.5, 2000), ("recorder", 0.5, 200)],
		3e-5, "largest strain reached", parameters=[("B", "30 GPa", "bulk modulus <of> concrete")]
	)


def rigid_run():
	grid = np.stack(
		np.meshgrid(np.linspace(0.005, 0.095, 10), np.linspace(0.005, 0.195, 20), [0.0]), axis=-1
	).reshape(-1, 3)
	spheres = packing.Packing(grid, np.full(len(grid), 0.005))
	cracks = crack_traces(grid[:5], grid[1:6], np.full(5, 0.005))
	snapshots = [
		SphereSnapshot(
			time, grid, spheres.radii, np.full(len(grid), 1e3 * time), grid[:, 0] - 0.05, cracks,
			np.ones(5, bool)
		)
		for time in (0, 2e-4, 4e-4)
	]
	return Run(
		"rigid", "rigid bonded spheres", "sphere", len(grid), 6 * len(grid), 4e-7, 5e-7, 1000, 1.0, 0.9, 1,
		curve({"externalWork": -1000, "bondElastic": 400, "friction": 600}),
		snapshots, [("interactions", 0.7, 1000), ("newton", 0.3, 1000)], 3e-5,
		"stress stayed below 20 % of the peak", extra={"bonds": 361}, bytes_per_particle=2500.0
	)


@pytest.fixture
def runs():
	return [rigid_run(), deformable_run()]


def broken(count):
	"""So many broken bonds, every third in shear, evenly over the 0.4 ms of the test."""
	records = np.zeros(count, broken_bonds.DTYPE)
	records["time"], records["mode"] = (
		np.linspace(0, 4e-4, count),
		np.where(np.arange(count) % 3, "tension", "shear"),
	)
	return records


def report(runs, folder, **options):
	return Report(
		runs, folder, "A title", [("width", "0.1 m", "of the block")], "run it --so",
		{"preset": "none", "seed": 7, "vtk": True}, {"YADE": "1"}, ["A note."], **options
	)


def test_summary_has_the_promised_figures(runs):
	for run in runs:
		figures = run.summary()
		assert KEYS <= figures.keys()
		assert figures["ucs_MPa"] == pytest.approx(60)
		assert figures["young_GPa"] == pytest.approx(30)
		assert figures["strain_at_peak"] == pytest.approx(0.002)
		assert figures["damage_at_peak"] == pytest.approx(0.2)
		assert figures["damage_at_end"] == pytest.approx(0.4)
		assert figures["energy_error"] == 3e-5
		assert figures["peak_passed"]
	# processor time of all, 0.9 s
	assert runs[0].summary()["ns_per_particle_step"] == pytest.approx(1e9 * 0.9 / 1000 / 200)
	assert runs[0].summary()["bytes_per_particle"] == 2500 and runs[1].summary()["bytes_per_particle"] is None
	assert runs[0].summary()["bonds"] == 361


def test_cost_ratios(runs):
	rigid, deformable = runs
	ratios = cost_ratios(runs)
	assert ratios["wall_s"] == pytest.approx(4)
	assert ratios["steps"] == pytest.approx(2)
	# without the recorder's half second
	seconds = (3.9 - 0.5) / 2000, 0.9 / 1000
	assert ratios["ns_per_particle_step"] == pytest.approx(
		seconds[0] / seconds[1] * rigid.particles / deformable.particles
	)
	assert cost_ratios(runs[:1]) == {}


def test_every_report_says_where_the_time_goes(runs, tmp_path):
	"""Of 1000 steps of 200 spheres bonds take 0.7 s and their motion 0.3 s."""
	rows = runs[0].summary()["engines"]
	assert [row["engine"] for row in rows] == ["interactions", "newton"]
	assert [row["ns_per_particle_step"] for row in rows] == pytest.approx([3500, 1500])
	assert [row["share"] for row in rows] == pytest.approx([0.7, 0.3])
	assert [name for name, _, _ in runs[0].engine_costs(least=0.5)] == ["interactions", "others"]
	made = report(runs, tmp_path, pictures=False)
	page = open(made.write(), encoding="utf-8").read()
	assert "Where the time goes" in page and "<th>interactions</th><td>3500</td><td>70.0 %</td>" in page
	assert "2\u202f500 bytes a sphere" in page and "bytes a triangle" not in page
	assert {row[0]: row[2] for row in made.table_rows() if row}["memory per particle"] == ["2\u202f500", "–"]


class Cost:
	"""Stands for an accuracy.section.Section."""
	points, columns, notes = {"rigid bonded spheres": []}, ["sample", "quantity", "error"], ["What is kept."]

	def sentences(self, title):
		return [f"{title} cost 3 s."]

	def rows(self, title):
		return [["4 mm", "strength", "3 %", "1 %"], ["8 mm", "strength", "it broke <down>"]]

	def plain(self):
		return {"rigid": {"points": []}}

	def figures(self):
		return {"cost_rigid": None}


def test_what_the_accuracy_cost_is_a_section(runs, tmp_path):
	made = report(runs, tmp_path, pictures=False, cost=Cost())
	page = open(made.write(), encoding="utf-8").read()
	for text in (
		"What this accuracy cost",
		"What is kept.",
		"rigid bonded spheres cost 3 s.",
		"broke &lt;down&gt;",
	):
		assert text in page
	with open(tmp_path / "summary.json") as file:
		assert json.load(file)["cost"] == {"rigid": {"points": []}}
	assert "What this accuracy cost" not in open(report(runs, tmp_path, pictures=False).write()).read()
	assert "cost" not in report(runs, tmp_path).summary()


def test_parts_of_the_energy_book(runs):
	rigid, deformable = runs
	assert rigid.energy("input")[-1] == pytest.approx(4) == rigid.energy_through
	assert rigid.energy("elastic")[-1] + rigid.energy("friction")[-1] == pytest.approx(4)
	assert deformable.energy("plastic flow")[-1] == pytest.approx(2.8)
	assert deformable.energy("friction") is None


def test_a_run_without_an_energy_book_draws_none(runs):
	kept, without = runs
	kinds = {name: unit for name, unit in without.series.units.items() if not name.startswith("energy_")}
	series = Series.of(kinds, **{name: without.series[name] for name in kinds})
	without = dataclasses.replace(without, series=series, energy_error=math.nan)
	assert math.isnan(without.energy_through) and without.summary()["energy_error"] is None
	assert energy([without]) is None and len(energy([kept, without]).axes) == 2


def test_files_and_page(runs, tmp_path):
	made = report(runs, tmp_path / "new" / "out")
	page = open(made.write(), encoding="utf-8").read()
	folder = tmp_path / "new" / "out"
	with open(folder / "summary.json") as file:
		summary = json.load(file)
	assert set(summary["models"]) == {"rigid", "deformable"}
	assert summary["options"]["seed"] == 7
	assert summary["cost_ratio_deformable_to_rigid"]["wall_s"] == pytest.approx(4)
	assert Series.read(folder / "rigid.csv")["stress"].max() == pytest.approx(60e6)
	for text in (
		"A title", "run it --so", "A note.", "bulk modulus &lt;of&gt; concrete", "seed 7", "60.0",
		"rigid bonded spheres", "deformable triangles"
	):
		assert text in page
	pictures = sorted(name for name in os.listdir(folder) if name.endswith(".png"))
	assert len(pictures) == 8 == page.count("data:image/png;base64,")
	for name in pictures:
		assert name in page
		width, _ = size_of_png(folder / name)
		assert round(width / 300 * 25.4) in (85, 175), name  # column or page at 300 dpi
	# self-contained: nothing is loaded from elsewhere
	assert not re.search(r"""(src|href)\s*=\s*["'](?!data:)|url\(|@import|<script|<link""", page)


@pytest.mark.parametrize("which", [0, 1])
def test_one_model_alone(runs, tmp_path, which):
	made = report(runs[which:which + 1], tmp_path)
	page = open(made.write(), encoding="utf-8").read()
	assert page.count("data:image/png;base64,") == 8
	assert runs[1 - which].title not in page
	assert made.summary()["cost_ratio_deformable_to_rigid"] == {}


def test_broken_bonds_have_a_picture_and_a_file(runs, tmp_path):
	rigid, deformable = runs
	rigid.broken, rigid.extra = broken(90), {"bonds": 361, "broken_in_tension": 60, "broken_in_shear": 30}
	made = report(runs, tmp_path / "both")
	page = open(made.write(), encoding="utf-8").read()
	assert page.count("data:image/png;base64,") == 9 and "rigid_broken_bonds.csv" in page
	assert (broken_bonds.read(tmp_path / "both" / "rigid_broken_bonds.csv") == rigid.broken).all()
	rows = {row[0]: row[2] for row in made.table_rows() if row}
	assert rows["bonds broken in tension"] == ["60", "–"] and rows["bonds broken in shear"] == ["30", "–"]
	made = report([deformable], tmp_path / "one")
	made.write()
	assert not {row[0] for row in made.table_rows() if row} & {"bonds at the start", "bonds broken in shear"}
	assert not (tmp_path / "one" / "broken_bonds.png").exists()


def test_tension_has_a_strength_of_its_own(runs, tmp_path):
	run = runs[0]
	run.test, run.wording = "tension", TENSION
	figures = run.summary()
	assert (figures["test"], figures["ucs_MPa"], figures["tensile_MPa"]) == ("tension", None, pytest.approx(60))
	made = report([run], tmp_path)
	page = open(made.write(), encoding="utf-8").read()
	assert "60.0 MPa in tension" in page and "moved apart" in page and "tension positive" in page
	assert "tensile strength" in made.table() and "UCS" not in made.table()


def test_without_pictures(runs, tmp_path):
	page = open(report(runs, tmp_path, pictures=False).write(), encoding="utf-8").read()
	assert "data:image" not in page
	assert "Figure" not in page
	assert not [name for name in os.listdir(tmp_path) if name.endswith(".png")]


def test_table_is_aligned_and_complete(runs, tmp_path):
	lines = report(runs, tmp_path).table().splitlines()
	assert len({len(line) for line in lines}) == 1
	strength = next(line for line in lines if line.startswith("strength (UCS) [MPa]"))
	assert strength.split()[-2:] == ["60.0", "60.0"]


def test_a_figure_that_does_not_exist_is_null_not_nan(runs, tmp_path):
	run = runs[0]
	coarse = Series(**run.series.units)
	for row in (0, 100, 200):
		coarse.append(**{name: run.series[name][row] for name in run.series.units})
	run.series = coarse
	made = report(runs, tmp_path)
	made.write()
	with open(tmp_path / "summary.json") as file:
		assert json.load(file)["models"]["rigid"]["young_GPa"] is None
	assert "–" in made.table()


def test_crack_traces_lie_across_the_bond():
	first, second = np.array([[0, 0, 0], [0, 0, 1], [0, 0, 0.0]]), np.array([[2, 0, 0], [0, 4, 2], [0, 0, 3.0]])
	traces = crack_traces(first, second, np.array([0.5, 1, 1]))
	assert traces[0].tolist() == [[1, -0.5], [1, 0.5]]
	assert sorted(traces[1].tolist()) == [[-1, 2], [1, 2]]
	assert traces[2].tolist() == [[0, 0], [0, 0]]  # in the plane of the picture: no trace


def size_of_png(path):
	with open(path, "rb") as file:
		head = file.read(24)
	return struct.unpack(">II", head[16:24])


def test_what_has_not_failed_has_no_strength():
	"""A straight line to its last record, 60 MPa: None in the summary, a dash in the table,
	unless it has yielded."""
	run = deformable_run()
	rising = Series(**run.series.units)
	for row in range(101):
		rising.append(**{**{name: run.series[name][row] for name in run.series.units}, "damage": 0.0})
	run = dataclasses.replace(run, series=rising)
	summary = run.summary()
	assert not run.has_strength and summary["ucs_MPa"] is None
	assert summary["young_GPa"] == pytest.approx(30) and summary["strain_at_peak"] == pytest.approx(0.002)
	report = Report([run], "out", "t")
	assert ("strength (UCS)", "MPa", ["–"]) in report.table_rows()
	assert "so that this is no strength" in report.html({})
	assert dataclasses.replace(run, yielded=True).summary()["ucs_MPa"] == pytest.approx(60)
