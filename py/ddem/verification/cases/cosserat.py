# GPL v2 or later, see LICENSE.
"""The pseudo-Cosserat medium: how β_φ disperses shear waves, and how it fades into the classic continuum."""
import numpy as np
from scipy.linalg import eigh

from yade import O, ddem
from yade.ddem import plots
from yade.ddem.verification import case, tools

EDGE, HALF = 0.01, np.sqrt(0.75)  # edge of the equilateral triangles [m], their height over it
# u_y of the node, u_y and φ of the cores -> 8 degrees of freedom of a cell (node; core of the upright triangle;
# core of the other)
SHEAR = np.zeros((8, 3))
SHEAR[[1, 3, 4, 6, 7], [0, 1, 2, 1, 2]] = 1

# ---- the lattice, from the linearised equations of the element alone ----


def element_matrices(corners, material, beta, share):
	"""Stiffness (9, 9) per thickness and masses (9,) of a triangle: displacements of its vertices (6), of its core
	(2), rotation of its core.

	U = Σ_k S_k w(ε_k) + ½ μ β_φ ε_φ² S, Δu_e = u_e − u_i − φ e_z × r_e, ε_φ = (1/3) Σ_e (t_e·Δu_e)/|r_e|; strains
	of the three sub-elements (centre, k, k+1) from linear interpolation; masses α m/3 in the vertices, (1 − α) m in
	the core, J_M = m Σ|r_e|² (1/12 − α/3).
	"""
	arms = corners - corners.mean(axis=0)
	lam, mu = tools.lame(material)
	moduli = np.array([[lam + 2 * mu, lam, 0], [lam, lam + 2 * mu, 0], [0, 0, mu]])
	relative = np.zeros((6, 9))  # Δu from the degrees of freedom
	for e, (x, y) in enumerate(arms):
		relative[2 * e, [2 * e, 6, 8]] = 1, -1, y
		relative[2 * e + 1, [2 * e + 1, 7, 8]] = 1, -1, -x
	area = 0.5 * np.linalg.det(np.column_stack([np.ones(3), corners]))
	stiffness = np.zeros((9, 9))
	for k in range(3):
		next_one = (k + 1) % 3
		# column: gradient of the shape function that is 1 at that vertex and 0 at the centre
		inverse = np.linalg.inv(np.array([arms[k], arms[next_one]]))
		strain = np.zeros((3, 6))
		for e, (gx, gy) in ((k, inverse[:, 0]), (next_one, inverse[:, 1])):
			strain[0, 2 * e], strain[1, 2 * e + 1], strain[2, 2 * e], strain[2, 2 * e + 1] = gx, gy, gy, gx
		b = strain @ relative
		stiffness += area / 3 * b.T @ moduli @ b
	rotation = np.concatenate([(-y, x) / (x * x + y * y) for x, y in arms]) / 3 @ relative
	stiffness += mu * beta * area * np.outer(rotation, rotation)
	mass = material.density * area
	return stiffness, np.array(
		[share * mass / 3] * 6 + [(1 - share) * mass] * 2 + [mass * (arms**2).sum() * (1 / 12 - share / 3)]
	)


def lattice_modes(wavenumber, material, beta, share):
	"""Angular frequencies [rad/s] and modes of shear waves along x in the infinite lattice of equilateral
	triangles, by Bloch's theorem.

	A cell has one node and two triangles, 8 degrees of freedom. Rows of nodes are mirrors, so in a shear wave nodes
	have no u_x, the cores of both kinds move alike, and u_x of cores is a wave of its own, which leaves 3 branches.
	Modes (3, 8) belong to displacements mode·e^{ikx}, x being the place of the node or core.
	"""
	first, second = np.array([EDGE, 0]), np.array([0.5, HALF]) * EDGE
	matrix, masses = np.zeros((8, 8), complex), np.zeros(8)
	for t, corners in enumerate((np.array([0 * first, first, second]), np.array([first, first + second, second]))):
		stiffness, mass = element_matrices(corners, material, beta, share)
		project = np.zeros((9, 8), complex)
		for e, corner in enumerate(corners):
			project[2 * e, 0] = project[2 * e + 1, 1] = np.exp(1j * wavenumber * corner[0])
		project[6:, 2 + 3 * t:5 + 3 * t] = np.exp(1j * wavenumber * corners.mean(axis=0)[0]) * np.eye(3)
		matrix += project.conj().T @ stiffness @ project
		masses += (np.abs(project)**2).T @ mass
	values, vectors = eigh(SHEAR.T @ matrix @ SHEAR, SHEAR.T @ np.diag(masses) @ SHEAR)
	return np.sqrt(np.maximum(values, 0)), (SHEAR @ vectors).T


def continuum_frequencies(classic, material, beta, share):
	"""Both branches [rad/s] of the continuum where the classic one, without rotation of cores, has the frequency
	*classic* [rad/s] (c_s k, or that of a mesh).

	The roots of ω² = ω_s² (1 − ¼ β_φ ω²/(ω_c² − ω²)).
	"""
	square, core = np.square(classic), core_frequency(material, beta, share)**2
	middle = 0.5 * (core + square * (1 + beta / 4))
	return np.sqrt(
		np.array([middle - np.sqrt(middle**2 - square * core), middle + np.sqrt(middle**2 - square * core)])
	)


def core_frequency(material, beta, share):
	"""ω_c [rad/s]: cores alone, swinging against their vertices;
	for equilateral triangles Σ|r_e|² is the square of the edge."""
	return np.sqrt(material.shear * beta / (material.density * EDGE**2 * (1 / 12 - share / 3)))


# ---- the same waves in the engine ----


def lattice_strip(columns):
	"""One row of equilateral triangles. Its two borders are mirrors of the lattice:
	a shear wave along it has no u_x there."""
	low = np.column_stack([np.arange(columns + 1), np.zeros(columns + 1)])
	high = np.column_stack([np.arange(columns) + 0.5, np.full(columns, HALF)])
	i = np.arange(columns)
	upright = np.column_stack([i, i + 1, columns + 1 + i])
	other = np.column_stack([i[1:], columns + 1 + i[1:], columns + i[1:]])
	return ddem.mesh.Mesh(EDGE * np.vstack([low, high]), np.vstack([upright, other]))


def measured_frequencies(wavenumber, branches, beta, share, rotation="cosserat"):
	"""Frequencies [rad/s] at which a long strip swings in its middle when all of it starts with the velocities of
	Bloch's modes, the sum of the branches; and those of the modes."""
	columns = 480 if wavenumber * EDGE < 0.5 else 240  # two periods before the ends are felt
	O.reset()
	material = tools.elastic(rotationStiffness=beta)
	expected, modes = lattice_modes(wavenumber, material, beta, share)
	block = ddem.append(lattice_strip(columns), material)
	block.hold(block.node_ids, "x")
	centres = block.mesh.centroids
	upright = centres[:, 1] < 0.4 * HALF * EDGE
	amplitude = 1e-7 * EDGE
	node, core = np.zeros(len(block.node_ids)), np.zeros((len(centres), 3))
	for branch in branches:
		node += amplitude * expected[branch] * np.cos(wavenumber * block.mesh.nodes[:, 0])
		mode = modes[branch] / modes[branch, 1]  # u_y of nodes is cos kx
		of_core = np.where(upright[:, None], mode[2:5], mode[5:8])
		core += amplitude * expected[branch] * (of_core * np.exp(1j * wavenumber * centres[:, 0])[:, None]).real
	for i, v in zip(block.node_ids, node):
		O.bodies[int(i)].state.vel = (0, v, 0)
	for i, (vx, vy, spin) in zip(block.triangle_ids, core):
		state = O.bodies[int(i)].state
		state.vel, state.angVel = (vx, vy, 0), (0, 0, spin)
	middle = np.argmin(np.abs(block.mesh.nodes[:, 0] - 0.5 * columns * EDGE) + block.mesh.nodes[:, 1])
	recorder = tools.Recorder(lambda: block.displacements[middle, 1], 4)
	tools.start(recorder.engine, step=0.5, rotation=rotation, vertexShare=share)
	fastest = np.sqrt((material.bulk + 4 / 3 * material.shear) / material.density)
	O.run(int(0.45 * columns * EDGE / fastest / O.dt), True)  # until the ends are felt
	guesses = 2 / O.dt * np.arcsin(0.5 * O.dt * expected[list(branches)])
	found = tools.fit_frequencies(recorder.times, recorder.values, guesses)
	# without the leapfrog's own, known error
	return 2 / O.dt * np.sin(0.5 * O.dt * found), expected[list(branches)]


@case(group="waves and vibration", seconds=4)
def cosserat_dispersion(check):
	"""Pseudo-Cosserat: dispersion of shear waves

	Cores are tied to their vertices by β_φ but not to each other. Linearised (Δu_e = u_e − u_i − φ e_z × r_e), the
	rotation strain of an equilateral triangle is the rotation of the material less that of the core, ε_φ = ½ curl
	u − φ. For a shear wave u_y(x, t) the energies per volume are ½ρ u̇² + ½ j φ̇² and ½μ u'² + ½μβ_φ (½u' − φ)²,
	with j = J_M/S = ρ (1/12 − α/3) Σ|r_e|². The equations of Lagrange are

		ρ ü = μ u'' + ½ μβ_φ ∂_x (½u' − φ),   j φ̈ = μβ_φ (½u' − φ)

	With all in proportion to exp i(kx − ωt) the second gives the rotation of the cores,
	and with it the first the dispersion relation:

		φ = ½u' ω_c²/(ω_c² − ω²),   ω_c² = μβ_φ/j

		ρω² = μk² (1 − ¼ β_φ ω²/(ω_c² − ω²))

	Two branches: slow waves, in which cores turn with the material, the more the faster it swings, and by their
	inertia slow the wave down (c → c_s as k → 0, for any β_φ); and above ω_c waves in which cores swing against it,
	c → √(1 + β_φ/4) c_s as k → ∞. Between ω_c/√(1 + β_φ/4) and ω_c the continuum has none. It is the reduced
	Cosserat medium, without couple stresses: Eringen's micropolar one with κ = ½μβ_φ, a shear modulus of μ − κ/2,
	and γ = 0. ω_c is 6√β_φ c_s/a with α = 1/6 and triangles of edge a: a matter of the mesh, so there the lattice
	shows as well. It is solved exactly by Bloch's theorem, with matrices assembled in the case's own file from the
	equations of the element.

	Reference: Bloch's theorem for the lattice; for long waves the continuum above, derived here (Eringen,
	Microcontinuum Field Theories, 1999; reduced medium: Grekova, Kulesh and Herman, Bull. Seismol. Soc. Am.
	99, 2009), with the classic dispersion of the same mesh, measured with rotation “none”, for c_s k.

	Expect: the engine's waves are those of the lattice to 1e-5 on both branches, for the paper's β_φ = 2 and for
	a soft 0.05, whose branches avoid each other near ka = 0.8. Up to there the continuum has the slow branch within
	2e-4 with β_φ = 2, where the cores slow it by 2e-3, and both within 2e-3 with 0.05, where they slow it by 6e-2;
	the fast branch with β_φ = 2 bends down by 1 %, which only the lattice explains.
	"""
	# β_φ: α, that is the inertia of cores; how close the continuum comes to each branch
	sets = {2.0: (1 / 6, (2.5e-4, 2e-2)), 0.05: (0.02, (3e-3, 3e-3))}
	measured, plain = {}, tools.elastic()
	points = np.array([0.4, 0.8, 1.2, 1.8, 2.4, 3.0])
	long = points < 1
	for beta, (share, tolerances) in sets.items():
		both = [measured_frequencies(ka / EDGE, (0, 1), beta, share) for ka in points]
		found, exact = (np.array([pair[i] for pair in both]) for i in (0, 1))
		# without β_φ the lowest branch is free turning
		classic = [measured_frequencies(ka / EDGE, (1, ), 0.0, share, "none")[0][0] for ka in points[long]]
		continuum = continuum_frequencies(classic, plain, beta, share).T
		measured[beta] = points, found
		for branch, name in enumerate(("lower", "upper")):
			worst = np.argmax(np.abs(found[:, branch] / exact[:, branch] - 1))
			check(
				(
					f"{name} branch, β_φ = {beta:g}, frequency at ka = {points[worst]:g}, the "
					f"worst of {len(points)} [rad/s]"
				),
				found[worst, branch],
				exact[worst, branch],
				1e-5,
				"Bloch's theorem for the lattice",
			)
			worst = np.argmax(np.abs(found[long, branch] / continuum[:, branch] - 1))
			check(
				(
					f"{name} branch, β_φ = {beta:g}, long waves, frequency at "
					f"ka = {points[worst]:g} [rad/s]"
				),
				found[worst, branch],
				continuum[worst, branch],
				tolerances[branch],
				"continuum: ω² = ω_s² (1 − ¼ β_φ ω²/(ω_c² − ω²))",
			)

	check.note(
		"""The lattice has a dispersion of its own: with five sixths of the mass in the cores short waves run
		faster than c_s, by 0.15 % with 31 triangles to the wavelength (ka = 0.2) and 0.6 % with 16 (ka = 0.4),
		where the cores' rotation slows them by 0.01 % and 0.06 %."""
	)

	def draw():
		fig, panels = tools.axes(plots.PAGE, 72, panels=2)
		unit = np.sqrt(plain.shear / plain.density) / EDGE
		k = np.linspace(0.02, np.pi, 120)
		for ax, (beta, (share, _)) in zip(panels, sets.items()):
			lattice = np.array([lattice_modes(ka / EDGE, plain, beta, share)[0][:2] for ka in k]) / unit
			continuum = continuum_frequencies(k * unit, plain, beta, share) / unit
			points, found = measured[beta]
			for branch in (0, 1):
				ax.plot(
					k, lattice[:, branch], "-", color="0.3", linewidth=0.8,
					label="lattice, exact" if not branch else None
				)
				ax.plot(
					k, continuum[branch], "--", color=plots.COLOURS[1], linewidth=0.8,
					label="continuum" if not branch else None
				)
				ax.plot(
					points, found[:, branch] / unit, "o", color=plots.COLOURS[0], markersize=3.2,
					label="deformable triangles" if not branch else None
				)
			ax.plot(k, k, ":", color="0.6", linewidth=0.8, label=r"classic, $c_s k$")
			ax.set_title(rf"$\beta_\varphi = {beta:g}$", loc="left")
			ax.set_xlim(0, np.pi)
			ax.set_ylim(0, 10 if beta > 1 else 3)
			ax.set_xlabel("wave number $ka$ [-]")
		panels[0].set_ylabel(r"frequency $\omega a/c_s$ [-]")
		handles, labels = panels[0].get_legend_handles_labels()
		fig.legend(handles, labels, loc="outside upper center", ncols=4)
		return fig

	check.picture(
		draw,
		"Dispersion of shear waves, both branches. Left: β_φ of the paper, cores swing far above the waves. "
		"Right: soft ties of heavy cores, branches avoid each other.",
	)


@case(group="waves and vibration", seconds=0.5)
def cosserat_to_classic(check, size=0.008):
	"""Pseudo-Cosserat: the classic limit β_φ → 0

	A block is hit by a transverse velocity that varies as a bell along it, on an unstructured mesh, once without
	rotation of cores and then with ever smaller β_φ. The difference of the displacements half a passage later must
	vanish with β_φ: cores that swing slower than the waves are felt as additional stiffness in proportion to β_φ
	(the factor 1 + β_φ/4 of the upper branch). Stiffer ties make cores follow the waves,
	and only their inertia is felt.

	Reference: the same code with rotation “none”, which agrees with FreeFem++ at rest and with the exact speeds of
	classic waves in other cases.

	Expect: less than half a per cent for any β_φ in this mesh; below 1e-3 the difference falls in proportion to
	β_φ, and at 0 it is gone.
	"""
	length, height = 0.2, 0.04
	mesh = ddem.mesh.rectangle(length, height, size=size, pattern="unstructured", seed=1)

	def displacements(rotation, beta):
		O.reset()
		material = tools.elastic(rotationStiffness=beta)
		block = ddem.append(mesh, material)
		tools.set_velocity(block, lambda x, y: (0 * x, 1e-3 * np.exp(-((x - length / 2) / 0.02)**2)))
		with tools.without_warnings():
			tools.start(rotation=rotation)
			O.dt = step
			O.run(int(0.5 * length / np.sqrt(material.shear / material.density) / step), True)
		return block.displacements.copy()

	tools.elastic(rotationStiffness=2)
	ddem.append(mesh, "elastic")
	tools.start(rotation="cosserat")
	step = O.dt
	classic = displacements("none", 0)
	betas = np.array([2, 0.5, 0.1, 1e-2, 1e-3, 1e-4, 1e-5])
	differences = np.array(
		[np.linalg.norm(displacements("cosserat", beta) - classic) for beta in betas]
	) / np.linalg.norm(classic)
	order = np.log(differences[-2] / differences[-1]) / np.log(betas[-2] / betas[-1])
	check(
		"order at which the difference vanishes with β_φ [-]", order, 1, 2e-2,
		"stiffness in proportion to β_φ, upper branch of the dispersion relation"
	)
	gone = np.linalg.norm(displacements("cosserat", 0) - classic) / np.linalg.norm(classic)
	check(
		"largest difference of displacements, any β_φ [-]", differences.max(), 0, 5e-3, "classic continuum",
		scale=1
	)
	check("difference of displacements at β_φ = 0 [-]", gone, 0, 3e-8, "classic continuum", scale=1)

	def draw():
		fig, (ax,) = tools.axes(height=58)
		ax.loglog(betas, differences, "o-", markersize=3.5)
		ax.loglog(betas[-3:], 1.6 * differences[-1] * betas[-3:] / betas[-1], "k-", linewidth=0.7)
		ax.annotate(
			"1 : 1", (betas[-2], 1.6 * differences[-1] * betas[-2] / betas[-1]), (-4, 4),
			textcoords="offset points", ha="right"
		)
		ax.set_xlabel(r"$\beta_\varphi$ [-]")
		ax.set_ylabel("difference to classic [-]")
		return fig

	check.picture(
		draw, "Difference of all displacements to those of a classic continuum, over the rotation stiffness."
	)
