# GPL v2 or later, see LICENSE.
"""Bend a notched beam until a crack has grown from the notch to the load, on several meshes, with and without the crack-band correction.

Run:      scripts/ddem run scripts/notched_beam.py                     (a minute)
          scripts/ddem run scripts/notched_beam.py --sizes 0.01        (ten seconds)
          scripts/ddem run scripts/notched_beam.py --help              (all options)
Writes:   a table here, and in out/notched_beam: bending.png, a CSV of each beam, and beam.pvd of the last one for ParaView.

                  v             A beam 44 cm long and 10 cm high on a span of 40 cm, with a notch of 3 cm, in plane strain, pushed down at 0.2 m/s. The mesh is
       ===================      irregular, fine in the middle. Concrete is that of Table 2 with a twentieth of its fracture energy, 4 kJ/m³, which is to hold for
       |                 |      triangles 7 mm wide. (With Table 2's 80 kJ/m³ a beam of this size yields rather than breaks.) Around supports and load it is
       ========| |========      elastic, so that it does not crush there.
         ^             ^

Expect:   a crack that runs up from the notch and stops below the load, where the beam is compressed. From 10 mm to 5 mm the work of the load until 0.4 mm falls by
          11 % where energy is per volume, and grows by 23 % with the crack band: most of it is taken beside the crack, where concrete flows without breaking, and
          the correction makes that flow stronger, too.
"""
import argparse
import os

import numpy as np

from yade import O
from yade.ddem import commandline, plots, vtk
from yade.ddem.series import Series
from yade.ddem.structures import beam, beam_figures


def main():
	options = read_options()
	beams = {}
	print(f"{'crack band':<12}{'size [mm]':>10}{'triangles':>11}{'largest force [kN/m]':>22}{'at [mm]':>9}{'work [J/m]':>12}{'taken [J/m]':>13}{'energy error':>14}")
	last = options.bands[-1], options.sizes[-1]
	for corrected in options.bands:
		for size in options.sizes:
			O.reset()
			recorders = [lambda block: vtk.Recorder(block, os.path.join(options.out, "beam"))] if options.vtk and (corrected, size) == last else []
			one = beam.run(
				size, options.velocity, deflection=options.deflection, energy=options.energy, crack_band=beam.BAND if corrected else None, seed=options.seed,
				recorders=recorders
			)
			beams[corrected, size] = one
			write(one, os.path.join(options.out, f"size-{1e3 * size:g}-{'band' if corrected else 'volume'}.csv"))
			top = one.force.argmax()
			print(
				f"{'yes' if corrected else 'no':<12}{1e3 * size:>10g}{len(one.mesh.triangles):>11}{one.force[top] / 1e3:>22.1f}{1e3 * one.deflection[top]:>9.2f}"
				f"{one.work[-1]:>12.1f}{one.dissipated[-1]:>13.1f}{one.energy_error:>14.0e}", flush=True
			)
	if len(options.bands) == 2:
		plots.save(beam_figures.bending(beams, (False, options.sizes[-1])), os.path.join(options.out, "bending.png"))
	print(f"\nPictures and files: {options.out}")


def write(one, path):
	series = Series(deflection="m", force="N/m", opening="m", dissipated="J/m")
	for row in zip(*(getattr(one, name) for name in series.units)):
		series.append(**dict(zip(series.units, row)))
	series.write(path)


def read_options():
	"""Options from the command line; complains about them before anything runs."""
	parser = argparse.ArgumentParser(
		prog="scripts/ddem run scripts/notched_beam.py", usage="%(prog)s [options]", description="Bend a notched beam until it breaks.",
		formatter_class=argparse.ArgumentDefaultsHelpFormatter, allow_abbrev=False
	)
	parser.add_argument("--sizes", type=float, nargs="+", default=(0.01, 0.005), metavar="M", help="of the mesh in the middle [m]")
	parser.add_argument("--energy", type=float, default=beam.ENERGY, metavar="J/M3", help="fracture energy per volume [J/m³]; Table 2 has 80e3")
	parser.add_argument("--velocity", type=float, default=0.2, metavar="M/S", help="of the load, downwards [m/s]")
	parser.add_argument("--deflection", type=float, default=4e-4, metavar="M", help="at which a test ends [m]")
	parser.add_argument("--seed", type=int, default=None, metavar="N", help="draws another mesh")
	parser.add_argument("--bands", choices=("both", "no", "yes"), default="both", help="with the crack-band correction or without; the picture shows both")
	parser.add_argument("--vtk", action=argparse.BooleanOptionalAction, default=True, help="ParaView files of the last beam")
	parser.add_argument("--out", default=os.path.join("out", "notched_beam"), metavar="DIR", help="folder for all files, made when missing")
	options = parser.parse_args()
	options.bands = {"both": (False, True), "no": (False,), "yes": (True,)}[options.bands]
	for name, values, low, high in (
		("--sizes", options.sizes, 5e-4, beam.NOTCH), ("--energy", [options.energy], 1, np.inf), ("--velocity", [options.velocity], 1e-3, 10),
		("--deflection", [options.deflection], 1e-6, 0.01), ("--seed", [options.seed or 0], 0, np.inf)
	):
		for value in values:
			if not low <= value <= high:
				parser.error(f"argument {name}: {value:g} must lie between {low:g} and {high:g}")
	commandline.require_writable(parser, "--out", options.out)
	return options


if __name__ == "__main__":
	main()
