# GPL v2 or later, see LICENSE.
"""Elastodynamics by finite elements, independent of the plugin: FreeFem++ assembles the matrices,
textbook schemes integrate in time."""
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix, diags
from scipy.sparse.linalg import eigsh, factorized

from . import freefem

_ASSEMBLY = """
mesh Th = readmesh("mesh.msh");
fespace Vh(Th, [ELEMENT, ELEMENT]);
real lambda, mu, density;
{ ifstream file("material.txt"); file >> lambda; file >> mu; file >> density; }
varf stiffness([u, v], [p, q]) = int2d(Th)(
	lambda * (dx(u) + dy(v)) * (dx(p) + dy(q)) + 2 * mu * (dx(u) * dx(p) + dy(v) * dy(q))
	+ mu * (dy(u) + dx(v)) * (dy(p) + dx(q)));
varf inertia([u, v], [p, q]) = int2d(Th)(density * (u * p + v * q));
varf push([u, v], [p, q]) = int1d(Th, 1)(p);
matrix K = stiffness(Vh, Vh), M = inertia(Vh, Vh);
real[int] force = push(0, Vh);
Vh [X, X2] = [x, x];
Vh [Y, Y2] = [y, y];
Vh [D, D2] = [0, 1];
int[int] I(1), J(1);
real[int] C(1);
ofstream result("result.txt");
result.precision(17);
for (int i = 0; i < Vh.ndof; i++) result << 0 << " " << X[][i] << " " << Y[][i] << " " << D[][i] << endl;
for (int i = 0; i < Vh.ndof; i++) result << 1 << " " << i << " " << 0 << " " << force[i] << endl;
[I, J, C] = K;
for (int i = 0; i < I.n; i++) result << 2 << " " << I[i] << " " << J[i] << " " << C[i] << endl;
[I, J, C] = M;
for (int i = 0; i < I.n; i++) result << 3 << " " << I[i] << " " << J[i] << " " << C[i] << endl;
"""


@dataclass(frozen=True)
class System:
	"""M ü + K u = load·p(t) of a plane body of unit thickness."""
	points: np.ndarray  # of the degrees of freedom (n, 2) [m]
	axis: np.ndarray  # 0: along x, 1: along y (n,)
	stiffness: csr_matrix  # [Pa]
	mass: csr_matrix  # consistent [kg/m]
	load: np.ndarray  # of a unit traction along x on the loaded edges (n,) [m]

	def at(self, point, axis):
		"""The degree of freedom at a point [m].

		:raises ValueError: there is none
		"""
		distance = np.linalg.norm(self.points - point, axis=1) + 1e9 * (self.axis != axis)
		if distance.min() > 1e-9:
			raise ValueError(
				f"no degree of freedom at {tuple(point)} m; the nearest is {distance.min():.3g} m away"
			)
		return int(distance.argmin())


def assemble(nodes, triangles, material, edges, element="P2"):
	"""The :class:`System` of a body by FreeFem++.

	:param material: λ, μ [Pa], density [kg/m³]
	:param edges: (first node, second node) of the loaded edges
	:param element: "P1" or "P2": linear or quadratic triangles
	"""
	script = _ASSEMBLY.replace("ELEMENT", element)
	kind, first, second, value = freefem.run(
		script, nodes, triangles, {"material": np.array(material)}, [(a, b, 1) for a, b in edges]
	).T
	count = int((kind == 0).sum())
	matrix = lambda chosen: coo_matrix(
		(value[chosen], (first[chosen].astype(int), second[chosen].astype(int))), (count, count)
	).tocsr()
	return System(
		np.column_stack([first, second])[kind == 0], value[kind == 0].astype(int), matrix(kind == 2),
		matrix(kind == 3), value[kind == 1]
	)


def lumped_masses(mesh, density, vertex_share=1 / 6):
	"""Masses per thickness [kg/m] of deformable triangles, vertices first, then cores: each vertex has a third of
	*vertex_share* of every triangle around it.

	:param density: [kg/m³]
	"""
	masses = density * mesh.areas
	vertices = np.bincount(mesh.triangles.ravel(), np.repeat(vertex_share * masses / 3, 3), len(mesh.nodes))
	return np.concatenate([vertices, (1 - vertex_share) * masses])


def first_mode(system, mass, held):
	"""(angular frequency [rad/s], shape (n,)) of the slowest vibration with a lumped mass (n,) [kg/m], where *held*
	(n,) is true at rest."""
	free = np.flatnonzero(~held)
	scale = diags(1 / np.sqrt(mass[free]))  # turns K u = ω² M u into a standard problem
	values, vectors = eigsh((scale @ system.stiffness[free][:, free] @ scale).tocsc(), k=1, sigma=0)
	shape = np.zeros(len(mass))
	shape[free] = scale @ vectors[:, 0]
	return np.sqrt(values[0]), shape


def newmark(system, pressure, dt, steps):
	"""Displacements (steps + 1, n) [m] from rest, by Newmark's method of mean acceleration (β = ¼, γ = ½):
	implicit, of second order, without damping.

	:param pressure: function of the time [Pa]
	"""
	solve = factorized((system.mass + 0.25 * dt**2 * system.stiffness).tocsc())
	moved, velocity = np.zeros(len(system.load)), np.zeros(len(system.load))
	acceleration = factorized(system.mass.tocsc())(system.load * pressure(0.0))
	result = [moved]
	for k in range(1, steps + 1):
		predicted = moved + dt * velocity + 0.25 * dt**2 * acceleration
		following = solve(system.load * pressure(k * dt) - system.stiffness @ predicted)
		velocity = velocity + 0.5 * dt * (acceleration + following)
		moved, acceleration = predicted + 0.25 * dt**2 * following, following
		result.append(moved)
	return np.array(result)


def central_differences(system, mass, pressure, dt, steps):
	"""Displacements (steps + 1, n) [m] with a lumped mass (n,) [kg/m], by central differences:
	explicit, of second order.

	The velocity is zero half a step before the start, as in YADE:
	a pressure that does not begin at zero acts half a step more.
	"""
	inverse = diags(1 / mass)
	moved, velocity = np.zeros(len(system.load)), np.zeros(len(system.load))
	result = [moved]
	for k in range(steps):
		velocity = velocity + dt * (inverse @ (system.load * pressure(k * dt) - system.stiffness @ moved))
		moved = moved + dt * velocity
		result.append(moved)
	return np.array(result)
