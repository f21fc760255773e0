# GPL v2 or later, see LICENSE.
"""How fast errors fall when the mesh is refined."""
import numpy as np

from yade import O, ddem
from yade.ddem import plots
from yade.ddem.verification import case, elasticity, tools

SIDE = 0.1  # of the square [m]


def order(sizes, errors):
	"""Slope of log error over log size, by least squares."""
	return np.polyfit(np.log(sizes), np.log(errors), 1)[0]


def draw_orders(sizes, lines, label):
	"""Errors over sizes; lines: (name, errors, order to draw below it or None)."""
	fig, (ax,) = tools.axes(height=62)
	for (name, errors, slope), marker in zip(lines, "osv^"):
		ax.loglog(1e3 * sizes, errors, marker=marker, markersize=3.5, label=name)
		if slope:
			below = 0.65 * errors[-1] * (sizes / sizes[-1])**slope
			ax.loglog(1e3 * sizes, below, ":", color="0.4", linewidth=0.8)
			ax.annotate(
				f"order {slope:g}",
				(1e3 * np.sqrt(sizes[0] * sizes[-1]), np.sqrt(below[0] * below[-1])), (4, -8),
				textcoords="offset points", fontsize=7
			)
	ax.set_xticks(1e3 * sizes, [f"{1e3 * size:g}" for size in sizes])
	ax.set_xticks([], minor=True)
	ax.set_xlabel("size of the triangles [mm]")
	ax.set_ylabel(label)
	tools.legend(ax)
	return fig


@case(group="statics", seconds=1)
def convergence(check, sizes=(0.02, 0.01, 0.005, 0.0025)):
	"""Order of convergence at rest

	A square whose border is displaced as an exact solution says (complex potentials φ = Sℓ e^{z/ℓ}, ψ = ½ i Sℓ
	e^{z/ℓ}: all components, smooth, not symmetric), on four unstructured meshes.
	Errors are means of squares over the area.

	Reference: for linear triangles the displacement's error falls with the square of the size, that of the stress
	in proportion to it (Strang and Fix, An Analysis of the Finite Element Method, 1973).

	Expect: orders 2 and 1 within 0.1.
	"""
	displacement, stress = [], []
	for size in sizes:
		O.reset()
		material = tools.elastic()
		exact = elasticity.exponential(material, 1e6, 0.5 * SIDE)
		block = ddem.append(
			ddem.mesh.rectangle(SIDE, SIDE, size=size, pattern="unstructured", seed=1), material
		)
		mesh = block.mesh
		block.hold(block.node_ids[mesh.boundary()])
		tools.place(block, lambda x, y: np.add((x, y), exact.displacement(np.column_stack([x, y])).T))
		engine = tools.start(rotation="none")
		ddem.relax(1e-6)
		places = np.vstack([mesh.nodes, mesh.centroids])
		moved = np.vstack([engine.array("nodePosition"), engine.array("corePosition")]) - places
		corners = np.stack(
			[
				np.column_stack(
					[
						len(mesh.nodes) + np.arange(len(mesh.triangles)),
						mesh.triangles[:, k],
						mesh.triangles[:, (k + 1) % 3],
					]
				)
				for k in range(3)
			],
			axis=1,
		)
		points = places[corners].mean(axis=2)  # centroids of the sub-elements
		weights = np.repeat(mesh.areas / 3, 3).reshape(-1, 3)
		relative = lambda found, wanted: np.sqrt(
			(weights[..., None] * (found - wanted)**2).sum() / (weights[..., None] * wanted**2).sum()
		)
		displacement.append(relative(moved[corners].mean(axis=2), exact.displacement(points)))
		found = block.stress[..., [0, 1, 3]]
		stress.append(relative(found, exact.stress(points)))
	sizes = np.array(sizes)
	source = "Strang and Fix (1973), linear triangles"
	check("order of the displacement [-]", order(sizes, displacement), 2, 5e-2, source)
	check("order of the stress in sub-elements [-]", order(sizes, stress), 1, 1e-1, source)
	check(
		f"error of the displacement at {1e3 * sizes[-1]:g} mm [-]", displacement[-1], 0, 6e-4,
		"complex potentials", scale=1
	)
	check(f"error of the stress at {1e3 * sizes[-1]:g} mm [-]", stress[-1], 0, 3e-2, "complex potentials", scale=1)
	lines = [("displacement", displacement, 2), ("stress in sub-elements", stress, 1)]
	check.picture(
		lambda: draw_orders(sizes, lines, "relative error [-]"),
		"Errors at rest over the size of the triangles.",
	)


def frequency(kind, size, rotation):
	"""(measured, exact) angular frequency [rad/s] of a square between rollers in one of its exact modes,
	and the block."""
	O.reset()
	material = tools.elastic()
	k, sign = np.pi / SIDE, 1 if kind == "compression" else -1
	omega = np.sqrt(2) * k * elasticity.speeds(material)[0 if kind == "compression" else 1]
	block = ddem.append(ddem.mesh.rectangle(SIDE, SIDE, size=size, pattern="unstructured", seed=1), material)
	block.hold([*block.boundary("left"), *block.boundary("right")], "x")
	block.hold([*block.boundary("bottom"), *block.boundary("top")], "y")
	shape = lambda x, y: np.array([np.sin(k * x) * np.cos(k * y), sign * np.cos(k * x) * np.sin(k * y)])
	half_curl = lambda x, y: (1 - sign) / 2 * k * np.sin(k * x) * np.sin(k * y)
	tools.set_velocity(
		block,
		lambda x, y: 1e-3 * shape(x, y),
		(lambda x, y: 1e-3 * half_curl(x, y)) if rotation == "cosserat" else 0.0,
	)
	weights = shape(*block.mesh.nodes.T).T
	every = max(1, int(2 * np.pi / omega / ddem.time_step(0.8) / 40))
	recorder = tools.Recorder(lambda: (weights * block.displacements).sum(), every)
	tools.start(recorder.engine, rotation=rotation)
	O.run(int(3.3 * 2 * np.pi / omega / O.dt), True)
	return tools.fit_frequencies(recorder.times, recorder.values, [omega])[0], omega, block


@case(group="waves and vibration", seconds=2)
def convergence_of_frequencies(check, sizes=(0.02, 0.01, 0.005)):
	"""Order of convergence of frequencies

	A square between rollers swings in two exact modes, one of shear and one of compression (k = π/L):

		u = (sin kx cos ky, −cos kx sin ky),  ω = √2 k c_s;   u = (sin kx cos ky, cos kx sin ky),  ω = √2 k c_p

	Their frequencies are measured on three unstructured meshes, without rotation of cores and with β_φ = 2;
	time steps fall with the size. Cores that turn with the material, φ = ½ curl u, add their inertia J_M and so
	lower the frequency of the shear mode, whose ½ curl u is k sin kx sin ky:

		Δω/ω = −½ ∫½ j φ̇² / ∫½ ρ u̇² = −¼ k² j/ρ,   j/ρ = (1/12 − α/3) Σ|r_e|²

	Reference: separation of variables (Graff, Wave Motion in Elastic Solids, 1975); Rayleigh's quotient for the
	inertia of cores. Linear triangles have errors of second order in the size (Strang and Fix 1973).

	Expect: order 2 within 0.1; errors below 2e-3 (shear) and 2e-4 (compression) with 20 triangles along a side.
	"""
	lines, sizes, finest = [], np.array(sizes), {}
	for rotation in ("none", "cosserat"):
		for kind, tolerance in (("shear", 3e-3), ("compression", 3e-4)):
			errors = []
			for size in sizes:
				found, omega, block = frequency(kind, size, rotation)
				errors.append(abs(found / omega - 1))
			check(
				f"order of the frequency, {kind}, {rotation} [-]", order(sizes, errors), 2, 5e-2,
				"Strang and Fix (1973), linear triangles"
			)
			check(
				f"frequency, {kind}, {rotation}, at {1e3 * size:g} mm [rad/s]",
				found, omega, tolerance, "Graff (1975), separation of variables"
			)
			lines.append(
				(
					f"{kind}, {rotation}",
					errors,
					2 if rotation == "none" and kind == "compression" else None,
				)
			)
			finest[kind, rotation] = found
	arms = block.mesh.nodes[block.mesh.triangles] - block.mesh.centroids[:, None]
	inertia = np.average((arms**2).sum(axis=(1, 2)), weights=block.mesh.areas) / 36  # j/ρ with α = 1/6 [m²]
	check(
		f"shift of the shear frequency by the inertia of cores, at {1e3 * size:g} mm [-]",
		finest["shear", "cosserat"] / finest["shear", "none"] - 1,
		-0.25 * (np.pi / SIDE)**2 * inertia, 5e-2, "Rayleigh's quotient: −¼ k² j/ρ"
	)

	check.picture(
		lambda: draw_orders(sizes, lines, "relative error of the frequency [-]"),
		"Errors of the frequencies of a square between rollers over the size of the triangles."
	)
