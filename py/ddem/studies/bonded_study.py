# GPL v2 or later, see LICENSE.
"""The study of bonded spheres after ESyS-Particle's tutorial: groups of runs, their spread over packings, and what the
paper claims about them. Needs no YADE.

The paper crushes spheres of three ranges of radii between walls of two stiffnesses, and shows broken bonds, forces on
both walls, and stress over strain. A :class:`Group` holds the runs of several packings with the same parameters, made
by scripts/ucs_bonded.py; :func:`claims` sets them beside the paper's numbers.
"""
import json
import os
from dataclasses import dataclass

import numpy as np

from .. import broken_bonds
from ..series import Series

RECORD = 1e-8  #: between two records of the paper [s]: every tenth step of 1 ns; its figures count them as steps

#: what ESyS-Particle 2.3.5 itself gives with the tutorial's parameters, by eq. 9: strength [MPa], Young's modulus [GPa]
#: (tests/data/esys/runs.csv)
ESYS = {"ref_s1": (148.9, 90.8), "dbl_s1": (96.9, 52.3), "ref_s1_rock": (124.6, 90.4)}
UCS_CLAIMED, YOUNG_CLAIMED, BROKEN_CLAIMED = (180.0, 300.0), (120.0, 190.0), (30.0, 40.0)  # MPa, GPa, %

#: columns of the table and of runs.csv: name, title, unit, format
FIGURES = (
	("particles", "spheres", "", "{:.0f}"), ("bonds", "bonds", "", "{:.0f}"), ("ucs_MPa", "UCS", "MPa", "{:.0f}"),
	("young_GPa", "E", "GPa", "{:.0f}"),
	("strain_at_peak_percent", "strain at the peak", "%", "{:.3f}"),
	("broken_at_peak_percent", "broken at the peak", "%", "{:.0f}"),
	("broken_at_end_percent", "broken at the end", "%", "{:.0f}"),
	("force_bottom_kN", "largest force, bottom", "kN", "{:.1f}"),
	("force_top_kN", "largest force, top", "kN", "{:.1f}"), ("time_bottom_ms", "at, bottom", "ms", "{:.3f}"),
	("time_top_ms", "at, top", "ms", "{:.3f}"),
	("ns_per_particle_step", "a sphere and step", "ns", "{:.0f}"), ("bytes_per_particle", "a sphere", "B", "{:.0f}")
)


class Record:
	"""A finished run, read from the folder that scripts/ucs_bonded.py left."""

	def __init__(self, folder):
		with open(os.path.join(folder, "summary.json")) as file:
			summary = json.load(file)
		self.folder, self.options, self.summary = folder, summary["options"], summary["models"]["rigid"]
		self.series, self.broken = (
			Series.read(os.path.join(folder, "rigid.csv")),
			broken_bonds.read(os.path.join(folder, "rigid_broken_bonds.csv")),
		)

	def curve(self, quantity, times):
		"""A quantity at given times [s]: a column of the series, or "broken_percent" of all bonds."""
		if quantity == "broken_percent":
			return 100 * broken_bonds.counts(self.broken, times) / self.summary["bonds"]
		return np.interp(times, self.series["time"], self.series[quantity], left=0.0)

	@property
	def wave_ratio(self):
		"""Speed of a wave along the sample over that of a wall [-]."""
		return self.summary["wave_speed_m_s"] / self.options["velocity"]

	def figures(self):
		"""What the run measured, by the names of :data:`FIGURES`."""
		series, summary = self.series, self.summary
		bottom, top = int(np.argmax(series["force_bottom"])), int(np.argmax(series["force_top"]))
		return {
			"particles": summary["particles"],
			"bonds": summary["bonds"],
			"ucs_MPa": summary["ucs_MPa"],
			"young_GPa": summary["young_GPa"],
			"strain_at_peak_percent": 100 * summary["strain_at_peak"],
			"broken_at_peak_percent": 100 * summary["damage_at_peak"],
			"broken_at_end_percent": 100 * summary["damage_at_end"],
			"force_bottom_kN": series["force_bottom"][bottom] / 1e3,
			"force_top_kN": series["force_top"][top] / 1e3,
			"time_bottom_ms": 1e3 * series["time"][bottom],
			"time_top_ms": 1e3 * series["time"][top],
			"ns_per_particle_step": summary.get("ns_per_particle_step"),
			"bytes_per_particle": summary.get("bytes_per_particle"),
		}


@dataclass(frozen=True)
class Spread:
	"""Median and range over packings; numbers, or arrays of the same length."""
	median: float
	low: float
	high: float

	@classmethod
	def of(cls, values):
		return cls(np.median(values, axis=0), np.min(values, axis=0), np.max(values, axis=0))

	def __rmul__(self, factor):
		return Spread(factor * self.median, factor * self.low, factor * self.high)

	def texts(self, form):
		"""Median, and range or nothing where there is none, as a table shows them."""
		median, low, high = (
			form.format(float(v)).replace("-", "−") for v in (self.median, self.low, self.high)
		)
		return median, "" if low == high else f"{low}{' to ' if '+' in form else '–'}{high}"

	def text(self, form):
		"""Both in one line."""
		median, around = self.texts(form)
		return f"{median} ({around})" if around else median


@dataclass
class Group:
	"""Runs with the same parameters on several packings."""
	name: str  # of files
	label: str  # for legends
	radii: tuple  # smallest and largest [m]
	stiffness: float  # of the walls [Pa]
	kind: str  # "paper" for the runs of the paper's figures, else what is different
	records: list

	def spread(self, figure):
		"""Of one of :data:`FIGURES`; None where no run has it."""
		values = [record.figures()[figure] for record in self.records]
		return None if None in values else Spread.of(np.array(values, float))

	def curve(self, quantity, times):
		"""Median and range of a quantity at given times [s]."""
		return Spread.of(np.array([record.curve(quantity, times) for record in self.records]))

	@property
	def range_text(self):
		return f"{1e3 * self.radii[0]:.1f}–{1e3 * self.radii[1]:.1f} mm"

	@property
	def end(self):
		"""Time up to which all runs go [s]."""
		return min(record.series.last("time") for record in self.records)


def write_curves(group, path, points=501):
	"""Median and range of broken bonds, forces, strain and stress over time as a CSV file."""
	times = np.linspace(0, group.end, points)
	units = {"time": "s"}
	columns = {"time": times}
	for quantity, unit in (
		("strain", "-"), ("stress", "Pa"), ("force_bottom", "N"), ("force_top", "N"), ("broken_percent", "%")
	):
		spread = group.curve(quantity, times)
		for part in ("median", "low", "high"):
			units[f"{quantity}_{part}"], columns[f"{quantity}_{part}"] = unit, getattr(spread, part)
	series = Series(**units)
	for row in range(points):
		series.append(**{name: values[row] for name, values in columns.items()})
	series.write(path)


# ---- the paper's claims ----


@dataclass(frozen=True)
class Claim:
	"""What the paper says, and what these runs give."""
	about: str
	paper: str
	here: str
	remark: str


def claims(groups):
	"""The paper's statements beside these groups, of which those of kind "paper" count;
	others are used where they are there."""
	paper = [group for group in groups if group.kind == "paper"]
	first = min(group.stiffness for group in paper)
	base = [group for group in paper if group.stiffness == first]
	strengths, moduli = (_over(paper, name) for name in ("ucs_MPa", "young_GPa"))
	ends, peaks = (_over(paper, name) for name in ("broken_at_end_percent", "broken_at_peak_percent"))
	times = [
		Spread.of([record.figures()[name] / 1e3 / RECORD for group in paper for record in group.records])
		for name in ("time_bottom_ms", "time_top_ms")
	]
	ratio = Spread.of(
		[
			100 * (record.figures()["force_top_kN"] / record.figures()["force_bottom_kN"] - 1)
			for group in paper
			for record in group.records
		]
	)
	rows = [
		Claim(
			"strength (UCS)",
			f"{_range(UCS_CLAIMED)} MPa",
			f"{strengths.text('{:.0f}')} MPa",
			_twice(strengths, UCS_CLAIMED, "MPa"),
		),
		Claim(
			"Young's modulus",
			f"{_range(YOUNG_CLAIMED)} GPa",
			f"{moduli.text('{:.0f}')} GPa",
			_twice(moduli, YOUNG_CLAIMED, "GPa"),
		),
		Claim(
			"bonds broken at the peak",
			"a significant fraction",
			f"{peaks.text('{:.0f}')} %",
			"of all bonds",
		),
		Claim(
			"bonds broken after the peak",
			f"{_range(BROKEN_CLAIMED)} %",
			f"{ends.text('{:.0f}')} %",
			f"at the end, {1e3 * min(g.end for g in paper):.2f} ms",
		),
		Claim(
			"largest force on the bottom wall",
			"between 15 000 and 20 000 increments",
			times[0].text("{:.0f}"),
			"counted in records, every 10 steps of 1 ns",
		),
		Claim("largest force on the top wall", "at bigger increments", times[1].text("{:.0f}"), "likewise"),
		Claim(
			"the same, over that on the bottom wall",
			"about 25 % more",
			f"{ratio.text('{:+.1f}')} %",
			"the paper does not say what its 25 % are counted from",
		),
	]
	if len({group.stiffness for group in paper}) > 1:
		said = "force slightly larger at the bottom, by about 25 % at the top"
		rows.append(
			Claim(
				"walls 2 % stiffer",
				said,
				_stiffer(paper),
				"medians of the largest forces, bottom and top",
			)
		)
	if len(base) > 1:
		shares = "; ".join(
			f"{g.range_text}: {g.spread('broken_at_end_percent').text('{:.0f}')} %" for g in base
		)
		rows.append(
			Claim(
				"larger spheres",
				"less intact after the peak",
				shares,
				f"bonds broken at the end, K = {first / 1e9:g} GPa",
			)
		)
	waves = Spread.of([record.wave_ratio for group in paper for record in group.records])
	return rows + [
		Claim(
			"wave speed over that of a wall",
			"about 2000",
			waves.text("{:.0f}"),
			"√(E/ρ), with the sample's modulus and the masses of the test",
		)
	]


def change(group, base, name):
	"""Change of a figure from a base group, packing by packing, as a share: :class:`Spread`."""
	return Spread.of(
		[new.figures()[name] / old.figures()[name] - 1 for new, old in zip(group.records, base.records)]
	)


def _over(groups, name):
	return Spread.of([record.figures()[name] for group in groups for record in group.records])


def _range(claimed):
	return f"{claimed[0]:g}–{claimed[1]:g}"


def _twice(spread, claimed, unit):
	return (
		f"by eq. 9, {place(spread, claimed)}; divided by A {(2 * spread).text('{:.0f}')} {unit}, "
		f"{place(2 * spread, claimed)}"
	)


def place(spread, claimed):
	"""Where a range lies in the claimed one, in words."""
	if claimed[0] <= spread.low and spread.high <= claimed[1]:
		return "inside"
	if spread.high < claimed[0]:
		return "below"
	return "above" if spread.low > claimed[1] else "partly inside"


def _stiffer(paper):
	soft, stiff = (
		sorted((g for g in paper if g.stiffness == k), key=lambda g: g.radii)
		for k in sorted({g.stiffness for g in paper})
	)
	parts = []
	for one, two in zip(soft, stiff):
		grown = [
			100 * (two.spread(name).median / one.spread(name).median - 1)
			for name in ("force_bottom_kN", "force_top_kN")
		]
		parts.append(f"{one.range_text}: {grown[0]:+.1f} %, {grown[1]:+.1f} %")
	return "; ".join(parts).replace("-", "−")
