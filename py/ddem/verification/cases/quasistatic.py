# GPL v2 or later, see LICENSE.
"""The paper's reinforced block at rest, found by dynamic relaxation."""
import numpy as np

from yade import O, Vector3, ddem
from yade.ddem import plots
from yade.ddem.verification import case, freefem, statics, tools

WIDTH, HEIGHT, STRAIN = 0.10, 0.20, 1e-5
RESIDUAL = 1e-6  # wanted; see ddem.out_of_balance [-]
REBAR = ddem.mesh.box(0.043, 0.093, 0.057, 0.107)


def block_between_platens():
	"""The block of Zubelewicz (2018), section 4.3, elastic, its top moved down by STRAIN,
	both ends held laterally."""
	O.reset()
	tools.elastic("concrete", rotationStiffness=2)
	tools.elastic("steel", **tools.STEEL, rotationStiffness=2)
	block = ddem.append(
		ddem.mesh.rectangle(WIDTH, HEIGHT, size=0.01, regions={"steel": REBAR}),
		{"": "concrete", "steel": "steel"},
	)
	top = block.boundary("top")
	block.hold([*block.boundary("bottom"), *top])
	for i in top:
		O.bodies[int(i)].state.pos -= Vector3(0, STRAIN * HEIGHT, 0)
	return block


@case(group="dynamic relaxation", seconds=2, needs="FreeFem++")
def dynamic_relaxation(check):
	"""Dynamic relaxation of a reinforced block

	The block with a steel rebar of the paper's section 4.3 (10 cm × 20 cm, 800 triangles, 8 of them steel), elastic
	here, its rough ends moved together by 10⁻⁵ of its height. Steps with local damping bring it to rest until the
	largest force out of balance is 10⁻⁶ of the force a triangle transmits (ddem.relax).

	Reference: FreeFem++ on the mesh in which every triangle is split at its centroid, two materials;
	equilibrium of the block.

	Expect: displacements and the forces on the platens within 3·10⁻⁶ of FreeFem++, some times the residual;
	the rotation of frames changes them by less than that at this strain. The compact block comes to rest fastest
	with little damping, see the note.
	"""
	histories = {}
	for damping in (0.1, 0.3, 0.7):
		block_between_platens()
		tools.start(rotation="none", damping=damping)
		steps, residuals = [], []
		for _ in range(24):
			O.run(249, True)
			steps.append(O.iter)
			residuals.append(ddem.out_of_balance())
		histories[damping] = steps, residuals

	for rotation in tools.TREATMENTS:
		block = block_between_platens()
		mesh = block.mesh
		nodes, triangles = statics.split_at_centroids(mesh)
		moduli = np.array(
			[tools.lame(O.materials["steel" if region else "concrete"]) for region in mesh.regions]
		)
		ends = np.isin(np.arange(len(nodes)), mesh.boundary(lambda x, y: (y < 1e-9) | (y > HEIGHT - 1e-9)))
		values = np.zeros(nodes.shape)
		values[mesh.boundary("top"), 1] = -STRAIN * HEIGHT
		expected = freefem.solve(
			nodes, triangles, np.repeat(moduli, 3, axis=0), np.zeros(nodes.shape),
			np.repeat(ends[:, None], 2, axis=1), values
		)
		engine = tools.start(rotation=rotation)
		_, steps = ddem.relax(RESIDUAL)
		source = "FreeFem++ on the split mesh"
		found = np.vstack([engine.array("nodePosition"), engine.array("corePosition")]) - nodes
		difference = np.abs(found - expected).max() / np.abs(expected).max()
		check(
			f"displacements after {steps} steps, largest difference, {rotation} [-]",
			difference, 0, 3e-6, source, scale=1
		)
		bottom, top = (
			block.node_forces[np.isin(block.node_ids, block.boundary(side)), 1].sum()
			for side in ("bottom", "top")
		)
		force = platen_force(nodes, triangles, expected, np.repeat(moduli, 3, axis=0))
		check(f"force on the upper platen, {rotation} [N/m]", top, force, 3e-6, source)
		check(
			f"force on both platens over that on one, {rotation} [-]", (bottom + top) / top, 0, 3e-6,
			"equilibrium of the block", scale=1
		)
	after = {damping: residuals[7] for damping, (_, residuals) in histories.items()}
	check.note(
		f"""Local damping acts on every degree of freedom by the sign of its own motion, and so keeps stiff
		modes going while slow ones move. After 2000 steps the residual is {after[0.1]:.0e} with a coefficient
		of 0.1, {after[0.3]:.0e} with 0.3 and {after[0.7]:.0e} with 0.7. What bends takes many times as many
		steps, see ddem.relax."""
	)
	axial = block.stress.mean(axis=1)[:, 1]
	drawn = block.mesh, axial / abs(np.average(axial, weights=block.area))

	def draw():
		fig, (left, right) = tools.axes(plots.PAGE, 78, panels=2, width_ratios=(1, 1.5))
		plots.field(drawn[0], drawn[1], r"$\sigma_{yy}$ over its mean [-]", ax=left)
		for damping, (steps, residuals) in histories.items():
			right.semilogy(steps, residuals, "o-", markersize=2.5, label=f"damping {damping:g}")
		right.axhline(RESIDUAL, color="0.6", linewidth=0.7)
		right.set_xlabel("steps [-]")
		right.set_ylabel("largest force out of balance [-]")
		tools.legend(right, 3)
		return fig

	check.picture(draw, "Left: axial stress of the block at rest. Right: how the forces come into balance.")


def platen_force(nodes, triangles, displacement, moduli):
	"""Force per thickness [N/m] of the block on the upper platen, by the work that the stress of linear triangles
	does on a uniform strain along y."""
	a, b, c = (nodes[triangles[:, k]] for k in range(3))
	sides = np.stack([b - a, c - a], axis=1)
	moved = np.stack([displacement[triangles[:, k]] - displacement[triangles[:, 0]] for k in (1, 2)], axis=1)
	gradient = np.linalg.solve(sides, moved)  # [direction, component]
	lam, mu = moduli.T
	axial = lam * (gradient[:, 0, 0] + gradient[:, 1, 1]) + 2 * mu * gradient[:, 1, 1]
	return -(axial * np.abs(np.linalg.det(sides)) / 2).sum() / HEIGHT
