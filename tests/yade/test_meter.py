# GPL v2 or later, see LICENSE.
"""What counts as cost: the steps that YADE makes, however they are asked for."""
import builtins
import re

import pytest

from deformable_samples import elastic, skewed_mesh, start
from yade import O, PyRunner, ddem, utils
from yade.ddem import meter as meters
from yade.ddem.meter import StepMeter, particles, refined, unknowns


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
		monkeypatch.setattr(without, "_of_others", lambda: 3600.0 if O.iter > 60 else 0.0)
		half = without.cpu_s
		O.run(50, True)
	O.timingEnabled = False
	assert without.steps == 100 and without.cpu_s == half  # what is left of the second run is nothing


def test_what_a_recorder_waits_for_the_processor_is_no_time_of_it(monkeypatch):
	"""By clocks that go on for what is written here alone. In a step a recorder works for 3 s and waits for 2 s;
	calling it takes half a second more, as YADE says, and all else 1 s of two threads."""
	process, thread, clock = [0.0], [0.0], [0.0]
	monkeypatch.setattr(meters, "_now", lambda: (process[0], thread[0], clock[0]))

	@meters.recording()
	def record():
		process[0], thread[0], clock[0] = process[0] + 3, thread[0] + 3, clock[0] + 5

	def step():
		process[0], clock[0] = process[0] + 2.5, clock[0] + 1.5
		record()

	monkeypatch.setattr(builtins, "step_of_test", step, raising=False)
	ddem.append(skewed_mesh(), elastic())
	start()
	O.engines = O.engines + [PyRunner(command="step_of_test()", iterPeriod=1)]
	with StepMeter(apart=["recorder"]) as meter:
		monkeypatch.setattr(meter, "_of_others", lambda: 5.5 * thread[0] / 3)
		O.run(50, True)
		process[0] += 7  # between runs
		O.run(50, True)
	calls = thread[0] / 3
	assert calls in (99, 100) and meter.steps == 100  # YADE leaves out the first step of all
	assert meter.cpu_s == pytest.approx(2 * calls) and meter.wall_s == pytest.approx(calls)


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
