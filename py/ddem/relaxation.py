# GPL v2 or later, see LICENSE.
"""Equilibrium by dynamic relaxation: explicit steps with damping until the forces balance, the way the method was first
used for quasi-static problems."""
import math

import numpy as np

from yade import O

from .block import _engine

#: steps before the first look at the residual; then there is one whenever a fifth as many steps as so far have passed
FIRST = 500


def relax(residual=1e-6, damping=0.3, limit=200_000):
	"""Run until every node and every core of the scene is in equilibrium with its loads, supports and prescribed
	positions; returns the residual and the steps.

	Cundall's local damping takes the motion out. Time means nothing meanwhile. Forces of other engines,
	O.forces.setPermF and :yref:`DeformableEngine.gravity` are the loads; held nodes stay where they are,
	or move on as prescribed.

	:param residual: wanted :func:`out_of_balance` [-].
		Round-off of positions sets a floor of some 1e-15 over the strain.
	:param damping: :yref:`DeformableEngine.damping` meanwhile [-]; what it was before is put back. 0.1 is fastest
		for compact samples: a block of 800 triangles between platens is at 1e-6 after 1500 steps, with
		0.3 after 4000, with 0.7 not after 6000. Bending is slow: a cantilever four times as long as high takes
		32 000 steps with 0.3, more with less damping and with more, because slow motion keeps stiff modes
		going; one twenty times as long stays at 4e-4 for 60 000 steps.
	:param limit: steps after which to give up.
	:raises ValueError: residual, damping or limit out of range, or no time step.
	:raises RuntimeError: still out of balance after *limit* steps.
	"""
	for name, value, largest in (("residual", residual, 1), ("damping", damping, 1), ("limit", limit, math.inf)):
		if not 0 < value < largest:
			raise ValueError(
				f"relax: {name} = {value} must be positive"
				+ (f" and below {largest}" if largest < math.inf else "")
			)
	if not O.dt > 0:
		raise ValueError(f"O.dt = {O.dt} s must be positive; set O.dt = ddem.time_step(0.8)")
	engine, first = _engine(), O.iter
	before = engine.damping
	try:
		while True:
			engine.damping = damping
			O.run(max(FIRST, (O.iter - first) // 5) - 1, True)
			reached = out_of_balance()
			if reached <= residual:
				return reached, O.iter - first
			if O.iter - first >= limit:
				raise RuntimeError(
					f"relax: the forces are still out of balance by {reached:.1e} after "
					f"{O.iter - first} steps, {residual:.1e} is wanted; raise limit=, try less "
					"damping, or allow a larger residual="
				)
	finally:
		engine.damping = before


def out_of_balance():
	"""Largest force out of balance at any free degree of freedom (or moment on a core over the triangle's size),
	over the mean force that the stresses of a triangle transmit, ``|σ| h √S`` [-]. Zero where neither is more than
	the round-off of positions, infinite where a load meets a sample that carries nothing yet.

	It takes one undamped step, whose change of velocities tells all forces, whoever adds them.
	"""
	engine = _engine()
	triangles = [O.bodies[int(i)] for i in engine.values("triangleIds")]
	size, stress = np.sqrt(engine.values("area")), engine.values("stress")
	section = size * np.array([body.shape.thickness for body in triangles])
	norm = np.sqrt((stress[..., [0, 1]]**2).sum(axis=2) + 2 * stress[..., 3]**2).mean(axis=1)
	noise = (
		max(body.material.young for body in triangles)
		* np.spacing(np.abs(engine.array("nodePosition")).max())
		/ size.min()
	)

	velocities = {
		name: engine.array(name).copy()
		for name in ("nodeVelocity", "coreVelocity", "coreSpin")
		if name != "coreSpin" or engine.rotation == "cosserat"
	}
	damping, engine.damping = engine.damping, 0.0
	O.step()
	engine.damping = damping
	change = {name: engine.array(name) - before for name, before in velocities.items()}
	forces = [
		np.abs(engine.array(kind + "Mass")[:, None] * change[kind + "Velocity"]).max() / O.dt
		for kind in ("node", "core")
	]
	if "coreSpin" in change:
		forces.append(
			np.abs(
				np.array([body.state.inertia[2] for body in triangles]) * change["coreSpin"] / size
			).max()
			/ O.dt
		)
	largest, transmitted, floor = max(forces), (norm * section).mean(), 100 * noise * section.mean()
	if transmitted > floor:
		return float(largest / transmitted)
	return 0.0 if largest <= floor else math.inf
