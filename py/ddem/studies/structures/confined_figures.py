# GPL v2 or later, see LICENSE.
"""Pictures of blocks crushed under lateral pressure."""
import numpy as np
from matplotlib import rc_context

from ... import plots
from . import confined


def strength(rough, smooth):
	"""Stress over strain, strength over pressure, and damage at the end.

	:param rough, smooth: lists of :class:`confined.History`, in order of their pressures
	"""
	with rc_context(plots.STYLE):
		fig = plots.figure(plots.PAGE, 130)
		fig.set_layout_engine("constrained")
		columns = 4
		wide = [["curves"] * (columns // 2) + ["strength"] * (columns - columns // 2)]
		places = fig.subplot_mosaic(wide + [list(range(columns))], height_ratios=(1, 1.15))
		for number, one in enumerate(rough):
			colour = plots.COLOURS[number]
			places["curves"].plot(
				100 * one.strain, one.stress / 1e6, color=colour, label=f"{one.pressure / 1e6:g} MPa"
			)
			strain, stress, _ = confined.material_point(one.pressure, one.rate, one.strain[-1])
			places["curves"].plot(100 * strain, stress / 1e6, "k--", linewidth=0.6)
		places["curves"].plot([], [], "k--", linewidth=0.6, label="material point")
		places["curves"].set_xlabel("strain of the block [%]")
		places["curves"].set_ylabel("axial stress [MPa]")
		places["curves"].set_ylim(0, 1.8 * max(one.stress.max() for one in rough) / 1e6)
		places["curves"].legend(title="pressure", ncols=2, loc="upper right")
		for histories, marker, name in (
			(rough, "o", "rough ends, spread of $G_f$"),
			(smooth, "s", "smooth ends, no spread"),
		):
			places["strength"].plot(
				[one.pressure / 1e6 for one in histories],
				[one.peak[0] / 1e6 for one in histories],
				marker,
				markersize=4,
				label=name,
			)
		pressures = np.linspace(0, max(one.pressure for one in rough), 25)
		peaks = [
			confined.material_point(pressure, rough[0].rate, 0.006)[1].max() / 1e6 for pressure in pressures
		]
		places["strength"].plot(pressures / 1e6, peaks, "k--", linewidth=0.8, label="material point")
		places["strength"].set_xlabel("lateral pressure [MPa]")
		places["strength"].set_ylabel("strength [MPa]")
		places["strength"].legend()
		for name in ("curves", "strength"):
			places[name].spines[["top", "right"]].set_visible(False)
		shown = rough[:columns]
		_maps([places[k] for k in range(len(shown))], {f"{one.pressure / 1e6:g} MPa": one for one in shown})
		for k in range(len(shown), columns):
			places[k].set_axis_off()
		fig.colorbar(
			places[0].collections[0],
			ax=[places[k] for k in range(columns)],
			label="damage $\\eta/\\eta_{max}$ [-]",
			aspect=25,
		)
	return fig


def orientation(blocks):
	"""Stress over strain of blocks on several meshes, by (number of triangles, pattern), and the damage at the end
	of those with the last number."""
	counts, patterns = (list(dict.fromkeys(names)) for names in zip(*blocks))
	with rc_context(plots.STYLE):
		fig = plots.figure(plots.PAGE, 82)
		fig.set_layout_engine("constrained")
		curves, *maps = fig.subplots(1, 1 + len(patterns), width_ratios=(1.5, *[1] * len(patterns)))
		look = lambda count: "-" if count == counts[-1] else "--"
		for (count, pattern), one in blocks.items():
			label = pattern if count == counts[-1] else None
			curves.plot(
				100 * one.strain, one.stress / 1e6, look(count),
				color=plots.COLOURS[patterns.index(pattern)], label=label
			)
		for count in counts:
			curves.plot([], [], look(count), color="k", label=f"about {count} triangles")
		curves.set_xlabel("strain of the block [%]")
		curves.set_ylabel("axial stress [MPa]")
		curves.set_ylim(0, 1.6 * max(one.stress.max() for one in blocks.values()) / 1e6)
		curves.legend(loc="upper right")
		curves.spines[["top", "right"]].set_visible(False)
		_maps(maps, {pattern: blocks[counts[-1], pattern] for pattern in patterns})
		fig.colorbar(
			maps[0].collections[0], ax=maps, label="damage $\\eta/\\eta_{max}$ [-]", location="bottom",
			shrink=0.6, aspect=30
		)
	return fig


def _maps(axes, blocks):
	"""Damage of blocks at the end, by title, on the deformed meshes."""
	for ax, (title, one) in zip(axes, blocks.items()):
		plots.field((one.nodes, one.mesh.triangles), one.damage, "", ax=ax, limits=(0, 1), colorbar=False)
		ax.set_title(title)
		ax.set_xlim(-8, 1e3 * confined.WIDTH + 8)
		ax.set_ylim(-3, 1e3 * confined.HEIGHT + 3)
		if ax is not axes[0]:
			ax.set_ylabel("")
