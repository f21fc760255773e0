# GPL v2 or later, see LICENSE.
"""Samples of bonded spheres as scripts make them from options: packed or read, of one of the criteria by which bonds
break."""
import math

import numpy as np

from yade import BondedMat, O, ParallelBondMat, SofteningBondMat

from .. import bonded
from .. import packing as packings
from .bonded_tests import TESTS

#: law and density [kg/m³] of the mass of spheres in each convention, unless told otherwise
MASS = {"consistent": ("solid", 2600.0), "esys": ("cube", 1e6)}
#: material of each criterion by which bonds break, and its options
CRITERIA = {
	"mohr-coulomb": (BondedMat, {}),
	"parallel": (ParallelBondMat, {"momentContribution": "moment_contribution"}),
	"softening": (SofteningBondMat, {"tensionEnergy": "tension_energy", "shearEnergy": "shear_energy"}),
}


def read_packing(options):
	"""The spheres, and their bonds where a file lists them."""
	if options.particles is None and options.shape != "prism":
		width, height, _ = options.size
		if options.shape == "cylinder":
			body = packings.Cylinder((0, 0, 0), (0, height, 0), width / 2)
		else:
			body = TESTS[options.test].disc(options)
		return packings.fill(body, *options.radii, seed=options.seed, fails=options.fails)
	if options.particles is None:
		return packings.prism(
			*options.size, *options.radii, seed=options.seed, fails=options.fails, keep=options.packings,
			generator=options.generator
		)
	packing = packings.read(options.particles, options.bonds, options.length_unit)
	if options.box:
		packing.lower, packing.upper = np.array(options.box[:3], float), np.array(options.box[3:], float)
	return packing


def append(options, packing):
	"""Spheres and bonds of a packing in the scene, of the material "bonds" that the options say;
	a :class:`bonded.BondedSample`."""
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
	return bonded.append(
		packing, "bonds", gap=None if packing.bonds is not None else options.gap, mass_law=options.mass_law,
		scatter=bonded.Weibull(options.scatter, options.seed) if options.scatter else None
	)


def waves(sample, run):
	"""Density of a sample as a whole, and the speed of a wave along it, √(E/ρ), for the summary; None where the
	test measures no modulus.

	:param run: the finished :class:`runs.Run`
	"""
	density = sum(O.bodies[int(i)].state.mass for i in sample.ids) / sample.volume
	young = run.strength.young if run.wording.modulus == "young_GPa" else 0
	return {
		"sample_density_kg_m3": density,
		"wave_speed_m_s": math.sqrt(young / density) if young > 0 else None,
	}
