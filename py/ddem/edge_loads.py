# GPL v2 or later, see LICENSE.
"""Loads on edges of a sample of deformable triangles: pressure and tractions, and edges through which waves leave."""
import math

import numpy as np

from yade import AbsorbingEdge, EdgeTraction, O, Vector2, Vector2i


def pressure(
	block, edges, value=0.0, shear=0.0, traction=(0.0, 0.0), ramp=0.0, course=None, follower=True, profile=None
):
	"""Load edges of a block; returns an :yref:`EdgeTraction`, to be put into O.engines::

		confine = ddem.pressure(block, "right", 5e6, ramp=1e-3)
		O.engines = [ForceResetter(), confine, DeformableEngine()]

	Its attributes may be changed at any time, for example ``confine.pressure = 2e6`` in a PyRunner.

	:param block: :class:`Block` from :func:`block.append`
	:param edges: a side or a function of the mesh's coordinates, as :meth:`Block.edges` takes them, or pairs of
		node ids (b, 2).
	:param value: normal pressure [Pa], positive compresses.
	:param shear: shear traction [Pa] along the border, counter-clockwise about the block.
	:param traction: traction (x, y) [Pa] of a fixed direction.
	:param ramp: time over which the load grows linearly from zero, from now [s].
	:param course: pairs (time [s], factor [-]) of the load, in O.time, linear in between and constant before and
		after; instead of *ramp*.
	:param follower: True: the load follows the edges as they turn and stretch; False: a dead load of the beginning.
	:param profile: function of the arrays x, y [m] of nodes in the mesh's coordinates that gives factors [-],
		linear along each edge; None: uniform.
	:raises ValueError: a value that is not finite, a negative ramp, ramp and course together, a
		course that is not of rising times, a profile that does not give a number for each node; edges that are
		none, see :meth:`Block.edges`.
	"""
	values = np.array([value, shear, *traction], float)
	if values.shape != (4,) or not np.isfinite(values).all():
		raise ValueError(
			f"pressure: value = {value} Pa, shear = {shear} Pa and traction = {traction} Pa must be "
			"finite numbers"
		)
	if not 0 <= ramp < math.inf:
		raise ValueError(f"pressure: ramp = {ramp} s must be finite and not negative")
	if ramp and course is not None:
		raise ValueError("pressure: give either ramp= or course=")
	if ramp:
		course = [(O.time, 0.0), (O.time + ramp, 1.0)]
	times, factors = as_course(course)
	pairs = pairs_of(block, edges)
	return EdgeTraction(
		edges=as_yade(pairs), pressure=value, shear=shear, traction=Vector2(*values[2:]), follower=follower,
		times=times, factors=factors, profile=_profile(block, pairs, profile)
	)


def absorb(block, edges, keep=True, dofs="xy"):
	"""Let waves leave a block through edges; returns an :yref:`AbsorbingEdge`, to be put into O.engines.

	Nodes of the edges that are held are let go. What held them in the last step goes on as a force, so that
	a sample in equilibrium stays where it is::

		ddem.relax()                                  # under its weight, the bottom held
		leave = ddem.absorb(block, "bottom")
		O.engines = O.engines[:-1] + [leave, O.engines[-1]]

	:param block: :class:`Block` from :func:`block.append`
	:param edges: as for :func:`pressure`.
	:param keep: whether the reactions go on.
	:param dofs: directions in which held nodes are let go, "x", "y" or "xy"; for a corner that another side holds.
	:raises ValueError: dofs unknown; edges that are none.
	:raises RuntimeError: reactions are to go on, and no step has been made that would tell them.
	"""
	if dofs not in ("x", "y", "xy"):
		raise ValueError(
			f"absorb: dofs = {dofs!r} must be 'x', 'y' or 'xy', the directions in which nodes are let go"
		)
	pairs = pairs_of(block, edges)
	nodes = np.unique(pairs)
	held = [set(O.bodies[int(i)].state.blockedDOFs) & set(dofs) for i in nodes]
	engine = AbsorbingEdge(edges=as_yade(pairs))
	if keep and any(held):
		rows = {int(i): row for row, i in enumerate(block.node_ids)}
		forces = block.reactions[[rows[int(i)] for i in nodes]]
		engine.nodes = [int(i) for i, own in zip(nodes, held) if own]
		engine.forces = [
			Vector2(x if "x" in own else 0, y if "y" in own else 0)
			for (x, y), own in zip(forces, held)
			if own
		]
	for i, own in zip(nodes, held):
		if own:
			block.release([i], "".join(own))
	return engine


def pairs_of(block, edges):
	"""Node ids (b, 2) of edges, named or given."""
	if edges is None or isinstance(edges, str) or callable(edges):
		return np.asarray(block.edges(edges))
	pairs = np.asarray(edges)
	if pairs.ndim != 2 or pairs.shape[1] != 2 or pairs.dtype.kind not in "iu" or not len(pairs):
		raise ValueError(
			f"edges of shape {pairs.shape} and type {pairs.dtype} are no pairs of node ids (b, 2); "
			"give what block.edges('right') gives, a side, or a function of x and y"
		)
	return pairs


def as_course(course):
	"""Times [s] and factors [-] of pairs; none where there is no course.

	:raises ValueError: other than pairs of finite numbers with rising times.
	"""
	if course is None:
		return [], []
	wrong = ValueError(f"course = {course} must be pairs of rising times [s] and factors [-], all finite")
	try:
		table = np.array(course, float)
	except (TypeError, ValueError):
		raise wrong from None
	if table.ndim != 2 or table.shape[1:] != (2,) or len(table) == 0:
		raise wrong
	if not np.isfinite(table).all() or (np.diff(table[:, 0]) <= 0).any():
		raise wrong
	return table[:, 0].tolist(), table[:, 1].tolist()


def as_yade(pairs):
	"""Pairs of ids as engines take them."""
	return [Vector2i(int(a), int(b)) for a, b in pairs]


def _profile(block, pairs, profile):
	if profile is None:
		return []
	rows = {int(i): row for row, i in enumerate(block.node_ids)}
	missing = [int(i) for i in np.unique(pairs) if int(i) not in rows]
	if missing:
		raise ValueError(
			f"pressure: node {missing[0]} is not of this block, so profile= has no coordinates for it"
		)
	places = block.mesh.nodes[[rows[int(i)] for i in pairs.ravel()]]
	factors = np.asarray(profile(*places.T), float)
	if factors.shape != (len(places),) or not np.isfinite(factors).all():
		raise ValueError(
			f"pressure: profile= must turn the arrays x, y ({len(places)} values) into as many finite "
			f"factors, it gave shape {factors.shape}"
		)
	return [Vector2(a, b) for a, b in factors.reshape(-1, 2)]
