# GPL v2 or later, see LICENSE.
"""ESyS-Particle as a peer: what it is given, how it is run, what is read back, how two records are compared. None of
these tests needs that program; the live comparison is in tests/yade/test_compare_esys.py."""
import json
import math
import os
import textwrap

import numpy as np
import pytest
from ddem.packing import Packing
from ddem.studies import esys
from ddem.studies.esys import comparison, compression


@pytest.fixture
def setup():
	"""Three touching spheres in a row, in a box of 10 mm x 20 mm x 10 mm;
	the other values are those of ESyS-Particle's tutorial."""
	packing = Packing(
		[[5e-3, 4e-3, 0], [5e-3, 7e-3, 0], [5e-3, 9.5e-3, 0]], [2e-3, 1e-3, 1.5e-3], (0, 0, -5e-3),
		(10e-3, 20e-3, 5e-3), bonds=[[0, 1], [1, 2]]
	)
	return esys.Setup(packing, dt=1e-8, steps=20, every=5, ramp_steps=5000)


# ---- what it is given ----


def test_parameters_are_those_of_the_tutorial_in_its_units(setup):
	given = esys.parameters(setup, workers=2)
	# rot_compress.py of the tutorial; mm, N, ms, so MPa and g/mm³
	tutorial = {
		"walls": [0, 20], "dt": 1e-5, "speed": 0.125, "wall_stiffness": 1e5, "young": 1e5, "poisson": 0.25,
		"cohesion": 100, "bond_friction": 1,
		"friction_static": 0.6, "friction_dynamic": 0.4, "viscosity": 0.002, "density": 1, "grid_spacing": 5,
		"verlet_distance": 0.08
	}
	assert {name: given[name] for name in tutorial} == {
		name: pytest.approx(value, rel=1e-12) for name, value in tutorial.items()
	}
	assert (given["steps"], given["every"], given["ramp_steps"], given["workers"], given["mass_law"]) == (
		20, 5, 5000, 2, "cube"
	)


def test_domain_has_room_around_the_sample_and_is_halved_in_its_middle(setup):
	lower, upper = np.array(esys.parameters(setup)["domain"])
	np.testing.assert_allclose(0.5 * (lower + upper), [5, 10, 0])
	assert (lower <= [-10, -20, -15]).all() and (upper >= [20, 40, 15]).all()


def test_files_are_read_as_they_were_written(setup, tmp_path):
	(tmp_path / "force.dat").write_text("of an earlier run: ESyS-Particle would append to it")
	esys.write_input(setup, tmp_path)
	assert not (tmp_path / "force.dat").exists()
	assert compression.rows(tmp_path / "bonds.csv", "ij", (int, int)) == [(0, 1), (1, 2)]
	spheres = compression.rows(tmp_path / "particles.csv", "id x y z r".split(), (int, float, float, float, float))
	assert [sphere[0] for sphere in spheres] == [0, 1, 2]
	np.testing.assert_allclose(
		[sphere[1:] for sphere in spheres], [[5, 4, 0, 2], [5, 7, 0, 1], [5, 9.5, 0, 1.5]], rtol=1e-15
	)
	assert json.loads((tmp_path / "parameters.json").read_text()) == esys.parameters(setup)


def test_walls_move_as_in_a_recorded_run():
	# Bottom wall [mm] after 5, 10, 15 and 25000 steps of a run with ESyS-Particle's own WallLoader:
	# 0.125 m/s, 1e-5 ms, ramp of 5000 steps.
	places = np.cumsum([compression.ramped_step(step, 0.125, 1e-5, 5000) for step in range(1, 25001)])
	np.testing.assert_allclose(places[[4, 9, 14, 24999]], [2.5e-9, 1.125e-8, 2.625e-8, 0.028124375], rtol=1e-9)
	assert compression.ramped_step(1, 0.125, 1e-5, 0) == 0.125 * 1e-5


def test_mass_laws():
	assert compression.mass(2.0, 3.0, "cube") == 24.0
	assert compression.mass(2.0, 3.0, "solid") == pytest.approx(32 * math.pi)


@pytest.mark.parametrize(
	"change, message",
	[
		({"steps": 21}, "steps = 21 must be a multiple of every = 5"),
		({"mass_law": "hollow"}, "mass_law = 'hollow' must be cube or solid"),
		({"dt": 0.0}, r"dt = 0.0 s"),
	],
)
def test_wrong_setups_are_refused(setup, change, message):
	with pytest.raises(ValueError, match=message):
		esys.Setup(**{**vars(setup), **change})


def test_setup_without_bonds_is_refused(setup):
	with pytest.raises(ValueError, match="this packing has no bonds"):
		esys.Setup(Packing(setup.packing.centres, setup.packing.radii), dt=1e-8, steps=5)


# ---- how it is run ----

FORCES = [0, 1, 2, 4, 3]  # of each wall [N] at the five records
BONDS = [2, 2, 2, 1, 1]


def leave_output(folder):
	rows = range(5)
	(folder / "position.dat").write_text("".join(f"0 {0.1 * k} 0  0 {20 - 0.1 * k} 0  \n" for k in rows))
	# the top wall pushes down, by 1 N more
	(folder / "force.dat").write_text("".join(f"0.5 {FORCES[k]} 0  0 {-FORCES[k] - 1} 0.5  \n" for k in rows))
	(folder / "bonds.dat").write_text("".join(f"{count:.10e}\n" for count in BONDS))
	(folder / "finished.json").write_text('{"pieces": [1.2e-5, 1.5e-5, 1.5e-5, 1.5e-5]}')


@pytest.fixture
def programs(tmp_path, monkeypatch):
	"""Stand-ins for mpirun and esysparticle: make(text) writes the former as a shell script."""
	folder = tmp_path / "bin"
	folder.mkdir()
	monkeypatch.setenv("PATH", str(folder), prepend=os.pathsep)

	def make(text):
		for name in ("mpirun", "esysparticle"):
			(folder / name).write_text("#!/bin/sh\n" + textwrap.dedent(text))
			(folder / name).chmod(0o755)

	return make


def test_run(setup, tmp_path, programs):
	programs(
		f"""
		echo "$@" > arguments.txt
		test -f particles.csv -a -f parameters.json || exit 9
		echo "constructing FieldMaster"; echo "step 10"; echo "step 20"
		cp {tmp_path}/left/* .
		"""
	)
	(tmp_path / "left").mkdir()
	leave_output(tmp_path / "left")
	seen = []
	record = esys.run(setup, tmp_path / "run", workers=2, progress=seen.append)
	assert seen == [10, 20]
	arguments = (tmp_path / "run" / "arguments.txt").read_text().split()
	assert arguments[arguments.index("-n") + 1] == "3"  # a master and two workers
	assert arguments[-1] == compression.__file__
	assert (record.program, record.threads) == ("ESyS-Particle", 2)
	# 57 µs for 19 steps of 3 spheres
	assert record.nanoseconds == pytest.approx(1000)
	np.testing.assert_allclose(record.series["time"], [0, 5e-8, 1e-7, 1.5e-7, 2e-7])
	np.testing.assert_allclose(record.series["strain"], [0, 0.01, 0.02, 0.03, 0.04], atol=1e-12)
	np.testing.assert_allclose(record.series["force_bottom"], FORCES)
	np.testing.assert_allclose(record.series["force_top"], np.array(FORCES) + 1)
	np.testing.assert_allclose(record.series["stress"], (np.array(FORCES) + 0.5) / 1e-4)  # on 10 mm x 10 mm
	assert record.broken_share.tolist() == [0, 0, 0, 0.5, 0.5]


def test_failure_is_told_in_its_own_words(setup, tmp_path, programs):
	programs("echo 'ValueError: something is wrong' >&2; exit 3")
	with pytest.raises(RuntimeError, match=r"(?s)exit code 3.*something is wrong"):
		esys.run(setup, tmp_path / "run")


def test_run_that_ends_early_is_no_success(setup, tmp_path, programs):
	programs("echo 'good bye'")
	with pytest.raises(RuntimeError, match="good bye"):
		esys.run(setup, tmp_path / "run")


def test_interrupted_run_leaves_no_process(setup, tmp_path, programs):
	programs("echo $$ > process; echo step 1; exec sleep infinity")

	def interrupt(step):
		raise KeyboardInterrupt

	with pytest.raises(KeyboardInterrupt):
		esys.run(setup, tmp_path / "run", progress=interrupt)
	with pytest.raises(ProcessLookupError):
		os.kill(int((tmp_path / "run" / "process").read_text()), 0)


def test_missing_program_is_named_with_the_way_out(setup, tmp_path, monkeypatch):
	monkeypatch.setenv("PATH", str(tmp_path))
	with pytest.raises(RuntimeError, match="apt-get install esys-particle"):
		esys.run(setup, tmp_path / "run")
	assert not (tmp_path / "run").exists()


def test_incomplete_output_is_refused(setup, tmp_path):
	leave_output(tmp_path)
	(tmp_path / "bonds.dat").write_text("2\n2\n")
	with pytest.raises(ValueError, match=r"bonds\.dat: 2 rows of 1 numbers instead of 5 of 1"):
		esys.read_output(setup, tmp_path)


# ---- comparison ----


def record_of(setup, program, stress, broken, seconds=1.0, interval=5e-8):
	"""A record with a strain that grows by 1e-4 a row; stress in MPa."""
	record = esys.Record(program, setup, pieces=[0.25 * seconds, 0.75 * seconds])
	for row, (value, count) in enumerate(zip(stress, broken)):
		record.series.append(
			time=row * interval, strain=1e-4 * row, stress=1e6 * value, force_top=100 * value,
			force_bottom=100 * value, broken=count
		)
	return record


@pytest.fixture
def pair(setup):
	"""Two tests of 100 MPa/1 % stiffness, peak at 1 MPa; the second differs by 1e-4 MPa at 50 %, by 0.01 MPa at
	80 %, and in its peak by 0.1 MPa."""
	stress = np.concatenate([np.linspace(0, 1, 11), [0.5, 0.3]])
	other = stress.copy()
	other[[5, 8, 10]] += [1e-4, 0.01, 0.1]
	broken = np.where(np.arange(13) > 9, 1, 0)
	return record_of(setup, "first", stress, broken, 2.0), record_of(setup, "second", other, broken, 0.5)


def test_repeats_count_where_they_were_fastest(pair):
	first, second = pair
	first.pieces, second.pieces = [1.0, 5.0, 2.0], [3.0, 1.5, 2.5]
	best = esys.undisturbed([first, second])
	assert best.pieces == [1.0, 1.5, 2.0] and best.seconds == 4.5
	assert (best.program, best.series) == ("first", first.series)


def test_figures(pair):
	figures = comparison.figures(pair[0])
	assert figures["ucs_MPa"] == pytest.approx(1.0)
	assert figures["young_GPa"] == pytest.approx(1.0)
	assert figures["strain_at_peak_percent"] == pytest.approx(0.1)
	assert (figures["broken_at_peak_percent"], figures["broken_at_end_percent"], figures["peak_passed"]) == (
		50,
		50,
		True,
	)
	assert figures["ns_per_particle_step"] == pytest.approx(2e9 / 19 / 3)
	assert figures["ns_per_bond_step"] == pytest.approx(2e9 / 19 / 2)
	assert figures["bytes_per_particle"] is None
	pair[1].engines = [("interactions", 80.0, 0.8), ("newton", 20.0, 0.2)]
	rows = [line.split() for line in comparison.table(*pair).splitlines()]
	assert ["interactions", "80", "ns", "80.0", "%"] in rows and ["newton", "20", "ns", "20.0", "%"] in rows


def test_differences(pair):
	apart = comparison.differences(*pair)
	assert apart["stress_MPa"] == pytest.approx(1e-4)  # up to 60 %
	assert apart["equal_up_to_percent"] == pytest.approx(70)  # the row before the one that departs by 0.01 MPa
	assert comparison.differences(pair[0], pair[0]) == {"stress_MPa": 0.0, "equal_up_to_percent": 100.0}


def test_records_of_other_times_are_refused(setup):
	stress, broken = [0, 1, 2, 3], [0, 0, 0, 0]
	with pytest.raises(ValueError, match="not taken at the same times"):
		comparison.differences(
			record_of(setup, "first", stress, broken),
			record_of(setup, "second", stress, broken, interval=6e-8),
		)


def test_table_says_what_differs_and_who_is_faster(pair):
	text = comparison.table(*pair)
	row = next(line for line in text.splitlines() if line.startswith("strength"))
	assert row.split()[2:] == ["MPa", "1.00", "1.10", "+10", "%"]
	assert "second takes 0.25 of the time of first" in text
	assert "up to 60 % of the peak: 1.0e-04 MPa; below 1e-3 MPa up to 70 %" in text


def test_picture_shows_both(pair, tmp_path):
	figure = comparison.picture(*pair)
	above, middle, below = figure.axes
	assert [line.get_label() for line in above.lines] == ["first", "second"]
	np.testing.assert_allclose(above.lines[1].get_ydata()[10], 1.1)
	assert (
		all(unit in axes.get_ylabel() for axes, unit in zip(figure.axes, ("[MPa]", "[%]", "[MPa]")))
		and "[%]" in below.get_xlabel()
	)
