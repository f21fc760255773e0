# GPL v2 or later, see LICENSE.
"""Options of ``scripts/ucs_bonded.py``: every parameter of sample, bonds, walls and test, and what is refused before
anything is built. Those of one kind of test are its own, see :mod:`bonded_tests`."""
import argparse
import math
import os
from argparse import SUPPRESS

from yade import O

from .. import packing, provenance
from . import commandline, uniaxial
from .bonded_specimen import CRITERIA, MASS
from .bonded_tests import TESTS
from .commandline import count, not_negative, number, positive, require_writable, seed, share


def read_options():
	"""Options from the command line, and the parser, which complains."""
	parser = argparse.ArgumentParser(
		prog="scripts/ddem run scripts/ucs_bonded.py",
		usage="%(prog)s [options]",
		formatter_class=argparse.ArgumentDefaultsHelpFormatter,
		allow_abbrev=False,
		description=(
			"Crush, pull apart, confine, split, bend or shear one sample of "
			"bonded spheres, and report."
		),
		epilog=(
			"SI units: m, s, Pa, kg/m³; only files of particles have a unit of their own. The defaults "
			"are the parameters of ESyS-Particle's tutorial. The same options give the same result on one "
			"thread, bit by bit."
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
		"--convention",
		choices=tuple(MASS),
		default="consistent",
		help="of bonds, contacts and moving walls: conservative, with the full bending moment; or that of "
		"ESyS-Particle 2.3.5, to compare with it",
	)
	run.add_argument(
		"--threads", type=count, default=O.numThreads, metavar="N",
		help="OpenMP threads; YADE is started again where it has another number"
	)
	run.add_argument(
		"--out",
		default=os.path.join("out", "ucs_bonded"),
		metavar="DIR",
		help="folder for all files, made when missing; older files are replaced",
	)
	sample = parser.add_argument_group("generated sample")
	sample.add_argument(
		"--size", type=positive, nargs=3, default=SUPPRESS, metavar=("W", "H", "D"),
		help=(
			"width, height and depth of the prism [m]; the load is along H, of direct shear along "
			f"W {_defaults('size')}"
		)
	)
	sample.add_argument(
		"--radii", type=positive, nargs=2, default=(0.4e-3, 2e-3), metavar=("MIN", "MAX"),
		help="range of the spheres' radii [m]"
	)
	sample.add_argument(
		"--shape",
		choices=("prism", "cylinder", "disc"),
		default=SUPPRESS,
		help=(
			"of the sample; cylinder: the diameter is W; disc: on its side, the diameter is W and H, its "
			f"length D {_defaults('shape')}. Cylinders and discs are filled by ddem.packing.fill"
		),
	)
	sample.add_argument("--seed", type=seed, default=1, help="draws the packing")
	sample.add_argument(
		"--fails", type=count, default=5000, metavar="N",
		help="the packing is finished when so many spheres in a row found no place"
	)
	sample.add_argument(
		"--generator",
		choices=packing.GENERATORS,
		default="gengeo",
		help=(
			"of the packing: GenGeo, or ddem.packing.fill, which is much faster and makes other packings "
			"of the same kind"
		),
	)
	sample.add_argument(
		"--packings",
		default=SUPPRESS,
		metavar="DIR",
		help="keep the packing there, and take it from there the next time (default: made anew)",
	)
	files = parser.add_argument_group("sample from files")
	files.add_argument(
		"--particles",
		default=SUPPRESS,
		metavar="CSV",
		help="spheres, columns id, x, y, z, r; the load is along y (default: a generated sample)",
	)
	files.add_argument(
		"--bonds",
		default=SUPPRESS,
		metavar="CSV",
		help="bonds, columns i, j, which are such ids (default: spheres closer than --gap)",
	)
	files.add_argument(
		"--length-unit", choices=tuple(packing.UNITS), default="m", help="of the file of particles"
	)
	files.add_argument(
		"--box",
		type=number,
		nargs=6,
		default=SUPPRESS,
		metavar=("X0", "Y0", "Z0", "X1", "Y1", "Z1"),
		help="corners of the sample [m]: where the walls start, and "
		"the face A of eq. 9 (default: the box around the spheres)",
	)
	bonds = parser.add_argument_group("bonds and contacts")
	bonds.add_argument(
		"--gap", type=not_negative, default=5e-6, metavar="M",
		help="spheres closer than this are bonded, where no file lists the bonds"
	)
	bonds.add_argument(
		"--criterion", choices=tuple(CRITERIA), default="mohr-coulomb",
		help="by which bonds break: BondedMat, ParallelBondMat or SofteningBondMat"
	)
	bonds.add_argument(
		"--moment-contribution", type=share, default=1.0, metavar="PART",
		help="share of the stress of moments that breaks parallel bonds"
	)
	bonds.add_argument(
		"--tension-energy", type=positive, default=100.0, metavar="J/M2",
		help="that softening bonds take in tension"
	)
	bonds.add_argument(
		"--shear-energy", type=positive, default=1000.0, metavar="J/M2",
		help="that softening bonds take in shear"
	)
	bonds.add_argument(
		"--scatter", type=positive, default=SUPPRESS, metavar="M",
		help="Weibull modulus of the strength of bonds, drawn by the seed (default: all are equal)"
	)
	bonds.add_argument(
		"--young", type=positive, default=100e9, metavar="PA",
		help="Young's modulus of the bonds, and of contacts"
	)
	bonds.add_argument("--poisson", type=number, default=0.25, metavar="NU", help="Poisson's ratio")
	bonds.add_argument(
		"--cohesion", type=positive, default=100e6, metavar="PA",
		help="C, shear strength of a bond without normal stress"
	)
	angle = bonds.add_mutually_exclusive_group()
	angle.add_argument(
		"--tan-phi", type=positive, default=1.0, metavar="T",
		help="tangent of the friction angle: bonds break where τ > C - σ tan φ"
	)
	angle.add_argument(
		"--phi", type=positive, default=SUPPRESS, metavar="DEGREES",
		help="the angle itself, instead (default: that of --tan-phi)"
	)
	bonds.add_argument(
		"--tensile-strength", type=positive, default=SUPPRESS, metavar="PA",
		help="a bond breaks where σ exceeds it (default: C/tan φ)"
	)
	bonds.add_argument(
		"--friction", type=not_negative, nargs=2, default=(0.6, 0.4), metavar=("STATIC", "DYNAMIC"),
		help="coefficients of contacts until the first slip, and then"
	)
	bonds.add_argument(
		"--gradual-friction",
		action="store_true",
		help="contacts slip gradually, μ F (1 - (1 - δ/δ_max)^1.5), eq. 7; not in esys",
	)
	bonds.add_argument(
		"--contact-damping", type=not_negative, nargs=2, default=(0.0, 0.0), metavar=("NORMAL", "SHEAR"),
		help="parts of the critical one (eq. 6); not in esys"
	)
	bonds.add_argument(
		"--mass-law",
		choices=("solid", "cube"),
		default=SUPPRESS,
		help="mass of a sphere: density times 4/3 pi r³, or times r³ as ESyS-Particle's own (default: "
		"solid; in esys cube)",
	)
	bonds.add_argument(
		"--density",
		type=positive,
		default=SUPPRESS,
		metavar="KG/M3",
		help="of the spheres, see --mass-law (default: 2600; in esys 1e6, ESyS-Particle's 1 g/mm³, "
		"92 times the mass of rock)",
	)
	walls = parser.add_argument_group("walls")
	walls.add_argument(
		"--wall-stiffness", type=positive, default=SUPPRESS, metavar="PA",
		help=(
			"K: a sphere of radius r feels the spring pi r K (default: 100e9; in bending a tenth of "
			"--young, in shear --young)"
		)
	)
	walls.add_argument(
		"--bonded-walls", action=argparse.BooleanOptionalAction, default=SUPPRESS,
		help="bond spheres within 1.1 radii of a wall to it for good (default: in tension)"
	)
	walls.add_argument(
		"--wall-shear-stiffness", type=not_negative, default=0.0, metavar="PA",
		help="the same along bonded walls; 0: the ends can contract"
	)
	walls.add_argument(
		"--velocity", type=positive, default=SUPPRESS, metavar="M/S",
		help=f"of each wall {_defaults('velocity')}"
	)
	walls.add_argument(
		"--ramp", type=not_negative, default=5e-5, metavar="S",
		help="time over which the walls' speed grows linearly"
	)
	walls.add_argument("--drive", choices=("both", "top"), default="both", help="which walls move")
	test = parser.add_argument_group("test")
	test.add_argument(
		"--viscosity", type=not_negative, default=2.0, metavar="1/S",
		help="of the damping of every sphere's motion; ESyS-Particle's 0.002 /ms"
	)
	test.add_argument(
		"--rotational-viscosity", type=not_negative, default=SUPPRESS, metavar="1/S",
		help="the same of its rotation (default: --viscosity)"
	)
	test.add_argument(
		"--safety", type=share, default=0.8, metavar="PART", help="time step, as a part of the critical one"
	)
	test.add_argument(
		"--dt", type=positive, default=SUPPRESS, metavar="S",
		help="the time step itself, instead (default: by --safety)"
	)
	test.add_argument(
		"--strain", type=positive, default=SUPPRESS, metavar="E",
		help=f"the test ends there at the latest {_defaults('strain')}"
	)
	test.add_argument(
		"--stop", type=share, default=SUPPRESS, metavar="PART",
		help=f"the test ends when the stress stays below this part of the peak; 0: never {_defaults('stop')}"
	)
	commandline.output_options(parser, rows=(uniaxial.ROWS, uniaxial.SNAPSHOTS))
	options = parser.parse_args()
	provenance.begin({name: value for name, value in vars(options).items() if name != "packings"})

	given, test = vars(options), TESTS[options.test]
	law, density = MASS[options.convention]
	for name, value in (
		("packings", None), ("particles", None), ("bonds", None), ("box", None), ("mass_law", law),
		("density", density), ("bonded_walls", test.bonded_walls),
		("velocity", test.velocity), ("strain", test.strain), ("stop", test.stop),
		("rotational_viscosity", options.viscosity), ("dt", None), ("tensile_strength", None),
		("shape", test.shape), ("scatter", None),
		("wall_stiffness", test.wall_stiffness(options)), *test.own.items()
	):
		given.setdefault(name, value)
	given.setdefault("size", _usual_size(options))
	options.friction_angle = math.radians(options.phi) if "phi" in given else math.atan(options.tan_phi)
	check(options, parser)
	return options, parser


def check(options, parser):
	"""Complain about options that do not go together, before anything runs; what a material or a packing refuses,
	it says itself."""
	generated = ("size", "radii", "seed", "fails", "packings")
	if options.particles:
		for name in generated:
			usual = _usual_size(options) if name == "size" else parser.get_default(name)
			if getattr(options, name) not in (None, usual):
				parser.error(
					f"argument --{name}: it belongs to a generated sample, not to a file of "
					"particles"
				)
			delattr(options, name)
	if options.bonds and not options.particles:
		parser.error("argument --bonds: a file of bonds goes with a file of particles; add --particles")
	if options.box and not options.particles:
		parser.error("argument --box: it belongs to a file of particles; a generated sample has --size")
	if options.length_unit != "m" and not options.particles:
		parser.error("argument --length-unit: it belongs to a file of particles")
	if options.box and not all(low < high for low, high in zip(options.box[:3], options.box[3:])):
		parser.error(
			"argument --box: its second corner must be above the first in x, y and z: "
			f"got {' '.join(f'{v:g}' for v in options.box)} m"
		)
	if options.shape == "disc" and not options.particles and options.size[0] != options.size[1]:
		parser.error(
			f"argument --size: a disc of {options.size[0]:g} m has that height as well, not "
			f"{options.size[1]:g} m: give W and H the same"
		)
	test = TESTS[options.test]
	for other in TESTS.values():
		for name in other.own.keys() & vars(options).keys() - test.own.keys():
			parser.error(f"argument --{name.replace('_', '-')}: it belongs to --test {other.name}")
	if not test.two_walls and options.drive != "both":
		parser.error(f"argument --drive: --test {test.name} has no two walls that move")
	test.check(options, parser.error)
	if test.prism_only and options.shape != "prism":
		parser.error(f"argument --shape: --test {options.test} needs a prism")
	if options.convention == "esys" and options.criterion != "mohr-coulomb":
		parser.error("argument --criterion: bonds of the convention esys break by mohr-coulomb")
	if options.wall_shear_stiffness and not options.bonded_walls:
		parser.error("argument --wall-shear-stiffness: only bonded walls have one; add --bonded-walls")
	if options.safety == 0:
		parser.error("argument --safety: 0 leaves no time step")
	if options.rows < uniaxial.SNAPSHOTS:
		parser.error(f"argument --rows: {options.rows} must be at least {uniaxial.SNAPSHOTS}")
	require_writable(parser, "--out", options.out)


def _usual_size(options):
	"""Size of a generated sample, unless told otherwise [m]; a disc is as high as wide."""
	width, height, depth = TESTS[options.test].size
	return width, width if options.shape == "disc" else height, depth


def _defaults(name):
	"""Defaults of an option that differ between kinds of tests, for its help."""
	said = lambda value: " ".join(f"{v:g}" for v in value) if isinstance(value, tuple) else value
	common = getattr(TESTS["compression"], name)
	others = [
		f"{kind} {said(getattr(test, name))}" for kind, test in TESTS.items() if getattr(test, name) != common
	]
	return f"(default: {said(common)}; in {', '.join(others)})"
