# GPL v2 or later, see LICENSE.
# The crack-band correction of the fracture energy; what it does to a crack is the verification case crack_band.
import numpy as np
import pytest

from yade import ConcreteDamageMat, O, ddem

from deformable_samples import bodies, elastic, start


def broken():
	O.materials.append(ConcreteDamageMat(label="brittle", fractureEnergy=8e3))
	return "brittle"


def energies(block):
	return np.array([body.shape.fractureEnergy for body in bodies(block.triangle_ids)])


def factors(block):
	return np.array([body.shape.bandFactor for body in bodies(block.triangle_ids)])


@pytest.fixture
def mesh():
	"""Triangles of several sizes, some of steel."""
	elastic("steel")
	O.materials.append(ConcreteDamageMat(label="concrete", fractureEnergy=50e3))
	return ddem.mesh.rectangle(
		0.02,
		0.03,
		lambda x, y: 0.002 + 0.1 * y,
		pattern="unstructured",
		regions={"steel": ddem.mesh.box(0.005, 0.005, 0.01, 0.01)},
	)


def test_energy_per_area_of_a_row_is_that_of_the_reference_width(mesh):
	block = ddem.append(mesh, {"": "concrete", "steel": "steel"}, crack_band=0.01)
	areas, steel = block.mesh.areas, block.mesh.region("steel")
	breakable = np.setdiff1d(np.arange(len(areas)), steel)
	assert areas[breakable].max() > 2 * areas[breakable].min()
	# Bažant and Oh (1983), with the width √(2 S) of Rots (1988): the material's energy per volume, times 10 mm
	assert (factors(block) * np.sqrt(2 * areas))[breakable] == pytest.approx(0.01)
	assert (energies(block) == -1).all()


def test_it_leaves_what_the_seed_draws_and_is_off_unless_asked_for(mesh):
	choices = ({}, {"seed": 4}, {"seed": 4, "crack_band": 0.01})
	plain, drawn, both = (
		ddem.append(mesh, {"": "concrete", "steel": "steel"}, position=(x, 0, 0), **chosen)
		for x, chosen in enumerate(choices)
	)
	concrete = np.setdiff1d(np.arange(len(plain.triangle_ids)), plain.mesh.region("steel"))
	assert (energies(plain) == -1).all()  # the material's own
	assert (factors(plain) == 1).all() and (factors(drawn) == 1).all()
	assert (energies(both)[concrete] == energies(drawn)[concrete]).all()
	assert factors(both)[concrete] == pytest.approx(0.01 / np.sqrt(2 * plain.mesh.areas[concrete]))


def test_a_factor_that_is_changed_during_a_run_takes_effect_and_a_wrong_one_is_refused():
	damages = []
	for change in (None, 0.05):
		O.reset()
		block = ddem.append(ddem.mesh.rectangle(0.02, 0.02, 0.01), broken())
		block.drive(block.boundary("top"), (None, 5))
		block.hold(block.boundary("bottom"), "y")
		start()
		O.run(200, True)
		for body in bodies(block.triangle_ids) if change else ():
			body.shape.bandFactor = change
		O.run(300, True)
		damages.append(block.damage.mean())
	assert damages[1] > 1.05 * damages[0]
	bodies(block.triangle_ids)[1].shape.bandFactor = -3
	with pytest.raises(ValueError, match="bandFactor = -3.*must be positive"):
		O.step()


@pytest.mark.parametrize("width", [0, -0.01, float("nan"), float("inf"), "1 cm"])
def test_a_width_that_is_no_length_is_refused_before_anything_is_appended(mesh, width):
	with pytest.raises(ValueError, match="crack_band"):
		ddem.append(mesh, {"": "concrete", "steel": "steel"}, crack_band=width)
	assert len(O.bodies) == 0
