# GPL v2 or later, see LICENSE.
"""Other ways to start YADE in the launcher's environment: yade-batch with a table, and plain Python."""
import os
import pathlib
import subprocess

import pytest

DDEM = pathlib.Path(__file__).resolve().parents[2] / 'scripts' / 'ddem'

BLOCK = '''
O.materials.append(DeformableElastMat(bulk=30e9, shear=26e9, density=2400, label='rock'))
block = ddem.append(ddem.mesh.rectangle(0.02, 0.04, size=size), 'rock')
platens = ddem.platens(block, velocity=velocity)
runner = PyRunner(command='record()', iterPeriod=10)
O.engines = [ForceResetter(), *platens.engines, DeformableEngine(rotation='none'), runner]
O.dt = ddem.time_step(0.8)
stresses = []

def record():
	stresses.append(platens.stress)

O.run(50, True)
'''


def shell(*command, folder, **environment):
	return subprocess.run(
		[DDEM, 'shell', *command], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
		stderr=subprocess.STDOUT, text=True, env={**os.environ, **environment}
	)


def test_yade_batch_runs_every_row_of_a_table(tmp_path):
	(tmp_path / 'table.txt').write_text('description velocity size\nslow 0.5 0.01\nfast 2 0.01\n')
	(tmp_path / 'job.py').write_text(
		f'''
from yade import ddem
readParamsFromTable(velocity=1, size=0.02, noTableOk=True)
from yade.params.table import *
{BLOCK}
open(O.tags['description'] + '.result', 'w').write(repr((velocity, len(block.triangle_ids), float(stresses[-1]))))
waitIfBatch()
'''
	)
	done = shell('yade-batch', '-j', '1', '--job-threads=1', 'table.txt', 'job.py', folder=tmp_path)
	logs = ''.join(path.read_text() for path in tmp_path.glob('*.log'))
	assert done.returncode == 0 and 'FAILED' not in done.stdout, done.stdout + logs
	slow, fast = (eval((tmp_path / f'{name}.result').read_text()) for name in ('slow', 'fast'))
	assert (slow[0], fast[0]) == (0.5, 2) and slow[1] == fast[1] > 10
	assert fast[2] == pytest.approx(4 * slow[2], rel=1e-6) and slow[2] > 0  # rotation 'none' is linear


@pytest.mark.parametrize('threads', ['1', '2'])
def test_plain_python_has_yade_with_the_plugin(tmp_path, threads):
	(tmp_path / 'study.py').write_text(
		f'''
import sys
from yade import *
from yade import ddem
velocity, size = 2, 0.01
{BLOCK}
print('RESULT', len(stresses), stresses[-1] > 0, O.numThreads, sys.argv[1:])
'''
	)
	done = shell('python3', 'study.py', 'an argument', folder=tmp_path, OMP_NUM_THREADS=threads)
	assert done.returncode == 0 and f"RESULT 4 True {threads} ['an argument']" in done.stdout, done.stdout


def test_modules_of_the_user_s_own_python_path_are_found(tmp_path):
	(tmp_path / 'mine').mkdir()
	(tmp_path / 'mine' / 'my_study.py').write_text('name = "mine"')
	command = 'import my_study, yade.ddem; print("FOUND", my_study.name)'
	done = shell('python3', '-c', command, folder=tmp_path, PYTHONPATH=str(tmp_path / 'mine'))
	assert done.returncode == 0 and 'FOUND mine' in done.stdout, done.stdout
