# GPL v2 or later, see LICENSE.
"""The sides of a mesh, straight or uneven, and how they are told from round or slanted borders."""
import math

import numpy as np

from . import checks

SIDES = {"left": (0, -1), "right": (0, 1), "bottom": (1, -1), "top": (1, 1)}  # axis, and where along it the side is
_UNEVEN = 0.3  # of the shorter border edge at a node: so far may it lie behind the outermost node of its side
_CORNER = 35.0  # [degree]: where the border turns by less, it goes on; regular polygons of up to 10 corners have sides


def side(mesh, name):
	"""Sorted indices of the border nodes of a side.

	These are the nodes that lie no more than 0.3 of an edge of the border behind the outermost one, so that the
	side may be uneven or slant a little. A side has at least one edge, no node alone, and ends at corners of 35
	degrees or more. It may have gaps, such as the mouth of a notch.

	:raises ValueError: what lies outermost is no such side: the apex of a round, slanted or rough border
	"""
	axis, sign = SIDES[name]
	edges = mesh.boundary_edges()
	steps = mesh.nodes[edges[:, 1]] - mesh.nodes[edges[:, 0]]
	shortest = np.full(len(mesh.nodes), np.inf)
	np.minimum.at(shortest, edges, np.linalg.norm(steps, axis=1)[:, None])
	border = np.unique(edges)
	behind = np.max(sign * mesh.nodes[border, axis]) - sign * mesh.nodes[:, axis]
	nodes = border[behind[border] <= _UNEVEN * shortest[border]]
	own = np.isin(edges, nodes).all(axis=1)
	alone = np.setdiff1d(nodes, edges[own])
	if len(alone):
		_refuse(
			mesh, name, nodes,
			f"no edge joins the one at {checks.point(mesh.nodes[alone[0]])} with another of them"
		)
	for at, other in ((1, 0), (0, 1)):  # where an edge of the side ends and where it starts
		for edge in np.flatnonzero(own & ~np.isin(edges[:, at], edges[own, other])):
			node = edges[edge, at]
			for following in np.flatnonzero(edges[:, other] == node):
				turn = math.degrees(
					math.acos(np.clip(_unit(steps[edge]) @ _unit(steps[following]), -1, 1))
				)
				if turn < _CORNER:
					_refuse(
						mesh, name, nodes,
						f"at {checks.point(mesh.nodes[node])} the border goes on, turning by "
						f"{turn:.0f} degrees only"
					)
	return nodes


def _refuse(mesh, name, nodes, why):
	axis, sign = SIDES[name]
	places, others = mesh.nodes[nodes, axis], mesh.nodes[nodes, 1 - axis]
	near = places.min() if sign > 0 else places.max()
	few = len(nodes) == 1
	raise ValueError(
		f"boundary({name!r}): the mesh has no straight {name} side. Within {_UNEVEN} of an edge of its {name} "
		"end, "
		f"{'xy'[axis]} = {places.max() if sign > 0 else places.min():.6g} m, {'lies' if few else 'lie'} "
		f"{len(nodes)} node{'' if few else 's'} of the border, "
		f"{'yx'[axis]} from {others.min():.6g} to {others.max():.6g} m, and {why}. Name the nodes by a "
		"function of the mesh's coordinates, for example "
		f"boundary(lambda x, y: {'xy'[axis]} {'>' if sign > 0 else '<'} "
		f"{near - sign * mesh.edge_lengths.mean():.6g})"
	)


def _unit(vector):
	return vector / np.linalg.norm(vector)
