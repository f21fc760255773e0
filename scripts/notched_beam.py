# GPL v2 or later, see LICENSE.
"""Bend a notched beam until a crack has grown from its notch, on several meshes,
with and without the crack-band correction.

Run:      scripts/ddem run scripts/notched_beam.py                          (two minutes)
          scripts/ddem run scripts/notched_beam.py --sizes 0.01 --bands no  (quarter of a minute, one beam)
          scripts/ddem run scripts/notched_beam.py --help                   (all options)
Writes:   a table here, and in out/notched_beam: bending.png (with both kinds of beams), a CSV of each beam, and
          beam.pvd of the last one for ParaView.

                  v             A beam 44 cm long and 10 cm high on a span of 40 cm, with a notch of 3 cm, in plane
       ===================      strain, pushed down at a speed that grows to 0.05 m/s in 4 ms. The mesh is irregular,
       |                 |      fine in the middle. Concrete is that of Table 2 with a twentieth of its fracture energy,
       ========| |========      4 kJ/m³, which is to hold for triangles 7 mm wide. (With Table 2's 80 kJ/m³ a beam of
         ^             ^        this size yields rather than breaks.) Around supports and load it is elastic, so that it
                                does not crush there. The table has the largest difference of load and reactions over
                                the largest load ("imbalance"), and the kinetic energy over the work from
                                half the largest load on.

Expect:   a stiffness within 0.1 % of FreeFem++'s; 81 to 83 kN/m, which is 1.4 times what elastic bending of the
          section above the notch gives with the law's tensile strength of 7 MPa, and half of linear elastic fracture
          mechanics; then a crack of 1.5 to 3 cm, and a beam that goes on yielding around it, where the law flows.
          From 10 mm to 5 mm flow and damage take 19 % less where energy is per volume, and 8 % less with the crack band
          (14.5 and 13.4 J/m); the strength falls by 2 % in both. G_f times the band's width times the section would be
          2 J/m: an open band of this law goes on taking energy, 5 times G_f h until 0.1 mm, and most flow is beside the
          crack. Speed matters: 103 kN/m at 0.2 m/s, where load and reactions differ by a fifth; 61 and 54 at 0.02 and
          0.01 m/s (10 mm), where the crack opens in one sub-element of the triangle above the notch and stays there.
"""
import math
import os

from yade import O
from yade.ddem import plots, provenance, vtk
from yade.ddem.studies import commandline
from yade.ddem.studies.structures import beam, beam_figures


@commandline.steps_told()
def main():
	options = read_options()
	beams = {}
	print(
		f"{'crack band':<12}{'size':>6}{'triangles':>11}{'largest load':>15}{'at':>7}{'work':>8}{'taken':>8}"
		f"{'imbalance':>11}{'kinetic':>9}{'book':>8}"
	)
	print(
		f"{'':<12}{'[mm]':>6}{'':>11}{'[kN/m]':>15}{'[mm]':>7}{'[J/m]':>8}{'[J/m]':>8}{'[%]':>11}{'[%]':>9}"
		f"{'[-]':>8}"
	)
	last = options.bands[-1], options.sizes[-1]
	for corrected in options.bands:
		for size in options.sizes:
			O.reset()
			recorders = (
				[lambda block: vtk.Recorder(block, os.path.join(options.out, "beam"))]
				if options.vtk and (corrected, size) == last
				else []
			)
			one = beam.run(
				size, options.velocity, deflection=options.deflection, energy=options.energy,
				crack_band=beam.BAND if corrected else None, seed=options.seed,
				recorders=recorders
			)
			beams[corrected, size] = one
			one.series.write(
				os.path.join(
					options.out, f"size-{1e3 * size:g}-{'band' if corrected else 'volume'}.csv"
				)
			)
			top = one.force.argmax()
			print(
				(
					f"{'yes' if corrected else 'no':<12}{1e3 * size:>6g}"
					f"{len(one.mesh.triangles):>11}{one.force[top] / 1e3:>15.1f}"
					f"{1e3 * one.deflection[top]:>7.2f}{one.work[-1]:>8.1f}"
					f"{one.dissipated[-1]:>8.1f}{100 * one.imbalance:>11.1f}"
					f"{100 * one.kinetic_share:>9.1f}{one.energy_error:>8.0e}"
				),
				flush=True,
			)
	if len(options.bands) == 2:
		plots.save(
			beam_figures.bending(beams, (False, options.sizes[-1])),
			os.path.join(options.out, "bending.png"),
		)
	print(f"\nPictures and files: {options.out}")


def read_options():
	"""Options from the command line; complains about them before anything runs."""
	parser = commandline.script_parser("notched_beam", "Bend a notched beam until it breaks.")
	parser.add_argument(
		"--sizes", type=float, nargs="+", default=(0.01, 0.005), metavar="M",
		help="of the mesh in the middle [m]"
	)
	parser.add_argument(
		"--energy", type=float, default=beam.ENERGY, metavar="J/M3",
		help="fracture energy per volume [J/m³]; Table 2 has 80e3"
	)
	parser.add_argument(
		"--velocity", type=float, default=0.05, metavar="M/S", help="of the load, downwards, after 4 ms [m/s]"
	)
	parser.add_argument("--deflection", type=float, default=3e-4, metavar="M", help="at which a test ends [m]")
	parser.add_argument("--seed", type=int, default=None, metavar="N", help="draws another mesh")
	parser.add_argument(
		"--bands",
		choices=("both", "no", "yes"),
		default="both",
		help="with the crack-band correction or without; the picture shows both",
	)
	commandline.add_files(parser, "notched_beam", "ParaView files of the last beam")
	options = parser.parse_args()
	provenance.begin(vars(options))
	options.bands = {"both": (False, True), "no": (False,), "yes": (True,)}[options.bands]
	for name, values, low, high in (
		("--sizes", options.sizes, 5e-4, beam.NOTCH), ("--energy", options.energy, 1, math.inf),
		("--velocity", options.velocity, 1e-3, 10),
		("--deflection", options.deflection, 1e-6, 0.01), ("--seed", options.seed or 0, 0, math.inf)
	):
		commandline.require_between(parser, name, values, low, high)
	commandline.require_writable(parser, "--out", options.out)
	return options


if __name__ == "__main__":
	main()
