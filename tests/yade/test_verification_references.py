# GPL v2 or later, see LICENSE.
"""The references of the verification cases, checked by themselves: exact solutions, integrators, and how loads and
stresses are taken from a mesh."""
import dataclasses

import numpy as np
import pytest
from scipy.sparse import csr_matrix

from yade import ddem
from yade.ddem.verification import dynamics, elasticity, statics, tools
from yade.ddem.verification.cases import cosserat


@pytest.fixture
def material():
	return tools.elastic()


@pytest.mark.parametrize(
	"make", [lambda m: elasticity.kirsch(m, 1e6, 0.01), lambda m: elasticity.exponential(m, 1e6, 0.05)]
)
def test_plane_fields_are_elastic_and_in_equilibrium(material, make):
	"""Hooke's law and the equations of equilibrium by central differences of the displacement and of the stress."""
	field, h = make(material), 1e-5
	points = np.random.default_rng(1).uniform(0.012, 0.03, (20, 2))
	steps = h * np.eye(2)
	gradient = np.stack(
		[(field.displacement(points + s) - field.displacement(points - s)) / (2 * h) for s in steps], axis=-1
	)
	lam, mu = tools.lame(material)
	strain = 0.5 * (gradient + gradient.transpose(0, 2, 1))
	stress = lam * np.trace(strain, axis1=1, axis2=2)[:, None, None] * np.eye(2) + 2 * mu * strain
	wanted = field.stress(points)
	assert np.allclose(
		np.stack([stress[:, 0, 0], stress[:, 1, 1], stress[:, 0, 1]], axis=-1),
		wanted,
		rtol=0,
		atol=1e-5 * np.abs(wanted).max(),
	)
	dx, dy = ((field.stress(points + s) - field.stress(points - s)) / (2 * h) for s in steps)
	size = max(np.abs(dx).max(), np.abs(dy).max())
	assert np.abs([dx[:, 0] + dy[:, 2], dx[:, 2] + dy[:, 1]]).max() < 1e-5 * size


def test_kirsch_has_a_free_hole_and_the_pull_far_away(material):
	field, angles = elasticity.kirsch(material, 1e6, 0.01), np.linspace(0, 2 * np.pi, 17)
	normals = np.column_stack([np.cos(angles), np.sin(angles)])
	assert np.abs(field.traction(0.01 * normals, normals)).max() < 1e-6
	assert field.stress(np.array([[0, 0.01], [0.01, 0]])) == pytest.approx(
		np.array([[3e6, 0, 0], [0, -1e6, 0]]), abs=1e-6
	)
	assert field.stress(np.array([[1e3, 2e3]])) == pytest.approx(np.array([[1e6, 0, 0]]), abs=1)


def test_rayleigh_speeds():
	"""Closed form at ν = 1/4, and 0.9553 where incompressible: Rayleigh (1885).
	Elsewhere the root of his cubic equation."""
	for poisson in (0.1, 0.25, 0.4):
		material = tools.elastic(young=60e9, poisson=poisson, density=2400)
		p, s = elasticity.speeds(material)
		ratio = (s / p)**2
		roots = np.roots([1, -8, 24 - 16 * ratio, 16 * ratio - 16])
		root = min(x.real for x in roots if abs(x.imag) < 1e-12 and 0 < x.real < 1)
		assert elasticity.rayleigh_speed(material) / s == pytest.approx(np.sqrt(root), rel=1e-12)
	closed = tools.elastic(young=60e9, poisson=0.25, density=2400)
	assert elasticity.rayleigh_speed(closed) / elasticity.speeds(closed)[1] == pytest.approx(
		np.sqrt(2 - 2 / np.sqrt(3)), rel=1e-12
	)
	soft = tools.elastic(young=60e9, poisson=0.4999999, density=2400)
	assert elasticity.rayleigh_speed(soft) / elasticity.speeds(soft)[1] == pytest.approx(0.9553, abs=5e-5)


def test_nodal_loads_keep_force_and_moment():
	"""Of a parabolic shear and a linear normal stress on one side: resultants in closed form."""
	mesh = ddem.mesh.rectangle(0.2, 0.1, size=0.03, pattern="unstructured", seed=1)
	traction = lambda points, normals: np.stack(
		[3e6 * points[..., 1], 6 * points[..., 1] * (0.1 - points[..., 1]) / 0.1**3], axis=-1
	)
	loads = statics.nodal_loads(mesh, lambda x, y: x > 0.2 - 1e-9, traction)
	assert loads.sum(axis=0) == pytest.approx([3e6 * 0.1**2 / 2, 1])
	assert (mesh.nodes[:, 1] * loads[:, 0]).sum() == pytest.approx(3e6 * 0.1**3 / 3)
	assert not loads[mesh.nodes[:, 0] < 0.2 - 1e-9].any()
	with pytest.raises(ValueError, match="none of the .* border edges; the mesh spans x 0 to 0.2 m, y 0 to 0.1 m"):
		statics.nodal_loads(mesh, lambda x, y: x > 1, traction)


def test_recovered_stress_is_exact_for_quadratics():
	points = np.random.default_rng(2).uniform(-1, 1, (200, 2))
	values = lambda p: np.stack([1 + p[..., 0] * p[..., 1], p[..., 1]**2 - 2 * p[..., 0]], axis=-1)
	at = np.array([0.2, -0.1])
	assert statics.recover(points, values(points), at, 0.5) == pytest.approx(values(at))
	with pytest.raises(ValueError, match="a quadratic needs 12"):
		statics.recover(points, values(points), at, 0.01)


def oscillators(masses=(2.0, 3.0), stiffness=(50.0, 12.0)):
	"""Two oscillators that do not know of each other, pushed by 1 N each."""
	return dynamics.System(
		np.zeros((2, 2)), np.array([0, 1]), csr_matrix(np.diag(stiffness)), csr_matrix(np.diag(masses)),
		np.ones(2)
	)


@pytest.mark.parametrize("scheme", ["newmark", "central differences"])
def test_integrators_are_of_second_order(scheme):
	"""Against the exact motion under the force 1 − cos Ωt."""
	system, end, forcing = oscillators(), 2.0, 3.0
	push = lambda t: 1 - np.cos(forcing * t)
	mass, stiffness = system.mass.diagonal(), system.stiffness.diagonal()
	natural = np.sqrt(stiffness / mass)
	swing = 1 / (stiffness - mass * forcing**2)
	exact = (1 - np.cos(natural * end)) / stiffness - swing * (np.cos(forcing * end) - np.cos(natural * end))
	errors = []
	for steps in (200, 400):
		arguments = push, end / steps, steps
		moved = (
			dynamics.newmark(system, *arguments)
			if scheme == "newmark"
			else dynamics.central_differences(system, mass, *arguments)
		)
		errors.append(np.abs(moved[-1] - exact).max())
	assert errors[0] < 1e-3 * np.abs(exact).max()
	assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.05)


def test_first_mode_is_the_slowest_that_is_not_held():
	system = oscillators()
	frequency, shape = dynamics.first_mode(
		dataclasses.replace(system, stiffness=csr_matrix([[50.0, 1, 0], [1, 12.0, 0], [0, 0, 1e-3]])),
		np.array([2.0, 3, 1]),
		np.array([False, False, True]),
	)
	values, vectors = np.linalg.eig(np.array([[50 / 2, 1 / 2], [1 / 3, 12 / 3]]))
	assert frequency == pytest.approx(np.sqrt(values.min()))
	assert shape[0] / shape[1] == pytest.approx(vectors[0, values.argmin()] / vectors[1, values.argmin()])
	assert shape[2] == 0


def test_lumped_masses_are_those_of_the_engine():
	material = tools.elastic()
	block = ddem.append(ddem.mesh.rectangle(0.2, 0.1, size=0.03, pattern="unstructured", seed=1), material)
	engine = tools.start()
	assert np.concatenate([engine.array("nodeMass"), engine.array("coreMass")]) == pytest.approx(
		dynamics.lumped_masses(block.mesh, material.density), rel=1e-12
	)


def test_frequencies_are_found_in_a_sum():
	times = np.linspace(0, 3, 400)
	signal = 0.2 + np.cos(5.3 * times + 1) + 0.3 * np.sin(17.1 * times)
	assert tools.fit_frequencies(times, signal, [5, 17.5]) == pytest.approx([5.3, 17.1], rel=1e-9)


def test_long_waves_of_the_lattice_are_those_of_the_continuum(material):
	"""Both branches to the square of the wave number; and no stiffness against a rigid turn or shift."""
	for beta, share in ((2.0, 1 / 6), (0.05, 0.02)):
		errors = []
		for ka in (0.02, 0.04):
			lattice = cosserat.lattice_modes(ka / cosserat.EDGE, material, beta, share)[0][:2]
			speed = np.sqrt(material.shear / material.density)
			errors.append(
				np.abs(
					lattice
					/ cosserat.continuum_frequencies(
						speed * ka / cosserat.EDGE, material, beta, share
					)
					- 1
				)
			)
		assert np.max(errors[1]) < 1e-4
		assert np.allclose(errors[1] / errors[0], 4, rtol=0.02)
	corners = np.array([[0.0, 0.0], [1.1, 0.1], [0.3, 0.9]])
	stiffness, _ = cosserat.element_matrices(corners, material, 2.0, 1 / 6)
	arms = corners - corners.mean(axis=0)
	turn = np.concatenate([np.column_stack([-arms[:, 1], arms[:, 0]]).ravel(), [0, 0, 1]])
	shift = np.array([1.0, 0, 1, 0, 1, 0, 1, 0, 0])
	assert np.abs(stiffness @ np.column_stack([turn, shift])).max() < 1e-12 * np.abs(stiffness).max()
