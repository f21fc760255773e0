# GPL v2 or later, see LICENSE.
"""Pictures of the crushed block with a steel bar, as Figures 6 to 8 of Zubelewicz (2018), and of its studies."""
import numpy as np
from matplotlib import rc_context
from matplotlib.collections import LineCollection

from ... import plots
from .reinforced import HEIGHT, WIDTH


def history(crushed, instants, shown=3e-4):
	"""Figure 7: average stress on the top over time, and damage on the deformed block at the instants [s];
	*shown* [s] of the time."""
	with rc_context(plots.STYLE):
		fig, upper, lower = _rows(len(instants), 125, (0.62, 1))
		upper.plot(
			1e6 * crushed.times, crushed.stress / 1e6, color="0.8", linewidth=0.6,
			label="average stress on the top"
		)
		_curve(upper, crushed, "its mean over 5 µs", plots.COLOURS[1])
		upper.legend(loc="upper right")
		for number, instant in enumerate(instants, start=1):
			_mark(upper, crushed, instant, str(number))
		_label(upper, shown)
		for number, (ax, instant) in enumerate(zip(lower, instants), start=1):
			drawn = block(ax, crushed, instant, "damage", (0, 1))
			ax.set_title(f"{number}: {1e6 * crushed.snapshot(instant)[0].time:.0f} µs")
		_share(lower)
		fig.colorbar(drawn, ax=list(lower), label="damage $\\eta/\\eta_{max}$ [-]", shrink=0.8, aspect=25)
	return fig


def shape(crushed, instant):
	"""Lateral displacement and rotation on the deformed block at an instant [s], and the largest rotation and
	lateral displacement over time."""
	snapshot, moved = crushed.snapshot(instant)
	with rc_context(plots.STYLE):
		fig, upper, lower = _rows(2, 92, (1, 1), side=True)
		lateral = 1e3 * moved[:, 0]
		for ax, values, name in (
			(lower[0], lateral, "lateral displacement [mm]"),
			(lower[1], snapshot.rotation, "rotation [rad]"),
		):
			drawn = block(ax, crushed, instant, values, None)
			fig.colorbar(drawn, ax=ax, label=name, shrink=0.8, aspect=25, location="bottom")
		_share(lower)
		times = 1e3 * np.array([s.time for s in crushed.run.snapshots])
		upper.plot(
			times,
			[np.abs(s.rotation).max() for s in crushed.run.snapshots],
			color=plots.COLOURS[0],
			label="largest rotation",
		)
		lateral = [1e2 * np.abs((s.nodes - crushed.mesh.nodes)[:, 0]).max() for s in crushed.run.snapshots]
		upper.plot(times, lateral, color=plots.COLOURS[1], label="largest lateral displacement")
		upper.axhline(np.pi / 3, color="0.4", linewidth=0.7, linestyle="--")
		upper.annotate(r"$\pi/3$", (0, np.pi / 3), textcoords="offset points", xytext=(2, 3))
		upper.set_xlabel("time [ms]")
		upper.set_ylabel("rotation [rad], displacement [cm]")
		upper.set_xlim(0, None)
		upper.set_ylim(0, None)
		upper.legend(loc="upper left")
	return fig


def realisations(crushed, instant):
	"""Figure 8: stress over time of several realisations (by seed), and damage of each at an instant [s],
	the point P."""
	with rc_context(plots.STYLE):
		fig, upper, lower = _rows(len(crushed), 125, (0.62, 1))
		for number, (seed, one) in enumerate(crushed.items()):
			_curve(upper, one, f"seed {seed}", plots.COLOURS[number % len(plots.COLOURS)])
		_mark(upper, next(iter(crushed.values())), instant, "P")
		_label(upper, 1.02 * instant)
		upper.legend(loc="upper right")
		for ax, (seed, one) in zip(lower, crushed.items()):
			drawn = block(ax, one, instant, "damage", (0, 1))
			ax.set_title(f"seed {seed}, P: {1e6 * one.snapshot(instant)[0].time:.0f} µs")
		_share(lower)
		fig.colorbar(drawn, ax=list(lower), label="damage $\\eta/\\eta_{max}$ [-]", shrink=0.8, aspect=25)
	return fig


def refinement(crushed, shown=3e-4):
	"""Stress over time on several meshes with and without the crack band, by (corrected?, size), and the energy
	that flow and damage take over the size."""
	sizes = sorted({size for _, size in crushed}, reverse=True)
	with rc_context(plots.STYLE):
		fig = plots.figure(plots.PAGE, 62)
		fig.set_layout_engine("constrained")
		panels = fig.subplots(1, 3, width_ratios=(1, 1, 0.8))
		for ax, corrected in zip(panels, (False, True)):
			for number, size in enumerate(sizes):
				_curve(ax, crushed[corrected, size], f"{1e3 * size:g} mm", plots.COLOURS[number])
			_label(ax, shown)
			ax.set_title("$G_f$ with crack band" if corrected else "$G_f$ per volume")
		panels[1].sharey(panels[0])
		panels[1].set_ylabel("")
		panels[0].legend(title="size")
		for corrected, marker in ((False, "o-"), (True, "s-")):
			energies = [
				np.interp(shown, crushed[corrected, size].times, crushed[corrected, size].dissipated)
				/ 1e3
				for size in sizes
			]
			panels[2].semilogx(
				[1e3 * size for size in sizes],
				energies,
				marker,
				markersize=4,
				label="crack band" if corrected else "per volume",
			)
		panels[2].set_xticks([1e3 * size for size in sizes], [f"{1e3 * size:g}" for size in sizes])
		panels[2].minorticks_off()
		panels[2].set_ylim(0, 1.05 * panels[2].get_ylim()[1])
		panels[2].set_xlabel("size of the cells [mm]")
		panels[2].set_ylabel(f"energy until {1e6 * shown:.0f} µs [kJ/m]")
		panels[2].legend()
		for ax in panels:
			ax.spines[["top", "right"]].set_visible(False)
	return fig


def shielding(crushed, zones, instant=24e-6, later=70e-6):
	"""What the bar changes: damage over time in zones around it, vertical stress at an instant [s] and damage at
	a later one with the bar, and the difference to the block without it.

	:param crushed: see :func:`reinforced_statements.with_and_without_bar`
	:param zones: masks of the triangles by name
	"""
	with_bar, without = crushed[True], crushed[False]
	with rc_context(plots.STYLE):
		fig = plots.figure(plots.PAGE, 75)
		fig.set_layout_engine("constrained")
		curve, *maps = fig.subplots(1, 5, width_ratios=(1.6, 1, 1, 1, 1))
		for number, (name, zone) in enumerate(zones.items()):
			for one, line in ((with_bar, "-"), (without, "--")):
				times = [snapshot.time for snapshot in one.run.snapshots]
				curve.plot(
					[1e6 * time for time in times],
					[one.mean_damage(time, zone) for time in times],
					line,
					color=plots.COLOURS[number],
					label=name if one is with_bar else None,
				)
		curve.plot([], [], "k--", label="without bar")
		curve.set_xlabel("time [µs]")
		curve.set_ylabel("mean damage [-]")
		curve.set_ylim(0, None)
		curve.legend(loc="upper left", bbox_to_anchor=(0.0, 1.05), handlelength=1.5)
		curve.spines[["top", "right"]].set_visible(False)
		stresses = [-one.recorders[0].at(instant)[:, 1] / 1e6 for one in (with_bar, without)]
		damages = [one.damage(later) for one in (with_bar, without)]
		pictures = (
			(instant, stresses[0], (0, 200), "compression\n[MPa]"),
			(instant, stresses[0] - stresses[1], None, "with − without\n[MPa]"),
			(later, damages[0], (0, 1), "damage\n[-]"),
			(later, damages[0] - damages[1], None, "with − without\n[-]")
		)
		for ax, (time, values, limits, name) in zip(maps, pictures):
			ax.set_title(f"{1e6 * time:.0f} µs")
			fig.colorbar(
				block(ax, with_bar, time, values, limits), ax=ax, label=name, location="bottom",
				shrink=0.9, aspect=10
			)
			ax.set_xlabel("")
		_share(maps)
	return fig


def block(ax, crushed, instant, values, limits):
	"""Draw "damage", or values of nodes, triangles or sub-elements, on the deformed block with its bar; returns
	what a colour bar needs. Without limits, colours are symmetric about zero."""
	snapshot, _ = crushed.snapshot(instant)
	values = snapshot.damage if isinstance(values, str) else values
	signed = limits is None
	plots.field(
		(snapshot.nodes, crushed.mesh.triangles), values, "", ax=ax, limits=limits, signed=signed,
		colorbar=False
	)
	if len(snapshot.border):
		ax.add_collection(LineCollection(1e3 * snapshot.nodes[snapshot.border], colors="red", linewidths=0.8))
	out = max(12, 1e3 * np.abs(snapshot.nodes[:, 0] - WIDTH / 2).max() - 500 * WIDTH + 3)
	ax.set_xlim(-out, 1e3 * WIDTH + out)
	ax.set_ylim(-4, 1e3 * HEIGHT + 4)
	return ax.collections[0]


def _rows(count, height, ratios, side=False):
	"""A figure with a wide panel and `count` maps, below it or (side) right of it."""
	fig = plots.figure(plots.PAGE, height)
	fig.set_layout_engine("constrained")
	if side:
		places = fig.subplot_mosaic([["wide", *range(count)]], width_ratios=(1.4, *[1] * count))
	else:
		places = fig.subplot_mosaic([["wide"] * count, list(range(count))], height_ratios=ratios)
	places["wide"].spines[["top", "right"]].set_visible(False)
	return fig, places["wide"], [places[k] for k in range(count)]


def _curve(ax, crushed, label, colour):
	ax.plot(1e6 * crushed.times, crushed.smooth / 1e6, color=colour, linewidth=0.8, label=label)


def _mark(ax, crushed, instant, text):
	height = np.interp(instant, crushed.times, crushed.smooth) / 1e6
	ax.plot(1e6 * instant, height, "o", color="k", markersize=3, zorder=4)
	ax.annotate(text, (1e6 * instant, height), textcoords="offset points", xytext=(4, 5), fontsize=8)


def _label(ax, shown):
	ax.set_xlim(0, 1e6 * shown)
	ax.set_xlabel("time [µs]")
	ax.set_ylabel("stress [MPa]")


def _share(axes):
	for ax in axes[1:]:
		ax.set_ylabel("")
		ax.set_yticklabels([])
