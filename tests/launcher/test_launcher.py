# GPL v2 or later, see LICENSE.
# The launcher as its users see it.  Runs outside YADE, in an environment where YADE is installed.
import os
import pathlib
import signal
import subprocess

import pytest

DDEM = pathlib.Path(__file__).resolve().parents[2] / 'scripts' / 'ddem'


def ddem(*arguments, **options):
	return subprocess.run([DDEM, *map(str, arguments)], capture_output=True, text=True, **options)


@pytest.fixture
def script(tmp_path):
	"""Writes a YADE script into a folder with a space in its name."""

	def write(text):
		folder = tmp_path / 'a folder'
		folder.mkdir(exist_ok=True)
		path = folder / 'script.py'
		path.write_text(text)
		return path

	return write


@pytest.mark.parametrize('command', ['run', 'test', 'bench', 'docs', 'shell', 'setup'])
def test_every_command_has_help(command):
	result = ddem(command, '--help')
	assert result.returncode == 0
	assert result.stdout.startswith('scripts/ddem ' + command)


def test_general_help_names_every_command():
	result = ddem('--help')
	assert result.returncode == 0
	assert all(
		'scripts/ddem ' + command in result.stdout
		for command in ['run', 'test', 'bench', 'docs', 'shell', 'setup']
	)


@pytest.mark.parametrize(
	'arguments, message', [
		(['fly'], "no command 'fly'"),
		(['run'], 'which script'),
		(['run', 'missing.py'], 'no such script: missing.py'),
		(['run', '--threads', 'many', 'x.py'], "--threads needs a number, not 'many'"),
		(['run', '--fast', 'x.py'], "unknown option '--fast'"),
		(['setup', '--hurry'], "unknown argument '--hurry'"),
		(['docs', 'models'], "unknown argument 'models'"),
		(['docs', '--out'], '--out needs a folder'),
	]
)
def test_wrong_use_is_one_line_and_exit_code_2(arguments, message):
	result = ddem(*arguments)
	assert result.returncode == 2
	assert message in result.stderr and result.stderr.count('\n') == 1 and result.stdout == ''


def test_script_runs_with_the_plugin_its_arguments_and_the_callers_directory(script, tmp_path):
	path = script(
		'''
import os, sys
import yade
loaded = any('libpkg_ddem.so' in line for line in open('/proc/self/maps'))
open('result.txt', 'w').write(repr((sys.argv[1:], os.getcwd(), os.environ['MY_VARIABLE'], loaded)))
'''
	)
	result = ddem('run', path, 'two words', '--option', '', cwd=tmp_path, env={**os.environ, 'MY_VARIABLE': "it's"})
	assert result.returncode == 0, result.stderr
	assert eval((tmp_path / 'result.txt').read_text()) == (
		['two words', '--option', ''],
		str(tmp_path),
		"it's",
		True,
	)
	assert (tmp_path / 'result.txt').stat().st_uid == os.getuid()


@pytest.mark.parametrize('code', [0, 7])
def test_exit_code_is_the_scripts(script, code):
	assert ddem('run', script('import sys; sys.exit(%d)' % code)).returncode == code


def test_script_error_is_exit_code_1(script):
	result = ddem('run', script('1 / 0'))
	assert result.returncode == 1 and 'ZeroDivisionError' in result.stderr


@pytest.fixture
def fake_apt(tmp_path):
	"""An environment whose apt-get only notes what it is asked to do; and the file with the notes."""
	notes, program = tmp_path / 'notes', tmp_path / 'bin' / 'apt-get'
	program.parent.mkdir()
	program.write_text('#!/bin/sh\necho "$*" >> "%s"\n' % notes)
	program.chmod(0o755)
	notes.touch()
	return {**os.environ, 'PATH': '%s:%s' % (program.parent, os.environ['PATH'])}, notes


def test_package_that_a_script_needs_is_installed_or_named(script, fake_apt):
	environment, notes = fake_apt
	result = ddem(
		'run',
		script('# A comment.\n# needs: ddem-absent python3-numpy\nprint("the script runs")'),
		env=environment,
	)
	if os.getuid() == 0:
		assert result.returncode == 0 and 'the script runs' in result.stdout, result.stderr
		installed = [line.split() for line in notes.read_text().splitlines() if ' install ' in line]
		assert len(installed) == 1 and '--no-install-recommends' in installed[0]
		# the latter is there already
		assert installed[0][-1] == 'ddem-absent' and 'python3-numpy' not in installed[0]
	else:
		assert (
			result.returncode == 125
			and 'sudo apt-get install --no-install-recommends ddem-absent' in result.stderr
		)


def test_needs_count_only_at_the_top_of_a_script(script, fake_apt):
	environment, notes = fake_apt
	result = ddem(
		'run',
		script(
			'#!/usr/bin/env python3\n# needs: python3-numpy\nprint("the script runs")\n'
			'# needs: ddem-absent\n'
		),
		env=environment,
	)
	assert result.returncode == 0 and 'the script runs' in result.stdout, result.stderr
	assert notes.read_text() == ''


def test_needs_that_are_no_package_names_are_refused(script, fake_apt):
	environment, notes = fake_apt
	result = ddem('run', script('# needs: python3-numpy --allow-downgrades\n'), env=environment)
	assert (
		result.returncode == 2
		and "'--allow-downgrades', which is not the name of a Debian package" in result.stderr
	)
	assert notes.read_text() == ''


@pytest.mark.parametrize('options, variable, threads', [(['--threads', '2'], None, 2), ([], '2', 2), ([], None, 1)])
def test_number_of_threads(script, options, variable, threads):
	environment = {key: value for key, value in os.environ.items() if key != 'OMP_NUM_THREADS'}
	if variable:
		environment['OMP_NUM_THREADS'] = variable
	result = ddem('run', *options, script('print("threads", O.numThreads)'), env=environment)
	assert 'threads %d' % threads in result.stdout


def test_ctrl_c_stops_the_script(script):
	path = script('import signal\nprint("started", flush=True)\nsignal.pause()')
	# A job started in the background ignores Ctrl-C and hands that on; a person at a terminal does not.
	listen = lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)
	process = subprocess.Popen(
		[DDEM, 'run', path], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
		start_new_session=True, preexec_fn=listen
	)
	for line in process.stdout:
		if line.startswith('started'):
			break
	os.killpg(process.pid, signal.SIGINT)
	assert process.wait() != 0
