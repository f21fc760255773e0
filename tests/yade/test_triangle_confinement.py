# GPL v2 or later, see LICENSE.
"""Oedometric and biaxial tests of triangles against Hooke's law in plane strain."""
import pytest
from deformable_samples import elastic

from yade import DeformableEngine, ForceResetter, O, ddem
from yade.ddem.triangle_confinement import constrained_modulus, plane_strain_modulus

YOUNG, POISSON = 30e9, 0.25


def block(pattern="unstructured", **options):
	rock = elastic(bulk=YOUNG / (3 * (1 - 2 * POISSON)), shear=YOUNG / (2 * (1 + POISSON)))
	return ddem.append(ddem.mesh.rectangle(0.1, 0.2, size=0.02, pattern=pattern), rock, thickness=0.05, **options)


def pressed(platens):
	"""Stress and strain at rest after a short way."""
	O.engines = [ForceResetter(), *platens.engines, DeformableEngine(rotation="corotational")]
	O.dt = ddem.time_step(0.8)
	O.run(100, True)
	for engine in platens.engines[:1]:
		engine.velocity = 0
	ddem.relax(1e-6)
	return platens.stress, platens.strain


def test_the_slope_of_an_oedometer_is_the_constrained_modulus():
	"""Uniaxial strain is uniform, so that any mesh has it exactly, up to the square of the strain."""
	stress, strain = pressed(ddem.oedometer(block(), velocity=0.1))
	assert 1e-6 < strain < 1e-4
	assert stress / strain == pytest.approx(constrained_modulus(YOUNG, POISSON), rel=2 * strain + 1e-5)


def test_under_pressure_the_slope_is_that_of_plane_strain():
	press = ddem.biaxial(block(initial_stress=(-5e6, -5e6, 0)), 5e6, velocity=0.1)
	stress, strain = pressed(press)
	assert 1e-6 < strain < 1e-4
	# pressures follow the edges as they stretch, by ν/(1 - ν) of the strain
	assert (stress - 5e6) / strain == pytest.approx(plane_strain_modulus(YOUNG, POISSON), rel=1e-3)


def test_a_block_under_pressure_stays_where_it_is():
	made = block(initial_stress=(-5e6, -5e6, 0))
	press = ddem.biaxial(made, 5e6, velocity=1e-9)
	O.engines = [ForceResetter(), *press.engines, DeformableEngine()]
	O.dt = ddem.time_step(0.8)
	O.run(50, True)
	assert press.stress == pytest.approx(5e6, rel=1e-9)
	assert made.stress[..., 2].mean() == pytest.approx(-2 * POISSON * 5e6, rel=1e-9)
	assert abs(made.velocities).max() < 1e-6


@pytest.mark.parametrize(
	"options, pressure, message", [
		({}, 5e6, "initial_stress=.-5e.06, -5e.06, 0."),
		({"initial_stress": (-4e6, -5e6, 0)}, 5e6, "not under"),
		({"initial_stress": (-5e6, -5e6, 0)}, 0.0, "must be positive")
	]
)
def test_another_pressure_than_that_of_the_block_is_refused(options, pressure, message):
	made = block(**options)
	with pytest.raises(ValueError, match=message):
		ddem.biaxial(made, pressure, velocity=0.1)
	assert not any(set("xy") & set(O.bodies[i].state.blockedDOFs) for i in made.node_ids)
