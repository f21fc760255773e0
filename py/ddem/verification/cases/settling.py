# GPL v2 or later, see LICENSE.
"""Gravity: a column settles under its own weight."""
import numpy as np

from yade import O, ddem
from yade.ddem.verification import case, tools

WIDTH, HEIGHT, GRAVITY = 10.0, 40.0, 9.81  # [m], [m/s²]


@case(group="statics", seconds=0.5)
def settling(check, size=2.0):
	"""A column settles under its own weight

	The column stands on rollers, its sides are free. Gravity is switched on at once, damped until nothing moves. Only σ_yy is left, and the top comes down by
	u:

		σ_yy = −ρ g (H − y),   σ_xx = σ_xy = 0,   u = ρ g H² (1 − ν²)/2E

	Reference: equilibrium of the part above y, and Hooke's law in plane strain (Timoshenko and Goodier, Theory of Elasticity, 1970, art. 96).

	Expect: the weight on the support and the mean stress, which follows from virtual work, to the residual of the relaxation (1e-7); the settlement within
	0.5 % on 2 m cells.
	"""
	material = tools.elastic(rotationStiffness=0)
	block = ddem.append(ddem.mesh.rectangle(WIDTH, HEIGHT, size), material)
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
	mean = np.average(block.stress.mean(axis=1), axis=0, weights=block.area)
	check("mean σ_yy [Pa]", mean[1], -weight / (2 * WIDTH), 1e-6, "virtual work with a linear displacement, exact on any mesh")
	check("mean σ_xx [Pa]", mean[0], 0, 1e-6, "free sides", scale=weight / WIDTH)
	settlement = -block.displacements[np.isin(block.node_ids, top), 1].mean()
	modulus = material.young / (1 - material.poisson**2)
	check("settlement of the top [m]", settlement, weight / WIDTH * HEIGHT / (2 * modulus), 5e-3, "Hooke's law in plane strain")
	y, stress = block.mesh.centroids[:, 1], block.stress.mean(axis=1)[:, 1]

	def draw():
		fig, (ax,) = tools.axes(height=60)
		ax.plot(stress / 1e6, y, ".", markersize=2, label="triangles")
		ax.plot([-weight / WIDTH / 1e6, 0], [0, HEIGHT], "k-", linewidth=0.7, label="−ρ g (H − y)")
		ax.set_xlabel("vertical stress [MPa]")
		ax.set_ylabel("height [m]")
		tools.legend(ax)
		return fig

	check.picture(draw, "Vertical stress of the triangles over the height of the column at rest.")
