# GPL v2 or later, see LICENSE.
"""Pictures of a spalling bar."""
import numpy as np
from matplotlib import rc_context

from ... import plots
from .spall import WAVE


def history(broken, elastic, largest=None):
	"""Velocity of the free end with and without fracture, stress over place and time,
	and damage along the bar at the end.

	:param broken, elastic: :class:`spall.History` each
	:param largest: of the colours of the stress [MPa]; twice the largest tension if left out
	"""
	with rc_context(plots.STYLE):
		fig = plots.figure(plots.PAGE, 105)
		fig.set_layout_engine("constrained")
		places = fig.subplot_mosaic(
			[["surface", "waves"], ["damage", "waves"]], width_ratios=(1, 1.15), height_ratios=(1.3, 1)
		)
		ax = places["surface"]
		for one, name, look in ((elastic, "elastic", "k--"), (broken, "concrete", "-")):
			ax.plot(1e6 * one.times, one.surface, look, linewidth=0.9, label=name)
		(high, low), rows = broken.pullback
		ax.annotate(
			"",
			(1e6 * broken.times[rows[1]], low),
			(1e6 * broken.times[rows[1]], high),
			arrowprops={"arrowstyle": "<->", "linewidth": 0.7},
		)
		ax.annotate(
			r"$\Delta u_{fs}$",
			(1e6 * broken.times[rows[1]], 0.5 * (high + low)),
			textcoords="offset points",
			xytext=(4, 0),
		)
		ax.set_xlabel("time [µs]")
		ax.set_ylabel("velocity of the free end [m/s]")
		ax.legend(loc="upper left")

		ax = places["damage"]
		ax.fill_between(1e3 * broken.places, broken.damage[-1], step="mid", color=plots.COLOURS[1], linewidth=0)
		quarter = 1e3 * (broken.length - WAVE * broken.duration / 4)
		ax.axvline(quarter, color="k", linewidth=0.7, linestyle="--")
		ax.annotate(
			"$cT/4$ from\nthe free end", (quarter, 0.97), textcoords="offset points", xytext=(-28, 0),
			ha="right", va="top"
		)
		ax.set_xlim(0, 1e3 * broken.length)
		ax.set_ylim(0, 1)
		ax.set_xlabel("$x$ [mm]")
		ax.set_ylabel("damage at the end [-]")

		ax = places["waves"]
		largest = largest or 2 * broken.stress.max() / 1e6
		drawn = ax.pcolormesh(
			1e3 * broken.places, 1e6 * broken.times, broken.stress / 1e6, cmap=plots.DIVERGING,
			vmin=-largest, vmax=largest, shading="nearest", rasterized=True
		)
		if broken.damage.max() > 0.5:
			ax.contour(
				1e3 * broken.places, 1e6 * broken.times, broken.damage, levels=[0.5], colors="k",
				linewidths=0.7
			)
		_, row, cell = broken.tension
		(leaves, comes), x = 1e6 * np.array(broken.arrivals), 1e3 * broken.places[cell]
		ax.plot(
			[1e3 * broken.length, x, 1e3 * broken.length],
			[leaves, 1e6 * broken.times[row], comes],
			"k--",
			linewidth=0.7,
		)
		ax.plot(x, 1e6 * broken.times[row], "ko", markersize=2.5)
		ax.set_ylim(0, 1e6 * broken.times[-1])
		ax.set_xlabel("$x$ [mm]")
		ax.set_ylabel("time [µs]")
		fig.colorbar(drawn, ax=ax, label="axial stress [MPa], tension positive", aspect=30, extend="both")
		for name in ("surface", "damage"):
			places[name].spines[["top", "right"]].set_visible(False)
	return fig
