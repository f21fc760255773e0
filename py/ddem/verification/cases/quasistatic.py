# GPL v2 or later, see LICENSE.
"""The paper's reinforced block at rest, found by dynamic relaxation."""
import numpy as np

from yade import O, Vector3, ddem
from yade.ddem import plots
from yade.ddem.verification import case, freefem, statics, tools

WIDTH, HEIGHT, STRAIN = 0.10, 0.20, 1e-5
REBAR = ddem.mesh.box(0.043, 0.093, 0.057, 0.107)


def block_between_platens():
	"""The block of Zubelewicz (2018), section 4.3, elastic, its top moved down by STRAIN, both ends held laterally."""
	O.reset()
	tools.elastic("concrete", rotationStiffness=2)
	tools.elastic("steel", **tools.STEEL, rotationStiffness=2)
	block = ddem.append(ddem.mesh.rectangle(WIDTH, HEIGHT, size=0.01, regions={"steel": REBAR}), {"": "concrete", "steel": "steel"})
	top = block.boundary("top")
	block.hold([*block.boundary("bottom"), *top])
	for i in top:
		O.bodies[int(i)].state.pos -= Vector3(0, STRAIN * HEIGHT, 0)
	return block


@case(group="dynamic relaxation", seconds=2, needs="FreeFem++")
def dynamic_relaxation(check):
	"""Dynamic relaxation of a reinforced block

	The block with a steel rebar of the paper's section 4.3 (10 cm × 20 cm, 800 triangles, 8 of them steel), elastic here, its rough ends moved together by
	10⁻⁵ of its height. Steps with local damping bring it to rest until the largest force out of balance is 10⁻⁶ of the force a triangle transmits
	(ddem.relax).

	Reference: FreeFem++ on the mesh in which every triangle is split at its centroid, two materials.

	Expect: displacements and the stress on the platen as close to FreeFem++ as the residual says. Where frames rotate, they may differ by the strain of 10⁻⁵
	as well. The compact block comes to rest fastest with little damping, see the note.
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

	for rotation, tolerance in (("none", 1e-5), ("corotational", 1e-4), ("cosserat", 1e-4)):
		block = block_between_platens()
		mesh = block.mesh
		nodes, triangles = statics.split_at_centroids(mesh)
		moduli = np.array([tools.lame(O.materials["steel" if region else "concrete"]) for region in mesh.regions])
		ends = np.isin(np.arange(len(nodes)), mesh.boundary(lambda x, y: (y < 1e-9) | (y > HEIGHT - 1e-9)))
		values = np.zeros(nodes.shape)
		values[mesh.boundary("top"), 1] = -STRAIN * HEIGHT
		expected = freefem.solve(nodes, triangles, np.repeat(moduli, 3, axis=0), np.zeros(nodes.shape), np.repeat(ends[:, None], 2, axis=1), values)
		engine = tools.start(rotation=rotation)
		residual, steps = ddem.relax(1e-6)
		found = np.vstack([engine.array("nodePosition"), engine.array("corePosition")]) - nodes
		check(f"residual after {steps} steps, {rotation} [-]", residual, 0, 1e-6, "what was asked for", scale=1)
		check(
			f"difference of displacements to FreeFem++, {rotation} [-]",
			np.abs(found - expected).max() / np.abs(expected).max(),
			0,
			tolerance,
			"FreeFem++ on the split mesh",
			scale=1
		)
		stress = block.stress.mean(axis=1)
		strains = expected_strains(nodes, triangles, expected)
		lam, mu = np.repeat(moduli, 3, axis=0).T
		axial = (lam * strains.sum(axis=1) + 2 * mu * strains[:, 1]).reshape(-1, 3).mean(axis=1)
		mean = np.average(axial, weights=mesh.areas)
		check(f"mean axial stress, {rotation} [Pa]", np.average(stress[:, 1], weights=block.area), mean, tolerance, "FreeFem++ on the split mesh")
	after = {damping: residuals[7] for damping, (_, residuals) in histories.items()}
	check.note(
		f"""Local damping acts on every degree of freedom by the sign of its own motion, and so keeps stiff modes going while slow ones move. After 2000
		steps the residual is {after[0.1]:.0e} with a coefficient of 0.1, {after[0.3]:.0e} with 0.3 and {after[0.7]:.0e} with 0.7. Slender samples need more
		damping, because their slow modes take long to stop."""
	)
	drawn = block.mesh, stress[:, 1] / abs(mean)

	def draw():
		fig, (left, right) = tools.axes(plots.PAGE, 78, panels=2, width_ratios=(1, 1.5))
		plots.field(drawn[0], drawn[1], r"$\sigma_{yy}$ over its mean [-]", ax=left)
		for damping, (steps, residuals) in histories.items():
			right.semilogy(steps, residuals, "o-", markersize=2.5, label=f"damping {damping:g}")
		right.axhline(1e-6, color="0.6", linewidth=0.7)
		right.set_xlabel("steps [-]")
		right.set_ylabel("largest force out of balance [-]")
		tools.legend(right, 3)
		return fig

	check.picture(draw, "Left: axial stress of the block at rest. Right: how the forces come into balance.")


def expected_strains(nodes, triangles, displacement):
	"""xx and yy (m, 2) [-] of linear triangles."""
	a, b, c = (nodes[triangles[:, k]] for k in range(3))
	inverse = np.linalg.inv(np.stack([b - a, c - a], axis=1))
	moved = np.stack([displacement[triangles[:, k]] - displacement[triangles[:, 0]] for k in (1, 2)], axis=1)
	gradient = inverse @ moved  # [direction, component]
	return np.stack([gradient[:, 0, 0], gradient[:, 1, 1]], axis=1)
