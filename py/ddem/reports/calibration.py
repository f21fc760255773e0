# GPL v2 or later, see LICENSE.
"""Report of a calibration: progress lines, table, calibration.json, pictures,
and a calibration.html that holds everything.

::

	report = CalibrationReport(outcome, bench, model="rigid", folder="out", title="…")
	print(report.table())
	report.write()
"""
import datetime
import math
import os

import numpy as np
from markupsafe import Markup
from matplotlib import rc_context
from matplotlib.ticker import FuncFormatter, MaxNLocator, NullLocator

from .. import plots, provenance
from ..studies.runs import plain_costs
from ..studies.calibration_quantities import MEASURES, TUNABLES
from . import pages

_WIDTH = 11  # of a column of progress


class Progress:
	"""A line a point, for a terminal; pass it as *tell* of a :class:`studies.calibration.Calibration`.

	:param model: "rigid" or "deformable"
	:param parameters, targets: those of the calibration
	:param write: called with each line
	"""

	def __init__(self, model, parameters, targets, write=print):
		self.tuned, self.measures = (
			[TUNABLES[model][p.name] for p in parameters],
			[MEASURES[t.name] for t in targets],
		)
		self.targets, self.write = targets, write

	def header(self):
		"""Names and units of the columns, and the targets below."""
		names = [f"{q.name} [{q.unit}]" if q.unit else q.name for q in self.tuned]
		self._widths = [max(_WIDTH, len(name) + 2) for name in names]
		first = (
			"".join(f"{name:>{width}}" for name, width in zip(names, self._widths))
			+ "   "
			+ "".join(f"{q.title:>{_WIDTH}}" for q in self.measures)
		)
		aims = [
			f"{target.value / q.factor:.4g} ± {100 * target.tolerance:.2g} %"
			for target, q in zip(self.targets, self.measures)
		]
		second = " " * (sum(self._widths) + 3) + "".join(f"{aim:>{max(_WIDTH, len(aim) + 1)}}" for aim in aims)
		self.write(f"{'':28}{first}\n{'   n   point':28}{second}")

	def __call__(self, step):
		values = "".join(
			f"{step.point.values[q.name] / q.factor:>{width}.5g}"
			for q, width in zip(self.tuned, self._widths)
		)
		line = f"{step.number:4d}   {self._purpose(step):21}{values}   "
		if step.point.error:
			self.write(f"{line}FAILED: {step.point.error}")
			return
		measured = "".join(f"{step.point.measured[q.name] / q.factor:>{_WIDTH}.4g}" for q in self.measures)
		misses = ", ".join(
			f"{q.symbol} {percent(target.miss(step.point))}"
			for target, q in zip(self.targets, self.measures)
		)
		met = all(abs(target.miss(step.point)) <= target.tolerance for target in self.targets)
		self.write(
			f"{line}{measured}   "
			f"{misses}{' - met' if met else ''}{' (from the file)' if step.point.reused else ''}"
		)

	def _purpose(self, step):
		return {
			"start": "start",
			"scaling": "by scaling laws",
			"search": "search",
			"sensitivity": f"moves {step.parameter}",
		}[step.purpose]


class CalibrationReport:
	"""The report of a finished calibration.

	:param outcome: :class:`studies.calibration.Outcome`
	:param bench: :class:`studies.evaluations.Bench` that measured it
	:param model: "rigid" or "deformable"
	:param folder: where everything goes; made when missing
	:param title: heading
	:param material: the line to paste into a script
	:param rows: (name, value with unit, meaning) of specimen and tests
	:param command: the command line that made it
	:param options: plain values of all options
	:param versions: name -> version of the programs used
	:param notes: sentences for the report
	:param pictures: False leaves the pictures out
	:param pdf: write each picture as a PDF as well
	"""

	def __init__(
		self, outcome, bench, model, folder, title, material="", rows=(), command="", options=None,
		versions=None, notes=(), pictures=True, pdf=False
	):
		self.outcome, self.bench, self.model, self.folder, self.title, self.material = (
			outcome, bench, model, str(folder), title, material
		)
		self.rows, self.command, self.options, self.versions, self.notes = (
			list(rows), command, dict(options or {}), dict(versions or {}), list(notes)
		)
		self.pictures, self.pdf = pictures, pdf
		self.written = datetime.datetime.now().astimezone().replace(microsecond=0)
		self.tuned = [TUNABLES[model][p.name] for p in outcome.parameters]
		self.measures = [MEASURES[t.name] for t in outcome.targets]

	@property
	def effects(self):
		"""What the scene of the best point simulated, see :meth:`effect_table.EffectTable.rows`."""
		return self.bench.effects(self.outcome.best.values) if self.outcome.best else []

	@property
	def engines(self):
		"""Where the time of the best point goes: rows for a page, see :func:`studies.runs.plain_costs`."""
		measured = self.outcome.best.measured if self.outcome.best else {}
		taken = {name.partition(":")[2]: ns for name, ns in measured.items() if name.startswith("engine:")}
		total = sum(taken.values()) or 1.0
		return plain_costs(sorted(((n, ns, ns / total) for n, ns in taken.items()), key=lambda row: -row[1]))

	def told(self):
		"""What the steps of the evaluations that were made now have cost, in a line; empty where none was."""
		made = {
			tuple(sorted(step.point.values.items())): step.point.measured
			for step in self.outcome.steps
			if not step.point.reused and "particle_steps" in step.point.measured
		}
		if not made:
			return ""
		from .. import meter  # needs YADE, as who has made steps does
		# measures are means over the cases
		cases = len(self.bench.cases)
		sums = [cases * sum(m[n] for m in made.values()) for n in ("steps", "particle_steps", "cpu_s")]
		counts = [round(m["particles"]) for m in made.values()]
		kind = "sphere" if self.model == "rigid" else "triangle"
		return meter.line(kind, round(sums[0]), round(sums[1]), sums[2], min(counts), max(counts))

	def verdict(self):
		"""One sentence: whether the targets are met."""
		if self.outcome.reached:
			return f"All targets are met after {self._count()}."
		if self.outcome.best is None:
			return f"Nothing could be measured: {'; '.join(self.outcome.why)}."
		return (
			f"The targets are NOT met: {'; '.join(self.outcome.why)}. The nearest is shown, after "
			f"{self._count()}."
		)

	def target_rows(self):
		"""(text, symbol, unit, target, tolerance, reached, off by, scatter) as text, a row a target."""
		rows = []
		for target, quantity in zip(self.outcome.targets, self.measures):
			row = [
				quantity.meaning.split(":")[0],
				quantity.symbol,
				quantity.unit,
				f"{target.value / quantity.factor:.4g}",
				f"{100 * target.tolerance:.3g} %",
			]
			best = self.outcome.best
			if best is None:
				rows.append((*row, "–", "–", "–"))
				continue
			scatter = best.scatter[target.name]
			rows.append((
				*row, f"{best.measured[target.name] / quantity.factor:.4g}", percent(target.miss(best)),
				"–" if scatter is None else f"{100 * scatter / best.measured[target.name]:.2g} %"
			))
		return rows

	def parameter_rows(self):
		"""(attribute, symbol, unit, value, start, bounds, remark) as text, a row a parameter."""
		rows = []
		for parameter, q in zip(self.outcome.parameters, self.tuned):
			value = (
				"–"
				if self.outcome.best is None
				else f"{self.outcome.best.values[q.name] / q.factor:.5g}"
			)
			hit = self.outcome.hit.get(q.name)
			bounds = f"{parameter.lower / q.factor:.4g} to {parameter.upper / q.factor:.4g}"
			rows.append(
				(
					q.name, q.symbol, q.unit, value, f"{parameter.start / q.factor:.4g}", bounds,
					f"at its {hit} bound" if hit else ""
				)
			)
		return rows

	@property
	def errors_known(self):
		"""Whether there were points enough for standard errors of the elasticities."""
		return self.outcome.errors is not None and bool(np.isfinite(self.outcome.errors).all())

	def elasticity_rows(self):
		"""(measure, one elasticity a parameter) as text; empty where they were not measured."""
		if self.outcome.elasticities is None:
			return []
		rows = zip(self.measures, self.outcome.elasticities, self.outcome.errors)
		return [
			(q.symbol, [_with_error(value, error) for value, error in zip(values, errors)])
			for q, values, errors in rows
		]

	def table(self):
		"""Targets, parameters and sensitivities, for a terminal."""
		blocks = [
			_columns(
				("target", "", "unit", "wanted", "within", "measured", "off by", "scatter"),
				self.target_rows(),
			),
			_columns(("parameter", "", "unit", "found", "start", "bounds", ""), self.parameter_rows()),
		]
		if self.outcome.elasticities is not None:
			names = [q.name for q in self.tuned]
			blocks.append(
				_columns(
					("d ln/d ln", *names),
					[(symbol, *values) for symbol, values in self.elasticity_rows()],
				)
			)
		return "\n\n".join([self.verdict(), *blocks, self.material])

	def summary(self):
		"""What calibration.json holds; SI units."""
		outcome, best = self.outcome, self.outcome.best
		return {
			"title": self.title,
			"written": self.written.isoformat(),
			"command": self.command,
			"options": self.options,
			"versions": self.versions,
			"machine": pages.machine(),
			"reached": outcome.reached,
			"why": outcome.why,
			"targets": {
				t.name: {
					"value": t.value,
					"tolerance": t.tolerance,
					"measured": best and best.measured[t.name],
					"miss": best and t.miss(best),
					"scatter": best and best.scatter[t.name],
				}
				for t in outcome.targets
			},
			"parameters": {
				p.name: {
					"value": best and best.values[p.name], "start": p.start, "lower": p.lower,
					"upper": p.upper, "bound_hit": outcome.hit.get(p.name)
				}
				for p in outcome.parameters
			},
			"measured": best and best.measured,
			"material": self.material,
			"elasticities": None
			if outcome.elasticities is None
			else {
				t.name: {p.name: float(value) for p, value in zip(outcome.parameters, row)}
				for t, row in zip(outcome.targets, outcome.elasticities)
			},
			"elasticity_errors": None
			if outcome.elasticities is None
			else {
				t.name: {
					p.name: float(error) if math.isfinite(error) else None
					for p, error in zip(outcome.parameters, row)
				}
				for t, row in zip(outcome.targets, outcome.errors)
			},
			"evaluations": {
				"made": self.bench.ran,
				"reused": self.bench.reused,
				"failed": self.bench.failed,
				"cases_a_point": self.bench.cases,
				"seconds_added_up": self.bench.seconds,
				"wall_s": outcome.seconds,
			},
			"settings": self.bench.settings,
			"effects": self.effects,
			"steps": [
				{
					"number": s.number,
					"purpose": s.purpose,
					"parameter": s.parameter,
					"values": s.point.values,
					"measured": s.point.measured,
					"scatter": s.point.scatter,
					"error": s.point.error,
				}
				for s in outcome.steps
			],
		}

	def write(self):
		"""Write all files and return the path of calibration.html."""
		os.makedirs(self.folder, exist_ok=True)
		provenance.write_json(self._path("calibration.json"), self.summary(), indent=2, allow_nan=False)
		drawn = {}
		if self.pictures:
			drawn["convergence"] = convergence(self.outcome) if self.outcome.best else None
			drawn["sensitivities"] = (
				sensitivities(self.outcome, self.model)
				if self.outcome.elasticities is not None
				else None
			)
		page = pages.render(
			"calibration.html", {"symbol": _markup}, title=self.title, written=self.written, report=self,
			outcome=self.outcome, bench=self.bench,
			pictures=pages.save(drawn, self.folder, self.pdf), processor=pages.processor()
		)
		return pages.write(page, self._path("calibration.html"))

	def _path(self, name):
		return os.path.join(self.folder, name)

	def _count(self):
		reused = f" and {self.bench.reused} from the file" if self.bench.reused else ""
		return f"{self.bench.ran} evaluations{reused} in {self.outcome.seconds:.0f} s"


# ---- pictures ----


def convergence(outcome):
	"""How far every point was from the targets."""
	linear = 100 * max(target.tolerance for target in outcome.targets)
	with rc_context(plots.STYLE):
		fig = plots.figure(plots.COLUMN, 62)
		ax = fig.add_subplot()
		alike = len({target.tolerance for target in outcome.targets}) == 1
		for k, target in enumerate(outcome.targets):
			colour, size = plots.COLOURS[k % len(plots.COLOURS)], 100 * target.tolerance
			good = [step for step in outcome.steps if not step.point.error]
			path = [step for step in good if step.purpose != "sensitivity"]
			aside = [step for step in good if step.purpose == "sensitivity"]
			scatter = [100 * (step.point.scatter[target.name] or 0) / target.value for step in path]
			ax.errorbar(
				[s.number for s in path], [100 * target.miss(s.point) for s in path],
				yerr=scatter if any(scatter) else None, fmt="o-", color=colour,
				markersize=3.2, capsize=1.5, elinewidth=0.6,
				label=_mathematical(MEASURES[target.name].symbol)
			)
			hollow = {"markersize": 3, "fillstyle": "none", "markeredgewidth": 0.6}
			ax.plot(
				[s.number for s in aside],
				[100 * target.miss(s.point) for s in aside],
				"o",
				color=colour,
				**hollow,
			)
			if not alike:
				ax.axhspan(-size, size, color=colour, alpha=0.12, linewidth=0)
		if alike:
			ax.axhspan(-linear, linear, color="0.88", linewidth=0, zorder=0)
		ax.axhline(0, color="0.4", linewidth=0.5, zorder=0)
		failed = [step.number for step in outcome.steps if step.point.error]
		if failed:
			ax.plot(failed, np.zeros(len(failed)), "x", color="#b3261e", markersize=4, label="failed")
		ax.plot([], [], "s", color="0.88" if alike else "0.8", markersize=5, label="tolerance")
		if any(step.purpose == "sensitivity" for step in outcome.steps):
			ax.plot(
				[], [], "o", color="0.3", markersize=3, fillstyle="none", markeredgewidth=0.6,
				label="for sensitivities"
			)
		ax.set_yscale("symlog", linthresh=linear, linscale=0.6)
		reach = max(
			[
				abs(100 * target.miss(step.point))
				for step in outcome.steps
				if not step.point.error
				for target in outcome.targets
			]
			+ [2 * linear]
		)
		ticks = _ticks(linear, reach)
		ax.set_yticks(ticks)
		ax.yaxis.set_major_formatter(
			FuncFormatter(lambda value, _: f"{value:+g}".replace("-", "−") if value else "0")
		)
		ax.yaxis.set_minor_locator(NullLocator())
		ax.set_ylim(-_beyond(outcome, -1, linear), _beyond(outcome, 1, linear))
		ax.xaxis.set_major_locator(MaxNLocator(integer=True))
		ax.set_xlim(0.5, len(outcome.steps) + 0.5)
		ax.set_xlabel("point")
		ax.set_ylabel("distance from target [%]")
		ax.spines[["top", "right"]].set_visible(False)
		handles, labels = ax.get_legend_handles_labels()
		# error bars come last otherwise
		order = sorted(
			range(len(labels)), key=lambda k: (labels[k] in ("failed", "tolerance", "for sensitivities"), k)
		)
		fig.legend(
			[handles[k] for k in order],
			[labels[k] for k in order],
			loc="outside upper center",
			ncols=len(order),
			columnspacing=1.2,
			handletextpad=0.5,
		)
	return fig


def sensitivities(outcome, model):
	"""Elasticities of all targets, a group of bars a parameter."""
	with rc_context(plots.STYLE):
		fig = plots.figure(plots.COLUMN, 55)
		ax = fig.add_subplot()
		count, names = len(outcome.targets), [p.name for p in outcome.parameters]
		width = 0.7 / count
		for k, (target, row) in enumerate(zip(outcome.targets, outcome.elasticities)):
			x = np.arange(len(names)) + (k - (count - 1) / 2) * width
			errors = outcome.errors[k] if np.isfinite(outcome.errors[k]).all() else None
			look = {
				"color": plots.COLOURS[k % len(plots.COLOURS)],
				"error_kw": {"elinewidth": 0.7, "capsize": 2, "ecolor": "0.2"},
			}
			bars = ax.bar(
				x, row, 0.9 * width, yerr=errors, label=_mathematical(MEASURES[target.name].symbol),
				**look
			)
			ax.bar_label(
				bars,
				[f"{round(value, 2) + 0.0:.2f}".replace("-", "−") for value in row],
				padding=1.5,
				fontsize=6.5,
			)
		ax.axhline(0, color="0.2", linewidth=0.6)
		margin = np.nan_to_num(outcome.errors)
		low, high = (
			min(0.0, (outcome.elasticities - margin).min()),
			max(1.0, (outcome.elasticities + margin).max()),
		)
		ax.set_ylim(low - 0.12 * (high - low) * (low < 0), high + 0.12 * (high - low))
		ax.set_xticks(
			range(len(names)), [f"{name} {_mathematical(TUNABLES[model][name].symbol)}" for name in names]
		)
		ax.set_xlim(-0.5, len(names) - 0.5)
		ax.tick_params(axis="x", length=0)
		ax.set_ylabel("elasticity [-]")
		ax.spines[["top", "right", "bottom"]].set_visible(False)
		fig.legend(loc="outside upper center", ncols=count)
	return fig


def _ticks(linear, reach):
	steps = [
		value
		for value in (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000)
		if linear < value <= 1.3 * reach
	]
	steps = [linear] + [value for value in steps if value >= 2 * linear]
	return [-value for value in reversed(steps)] + [0] + steps


def _beyond(outcome, sign, linear):
	"""How far the picture reaches on one side of zero."""
	found = [
		sign * 100 * target.miss(step.point)
		for step in outcome.steps
		if not step.point.error
		for target in outcome.targets
	]
	return 1.4 * max(found + [1.6 * linear])


def _with_error(value, error):
	text = f"{round(value, 2) + 0.0:+.2f}" + (f" ± {error:.2f}" if math.isfinite(error) else "")
	return text.replace("-", "−")


def _parts(symbol):
	base, _, index = symbol.partition("_")
	return base, index


def _mathematical(symbol):
	"""A symbol for a picture: σ_p0 with p0 as its index; words such as UCS stay upright."""
	base, index = _parts(symbol)
	return symbol if len(base) > 1 else f"${base}_{{\\mathrm{{{index}}}}}$" if index else f"${base}$"


def _markup(symbol):
	"""The same for the page."""
	base, index = _parts(symbol)
	return (
		Markup("{}").format(symbol)
		if len(base) > 1
		else Markup("<i>{}</i>{}").format(base, Markup("<sub>{}</sub>").format(index) if index else "")
	)


def percent(part):
	"""A signed part in per cent."""
	return f"{round(100 * part, 1) + 0.0:+.{1 if abs(part) < 0.995 else 0}f} %".replace("-", "−")


def _columns(head, rows):
	"""Text in columns: the first left, the others right aligned."""
	table = [[str(cell) for cell in row] for row in (head, *rows)]
	widths = [max(len(row[k]) for row in table) for k in range(len(head))]
	lines = [
		"  ".join(
			cell.ljust(width) if k == 0 else cell.rjust(width)
			for k, (cell, width) in enumerate(zip(row, widths))
		).rstrip()
		for row in table
	]
	return "\n".join([lines[0], "-" * max(map(len, lines)), *lines[1:]])


def material_line(model, values, density):
	"""The material as a line to paste into a YADE script."""
	kind = {"rigid": "BondedMat", "deformable": "ConcreteDamageMat"}[model]
	numbers = ", ".join(f"{name}={_python(value)}" for name, value in values.items())
	dense = f"density={density:g} / packing.solid_fraction" if model == "rigid" else f"density={density:g}"
	return f"O.materials.append({kind}(label=\"{'rock' if model == 'rigid' else 'concrete'}\", {numbers}, {dense}))"


def _python(value):
	"""A short literal of the same number to six digits; large ones in powers of a thousand."""
	if abs(value) < 1e4 or not math.isfinite(value):
		return f"{value:.6g}"
	power = 3 * int(math.log10(abs(value)) // 3)
	return f"{value / 10**power:.6g}e{power}"
