# GPL v2 or later, see LICENSE.
"""Which launchers wait for which, in checkouts that share a cache. In the place of cmake, apt-get and yade are programs
that do nothing; the first two take as long as a test lets them."""
import os
import pathlib
import shutil
import signal
import subprocess

import pytest

from waiting import until

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / 'scripts'
WORK = '[ -z "${1}" ] || { touch "${1}.begun"; cat "${1}"; }\n'  # until somebody has opened the gate
PROGRAMS = {
	'cmake': '[ "$1" != --build ] || { set -- "$BUILD_GATE"; %s}\n' % WORK,
	'apt-get': 'case "$*" in *" install "*) set -- "$INSTALL_GATE"; %s esac\n' % WORK,
	'yade': 'echo "Yade version: 2025.2.0"\n',
}
NEEDY = ('run', 'needy.py')  # needs a package


class Gate:
	"""Something that lasts: it has begun, and goes on until the gate is opened."""

	def __init__(self, path):
		self.path = path
		os.mkfifo(path)

	def begun(self):
		return os.path.exists(f'{self.path}.begun')

	def open(self):
		with open(self.path, 'w'):
			pass


class Launchers:
	"""Starts launchers in the checkouts of a folder; ends what is left of them."""

	def __init__(self, folder):
		self._folder, self._processes = folder, []
		(folder / 'bin').mkdir()
		for name, text in PROGRAMS.items():
			program = folder / 'bin' / name
			program.write_text('#!/bin/sh\n' + text)
			program.chmod(0o755)
		(folder / NEEDY[1]).write_text('# needs: ddem-absent\n')
		self.environment = {
			**os.environ, 'PATH': '%s:%s' % (folder / 'bin', os.environ['PATH']),
			'XDG_CACHE_HOME': str(folder / 'cache'), 'YADE_SOURCE_DIR': str(folder), 'BUILD_GATE': '',
			'INSTALL_GATE': ''
		}
		self.environment.pop('YADE_PREFIX', None)

	def gate(self, name):
		return Gate(self._folder / name)

	def start(self, checkout, *arguments, build=None, install=None):
		scripts = self._folder / checkout / 'scripts'
		if not scripts.exists():
			shutil.copytree(SCRIPTS, scripts)
		gates = {'BUILD_GATE': build, 'INSTALL_GATE': install}
		gates = {name: str(gate.path) for name, gate in gates.items() if gate}
		process = subprocess.Popen(
			[scripts / 'ddem', *(arguments or ('shell', 'true'))], stdin=subprocess.DEVNULL,
			stdout=subprocess.DEVNULL,
			stderr=subprocess.PIPE, text=True, cwd=self._folder, env={**self.environment, **gates},
			start_new_session=True
		)
		self._processes.append(process)
		return process

	def build(self, checkout, gate):
		"""A launcher that is building, until the gate is opened."""
		process = self.start(checkout, build=gate)
		until(gate.begun)
		return process

	def install(self, checkout, gate):
		"""A launcher that installs a package, until the gate is opened."""
		process = self.start(checkout, *NEEDY, install=gate)
		until(gate.begun)
		return process

	def end(self):
		for process in self._processes:
			try:
				os.killpg(process.pid, signal.SIGKILL)
			except ProcessLookupError:
				pass
			process.communicate()


@pytest.fixture
def launchers(tmp_path):
	launchers = Launchers(tmp_path)
	yield launchers
	launchers.end()


def assert_waits(process, for_whom):
	for line in process.stderr:
		if 'waiting' in line:
			assert for_whom in line
			break
	assert process.poll() is None


def assert_does_not_wait(process):
	for line in process.stderr:
		assert 'waiting' not in line
	assert process.wait() == 0


CHECKOUT, CHANGE, USE = 'setting up this checkout', 'changing the environment', 'at work in the environment'
as_root = pytest.mark.skipif(os.getuid() != 0, reason='installs packages')


def test_another_checkout_is_not_waited_for(launchers):
	gate = launchers.gate('build')
	building = launchers.build('one', gate)
	assert_does_not_wait(launchers.start('two'))  # looks at the environment, builds, and runs its command
	assert building.poll() is None
	gate.open()
	assert_does_not_wait(building)


def test_second_start_in_a_checkout_waits_for_the_first(launchers):
	gate = launchers.gate('build')
	building = launchers.build('one', gate)
	second = launchers.start('one')
	assert_waits(second, CHECKOUT)
	gate.open()
	assert building.wait() == 0
	assert_does_not_wait(second)


def test_what_a_killed_launcher_has_left_at_work_is_waited_for(launchers):
	gate = launchers.gate('build')
	building = launchers.build('one', gate)
	building.kill()  # the launcher alone; its build goes on
	assert building.wait() == -signal.SIGKILL
	second = launchers.start('one')
	assert_waits(second, CHECKOUT)
	gate.open()
	assert_does_not_wait(second)


@as_root
def test_all_wait_while_the_environment_changes(launchers):
	gate = launchers.gate('install')
	installing = launchers.install('one', gate)
	others = [launchers.start('two'), launchers.start('three', *NEEDY)]
	for other in others:
		assert_waits(other, CHANGE)
	gate.open()
	assert installing.wait() == 0
	for other in others:
		assert other.wait() == 0


@as_root
def test_a_killed_launcher_s_installation_is_waited_for(launchers):
	gate = launchers.gate('install')
	installing = launchers.install('one', gate)
	installing.kill()
	assert installing.wait() == -signal.SIGKILL
	second = launchers.start('two')
	assert_waits(second, CHANGE)
	gate.open()
	assert_does_not_wait(second)


@as_root
def test_the_environment_does_not_change_under_a_build(launchers):
	build, install = launchers.gate('build'), launchers.gate('install')
	building = launchers.build('one', build)
	installing = launchers.start('two', *NEEDY, install=install)
	assert_waits(installing, USE)
	assert not install.begun()
	assert_does_not_wait(launchers.start('three'))  # shares it with the build
	build.open()
	assert building.wait() == 0
	until(install.begun)
	install.open()
	assert_does_not_wait(installing)
