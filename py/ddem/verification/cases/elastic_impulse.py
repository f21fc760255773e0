# GPL v2 or later, see LICENSE.
"""The report's elastic block under a horizontal impulse, against finite elements."""
import numpy as np

from yade import O
from yade.ddem.studies.structures import impulse, impulse_figures, spall
from yade.ddem.verification import impulse_reference
from yade.ddem.verification import case


@case(group="concrete structures", seconds=15, needs="FreeFem++")
def elastic_impulse(check, size=0.01):
	"""The report's elastic block under an impulse

	A block of 10 cm × 40 cm, free all around, gets a pressure of 10 sin²(π t/40 µs) MPa on its left side
	(Zubelewicz (2018), section 4.2, which does not print the impulse). Waves run to and fro across it ten times,
	and those from the ends mix in. The displacement of the central point minus that of a rigid block is compared
	over time, and the whole field at three instants; errors are relative to the largest deformation, 1.6 µm.

	Reference: FreeFem++ assembles stiffness and mass. Linear triangles on the split mesh with the same lumped
	masses, integrated by central differences, must give the same; quadratic triangles with consistent mass,
	by Newmark's method, are the solution of the problem (within 0.3 % until 50 µs, 0.6 % until 200 µs: half the
	size, half the step). Momentum: force times time.

	Expect: the same to round-off where nothing rotates; within 1 % of the solution in the first 50 µs, 8 % after
	ten passages on 1 cm cells and 3.5 % on half the size; with rotating cores (β_φ = 2) as close. The problem
	hardly feels β_φ: cores that rotate move the centre by 0.5 %.
	"""
	histories = {}
	for name, cell, rotation in (
		("none", size, "none"),
		("cosserat", size, "cosserat"),
		("half the size", size / 2, "cosserat"),
	):
		O.reset()
		histories[name] = impulse.run(cell, rotation=rotation)
	plain, turning, fine = histories.values()
	equal, exact = impulse_reference.twin(plain), impulse_reference.quadratic(plain)
	source = "FreeFem++, linear triangles on the split mesh, lumped mass, central differences"
	error = np.abs(plain.centre - equal.centre).max() / np.abs(equal.centre).max()
	check(
		"centre, no rotation: largest difference to the same elements over u_x [-]",
		error, 0, 1e-10, source, scale=1
	)
	source = "FreeFem++, quadratic triangles, consistent mass, Newmark"
	shaken = np.abs(exact.centre[:, 0] - plain.impulse.rigid(exact.times)).max()
	for name, history in histories.items():
		error = (
			np.abs(np.interp(exact.times, history.times, history.centre[:, 0]) - exact.centre[:, 0])
			/ shaken
		)
		early, whole = (0.0075, 0.035) if history is fine else (0.01, 0.08)
		check(
			f"centre until 50 µs, {name}: largest difference over the deformation [-]",
			error[exact.times <= 50e-6].max(), 0, early, source, scale=1
		)
		check(
			f"centre until 200 µs, {name}: largest difference over the deformation [-]",
			error.max(), 0, whole, source, scale=1
		)
		velocity = history.impulse.momentum / (2400 * impulse.WIDTH * impulse.HEIGHT)
		check(
			f"mean velocity at the end, {name} [m/s]", history.velocity, velocity, 1e-6,
			"momentum: impulse over mass"
		)
		check(f"error of the energy book, {name} [-]", history.energy_error, 0, 1e-8, "first law", scale=1)
	for name, history in (("none", plain), ("cosserat", turning)):
		for instant, field, expected, tolerance in zip(
			history.instants, history.fields, exact.fields, (0.004, 0.01, 0.05)
		):
			error = np.linalg.norm(field - expected) / np.linalg.norm(expected - expected.mean(axis=0))
			check(
				f"field at {1e6 * instant:.0f} µs, {name}: difference over deformation, L2 [-]",
				error, 0, tolerance, source, scale=1
			)
	first = np.abs(turning.fields[0][:, 1])
	quiet = (
		np.abs(turning.mesh.nodes[:, 1] - impulse.HEIGHT / 2)
		< impulse.HEIGHT / 2 - spall.WAVE * turning.instants[0]
	)
	check(
		"u_y at 20 µs farther from the ends than c_p t, over the largest [-]",
		first[quiet].max() / first.max(), 0, 1e-3, "no wave is faster than c_p", scale=1
	)
	counts, expected = (
		[impulse.regions(plain.mesh, field[:, 1]) for field in one.fields] for one in (turning, exact)
	)
	check(
		f"regions of one sign in u_y at {1e6 * turning.instants[-1]:.0f} µs [-]",
		counts[-1], expected[-1], 0.1, source
	)
	check.note(
		"The report: “vertical displacements produce increasingly complex patterns”. Here the number of "
		"separate regions of one sign in u_y (of more than a tenth of the largest) is "
		f"{', '.join(map(str, counts))} at the three instants, and {', '.join(map(str, expected))} in the "
		"finite elements."
	)
	check.picture(
		lambda: impulse_figures.displacement(turning, exact),
		"Displacement of the central point, as in Figure 5 of Zubelewicz (2018), and what is left of it "
		"without the motion of a rigid block; finite elements dashed.",
	)
	check.picture(
		lambda: impulse_figures.contours(turning, exact),
		"Displacements at the instants 1, 2 and 3, with contour lines of both solutions.",
	)
