# GPL v2 or later, see LICENSE.
"""Crush a block under lateral pressure: strength and pattern of damage over the confinement.

Run:      scripts/ddem run scripts/confined_block.py                      (a minute)
          scripts/ddem run scripts/confined_block.py --pressures 0 10e6 30e6
          scripts/ddem run scripts/confined_block.py --help               (all options)
Writes:   a table here, and in out/confined_block: confined.png, a CSV of each test, and pressure-0.pvd … for ParaView.

             v v v         A block 10 cm wide and 20 cm tall, plane strain, 800 triangles, Tables 1 and 2. A pressure
          |=========|      grows on both sides; then two platens move towards each other at 0.5 m/s each, a strain rate
       -> |         | <-   of 5 /s. Each pressure is tested twice: with rough ends and random fracture energies, and
       -> |         | <-   with smooth ends and equal ones, where the block deforms as one point of the material does.
          |=========|
             ^ ^ ^

Expect:   with smooth ends the strengths of a material point in plane strain on the same path, 60, 145, 221 and 290 MPa
          at 0, 20, 40 and 60 MPa, within 1 %; what is missing is inertia, since the sides are set moving (5 % with
          --velocity 1, 0.3 % with 0.25). A cylinder in a pressure cell bears more, 105 to 329 MPa at 10 /s: in plane
          strain σ_zz is another than the pressure, 10 MPa without any, 75 MPa under 60. Rough ends add 3 to 5 MPa,
          at no pressure 7 without and 3 with the random fracture energies. The stress left after the peak grows with
          the pressure; damage is in two crossing bands that leave wedges at the ends whole. Their edges at 45° are
          those of the cells: see scripts/mesh_orientation.py.
"""
import math
import os

from yade import O
from yade.ddem import plots, provenance, vtk
from yade.ddem.studies import commandline
from yade.ddem.studies.structures import confined, confined_figures


@commandline.steps_told()
def main():
	options = read_options()
	tests = {"rough": [], "smooth": []}
	print(
		f"{'lateral pressure':>16}{'ends':>8}{'strength':>10}{'at strain':>11}{'point':>10}{'left':>10}"
		f"{'damage':>8}{'energy error':>14}"
	)
	print(f"{'[MPa]':>16}{'':>8}{'[MPa]':>10}{'[%]':>11}{'[MPa]':>10}{'[MPa]':>10}{'[-]':>8}{'[-]':>14}")
	for pressure in options.pressures:
		_, point, _ = confined.material_point(pressure, 2 * options.velocity / confined.HEIGHT)
		for ends, seed in (("rough", options.seed), ("smooth", None)):
			O.reset()
			name = os.path.join(options.out, f"pressure-{pressure / 1e6:g}")
			recorders = [lambda block: vtk.Recorder(block, name)] if options.vtk and ends == "rough" else []
			one = confined.run(
				pressure, ends, seed, options.size, options.mesh, options.velocity, options.strain,
				recorders=recorders
			)
			tests[ends].append(one)
			one.series.write(f"{name}-{ends}.csv")
			print(
				(
					f"{pressure / 1e6:>16g}{ends:>8}{one.peak[0] / 1e6:>10.1f}"
					f"{100 * one.peak[1]:>11.2f}{point.max() / 1e6:>10.1f}"
					f"{one.stress[-1] / 1e6:>10.1f}{one.damage.mean():>8.2f}"
					f"{one.energy_error:>14.0e}"
				),
				flush=True,
			)
	plots.save(
		confined_figures.strength(tests["rough"], tests["smooth"]), os.path.join(options.out, "confined.png")
	)
	print(f"\nPictures and files: {options.out}")


def read_options():
	"""Options from the command line; complains about them before anything runs."""
	parser = commandline.script_parser("confined_block", "Crush a block under lateral pressure.")
	parser.add_argument(
		"--pressures", type=float, nargs="+", default=(0.0, 20e6, 40e6, 60e6), metavar="PA",
		help="on the sides [Pa]; four of them are drawn"
	)
	parser.add_argument("--velocity", type=float, default=0.5, metavar="M/S", help="of each platen [m/s]")
	parser.add_argument("--strain", type=float, default=0.01, metavar="E", help="at which a test ends [-]")
	parser.add_argument(
		"--seed", type=int, default=1, metavar="N",
		help="draws the fracture energies of the blocks with rough ends"
	)
	parser.add_argument("--size", type=float, default=0.01, metavar="M", help="of the cells [m]")
	parser.add_argument(
		"--mesh",
		choices=("crossed", "alternating", "unstructured"),
		default="crossed",
		help="pattern of the mesh",
	)
	commandline.add_files(parser, "confined_block", "ParaView files of the blocks with rough ends")
	options = parser.parse_args()
	provenance.begin(vars(options))
	for name, values, low, high in (
		("--pressures", options.pressures, 0, 1e9), ("--velocity", options.velocity, 1e-3, 100),
		("--strain", options.strain, 1e-4, 0.1),
		("--size", options.size, 1e-4, confined.WIDTH / 4), ("--seed", options.seed, 0, math.inf)
	):
		commandline.require_between(parser, name, values, low, high)
	commandline.require_writable(parser, "--out", options.out)
	return options


if __name__ == "__main__":
	main()
