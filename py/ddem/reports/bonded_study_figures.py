# GPL v2 or later, see LICENSE.
"""Pictures of the study of bonded spheres: the median over packings as a line, their range as a band."""
import numpy as np
from matplotlib import rc_context

from .. import plots
from ..studies.bonded_study import RECORD

_POINTS = 501
_COLOURS = (plots.COLOURS[1], plots.COLOURS[0], plots.COLOURS[2], plots.COLOURS[3])
_PANEL = 62.0  # height of a picture with one row of panels [mm]


def broken_bonds(groups):
	"""Broken share of the bonds over time, a panel a stiffness (Figures 1 and 2 of the paper)."""
	return _over_time(groups, "broken_percent", 1, "broken bonds [%]")


def force_bottom(groups):
	"""Force on the bottom wall over time (Figure 3)."""
	return _over_time(groups, "force_bottom", 1e-3, "force on the bottom wall [kN]")


def force_top(groups):
	"""Force on the top wall over time (Figure 4)."""
	return _over_time(groups, "force_top", 1e-3, "force on the top wall [kN]")


def stress_strain(groups):
	"""Stress over strain (Figures 5 and 6), and on the right what it would be divided by A."""
	fig, panels = _panels(groups)
	with rc_context(plots.STYLE):
		for ax, members in panels:
			for colour, group in zip(_COLOURS, members):
				_stress_band(ax, group, colour, group.range_text)
			_dress(
				ax,
				"axial strain [%]",
				"axial stress, eq. 9 [MPa]" if ax is panels[0][0] else None,
				_title(members),
			)
			_doubled(ax, label=ax is panels[-1][0])
		_legend(fig, panels[0][0])
	return fig


def influences(groups):
	"""Stress over strain for the middle range: what the mass of the spheres,
	the convention and the packing do to it."""
	with rc_context(plots.STYLE):
		fig = plots.figure(plots.COLUMN, 80)
		fig.set_layout_engine("constrained")
		ax = fig.subplots()
		for colour, group in zip(_COLOURS, groups):
			_stress_band(ax, group, colour, "as the paper" if group.kind == "paper" else group.kind)
		_dress(ax, "axial strain [%]", "axial stress, eq. 9 [MPa]", None)
		fig.legend(loc="outside upper left", ncols=2)
	return fig


#: pictures of the paper, in order
PAPER = {
	"broken_bonds": broken_bonds,
	"force_bottom": force_bottom,
	"force_top": force_top,
	"stress_strain": stress_strain,
}


def _over_time(groups, quantity, factor, label):
	fig, panels = _panels(groups)
	with rc_context(plots.STYLE):
		for ax, members in panels:
			for colour, group in zip(_COLOURS, members):
				times = np.linspace(0, group.end, _POINTS)
				_band(ax, 1e3 * times, group.curve(quantity, times), factor, colour, group.range_text)
			_dress(ax, "time [ms]", label if ax is panels[0][0] else None, None)
			above = ax.secondary_xaxis(
				"top",
				functions=(
					lambda ms: ms * 1e-3 / RECORD / 1000,
					lambda records: records * 1000 * RECORD * 1e3,
				),
			)
			above.set_xlabel(f"{_title(members)}\nrecords of the paper, every 10 ns [thousands]")
			above.spines["top"].set_linewidth(0.6)
		_legend(fig, panels[0][0])
	return fig


def _stress_band(ax, group, colour, label):
	times = np.linspace(0, group.end, _POINTS)
	# Walls move as told, so that all runs have the same strain at the same time.
	_band(ax, 100 * group.curve("strain", times).median, group.curve("stress", times), 1e-6, colour, label)


def _band(ax, x, spread, factor, colour, label):
	ax.fill_between(x, factor * spread.low, factor * spread.high, color=colour, alpha=0.18, linewidth=0)
	ax.plot(x, factor * spread.median, color=colour, label=label)


def _panels(groups):
	"""A figure with a panel for each stiffness of the walls; (axes, groups by size) of each."""
	stiffnesses = sorted({group.stiffness for group in groups})
	with rc_context(plots.STYLE):
		fig = plots.figure(plots.PAGE if len(stiffnesses) > 1 else plots.COLUMN, _PANEL)
		fig.set_layout_engine("constrained")
		axes = fig.subplots(1, len(stiffnesses), sharey=True, squeeze=False)[0]
	return fig, [
		(ax, sorted((g for g in groups if g.stiffness == k), key=lambda g: g.radii))
		for ax, k in zip(axes, stiffnesses)
	]


def _title(members):
	return f"walls of $K$ = {members[0].stiffness / 1e9:g} GPa"


def _dress(ax, x, y, title):
	ax.spines[["top", "right"]].set_visible(False)
	ax.set_xlabel(x)
	if y:
		ax.set_ylabel(y)
	if title:
		ax.set_title(title)
	ax.set_xlim(0, 1.005 * ax.dataLim.x1)
	ax.set_ylim(bottom=0)


def _doubled(ax, label):
	right = ax.secondary_yaxis("right", functions=(lambda stress: 2 * stress, lambda stress: stress / 2))
	right.spines["right"].set_linewidth(0.6)
	if label:
		right.set_ylabel("the same divided by A [MPa]")


def _legend(fig, ax):
	handles, labels = ax.get_legend_handles_labels()
	fig.legend(handles, [f"radii {label}" for label in labels], loc="outside lower center", ncols=len(labels))
