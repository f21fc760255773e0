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
	"""An irregular mesh, sheared and stretched so that no triangle is equilateral and no edge
	is parallel to an axis."""
	plain = ddem.mesh.rectangle(0.05, 0.04, size=0.011, pattern="unstructured", seed=3)
	return ddem.mesh.Mesh(plain.nodes @ np.array([[1.0, 0.15], [0.3, 0.8]]), plain.triangles)


def deform(block, gradient, turns=0.0, turn=0.0):
	"""Displace nodes and cores by the gradient [-] and turn the cores by angles [rad], one a triangle; then turn
	all by an angle [rad]. One step takes it up, everything held but the cores' rotation."""
	for body in tools.bodies(block):
		body.state.blockedDOFs = "xyzXY"
	f = rotation(turn) @ (np.eye(2) + gradient)
	tools.place(block, lambda x, y: (f[0, 0] * x + f[0, 1] * y, f[1, 0] * x + f[1, 1] * y))
	for i, angle in zip(block.triangle_ids, np.broadcast_to(turns, len(block.triangle_ids)) + turn):
		O.bodies[int(i)].state.ori = (Vector3(0, 0, 1), float(angle))
	O.step()


def moments(block):
	"""On cores [N·m], from the spin that the first step from rest gave them."""
	states = [O.bodies[int(i)].state for i in block.triangle_ids]
	return np.array([state.inertia[2] * state.angVel[2] / O.dt for state in states])


def rotation(angle):
	"""Matrix of a rotation by an angle [rad]."""
	return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def rigid_turn(mesh, gradient):
	"""Rotations of cores [rad] that leave no rotation strain ε_φ, to first order:
	the mean rotation of the three vertices about the centroid."""
	arms = mesh.nodes[mesh.triangles] - mesh.centroids[:, None]
	moved = arms @ np.reshape(gradient, (2, 2)).T
	return ((arms[..., 0] * moved[..., 1] - arms[..., 1] * moved[..., 0]) / (arms**2).sum(axis=2)).mean(axis=1)


def polar(f):
	"""Rotation and stretch (2, 2) of a deformation gradient."""
	turn = rotation(np.arctan2(f[1, 0] - f[0, 1], f[0, 0] + f[1, 1]))
	return turn, turn.T @ f


def expected_stress(gradient, treatment, material, turn):
	"""Stress xx, yy, zz, xy [Pa] of a homogeneous deformation: Hooke's law for the linear strain, or for the
	stretch U − 1 in the material's frame, turned back."""
	lam, mu = tools.lame(material)
	f = rotation(turn) @ (np.eye(2) + gradient)
	frame, stretch = (np.eye(2), 0.5 * (f + f.T)) if treatment == "none" else polar(f)
	strain = stretch - np.eye(2)
	stress = frame @ (lam * np.trace(strain) * np.eye(2) + 2 * mu * strain) @ frame.T
	return np.array([stress[0, 0], stress[1, 1], lam * np.trace(strain), stress[0, 1]])


def patch_errors(treatment, beta, amount, turn=0.0):
	"""Largest errors in all modes: of the stress, over the largest; of the force on inner nodes and on cores, over
	the largest on a node; of the moment on cores, over that force times the triangle's size [-].
	And the last block."""
	worst = np.zeros(4)
	for mode in MODES.values():
		O.reset()
		material = tools.elastic(rotationStiffness=beta)
		block = ddem.append(skewed_mesh(), material)
		with tools.without_warnings():  # of β_φ = 0, which lets cores go
			engine = tools.start(rotation=treatment)
		gradient = amount * np.reshape(mode, (2, 2))
		# of the polar decomposition
		angle = np.arctan2(gradient[1, 0] - gradient[0, 1], 2 + np.trace(gradient))
		deform(block, gradient, rigid_turn(block.mesh, gradient) if beta else angle, turn)
		expected = expected_stress(gradient, treatment, material, turn)
		inner = np.setdiff1d(np.arange(len(block.node_ids)), block.mesh.boundary())
		force = np.linalg.norm(block.node_forces, axis=1)
		errors = [
			np.abs(block.stress - expected).max() / np.abs(expected).max(),
			force[inner].max() / force.max(),
			np.linalg.norm(engine.array("coreForce"), axis=1).max() / force.max(),
			np.abs(moments(block) / block.mesh.sizes).max() / force.max()
		]
		worst = np.maximum(worst, errors)
	return worst, block


@case(group="the element", seconds=1)
def patch_test(check):
	"""Patch test: homogeneous strain on a skewed mesh

	All nodes are put where a homogeneous deformation would bring them, in six modes, and the whole sample is turned
	by 2 rad as well where the frame follows. Every sub-element of every triangle must then have the same stress,
	and the forces on inner nodes, on cores, and the moments on cores must vanish:

		σ = λ tr(ε) 1 + 2μ ε

	ε is the linear strain with rotation “none”, and the stretch U − 1 in the turned frame with the others.
	With β_φ > 0 a core is at rest where its rotation strain ε_φ is zero. In a triangle that is not equilateral
	strain alone makes the vertices turn about the centroid, so the core does not turn with the material but by the
	mean of its vertices; strain is then measured in a frame off by the strain, and the test is passed to first
	order in it. A core that is turned by a small angle θ out of this place is pulled back by the moment μ β_φ S θ.

	Reference: Hooke's law in plane strain; the test is that of Irons and Razzaque (1972). The moment: derivative of
	the energy ½ μ β_φ ε_φ² S (Zubelewicz 2018, section 2).

	Expect: round-off, except with β_φ = 2: there an error in proportion to the strain.
	"""
	runs = [
		("none", "none", 2.0, 0.1, 0.0, 1e-12), ("corotational", "corotational", 2.0, 0.1, 2.0, 1e-12),
		("cosserat, β_φ = 0", "cosserat", 0.0, 0.1, 2.0, 1e-12),
		("cosserat, β_φ = 2", "cosserat", 2.0, 1e-6, 2.0, 2e-6)
	]
	for name, treatment, beta, amount, turn, tolerance in runs:
		errors, block = patch_errors(treatment, beta, amount, turn)
		if treatment == "none":
			drawn = block.mesh, block.displacements.copy()
		for what, error in zip(("stress", "force on inner nodes", "force on cores", "moment on cores"), errors):
			if what != "moment on cores" or treatment == "cosserat":
				check(
					f"{what}, {name}, strain {amount:g} [-]", error, 0, tolerance,
					"Hooke's law in plane strain, equilibrium", scale=1
				)

	O.reset()
	material, angle = tools.elastic(rotationStiffness=2), 1e-5
	block = ddem.append(skewed_mesh(), material)
	tools.start(rotation="cosserat")
	deform(block, np.zeros((2, 2)), angle)
	ratios = -moments(block) / (2 * material.shear * block.mesh.areas * angle)
	check(
		"moment on a turned core over μ β_φ S θ, the worst [-]",
		ratios[np.argmax(np.abs(ratios - 1))],
		1,
		1e-8,
		"derivative of ½ μ β_φ ε_φ² S",
	)

	def draw():
		fig, (left, right) = tools.axes(plots.PAGE, 60, panels=2)
		mesh, moved = drawn
		for nodes, colour, label in (
			(mesh.nodes, "0.7", "mesh"),
			(mesh.nodes + moved, plots.COLOURS[0], "mode “all”"),
		):
			left.triplot(*(1e3 * nodes.T), mesh.triangles, color=colour, linewidth=0.6)
			left.plot([], [], color=colour, linewidth=0.6, label=label)
		left.set_aspect("equal")
		left.set_xlabel("$x$ [mm]")
		left.set_ylabel("$y$ [mm]")
		tools.legend(left)
		amounts = 10.0**np.arange(-6, 0)
		for (name, treatment, beta, _, turn, _), marker in zip(runs, "s^vo"):
			errors = [patch_errors(treatment, beta, amount, turn)[0][0] for amount in amounts]
			right.loglog(
				amounts, errors, marker=marker, markersize=3.5,
				label=name.replace("β_φ", r"$\beta_\varphi$")
			)
		right.set_xlabel("strain [-]")
		right.set_ylabel("largest error of the stress [-]")
		tools.legend(right)
		return fig

	check.picture(
		draw,
		"Left: the skewed mesh and its last mode. Right: largest error of the stress in all modes over the "
		"size of the strain: round-off of positions, or with β_φ = 2 half the strain itself.",
	)


@case(group="the element", seconds=0.2)
def rigid_motion(check):
	"""Rigid motion through any angle

	A skewed sample is shifted by 1 m and turned by 16 angles up to 2.5 turns. Frames that follow the material
	(corotational, cosserat) must find no stress at all; a frame that does not (none) finds the strain cos
	θ − 1, which is why it is for small rotations.

	Reference: objectivity: a rigid motion has no strain. For the fixed frame:
	ε = cos θ − 1, the linear strain of a rigid turn.

	Expect: stress below 1e-12 of the bulk modulus, and forces below it times the triangle's size: round-off of
	positions of 1 m in triangles of 1 cm.
	"""
	angles = np.linspace(0, 5 * np.pi, 17)[1:]
	found, forces = {}, {}
	for treatment in tools.TREATMENTS:
		O.reset()
		material = tools.elastic()
		block = ddem.append(skewed_mesh(), material)
		for body in tools.bodies(block):
			body.state.blockedDOFs = "xyzXYZ"
		tools.start(rotation=treatment)
		found[treatment], forces[treatment] = [], []
		for angle in angles:
			c, s = np.cos(angle), np.sin(angle)
			tools.place(block, lambda x, y: (c * x - s * y + 1, s * x + c * y))
			for i in block.triangle_ids:
				O.bodies[int(i)].state.ori = (Vector3(0, 0, 1), float(angle))
			O.step()
			found[treatment].append(np.abs(block.stress).max() / material.bulk)
			forces[treatment].append(
				np.linalg.norm(block.node_forces, axis=1).max()
				/ (material.bulk * block.mesh.sizes.mean())
			)
		if treatment == "none":
			strain = block.strain[..., 0] - (np.cos(angles[-1]) - 1)
			check(
				"strain error of the fixed frame after 2.5 turns [-]", np.abs(strain).max(), 0, 1e-12,
				"linear strain of a rigid turn, cos θ − 1", scale=1
			)
		else:
			check(
				f"largest stress over the bulk modulus, {treatment} [-]", max(found[treatment]), 0,
				1e-12, "objectivity", scale=1
			)
			check(
				f"largest force over the bulk modulus and size, {treatment} [-]",
				max(forces[treatment]), 0, 1e-12, "objectivity", scale=1
			)

	def draw():
		fig, (ax,) = tools.axes(height=55)
		for treatment, marker, size in zip(tools.TREATMENTS, "s^o", (3, 6, 3)):
			ax.semilogy(angles / (2 * np.pi), found[treatment], marker, markersize=size, label=treatment)
		ax.set_xlabel("turns [-]")
		ax.set_ylabel("stress over bulk modulus [-]")
		tools.legend(ax, 3)
		return fig

	check.picture(draw, "Largest stress that a rigid turn causes in each treatment of rotation.")
