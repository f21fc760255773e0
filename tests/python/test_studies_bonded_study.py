# GPL v2 or later, see LICENSE.
"""The study of bonded spheres from runs that were computed by hand: spreads, claims, files, pictures."""
import csv
import json
import os
import re
import struct

import numpy as np
import pytest
from ddem import broken_bonds
from ddem.reports import bonded_study as report
from ddem.series import Series
from ddem.studies import bonded_study
from ddem.studies.bonded_study import Group, Record, Spread, change, claims

AREA, HEIGHT, END = 1e-4, 0.02, 2.5e-4
BONDS = 200


def folder(path, strength, top=1.0):
	"""What scripts/ucs_bonded.py leaves: stress up to *strength* [MPa] at 0.2 ms, then down to half of it at
	0.25 ms; the top wall feels *top* times the force of the bottom wall; 20 of 200 bonds have broken by the peak,
	80 by the end."""
	os.makedirs(path)
	series = Series(time="s", strain="-", stress="Pa", force_top="N", force_bottom="N", damage="-")
	for time in np.linspace(END / 500, END, 500):
		stress = 1e6 * strength * (time / 2e-4 if time <= 2e-4 else 1 - (time - 2e-4) / 1e-4)
		bottom = 2 * AREA * stress / (1 + top)
		series.append(
			time=time, strain=0.01 * time / 2e-4, stress=stress, force_top=top * bottom,
			force_bottom=bottom, damage=0.0
		)
	series.write(path / "rigid.csv")
	broken = np.zeros(80, broken_bonds.DTYPE)
	broken["mode"], broken["time"] = (
		"tension",
		np.concatenate([np.linspace(1e-4, 1.9e-4, 20), np.linspace(2.01e-4, 2.4e-4, 60)]),
	)
	broken_bonds.write(broken, path / "rigid_broken_bonds.csv")
	figures = {
		"particles": 50, "bonds": BONDS, "ucs_MPa": strength, "young_GPa": strength / 1.5,
		"strain_at_peak": 0.01, "damage_at_peak": 0.1, "damage_at_end": 0.4,
		"dt_s": 5e-7, "steps": 500, "cpu_s": 3.0, "wave_speed_m_s": 800.0, "ns_per_particle_step": 80.0,
		"bytes_per_particle": 7000.0
	}
	with open(path / "summary.json", "w") as file:
		json.dump({"options": {"velocity": 0.125, "seed": 1}, "models": {"rigid": figures}}, file)
	return Record(str(path))


@pytest.fixture
def group(tmp_path):
	"""A group of runs of these strengths."""

	def make(strengths, radii=(0.4e-3, 2e-3), stiffness=100e9, kind="paper", top=1.0):
		name = f"{kind}-{radii[0]:g}-{stiffness:g}".replace(" ", "_")
		return Group(
			name,
			name,
			radii,
			stiffness,
			kind,
			[folder(tmp_path / f"{name}-{row}", strength, top) for row, strength in enumerate(strengths)],
		)

	return make


def test_figures_of_a_run(group):
	figures = group([150.0], top=1.25).records[0].figures()
	assert figures["force_bottom_kN"] == pytest.approx(2 * AREA * 150e6 / 2.25 / 1e3)
	assert figures["force_top_kN"] == pytest.approx(1.25 * figures["force_bottom_kN"])
	assert figures["time_top_ms"] == pytest.approx(0.2)
	assert (figures["broken_at_peak_percent"], figures["broken_at_end_percent"]) == (10, 40)


def test_spread_over_packings(group):
	some = group([100.0, 130.0, 190.0])
	assert (some.spread("ucs_MPa").median, some.spread("ucs_MPa").low, some.spread("ucs_MPa").high) == (
		130,
		100,
		190,
	)
	assert some.spread("ucs_MPa").text("{:.0f}") == "130 (100–190)"
	assert Spread.of([-1.0, 2.0]).text("{:+.0f}") == "+0 (−1 to +2)"
	assert Spread.of([7.0]).text("{:.1f}") == "7.0"
	curve = some.curve("stress", np.array([1e-4, 2e-4]))
	np.testing.assert_allclose(curve.median, [65e6, 130e6], rtol=1e-9)
	np.testing.assert_allclose(curve.high, [95e6, 190e6], rtol=1e-9)
	np.testing.assert_array_equal(some.curve("broken_percent", np.array([0, 1.95e-4, END])).median, [0, 10, 40])


def test_curves_file(group, tmp_path):
	some = group([100.0, 130.0, 190.0])
	bonded_study.write_curves(some, tmp_path / "curves.csv")
	series = Series.read(tmp_path / "curves.csv")
	assert series.last("time") == pytest.approx(END)
	row = int(np.argmin(abs(series["time"] - 2e-4)))
	assert (series["stress_low"][row], series["stress_high"][row]) == (pytest.approx(100e6), pytest.approx(190e6))
	assert series["broken_percent_median"][-1] == 40
	assert series["strain_low"][row] == series["strain_high"][row] == pytest.approx(0.01)


def test_claims_stand_beside_what_was_measured(group):
	groups = [
		group([200.0, 240.0, 260.0], top=1.25), group([100.0, 110.0, 120.0], radii=(0.8e-3, 4e-3)),
		group([220.0, 264.0, 286.0], stiffness=102e9, top=1.25),
		group([100.0, 110.0, 120.0], radii=(0.8e-3, 4e-3), stiffness=102e9)
	]
	found = {claim.about: claim for claim in claims(groups)}
	assert found["strength (UCS)"].paper == "180–300 MPa"
	assert found["strength (UCS)"].here == "160 (100–286) MPa"
	assert (
		found["strength (UCS)"].remark
		== "by eq. 9, partly inside; divided by A 320 (200–572) MPa, partly inside"
	)
	assert found["Young's modulus"].here == "107 (67–191) GPa"
	assert found["bonds broken at the peak"].here == "10 %" and found["bonds broken after the peak"].here == "40 %"
	assert found["largest force on the bottom wall"].here == "20000"  # 0.2 ms in records of 10 ns
	assert found["the same, over that on the bottom wall"].here == "+12.5 (+0.0 to +25.0) %"
	assert found["walls 2 % stiffer"].here == "0.4–2.0 mm: +10.0 %, +10.0 %; 0.8–4.0 mm: +0.0 %, +0.0 %"
	assert found["wave speed over that of a wall"].here == "6400"


@pytest.mark.parametrize(
	"values, place",
	[([200, 280], "inside"), ([100, 170], "below"), ([310, 320], "above"), ([170, 190], "partly inside")],
)
def test_place_in_the_claimed_range(values, place):
	assert bonded_study.place(Spread.of(values), bonded_study.UCS_CLAIMED) == place


def test_change_is_taken_packing_by_packing(group):
	base, other = group([100.0, 200.0, 300.0]), group([80.0, 190.0, 300.0], kind="rock density")
	spread = change(other, base, "ucs_MPa")
	assert (spread.low, spread.median, spread.high) == (pytest.approx(-0.2), pytest.approx(-0.05), pytest.approx(0))


def test_page_and_files(group, tmp_path):
	groups = [
		group([200.0, 240.0, 260.0]), group([210.0, 240.0, 260.0], stiffness=102e9),
		group([160.0, 192.0, 208.0], kind="rock density"),
		group([180.0, 216.0, 234.0], kind="consistent bonds"), group([148.85], kind="sample of ESyS-Particle"),
		group([125.0], kind="sample of ESyS-Particle, rock density")
	]
	out = tmp_path / "out"
	path = report.write(
		groups, str(out), "run it", {"quick": False}, {"YADE": "1"}, [("walls", "0.125 m/s", "speed")]
	)
	page = open(path, encoding="utf-8").read().replace("\u00a0", " ")
	assert page.count("data:image/png;base64,") == 5
	# nothing is loaded from elsewhere
	assert not re.search(r"""(src|href)\s*=\s*["'](?!data:)|url\(|@import|<script|<link""", page)
	for text in (
		"240 (200–260) MPa for 0.4–2.0 mm", "the strength changes by −20.0 %",
		"in ESyS-Particle itself by −16 %", "the bonds here give 148.8 MPa", "run it", "likely twice"
	):
		assert text in page, text
	for name in ("broken_bonds", "force_bottom", "force_top", "stress_strain", "influences"):
		with open(out / f"{name}.png", "rb") as file:
			head = file.read(24)
		assert round(struct.unpack(">II", head[16:24])[0] / 300 * 25.4) == (85 if name == "influences" else 175)
	with open(out / "study.json") as file:
		study = json.load(file)
	assert study["groups"][0]["spread"]["ucs_MPa"] == {"median": 240, "smallest": 200, "largest": 260}
	assert [run["ucs_MPa"] for run in study["groups"][0]["runs"]] == [200, 240, 260]
	assert {claim["about"] for claim in study["claims"]} == {claim.about for claim in claims(groups)}
	with open(out / "runs.csv", newline="") as file:
		rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
	assert study["readings"] == [
		[groups[0].label, "inside", "inside", "above", "above"],
		[groups[4].label, "below", "below", "inside", "above"],
	]
	assert len(rows) == 14 and float(rows[1]["ucs_MPa [MPa]"]) == 240
	assert len([name for name in os.listdir(out) if name.startswith("curves_")]) == len(groups)
	lines = report.table(groups).splitlines()
	assert len(lines) == 2 + len(groups) and len({len(line) for line in lines}) == 1


def test_effects_of_the_first_run_are_on_the_page(group, tmp_path):
	one = group([200.0, 210.0])
	row = {
		"group": "bonded spheres", "particle": "bond", "count": 200, "group_bytes": 0, "cost": "",
		"effect": "torsion", "state": "idle", "why": "part of every bond", "bytes": 0,
		"measured": "a share of 1e-6"
	}
	one.records[0].summary["effects"] = [row]
	path = report.write([one], str(tmp_path / "out"), "run it", {}, {}, [], pictures=False)
	page = open(path, encoding="utf-8").read()
	assert f"Of the first run, {one.label}." in page
	assert "part of every bond. <i>a share of 1e-6: changed nothing</i>" in page
	with open(tmp_path / "out" / "study.json", encoding="utf-8") as file:
		assert json.load(file)["effects"] == [row]


def test_cost_is_in_every_table_and_the_first_run_s_engines_on_the_page(group, tmp_path):
	one = group([200.0, 210.0])
	one.records[0].summary["engines"] = [{"engine": "interactions", "ns_per_particle_step": 60.0, "share": 0.75}]
	path = report.write([one], str(tmp_path / "out"), "run it", {}, {}, [], pictures=False)
	page = open(path, encoding="utf-8").read()
	assert "<th>interactions</th><td>60</td><td>75.0 %</td>" in page and "a sphere [B]" in page
	with open(tmp_path / "out" / "study.json", encoding="utf-8") as file:
		runs = json.load(file)["groups"][0]["runs"]
	assert [(run["ns_per_particle_step"], run["bytes_per_particle"]) for run in runs] == [(80, 7000)] * 2
	assert "7000" in report.table([one])
	one.records[1].summary.pop("bytes_per_particle")  # of a version that did not say so
	assert "–" in report.table([one])


def test_page_of_a_few_runs_without_pictures(group, tmp_path):
	page = open(
		report.write([group([200.0])], str(tmp_path / "out"), "run it", {}, {}, [], pictures=False),
		encoding="utf-8",
	).read()
	assert "data:image" not in page and "Figure 1" not in page and "What else decides" not in page
