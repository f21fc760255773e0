# GPL v2 or later, see LICENSE.
"""Patch test and rigid motion: what every element must do exactly."""
import numpy as np

from yade import O, Vector3, ddem
from yade.ddem import plots
from yade.ddem.verification import case, tools

# displacement gradients: xx, xy, yx, yy
MODES = {
	"stretch x": (1, 0, 0, 0),
	"stretch y": (0, 0, 0, 1),
	"pure shear": (0, 1, 1, 0),
	"volume": (1, 0, 0, 1),
	"simple shear": (0, 1, 0, 0),
	"all": (0.7, -0.4, 0.9, -0.5)
}


def skewed_mesh():
	"""An irregular mesh, sheared and stretched so that no triangle is equilateral and no edge is parallel to an axis."""
	plain = ddem.mesh.rectangle(0.05, 0.04, size=0.011, pattern="unstructured", seed=3)
	return ddem.mesh.Mesh(plain.nodes @ np.array([[1.0, 0.15], [0.3, 0.8]]), plain.triangles)


def deform(block, gradient, turns=None):
	"""Displace nodes and cores by the gradient [-] and turn the cores by angles [rad], one a triangle; one step that takes them up, everything held."""
	for body in tools.bodies(block):
		body.state.blockedDOFs = "xyzXYZ"
	g = np.reshape(gradient, (2, 2))
	tools.place(block, lambda x, y: (x + g[0, 0] * x + g[0, 1] * y, y + g[1, 0] * x + g[1, 1] * y))
	for i, angle in zip(block.triangle_ids, np.broadcast_to(0.0 if turns is None else turns, len(block.triangle_ids))):
		O.bodies[int(i)].state.ori = (Vector3(0, 0, 1), float(angle))
	O.step()


def rigid_turn(mesh, gradient):
	"""Rotations of cores [rad] that leave no rotation strain ε_φ, to first order: the mean rotation of the three vertices about the centroid."""
	arms = mesh.nodes[mesh.triangles] - mesh.centroids[:, None]
	moved = arms @ np.reshape(gradient, (2, 2)).T
	return ((arms[..., 0] * moved[..., 1] - arms[..., 1] * moved[..., 0]) / (arms**2).sum(axis=2)).mean(axis=1)


def polar(f):
	"""Rotation angle [rad] and stretch of a deformation gradient."""
	angle = np.arctan2(f[1, 0] - f[0, 1], f[0, 0] + f[1, 1])
	return angle, np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]) @ f


def expected_stress(f, treatment, material):
	"""Stress xx, yy, zz, xy [Pa] of a homogeneous deformation: Hooke's law for the linear strain, or for the stretch in the material's frame, turned back."""
	lam, mu = tools.lame(material)
	angle, stretch = (0.0, 0.5 * (f + f.T)) if treatment == "none" else polar(f)
	strain = stretch - np.eye(2)
	turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
	stress = turn @ (lam * np.trace(strain) * np.eye(2) + 2 * mu * strain) @ turn.T
	return np.array([stress[0, 0], stress[1, 1], lam * np.trace(strain), stress[0, 1]])


@case(group="the element", seconds=0.5)
def patch_test(check, amount=0.1):
	"""Patch test: homogeneous strain on a skewed mesh

	All nodes are put where a homogeneous deformation would bring them, in six modes. Every sub-element of every triangle must then have the same stress, and
	the forces on inner nodes must vanish:

		σ = λ tr(ε) 1 + 2μ ε

	ε is the linear strain with rotation “none”, and the stretch U − 1 in the turned frame with the others. With β_φ > 0 a core is at rest where its rotation
	strain ε_φ is zero. In a triangle that is not equilateral strain alone makes the vertices turn about the centroid, so the core does not turn with the
	material but by the mean of its vertices; strain is then measured in a frame off by the strain, and the test is passed to first order in it.

	Reference: Hooke's law in plane strain; the test is that of Irons and Razzaque (1972).

	Expect: round-off, except with β_φ = 2: there the strain of 1e-6 itself.
	"""
	runs = [("none", 2.0, amount, 1e-12), ("corotational", 2.0, amount, 1e-12), ("cosserat", 0.0, amount, 1e-12), ("cosserat", 2.0, 1e-6, 2e-6)]
	drawn = None
	for treatment, stiffness, size, tolerance in runs:
		worst, forces = 0.0, 0.0
		for gradient in MODES.values():
			O.reset()
			material = tools.elastic(rotationStiffness=stiffness)
			block = ddem.append(skewed_mesh(), material)
			with tools.without_warnings():  # of β_φ = 0, which lets cores go
				tools.start(rotation=treatment)
			g = size * np.reshape(gradient, (2, 2))
			deform(block, g, rigid_turn(block.mesh, g) if stiffness else polar(np.eye(2) + g)[0])
			expected = expected_stress(np.eye(2) + g, treatment, material)
			worst = max(worst, np.abs(block.stress - expected).max() / np.abs(expected).max())
			inner = np.setdiff1d(np.arange(len(block.node_ids)), block.mesh.boundary())
			force = np.linalg.norm(block.node_forces, axis=1)
			forces = max(forces, force[inner].max() / force.max())
		name = f"{treatment}{f', β_φ = {stiffness:g}' if treatment == 'cosserat' else ''}, strain {size:g}"
		check(f"error of the stress, {name} [-]", worst, 0, tolerance, "Hooke's law in plane strain", scale=1)
		check(f"force on inner nodes, {name} [-]", forces, 0, tolerance, "equilibrium of a homogeneous stress", scale=1)
		if drawn is None:
			drawn = block.mesh, block.displacements.copy(), block.stress[..., 3] / 1e9

	def draw():
		mesh, moved, shear = drawn
		return plots.field(mesh, shear, r"shear stress $\sigma_{xy}$ [GPa]", displacement=moved, signed=True, edges=True)

	check.picture(draw, "The skewed mesh, deformed by the last mode (“all”): one stress everywhere.")


@case(group="the element", seconds=0.2)
def rigid_motion(check):
	"""Rigid motion through any angle

	A skewed sample is shifted by 1 m and turned by 16 angles up to 2.5 turns. Frames that follow the material (corotational, cosserat) must find no stress at
	all; a frame that does not (none) finds the strain cos θ − 1, which is why it is for small rotations.

	Reference: objectivity: a rigid motion has no strain. For the fixed frame: ε = cos θ − 1, the linear strain of a rigid turn.

	Expect: stress below 1e-12 of the bulk modulus: round-off of positions of 1 m in triangles of 1 cm.
	"""
	angles = np.linspace(0, 5 * np.pi, 17)[1:]
	found = {}
	for treatment in tools.TREATMENTS:
		O.reset()
		material = tools.elastic()
		block = ddem.append(skewed_mesh(), material)
		for body in tools.bodies(block):
			body.state.blockedDOFs = "xyzXYZ"
		tools.start(rotation=treatment)
		found[treatment] = []
		for angle in angles:
			c, s = np.cos(angle), np.sin(angle)
			tools.place(block, lambda x, y: (c * x - s * y + 1, s * x + c * y))
			for i in block.triangle_ids:
				O.bodies[int(i)].state.ori = (Vector3(0, 0, 1), float(angle))
			O.step()
			found[treatment].append(np.abs(block.stress).max() / material.bulk)
		if treatment == "none":
			strain = block.strain[..., 0] - (np.cos(angles[-1]) - 1)
			check("strain error of the fixed frame after 2.5 turns [-]", np.abs(strain).max(), 0, 1e-12, "linear strain of a rigid turn, cos θ − 1", scale=1)
		else:
			check(f"largest stress over the bulk modulus, {treatment} [-]", max(found[treatment]), 0, 1e-12, "objectivity", scale=1)

	def draw():
		fig, (ax,) = tools.axes(height=55)
		for treatment, marker in zip(tools.TREATMENTS, "s^o"):
			ax.semilogy(angles / (2 * np.pi), np.maximum(found[treatment], 1e-17), marker=marker, markersize=3, linestyle="-", label=treatment)
		ax.set_xlabel("turns [-]")
		ax.set_ylabel("stress over bulk modulus [-]")
		tools.legend(ax)
		return fig

	check.picture(draw, "Largest stress that a rigid turn causes in each treatment of rotation.")
