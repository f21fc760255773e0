# GPL v2 or later, see LICENSE.
"""Stress that a sample has before anything moves, such as that of rock in place.

``ddem.append(…, initial_stress=…)`` gives triangles a stress where they are not strained. Their law sees their strain
plus that of the initial stress, which it makes of the stress itself: so yielding, damage and energies are those of the
whole stress, with every law, and ``block.stress`` is the whole stress; ``block.strain`` and displacements count from
the start. A stress that a law does not bear is refused when the engine reads the scene.

Nothing moves where the stress is in equilibrium with weight, held nodes and loads on edges: constant stress, and stress
that is linear in space together with the gravity that it bears, are in equilibrium node by node, to round-off.
:func:`on_edges` makes the loads on edges that bear it, and takes them away where a hole is opened::

	k0 = 0.5
	weight = lambda x, y: (k0 * gamma * (y - 10), gamma * (y - 10), 0)     # [Pa], surface at y = 10 m
	block = ddem.append(mesh, "rock", initial_stress=weight)
	wall = ddem.initial_stress.on_edges(block, tunnel, course=[(0, 1), (0.01, 0)])

The energy book begins with the energy that the law stores at the initial stress.
"""
import numpy as np

from yade import EdgeTraction, Matrix3, O, Vector2

from .edge_loads import as_course, as_yade, pairs_of


def of_triangles(mesh, materials, stress):
	"""What each triangle's initialStress is to be: lists of tensors [Pa], none, one, or one a sub-element.

	:param materials: by region, for zz where it is left out
	:param stress: as :func:`block.append` takes it
	:raises ValueError: other than three or four finite numbers, or a function that gives others.
	"""
	count = len(mesh.triangles)
	if stress is None:
		return [[]] * count
	corners = mesh.nodes[mesh.triangles]
	centres = corners.mean(axis=1)
	if callable(stress):
		places = np.stack([(centres + corners[:, k] + corners[:, (k + 1) % 3]) / 3 for k in range(3)], axis=1)
		given = stress(*places.reshape(-1, 2).T)
	else:
		places, given = centres[:, None], stress
	rows = places.shape[0] * places.shape[1]
	try:
		parts = [np.broadcast_to(np.asarray(part, float), rows) for part in given]
	except (TypeError, ValueError):
		parts = []
	if len(parts) not in (3, 4) or not np.isfinite(parts).all():
		what = f"the function gives {given!r} for {rows} places" if callable(stress) else f"it is {stress!r}"
		raise ValueError(
			"initial_stress must be (xx, yy, xy) or (xx, yy, xy, zz), finite numbers [Pa], or a function "
			f"of x and y that gives them, numbers or arrays; {what}"
		)
	poisson = np.array([material.poisson if material else 0.0 for material in materials])[mesh.regions]
	xx, yy, xy = (part.reshape(count, -1) for part in parts[:3])
	zz = parts[3].reshape(count, -1) if len(parts) == 4 else poisson[:, None] * (xx + yy)
	return [
		[Matrix3(a, c, 0, c, b, 0, 0, 0, d) for a, b, c, d in zip(*rows)]
		for rows in zip(xx.tolist(), yy.tolist(), xy.tolist(), zz.tolist())
	]


def on_edges(block, edges, course=None):
	"""Tractions that bear the initial stress on edges of a block, an :yref:`EdgeTraction`.

	Dead loads: traction σ·n of the beginning, linear along each edge as the stress is in its triangle.

	:param block: :class:`Block` that was appended with an initial_stress
	:param edges: as for :func:`edge_loads.pressure`
	:param course: pairs (time [s], factor [-]); from 1 to 0 it takes the edges' support away. None: they stay.
	:raises ValueError: edges that are none, a course that is not of rising times,
		or a block without initial stress.
	"""
	pairs = pairs_of(block, edges)
	times, factors = as_course(course)
	rows = {int(i): row for row, i in enumerate(block.node_ids)}
	owner, nodes, triangles = {}, block.mesh.nodes, block.mesh.triangles
	for row, corners in enumerate(triangles.tolist()):
		for k in range(3):
			owner[corners[k], corners[(k + 1) % 3]] = row
	tractions, found = [], False
	for first, second in pairs.tolist():
		ends = rows.get(first), rows.get(second)
		if ends not in owner and ends[::-1] not in owner:
			raise ValueError(f"on_edges: bodies #{first} and #{second} are no edge of this block")
		row = owner[ends] if ends in owner else owner[ends[::-1]]
		start, end = ends if ends in owner else ends[::-1]
		along = nodes[end] - nodes[start]
		normal = np.array([along[1], -along[0]]) / np.hypot(*along)
		stress = _linear(block, row)
		found = found or stress is not None
		for at in ends:
			tractions.append(Vector2(*(stress(nodes[at]) @ normal)) if stress else Vector2(0, 0))
	if not found:
		raise ValueError(
			"on_edges: the triangles at these edges have no initial stress; append the block with one"
		)
	return EdgeTraction(
		edges=as_yade(pairs), tractions=tractions, follower=False, times=times, factors=factors
	)


def _linear(block, row):
	"""Stress (2, 2) [Pa] in a triangle as a function of a place, None without any."""
	shape = O.bodies[block.triangle_ids[row]].shape
	tensors = np.array([[[m[0, 0], m[0, 1]], [m[1, 0], m[1, 1]]] for m in shape.initialStress])
	if not len(tensors):
		return None
	if len(tensors) == 1:
		return lambda place: tensors[0]
	corners = block.mesh.nodes[block.mesh.triangles[row]]
	centre = corners.mean(axis=0)
	at = (centre + corners + np.roll(corners, -1, axis=0)) / 3
	gradient = np.linalg.solve(at[:2] - at[2], (tensors[:2] - tensors[2]).reshape(2, 4))
	return lambda place: tensors.mean(axis=0) + ((place - centre) @ gradient).reshape(2, 2)
