# GPL v2 or later, see LICENSE.
"""Bonds that soften: energies and curves in scenes, the book, saving in the midst of it."""
import math

import numpy as np
import pytest

from yade import BondedMat, BondedInteractionLoop, Ip2_BondedMat_BondedMat_BondedPhys, O, ParallelBondMat
from yade import SofteningBondMat, Vector3, ddem, utils
from yade import (
	ForceResetter, Ig2_Sphere_Sphere_ScGeom, InteractionLoop, Law2_ScGeom_BondedPhys_Bonded,
	TranslationEngine
)
from yade.ddem.energy import EnergyBalance

YOUNG, LENGTH, RADIUS = 30e9, 2e-3, 1e-3
AREA = math.pi * RADIUS**2


def soft(**more):
	return SofteningBondMat(
		**{
			**dict(
				label="soft", young=YOUNG, poisson=0.25, tensionEnergy=60, shearEnergy=400,
				density=2600,
				frictionStatic=0, frictionDynamic=0
			),
			**more
		}
	)


def pair(material, direction=(1, 0, 0), speed=0.01, loop=BondedInteractionLoop):
	"""Two bonded spheres, one held, the other driven at a constant speed without rotation."""
	O.reset()
	O.materials.append(material)
	ids = [
		O.bodies.append(utils.sphere(Vector3(x, 0, 0), RADIUS, material=material, fixed=True))
		for x in (0, LENGTH)
	]
	Ip2_BondedMat_BondedMat_BondedPhys().bond([ids])
	drive = TranslationEngine(ids=[ids[1]], translationAxis=direction, velocity=speed)
	O.engines = [
		ForceResetter(),
		loop(
			[Ig2_Sphere_Sphere_ScGeom()],
			[Ip2_BondedMat_BondedMat_BondedPhys()],
			[Law2_ScGeom_BondedPhys_Bonded()],
		),
		drive,
		ddem.bonded.engines()[-1],
	]
	O.trackEnergy = True
	O.dt = 1e-7
	return ids


def curve(ids, steps):
	"""Separation [m] and force [N] on the driven sphere in every step until the bond is gone."""
	rows = []
	for _ in range(steps):
		O.step()
		force = -O.forces.f(ids[1])
		rows.append([(O.bodies[ids[1]].state.pos - Vector3(LENGTH, 0, 0)).norm(), force.norm()])
		if ddem.bonded.law().brokenCount():
			break
	return np.array(rows)


@pytest.mark.parametrize("loop", [BondedInteractionLoop, InteractionLoop])
def test_pure_tension_takes_its_energy_along_a_straight_line(loop):
	ids = pair(soft(), loop=loop)
	opened, force = curve(ids, 20000).T
	stress = force / AREA
	assert stress.max() == pytest.approx(10e6, rel=2e-3)  # the cut-off; 1 nm a step, 0.67 µm to the strength
	assert opened[-1] == pytest.approx(12e-6, abs=2.1e-9)  # 2 G/f_t
	falling = (opened > 0.7e-6) & (opened < 11.9e-6)
	line = 10e6 * (12e-6 - opened) / (12e-6 - 10e6 * LENGTH / YOUNG)
	assert abs(stress - line)[falling].max() < 2e-3 * 10e6  # a step late
	assert O.energy["bondSoftening"] == pytest.approx(60 * AREA, rel=1e-3)
	(record, ) = ddem.bonded.law().brokenBonds()
	assert record.mode == "tension"
	assert record.energy == pytest.approx(60 * AREA, rel=1e-3)


def test_shear_takes_its_energy():
	# the branch turns by 2 %, and so does what is shear and what is tension
	ids = pair(soft(tensileStrength=math.inf), direction=(0, 0, 1))
	opened, force = curve(ids, 80000).T
	assert force.max() / AREA == pytest.approx(20e6, rel=0.05)
	assert O.energy["bondSoftening"] == pytest.approx(400 * AREA, rel=0.1)
	assert ddem.bonded.law().brokenBonds()[0].mode == "shear"


def test_both_loops_agree_to_the_last_step():
	results = []
	for loop in (BondedInteractionLoop, InteractionLoop):
		ids = pair(soft(), direction=(0.6, 0.8, 0), loop=loop)
		rows = curve(ids, 30000)
		results.append((rows, O.energy["bondSoftening"], ddem.bonded.law().brokenBonds()[0].energy))
	(a, lost_a, broken_a), (b, lost_b, broken_b) = results
	assert len(a) == len(b)
	np.testing.assert_allclose(a, b, rtol=1e-9, atol=1e-6)
	assert lost_a == pytest.approx(lost_b, rel=1e-9) and broken_a == pytest.approx(broken_b, rel=1e-9)


def test_saved_in_the_midst_of_softening_it_goes_on_as_before(tmp_path):
	ids = pair(soft())
	curve(ids, 4000)
	memory = O.interactions[0, 1].phys.memory
	assert memory["lost"] > 0.2 * 60 * AREA
	O.save(str(tmp_path / "half.xml"))
	whole = curve(ids, 20000)
	O.load(str(tmp_path / "half.xml"))
	assert O.interactions[0, 1].phys.memory == memory
	np.testing.assert_array_equal(curve(ids, 20000), whole)


def test_a_specimen_softens_and_bears_more_with_more_energy():
	strengths = []
	for energy in (15.0, 60.0):
		O.reset()
		O.materials.append(
			soft(tensionEnergy=energy, shearEnergy=6 * energy, frictionStatic=0.6, frictionDynamic=0.4)
		)
		packing = ddem.packing.prism(0.01, 0.02, 0.01, 0.8e-3, 2e-3, seed=1, fails=500)
		sample = ddem.bonded.append(packing, "soft")
		platens = ddem.bonded.platens(sample, velocity=0.25, ramp=5e-6)
		O.engines = ddem.bonded.engines(platens)
		O.dt = ddem.bonded.time_step(0.4)
		book = EnergyBalance()
		largest = 0.0
		while platens.strain < 4e-3:
			O.run(200, True)
			largest = max(largest, platens.stress)
			book.record()
		strengths.append(largest)
		assert book.largest < 2e-3
		assert O.energy["bondSoftening"] > 3 * O.energy["bondBroken"]
	assert strengths[1] > 1.1 * strengths[0]


def test_bonds_that_would_snap_back_are_refused():
	O.reset()
	O.materials.append(soft(tensionEnergy=3))
	packing = ddem.packing.Packing([(0, 0, 0), (LENGTH, 0, 0)], [RADIUS, RADIUS])
	with pytest.raises(ValueError, match=r"cannot bond bodies #0 and #1: .*tensionEnergy = 3 J/m².*3.33333 J/m²"):
		ddem.bonded.append(packing, "soft", gap=1e-6)
	assert len([b for b in O.bodies if b]) == 0 and len(O.interactions) == 0


@pytest.mark.parametrize("kind", [SofteningBondMat, ParallelBondMat])
def test_esys_knows_mohr_and_coulomb_only(kind):
	pair(kind(label="other"))
	O.engines = ddem.bonded.engines(convention="esys")
	with pytest.raises(ValueError, match="'other': the convention 'esys' knows bonds of BondedMat only"):
		ddem.bonded.check()
	with pytest.raises(ValueError, match="knows bonds of MohrCoulomb only"):
		O.step()


def test_each_material_tells_its_criterion():
	assert BondedMat().criterion == "MohrCoulomb"
	assert ParallelBondMat().criterion == "ParallelBond"
	assert SofteningBondMat().criterion == "SofteningBond"
