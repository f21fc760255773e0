# GPL v2 or later, see LICENSE.
"""Gravity: a column settles under its own weight."""
import numpy as np

from yade import O, ddem
from yade.ddem.verification import case, elasticity, tools

WIDTH, HEIGHT, GRAVITY = 10.0, 40.0, 9.81  # [m], [m/s²]


@case(group="statics", seconds=0.5)
def settling(check, size=2.0):
	"""A column settles under its own weight

	The column stands on rollers, its sides are free. Gravity is switched on at once, damped until nothing moves.
	Away from the support only σ_yy is left:

		σ_yy = −ρ g (H − y),   σ_xx = σ_xy = 0

	and the mean of the top comes down by u. This is exact although the flat support disturbs the stress within one
	width of it (the free solution would curve the base): by Betti's theorem with the column under a uniform
	pressure. Mean stresses follow in the same way from virtual work, and as both trial fields are linear, finite
	elements have all three exactly on any mesh:

		u = ρ g H² (1 − ν²)/2E,   mean σ_yy = −ρ g H/2,   mean σ_xx = 0

	Reference: equilibrium of the part above y, and Hooke's law in plane strain (Timoshenko and Goodier, Theory of
	Elasticity, 1970, art. 96); Betti's theorem.

	Expect: weight, mean stresses and settlement to 1e-6: the residual of the relaxation is 1e-7; the stress of the
	triangles more than one width above the support within 1 % of its largest on 2 m triangles.
	"""
	material = tools.elastic()
	block = ddem.append(ddem.mesh.rectangle(WIDTH, HEIGHT, size, pattern="unstructured", seed=1), material)
	bottom, top = (block.boundary(side) for side in ("bottom", "top"))
	block.hold(bottom, "y")
	block.hold(bottom[:1], "x")
	engine = tools.start(rotation="none", gravity=(0, -GRAVITY, 0))
	ddem.relax(1e-7)

	weight = material.density * WIDTH * HEIGHT * GRAVITY
	force, mass = engine.array("nodeForce"), engine.array("nodeMass")
	held = np.isin(block.node_ids, bottom)
	support = -(force[held, 1] - GRAVITY * mass[held]).sum()
	check("force on the support [N]", support, weight, 1e-6, "equilibrium")
	stress = block.stress.mean(axis=1)
	mean = np.average(stress, axis=0, weights=block.area)
	check("mean σ_yy [Pa]", mean[1], -weight / (2 * WIDTH), 1e-6, "virtual work")
	check("mean σ_xx [Pa]", mean[0], 0, 1e-6, "virtual work", scale=weight / WIDTH)
	row = np.isin(block.node_ids, top)
	x, moved = block.mesh.nodes[row, 0], block.displacements[row, 1]
	settlement = -np.trapezoid(moved[np.argsort(x)], np.sort(x)) / WIDTH
	check(
		"settlement of the top, its mean [m]", settlement,
		weight / WIDTH * HEIGHT / (2 * elasticity.plane_modulus(material)),
		1e-6, "Betti's theorem"
	)
	y = block.mesh.centroids[:, 1]
	wrong = stress - np.outer(y - HEIGHT, np.array([0, 1, material.poisson, 0])) * material.density * GRAVITY
	above = y > WIDTH
	check(
		"stress above the support, largest error over ρ g H [-]", np.abs(wrong[above]).max() * WIDTH / weight,
		0, 1.2e-2, "equilibrium", scale=1
	)

	def draw():
		fig, (ax,) = tools.axes(height=60)
		ax.axhspan(0, WIDTH, color="0.92", zorder=0, linewidth=0)
		ax.text(-0.02, 0.5 * WIDTH, "disturbed by the flat support", ha="right", va="center")
		ax.plot(stress[:, 1] / 1e6, y, ".", markersize=2, label="triangles")
		ax.plot([-weight / WIDTH / 1e6, 0], [0, HEIGHT], "k-", linewidth=0.7, label="−ρ g (H − y)")
		ax.set_xlabel("vertical stress [MPa]")
		ax.set_ylabel("height [m]")
		tools.legend(ax)
		return fig

	check.picture(draw, "Vertical stress of the triangles over the height of the column at rest.")
