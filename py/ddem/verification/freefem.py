# GPL v2 or later, see LICENSE.
"""Plane-strain elasticity by FreeFem++ (F. Hecht, New development in FreeFem++, J. Numer. Math. 20, 2012):
the independent finite element code of the cases.

Debian's package is freefem++. Nothing of the plugin is in here: FreeFem++ gets a mesh, materials, loads and supports as
text files and a variational form in its own language, assembles and solves, and writes displacements.
"""
import os
import re
import subprocess
import tempfile

import numpy as np

# Linear triangles, nodal loads, and supports by FreeFem++'s own way of putting a very large number on the diagonal.
_ELASTICITY = """
mesh Th = readmesh("mesh.msh");
fespace Vh(Th, [P1, P1]);
fespace Ph(Th, P0);
Ph lambda, mu;
{ ifstream file("moduli.txt"); for (int k = 0; k < Th.nt; k++) { file >> lambda[][k]; file >> mu[][k]; } }
Vh [u, v], [p, q];
varf stiffness([u, v], [p, q]) = int2d(Th)(
	lambda * (dx(u) + dy(v)) * (dx(p) + dy(q)) + 2 * mu * (dx(u) * dx(p) + dy(v) * dy(q))
	+ mu * (dy(u) + dx(v)) * (dy(p) + dx(q)));
matrix K = stiffness(Vh, Vh);
real[int] force(Vh.ndof);
real held, value;
ifstream file("loads.txt");
for (int i = 0; i < Vh.ndof; i++) {
	file >> force[i]; file >> held; file >> value;
	if (held > 0) { K(i, i) = 1e30; force[i] = 1e30 * value; }
}
set(K, solver = sparsesolver);
u[] = K^-1 * force;
ofstream result("result.txt");
result.precision(17);
for (int i = 0; i < Vh.ndof; i++) result << u[][i] << endl;
"""


def solve(nodes, triangles, moduli, loads, held, values=0.0):
	"""Displacements (n, 2) [m] of linear triangles of unit thickness.

	:param nodes: (n, 2) [m]
	:param triangles: (m, 3) node indices, counter-clockwise
	:param moduli: (m, 2) or (2,) λ and μ [Pa]
	:param loads: (n, 2) nodal forces per unit thickness [N/m]
	:param held: (n, 2) true where the displacement is prescribed
	:param values: (n, 2) or 0, prescribed displacements [m]
	"""
	moduli = np.broadcast_to(moduli, (len(triangles), 2))
	values = np.broadcast_to(values, nodes.shape)
	table = np.column_stack([np.ravel(loads), np.ravel(held), np.ravel(values)])
	return run(_ELASTICITY, nodes, triangles, {"moduli": moduli, "loads": table}).reshape(-1, 2)


def run(script, nodes, triangles, tables=None, edges=()):
	"""Run a script of FreeFem++ and return the numbers that it wrote into result.txt.

	:param script: text; it finds the mesh in mesh.msh and the tables in NAME.txt
	:param tables: name -> array
	:param edges: (first node, second node, label) of the border
	:raises RuntimeError: FreeFem++ is missing, or what it complained about
	"""
	with tempfile.TemporaryDirectory(prefix="freefem-") as folder:
		_write_mesh(os.path.join(folder, "mesh.msh"), nodes, triangles, edges)
		for name, table in (tables or {}).items():
			np.savetxt(os.path.join(folder, f"{name}.txt"), table, fmt="%.17g")
		with open(os.path.join(folder, "script.edp"), "w") as file:
			file.write(script)
		try:
			done = subprocess.run(
				["FreeFem++", "-nw", "-v", "0", "script.edp"], cwd=folder, capture_output=True,
				text=True, check=False
			)
		except FileNotFoundError:
			raise RuntimeError(
				"FreeFem++ is missing, the independent finite element code of this case; install "
				"Debian's package freefem++"
			) from None
		if done.returncode:
			raise RuntimeError(
				f"FreeFem++ failed with exit code {done.returncode}:\n"
				f"{done.stdout[-2000:]}{done.stderr[-2000:]}"
			)
		return np.loadtxt(os.path.join(folder, "result.txt"))


def version():
	"""Version of FreeFem++, "" where it is missing."""
	try:
		done = subprocess.run(["FreeFem++"], capture_output=True, text=True, check=False)
	except FileNotFoundError:
		return ""
	found = re.search(r"version (\S+)", done.stdout)
	return found[1] if found else ""


def _write_mesh(path, nodes, triangles, edges):
	"""FreeFem++'s own format: counts; x y label; three nodes and a region; two nodes and a label.
	Numbers of nodes begin at 1."""
	with open(path, "w") as file:
		file.write(f"{len(nodes)} {len(triangles)} {len(edges)}\n")
		file.writelines(f"{x:.17g} {y:.17g} 0\n" for x, y in nodes)
		file.writelines(f"{a + 1} {b + 1} {c + 1} 0\n" for a, b, c in triangles)
		file.writelines(f"{a + 1} {b + 1} {label}\n" for a, b, label in edges)
