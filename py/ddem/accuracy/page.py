# GPL v2 or later, see LICENSE.
"""Tables and files of what accuracy costs: cost.json, cost.csv and a page with pictures."""
import datetime
import math
import os

from .. import provenance
from ..reports import pages
from . import convergence, figures, sentences

_COLUMNS = (
	("ladder", 16, lambda p: p.ladder), ("rung", 26, lambda p: p.rung), ("quantity", 27, lambda p: p.quantity),
	("particles", 10, lambda p: _number(p.cost.get("particles"), ".0f")),
	("steps", 8, lambda p: _number(p.cost.get("steps"), ".0f")),
	("ns/p-step", 10, lambda p: _number(p.cost.get("ns_per_particle_step"), ".0f")),
	("B/p", 7, lambda p: _number(p.cost.get("bytes_per_particle"), ".0f")),
	("core-s", 9, lambda p: _number(p.cpu_s, ".3g")), ("MB", 7, lambda p: _number(p.cost.get("memory_MB"), ".0f")),
	("error", 10, lambda p: "not run" if p.skipped else "FAILED" if p.failed else _number(p.error, ".2e")),
	("digits", 7, lambda p: _number(convergence.digits(p.error), ".1f")),
	("size", 6, lambda p: _number(-convergence.digits(p.cost.get("unknowns", math.nan)), ".1f")),
	("efficacy", 9, lambda p: _number(convergence.efficacy(p.error, p.cpu_s), ".1f")),
	("front", 6, lambda p: "yes" if p.pareto else ""),
)
CSV = (
	"case", "ladder", "kind", "quantity", "of", "unit", "rung", "h", "value", "scatter", "error", "reference",
	"reference_error", "source", "particles", "unknowns", "steps", "dt_s", "ns_per_particle_step",
	"bytes_per_particle", "cpu_s", "wall_s", "memory_MB", "threads",
	"digits_of_accuracy", "digits_of_size", "digits_of_efficacy", "pareto", "failed"
)


def _number(value, form):
	return "" if value is None or not math.isfinite(value) else format(value, form)


def table(points):
	"""All points, a line each, for a terminal."""
	lines = ["".join(f"{name:<{width}}" if width > 12 else f"{name:>{width}}" for name, width, _ in _COLUMNS)]
	for point in points:
		cells = [(cell(point)[:width - 1], width) for _, width, cell in _COLUMNS]
		lines.append("".join(f"{text:<{width}}" if width > 12 else f"{text:>{width}}" for text, width in cells))
	return "\n".join(lines)


def prediction(ladder, predicted, measured):
	"""What was predicted of a rung beside what it gave, in a line."""
	got = measured.failed or f"{sentences.per_cent(measured.error)} for {sentences.seconds(measured.cpu_s)}"
	return (
		f"{ladder.name}: predicted {sentences.per_cent(predicted.error)} for "
		f"{sentences.seconds(predicted.cpu_s)} ({measured.rung}, order {predicted.order:.2g}); measured {got}"
	)


def write(points, told, study, folder, command):
	"""Write all files into a folder and return the path of the page.

	:param told: sentences
	:param study: :class:`study.Study`
	:param command: command line that repeats it
	"""
	os.makedirs(folder, exist_ok=True)
	rows = [point.plain() for point in points]
	provenance.write_json(os.path.join(folder, "cost.json"), rows, indent=2, ensure_ascii=False, allow_nan=False)
	with provenance.csv_writer(os.path.join(folder, "cost.csv")) as writer:
		writer.writerow(CSV)
		writer.writerows([["" if row[name] is None else row[name] for name in CSV] for row in rows])
	ladders = {}
	for point in points:
		ladders.setdefault(point.ladder, []).append(point)
	drawn = {"summary": figures.summary(points), "threads": figures.threads(points)}
	for name, group in ladders.items():
		drawn[name] = figures.work_precision(group)
		drawn[f"{name}_crack_energy"] = figures.crack_energy(group)
		strengths = [p for p in group if p.of == "UCS"]
		drawn[f"{name}_two_errors"] = figures.two_errors(strengths)
	pictures = pages.save(drawn, folder)
	html = pages.render(
		"accuracy_cost.html", title="What accuracy costs in time", written=datetime.datetime.now().astimezone(),
		command=command, pictures=pictures, ladders=ladders,
		sentences=told, failures=sentences.failures(points), skipped=sentences.skipped(points),
		machine=study.machine,
		predictions=[prediction(*one) for one in study.predictions],
		columns=[(name, cell) for name, _, cell in _COLUMNS[1:]],
		engines={name: sentences.engines(group) for name, group in ladders.items()},
		kinds={name: group[0].kind for name, group in ladders.items()},
		sources={
			name: list(dict.fromkeys(_source(p) for p in group if p.source))
			for name, group in ladders.items()
		}
	)
	return pages.write(html, os.path.join(folder, "accuracy_cost.html"))


def _source(point):
	own = f", itself within {sentences.per_cent(point.reference_error)}" if point.reference_error > 0 else ""
	return f"{point.quantity}: {point.source}{own}"
