# GPL v2 or later, see LICENSE.
"""What is said of a run before it is run: counts exactly, memory nearly, errors by their order,
times by measurement."""
import json
from dataclasses import replace

import falling_ladder
import pytest
import script_modules

from deformable_samples import elastic, skewed_mesh, start
from yade import BondedMat, ConcreteDamageMat, DeformableTimeStepper, O, PyRunner, ddem
from yade.ddem.accuracy import scene_cost
from yade.ddem.accuracy.ladders import each


@pytest.fixture(autouse=True)
def cache(monkeypatch, tmp_path):
	"""The user's cache, empty."""
	monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
	return tmp_path / "cache" / "yade-ddem"


def test_triangles_before_a_run():
	O.materials.append(ConcreteDamageMat(label="concrete", rateDependence=False))
	block = ddem.append(ddem.mesh.rectangle(0.02, 0.04, size=0.004), "concrete", seed=1)
	platens = ddem.platens(block, velocity=1)
	engine = start(DeformableTimeStepper(), *platens.engines)
	O.engines = O.engines + [PyRunner(command="nothing_that_there_is()", iterPeriod=1, label="mine")]
	positions = block.positions.copy()
	found = ddem.estimate(until=100.5 * O.dt, bench=0.3)
	assert (found.steps, found.particles, found.kind) == (101, len(block.triangle_ids), "triangle")
	assert found.dt == O.dt and found.critical == engine.criticalTimeStep()
	assert found.ruling == engine.rulingTriangle()[0] and found.left_out == ("mine", )
	low, high = found.seconds
	assert 0 < low <= high
	assert set(found.effects) == {
		f"{name} of concrete" for name in ("viscoplasticFlow", "damage", "equationOfState")
	}
	assert all(0 <= share < 1 for share in found.effects.values())
	said = str(found)
	assert said.startswith(f"101 steps of {len(block.triangle_ids)} triangles: ") and "without mine" in said
	assert f"triangle {found.ruling} at (" in said and "0.80 of the critical one" in said
	assert O.iter == 0 and (block.positions == positions).all()  # the scene itself has not moved


def test_spheres_before_a_run():
	O.materials.append(BondedMat(label="bonds", young=50e9, cohesion=80e6))
	packing = ddem.packing.prism(0.01, 0.02, 0.01, 1e-3, 2e-3, seed=1)
	sample = ddem.bonded.append(packing, "bonds")
	O.engines = ddem.bonded.engines(ddem.bonded.platens(sample, 0.1, 1e-4))
	O.dt = ddem.bonded.time_step(0.8)
	found = ddem.estimate(steps=50, bench=0.2)
	assert (found.steps, found.particles, found.kind) == (50, len(sample), "sphere")
	assert found.effects == {}  # what a material of bonds switches is in the contacts already
	assert found.ruling is None and found.dt / found.critical == pytest.approx(0.8) and found.seconds[0] > 0


@pytest.mark.parametrize("wrong", ({}, {"until": 1.0, "steps": 3}, {"until": -1.0}))
def test_wrong_questions_are_refused(wrong):
	ddem.append(skewed_mesh(), elastic())
	start()
	with pytest.raises(ValueError, match="until"):
		ddem.estimate(**wrong)
	O.dt = 0
	with pytest.raises(ValueError, match="O.dt = 0"):
		ddem.estimate(steps=3)


def test_what_was_measured_is_kept_until_the_scene_is_another(cache, monkeypatch):
	asked = []
	submit = scene_cost.Questions.submit
	monkeypatch.setattr(scene_cost.Questions, "submit", lambda *given: asked.append(given) or submit(*given))

	def estimated(more=0, **options):
		O.reset()
		ddem.append(ddem.mesh.rectangle(0.02, 0.04, nx=8 + more, ny=16, pattern="crossed"), elastic())
		start(rotation=options.pop("rotation", "cosserat"), flowInterval=options.pop("flowInterval", 1))
		return ddem.estimate(steps=100, bench=0.2, **options).ns_strained

	first = estimated()
	assert estimated() == first and len(asked) == 1
	(line, ) = [json.loads(text) for text in (cache / "steps.jsonl").read_text().splitlines()]
	assert line["node"] in line["settings"]["machine"]  # the machine's name is part of the key
	changes = ({"more": 8}, {"rotation": "none"}, {"flowInterval": 2}, {"fresh": True})
	for number, change in enumerate(changes, 2):
		estimated(**change)
		assert len(asked) == number


@pytest.mark.parametrize("name", ("block", "cantilever", "booked", "crushed", "bonds"))
def test_steps_and_memory_are_as_estimated(name):
	"""Scenes of scripts/estimate_runs.py, which says it of times as well. A time stepper adds steps."""
	script = script_modules.load("estimate_runs")
	until = script.SCENES[name]()
	row = script.compare(name, until)
	assert row["steps"] == pytest.approx(row["steps_estimated"], rel=0.1 if name == "crushed" else 1e-12)
	assert row["memory_MB"] == pytest.approx(row["memory_estimated_MB"], rel=0.05)


def test_the_error_is_expected_by_the_order_of_cheaper_rungs(cache):
	(mine, ) = falling_ladder.LADDERS
	fallen = replace(mine, rungs=each("safety", 0.8, 0.4, 0.2, 0.1), usual={"safety": 0.1})
	ddem.append(ddem.mesh.rectangle(0.04, 0.04, size=0.01), elastic())
	start()
	found = ddem.estimate(steps=10, bench=0.1, ladder=fallen, rung={"safety": 0.1}, target=1e-4)
	(expected, ), (needed, ) = found.expected, found.needed
	# 200 steps at 1: one part in 200/safety
	assert expected.error == pytest.approx(1 / 2000, rel=1e-6) and expected.order == pytest.approx(1, rel=1e-5)
	assert expected.settled and needed.step == pytest.approx(0.02, rel=1e-4)
	assert "expected error of way: 0.05 %, order 1" in str(found) and "0.01 % in way needs 0.02" in str(found)
	assert len((cache / "rungs" / "rungs.jsonl").read_text().splitlines()) == 3  # not the one that was asked for


@pytest.mark.parametrize("options, message", [
	({"target": 0.01}, "give ladder= and rung= beside target="), ({"rung": {"size": 1}}, "give ladder="),
	({"ladder": "beem"}, "no ladder 'beem'"), ({"ladder": "plane_waves"}, "give rung="),
	({"ladder": "ucs_rotation", "rung": {"rotation": "none"}}, "which must be one"),
	(
		{"ladder": "plane_waves", "rung": {"size": 0.008}},
		"needs two rungs that are coarser than 8 mm, and there are 1",
	),
])
def test_errors_that_cannot_be_expected(options, message):
	ddem.append(skewed_mesh(), elastic())
	start()
	with pytest.raises(ValueError, match=message):
		ddem.estimate(steps=3, **options)
