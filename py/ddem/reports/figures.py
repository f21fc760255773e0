# GPL v2 or later, see LICENSE.
"""Pictures of tests in compression or tension, each made from finished runs and returned as a matplotlib figure;
None where there is nothing to show."""
import numpy as np
from matplotlib import rc_context
from matplotlib.collections import LineCollection
from matplotlib.ticker import FormatStrFormatter

from .. import broken_bonds as broken_list
from .. import plots
from ..studies.measures import instants
from ..studies.runs import ENERGY_PARTS
from ..studies.snapshots import TriangleSnapshot

MODEL_COLOURS = {"rigid": plots.COLOURS[1], "deformable": plots.COLOURS[0]}
_PART_COLOURS = {
	"elastic": "#56B4E9", "kinetic": "#F0E442", "plastic flow": "#E69F00", "damage": "#D55E00",
	"broken bonds": "#CC79A7", "friction": "#009E73",
	"damping": "#999999"
}


def stress_strain(runs):
	"""Stress over strain, with the peaks and the lines that give Young's moduli."""
	fig, axes = _figure(1, plots.COLUMN, 65)
	ax = axes[0]
	with rc_context(plots.STYLE):
		for run in runs:
			strain, stress, measures = 100 * run.series["strain"], run.series["stress"] / 1e6, run.strength
			colour = MODEL_COLOURS[run.model]
			ax.plot(strain, stress, color=colour, label=run.title)
			if run.has_strength:
				ax.plot(
					100 * measures.strain_at_peak, measures.ucs / 1e6, "o", color=colour,
					markersize=3.5
				)
			if np.isfinite(measures.young) and run.wording.modulus:
				ends = np.array([0.0, 0.9 * measures.ucs])
				ax.plot(
					100 * (ends - measures.offset) / measures.young, ends / 1e6, "--", color=colour,
					linewidth=0.6
				)
		words = runs[0].wording
		if words.modulus:
			ax.plot([], [], "--", color="0.4", linewidth=0.6, label="fit between 20 % and 60 %")
		if any(run.has_strength for run in runs):
			ax.plot([], [], "o", color="0.4", markersize=3.5, label=f"peak ({words.peak})")
		_label(ax, f"{words.strain} [%]", f"{words.stress} [MPa]")
		ax.set_xlim(0, 102 * max(run.series["strain"].max() for run in runs))
		ax.set_ylim(bottom=min(0.0, min(1.05 * run.series["stress"].min() / 1e6 for run in runs)))
		fig.legend(loc="outside upper center", ncols=2, columnspacing=1.5)
	return fig


def wall_forces(runs):
	"""Forces on both platens over time, a panel a model."""
	fig, axes = _figure(len(runs), plots.PAGE if len(runs) > 1 else plots.COLUMN, 55, sharey=True)
	with rc_context(plots.STYLE):
		for ax, run in zip(axes, runs):
			time, colour = 1e3 * run.series["time"], MODEL_COLOURS[run.model]
			ax.plot(time, run.series["force_top"] / 1e3, color=colour, label=run.wording.ends[0])
			ax.plot(
				time, run.series["force_bottom"] / 1e3, color="0.25", linewidth=0.8,
				linestyle=(0, (3, 1.2)), label=run.wording.ends[1]
			)
			_label(ax, "time [ms]", f"{run.wording.force} [kN]" if ax is axes[0] else None, run.title)
			ax.set_xlim(left=0)
			ax.legend()
	return fig


def damage(runs):
	"""Broken bonds and damage over strain."""
	fig, axes = _figure(1, plots.COLUMN, 65)
	ax, names = axes[0], {"rigid": "broken share of bonds", "deformable": "mean damage of triangles"}
	with rc_context(plots.STYLE):
		for run in runs:
			strain, values, peak = 100 * run.series["strain"], run.series["damage"], run.strength.peak
			ax.plot(strain, values, color=MODEL_COLOURS[run.model], label=names[run.model])
			ax.plot(strain[peak], values[peak], "o", color=MODEL_COLOURS[run.model], markersize=3.5)
		ax.plot([], [], "o", color="0.4", markersize=3.5, label="at the peak stress")
		_label(ax, f"{runs[0].wording.strain} [%]", "damage of the sample [-]")
		ax.set_xlim(left=0)
		ax.set_ylim(bottom=0)
		fig.legend(loc="outside upper center", ncols=2, columnspacing=1.5)
	return fig


def broken_bonds(runs):
	"""Number of broken bonds over time, by mode, with the moment of the peak stress."""
	rigid = [run for run in runs if run.broken is not None]
	if not rigid:
		return None
	run = rigid[0]
	fig, axes = _figure(1, plots.COLUMN, 65)
	ax, time = axes[0], run.series["time"]
	with rc_context(plots.STYLE):
		for label, mode, colour, line in (
			("all", None, "0.25", "-"),
			("in tension", "tension", plots.COLOURS[0], "-"),
			("in shear", "shear", plots.COLOURS[4], "-"),
		):
			ax.plot(1e3 * time, broken_list.counts(run.broken, time, mode), line, color=colour, label=label)
		ax.axvline(
			1e3 * time[run.strength.peak], color="0.5", linewidth=0.6, linestyle=(0, (3, 1.5)),
			label="peak stress"
		)
		_label(ax, "time [ms]", "broken bonds [-]")
		ax.set_xlim(0, 1e3 * time[-1])
		ax.set_ylim(bottom=0)
		bonds = run.extra["bonds"]
		share = ax.secondary_yaxis(
			"right", functions=(lambda count: 100 * count / bonds, lambda part: part * bonds / 100)
		)
		share.set_ylabel("share of all bonds [%]")
		share.spines["right"].set_linewidth(0.6)
		fig.legend(loc="outside upper center", ncols=4, columnspacing=1.5)
	return fig


def energy(runs):
	"""Where the platens' work went, and how far the energy book is from closing; None where no run kept one."""
	runs = [run for run in runs if run.energy("input") is not None]
	if not runs:
		return None
	with rc_context(plots.STYLE):
		fig = plots.figure(plots.PAGE if len(runs) > 1 else plots.COLUMN, 78)
		axes = fig.subplots(2, len(runs), sharex="col", height_ratios=(3.2, 1), squeeze=False)
		shown = {}
		for (book, error), run in zip(axes.T, runs):
			strain, base = 100 * run.series["strain"], 0.0
			for part in ENERGY_PARTS:
				values = run.energy(part)
				if (
					values is None
					or not np.abs(values).max() > 0.01 * np.abs(run.energy("input")).max()
				):
					continue
				shown[part] = book.fill_between(
					strain, base, base + values, color=_PART_COLOURS[part], linewidth=0, alpha=0.85
				)
				base = base + values
			(shown[f"work of the {run.wording.loads}"],) = book.plot(
				strain, run.energy("input"), color="black", linewidth=0.9
			)
			_label(book, None, "energy [J]" if book is axes[0, 0] else None, run.title)
			error.semilogy(
				strain,
				np.maximum(100 * np.abs(run.series["energy_drift"]) / run.energy_through, 1e-10),
				color=MODEL_COLOURS[run.model],
			)
			_label(error, f"{run.wording.strain} [%]", "error [%]" if error is axes[1, 0] else None)
			book.set_xlim(0, strain[-1])
			book.set_ylim(bottom=0)
		_same_limits([ax for ax in axes[1]])
		fig.legend(
			shown.values(), shown.keys(), loc="outside lower center", ncols=7 if len(runs) > 1 else 3,
			columnspacing=1.2, handlelength=1.4
		)
	return fig


def final_damage(runs):
	"""Damage of the samples at the end, side by side, in one scale of colours."""
	return _maps(runs, [[run.snapshots[-1]] for run in runs], _width(runs), _draw_damage, "damage [-]")


def evolution(runs):
	"""Damage at the same stages of both tests: on the way up, at the peak, on the way down, at the end."""
	chosen = [
		[
			run.snapshot_near(run.series["time"][row])
			for row in instants(run.series["strain"], run.series["stress"])
		]
		for run in runs
	]
	return _maps(runs, chosen, plots.PAGE, _draw_damage, "damage [-]", stages=True)


def rotation(runs):
	"""Rotation of the particles at the end, side by side, each in its own scale."""
	return _maps(
		runs,
		[[run.snapshots[-1]] for run in runs],
		_width(runs),
		_draw_rotation,
		"rotation [rad]",
		own_scales=True,
	)


def engines(runs):
	"""Time per particle and step that each engine took."""
	fig, axes = _figure(1, plots.PAGE, 13 + 4.8 * sum(len(run.engine_costs(0.005)) + 1 for run in runs))
	ax, place, ticks = axes[0], 0.0, []
	with rc_context(plots.STYLE):
		for run in runs:
			costs = run.engine_costs(0.005)
			for name, cost, share in costs:
				ax.barh(
					place, cost, color=MODEL_COLOURS[run.model], height=0.72,
					label=run.title if name == costs[0][0] else None
				)
				text = (
					f"{cost:.0f} ns ({100 * share:.1f} %)"
					if cost >= 10
					else f"{cost:.2g} ns ({100 * share:.1f} %)"
				)
				ax.annotate(
					text, (cost, place), (3, 0), textcoords="offset points", va="center", fontsize=7
				)
				ticks.append((place, name))
				place += 1
			place += 1
		ax.set_yticks([y for y, _ in ticks], [name for _, name in ticks])
		ax.invert_yaxis()
		_label(ax, "wall time per particle and step [ns]", None)
		ax.margins(x=0.16)
		ax.legend(loc="lower right")
	return fig


def also(runs):
	"""What a kind of test records beside stress and strain, over the last of it; None where that is nothing."""
	if not runs[0].wording.also:
		return None
	*columns, over = runs[0].wording.also
	with rc_context(plots.STYLE):
		fig = plots.figure(plots.COLUMN, 65 if len(columns) == 1 else 15 + 35 * len(columns))
		axes = fig.subplots(len(columns), 1, sharex=True, squeeze=False)[:, 0]
		for ax, column in zip(axes, columns):
			for run in runs:
				ax.plot(
					over.factor * run.series[over.name], column.factor * run.series[column.name],
					color=MODEL_COLOURS[run.model]
				)
			_label(ax, over.label if ax is axes[-1] else None, column.label)
			ax.margins(x=0)
	return fig


#: pictures of the report, in order
ALL = {
	"stress_strain": stress_strain, "also": also, "damage": damage, "broken_bonds": broken_bonds,
	"wall_forces": wall_forces,
	"evolution": evolution,
	"final_damage": final_damage, "rotation": rotation, "energy": energy, "engines": engines
}


def _draw_damage(snapshot, ax):
	if isinstance(snapshot, TriangleSnapshot):
		plots.field(
			(snapshot.nodes, snapshot.triangles), snapshot.damage, "", ax=ax, limits=(0, 1), colorbar=False
		)
		ax.add_collection(LineCollection(1e3 * snapshot.nodes[snapshot.border], colors="white", linewidths=0.7))
	else:
		plots.spheres(
			snapshot.centres, snapshot.radii, snapshot.damage, "", ax=ax, limits=(0, 1), colorbar=False,
			cracks=snapshot.cracks
		)
		_draw_loads(snapshot, ax)


def _draw_rotation(snapshot, ax):
	largest = np.quantile(np.abs(snapshot.rotation), 0.99) or 1.0
	look = {"ax": ax, "limits": (-largest, largest), "signed": True, "colorbar": False}
	if isinstance(snapshot, TriangleSnapshot):
		plots.field((snapshot.nodes, snapshot.triangles), snapshot.rotation, "", **look)
	else:
		plots.spheres(snapshot.centres, snapshot.radii, snapshot.rotation, "", **look)
		_draw_loads(snapshot, ax)


def _draw_loads(snapshot, ax):
	ax.add_collection(LineCollection([1e3 * line for line in snapshot.loads], colors="0.25", linewidths=1.0))


def _width(runs):
	return plots.COLUMN if len(runs) > 1 else 0.55 * plots.COLUMN


def _maps(runs, snapshots, width, draw, label, stages=False, own_scales=False):
	"""A row of pictures a model with the stage above each and a colour bar at the side, or one row with a picture
	a model and colour bars below; all of the same piece of the plane.
	"""
	low, high = _window(snapshots)
	wide = (high - low)[0] > 1.5 * (high - low)[1]  # as a beam
	rows, columns = (len(runs), max(map(len, snapshots))) if stages else (1, len(runs))
	below = stages and wide and len(runs) == 1  # the stages one below the other
	if below:
		rows, columns, width = columns, rows, plots.COLUMN
	elif wide:
		width = max(width, plots.COLUMN)
	across = (width - (29 if stages else 13) - 4 * (columns - 1)) / columns  # of one picture [mm]
	with rc_context(plots.STYLE):
		fig = plots.figure(
			width, rows * (across * (high - low)[1] / (high - low)[0] + (5 if stages else 20)) + 10
		)
		axes = fig.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
		for ax in axes.flat:
			ax.set_visible(False)
		for row, (run, shown) in enumerate(zip(runs, snapshots)):
			for column, snapshot in enumerate(shown):
				ax = axes[column, row] if below else axes[row, column] if stages else axes[0, row]
				ax.set_visible(True)
				draw(snapshot, ax)
				ax.set_xlim(1e3 * low[0], 1e3 * high[0])
				ax.set_ylim(1e3 * low[1], 1e3 * high[1])
				ax.set_title(_stage(run, snapshot) if stages else run.title.replace(" ", "\n", 1))
		for ax in axes[:, 1:].flat:
			ax.set_ylabel(None)
		for ax in axes[:-1].flat:
			ax.set_xlabel(None)
		if stages and not below:
			for ax, run in zip(axes[:, 0], runs):
				ax.set_ylabel(f"{run.title}\n{ax.get_ylabel()}")
		look = (
			{"shrink": 0.7, "aspect": 30}
			if stages
			else {"shrink": 0.9, "aspect": 30 if own_scales else 45, "orientation": "horizontal"}
		)
		for ax in axes.flat if own_scales else axes.flat[:1]:
			bar = fig.colorbar(
				ax.collections[0], ax=ax if own_scales else axes, label=label,
				extend="both" if own_scales else "neither", **look
			)
			if own_scales:
				bar.ax.locator_params(nbins=3)
				bar.formatter = FormatStrFormatter("%g")
	return fig


def _stage(run, snapshot):
	row = int(np.argmin(np.abs(run.series["time"] - snapshot.time)))
	return f"{100 * run.series['strain'][row]:.2f} %, {run.series['stress'][row] / 1e6:.0f} MPa"


def _window(snapshots):
	"""Corners of the piece of the plane that shows nearly all of every sample,
	but not the last fragment that flew away."""
	def places(snapshot):
		return snapshot.nodes if isinstance(snapshot, TriangleSnapshot) else snapshot.centres[:, :2]

	ends = [np.quantile(places(s), (0.01, 0.99), axis=0) for row in snapshots for s in row]
	ends += [
		np.array([line.min(axis=0), line.max(axis=0)])
		for row in snapshots for s in row for line in getattr(s, "loads", ())
	]
	low, high = np.min([e[0] for e in ends], axis=0), np.max([e[1] for e in ends], axis=0)
	return low - 0.05 * (high - low), high + 0.05 * (high - low)


def _figure(panels, width, height, **options):
	with rc_context(plots.STYLE):
		fig = plots.figure(width, height)
		fig.set_layout_engine("constrained")
		return fig, fig.subplots(1, panels, squeeze=False, **options)[0]


def _label(ax, x, y, title=None):
	ax.spines[["top", "right"]].set_visible(False)
	if x:
		ax.set_xlabel(x)
	if y:
		ax.set_ylabel(y)
	if title:
		ax.set_title(title)


def _same_limits(axes):
	low, high = min(ax.get_ylim()[0] for ax in axes), max(ax.get_ylim()[1] for ax in axes)
	for ax in axes:
		ax.set_ylim(low, high)
