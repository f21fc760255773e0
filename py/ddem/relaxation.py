# GPL v2 or later, see LICENSE.
"""Equilibrium by dynamic relaxation: explicit steps with damping until the forces balance, the way the method was first used for quasi-static problems."""
import math

import numpy as np

from yade import O

from .block import _engine

FIRST = 500  #: steps before the first look at the residual; then there is one whenever a fifth as many steps as so far have passed


def relax(residual=1e-6, damping=0.3, limit=200_000):
	"""Run until every node and every core of the scene is in equilibrium with its loads, supports and prescribed positions; returns the residual and the steps.

	Cundall's local damping takes the motion out. Time means nothing meanwhile. Forces of other engines, O.forces.setPermF and :yref:`DeformableEngine.gravity` are
	the loads; held nodes stay where they are, or move on as prescribed.

	:param residual: largest force out of balance of any degree of freedom (or moment of a core over the triangle's size) over the mean force that the stresses
		of a triangle transmit, |σ| h √S. Round-off of positions sets a floor of some 1e-15 over the strain.
	:param damping: :yref:`DeformableEngine.damping` meanwhile [-]; what it was before is put back. Local damping of 0.3 needs about 10 periods of the slowest mode
		for 1e-6 and then slows down, more of it stops earlier: 0.7 never gets below 1e-4, because it keeps stiff modes chattering.
	:param limit: steps after which to give up.
	:raises ValueError: residual, damping or limit out of range, or no time step.
	:raises RuntimeError: still out of balance after *limit* steps.
	"""
	for name, value, largest in (("residual", residual, 1), ("damping", damping, 1), ("limit", limit, math.inf)):
		if not 0 < value < largest:
			raise ValueError(f"relax: {name} = {value} must be positive" + (f" and below {largest}" if largest < math.inf else ""))
	if not O.dt > 0:
		raise ValueError(f"O.dt = {O.dt} s must be positive; set O.dt = ddem.time_step(0.8)")
	engine, first = _engine(), O.iter
	before = engine.damping
	try:
		while True:
			engine.damping = damping
			O.run(max(FIRST, (O.iter - first) // 5) - 1, True)
			engine.damping = 0
			reached = _step_and_residual(engine)
			if reached <= residual:
				return reached, O.iter - first
			if O.iter - first >= limit:
				raise RuntimeError(
					f"relax: the forces are still out of balance by {reached:.1e} after {O.iter - first} steps, {residual:.1e} is wanted; raise limit=, "
					"try less damping, or allow a larger residual="
				)
	finally:
		engine.damping = before


def _step_and_residual(engine):
	"""One undamped step, whose change of velocities tells all forces out of balance; blocked degrees of freedom do not change."""
	kinds = [("node", "Velocity", "nodeMass"), ("core", "Velocity", "coreMass")]
	before = [engine.array(kind + name).copy() for kind, name, _ in kinds]
	spins = engine.array("coreSpin").copy() if engine.rotation == "cosserat" else None
	O.step()
	forces = [
		np.abs(engine.array(mass)[:, None] * (engine.array(kind + name) - old)).max() / O.dt for (kind, name, mass), old in zip(kinds, before)
	]
	size = np.sqrt(engine.values("area"))
	if spins is not None:
		inertia = np.array([O.bodies[int(i)].state.inertia[2] for i in engine.values("triangleIds")])
		forces.append(np.abs(inertia * (engine.array("coreSpin") - spins) / size).max() / O.dt)
	thickness = np.array([O.bodies[int(i)].shape.thickness for i in engine.values("triangleIds")])
	stress = engine.values("stress")
	transmitted = (np.sqrt((stress[..., [0, 1]]**2).sum(axis=2) + 2 * stress[..., 3]**2).mean(axis=1) * thickness * size).mean()
	return max(forces) / transmitted if transmitted > 0 else (0.0 if max(forces) == 0 else math.inf)
