# GPL v2 or later, see LICENSE.
"""Three-point bending of triangles against Timoshenko's beam in plane strain."""
import pytest
from deformable_samples import elastic

from yade import DeformableEngine, ForceResetter, O, ddem
from yade.ddem.triangle_bending import plane_strain_deflection

YOUNG, POISSON, DEPTH = 30e9, 0.2, 0.05


def bent(cells, span=0.36, length=0.40, height=0.04):
	rock = elastic(bulk=YOUNG / (3 * (1 - 2 * POISSON)), shear=YOUNG / (2 * (1 + POISSON)))
	block = ddem.append(ddem.mesh.rectangle(length, height, size=height / cells), rock, thickness=DEPTH)
	bending = ddem.three_point_bending(block, span, velocity=0.02)
	O.engines = [ForceResetter(), *bending.engines, DeformableEngine(rotation="corotational")]
	O.dt = ddem.time_step(0.8)
	O.run(400, True)
	bending.engines[0].velocity = 0
	ddem.relax(1e-5)
	return bending


def test_the_deflection_tends_to_that_of_timoshenkos_beam():
	"""Linear triangles are too stiff, by an error of second order in their size; the load's strip, a fifth of the
	height wide and kept from turning, adds half a per cent."""
	errors = []
	for cells in (4, 8):
		O.reset()
		bending = bent(cells)
		exact = plane_strain_deflection(bending.force_top, bending.span, YOUNG, POISSON, DEPTH, 0.04)
		errors.append(1 - bending.deflection / exact)
		assert bending.force_bottom == pytest.approx(bending.force_top, rel=1e-3)
	assert 0 < errors[1] < 0.02 and 2.5 < errors[0] / errors[1] < 5
	assert bending.area == pytest.approx(2 * DEPTH * 0.04**2 / (3 * bending.span))
	assert bending.strain == pytest.approx(6 * bending.deflection * 0.04 / bending.span**2)


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
