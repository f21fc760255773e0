# GPL v2 or later, see LICENSE.
"""ConcreteDamageMat and the material point are the same concrete."""
import pytest

from yade import ConcreteDamageMat
from yade.ddem.materialpoint import EFFECTS, MaterialPoint, concrete


def test_material_of_a_scene_gives_parameters_and_effects():
	material = ConcreteDamageMat(fractureEnergy=40e3, equationOfState=False)
	point = MaterialPoint(material)
	assert point.parameters["fractureEnergy"] == 40e3
	assert point.parameters["bulk"] == pytest.approx(30e9)
	assert set(point.effects) == set(EFFECTS) - {"equationOfState"}
	same = MaterialPoint(concrete(fractureEnergy=40e3), effects=set(EFFECTS) - {"equationOfState"})
	assert point.uniaxial(rate=-1, until=-0.004).axial_stress == pytest.approx(same.uniaxial(rate=-1, until=-0.004).axial_stress, rel=1e-9)


def test_parameters_of_a_scene_material_are_the_laws_own():  # a parameter that one side has and the other has not, or another default, would go unnoticed
	material = ConcreteDamageMat()
	for name, value in concrete().items():
		if hasattr(material, name):
			assert getattr(material, name) == pytest.approx(value, rel=1e-12), name
