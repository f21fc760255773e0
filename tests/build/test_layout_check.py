# GPL v2 or later, see LICENSE.
# A plugin built with a wrong view of YADE's classes refuses to load, says why, and leaves YADE running.
import json
import os
import re
import shlex
import shutil
import subprocess

import pytest

SCRIPT = '''
import yade
print('YADE runs:', O.iter == 0 and len(O.bodies) == 0)
engines = [name for name in yade.__all__ if name.startswith('DeformableE') and name.endswith('Engine')]
print('classes of the plugin:', engines)
from yade import ddem
'''


@pytest.fixture(scope='module')
def build():
	"""The build directory, as the launcher names it."""
	return os.environ['DDEM_BUILD_DIR']


@pytest.fixture
def run_with_loader(build, tmp_path):
	"""Builds the loader with one source compiled in another way, and runs a script in a YADE that finds it;
	gives exit code, stdout and stderr."""

	def run(source, change):
		commands = json.load(open(os.path.join(build, 'compile_commands.json')))
		entry = next(entry for entry in commands if entry['file'].endswith('/loader/' + source))
		arguments = [argument for argument in shlex.split(entry['command']) if not argument.endswith('ccache')]
		normal_object = arguments[arguments.index('-o') + 1]
		wrong_object = str(tmp_path / 'wrong.o')
		arguments[arguments.index('-o') + 1] = wrong_object
		subprocess.run(change(arguments) + ['-O0'], cwd=entry['directory'], check=True)

		prefix = tmp_path / 'prefix'
		shutil.copytree(os.environ['YADE_PREFIX'], prefix, symlinks=True)
		(library,) = prefix.glob('lib*/**/libpkg_ddem.so')
		link = subprocess.run(
			['ninja', '-t', 'commands', 'libpkg_ddem.so'], cwd=build, check=True, capture_output=True,
			text=True
		).stdout.splitlines()[-1]
		link = link.replace(normal_object, shlex.quote(wrong_object))
		link = re.sub(r' -o \S*libpkg_ddem\.so ', ' -o %s ' % shlex.quote(str(library)), link)
		library.unlink()
		subprocess.run(link, shell=True, cwd=build, check=True)

		script = tmp_path / 'script.py'
		script.write_text(SCRIPT)
		result = subprocess.run(
			['yade', '-n', '-x', str(script)],
			env={**os.environ, 'YADE_PREFIX': str(prefix)},
			capture_output=True,
			text=True,
		)
		return result.returncode, result.stdout, result.stderr

	return run


def expect_refusal(result, cause):
	code, out, err = result
	assert re.search('does not fit this YADE', err), err
	assert re.search(cause, err), err
	assert 'scripts/ddem setup' in err  # the way out
	assert 'YADE runs: True' in out
	assert 'classes of the plugin: []' in out
	assert re.search(r'ImportError: The plugin yade-ddem does not fit', err) and code == 1


def test_plugin_compiled_without_a_feature_of_yade_is_refused(run_with_loader):
	# FEM support is a shared_ptr in Shape (16 bytes), before all the members that scripts use.
	without_fem = lambda arguments: [argument for argument in arguments if argument != '-DYADE_FEM']
	expect_refusal(
		run_with_loader('LayoutCheck.cpp', without_fem), r'class Shape: \d+ bytes in YADE, \d+ in the plugin'
	)


@pytest.mark.slow
@pytest.mark.parametrize(
	'remove, add, cause', [
		('-DEIGEN_DONT', None, 'class State'),
		('-DYADE_OPENGL', None, 'class Scene'),
		('-DYADE_MPI', None, 'class (Body|Scene)'),
		('-DYADE_OPENMP', None, 'class (Scene|EnergyTracker)'),
		(None, '-DYADE_LIQMIGRATION', 'class State'),
		(None, '-DYADE_SPH', 'class State'),
		(None, '-DYADE_DEFORM', 'class (Thermal)?State'),
		(None, ['-DYADE_MASK_ARBITRARY', '-DYADE_MASK_ARBITRARY_SIZE=256'], 'class Body'),
	]
)
def test_every_definition_that_changes_layouts_is_noticed(run_with_loader, remove, add, cause):

	def change(arguments):
		kept = [argument for argument in arguments if not remove or not argument.startswith(remove)]
		return kept + ([add] if isinstance(add, str) else add or [])

	expect_refusal(run_with_loader('LayoutCheck.cpp', change), cause)


def test_plugin_built_for_another_version_is_refused(run_with_loader):
	older = lambda arguments: [
		re.sub(r'(-DDDEM_YADE_VERSION=).*', r'\1"2024.1"', argument) for argument in arguments
	]
	expect_refusal(
		run_with_loader('Loader.cpp', older), r'version: YADE is [\d.]+, the plugin was built for 2024\.1'
	)
