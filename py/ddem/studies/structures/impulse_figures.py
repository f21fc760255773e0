# GPL v2 or later, see LICENSE.
"""Pictures of the block under an impulse, as Figure 5 of Zubelewicz (2018)."""
import numpy as np
from matplotlib import rc_context
from matplotlib.lines import Line2D
from matplotlib.tri import Triangulation

from ... import plots


def displacement(history, reference=None):
	"""Displacement of the central point and pressure over time; below what deformation contributes to it."""
	with rc_context(plots.STYLE):
		fig = plots.figure(plots.COLUMN, 105)
		fig.set_layout_engine("constrained")
		whole, part = fig.subplots(2, 1, sharex=True, height_ratios=(1, 1))
		time = 1e6 * history.times
		whole.plot(time, 1e6 * history.centre[:, 0], color=plots.COLOURS[1])
		if reference is not None:
			whole.plot(1e6 * reference.times, 1e6 * reference.centre[:, 0], "k--", linewidth=0.8)
		push = whole.twinx()
		push.plot(time, history.impulse.at(history.times) / 1e6, color=plots.COLOURS[0])
		push.set_ylabel("pressure on the side [MPa]", color=plots.COLOURS[0])
		push.spines["top"].set_visible(False)
		whole.set_xlim(0, time[-1])
		if history.impulse.pressure > 0:
			whole.set_ylim(0, None)
		push.set_ylim(0, 1.6 * history.impulse.pressure / 1e6)
		whole.set_ylabel("$u_x$ at the centre [µm]", color=plots.COLOURS[1])
		_mark(whole, history, 1e6 * history.centre[:, 0], (-8, 5))
		rest = 1e6 * (history.centre[:, 0] - history.impulse.rigid(history.times))
		part.plot(time, rest, color=plots.COLOURS[1], label="deformable triangles")
		if reference is not None:
			part.plot(
				1e6 * reference.times,
				1e6 * (reference.centre[:, 0] - history.impulse.rigid(reference.times)),
				"k--", linewidth=0.8, label="finite elements"
			)
		_mark(part, history, rest, (4, -13))
		part.set_xlabel("time [µs]")
		part.set_ylabel(r"$u_x - u_\mathrm{rigid}$ [µm]")
		part.legend(loc="best")
		for ax in (whole, part):
			ax.spines["top"].set_visible(False)
		part.spines["right"].set_visible(False)
	return fig


def contours(history, reference=None, levels=10):
	"""u_x, its mean left out, and u_y at the instants, in columns, with contour lines (not at zero);
	those of a reference dashed over them."""
	count = len(history.instants)
	with rc_context(plots.STYLE):
		fig = plots.figure(plots.PAGE, min(105, 40 + 210 / count))
		fig.set_layout_engine("constrained")
		axes = np.ravel(fig.subplots(1, 2 * count, sharey=True))
		for axis, name in ((0, "$u_x$ minus its mean [µm]"), (1, "$u_y$ [µm]")):
			part = lambda field: 1e6 * (field[:, axis] - field[:, axis].mean())
			fields = [part(field) for field in history.fields]
			largest = max(np.abs(field).max() for field in fields)
			row = axes[axis * count:(axis + 1) * count]
			for number, (ax, field) in enumerate(zip(row, fields)):
				plots.field(
					history.mesh, field, name, ax=ax, limits=(-largest, largest), signed=True,
					colorbar=False
				)
				lines = {"levels": np.linspace(-largest, largest, levels + 2)[1:-1], "linewidths": 0.5}
				shape = Triangulation(*(1e3 * history.mesh.nodes.T), history.mesh.triangles)
				ax.tricontour(shape, field, colors=plots.COLOURS[1], linestyles="solid", **lines)
				if reference is not None:
					ax.tricontour(
						shape, part(reference.fields[number]), colors="k", linestyles="dashed",
						**lines
					)
				ax.set_title(f"{number + 1}: {1e6 * history.instants[number]:.0f} µs")
				ax.set_xticks((0, 50, 100))
				if ax is not axes[0]:
					ax.set_ylabel("")
			fig.colorbar(
				row[0].collections[0], ax=list(row), label=name, location="top", shrink=0.8, aspect=25
			)
		if reference is not None:
			handles = [
				Line2D([], [], color=plots.COLOURS[1], linewidth=0.8),
				Line2D([], [], color="k", linewidth=0.8, linestyle="dashed"),
			]
			fig.legend(
				handles,
				["deformable triangles", "finite elements"],
				loc="outside lower center",
				ncols=2,
			)
	return fig


def _mark(ax, history, values, offset):
	for number, instant in enumerate(history.instants):
		height = np.interp(instant, history.times, values)
		ax.plot(1e6 * instant, height, "o", color="k", markersize=3, zorder=4)
		ax.annotate(
			str(number + 1), (1e6 * instant, height), textcoords="offset points", xytext=offset, fontsize=8,
			bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.4}
		)
