# GPL v2 or later, see LICENSE.
"""The report's elastic block under a horizontal impulse, against finite elements."""
import numpy as np

from yade import O
from yade.ddem.structures import impulse, impulse_figures, impulse_reference
from yade.ddem.verification import case


@case(group="concrete structures", seconds=10, needs="FreeFem++")
def elastic_impulse(check, size=0.01):
	"""The report's elastic block under an impulse

	A block of 10 cm × 40 cm, free all around, gets a pressure of 10 sin²(π t/40 µs) MPa on its left side (Zubelewicz (2018), section 4.2, which does not print
	the impulse). Waves run to and fro across it ten times, and those from the ends mix in. The displacement of the central point minus that of a rigid block is
	compared over time, and the whole field at three instants; errors are relative to the largest deformation.

	Reference: FreeFem++ assembles stiffness and mass. Linear triangles on the split mesh with the same lumped masses, integrated by central differences, must give
	the same; quadratic triangles with consistent mass, by Newmark's method, are the solution of the problem (within 0.6 %: half the size, half the step).
	Momentum: force times time.

	Expect: the same to round-off where nothing rotates; within 1 % of the solution in the first 50 µs, 8 % of the deformation after ten passages on 1 cm cells
	(3 % on half the size); with rotating cores (β_φ = 2) as close.
	"""
	histories = {}
	for rotation in ("none", "cosserat"):
		O.reset()
		histories[rotation] = impulse.run(size, rotation=rotation)
	plain, turning = histories["none"], histories["cosserat"]
	equal, exact = impulse_reference.twin(plain), impulse_reference.quadratic(plain)
	source = "FreeFem++, linear triangles on the split mesh, lumped mass, central differences"
	error = np.abs(plain.centre - equal.centre).max() / np.abs(equal.centre).max()
	check("centre, no rotation: largest difference to the same elements over u_x [-]", error, 0, 1e-10, source, scale=1)
	source = "FreeFem++, quadratic triangles, consistent mass, Newmark"
	shaken = np.abs(exact.centre[:, 0] - plain.impulse.rigid(exact.times)).max()
	for rotation, history in histories.items():
		error = np.abs(np.interp(exact.times, history.times, history.centre[:, 0]) - exact.centre[:, 0]) / shaken
		check(f"centre until 50 µs, {rotation}: largest difference over the deformation [-]", error[exact.times <= 50e-6].max(), 0, 1e-2, source, scale=1)
		check(f"centre until 200 µs, {rotation}: largest difference over the deformation [-]", error.max(), 0, 0.08, source, scale=1)
		for instant, field, expected in zip(history.instants, history.fields, exact.fields):
			error = np.linalg.norm(field - expected) / np.linalg.norm(expected - expected.mean(axis=0))
			check(f"field at {1e6 * instant:.0f} µs, {rotation}: difference over deformation, L2 [-]", error, 0, 0.05, source, scale=1)
		velocity = history.impulse.momentum / (2400 * impulse.WIDTH * impulse.HEIGHT)
		check(f"mean velocity at the end, {rotation} [m/s]", history.velocity, velocity, 1e-5, "momentum: impulse over mass")
		check(f"error of the energy book, {rotation} [-]", history.energy_error, 0, 1e-6, "first law", scale=1)
	check.picture(
		lambda: impulse_figures.displacement(turning, exact), "Displacement of the central point, as in Figure 5 of Zubelewicz (2018), and what is left of it without "
		"the motion of a rigid block, beside finite elements."
	)
	check.picture(lambda: impulse_figures.contours(turning), "Displacements at the instants 1, 2 and 3.")
