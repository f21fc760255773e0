# GPL v2 or later, see LICENSE.
"""Static problems solved twice: by FreeFem++ on the mesh in which every triangle is split at its centroid,
and by deformable triangles."""
from dataclasses import dataclass

import numpy as np

from yade import O, Vector3, ddem

from . import freefem, tools


@dataclass
class Solution:
	"""A static solution; displacements have the vertices' rows first, then the centroids'."""
	block: object  # ddem.Block
	freefem: np.ndarray  # displacements by FreeFem++ (n + m, 2) [m]
	# largest force out of balance of the deformable triangles in FreeFem++'s solution,
	# over the largest nodal force [-]
	unbalanced: float
	relaxed: np.ndarray = None  # displacements by deformable triangles (n + m, 2) [m]
	residual: float = None  # of the relaxation, see ddem.relax
	steps: int = 0  # of the relaxation

	@property
	def difference(self):
		"""Largest difference of a displacement over the largest displacement [-]."""
		return np.abs(self.relaxed - self.freefem).max() / np.abs(self.freefem).max()


def split_at_centroids(mesh):
	"""Nodes and triangles of the barycentric (Alfeld) split:
	the vertices first, then a centroid for each triangle."""
	centre = len(mesh.nodes) + np.arange(len(mesh.triangles))
	parts = [np.column_stack([centre, mesh.triangles[:, k], mesh.triangles[:, (k + 1) % 3]]) for k in range(3)]
	return np.vstack([mesh.nodes, mesh.centroids]), np.stack(parts, axis=1).reshape(-1, 3)


def nodal_loads(mesh, where, traction, points=8):
	"""Nodal forces per thickness (n, 2) [N/m] that do the work of a traction on the border.

	:param where: says which border edges carry it, from the arrays x, y [m] of their middles
	:param traction: (points, outer normals), both (…, 2), -> (…, 2) [Pa]
	:param points: of Gauss–Legendre integration on each edge
	:raises ValueError: no border edge carries it
	"""
	edges = mesh.boundary_edges()
	a, b = mesh.nodes[edges[:, 0]], mesh.nodes[edges[:, 1]]
	chosen = where(*(0.5 * (a + b)).T)
	if not np.any(chosen):
		raise ValueError(
			f"where() chooses none of the {len(edges)} border edges; the mesh spans x {_span(mesh, 0)}, "
			f"y {_span(mesh, 1)}"
		)
	edges, a, b = edges[chosen], a[chosen], b[chosen]
	along, weights = np.polynomial.legendre.leggauss(points)
	part = 0.5 * (1 + along)[:, None, None]
	edge = b - a
	normals = np.column_stack([edge[:, 1], -edge[:, 0]]) / np.linalg.norm(edge, axis=1)[:, None]
	forces = (
		traction(a + part * edge, np.broadcast_to(normals, (points, *normals.shape)))
		* (0.5 * weights[:, None] * np.linalg.norm(edge, axis=1))[:, :, None]
	)
	loads = np.zeros(mesh.nodes.shape)
	np.add.at(loads, edges[:, 0], ((1 - part) * forces).sum(axis=0))
	np.add.at(loads, edges[:, 1], (part * forces).sum(axis=0))
	return loads


def _span(mesh, axis):
	return f"{mesh.nodes[:, axis].min():g} to {mesh.nodes[:, axis].max():g} m"


def solve_and_balance(mesh, material, loads, held):
	"""Solve by FreeFem++, and see whether the forces of deformable triangles balance in its solution.

	:param mesh: renumbered (mesh.reordered()), so that its rows are the block's
	:param material: elastic, in O.materials
	:param loads: (n, 2) nodal forces per thickness [N/m]
	:param held: (n, 2) true where the displacement is zero
	:returns: :class:`Solution` without what is relaxed
	"""
	nodes, triangles = split_at_centroids(mesh)
	count = len(mesh.nodes)
	padding = np.zeros((len(nodes) - count, 2))
	expected = freefem.solve(
		nodes, triangles, tools.lame(material), np.vstack([loads, padding]), np.vstack([held, padding > 0])
	)

	block = ddem.append(mesh, material)
	if not np.array_equal(block.mesh.triangles, mesh.triangles):
		raise ValueError("solve() needs a mesh that is numbered as the block is: mesh.reordered()")
	engine = tools.start(rotation="none")
	return Solution(block, expected, _unbalanced(block, engine, expected, loads, held))


def solve(mesh, material, loads, held, rotation="none", **relaxation):
	"""The same, and deformable triangles relaxed from rest; further parameters are those of ddem.relax."""
	solution = solve_and_balance(mesh, material, loads, held)
	block = solution.block
	for i, row in zip(block.node_ids, held):
		O.bodies[int(i)].state.blockedDOFs = (
			"z" + "".join(name for name, fixed in zip("xy", row) if fixed) + "XYZ"
		)
	for i, force in zip(block.node_ids, loads):
		O.forces.setPermF(int(i), (*force, 0))
	engine = tools.start(rotation=rotation)
	solution.residual, solution.steps = ddem.relax(**relaxation)
	solution.relaxed = np.vstack([engine.array("nodePosition"), engine.array("corePosition")]) - np.vstack(
		[mesh.nodes, mesh.centroids]
	)
	return solution


def check_equality(check, solution, unbalanced, difference):
	"""Record how far deformable triangles are from FreeFem++ on the split mesh: their forces in its solution, and
	their own solution; with both tolerances [-]."""
	source = "FreeFem++ on the split mesh"
	check("force out of balance in FreeFem++'s solution [-]", solution.unbalanced, 0, unbalanced, source, scale=1)
	check("difference of displacements to FreeFem++ [-]", solution.difference, 0, difference, source, scale=1)


def _unbalanced(block, engine, displacement, loads, held):
	"""Put everything where FreeFem++ says, one step without motion, and look at the forces. Enlarged to a strain at
	which round-off of positions does not show: the treatment is linear."""
	members = tools.bodies(block)
	reference = [body.state.refPos for body in members]
	corners = displacement[block.mesh.triangles]
	# largest gradient about 0.1
	scale = (
		0.1
		/ (np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1) / block.mesh.sizes).max()
	)
	for body, (x, y, _), (u, v) in zip(members, reference, displacement):
		body.state.blockedDOFs = "xyzXYZ"
		body.state.pos = (x + scale * u, y + scale * v, 0)
	O.step()
	node, core = engine.array("nodeForce") / scale + loads, engine.array("coreForce") / scale
	largest = np.abs(engine.array("nodeForce")).max() / scale
	for body, place in zip(members, reference):
		body.state.pos, body.state.vel, body.state.blockedDOFs = place, Vector3.Zero, "z"
	for i in block.triangle_ids:
		O.bodies[int(i)].state.blockedDOFs = "zXY"
	return max(np.abs(np.where(held, 0, node)).max(), np.abs(core).max()) / largest


def recover(points, values, at, radius):
	"""Values (…,) at a place from those at points around it: the quadratic of least squares over the points within
	the radius [m]; needs 12 of them.

	:param points: (n, 2) [m]
	:param values: (n, …)
	:param at: (2,) [m]
	"""
	offset = (points - at) / radius
	near = np.linalg.norm(offset, axis=1) < 1
	if near.sum() < 12:
		raise ValueError(f"only {near.sum()} points within {radius:g} m of {tuple(at)}; a quadratic needs 12")
	x, y = offset[near].T
	terms = np.column_stack([np.ones(len(x)), x, y, x * x, x * y, y * y])
	return np.linalg.lstsq(terms, values[near], rcond=None)[0][0]
