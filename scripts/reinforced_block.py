# GPL v2 or later, see LICENSE.
"""Crush a concrete block with a steel bar at 10 m/s: Zubelewicz (2018), section 4.3 and Figures 6 to 8.

Run:      scripts/ddem run scripts/reinforced_block.py                 (three realisations; half a minute)
          scripts/ddem run scripts/reinforced_block.py --study mesh    (other meshes, with and without crack band; half a minute)
          scripts/ddem run scripts/reinforced_block.py --study bar     (with the bar and without; twenty seconds)
          scripts/ddem run scripts/reinforced_block.py --help          (all options)
Writes:   a table here, and in out/reinforced_block: mesh.png (Figure 6), history.png (7), shape.png (deformation, rotations), realisations.png (8), a CSV of each
          seed, seed-1.pvd for ParaView; the studies write refinement.png and shielding.png instead.

        v v v v v      Plane strain, 10 cm wide and 20 cm tall, 800 triangles with three integration points each; Tables 1 and 2 untouched. The top moves down
       |=========|     at 10 m/s from the first step on, the bottom stands, both are held laterally. In the middle is a bar of 304L steel, 8 triangles that
       |         |     make a square of 1.4 cm on its corner. The fracture energy of each triangle is drawn from a normal distribution with a standard
       |   <#>   |     deviation of 0.8 G_f, not below 0.2 G_f.
       |         |     Stress is the force on the top over its width. The time step is 0.4 of the critical one, since elements stretch to several times their
       |=========|     size while they turn: at 0.8 the run ends with an error between 1.6 and 2.3 ms, long after the last load.

Expect:   the wave of 125 MPa, ringing for the first microseconds, as the platen hits at full speed; it falls as the free sides unload, and rises again at 75 µs when
          the wave is back from the bottom. Nothing is left to bear after 0.14 ms. Damage comes from the upper corners down, then from the lower ones up, wedges at
          both ends stay whole. The realisations have the same trend and differ in detail. Rotations at the corners reach 0.5 rad at 0.6 ms and π/3 at 2.5 ms.
          Mesh: energy per volume makes finer meshes weaker, 5.8 instead of 6.9 kJ/m with half the size. With the crack band the stress is nearly the same on
          all meshes until 0.13 ms, but the energy overcorrected, 7.9 kJ/m, because the flow is not all in bands.
          Bar: it draws stress upon itself, with more damage above, below and at its sides (0.35 instead of 0.18 at 70 µs), and shields what lies diagonally
          below (0.17 instead of 0.20).
"""
import argparse
import os

import numpy as np

from yade import O
from yade.ddem import commandline, plots, vtk
from yade.ddem.structures import reinforced, reinforced_figures

INSTANTS = (20e-6, 60e-6, 100e-6, 200e-6, 600e-6)  # of the damage maps [s]


def main():
	options = read_options()
	{"none": realisations, "mesh": refinement, "bar": shielding}[options.study](options)
	print(f"\nPictures and files: {options.out}")


def realisations(options):
	"""The report's case, once for each seed."""
	crushed, last = {}, min(INSTANTS[-1], options.until)
	for seed in options.seeds:
		O.reset()
		leader = seed == options.seeds[0]
		recorders = [lambda block: vtk.Recorder(block, os.path.join(options.out, f"seed-{seed}"))] if options.vtk and leader else []
		crushed[seed] = crush(options, seed=seed, until=options.until if leader else last, recorders=recorders)
		crushed[seed].run.series.write(os.path.join(options.out, f"seed-{seed}.csv"))
	first = crushed[options.seeds[0]]
	plots.mesh(first.mesh, file=os.path.join(options.out, "mesh.png"))
	save(reinforced_figures.history(first, [instant for instant in INSTANTS if instant <= options.until]), options, "history.png")
	save(reinforced_figures.shape(first, options.until), options, "shape.png")
	save(reinforced_figures.realisations(crushed, last), options, "realisations.png")
	table([("seed", *crushed)] + [
		(name, *(text(one) for one in crushed.values())) for name, text in (
			("largest stress, mean over 5 µs [MPa]", lambda one: f"{one.smooth.max() / 1e6:.0f}"),
			("mean stress until 20 µs [MPa]", lambda one: f"{one.stress[one.times <= 20e-6].mean() / 1e6:.0f}"),
			("stress after 0.2 ms, up to [MPa]", lambda one: f"{np.abs(one.stress[one.times > 2e-4]).max() / 1e6:.1f}" if last > 2e-4 else "-"),
			(f"at {1e6 * last:.0f} µs: mean damage", lambda one: f"{np.interp(last, one.times, one.run.series['damage']):.2f}"),
			("   energy taken [kJ/m]", lambda one: f"{np.interp(last, one.times, one.dissipated) / 1e3:.2f}"),
			("   largest rotation [rad]", lambda one: f"{np.abs(one.snapshot(last)[0].rotation).max():.2f}"),
			("end [ms]", lambda one: f"{1e3 * one.times[-1]:.1f}"),
			("   largest rotation [rad]", lambda one: f"{np.abs(one.run.snapshots[-1].rotation).max():.2f}"),
			("error of the energy book", lambda one: f"{one.run.energy_error:.0e}"),
			("wall time [s]", lambda one: f"{one.run.wall:.0f}"),
		)
	])


def refinement(options):
	"""The same block on finer meshes, all fracture energies equal, with and without the crack band."""
	crushed = {}
	for corrected in (False, True):
		for size in options.sizes:
			O.reset()
			crushed[corrected, size] = crush(options, size=size, seed=None, until=3e-4, crack_band=reinforced.BAND if corrected else None)
	save(reinforced_figures.refinement(crushed), options, "refinement.png")
	table([("crack band", "size [mm]", "triangles", "stress at 60 and 100 µs [MPa]", "energy [kJ/m]", "mean damage")] + [
		(
			"yes" if corrected else "no", f"{1e3 * size:g}", f"{len(one.mesh.triangles)}",
			", ".join(f"{value / 1e6:.0f}" for value in np.interp((6e-5, 1e-4), one.times, one.stress)), f"{one.dissipated[-1] / 1e3:.2f}",
			f"{one.run.series.last('damage'):.2f}"
		) for (corrected, size), one in crushed.items()
	])


def shielding(options):
	"""The same block with the bar and without it, on a finer mesh, all fracture energies equal."""
	crushed = {}
	for bar in (True, False):
		O.reset()
		crushed[bar] = crush(options, size=0.005, seed=None, bar=bar, until=1e-4, recorders=[reinforced.Fields])
	x, y = (crushed[True].mesh.centroids - (reinforced.WIDTH / 2, reinforced.HEIGHT / 2)).T
	zones = {
		"above and below": np.flatnonzero((abs(x) < 0.007) & (abs(y) > 0.01) & (abs(y) < 0.03)),
		"at the sides": np.flatnonzero((abs(y) < 0.007) & (abs(x) > 0.01) & (abs(x) < 0.03)),
		"diagonally below": np.flatnonzero((abs(x) > 0.005) & (abs(x) < 0.025) & (y < -0.01) & (y > -0.04)),
	}
	fields = {bar: one.recorders[0] for bar, one in crushed.items()}
	save(reinforced_figures.shielding(crushed, fields, 24e-6, 70e-6, zones), options, "shielding.png")
	rows = [("mean damage with and without the bar", "50 µs", "70 µs", "100 µs")]
	for name, zone in zones.items():
		pairs = ([f"{crushed[bar].snapshot(instant)[0].damage[zone].mean():.2f}" for bar in (True, False)] for instant in (50e-6, 70e-6, 100e-6))
		rows.append((name, *(", ".join(pair) for pair in pairs)))
	table(rows)


def crush(options, **settings):
	return reinforced.run(velocity=options.velocity, rotation=options.rotation, step=options.step, progress=True, **settings)


def save(figure, options, name):
	plots.save(figure, os.path.join(options.out, name))


def table(rows):
	widths = [max(len(str(row[column])) for row in rows) for column in range(len(rows[0]))]
	print()
	for row in rows:
		print("  ".join(f"{str(cell):<{width}}" for cell, width in zip(row, widths)).rstrip())


def read_options():
	"""Options from the command line; complains about them before anything runs."""
	parser = argparse.ArgumentParser(
		prog="scripts/ddem run scripts/reinforced_block.py", usage="%(prog)s [options]", description="Crush a concrete block with a steel bar at 10 m/s.",
		formatter_class=argparse.ArgumentDefaultsHelpFormatter, allow_abbrev=False
	)
	parser.add_argument("--study", choices=("none", "mesh", "bar"), default="none", help="none: the report's case; mesh: refinement with and without the crack-band "
		"correction; bar: what the steel shields")
	parser.add_argument("--seeds", type=int, nargs="+", default=(1, 2, 3), metavar="N", help="realisations of the fracture energies")
	parser.add_argument("--sizes", type=float, nargs="+", default=(0.02, 0.01, 0.005), metavar="M", help="cells of the mesh study [m]")
	parser.add_argument("--until", type=float, default=2.5e-3, metavar="S", help="end of the first realisation [s]; the others end at 0.6 ms at the latest")
	parser.add_argument("--velocity", type=float, default=reinforced.VELOCITY, metavar="M/S", help="of the top, downwards [m/s]")
	parser.add_argument("--rotation", choices=("cosserat", "corotational", "none"), default="cosserat", help="how triangles follow rotation")
	parser.add_argument("--step", type=float, default=0.4, metavar="PART", help="time step, as a part of the critical one")
	parser.add_argument("--vtk", action=argparse.BooleanOptionalAction, default=True, help="ParaView files of the first seed")
	parser.add_argument("--out", default=os.path.join("out", "reinforced_block"), metavar="DIR", help="folder for all files, made when missing")
	options = parser.parse_args()
	for name, values, low, high in (
		("--seeds", options.seeds, 0, np.inf), ("--sizes", options.sizes, 1e-4, reinforced.WIDTH / 4), ("--until", [options.until], 1e-5, np.inf),
		("--velocity", [options.velocity], 1e-3, np.inf), ("--step", [options.step], 1e-3, 1)
	):
		for value in values:
			if not low <= value <= high:
				parser.error(f"argument {name}: {value:g} must lie between {low:g} and {high:g}")
	commandline.require_writable(parser, "--out", options.out)
	return options


if __name__ == "__main__":
	main()
