# GPL v2 or later, see LICENSE.
"""What several cases need: materials, engines, motion of whole samples, axes of pictures."""
import contextlib
import weakref

import numpy as np
from matplotlib import rc_context
from scipy.optimize import least_squares

from yade import DeformableElastMat, DeformableEngine, ForceResetter, O, PyRunner, log

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
	"""Set O.engines (the others before the DeformableEngine) and a time step of *step* times the critical one;
	returns the DeformableEngine."""
	engine = DeformableEngine(**settings)
	O.engines = [ForceResetter(), *engines, engine]
	O.dt = step * engine.criticalTimeStep()
	return engine


@contextlib.contextmanager
def without_warnings():
	"""For scenes that do on purpose what the engine warns of."""
	log.setLevel("DeformableEngine", log.ERROR)
	try:
		yield
	finally:
		log.unsetLevel("DeformableEngine")


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
	"""Give nodes and cores the velocity(x, y) [m/s] of their place (arrays), and cores the spin [rad/s],
	a number or a function of x and y."""
	members = bodies(block)
	x, y = np.array([body.state.pos for body in members])[:, :2].T
	for body, vx, vy in zip(members, *np.broadcast_arrays(*velocity(x, y), x)[:2]):
		body.state.vel = (float(vx), float(vy), 0)
	spins = np.broadcast_to(spin(x, y) if callable(spin) else spin, x.shape)[len(block.node_ids):]
	for i, value in zip(block.triangle_ids, spins):
		O.bodies[int(i)].state.angVel = (0, 0, float(value))


_recorders = weakref.WeakValueDictionary()  # by number, for PyRunner


class Recorder:
	"""Keeps what function() returns, with the time, every so many steps; put :attr:`engine` before the
	DeformableEngine, so that positions are those of the time. Keep the recorder itself as long as it runs."""

	def __init__(self, function, every):
		self._function, self._rows = function, []
		_recorders[id(self)] = self
		#: to be put into O.engines
		self.engine = PyRunner(
			command=f"__import__('{__name__}', fromlist=['_recorders'])._recorders[{id(self)}]._take()",
			iterPeriod=every,
			initRun=True,
		)

	def _take(self):
		self._rows.append((O.time, np.array(self._function(), float)))

	@property
	def times(self):
		"""(k,) [s]."""
		return np.array([time for time, _ in self._rows])

	@property
	def values(self):
		"""(k, …)."""
		return np.array([value for _, value in self._rows])


def fit_frequencies(times, signal, guesses):
	"""Angular frequencies [rad/s], near the guesses, of the harmonic oscillations whose sum is closest to the
	signal (least squares), a constant left free."""
	guesses = np.atleast_1d(np.asarray(guesses, float))

	def misfit(scaled):
		phases = np.outer(times, scaled * guesses)
		basis = np.column_stack([np.ones(len(times)), np.cos(phases), np.sin(phases)])
		return basis @ np.linalg.lstsq(basis, signal, rcond=None)[0] - signal

	scale = np.abs(signal).max()
	return (
		least_squares(
			lambda scaled: misfit(scaled) / scale, np.ones(len(guesses)), xtol=1e-12, ftol=1e-14, gtol=1e-14
		).x
		* guesses
	)


def axes(width=plots.COLUMN, height=None, panels=1, **options):
	"""A figure [mm] with a row of panels in the style of the plots: (figure, list of axes)."""
	with rc_context(plots.STYLE):
		fig = plots.figure(width, height or 0.68 * width / panels)
		fig.set_layout_engine("constrained")
		row = fig.subplots(1, panels, squeeze=False, **options)[0]
		for ax in row:
			ax.spines[["top", "right"]].set_visible(False)
		return fig, list(row)


def legend(ax, columns=2, **options):
	"""A legend above the axes, where it covers nothing."""
	with rc_context(plots.STYLE):
		ax.legend(
			loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=columns, borderaxespad=0.2,
			columnspacing=1.2, handlelength=1.6, **options
		)
