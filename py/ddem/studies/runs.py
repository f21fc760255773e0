# GPL v2 or later, see LICENSE.
"""The record of a finished test in compression or tension, as plain data:
what files, tables and pictures are made from."""
import math
from dataclasses import dataclass, field

import numpy as np

from ..series import Series
from .measures import Strength, strength
from .wording import COMPRESSION, Wording

#: entries of the energy book by part, in the order in which pictures stack them
ENERGY_PARTS = {
	"elastic": ("elastPotential", "elastRotation", "bondElastic", "contactElastic", "wallElastic"),
	"kinetic": ("kinetic", ),
	"plastic flow": ("plasticFlow", ),
	"damage": ("damage", ),
	"broken bonds": ("bondBroken", ),
	"friction": ("friction", ),
	"damping": ("bodyDamping", "nonviscDamp", "contactDamping"),
}
RECORDER = "recorder"  #: label of the engine that keeps the record
EXTERNAL = ("externalWork", "gravWork")  #: what came in from outside, booked with a minus sign


@dataclass
class Run:
	"""A finished test of one model."""
	model: str  # "rigid" or "deformable"
	title: str  # for legends, as "rigid bonded spheres"
	particle: str  # what a particle is, as "sphere"
	particles: int
	degrees_of_freedom: int
	dt: float  # time step [s]
	critical_dt: float  # largest stable time step at the start [s]
	steps: int
	wall: float  # wall time of all steps with their recording [s]
	busy: float  # processor time of the same, all threads together [s]
	threads: int
	# time, strain, stress, force_top, force_bottom, damage, energy_… and energy_drift
	# (what the book has too much) [SI]; loading counts positive
	series: Series
	snapshots: list  # of snapshots.TriangleSnapshot or SphereSnapshot, in order of time
	engines: list  # (name, wall seconds, calls) in order
	energy_error: float  # largest error of the energy book, see energy.EnergyBalance.largest [-]
	stopped: str  # why the run ended
	setup: float = 0.0  # wall time until the first step [s]
	parameters: list = field(default_factory=list)  # (name, value with unit, meaning)
	extra: dict = field(default_factory=dict)  # further figures for the summary
	test: str = "compression"  # or "tension", where stress, strain and forces are positive in tension
	effects: list = field(default_factory=list)  # of the scene at the end, see effect_table.EffectTable.rows
	broken: np.ndarray = None  # records of the broken bonds (broken_bonds.DTYPE), None where there are no bonds
	wording: Wording = COMPRESSION  # what this kind of test calls what it measures
	recorded: float = None  # processor time of the recording [s]; None: as by the clock
	bytes_per_particle: float = None  # see meter.bytes_per_particle; None where it is not known
	yielded: bool = False  # whether triangles have a plastic strain at the end

	@property
	def strength(self) -> Strength:
		"""Measures of the stress–strain curve."""
		return strength(self.series["strain"], self.series["stress"])

	@property
	def has_strength(self):
		"""Whether the largest stress is a strength, or at least a lower bound of one: the stress has fallen
		from it, or something has broken or yielded. An elastic sample has none."""
		return self.strength.peaked or self.yielded or bool((self.series["damage"] > 0).any())

	@property
	def energy_through(self):
		"""The larger of the work put in and the energy found in the sample, at most [J];
		not a number where no book was kept."""
		if self.energy("input") is None:
			return math.nan
		found = sum(values for values in map(self.energy, ENERGY_PARTS) if values is not None)
		return float(max(np.abs(self.energy("input")).max(), np.max(found)))

	@property
	def recording(self):
		"""Wall time of the recorder [s]."""
		return sum(seconds for name, seconds, _ in self.engines if name == RECORDER)

	@property
	def seconds_per_step(self):
		"""Processor time of a step, of all threads together, the recorder left out [s]; see :mod:`meter`."""
		recorded = self.recording if self.recorded is None else self.recorded
		return max(0.0, self.busy - recorded) / self.steps

	def engine_costs(self, least=0.0):
		"""Where the time goes: (name, ns per particle and step by the clock, share of all engines), the largest
		first; those with less than *least* of the time together as "others"."""
		return engine_costs(self.engines, self.steps * self.particles, least)

	def energy(self, part):
		"""One of :data:`ENERGY_PARTS`, or "input", over time [J];
		None when the book has none of its entries."""
		sign, entries = (-1, EXTERNAL) if part == "input" else (1, ENERGY_PARTS[part])
		found = [self.series[f"energy_{name}"] for name in entries if f"energy_{name}" in self.series.units]
		return sign * sum(found) if found else None

	def snapshot_near(self, time):
		"""The snapshot closest to a time [s]."""
		return min(self.snapshots, key=lambda snapshot: abs(snapshot.time - time))

	def summary(self):
		"""Figures for summary.json: units in the names, None where a figure does not exist."""
		measures = self.strength
		damage = self.series["damage"]
		figures = {
			"particles": self.particles,
			"degrees_of_freedom": self.degrees_of_freedom,
			"dt_s": self.dt,
			"dt_over_critical": self.dt / self.critical_dt,
			"steps": self.steps,
			"wall_s": self.wall,
			"cpu_s": self.busy,
			"recording_s": self.recording,
			"setup_s": self.setup,
			"ns_per_particle_step": 1e9 * self.seconds_per_step / self.particles,
			"ns_per_degree_of_freedom_step": 1e9 * self.seconds_per_step / self.degrees_of_freedom,
			"bytes_per_particle": self.bytes_per_particle,
			"engines": plain_costs(self.engine_costs()),
			"test": self.test,
			"ucs_MPa": None,
			"tensile_MPa": None,
			"peak_passed": measures.peaked,
			"young_GPa": measures.young / 1e9 if self.wording.modulus == "young_GPa" else None,
			"strain_at_peak": measures.strain_at_peak,
			"damage_at_peak": float(damage[measures.peak]),
			"damage_at_end": float(damage[-1]),
			"strain_at_end": self.series.last("strain"),
			"stress_at_end_MPa": self.series.last("stress") / 1e6,
			"energy_error": self.energy_error,
			"stopped": self.stopped,
			self.wording.strength: measures.ucs / 1e6 if self.has_strength else None,
			**({self.wording.modulus: measures.young / 1e9} if self.wording.modulus else {}),
			"effects": self.effects,
			**self.extra,
		}
		return {
			name: None if isinstance(value, float) and not math.isfinite(value) else value
			for name, value in figures.items()
		}


def engine_costs(engines, particle_steps, least=0.0):
	"""Where the time goes, see :meth:`Run.engine_costs`.

	:param engines: (name, wall seconds, calls) of each
	:param particle_steps: steps times particles
	"""
	ran = {}  # those of one name together, such as of two platens
	for name, seconds, calls in engines:
		if calls:
			ran[name] = ran.get(name, 0.0) + seconds
	total = sum(ran.values()) or 1.0
	rows = [(name, 1e9 * seconds / particle_steps, seconds / total) for name, seconds in ran.items()]
	large = sorted((row for row in rows if row[2] >= least), key=lambda row: -row[1])
	small = [row for row in rows if row[2] < least]
	if small:
		large.append(("others", sum(row[1] for row in small), sum(row[2] for row in small)))
	return large


def plain_costs(rows):
	"""Rows of :func:`engine_costs` for files and pages: dicts of engine, ns_per_particle_step, share."""
	return [{"engine": name, "ns_per_particle_step": ns, "share": share} for name, ns, share in rows]


def cost_ratios(runs):
	"""How much the deformable model costs, over the rigid one, by measure; empty unless there are both."""
	by_model = {run.model: run for run in runs}
	if not {"rigid", "deformable"} <= by_model.keys():
		return {}
	rigid, deformable = by_model["rigid"].summary(), by_model["deformable"].summary()
	return {
		name: deformable[name] / rigid[name]
		for name in ("wall_s", "steps", "ns_per_particle_step", "ns_per_degree_of_freedom_step")
	}
