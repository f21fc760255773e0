# GPL v2 or later, see LICENSE.
"""ESyS-Particle as a peer: the same compression test of bonded spheres, run by that program and read back.

::

	sample = ddem.packing.read("particles.csv", "bonds.csv", length_unit="mm")
	record = ddem.studies.esys.run(ddem.studies.esys.Setup(sample, dt=1e-8, steps=25000), folder="out/esys")
	record.series["stress"], record.nanoseconds

Needs Debian's package esys-particle; ``scripts/ddem run`` installs it for scripts that say ``# needs: esys-particle``.
Nothing here needs YADE. The input script of ESyS-Particle is compression.py, which says what the model is.
"""
import collections
import contextlib
import json
import math
import os
import shutil
import subprocess
from dataclasses import dataclass, field, replace

import numpy as np

from ...packing import Packing
from ...series import Series

#: columns of a record, beside time
UNITS = {"strain": "-", "stress": "Pa", "force_top": "N", "force_bottom": "N", "broken": "-"}
_INPUT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "compression.py")
_WRITTEN = ("position.dat", "force.dat", "bonds.dat", "finished.json")
# Bound to no core, as YADE is not; more processes than cores are allowed; all on this machine, so that no network is
# looked for; a process that waits lets others have its core, without which the run comes almost to a stop where other
# programs want the cores.
_MPI = ("--bind-to", "none", "--oversubscribe", "--mca", "btl", "self,sm", "--mca", "mpi_yield_when_idle", "1")
_LAST_WORDS = 15  # lines of the output that go into an error


@dataclass(frozen=True)
class Setup:
	"""A compression test of bonded spheres between two elastic walls, which move along y towards each other;
	defaults as in ESyS-Particle's tutorial."""
	packing: Packing  # with its bonds; the walls start at the lower and upper face of its box
	dt: float  # time step [s]
	steps: int
	every: int = 5  # steps between records
	ramp_steps: int = 5000  # over which the speed of the walls grows linearly from zero
	speed: float = 0.125  # of each wall [m/s]
	wall_stiffness: float = 100e9  # K [Pa]; a sphere of radius r feels the spring pi r K
	young: float = 100e9  # of bonds and contacts [Pa]
	poisson: float = 0.25
	cohesion: float = 100e6  # of the bonds [Pa]
	bond_friction: float = 1.0  # tangent of the bonds' friction angle
	friction_static: float = 0.6
	friction_dynamic: float = 0.4
	viscosity: float = 2.0  # of the body damping [1/s]
	density: float = 1e6  # [kg/m³]
	mass_law: str = "cube"  # mass density r³, ESyS-Particle's own; "solid": of a full sphere

	def __post_init__(self):
		if self.packing.bonds is None or len(self.packing.bonds) == 0:
			raise ValueError("this packing has no bonds; set packing.bonds = packing.neighbours(gap)")
		if self.mass_law not in ("cube", "solid"):
			raise ValueError(f"mass_law = '{self.mass_law}' must be cube or solid")
		if not (self.dt > 0 and self.steps >= 2 and self.every >= 1 and self.ramp_steps >= 0):
			raise ValueError(
				f"dt = {self.dt} s, steps = {self.steps} (at least 2) and every = {self.every} must "
				f"be positive, ramp_steps = {self.ramp_steps} not negative"
			)
		if self.steps % self.every:
			raise ValueError(
				f"steps = {self.steps} must be a multiple of every = {self.every}, so that the last "
				"one is recorded"
			)

	@property
	def area(self):
		"""Of the loaded face [m²]."""
		return float(self.packing.size[0] * self.packing.size[2])


@dataclass
class Record:
	"""A finished test."""
	program: str
	setup: Setup
	# see UNITS; compression positive; broken counts bonds
	series: Series = field(default_factory=lambda: Series(time="s", **UNITS))
	# wall time from record to record without the first step, with recording [s]
	pieces: list = field(default_factory=list)
	threads: int = 1  # that calculate
	busy: float = math.nan  # processor time of the same steps, of all threads [s]; nan where it is not known
	bytes_per_particle: float = None  # see meter.bytes_per_particle; None where it is not known
	engines: list = field(default_factory=list)  # (name, ns per particle and step, share), see runs.engine_costs
	effects: list = field(default_factory=list)  # see effect_table.EffectTable.rows

	@property
	def seconds(self):
		"""Wall time of all steps but the first [s]."""
		return float(sum(self.pieces))

	@property
	def nanoseconds(self):
		"""Wall time per particle and step [ns]."""
		return 1e9 * self.seconds / ((self.setup.steps - 1) * len(self.setup.packing))

	@property
	def broken_share(self):
		"""Broken bonds over those at the start, at each record [-]."""
		return self.series["broken"] / len(self.setup.packing.bonds)


def run(setup, folder, workers=1, progress=lambda step: None):
	"""Run a test in ESyS-Particle, with one master process, which waits busily, and *workers* that calculate.

	:param folder: for its input and output; made when missing, its own older files are replaced
	:param progress: called with the number of the step, now and then
	:returns: :class:`Record`
	:raises RuntimeError: ESyS-Particle is not installed, or has failed: its last words
	"""
	programs = [shutil.which(name) for name in ("mpirun", "esysparticle")]
	if None in programs:
		raise RuntimeError(
			"ESyS-Particle is not installed on this machine: apt-get install esys-particle, or start the "
			"script with scripts/ddem run"
		)
	write_input(setup, folder, workers)
	command = [programs[0], *_MPI, "-n", str(workers + 1), programs[1], _INPUT]
	environment = {
		**os.environ,
		"OMPI_ALLOW_RUN_AS_ROOT": "1",
		"OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
		"PYTHONDONTWRITEBYTECODE": "1",
	}
	streams = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
	last = collections.deque(maxlen=_LAST_WORDS)
	with _ended(subprocess.Popen(command, cwd=folder, env=environment, **streams)) as process:
		for line in process.stdout:
			if line.startswith("step "):
				progress(int(line.split()[1]))
			elif line.strip():
				last.append(line.rstrip())
		code = process.wait()
	if code != 0 or not os.path.exists(os.path.join(folder, "finished.json")):
		raise RuntimeError(
			f"ESyS-Particle has failed (exit code {code}); its last words in {folder}:\n" + "\n".join(last)
		)
	return read_output(setup, folder, workers)


def undisturbed(records):
	"""One record of several runs of the same test, which only differ in time: of each piece the shortest, so that
	what else the machine does counts little."""
	return replace(records[0], pieces=np.min([record.pieces for record in records], axis=0).tolist())


def version():
	"""Version of the installed package, as "2.3.5+dfsg2-11"; None when no package manager knows it."""
	try:
		return (
			subprocess.run(
				["dpkg-query", "-W", "-f", "${Version}", "esys-particle"],
				capture_output=True,
				text=True,
				check=True,
			).stdout
			or None
		)
	except (OSError, subprocess.CalledProcessError):
		return None


def write_input(setup, folder, workers=1):
	"""Write what compression.py reads, in its units, into a folder; output of an earlier run is removed from it."""
	os.makedirs(folder, exist_ok=True)
	for name in _WRITTEN:
		with contextlib.suppress(FileNotFoundError):
			os.remove(os.path.join(folder, name))
	setup.packing.write(os.path.join(folder, "particles.csv"), os.path.join(folder, "bonds.csv"), length_unit="mm")
	with open(os.path.join(folder, "parameters.json"), "w") as file:
		json.dump(parameters(setup, workers), file, indent="\t")


def parameters(setup, workers=1):
	"""What compression.py reads from parameters.json: lengths in mm, times in ms, stresses in MPa,
	densities in g/mm³."""
	packing, largest = setup.packing, setup.packing.radii.max()
	margin = packing.size.max()
	mm, ms, mpa = 1e3, 1e3, 1e-6
	return {
		"steps": setup.steps,
		"every": setup.every,
		"dt": setup.dt * ms,
		"ramp_steps": setup.ramp_steps,
		"speed": setup.speed,
		"walls": [float(packing.lower[1] * mm), float(packing.upper[1] * mm)],
		"wall_stiffness": setup.wall_stiffness * mpa,
		"young": setup.young * mpa,
		"poisson": setup.poisson,
		"cohesion": setup.cohesion * mpa,
		"bond_friction": setup.bond_friction,
		"friction_static": setup.friction_static,
		"friction_dynamic": setup.friction_dynamic,
		"viscosity": setup.viscosity / ms,
		"density": setup.density * 1e-6,
		"mass_law": setup.mass_law,
		# The tutorial's for a largest radius of 2 mm: 5 mm and 0.08 mm.
		"grid_spacing": float(2.5 * largest * mm),
		"verlet_distance": float(0.04 * largest * mm),
		"domain": [((packing.lower - margin) * mm).tolist(), ((packing.upper + margin) * mm).tolist()],
		"workers": workers,
	}


def read_output(setup, folder, workers=1):
	"""The record of a run from what compression.py has left in a folder.

	:raises ValueError: a file is not what it should be: which, and what is wrong
	"""
	rows = setup.steps // setup.every + 1
	position, force, bonds = (
		_table(os.path.join(folder, name), rows, columns)
		for name, columns in (("position.dat", 6), ("force.dat", 6), ("bonds.dat", 1))
	)
	with open(os.path.join(folder, "finished.json")) as file:
		pieces = json.load(file)["pieces"]
	# Columns 1 and 4 are along y, of the bottom and of the top wall. Forces are those of the walls on the spheres.
	distance, bottom, top = position[:, 4] - position[:, 1], force[:, 1], -force[:, 4]
	record = Record("ESyS-Particle", setup, pieces=pieces, threads=workers)
	columns = {
		"time": setup.dt * setup.every * np.arange(rows),
		"strain": 1 - distance / distance[0],
		"stress": 0.5 * (top + bottom) / setup.area,
		"force_top": top,
		"force_bottom": bottom,
		"broken": bonds[0, 0] - bonds[:, 0],
	}
	for row in range(rows):
		record.series.append(**{name: values[row] for name, values in columns.items()})
	return record


def _table(path, rows, columns):
	try:
		table = np.loadtxt(path, ndmin=2)
	except ValueError as error:
		raise ValueError(f"{path}: {error}") from None
	if table.shape != (rows, columns):
		raise ValueError(
			f"{path}: {table.shape[0]} rows of {table.shape[1]} numbers instead of {rows} of {columns}"
		)
	return table


@contextlib.contextmanager
def _ended(process):
	"""A process that is ended when it is left, whatever has happened; mpirun takes the others with it."""
	with process:
		try:
			yield process
		finally:
			process.terminate()
