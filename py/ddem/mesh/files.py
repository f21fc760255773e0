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
from .triangles import Mesh

_REGION = "region"  # cell array with the region's number; "region:NAME" marks the triangles of one region, for formats without names


def read(path, orient=False):
	"""Read a plane triangle mesh from a Gmsh, VTK or other file known to meshio.

	Physical surfaces of Gmsh become regions: under their name, or as "physical N" where they have none. Points and curves in the file are ignored,
	points of no triangle dropped.

	:param orient: turn clockwise triangles over
	"""
	path = os.fspath(path)
	if not os.path.isfile(path):
		raise ValueError(f"mesh file {path!r} does not exist")
	if path.endswith(".msh"):
		_check_gmsh_text(path)
	data = _read_with_meshio(path)

	planar = _plane(np.asarray(data.points, dtype=float), path)
	others = sorted({block.type for block in data.cells} - {"triangle", "line", "vertex"})
	if others:
		hint = "; use triangles of first order" if any(name.startswith(("triangle", "line")) for name in others) else "; split them into triangles"
		raise ValueError(f"{path!r} has cells of type {', '.join(others)}; only plane triangles can be used{hint}")
	blocks = [i for i, block in enumerate(data.cells) if block.type == "triangle"]
	if not blocks:
		raise ValueError(f"{path!r} has no triangles (in Gmsh: generate the 2D mesh, and put the surface in a physical group or set Mesh.SaveAll)")
	triangles = np.vstack([data.cells[i].data for i in blocks]).astype(np.int64)
	if triangles.min() < 0 or triangles.max() >= len(planar):
		raise ValueError(f"{path!r} has a triangle with node {triangles.max()}, but only {len(planar)} nodes; the file is damaged")
	used, renumbered = np.unique(triangles, return_inverse=True)
	regions, names = _regions(data, blocks, len(triangles))
	try:
		mesh = Mesh(planar[used], renumbered.reshape(-1, 3), regions, names, orient=orient).validate()
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
		meshio.write(path, meshio.Mesh(nodes, [("triangle", mesh.triangles)], cell_data=numbers, field_data=names), file_format="gmsh22", binary=False)
		return
	arrays = {_REGION: [mesh.regions]}
	arrays.update({f"{_REGION}:{_escaped(name)}": [(mesh.regions == i).astype(np.int32)] for i, name in enumerate(mesh.region_names) if name})
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
	raise ValueError(f"cannot read mesh file {path!r}; it is truncated, damaged or of another kind ({_xml_error(path) or reason})")


def _xml_error(path):
	"""Where a file that should be XML stops being it: meshio knows but does not say."""
	if path.endswith((".vtu", ".vtp", ".xdmf")):
		try:
			ElementTree.parse(path)
		except ElementTree.ParseError as error:
			return str(error)
	return ""


def _check_gmsh_text(path):
	"""Find the line where a Gmsh text file is cut off or not a number; meshio does not say it, and may read such a file without complaint."""
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
					f"{path!r}, line {number}: ${line.group(2).decode()} begins before ${section} of line {opened} has ended; the "
					"file is damaged"
				)
			section, start, opened = line.group(2).decode(), line.end(), number
			continue
		if section != line.group(2).decode():
			raise ValueError(
				f"{path!r}, line {number}: $End{line.group(2).decode()} does not end {'$' + section if section else 'any section'}; "
				"the file is damaged"
			)
		if section in ("Nodes", "Elements", "Entities"):
			strange = re.search(rb"[^\s0-9eE.+-]\S*", text[start:line.start()])
			if strange:
				number = 1 + text.count(b"\n", 0, start + strange.start())
				raise ValueError(f"{path!r}, line {number}: {strange.group().decode(errors='replace')!r} in ${section} is not a number")
		if section in ("Nodes", "Elements") and header.group(1).startswith(b"2"):
			rows = text[start:line.start()].split(b"\n")[1:]
			rows = [row for row in rows if row.strip()]
			if rows and rows[0].strip().isdigit() and int(rows[0]) != len(rows) - 1:
				raise ValueError(
					f"{path!r}, line {opened + 1}: ${section} announces {int(rows[0])} lines, but {len(rows) - 1} follow; the "
					"file is damaged"
				)
		section = None
	if section:
		raise ValueError(
			f"{path!r}, line {1 + text.count(bytes([10]))}: the file ends within ${section}, which began in line {opened}; it is truncated"
		)


def _plane(points, path):
	if points.shape[1] == 2:
		return points
	flat = np.ptp(points, axis=0) <= 1e-9 * np.ptp(points, axis=0).max()
	if flat[2]:
		return points[:, :2]
	low, high = points[:, 2].min(), points[:, 2].max()
	axis = "the mesh lies in another plane: exchange its coordinates" if flat.any() else "only plane meshes can be used"
	raise ValueError(f"{path!r} is not in the x-y plane: z goes from {low:g} to {high:g} m; {axis}")


def _regions(data, blocks, count):
	"""Region number of each triangle, and names."""
	titles = {int(number): name for name, (number, dimension) in data.field_data.items() if dimension == 2}
	if "gmsh:physical" in data.cell_data:
		numbers = np.concatenate([data.cell_data["gmsh:physical"][i] for i in blocks]).astype(int)
		groups = [number for number in sorted(set(numbers.tolist())) if number != 0]
		regions = np.zeros(count, dtype=np.int32)
		for region, number in enumerate(groups, start=1):
			regions[numbers == number] = region
		return regions, ("", *(titles.get(number, f"physical {number}") for number in groups))
	regions, names = np.zeros(count, dtype=np.int32), [""]
	for key, values in data.cell_data.items():
		if key.startswith(_REGION + ":"):
			names.append(unquote(key[len(_REGION) + 1:]))
			regions[np.concatenate([values[i] for i in blocks]).astype(int) != 0] = len(names) - 1
	return regions, tuple(names)
