# GPL v2 or later, see LICENSE.
"""The verification page: one HTML file with every case, its reference, error, tolerance, source and picture."""
import datetime
import os
import re

import numpy as np
from markupsafe import Markup, escape
from matplotlib import rc_context

from .. import plots
from ..reports import pages
from .framework import GROUPS, Picture

_FLOOR = 1e-16  # errors below are drawn there


def write(results, folder, command="", versions=None):
	"""Write verification.html and its pictures into a folder, which is made when missing;
	returns the path of the page.

	:param results: list of :class:`framework.Result`, run with pictures
	:param command: the command line that made them
	:param versions: name -> version of the programs used
	"""
	os.makedirs(folder, exist_ok=True)
	pictures = {}  # of each case, (picture, file name, bytes)
	for result in results:
		for number, picture in enumerate(result.pictures, start=1):
			name = (
				f"{result.case.name}_{number}.png"
				if len(result.pictures) > 1
				else f"{result.case.name}.png"
			)
			pictures.setdefault(result.case.name, []).append(
				(picture, name, _save(picture, os.path.join(folder, name)))
			)
	overview = Picture(errors(results), "")
	page = html(results, pictures, _save(overview, os.path.join(folder, "errors.png")), command, versions)
	return pages.write(page, os.path.join(folder, "verification.html"))


def html(results, pictures, overview, command="", versions=None):
	"""The page; *pictures* of each case by its name, as (:class:`framework.Picture`, file name, bytes of a PNG
	file), *overview* the bytes of the picture of all errors."""
	filters = {
		"figure": lambda value: _number(value, 6),
		"error": lambda value: _number(value, 2),
		"png": pages.encoded,
		"indices": _with_indices,
	}
	records = [record for result in results for record in result.records]
	return pages.render(
		"verification.html",
		filters,
		written=datetime.datetime.now().astimezone(),
		groups=[(group, [r for r in results if r.case.group == group]) for group in GROUPS],
		results=results,
		tightest={result.case.name: _tightest(result) for result in results if result.records},
		checks=len(records),
		failed=[record for record in records if not record.passed],
		wall=sum(result.wall for result in results),
		pictures=pictures,
		overview=overview,
		command=command,
		versions=dict(versions or {}),
		machine=pages.machine()
	)


def errors(results):
	"""Error of every check beside its tolerance, a row a case."""
	with rc_context(plots.STYLE):
		fig = plots.figure(plots.PAGE, 18 + 4.3 * len(results))
		ax = fig.add_subplot()
		for row, result in enumerate(results):
			for record in result.records:
				error = max(record.error, _FLOOR) if np.isfinite(record.error) else 1.0
				ax.plot(
					[error, max(record.tolerance, _FLOOR)], [row, row], "-", color="0.85",
					linewidth=0.8, zorder=1
				)
				ax.plot(max(record.tolerance, _FLOOR), row, "|", color="0.35", markersize=5, zorder=2)
				ax.plot(
					error, row, "o", color=plots.COLOURS[0 if record.passed else 1], markersize=2.8,
					zorder=3
				)
		ax.plot([], [], "o", color=plots.COLOURS[0], markersize=2.8, label="error")
		ax.plot([], [], "|", color="0.35", markersize=5, label="tolerance")
		if not all(result.passed for result in results):
			ax.plot([], [], "o", color=plots.COLOURS[1], markersize=2.8, label="error above the tolerance")
		ax.set_xscale("log")
		ax.set_xlim(0.4 * _FLOOR, 3)
		ax.set_yticks(
			range(len(results)),
			[
				result.case.title.replace("β_φ", r"$\beta_\varphi$").replace("→", r"$\to$")
				for result in results
			],
		)
		ax.set_ylim(len(results) - 0.3, -0.7)
		ax.tick_params(axis="y", length=0)
		ax.spines[["top", "right", "left"]].set_visible(False)
		ax.set_xlabel("relative error [-]")
		fig.legend(loc="outside upper right", ncols=3)
	return fig


def _save(picture, path):
	data = picture.png()
	with open(path, "wb") as file:
		file.write(data)
	return data


def _with_indices(text):
	"""σ_xx, ė_N: what follows a single letter and an underscore becomes an index, what follows a hat an exponent;
	names like time_step stay."""
	text = re.sub(
		r"\^(\([^()]*\)|{[^{}]*}|[\d.]*\d|\w+)",
		lambda found: f"<sup>{found[1].strip('(){}')}</sup>",
		str(escape(text)),
	)
	return Markup(re.sub(r"(?<![A-Za-z])([^\W\d_]\u0307?)_([^\W_]+)", r"\1<sub>\2</sub>", text))


def _tightest(result):
	"""The check of a result whose error is nearest to its tolerance, or furthest above it."""
	return max(
		result.records,
		key=lambda record: (
			record.error / record.tolerance
			if record.tolerance > 0 and np.isfinite(record.error)
			else np.inf
		),
	)


def _number(value, digits):
	"""For people: 1.23·10⁻⁷ rather than 1.23e-07."""
	if not np.isfinite(value):
		return "–"
	text = f"{value:.{digits}g}"
	if "e" not in text:
		return text.replace("-", "−")
	mantissa, exponent = text.split("e")
	return f"{mantissa}·10{str(int(exponent)).translate(str.maketrans('-0123456789', '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'))}".replace(
		"-", "−"
	)
