# GPL v2 or later, see LICENSE.
# Steel that yields in scenes: strength of a block, one triangle against the material point, saving, what a block tells.
# The law's numbers are tested in tests/kernel/laws/von_mises_test.cpp.
import math

import numpy as np
import pytest

from yade import O, VonMisesMat, ddem
from yade.ddem.materialpoint import MaterialPoint

from deformable_samples import (
	assert_fields_reach_paraview, assert_goes_on_after_loading, beside_point, bodies, start, steps
)

YIELD = 270e6  # [Pa]: steel 304L of Zubelewicz (2018), the default


def stretched(speed=2.0, **parameters):
	"""A block of steel whose top and bottom move apart uniformly; its engine keeps the energy book."""
	O.materials.append(VonMisesMat(label="steel", **parameters))
	block = ddem.append(ddem.mesh.rectangle(0.02, 0.04, 0.005), "steel")
	block.hold(block.boundary("bottom"), "y")
	block.hold(block.node_ids[:1], "x")
	block.drive(block.boundary("top"), (None, speed))
	for body in bodies([*block.node_ids, *block.triangle_ids]):
		body.state.vel[1] = speed * body.state.pos[1] / 0.04
	engine = start(damping=0.2)
	O.trackEnergy = True
	return block, engine


def test_a_block_of_steel_yields_at_270_MPa():
	speed = 2.0
	block, engine = stretched(speed)
	top = np.flatnonzero(np.isin(block.node_ids, block.boundary("top")))
	first, forces = None, []
	while O.time < 0.01 * 0.04 / speed:
		steps(5)
		if first is None and engine.values("accumulatedPlasticStrain").any():
			first = equivalent(block.stress).mean()
		forces.append(-block.node_forces[top, 1].sum() / 0.02)
	assert first == pytest.approx(YIELD, rel=0.05)  # on average when the first sub-element yields
	assert equivalent(block.stress).max() < YIELD * (1 + 1e-9)
	# plane strain with free sides: ideal plasticity ends at 2σ_y/√3
	assert np.mean(forces[-20:]) == pytest.approx(2 / math.sqrt(3) * YIELD, rel=0.01)
	# work of the yield stress on the accumulated plastic strain
	volume = np.asarray(block.area)[:, None] / 3
	work = (YIELD * engine.values("accumulatedPlasticStrain") * volume).sum()
	assert O.energy["plasticFlow"] == pytest.approx(work, rel=1e-3)
	assert O.energy["damage"] == 0 and (block.damage == 0).all()
	start_energy = 0.5 * 8030 * 0.02 * 0.04 * speed**2 / 3
	assert O.energy.total() == pytest.approx(start_energy, abs=1e-3 * O.energy["plasticFlow"])


def equivalent(stress):
	"""von Mises' equivalent stress √(3/2 s:s) of tensors xx, yy, zz, xy [Pa]."""
	deviator = stress[..., :3] - stress[..., :3].mean(axis=-1, keepdims=True)
	return np.sqrt(1.5 * ((deviator**2).sum(axis=-1) + 2 * stress[..., 3]**2))


@pytest.mark.parametrize("hardening", [0, 5e9])
def test_a_triangle_follows_the_material_point(hardening):
	material = VonMisesMat(hardening=hardening)
	triangle, rates = [(-1, -1), (2, -1), (-1, 2)], [(50, -20, 0), (-80, 0, 40), (0, 60, 20)]
	for engine, end in beside_point(material, MaterialPoint(material), triangle, rates):
		assert engine.values("stress")[0] == pytest.approx(np.tile(end.stress[-1], (3, 1)), rel=1e-9, abs=1)
		plastic, accumulated = end.plastic_strain[-1], end.fields["accumulatedPlasticStrain"][-1]
		assert engine.values("plasticStrain")[0] == pytest.approx(np.tile(plastic, (3, 1)), rel=1e-9, abs=1e-14)
		assert engine.values("accumulatedPlasticStrain")[0] == pytest.approx(accumulated, rel=1e-9)
	assert accumulated > 1e-3


def test_a_block_that_yields_is_saved_and_goes_on_bit_by_bit(tmp_path):
	_, engine = stretched(speed=20)
	steps(300)
	assert engine.values("accumulatedPlasticStrain").max() > 1e-4
	names = ("stress", "plasticStrain", "accumulatedPlasticStrain", "plasticDissipation")
	assert_goes_on_after_loading(tmp_path / "steel.xml", 300, names, "plasticFlow")


def test_fields_come_by_themselves(tmp_path):
	block, engine = stretched(speed=20)
	steps(300)
	assert {name: (unit, components) for name, unit, components in engine.fields()} == {
		"plasticStrain": ("-", 4), "accumulatedPlasticStrain": ("-", 1), "strain": ("-", 3),
		"plasticDissipation": ("J/m³", 1)
	}
	assert (block.plastic_strain == engine.values("plasticStrain")).all() and block.plastic_strain.any()
	assert block.plastic_strain[..., :3].sum(axis=-1) == pytest.approx(0, abs=1e-15)
	volume = np.asarray(block.area)[:, None] / 3
	assert (engine.values("plasticDissipation") * volume).sum() == pytest.approx(O.energy["plasticFlow"], rel=1e-12)
	assert_fields_reach_paraview(block, tmp_path, ("accumulatedPlasticStrain", "plasticDissipation"))


@pytest.mark.parametrize("name, value", [("yieldStress", 0), ("hardening", -1e9), ("yieldStress", math.nan)])
def test_parameters_out_of_bounds_are_refused(name, value):
	with pytest.raises(ValueError) as error:
		VonMisesMat(label="steel", **{name: value})
	assert name in str(error.value) and "Pa" in str(error.value) and "steel" in str(error.value)
