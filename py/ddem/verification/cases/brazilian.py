# GPL v2 or later, see LICENSE.
"""The Brazilian test: a disc between two points."""
import numpy as np

from yade import ddem
from yade.ddem import plots
from yade.ddem.verification import case, statics, tools

RADIUS, FORCE, CORNERS = 0.05, 1e6, 120  # [m], [N/m], of the polygon


@case(group="statics", seconds=3, needs="FreeFem++")
def brazilian(check, size=0.004):
	"""Brazilian disc: tension at the centre

	Two opposite forces P per thickness press a disc of diameter D along y. At its centre

		σ_xx = 2P/πD,   σ_yy = −6P/πD,   σ_xy = 0

	and along the diameter across the load, at r = 2x/D from it,

		σ_xx = 2P/πD ((1 − r²)/(1 + r²))²,   σ_yy = 2P/πD (1 − 4/(1 + r²)²)

	The mesh is unstructured; the forces act on single nodes, so that the stress there grows without bound as the
	mesh is refined, while that at the centre converges. The lower pole is held.

	Solved by FreeFem++ on the mesh in which every triangle is split at its centroid, and by deformable triangles,
	relaxed from rest.

	Reference: Hertz (1883); Timoshenko and Goodier, Theory of Elasticity (1970),
	art. 41. FreeFem++ 4.15 with linear triangles.

	Expect: the forces of deformable triangles balance in FreeFem++'s solution to round-off; relaxed displacements
	agree with it to the residual; the centre is within 1 % of the exact stress and all of the diameter within 2 %
	of that at the centre, with 25 triangles along it.
	"""
	material = tools.elastic()
	mesh = ddem.mesh.polygon(ddem.mesh.disc(0, 0, RADIUS, CORNERS), size=size, seed=1).reordered()
	x, y = mesh.nodes.T
	top, bottom = np.argmax(y), np.argmin(y)
	loads, held = np.zeros(mesh.nodes.shape), np.zeros(mesh.nodes.shape, bool)
	loads[top, 1] = -FORCE
	held[bottom] = True
	held[top, 0] = True
	solution = statics.solve(mesh, material, loads, held)
	statics.check_equality(check, solution, unbalanced=1e-12, difference=1e-5)

	unit = FORCE / (np.pi * 2 * RADIUS)
	stress = solution.block.stress.mean(axis=1)[:, [0, 1, 3]]
	centre = statics.recover(mesh.centroids, stress, np.zeros(2), 0.3 * RADIUS) / unit
	check("σ_xx at the centre over P/πD [-]", centre[0], 2, 2e-2, "Timoshenko and Goodier (1970), art. 41: 2P/πD")
	check("σ_yy at the centre over P/πD [-]", centre[1], -6, 1e-2, "Timoshenko and Goodier (1970), art. 41: −6P/πD")
	check("σ_xy at the centre over P/πD [-]", centre[2], 0, 1e-2, "symmetry", scale=2)
	places = np.linspace(0, 0.95, 20)
	along = (
		np.array(
			[
				statics.recover(mesh.centroids, stress, np.array((place * RADIUS, 0.0)), 0.25 * RADIUS)
				for place in places
			]
		)
		/ unit
	)
	exact = lambda r: np.array([2 * ((1 - r**2) / (1 + r**2))**2, 2 - 8 / (1 + r**2)**2])
	wrong = np.abs(along[:, :2].T - exact(places)).max(axis=1)
	for name, error, scale in zip(("σ_xx", "σ_yy"), wrong, (2, 6)):
		check(
			f"{name} along the diameter, largest error over that at the centre [-]",
			error / scale, 0, 2e-2, "Timoshenko and Goodier (1970), art. 41", scale=1
		)

	def draw():
		fig, (left, right) = tools.axes(plots.PAGE, 68, panels=2)
		plots.field(
			mesh, stress[:, 0] / unit, r"$\sigma_{xx}\,\pi D/P$ [-]", ax=left, limits=(-3, 3), signed=True
		)
		r = np.linspace(0, 1, 200)
		right.plot(r, exact(r).T, "k-", linewidth=0.8, label=["Hertz", None])
		right.plot(places, along[:, 0], "o", markersize=3, label=r"$\sigma_{xx}$")
		right.plot(places, along[:, 1], "s", markersize=3, label=r"$\sigma_{yy}$")
		right.set_xlabel("distance from the centre over the radius [-]")
		right.set_ylabel(r"stress $\pi D/P$ [-]")
		tools.legend(right, 3)
		return fig

	check.picture(
		draw,
		"Left: stress across the loaded diameter; it is tensile between the poles. Right: stresses along the "
		"horizontal diameter.",
	)
