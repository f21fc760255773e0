# GPL v2 or later, see LICENSE.
"""What several cases need: materials, engines, motion of whole samples, axes of pictures."""
import numpy as np
from matplotlib import rc_context

from yade import DeformableElastMat, DeformableEngine, ForceResetter, O

from .. import plots

CONCRETE = {"bulk": 30e9, "shear": 26e9, "density": 2400}  #: Zubelewicz (2018), Table 1, without the equation of state
STEEL = {"bulk": 151e9, "shear": 81e9, "density": 8030}  #: 304L: Zubelewicz (2018), section 4.3
TREATMENTS = ("none", "corotational", "cosserat")  #: of rotation


def elastic(label="elastic", **changes):
	"""Append an elastic material, concrete's unless changed, and return it."""
	properties = changes if "young" in changes else {**CONCRETE, **changes}
	material = DeformableElastMat(label=label, **properties)
	O.materials.append(material)
	return material


def lame(material):
	"""(λ, μ) [Pa]."""
	return material.bulk - 2 / 3 * material.shear, material.shear


def start(*engines, step=0.8, **settings):
	"""Set O.engines (the others before the DeformableEngine) and a time step of *step* times the critical one; returns the DeformableEngine."""
	engine = DeformableEngine(**settings)
	O.engines = [ForceResetter(), *engines, engine]
	O.dt = step * engine.criticalTimeStep()
	return engine


def bodies(block):
	"""Node bodies, then triangle bodies, of a block."""
	return [O.bodies[int(i)] for i in (*block.node_ids, *block.triangle_ids)]


def place(block, move):
	"""Put nodes and cores where move(x, y) says, x and y being arrays of their reference positions [m]."""
	members = bodies(block)
	x, y = np.array([body.state.refPos for body in members])[:, :2].T
	for body, new_x, new_y in zip(members, *np.broadcast_arrays(*move(x, y), x)[:2]):
		body.state.pos = (float(new_x), float(new_y), 0)


def set_velocity(block, velocity, spin=0.0):
	"""Give nodes and cores the velocity(x, y) [m/s] of their place (arrays), and cores the spin [rad/s], a number or a function of x and y."""
	members = bodies(block)
	x, y = np.array([body.state.pos for body in members])[:, :2].T
	for body, vx, vy in zip(members, *np.broadcast_arrays(*velocity(x, y), x)[:2]):
		body.state.vel = (float(vx), float(vy), 0)
	spins = np.broadcast_to(spin(x, y) if callable(spin) else spin, x.shape)[len(block.node_ids):]
	for i, value in zip(block.triangle_ids, spins):
		O.bodies[int(i)].state.angVel = (0, 0, float(value))


def axes(width=plots.COLUMN, height=None, panels=1, **options):
	"""A figure [mm] with a row of panels in the style of the plots: (figure, list of axes)."""
	with rc_context(plots.STYLE):
		fig = plots.figure(width, height or 0.68 * width / panels)
		fig.set_layout_engine("constrained")
		row = fig.subplots(1, panels, squeeze=False, **options)[0]
		for ax in row:
			ax.spines[["top", "right"]].set_visible(False)
		return fig, list(row)
