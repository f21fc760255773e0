# GPL v2 or later, see LICENSE.
"""ParaView files of a running scene: a .vtu file an instant, and a .pvd file that lists them with their times.

A recorder is called whenever a file is wanted, for instance by a PyRunner::

	record = ddem.vtk.Recorder(block, "out/block")
	O.engines += [PyRunner(command="record()", virtPeriod=1e-5)]

Deformable triangles give one series of files; bonded spheres give three: spheres, bonds and broken bonds.
Open the .pvd file in ParaView.
"""
import glob
import os
import re
import sys
import warnings
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from xml.sax.saxutils import quoteattr

import numpy as np

from . import provenance

VTK_VERTEX, VTK_LINE, VTK_TRIANGLE = 1, 3, 5  #: VTK's numbers of these kinds of cells
_KINDS = (("f", float, "Float64"), ("ib", np.int64, "Int64"), ("u", np.uint8, "UInt8"))  # of numpy, in VTK's files
#: order of the components of a symmetric tensor in VTK
TENSOR = ("XX", "YY", "ZZ", "XY", "YZ", "XZ")


class Recorder:
	"""Writes the state of a sample each time it is called.

	:param sample: a Block of deformable triangles (:func:`yade.ddem.append`) or a sample of bonded spheres
		(:func:`yade.ddem.bonded.append`)
	:param name: path and beginning of the files' names: "out/block" gives out/block.pvd and out/block-0000.vtu,
		out/block-0001.vtu … Missing folders are made. Files of an earlier recording of that name are removed
		where the scene is at its start. In a scene that has run, as one that was loaded, in the same process or
		another, the recording goes on: its files up to the present time stay; later ones, of a run that was
		given up, are removed with a warning.
	:param sub_elements: of triangles: three cells a triangle, each with its own stress and damage,
		instead of one with their mean
	:raises FileExistsError: files of such names that no recorder has written; nothing is removed then

	The names of arrays say their units. "state" of bonds and "mode" of broken ones are 0: holds, 1: broken in
	tension, 2: broken in shear.

	============  ==================================================================================================
	triangles     stress [Pa], strain, plastic strain (symmetric tensors), damage, whatever else their law
	              remembers, rotation [rad], region, id; nodes: displacement [m], velocity [m/s]
	spheres       radius [m], displacement [m], velocity [m/s], rotation [rad] (vector), damage (broken share of its
	              bonds), id
	bonds         state (0 holds, 1 tension, 2 shear), radius [m], axial force [N] (tension positive) and shear
	              force [N], not a number where broken; normal stress [Pa], shear stress [Pa], those that broke it
	              where broken; time of breaking [s], not a number where it holds
	broken bonds  time [s], mode (1 tension, 2 shear), normal of the crack, radius [m], normal stress [Pa], shear
	              stress [Pa], energy lost [J]
	============  ==================================================================================================
	"""

	def __init__(self, sample, name, sub_elements=False):
		from .block import Block
		if isinstance(sample, Block):
			self._grids = lambda: {"": _triangles(sample, sub_elements)}
			suffixes = ("", )
		else:
			self._grids = lambda: _bonded(sample)
			suffixes = ("-spheres", "-bonds", "-broken")
		self._collections = {suffix: _Collection(name + suffix) for suffix in suffixes}
		for collection in self._collections.values():
			collection.begin()

	def __call__(self):
		"""Write the present state; where it is already, it is written again."""
		from yade import O
		origin = provenance.record()
		for suffix, grid in self._grids().items():
			self._collections[suffix].add(grid, O.time, origin)

	@property
	def files(self):
		"""The .pvd files."""
		return [collection.path for collection in self._collections.values()]


@dataclass(frozen=True)
class Grid:
	"""Points, cells of one kind, and arrays on both; made by :func:`grid`."""
	points: np.ndarray  # (n, 3)
	cells: np.ndarray  # rows of points (m, k)
	kind: int
	point_data: dict
	cell_data: dict


def grid(points, cells, kind, point_data=None, cell_data=None):
	"""A :class:`Grid` from arrays.

	:param points: (n, 2) or (n, 3)
	:param cells: (m, k) rows of points; (m,) for VTK_VERTEX
	:param kind: VTK_TRIANGLE, VTK_LINE or VTK_VERTEX
	:param point_data, cell_data: arrays by name, a row per point or cell; rows of two numbers become vectors in the
		plane, rows of six are symmetric tensors
	:raises ValueError: an array of another number of rows
	"""
	cells = np.asarray(cells)
	cells = cells[:, None] if cells.ndim == 1 else cells
	data = []
	for arrays, rows in ((point_data, len(points)), (cell_data, len(cells))):
		data.append({name: np.asarray(values) for name, values in (arrays or {}).items()})
		for name, values in data[-1].items():
			if len(values) != rows:
				raise ValueError(f"array '{name}' has {len(values)} rows where the grid has {rows}")
	return Grid(np.asarray(points, float), cells, kind, *data)


def write(data, path, time=None, origin=None):
	"""Write a :class:`Grid` to a .vtu file; *time* [s] is stored as VTK's TimeValue.

	Where it comes from (*origin*, or :func:`provenance.record`) is stored in its field data, as a text. The file
	is complete at any moment.

	VTK's own writer takes four times as long for such small grids, which is a tenth of the whole run. So the file
	is written here: XML, and the numbers as they are in memory, "appended" and "raw" in VTK's words. VTK and
	ParaView read that since 5.0, and tests have VTK read it back.
	"""
	blocks = _Blocks()
	corners = data.cells.shape[1]
	field = []
	if time is not None:
		field.append(blocks.array("TimeValue", np.array([float(time)]), "NumberOfTuples"))
	field.append(blocks.text(provenance.KEY, provenance.text(origin)))
	arrays = lambda named: "".join(blocks.array(name, values) for name, values in named.items())
	content = (
		f"<FieldData>\n{''.join(field)}</FieldData>\n"
		f'<Piece NumberOfPoints="{len(data.points)}" NumberOfCells="{len(data.cells)}">\n'
		f"<PointData>\n{arrays(data.point_data)}</PointData>\n<CellData>\n{arrays(data.cell_data)}</CellData>\n"
		f"<Points>\n{blocks.array('Points', data.points)}</Points>\n<Cells>\n"
		f"{blocks.array('connectivity', data.cells.ravel())}"
		f"{blocks.array('offsets', corners * np.arange(1, len(data.cells) + 1))}"
		f"{blocks.array('types', np.full(len(data.cells), data.kind, np.uint8))}</Cells>\n</Piece>\n"
	)
	start = (
		'<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0" '
		f'byte_order="{sys.byteorder.capitalize()}Endian" header_type="UInt64">\n<UnstructuredGrid>\n{content}'
		'</UnstructuredGrid>\n<AppendedData encoding="raw">\n_'
	)
	_replace(path, b"".join([start.encode(), *blocks.data, b"\n</AppendedData>\n</VTKFile>\n"]))


class _Blocks:
	"""The numbers of a file one after another, each array with its size in bytes before it."""

	def __init__(self):
		self.data, self._size = [], 0

	def array(self, name, values, count=None):
		"""Adds an array, and returns the element that tells of it."""
		values = _in_space(values)
		kind, element = next(pair for kinds, *pair in _KINDS if values.dtype.kind in kinds)
		many = values.shape[1] if values.ndim == 2 else 1
		names = (
			"".join(f' ComponentName{i}="{part}"' for i, part in enumerate(TENSOR))
			if many == len(TENSOR)
			else ""
		)
		shape = f'{count or "NumberOfComponents"}="{len(values) if count else many}"'
		place = self._add(np.ascontiguousarray(values, kind))
		return f'<DataArray type="{element}" Name={quoteattr(name)} {shape}{names} {place}/>\n'

	def text(self, name, text):
		"""The same of a text."""
		place = self._add(np.frombuffer(text.encode() + b"\0", np.uint8))
		return f'<Array type="String" Name={quoteattr(name)} NumberOfTuples="1" {place}/>\n'

	def _add(self, values):
		place = f'format="appended" offset="{self._size}"'
		self.data += [values.nbytes.to_bytes(8, sys.byteorder), values]
		self._size += 8 + values.nbytes
		return place


def _replace(path, content):
	"""Write a file that is complete at any moment."""
	with open(path + ".new", "wb") as file:
		file.write(content)
	os.replace(path + ".new", path)


def field_text(path, name):
	"""A text in the field data of a .vtu file; None when it holds none of that name."""
	found = _field(path, name)
	return found.GetValue(0) if found and found.GetClassName() == "vtkStringArray" else None


class _Collection:
	"""A .pvd file and the .vtu files beside it."""

	def __init__(self, name):
		"""Looks at what there is of that name, and changes nothing yet."""
		from yade import O
		self.name, self.path = name, name + ".pvd"
		files = [path for path in glob.glob(glob.escape(name) + "-*.vtu") if self._number(path) is not None]
		listed = self._listed()
		for path in files:
			if not _is_ours(path):
				raise FileExistsError(
					f"{path} is in the way and no recorder has written it: move it, or give the "
					"recorder another name"
				)
		self._earlier = {os.path.basename(path): path for path in files}
		self._entries = []  # (time as text, file) in order of time
		if O.iter == 0:
			return
		for file, path in self._earlier.items():  # one that is not listed was the last before the process ended
			self._entries.append((listed[file] if file in listed else repr(_time_of(path)), file))
		self._entries.sort(key=lambda entry: float(entry[0]))

	def _number(self, path):
		found = re.fullmatch(re.escape(os.path.basename(self.name)) + r"-(\d+)\.vtu", os.path.basename(path))
		return int(found[1]) if found else None

	def _listed(self):
		"""Time, as text, of each file that the list of an earlier recording names."""
		if not os.path.exists(self.path):
			return {}
		with open(self.path, encoding="utf-8", errors="replace") as file:
			text = file.read()
		try:
			entries = list(ET.fromstring(text.encode()).iter("DataSet"))
		except ET.ParseError:
			entries = None
		if entries is None or provenance.KEY not in text:
			raise FileExistsError(
				f"{self.path} is in the way and is no list that a recorder has written: move it, or "
				"give the recorder another name"
			)
		return {entry.get("file"): entry.get("timestep") for entry in entries}

	def begin(self):
		"""Removes what an earlier recording has left and this one does not go on from."""
		from yade import O
		os.makedirs(os.path.dirname(os.path.abspath(self.name)), exist_ok=True)
		if O.iter == 0:
			for path in self._earlier.values():
				os.remove(path)
			if os.path.exists(self.path):
				os.remove(self.path)
		else:
			self._give_up(O.time * (1 + 1e-12))

	def _give_up(self, time):
		"""Forget entries after a time [s], which belong to a run that was given up, and their files."""
		later = [entry for entry in self._entries if float(entry[0]) > time]
		if not later:
			return
		warnings.warn(
			f"{self.path}: the recording goes on at {time:.6g} s; later files, {len(later)} of "
			"them, are removed",
			stacklevel=4,
		)
		self._remove(later)

	def _remove(self, entries):
		self._entries = [entry for entry in self._entries if entry not in entries]
		for _, file in entries:
			os.remove(os.path.join(os.path.dirname(self.path), file))

	def add(self, data, time, origin):
		"""Write a file, and the list with it."""
		last = float(self._entries[-1][0]) if self._entries else -1.0
		if last >= time * (1 - 1e-12):  # the scene was loaded meanwhile, or has not moved on
			self._give_up(time * (1 + 1e-12))
			self._remove([entry for entry in self._entries if float(entry[0]) >= time * (1 - 1e-12)])
		number = self._number(self._entries[-1][1]) + 1 if self._entries else 0
		path = f"{self.name}-{number:04d}.vtu"
		write(data, path, time, origin)
		self._entries.append((repr(float(time)), os.path.basename(path)))
		lines = [
			'<?xml version="1.0" encoding="utf-8"?>', '<VTKFile type="Collection" version="0.1">',
			f"  <!--{provenance.comment(origin)}-->", "  <Collection>", *(
				f'    <DataSet timestep="{instant}" part="0" file={quoteattr(file)} />'
				for instant, file in self._entries
			), "  </Collection>", "</VTKFile>", ""
		]
		_replace(self.path, "\n".join(lines).encode())  # so that ParaView can follow a run


def _is_ours(path):
	"""Whether a .vtu file says where it comes from, as all do that this module writes: in its header."""
	with open(path, "rb") as file:
		return f'Name="{provenance.KEY}"'.encode() in file.read(1 << 16)


def _time_of(path):
	"""VTK's TimeValue in a .vtu file [s]."""
	return _field(path, "TimeValue").GetValue(0)


def _field(path, name):
	"""The array of that name in the field data of a .vtu file, or None."""
	from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader  # which takes a moment to load
	reader = vtkXMLUnstructuredGridReader()
	reader.SetFileName(path)
	reader.Update()
	return reader.GetOutput().GetFieldData().GetAbstractArray(name)


def _triangles(block, sub_elements):
	nodes, triangles = block.positions, block.mesh.triangles
	corners, cells = nodes, triangles
	points = {"displacement [m]": block.displacements, "velocity [m/s]": block.velocities}
	# what every law has, and whatever else the laws of this block remember
	tensors = {"stress [Pa]": block.stress, "strain": block.strain, "plastic strain": block.plastic_strain}
	scalars = {"damage": block.sub_element_damage}
	for field, unit, components in block.fields:
		name = title(field, unit)
		if name not in tensors:
			(scalars if components == 1 else tensors)[name] = block.field(field)
	single = {"rotation [rad]": block.rotation, "region": block.mesh.regions, "id": block.triangle_ids}
	if sub_elements:
		centres = len(nodes) + np.arange(len(triangles))
		cores = block.core_positions
		corners = np.vstack([nodes, cores])
		points = {
			"displacement [m]": np.vstack(
				[block.displacements, cores - block.reference_positions[triangles].mean(axis=1)]
			),
			"velocity [m/s]": np.vstack([block.velocities, block.core_velocities]),
		}
		cells = np.stack(
			[np.repeat(centres, 3), triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()], axis=1
		)
		values = {name: array.reshape(len(cells), -1) for name, array in (tensors | scalars).items()}
		single = {name: np.repeat(array, 3) for name, array in single.items()}
	else:
		values = {name: array.mean(axis=1) for name, array in (tensors | scalars).items()}
	for name in tensors:
		values[name] = np.pad(values[name], ((0, 0), (0, 2)))
	for name in scalars:
		values[name] = values[name].ravel()
	return grid(corners, cells, VTK_TRIANGLE, points, {**values, **single})


def title(field, unit):
	"""Name of the array that a law's field has in files: in words, with its unit,
	as "damage dissipation [J/m3]"."""
	words = re.sub("[A-Z]", lambda letter: " " + letter[0].lower(), field)
	unit = unit.replace("²", "2").replace("³", "3")  # ParaView's lists and formulas are happier without
	return words if unit == "-" else f"{words} [{unit}]"


def _bonded(sample):
	"""Spheres, bonds and broken bonds at one instant."""
	from .bonded import HOLDS, broken_share
	positions, bonds, broken = sample.positions, sample.bond_records, sample.broken
	spheres = {
		"radius [m]": sample.radii, "displacement [m]": sample.displacements,
		"velocity [m/s]": sample.velocities, "rotation [rad]": sample.rotations,
		"damage (broken share of its bonds)": broken_share(bonds, bonds["mode"] != HOLDS, sample.ids),
		"id": sample.ids
	}
	rows = sample.rows(np.column_stack([bonds["id1"], bonds["id2"]]))
	there = (rows >= 0).all(axis=1)  # not of a sphere that was erased
	there = slice(None) if there.all() else there  # which copies nothing
	held = {
		name: bonds[column][there] for name, column in (
			("state (0 holds, 1 tension, 2 shear)", "mode"), ("radius [m]", "radius"),
			("axial force [N]", "axial_force"), ("shear force [N]", "shear_force"),
			("normal stress [Pa]", "normal_stress"), ("shear stress [Pa]", "shear_stress"),
			("time of breaking [s]", "time")
		)
	}
	lost = {
		name: broken[column] for name, column in (
			("time [s]", "time"), ("normal", "normal"), ("radius [m]", "radius"),
			("normal stress [Pa]", "normal_stress"), ("shear stress [Pa]", "shear_stress"),
			("energy lost [J]", "energy")
		)
	}
	lost["mode (1 tension, 2 shear)"] = bonds["mode"][bonds["mode"] != HOLDS]  # in the order of the others
	return {
		"-spheres": grid(positions, np.arange(len(positions)), VTK_VERTEX, spheres),
		"-bonds": grid(*_lines(positions, rows[there]), VTK_LINE, None, held),
		"-broken": grid(broken["position"], np.arange(len(broken)), VTK_VERTEX, lost),
	}


def _lines(positions, rows):
	"""Points, and rows of the two ends of each bond. One that crosses the border of a periodic cell goes from its
	first sphere to the nearest image of the second, a point of its own."""
	from . import cells
	branch = positions[rows[:, 1]] - positions[rows[:, 0]]
	nearest = cells.nearest(branch)
	across = np.flatnonzero((nearest != branch).any(axis=1))
	if len(across) == 0:
		return positions, rows
	images = positions[rows[across, 0]] + nearest[across]
	rows = rows.copy()
	rows[across, 1] = len(positions) + np.arange(len(across))
	return np.vstack([positions, images]), rows


def _in_space(values):
	return np.pad(values, ((0, 0), (0, 1))) if values.ndim == 2 and values.shape[1] == 2 else values
