# GPL v2 or later, see LICENSE.
"""The script that shows what accuracy costs: on a ladder of one's own, from the command line to the files."""
import json

import falling_ladder
import origins
import pytest
import script_modules

from yade import ConcreteDamageMat, O
from yade.ddem.accuracy import ladders, points, prediction, rungs
from yade.ddem.studies import virtualtest
from yade.ddem.studies.workers import Here


@pytest.fixture
def script():
	return script_modules.load("accuracy_cost")


@pytest.fixture
def here(monkeypatch):
	"""Rungs in this YADE, one after the other; returns the settings that were asked for."""
	asked = []

	def submit(self, values, case):
		asked.append(values)
		return Here().submit(rungs.perform, case["scene"], values)

	monkeypatch.setattr(rungs.SeparateRung, "submit", submit)
	return asked


def test_a_ladder_of_one_s_own(script, here, tmp_path, monkeypatch, capsys):
	out = tmp_path / "out"
	arguments = ("--ladders", falling_ladder.__file__, "--out", out, "--target", "0.05%", "--budget", "1h")
	assert script_modules.run(script, monkeypatch, *arguments) == 0
	said = capsys.readouterr().out
	rows = json.loads((out / "cost.json").read_text())
	assert [row["rung"] for row in rows[:3]] == ["safety 0.8", "safety 0.4", "safety 0.2"]
	assert [row["error"] for row in rows] == pytest.approx([1 / 250, 1 / 500, 1 / 1000, 1 / 2000], rel=1e-6)
	assert rows[3]["rung"] == "safety 0.1" and rows[3]["pareto"]  # the step that was predicted for the target
	assert "mine: predicted 0.05 %" in said and "measured 0.05 %" in said and "% in way costs" in said
	assert all(row["wall_s"] > 0 and row["particles"] > 0 and row["ns_per_particle_step"] > 0 for row in rows)
	written = origins.of_all(out)  # each says where it comes from
	assert {path.name for path in written} == {
		"accuracy_cost.html", "cost.csv", "cost.json", "mine.png", "rungs.jsonl"
	}
	before = list(here)
	script_modules.run(script, monkeypatch, *arguments)
	assert here == before  # nothing was run again


def test_the_list_has_every_ladder(script, monkeypatch, capsys):
	script_modules.run(script, monkeypatch, "--list")
	said = capsys.readouterr().out
	assert "cantilever        mesh size             25 mm, 12.5 mm" in said and "ucs_rotation" in said
	assert O.iter == 0


@pytest.mark.parametrize(
	"arguments, says", (
		(("--case", "beem"), "no ladder 'beem'"), (("--target", "0"), "invalid share value: '0'"),
		(("--budget", "soon"), "invalid duration value: 'soon'"),
		(("--threads", "0"), "must lie between 1 and"),
		(("--ladders", "nothing.py"), "nothing.py: FileNotFoundError"),
	)
)
def test_wrong_options_are_refused_before_anything_runs(script, here, tmp_path, monkeypatch, capsys, arguments, says):
	with pytest.raises(SystemExit) as ended:
		script_modules.run(script, monkeypatch, "--out", tmp_path / "out", *arguments)
	assert ended.value.code == 2 and says in capsys.readouterr().err and not here


def test_a_ladder_of_each_scene_runs(here):
	"""The cheapest rung of the built-in ladders that need no other program, in this YADE."""
	for name in ("plane_waves", "rayleigh_wave", "crack_band", "ucs_rotation", "ucs_beta", "ucs_flow"):
		ladder, = ladders.find(name)
		settings = ladder.settings(ladder.rungs[0])
		outcome = rungs.perform(rungs.scene_name(ladder.scene), settings)
		found = points.of_ladder(ladder, [[outcome]] * len(ladder.rungs), name)
		assert not any(point.failed for point in found), name
		assert prediction.predict(found, 1e-9) is None  # all alike: no order


def test_usual_rungs_are_what_the_scene_takes_where_nothing_is_said():
	"""So that ladders of one scene can be combined."""
	known = vars(virtualtest.Setup.standard("deformable", "block"))
	concrete = ConcreteDamageMat()
	asked = 0
	for ladder in ladders.find("ucs"):
		if ladder.kind in (*ladders.REFINED, "threads"):
			continue
		for name, value in ladder.usual.items():
			for name, value in value.items() if isinstance(value, dict) else [(name, value)]:
				usual = getattr(concrete, name) if hasattr(concrete, name) else known[name]
				assert value == usual, ladder.name
				asked += 1
	assert asked == 7
