# GPL v2 or later, see LICENSE.
# needs: esys-particle
"""Crush the same sample of bonded spheres in ESyS-Particle and here, with the same parameters,
and compare results and cost.

Run:      scripts/ddem run scripts/compare_esys.py              (half a minute;
                                                                installs Debian's esys-particle the first time,
                                                                300 MB to download)
          scripts/ddem run scripts/compare_esys.py --threads 2  (two threads here, two workers and a master there)
          scripts/ddem run scripts/compare_esys.py --particles P.csv --bonds B.csv --length-unit mm
          scripts/ddem run scripts/compare_esys.py --help       (all options)
Writes:   a table here, and in out/compare_esys: summary.json, comparison.png, esys.csv and yade.csv with both curves,
          esys/ with input and output of the peer.

The test is that of ESyS-Particle's tutorial, which the paper of rigid bonded particles follows: a prism of 10 mm
x 20 mm x 10 mm between two elastic walls that move towards each other at 0.125 m/s each. With --convention esys, the
default, our bonds, contacts, walls and damping do what ESyS-Particle does, peculiarities included.

Both programs are timed alike: wall time of all steps but the first, recording included, set-up and start left out;
with --repeats, each piece from record to record counts where it was fastest, so that what else the machine does
disturbs little. ESyS-Particle calculates with worker processes beside a master that waits busily: with one worker it
keeps two cores busy, and our program one.

Expect:   stresses equal to 1e-4 MPa up to the first bond that breaks one step apart, at half the strength or later:
          ESyS-Particle's angles carry noise of 1e-8, which a bond close to its strength feels. From there on the test
          is chaotic, and the curves part slowly. Strength and Young's modulus agree to 1 % and 0.2 %.
"""
import argparse
import math
import os
import sys
import time

from tqdm import tqdm

from yade import ddem, timing
from yade.ddem import meter, plots, provenance
from yade.ddem.studies import commandline, runs
from yade.ddem.studies.commandline import count, not_negative, positive, require_writable, seed
from yade.ddem.studies.esys import comparison

SIZE = (0.010, 0.020, 0.010)  # of a prism made here [m]
BUSY = 0.5  # load of the machine from which it is said that the times are not to be trusted
GAP = 5e-6  # up to which spheres are bonded [m]: the tutorial's 0.005 mm


def main():
	options = read_options()
	commandline.restart(options.threads)
	try:
		setup = read_setup(options)
	except (OSError, ValueError) as error:
		stop(error)
	print(
		f"{len(setup.packing)} spheres, {len(setup.packing.bonds)} bonds, {setup.steps} steps of "
		f"{1e6 * setup.dt:g} µs"
	)
	load = os.getloadavg()[0]
	theirs, ours = [], []
	for _ in range(options.repeats):  # in turn, so that a machine that others use as well disturbs both alike
		theirs.append(run_esys(setup, options))
		ours.append(run_here(setup, options))
	report(ddem.esys.undisturbed(theirs), ddem.esys.undisturbed(ours), options)
	if load > BUSY:
		print(
			f"Other programs were busy on this machine when the runs began (load {load:.1f}): the times "
			"say little."
		)


# ---- the test in both programs ----


def read_setup(options):
	"""The test that both programs get."""
	if options.particles:
		packing = ddem.packing.read(options.particles, options.bonds, options.length_unit)
	else:
		packing = ddem.packing.prism(*options.size, *options.radii, seed=options.seed, fails=options.fails)
	if packing.bonds is None:
		packing.bonds = packing.neighbours(options.gap)
	return ddem.esys.Setup(
		packing, dt=options.dt, steps=options.steps, every=options.every,
		ramp_steps=round(options.ramp / options.dt), speed=options.velocity,
		wall_stiffness=options.wall_stiffness, young=options.young, poisson=options.poisson,
		cohesion=options.cohesion, bond_friction=options.tan_phi,
		friction_static=options.friction[0], friction_dynamic=options.friction[1], viscosity=options.viscosity,
		density=options.density,
		mass_law=options.mass_law
	)


def run_esys(setup, options):
	with tqdm(
		total=setup.steps, unit="step", desc="ESyS-Particle", disable=None if options.progress else True
	) as bar:
		try:
			return ddem.esys.run(
				setup,
				os.path.join(options.out, "esys"),
				options.workers,
				progress=lambda step: bar.update(step - bar.n),
			)
		except RuntimeError as error:
			stop(error)


def run_here(setup, options):
	"""The same test in YADE, with this plugin."""
	O.reset()
	O.materials.append(
		BondedMat(
			label="bonds", young=setup.young, poisson=setup.poisson, cohesion=setup.cohesion,
			bondFrictionAngle=math.atan(setup.bond_friction),
			frictionStatic=setup.friction_static, frictionDynamic=setup.friction_dynamic,
			density=setup.density
		)
	)
	sample = ddem.bonded.append(setup.packing, "bonds", mass_law=setup.mass_law)
	platens = ddem.bonded.platens(
		sample, setup.speed, ramp=setup.ramp_steps * setup.dt, stiffness=setup.wall_stiffness
	)
	O.engines = ddem.bonded.engines(platens, viscosity=setup.viscosity, convention=options.convention)
	O.dt = setup.dt
	ddem.bonded.check()
	O.timingEnabled = True
	record = ddem.esys.Record("YADE with this plugin", setup, threads=O.numThreads)

	def note(step, strain):
		record.series.append(
			time=step * setup.dt, strain=strain, stress=platens.stress, force_top=platens.force_top,
			force_bottom=platens.force_bottom,
			broken=ddem.bonded.law().brokenCount()
		)

	with tqdm(
		total=setup.steps, unit="step", desc="YADE", mininterval=0.5, disable=None if options.progress else True
	) as bar:
		note(0, platens.strain)
		for step in range(1, setup.steps + 1):
			recorded = step % setup.every == 0
			if recorded:
				# of the walls as the forces of this step see them; its end moves them on
				strain = platens.strain
			O.step()
			if step == 1:
				# the first makes the lists of neighbours, as in ESyS-Particle
				timing.reset()
				record.bytes_per_particle = meter.bytes_per_particle()
				clock, busy = time.perf_counter(), time.process_time()
			if recorded:
				note(step, strain)
				bar.update(setup.every)
				record.pieces.append(time.perf_counter() - clock)
				clock += record.pieces[-1]
	record.busy = time.process_time() - busy
	taken = [(e.label or type(e).__name__, 1e-9 * e.execTime, e.execCount) for e in O.engines]
	record.engines = runs.engine_costs(taken, (setup.steps - 1) * len(setup.packing))
	record.effects = ddem.effects().rows()
	return record


def stop(reason):
	sys.exit(f"compare_esys.py: {reason}")


# ---- what comes out ----


def report(theirs, ours, options):
	theirs.series.write(os.path.join(options.out, "esys.csv"))
	ours.series.write(os.path.join(options.out, "yade.csv"))
	picture = os.path.join(options.out, "comparison.png")
	plots.save(comparison.picture(theirs, ours), picture)
	setup = theirs.setup
	summary = {
		"command": commandline.command(),
		"options": commandline.plain(options),
		"versions": {**commandline.versions(), "ESyS-Particle": ddem.esys.version()},
		"particles": len(setup.packing),
		"bonds": len(setup.packing.bonds),
		"esys": comparison.figures(theirs),
		"yade": comparison.figures(ours),
		"differences": comparison.differences(theirs, ours),
		"time_ratio_yade_to_esys": ours.nanoseconds / theirs.nanoseconds,
		"engines": runs.plain_costs(ours.engines),
		"effects": ours.effects,
	}
	provenance.write_json(os.path.join(options.out, "summary.json"), summary, indent="\t")
	print(f"\n{comparison.table(theirs, ours)}\n\nWritten to {options.out}")
	steps, count = setup.steps - 1, len(setup.packing)
	print(meter.line("sphere", steps, steps * count, ours.busy, count, count))


# ---- options ----


def read_options():
	defaults = ddem.esys.Setup
	parser = argparse.ArgumentParser(
		prog="scripts/ddem run scripts/compare_esys.py",
		usage="%(prog)s [options]",
		formatter_class=argparse.ArgumentDefaultsHelpFormatter,
		allow_abbrev=False,
		description=(
			"Crush the same sample of bonded spheres in ESyS-Particle and in YADE with this plugin, and "
			"compare results and cost."
		),
		epilog=(
			"SI units, but for the files of a sample, which have --length-unit. The walls start at the "
			"box around the spheres."
		),
	)
	run = parser.add_argument_group("run")
	run.add_argument(
		"--out",
		default=os.path.join("out", "compare_esys"),
		metavar="DIR",
		help="folder for all files, made when missing; replaces older ones",
	)
	run.add_argument(
		"--repeats",
		type=count,
		default=1,
		metavar="N",
		help="runs of each program, for the time; the results are the same",
	)
	run.add_argument("--threads", type=count, default=O.numThreads, metavar="N", help="of our run")
	run.add_argument(
		"--workers",
		type=count,
		metavar="N",
		help="processes that calculate in ESyS-Particle (default: as many as --threads)",
	)
	run.add_argument(
		"--convention",
		choices=("esys", "consistent"),
		default="esys",
		help="our bonds: the same as ESyS-Particle's, or their improved version",
	)
	run.add_argument(
		"--progress",
		action=argparse.BooleanOptionalAction,
		default=True,
		help="progress bars, where the terminal can show them",
	)
	sample = parser.add_argument_group("sample")
	sample.add_argument(
		"--particles",
		metavar="CSV",
		help="spheres from a file with the columns id,x,y,z,r, instead of a packing made here",
	)
	sample.add_argument("--bonds", metavar="CSV", help="bonds from a file with the columns i,j")
	sample.add_argument("--length-unit", choices=ddem.packing.UNITS, default="m", help="of --particles")
	sample.add_argument(
		"--gap", type=not_negative, default=GAP, metavar="M",
		help="without --bonds: spheres closer than this are bonded"
	)
	sample.add_argument(
		"--size", type=positive, nargs=3, default=SIZE, metavar=("W", "H", "D"),
		help="width, height and depth of the packing made here"
	)
	sample.add_argument(
		"--radii", type=positive, nargs=2, default=(0.4e-3, 2e-3), metavar=("MIN", "MAX"),
		help="range of its spheres' radii"
	)
	sample.add_argument("--seed", type=seed, default=1, help="draws the packing")
	sample.add_argument(
		"--fails", type=count, default=5000, metavar="N",
		help="the packing is finished when so many spheres in a row found no place"
	)
	test = parser.add_argument_group("test")
	test.add_argument("--steps", type=count, default=25000, metavar="N", help="time steps, a multiple of --every")
	test.add_argument(
		"--dt", type=positive, default=1e-8, metavar="S",
		help="time step; the tutorial's 1e-9 s gives the same curve"
	)
	test.add_argument("--every", type=count, default=25, metavar="N", help="steps between two records")
	test.add_argument("--velocity", type=positive, default=defaults.speed, metavar="M/S", help="of each wall")
	test.add_argument(
		"--ramp", type=not_negative, default=5e-5, metavar="S",
		help="time over which the walls reach their velocity"
	)
	test.add_argument(
		"--wall-stiffness", type=positive, default=defaults.wall_stiffness, metavar="PA",
		help="K; a sphere of radius r feels the spring pi r K"
	)
	test.add_argument(
		"--viscosity", type=not_negative, default=defaults.viscosity, metavar="1/S", help="of the body damping"
	)
	bonds = parser.add_argument_group("bonds and contacts")
	bonds.add_argument("--young", type=positive, default=defaults.young, metavar="PA", help="Young's modulus")
	bonds.add_argument("--poisson", type=float, default=defaults.poisson, help="Poisson's ratio")
	bonds.add_argument(
		"--cohesion", type=positive, default=defaults.cohesion, metavar="PA",
		help="C, shear strength of a bond without normal stress"
	)
	bonds.add_argument(
		"--tan-phi",
		type=positive,
		default=defaults.bond_friction,
		help="tangent of the friction angle in the strength of bonds",
	)
	bonds.add_argument(
		"--friction",
		type=not_negative,
		nargs=2,
		default=(defaults.friction_static, defaults.friction_dynamic),
		metavar=("STATIC", "DYNAMIC"),
		help="coefficients of contacts between spheres that are not bonded",
	)
	bonds.add_argument(
		"--density", type=positive, default=defaults.density, metavar="KG/M3",
		help="of the spheres, see --mass-law"
	)
	bonds.add_argument("--mass-law", choices=("cube", "solid"), default=defaults.mass_law,
		help="mass of a sphere: density times r³, ESyS-Particle's default, or times 4/3 pi r³")
	options = parser.parse_args()
	provenance.begin(vars(options))
	if options.bonds and not options.particles:
		parser.error("argument --bonds: a file of bonds goes with a file of particles; add --particles")
	if options.steps % options.every:
		parser.error(
			f"argument --steps: {options.steps} is no multiple of --every {options.every}, so the last "
			"step would not be recorded"
		)
	require_writable(parser, "--out", options.out)
	options.workers = options.workers or options.threads
	return options


if __name__ == "__main__":
	main()
