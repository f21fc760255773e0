# GPL v2 or later, see LICENSE.
"""What a mesh must satisfy; each failure is a ValueError that names the triangle or node and its place."""
import numpy as np

from .. import _mesh

_FLAT = 1e-9  # a triangle whose smallest height is below this times its longest edge has no area
_CLOSE = 1e-9  # nodes nearer to each other, or to an edge, than this times the local edge length are in conflict


def arrays(nodes, triangles, regions, region_names):
	"""Own copies of a mesh's arrays with their final types, checked one by one."""
	nodes = np.array(nodes, dtype=np.float64)
	if nodes.ndim != 2 or nodes.shape[1] != 2:
		raise ValueError(f"nodes must be (n, 2) coordinates [m], not an array of shape {nodes.shape}")
	if not np.isfinite(nodes).all():
		index = int(np.flatnonzero(~np.isfinite(nodes).all(axis=1))[0])
		raise ValueError(f"node {index} is at {point(nodes[index])}: coordinates must be finite numbers")
	indices = np.array(triangles)
	if indices.ndim != 2 or indices.shape[1] != 3 or indices.dtype.kind not in "iu":
		raise ValueError(
			f"triangles must be (m, 3) integer node indices, not {indices.dtype} of shape {indices.shape}"
		)
	if len(indices) == 0:
		raise ValueError("a mesh needs at least one triangle")
	if indices.min() < 0 or indices.max() >= len(nodes):
		triangle = int(np.flatnonzero((indices < 0).any(axis=1) | (indices >= len(nodes)).any(axis=1))[0])
		raise ValueError(
			f"triangle {triangle} has nodes {tuple(indices[triangle].tolist())}, but nodes are numbered "
			f"from 0 to {len(nodes) - 1}"
		)
	names = tuple(region_names)
	if (
		not names
		or names[0] != ""
		or len(set(names)) != len(names)
		or not all(isinstance(name, str) for name in names)
	):
		raise ValueError(
			"region_names must be different strings, the first of them \"\" (the default region), not "
			f"{names!r}"
		)
	numbers = np.zeros(len(indices), dtype=np.int32) if regions is None else np.array(regions)
	if numbers.shape != (len(indices),) or numbers.dtype.kind not in "iu":
		raise ValueError(
			f"regions must be one integer a triangle ({len(indices)}), not {numbers.dtype} of shape "
			f"{numbers.shape}"
		)
	if numbers.min() < 0 or numbers.max() >= len(names):
		triangle = int(np.flatnonzero((numbers < 0) | (numbers >= len(names)))[0])
		raise ValueError(
			f"triangle {triangle} is in region {numbers[triangle]}, but region_names has {len(names)} "
			f"names: {names!r}"
		)
	return nodes, indices.astype(np.int32), numbers.astype(np.int32), names


def geometry(mesh):
	"""Raise ValueError unless the mesh is a proper triangulation:
	positive triangles that meet only in whole edges and in nodes."""
	_degenerate(mesh)
	_clockwise(mesh)
	_duplicates(mesh)
	_nodes(mesh)
	_manifold(mesh)
	_overlaps(mesh)


def _degenerate(mesh):
	flat = np.flatnonzero(mesh.heights <= _FLAT * mesh.edge_lengths.max(axis=1))
	if len(flat):
		raise ValueError(
			f"{_triangle(mesh, flat[0])} has no area{_more(flat)}; remove it, or move one of its nodes"
		)


def _clockwise(mesh):
	turned = np.flatnonzero(mesh.areas < 0)
	if len(turned):
		raise ValueError(
			f"{_triangle(mesh, turned[0])} is clockwise{_more(turned)}; triangles must be "
			"counter-clockwise: use mesh.flipped(), or make or read it with orient=True"
		)


def _duplicates(mesh):
	_, first, inverse = np.unique(np.sort(mesh.triangles, axis=1), axis=0, return_index=True, return_inverse=True)
	again = np.flatnonzero(first[inverse.reshape(-1)] != np.arange(len(mesh.triangles)))
	if len(again):
		raise ValueError(
			f"{_triangle(mesh, again[0])} is the same as triangle "
			f"{first[inverse.reshape(-1)[again[0]]]}{_more(again)}; remove one of them"
		)


def _nodes(mesh):
	unused = np.setdiff1d(np.arange(len(mesh.nodes)), mesh.triangles)
	if len(unused):
		raise ValueError(
			f"node {unused[0]} at {point(mesh.nodes[unused[0]])} belongs to no triangle{_more(unused)}; "
			"remove it"
		)
	from scipy.spatial import cKDTree  # slow to import
	twins = cKDTree(mesh.nodes).query_pairs(_CLOSE * mesh.edge_lengths.min(), output_type="ndarray")
	if len(twins):
		a, b = sorted(twins.tolist())[0]
		raise ValueError(
			f"nodes {a} and {b} are both at {point(mesh.nodes[a])}{_more(twins)}; the triangles there are "
			"not joined: use one node for "
			"both, for example by merging duplicate nodes in the program that made the mesh"
		)


def _manifold(mesh):
	_, edges, unique, count = mesh._edge_table
	crowded = np.flatnonzero(count > 2)
	if len(crowded):
		a, b = edges[crowded[0]]
		triangles = ", ".join(str(t) for t in np.flatnonzero(unique == crowded[0]) // 3)
		raise ValueError(
			f"the edge between nodes {a} and {b}, {point(mesh.nodes[a])} to {point(mesh.nodes[b])}, "
			f"belongs to {count[crowded[0]]} "
			f"triangles ({triangles})"
			f"{_more(crowded)}; at most two can share an edge"
		)


def _overlaps(mesh):
	conflict = _mesh.firstConflict(mesh.nodes, mesh.triangles, _CLOSE)
	if conflict is None:
		return
	first, second, node = conflict
	if node >= 0:
		raise ValueError(
			f"node {node} at {point(mesh.nodes[node])} of triangle {first} lies on an edge of "
			f"{_triangle(mesh, second)} without being "
			"one of its nodes; the two are not joined: split that triangle at the node"
		)
	raise ValueError(
		f"{_triangle(mesh, first)} overlaps {_triangle(mesh, second)}; remove one of them or move its nodes"
	)


def point(position):
	return "(" + ", ".join(f"{value:.6g}" for value in position) + ") m"


def _triangle(mesh, index):
	corners = " ".join(point(corner)[:-2] for corner in mesh.nodes[mesh.triangles[index]])
	return f"triangle {index} with corners {corners} m"


def _more(found):
	return f" (and {len(found) - 1} more)" if len(found) > 1 else ""
