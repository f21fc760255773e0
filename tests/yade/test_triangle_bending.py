# GPL v2 or later, see LICENSE.
"""Three-point bending of triangles against an elastic beam in plane strain."""
import numpy as np
import pytest
from deformable_samples import elastic

from yade import DeformableEngine, ForceResetter, O, ddem
from yade.ddem.triangle_bending import plane_strain_deflection

YOUNG, POISSON, DEPTH = 30e9, 0.2, 0.05


def bent(cells, strip=1e-6, span=0.32, length=0.36, height=0.04):
	"""A beam at rest under a load; as it is told, at one node."""
	rock = elastic(bulk=YOUNG / (3 * (1 - 2 * POISSON)), shear=YOUNG / (2 * (1 + POISSON)))
	block = ddem.append(ddem.mesh.rectangle(length, height, size=height / cells), rock, thickness=DEPTH)
	bending = ddem.three_point_bending(block, span, velocity=0.02, strip=strip)
	O.engines = [ForceResetter(), *bending.engines, DeformableEngine(rotation="corotational")]
	O.dt = ddem.time_step(0.8)
	O.run(400, True)
	bending.engines[0].velocity = 0
	ddem.relax(1e-5)
	return bending


def lacking(bending):
	"""What the deflection lacks of that of an elastic beam, over it."""
	exact = plane_strain_deflection(bending.force_top, bending.span, YOUNG, POISSON, DEPTH, bending.height)
	return 1 - bending.deflection / exact


def test_the_deflection_tends_to_that_of_an_elastic_beam():
	"""Linear triangles are too stiff, by an error of second order in their size."""
	errors = []
	for cells in (4, 8, 16):
		O.reset()
		bending = bent(cells)
		assert bending.span == pytest.approx(0.32) and bending.strip == 0
		assert bending.force_bottom == pytest.approx(bending.force_top, rel=1e-3)
		errors.append(lacking(bending))
	steps = -np.diff(errors)
	assert 3 < steps[0] / steps[1] < 5  # 4 of second order
	assert errors[2] - steps[1] / 3 == pytest.approx(0, abs=0.003)  # Richardson's limit
	assert errors[1] < 0.02
	assert bending.area == pytest.approx(2 * DEPTH * 0.04**2 / (3 * bending.span))
	assert bending.strain == pytest.approx(6 * bending.deflection * 0.04 / bending.span**2)


def test_the_closed_form_is_the_books_in_plane_stress():
	"""1 + 2.85 (h/L)² - 0.84 (h/L)³ of a slender beam where ν = 0.3 in plane stress (Timoshenko and Goodier):
	a beam in plane strain of that E' and ν'."""
	poisson = 0.3 / 1.3
	young = 1 - poisson**2  # E' = 1
	for ratio in (4, 8):
		found = plane_strain_deflection(1, ratio, young, poisson, 1, 1) / (ratio**3 / 4)
		assert found == pytest.approx(1 + 2.85 / ratio**2 - 0.84 / ratio**3, rel=1e-9)


def test_a_strip_that_does_not_turn_stiffens_the_beam():
	"""The wider the more, and less than if the beam beneath it were rigid, which takes 3 s/L of the deflection."""
	found = []
	for strip in (1e-6, 0.01, 0.02):
		O.reset()
		bending = bent(8, strip)
		assert bending.strip == pytest.approx(strip, abs=1e-5)
		found.append(lacking(bending))
	for strip, error in zip((0.01, 0.02), found[1:]):
		assert found[0] + 0.02 < error < found[0] + 3 * strip / 0.32
	assert found[2] > found[1]


def test_what_is_no_beam_is_refused_and_nothing_is_held():
	for size, span, options, message in (
		((0.1, 0.08), 0.08, {}, "is no beam"), ((0.2, 0.05), 0.3, {}, "must not exceed the beam's length"),
		((0.2, 0.05), 0.15, {"strip": 0.2}, "strip = 0.2 m"),
		((0.2, 0.05), 0.15, {"ramp": -1.0}, "ramp = -1.0 s")
	):
		O.reset()
		block = ddem.append(ddem.mesh.rectangle(*size, size=0.02), elastic())
		with pytest.raises(ValueError, match=message):
			ddem.three_point_bending(block, span, velocity=0.1, **options)
		assert not any(set("xy") & set(O.bodies[i].state.blockedDOFs) for i in block.node_ids)
