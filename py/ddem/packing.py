# GPL v2 or later, see LICENSE.
"""Packings of spheres: random fillings of convex specimens with a range of radii, neighbours, CSV files::

	packing = ddem.packing.fill(ddem.packing.Cylinder((0, 0, 0), (0, 0.1, 0), 0.025), rmin=1e-3, rmax=3e-3)

:func:`fill` takes any of :mod:`shapes` and a tenth of a millisecond a sphere. :func:`prism` and :func:`layer` are
boxes of GenGeo's packer, unless told otherwise; the same algorithm, some fifty times slower. Results that are
documented with a seed are of GenGeo's packings.
"""
import contextlib
import copy
import ctypes
import hashlib
import itertools
import json
import math
import numbers
import os
import re
import sys

import numpy as np

from . import _packing, provenance
from .shapes import Ball, Box, Cylinder, Disc, Polygon, Polyhedron, Rectangle, flattened_disc  # noqa: F401

UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6}  #: length units of files, in metres
GENERATORS = ("gengeo", "fill")  #: what packs a prism or a layer

#: gap up to which spheres are bonded, of the largest radius: the tutorial's 0.005 mm for 2 mm
BOND_GAP = 0.0025
# overlap and distance to the walls that the packer allows, of the largest radius; the tutorial's 1e-5 mm for 2 mm
_TOLERANCE = 5e-6
_FLAT = 1e-9  # a packing thinner than this share of a radius is a layer


class Packing:
	"""Spheres in a box or another shape, and pairs of them that are to be bonded. Plain numpy arrays;
	needs no YADE."""

	def __init__(self, centres, radii, lower=None, upper=None, bonds=None, shape=None, cell=None):
		"""
		:param centres: (n, 3) [m]
		:param radii: (n,) [m]
		:param lower, upper: corners of the box [m]; None: that of the spheres
		:param bonds: (m, 2) pairs of rows, or None when nothing is said about bonds
		:param shape: one of :mod:`shapes` that the spheres fill; None: their box
		:param cell: sizes (3,) of the periodic cell that the spheres fill, or (3, 3) its sides, one a column,
			as O.cell.hSize [m]; None: nothing is periodic
		:raises ValueError: shapes that do not fit, numbers that are not finite, radii that are not positive,
			bonds to unknown spheres, a cell without volume
		"""
		self.centres = np.array(centres, float).reshape(-1, 3)
		self.radii = np.array(radii, float).reshape(-1)
		if len(self.centres) != len(self.radii) or len(self.radii) == 0:
			raise ValueError(
				f"a packing needs a radius for each centre: got {len(self.centres)} centres and "
				f"{len(self.radii)} radii"
			)
		for row in np.flatnonzero(~np.isfinite(self.centres).all(axis=1)):
			raise ValueError(f"sphere {row}: centre {tuple(self.centres[row].tolist())} m is not finite")
		for row in np.flatnonzero(~((self.radii > 0) & np.isfinite(self.radii))):
			raise ValueError(f"sphere {row}: radius = {self.radii[row]} m must be positive and finite")
		#: sides of the periodic cell (3, 3), one a column [m]; None: nothing is periodic
		self.cell = None if cell is None else _checked_cell(cell)
		if cell is not None and lower is None and upper is None:
			lower, upper = np.minimum(self.cell, 0).sum(axis=1), np.maximum(self.cell, 0).sum(axis=1)
		around = self.radii[:, None]
		#: corner of the box [m]
		self.lower = np.array((self.centres - around).min(axis=0) if lower is None else lower, float)
		#: corner of the box [m]
		self.upper = np.array((self.centres + around).max(axis=0) if upper is None else upper, float)
		self.bonds = None if bonds is None else _checked_bonds(bonds, len(self.radii))
		#: one of :mod:`shapes` that the spheres fill; None: their box
		self.shape = shape

	def __len__(self):
		return len(self.radii)

	@property
	def size(self):
		"""Width, height and depth of the box (3,) [m]."""
		return self.upper - self.lower

	@property
	def flat(self):
		"""Whether all centres lie in one plane z = const, so that the spheres are to
		move in that plane only."""
		return bool(np.ptp(self.centres[:, 2]) <= _FLAT * self.radii.max())

	@property
	def volume(self):
		"""Volume of the periodic cell, of the shape, or of the box where there is none [m³]; a layer is as deep
		as its box."""
		if self.cell is not None:
			return float(abs(np.linalg.det(self.cell)))
		if self.shape is None:
			return float(self.size.prod())
		return self.shape.volume * (float(self.size[2]) if self.shape.dimension == 2 else 1)

	@property
	def solid_fraction(self):
		"""Volume of the spheres over :attr:`volume` [-]."""
		return float((4 / 3 * math.pi * self.radii**3).sum() / self.volume)

	def area(self, axis=1):
		"""Area of the flat face across *axis* (0, 1 or 2) [m²], which platens load; the smaller one where two
		differ. A layer is as deep as its box.

		:raises ValueError: a shape without a flat face there, as a ball; *axis* is another number
		"""
		if axis not in (0, 1, 2):
			raise ValueError(f"axis = {axis} must be 0, 1 or 2, for x, y or z")
		if self.shape is None:
			return float(np.delete(self.size, axis).prod())
		return self.shape.face(axis) * (float(self.size[2]) if self.shape.dimension == 2 and axis < 2 else 1)

	def neighbours(self, gap):
		"""Pairs of spheres whose surfaces are closer than *gap* [m] or overlap:
		(m, 2) rows, each pair and the list in ascending order; across the border of a periodic cell, too."""
		if not gap >= 0:
			raise ValueError(f"gap = {gap} m must not be negative")
		if self.cell is None:
			return self._neighbours(gap)
		centres, rows = _with_images(self.centres, self.cell, 2 * float(self.radii.max()) + gap)
		count, pairs = len(self), Packing(centres, self.radii[rows])._neighbours(gap)
		pairs = np.sort(rows[pairs[pairs[:, 0] < count]], axis=1)
		return np.unique(pairs[pairs[:, 0] != pairs[:, 1]], axis=0)

	def _neighbours(self, gap):
		from scipy.spatial import cKDTree
		# Radii span a decade: searching by classes of radius keeps the candidates few.
		classes = np.floor(np.log2(self.radii / self.radii.min())).astype(int)
		members = [np.flatnonzero(classes == c) for c in range(classes.max() + 1)]
		trees = [cKDTree(self.centres[rows]) if len(rows) else None for rows in members]
		found = []
		for a, first in enumerate(members):
			for b, second in enumerate(members[:a + 1]):
				if len(first) == 0 or len(second) == 0:
					continue
				reach = (self.radii[first].max() + self.radii[second].max() + gap) * (1 + 1e-12)
				close = trees[a].sparse_distance_matrix(trees[b], reach, output_type="ndarray")
				i, j = first[close["i"]], second[close["j"]]
				keep = (close["v"] < self.radii[i] + self.radii[j] + gap) & (
					(i < j) if a == b else True
				)
				found.append(np.sort(np.column_stack([i[keep], j[keep]]), axis=1))
		pairs = np.concatenate(found)
		return pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))]

	def pieces(self, pairs):
		"""Number of the piece to which each sphere belongs (n,), 0 for the largest, where *pairs* (m, 2) hold
		spheres together."""
		from scipy.sparse import coo_array
		from scipy.sparse.csgraph import connected_components
		pairs = np.asarray(pairs, int).reshape(-1, 2)
		graph = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(self), len(self)))
		count, piece = connected_components(graph, directed=False)
		order = np.argsort(-np.bincount(piece, minlength=count), kind="stable")
		return np.argsort(order)[piece]

	def write(self, particles, bonds=None, length_unit="m"):
		"""Write ``id,x,y,z,r`` to *particles* and, where given, ``i,j`` to *bonds*, lengths in *length_unit*;
		all digits are kept."""
		unit = _unit(length_unit)
		with provenance.csv_writer(particles) as writer:
			writer.writerow(["id", "x", "y", "z", "r"])
			for row, (centre, radius) in enumerate(zip(self.centres, self.radii)):
				writer.writerow([row] + [repr(float(v / unit)) for v in (*centre, radius)])
		if bonds is None:
			return
		if self.bonds is None:
			raise ValueError(
				"this packing has no list of bonds to write; "
				"set packing.bonds = packing.neighbours(gap)"
			)
		with provenance.csv_writer(bonds) as writer:
			writer.writerow(["i", "j"])
			writer.writerows(self.bonds.tolist())


def of(spheres, lower=None, upper=None):
	"""A :class:`Packing` of anything that lists centres and radii: YADE's ``pack.SpherePack`` (makeCloud,
	fromSimulation, load), the list of bodies that ``pack.randomDensePack`` and ``pack.regularHexa`` return, or
	another packing.

	:param lower, upper: corners of the box [m]; None: that of the spheres
	:returns: with the cell of a SpherePack that is periodic
	:raises ValueError: it lists something else, or nothing
	"""
	if isinstance(spheres, Packing):
		return spheres
	try:
		pairs = [(one.state.pos, one.shape.radius) if hasattr(one, "shape") else one[:2] for one in spheres]
		centres, radii = [tuple(centre) for centre, _ in pairs], [float(radius) for _, radius in pairs]
	except (TypeError, ValueError, AttributeError, IndexError):
		raise ValueError(
			f"{type(spheres).__name__} is no packing: give a Packing, a SpherePack, or a list of spheres "
			"or of (centre, radius)"
		) from None
	cell = tuple(getattr(spheres, "cellSize", ())) if getattr(spheres, "isPeriodic", False) else ()
	cell = cell if any(cell) else None  # a SpherePack may say periodic and have no cell
	return Packing(centres, radii, lower, upper, cell=cell)


def fill(shape, rmin, rmax, seed=1, fails=5000):
	"""Random packing of touching spheres in a convex shape; in one of the plane, one layer of them.

	The insertion of Place and Mora (2001), as in :func:`prism`, with the touching spheres in closed form:
	seed spheres at random, with radii from *rmin* to its mean with *rmax*, then spheres within the range that touch
	four others or walls (three in a layer), until *fails* random points in a row gave none. 20 000 spheres take
	about two seconds.

	:param shape: :class:`Box`, :class:`Cylinder`, :class:`Ball`, :class:`Polyhedron`; in the plane
		:class:`Rectangle`, :class:`Disc`, :class:`Polygon`
	:param rmin, rmax: range of radii [m]
	:param seed: same seed, same packing, to the last bit on any machine (for the hull of a polyhedron or polygon:
		with the same version of Qhull)
	:param fails: more give a denser packing, and take longer
	:returns: :class:`Packing` with that shape; no overlap and no gap where spheres touch is above 1e-10 *rmax*
	:raises ValueError: another shape, radii that are not positive, a range of radii that is empty or does not fit,
		a seed or fails that is no whole number from 0 or 1 upwards
	"""
	_check_order(shape, rmin, rmax, seed, fails)
	provenance.note_seed(seed)
	spheres = _fill(shape, rmin, rmax, seed, fails)
	depth = np.array([0, 0, rmax if shape.dimension == 2 else 0])
	return Packing(spheres[:, :3], spheres[:, 3], shape.lower - depth, shape.upper + depth, shape=shape)


def prism(width, height, depth, rmin, rmax, seed=1, fails=5000, keep=None, generator="gengeo"):
	"""Random packing of touching spheres in a prism, x from 0 to *width*, y (the axis of loading) from 0 to
	*height*, z from -*depth*/2 to *depth*/2.

	GenGeo's insertion packer, which ESyS-Particle's tutorial uses (Place and Mora 2001): seed spheres at random,
	then spheres that touch four neighbours or walls, until *fails* insertions in a row failed.

	:param rmin, rmax: range of radii [m]
	:param seed: same seed, same packing (on the same C library)
	:param fails: more give a denser packing, and take longer
	:param keep: folder, made when missing, from which a packing with the same parameters is taken where it was made
		before, and where it is kept otherwise
	:param generator: "gengeo", or "fill" for :func:`fill`: the same algorithm, much faster, with other packings,
		which touch more of the walls: a prism of them is 4 % stiffer
	:returns: :class:`Packing`
	:raises ValueError: sizes that are not positive, a range of radii that is empty or does not fit, an unknown
		generator
	:raises ImportError: GenGeo is missing
	"""
	_check_sizes({"width": width, "height": height, "depth": depth, "rmin": rmin, "rmax": rmax}, rmin, rmax)
	if 2 * rmax > min(width, height, depth):
		raise ValueError(
			f"rmax = {rmax} m: a sphere of {2 * rmax} m does not fit into {width} x {height} x {depth} m; "
			"choose a smaller radius, or layer()"
		)
	shape = Box((0, 0, -depth / 2), (width, height, depth / 2))
	_check_generator(generator, shape, rmin, rmax, seed, fails)
	provenance.note_seed(seed)
	path = _kept(keep, (width, height, depth), rmin, rmax, seed, fails, generator)
	if path and os.path.exists(path):
		kept = _read(path)
		return Packing(kept.centres, kept.radii, shape.lower, shape.upper, shape=shape)
	if generator == "fill":
		spheres = _fill(shape, rmin, rmax, seed, fails)
	else:
		spheres = _pack((width, height, depth), rmin, rmax, seed, fails)
		spheres[:, 2] -= depth / 2
	packing = Packing(spheres[:, :3], spheres[:, 3], shape.lower, shape.upper, shape=shape)
	if path:
		os.makedirs(keep, exist_ok=True)
		packing.write(f"{path}.{os.getpid()}")
		os.replace(f"{path}.{os.getpid()}", path)  # whole at any moment, for others who look for it
	return packing


def layer(width, height, rmin, rmax, seed=1, fails=5000, generator="gengeo"):
	"""One layer of touching spheres in the plane z = 0, x from 0 to *width*, y from 0 to *height*;
	its box is 2 *rmax* deep.

	A two-dimensional specimen to set beside deformable triangles: :func:`bonded.append` blocks motion out of its
	plane. Parameters and errors as for :func:`prism`.
	"""
	_check_sizes({"width": width, "height": height, "rmin": rmin, "rmax": rmax}, rmin, rmax)
	if 2 * rmax > min(width, height):
		raise ValueError(
			f"rmax = {rmax} m: a sphere of {2 * rmax} m does not fit into {width} x {height} m; choose "
			"a smaller radius"
		)
	shape = Rectangle((0, 0), (width, height))
	_check_generator(generator, shape, rmin, rmax, seed, fails)
	if generator == "fill":
		return fill(shape, rmin, rmax, seed, fails)
	provenance.note_seed(seed)
	spheres = _pack((width, height), rmin, rmax, seed, fails)
	spheres[:, 2] = 0
	return Packing(spheres[:, :3], spheres[:, 3], (0, 0, -rmax), (width, height, rmax), shape=shape)


def read(particles, bonds=None, length_unit="m"):
	"""Packing from a CSV file with the columns id, x, y, z, r (in any order, others are ignored) and, where given,
	bonds from one with i, j, which are such ids; or from a text file with x y z r in each line, as YADE's
	``SpherePack.save``, ``export.text`` and ``export.textExt`` write it; ids are 0, 1, … where it has none.

	:param length_unit: of the file: "m", "cm", "mm" or "um"
	:raises ValueError: naming file, line and what is wrong there
	"""
	packing = _read(particles, bonds, length_unit)
	for path in filter(None, (particles, bonds)):
		provenance.note_file(path)
	return packing


def _read(particles, bonds=None, length_unit="m"):
	unit = _unit(length_unit)
	rows, ids = [], {}
	for place, record in _plain_records(particles) or _records(particles, ("id", "x", "y", "z", "r")):
		number = _number(place, "id", record["id"], int)
		if number in ids:
			raise ValueError(f"{place}: id {number} appears twice")
		ids[number] = len(rows)
		values = [_number(place, name, record[name], float) for name in "xyzr"]
		if values[3] <= 0:
			raise ValueError(f"{place}: radius r = {values[3]} {length_unit} must be positive")
		rows.append(values)
	if not rows:
		raise ValueError(f"{particles}: no spheres in it")
	pairs = None
	if bonds is not None:
		pairs = []
		for place, record in _records(bonds, ("i", "j")):
			pair = [_number(place, name, record[name], int) for name in "ij"]
			for number in pair:
				if number not in ids:
					raise ValueError(f"{place}: there is no sphere with id {number} in {particles}")
			if pair[0] == pair[1]:
				raise ValueError(f"{place}: sphere {pair[0]} is bonded to itself")
			pairs.append([ids[number] for number in pair])
		pairs = np.array(pairs, dtype=int).reshape(-1, 2)
	data = np.array(rows) * unit
	return Packing(data[:, :3], data[:, 3], bonds=pairs)


def notched(packing, depth, x=None, gap=None):
	"""The packing with a notch from below: no bond crosses the plane across *x* up to *depth* above the lower face.

	A cut without width: its faces still touch in compression, and slip.

	:param packing: :class:`Packing`, a beam along x
	:param depth: of the notch along y [m]
	:param x: where it is [m]; None: half way along the box
	:param gap: spheres closer than this are bonded elsewhere [m]. None: the packing's own list of bonds,
		or 0.0025 of the largest radius where it has none.
	:returns: :class:`Packing` with a list of bonds
	:raises ValueError: a depth that is not positive or not below the height, a plane beside the packing, one that
		no bond crosses, a periodic packing
	"""
	if packing.cell is not None:
		raise ValueError(
			"notched: a periodic packing has no lower face to cut from, its cell goes on below it; "
			"set packing.cell = None, or pack a box"
		)
	height, x = float(packing.size[1]), float(0.5 * (packing.lower + packing.upper)[0] if x is None else x)
	if not 0 < depth < height:
		raise ValueError(
			f"notched: depth = {depth} m must lie between 0 and the height of the packing, {height:.6g} m"
		)
	if not packing.lower[0] < x < packing.upper[0]:
		raise ValueError(
			f"notched: x = {x} m is not between the ends of the packing, {packing.lower[0]:.6g} and "
			f"{packing.upper[0]:.6g} m"
		)
	pairs = packing.bonds
	if pairs is None or gap is not None:
		pairs = packing.neighbours(BOND_GAP * packing.radii.max() if gap is None else gap)
	one, two = packing.centres[pairs].transpose(1, 0, 2)
	across = (one[:, 0] < x) != (two[:, 0] < x)
	share = (x - one[:, 0]) / np.where(across, two[:, 0] - one[:, 0], 1)
	cut = across & (one[:, 1] + share * (two[:, 1] - one[:, 1]) < packing.lower[1] + depth)
	if not cut.any():
		raise ValueError(
			f"notched: no bond crosses x = {x:.6g} m up to {depth} m above the lower face: nothing to cut"
		)
	whole, packing = packing, copy.copy(packing)
	packing.centres, packing.radii = whole.centres.copy(), whole.radii.copy()
	packing.bonds = pairs[~cut]
	return packing


def _kept(folder, size, rmin, rmax, seed, fails, generator):
	"""Where in a folder the packing with these parameters is kept."""
	if folder is None:
		return None
	asked = [size, (rmin, rmax), seed, fails] + ([] if generator == "gengeo" else [generator])
	key = hashlib.sha256(json.dumps(asked).encode()).hexdigest()[:12]
	return os.path.join(folder, f"packing-seed{seed}-{key}.csv")


def _check_sizes(sizes, rmin, rmax):
	for name, value in sizes.items():
		if not (value > 0 and math.isfinite(value)):
			raise ValueError(f"{name} = {value} m must be positive and finite")
	if rmin > rmax:
		raise ValueError(f"rmin = {rmin} m is above rmax = {rmax} m")


def _check_order(shape, rmin, rmax, seed, fails):
	if not isinstance(shape, (Ball, Box, Cylinder, Polygon, Polyhedron)):
		raise ValueError(
			f"{type(shape).__name__} is no shape to fill: give a Box, Cylinder, Ball or Polyhedron, or, "
			"for a layer, a Rectangle, Disc or Polygon"
		)
	_check_sizes({"rmin": rmin, "rmax": rmax}, rmin, rmax)
	if rmax > shape.inner * (1 + _FLAT):
		raise ValueError(
			f"rmax = {rmax} m: the largest sphere that fits into {shape} has a radius of "
			f"{shape.inner:.6g} m; choose a smaller one"
		)
	for name, value, least in (("seed", seed, 0), ("fails", fails, 1)):
		if isinstance(value, bool) or not isinstance(value, numbers.Integral) or not least <= value < 2**64:
			raise ValueError(f"{name} = {value} must be a whole number from {least} to 2^64 - 1")


def _check_generator(generator, *order):
	if generator not in GENERATORS:
		raise ValueError(f"generator = '{generator}' is unknown; use {' or '.join(map(repr, GENERATORS))}")
	if generator == "fill":
		_check_order(*order)


def _fill(shape, rmin, rmax, seed, fails):
	"""Rows x, y, z, r, neighbours close to each other."""
	spheres = _packing.fill(
		shape.dimension, shape.lower, shape.upper, shape.walls, float(rmin), float(rmax), int(seed), int(fails)
	)
	return spheres[_along_a_curve(spheres[:, :3], 2 * rmax)]


def _along_a_curve(centres, cell):
	"""Rows in the order of cells along a curve that fills space (Morton 1966). In the order of insertion neighbours
	lie anywhere in memory, and from some ten thousand spheres on a step waits for it:
	1.5 times as long with 95 000."""
	place = np.floor((centres - centres.min(axis=0)) / cell).astype(np.int64)
	key = np.zeros(len(centres), np.int64)
	for bit in range(21):
		for axis in range(3):
			key |= (place[:, axis] >> bit & 1) << (3 * bit + axis)
	return np.argsort(key, kind="stable")


def _checked_cell(cell):
	"""Sides (3, 3) of a cell given by sizes or sides."""
	sides = np.array(cell, float)
	sides = np.diag(sides) if sides.shape == (3, ) else sides
	if sides.shape != (3, 3) or not abs(np.linalg.det(sides)) > 0 or not np.isfinite(sides).all():
		raise ValueError(
			f"cell = {np.array(cell).tolist()} m: a periodic cell has three positive sizes, or three "
			"sides that span a volume"
		)
	return sides


def _with_images(centres, cell, reach):
	"""Centres, moved into the cell, and after them those images that are closer to it than *reach* [m]; and the row
	of each. The same ones for spheres that have left the cell on one side and come back on the other."""
	inverse = np.linalg.inv(cell)
	inside = centres @ inverse.T % 1
	margin = reach * np.linalg.norm(inverse, axis=1)  # a row of the inverse is one over the height
	places, rows = [inside], [np.arange(len(centres))]
	for shift in itertools.product((-1, 0, 1), repeat=3):
		image = inside + shift
		near = np.flatnonzero(((image > -margin) & (image < 1 + margin)).all(axis=1)) if any(shift) else []
		places.append(image[near])
		rows.append(np.asarray(near, int))
	return np.concatenate(places) @ cell.T, np.concatenate(rows)


def _checked_bonds(bonds, count):
	bonds = np.array(bonds, dtype=int).reshape(-1, 2)
	if len(bonds) == 0:
		return bonds
	if bonds.min() < 0 or bonds.max() >= count:
		bad = bonds[((bonds < 0) | (bonds >= count)).any(axis=1)][0]
		raise ValueError(f"bond {tuple(bad)} names a sphere that does not exist: there are {count}")
	if (bonds[:, 0] == bonds[:, 1]).any():
		raise ValueError(f"sphere {bonds[bonds[:, 0] == bonds[:, 1]][0, 0]} is bonded to itself")
	ordered = np.unique(np.sort(bonds, axis=1), axis=0)
	if len(ordered) != len(bonds):
		pairs, counts = np.unique(np.sort(bonds, axis=1), axis=0, return_counts=True)
		raise ValueError(f"bond {tuple(pairs[counts > 1][0])} is listed twice")
	return ordered


def _pack(size, rmin, rmax, seed, fails):
	"""Rows x, y, z, r of a packing in a box at the origin, in the order in which GenGeo lists them."""
	try:
		import gengeo
	except ImportError as error:
		raise ImportError(
			"sphere packings need GenGeo: install Debian's package python3-gengeo, or read a packing from "
			"a file with packing.read()"
		) from error
	scaled = [s / rmax for s in size]  # GenGeo's own constants suit radii of order one
	with _quiet():
		packer, box, table = (
			_packer_in_plane(gengeo, *scaled, rmin / rmax, fails)
			if len(size) == 2
			else _packer_in_space(gengeo, scaled, rmin / rmax, fails)
		)
		# GenGeo draws from the C library's rand(); its own seeding knows only "fixed" and "by the clock".
		ctypes.CDLL(None).srand(ctypes.c_uint(int(seed)))
		packer.generatePacking(volume=box, ntable=table, groupID=0, tag=0)
	spheres = [
		(s.Centre().X(), s.Centre().Y(), s.Centre().Z(), s.Radius()) for s in table.getSphereListFromGroup(0)
	]
	return np.array(spheres).reshape(-1, 4) * rmax


def _packer_in_plane(gengeo, width, height, rmin, fails):
	corners = [gengeo.Vector3(*xy, 0) for xy in ((0, 0), (width, 0), (width, height), (0, height))]
	box, table = gengeo.BoxWithLines2D(corners[0], corners[2]), gengeo.MNTable2D(corners[0], corners[2], 2.2, 1)
	for here, there in zip(corners, corners[1:] + corners[:1]):
		box.addLine(gengeo.Line2D(there, here))
	return gengeo.InsertGenerator2D(rmin, 1.0, fails, 1000, _TOLERANCE), box, table


def _packer_in_space(gengeo, size, rmin, fails):
	lower, upper = gengeo.Vector3(0, 0, 0), gengeo.Vector3(*size)
	box, table = gengeo.BoxWithPlanes3D(lower, upper), gengeo.MNTable3D(lower, upper, 2.2, 1)
	for normal in np.eye(3).tolist():
		box.addPlane(gengeo.Plane(lower, gengeo.Vector3(*normal)))
		box.addPlane(gengeo.Plane(upper, gengeo.Vector3(*(-n for n in normal))))
	packer = gengeo.InsertGenerator3D(rmin, 1.0, fails, 1000, _TOLERANCE)
	packer.setOldSeeding(False)  # has no default of its own
	return packer, box, table


@contextlib.contextmanager
def _quiet():
	"""GenGeo reports its progress on the standard output of C++."""
	libc = ctypes.CDLL(None)
	sys.stdout.flush()
	libc.fflush(None)
	kept = os.dup(1)
	try:
		with open(os.devnull, "w") as nowhere:
			os.dup2(nowhere.fileno(), 1)
			yield
	finally:
		libc.fflush(None)
		os.dup2(kept, 1)
		os.close(kept)


def _unit(name):
	if name not in UNITS:
		raise ValueError(f"length_unit = '{name}' is unknown; use one of {', '.join(UNITS)}")
	return UNITS[name]


def _records(path, columns):
	"""Place ("file, line n") and values by column of every line of a CSV file."""
	with open(path, newline="") as file:
		lines = provenance.csv_rows(file)
		header = [name.strip() for name in next(lines, (1, []))[1]]
		missing = [name for name in columns if name not in header]
		if missing:
			raise ValueError(
				f"{path}, line 1: column {missing[0]} is missing; the header must name "
				f"{', '.join(columns)}"
			)
		for number, fields in lines:
			place = f"{path}, line {number}"
			if not fields:
				continue
			if len(fields) != len(header):
				raise ValueError(f"{place}: {len(fields)} fields where the header has {len(header)}")
			yield place, dict(zip(header, fields))


def _plain_records(path):
	"""The same of a file of lines "x y z r …", in the columns that YADE's line "#format id_x_y_z_r_…" names where
	there is one; None where it is none."""
	columns, lines = ["x", "y", "z", "r"], []
	with open(path, encoding="utf-8") as file:
		for number, line in enumerate(file, 1):
			if line.startswith("#format"):
				columns = line.partition(" ")[2].strip().split("_")
				if not {*"xyzr"} <= set(columns):
					raise ValueError(
						f"{path}, line {number}: the format must name x, y, z and r: "
						f"{line.strip()}"
					)
			elif line.strip() and not line.lstrip().startswith("#"):
				lines.append((number, line.split()))
	if not lines or not re.fullmatch(r"[-+.\d]\S*", lines[0][1][0]) or "," in "".join(lines[0][1]):
		return None
	needed = max(columns.index(name) for name in "xyzr") + 1
	short = [number for number, fields in lines if len(fields) < needed]
	if short:
		raise ValueError(
			f"{path}, line {short[0]}: a line of numbers must have {' '.join(columns[:needed])} at least"
		)
	return [
		(f"{path}, line {number}", {"id": str(row), **dict(zip(columns, fields))})
		for row, (number, fields) in enumerate(lines)
	]


def _number(place, name, text, kind):
	try:
		value = kind(text)
	except ValueError:
		raise ValueError(
			f"{place}: {name} = '{text.strip()}' is not {'a whole' if kind is int else 'a'} number"
		) from None
	if not math.isfinite(value):
		raise ValueError(f"{place}: {name} = {text.strip()} is not finite")
	return value
