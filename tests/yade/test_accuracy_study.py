# GPL v2 or later, see LICENSE.
"""Ladders that are run, kept, resumed, budgeted and refined; on scenes whose error law is known, and on a real one."""
import json

import pytest

from yade import ddem
from yade.ddem.accuracy import rungs, study
from yade.ddem.accuracy.ladders import Ladder, Quantity, each
from yade.ddem.studies import workers

SIZES = (0.008, 0.004, 0.002)
DEFLECTION = Quantity("deflection", "displacement", "m")


class Known:
	"""Evaluates rungs whose error is (size/mm)² per cent and whose cost grows with size^-3; counts them."""

	def __init__(self):
		self.asked = []

	def __call__(self, values, case):
		size = values["size"]
		self.asked.append(size)
		if values.get("blown"):
			raise RuntimeError("it blew up")
		error, seconds = 0.01 * (1e3 * size)**2, 1e-9 * size**-3
		return {
			"value:deflection": 3 * (1 - error), "reference:deflection": 3.0, "error:deflection": error,
			"cpu_s": seconds,
			"wall_s": seconds, "ns_per_particle_step": 1.0, "memory_MB": 5.0, "steps": 1 / size,
			"particles": size**-2,
			"unknowns": 300, "particle_steps": 1e5, "dt_s": 1e-7, "threads": 1
		}


def ladder(name="beam", rungs_=None, **more):
	return Ladder(
		name, "mesh size", "cantilever", rungs_ or each("size", *SIZES), [DEFLECTION], refined="size", **more
	)


def test_a_study_that_is_repeated_runs_nothing_and_says_the_same(tmp_path):
	first, again = Known(), Known()
	found = study.Study([ladder()], str(tmp_path), evaluate=first).run()
	assert first.asked == list(SIZES) and [p.error for p in found] == pytest.approx([0.64, 0.16, 0.04])
	assert study.Study([ladder()], str(tmp_path), evaluate=again).run() == found
	assert again.asked == []


def test_a_study_that_was_cut_off_goes_on(tmp_path):

	class Stops(Known):

		def __call__(self, values, case):
			if len(self.asked) == 2:
				raise KeyboardInterrupt
			return super().__call__(values, case)

	with pytest.raises(KeyboardInterrupt):
		study.Study([ladder()], str(tmp_path), evaluate=Stops()).run()
	rest = Known()
	work = study.Study([ladder()], str(tmp_path), evaluate=rest)
	assert [p.error for p in work.run()] == pytest.approx([0.64, 0.16, 0.04])
	assert rest.asked == [SIZES[-1]]


def test_results_of_another_machine_are_not_mixed(tmp_path, monkeypatch):
	study.Study([ladder()], str(tmp_path), evaluate=Known()).run()
	monkeypatch.setattr(workers.platform, "node", lambda: "elsewhere")
	other = Known()
	study.Study([ladder()], str(tmp_path), evaluate=other).run()
	assert other.asked == list(SIZES)


def test_a_rung_that_would_break_the_budget_is_not_started(tmp_path):
	told, asked = [], Known()
	# by its power law the third takes 0.125 s and the fourth 8 times as much as the third by the two before it
	sizes = (*SIZES, 0.0001)
	work = study.Study(
		[ladder(rungs_=each("size", *sizes))], str(tmp_path), budget=0.9, evaluate=asked, report=told.append
	)
	found = work.run()
	assert asked.asked == list(SIZES)
	assert (
		found[-1].failed.startswith("not run: it would take about 1 s of a budget of which ")
		and found[-1].skipped
	)
	assert told[0] == "beam: 8 mm: 0.00195 core-seconds, 15625 particles, 1 ns a particle-step"


def test_cheap_rungs_of_all_ladders_come_first(tmp_path):
	asked = Known()
	dear = ladder("dear", rungs_=each("size", 0.0008, 0.0004))
	study.Study([dear, ladder()], str(tmp_path), evaluate=asked).run()
	assert asked.asked == [0.0008, *SIZES, 0.0004]  # the first of each tells what the next will take


def test_failures_do_not_stop_the_others(tmp_path):
	blown = ladder(rungs_=({"size": 0.008}, {"size": 0.004, "blown": True}, {"size": 0.002}))
	found = study.Study([blown], str(tmp_path), evaluate=Known()).run()
	assert [bool(p.failed) for p in found] == [False, True, False] and "it blew up" in found[1].failed


def test_a_target_is_predicted_and_met(tmp_path):
	asked = Known()
	work = study.Study([ladder()], str(tmp_path), evaluate=asked)
	found = work.run(target=0.01)
	(_, predicted, measured), = work.predictions
	assert predicted.step == pytest.approx(0.001) and predicted.order == pytest.approx(2)
	assert measured.error == pytest.approx(0.01) and predicted.cpu_s == pytest.approx(measured.cpu_s)
	assert found[-1] == measured and asked.asked[-1] == pytest.approx(0.001)
	nothing = study.Study([ladder()], str(tmp_path), evaluate=Known())
	nothing.run(target=0.2)
	assert not nothing.predictions  # a rung is good enough


SCENE = '''
from yade import DeformableElastMat, DeformableEngine, ForceResetter, O, ddem
from yade.ddem.accuracy.ladders import Ladder, Quantity, each


def stretched(size):
	"""A block that is held at one side and pulled at the other for a hundred steps: the mean strain is known."""
	O.materials.append(DeformableElastMat(young=30e9, poisson=0.2, density=2400, label="rock"))
	block = ddem.append(ddem.mesh.rectangle(0.04, 0.04, size=size), "rock")
	block.drive(block.boundary("top"), (0, 1))
	O.engines = [ForceResetter(), DeformableEngine()]
	O.dt = 1e-7
	O.run(100, True)
	return {"travel": (block.displacements[:, 1].max(), 1e-5), "size": size}


LADDERS = [
	Ladder(
		"mine", "mesh size", stretched, each("size", 0.02, 0.01), [Quantity("travel", "displacement", "m")],
		refined="size"
	)
]
'''


def test_a_scene_of_one_s_own_in_yades_of_their_own(tmp_path):
	file = tmp_path / "mine.py"
	file.write_text(SCENE)
	perform = lambda settings, scene="stretched": rungs.SeparateRung().submit(
		settings, {"scene": f"{file}:{scene}"}
	).result()
	answers = [perform({"size": size}) for size in (0.02, 0.01)]
	for answer in answers:
		assert answer["steps"] == 100 and answer["error:travel"] < 1e-9 and answer["value:size"] in (0.02, 0.01)
		assert answer["particle_steps"] == 100 * answer["particles"] and answer["dt_s"] == 1e-7
		assert answer["unknowns"] > 3 * answer["particles"] and answer["cpu_s"] > 0
	assert answers[1]["particles"] == 4 * answers[0]["particles"] and answers[0]["threads"] == 1
	two = perform({"size": 0.02, "threads": 2})
	assert two["threads"] == 2 and two["value:travel"] == answers[0]["value:travel"]
	with pytest.raises(rungs.EvaluationError, match="AttributeError.*nothing"):
		perform({"size": 0.02}, "nothing")


def test_the_files(tmp_path):
	from yade.ddem.accuracy import page, sentences
	work = study.Study([ladder()], str(tmp_path), evaluate=Known())
	found = work.run(target=0.01)
	path = page.write(found, sentences.all_of(found), work, str(tmp_path), "command")
	html = open(path, encoding="utf-8").read()
	assert "5 % in deflection costs" in html and "predicted 1 % for 1 s" in html and html.count("<img") == 2
	rows = json.loads((tmp_path / "cost.json").read_text())
	assert len(rows) == 4 and rows[0]["case"] == "cantilever" and rows[0]["pareto"] is True
	assert ddem.provenance.KEY in rows[0]
	assert (tmp_path / "cost.csv").read_text().startswith("case,ladder,kind,quantity")
	assert page.table(found).splitlines()[0].split()[:3] == ["ladder", "rung", "quantity"]


def test_settings_that_stand_for_one_another_are_expected_to_cost_alike(tmp_path):
	"""The first takes 0.125 s, and 0.9 s are left: enough for one that costs twice as much, not eight times."""
	rungs_ = ({"size": 0.002, "rotation": "none"}, {"size": 0.002, "rotation": "cosserat"})
	turn = Ladder("turn", "rotation treatment", "cantilever", rungs_, [DEFLECTION])
	found = study.Study([turn], str(tmp_path / "turn"), budget=0.9, evaluate=Known()).run()
	assert not any(p.skipped for p in found)
	finer = ladder(rungs_=each("size", 0.002, 0.0019))
	found = study.Study([finer], str(tmp_path / "finer"), budget=0.9, evaluate=Known()).run()
	assert [p.skipped for p in found] == [False, True]
