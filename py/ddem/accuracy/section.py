# GPL v2 or later, see LICENSE.
"""What the accuracy of finished runs cost, as a section of their report. Needs no YADE."""
import math
import textwrap
from dataclasses import replace

from . import convergence, figures, sentences

_COLUMNS = (
	("sample", lambda p: p.rung), ("quantity", lambda p: p.quantity),
	("particles", lambda p: f"{p.cost['particles']:.0f}"), ("steps", lambda p: f"{p.cost['steps']:.0f}"),
	("ns a particle-step", lambda p: f"{p.cost['ns_per_particle_step']:.3g}"),
	("bytes a particle", lambda p: _or_dash(p.cost.get("bytes_per_particle"), "{:.0f}")),
	("core-seconds", lambda p: f"{p.cpu_s:.3g}"), ("memory [MB]", lambda p: f"{p.cost['memory_MB']:.0f}"),
	("error", lambda p: _or_dash(sentences.supported(p), "{:.2g} %", 100)),
	("scatter", lambda p: _or_dash(p.scatter, "{:.2g} %", 100)),
	("digits", lambda p: _or_dash(convergence.digits(sentences.supported(p)), "{:.1f}"))
)


class Section:
	"""What the accuracy of finished runs cost: the same tests on coarser samples and with other seeds.

	:param points: title of a model -> points of its ladder, of every quantity, see :mod:`points`
	:param names: title of a model -> its short name, for files
	:param notes: sentences: what all samples of a ladder have in common
	:param effects: title of a model -> {effect: share of a strained step that it costs}
	"""

	def __init__(self, points, names, notes=(), effects=None):
		self.points, self.names = dict(points), dict(names)
		self.notes, self.effects = list(notes), dict(effects or {})

	@property
	def columns(self):
		"""Titles of the table."""
		return [title for title, _ in _COLUMNS]

	def rows(self, title):
		"""The table of a model, a list of texts a sample and quantity; what failed says why in the third."""
		return [
			[p.rung, p.quantity, p.failed] if p.failed else [cell(p) for _, cell in _COLUMNS]
			for p in self.points[title]
		]

	def sentences(self, title):
		"""What a model's points say: of each quantity, of the scatter, and where the time goes."""
		points = self.points[title]
		groups = sentences.grouped(points).values()
		told = [sentences.of_one(group) for group in groups]
		told += [sentences.hidden(group) for group in groups if group[0].of == "UCS"]
		told.append(sentences.engines(points))
		if self.effects.get(title):
			shares = ", ".join(
				f"{name} {sentences.per_cent(max(0.0, share))}"
				for name, share in sorted(self.effects[title].items(), key=lambda item: -item[1])
			)
			told.append(f"Effects, as shares of a step in which all is strained: {shares}.")
		return [text for text in told if text]

	def text(self):
		"""All of it for a terminal."""
		lines = ["What this accuracy cost"]
		for title in self.points:
			lines += ["", title]
			rows = [self.columns, *self.rows(title)]
			widths = [max(len(row[k]) for row in rows if len(row) > 3) for k in range(len(_COLUMNS))]
			for row in rows:
				cells = [f"{row[0]:<{widths[0]}}", f"{row[1]:<{widths[1]}}"]
				if len(row) > 3:
					cells += [f"{cell:>{width}}" for cell, width in zip(row[2:], widths[2:])]
				else:
					cells.append(f"FAILED: {row[2]}")
				lines.append("  " + "  ".join(cells))
			lines += [_wrapped(text, "  ") for text in self.sentences(title)]
		return "\n".join([*lines, "", *map(_wrapped, self.notes)])

	def plain(self):
		"""For a JSON file: a model's short name -> points, sentences and shares of effects; and the notes."""
		found = {
			self.names[title]: {
				"points": [_plain(p) for p in points],
				"sentences": self.sentences(title),
				"effects": self.effects.get(title, {}),
			}
			for title, points in self.points.items()
		}
		return {**found, "notes": self.notes}

	def figures(self):
		"""Name of the file -> picture of a model; None where no quantity shows a trend over the sizes."""
		told = {self.names[title]: _told(points) for title, points in self.points.items()}
		return {
			f"cost_{name}": figures.work_precision(points) if points else None
			for name, points in told.items()
		}


def _wrapped(text, indent=""):
	return textwrap.fill(text, 120, initial_indent=indent, subsequent_indent=2 * indent)


def _plain(point):
	"""For a file; the scene is the run's own, whose name would be a path."""
	row = point.plain()
	del row["case"]
	return row


def _told(points):
	"""The same points with the errors that their numbers support, and the front of these; without quantities that
	show no trend, whose errors are one bound for all sizes."""
	found = []
	for group in sentences.grouped(points).values():
		if any(math.isnan(p.error) for p in group if not p.failed):
			continue
		group = [replace(p, error=sentences.supported(p)) for p in group]
		places = convergence.front([p.cpu_s for p in group], [p.error for p in group])
		found += [replace(p, pareto=place in places) for place, p in enumerate(group)]
	return found


def _or_dash(value, form, factor=1):
	return form.format(factor * value) if value is not None and math.isfinite(value) else "–"
