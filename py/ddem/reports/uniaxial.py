# GPL v2 or later, see LICENSE.
"""Report of tests in compression or tension: table, summary.json, a CSV a model, broken bonds, pictures,
and a report.html that holds everything.

Works on finished runs (:class:`studies.runs.Run`), so a report can be made again without the scene::

	report = ddem.reports.uniaxial.Report(runs, folder="out", title="…", settings={...}, command="…")
	report.write()
	print(report.table())
"""
import datetime
import os

from .. import broken_bonds, provenance
from ..studies.runs import cost_ratios
from . import figures, pages

THOUSANDS = "\u202f"  #: between thousands: a narrow space

#: rows of the table: name in the summary, text, unit shown, factor to it, format; None: a line
ROWS = (
	("particles", "particles", "", 1, "{:,d}"),
	("degrees_of_freedom", "degrees of freedom", "", 1, "{:,d}"),
	("bonds", "bonds at the start", "", 1, "{:,d}"),
	None,
	("ucs_MPa", "strength (UCS)", "MPa", 1, "{:.1f}"),
	("tensile_MPa", "tensile strength", "MPa", 1, "{:.2f}"),
	("young_GPa", "Young's modulus", "GPa", 1, "{:.1f}"),
	("strain_at_peak", "strain at the peak", "%", 100, "{:.3f}"),
	("damage_at_peak", "damage at the peak", "", 1, "{:.3f}"),
	("damage_at_end", "damage at the end", "", 1, "{:.3f}"),
	("broken_in_tension", "bonds broken in tension", "", 1, "{:,d}"),
	("broken_in_shear", "bonds broken in shear", "", 1, "{:,d}"),
	("strain_at_end", "strain at the end", "%", 100, "{:.3f}"),
	("energy_error", "energy error", "", 1, "{:.1e}"),
	None,
	("dt_s", "time step", "µs", 1e6, "{:.3f}"),
	("steps", "steps", "", 1, "{:,d}"),
	("cpu_s", "processor time", "s", 1, "{:.1f}"),
	("wall_s", "wall time", "s", 1, "{:.1f}"),
	("recording_s", "of it for recording", "s", 1, "{:.1f}"),
	("ns_per_particle_step", "per particle and step", "ns", 1, "{:,.0f}"),
	("ns_per_degree_of_freedom_step", "per degree of freedom and step", "ns", 1, "{:,.0f}"),
	("bytes_per_particle", "memory per particle", "B", 1, "{:,.0f}"),
)
#: rows that are left out where no run has them
_IF_ANY = {"bonds", "ucs_MPa", "tensile_MPa", "young_GPa", "broken_in_tension", "broken_in_shear"}


class Report:
	"""The report of one or two runs.

	:param runs: list of :class:`studies.runs.Run`
	:param folder: where everything goes; made when missing
	:param title: heading of the report
	:param settings: (name, value with unit, meaning) of what both tests share
	:param command: the command line that made it
	:param options: plain values of all options and the seed, for summary.json
	:param versions: name -> version of the programs used
	:param notes: sentences for the report: choices, calibration, limits
	:param pictures: False leaves the pictures out
	:param pdf: write each picture as a PDF as well
	:param cost: what this accuracy cost, an :class:`accuracy.section.Section`; None: it was not asked for
	"""

	def __init__(
		self, runs, folder, title, settings=(), command="", options=None, versions=None, notes=(),
		pictures=True, pdf=False, cost=None
	):
		if not runs:
			raise ValueError("a report needs at least one run")
		self.runs, self.folder, self.title, self.settings, self.command = (
			list(runs), str(folder), title, list(settings), command
		)
		self.options, self.versions, self.notes = dict(options or {}), dict(versions or {}), list(notes)
		self.pictures, self.pdf, self.cost = pictures, pdf, cost
		self.written = datetime.datetime.now().astimezone().replace(microsecond=0)

	def summary(self):
		"""What summary.json holds."""
		return {
			"title": self.title,
			"written": self.written.isoformat(),
			"command": self.command,
			"options": self.options,
			"versions": self.versions,
			"machine": {**pages.machine(), "threads": self.runs[0].threads},
			"models": {
				run.model: {
					**run.summary(),
					"parameters": {name: value for name, value, _ in run.parameters},
				}
				for run in self.runs
			},
			"cost_ratio_deformable_to_rigid": cost_ratios(self.runs),
			**({"cost": self.cost.plain()} if self.cost else {}),
		}

	def table_rows(self):
		"""(text, unit, one formatted value a run) for the table; None for a line."""
		summaries = [run.summary() for run in self.runs]
		rows, words = [], self.runs[0].wording
		place = [row and row[0] for row in ROWS].index("young_GPa")
		for row in (*ROWS[:place], *words.rows, *ROWS[place:]):
			if row is None:
				rows.append(None)
				continue
			name, text, unit, factor, form = row
			values = [summary.get(name) for summary in summaries]
			if name not in _IF_ANY or name == words.strength or any(value is not None for value in values):
				rows.append((text, unit, [_formatted(value, factor, form) for value in values]))
		return rows

	def table(self):
		"""The figures of all runs side by side, for a terminal."""
		rows = self.table_rows()
		titles = [run.title for run in self.runs]
		first = max(len(f"{text} [{unit}]") if unit else len(text) for text, unit, _ in filter(None, rows))
		widths = [
			max(len(title), *(len(values[i]) for _, _, values in filter(None, rows)))
			for i, title in enumerate(titles)
		]
		rule = "-" * (first + sum(width + 3 for width in widths))
		lines = [" " * first + "".join(f"   {title:>{width}}" for title, width in zip(titles, widths)), rule]
		for row in rows:
			if row is None:
				lines.append(rule)
				continue
			text, unit, values = row
			lines.append(
				f"{f'{text} [{unit}]' if unit else text:<{first}}"
				+ "".join(f"   {value:>{width}}" for value, width in zip(values, widths))
			)
		return "\n".join(lines)

	def write(self):
		"""Write all files and return the path of report.html."""
		os.makedirs(self.folder, exist_ok=True)
		provenance.write_json(self._path("summary.json"), self.summary(), indent=2, allow_nan=False)
		for run in self.runs:
			run.series.write(self._path(f"{run.model}.csv"))
			if run.broken is not None:
				broken_bonds.write(run.broken, self._path(f"{run.model}_broken_bonds.csv"))
		drawn = {}
		if self.pictures:
			drawn = {name: draw(self.runs) for name, draw in figures.ALL.items()}
			drawn.update(self.cost.figures() if self.cost else {})
		pictures = pages.save(drawn, self.folder, self.pdf)
		return pages.write(self.html(pictures), self._path("report.html"))

	def html(self, pictures):
		"""The page; *pictures* (:class:`pages.Picture`) by name."""
		summary = self.summary()
		return pages.render(
			"compression.html", title=self.title, written=self.written, command=self.command,
			settings=self.settings, notes=self.notes, versions=self.versions,
			machine=summary["machine"], runs=self.runs, by_model={run.model: run for run in self.runs},
			summaries=summary["models"], rows=self.table_rows(),
			ratios=summary["cost_ratio_deformable_to_rigid"], pictures=pictures, options=self.options,
			one=self.runs[0] if len(self.runs) == 1 else None, cost=self.cost
		)

	def _path(self, name):
		return os.path.join(self.folder, name)


def _formatted(value, factor, form):
	return "–" if value is None else form.format(factor * value).replace(",", THOUSANDS)
