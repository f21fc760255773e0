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
import math
import os

from yade import O
from yade.ddem import commandline, plots, vtk
from yade.ddem.structures import confined, confined_figures

# size [m] that gives so many triangles on the area of the block: four, two and 2.38 triangles for each square of that side
SIZES = {"crossed": 4.0, "alternating": 2.0, "unstructured": 2.38}


def main():
	options = read_options()
	blocks = {}
	print(f"{'mesh':<14}{'triangles':>10}{'strength [MPa]':>16}{'left [MPa]':>12}{'energy [kJ/m³]':>16}{'mean damage':>13}   bands at [°] (share)")
	for count in options.count:
		for pattern, share in SIZES.items():
			O.reset()
			size = math.sqrt(share * confined.WIDTH * confined.HEIGHT / count)
			name = os.path.join(options.out, f"{pattern}-{count}")
			recorders = [lambda block: vtk.Recorder(block, name)] if options.vtk else []
			one = blocks[count, pattern] = confined.run(0.0, options.ends, options.seed, size, pattern, options.velocity, options.strain, recorders=recorders)
			one.series.write(f"{name}.csv")
			bands = "  ".join(f"{angle:>2} ({share:.2f})" for angle, share in one.bands())
			print(
				f"{pattern:<14}{len(one.mesh.triangles):>10}{one.peak[0] / 1e6:>16.1f}{one.stress[-1] / 1e6:>12.1f}{one.energy / 1e3:>16.0f}{one.damage.mean():>13.2f}   {bands}",
				flush=True
			)
	plots.save(confined_figures.orientation(blocks), os.path.join(options.out, "orientation.png"))
	print(f"\nPictures and files: {options.out}")


def read_options():
	"""Options from the command line; complains about them before anything runs."""
	parser = commandline.script_parser("mesh_orientation", "Crush the same block on meshes of several patterns.")
	parser.add_argument("--count", type=int, nargs="+", default=(800, 3200), metavar="N", help="about how many triangles the meshes have; at most two of them")
	parser.add_argument("--ends", choices=("rough", "smooth"), default="rough", help="rough ends hold the block laterally; with smooth ones bands lie where they want")
	parser.add_argument("--velocity", type=float, default=0.5, metavar="M/S", help="of each platen [m/s]")
	parser.add_argument("--strain", type=float, default=0.006, metavar="E", help="at which a test ends [-]")
	parser.add_argument("--seed", type=int, default=1, metavar="N", help="draws the fracture energies")
	commandline.add_files(parser, "mesh_orientation")
	options = parser.parse_args()
	for name, values, low, high in (
		("--count", options.count, 100, 1e5), ("--velocity", options.velocity, 1e-3, 100), ("--strain", options.strain, 1e-4, 0.1), ("--seed", options.seed, 0, math.inf)
	):
		commandline.require_between(parser, name, values, low, high)
	if len(options.count) > 2:
		parser.error(f"argument --count: {len(options.count)} numbers; give one or two")
	commandline.require_writable(parser, "--out", options.out)
	return options


if __name__ == "__main__":
	main()
