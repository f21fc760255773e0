# GPL v2 or later, see LICENSE.
"""Large rotations: a spinning disc, a swinging block, a beam rolled up to a ring."""
import numpy as np
from scipy.special import ellipj, ellipk

from yade import O, Vector3, ddem
from yade.ddem import plots
from yade.ddem.verification import case, elasticity, tools

OBJECTIVE = ("corotational", "cosserat")  # treatments that follow rotation


@case(group="rotation", seconds=2)
def spinning_disc(check, size=0.007, turns=5):
	"""A disc spins five turns

	A disc of radius R begins to spin at ω = 5000 rad/s with the radial displacement of a steady spin, so that it
	hardly pulses. It must turn by ωt, keep its angular momentum and its energy, and carry the stress of a rotating
	disc in plane strain,

		σ_rr = K (R² − r²),   σ_θθ = K (R² − r² (1 + 2ν)/(3 − 2ν)),   K = ρ ω² (3 − 2ν)/(8 (1 − ν))

	Reference: Timoshenko and Goodier, Theory of Elasticity (1970), art. 32, for plane strain, R being the radius of
	the circle of the polygon's area; conservation of energy and momentum.

	Expect: momentum to round-off, energy to 2·10⁻⁸, the angle to 5·10⁻⁶; the stress of a triangle, averaged over
	the turns, within 3 % (root of the mean square over the disc, with 14 triangles across), its size, which is that
	of its projection on the exact stress, within 0.5 %.
	With triangles of half the size they are within 1 % and 0.04 %.
	"""
	radius, spin = 0.05, 5000.0
	drawn = {}
	for rotation in OBJECTIVE:
		O.reset()
		material = tools.elastic()
		nu = material.poisson
		block = ddem.append(ddem.mesh.polygon(ddem.mesh.disc(0, 0, radius, 48), size=size, seed=1), material)
		factor = (1 + nu) * (1 - 2 * nu) / (8 * (1 - nu) * material.young) * material.density * spin**2
		wide = lambda x, y: 1 + factor * ((3 - 2 * nu) * radius**2 - x * x - y * y)
		engine = tools.start(rotation=rotation)
		tools.place(block, lambda x, y: (x * wide(x, y), y * wide(x, y)))
		tools.set_velocity(block, lambda x, y: (-spin * y, spin * x), spin)
		energy = ddem.EnergyBalance()
		O.step()
		energy.record()  # what it begins with
		momentum, begin, angles, stress = angular_momentum(engine), O.time, [mean_turn(block)], 0.0
		for _ in range(8 * turns):
			O.run(int(2 * np.pi / spin / O.dt / 8), True)
			energy.record()
			angles.append(mean_turn(block))
			stress = stress + radial_stress(block) / (8 * turns)
		name = f"{(O.time - begin) * spin / (2 * np.pi):.2f} turns, {rotation}"
		check(
			f"angle after {name} [rad]", np.unwrap(angles)[-1] - angles[0], spin * (O.time - begin), 5e-6,
			"kinematics: ω t"
		)
		check(
			f"angular momentum after {name}, over its start [-]",
			angular_momentum(engine) / momentum,
			1,
			1e-12,
			"conservation of angular momentum",
		)
		check(
			f"energy after {name}, drift of the book [-]", energy.largest, 0, 2e-8,
			"conservation of energy", scale=1
		)
		r, rim = np.linalg.norm(block.mesh.centroids, axis=1), np.sqrt(block.mesh.areas.sum() / np.pi)
		k = material.density * spin**2 * (3 - 2 * nu) / (8 * (1 - nu))
		exact = k * np.column_stack([rim**2 - r**2, rim**2 - r**2 * (1 + 2 * nu) / (3 - 2 * nu)])
		product = lambda first, second: np.average((first * second).sum(axis=1), weights=block.mesh.areas)
		error, name = (
			np.sqrt(product(stress - exact, stress - exact) / product(exact, exact)),
			f"mean over {name}",
		)
		check(
			f"stress, {name}, projected on the exact one [-]",
			product(stress, exact) / product(exact, exact),
			1,
			5e-3,
			"Timoshenko and Goodier (1970), art. 32",
		)
		check(
			f"stress, {name}, root of the mean square error [-]", error, 0, 3e-2,
			"Timoshenko and Goodier (1970), art. 32", scale=1
		)
		drawn[rotation] = r / rim, stress / (k * rim**2)

	def draw():
		fig, (ax,) = tools.axes(height=62)
		place = np.linspace(0, 1, 100)
		ax.plot(place, 1 - place**2, "k-", linewidth=0.8, label="exact")
		ax.plot(place, 1 - place**2 * (1 + 2 * nu) / (3 - 2 * nu), "k-", linewidth=0.8)
		for (rotation, (r, values)), marker in zip(drawn.items(), "o+"):
			for column, name in enumerate(("rr", r"\theta\theta")):
				look = {
					"color": plots.COLOURS[column],
					"markersize": 2.5,
					"markerfacecolor": "none",
					"markeredgewidth": 0.5,
				}
				ax.plot(r, values[:, column], marker, label=rf"$\sigma_{{{name}}}$, {rotation}", **look)
		ax.set_xlabel("distance from the centre over the radius [-]")
		ax.set_ylabel("stress over that at the centre [-]")
		ax.set_xlim(0, 1)
		tools.legend(ax)
		return fig

	check.picture(draw, "Radial and hoop stress of the triangles of the spinning disc, averaged over the turns.")


def radial_stress(block):
	"""σ_rr and σ_θθ (m, 2) [Pa] of the triangles about the origin, where they are now."""
	x, y = block.positions[block.mesh.triangles].mean(axis=1).T
	c, s = np.array([x, y]) / np.hypot(x, y)
	xx, yy, _, xy = block.stress.mean(axis=1).T
	return np.column_stack([xx * c * c + yy * s * s + 2 * xy * s * c, xx * s * s + yy * c * c - 2 * xy * s * c])


def angular_momentum(engine):
	"""About the origin [kg·m²/s]."""
	total = 0.0
	for kind in ("node", "core"):
		mass, x, v = (engine.array(kind + part) for part in ("Mass", "Position", "Velocity"))
		total += (mass * (x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0])).sum()
	if engine.rotation == "cosserat":
		inertia = np.array([O.bodies[int(i)].state.inertia[2] for i in engine.values("triangleIds")])
		total += (inertia * engine.array("coreSpin")).sum()
	return total


def mean_turn(block):
	"""Angle [rad] by which the nodes have turned about the origin, the mean."""
	now, before = block.positions, block.mesh.nodes
	return np.angle(((now[:, 0] + 1j * now[:, 1]) * np.conj(before[:, 0] + 1j * before[:, 1])).sum())


@case(group="rotation", seconds=3)
def pendulum(check, swing=2.5, gravity=4e4):
	"""A block swings like a pendulum

	A stiff block hangs by one of its nodes and is let go from an angle of 143° against gravity. It is a physical
	pendulum of finite amplitude; its period follows from the complete elliptic integral K,

		T = 4 K(sin² θ₀/2) √(J/(m g d))

	J about the pivot, d its distance from the centre of mass. Rotation sweeps 286° to and fro. The block swings
	twice, under g and 2 g: it stretches by as much as g grows, so twice the first period less the second, in units
	of the exact ones, is that of a rigid block.

	Reference: the pendulum's exact period (Landau and Lifshitz, Mechanics, 1976, § 11) with J of the solid
	rectangle. Without rotating cores, J lacks the inertia of the cores, Σ ρS (a² + b² + c²)(1 − 4α)/36 over the
	triangles with sides a, b, c and a share α of mass in the vertices.

	Expect: a period that stretch makes longer by 2.5·10⁻⁴, and without it within 2·10⁻⁵; energy to 4·10⁻⁷.
	"""
	drawn = {}
	for rotation in OBJECTIVE:
		runs = [swinging(rotation, swing, factor * gravity) for factor in (1, 2)]
		ratios = [found / exact for _, _, found, exact, _ in runs]
		check(
			f"period without stretch over the exact one, {rotation} [-]",
			2 * ratios[0] - ratios[1],
			1,
			2e-5,
			"Landau and Lifshitz (1976), § 11",
		)
		check(
			f"drift of the energy book, {rotation} [-]",
			max(run[-1] for run in runs),
			0,
			4e-7,
			"conservation of energy",
			scale=1,
		)
		times, angle, _, exact, _ = runs[0]
		drawn[rotation] = times / exact, np.degrees(angle)
	check.note(
		f"Under g = {gravity:g} m/s² the block's stretch makes the period longer by {ratios[0] - 1:.1e}, "
		f"under twice that by {ratios[1] - 1:.1e}."
	)

	def draw():
		fig, (ax,) = tools.axes(height=58)
		for (rotation, (time, angle)), marker in zip(drawn.items(), "o+"):
			every = max(1, len(time) // 60)
			ax.plot(
				time[::every], angle[::every], marker, markersize=3.5, markerfacecolor="none",
				markeredgewidth=0.6, label=rotation
			)
		u = np.linspace(0, 1.35, 400)
		sn = ellipj(ellipk(np.sin(swing / 2)**2) * (1 + 4 * u), np.sin(swing / 2)**2)[0]
		ax.plot(u, np.degrees(2 * np.arcsin(np.sin(swing / 2) * sn)), "k-", linewidth=0.7, label="exact")
		ax.set_xlabel("time over the period [-]")
		ax.set_ylabel("angle [°]")
		tools.legend(ax, 3)
		return fig

	check.picture(draw, "Angle of the swinging block; the exact motion is 2 arcsin(sin(θ₀/2) sn).")


def swinging(rotation, swing, gravity):
	"""Let the block go: times [s] and angles [rad], the period found and the exact one [s],
	the drift of the energy book [-]."""
	O.reset()
	width, height = 0.04, 0.1
	block = ddem.append(ddem.mesh.rectangle(width, height, 0.02), tools.elastic())
	at = lambda x, y: int(np.argmin(np.hypot(block.mesh.nodes[:, 0] - x, block.mesh.nodes[:, 1] - y)))
	pivot, far = at(width / 2, height), at(width / 2, 0)
	place = block.mesh.nodes[pivot]
	block.hold(block.node_ids[[pivot]])
	turn = np.array([[np.cos(swing), -np.sin(swing)], [np.sin(swing), np.cos(swing)]])
	tools.place(block, lambda x, y: turn @ np.array([x - place[0], y - place[1]]) + place[:, None])
	for i in block.triangle_ids:
		O.bodies[int(i)].state.ori = (Vector3(0, 0, 1), swing)
	recorder = tools.Recorder(lambda: block.positions[far] - place, 20)
	engine = tools.start(recorder.engine, rotation=rotation, gravity=(0, -gravity, 0))

	inertia = (width**2 + height**2) / 12 + height**2 / 4  # over the mass [m²]
	if rotation != "cosserat":
		corners = block.mesh.nodes[block.mesh.triangles]
		sides = ((corners - np.roll(corners, 1, axis=1))**2).sum(axis=(1, 2))
		inertia -= np.average(sides, weights=block.mesh.areas) * (1 - 4 * engine.vertexShare) / 36
	exact = 4 * ellipk(np.sin(swing / 2)**2) * np.sqrt(inertia / (gravity * height / 2))

	energy = ddem.EnergyBalance()
	O.step()
	energy.record()  # what it begins with
	O.run(int(1.35 * exact / O.dt), True)
	energy.record()
	times, (x, y) = recorder.times, recorder.values.T
	angle = np.unwrap(np.arctan2(x, -y))
	angle -= 2 * np.pi * np.round((angle[0] - swing) / (2 * np.pi))
	down = np.flatnonzero((angle[:-1] > 0) & (angle[1:] <= 0))
	crossings = times[down] + angle[down] / (angle[down] - angle[down + 1]) * (times[down + 1] - times[down])
	return times, angle, crossings[1] - crossings[0], exact, energy.largest


@case(group="rotation", seconds=10)
def rolled_beam(check, cells=(4, 6)):
	"""A beam is rolled up to a ring

	A strip sixteen times as long as thick is bent to a half and to a full circle; the end faces stay plane, slide
	along themselves, and turn by ML/E'I = π and 2π. The moment on them is that of pure bending. For a material that
	is linear in the stretch U − 1 finite bending has a closed form: with κ = 2π/L and m = ν/(1 − ν) the radius r of
	the fibre at height Y in the straight strip follows from T_r' = κ T_θ,

		r'' = κ² r − κ (1 + m),   T_r = 0 at Y = ±h/2,   M = ∫ T_θ r dY → E'I κ for a thin strip

	with T_r = (λ + 2μ)(r' − 1) + λ(κr − 1) and T_θ likewise.
	It begins as a circle of unstrained thickness and is relaxed.

	Reference: the closed form, derived here; the elastica in the limit (Love, A Treatise on the Mathematical Theory
	of Elasticity, 1927, § 262).

	Expect: crossed cells are too stiff in bending by the square of their size, 5 % with four over the height and
	2 % with six. Extrapolated from the two by that square, the moment is within 0.2 % of the closed form, which
	lies 0.8 % and 3.0 % below that of a thin strip.
	"""
	length, height = 0.16, 0.01
	drawn, stiffness = [], {}
	for rotation, part, name in (("corotational", 0.5, "π"), ("corotational", 1.0, "2π"), ("cosserat", 1.0, "2π")):
		kappa, moments = 2 * np.pi * part / length, []
		for count in cells:
			material, block, moment, axial = rolled_up(rotation, kappa, length, height, count)
			moments.append(moment / thin_moment(material, height, kappa))
		exact = bending_moment(material, height, kappa) / thin_moment(material, height, kappa)
		check(
			f"moment at ML/E'I = {name} over that of a thin strip, extrapolated, {rotation} [-]",
			np.dot(moments, (-cells[0]**2, cells[1]**2)) / (cells[1]**2 - cells[0]**2), exact, 2e-3,
			"closed form of finite bending"
		)
		check(
			f"axial force at ML/E'I = {name} over M/h, {rotation} [-]", axial * height / moment, 0, 5e-4,
			"pure bending", scale=1
		)
		stiffness[name, rotation] = [value / exact - 1 for value in moments]
		drawn.append(
			(
				block.positions.copy(),
				block.mesh.triangles,
				along_fibres(block, kappa) / 1e9,
				f"$ML/E'I$ = {name}, {rotation}",
			)
		)
	check.note(
		f"Too stiff with {cells[0]} and with {cells[1]} cells over the height: "
		+ "; ".join(
			f"{100 * first:.1f} % and {100 * second:.1f} % at {name}, {rotation}"
			for (name, rotation), (first, second) in stiffness.items()
		)
		+ "."
	)

	def draw():
		fig, panels = tools.axes(plots.PAGE, 62, panels=3)
		largest = max(np.abs(stress).max() for _, _, stress, _ in drawn)
		for ax, (nodes, triangles, stress, name) in zip(panels, drawn):
			plots.field(
				(nodes, triangles), stress, "", ax=ax, limits=(-largest, largest), signed=True,
				colorbar=False
			)
			ax.set_title(name)
		fig.colorbar(
			panels[0].collections[0], ax=panels, label="stress along the strip [GPa]", shrink=0.9, aspect=25
		)
		return fig

	check.picture(draw, "The strip bent to a half and to a full circle; stress along its fibres.")


def rolled_up(rotation, kappa, length, height, cells):
	"""Bend the strip to the curvature kappa [1/m]: its material, the block at rest, and the moment [N] and axial
	force [N/m] per thickness on its left face."""
	O.reset()
	material = tools.elastic()
	block = ddem.append(ddem.mesh.rectangle(length, height, height / cells), material)

	def rolled(x, y):
		radius = 1 / kappa - (y - height / 2)
		return radius * np.sin(kappa * x), 1 / kappa - radius * np.cos(kappa * x)

	tools.place(block, rolled)
	for i, x in zip(block.triangle_ids, block.mesh.centroids[:, 0]):
		O.bodies[int(i)].state.ori = (Vector3(0, 0, 1), kappa * x)
	left = block.boundary("left")
	face = np.isin(block.node_ids, left)
	block.hold([*left, *block.boundary("right")], "x")
	block.hold(left[np.abs(block.mesh.nodes[face, 1] - height / 2) < 1e-9], "y")
	tools.start(rotation=rotation)
	ddem.relax(2e-5, damping=0.15)
	force, y = block.node_forces[face, 0], block.positions[face, 1]
	return material, block, -(force * (y - y.mean())).sum(), force.sum()


def along_fibres(block, kappa):
	"""Stress (m,) [Pa] of the triangles along the fibres of a strip bent to the curvature kappa [1/m]."""
	angles = kappa * block.mesh.centroids[:, 0]
	xx, yy, _, xy = block.stress.mean(axis=1).T
	c, s = np.cos(angles), np.sin(angles)
	return xx * c * c + yy * s * s + 2 * xy * s * c


def thin_moment(material, height, kappa):
	"""E'I κ [N]."""
	return elasticity.plane_modulus(material) * height**3 / 12 * kappa


def bending_moment(material, height, kappa):
	"""Moment per thickness [N] of a strip bent to the curvature kappa [1/m], linear in the stretch."""
	lam, mu = tools.lame(material)
	stiff, m = lam + 2 * mu, lam / (lam + 2 * mu)
	# r = A cosh κY + B sinh κY + (1 + m)/κ; T_r = 0 at both faces
	rows, right = [], []
	for y in (-height / 2, height / 2):
		c, s = np.cosh(kappa * y), np.sinh(kappa * y)
		rows.append([stiff * kappa * s + lam * kappa * c, stiff * kappa * c + lam * kappa * s])
		right.append(stiff + lam - lam * (1 + m))
	a, b = np.linalg.solve(rows, right)
	y, weights = np.polynomial.legendre.leggauss(20)
	y, weights = 0.5 * height * y, 0.5 * height * weights
	c, s = np.cosh(kappa * y), np.sinh(kappa * y)
	r, slope = a * c + b * s + (1 + m) / kappa, kappa * (a * s + b * c)
	return float((weights * (stiff * (kappa * r - 1) + lam * (slope - 1)) * r).sum())
