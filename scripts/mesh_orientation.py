# GPL v2 or later, see LICENSE.
"""Crush the same block on crossed, alternating and irregular meshes: what the pattern of the mesh does to strength, energy and cracks.

Run:      scripts/ddem run scripts/mesh_orientation.py                 (a minute)
          scripts/ddem run scripts/mesh_orientation.py --count 800     (ten seconds, the coarse meshes alone)
          scripts/ddem run scripts/mesh_orientation.py --help          (all options)
Writes:   a table here, and in out/mesh_orientation: orientation.png, a CSV of each block, and crossed-800.pvd … for ParaView.

A block 10 cm wide and 20 cm tall between rough platens that move towards each other at 1 m/s each; Tables 1 and 2, random fracture energies. Crossed cells have both
diagonals, alternating ones a diagonal each, whose direction alternates; irregular meshes are CGAL's. Meshes of about the same number of triangles are compared.

Expect:   strengths of 70 to 73 MPa, whatever the pattern and the fineness; the energy taken until 0.6 % within 9 % on meshes of one fineness, the irregular one
          highest, and 16 to 19 % less on meshes of four times as many triangles. Two bands run from corner to corner, at 63° on every mesh; on the regular ones
          the edges of the wedges at the ends follow the diagonals of the cells, on the irregular one they are rough.
"""
import argparse
import math
import os

import numpy as np
from matplotlib import rc_context

from yade import O
from yade.ddem import commandline, plots, vtk
from yade.ddem.series import Series
from yade.ddem.structures import confined

# size [m] that gives so many triangles on the area of the block: four, two and 2.38 triangles for each square of that side
SIZES = {"crossed": 4.0, "alternating": 2.0, "unstructured": 2.38}


def main():
	options = read_options()
	blocks = {}
	print(f"{'mesh':<14}{'triangles':>10}{'strength [MPa]':>16}{'at strain [%]':>15}{'left [MPa]':>12}{'energy [kJ/m³]':>16}{'mean damage':>13}")
	for count in options.count:
		for pattern, share in SIZES.items():
			O.reset()
			size = math.sqrt(share * confined.WIDTH * confined.HEIGHT / count)
			name = os.path.join(options.out, f"{pattern}-{count}")
			recorders = [lambda block: vtk.Recorder(block, name)] if options.vtk else []
			one = blocks[count, pattern] = confined.run(0.0, "rough", options.seed, size, pattern, strain=options.strain, recorders=recorders)
			series = Series(strain="-", stress="Pa")
			for strain, stress in zip(one.strain, one.stress):
				series.append(strain=strain, stress=stress)
			series.write(f"{name}.csv")
			print(
				f"{pattern:<14}{len(one.mesh.triangles):>10}{one.peak[0] / 1e6:>16.1f}{100 * one.peak[1]:>15.2f}{one.stress[-1] / 1e6:>12.1f}"
				f"{np.trapezoid(one.stress, one.strain) / 1e3:>16.0f}{one.damage.mean():>13.2f}", flush=True
			)
	plots.save(draw(blocks, options.count), os.path.join(options.out, "orientation.png"))
	print(f"\nPictures and files: {options.out}")


def draw(blocks, counts):
	"""Stress over strain for all meshes, and damage of the finest ones at the end."""
	with rc_context(plots.STYLE):
		fig = plots.figure(plots.PAGE, 82)
		fig.set_layout_engine("constrained")
		curves, *maps = fig.subplots(1, 1 + len(SIZES), width_ratios=(1.5, *[1] * len(SIZES)))
		for (count, pattern), one in blocks.items():
			colour = plots.COLOURS[list(SIZES).index(pattern)]
			last = count == counts[-1]
			curves.plot(100 * one.strain, one.stress / 1e6, "-" if last else "--", color=colour, label=pattern if last else None)
		for number, count in enumerate(counts):
			curves.plot([], [], "-" if number == len(counts) - 1 else "--", color="k", label=f"about {count} triangles")
		curves.set_xlabel("strain [%]")
		curves.set_ylabel("stress [MPa]")
		curves.set_ylim(0, 1.55 * max(one.stress.max() for one in blocks.values()) / 1e6)
		curves.legend(loc="upper right")
		curves.spines[["top", "right"]].set_visible(False)
		for ax, pattern in zip(maps, SIZES):
			one = blocks[counts[-1], pattern]
			plots.field((one.nodes, one.mesh.triangles), one.damage, "", ax=ax, limits=(0, 1), colorbar=False)
			ax.set_title(pattern)
			ax.set_xlim(-8, 1e3 * confined.WIDTH + 8)
			ax.set_ylim(-3, 1e3 * confined.HEIGHT + 3)
			if ax is not maps[0]:
				ax.set_ylabel("")
		fig.colorbar(maps[0].collections[0], ax=list(maps), label="damage $\\eta/\\eta_{max}$ [-]", location="bottom", shrink=0.6, aspect=30)
	return fig


def read_options():
	"""Options from the command line; complains about them before anything runs."""
	parser = argparse.ArgumentParser(
		prog="scripts/ddem run scripts/mesh_orientation.py", usage="%(prog)s [options]", description="Crush the same block on meshes of several patterns.",
		formatter_class=argparse.ArgumentDefaultsHelpFormatter, allow_abbrev=False
	)
	parser.add_argument("--count", type=int, nargs="+", default=(800, 3200), metavar="N", help="about how many triangles the meshes have; at most two of them")
	parser.add_argument("--seed", type=int, default=1, help="draws the fracture energies")
	parser.add_argument("--strain", type=float, default=0.006, metavar="E", help="at which a test ends [-]")
	parser.add_argument("--vtk", action=argparse.BooleanOptionalAction, default=True, help="ParaView files")
	parser.add_argument("--out", default=os.path.join("out", "mesh_orientation"), metavar="DIR", help="folder for all files, made when missing")
	options = parser.parse_args()
	for name, values, low, high in (("--count", options.count, 100, 1e5), ("--seed", [options.seed], 0, math.inf), ("--strain", [options.strain], 1e-4, 0.1)):
		for value in values:
			if not low <= value <= high:
				parser.error(f"argument {name}: {value:g} must lie between {low:g} and {high:g}")
	if len(options.count) > 2:
		parser.error(f"argument --count: {len(options.count)} numbers; give one or two")
	commandline.require_writable(parser, "--out", options.out)
	return options


if __name__ == "__main__":
	main()
