# GPL v2 or later, see LICENSE.
"""A flexible jacket around bonded spheres: the membrane of a triaxial cell, under the pressure of its fluid.

Its names are those of :mod:`bonded`, too: ``ddem.bonded.jacket``. SI units; pressure and strains are positive in
compression.
"""
import math

import numpy as np

from yade import JacketPressure, O, Vector2i, Vector3, Vector3i

from .cells import require_faces

_AXES = "xyz"
_CORNERS = 64  # of the polygon around each sphere's outline
# what a prism on the outline may have of the volume of the shape: it is below 1 where the sides are parallel
_LARGER = 1.05
# and that on the centres of their hull: 1.13 in a prism of a hundred spheres, 1.25 in a disc along a diameter
_LARGER_HULL = 1.2
_PARTS = 6  # of the distance between nodes, to which the side is split among spheres


def jacket(sample, pressure, ramp=1e-4, axis="y", resolution=None):
	"""A flexible jacket around the sides of a cylinder, a prism or another convex specimen of one cross-section,
	whose ends platens cover::

		press = ddem.bonded.servo(sample, [("stress", 10e6, 1e-4), ("strain", 0.01, 2e-3)], velocity=1.0)
		around = ddem.bonded.jacket(sample, pressure=10e6, ramp=1e-4)
		O.engines = ddem.bonded.engines([press, around])

	The membrane is made on the convex outline of the spheres, seen along the axis,
	from end to end of the sample's box:
	smooth at first, as rubber that bridges the pores. Each of its nodes moves with the mean of the spheres whose
	surfaces are next to it. So each outer sphere bears the pressure on its part of the side,
	and all together that on the whole side.

	:param sample: :class:`bonded.BondedSample`, whose sides are parallel to *axis*
	:param pressure: that presses inwards [Pa]
	:param ramp: time in which it grows from 0 [s]; some ten times that of a wave through the sample
	:param axis: of the specimen, "x", "y" or "z"
	:param resolution: distance of the membrane's nodes [m]. None: 1.5 mean radii of the spheres.
	:returns: :class:`Jacket`; hand it to :func:`bonded.engines`.
	:raises ValueError: pressure or ramp negative or not finite, an unknown axis, a layer, a resolution that is not
		positive or leaves fewer than six nodes around the sample, sides that are not parallel to the axis:
		a prism on the outline larger than the shape by more than 5 %, or, where the packing says no shape and
		spheres are the only measure, that of the centres larger than their convex hull by more than 20 %

	Limits: see :yref:`JacketPressure`. The surface layer of a packing has fewer bonds and is softer than the rest,
	and a jacket does not spread its load as a rigid wall does.
	"""
	require_faces()
	if axis not in _AXES:
		raise ValueError(f"axis = '{axis}' is unknown; use 'x', 'y' or 'z'")
	for name, value, unit in (("pressure", pressure, "Pa"), ("ramp", ramp, "s")):
		if not (value >= 0 and math.isfinite(value)):
			raise ValueError(f"jacket: {name} = {value} {unit} must be finite and not negative")
	radii = sample.radii
	size = 1.5 * float(radii.mean()) if resolution is None else resolution
	if not (size > 0 and math.isfinite(size)):
		raise ValueError(f"jacket: resolution = {resolution} m must be positive and finite")
	number = _AXES.index(axis)
	across = [(number + 1) % 3, (number + 2) % 3]  # with the axis a right-handed frame
	if np.ptp(sample.positions, axis=0)[across].min() < 1e-9 * radii.max():
		raise ValueError(f"jacket: the spheres are one layer along {axis}: there is no side to go around")
	outline = _outline(sample.positions[:, across], radii, size)
	_check_sides(sample, outline, across, number)
	rows = max(1, math.ceil((sample.upper - sample.lower)[number] / size)) + 1
	heights = np.linspace(sample.lower[number], sample.upper[number], rows)
	nodes = np.empty((rows, len(outline), 3))
	nodes[:, :, across], nodes[:, :, number] = outline, heights[:, None]
	nodes = nodes.reshape(-1, 3)
	faces, ends = _tube(rows, len(outline))
	ids = np.asarray(sample.ids)
	owners, shares = _supports(outline, heights, across, number, sample.positions, radii)
	held = np.unique(owners)
	offsets = nodes.copy()
	np.subtract.at(offsets, shares["node"], shares["weight"][:, None] * sample.positions[owners])
	a, b, c = (nodes[faces[:, k]] for k in range(3))
	return Jacket(
		JacketPressure(
			pressure=pressure, rampTime=ramp, axis=Vector3.Unit(number), ids=ids[held].tolist(),
			offsets=[Vector3(*o) for o in offsets.tolist()],
			supports=[
				Vector2i(*s)
				for s in zip(shares["node"].tolist(), np.searchsorted(held, owners).tolist())
			],
			weights=shares["weight"].tolist(),
			faces=[Vector3i(*f) for f in faces.tolist()], ends=[Vector3i(*f) for f in ends.tolist()],
			normals=[Vector3(*n) for n in np.cross(b - a, c - a).tolist()]
		)
	)


def _check_sides(sample, outline, across, number):
	"""The membrane must lie on the sides, not span across what is missing beside a prism."""
	from scipy.spatial import ConvexHull, QhullError
	if sample.is_shaped:
		what, limit = "volume of the sample", _LARGER
		found = ConvexHull(outline).volume * float((sample.upper - sample.lower)[number]) / sample.volume
	else:
		what, limit, centres = "convex hull of the spheres' centres", _LARGER_HULL, sample.positions
		height = np.ptp(centres[:, number])
		if height < 1e-9 * sample.radii.max():
			return  # one layer across the axis
		try:
			found = ConvexHull(centres[:, across]).volume * height / ConvexHull(centres).volume
		except QhullError:
			found = math.inf  # a layer at a slant
	if found > limit:
		raise ValueError(
			f"jacket: a prism along {_AXES[number]} on the sample's outline has {found:.3g} times the "
			f"{what}, where {limit} is the limit: its sides are not parallel to that axis; choose the "
			"axis= along which it has one cross-section, or make it a prism or a cylinder"
		)


def _supports(outline, heights, across, number, centres, radii):
	"""Which spheres carry each node, and by which weights: the shares of its cell, a node's surroundings half way
	to the next, that is nearest to their surfaces; :data:`_PARTS` squared points of it are asked.

	:returns: rows of the spheres (n,), and for each of these the number of the node and the weight, by name
	"""
	parts = (np.arange(_PARTS) + 0.5) / _PARTS - 0.5  # of the distance between nodes
	ahead, back = np.roll(outline, -1, axis=0) - outline, outline - np.roll(outline, 1, axis=0)
	sides = np.where(parts[:, None, None] > 0, ahead, back) * parts[:, None, None] + outline
	levels = heights + parts[:, None] * (heights[1] - heights[0])
	levels = heights[-1] - abs(heights[-1] - heights[0] - abs(levels - heights[0]))  # half cells at the ends
	points = np.empty((len(heights), len(outline), _PARTS, _PARTS, 3))
	points[..., across] = sides.swapaxes(0, 1)[None, :, None]
	points[..., number] = levels.T[:, None, :, None]
	owners = _nearest(points.reshape(-1, 3), centres, radii)
	node = np.repeat(np.arange(len(heights) * len(outline)), _PARTS**2)
	pairs, counts = np.unique(np.column_stack([node, owners]), axis=0, return_counts=True)
	return pairs[:, 1], {"node": pairs[:, 0], "weight": counts / _PARTS**2}


def _outline(centres, radii, size):
	"""Points (n, 2) at equal distances of about *size* on the convex hull of discs, counter-clockwise."""
	from scipy.spatial import ConvexHull
	angles = np.arange(_CORNERS) * 2 * math.pi / _CORNERS
	corners = np.column_stack([np.cos(angles), np.sin(angles)])
	points = (centres[:, None] + radii[:, None, None] * corners).reshape(-1, 2)
	hull = points[ConvexHull(points).vertices]
	closed = np.vstack([hull, hull[:1]])
	way = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(closed, axis=0).T))])
	count = math.ceil(way[-1] / size)
	if count < 6:
		raise ValueError(f"jacket: resolution = {size:.6g} m leaves fewer than six nodes around the sample")
	places = np.arange(count) * way[-1] / count
	return np.column_stack([np.interp(places, way, closed[:, k]) for k in (0, 1)])


def _tube(rows, around):
	"""Triangles (n, 3) of a tube of nodes, row by row from its lower end, normals outwards;
	and those of its ends."""
	row, column = (place.ravel() for place in np.mgrid[:rows - 1, :around])
	here, next_ = row * around + column, row * around + (column + 1) % around
	faces = np.stack([here, next_, here + around, next_, next_ + around, here + around], axis=1).reshape(-1, 3)
	fan = np.arange(1, around - 1)
	low = np.column_stack([np.zeros_like(fan), fan + 1, fan])
	high = (rows - 1) * around + np.column_stack([np.zeros_like(fan), fan, fan + 1])
	return faces, np.concatenate([low, high])


def _nearest(nodes, centres, radii):
	"""The sphere whose surface is nearest to each node (n,)."""
	from scipy.spatial import cKDTree
	tree, count = cKDTree(centres), min(16, len(centres))
	distances, rows = tree.query(nodes, k=count)
	distances, rows = distances.reshape(len(nodes), -1), rows.reshape(len(nodes), -1)
	gaps = distances - radii[rows]
	nearest = rows[np.arange(len(nodes)), gaps.argmin(axis=1)]
	# large spheres further away may reach closer than the nearest centres do
	for node in np.flatnonzero((distances[:, -1] - radii.max() < gaps.min(axis=1)) & (count < len(centres))):
		nearest[node] = np.argmin(np.linalg.norm(centres - nodes[node], axis=1) - radii)
	return nearest


class Jacket:
	"""A flexible jacket on bonded spheres: what :func:`jacket` returns."""

	def __init__(self, engine):
		self.engine = engine  #: the :yref:`JacketPressure`
		self.engines = [engine]
		self._volume = engine.volume

	@classmethod
	def from_scene(cls):
		"""The jacket in the current scene, for a scene that was loaded; its strain counts from then.

		:raises RuntimeError: O.engines has none, or more than one
		"""
		found = [engine for engine in O.engines if isinstance(engine, JacketPressure)]
		if len(found) != 1:
			raise RuntimeError(f"O.engines has {len(found)} JacketPressure where a jacket is one")
		return cls(found[0])

	@property
	def pressure(self):
		"""Present pressure [Pa]."""
		return self.engine.present

	@property
	def volume(self):
		"""Volume within the membrane and the ends [m³]."""
		return self.engine.volume

	@property
	def volumetric_strain(self):
		"""Share of that volume that has been lost since the jacket was made [-]:
		what a triaxial cell measures."""
		return 1 - self.volume / self._volume

	@property
	def mesh(self):
		"""Present nodes (n, 3) [m] and faces (m, 3) of the membrane, for pictures."""
		engine = self.engine
		return np.array(engine.nodes()), np.array(engine.faces)
