# GPL v2 or later, see LICENSE.
"""Mesh files, through meshio."""
import contextlib
import io
import os
import re
import warnings
from urllib.parse import unquote
from xml.etree import ElementTree

import numpy as np

from .. import provenance
from . import abaqus
from .triangles import Mesh

# cell array with the region's number; "region:NAME" marks the triangles of one region, for formats without names
_REGION = "region"
_MATERIALS = ("medit:ref", "nastran:ref", "avsucd:material")  # meshio's cell arrays of numbers of materials
_NUMBERED = ("gmsh:physical", _REGION + ":", *_MATERIALS)


def read(path, orient=False, length_unit="m", regions=None):
	"""Read a plane triangle mesh from a Gmsh, VTK, Abaqus or other file known to meshio.

	Physical surfaces of Gmsh become regions: under their name, or as "physical N" where they have none. So do
	element sets of Abaqus and CalculiX (one that holds all triangles only if it is the only one) and of other
	formats, and the numbers of materials that Medit, Nastran and AVS-UCD files have, as "material N". Elements
	CPE3, CPS3, S3 and the like are read as the plane-strain triangles of this package. Points, curves and sets of
	nodes in the file are ignored, points of no triangle dropped.

	:param orient: turn clockwise triangles over
	:param length_unit: of the file: "m", "cm", "mm" or "um"; see also :meth:`Mesh.scaled`
	:param regions: names of the groups or sets that become regions, for files in which they overlap; all when left
		out
	:raises ValueError: no such file, a damaged one, other cells than plane triangles, a bad mesh, sets that
		overlap, unknown unit or region
	"""
	from ..packing import _unit
	unit, path = _unit(length_unit), os.fspath(path)
	if not os.path.isfile(path):
		raise ValueError(f"mesh file {path!r} does not exist")
	if path.endswith(".msh"):
		_check_gmsh_text(path)
	if path.lower().endswith(".inp"):
		data = abaqus.read(path)
		points, triangles, groups, preferred = data.points, data.triangles, data.sets, data.sections
	else:
		data = _read_with_meshio(path)
		points, preferred = np.asarray(data.points, dtype=float), []
		triangles, blocks = _triangles(data, path)
		groups = _groups(data, blocks, len(triangles))

	if len(triangles) == 0:
		raise ValueError(
			f"{path!r} has no triangles (in Gmsh: generate the 2D mesh, and put the surface in a physical "
			"group or set Mesh.SaveAll)"
		)
	planar = _plane(points * unit, path)
	if triangles.min() < 0 or triangles.max() >= len(planar):
		raise ValueError(
			f"{path!r} has a triangle with node {triangles.max()}, but only {len(planar)} nodes; the file "
			"is damaged"
		)
	used, renumbered = np.unique(triangles, return_inverse=True)
	try:
		numbers, names = _regions(groups, preferred, len(triangles), regions)
		mesh = Mesh(planar[used], renumbered.reshape(-1, 3), numbers, names, orient=orient).validate()
	except ValueError as error:
		raise ValueError(f"{path!r}: {error}") from None
	provenance.note_file(path)
	return mesh


def write(mesh, path):
	"""Write a mesh with its regions; see :meth:`Mesh.write`."""
	import meshio
	path = os.fspath(path)
	nodes = np.column_stack([mesh.nodes, np.zeros(len(mesh.nodes))])
	if path.endswith(".msh"):
		# Number 0 is "in no physical group". Version 2.2 is what every reader of Gmsh files understands.
		numbers = {"gmsh:physical": [mesh.regions], "gmsh:geometrical": [mesh.regions + 1]}
		names = {name: np.array([i, 2]) for i, name in enumerate(mesh.region_names) if name}
		meshio.write(
			path,
			meshio.Mesh(nodes, [("triangle", mesh.triangles)], cell_data=numbers, field_data=names),
			file_format="gmsh22",
			binary=False,
		)
		return
	arrays = {_REGION: [mesh.regions]}
	arrays.update(
		{
			f"{_REGION}:{_escaped(name)}": [(mesh.regions == i).astype(np.int32)]
			for i, name in enumerate(mesh.region_names)
			if name
		}
	)
	try:
		meshio.write(path, meshio.Mesh(nodes, [("triangle", mesh.triangles)], cell_data=arrays))
	except (meshio.ReadError, meshio.WriteError) as error:
		raise ValueError(f"cannot write mesh file {path!r}: {error}") from None


def _escaped(name):
	return name.replace("%", "%25").replace(" ", "%20")  # VTK's old format allows no spaces in names of arrays


def _read_with_meshio(path):
	import meshio
	said = io.StringIO()  # meshio prints what is wrong, and then ends the process
	try:
		with warnings.catch_warnings(), contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
			warnings.simplefilter("ignore")
			return meshio.read(path)
	except SystemExit:
		reason = " ".join(said.getvalue().split())
	except Exception as error:  # whatever the reader of a damaged file stumbles over
		reason = f"{type(error).__name__}: {error}"
	raise ValueError(
		f"cannot read mesh file {path!r}; it is truncated, damaged or of another kind "
		f"({_xml_error(path) or reason})"
	)


def _xml_error(path):
	"""Where a file that should be XML stops being it: meshio knows but does not say."""
	if path.endswith((".vtu", ".vtp", ".xdmf")):
		try:
			ElementTree.parse(path)
		except ElementTree.ParseError as error:
			return str(error)
	return ""


def _check_gmsh_text(path):
	"""Find the line where a Gmsh text file is cut off or not a number; meshio does not say it,
	and may read such a file without complaint."""
	with open(path, "rb") as file:
		text = file.read()
	header = re.match(rb"\s*\$MeshFormat\s+(\S+)\s+([01])\s", text)
	if not header or header.group(2) == b"1":
		return  # another format or binary
	section, start, opened = None, 0, 0
	for line in re.finditer(rb"^[ \t]*\$(End)?(\w+)[ \t]*\r?$", text, re.M):
		number = 1 + text.count(b"\n", 0, line.start())
		if not line.group(1):
			if section:
				raise ValueError(
					f"{path!r}, line {number}: ${line.group(2).decode()} begins before ${section} "
					f"of line {opened} has ended; the file is damaged"
				)
			section, start, opened = line.group(2).decode(), line.end(), number
			continue
		if section != line.group(2).decode():
			raise ValueError(
				f"{path!r}, line {number}: $End{line.group(2).decode()} does not end "
				f"{'$' + section if section else 'any section'}; the file is damaged"
			)
		if section in ("Nodes", "Elements", "Entities"):
			strange = re.search(rb"[^\s0-9eE.+-]\S*", text[start:line.start()])
			if strange:
				number = 1 + text.count(b"\n", 0, start + strange.start())
				raise ValueError(
					f"{path!r}, line {number}: {strange.group().decode(errors='replace')!r} in "
					f"${section} is not a number"
				)
		if section in ("Nodes", "Elements") and header.group(1).startswith(b"2"):
			rows = text[start:line.start()].split(b"\n")[1:]
			rows = [row for row in rows if row.strip()]
			if rows and rows[0].strip().isdigit() and int(rows[0]) != len(rows) - 1:
				raise ValueError(
					f"{path!r}, line {opened + 1}: ${section} announces {int(rows[0])} lines, but "
					f"{len(rows) - 1} follow; the file is damaged"
				)
		section = None
	if section:
		raise ValueError(
			f"{path!r}, line {1 + text.count(bytes([10]))}: the file ends within ${section}, which began "
			f"in line {opened}; it is truncated"
		)


def _plane(points, path):
	if points.shape[1] == 2:
		return points
	flat = np.ptp(points, axis=0) <= 1e-9 * np.ptp(points, axis=0).max()
	if flat[2]:
		return points[:, :2]
	low, high = points[:, 2].min(), points[:, 2].max()
	axis = (
		"the mesh lies in another plane: exchange its coordinates"
		if flat.any()
		else "only plane meshes can be used"
	)
	raise ValueError(f"{path!r} is not in the x-y plane: z goes from {low:g} to {high:g} m; {axis}")


def _triangles(data, path):
	"""Triangles (m, 3) of what meshio has read, and the numbers of the blocks of cells that they come from."""
	others = sorted({block.type for block in data.cells} - {"triangle", "line", "vertex"})
	if others:
		hint = "; use triangles of first order" if any(
			name.startswith(("triangle", "line")) for name in others
		) else "; split them into triangles"
		raise ValueError(
			f"{path!r} has cells of type {', '.join(others)}; only plane triangles can be used{hint}"
		)
	blocks = [i for i, block in enumerate(data.cells) if block.type == "triangle"]
	return np.vstack([data.cells[i].data for i in blocks] or [np.empty((0, 3))]).astype(np.int64), blocks


def _groups(data, blocks, count):
	"""Groups of triangles in what meshio has read: rows of triangles by name."""
	whole = {
		key: np.concatenate([values[i] for i in blocks]).astype(int) for key,
		values in data.cell_data.items() if key.startswith(_NUMBERED) and blocks
	}
	if "gmsh:physical" in whole:
		titles = {int(number): name for name, (number, dimension) in data.field_data.items() if dimension == 2}
		numbers, groups = whole["gmsh:physical"], {}
		for number in sorted(set(numbers.tolist()) - {0}):
			name = titles.get(number, f"physical {number}")
			groups[name] = np.concatenate(
				[groups.get(name, []), np.flatnonzero(numbers == number)]
			).astype(int)
		return groups
	groups = {
		unquote(key[len(_REGION) + 1:]): np.flatnonzero(values) for key,
		values in whole.items() if key.startswith(_REGION + ":")
	}
	first = np.cumsum([0] + [len(data.cells[i].data) for i in blocks])
	for name, members in data.cell_sets.items():
		rows = [
			np.asarray(members[i], dtype=int) + start for i,
			start in zip(blocks, first) if members[i] is not None
		]
		if not name.startswith("gmsh:") and sum(map(len, rows)):
			groups[name] = np.concatenate(rows)
	if not groups:
		for key in _MATERIALS:
			numbers = sorted(set(whole.get(key, np.zeros(0, dtype=int)).tolist()))
			if len(numbers) > 1:
				return {
					f"material {number}": np.flatnonzero(whole[key] == number) for number in numbers
				}
	return groups


def _regions(groups, preferred, count, wanted):
	"""Region number of each triangle, and names, from groups of triangles.

	:param preferred: groups that count where groups overlap
	:param wanted: names of the groups to take, or None
	"""
	if wanted is not None:
		missing = [name for name in wanted if name not in groups]
		if isinstance(wanted, str) or missing:
			raise ValueError(
				f"regions = {wanted!r}: give a list of names of the file's groups of triangles, which "
				f"are {', '.join(map(repr, groups)) or 'none'}"
			)
		chosen = {name: groups[name] for name in wanted}
	else:
		chosen = groups
		if _overlap(chosen, count):
			# a set of all elements says nothing
			chosen = {name: rows for name, rows in groups.items() if len(rows) < count} or groups
		if _overlap(chosen, count) and preferred:
			chosen = {name: groups[name] for name in preferred}
	shared = _overlap(chosen, count)
	if shared:
		triangle, names = shared
		raise ValueError(
			f"triangle {triangle} (counted from 0) belongs to the sets {', '.join(map(repr, names))}, and "
			"can have one region only; say which sets become regions: "
			f"read(…, regions=[…]); the file has {', '.join(map(repr, groups))}"
		)
	regions = np.zeros(count, dtype=np.int32)
	for number, rows in enumerate(chosen.values(), start=1):
		regions[rows] = number
	return regions, ("", *chosen)


def _overlap(groups, count):
	"""The first triangle that is in more than one group, and their names; None if there is none."""
	times = np.zeros(count, dtype=int)
	for rows in groups.values():
		times[rows] += 1
	if (times < 2).all():
		return None
	triangle = int(np.flatnonzero(times > 1)[0])
	return triangle, [name for name, rows in groups.items() if triangle in rows]
