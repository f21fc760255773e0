# GPL v2 or later, see LICENSE.
"""Options of ``scripts/ucs_deformable.py``: every parameter of sample, law, loads and test, and what is refused before
anything is built. Those of one kind of test are its own, see :mod:`deformable_tests`."""
import argparse
import os
from argparse import SUPPRESS

from yade import O

from .. import mesh, provenance
from . import commandline, deformable_laws, uniaxial
from .commandline import count, not_negative, number, positive, require_writable, seed, share
from .deformable_laws import LAWS
from .deformable_tests import TESTS


def read_options():
	"""Options from the command line, and the parser, which complains."""
	parser = argparse.ArgumentParser(
		prog="scripts/ddem run scripts/ucs_deformable.py",
		usage="%(prog)s [options]",
		formatter_class=argparse.ArgumentDefaultsHelpFormatter,
		allow_abbrev=False,
		description=(
			"Crush, pull, confine, bend, split or shear one sample of deformable "
			"triangles, and report."
		),
		epilog=(
			"SI units: m, s, Pa, kg/m³; angles in degrees. The defaults are Zubelewicz's concrete. "
			"The same options give the same result on any number of threads, bit by bit."
		),
	)
	run = parser.add_argument_group("run")
	run.add_argument(
		"--test",
		choices=tuple(TESTS),
		default="compression",
		help="; ".join(f"{name}: {test.about}" for name, test in TESTS.items())
	)
	for test in TESTS.values():
		test.add_options(run)
	run.add_argument(
		"--threads", type=count, default=O.numThreads, metavar="N",
		help="OpenMP threads; YADE is started again where it has another number"
	)
	run.add_argument(
		"--out",
		default=os.path.join("out", "ucs_deformable"),
		metavar="DIR",
		help="folder for all files, made when missing; older files are replaced",
	)
	sample = parser.add_argument_group("sample")
	sample.add_argument(
		"--size", type=positive, nargs=3, default=SUPPRESS, metavar=("W", "H", "D"),
		help=(
			"width, height and thickness [m]; the load is along H, of a shear test along W; a disc has the "
			f"diameter W {_defaults('size')}"
		)
	)
	sample.add_argument(
		"--edge", type=positive, default=SUPPRESS, metavar="M",
		help=(
			"edge length of the triangles [m] (default: a twentieth of the smaller of W and H; in bending "
			"a tenth)"
		)
	)
	sample.add_argument(
		"--mesh", dest="pattern", choices=mesh.generate.PATTERNS, default="unstructured",
		help="pattern of the mesh"
	)
	sample.add_argument("--seed", type=seed, default=1, help="draws the irregular mesh and the fracture energies")
	sample.add_argument(
		"--spread",
		type=not_negative,
		default=SUPPRESS,
		metavar="PART",
		help=(
			"standard deviation of the triangles' fracture energies over their mean (default: concrete "
			"0.8, as in Zubelewicz 2018; others 0)"
		),
	)
	law = parser.add_argument_group("law")
	law.add_argument(
		"--law", choices=tuple(LAWS), default="concrete",
		help="; ".join(f"{name}: {one.about}" for name, one in LAWS.items())
	)
	law.add_argument(
		"--young", type=positive, default=SUPPRESS, metavar="PA", help="Young's modulus (default: the law's)"
	)
	law.add_argument(
		"--poisson", type=number, default=SUPPRESS, metavar="NU", help="Poisson's ratio (default: the law's)"
	)
	law.add_argument(
		"--density", type=positive, default=SUPPRESS, metavar="KG/M3", help="of the sample (default: the law's)"
	)
	deformable_laws.add_options(law)
	loads = parser.add_argument_group("loads")
	loads.add_argument(
		"--velocity", type=positive, default=SUPPRESS, metavar="M/S",
		help=f"of each platen, of a beam's load, of the top in shear {_defaults('velocity')}"
	)
	loads.add_argument(
		"--ramp", type=not_negative, default=SUPPRESS, metavar="S",
		help=f"time over which that speed grows linearly {_defaults('ramp')}"
	)
	loads.add_argument("--drive", choices=("both", "top"), default="both", help="which platens move")
	loads.add_argument(
		"--ends", choices=("rough", "smooth"), default=SUPPRESS,
		help=(
			"rough platens hold the ends laterally, smooth ones let them slide (default: rough; in tension "
			"smooth)"
		)
	)
	test = parser.add_argument_group("test")
	test.add_argument(
		"--rotation", choices=("cosserat", "corotational", "none"), default="cosserat",
		help="how triangles follow rotation, see DeformableEngine.rotation"
	)
	test.add_argument(
		"--damping", type=share, default=0.0, metavar="PART",
		help="Cundall's local damping of all motion; 0: none, for tests with waves"
	)
	test.add_argument(
		"--safety", type=share, default=0.8, metavar="PART", help="time step, as a part of the critical one"
	)
	test.add_argument(
		"--strain", type=positive, default=SUPPRESS, metavar="E",
		help=f"the test ends there at the latest {_defaults('strain')}"
	)
	test.add_argument(
		"--stop", type=share, default=SUPPRESS, metavar="PART",
		help="the test ends when the stress stays below this part of the peak; 0: never (default: 0.2)"
	)
	commandline.output_options(parser, rows=(uniaxial.ROWS, uniaxial.SNAPSHOTS))
	options = parser.parse_args()
	provenance.begin(vars(options))

	given, test = vars(options), TESTS[options.test]
	for other in TESTS.values():
		for name in other.own.keys() & given.keys() - test.own.keys():
			parser.error(f"argument --{name.replace('_', '-')}: it belongs to --test {other.name}")
	if test.ends is None and "ends" in given:
		parser.error(f"argument --ends: --test {test.name} has no ends to choose")
	for name, value in (
		("size", test.size), ("velocity", test.velocity), ("strain", test.strain), ("ramp", test.ramp),
		("stop", test.stop),
		("ends", test.ends), ("young", None), ("poisson", None), ("density", None),
		("spread", 0.8 if options.law == "concrete" else 0.0), *test.own.items()
	):
		given.setdefault(name, value)
	given.setdefault("edge", min(options.size[:2]) / test.cells)
	check(options, parser)
	return options, parser


def check(options, parser):
	"""Complain about options that do not go together, before anything runs; what a material or a mesh refuses,
	it says itself."""
	test, smaller = TESTS[options.test], min(options.size[:2])
	if options.edge > smaller / 4:
		parser.error(
			f"argument --edge: {options.edge:g} m is more than a quarter of the smaller side of the "
			f"sample, {smaller:g} m"
		)
	if not test.two_platens and options.drive != "both":
		parser.error(f"argument --drive: --test {test.name} has no two platens that move")
	test.check(options, parser.error)
	deformable_laws.check(options, parser.error)
	if options.spread and not hasattr(LAWS[options.law].material(), "fractureEnergy"):
		parser.error(f"argument --spread: --law {options.law} has no fracture energy")
	if options.safety == 0:
		parser.error("argument --safety: 0 leaves no time step")
	if options.rows < uniaxial.SNAPSHOTS:
		parser.error(f"argument --rows: {options.rows} must be at least {uniaxial.SNAPSHOTS}")
	require_writable(parser, "--out", options.out)


def _defaults(name):
	"""Defaults of an option that differ between kinds of tests, for its help."""
	said = lambda value: " ".join(f"{v:g}" for v in value) if isinstance(value, tuple) else f"{value:g}"
	common = getattr(TESTS["compression"], name)
	others = [
		f"{kind} {said(getattr(test, name))}" for kind, test in TESTS.items() if getattr(test, name) != common
	]
	return f"(default: {said(common)}; in {', '.join(others)})"
