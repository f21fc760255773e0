# GPL v2 or later, see LICENSE.
"""Pictures of what accuracy costs. Needs no YADE."""
import math

import numpy as np
from matplotlib import rc_context
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FuncFormatter, LogFormatterMathtext, LogLocator, NullFormatter, NullLocator

from .. import plots
from . import convergence, sentences

_MARKS = ("o", "s", "^", "D", "v", "P", "X", "*")


def _drawn(points):
	return [p for p in points if not p.failed and p.known > 0 and math.isfinite(p.error) and p.cpu_s > 0]


def _mantissa(value):
	return round(value / 10**math.floor(math.log10(value) + 1e-9))


def _power(value, _):
	"""As 2·10⁻⁸."""
	power = math.floor(math.log10(value) + 1e-9)
	return f"${value / 10**power:.2g}\\cdot10^{{{power}}}$"


def _ticks(axis, low, high, words):
	"""Ticks of a logarithmic axis: decades where there are several, else 1, 2 and 5 as well."""
	decades = high > 200 * low
	axis.set_major_locator(LogLocator(subs=(1, ) if decades else (1, 2, 5), numticks=12))
	written = words or (None if decades else _power)
	axis.set_major_formatter(FuncFormatter(written) if written else LogFormatterMathtext())
	axis.set_minor_formatter(NullFormatter())


def _axes(ax):
	ax.set_xscale("log")
	ax.set_yscale("log")
	ax.margins(x=0.16, y=0.2)
	per_cent = ax.get_ylim()[0] > 2e-5  # else powers of ten read better
	_ticks(ax.yaxis, *ax.get_ylim(), (lambda value, _: f"{100 * value:g} %") if per_cent else None)
	_ticks(ax.xaxis, *ax.get_xlim(), lambda value, _: f"{value:g}")
	ax.set_xlabel("processor time of the steps [s]")
	ax.set_ylabel("relative error [-]")


def work_precision(points, width=plots.COLUMN):
	"""Errors of one ladder against core-seconds: a line a quantity, a point a rung, ringed where it is on the
	front; ranges of seeds as bars, slopes in the legend; the energy book in axes of its own. No error is drawn
	below that of its reference: the mark is open where it would be.
	None where nothing can be drawn, and for threads, see :func:`threads`."""
	if points[0].kind == "threads":
		return None
	groups = [group for group in map(_drawn, sentences.grouped(points).values()) if group]
	books = [group for group in groups if group[0].of == "energy book"]
	parts = [part for part in ([group for group in groups if group not in books], books) if part]
	if not parts:
		return None
	with rc_context(plots.STYLE):
		figure = plots.figure(width, (0.9 if len(parts) < 2 else 1.15) * width)
		heights = [3, 1.4] if len(parts) > 1 else [1]
		grid = figure.subplots(len(parts), 1, sharex=True, squeeze=False, height_ratios=heights)
		number = 0
		for ax, part in zip(grid[:, 0], parts):
			for group in part:
				_line(ax, group, number)
				number += 1
			_axes(ax)
			if part is parts[0]:
				_label(ax, *part)
			if ax is not grid[-1, 0]:
				ax.set_xlabel("")
		handles = [handle for ax in grid[:, 0] for handle in ax.get_legend_handles_labels()[0]]
		if any(_hidden(p) for group in groups for p in group):
			handles.append(
				Line2D(
					[], [], linestyle="none", marker="o", markersize=3.5, fillstyle="none",
					color="#555555", label="open: below the error of the reference, drawn at it"
				)
			)
		figure.legend(handles=handles, loc="outside upper center", ncols=1)
	return figure


def _hidden(point):
	return point.error < point.reference_error


def _label(ax, group, *others):
	"""The rungs beside the points of a line, on the side that is away from the other lines, or on the other side of
	a close neighbour; where they stand for one another, and have long names, numbers with a key over the axes."""
	if group[0].kind in sentences.COMPARED:
		for number, p in enumerate(group, 1):
			ax.annotate(
				str(number), (p.cpu_s, p.known), textcoords="offset points", xytext=(0, 7),
				ha="center", fontsize=6, color="#555555"
			)
		key = "\n".join(f"{number}: {p.rung}" for number, p in enumerate(group, 1))
		ax.set_title(key, fontsize=6, loc="left", color="#555555")
		return
	level = lambda line: np.mean([math.log(p.known) for p in line])
	# points of paper, above or below
	free = 8 if all(level(group) > level(other) - 0.05 for other in others) else -8
	at = ax.transData.transform([(p.cpu_s, p.known) for p in group]) * 72 / ax.figure.dpi
	side = free
	for place, p in enumerate(group):
		close = place and np.hypot(*(at[place] - at[place - 1])) < 38
		side = -side if close else free
		along = at[min(place + 1, len(at) - 1)] - at[max(place - 1, 0)]
		along = along / (np.hypot(*along) or 1.0)
		x, y = (-side * along[1], side * along[0]) if along.any() else (0, side)
		ax.annotate(
			p.rung, (p.cpu_s, p.known), textcoords="offset points", xytext=(x, y), fontsize=6,
			color="#555555", ha="left" if x > 5 else "right" if x < -5 else "center",
			va="bottom" if y > 2 else "top" if y < -2 else "center",
			path_effects=[withStroke(linewidth=1.5, foreground="white")]
		)


def _line(ax, group, number):
	x, y = np.array([p.cpu_s for p in group]), np.array([p.known for p in group])
	colour = plots.COLOURS[number % len(plots.COLOURS)]
	told = [p for p in group if not _hidden(p)]
	_, slope = convergence.power_law([p.cpu_s for p in told], [p.error for p in told])
	apart = group[0].kind in sentences.COMPARED  # settings that stand for one another lie on no line
	sloped = len(told) > 2 and math.isfinite(slope) and not apart
	name = group[0].quantity + (f", slope {round(slope, 2) + 0:.2f}" if sloped else "")
	mark = _MARKS[number % len(_MARKS)]
	line = "none" if apart else "-"
	ax.plot(x, y, linestyle=line, marker=mark, markersize=3.5, color=colour, label=name)
	open_ = [place for place, p in enumerate(group) if _hidden(p)]
	ax.plot(
		x[open_], y[open_], linestyle="none", marker=mark, markersize=3.5, color=colour, markerfacecolor="white"
	)
	front = [p for p in group if p.pareto]
	ax.plot(
		[p.cpu_s for p in front], [p.known for p in front], "o", markersize=7, fillstyle="none",
		color=colour,
		markeredgewidth=0.6
	)
	for p in group:
		seeds = [error for error in p.errors if error > 0]
		if len(seeds) > 1:
			ax.plot([p.cpu_s] * 2, [min(seeds), max(seeds)], color=colour, linewidth=0.6, alpha=0.6)
		if p.cpu_range and p.cpu_range[1] > p.cpu_range[0]:
			ax.plot(p.cpu_range, [p.known] * 2, color=colour, linewidth=0.6, alpha=0.6)


def two_errors(points, width=plots.COLUMN):
	"""Both errors of fracture over the size, and where they cross. None where there are fewer than three sizes."""
	h, discretisation, scatter = sentences.two_errors(points)
	if not h:
		return None
	with rc_context(plots.STYLE):
		figure = plots.figure(width, 0.75 * width)
		ax = figure.add_subplot()
		sizes = 1e3 * np.array(h)
		ax.loglog(sizes, discretisation, "o-", markersize=3.5, label="of discretisation: h against h/2")
		ax.loglog(sizes, scatter, "s-", markersize=3.5, label="of samples: standard deviation of seeds")
		found = sentences.recommended(points)
		if found:
			ax.axvline(1e3 * found[0], color="#888888", linewidth=0.6, linestyle="--")
			ax.annotate(
				f"{1e3 * found[0]:.2g} mm", (1e3 * found[0], ax.get_ylim()[0]),
				textcoords="offset points", xytext=(3, 4),
				fontsize=7
			)
		ax.set_xlabel("size [mm]")
		ax.set_ylabel(f"relative error of the {points[0].quantity} [-]")
		per_cent = FuncFormatter(lambda value, _: f"{100 * value:g} %")
		ax.yaxis.set_major_formatter(per_cent)
		ax.yaxis.set_minor_formatter(
			FuncFormatter(lambda value, _: f"{100 * value:g} %" if _mantissa(value) in (2, 5) else "")
		)
		ax.set_xticks(sizes, [f"{size:g}" for size in sizes])
		ax.xaxis.set_minor_locator(NullLocator())
		ax.legend()
	return figure


def threads(points, width=plots.COLUMN):
	"""Time by the clock, processor time and what an ideal machine would take over the threads, for all ladders of
	them, each with its particles. None where there is none with two rungs."""
	ladders = {}
	for p in points:
		if p.kind == "threads" and not p.failed:
			ladders.setdefault(p.ladder, {})[p.settings["threads"]] = p.cost
	ladders = [sorted(costs.items()) for costs in ladders.values() if len(costs) > 1]
	if not ladders:
		return None
	with rc_context(plots.STYLE):
		figure = plots.figure(width, 0.9 * width)
		ax = figure.add_subplot()
		ax.set_xscale("log", base=2)
		ax.set_yscale("log")
		for number, costs in enumerate(ladders):
			colour, counts = plots.COLOURS[number % len(plots.COLOURS)], np.array([n for n, _ in costs])
			first = costs[0][1]
			for key, line, name in (("wall_s", "o-", "by the clock"), ("cpu_s", "s--", "of processors")):
				ax.plot(
					counts, [cost[key] for _, cost in costs], line, markersize=3.5, color=colour,
					label=f"{name}, {first['particles']:.0f} particles"
				)
			ideal, = ax.plot(
				counts, first["wall_s"] * counts[0] / counts, ":", color="#888888", linewidth=0.8
			)
		ideal.set_label("shared without loss")
		counts = sorted({n for costs in ladders for n, _ in costs})
		ax.set_xticks(counts, [f"{n}" for n in counts])
		ax.xaxis.set_minor_locator(NullLocator())
		ax.margins(x=0.1, y=0.1)
		_ticks(ax.yaxis, *ax.get_ylim(), lambda value, _: f"{value:g}")
		ax.set_xlabel("threads")
		ax.set_ylabel("time of the steps [s]")
		figure.legend(loc="outside upper center", ncols=1)
	return figure


def crack_energy(points, width=plots.COLUMN):
	"""Energies of a crack over the size of the mesh, a line a quantity, and their reference.
	None where fewer than two sizes have one."""
	groups = [
		sorted((p for p in group if not p.failed and p.value > 0), key=lambda p: p.step)
		for group in sentences.grouped(points).values()
		if group[0].of == "crack energy" and group[0].step is not None
	]
	groups = [group for group in groups if len(group) > 1]
	if not groups:
		return None
	with rc_context(plots.STYLE):
		figure = plots.figure(width, 0.75 * width)
		ax = figure.add_subplot()
		for number, group in enumerate(groups):
			_, exponent = convergence.power_law([p.step for p in group], [p.value for p in group])
			ax.semilogx(
				[1e3 * p.step for p in group], [p.value for p in group], marker=_MARKS[number],
				markersize=3.5, color=plots.COLOURS[number],
				label=f"{group[0].quantity}, as size$^{{{exponent:.2f}}}$"
			)
		right = groups[0][0].reference
		ax.axhline(right, color="#888888", linewidth=0.8, linestyle="--", label=groups[0][0].source)
		sizes = sorted({1e3 * p.step for group in groups for p in group})
		ax.set_xticks(sizes, [f"{size:g}" for size in sizes])
		ax.xaxis.set_minor_locator(NullLocator())
		ax.margins(x=0.08, y=0.1)
		ax.set_ylim(bottom=0)
		ax.set_xlabel("size [mm]")
		ax.set_ylabel("energy of the crack [J/m²]")
		figure.legend(loc="outside upper center", ncols=1)
	return figure


def summary(points, width=plots.PAGE):
	"""The fronts of all ladders that refine, a line each, without what does not converge: the energy book and
	energies of cracks. Marks are open as in :func:`work_precision`. None where there is none."""
	groups = [
		[p for p in _drawn(group) if p.pareto]
		for group in sentences.grouped(points).values()
		if group[0].kind in sentences.REFINED and group[0].of not in ("energy book", "crack energy")
	]
	groups = [group for group in groups if len(group) > 1]
	if not groups:
		return None
	with rc_context(plots.STYLE):
		figure = plots.figure(width, 0.5 * width)
		ax = figure.add_subplot()
		for number, group in enumerate(groups):
			colour = plots.COLOURS[number % len(plots.COLOURS)]
			mark = _MARKS[number // len(plots.COLOURS)]
			ax.plot(
				[p.cpu_s for p in group], [p.known for p in group], marker=mark, markersize=3.5,
				color=colour, label=f"{group[0].quantity} ({group[0].ladder})"
			)
			hidden = [p for p in group if _hidden(p)]
			ax.plot(
				[p.cpu_s for p in hidden], [p.known for p in hidden], linestyle="none", marker=mark,
				markersize=3.5, color=colour, markerfacecolor="white"
			)
		_axes(ax)
		figure.legend(loc="outside right upper")
	return figure
