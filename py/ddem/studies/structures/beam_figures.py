# GPL v2 or later, see LICENSE.
"""Pictures of notched beams."""
from matplotlib import rc_context

from ... import plots


def bending(beams, shown, scale=20):
	"""Force over deflection on several meshes with and without the crack band, by (corrected?, size), and the
	damage of one of them on the deformed beam."""
	with rc_context(plots.STYLE):
		fig = plots.figure(plots.PAGE, 112)
		fig.set_layout_engine("constrained")
		places = fig.subplot_mosaic([[False, True], ["map", "map"]], height_ratios=(1.25, 1))
		sizes = sorted({size for _, size in beams}, reverse=True)
		for corrected in (False, True):
			ax = places[corrected]
			for number, size in enumerate(sizes):
				one = beams[corrected, size]
				ax.plot(
					1e3 * one.deflection,
					one.force / 1e3,
					color=plots.COLOURS[number],
					label=f"{1e3 * size:g} mm",
				)
				ax.plot(
					1e3 * one.deflection,
					one.reaction / 1e3,
					color=plots.COLOURS[number],
					linewidth=0.4,
				)
			ax.set_title("$G_f$ with crack band" if corrected else "$G_f$ per volume")
			ax.set_xlabel("deflection [mm]")
			ax.set_ylim(0, 1.25 * max(one.force.max() for one in beams.values()) / 1e3)
			ax.spines[["top", "right"]].set_visible(False)
		places[False].set_ylabel("load per thickness [kN/m]")
		places[False].plot([], [], "k", linewidth=0.4, label="supports")
		places[False].legend(title="size")
		one, ax = beams[shown], places["map"]
		plots.field(
			one.mesh, one.damage, "damage $\\eta/\\eta_{max}$ [-]", ax=ax,
			displacement=one.nodes - one.mesh.nodes, scale=scale, limits=(0, 1)
		)
	return fig
