# GPL v2 or later, see LICENSE.
# needs: freefem++
"""Push an elastic block on its side and follow the waves: Zubelewicz (2018), section 4.2 and Figure 5.

Run:      scripts/ddem run scripts/elastic_impulse.py                 (ten seconds;
                                                                      installs Debian's freefem++ the first time)
          scripts/ddem run scripts/elastic_impulse.py --no-reference  (a second,
                                                                      without the finite elements to compare with)
          scripts/ddem run scripts/elastic_impulse.py --help          (all options)
Writes:   a table here, and in out/elastic_impulse: displacement.png and contours.png as Figure 5, centre.csv,
          and block.pvd for ParaView.

          p(t) |___________    A block 10 cm wide and 40 cm tall, of 1600 triangles, plane strain, with the moduli of
         ---->|     |      |   concrete (Table 1, no equation of state) and rotating cores (β_φ = 2). A pressure acts on
         ---->|     o      |   the left side for 40 µs, all other sides are free. The report does not print the impulse;
         ---->|_____|______|   here it is 10 MPa sin²(π t/40 µs) on the whole side; --shape, --pressure,
                               --duration and --patch change it.
                               The finite elements are FreeFem++'s quadratic triangles with consistent mass, integrated
                               by Newmark's method: nothing of the plugin.

Expect:   the centre moves off at the 0.83 m/s of a rigid block and trembles by 1.6 µm as waves run to and fro.
          Both solutions agree within 0.6 % of that until 50 µs and 7 % at 200 µs, where waves have crossed the block
          ten times (--size 0.005: 2 %). From the free ends come vertical displacements, at 20 µs in 2 separate regions
          of one sign, one at each end, at 100 µs in 10: the report's "increasingly complex patterns".
          β_φ is hardly felt.
"""
import argparse
import os
import sys
import time

import numpy as np

from yade.ddem import plots, provenance, vtk
from yade.ddem.series import Series
from yade.ddem.studies import commandline
from yade.ddem.studies.structures import impulse, impulse_figures


@commandline.steps_told()
def main():
	options = read_options()
	recorders = [lambda block: vtk.Recorder(block, os.path.join(options.out, "block"))] if options.vtk else []
	start = time.perf_counter()
	history = impulse.run(
		options.size, options.impulse, options.rotation, options.until, options.instants, recorders=recorders
	)
	wall = time.perf_counter() - start
	reference = find_reference(history) if options.reference else None

	series = Series(time="s", pressure="Pa", ux="m", uy="m")
	for now, (ux, uy) in zip(history.times, history.centre):
		series.append(time=now, pressure=history.impulse.at(now), ux=ux, uy=uy)
	series.write(os.path.join(options.out, "centre.csv"))
	plots.save(impulse_figures.displacement(history, reference), os.path.join(options.out, "displacement.png"))
	plots.save(impulse_figures.contours(history, reference), os.path.join(options.out, "contours.png"))
	print_table(history, reference, wall)
	print(f"\nPictures and files: {options.out}")


def find_reference(history):
	from yade.ddem.verification import impulse_reference
	try:
		return impulse_reference.quadratic(history)
	except (RuntimeError, ValueError) as error:
		sys.exit(f"elastic_impulse.py: {error}\nOr leave the comparison out: --no-reference")


def print_table(history, reference, wall):
	deformation = history.centre[:, 0] - history.impulse.rigid(history.times)
	rows = [
		("triangles", f"{len(history.mesh.triangles)}"),
		(
			"steps",
			f"{len(history.times) - 1} of {1e6 * history.dt:.3g} µs, {wall:.1f} s with set-up and records",
		),
		(
			"displacement of the centre",
			f"{1e6 * history.centre[-1, 0]:.2f} µm at {1e6 * history.times[-1]:.0f} µs",
		),
		("without that of a rigid block", f"up to {1e6 * np.abs(deformation).max():.3f} µm"),
		(
			"regions of one sign in u_y",
			", ".join(f"{impulse.regions(history.mesh, field[:, 1])}" for field in history.fields)
			+ " at the instants",
		),
		("error of the energy book", f"{history.energy_error:.1e}"),
	]
	if reference is not None:
		error = (
			np.abs(np.interp(reference.times, history.times, history.centre[:, 0]) - reference.centre[:, 0])
			/ np.abs(deformation).max()
		)
		early = reference.times <= 50e-6
		rows.append(
			(
				"difference to finite elements",
				(
					f"{100 * error[early].max():.2f} % of that until 50 µs, "
					f"{100 * error.max():.1f} % until the end"
				),
			)
		)
	for name, value in rows:
		print(f"{name:<32}{value}")


def read_options():
	"""Options from the command line; complains about them before anything runs."""
	parser = argparse.ArgumentParser(
		prog="scripts/ddem run scripts/elastic_impulse.py", usage="%(prog)s [options]",
		description="Push an elastic block on its side and follow the waves.",
		formatter_class=argparse.ArgumentDefaultsHelpFormatter, allow_abbrev=False
	)
	push = parser.add_argument_group("impulse")
	push.add_argument("--shape", choices=impulse.SHAPES, default="sine-squared", help="pressure over time")
	push.add_argument("--pressure", type=float, default=10e6, metavar="PA", help="largest pressure [Pa]")
	push.add_argument("--duration", type=float, default=40e-6, metavar="S", help="duration [s]")
	push.add_argument(
		"--patch", type=float, default=impulse.HEIGHT, metavar="M",
		help="height of the loaded part, in the middle of the side [m]"
	)
	block = parser.add_argument_group("block")
	block.add_argument(
		"--size", type=float, default=0.01, metavar="M",
		help="size of the crossed cells [m]; 0.01 gives the report's 1600 triangles"
	)
	block.add_argument(
		"--rotation",
		choices=("cosserat", "corotational", "none"),
		default="cosserat",
		help="how triangles follow rotation",
	)
	run = parser.add_argument_group("run")
	run.add_argument("--until", type=float, default=200e-6, metavar="S", help="end [s]")
	run.add_argument(
		"--instants", type=float, nargs="+", default=impulse.INSTANTS, metavar="S",
		help="times of the contours [s]"
	)
	run.add_argument(
		"--reference",
		action=argparse.BooleanOptionalAction,
		default=True,
		help="finite elements to compare with, by FreeFem++",
	)
	run.add_argument("--vtk", action=argparse.BooleanOptionalAction, default=True, help="ParaView files")
	run.add_argument(
		"--out",
		default=os.path.join("out", "elastic_impulse"),
		metavar="DIR",
		help="folder for all files, made when missing",
	)
	options = parser.parse_args()
	provenance.begin(vars(options))
	try:
		options.impulse = impulse.Impulse(options.shape, options.pressure, options.duration, options.patch)
	except ValueError as error:
		parser.error(str(error))
	if not 5e-4 <= options.size <= impulse.WIDTH / 2:
		parser.error(
			f"argument --size: {options.size:g} m must lie between 0.0005 m (640 000 triangles) and half "
			f"the width of {impulse.WIDTH:g} m"
		)
	if not options.until > 0 or not all(0 < instant <= options.until for instant in options.instants):
		parser.error(f"argument --instants: all must lie between 0 and --until, {options.until:g} s")
	commandline.require_writable(parser, "--out", options.out)
	return options


if __name__ == "__main__":
	main()
