# GPL v2 or later, see LICENSE.
"""The nearly incompressible limit: how stiff the triangles become."""
import numpy as np

from yade import O, ddem
from yade.ddem.verification import case, freefem, statics, tools

SIDE, SHEAR, LOAD = 0.1, 1e9, 1e6  # [m], shear modulus [Pa], shear stress on the right side [Pa]
RATIOS = np.array([0.2, 0.4, 0.45, 0.49, 0.499, 0.4999])
# divisions of a side over those of the crossed mesh, for as many triangles
PARTS = {"crossed": 1.0, "alternating": 1.4, "unstructured": 1.3}

# Quadratic displacements with linear pressures (Taylor and Hood), which do not lock; result:
# the mean deflection of the loaded side.
_TAYLOR_HOOD = f"""
real mu, bulk;
{{ ifstream file("material.txt"); file >> mu; file >> bulk; }}
real lambda = bulk - 2 * mu / 3;
mesh Th = square(30, 30, [{SIDE} * x, {SIDE} * y]);
fespace Vh(Th, [P2, P2, P1]);
Vh [u, v, p], [a, b, q];
solve panel([u, v, p], [a, b, q]) =
	int2d(Th)(2 * mu * (dx(u) * dx(a) + dy(v) * dy(b)) + mu * (dy(u) + dx(v)) * (dy(a) + dx(b))
		- p * (dx(a) + dy(b)) - q * (dx(u) + dy(v)) - p * q / lambda)
	- int1d(Th, 2)({LOAD} * b) + on(4, u = 0, v = 0);
ofstream result("result.txt");
result.precision(17);
result << int1d(Th, 2)(v) / {SIDE} << endl;
"""


def panel(pattern, cells):
	"""A square panel in one of the patterns of ddem.mesh.rectangle."""
	extra = {"seed": 1} if pattern == "unstructured" else {}
	return ddem.mesh.rectangle(SIDE, SIDE, SIDE / cells, pattern=pattern, **extra).reordered()


def deflection(mesh, displacement):
	"""Mean of u_y over the right side [m]."""
	right = mesh.boundary("right")
	right = right[np.argsort(mesh.nodes[right, 1])]
	return np.trapezoid(displacement[right, 1], mesh.nodes[right, 1]) / SIDE


@case(group="statics", seconds=6, needs="FreeFem++")
def incompressible(check, cells=12):
	"""Nearly incompressible: do the triangles lock?

	A square panel, clamped at the left and sheared at the right, with Poisson's ratio up to 0.4999, on three
	patterns of mesh. A mesh that locks moves less than a solution that cannot.

	At rest and without a load on its core, the core of a triangle sits where the linear interpolation between the
	vertices has it: all three sub-elements then have one stress, and the split triangle is the plain linear
	triangle. So it locks as that does: one constraint a triangle, against one node (two unknowns) for every two
	triangles. Only where four triangles meet along two straight lines one of their four constraints follows from
	the others and leaves room to move (Nagtegaal, Parks and Rice 1974): at the centres of crossed cells, and at
	every other node of alternating ones.

	The deflections are those of FreeFem++'s solutions on the split mesh; that they are the deformable triangles'
	too is seen from their forces, which balance in them.

	Reference: FreeFem++ with Taylor–Hood elements (quadratic displacements, linear pressures), 1800 of them, whose
	deflections are within 0.2 % of those of nine times as many;
	FreeFem++ with plain linear triangles on the same mesh.

	Expect: the split triangle moves as the plain one to round-off, in all meshes. The regular patterns stay within
	5 % of the reference for any Poisson's ratio; an unstructured mesh does up to 0.45 and locks beyond,
	see the note.
	"""
	reference, ratio_of, unbalanced, split = [], {pattern: [] for pattern in ddem.mesh.generate.PATTERNS}, 0.0, 0.0
	for poisson in RATIOS:
		bulk = 2 * SHEAR * (1 + poisson) / (3 * (1 - 2 * poisson))
		reference.append(
			float(
				freefem.run(
					_TAYLOR_HOOD,
					np.zeros((0, 2)),
					np.zeros((0, 3), int),
					{"material": [SHEAR, bulk]},
				)
			)
		)
		for pattern, ratios in ratio_of.items():
			O.reset()
			material = tools.elastic(young=2 * SHEAR * (1 + poisson), poisson=poisson, density=1000)
			mesh = panel(pattern, round(PARTS[pattern] * cells))
			loads = statics.nodal_loads(
				mesh,
				lambda x, y: x > SIDE - 1e-9,
				lambda points, normals: np.broadcast_to([0.0, LOAD], points.shape),
			)
			held = np.repeat((mesh.nodes[:, 0] < 1e-9)[:, None], 2, axis=1)
			solution = statics.solve_and_balance(mesh, material, loads, held)
			plain = freefem.solve(mesh.nodes, mesh.triangles, tools.lame(material), loads, held)
			unbalanced = max(unbalanced, solution.unbalanced)
			split = max(split, np.abs(solution.freefem[:len(plain)] - plain).max() / np.abs(plain).max())
			ratios.append(deflection(mesh, solution.freefem) / reference[-1])
	found = {pattern: np.array(ratios) for pattern, ratios in ratio_of.items()}
	check(
		"force out of balance in FreeFem++'s solutions, all meshes and ratios [-]",
		unbalanced, 0, 1e-8, "FreeFem++ on the split mesh", scale=1
	)
	check(
		"difference of split and plain triangles, all meshes and ratios [-]",
		split, 0, 1e-8, "FreeFem++ on the mesh itself", scale=1
	)
	for pattern, ratios in found.items():
		last = 2 if pattern == "unstructured" else -1
		check(
			f"deflection over reference, {pattern}, ν = {RATIOS[last]:g} [-]",
			ratios[last], 1, 5e-2, "FreeFem++, Taylor–Hood elements"
		)
	check.note(
		f"""A limit of the method: on unstructured meshes the panel moves only
		{100 * found["unstructured"][-2]:.0f} % of what it should at ν = 0.499 and
		{100 * found["unstructured"][-1]:.0f} % at 0.4999; crossed cells {100 * found["crossed"][-1]:.1f} %,
		alternating ones {100 * found["alternating"][-1]:.1f} %. Use a regular pattern above ν = 0.45.
		Concrete has 0.16, and its equation of state keeps it, since it raises both moduli alike."""
	)

	def draw():
		fig, (ax,) = tools.axes(height=58)
		for (pattern, ratios), marker in zip(found.items(), "osv"):
			ax.semilogx(0.5 - RATIOS, ratios, marker=marker, markersize=3.5, label=pattern)
		ax.axhline(1, color="0.6", linewidth=0.7)
		ax.invert_xaxis()
		ax.set_xticks(0.5 - RATIOS, [f"{ratio:g}" for ratio in RATIOS])
		ax.set_xticks([], minor=True)
		ax.set_ylim(0, 1.1)
		ax.set_xlabel("Poisson's ratio [-]")
		ax.set_ylabel("deflection over reference [-]")
		tools.legend(ax, 3)
		return fig

	check.picture(
		draw,
		"Deflection of a sheared panel over that of a solution that cannot lock, for three patterns with "
		"about 580 triangles each.",
	)
