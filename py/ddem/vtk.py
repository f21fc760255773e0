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
import xml.etree.ElementTree as ET

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import VTK_LINE, VTK_TRIANGLE, VTK_VERTEX, vtkCellArray, vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter

from . import provenance

#: order of the components of a symmetric tensor in VTK
TENSOR = ("XX", "YY", "ZZ", "XY", "YZ", "XZ")
#: values of the array "state" of a bond
HOLDS, TENSION, SHEAR = 0, 1, 2


class Recorder:
	"""Writes the state of a sample each time it is called.

	:param sample: a Block of deformable triangles (:func:`yade.ddem.append`) or a sample of bonded spheres
		(:func:`yade.ddem.bonded.append`)
	:param name: path and beginning of the files' names: "out/block" gives out/block.pvd and out/block-0000.vtu,
		out/block-0001.vtu … Missing folders are made. Files of an earlier recording of that name are removed
		where the scene is at its start. In a scene that has run, as one that was loaded, the recording goes on:
		its files up to the present time stay, later ones are removed.
	:param sub_elements: of triangles: three cells a triangle, each with its own stress and damage,
		instead of one with their mean

	=================  =============================================================================================
	triangles          stress [Pa], strain, plasticStrain (symmetric tensors), damage, rotation [rad], region, id;
	                   nodes: displacement [m], velocity [m/s]
	spheres            radius [m], displacement [m], velocity [m/s], rotation (vector) [rad], damage
	                   (share of its bonds that are broken), id
	bonds              state (0 holds, 1 broken in tension, 2 broken in shear), radius [m], axialForce (tension
	                   positive), shearForce [N] (NaN where broken), normalStress, shearStress [Pa]
	                   (those of the moment of failure where broken)
	broken bonds       time [s], mode (as state), normal of the crack, radius [m], normalStress,
	                   shearStress [Pa], energy lost [J]
	=================  =============================================================================================
	"""

	def __init__(self, sample, name, sub_elements=False):
		self._parts = _parts(sample, sub_elements)
		self._collections = {suffix: _Collection(name + suffix) for suffix in self._parts}

	def __call__(self):
		"""Write the present state."""
		from yade import O
		for suffix, grid in self._parts.items():
			self._collections[suffix].add(grid(), O.time)

	@property
	def files(self):
		"""The .pvd files."""
		return [collection.path for collection in self._collections.values()]


def grid(points, cells, kind, point_data=None, cell_data=None):
	"""A vtkUnstructuredGrid from arrays.

	:param points: (n, 2) or (n, 3)
	:param cells: (m, k) rows of points; (m,) for VTK_VERTEX
	:param kind: VTK_TRIANGLE, VTK_LINE or VTK_VERTEX
	:param point_data, cell_data: arrays by name, a row per point or cell; rows of two numbers become vectors in the
		plane, rows of six are symmetric tensors
	"""
	cells = np.asarray(cells, dtype=np.int64)
	cells = cells[:, None] if cells.ndim == 1 else cells
	result = vtkUnstructuredGrid()
	places = vtkPoints()
	places.SetData(_array("points", np.asarray(points, float)))
	result.SetPoints(places)
	table = vtkCellArray()
	corners = np.full((len(cells), cells.shape[1] + 1), cells.shape[1], dtype=np.int64)
	corners[:, 1:] = cells
	table.ImportLegacyFormat(numpy_to_vtkIdTypeArray(corners.ravel(), deep=True))
	result.SetCells(kind, table)
	for data, arrays, rows in (
		(result.GetPointData(), point_data, len(points)),
		(result.GetCellData(), cell_data, len(cells)),
	):
		for name, values in (arrays or {}).items():
			if len(values) != rows:
				raise ValueError(f"array '{name}' has {len(values)} rows where the grid has {rows}")
			data.AddArray(_array(name, np.asarray(values)))
	return result


def write(data, path, time=None):
	"""Write a vtkUnstructuredGrid to a .vtu file, compressed; *time* [s] is stored as VTK's TimeValue.

	Where it comes from is stored in its field data, as a text (see :mod:`provenance`).
	"""
	if time is not None:
		data.GetFieldData().AddArray(_array("TimeValue", np.array([float(time)])))
	origin = vtkStringArray()
	origin.SetName(provenance.KEY)
	origin.InsertNextValue(provenance.text())
	data.GetFieldData().AddArray(origin)
	writer = vtkXMLUnstructuredGridWriter()
	writer.SetFileName(path)
	writer.SetInputData(data)
	writer.SetDataModeToAppended()
	writer.EncodeAppendedDataOff()
	writer.SetCompressorTypeToLZ4()  # a fraction of zlib's time; ParaView reads it since 5.4
	if writer.Write() != 1:
		raise OSError(f"VTK could not write {path}")


def field_text(path, name):
	"""A text in the field data of a .vtu file; None when it holds none of that name."""
	reader = vtkXMLUnstructuredGridReader()
	reader.SetFileName(path)
	reader.Update()
	found = reader.GetOutput().GetFieldData().GetAbstractArray(name)
	return found.GetValue(0) if isinstance(found, vtkStringArray) else None


class _Collection:
	"""A .pvd file and the .vtu files beside it."""

	def __init__(self, name):
		self.name, self.path = name, name + ".pvd"
		self.tree = ET.ElementTree(ET.Element("VTKFile", type="Collection", version="0.1"))
		self.origin = ET.Comment()
		self.tree.getroot().append(self.origin)
		self.list = ET.SubElement(self.tree.getroot(), "Collection")
		os.makedirs(os.path.dirname(os.path.abspath(name)), exist_ok=True)
		kept = self._kept()
		self._next = 0
		for entry in kept:
			self.list.append(entry)
			self._next = int(entry.get("file")[len(os.path.basename(name)) + 1:-len(".vtu")]) + 1
		files = {os.path.join(os.path.dirname(name), entry.get("file")) for entry in kept}
		for old in glob.glob(glob.escape(name) + "-[0-9]*.vtu") + (
			[] if kept else glob.glob(glob.escape(self.path))
		):
			if old not in files:
				os.remove(old)

	def _kept(self):
		"""Entries of an earlier part of the same run, in order of time."""
		from yade import O
		if O.iter == 0 or not os.path.exists(self.path):
			return []
		try:
			entries = ET.parse(self.path).getroot().iter("DataSet")
		except ET.ParseError:
			return []
		own = re.compile(re.escape(os.path.basename(self.name)) + r"-\d+\.vtu")
		there = lambda entry: os.path.exists(os.path.join(os.path.dirname(self.path), entry.get("file")))
		return sorted(
			(
				entry
				for entry in entries
				if own.fullmatch(entry.get("file", ""))
				and float(entry.get("timestep")) <= O.time * (1 + 1e-12)
				and there(entry)
			),
			key=lambda entry: float(entry.get("timestep")),
		)

	def add(self, data, time):
		path = f"{self.name}-{self._next:04d}.vtu"
		self._next += 1
		write(data, path, time)
		ET.SubElement(self.list, "DataSet", timestep=repr(float(time)), part="0", file=os.path.basename(path))
		self.origin.text = provenance.comment()
		ET.indent(self.tree)
		self.tree.write(self.path + ".new", encoding="utf-8", xml_declaration=True)
		os.replace(self.path + ".new", self.path)  # complete at any moment, so ParaView can follow a run


def _parts(sample, sub_elements):
	from .block import Block
	if isinstance(sample, Block):
		return {"": lambda: _triangles(sample, sub_elements)}
	return {
		"-spheres": lambda: _spheres(sample),
		"-bonds": lambda: _bonds(sample),
		"-broken": lambda: _broken(sample),
	}


def _triangles(block, sub_elements):
	nodes, triangles = block.positions, block.mesh.triangles
	corners, cells = nodes, triangles
	points = {"displacement": block.displacements, "velocity": block.velocities}
	# what every law has, and whatever else the laws of this block remember
	tensors = {"stress": block.stress, "strain": block.strain, "plasticStrain": block.plastic_strain}
	scalars = {"damage": block.sub_element_damage}
	for name, _, components in block.fields:
		if name not in tensors:
			(scalars if components == 1 else tensors)[name] = block.field(name)
	single = {"rotation": block.rotation, "region": block.mesh.regions, "id": block.triangle_ids}
	if sub_elements:
		centres = len(nodes) + np.arange(len(triangles))
		cores = block.core_positions
		corners = np.vstack([nodes, cores])
		points = {
			"displacement": np.vstack(
				[block.displacements, cores - block.reference_positions[triangles].mean(axis=1)]
			),
			"velocity": np.vstack([block.velocities, block.core_velocities]),
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


def _spheres(sample):
	arrays = {
		"radius": sample.radii, "displacement": sample.displacements, "velocity": sample.velocities,
		"rotation": sample.rotations, "damage": sample.damage,
		"id": sample.ids
	}
	return grid(sample.positions, np.arange(len(sample)), VTK_VERTEX, arrays)


def _bonds(sample):
	broken, positions = sample.broken, sample.positions
	held, stresses, forces = sample.bonds, sample.bond_stresses, sample.bond_forces
	ends = np.vstack([held, np.column_stack([broken["id1"], broken["id2"]])])
	rows = sample.rows(ends)
	there = (rows >= 0).all(axis=1)  # not of a sphere that was erased
	lost = np.full((len(broken), 2), np.nan)
	columns = {
		"state": (np.full(len(held), HOLDS), _modes(broken)),
		"normalStress": (stresses[:, 0], broken["normal_stress"]),
		"shearStress": (stresses[:, 1], broken["shear_stress"]),
		"radius": (sample.bond_radii, broken["radius"]),
		"axialForce": (forces[:, 0], lost[:, 0]), "shearForce": (forces[:, 1], lost[:, 1])
	}
	arrays = {name: np.concatenate(parts)[there] for name, parts in columns.items()}
	return grid(positions, rows[there], VTK_LINE, None, arrays)


def _broken(sample):
	broken = sample.broken
	arrays = {name: broken[name] for name in ("time", "normal", "radius", "energy")}
	arrays["mode"] = _modes(broken)
	arrays["normalStress"], arrays["shearStress"] = broken["normal_stress"], broken["shear_stress"]
	return grid(broken["position"], np.arange(len(broken)), VTK_VERTEX, arrays)


def _modes(broken):
	return np.where(broken["mode"] == "tension", TENSION, SHEAR)


def _in_space(values):
	return np.pad(values, ((0, 0), (0, 1))) if values.ndim == 2 and values.shape[1] == 2 else values


def _array(name, values):
	values = _in_space(values)
	if values.dtype.kind in "iub":
		values = values.astype(np.int32)
	array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
	array.SetName(name)
	if values.ndim == 2 and values.shape[1] == len(TENSOR):
		for index, component in enumerate(TENSOR):
			array.SetComponentName(index, component)
	return array
