# GPL v2 or later, see LICENSE.
"""Campaigns of runs in YADEs of their own: reuse, failures, interruption, killed workers. A shell script stands in for
YADE."""
import json
import os
import signal

import pytest

from yade.ddem.studies import commandline
from yade.ddem.studies.campaign import FINISHED, Campaign, Case, Failed
from yade.ddem.studies.workers import Here, Workers

from waiting import until

CASES = [Case(f"seed{number}", ("--seed", str(number))) for number in (1, 2, 3)]


@pytest.fixture
def yade(tmp_path):
	"""A program that does what the text says, with the arguments of the script in $arguments and its folder in
	$out, and then leaves a summary."""

	def make(text=""):
		program = tmp_path / "yade"
		versions = json.dumps({"versions": commandline.versions()})
		program.write_text(
			"#!/bin/sh\n"
			"shift 4; arguments=$*; for out; do :; done\n"  # -n -x -j1 SCRIPT
			f"echo $arguments >> {tmp_path}/started\n{text}\n"
			f"cat > $out/summary.json <<'END'\n{versions}\nEND\n"
		)
		program.chmod(0o755)
		return str(program)

	return make


@pytest.fixture
def started(tmp_path):
	"""Seeds that were started, in order of seed."""
	return lambda: sorted(line.split()[1] for line in (tmp_path / "started").read_text().splitlines())


def campaign(tmp_path, yade, cases=CASES, workers=None, text="", **options):
	(tmp_path / "script.py").write_text(text)
	return Campaign(tmp_path / "script.py", cases, tmp_path / "runs", workers or Here(), yade=yade, **options)


def test_every_case_has_a_folder(tmp_path, yade, started):
	said = []
	with Workers(jobs=2) as work:
		program, report = yade("test -d $out"), lambda *done: said.append(done)
		folders = campaign(tmp_path, program, workers=work, report=report).run()
	assert {case.name: os.path.basename(folder) for case, folder in folders.items()} == {
		f"seed{n}": f"seed{n}" for n in (1, 2, 3)
	}
	assert started() == ["1", "2", "3"]
	assert {(case.name, folder) for case, folder, _ in said} == {(case.name, folders[case]) for case in CASES}
	assert all(seconds >= 0 for _, _, seconds in said)


def test_what_is_finished_is_not_repeated(tmp_path, yade, started):
	campaign(tmp_path, yade()).run()
	said = []
	campaign(tmp_path, yade(), report=lambda *done: said.append(done)).run()
	assert started() == ["1", "2", "3"]
	assert [seconds for _, _, seconds in said] == [None] * 3


def test_other_options_or_another_plugin_are_another_run(tmp_path, yade, started):
	campaign(tmp_path, yade()).run()
	path = tmp_path / "runs" / "seed2" / FINISHED
	path.write_text(path.read_text().replace(commandline.plugin(), "0" * 12))
	changed = [CASES[0], CASES[1], Case("seed3", ("--seed", "3", "--young", "1"))]
	campaign(tmp_path, yade(), changed).run()
	assert started() == ["1", "2", "2", "3", "3"]


def test_another_script_is_another_run(tmp_path, yade, started):
	campaign(tmp_path, yade()).run()
	campaign(tmp_path, yade(), text="# changed").run()
	assert started() == ["1", "1", "2", "2", "3", "3"]


def test_a_run_that_ended_while_the_user_interrupted_is_kept(tmp_path, yade, started):
	"""All three have ended when the first one is told, and Ctrl-C comes then."""

	def press(*_):
		raise KeyboardInterrupt

	with pytest.raises(KeyboardInterrupt):
		campaign(tmp_path, yade(), report=press).run()  # one after another, so that all have ended
	campaign(tmp_path, yade()).run()
	assert started() == ["1", "2", "3"]


def test_unfinished_run_is_made_again_in_an_empty_folder(tmp_path, yade, started):
	campaign(tmp_path, yade()).run()
	os.remove(tmp_path / "runs" / "seed1" / FINISHED)
	(tmp_path / "runs" / "seed1" / "rest").write_text("of a run that was killed")
	campaign(tmp_path, yade()).run()
	assert started() == ["1", "1", "2", "3"]
	assert not (tmp_path / "runs" / "seed1" / "rest").exists()


def test_failure_is_told_and_the_others_are_kept(tmp_path, yade, started):
	with pytest.raises(
		Failed,
		match=(
			"1 of 3 runs failed\nseed2: YADE ended with exit code 3; its last lines, of .*log.txt: "
			"nothing | works"
		),
	):
		campaign(tmp_path, yade("case $2 in 2) echo nothing; echo works; exit 3;; esac")).run()
	campaign(tmp_path, yade()).run()
	assert started() == ["1", "2", "2", "3"]


@pytest.mark.parametrize(
	"text", ["exit 0", "echo '{' > $out/summary.json; exit 0", "echo '{}' > $out/summary.json; exit 0"]
)
def test_run_without_a_summary_has_failed(tmp_path, yade, text):
	with pytest.raises(Failed, match="no summary.json that can be read"):
		campaign(tmp_path, yade(text), CASES[:1]).run()
	assert not campaign(tmp_path, yade(), CASES[:1]).finished(CASES[0])


def test_many_failures_are_cut_short(tmp_path, yade):
	with pytest.raises(Failed) as failed:
		campaign(tmp_path, yade("exit 1"), [Case(f"run{n}", ()) for n in range(6)]).run()
	assert len(str(failed.value).splitlines()) == 5 and str(failed.value).endswith("and 3 more")


def test_interruption_ends_what_is_running(tmp_path, yade):
	"""Two runs at the same time: one would last for ever; when the other is finished, the user presses Ctrl-C."""

	def press(*_):
		raise KeyboardInterrupt

	program = yade(
		"case $2 in 1) echo $$ > $out/pid; exec sleep infinity;; esac; "
		"while ! test -e $out/../seed1/pid; do sleep 0.01; done"
	)
	with Workers(jobs=2) as work:
		running = campaign(tmp_path, program, workers=work, report=press)
		with pytest.raises(KeyboardInterrupt):
			running.run()
	until(lambda: not os.path.exists(f"/proc/{(tmp_path / 'runs' / 'seed1' / 'pid').read_text().strip()}"))
	assert running.finished(CASES[1]) and not running.finished(CASES[0])


def test_a_run_whose_worker_is_killed_is_made_by_another(tmp_path, yade, started):
	"""The first run of a seed waits to be killed; its YADE dies with its worker, and a second one is started."""
	program = yade(
		"mkdir $out/../../tried$2 2>/dev/null || exit_now=1; "
		"case $2$exit_now in 2) echo $PPID > $out/../../victim; echo $$ > $out/../../orphan; exec sleep "
		"infinity;; esac"
	)
	killed = []

	def kill_worker(*_):
		"""Called when another run has finished; the worker is what the YADE's parent process is."""
		if not killed:
			killed.append(int(until(lambda: read(tmp_path / "victim"))))
			os.kill(killed[0], signal.SIGKILL)

	with Workers(jobs=2) as work:
		folders = campaign(tmp_path, program, workers=work, report=kill_worker).run()
		assert killed[0] not in work.workers.values()
	assert sorted(os.path.basename(folder) for folder in folders.values()) == ["seed1", "seed2", "seed3"]
	assert started() == ["1", "2", "2", "3"]
	until(lambda: not os.path.exists(f"/proc/{read(tmp_path / 'orphan')}"))


def read(path):
	"""A line of a file; nothing before it is there."""
	return path.read_text().strip() if path.exists() else ""


def test_bad_campaigns(tmp_path):
	with pytest.raises(ValueError, match="same name: seed1"):
		campaign(tmp_path, "yade", [CASES[0], CASES[0]])
