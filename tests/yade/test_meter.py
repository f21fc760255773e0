# GPL v2 or later, see LICENSE.
"""What counts as cost: the steps that YADE makes, however they are asked for."""
import builtins
import gc
import re

import pytest

from deformable_samples import elastic, skewed_mesh, start
from yade import BondedMat, O, PyRunner, ddem, utils
from yade.ddem import meter as meters
from yade.ddem.meter import (
	StepMeter, beside_the_scene, bytes_per_particle, heap, is_metered, line, particles, refined, unknowns
)


def test_steps_count_however_they_are_run():
	block = ddem.append(skewed_mesh(), elastic())
	start()
	count = len(block.triangle_ids)
	methods = O.run, O.step, O.wait
	with StepMeter() as meter:
		O.run(20, True)
		O.step()
		O.run(10)
		O.wait()
		ddem.run(steps=5, progress=False)
	assert meter.steps == O.iter == 36 and meter.particle_steps == 36 * count
	assert meter.particles == count and meter.unknowns == 3 * count + 2 * len(block.node_ids) and meter.dt == O.dt
	assert 0 < meter.ns_per_particle_step
	assert (O.run, O.step, O.wait) == methods
	O.run(3, True)
	assert meter.steps == 36


def test_what_lies_between_runs_does_not_count():
	ddem.append(skewed_mesh(), elastic())
	start()
	with StepMeter() as meter:
		O.run(20, True)
		before = meter.cpu_s, meter.wall_s
		sum(i * i for i in range(200_000))
		assert (meter.cpu_s, meter.wall_s) == before
	assert (meter.cpu_s, meter.wall_s) == before and before[0] > 0


def test_a_run_that_fails_counts_and_leaves_no_trace():
	ddem.append(skewed_mesh(), elastic())
	start()
	run = O.run
	with pytest.raises(KeyError):
		with StepMeter() as meter:
			O.run(7, True)
			raise KeyError
	assert meter.steps == 7 and O.run == run


def test_spheres_are_particles_where_there_are_no_triangles():
	O.bodies.append([utils.sphere((i, 0, 0), 0.1) for i in range(3)])
	assert particles() == 3 and unknowns() == 18


def test_engines_that_record_do_not_count(monkeypatch):
	"""YADE says that they have taken an hour of the run."""
	ddem.append(skewed_mesh(), elastic())
	start()
	recorder = PyRunner(command="pass", iterPeriod=1, label="recorder")
	O.engines = O.engines + [recorder]
	O.timingEnabled = True
	with StepMeter(apart=["recorder"]) as without:
		O.run(50, True)
		monkeypatch.setattr(without, "_of_others", lambda took: 3600.0 if O.iter > 60 else 0.0)
		half = without.cpu_s
		O.run(50, True)
	O.timingEnabled = False
	assert without.steps == 100 and without.cpu_s == half  # what is left of the second run is nothing


def test_what_a_recorder_waits_for_the_processor_is_no_time_of_it(monkeypatch):
	"""By clocks that go on for what is written here alone. In a step a recorder works for 3 s and waits for 2 s;
	all else takes 2.5 s of two threads, 1.5 s by the clock."""
	process, clock = [0.0], [0.0]
	monkeypatch.setattr(meters, "_now", lambda: (process[0], clock[0]))
	calls = []

	def step():
		calls.append(None)
		process[0], clock[0] = process[0] + 2.5, clock[0] + 1.5
		with meters.beside_the_steps():
			process[0], clock[0] = process[0] + 3, clock[0] + 5

	monkeypatch.setattr(builtins, "step_of_test", step, raising=False)
	ddem.append(skewed_mesh(), elastic())
	start()
	O.engines = O.engines + [PyRunner(command="step_of_test()", iterPeriod=1, label="recorder")]
	with StepMeter(apart=["recorder"]) as meter:
		O.run(50, True)
		process[0] += 7  # between runs
		O.run(50, True)
	assert meter.steps == 100 and len(calls) in (99, 100)  # YADE leaves out the first step of all
	assert meter.cpu_s == pytest.approx(2.5 * len(calls)) and meter.wall_s == pytest.approx(1.5 * len(calls))


def test_a_run_says_what_it_cost(capfd):
	block = ddem.append(skewed_mesh(), elastic())
	start()
	ddem.run(steps=20)
	said = capfd.readouterr().err.splitlines()[-1]
	counted = f"20 steps of {len(block.triangle_ids)} triangles: "
	assert re.fullmatch(counted + r"[\d.]+ ns a triangle-step, [\d.e-]+ s of processor time", said)
	ddem.run(steps=20, progress=False)
	assert not capfd.readouterr().err


def test_what_a_bar_says_is_refined_by_the_last_steps():
	"""After 3 s, a hundred steps of 1000 particles took 2 s of which 300 are left:
	20 µs a step and particle, 11 s."""
	assert refined(1000, 100, 2.0, 300, 3.0) == "20000 ns a sphere-step, 11 core-seconds in all"
	assert refined(1000, 0, 2.0, 300, 3.0) == refined(0, 100, 2.0, 300, 3.0) == ""


def test_the_bar_of_a_run_shows_it(monkeypatch, capsys):
	import tqdm
	shown = tqdm.tqdm
	monkeypatch.setattr(tqdm, "tqdm", lambda **options: shown(**{**options, "disable": False}))
	ddem.append(skewed_mesh(), elastic())
	start()
	ddem.run(steps=200)
	assert re.search(r"ns a triangle-step, \S+ core-seconds in all\]", capsys.readouterr().err)


def test_a_meter_within_another_counts_its_own_part():
	ddem.append(skewed_mesh(), elastic())
	start()
	methods = O.run, O.step, O.wait
	with StepMeter() as whole:
		O.run(3, True)
		with StepMeter() as part:
			O.run(4, True)
			O.step()
		assert is_metered()
		O.step()
	assert (part.steps, whole.steps) == (5, 9) and part.cpu_s <= whole.cpu_s
	assert (O.run, O.step, O.wait) == methods and not is_metered()


def test_a_metered_run_leaves_the_saying_to_the_meter(capfd):
	ddem.append(skewed_mesh(), elastic())
	start()
	with StepMeter():
		ddem.run(steps=5)
	assert "processor time" not in capfd.readouterr().err


def test_scenes_of_several_sizes_and_kinds_are_told_apart():
	few = len(ddem.append(skewed_mesh(), elastic()).triangle_ids)
	start()
	with StepMeter() as meter:
		O.run(10, True)
		O.reset()
		sample = ddem.append(ddem.mesh.rectangle(0.1, 0.1, size=0.01), elastic())
		start()
		O.step()
		O.step()
		O.reset()
		O.bodies.append([utils.sphere((i, 0, 0), 0.1) for i in range(3)])
		O.dt = 1e-9
		O.run(7, True)
	many = len(sample.triangle_ids)
	triangles, spheres = meter.told()
	assert triangles.startswith(f"12 steps of {few} to {many} triangles: ") and triangles.endswith("processor time")
	assert spheres.startswith("7 steps of 3 spheres: ")
	assert meter.particle_steps == 10 * few + 2 * many + 7 * 3 and meter.particles == many


def test_a_line_is_plain_arithmetic():
	said = line("sphere", 100, 2000, 5e-6, 10, 30)
	assert said == "100 steps of 10 to 30 spheres: 2.5 ns a sphere-step, 5e-06 s of processor time"


def test_engines_are_timed_where_yade_times_them():
	ddem.append(skewed_mesh(), elastic())
	start()
	O.engines = O.engines + [PyRunner(command="pass", iterPeriod=1, label="recorder")]
	with StepMeter(apart=["recorder"]) as meter:
		O.run(5, True)
		assert not meter.engines
		O.timingEnabled = True
		try:
			O.run(20, True)
			O.step()
		finally:
			O.timingEnabled = False
	assert meter.engines.keys() == {"ForceResetter", "DeformableEngine"}
	taken = next(engine.execTime for engine in O.engines if type(engine).__name__ == "DeformableEngine")
	assert meter.engines["DeformableEngine"] == pytest.approx(1e-9 * taken)
	figures = meter.figures()
	assert figures["engine:DeformableEngine"] == pytest.approx(taken / meter.particle_steps)
	assert figures["ns_per_particle_step"] == meter.ns_per_particle_step and figures["steps"] == 26


# ---- memory ----


def test_heap_counts_what_is_allocated():
	before = heap()
	kept = bytearray(50_000_000)
	assert heap() - before == pytest.approx(len(kept), rel=0.01)
	del kept
	assert abs(heap() - before) < 1e6


def sample(size):
	gc.collect()  # what other tests have left would be freed meanwhile
	return ddem.append(ddem.mesh.rectangle(0.1, 0.1, size=size), elastic())


def test_bytes_of_triangles_do_not_depend_on_their_number():
	"""And are no less than what a body with its state and shape must have, some hundred numbers."""
	found = []
	for size in (0.004, 0.002):
		O.reset()
		sample(size)
		start()
		O.step()
		found.append(bytes_per_particle())
	assert found[0] == pytest.approx(found[1], rel=0.1) and 800 < found[1] < 8000


def test_bytes_stay_those_of_the_first_step():
	sample(0.004)
	start()
	with beside_the_scene():
		kept = bytearray(20_000_000)
	O.step()
	found = bytes_per_particle()
	assert found < 8000  # the 20 MB would be more
	kept += bytearray(20_000_000)
	assert bytes_per_particle() == found == ddem.effects().bytes_per_particle
	assert f"memory: {found:.0f} bytes a triangle" in str(ddem.effects())
	assert {row["bytes_per_particle"] for row in ddem.effects().rows()} == {found}


def test_bytes_of_bonded_spheres_have_their_bonds():
	O.materials.append(BondedMat(label="rock"))
	gc.collect()
	spheres = ddem.packing.prism(0.02, 0.02, 0.02, 5e-4, 1e-3, seed=1, fails=200)
	made = ddem.bonded.append(spheres, "rock")
	O.engines = ddem.bonded.engines()
	O.dt = ddem.bonded.time_step(0.5)
	O.step()
	bonds = made.initial_bonds / len(made) * ddem.effects()["bonded"].bytes
	assert bonds < bytes_per_particle() < 20_000


def test_a_scene_made_by_other_means_has_no_bytes(tmp_path):
	assert bytes_per_particle() is None
	O.bodies.append([utils.sphere((i, 0, 0), 0.1) for i in range(3)])
	assert bytes_per_particle() is None
