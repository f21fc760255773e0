# GPL v2 or later, see LICENSE.
"""Crush a concrete block with a steel bar at 10 m/s: Zubelewicz (2018), section 4.3 and Figures 6 to 8.

Run:      scripts/ddem run scripts/reinforced_block.py               (three realisations; half a minute)
          scripts/ddem run scripts/reinforced_block.py --study mesh  (other meshes, with and without crack band;
                                                                     half a minute)
          scripts/ddem run scripts/reinforced_block.py --study bar   (with the bar and without; twenty seconds)
          scripts/ddem run scripts/reinforced_block.py --help        (all options)
Writes:   a table here, and what the report says beside what is measured; in out/reinforced_block: mesh.png (Figure 6),
          history.png (7), shape.png (deformation, rotations), realisations.png (8), a CSV of each seed, seed-1.pvd for
          ParaView; the studies write refinement.png and shielding.png instead.

        v v v v v      Plane strain, 10 cm wide and 20 cm tall, 800 triangles with three integration points each;
       |=========|     Tables 1 and 2 untouched. The top moves down at 10 m/s from the first step on, the bottom stands,
       |         |     both are held laterally. In the middle is a bar of 304L steel, 8 triangles that make a square of
       |   <#>   |     1.4 cm on its corner. The fracture energy of each triangle is drawn from a normal distribution
       |         |     with a standard deviation of 0.8 G_f, not below 0.2 G_f.
       |=========|     Stress is the force on the top over its width. Damage is that of an open crack, η/η_max = η_0.
                       The time step is 0.8 of the critical one and follows it down, by half at 2.5 ms, as triangles
                       stretch to several times their size while they turn (DeformableTimeStepper).

Expect:   the wave of 125 MPa, ringing for the first microseconds, as the platen hits at full speed; it falls as the
          free sides unload, and rises again to 134 to 140 MPa at 75 µs when the wave is back from the bottom. Less than
          2 % is left after 0.14 ms. Damage begins in the upper corners (10 µs) and runs down the sides; 40 % of the
          concrete ends with a damage above 0.9, 20 % with one below 0.1, mostly the wedges at both ends. Their sharp
          45° are diagonals of the mesh: with --pattern unstructured the wedges are there, with ragged borders and
          a mean damage of 0.06 to 0.12 instead of 0.04. The realisations differ by 10 MPa at most, and by 0.12 in the
          damage of a triangle. Rotations at the corners reach 0.5 rad at 0.6 ms and π/3 at 2.2 ms.
          Otherwise than the report has it, the lower half is as damaged as the upper one from 70 µs on,
          and its corners turn as far.
          Mesh: energy per volume makes finer meshes weaker, 5.8 instead of 6.9 kJ/m with half the size, as size^0.22.
          With the crack band the energy is 7.2 instead of 6.9 kJ/m, as size^-0.09, though the flow is not all in bands:
          see yade.ddem.crackband.
          Bar: the wave that passes is 4 % smaller diagonally below, and 13 % larger above, where it is reflected;
          right below it is 4 % larger. Damage at 70 µs is smaller diagonally below (0.16 instead of 0.20) and larger
          above, below and at the sides (0.35 instead of 0.19): a shield in that direction only,
          and 0.01 more damage in all.
"""
import argparse
import os
import textwrap

import numpy as np

from yade import O
from yade.ddem import plots, provenance, vtk
from yade.ddem.studies import commandline
from yade.ddem.studies.structures import reinforced, reinforced_figures, reinforced_statements

@commandline.steps_told()
def main():
	options = read_options()
	{"none": realisations, "mesh": refinement, "bar": shielding}[options.study](options)
	print(f"\nPictures and files: {options.out}")


def realisations(options):
	"""The report's case, once for each seed."""
	crushed, last = {}, min(reinforced.FINAL, options.until)
	for seed in options.seeds:
		O.reset()
		leader = seed == options.seeds[0]
		recorders = (
			[lambda block: vtk.Recorder(block, os.path.join(options.out, f"seed-{seed}"))]
			if options.vtk and leader
			else []
		)
		crushed[seed] = crush(options, seed=seed, until=options.until if leader else last, recorders=recorders)
		crushed[seed].run.series.write(os.path.join(options.out, f"seed-{seed}.csv"))
	first = crushed[options.seeds[0]]
	plots.mesh(first.mesh, file=os.path.join(options.out, "mesh.png"))
	save(
		reinforced_figures.history(
			first, [instant for instant in reinforced.INSTANTS if instant <= options.until]
		),
		options,
		"history.png",
	)
	save(reinforced_figures.shape(first, options.until), options, "shape.png")
	save(reinforced_figures.realisations(crushed, last), options, "realisations.png")
	table([("seed", *crushed)] + [
		(name, *(text(one) for one in crushed.values())) for name, text in (
			(
				"mean stress until 20 µs [MPa]",
				lambda one: f"{one.stress[one.times <= 20e-6].mean() / 1e6:.0f}",
			),
			(
				"largest stress after 50 µs, mean over 5 µs [MPa]",
				lambda one: f"{one.smooth[one.times > 5e-5].max() / 1e6:.0f}" if last > 5e-5 else "-",
			),
			(
				"stress after 0.2 ms, up to [MPa]",
				lambda one: (
					f"{np.abs(one.stress[one.times > 2e-4]).max() / 1e6:.1f}"
					if last > 2e-4
					else "-"
				),
			),
			(f"at {1e6 * last:.0f} µs: mean damage", lambda one: f"{one.mean_damage(last):.2f}"),
			(
				"   energy taken [kJ/m]",
				lambda one: f"{np.interp(last, one.times, one.dissipated) / 1e3:.2f}",
			),
			("end [ms]", lambda one: f"{1e3 * one.times[-1]:.1f}"),
			(
				"   largest rotation [rad]",
				lambda one: (
					f"{max(one.rotation(one.times[-1], upper)[0] for upper in (True, False)):.2f}"
				),
			),
			("   largest Mises stress in the bar so far [MPa]", lambda one: f"{one.bar_stress / 1e6:.0f}"),
			("   largest plastic strain in the bar", lambda one: f"{one.bar_plastic:.4f}"),
			("error of the energy book", lambda one: f"{one.run.energy_error:.0e}"),
			("wall time [s]", lambda one: f"{one.run.wall:.0f}"),
		)
	])
	if options.until >= reinforced.FINAL:
		O.reset()
		even = crush(options, seed=None, until=4.1e-5)
		print("\nWhat the report says of this case, and what is measured:")
		for said, found in reinforced_statements.statements(even, list(crushed.values())):
			print(
				textwrap.fill(f"“{said}”", 120),
				textwrap.fill(found, 120, initial_indent="    ", subsequent_indent="    "),
				sep="\n",
			)


def refinement(options):
	"""The same block on finer meshes, all fracture energies equal, with and without the crack band."""
	crushed = {}
	for corrected in (False, True):
		for size in options.sizes:
			O.reset()
			crushed[corrected, size] = crush(
				options, size=size, seed=None, until=3e-4,
				crack_band=reinforced.BAND if corrected else None
			)
	save(reinforced_figures.refinement(crushed), options, "refinement.png")
	table(
		[
			(
				"crack band", "size [mm]", "triangles", "stress at 60 and 100 µs [MPa]",
				"energy [kJ/m]", "mean damage", "share with damage > 0.9"
			)
		]
		+ [
			(
				"yes" if corrected else "no",
				f"{1e3 * size:g}",
				f"{len(one.mesh.triangles)}",
				", ".join(
					f"{value / 1e6:.0f}" for value in np.interp((6e-5, 1e-4), one.times, one.stress)
				),
				f"{one.dissipated[-1] / 1e3:.2f}",
				f"{one.mean_damage(3e-4):.2f}",
				f"{one.share(3e-4, 0.9, 1):.2f}",
			)
			for (corrected, size), one in crushed.items()
		]
	)
	if len(set(options.sizes)) > 1:
		logs = np.log(options.sizes)
		powers = [
			np.polyfit(
				logs, np.log([crushed[corrected, size].dissipated[-1] for size in options.sizes]), 1
			)[0]
			for corrected in (False, True)
		]
		print(
			f"\nEnergy goes as size^{powers[0]:.2f} per volume and size^{powers[1]:.2f} with the crack "
			"band; a crack in one row would take size^1 and size^0."
		)


def shielding(options):
	"""The same block with the bar and without it, on a finer mesh, all fracture energies equal."""
	crushed = reinforced_statements.with_and_without_bar(lambda **settings: crush(options, **settings), until=1e-4)
	measured = reinforced_statements.shielding(crushed)
	zones = reinforced_statements.zones(crushed[True].mesh)
	save(reinforced_figures.shielding(crushed, zones), options, "shielding.png")
	table(
		[
			(
				"with the bar and without it",
				"compression until 40 µs [MPa]",
				"damage at 70 µs",
				"damage at 100 µs",
			)
		]
		+ [
			(
				name,
				"{:.0f}, {:.0f}".format(*(value / 1e6 for value in stresses)),
				"{:.2f}, {:.2f}".format(*damages),
				", ".join(
					f"{crushed[bar].mean_damage(1e-4, zones[name]):.2f}" for bar in (True, False)
				),
			)
			for name, (stresses, damages) in measured.items()
		]
	)


def crush(options, **settings):
	return reinforced.run(
		pattern=options.pattern, velocity=options.velocity, rotation=options.rotation, step=options.step,
		steel=options.steel, progress=True, **settings
	)


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
		prog="scripts/ddem run scripts/reinforced_block.py", usage="%(prog)s [options]",
		description="Crush a concrete block with a steel bar at 10 m/s.",
		formatter_class=argparse.ArgumentDefaultsHelpFormatter, allow_abbrev=False
	)
	parser.add_argument(
		"--study",
		choices=("none", "mesh", "bar"),
		default="none",
		help="none: the report's case; mesh: refinement with and without the crack-band "
		"correction; bar: what the steel shields",
	)
	parser.add_argument(
		"--steel", choices=("elastic", "yielding"), default="elastic",
		help="the bar: elastic, as in the report, or yielding at 270 MPa, as 304L does"
	)
	parser.add_argument(
		"--seeds", type=int, nargs="+", default=(1, 2, 3), metavar="N",
		help="realisations of the fracture energies"
	)
	parser.add_argument(
		"--sizes", type=float, nargs="+", default=(0.02, 0.01, 0.005), metavar="M",
		help="cells of the mesh study [m]"
	)
	parser.add_argument(
		"--until", type=float, default=2.5e-3, metavar="S",
		help="end of the first realisation [s]; the others end at 0.6 ms at the latest"
	)
	parser.add_argument(
		"--velocity", type=float, default=reinforced.VELOCITY, metavar="M/S", help="of the top, downwards [m/s]"
	)
	parser.add_argument(
		"--pattern",
		choices=("crossed", "alternating", "unstructured"),
		default="crossed",
		help="of the mesh; crossed is the report's",
	)
	parser.add_argument(
		"--rotation",
		choices=("cosserat", "corotational", "none"),
		default="cosserat",
		help="how triangles follow rotation",
	)
	parser.add_argument(
		"--step", type=float, default=0.8, metavar="PART", help="time step, as a part of the critical one"
	)
	parser.add_argument(
		"--vtk", action=argparse.BooleanOptionalAction, default=True, help="ParaView files of the first seed"
	)
	parser.add_argument(
		"--out",
		default=os.path.join("out", "reinforced_block"),
		metavar="DIR",
		help="folder for all files, made when missing",
	)
	options = parser.parse_args()
	provenance.begin(vars(options))
	for name, values, low, high in (
		("--seeds", options.seeds, 0, np.inf), ("--sizes", options.sizes, 1e-4, reinforced.WIDTH / 4),
		("--until", [options.until], 1e-5, np.inf),
		("--velocity", [options.velocity], 1e-3, np.inf), ("--step", [options.step], 1e-3, 1)
	):
		for value in values:
			if not low <= value <= high:
				parser.error(f"argument {name}: {value:g} must lie between {low:g} and {high:g}")
	commandline.require_writable(parser, "--out", options.out)
	return options


if __name__ == "__main__":
	main()
