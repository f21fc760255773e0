# GPL v2 or later, see LICENSE.
# At rest, deformable triangles are linear finite elements on the mesh in which each triangle is split into three at its
# centroid (Alfeld split).
#
# The reference is a finite element solver of its own: constant-strain triangles assembled from the gradients of their
# shape functions, nothing of the plugin.
import numpy as np
import pytest
import scipy.sparse
import scipy.sparse.linalg

from yade import O, Vector3, ddem

from deformable_samples import TREATMENTS, bodies, elastic, lame, skewed_mesh, start


def split_at_centroids(mesh):
	"""Nodes and triangles of the Alfeld split: vertices first, then a centroid for each triangle."""
	first = len(mesh.nodes)
	centre = first + np.arange(len(mesh.triangles))
	corners = mesh.triangles
	parts = np.stack([np.column_stack([centre, corners[:, k], corners[:, (k + 1) % 3]]) for k in range(3)], axis=1)
	return np.vstack([mesh.nodes, mesh.nodes[corners].mean(axis=1)]), parts.reshape(-1, 3)


def solve_by_finite_elements(nodes, triangles, materials, thickness, forces, held):
	"""Plane-strain displacements (n, 2) [m] of constant-strain triangles.

	:param materials: (λ, μ) [Pa] of each triangle
	:param forces: (n, 2) [N]
	:param held: (n, 2) true where the displacement is zero
	"""
	rows, columns, values = [], [], []
	for corners, (lam, mu) in zip(triangles, materials):
		x = nodes[corners]
		# the linear interpolation a + b x + c y through the corners:
		# column k of the inverse holds the coefficients of shape function k
		coefficients = np.linalg.inv(np.column_stack([np.ones(3), x]))
		area = 0.5 * np.linalg.det(np.column_stack([np.ones(3), x]))
		dx, dy = coefficients[1], coefficients[2]
		strain = np.zeros((3, 6))  # xx, yy, 2 xy
		strain[0, 0::2], strain[1, 1::2] = dx, dy
		strain[2, 0::2], strain[2, 1::2] = dy, dx
		moduli = np.array([[lam + 2 * mu, lam, 0], [lam, lam + 2 * mu, 0], [0, 0, mu]])
		stiffness = thickness * area * strain.T @ moduli @ strain
		unknowns = np.column_stack([2 * corners, 2 * corners + 1]).ravel()
		rows.append(np.repeat(unknowns, 6))
		columns.append(np.tile(unknowns, 6))
		values.append(stiffness.ravel())
	n = 2 * len(nodes)
	matrix = scipy.sparse.csr_matrix(
		(np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=(n, n)
	)
	free = np.flatnonzero(~held.ravel())
	solution = np.zeros(n)
	solution[free] = scipy.sparse.linalg.spsolve(matrix[free][:, free].tocsc(), forces.ravel()[free])
	return solution.reshape(-1, 2)


def settle(block, loads, treatment, steps):
	"""Displacements of vertices and centroids (n, 2) [m] under forces on the vertices, from rest to rest."""
	for body in bodies([*block.node_ids, *block.triangle_ids]):
		body.state.pos, body.state.vel, body.state.ori, body.state.angVel = (
			body.state.refPos,
			Vector3.Zero,
			((0, 0, 1), 0),
			Vector3.Zero,
		)
	for i, force in zip(block.node_ids, loads):
		O.forces.setPermF(int(i), (*force, 0))
	engine = start(rotation=treatment, damping=0.7)
	reference = np.vstack([engine.array("nodePosition"), engine.array("corePosition")])
	O.run(steps, True)
	return np.vstack([engine.array("nodePosition"), engine.array("corePosition")]) - reference


MIXES = {
	"one material": ({"": "concrete"}, {}),
	"two materials": ({"": "concrete", "steel": "steel"}, {"steel": ddem.mesh.box(0.01, 0.01, 0.03, 0.02)}),
}


@pytest.mark.parametrize("mix", MIXES)
@pytest.mark.parametrize("treatment", TREATMENTS)
def test_static_solution_is_that_of_linear_finite_elements_on_the_split_mesh(treatment, mix):
	"""With 'cosserat' too: a core at rest feels no moment, so it has turned until its rotation strain is zero, and
	strain is measured the same in any frame nearby."""
	by_region, regions = MIXES[mix]
	materials = {
		"concrete": elastic("concrete"),
		"steel": elastic("steel", bulk=151e9, shear=81e9, density=8030),  # 304L: Zubelewicz (2018), section 4.3
	}
	mesh = ddem.mesh.rectangle(0.04, 0.03, size=0.008, pattern="unstructured", regions=regions, seed=2)
	thickness = 0.3
	block = ddem.append(mesh, by_region, thickness=thickness)
	left = block.mesh.boundary("left")
	block.hold(block.node_ids[left])
	x, y = block.mesh.nodes.T
	shape = np.column_stack([np.cos(90 * y - 30 * x), np.sin(70 * x) - 0.4])  # smooth, and without any symmetry

	nodes, triangles = split_at_centroids(block.mesh)
	held = np.zeros(nodes.shape, bool)
	held[left] = True
	names = [by_region[block.mesh.region_names[r]] for r in block.mesh.regions]
	moduli = np.repeat([lame(materials[name]) for name in names], 3, axis=0)
	unit = np.vstack([shape, np.zeros((len(triangles) // 3, 2))])
	expected = solve_by_finite_elements(nodes, triangles, moduli, thickness, unit, held)

	if treatment == "none":
		load = 1e-2 / np.abs(expected).max() * 0.04
		found = settle(block, load * shape, treatment, 6000)
	else:
		# What rotates is linear only up to the strain, and round-off of positions forbids very small ones.
		# With u(f) = L f + Q f² + C f³ + …, opposite loads drop the even terms and loads
		# f and 2f the cubic one.
		load = 1e-4 / np.abs(expected).max() * 0.04
		odd = [
			0.5
			* (
				settle(block, scale * load * shape, treatment, 6000)
				- settle(block, -scale * load * shape, treatment, 6000)
			)
			for scale in (1, 2)
		]
		found = (8 * odd[0] - odd[1]) / 6
	assert np.abs(found - load * expected).max() < 1e-9 * load * np.abs(expected).max()


def test_the_reference_solver_passes_the_patch_test():
	"""The solver that the test above relies on, checked by itself: a uniaxial stress state in closed form."""
	material = elastic()
	nodes, triangles = split_at_centroids(ddem.mesh.rectangle(0.02, 0.01, size=0.005))
	lam, mu = lame(material)
	thickness, stress = 0.3, 1e6
	forces = np.zeros(nodes.shape)
	right = np.flatnonzero(np.isclose(nodes[:, 0], 0.02))
	order = right[np.argsort(nodes[right, 1])]
	for a, b in zip(order, order[1:]):
		forces[[a, b], 0] += 0.5 * stress * thickness * (nodes[b, 1] - nodes[a, 1])
	held = np.zeros(nodes.shape, bool)
	held[np.isclose(nodes[:, 0], 0), 0] = True
	held[np.isclose(nodes[:, 1], 0), 1] = True
	found = solve_by_finite_elements(
		nodes, triangles, np.tile((lam, mu), (len(triangles), 1)), thickness, forces, held
	)
	modulus = 4 * mu * (lam + mu) / (lam + 2 * mu)  # plane strain, E/(1−ν²)
	ratio = lam / (lam + 2 * mu)  # ν/(1−ν)
	strain = stress / modulus
	assert np.abs(found - nodes * (strain, -ratio * strain)).max() < 1e-12 * strain * 0.02
