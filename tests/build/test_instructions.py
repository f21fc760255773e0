# GPL v2 or later, see LICENSE.
# needs: valgrind
# An effect that is off costs no instruction, and neither does what another group of triangles simulates: counted by
# callgrind, so nothing depends on the machine's speed.
import json
import os
import pathlib
import re
import shlex
import subprocess

import pytest

pytestmark = pytest.mark.slow

SOURCES = pathlib.Path(__file__).parent / 'instructions'
ROTATIONS = {'none': 0, 'corotational': 1, 'cosserat': 2}
# ConcreteEffects: book 1, flow 2, rate 4, damage 8, equation of state 16; a rate without flow is none.
MASKS = [mask for mask in range(32) if mask & 2 or not mask & 4]


@pytest.fixture(scope='module')
def build_program(tmp_path_factory):
	"""Builds a program of the folder instructions as the kernel's widest loops are built; gives its path."""
	build = os.environ['DDEM_BUILD_DIR']
	commands = json.load(open(os.path.join(build, 'compile_commands.json')))
	entry = next(entry for entry in commands if entry['file'].endswith('/ConcreteDamageCorotationalAvx2.cpp'))
	words = [word for word in shlex.split(entry['command']) if not word.endswith('ccache')]
	in_out = ('-c', '-o')
	compiler = [word for word, before in zip(words, [''] + words) if word not in in_out and before not in in_out]

	def build_it(source, name, *flags):
		# wide only where a loop is made in it
		arguments = compiler if flags else [word for word in compiler if word not in ('-mavx2', '-mfma')]
		program = tmp_path_factory.getbasetemp() / name
		link = ['-static', os.path.join(build, 'libddem_kernel.a'), '-fopenmp']
		command = [*arguments, *flags, str(SOURCES / source), *link, '-o', str(program)]
		subprocess.run(command, cwd=entry['directory'], check=True)
		return program

	return build_it


@pytest.fixture(scope='module')
def tile(build_program):
	return build_program('tile.cpp', 'tile')


@pytest.fixture(scope='module')
def system(build_program):
	return build_program('system.cpp', 'system')


def instructions(program, function, *arguments):
	"""Instructions inside a function, and what the program printed."""
	options = ['--tool=callgrind', '--callgrind-out-file=/dev/null', '--toggle-collect=' + function]
	command = ['valgrind', *options, program, *map(str, arguments)]
	result = subprocess.run(command, capture_output=True, text=True)
	assert result.returncode == 0, result.stderr
	count = int(re.search(r'Collected : (\d+)', result.stderr).group(1))
	assert count > 10000, result.stderr  # the function was found
	return count, result.stdout


@pytest.mark.parametrize('mask', MASKS)
def test_mask_costs_what_it_costs_alone(mask, tile, build_program):
	loop = '*advanceBatches*ConcreteDamage*'
	together, result = instructions(tile, loop, mask, 40)
	program = build_program('tile.cpp', 'alone%d' % mask, '-DALONE=%d' % mask)
	alone, result_alone = instructions(program, loop, mask, 40)
	assert float(result) == pytest.approx(float(result_alone), rel=1e-12)  # the same work
	assert together == pytest.approx(alone, rel=0.005)


def test_each_effect_costs_something_when_on(tile):
	loop = '*advanceBatches*ConcreteDamage*'
	cost = {mask: instructions(tile, loop, mask, 40)[0] for mask in (0, 2, 6, 8, 14, 16, 30, 31)}
	for less, more in ((0, 2), (2, 6), (0, 8), (6, 14), (0, 16), (14, 30), (30, 31)):
		assert cost[less] < 0.98 * cost[more], cost


@pytest.mark.parametrize('rotation', ROTATIONS.values(), ids=ROTATIONS)
def test_elastic_beside_concrete_costs_what_it_costs_alone(rotation, system):
	loop = '*advanceBatches*Elastic*'
	alone, _ = instructions(system, loop, 'elastic', rotation, 20)  # 1024 triangles
	beside, _ = instructions(system, loop, 'beside', rotation, 20)  # 512 of them
	assert 2 * beside == pytest.approx(alone, rel=0.005)


WHOLE_STEP = 'yade::ddem::TriangleSystem::step(yade::ddem::StepSettings const&)'


@pytest.mark.parametrize('rotation', ROTATIONS.values(), ids=ROTATIONS)
@pytest.mark.parametrize('law', ['ScalarDamage', 'VonMises'])
def test_law_below_its_threshold_costs_little_more_than_elasticity(law, rotation, system):
	elastic, _ = instructions(system, WHOLE_STEP, 'elastic', rotation, 20)
	below, _ = instructions(system, WHOLE_STEP, law, rotation, 20)
	assert elastic < below < 1.15 * elastic


@pytest.mark.parametrize('rotation', ROTATIONS.values(), ids=ROTATIONS)
def test_concrete_at_rest_skips_its_law(rotation, system):
	elastic, _ = instructions(system, WHOLE_STEP, 'elastic', rotation, 200)
	rest, _ = instructions(system, WHOLE_STEP, 'rest', rotation, 200)
	moving, _ = instructions(system, WHOLE_STEP, 'concrete', rotation, 200)
	assert rest < 1.9 * elastic  # it reads its state and compares its strain
	assert moving > 5 * elastic
