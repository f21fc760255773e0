# GPL v2 or later, see LICENSE.
"""A cantilever: deflection under an end load, and the note it sings when the load is taken away."""
import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

from yade import O, ddem
from yade.ddem import plots
from yade.ddem.verification import case, elasticity, statics, tools

LENGTH, HEIGHT, FORCE, KAPPA = 0.25, 0.05, 1e6, 5 / 6  # [m], [m], [N/m], Reissner's shear coefficient of a rectangle [-]


def beam_frequency(material):
	"""First angular frequency [rad/s] of Timoshenko's beam, clamped at one end, in plane strain.

	w' = φ + Q/κGA, φ' = M/EI, M' = −Q − ρI ω² φ, Q' = −ρA ω² w, with w = φ = 0 at the root and M = Q = 0 at the tip: the root of a 2 × 2 determinant.
	"""
	inertia, bending = HEIGHT**3 / 12, elasticity.plane_modulus(material) * HEIGHT**3 / 12

	def determinant(omega):
		rows = np.array([[0, 1, 0, 1 / (KAPPA * material.shear * HEIGHT)], [0, 0, 1 / bending, 0], [0, -material.density * inertia * omega**2, 0, -1],
			[-material.density * HEIGHT * omega**2, 0, 0, 0]])
		scale = np.array([1, 1 / LENGTH, bending / LENGTH**2, bending / LENGTH**3])  # so that all entries have one size
		end = expm(LENGTH * rows * scale[None, :] / scale[:, None])
		return np.linalg.det(end[2:, 2:])

	bernoulli = 1.8751041**2 * np.sqrt(bending / (material.density * HEIGHT * LENGTH**4))
	return brentq(determinant, 0.8 * bernoulli, 1.001 * bernoulli, rtol=1e-12)


@case(group="statics", seconds=4, needs="FreeFem++")
def cantilever(check, size=0.006):
	"""Cantilever: deflection and first frequency

	A beam five times as long as high is clamped at its left end and loaded by a parabolic shear stress at its right end. It comes to rest at the deflection of
	Timoshenko's beam in plane strain; then the load is taken away and the tip swings, without damping.

		w = PL³/3E'I + PL/κGA,   E' = E/(1 − ν²),   κ = 5/6

	Solved by FreeFem++ on the mesh in which every triangle is split at its centroid, and by deformable triangles, relaxed from rest.

	Reference: Timoshenko (1921) for both the deflection and the frequency (root of the beam's frequency equation); FreeFem++ 4.15 with linear triangles.

	Expect: agreement with FreeFem++ to the residual. Linear triangles are stiff in bending: with eight of them over the height the deflection is 2.6 % short
	and the frequency 1.4 % high, both errors falling with the square of the size.
	"""
	material = tools.elastic()
	mesh = ddem.mesh.rectangle(LENGTH, HEIGHT, size=size, pattern="unstructured", seed=1).reordered()
	held = np.repeat((mesh.nodes[:, 0] == 0)[:, None], 2, axis=1)

	def traction(points, normals):
		shear = -1.5 * FORCE / HEIGHT * (1 - (2 * points[..., 1] / HEIGHT - 1)**2)
		return np.stack([np.zeros_like(shear), shear], axis=-1)

	loads = statics.nodal_loads(mesh, lambda x, y: x > LENGTH - 1e-9, traction)
	solution = statics.solve(mesh, material, loads, held, residual=1e-5, damping=0.5)
	check("force out of balance in FreeFem++'s solution [-]", solution.unbalanced, 0, 1e-10, "FreeFem++ on the split mesh", scale=1)
	check("difference of displacements to FreeFem++ [-]", solution.difference, 0, 1e-3, "FreeFem++ on the split mesh", scale=1)

	tip = np.flatnonzero(mesh.nodes[:, 0] > LENGTH - 1e-9)
	moment = HEIGHT**3 / 12
	deflection = FORCE * LENGTH**3 / (3 * elasticity.plane_modulus(material) * moment) + FORCE * LENGTH / (KAPPA * material.shear * HEIGHT)
	middle = tip[np.argmin(np.abs(mesh.nodes[tip, 1] - HEIGHT / 2))]
	check("deflection of the tip [m]", -solution.relaxed[middle, 1], deflection, 3e-2, "Timoshenko's beam: PL³/3E'I + PL/κGA")
	shape, stress = solution.relaxed[:len(mesh.nodes)].copy(), solution.block.stress.mean(axis=1)[:, 0]

	for i in solution.block.node_ids:
		O.forces.setPermF(int(i), (0, 0, 0))
	frequency = beam_frequency(material)
	start = O.time
	every = max(1, int(2 * np.pi / frequency / O.dt / 100))
	swing = tools.Recorder(lambda: solution.block.displacements[middle, 1], every)
	tools.start(swing.engine)
	O.run(int(2.2 * 2 * np.pi / frequency / O.dt), True)
	times, tips = swing.times - start, swing.values
	found = tools.fit_frequencies(times, tips, [frequency, 6 * frequency])[0]
	check("first frequency [Hz]", found / (2 * np.pi), frequency / (2 * np.pi), 2e-2, "Timoshenko's beam, first root of the frequency equation")

	def draw():
		fig, (left, right) = tools.axes(plots.PAGE, 60, panels=2)
		plots.field(mesh, stress / 1e6, r"$\sigma_{xx}$ [MPa]", ax=left, displacement=shape, scale=0.3 * HEIGHT / deflection, signed=True)
		left.set_title("at rest, deflection enlarged")
		right.plot(1e3 * times, tips / deflection, label="deformable triangles")
		right.plot(1e3 * times, -np.cos(frequency * times), "k--", linewidth=0.7, label="first mode of Timoshenko's beam")
		right.set_xlabel("time after the release [ms]")
		right.set_ylabel(r"tip over $w$ [-]")
		tools.legend(right)
		return fig

	check.picture(draw, "Left: axial stress at rest. Right: the tip after the load has gone; the beam's first mode alone is shown for comparison.")
