# GPL v2 or later, see LICENSE.
"""Evaluations that are kept: what is reused, what is not, and what a killed or damaged run leaves."""
import concurrent.futures
import json
import os
import signal
import threading

import pytest
from ddem.studies.evaluations import Bench, EvaluationError, OutOfBudget, Store, fingerprint


class Counted:
	"""A model that knows how often it was asked: y = 2 x, plus the seed."""

	def __init__(self, fails_at=()):
		self.asked, self.fails_at, self.stopped = [], fails_at, False

	def __call__(self, values, case):
		self.asked.append((values["x"], case.get("seed")))
		if values["x"] in self.fails_at:
			raise EvaluationError(f"nothing works at {values['x']}")
		return {"y": 2 * values["x"] + case.get("seed", 0)}

	def stop(self):
		self.stopped = True


class Threads:
	"""Evaluates a model in threads, as workers do in processes."""

	def __init__(self, model, number):
		self.stop = getattr(model, "stop", lambda: None)
		self._model, self._pool = model, concurrent.futures.ThreadPoolExecutor(number)

	def submit(self, values, case):
		return self._pool.submit(self._model, values, case)


def points(*numbers):
	return [{"x": float(x)} for x in numbers]


def lines(path):
	return [json.loads(line) for line in path.read_text().splitlines()]


def test_mean_and_scatter_over_cases():
	model = Counted()
	with Bench(model, [{"seed": 0}, {"seed": 2}, {"seed": 4}]) as bench:
		point, = bench.measure(points(5))
	assert point.measured == {"y": 12.0}
	assert point.scatter == {"y": 2.0}  # of 10, 12, 14
	assert bench.ran == 3
	assert Bench(model).measure(points(5))[0].scatter == {"y": None}


def test_tests_of_different_kinds_complete_each_other():
	with Bench(
		lambda _, case: {"push": {"a": 1.0}, "pull": {"b": 2.0}}[case["test"]],
		[{"test": "push"}, {"test": "pull"}],
	) as bench:
		assert bench.measure(points(1))[0].measured == {"a": 1.0, "b": 2.0}


def test_repeated_start_evaluates_nothing_again(tmp_path):
	path = tmp_path / "new" / "folder" / "evaluations.jsonl"
	for expected in ((3, 0), (0, 3)):
		model = Counted()
		with Bench(model, settings={"specimen": "prism"}, path=path) as bench:
			found = bench.measure(points(1, 2)) + bench.measure(points(2, 3))
		assert [point.measured["y"] for point in found] == [2, 4, 4, 6]
		assert (len(model.asked), bench.reused) == expected == (bench.ran, bench.reused)


@pytest.mark.parametrize(
	"settings, case",
	[
		({"specimen": "block"}, {"seed": 1}),
		({"specimen": "prism", "speed": 1}, {"seed": 1}),
		({"specimen": "prism"}, {"seed": 2}),
	]
)
def test_other_settings_are_not_reused(tmp_path, settings, case):
	with Bench(Counted(), [{"seed": 1}], {"specimen": "prism"}, tmp_path / "e") as bench:
		bench.measure(points(1))
	model = Counted()
	with Bench(model, [case], settings, tmp_path / "e") as bench:
		bench.measure(points(1))
	assert len(model.asked) == 1
	assert len(lines(tmp_path / "e")) == 2


def test_order_of_settings_does_not_matter():
	assert fingerprint({"a": 1, "b": 2}, {"x": 1.0, "y": 2.0}, {}) == fingerprint(
		{"b": 2, "a": 1}, {"y": 2.0, "x": 1.0}, {}
	)
	assert fingerprint({"a": 1}, {"x": 1.0}, {}) != fingerprint({"a": 1}, {"x": 1.0 + 1e-15}, {})


def test_a_line_says_everything(tmp_path):
	with Bench(Counted(fails_at=[2.0]), [{"seed": 7}], {"specimen": "prism"}, tmp_path / "e") as bench:
		bench.measure(points(1, 2))
	good, bad = sorted(lines(tmp_path / "e"), key=lambda record: record["parameters"]["x"])
	assert (good["settings"], good["case"], good["measured"], good["error"]) == (
		{"specimen": "prism"},
		{"seed": 7},
		{"y": 9.0},
		None,
	)
	assert good["seconds"] >= 0 and "T" in good["finished"]
	assert (bad["parameters"], bad["measured"], bad["error"]) == ({"x": 2.0}, None, "nothing works at 2.0")


def test_what_a_scene_simulated_is_kept_beside_what_was_measured(tmp_path):
	told = {"a": [], "b": [{"effect": "flow"}]}
	cases = [{"test": name} for name in told]
	with Bench(lambda values, case: {"y": 1, "effects": told[case["test"]]}, cases, path=tmp_path / "e") as bench:
		(point, ) = bench.measure(points(1))
		assert point.measured == {"y": 1.0} and bench.effects(point.values) == told["b"]
		assert bench.effects({"x": 2.0}) == []  # not evaluated
	assert [record["effects"] for record in lines(tmp_path / "e")] in ([[], told["b"]], [told["b"], []])


@pytest.mark.parametrize(
	"damage",
	[
		b"not json\n",
		b"[1, 2]\n",
		b"{}\n",
		b'{"format": 0}\n',
		b"\xff\xfe\n",
		b'{"format": 1, "error": null, "measured": {"y": NaN}, "key": "k"}\n',
	]
)
def test_damaged_line_costs_only_its_own_evaluation(tmp_path, damage):
	path = tmp_path / "e"
	with Bench(Counted(), path=path) as bench:
		bench.measure(points(1, 2, 3))
	kept = path.read_bytes().splitlines(keepends=True)
	lost = json.loads(kept[1])["parameters"]["x"]
	path.write_bytes(kept[0] + damage + kept[2])
	model = Counted()
	with Bench(model, path=path) as bench:
		assert [number for number, _ in bench.store.unreadable] == [2]
		assert bench.store.unreadable[0][1]
		assert sorted(point.measured["y"] for point in bench.measure(points(1, 2, 3))) == [2, 4, 6]
	assert model.asked == [(lost, None)]


def test_line_that_was_cut_off_does_not_spoil_the_next(tmp_path):
	path = tmp_path / "e"
	with Bench(Counted(), path=path) as bench:
		bench.measure(points(1))
	whole = path.read_bytes()
	path.write_bytes(whole + whole[:40])  # killed while it wrote
	with Bench(Counted(), path=path) as bench:
		assert [number for number, _ in bench.store.unreadable] == [2]
		bench.measure(points(2))
	model = Counted()
	with Bench(model, path=path) as bench:
		bench.measure(points(1, 2))
	assert model.asked == []


def test_failed_evaluation_is_an_error_of_its_point_only(tmp_path):
	model = Counted(fails_at=[2.0])
	with Bench(model, [{"seed": 1}], path=tmp_path / "e") as bench:
		one, two, three = bench.measure(points(1, 2, 3))
	assert two.error == "seed 1: nothing works at 2.0" and two.measured == {}
	assert (one.error, three.error) == (None, None)
	assert (bench.ran, bench.failed) == (3, 1)
	model.fails_at = ()  # what was wrong has been put right: a new start tries again
	with Bench(model, [{"seed": 1}], path=tmp_path / "e") as bench:
		assert bench.measure(points(2))[0].measured == {"y": 5.0}


@pytest.mark.parametrize(
	"answer, text",
	[({"y": float("nan")}, "measured y = nan"), ({"y": None}, "TypeError"), (None, "TypeError")],
)
def test_answer_that_is_no_measure_is_an_error(answer, text):
	with Bench(lambda *_: answer) as bench:
		assert text in bench.measure(points(1))[0].error


def test_evaluations_run_at_the_same_time_and_give_the_same():
	meeting = threading.Barrier(3)

	def together(values, case):
		meeting.wait()  # hangs unless three are here at once
		return {"y": values["x"]**2}

	with Bench(Threads(together, 3)) as bench:
		parallel = bench.measure(points(3, 1, 2))
	with Bench(lambda values, _: {"y": values["x"]**2}) as bench:
		serial = bench.measure(points(3, 1, 2))
	assert (
		[point.measured for point in parallel]
		== [point.measured for point in serial]
		== [{"y": 9.0}, {"y": 1.0}, {"y": 4.0}]
	)
	assert [point.error for point in parallel] == [None] * 3


def test_the_same_point_twice_is_one_evaluation():
	model = Counted()
	with Bench(Threads(model, 2)) as bench:
		assert len(bench.measure(points(1, 1))) == 2
	assert len(model.asked) == 1


def test_interruption_keeps_what_was_finished_and_ends_the_rest(tmp_path):
	stopped, finished = threading.Event(), threading.Event()

	class Model:

		def __call__(self, values, case):
			if values["x"] == 1:
				finished.set()
				return {"y": 2.0}
			if values["x"] == 2:
				finished.wait(10)
				raise KeyboardInterrupt  # as its waiting thread gets it from Ctrl-C
			assert stopped.wait(10)
			raise EvaluationError("ended")

		def stop(self):
			stopped.set()

	with Bench(Threads(Model(), 3), path=tmp_path / "e") as bench:
		with pytest.raises(KeyboardInterrupt):
			bench.measure(points(1, 2, 3))
	assert stopped.is_set()
	assert [record["parameters"]["x"] for record in lines(tmp_path / "e")] == [1.0]


def test_what_is_written_is_counted_however_the_user_interrupts(tmp_path, monkeypatch):
	"""Ctrl-C while a line goes to the disk."""
	plain = Store.add

	def add(self, record):
		plain(self, record)
		os.kill(os.getpid(), signal.SIGINT)

	monkeypatch.setattr(Store, "add", add)
	with Bench(Counted(), path=tmp_path / "e") as bench:
		with pytest.raises(KeyboardInterrupt):
			bench.measure(points(1, 2, 3))
	assert bench.ran == len(lines(tmp_path / "e")) == 1


def test_budget(tmp_path):
	model = Counted()
	with Bench(model, path=tmp_path / "e", budget=3) as bench:
		bench.measure(points(1, 2))
		with pytest.raises(OutOfBudget, match="3 evaluations are used up"):
			bench.measure(points(3, 4))
		assert len(model.asked) == 2
		bench.measure(points(2, 3))  # 2 is known


def test_second_process_is_refused(tmp_path):
	with Bench(Counted(), path=tmp_path / "e"):
		with pytest.raises(RuntimeError, match="in use by another run"):
			Store(tmp_path / "e")
	Store(tmp_path / "e").close()


def test_a_bench_needs_a_case():
	with pytest.raises(ValueError, match="at least one case"):
		Bench(Counted(), cases=[])


def test_how_an_evaluation_was_made_is_written_beside_it(tmp_path):
	"""Seconds are those of the evaluation, without its time in a queue; the node is where it was made."""
	with Bench(lambda *_: {"y": 1, "about": {"seconds": 123.0, "node": "there"}}, path=tmp_path / "e") as bench:
		(point, ) = bench.measure(points(1))
	(line, ) = lines(tmp_path / "e")
	assert point.measured == {"y": 1.0} and point.seconds == bench.seconds == line["seconds"] == 123.0
	assert line["node"] == "there"
