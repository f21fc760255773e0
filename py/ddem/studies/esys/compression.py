# GPL v2 or later, see LICENSE.
"""Uniaxial compression of bonded spheres in ESyS-Particle 2.3.5: its side of scripts/compare_esys.py.

An input script of ESyS-Particle, not of YADE; package yade.ddem.studies.esys writes its files, runs it and reads what
it leaves. By hand, in the folder of the files::

	mpirun -n 2 esysparticle compression.py          # one master, the other processes are workers

Reads   parameters.json    see package yade.ddem.studies.esys; here all in mm, N, ms, and so g and MPa
        particles.csv      id,x,y,z,r
        bonds.csv          i,j
Writes  position.dat, force.dat  six numbers a row for bottom and top wall, at the start and after every so many steps
        bonds.dat                number of bonds, the same; ESyS-Particle appends to such files: they must not exist
        finished.json            "pieces": wall time from record to record without the first step, in s

Prints "step N" now and then.

The model is that of the tutorial of ESyS-Particle (Weatherley et al.): bonds of class BrittleBeam, rotational friction
between spheres that are not bonded, elastic walls that move towards each other with a speed that is ramped up linearly,
viscous body damping.
"""
import csv
import ctypes
import importlib.util
import json
import math
import os
import sys
import time
import traceback

BOND_TAG = 1
WALLS = ("bottom", "top")
REPORTS = 200  #: how often the progress is printed


def ramped_step(step, speed, dt, ramp_steps):
	"""How far a wall moves in a step (1, 2, …), as in the tutorial's WallLoader: its speed grows by the same amount
	in each of the first ramp_steps steps."""
	return speed * dt * (min((step - 1) / ramp_steps, 1.0) if ramp_steps else 1.0)


def mass(radius, density, law):
	"""Of a sphere; law "cube": density r³, what ESyS-Particle has for a sphere of density 1 unless told otherwise;
	"solid": of a full sphere."""
	return density * radius**3 * {"cube": 1.0, "solid": 4 / 3 * math.pi}[law]


def rows(path, names, kinds):
	with open(path, newline="") as file:
		lines = [line for line in file if not line.startswith("#")]
		return [tuple(kind(row[name]) for name, kind in zip(names, kinds)) for row in csv.DictReader(lines)]


def simulation(parameters, particles, bonds):
	"""The whole model, ready to run."""
	from esys.lsm import (
		BrittleBeamPrms, FrictionPrms, InteractionScalarFieldSaverPrms, LinDampingPrms, LsmMpi,
		NRotElasticWallPrms, RotDampingPrms, RotSphere, Runnable, WallVectorFieldSaverPrms
	)
	from esys.lsm.util import BoundingBox, Vec3
	# Debian's package does not tell the loader where this library of esys.lsm.geometry is.
	ctypes.CDLL(
		os.path.join(
			importlib.util.find_spec("esys.lsm.geometry").submodule_search_locations[0],
			"libGeometryPy.so.0",
		)
	)
	from esys.lsm.geometry import TaggedIdConnection
	p = parameters

	class WallLoader(Runnable):
		"""Moves both walls before the forces of a step are calculated."""

		def run(self):
			step = sim.getTimeStep()
			way = ramped_step(step, p["speed"], p["dt"], p["ramp_steps"])
			sim.moveWallBy("bottom", Vec3(0, way, 0))
			sim.moveWallBy("top", Vec3(0, -way, 0))

	# Slabs of equal height: the domain is centred on the sample.
	sim = LsmMpi(numWorkerProcesses=p["workers"], mpiDimList=[1, p["workers"], 1])
	sim.initNeighborSearch(particleType="RotSphere", gridSpacing=p["grid_spacing"], verletDist=p["verlet_distance"])
	sim.setNumTimeSteps(p["steps"])
	sim.setTimeStepSize(p["dt"])
	sim.setSpatialDomain(BoundingBox(Vec3(*p["domain"][0]), Vec3(*p["domain"][1])))

	for number, x, y, z, radius in particles:
		sim.createParticle(RotSphere(number, Vec3(x, y, z), radius, mass(radius, p["density"], p["mass_law"])))
	sim.createConnections([TaggedIdConnection(min(pair), max(pair), BOND_TAG) for pair in bonds])
	for wall, place, sense in zip(WALLS, p["walls"], (1, -1)):
		sim.createWall(name=wall, posn=Vec3(0, place, 0), normal=Vec3(0, sense, 0))

	sim.createInteractionGroup(
		BrittleBeamPrms(
			name="bonds", youngsModulus=p["young"], poissonsRatio=p["poisson"], cohesion=p["cohesion"],
			tanAngle=p["bond_friction"], tag=BOND_TAG
		)
	)
	sim.createInteractionGroup(
		FrictionPrms(
			name="friction", youngsModulus=p["young"], poissonsRatio=p["poisson"],
			dynamicMu=p["friction_dynamic"], staticMu=p["friction_static"]
		)
	)
	sim.createExclusion(interactionName1="bonds", interactionName2="friction")
	for wall in WALLS:
		sim.createInteractionGroup(
			NRotElasticWallPrms(name=wall + " repulsion", wallName=wall, normalK=p["wall_stiffness"])
		)
	if p["viscosity"]:
		# Last: it damps the sum of all other forces.
		sim.createInteractionGroup(LinDampingPrms(name="damping", viscosity=p["viscosity"], maxIterations=50))
		sim.createInteractionGroup(
			RotDampingPrms(name="rotational damping", viscosity=p["viscosity"], maxIterations=50)
		)

	when = {"beginTimeStep": 0, "endTimeStep": p["steps"], "timeStepIncr": p["every"]}
	for name, field in (("position.dat", "Position"), ("force.dat", "Force")):
		sim.createFieldSaver(
			WallVectorFieldSaverPrms(
				wallName=list(WALLS), fieldName=field, fileName=name, fileFormat="RAW_SERIES", **when
			)
		)
	sim.createFieldSaver(
		InteractionScalarFieldSaverPrms(
			interactionName="bonds", fieldName="count", fileName="bonds.dat", fileFormat="SUM", **when
		)
	)
	loader = WallLoader()
	sim.addPreTimeStepRunnable(loader)
	return sim, loader  # the simulation keeps no reference to the loader


def main():
	with open("parameters.json") as file:
		parameters = json.load(file)
	sim, loader = simulation(
		parameters,
		rows("particles.csv", "id x y z r".split(), (int, float, float, float, float)),
		rows("bonds.csv", "ij", (int, int)),
	)
	steps = parameters["steps"]
	sim.runTimeStep()  # the first makes tables of neighbours and bonds as well
	clock = [time.perf_counter()]
	for step in range(2, steps + 1):
		sim.runTimeStep()
		if step % parameters["every"] == 0:
			clock.append(time.perf_counter())
		if step % max(1, steps // REPORTS) == 0:
			print("step", step, flush=True)
	sim.exit()
	with open("finished.json", "w") as file:
		json.dump({"pieces": [end - start for start, end in zip(clock, clock[1:])]}, file)


if __name__ == "__main__":
	try:
		main()
	except BaseException:
		# also KeyboardInterrupt: the workers would wait for the master for ever, so the whole job is ended
		traceback.print_exc()
		sys.stdout.flush()
		os._exit(1)
