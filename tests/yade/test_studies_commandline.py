# GPL v2 or later, see LICENSE.
"""What scripts share: the line that each ends with, in this YADE."""
import re
from pathlib import Path

import pytest
import script_modules

from deformable_samples import elastic, skewed_mesh, start
from yade import O, PyRunner, ddem, utils
from yade.ddem import meter
from yade.ddem.studies import commandline

#: scripts whose steps are made elsewhere, or whose rows are the cost itself -> how they say it
OTHERWISE = {
	"bench": "every row is nanoseconds a particle-step",
	"accuracy_cost": "meter.line(", "bonded_figures": "bonded_study.told(", "calibrate": "report.told()",
	"compare_esys": "meter.line(",
}


def test_what_all_steps_have_cost_is_said_once_in_the_end(capsys):

	@commandline.steps_told()
	def main():
		count = len(ddem.append(skewed_mesh(), elastic()).triangle_ids)
		start()
		ddem.run(steps=3)
		O.run(4, True)
		O.reset()
		O.bodies.append([utils.sphere((i, 0, 0), 0.1) for i in range(2)])
		O.dt = 1e-9
		O.step()
		print("a table")
		return count

	count = main()
	printed = capsys.readouterr()
	table, triangles, spheres = printed.out.splitlines()
	assert table == "a table" and "processor time" not in printed.err
	said = rf"7 steps of {count} triangles: [\d.]+ ns a triangle-step, \S+ s of processor time"
	assert re.fullmatch(said, triangles)
	assert spheres.startswith("1 steps of 2 spheres: ")


def test_a_script_that_ends_early_says_it_too_and_one_without_steps_nothing(capsys):
	with pytest.raises(SystemExit):
		with commandline.steps_told():
			ddem.append(skewed_mesh(), elastic())
			start()
			O.run(4, True)
			raise SystemExit(1)
	assert capsys.readouterr().out.startswith("4 steps of ")
	with commandline.steps_told():
		pass
	assert capsys.readouterr().out == ""


def test_recording_is_none_of_it(monkeypatch):
	"""A record that says of itself that it has taken an hour."""
	ddem.append(skewed_mesh(), elastic())
	start()
	O.run(1, True)

	def record():
		with meter.beside_the_steps():
			pass
		monkeypatch.setattr(meter, "_beside", (meter.time_beside() + 3600.0, 3600.0))

	monkeypatch.setattr(meter, "record_of_test", record, raising=False)
	command = "__import__('yade.ddem.meter', fromlist=['meter']).record_of_test()"
	O.engines = O.engines + [PyRunner(command=command, iterPeriod=1)]
	with commandline.steps_told() as counted:
		O.run(50, True)
	assert counted.steps == 50 and counted.cpu_s == counted.wall_s == 0


def test_every_script_says_what_its_steps_cost():
	scripts = {path.stem: path.read_text(encoding="utf-8") for path in Path(script_modules.SCRIPTS).glob("*.py")}
	assert len(scripts) > 12
	silent = {name for name, text in scripts.items() if "@commandline.steps_told()\ndef main():" not in text}
	assert silent == set(OTHERWISE)
	assert all(OTHERWISE[name] in scripts[name] for name in silent - {"bench"})


def test_a_script_ends_with_the_line(monkeypatch, tmp_path, capsys):
	module = script_modules.load("confined_block")
	script_modules.run(
		module, monkeypatch, "--pressures", 0, "--size", 0.025, "--strain", 0.001, "--no-vtk", "--out", tmp_path
	)
	said = capsys.readouterr().out.splitlines()
	assert re.fullmatch(r"\d+ steps of \d+ triangles: .+ ns a triangle-step, \S+ s of processor time", said[-1])
	assert sum("triangle-step" in line for line in said) == 1
