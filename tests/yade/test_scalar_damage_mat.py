# GPL v2 or later, see LICENSE.
# Isotropic damage in scenes: a bar that breaks, one triangle against the material point, saving, what a block tells,
# refusals. The law's numbers are tested in tests/kernel/laws/scalar_damage_test.cpp.
import math

import numpy as np
import pytest

from yade import Matrix3, O, ScalarDamageMat, ddem
from yade.ddem.materialpoint import MaterialPoint

from deformable_samples import (
	assert_fields_reach_paraview, assert_goes_on_after_loading, beside_point, bodies, start, steps
)

G_F, STRENGTH = 100, 3e6  # [J/m²], [Pa]: the defaults


def bar(height, rows=3, speed=0.3):
	"""Rows of cells of this height [m], the middle one weaker, pulled apart; with the energy book."""
	for label, share in (("strong", 1), ("weak", 0.7)):
		strength = share * STRENGTH
		O.materials.append(ScalarDamageMat(label=label, young=30e9, poisson=0, tensileStrength=strength))
	middle = rows // 2 * height
	weak = ddem.mesh.box(0, middle, 4 * height, middle + height)
	mesh = ddem.mesh.rectangle(4 * height, rows * height, height, pattern="alternating", regions={"weak": weak})
	block = ddem.append(mesh, {"": "strong", "weak": "weak"})
	block.hold(block.boundary("bottom"), "y")
	block.hold(block.node_ids[:1], "x")
	block.drive(block.boundary("top"), (None, speed))
	for body in bodies([*block.node_ids, *block.triangle_ids]):  # from the start, so that no wave runs
		body.state.vel[1] = speed * body.state.pos[1] / (rows * height)
	engine = start()
	O.trackEnergy = True
	return block, engine


@pytest.mark.parametrize("height", [0.01, 0.04])
def test_a_bar_in_tension_softens_and_breaks_for_the_fracture_energy(height):
	speed = 0.03  # [m/s]: 0.3 MPa while a wave runs to and fro in the broken half of the bar
	block, _ = bar(height, speed=speed)
	top, area = np.flatnonzero(np.isin(block.node_ids, block.boundary("top"))), 4 * height
	stress = []
	opening = 10 * G_F / (0.7 * STRENGTH)  # [m]: the softening stress falls by e for every G_F/f_t
	while O.time < opening / speed:
		steps(20)
		stress.append(-block.node_forces[top, 1].sum() / area)
	assert max(stress) == pytest.approx(0.7 * STRENGTH, rel=0.05)  # of the weak row; waves
	assert abs(np.mean(stress[-10:])) < 0.01 * STRENGTH
	weak = block.mesh.region("weak")
	assert (block.damage[weak] > 0.9).all() and (np.delete(block.damage, weak) == 0).all()
	# two thirds to all of G_F, since sub-elements at an edge along the crack may unload: see the kernel's test
	assert 2 / 3 * G_F < O.energy["damage"] / area < 1.02 * G_F
	assert O.energy.total() == pytest.approx(total_at_start(speed, height), rel=1e-3, abs=1e-3 * O.energy["damage"])


def total_at_start(speed, height, rows=3, density=2400):
	"""Kinetic energy [J] of the bar stretched at this speed: ½ ρ ∫(v y/H)² dV."""
	return 0.5 * density * 4 * height * rows * height * speed**2 / 3


def test_a_triangle_follows_the_material_point():
	material = ScalarDamageMat()
	point = MaterialPoint(material, area=4.5e-4)
	triangle, rates = [(-1e-2, -1e-2), (2e-2, -1e-2), (-1e-2, 2e-2)], [(300, 20, 0), (-200, 0, 150), (0, 400, 100)]
	for engine, end in beside_point(material, point, triangle, rates):
		assert engine.values("stress")[0] == pytest.approx(np.tile(end.stress[-1], (3, 1)), rel=1e-6, abs=1)
		assert engine.values("damage")[0] == pytest.approx(end.damage_ratio[-1], rel=1e-9)
		assert engine.values("largestStrain")[0] == pytest.approx(end.fields["largestStrain"][-1], rel=1e-9)
	assert end.damage_ratio[-1] > 0.9


def test_a_broken_bar_is_saved_and_goes_on_bit_by_bit(tmp_path):
	_, engine = bar(0.02)
	steps(400)
	assert engine.values("damage").max() > 0.5
	names = ("stress", "damage", "largestStrain", "damageDissipation")
	assert_goes_on_after_loading(tmp_path / "bar.xml", 400, names, "damage")


def test_fields_come_by_themselves(tmp_path):
	block, engine = bar(0.02)
	steps(400)
	assert {name: (unit, components) for name, unit, components in engine.fields()} == {
		"largestStrain": ("-", 1), "strain": ("-", 3), "damageDissipation": ("J/m³", 1)
	}
	largest, count = engine.values("largestStrain"), len(block.triangle_ids)
	assert largest.shape == (count, 3)
	assert (largest[block.damage > 0] > 0.7 * STRENGTH / 30e9).any()
	# 1 − d of the sub-elements that are damaged, from the fields, for the law of the weak row with h = 0.02 m
	first = 0.7 * STRENGTH / 30e9
	soft = G_F / (0.02 * 0.7 * STRENGTH) - first / 2
	expected = np.where(largest > first, first / np.maximum(largest, first) * np.exp((first - largest) / soft), 1)
	weak = block.mesh.region("weak")
	assert 1 - block.sub_element_damage[weak] == pytest.approx(expected[weak], rel=1e-12)
	volume = np.asarray(block.area)[:, None] / 3
	assert (engine.values("damageDissipation") * volume).sum() == pytest.approx(O.energy["damage"], rel=1e-12)
	assert_fields_reach_paraview(block, tmp_path, ("largestStrain", "damageDissipation"))


def test_triangles_have_their_own_fracture_energy():
	mesh = ddem.mesh.rectangle(0.02, 0.02, 0.01, pattern="alternating")
	O.materials.append(ScalarDamageMat(label="concrete"))
	block = ddem.append(mesh, "concrete")
	tough = O.bodies[int(block.triangle_ids[3])]
	tough.shape.fractureEnergy = 4 * G_F
	engine = start()
	own = engine.values("fractureEnergy")
	assert own[list(engine.values("triangleIds")).index(tough.id)] == 4 * G_F
	assert sorted(own)[:-1] == [G_F] * (len(own) - 1)


def test_what_it_has_not_is_refused_with_place_and_way_out():
	O.materials.append(ScalarDamageMat(label="concrete"))
	limit = 2 * G_F * O.materials[0].young / STRENGTH**2  # Bažant and Oh (1983): beyond it stress would snap back
	ddem.append(ddem.mesh.rectangle(4 * limit, 2 * limit, 2 * limit, pattern="alternating"), "concrete")
	words = r"body \d+ at .*ScalarDamage: a triangle of area .* m².*energy of 100 J/m².*Keep √\(2·area\) below"
	with pytest.raises(ValueError, match=words):
		start()
	for name, value, text in (
		("bandFactor", 2, "bandFactor = 2.*leave crack_band out"),
		("initialDamage", Matrix3(0.1, 0, 0, 0, 0, 0, 0, 0, 0), "initialDamage = 0.1.*fractureEnergy of"),
	):
		O.reset()
		O.materials.append(ScalarDamageMat(label="concrete"))
		block = ddem.append(ddem.mesh.rectangle(0.02, 0.02, 0.01), "concrete")
		setattr(O.bodies[int(block.triangle_ids[5])].shape, name, value)
		with pytest.raises(ValueError, match=f"body {block.triangle_ids[5]} at .*{text}"):
			start()


BAD = [("tensileStrength", -1, "Pa"), ("fractureEnergy", 0, "J/m²"), ("residual", math.nan, "[-]")]


@pytest.mark.parametrize("name, value, unit", BAD)
def test_parameters_out_of_bounds_are_refused(name, value, unit):
	with pytest.raises(ValueError) as error:
		ScalarDamageMat(label="concrete", **{name: value})
	assert name in str(error.value) and unit in str(error.value) and "concrete" in str(error.value)


def test_another_strength_damages_nothing_that_is_virgin():
	material = ScalarDamageMat(label="concrete", young=30e9, poisson=0.2)
	O.materials.append(material)
	block = ddem.append(ddem.mesh.rectangle(0.04, 0.04, 0.01), "concrete")
	start(step=0.3)  # the arrays are made
	for name, value in (("tensileStrength", 0.5 * material.tensileStrength), ("bulk", 2 * material.bulk)):
		setattr(material, name, value)
		O.run(3, True)
		assert block.damage.max() == 0, name
