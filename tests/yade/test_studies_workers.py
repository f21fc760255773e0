# GPL v2 or later, see LICENSE.
"""Workers of Dask: of this machine and of a real scheduler with real workers; what is killed, stopped and refused."""
import concurrent.futures
import json
import os
import signal
import subprocess
import sys

import pytest
from distributed import Client

from yade.ddem.studies import questions, workers, yade_process
from yade.ddem.studies.evaluations import Bench, EvaluationError, Lost
from yade.ddem.studies.virtualtest import SeparateYade, Setup
from yade.ddem.studies.workers import Workers

from waiting import until

BLOCK = Setup.standard("deformable", "block", size=0.025, velocity=4.0)
COMPRESSION = {"test": "compression", "seed": 1}


def program(folder, text):
	"""A program in place of YADE, called with -n -x -j1 SCRIPT MODULE REQUEST ANSWER."""
	path = folder / "yade"
	path.write_text(f"#!/bin/sh\nshift 4; request=$2; answer=$3\n{text}\n")
	path.chmod(0o755)
	return str(path)


def says(found, by="null"):
	"""What such a program does to give an answer."""
	answer = json.dumps({"measured": found, "error": None, "by": "BY"}).replace('"BY"', by)
	return f"echo '{answer}' > $answer"


def physics(measured):
	"""What was measured, without what it cost."""
	return {name: measured[name] for name in ("young", "ucs", "strain_at_peak", "damage_at_peak", "energy_error")}


def gone(pid):
	return not os.path.exists(f"/proc/{pid}")


def number(path):
	return path.exists() and path.read_text().strip()


def test_functions_come_back_from_processes_of_their_own():
	with Workers(jobs=2) as work:
		asked = [work.submit(os.getpid) for _ in range(8)]
		found = {future.result() for future in asked}
		processes = set(work.workers.values())
	assert found <= processes and len(processes) == 2 and os.getpid() not in processes
	until(lambda: all(map(gone, processes)))


def test_nothing_is_started_where_nothing_is_submitted():
	with Workers(jobs=2) as work:
		assert work.workers == {}


def test_what_a_function_raises_is_raised_here():
	with Workers() as work:
		with pytest.raises(ZeroDivisionError):
			work.submit(divmod, 1, 0).result()
		assert work.submit(divmod, 7, 2).result() == (3, 1)


def test_evaluations_of_real_yades_at_the_same_time_are_those_of_one_after_another(tmp_path):
	found = {}
	points = [{"strength": 120e6}, {"strength": 100e6}]
	for name, work in (("two", Workers(jobs=2)), ("one", None)):
		evaluate = SeparateYade(BLOCK, {"young": 60e9}, workers=work)
		with Bench(evaluate, [COMPRESSION], evaluate.settings(), tmp_path / name) as bench:
			found[name] = [(physics(point.measured), point.error) for point in bench.measure(points)]
		if work:
			work.close()
	assert found["two"] == found["one"]
	assert found["one"][0][0]["ucs"] > found["one"][1][0]["ucs"] > 10e6
	# the second start asks nobody, although it has other workers
	work = Workers(jobs=3)
	evaluate = SeparateYade(BLOCK, {"young": 60e9}, workers=work)
	with Bench(evaluate, [COMPRESSION], evaluate.settings(), tmp_path / "one") as bench:
		bench.measure(points)
	assert bench.ran == 0 and work.workers == {}


def test_a_killed_worker_loses_nothing(tmp_path):
	"""The evaluation that its worker was at is made by another; those that were made are not made again."""
	made = tmp_path / "made"
	yade = program(
		tmp_path,
		f"""echo . >> {made}
		grep -q '"x": 2' $request && mkdir {tmp_path}/tried \
			&& {{ echo $PPID > {tmp_path}/victim; exec sleep infinity; }}
		{says({"y": 1.0})}""",
	)
	with Workers(jobs=2) as work:
		evaluate = questions.Questions("any", work, yade)
		with Bench(evaluate_of(evaluate), path=tmp_path / "e") as bench:
			with concurrent.futures.ThreadPoolExecutor() as pool:
				waiting = pool.submit(bench.measure, [{"x": x} for x in (1, 2, 3, 4)])
				os.kill(int(until(lambda: number(tmp_path / "victim"))), signal.SIGKILL)
				found = waiting.result()
	assert [point.error for point in found] == [None] * 4
	assert len(made.read_text().split()) == 5
	assert len((tmp_path / "e").read_text().splitlines()) == 4


def evaluate_of(asked):
	"""For a Bench: sends its values as the request."""

	class Evaluate:
		stop = asked.stop

		def submit(self, values, case):
			return asked.submit(values)

	return Evaluate()


def test_stop_ends_what_is_running_and_starts_nothing_more(tmp_path):
	yade = program(tmp_path, f"echo $$ > {tmp_path}/running; exec sleep infinity")
	work = Workers()
	asked = questions.Questions("any", work, yade)
	asked.submit({})
	running = until(lambda: number(tmp_path / "running"))
	asked.stop()
	until(lambda: gone(running))
	with pytest.raises(EvaluationError, match="told to stop"):
		asked.submit({})


@pytest.mark.slow  # a worker without a scheduler waits for half a minute
def test_workers_end_with_a_process_that_is_killed(tmp_path):
	yade = program(tmp_path, f"echo $$ > {tmp_path}/running; exec sleep infinity")
	script = tmp_path / "client.py"
	script.write_text(
		"from yade.ddem.studies import questions, workers\n"
		"work = workers.Workers()\n"
		f"asked = questions.Questions('any', work, {yade!r})\n"
		"future = asked.submit({})\n"
		f"print(*work.workers.values(), file=open({str(tmp_path / 'worker')!r}, 'w'), flush=True)\n"
		"future.result()\n"
	)
	client = subprocess.Popen([yade_process.running(), "-n", "-x", script], stdin=subprocess.DEVNULL)
	pids = [until(lambda: number(tmp_path / name)) for name in ("running", "worker")]
	client.kill()
	client.wait()
	until(lambda: all(map(gone, pids)))


@pytest.mark.parametrize("name, there", [("plugin", "000000000000"), ("yade", "1970.01")])
def test_results_of_another_plugin_or_yade_are_refused(tmp_path, name, there):
	by = json.dumps({**yade_process.identity(), "node": "node7", name: there})
	asked = questions.Questions("any", yade=program(tmp_path, says({"y": 1.0}, by)))
	with pytest.raises(EvaluationError, match=f"worker on node7 has {name} {there} .* not mixed"):
		asked.ask({})


# ---- a cluster: a scheduler and workers that somebody else has started ----


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
	"""Address of a scheduler with workers of one thread each, started as the manual says: two on one address of
	this machine, one on another."""
	folder = tmp_path_factory.mktemp("cluster")
	log = open(folder / "log", "wb")
	start = lambda *arguments: subprocess.Popen(
		[sys.executable, "-m", "dask", *arguments], stdout=log, stderr=subprocess.STDOUT, start_new_session=True
	)
	place = folder / "scheduler.json"
	scheduler = start("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard",
		"--scheduler-file", str(place))
	until(place.exists)
	address = json.loads(until(lambda: place.read_text()))["address"]
	options = ("--nthreads", "1", "--no-dashboard", "--memory-limit", "0", address)
	nannies = [
		start("worker", "--host", "127.0.0.1", "--nworkers", "2", *options),
		start("worker", "--host", "127.0.0.2", *options)
	]
	with Client(address) as client:
		client.wait_for_workers(3)
	yield address
	for process in (*nannies, scheduler):
		process.terminate()
		process.wait()
	log.close()


def test_a_cluster_gives_what_this_machine_gives(cluster):
	with Workers(cluster=cluster) as work:
		assert work.others == [] and work.machine == Workers().machine
		there = (
			SeparateYade(BLOCK, {"young": 60e9}, workers=work)
			.submit({"strength": 120e6}, COMPRESSION)
			.result()
		)
	here = SeparateYade(BLOCK, {"young": 60e9}).submit({"strength": 120e6}, COMPRESSION).result()
	assert physics(there) == physics(here)


def test_stop_ends_only_what_is_one_s_own_on_a_cluster(cluster, tmp_path):
	running = {}
	for name in ("mine", "other"):
		(tmp_path / name).mkdir()
		yade = program(tmp_path / name, f"echo $$ > {tmp_path}/{name}/running; exec sleep infinity")
		work = Workers(cluster=cluster)
		running[name] = work, questions.Questions("any", work, yade)
		running[name][1].submit({})
	pids = {name: until(lambda n=name: number(tmp_path / n / "running")) for name in running}
	running["mine"][1].stop()
	until(lambda: gone(pids["mine"]))
	assert not gone(pids["other"])
	running["other"][1].stop()
	until(lambda: gone(pids["other"]))
	with Workers(cluster=cluster) as work:  # the workers are still there
		assert work.submit(divmod, 7, 2).result() == (3, 1)


def test_results_of_two_machines_are_not_mixed(cluster, monkeypatch):
	"""The worker on the other address is told to be another machine: nothing is sent there, although it is free."""

	def machines(self):
		addresses = self._client.scheduler_info()["workers"]
		return {one: "slow" if "127.0.0.2" in one else "fast" for one in addresses}

	monkeypatch.setattr(Workers, "_machines", machines)
	with Workers(cluster=cluster) as work:
		assert (work.machine, work.others) == ("fast", ["slow"])
		found = [work.submit(os.getpid) for _ in range(12)]
		there = {pid for address, pid in work.workers.items() if "127.0.0.2" in address}
		assert there and not there & {future.result() for future in found}


def test_stop_on_a_cluster_leaves_nothing_of_a_queue(cluster, tmp_path):
	"""More is queued than there are workers: what would start next is not started, or ended as well."""
	yade = program(tmp_path, f"echo $$ >> {tmp_path}/running; exec sleep infinity")
	asked = questions.Questions("any", Workers(cluster=cluster), yade)
	futures = [asked.submit({}) for _ in range(12)]
	until(lambda: number(tmp_path / "running"))
	asked.stop()
	begun = (tmp_path / "running").read_text().split()
	until(lambda: all(map(gone, begun)))
	with Workers(cluster=cluster) as work:  # workers are free, and took nothing else from the queue
		assert [work.submit(divmod, 7, 2).result() for _ in range(6)] == [(3, 1)] * 6
	assert (tmp_path / "running").read_text().split() == begun
	assert len(begun) <= 6  # one a worker, and one more that was starting when its predecessor was ended
	assert all(isinstance(future.exception(), EvaluationError) for future in futures if future.done())


def test_a_scheduler_that_goes_is_no_failed_evaluation(tmp_path):
	"""Its text says what has gone; nothing is written as failed, and what was made is kept."""
	log = open(tmp_path / "log", "wb")
	start = lambda *arguments: subprocess.Popen(
		[sys.executable, "-m", "dask", *arguments], stdout=log, stderr=subprocess.STDOUT, start_new_session=True
	)
	place = tmp_path / "scheduler.json"
	scheduler = start("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard",
		"--scheduler-file", str(place))
	until(place.exists)
	address = json.loads(until(lambda: place.read_text()))["address"]
	nanny = start("worker", "--nthreads", "1", "--no-dashboard", "--memory-limit", "0", address)
	yade = program(
		tmp_path, f"""grep -q '"x": 2' $request && {{ echo $$ > {tmp_path}/running; exec sleep infinity; }}
		{says({"y": 1.0})}"""
	)
	work = Workers(cluster=address)
	with Bench(evaluate_of(questions.Questions("any", work, yade)), path=tmp_path / "e") as bench:
		with concurrent.futures.ThreadPoolExecutor() as pool:
			waiting = pool.submit(bench.measure, [{"x": 1}, {"x": 2}])
			until(lambda: number(tmp_path / "running"))
			until(lambda: (tmp_path / "e").exists() and (tmp_path / "e").read_text())  # the first has come
			scheduler.kill()
			with pytest.raises(Lost, match=f"the Dask scheduler at {address} is gone"):
				waiting.result()
	assert [json.loads(line)["error"] for line in (tmp_path / "e").read_text().splitlines()] == [None]
	for process in (nanny, scheduler):
		process.kill()
		process.wait()
	log.close()


def test_a_cluster_that_does_not_answer_is_told(monkeypatch):
	monkeypatch.setattr(workers, "ANSWER", 1)
	with pytest.raises(OSError, match="no Dask scheduler answers at tcp://127.0.0.1:1 .*dask scheduler"):
		Workers(cluster="tcp://127.0.0.1:1")


@pytest.mark.parametrize("options, message", [
	({"jobs": 0}, "jobs = 0"), ({"jobs": 1.5}, "jobs = 1.5"), ({"alike": "colour"}, "'colour' is unknown")
])
def test_bad_input(options, message):
	with pytest.raises(ValueError, match=message):
		Workers(**options)
