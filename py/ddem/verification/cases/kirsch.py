# GPL v2 or later, see LICENSE.
"""Kirsch's plate with a hole."""
import numpy as np

from yade import ddem
from yade.ddem import plots
from yade.ddem.verification import case, elasticity, statics, tools

RADIUS, SIDE, PULL = 0.01, 0.05, 1e6  # [m], [m], [Pa]


def quarter_plate(fine, growth=0.12):
	"""A quarter of the plate with the hole at the origin; size *fine* at the hole, growing by *growth* a metre."""
	arc = np.linspace(np.pi / 2, 0, max(3, round(np.pi / 2 * RADIUS / fine)) + 1)
	outline = np.vstack(
		[RADIUS * np.column_stack([np.cos(arc), np.sin(arc)]), [(SIDE, 0), (SIDE, SIDE), (0, SIDE)]]
	)
	outline[0, 0] = outline[len(arc) - 1, 1] = 0.0
	return ddem.mesh.polygon(
		outline, size=lambda x, y: fine + growth * max(0.0, np.hypot(x, y) - RADIUS), seed=1
	).reordered()


def hoop_at_the_hole(points, stress, angles):
	"""Stress along the border of the hole [Pa] at these angles: from that of the triangles around,
	by a quadratic in a²/r² and the angle."""
	r, theta = np.hypot(*points.T), np.arctan2(points[:, 1], points[:, 0])
	c, s = np.cos(theta), np.sin(theta)
	hoop = stress[:, 0] * s**2 + stress[:, 1] * c**2 - 2 * stress[:, 2] * s * c
	coordinates = np.column_stack([RADIUS**2 / r**2, theta])
	return np.array([statics.recover(coordinates, hoop, np.array([1.0, angle]), radius=0.4) for angle in angles])


@case(group="statics", seconds=2, needs="FreeFem++")
def kirsch(check, fine=0.0004):
	"""Kirsch: a plate with a hole

	A plate is pulled by S along x. At the border of a hole the stress along it is three times S on the flanks and
	−S ahead of and behind it. A quarter of the plate, five radii wide, carries the exact tractions on its outer
	border, so that it is a piece of the infinite plate. The mesh is unstructured and finer towards the hole.

	Solved by FreeFem++ on the mesh in which every triangle is split at its centroid, and by deformable triangles,
	relaxed from rest.

	Reference: Kirsch (1898); Muskhelishov (1953), § 56a. FreeFem++ 4.15 with linear triangles.

	Expect: the forces of deformable triangles balance in FreeFem++'s solution to round-off; relaxed displacements
	agree with it to the residual; with triangles of a twenty-fifth of the radius at the hole displacements are
	within 0.3 % of Kirsch's, the peak stress within 1 %.
	"""
	material = tools.elastic()
	exact = elasticity.kirsch(material, PULL, RADIUS)
	mesh = quarter_plate(fine)
	x, y = mesh.nodes.T
	held = np.column_stack([x == 0, y == 0])
	loads = statics.nodal_loads(mesh, lambda x, y: (x > SIDE - 1e-9) | (y > SIDE - 1e-9), exact.traction)
	solution = statics.solve(mesh, material, loads, held)
	statics.check_equality(check, solution, unbalanced=1e-12, difference=1e-6)

	stress = solution.block.stress.mean(axis=1)[:, [0, 1, 3]]
	angles = np.linspace(0, np.pi / 2, 19)
	hoop = hoop_at_the_hole(mesh.centroids, stress, angles) / PULL
	check("stress along the hole at its flank over S [-]", hoop[-1], 3, 1e-2, "Kirsch (1898): 3 S")
	check("stress along the hole ahead of it over S [-]", hoop[0], -1, 3e-2, "Kirsch (1898): −S")
	check(
		"stress along the hole, largest error over S [-]", np.abs(hoop - 1 + 2 * np.cos(2 * angles)).max(), 0,
		5e-2, "Kirsch (1898): S (1 − 2 cos 2θ)", scale=1
	)
	relaxed, moved = solution.relaxed[:len(mesh.nodes)], exact.displacement(mesh.nodes)
	check(
		"displacement of the nodes, largest error over the largest [-]",
		np.abs(relaxed - moved).max() / np.abs(moved).max(), 0, 5e-3, "Kirsch (1898)", scale=1
	)
	norm = lambda values: np.sqrt(np.average((values**2).sum(axis=1), weights=mesh.areas))
	wanted = exact.stress(mesh.centroids)
	check(
		"stress everywhere, root mean square error [-]", norm(stress - wanted) / norm(wanted), 0, 2e-2,
		"Kirsch (1898)", scale=1
	)

	def draw():
		fig, (left, right) = tools.axes(plots.PAGE, 68, panels=2)
		plots.field(
			mesh, stress[:, 0] / PULL, r"$\sigma_{xx}/S$ [-]", ax=left, displacement=relaxed,
			scale=0.05 * SIDE / np.abs(relaxed).max()
		)
		left.set_title("deformed, enlarged")
		fine_angle = np.linspace(0, np.pi / 2, 200)
		right.plot(
			np.degrees(fine_angle), 1 - 2 * np.cos(2 * fine_angle), "k-", linewidth=0.8,
			label=r"Kirsch, $1 - 2\cos 2\theta$"
		)
		right.plot(np.degrees(angles), hoop, "o", markersize=3, label="deformable triangles")
		right.set_xlabel("angle from the pull [°]")
		right.set_ylabel(r"stress along the hole over $S$ [-]")
		tools.legend(right)
		return fig

	check.picture(
		draw,
		"Left: stress along the pull, on the deformed quarter. Right: stress along the border of the hole.",
	)
