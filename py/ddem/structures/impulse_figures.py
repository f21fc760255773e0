# GPL v2 or later, see LICENSE.
"""Pictures of the block under an impulse, as Figure 5 of Zubelewicz (2018)."""
import numpy as np
from matplotlib import rc_context

from .. import plots


def displacement(history, reference=None):
	"""Displacement of the central point and pressure over time; below what deformation contributes to it."""
	with rc_context(plots.STYLE):
		fig = plots.figure(plots.COLUMN, 105)
		fig.set_layout_engine("constrained")
		whole, part = fig.subplots(2, 1, sharex=True, height_ratios=(1, 1))
		time = 1e6 * history.times
		whole.plot(time, 1e6 * history.centre[:, 0], color=plots.COLOURS[1], label="$u_x$")
		push = whole.twinx()
		push.plot(time, history.impulse.at(history.times) / 1e6, color=plots.COLOURS[0])
		push.set_ylabel("pressure on the side [MPa]", color=plots.COLOURS[0])
		push.spines["top"].set_visible(False)
		push.set_ylim(0, 1.6 * history.impulse.pressure / 1e6)
		whole.set_ylabel("$u_x$ at the centre [µm]", color=plots.COLOURS[1])
		_mark(whole, history, 1e6 * history.centre[:, 0])
		rest = 1e6 * (history.centre[:, 0] - history.impulse.rigid(history.times))
		part.plot(time, rest, color=plots.COLOURS[1], label="deformable triangles")
		if reference is not None:
			part.plot(1e6 * reference.times, 1e6 * (reference.centre[:, 0] - history.impulse.rigid(reference.times)), "k--", linewidth=0.8, label="finite elements")
		_mark(part, history, rest)
		part.set_xlabel("time [µs]")
		part.set_ylabel("$u_x$ minus that of\na rigid block [µm]")
		part.legend(loc="best")
		for ax in (whole, part):
			ax.spines["top"].set_visible(False)
		part.spines["right"].set_visible(False)
	return fig


def contours(history):
	"""u_x, its mean left out, and u_y at the instants, in columns."""
	count = len(history.instants)
	with rc_context(plots.STYLE):
		fig = plots.figure(plots.PAGE, min(105, 40 + 210 / count))
		fig.set_layout_engine("constrained")
		axes = np.ravel(fig.subplots(1, 2 * count, sharey=True))
		for axis, name in ((0, "$u_x$ minus its mean [µm]"), (1, "$u_y$ [µm]")):
			fields = [1e6 * (field[:, axis] - field[:, axis].mean()) for field in history.fields]
			largest = max(np.abs(field).max() for field in fields)
			row = axes[axis * count:(axis + 1) * count]
			for number, (ax, field) in enumerate(zip(row, fields)):
				plots.field(history.mesh, field, name, ax=ax, limits=(-largest, largest), signed=True, colorbar=False)
				ax.set_title(f"{number + 1}: {1e6 * history.instants[number]:.0f} µs")
				ax.set_xticks((0, 50, 100))
				if ax is not axes[0]:
					ax.set_ylabel("")
			fig.colorbar(row[0].collections[0], ax=list(row), label=name, location="top", shrink=0.8, aspect=25)
	return fig


def _mark(ax, history, values):
	for number, instant in enumerate(history.instants):
		height = np.interp(instant, history.times, values)
		ax.plot(1e6 * instant, height, "o", color="k", markersize=3, zorder=4)
		ax.annotate(str(number + 1), (1e6 * instant, height), textcoords="offset points", xytext=(-7, 4), fontsize=8)
