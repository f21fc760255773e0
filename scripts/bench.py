# GPL v2 or later, see LICENSE.
"""Speed of the plugin's engines beside YADE's own, measured in one run.

Run:     scripts/ddem bench        (or: scripts/ddem run scripts/bench.py [--quick] [--triangles N …])
Shows:   nanoseconds per triangle-step, per bond-step and per body-step of each engine, median of several repeats,
         on one thread unless OMP_NUM_THREADS says otherwise.
Takes:   about three minutes; --quick half a minute.
Expect:  elastic triangles at a small multiple of memory speed, well below the 122-196 ns that the same bodies cost when
         NewtonIntegrator moves them; ratios between rows hold from machine to machine, absolute times do not.
"""
import argparse
import statistics
import sys
import warnings

import numpy as np
from yade import ddem, timing

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument(
	"--triangles", type=int, nargs="+", default=[13000, 130000],
	help="sizes of the deformable samples (default: %(default)s)"
)
parser.add_argument(
	"--spheres", type=int, nargs="+", default=[900, 6000, 24000],
	help="sizes of the bonded samples (default: %(default)s)"
)
parser.add_argument(
	"--repeats", type=int, default=5, help="measurements of each row; the median is printed (default: %(default)s)"
)
parser.add_argument("--quick", action="store_true", help="small samples, few repeats")
options = parser.parse_args(sys.argv[1:])
if options.quick:
	options.triangles, options.spheres, options.repeats = [3200], [900], 3
if min(options.triangles) < 8 or min(options.spheres) < 100 or options.repeats < 1:
	parser.error("--triangles must be at least 8, --spheres at least 100 and --repeats at least 1")


def measure(engine, count, steps):
	"""Median nanoseconds per item and step of an engine (None: of the whole step)."""
	O.timingEnabled = True
	O.run(max(2, steps // 10), True)  # first touch, assembly
	samples = []
	for _ in range(options.repeats):
		timing.reset()
		O.run(steps, True)
		chosen = O.engines if engine is None else [engine]
		samples.append(sum(e.execTime for e in chosen) / steps / count)
	return statistics.median(samples)


def row(name, item, count, nanoseconds):
	print(f"{name:<58}{count:>9} {item:<10}{nanoseconds:>9.1f} ns", flush=True)


def deformable(count, material, rotation, energy=False):
	"""A block of about `count` triangles that vibrates (elastic) or is crushed (concrete)."""
	O.reset()
	O.materials.append(material)
	cells = round((count / 8)**0.5)
	block = ddem.append(
		ddem.mesh.rectangle(width=0.10, height=0.20, nx=cells, ny=2 * cells, pattern="crossed"), material
	)
	block.hold(block.boundary("bottom"))
	block.drive(block.boundary("top"), (0, -10))
	# all of it is strained from the first step on: a law skips what is at rest
	block.velocities = np.column_stack([0 * block.positions[:, 0], -10 * block.positions[:, 1] / 0.20])
	engine = DeformableEngine(rotation=rotation)
	O.engines = [ForceResetter(), engine]
	O.trackEnergy = energy
	O.dt = ddem.time_step(0.5)
	return engine, len(block.triangle_ids)


print(f"{'engine':<58}{'items':>9} {'':<10}{'per step':>12}")
for size in options.triangles:
	steps = max(20, 2_000_000 // size)
	for rotation in ("none", "corotational", "cosserat"):
		engine, count = deformable(size, DeformableElastMat(bulk=30e9, shear=26e9, density=2400), rotation)
		row(
			f"DeformableEngine, elastic, rotation {rotation}",
			"triangles",
			count,
			measure(engine, count, steps),
		)
	O.engines = [O.engines[0], PyRunner(command="pass", iterPeriod=1), O.engines[1]]
	row("whole step with an idle PyRunner, elastic, cosserat", "triangles", count, measure(None, count, steps))
	engine, count = deformable(
		size, DeformableElastMat(bulk=30e9, shear=26e9, density=2400), "cosserat", energy=True
	)
	row("DeformableEngine, elastic, cosserat, energy book", "triangles", count, measure(engine, count, steps))
	engine, count = deformable(size, ConcreteDamageMat(), "cosserat")
	row("DeformableEngine, concrete, cosserat", "triangles", count, measure(engine, count, max(20, steps // 5)))

	O.reset()
	for i in range(size):
		O.bodies.append(utils.sphere((i % 100, i // 100, 0), 0.4))
	newton = NewtonIntegrator(damping=0)
	O.engines = [ForceResetter(), newton]
	O.dt = 1e-9
	row("NewtonIntegrator (YADE), free spheres", "bodies", size, measure(newton, size, max(20, steps // 5)))


def bonded(packing, convention="consistent", half=False):
	"""Bonded spheres that vibrate at a tenth of a metre a second; with *half* every second pair that touches has no
	bond, but friction."""
	O.reset()
	O.materials.append(BondedMat(label="rock", density=2600, cohesion=1e15))
	pairs = packing.neighbours(0.0025 * packing.radii.max())
	if half:
		packing = ddem.packing.Packing(packing.centres, packing.radii, packing.lower, packing.upper, pairs[::2])
	with warnings.catch_warnings(action="ignore"):  # of pieces
		sample = ddem.bonded.append(packing, "rock")
	draw = np.random.default_rng(1)
	middle = 0.5 * (packing.lower + packing.upper)
	for i, centre in zip(sample.ids.tolist(), packing.centres):
		inwards = 20 * (middle - centre) if half else 0  # so that those without a bond stay in contact
		O.bodies[i].state.vel = Vector3(*(inwards + draw.uniform(-0.1, 0.1, 3)))
	O.engines = ddem.bonded.engines(convention=convention)
	O.dt = ddem.bonded.time_step(0.1 if half else 0.3)
	return sample


def jointed(packing):
	"""The same spheres with bonds of YADE's jointed cohesive frictional particle model,
	and the loop of its bonds."""
	O.reset()
	O.materials.append(
		JCFpmMat(young=1e11, poisson=0.2, cohesion=1e15, tensileStrength=1e15, frictionAngle=0.7, density=2600)
	)
	for centre, radius in zip(packing.centres, packing.radii):
		O.bodies.append(utils.sphere(centre, radius))
	loop = InteractionLoop(
		[Ig2_Sphere_Sphere_ScGeom(interactionDetectionFactor=1.01)],
		[Ip2_JCFpmMat_JCFpmMat_JCFpmPhys(cohesiveTresholdIteration=1)],
		[Law2_ScGeom_JCFpmPhys_JointedCohesiveFrictionalPM()]
	)
	O.engines = [
		ForceResetter(),
		InsertionSortCollider([Bo1_Sphere_Aabb(aabbEnlargeFactor=1.01)]),
		loop,
		NewtonIntegrator(damping=0),
	]
	O.dt = 1e-9
	O.run(1, True)
	return loop


def one_by_one():
	"""Puts YADE's InteractionLoop in the place of ours."""
	loop = O.engines[2]
	functors = (loop.geomDispatcher.functors, loop.physDispatcher.functors, loop.lawDispatcher.functors)
	O.engines = O.engines[:2] + [InteractionLoop(*functors)] + O.engines[3:]


for size in options.spheres:
	width = (size / 1.05e8)**(1 / 3)  # of a packing with so many spheres
	spheres = ddem.packing.prism(width, 2 * width, width, rmin=1e-3, rmax=2e-3, seed=1, fails=200)
	steps = max(20, 1_000_000 // size)
	for convention in ("consistent", "esys"):
		sample = bonded(spheres, convention)
		count = len(sample.bonds)
		row(f"BondedInteractionLoop, {convention}", "bonds", count, measure(O.engines[2], count, steps))
		if convention == "consistent":
			row("whole step of bonded spheres", "spheres", len(sample), measure(None, len(sample), steps))
			O.engines = O.engines[:-1] + [NewtonIntegrator(damping=0)]
			row(
				"whole step with YADE's NewtonIntegrator", "spheres", len(sample),
				measure(None, len(sample), steps // 2)
			)
	sample = bonded(spheres, half=True)
	taken = measure(None, len(sample), steps // 2)
	touching = sum(1 for i in O.interactions if i.isReal and not i.phys.bonded)
	row(
		f"whole step, half of the bonds, {touching / len(sample):.1f} contacts a sphere", "spheres",
		len(sample), taken
	)
	sample = bonded(spheres)
	one_by_one()
	count = len(sample.bonds)
	row("InteractionLoop, our bonds one by one", "bonds", count, measure(O.engines[2], count, steps // 5))
	loop = jointed(spheres)
	count = O.interactions.countReal()
	row("InteractionLoop, JCFpm bonds (YADE; normal and shear)", "bonds", count, measure(loop, count, steps // 5))
	row("whole step of JCFpm spheres (YADE)", "spheres", len(spheres), measure(None, len(spheres), steps // 5))
