# GPL v2 or later, see LICENSE.
"""The uniaxial tests: crush a sample between platens, or pull it apart, keep the record, and know when to stop."""
import math
import time

import numpy as np
from tqdm import tqdm

from yade import O, PyRunner, timing

from .. import loading, meter
from ..block import Block
from ..effect_table import effects
from ..energy import EnergyBalance
from ..series import Series
from .runs import RECORDER, Run
from .snapshots import SphereMotion, TriangleSnapshot
from .wording import COMPRESSION, TENSION

ROWS = 1000  #: records up to the largest strain, unless told otherwise
SNAPSHOTS = 100  #: pictures in memory up to the largest strain
FILES = 50  #: calls of the recorders up to the largest strain
_HELD = 0.02  # part of the largest strain over which the stress must stay low before the test is over

running = None  #: the test that is running, for the PyRunner that calls it


class Specimen:
	"""What a test asks of a sample, the same for both models."""

	def __init__(self, sample):
		self.sample = sample
		self.deformable = isinstance(sample, Block)
		self.model, self.title, self.particle = (
			("deformable", "deformable triangles", "triangle")
			if self.deformable
			else ("rigid", "rigid bonded spheres", "sphere")
		)
		self.particles = len(sample.triangle_ids if self.deformable else sample.ids)
		self.degrees_of_freedom = None

	def prepare(self):
		"""Called once the engines are set."""
		self.degrees_of_freedom = int(self.sample.degrees_of_freedom)
		if self.deformable:
			breaks = [hasattr(O.bodies[i].mat, "fractureEnergy") for i in self.sample.triangle_ids]
			self._weights = self.sample.area * (breaks if any(breaks) else 1)

	@property
	def damage(self):
		"""Damage of the whole sample, 0 to 1: mean of what can break by area (of concrete η/η_max; 0 where
		nothing can), or the broken share of the bonds."""
		if self.deformable:
			return float(np.average(self.sample.damage, weights=self._weights))
		return self.sample.broken_fraction

	@property
	def yielded(self):
		"""Whether triangles have a plastic strain."""
		return self.deformable and bool(np.any(self.sample.plastic_strain))

	def look(self, loads=()):
		"""What of a snapshot of this moment must be kept now; *loads*: lines that show them in pictures."""
		if self.deformable:
			return TriangleSnapshot.of(self.sample, O.time)
		return SphereMotion.of(self.sample, O.time, loads)

	def snapshots(self, looks):
		"""The snapshots of what was kept, see :mod:`snapshots`."""
		if self.deformable:
			return looks
		bonds = self.sample.bond_records
		return [one.snapshot(bonds) for one in looks]

	def figures(self):
		"""Further figures for the summary."""
		if self.deformable:
			rotation = self.sample.rotation
			return {
				"nodes": len(self.sample.node_ids),
				"largest_rotation_rad": float(np.abs(rotation).max()),
			}
		modes = self.sample.broken["mode"]
		return {
			"bonds": self.sample.initial_bonds,
			"broken_in_tension": int((modes == "tension").sum()),
			"broken_in_shear": int((modes == "shear").sum()),
		}

	@property
	def broken(self):
		"""Records of the broken bonds, see :attr:`bonded.BondedSample.broken`;
		None where there are no bonds."""
		return None if self.deformable else self.sample.broken


class CompressionTest:
	"""Runs the scene until the sample has failed, or to the largest strain::

		test = ddem.studies.uniaxial.CompressionTest(platens, duration=2e-3)
		O.engines = [...]
		O.dt = ddem.time_step(0.8)
		run = test.run()                # a runs.Run
		print(run.summary()["ucs_MPa"])

	Stress, strain and forces are positive in compression.

	:param platens: of either model; they know the sample
	:param duration: longest time to run [s]
	:param stop: the sample has failed when its stress stays below this part of the peak; 0: run for the whole
		duration
	:param recorders: called at the start, now and then, and at the end, for instance :class:`vtk.Recorder`
	:param critical_dt: largest stable time step [s], to report
	:param rows: records in the longest time
	:param snapshots: False keeps none between start and end, where nothing is to be drawn
	:param book: False keeps no energy book, which saves its time: no energies in the record, and an energy error
		that is not a number
	"""

	kind, wording = "compression", COMPRESSION
	sense = 1  #: in which stress, strain and forces of the platens, positive in compression, are recorded

	def __init__(
		self, platens, duration, stop=0.2, recorders=(), critical_dt=float("nan"), rows=ROWS, snapshots=True,
		book=True
	):
		if not duration > 0:
			raise ValueError(f"duration = {duration} s must be positive")
		if not 0 <= stop < 1:
			raise ValueError(f"stop = {stop} must be a part of the peak stress, from 0 to below 1")
		self.platens, self.duration, self.stop, self.recorders, self.critical_dt = (
			platens, duration, stop, tuple(recorders), critical_dt
		)
		if rows < SNAPSHOTS:
			raise ValueError(f"rows = {rows} must be at least {SNAPSHOTS}")
		self.specimen, self.longest = Specimen(platens.sample), rows
		self.rows, self._looks, self._between = [], [], snapshots
		self._peak, self._low = 0.0, 0
		self.stopped = self._filed = self.book = None
		self._booked = book

	def run(self, progress=True):
		"""Run the test and return its :class:`runs.Run`. The scene stays as it is at the end,
		for a closer look.

		:raises ValueError: no time step
		:raises RuntimeError: the run stopped with an error
		"""
		global running
		if not O.dt > 0:
			raise ValueError(
				f"O.dt = {O.dt} s must be positive; set it to ddem.time_step(0.8) or "
				"ddem.bonded.time_step(0.8)"
			)
		steps = max(1, round(self.duration / O.dt))
		period = max(1, steps // self.longest)
		self._held = max(2, round(_HELD * steps / period))
		self._end, self._dt = O.time + self.duration, O.dt
		self.specimen.prepare()
		if self._booked:
			self.book = EnergyBalance()
		else:
			O.trackEnergy = False
		recorder = "__import__('yade.ddem.studies.uniaxial', fromlist=['running']).running.record()"
		O.engines = O.engines + [
			PyRunner(command=recorder, iterPeriod=period, firstIterRun=period, label=RECORDER)
		]
		O.timingEnabled = True
		timing.reset()
		with meter.beside_the_scene():
			self._look(files=True)
		running, self._first, self._bytes = self, O.iter, None
		start, busy, beside = time.perf_counter(), time.process_time(), meter.time_beside()
		try:
			with tqdm(
				total=steps, unit="step", desc=self.specimen.title, mininterval=0.5,
				disable=None if progress else True
			) as self._bar:
				# to the nearest step; in time, since a time stepper may change O.dt
				loading.run(until=self._end - 0.5 * O.dt, progress=False)
		finally:
			running = None
		wall, busy = time.perf_counter() - start, time.process_time() - busy
		if self.stopped is None:
			self.stopped = "largest strain reached"
		self._look(files=True)
		return self._result(wall, busy, meter.time_beside() - beside)

	def record(self):
		"""Add a row to the record; called by the scene."""
		with meter.beside_the_steps():
			self._record()

	def _record(self):
		if not self.rows:
			self._bytes = meter.bytes_per_particle()
		energies = self.book.record() if self.book else {}
		row = {
			"time": O.time,
			**{
				name: self.sense * getattr(self.platens, name)
				for name in ("strain", "stress", "force_top", "force_bottom")
			},
			"damage": self.specimen.damage,
			**{column.name: getattr(self.platens, column.name) for column in self.wording.also},
		}
		if self.book:
			row["energy_drift"] = self.book.recorded_drift
		self.rows.append({**row, **{f"energy_{name}": value for name, value in energies.items()}})
		due = [len(self.rows) % (self.longest // times) == 0 for times in (FILES, SNAPSHOTS)]
		if any(due):
			self._look(files=due[0], snapshot=due[1] and self._between)
		self._peak = max(self._peak, row["stress"])
		self._low = self._low + 1 if row["stress"] < self.stop * self._peak else 0  # records in a row
		if self.stop and len(self.rows) > self._held and self._low >= self._held:
			self.stopped = f"stress stayed below {100 * self.stop:g} % of the peak"
			O.pause()
		done = O.iter - self._first
		self._bar.total = done + max(0, round((self._end - O.time) / O.dt))
		self._bar.update(done - self._bar.n)
		self._bar.set_postfix_str(
			f"strain {100 * row['strain']:.2f} %, stress {row['stress'] / 1e6:.0f} MPa", refresh=False
		)

	def _look(self, files, snapshot=True):
		"""Keep a snapshot of this moment, and let the recorders write theirs; each once a moment."""
		if snapshot and (not self._looks or self._looks[-1].time < O.time):
			self._looks.append(self.specimen.look(getattr(self.platens, "outlines", ())))
		if files and self._filed != O.time:
			self._filed = O.time
			for recorder in self.recorders:
				recorder()

	def _result(self, wall, busy, recorded):
		units = {
			"time": "s", "strain": "-", "stress": "Pa", "force_top": "N", "force_bottom": "N",
			"damage": "-",
			**{column.name: column.unit for column in self.wording.also}
		}
		names = dict.fromkeys(name for row in self.rows for name in row)
		series = Series(**{name: units.get(name, "J") for name in names})
		for row in self.rows:
			series.append(**{name: row.get(name, 0.0) for name in names})
		specimen = self.specimen
		return Run(
			model=specimen.model, title=specimen.title, particle=specimen.particle,
			particles=specimen.particles,
			degrees_of_freedom=specimen.degrees_of_freedom, dt=self._dt, critical_dt=self.critical_dt,
			steps=O.iter - self._first, wall=wall, busy=busy, recorded=recorded,
			threads=O.numThreads, series=series, snapshots=specimen.snapshots(self._looks),
			engines=[(e.label or type(e).__name__, 1e-9 * e.execTime, e.execCount) for e in O.engines],
			energy_error=self.book.largest if self.book else math.nan, stopped=self.stopped,
			extra=specimen.figures(),
			test=self.kind, wording=self.wording, broken=specimen.broken, effects=effects().rows(),
			bytes_per_particle=self._bytes, yielded=specimen.yielded
		)


class TensionTest(CompressionTest):
	"""The same with platens that pull (a negative velocity): stress, strain and forces are positive in tension, and
	the strength is that in tension."""

	kind, wording, sense = "tension", TENSION, -1
