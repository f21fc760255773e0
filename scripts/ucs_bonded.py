# GPL v2 or later, see LICENSE.
"""Crush, pull apart, confine or split one sample of bonded spheres: generated, or from files.

Run:      scripts/ddem run scripts/ucs_bonded.py                    (compression, consistent bonds, rock density;
                                                                    a quarter of a minute)
          scripts/ddem run scripts/ucs_bonded.py --convention esys  (bonds, contacts,
                                                                    walls and masses of ESyS-Particle's tutorial)
          scripts/ddem run scripts/ucs_bonded.py --test tension
          scripts/ddem run scripts/ucs_bonded.py --test triaxial --pressure 20e6     (or oedometer, brazilian)
          scripts/ddem run scripts/ucs_bonded.py --shape cylinder --criterion softening --scatter 8
          scripts/ddem run scripts/ucs_bonded.py --particles P.csv --bonds B.csv --length-unit mm
          scripts/ddem run scripts/ucs_bonded.py --help             (every parameter of model and test)
Writes:   a table here, and into out/ucs_bonded: report.html with pictures, summary.json, rigid.csv (time series),
          rigid_broken_bonds.csv (a line a broken bond), and ParaView files of spheres, bonds and broken bonds.

        v |  0.125 m/s      The uniaxial test of Weatherley et al. (tutorial of ESyS-Particle): spheres of 0.4 to 2 mm
     =============          packed into a prism of 10 x 20 x 10 mm, bonded where they touch, between two elastic walls
      o O o O O o           that push (spring pi r K on a sphere of radius r, no friction), or, in tension, hold the
      O o O O o O           spheres at both ends and pull. Stress is (F_top + F_bottom)/2A (eq. 9), strain the approach
      o O o O o o           of the walls over their first distance (eqs. 10-11), A the face of the box. Strength is the
     =============          largest stress, Young's modulus the least-squares slope between 20 % and 60 % of it.
        v ^                 In tension stress, strain and forces count positive in tension;
                            a bond's normal stress always does.

                            SI units everywhere, but for files of particles, which have --length-unit.

Expect:   690 spheres, 2190 bonds. Compression: 136 MPa and 112 GPa; a band of broken bonds crosses the sample, three in
          four of them broken in tension. In esys, with spheres 92 times as heavy: 186 MPa, as half the bending moment
          means less tension, and inertia holds the fragments together. Tension: 51 MPa and 114 GPa; one crack goes
          straight across. Another --seed changes strengths by a tenth or two.
"""
import argparse
import math
import os
import time
from argparse import SUPPRESS

from yade import ddem
from yade.ddem import provenance, vtk
from yade.ddem.reports import parameter_tables
from yade.ddem.reports.uniaxial import Report
from yade.ddem.studies import commandline, uniaxial
from yade.ddem.studies.commandline import count, not_negative, number, positive, require_writable, seed, share

# law and density [kg/m³] of each convention, unless told otherwise
MASS = {"consistent": ("solid", 2600.0), "esys": ("cube", 1e6)}
# Speed of each wall [m/s]: the stress of the first wave, ρcv, has to stay well below the strength,
# which is small in tension.
VELOCITY = {"compression": 0.125, "tension": 0.125 / 4, "triaxial": 0.25, "oedometer": 0.25, "brazilian": 0.0625}
STRAIN = {"compression": 5e-3, "tension": 1e-3, "triaxial": 1e-2, "oedometer": 5e-3, "brazilian": 4e-3}  # largest [-]
FLAT = math.radians(15)  # half of the angle that each flat end of a disc takes
# material of each criterion by which bonds break, and its options
CRITERIA = {
	"mohr-coulomb": (BondedMat, {}),
	"parallel": (ParallelBondMat, {"momentContribution": "moment_contribution"}),
	"softening": (SofteningBondMat, {"tensionEnergy": "tension_energy", "shearEnergy": "shear_energy"}),
}


@commandline.steps_told()
def main():
	options, parser = read_options()
	try:
		commandline.restart(options.threads)
		start = time.perf_counter()
		platens, critical, sample = make(options)
		ddem.bonded.check()
	except (ValueError, OSError, ImportError, RuntimeError) as error:
		parser.error(str(error))
	recorders = (
		[vtk.Recorder(platens.sample, os.path.join(options.out, "paraview", "rigid"))] if options.vtk else []
	)
	closing = options.velocity * (2 if options.drive == "both" else 1)
	duration = options.strain * platens.height / closing + 0.5 * options.ramp
	if options.test == "triaxial":
		duration += options.pressure_ramp
	kind = uniaxial.TensionTest if options.test == "tension" else uniaxial.CompressionTest
	test = kind(
		platens, duration, stop=options.stop, recorders=recorders, critical_dt=critical, rows=options.rows,
		snapshots=options.pictures
	)
	setup = time.perf_counter() - start
	run = test.run(progress=options.progress)
	run.setup, run.parameters = setup, sample
	run.extra.update(waves(platens, run))
	report = Report(
		[run], options.out, f"Uniaxial {options.test} of bonded spheres", settings=settings(options, platens),
		command=commandline.command(),
		options=commandline.plain(options), versions=versions(), notes=notes(options, platens, run, closing),
		pictures=options.pictures, pdf=options.pdf
	)
	page = report.write()
	print(f"\n{report.table()}\n\nReport: {page}")


# ---- the test ----


def make(options):
	"""Spheres, bonds, walls and engines in the scene; the walls, the critical time step,
	and what the report says about the sample."""
	O.reset()
	packing = read_packing(options)
	kind, own = CRITERIA[options.criterion]
	O.materials.append(
		kind(
			label="bonds", density=options.density, young=options.young, poisson=options.poisson,
			cohesion=options.cohesion, bondFrictionAngle=options.friction_angle,
			tensileStrength=options.tensile_strength or math.inf, frictionStatic=options.friction[0],
			frictionDynamic=options.friction[1],
			gradualFriction=options.gradual_friction, normalDamping=options.contact_damping[0],
			shearDamping=options.contact_damping[1],
			**{attribute: getattr(options, name) for attribute, name in own.items()}
		)
	)
	sample = ddem.bonded.append(
		packing, "bonds", gap=None if packing.bonds is not None else options.gap, mass_law=options.mass_law,
		scatter=ddem.bonded.Weibull(options.scatter, options.seed) if options.scatter else None
	)
	platens, loads = load(options, sample)
	O.engines = ddem.bonded.engines(loads, options.viscosity, options.rotational_viscosity, options.convention)
	critical = ddem.bonded.critical_time_step()
	O.dt = options.dt or options.safety * critical
	return platens, critical, describe(options, packing, sample, critical)


def load(options, sample):
	"""The platens that are measured, and all that loads the sample."""
	if options.test == "triaxial":
		height = float(sample.upper[1] - sample.lower[1])
		platens = ddem.bonded.triaxial(
			sample, options.pressure, options.strain, options.strain * height / (2 * options.velocity),
			options.pressure_ramp, 4 * options.velocity, options.wall_stiffness
		)
		return platens, platens
	area = None
	if options.test == "brazilian":  # the stress is then 2 P/(π D L), the tensile strength of a disc
		diameter, _, length = sample.upper - sample.lower
		area = math.pi / 2 * float(diameter * length)
	platens = ddem.bonded.platens(
		sample, -options.velocity if options.test == "tension" else options.velocity, options.ramp,
		stiffness=options.wall_stiffness, both=options.drive == "both",
		bonded=options.bonded_walls, shear_stiffness=options.wall_shear_stiffness, area=area
	)
	if options.test == "oedometer":
		return platens, [platens, ddem.bonded.confine(sample, stiffness=options.wall_stiffness)]
	return platens, platens


def flattened_disc(diameter, length):
	"""A disc on its side for the Brazilian test, with flat ends so that it does not crush where it is touched
	(Wang, Jia, Kou, Zhang, Lindqvist 2004)."""
	around = [(math.sin(a), math.cos(a)) for a in (2 * math.pi * k / 72 for k in range(72))]
	level = math.cos(FLAT)
	corners = [(x, y) for x, y in around if abs(y) < level]
	corners += [(sx * math.sin(FLAT), sy * level) for sx in (-1, 1) for sy in (-1, 1)]
	return ddem.packing.Polyhedron(
		[
			(diameter / 2 * x, diameter / 2 * (y + level), z) for x, y in corners
			for z in (-length / 2, length / 2)
		]
	)


def read_packing(options):
	"""The spheres, and their bonds where a file lists them."""
	if options.particles is None and options.shape != "prism":
		width, height, depth = options.size
		if options.shape == "cylinder":
			body = ddem.packing.Cylinder((0, 0, 0), (0, height, 0), width / 2)
		else:
			body = flattened_disc(width, depth)
		return ddem.packing.fill(body, *options.radii, seed=options.seed, fails=options.fails)
	if options.particles is None:
		return ddem.packing.prism(
			*options.size, *options.radii, seed=options.seed, fails=options.fails, keep=options.packings,
			generator=options.generator
		)
	packing = ddem.packing.read(options.particles, options.bonds, options.length_unit)
	if options.box:
		return ddem.packing.Packing(
			packing.centres, packing.radii, options.box[:3], options.box[3:], packing.bonds
		)
	return packing


# ---- options ----


def read_options():
	"""Options from the command line, and the parser, which complains."""
	parser = argparse.ArgumentParser(
		prog="scripts/ddem run scripts/ucs_bonded.py",
		usage="%(prog)s [options]",
		formatter_class=argparse.ArgumentDefaultsHelpFormatter,
		allow_abbrev=False,
		description="Crush, or pull apart, one sample of bonded spheres, and report.",
		epilog=(
			"SI units: m, s, Pa, kg/m³; only files of particles have a unit of their own. The defaults "
			"are the parameters of ESyS-Particle's tutorial. The same options give the same result on one "
			"thread, bit by bit."
		),
	)
	run = parser.add_argument_group("run")
	run.add_argument(
		"--test",
		choices=tuple(VELOCITY),
		default="compression",
		help=(
			"walls that push; walls that hold the ends and pull; walls that push with --pressure on the "
			"sides, or with sides that do not move; walls that split a disc"
		),
	)
	run.add_argument(
		"--pressure", type=positive, default=SUPPRESS, metavar="PA",
		help="on all sides, before and while the sample is crushed (default: none; a triaxial test needs it)"
	)
	run.add_argument(
		"--pressure-ramp", type=positive, default=1e-4, metavar="S",
		help="time over which it grows (triaxial test)"
	)
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
		"--size", type=positive, nargs=3, default=(0.010, 0.020, 0.010), metavar=("W", "H", "D"),
		help="width, height and depth of the prism [m]; the load is along H"
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
			"of the sample; cylinder: the diameter is W; disc: on its side, the diameter is W, its length "
			"D (default: prism; in the Brazilian test disc). Cylinders and discs are filled by "
			"ddem.packing.fill"
		),
	)
	sample.add_argument("--seed", type=seed, default=1, help="draws the packing")
	sample.add_argument(
		"--fails", type=count, default=5000, metavar="N",
		help="the packing is finished when so many spheres in a row found no place"
	)
	sample.add_argument(
		"--generator",
		choices=ddem.packing.GENERATORS,
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
		"--length-unit", choices=tuple(ddem.packing.UNITS), default="m", help="of the file of particles"
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
		"--wall-stiffness", type=positive, default=100e9, metavar="PA",
		help="K: a sphere of radius r feels the spring pi r K"
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
		help="of each wall (default: 0.125; in tension 0.03125)"
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
		help="the test ends there at the latest (default: 0.005; in tension 0.001)"
	)
	test.add_argument(
		"--stop", type=share, default=0.2, metavar="PART",
		help="the test ends when the stress stays below this part of the peak; 0: never"
	)
	output = parser.add_argument_group("output")
	output.add_argument(
		"--rows", type=count, default=uniaxial.ROWS, metavar="N",
		help="records up to the largest strain, at least 100"
	)
	output.add_argument("--vtk", action=argparse.BooleanOptionalAction, default=True, help="ParaView files")
	output.add_argument(
		"--pictures",
		action=argparse.BooleanOptionalAction,
		default=True,
		help="pictures, in the report and as PNG files",
	)
	output.add_argument("--pdf", action="store_true", help="each picture as a PDF file as well")
	output.add_argument(
		"--progress",
		action=argparse.BooleanOptionalAction,
		default=True,
		help="progress bar, where the terminal can show it",
	)
	options = parser.parse_args()
	provenance.begin({name: value for name, value in vars(options).items() if name != "packings"})

	given = vars(options)
	law, density = MASS[options.convention]
	for name, value in (
		("packings", None), ("particles", None), ("bonds", None), ("box", None), ("mass_law", law),
		("density", density), ("bonded_walls", options.test == "tension"),
		("velocity", VELOCITY[options.test]), ("strain", STRAIN[options.test]),
		("rotational_viscosity", options.viscosity), ("dt", None), ("tensile_strength", None),
		("shape", "disc" if options.test == "brazilian" else "prism"), ("pressure", None), ("scatter", None)
	):
		given.setdefault(name, value)
	options.friction_angle = math.radians(options.phi) if "phi" in given else math.atan(options.tan_phi)
	check(options, parser)
	return options, parser


def check(options, parser):
	"""Complain about options that do not go together, before anything runs; what a material or a packing refuses,
	it says itself."""
	generated = ("size", "radii", "seed", "fails", "packings")
	if options.particles:
		for name in generated:
			if getattr(options, name) not in (None, parser.get_default(name)):
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
	if (options.test == "triaxial") != (options.pressure is not None):
		parser.error("argument --pressure: it belongs to --test triaxial, which needs it")
	if options.test == "brazilian" and options.shape != "disc" and not options.particles:
		parser.error("argument --shape: the Brazilian test splits a disc")
	if options.test in ("triaxial", "oedometer") and options.shape != "prism":
		parser.error(f"argument --shape: the walls of --test {options.test} enclose a prism")
	if options.convention == "esys" and options.criterion != "mohr-coulomb":
		parser.error("argument --criterion: bonds of the convention esys break by mohr-coulomb")
	if options.test == "tension" and not options.bonded_walls:
		parser.error("argument --no-bonded-walls: walls that are not bonded only push, so there is no tension")
	if options.wall_shear_stiffness and not options.bonded_walls:
		parser.error("argument --wall-shear-stiffness: only bonded walls have one; add --bonded-walls")
	if options.safety == 0:
		parser.error("argument --safety: 0 leaves no time step")
	if options.rows < uniaxial.SNAPSHOTS:
		parser.error(f"argument --rows: {options.rows} must be at least {uniaxial.SNAPSHOTS}")
	require_writable(parser, "--out", options.out)


# ---- what the report says about the test ----


def describe(options, packing, sample, critical):
	"""Rows about the sample for the report."""
	smallest, largest = (1e3 * radius for radius in (packing.radii.min(), packing.radii.max()))
	width, height, depth = 1e3 * packing.size
	material = O.materials["bonds"]
	mass = "density × 4/3 π r³" if options.mass_law == "solid" else "density × r³"
	if options.particles:
		origin = f"from {os.path.basename(options.particles)}"
	else:
		packer = "GenGeo" if options.generator == "gengeo" and options.shape == "prism" else "ddem.packing.fill"
		origin = f"packed by {packer}, seed {options.seed}, until {options.fails} insertions in a row failed"
	made = [
		(
			"spheres",
			parameter_tables.number(len(sample)),
			(
				f"radii {smallest:.3g} to {largest:.3g} mm, {100 * packing.solid_fraction:.1f} % of "
				f"the box; {origin}"
			),
		),
		("box", f"{width:.4g} × {height:.4g} × {depth:.4g} mm", "width, height, depth"),
		(
			"bonds",
			parameter_tables.number(sample.initial_bonds),
			f"{2 * sample.initial_bonds / len(sample):.1f} a sphere",
		),
		*parameter_tables.rows(material, parameter_tables.BONDED),
	]
	if options.scatter:
		made.append(
			("m", f"{options.scatter:g}", f"Weibull modulus of the bonds' strength, seed {options.seed}")
		)
	for name in CRITERIA[options.criterion][1].values():
		made.append((name.replace("_", " "), f"{getattr(options, name):g}", f"of {type(material).__name__}"))
	if options.tensile_strength:
		made.append(("f_t", f"{options.tensile_strength / 1e6:.4g} MPa", "tensile strength of the bonds"))
	if options.gradual_friction:
		made.append(
			(
				"gradual friction",
				"yes",
				"tangential forces of contacts grow gradually with the slip (eq. 7)",
			)
		)
	if any(options.contact_damping):
		made.append(
			(
				"contact damping",
				"{:g}, {:g}".format(*options.contact_damping),
				"normal and tangential, parts of the critical one (eq. 6)",
			)
		)
	made.append(("ρ", f"{material.density:.4g} kg/m³", f"density of the spheres; mass = {mass}"))
	made.append(("time step", f"{1e9 * O.dt:.3g} ns", f"{O.dt / critical:.2g} of the critical one"))
	return made


def settings(options, platens):
	moving = "each wall" if options.drive == "both" else "the upper wall, the lower stands"
	direction, peer = (
		("pull" if options.test == "tension" else "push"),
		(", as in ESyS-Particle 2.3.5" if options.convention == "esys" else ""),
	)
	rows = [
		("convention", options.convention, f"of bonds, contacts and moving walls{peer}"),
		(
			"walls",
			f"{options.velocity:g} m/s",
			f"speed of {moving}, reached after {1e6 * options.ramp:g} µs; they {direction}",
		),
		(
			"K",
			f"{options.wall_stiffness / 1e9:g} GPa",
			"stiffness of the walls, π r K for a sphere of radius r",
		),
	]
	if options.pressure:
		rows.append(("p", f"{options.pressure / 1e6:g} MPa", "pressure on the sides"))
	if options.bonded_walls:
		along = (
			f"stiffness along them {options.wall_shear_stiffness / 1e9:g} GPa"
			if options.wall_shear_stiffness
			else "free to slide along them"
		)
		rows.append(("ends", "bonded", f"spheres within 1.1 radii of a wall are bonded to it, {along}"))
	strain = f"{100 * options.strain:g} %"
	until = (
		(f"{100 * options.stop:g} % of the peak", f"or a strain of {strain}")
		if options.stop
		else (strain, "of strain")
	)
	return rows + [
		("A", f"{1e6 * platens.area:.4g} mm²", "loaded face"),
		(
			"viscosity",
			f"{options.viscosity:g}, {options.rotational_viscosity:g} /s",
			"of translation and rotation",
		),
		("end of the test", *until),
	]


def waves(platens, run):
	"""Density of the sample as a whole, and the speed of a wave along it, √(E/ρ), for the summary."""
	density = sum(O.bodies[int(i)].state.mass for i in platens.sample.ids) / (platens.area * platens.height)
	return {
		"sample_density_kg_m3": density,
		"wave_speed_m_s": math.sqrt(run.strength.young / density) if run.strength.young > 0 else None,
	}


def notes(options, platens, run, closing):
	said = []
	wave = run.extra["wave_speed_m_s"]
	if wave:
		said.append(
			f"Rate. The sample has {parameter_tables.number(round(run.extra['sample_density_kg_m3']))} "
			f"kg/m³ as a whole, so that a wave runs along it at about √(E/ρ) = {wave:.0f} m/s, "
			f"{parameter_tables.number(round(wave / options.velocity))} times as fast as a wall, and "
			f"needs {1e6 * platens.height / wave:.1f} µs from end to end, in which the strain grows by "
			f"{100 * closing / wave:.3f} %. Where the two wall forces differ, the test is not quasi-static."
		)
	if options.convention == "esys":
		said.append(
			"ESyS-Particle's bonds have half the bending moment EI/d₀, the sum of the radii as rest "
			"length, and moment arms that are not conservative for unequal radii, so the energy book does "
			"not close exactly. Bonds between spheres with a gap g start with the stress E g/d₀, and "
			"break at once where it exceeds their strength."
		)
	if options.test == "triaxial":
		said.append(
			f"Triaxial. A pressure of {options.pressure / 1e6:g} MPa on all sides grows over "
			f"{1e6 * options.pressure_ramp:g} µs; then the walls on the sides keep it by servo while the "
			"platens approach. The stress is the whole axial one, strain counts from the start."
		)
	if options.test == "oedometer":
		said.append(
			"Oedometer. The walls on the sides stand still; the modulus is that of one-dimensional "
			"compression."
		)
	if options.test == "brazilian":
		said.append(
			"Brazilian. The stress is 2 P/(π D L), which a disc of diameter D and length L has across its "
			"loaded diameter while it is elastic, so the strength is its tensile strength; the modulus "
			"has no meaning as a modulus of the material."
		)
	if options.test == "compression":
		said.append(
			"Stress is the mean of both walls (eq. 9). The script in the tutorial of ESyS-Particle "
			"divides by A instead of 2A, and so gives stresses, strengths and moduli twice as high."
		)
	return said


def versions():
	import matplotlib
	import numpy
	from vtkmodules.vtkCommonCore import vtkVersion
	return {**commandline.versions(numpy, matplotlib), "VTK": vtkVersion.GetVTKVersion()}


if __name__ == "__main__":
	main()
