# GPL v2 or later, see LICENSE.
"""Convex specimens to be filled with spheres, in space and, for layers, in the plane z = 0::

	Cylinder((0, 0, 0), (0, 0.1, 0), radius=0.025)
	Polyhedron.from_half_spaces([(-1, 0, 0), (0, -1, 0), (0, 0, -1), (1, 1, 1)], [0, 0, 0, 0.05])

See :func:`packing.fill`. Every shape has

- ``dimension``: 3, or 2 in the plane,
- ``lower``, ``upper``: corners of the box around it (3,) [m],
- ``volume`` [m³], in the plane the area [m²],
- ``inner``: radius of the largest ball, or disc, inside [m],
- ``face(axis)``: its flat face across an axis [m²], in the plane its length [m].

Needs no YADE.
"""
import math

import numpy as np

_SAME = 1e-9  # of lengths that differ by less than this share of the size of a shape


class _Shape:
	dimension = 3
	_numbers = ()  # parameters of the constructor, which are attributes, too

	def as_record(self):
		"""Kind and numbers as JSON takes them, of which :func:`from_record` makes the same shape again."""
		values = {name: getattr(self, name) for name in self._numbers}
		return {
			"kind": type(self).__name__,
			**{
				name: value if np.isscalar(value) else value[..., :self.dimension].tolist()
				for name, value in values.items()
			}
		}

	def face(self, axis):
		"""Smaller of the two flat faces across *axis* (0, 1 or 2), those that platens load [m²]; in the plane
		its length [m].

		:raises ValueError: it ends there in a point, an edge or a round side
		"""
		ends = self._ends(axis)
		if min(ends) <= 0:
			raise ValueError(
				f"{self} has no flat face at its {'lower' if ends[0] <= 0 else 'upper'} end across "
				f"{'xyz'[axis]}; give the area that stresses are to refer to"
			)
		return min(ends)

	def _ends(self, axis):
		"""Lower and upper face across an axis; 0 where there is none."""
		return 0.0, 0.0


class _Polytope(_Shape):
	"""What lies inside of planes; in the plane z = 0, of lines."""

	def __init__(self, corners, normals, offsets, volume, inner):
		#: (n, 3) [m]
		self.corners = corners
		self.lower, self.upper = corners.min(axis=0), corners.max(axis=0)
		self.volume, self.inner = float(volume), float(inner)
		#: outward normals (m, 3)
		self.normals = normals
		#: distances of the planes from the origin along them (m,) [m]
		self.offsets = offsets
		self.walls = [
			("plane", tuple(-normal), -float(offset)) for normal, offset in zip(normals, offsets)
		]

	def _ends(self, axis):
		from scipy.spatial import ConvexHull
		close = _SAME * np.ptp(self.corners, axis=0).max()
		others = [k for k in range(self.dimension) if k != axis]
		if axis >= self.dimension:
			return self.volume, self.volume
		found = []
		for end in (self.lower[axis], self.upper[axis]):
			points = self.corners[abs(self.corners[:, axis] - end) <= close][:, others]
			if len(points) < self.dimension:
				found.append(0.0)
			elif self.dimension == 2:
				found.append(float(np.ptp(points)))
			else:
				found.append(float(ConvexHull(points).volume))
		return tuple(found)


class Box(_Polytope):
	"""A box along the axes."""

	_numbers = ("lower", "upper")

	def __init__(self, lower, upper):
		"""
		:param lower, upper: corners (3,) [m]
		:raises ValueError: numbers that are not finite, an upper corner that is not above the lower one
		"""
		self._set(_vector("lower", lower, 3), _vector("upper", upper, 3))

	def _set(self, lower, upper):
		for name, a, b in zip("xyz", lower, upper):
			if not b > a:
				raise ValueError(f"upper {name} = {b} m must be above lower {name} = {a} m")
		d, size = len(lower), upper - lower
		corners = np.zeros((2**d, 3))
		corners[:, :d] = np.stack(np.meshgrid(*zip(lower, upper), indexing="ij"), axis=-1).reshape(-1, d)
		normals = np.concatenate([-np.eye(3)[:d], np.eye(3)[:d]])
		super().__init__(corners, normals, np.concatenate([-lower, upper]), size.prod(), 0.5 * size.min())

	def _ends(self, axis):
		size = (self.upper - self.lower)[:self.dimension]
		return 2 * (float(np.delete(size, axis).prod() if axis < self.dimension else size.prod()), )

	def __str__(self):
		return f"the box of {_lengths(self.upper - self.lower)} m"


class Polyhedron(_Polytope):
	"""A convex polyhedron."""

	_numbers = ("corners", )

	def __init__(self, corners):
		"""
		:param corners: (n, 3) [m], in any order
		:raises ValueError: fewer than four, in one plane, not finite, or one inside of the others' hull
		"""
		super().__init__(*_hull(corners, 3))

	@classmethod
	def from_half_spaces(cls, normals, offsets):
		"""What solves normals · x <= offsets.

		:param normals: (n, 3), outward, of any length
		:param offsets: (n,) [m] times that length
		:raises ValueError: nothing does, or something that has no end
		"""
		from scipy.optimize import linprog
		from scipy.spatial import HalfspaceIntersection
		normals, offsets = np.array(normals, float).reshape(-1, 3), np.array(offsets, float).reshape(-1)
		length = np.linalg.norm(normals, axis=1)
		if len(normals) != len(offsets) or not (length > 0).all() or not np.isfinite([*length, *offsets]).all():
			raise ValueError(
				f"half-spaces need a normal and an offset each: got {len(normals)} normals and "
				f"{len(offsets)} offsets, which must be finite, and the normals not zero"
			)
		normals, offsets = normals / length[:, None], offsets / length
		scale = abs(offsets).max() or 1.0  # tolerances of linprog are absolute
		for axis in (*np.eye(3), *-np.eye(3)):
			end = linprog(axis, A_ub=normals, b_ub=offsets / scale, bounds=(None, None))
			if end.status == 2:
				raise ValueError(f"these {len(normals)} half-spaces have no point in common")
			if end.status == 3:
				raise ValueError(
					f"these {len(normals)} half-spaces have no end towards "
					f"{'+' if axis.sum() < 0 else '-'}{'xyz'[abs(axis).argmax()]}; add one"
				)
		centre, inner = _largest_ball(normals, offsets)
		if not inner > _SAME * scale:
			raise ValueError(f"these {len(normals)} half-spaces have no volume in common")
		planes = np.column_stack([normals, -offsets])
		return cls(_distinct(HalfspaceIntersection(planes, centre).intersections, _SAME * inner))

	def __str__(self):
		return f"the polyhedron of {len(self.corners)} corners"


class Cylinder(_Shape):
	"""A cylinder between two flat ends."""

	_numbers = ("bottom", "top", "radius")

	def __init__(self, bottom, top, radius):
		"""
		:param bottom, top: centres of its ends (3,) [m]
		:param radius: [m]
		:raises ValueError: a radius or a height that is not positive, numbers that are not finite
		"""
		self.bottom, self.top = _vector("bottom", bottom, 3), _vector("top", top, 3)
		self.radius = _radius(radius)
		self.height = float(np.linalg.norm(self.top - self.bottom))
		if not self.height > 0:
			raise ValueError(f"bottom and top of the cylinder are the same point {tuple(self.bottom)} m")
		#: direction of its axis (3,) [-]
		self.axis = (self.top - self.bottom) / self.height
		around = self.radius * np.sqrt(np.maximum(1 - self.axis**2, 0))
		self.lower = np.minimum(self.bottom, self.top) - around
		self.upper = np.maximum(self.bottom, self.top) + around
		self.volume = math.pi * self.radius**2 * self.height
		self.inner = min(self.radius, 0.5 * self.height)
		axis = tuple(self.axis)
		self.walls = [
			("cylinder", tuple(self.bottom), self.radius, axis),
			("plane", axis, float(self.axis @ self.bottom)),
			("plane", tuple(-self.axis), -float(self.axis @ self.top)),
		]

	def _ends(self, axis):
		along = abs(self.axis[axis]) > 1 - 1e-12
		return 2 * (math.pi * self.radius**2 if along else 0.0, )

	def __str__(self):
		return f"the cylinder of radius {self.radius} m and height {self.height:.6g} m"


class Ball(_Shape):
	"""A ball."""

	_numbers = ("centre", "radius")

	def __init__(self, centre, radius):
		"""
		:param centre: (3,) [m]
		:param radius: [m]
		:raises ValueError: a radius that is not positive, numbers that are not finite
		"""
		self._set(_vector("centre", centre, 3), radius)

	def _set(self, centre, radius):
		self.radius = self.inner = _radius(radius)
		#: (3,) [m]
		self.centre = np.zeros(3)
		self.centre[:len(centre)] = centre
		around = np.zeros(3)
		around[:len(centre)] = self.radius
		self.lower, self.upper = self.centre - around, self.centre + around
		self.volume = (math.pi if len(centre) == 2 else 4 / 3 * math.pi * self.radius) * self.radius**2
		self.walls = [("ball", tuple(self.centre), self.radius)]

	def __str__(self):
		return f"the ball of radius {self.radius} m"


def flattened_disc(diameter, length, flat=math.radians(30)):
	"""A disc on its side for the Brazilian test, its axis along z, from y = 0 upwards, with flat ends across y so
	that it does not crush where it is touched (Wang, Jia, Kou, Zhang, Lindqvist 2004); a :class:`Polyhedron`.

	:param diameter, length: [m]
	:param flat: angle that each flat end takes [rad]
	:raises ValueError: a diameter or length that is not positive and finite, an angle that is not between 0 and π/2
	"""
	for name, value in (("diameter", diameter), ("length", length)):
		if not (value > 0 and math.isfinite(value)):
			raise ValueError(f"flattened_disc: {name} = {value} m must be positive and finite")
	if not 0 < flat < math.pi / 2:
		degrees = f"; degrees? Then math.radians({flat})" if math.pi / 2 <= flat < 90 else ""
		raise ValueError(f"flattened_disc: flat = {flat} rad must lie between 0 and π/2{degrees}")
	half = 0.5 * flat
	around = [(math.sin(a), math.cos(a)) for a in (2 * math.pi * k / 72 for k in range(72))]
	level = math.cos(half)
	corners = [(x, y) for x, y in around if abs(y) < level]
	corners += [(sx * math.sin(half), sy * level) for sx in (-1, 1) for sy in (-1, 1)]
	return Polyhedron(
		[
			(diameter / 2 * x, diameter / 2 * (y + level), z) for x, y in corners
			for z in (-length / 2, length / 2)
		]
	)


class Rectangle(Box):
	"""A rectangle along the axes, in the plane z = 0."""

	dimension = 2

	def __init__(self, lower, upper):
		"""
		:param lower, upper: corners (2,) [m]
		:raises ValueError: as for :class:`Box`
		"""
		self._set(_vector("lower", lower, 2), _vector("upper", upper, 2))

	def __str__(self):
		return f"the rectangle of {_lengths((self.upper - self.lower)[:2])} m"


class Disc(Ball):
	"""A disc in the plane z = 0."""

	dimension = 2

	def __init__(self, centre, radius):
		"""
		:param centre: (2,) [m]
		:param radius: [m]
		:raises ValueError: as for :class:`Ball`
		"""
		self._set(_vector("centre", centre, 2), radius)

	def _ends(self, axis):
		return 2 * (self.volume if axis == 2 else 0.0, )

	def __str__(self):
		return f"the disc of radius {self.radius} m"


class Polygon(_Polytope):
	"""A convex polygon in the plane z = 0."""

	dimension = 2
	_numbers = ("corners", )

	def __init__(self, corners):
		"""
		:param corners: (n, 2) [m], in any order
		:raises ValueError: fewer than three, on one line, not finite, or one inside of the others' hull
		"""
		super().__init__(*_hull(corners, 2))

	def __str__(self):
		return f"the polygon of {len(self.corners)} corners"


def from_record(record):
	"""The shape of which ``as_record`` has made this.

	:raises ValueError: another kind, or what its constructor refuses
	"""
	kinds = {kind.__name__: kind for kind in (Ball, Box, Cylinder, Disc, Polygon, Polyhedron, Rectangle)}
	if record.get("kind") not in kinds:
		raise ValueError(f"kind = '{record.get('kind')}' is no shape; use one of {', '.join(kinds)}")
	return kinds[record["kind"]](**{name: value for name, value in record.items() if name != "kind"})


def _hull(corners, d):
	"""Corners, outward normals, offsets, volume and inner radius of a convex hull."""
	from scipy.spatial import ConvexHull, QhullError
	points = np.array(corners, float)
	what = "polyhedron" if d == 3 else "polygon"
	if points.ndim != 2 or points.shape[1] != d or len(points) <= d or not np.isfinite(points).all():
		raise ValueError(
			f"a {what} needs at least {d + 1} corners of {d} finite coordinates [m]: got an array of shape "
			f"{points.shape}"
		)
	size = np.ptp(points, axis=0).max()
	middle = points.mean(axis=0)
	try:
		hull = ConvexHull((points - middle) / (size or 1))
	except QhullError:
		raise ValueError(
			f"the {len(points)} corners of the {what} lie in one {'plane' if d == 3 else 'line'}"
		) from None
	planes = _distinct(hull.equations, _SAME)  # Qhull repeats a plane for each triangle of it
	normals = np.zeros((len(planes), 3))
	normals[:, :d] = planes[:, :d]
	offsets = -planes[:, d] * size + planes[:, :d] @ middle
	depth = (offsets - points @ normals[:, :d].T).min(axis=1)
	if depth.max() > _SAME * size:
		bad = depth.argmax()
		raise ValueError(
			f"corner {bad} at {tuple(points[bad].tolist())} m lies {depth[bad]:.3g} m inside of the hull "
			f"of the others: the {what} must be convex; leave it out to fill the hull"
		)
	spatial = np.zeros((len(points), 3))
	spatial[:, :d] = points
	_, inner = _largest_ball(normals[:, :d], offsets)
	return spatial, normals, offsets, hull.volume * size**d, inner


def _largest_ball(normals, offsets):
	"""Centre and radius of the largest ball inside of half-spaces: a linear programme."""
	from scipy.optimize import linprog
	d = normals.shape[1]
	scale = abs(offsets).max() or 1.0
	found = linprog(
		[0] * d + [-1], A_ub=np.column_stack([normals, np.ones(len(normals))]), b_ub=offsets / scale,
		bounds=(None, None)
	)
	return found.x[:d] * scale, float(found.x[d] * scale)


def _distinct(rows, close):
	"""Rows without those that differ from an earlier one by less than *close*."""
	kept = []
	for row in rows:
		if not any(abs(row - other).max() <= close for other in kept):
			kept.append(row)
	return np.array(kept)


def _vector(name, values, d):
	vector = np.array(values, float)
	if vector.shape != (d, ) or not np.isfinite(vector).all():
		raise ValueError(f"{name} = {values} m must be {d} finite coordinates")
	return vector


def _radius(value):
	if not (value > 0 and math.isfinite(value)):
		raise ValueError(f"radius = {value} m must be positive and finite")
	return float(value)


def _lengths(size):
	return " x ".join(f"{length:.6g}" for length in size)
