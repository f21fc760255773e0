# GPL v2 or later, see LICENSE.
"""Values of all triangles of a block, whose sums do not depend on how the work was divided."""
import numpy as np

TILE = 256  #: triangles of a tile, as in the kernel (Tiles.hpp)


class Field(np.lib.mixins.NDArrayOperatorsMixin):
	"""Values (m, …) of the triangles of a block as they were when read; numpy takes it as an array.

	Whatever is done with it is done by numpy, except :meth:`sum`, :meth:`mean`, :meth:`min` and :meth:`max` over
	the triangles: these go through the fixed tree of tiles in which the engine sums its energies, so they have the
	same bits for any number of threads and, later, of domains. It cannot be written to.
	"""

	def __init__(self, values, places):
		"""
		:param values: a row per triangle.
		:param places: of the triangles in the engine's tiles (m,).
		"""
		self._values = np.asarray(values).view()
		self._values.setflags(write=False)
		self._places = np.asarray(places)

	def sum(self, axis=None, **options):
		"""Sum over the triangles (axis 0 or None); other axes as numpy does it."""
		options = _said(options)
		if options or not self._over_triangles(axis):
			return self._values.sum(axis=axis, **options)
		total = tree_sum(self._values, self._places)
		return total.sum() if axis is None else total

	def mean(self, axis=None, **options):
		"""Mean over the triangles, each counted once whatever its area (axis 0 or None);
		other axes as numpy does it."""
		options = _said(options)
		if options or not self._over_triangles(axis):
			return self._values.mean(axis=axis, **options)
		count = self._values.size if axis is None else len(self._values)
		return self.sum(axis) / count

	def min(self, axis=None, **options):
		"""Smallest value, exact in any order."""
		return self._values.min(axis=axis, **_said(options))

	def max(self, axis=None, **options):
		"""Largest value, exact in any order."""
		return self._values.max(axis=axis, **_said(options))

	def _over_triangles(self, axis):
		return axis is None or axis == 0

	# --- as an array
	def __array__(self, dtype=None, copy=None):
		values = self._values if dtype is None else self._values.astype(dtype, copy=False)
		return values.copy() if copy else values

	def __array_ufunc__(self, function, method, *inputs, **options):
		if any(isinstance(x, Field) for x in options.get("out", ())):
			raise ValueError("output array is read-only: what was written here would reach no triangle")
		return getattr(function, method)(
			*(np.asarray(x) if isinstance(x, Field) else x for x in inputs), **options
		)

	def __getitem__(self, index):
		return self._values[index]

	def __setitem__(self, index, value):
		raise ValueError("assignment destination is read-only: what was written here would reach no triangle")

	def __iter__(self):
		return iter(self._values)

	def __len__(self):
		return len(self._values)

	def __getattr__(self, name):
		if name.startswith("__"):
			raise AttributeError(name)
		return getattr(self._values, name)

	def __repr__(self):
		return f"Field({self._values!r})"

	def __format__(self, spec):
		return format(self._values, spec)

	def __bool__(self):
		return bool(self._values)

	def __float__(self):
		return float(self._values)

	def __reduce__(self):
		return Field, (np.array(self._values), self._places)


def _said(options):
	"""Numpy's functions hand over options that nobody has set as None."""
	return {name: value for name, value in options.items() if value is not None}


def tree_sum(values, places):
	"""Sum over axis 0 in the tree over tiles.

	:param values: a row per triangle.
	:param places: of the rows in the tiles; places where there is no row count as zero.
	"""
	values = np.asarray(values)
	tiles = int(places.max()) // TILE + 1 if len(places) else 1
	room = np.zeros((tiles * TILE,) + values.shape[1:], dtype=np.result_type(values, float))
	room[places] = values
	room = room.reshape((tiles, TILE) + values.shape[1:])
	while room.shape[1] > 1:  # within a tile: halves upon each other
		half = room.shape[1] // 2
		room = room[:, :half] + room[:, half:]
	room = room[:, 0]
	while len(room) > 1:  # tiles: neighbours in pairs, one left over goes up as it is (TileSums.hpp)
		pairs = room[0:len(room) // 2 * 2:2] + room[1::2]
		room = np.concatenate([pairs, room[len(room) // 2 * 2:]])
	return room[0]
