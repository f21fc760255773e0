# GPL v2 or later, see LICENSE.
"""Parallel bonds, materials between others, and scatter of strength."""
import math

import numpy as np
import pytest

from yade import BondedInteractionLoop, BondedMat, InteractionLoop, O, ParallelBondMat, Vector3, ddem, utils
from yade import Law2_ScGeom_BondedPhys_MohrCoulomb, SofteningBondMat
from yade.ddem.energy import EnergyBalance


def specimen(material, test, **more):
	"""Strength [Pa] of a small prism of spheres."""
	O.reset()
	O.materials.append(material)
	packing = ddem.packing.prism(0.01, 0.02, 0.01, 0.8e-3, 2e-3, seed=2, fails=500)
	sample = ddem.bonded.append(packing, material.label, **more)
	speed = 0.2 if test == "compression" else -0.05
	platens = ddem.bonded.platens(sample, velocity=speed, ramp=5e-6, bonded=test == "tension")
	O.engines = ddem.bonded.engines(platens)
	O.dt = ddem.bonded.time_step(0.8)
	largest = 0.0
	while abs(platens.strain) < 5e-3:
		O.run(100, True)
		largest = max(largest, abs(platens.stress))
		if abs(platens.stress) < 0.5 * largest:
			break
	return largest, sample


def test_compression_over_tension_is_free():
	"""Mohr-Coulomb bonds give 2 to 3.7 whatever their parameters (scripts/calibrate.py); rock has 10 and more.
	Moments that do not break bonds, and shear strength above that in tension,
	lead from 2.8 to 6.8 in this small sample."""
	ratios = []
	for shear, moments in ((30e6, 1), (240e6, 0)):
		material = lambda: ParallelBondMat(
			label="rock", young=50e9, tensileStrength=20e6, cohesion=shear, momentContribution=moments
		)
		ratios.append(specimen(material(), "compression")[0] / specimen(material(), "tension")[0])
	assert ratios[0] < 3.2 and ratios[1] > 6


def test_radius_factor_scales_stiffness_as_its_square():
	O.reset()
	O.materials.append(ParallelBondMat(label="rock", young=50e9, radiusFactor=0.5))
	packing = ddem.packing.Packing([(0, 0, 0), (5e-3, 0, 0)], [2e-3, 3e-3])
	ddem.bonded.append(packing, "rock", gap=1e-6)
	phys = O.interactions[0, 1].phys
	assert phys.bondRadius == pytest.approx(1e-3, rel=1e-12)
	assert phys.kn == pytest.approx(50e9 * math.pi * 1e-6 / 5e-3, rel=1e-12)
	assert phys.kb == pytest.approx(50e9 * math.pi * 1e-12 / 4 / 5e-3, rel=1e-12)
	assert phys.strength == {"tension": 30e6, "cohesion": 100e6, "friction": 0.0, "moments": 1.0}


def test_thin_bonds_leave_contacts_that_the_time_step_knows():
	"""Bonds of 0.3 of the radius are eleven times as soft as the contacts that they leave."""
	O.reset()
	O.materials.append(
		ParallelBondMat(label="rock", young=50e9, radiusFactor=0.3, tensileStrength=1e6, cohesion=2e6)
	)
	shape = ddem.packing.Ball((0, 0, 0), 8e-3)
	sample = ddem.bonded.append(ddem.packing.fill(shape, 0.8e-3, 2e-3, seed=2, fails=300), "rock")
	for i in sample.ids:
		state = O.bodies[i].state
		state.vel = Vector3(-10 if state.pos[0] > 0 else 10, 0, 0)
	O.engines = ddem.bonded.engines()
	O.dt = ddem.bonded.time_step(0.8)
	book = EnergyBalance()
	O.run(500, True)
	assert sample.broken_fraction > 0.3
	assert O.dt < ddem.bonded.critical_time_step()
	assert book.error < 0.02


def row_of_three(first, second, third, **between):
	O.reset()
	for material in (first, second, third):
		if material:
			O.materials.append(material)
	packing = ddem.packing.Packing([(0, 0, 0), (2e-3, 0, 0), (4e-3, 0, 0)], [1e-3] * 3)
	return ddem.bonded.append(packing, ["stone", "stone", "mortar"], gap=1e-6, **between)


def stone(**more):
	return BondedMat(**{**dict(label="stone", young=80e9, cohesion=120e6, frictionDynamic=0.5), **more})


def mortar(**more):
	return BondedMat(**{**dict(label="mortar", young=30e9, cohesion=40e6), **more})


def test_where_two_materials_meet_the_weaker_counts():
	row_of_three(stone(), mortar(), None)
	same, other = O.interactions[0, 1].phys, O.interactions[1, 2].phys
	assert (same.young, same.strength["cohesion"]) == (80e9, 120e6)
	assert other.young == pytest.approx(2 / (1 / 80e9 + 1 / 30e9), rel=1e-12)
	assert (other.strength["cohesion"], other.frictionDynamic) == (40e6, 0.4)


def test_a_material_between_two_has_its_say():
	row_of_three(stone(), mortar(), BondedMat(label="seam", young=10e9, cohesion=5e6, between=["mortar", "stone"]))
	same, other = O.interactions[0, 1].phys, O.interactions[1, 2].phys
	assert (same.young, same.strength["cohesion"]) == (80e9, 120e6)
	assert (other.young, other.strength["cohesion"]) == (10e9, 5e6)


def test_criteria_that_differ_need_a_material_between():
	soft = lambda **more: SofteningBondMat(label="mortar", young=30e9, cohesion=10e6, tensileStrength=4e6, **more)
	with pytest.raises(
		ValueError, match="'stone' breaks by MohrCoulomb, 'mortar' by SofteningBond: append a third"
	):
		row_of_three(stone(), soft(), None)
	assert not any(O.bodies)
	seam = SofteningBondMat(label="seam", cohesion=5e6, tensileStrength=2e6, between=["stone", "mortar"])
	row_of_three(stone(), soft(), seam)
	assert [O.interactions[i, i + 1].phys.criterion for i in (0, 1)] == ["MohrCoulomb", "SofteningBond"]


@pytest.mark.parametrize("between, words", [
	(["stone"], "two different labels"), (["stone", "stone"], "two different labels"),
	(["stone", "mortr"], "O.materials has no BondedMat 'mortr'"),
])
def test_bad_materials_between(between, words):
	with pytest.raises(ValueError, match=words):
		row_of_three(stone(), mortar(), BondedMat(label="seam", between=between))


@pytest.mark.parametrize("loop", [BondedInteractionLoop, InteractionLoop])
def test_contacts_of_bad_materials_between_stop_the_run(loop):
	O.reset()
	for label in ("stone", "mortar"):
		O.materials.append(BondedMat(label=label))
	for label in ("seam", "joint"):
		O.materials.append(BondedMat(label=label, between=["stone", "mortar"]))
	for x, label in ((0, "stone"), (1.99e-3, "mortar")):
		O.bodies.append(utils.sphere(Vector3(x, 0, 0), 1e-3, material=label))
	engines = ddem.bonded.engines()
	ours = engines[2]
	engines[2] = loop(ours.geomDispatcher.functors, ours.physDispatcher.functors, ours.lawDispatcher.functors)
	O.engines = engines
	O.dt = 1e-9
	with pytest.raises(ValueError, match="both between"):
		ddem.bonded.check()
	if loop is BondedInteractionLoop:
		with pytest.raises(RuntimeError, match="both between"):
			O.step()
	else:
		O.step()  # says so and pauses; it ended the program
	O.reset()
	O.materials.append(BondedMat(label="seam", between=["stone", "mortar"]))
	O.engines = ddem.bonded.engines()
	with pytest.raises(ValueError, match="O.materials has no BondedMat 'stone'"):
		ddem.bonded.check()


def test_two_materials_between_the_same_are_refused():
	O.reset()
	for label in ("seam", "joint"):
		O.materials.append(BondedMat(label=label, between=["stone", "mortar"]))
	for material in (stone(), mortar()):
		O.materials.append(material)
	packing = ddem.packing.Packing([(0, 0, 0), (2e-3, 0, 0)], [1e-3] * 2)
	with pytest.raises(ValueError, match="'seam'.*'joint' are both between 'stone' and 'mortar'"):
		ddem.bonded.append(packing, ["stone", "mortar"], gap=1e-6)


def test_contacts_between_two_materials_have_the_same_say():
	O.reset()
	O.materials.append(stone(), )
	O.materials.append(mortar())
	O.materials.append(
		BondedMat(
			label="seam", young=10e9, frictionStatic=0.2, frictionDynamic=0.1, between=["stone", "mortar"]
		)
	)
	for x, label in ((0, "stone"), (1.99e-3, "mortar")):
		O.bodies.append(utils.sphere(Vector3(x, 0, 0), 1e-3, material=label))
	O.engines = ddem.bonded.engines()
	O.dt = 1e-9
	O.step()
	phys = O.interactions[0, 1].phys
	assert (phys.young, phys.frictionStatic, phys.frictionDynamic) == (10e9, 0.2, 0.1)


def test_weibull_factors_are_those_of_the_distribution():
	factors = ddem.bonded.Weibull(modulus=5, seed=3)(200000)
	assert factors.mean() == pytest.approx(1, rel=2e-3)
	gamma = math.gamma
	deviation = math.sqrt(gamma(1 + 2 / 5) / gamma(1 + 1 / 5)**2 - 1)
	assert factors.std() == pytest.approx(deviation, rel=1e-2)
	assert (factors == ddem.bonded.Weibull(5, 3)(200000)).all()
	assert (factors[:9] != ddem.bonded.Weibull(5, 4)(9)).all()
	with pytest.raises(ValueError, match=r"modulus = 0 \[-\] must be positive"):
		ddem.bonded.Weibull(0)


def test_scatter_multiplies_the_strength_of_each_bond():
	O.reset()
	O.materials.append(stone())
	packing = ddem.packing.prism(0.01, 0.01, 0.01, 0.8e-3, 2e-3, seed=2, fails=200)
	weibull = ddem.bonded.Weibull(6, seed=1)
	sample = ddem.bonded.append(packing, "stone", scatter=weibull)
	O.engines = ddem.bonded.engines()
	strengths = [O.interactions[int(i), int(j)].phys.strength["cohesion"] for i, j in sample.bonds]
	np.testing.assert_allclose(strengths, 120e6 * weibull(len(sample.bonds)), rtol=1e-12)


def test_bad_scatter_appends_nothing():
	O.reset()
	O.materials.append(stone())
	packing = ddem.packing.Packing([(0, 0, 0), (2e-3, 0, 0)], [1e-3] * 2)
	for scatter, words in ((lambda n: [0.0] * n, r"factor 0 = 0.0+ \[-\] must be positive"),
	                       (lambda n: [1.0] * (n + 1), "2 factors for 1 pairs")):
		with pytest.raises(ValueError, match=words):
			ddem.bonded.append(packing, "stone", gap=1e-6, scatter=scatter)
		assert not any(O.bodies)


def test_bad_lists_of_materials():
	O.reset()
	O.materials.append(stone())
	packing = ddem.packing.Packing([(0, 0, 0), (2e-3, 0, 0)], [1e-3] * 2)
	with pytest.raises(ValueError, match="3 materials for 2 spheres"):
		ddem.bonded.append(packing, ["stone"] * 3, gap=1e-6)
	with pytest.raises(ValueError, match="no material with label 'rock'"):
		ddem.bonded.append(packing, ["stone", "rock"], gap=1e-6)


def test_the_old_name_of_the_law_tells_the_new_one():
	for arguments in ({}, {"convention": "esys"}):
		with pytest.raises(RuntimeError, match="is now Law2_ScGeom_BondedPhys_Bonded"):
			Law2_ScGeom_BondedPhys_MohrCoulomb(**arguments)
