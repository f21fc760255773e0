# GPL v2 or later, see LICENSE.
"""The figures of the paper on bonded spheres: broken bonds, wall forces, stress over strain; three ranges of radii,
walls of two stiffnesses, three packings.

Run:      scripts/ddem run scripts/bonded_figures.py          (27 runs, five minutes on two cores;
                                                              after Ctrl-C the same command goes on)
          scripts/ddem run scripts/bonded_figures.py --quick  (large spheres only, two packings, long steps:
                                                              under a minute)
          scripts/ddem run scripts/bonded_figures.py --help   (all options)
Writes:   a table here, and into out/bonded_figures: bonded_figures.html, which holds everything; study.json, runs.csv
          (a line a run), curves_*.csv (medians and ranges over time), the pictures; and runs/, where every run has its
          summary, time series and list of broken bonds.

        18 runs, the paper's figures             radii 0.2-1.0, 0.4-2.0, 0.8-4.0 mm
                                                 x  walls of 100 and 102 GPa  x  3 packings
         6 runs, what rate and convention do     radii 0.4-2.0 mm, walls of 100 GPa
                                                 x  rock density, or consistent bonds  x  3 packings
         3 runs, what the packing does           samples of ESyS-Particle itself (tests/data/esys),
                                                 0.4-2.0 mm also with rock density

Each run is scripts/ucs_bonded.py with ESyS-Particle's convention and the tutorial's parameters, in a YADE of its own.
Between packings is chance, so lines are medians and bands the range.
A table sets the paper's statements beside what these runs give.

Expect:   strengths of 221, 220 and 165 MPa for small, middle and large spheres, moduli of 120, 116 and 85 GPa (medians,
          walls of 100 GPa); packings of large spheres differ by a factor of almost two. Walls that are 2 % stiffer
          change nothing beyond chance. The samples of ESyS-Particle give its own results, 149 and 97 MPa. Rock density
          lowers the strength by 14 % (16 % on the sample of ESyS-Particle, as there),
          consistent bonds lower it by 21 %.
"""
import argparse
import os
import shutil
import signal
import sys

from yade.ddem import provenance
from yade.ddem.reports import bonded_study
from yade.ddem.studies import commandline
from yade.ddem.studies.bonded_study import Group, Record
from yade.ddem.studies.campaign import Campaign, Case, Failed
from yade.ddem.studies.commandline import count, require_writable, share
from yade.ddem.studies.evaluations import Lost

SCRIPTS = os.path.dirname(os.path.abspath(sys.argv[0]))
# of ESyS-Particle, in a box of 10 x 20 x 10 mm
SAMPLES = os.path.join(os.path.dirname(SCRIPTS), "tests", "data", "esys")
BOX = ("-0.005", "0", "-0.005", "0.005", "0.02", "0.005")  # [m]
COARSE, MEDIUM, FINE = (0.8e-3, 4e-3), (0.4e-3, 2e-3), (0.2e-3, 1e-3)  # radii [m]
RANGES = {"fine": FINE, "medium": MEDIUM, "coarse": COARSE}
STIFFNESSES = (100e9, 102e9)  # of the walls [Pa]
STRAIN = 0.0028125  # reached after 0.25 ms: the tutorial's 250000 steps
INTERRUPTED = 130


def main():
	for number in (signal.SIGTERM, signal.SIGHUP):
		signal.signal(number, interrupt)
	options, parser = read_options()
	workers = commandline.workers(parser, options)
	groups = plan(options)
	if options.fresh:
		shutil.rmtree(os.path.join(options.out, "runs"), ignore_errors=True)
	cases = by_length(case for _, members in groups for case in members)
	print(f"{len(cases)} runs, {workers.told()}", flush=True)
	try:
		with workers:
			folders = Campaign(
				os.path.join(SCRIPTS, "ucs_bonded.py"), cases, os.path.join(options.out, "runs"),
				workers, tell
			).run()
	except KeyboardInterrupt:
		print("\nInterrupted; the same command goes on from what is finished.")
		sys.exit(INTERRUPTED)
	except Lost as error:
		sys.exit(f"bonded_figures.py: {error}; what is finished is kept, and the same command goes on")
	except Failed as error:
		sys.exit(f"bonded_figures.py: {error}\nWhat is finished is kept; the same command tries these again.")
	for group, members in groups:
		group.records = [Record(folders[case]) for case in members]
	groups = [group for group, _ in groups]
	page = bonded_study.write(
		groups, options.out, commandline.command(), commandline.plain(options), versions(),
		settings(options, groups), pictures=options.pictures, pdf=options.pdf
	)
	print(f"\n{bonded_study.table(groups)}\n\nReport: {page}\n{bonded_study.told(groups)}")


def interrupt(*_):
	raise KeyboardInterrupt


def tell(case, folder, seconds):
	"""Say that a run is finished."""
	figures = Record(folder).figures()
	took = "finished before" if seconds is None else f"{seconds:.0f} s"
	print(f"  {case.name:<28} {figures['ucs_MPa']:6.1f} MPa  {figures['young_GPa']:6.1f} GPa   {took}", flush=True)


# ---- what is run ----


def plan(options):
	"""Groups without records yet, each with its cases."""
	groups, ranges = [], [RANGES[name] for name in options.ranges]

	def add(name, label, radii, stiffness, kind, arguments, samples=None):
		common = [
			"--convention", "esys", "--wall-stiffness", repr(stiffness), "--safety", repr(options.safety),
			"--strain", repr(STRAIN), "--stop", "0"
		]
		common += ["--no-pictures", "--no-vtk", "--no-progress", *arguments]
		if samples:
			cases = [Case(name, (*common, *samples))]
		else:
			packing = [
				"--radii", *map(repr, radii), "--fails", str(options.fails), "--packings",
				os.path.join(options.out, "packings")
			]
			cases = [
				Case(f"{name}_seed{seed}", (*common, *packing, "--seed", str(seed)))
				for seed in range(1, options.packings + 1)
			]
		groups.append((Group(name, label, radii, stiffness, kind, []), cases))

	for stiffness in STIFFNESSES:
		for radii in ranges:
			add(
				f"{text(radii)}mm_K{stiffness / 1e9:g}", f"{label(radii)}, K = {stiffness / 1e9:g} GPa",
				radii, stiffness, "paper", []
			)
	size, stiffness = MEDIUM if MEDIUM in ranges else ranges[0], STIFFNESSES[0]
	rock = ["--mass-law", "solid", "--density", "2600"]
	add(f"{text(size)}mm_rock", f"{label(size)}, rock density", size, stiffness, "rock density", rock)
	consistent = ["--convention", "consistent", "--mass-law", "cube", "--density", "1e6"]
	add(
		f"{text(size)}mm_consistent", f"{label(size)}, consistent bonds", size, stiffness, "consistent bonds",
		consistent
	)
	if not options.quick:
		kind = "sample of ESyS-Particle"
		add("esys_0.4-2.0mm", f"{label(MEDIUM)}, {kind}", MEDIUM, stiffness, kind, [], sample("ref_s1"))
		add(
			"esys_0.4-2.0mm_rock", "the same, rock density", MEDIUM, stiffness, f"{kind}, rock density",
			rock, sample("ref_s1")
		)
		add("esys_0.8-4.0mm", f"{label(COARSE)}, {kind}", COARSE, stiffness, kind, [], sample("dbl_s1"))
	return groups


def sample(name):
	"""Options for a sample that ESyS-Particle has made."""
	files = [os.path.join(SAMPLES, f"sample_{name}_{part}.csv") for part in ("particles", "bonds")]
	return ["--particles", files[0], "--bonds", files[1], "--length-unit", "mm", "--box", *BOX]


def text(radii):
	return f"{1e3 * radii[0]:.1f}-{1e3 * radii[1]:.1f}"


def label(radii):
	return text(radii).replace("-", "–") + " mm"


def by_length(cases):
	"""Long runs first, so that none of them is left over for the end."""
	return sorted(cases, key=lambda case: (text(FINE) not in case.name, "rock" not in case.name))


# ---- options ----


def read_options():
	quick = "--quick" in sys.argv[1:]
	parser = argparse.ArgumentParser(
		prog="scripts/ddem run scripts/bonded_figures.py",
		usage="%(prog)s [options]",
		formatter_class=argparse.ArgumentDefaultsHelpFormatter,
		allow_abbrev=False,
		description=(
			"Make the figures of the paper on bonded spheres, and set its "
			"statements beside what they show."
		),
		epilog="Everything else is as in the tutorial of ESyS-Particle, see scripts/ucs_bonded.py --help.",
	)
	run = parser.add_argument_group("run")
	run.add_argument("--quick", action="store_true", help="large spheres only, two packings, long steps")
	commandline.add_workers(run, os.cpu_count(), "runs", ", each in a YADE of its own on one thread")
	run.add_argument(
		"--out",
		default=os.path.join("out", "bonded_figures"),
		metavar="DIR",
		help="folder for all files, made when missing",
	)
	run.add_argument("--fresh", action="store_true", help="make runs again that are finished")
	model = parser.add_argument_group("runs")
	model.add_argument(
		"--ranges", nargs="+", choices=tuple(RANGES), default=["coarse"] if quick else list(RANGES),
		help="of the radii"
	)
	model.add_argument(
		"--packings", type=count, default=2 if quick else 3, metavar="N",
		help="packings of each range, seeds 1 to N"
	)
	model.add_argument(
		"--fails", type=count, default=5000, metavar="N",
		help="a packing is finished when so many spheres in a row found no place"
	)
	model.add_argument(
		"--safety", type=share, default=0.8 if quick else 0.4, metavar="PART",
		help="time step, as a part of the critical one"
	)
	output = parser.add_argument_group("output")
	output.add_argument(
		"--pictures",
		action=argparse.BooleanOptionalAction,
		default=True,
		help="pictures, in the page and as PNG files",
	)
	output.add_argument("--pdf", action="store_true", help="each picture as a PDF file as well")
	options = parser.parse_args()
	provenance.begin(vars(options))
	if len(set(options.ranges)) < len(options.ranges):
		parser.error(f"argument --ranges: {' '.join(options.ranges)} names one twice")
	if options.safety == 0:
		parser.error("argument --safety: 0 leaves no time step")
	require_writable(parser, "--out", options.out)
	return options, parser


# ---- what the page says about the runs ----


def settings(options, groups):
	dt = sorted(record.summary["dt_s"] for group in groups for record in group.records)
	steps = sorted(record.summary["steps"] for group in groups for record in group.records)
	busy = sum(record.summary["cpu_s"] for group in groups for record in group.records) / 60
	said = (
		f"{options.safety:g} of the critical one; {steps[0]} to {steps[-1]} steps; {busy:.1f} minutes of "
		"processor time for all"
	)
	return [
		(
			"samples",
			"10 × 20 × 10 mm",
			(
				f"by GenGeo until {options.fails} insertions in a row failed, seeds 1 to "
				f"{options.packings}; bonds up to a gap of 5 µm"
			),
		),
		(
			"bonds",
			"E = 100 GPa, ν = 0.25",
			"C = 100 MPa, tan φ = 1; convention of ESyS-Particle 2.3.5 but where said",
		),
		("contacts", "μ = 0.6, 0.4", "static and dynamic friction; stiffness as of bonds"),
		("masses", "10⁶ kg/m³ · r³", "ESyS-Particle's default, but where said"),
		("walls", "0.125 m/s", "speed of each, reached after 50 µs; the tests end after 0.25 ms"),
		("viscosity", "2 /s", "of translation and rotation"),
		("time step", f"{1e9 * dt[0]:.3g} to {1e9 * dt[-1]:.3g} ns", said),
	]


def versions():
	import matplotlib
	import numpy
	return commandline.versions(numpy, matplotlib)


if __name__ == "__main__":
	main()
