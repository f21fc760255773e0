# GPL v2 or later, see LICENSE.
"""Calibrate a model: find the parameters of bonds, or of concrete, with which a small specimen has the wanted Young's
modulus and strengths.

Run:      scripts/ddem run scripts/calibrate.py --young 40e9 --ucs 60e6
              (bonded spheres: half a minute on two cores)
          scripts/ddem run scripts/calibrate.py --young 40e9 --ucs 60e6 --tensile 24e6 0.05
              (also the bonds' friction angle: two minutes)
          scripts/ddem run scripts/calibrate.py --model deformable --young 30e9 --ucs 50e6
              (triangles of concrete: half a minute)
          scripts/ddem run scripts/calibrate.py --specimen block --young 54e9 --ucs 71e6 --seeds 1 2 3
          scripts/ddem run scripts/calibrate.py --help
              (all options)
Writes:   a line a point and a table here, and out/calibrate/calibration.html, calibration.json,
          and evaluations.jsonl with every evaluation.

        targets ──> start by scaling laws ──> virtual tests ──> all within tolerance? ── yes ──> parameters,
                                                   ^                     | no                    sensitivities,
                                                   └─ response surface <─┘                       line to paste
                                       (a plane through the logarithms of all points)

Each evaluation is a compression (or tension) test of the specimen in a YADE of its own, several at the same time.
Ctrl-C loses nothing that was finished: the same command goes on from there, and other targets for the same specimen use
what is known; another build of the plugin measures anew. Exit code: 0 the targets are met, 1 they are not (the nearest
is shown, and what stopped the search), 2 wrong options, 130 interrupted.

Expect:   Spheres, 40 GPa and 60 MPa: five tests, E = 30.4 GPa and C = 42 MPa; the prism's modulus is proportional to E,
          its strength to C. A strength scatters by 1.7 % between neighbouring cohesions, so a tolerance below 2 % needs
          several --seeds. Strengths in compression and tension fall together with the friction angle: their ratio is
          2.0 at 15°, 2.8 at 45°, 3.2 at 70° (3.7 with a low tensileStrength), so that of rock, 10 and more, is out of
          reach of these bonds, and --tensile 6e6 says so. With --tensile 24e6: 25° and 29 MPa. Triangles, 30 GPa and
          50 MPa: five tests, young = 34.8 GPa and strength = 94.9 MPa;
          --tensile 6e6 beside it is met with friction = 0.68.
"""
import argparse
import os
import signal
import sys
from argparse import SUPPRESS

from yade.ddem import provenance
from yade.ddem.reports.calibration import CalibrationReport, Progress, material_line
from yade.ddem.studies import commandline, virtualtest
from yade.ddem.studies.calibration import Calibration, Target
from yade.ddem.studies.calibration_quantities import MEASURES, TUNABLES, parameters, starts, usual
from yade.ddem.studies.commandline import count, not_negative, positive, require_writable, seed, share
from yade.ddem.studies.evaluations import Bench, Lost

#: attributes of the material that are stated, with the values of its class where nothing else is said
STATED = {
	"rigid": ("young", "poisson", "cohesion", "bondFrictionAngle", "frictionStatic", "frictionDynamic"),
	"deformable": ("young", "poisson", "strength", "friction", "fractureEnergy", "flowFactor", "damageExponent"),
}
INTERRUPTED = 130


def main():
	for number in (signal.SIGTERM, signal.SIGHUP):
		signal.signal(number, interrupt)
	options, parser = read_options()
	try:
		setup, targets, tuned, fixed, separate = prepare(options)
		require_writable(parser, "--out", options.out)
		tests = virtualtest.cases([t.name for t in targets], options.seeds)
		workers = commandline.workers(parser, options)
		evaluate = separate(workers)
		bench = Bench(
			evaluate, tests, evaluate.settings(), os.path.join(options.out, "evaluations.jsonl"),
			options.budget
		)
		progress = Progress(options.model, tuned, targets, lambda line: print(line, flush=True))
		calibration = Calibration(tuned, targets, bench, options.step, options.sensitivities, progress)
	except (ValueError, OSError, RuntimeError) as error:
		parser.error(str(error))
	with workers, bench:
		for number, reason in bench.store.unreadable:
			print(
				f"{bench.store.path}, line {number} is not readable ({reason}); its evaluation is "
				"made again"
			)
		print(introduction(options, bench, workers))
		progress.header()
		try:
			outcome = calibration.run()
		except KeyboardInterrupt:
			print(f"\nInterrupted after {bench.ran} evaluations; the same command goes on from there.")
			sys.exit(INTERRUPTED)
		except Lost as error:
			sys.exit(
				f"calibrate.py: {error}; {bench.ran} evaluations are kept, and the same command goes on"
			)
		report = write_report(options, setup, fixed, outcome, bench)
	sys.exit(0 if report.outcome.reached else 1)


def interrupt(*_):
	raise KeyboardInterrupt


def prepare(options):
	"""Specimen, targets, parameters to tune, fixed ones, and what evaluates on some workers;
	ValueError before anything runs."""
	changes = {
		"radii": options.radii and tuple(options.radii), "fails": options.fails, "size": options.size,
		"density": options.density, "velocity": options.velocity,
		"tension_velocity": options.tension_velocity, "ramp": options.ramp, "strain": options.strain,
		"stop": options.stop, "safety": options.safety,
		"viscosity": options.viscosity, "wall_factor": options.wall_factor, "convention": options.convention
	}
	setup = virtualtest.Setup.standard(options.model, options.specimen, **changes)
	wanted = {name: value for name, value in ((name, getattr(options, name)) for name in MEASURES) if value}
	if not wanted:
		raise ValueError("nothing to aim at: give at least one of --young, --ucs and --tensile")
	targets = []
	for name, value in wanted.items():
		if len(value) > 2:
			raise ValueError(
				f"--{name} takes a value and, if it has one of its own, a tolerance; "
				f"got {' '.join(f'{v:g}' for v in value)}"
			)
		targets.append(Target(name, value[0], value[1] if len(value) == 2 else options.tolerance))

	if not options.step > 0:
		raise ValueError("--step 0: finite differences need a step, above the noise of breaking bonds (0.08)")

	names = options.tune or usual(options.model, wanted)
	given = dict(options.set)
	if options.model == "rigid" and options.specimen == "block":
		given.setdefault("poisson", 0.2)  # as in ucs_compare.py
	reference = virtualtest.material(options.model, given, setup.density)
	material = {name: getattr(reference, name) for name in (*TUNABLES[options.model], *STATED[options.model])}
	start = {**starts(options.model, {t.name: t.value for t in targets}, material), **options.start}
	for option, pairs in (("--start", options.start), ("--bounds", options.bounds)):
		for name in pairs:
			if name not in names:
				raise ValueError(
					f"{option} {name}: it is not tuned; tuned are {', '.join(names)} (see --tune; "
					"--set keeps a parameter at a value)"
				)
	for name in given:
		if name in names:
			raise ValueError(
				f"--set {name}: it is tuned, so it cannot be kept at a value; --start says where to "
				"begin"
			)
	tuned = parameters(options.model, names, start, options.bounds)
	stated = [
		name
		for name in STATED[options.model]
		if not (name in ("young", "poisson") and {"bulk", "shear"} & {*names, *given})
	]
	fixed = {**{name: material[name] for name in stated}, **given}
	if {"bulk", "shear"} & {*names, *given}:
		fixed.update((name, fixed.get(name, material[name])) for name in ("bulk", "shear"))
	fixed = {name: value for name, value in fixed.items() if name not in names}
	virtualtest.material(options.model, {**fixed, **{p.name: p.start for p in tuned}}, setup.density)
	cache = os.path.abspath(os.path.join(options.out, "packings"))
	return setup, targets, tuned, fixed, lambda workers: virtualtest.SeparateYade(setup, fixed, cache, workers)


# ---- options ----


def read_options():
	"""Options from the command line, and the parser, which complains."""
	parser = argparse.ArgumentParser(
		prog="scripts/ddem run scripts/calibrate.py",
		usage="%(prog)s [options]",
		description=(
			"Find the parameters with which a small specimen has the wanted "
			"Young's modulus and strengths."
		),
		formatter_class=argparse.ArgumentDefaultsHelpFormatter,
		allow_abbrev=False,
		epilog=(
			"SI units: Pa, m, s, m/s, rad. Attributes are those of BondedMat and ConcreteDamageMat. "
			"Evaluations that were made with the same settings are taken from DIR/evaluations.jsonl, "
			"whatever the targets."
		),
	)
	aim = parser.add_argument_group("targets (any of them)")
	for name, what in (
		("young", "Young's modulus"),
		("ucs", "strength in compression"),
		("tensile", "strength in tension, positive"),
	):
		aim.add_argument(
			f"--{name}", type=positive, nargs="+", default=SUPPRESS, metavar=("PA", "TOLERANCE"),
			help=f"{what} [Pa], and a relative tolerance of its own"
		)
	aim.add_argument(
		"--tolerance", type=share, default=0.02, metavar="PART",
		help="relative tolerance of targets without one of their own"
	)
	model = parser.add_argument_group("model")
	model.add_argument(
		"--model",
		choices=tuple(TUNABLES),
		default="rigid",
		help="bonded spheres or deformable triangles of concrete",
	)
	model.add_argument(
		"--tune",
		nargs="+",
		default=SUPPRESS,
		metavar="NAME",
		help="attributes of the material to tune. rigid: "
		+ ", ".join(TUNABLES["rigid"])
		+ "; deformable: "
		+ ", ".join(TUNABLES["deformable"])
		+ (
			" (default: young for --young; cohesion or strength for --ucs; bondFrictionAngle or friction "
			"for --tensile beside it)"
		),
	)
	model.add_argument(
		"--set", type=assignment, nargs="+", default=SUPPRESS, metavar="NAME=VALUE",
		help="any other attributes of the material, kept as given"
	)
	model.add_argument(
		"--start", type=assignment, nargs="+", default=SUPPRESS, metavar="NAME=VALUE",
		help="where to begin, instead of by scaling laws"
	)
	model.add_argument(
		"--bounds",
		type=interval,
		nargs="+",
		default=SUPPRESS,
		metavar="NAME=LOW:HIGH",
		help=(
			"how far a tuned attribute may go; by default a twentieth and twenty times the start, for "
			"angles and pure numbers their sensible range"
		),
	)
	model.add_argument(
		"--convention",
		choices=("consistent", "esys"),
		default="consistent",
		help="of rigid bonds: conservative, or ESyS-Particle's own",
	)
	sample = parser.add_argument_group("specimen (default: that of --specimen)")
	sample.add_argument(
		"--specimen",
		choices=tuple(virtualtest.SPECIMENS),
		default=SUPPRESS,
		help=(
			"prism: 10 x 20 x 10 mm, smooth ends, of spheres; block: 100 x 200 x 20 mm in plane strain, "
			"rough ends, that of ucs_compare.py (default: prism for rigid, block for deformable)"
		),
	)
	sample.add_argument(
		"--radii", type=positive, nargs=2, default=SUPPRESS, metavar=("MIN", "MAX"),
		help="range of the spheres' radii [m] (prism: 0.0004 0.002, block: 0.002 0.005)"
	)
	sample.add_argument(
		"--fails", type=count, default=1000, metavar="N",
		help="the packing of spheres is finished when so many in a row found no place"
	)
	sample.add_argument(
		"--size", type=positive, default=SUPPRESS, metavar="M",
		help="size of the triangles' mesh [m] (block: 0.005)"
	)
	sample.add_argument(
		"--density", type=positive, default=2400.0, metavar="KG/M3", help="of the specimen as a whole"
	)
	sample.add_argument(
		"--seeds", type=seed, nargs="+", default=[1], metavar="N",
		help="draw packing, mesh and fracture energies; measures are means over several seeds"
	)
	test = parser.add_argument_group("tests")
	test.add_argument(
		"--velocity", type=positive, default=SUPPRESS, metavar="M/S",
		help="speed of each platen in compression (prism: 0.125, block: 1)"
	)
	test.add_argument(
		"--tension-velocity", type=positive, default=SUPPRESS, metavar="M/S",
		help="the same in tension (default: a quarter of it)"
	)
	test.add_argument(
		"--ramp", type=not_negative, default=SUPPRESS, metavar="S",
		help="time over which the platens reach their speed [s] (prism: 2e-5, block: 1e-4)"
	)
	test.add_argument(
		"--strain", type=positive, default=0.01, metavar="E",
		help=(
			"largest strain in compression, half of it in tension; a specimen that has not failed there "
			"is an evaluation that failed"
		)
	)
	test.add_argument(
		"--stop", type=share, default=0.7, metavar="PART",
		help="a test ends when the stress stays below this part of the peak"
	)
	test.add_argument(
		"--safety", type=share, default=0.8, metavar="PART", help="time step, as a part of the critical one"
	)
	test.add_argument(
		"--viscosity", type=not_negative, default=0.0, metavar="1/S",
		help="damping of the spheres; ESyS-Particle's tutorial has 2"
	)
	test.add_argument(
		"--wall-factor", type=positive, default=10.0, metavar="F",
		help="stiffness of the platens of spheres over Young's modulus of the bonds"
	)
	search = parser.add_argument_group("search")
	commandline.add_workers(search, os.cpu_count(), "evaluations")
	search.add_argument("--budget", type=count, default=60, metavar="N", help="no more new evaluations than this")
	search.add_argument(
		"--step", type=share, default=0.08, metavar="PART",
		help="of finite differences, above the noise of breaking bonds"
	)
	search.add_argument(
		"--sensitivities", action=argparse.BooleanOptionalAction, default=True,
		help="measure them in the end where the search did not do so nearby, a point a parameter"
	)
	output = parser.add_argument_group("output")
	output.add_argument(
		"--out",
		default=os.path.join("out", "calibrate"),
		metavar="DIR",
		help="folder for all files, made when missing",
	)
	output.add_argument(
		"--pictures",
		action=argparse.BooleanOptionalAction,
		default=True,
		help="pictures, in the report and as PNG files",
	)
	output.add_argument("--pdf", action="store_true", help="each picture as a PDF file as well")
	options = parser.parse_args()
	provenance.begin(vars(options))
	for name in ("young", "ucs", "tensile", "tune", "radii", "size", "velocity", "tension_velocity", "ramp"):
		setattr(options, name, getattr(options, name, None))
	for name in ("set", "start", "bounds"):
		setattr(options, name, dict(getattr(options, name, ())))
	options.specimen = getattr(options, "specimen", "prism" if options.model == "rigid" else "block")
	return options, parser


def assignment(text):
	name, equals, value = text.partition("=")
	try:
		return name, float(value)
	except ValueError:
		raise argparse.ArgumentTypeError(f"'{text}' must be NAME=VALUE, as cohesion=60e6") from None


def interval(text):
	name, _, values = text.partition("=")
	low, _, high = values.partition(":")
	try:
		return name, (float(low), float(high))
	except ValueError:
		raise argparse.ArgumentTypeError(f"'{text}' must be NAME=LOW:HIGH, as cohesion=10e6:500e6") from None


# ---- what is said about it ----


def kinds(bench):
	return " and ".join(dict.fromkeys(case["test"] for case in bench.cases))


def introduction(options, bench, workers):
	seeds = f", mean of {len(options.seeds)} seeds" if len(options.seeds) > 1 else ""
	return (
		f"Calibration of the {options.model} model on a {options.specimen}: {kinds(bench)}{seeds}; "
		f"{workers.told()}.\n"
	)


def write_report(options, setup, fixed, outcome, bench):
	values = {**fixed, **(outcome.best.values if outcome.best else {})}
	order = [name for name in (*TUNABLES[options.model], *values) if name in values]
	material = (
		material_line(options.model, {name: values[name] for name in dict.fromkeys(order)}, setup.density)
		if outcome.best
		else ""
	)
	particles = "bonded spheres" if options.model == "rigid" else "deformable triangles of concrete"
	title = f"Calibration of {particles}: a {options.specimen} in {kinds(bench)}"
	report = CalibrationReport(
		outcome, bench, options.model, options.out, title, material, rows(options, setup, fixed),
		commandline.command(), commandline.plain(options),
		versions(), notes(setup), options.pictures, options.pdf
	)
	page = report.write()
	print(f"\n{report.table()}\n\nReport: {page}")
	if report.told():
		print(report.told())
	return report


def rows(options, setup, fixed):
	"""What the report says about specimen and tests."""
	size = f"{1e3 * setup.width:g} × {1e3 * setup.height:g} × {1e3 * setup.depth:g} mm"
	ends = "held laterally (rough)" if setup.rough else "free to slide (smooth)"
	made = [
		(
			"specimen",
			f"{options.specimen}, {size}",
			f"width, height, depth; ends {ends}; density {setup.density:g} kg/m³",
		)
	]
	if setup.model == "rigid":
		plane = "; front and back layers held out of plane" if setup.held else ""
		made.append(
			(
				"spheres",
				f"radii {1e3 * setup.radii[0]:g} to {1e3 * setup.radii[1]:g} mm",
				f"packed until {setup.fails} insertions in a row failed{plane}",
			)
		)
		made.append(("bonds", setup.convention, "convention"))
	else:
		made.append(
			(
				"triangles",
				f"size {1e3 * setup.size:g} mm",
				f"{setup.mesh} mesh, rotation {setup.rotation}; fracture energies drawn for each",
			)
		)
	for name, value in fixed.items():
		quantity = TUNABLES[setup.model].get(name)
		made.append(
			(
				name,
				quantity.shown(value) if quantity else f"{value:g}",
				(quantity.meaning + "; " if quantity else "") + "not tuned",
			)
		)
	made.append(
		(
			"platens",
			f"{setup.velocity:g} m/s",
			(
				f"speed of each in compression, {setup.tension_velocity:g} m/s in tension, reached "
				f"after {1e6 * setup.ramp:g} µs"
			),
		)
	)
	made.append(("time step", f"{setup.safety:g}", "of the critical one"))
	made.append(
		(
			"seeds",
			", ".join(map(str, options.seeds)),
			"of packing, mesh and fracture energies; measures are means over them",
		)
	)
	return made


def notes(setup):
	rate = 2 * setup.velocity / setup.height
	said = [
		(
			f"The parameters belong to this specimen and rate ({rate:g} /s in compression, "
			f"{2 * setup.tension_velocity / setup.height:g} /s in tension): strength changes with the "
			"number and size of particles, and with the rate."
		)
	]
	if setup.held or setup.model == "deformable":
		said.append(
			"In plane strain the slope exceeds the uniaxial Young's modulus by 1/(1 − ν²) in an elastic "
			"material."
		)
	return said


def versions():
	import matplotlib
	import numpy
	import scipy
	return commandline.versions(numpy, scipy, matplotlib)


if __name__ == "__main__":
	main()
