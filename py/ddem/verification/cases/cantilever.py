# GPL v2 or later, see LICENSE.
"""A cantilever: deflection under an end load, and the note it sings when the load is taken away."""
import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

from yade import O, ddem
from yade.ddem import plots
from yade.ddem.verification import case, dynamics, elasticity, freefem, statics, tools

# [m], [m], [N/m], Reissner's shear coefficient of a rectangle [-]
LENGTH, HEIGHT, FORCE, KAPPA = 0.25, 0.05, 1e4, 5 / 6


def beam_frequency(material):
	"""First angular frequency [rad/s] of Timoshenko's beam, clamped at one end, in plane strain.

	w' = φ + Q/κGA, φ' = M/EI, M' = −Q − ρI ω² φ, Q' = −ρA ω² w, with w = φ = 0 at the root and M = Q = 0 at the
	tip: the root of a 2 × 2 determinant.
	"""
	inertia, bending = HEIGHT**3 / 12, elasticity.plane_modulus(material) * HEIGHT**3 / 12

	def determinant(omega):
		rows = np.array(
			[
				[0, 1, 0, 1 / (KAPPA * material.shear * HEIGHT)],
				[0, 0, 1 / bending, 0],
				[0, -material.density * inertia * omega**2, 0, -1],
				[-material.density * HEIGHT * omega**2, 0, 0, 0],
			]
		)
		# so that all entries have one size
		scale = np.array([1, 1 / LENGTH, bending / LENGTH**2, bending / LENGTH**3])
		end = expm(LENGTH * rows * scale[None, :] / scale[:, None])
		return np.linalg.det(end[2:, 2:])

	bernoulli = 1.8751041**2 * np.sqrt(bending / (material.density * HEIGHT * LENGTH**4))
	return brentq(determinant, 0.8 * bernoulli, 1.001 * bernoulli, rtol=1e-12)


# Two-dimensional elasticity by quadratic triangles in squares, twelve over the height: deflection of the middle of the
# tip under a parabolic shear stress whose resultant is 1 N/m, and first angular frequency by inverse iteration.
_QUADRATIC = f"""
real lambda, mu, density;
{{ ifstream file("material.txt"); file >> lambda; file >> mu; file >> density; }}
mesh Th = square(60, 12, [{LENGTH} * x, {HEIGHT} * y]);
fespace Vh(Th, [P2, P2]);
varf stiffness([u, v], [p, q]) = int2d(Th)(
	lambda * (dx(u) + dy(v)) * (dx(p) + dy(q)) + 2 * mu * (dx(u) * dx(p) + dy(v) * dy(q))
	+ mu * (dy(u) + dx(v)) * (dy(p) + dx(q))) + on(4, u = 0, v = 0);
varf inertia([u, v], [p, q]) = int2d(Th)(density * (u * p + v * q));
varf pull([u, v], [p, q]) = int1d(Th, 2)(6 * y * ({HEIGHT} - y) / {HEIGHT}^3 * q);
matrix K = stiffness(Vh, Vh), M = inertia(Vh, Vh);
set(K, solver = sparsesolver);
real[int] force = pull(0, Vh);
Vh [u, v];
u[] = K^-1 * force;
ofstream result("result.txt");
result.precision(17);
result << v({LENGTH}, {HEIGHT} / 2) << endl;
real square;
for (int i = 0; i < 8; i++) {{
	force = M * u[];
	real[int] next = K^-1 * force, inert = M * next;
	square = (next' * force) / (next' * inert);
	u[] = next;
}}
result << sqrt(square) << endl;
"""


@case(group="statics", seconds=4, needs="FreeFem++")
def cantilever(check, size=0.006):
	"""Cantilever: deflection and first frequency

	A beam five times as long as high is clamped at its left end and loaded by a parabolic shear stress at its right
	end. It comes to rest; then the load is taken away and the tip swings, without damping. The deflection is so
	small (0.03 % of the length) that geometry stays linear. Timoshenko's beam has, in plane strain,

		w = PL³/3E'I + PL/κGA,   E' = E/(1 − ν²),   κ = 5/6

	and a first frequency that is the first root of the beam's frequency equation. Solved in two dimensions by
	FreeFem++ with quadratic triangles; by FreeFem++ with linear ones on the mesh in which every triangle is split
	at its centroid; and by deformable triangles, relaxed from rest and let go. FreeFem++'s stiffness matrix of the
	split mesh and the lumped masses give the first mode of the mesh;
	the frequency is that of the part of the motion in this mode.

	Reference: Timoshenko (1921) for deflection and frequency; FreeFem++ 4.15, quadratic triangles (the next finer
	mesh changes them by 1e-4) and linear ones.

	Expect: agreement with FreeFem++ on the same mesh, of displacements to the residual and of the frequency to
	round-off. Linear triangles are stiff in bending: with eight of them over the height the deflection is 2.5 %
	short and the frequency 1.3 % high against two-dimensional elasticity, with sixteen 0.6 % and 0.3 %.
	Timoshenko's beam itself bends 0.2 % more and swings 0.1 % slower than that.
	"""
	material = tools.elastic()
	mesh = ddem.mesh.rectangle(LENGTH, HEIGHT, size=size, pattern="unstructured", seed=1).reordered()
	held = np.repeat((mesh.nodes[:, 0] == 0)[:, None], 2, axis=1)

	def traction(points, normals):
		shear = -1.5 * FORCE / HEIGHT * (1 - (2 * points[..., 1] / HEIGHT - 1)**2)
		return np.stack([np.zeros_like(shear), shear], axis=-1)

	loads = statics.nodal_loads(mesh, lambda x, y: x > LENGTH - 1e-9, traction)
	solution = statics.solve(mesh, material, loads, held, residual=1e-5, damping=0.5)
	# a slender beam moves by some hundred times the residual
	statics.check_equality(check, solution, unbalanced=1e-11, difference=1e-3)

	per_force, exact_frequency = freefem.run(
		_QUADRATIC,
		np.zeros((0, 2)),
		np.zeros((0, 3), int),
		{"material": [*tools.lame(material), material.density]},
	)
	tip = np.flatnonzero(mesh.nodes[:, 0] > LENGTH - 1e-9)
	moment = HEIGHT**3 / 12
	deflection = FORCE * LENGTH**3 / (3 * elasticity.plane_modulus(material) * moment) + FORCE * LENGTH / (
		KAPPA * material.shear * HEIGHT
	)
	middle = tip[np.argmin(np.abs(mesh.nodes[tip, 1] - HEIGHT / 2))]
	check(
		"deflection of the tip, beam [m]",
		-solution.relaxed[middle, 1],
		deflection,
		3e-2,
		"Timoshenko's beam: PL³/3E'I + PL/κGA",
	)
	check(
		"deflection of the tip, 2D elasticity [m]",
		-solution.relaxed[middle, 1],
		FORCE * per_force,
		3e-2,
		"FreeFem++, quadratic triangles",
	)
	shape, stress = solution.relaxed[:len(mesh.nodes)].copy(), solution.block.stress.mean(axis=1)[:, 0]

	for i in solution.block.node_ids:
		O.forces.setPermF(int(i), (0, 0, 0))
	mass = np.repeat(dynamics.lumped_masses(mesh, material.density), 2)
	matrices = dynamics.assemble(
		*statics.split_at_centroids(mesh), (*tools.lame(material), material.density), (), "P1"
	)
	of_mesh, mode = dynamics.first_mode(
		matrices, mass, np.append(held.ravel(), np.zeros(2 * len(mesh.triangles), bool))
	)
	frequency, places = beam_frequency(material), np.vstack([mesh.nodes, mesh.centroids])
	start = O.time
	every = max(1, int(2 * np.pi / frequency / O.dt / 100))

	def motion():
		moved = np.vstack([engine.array("nodePosition"), engine.array("corePosition")]) - places
		return moved[middle, 1], (mode * mass) @ moved.ravel()

	swing = tools.Recorder(motion, every)
	engine = tools.start(swing.engine, rotation="none")
	O.run(int(2.2 * 2 * np.pi / frequency / O.dt), True)
	times, (tips, of_mode) = swing.times - start, swing.values.T
	guess = 2 / O.dt * np.arcsin(0.5 * O.dt * of_mesh)
	# without the leapfrog's own, known error
	found = 2 / O.dt * np.sin(0.5 * O.dt * tools.fit_frequencies(times, of_mode, guess)[0])
	check(
		"first frequency, same mesh [Hz]", found / (2 * np.pi), of_mesh / (2 * np.pi), 1e-9,
		"FreeFem++ on the split mesh, lumped masses"
	)
	for name, reference, source in (
		("beam", frequency, "Timoshenko's beam, first root of the frequency equation"),
		("2D elasticity", exact_frequency, "FreeFem++, quadratic triangles")
	):
		check(f"first frequency, {name} [Hz]", found / (2 * np.pi), reference / (2 * np.pi), 2e-2, source)

	def draw():
		fig, (left, right) = tools.axes(plots.PAGE, 60, panels=2)
		plots.field(
			mesh, stress / 1e6, r"$\sigma_{xx}$ [MPa]", ax=left, displacement=shape,
			scale=0.3 * HEIGHT / deflection, signed=True
		)
		left.set_title("at rest, deflection enlarged")
		right.plot(1e3 * times, tips / deflection, label="deformable triangles")
		right.plot(
			1e3 * times, -np.cos(frequency * times), "k--", linewidth=0.7,
			label="first mode of Timoshenko's beam"
		)
		right.set_xlabel("time after the release [ms]")
		right.set_ylabel(r"tip over $w$ [-]")
		tools.legend(right)
		return fig

	check.picture(
		draw,
		"Left: axial stress at rest. Right: the tip after the load has gone; the beam's first mode alone is "
		"shown for comparison.",
	)
