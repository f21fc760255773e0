# GPL v2 or later, see LICENSE.
"""Pictures fit for a paper: column width, 8 pt type, colours that everybody can tell apart, units on every axis.

Figures are made without pyplot, so they work inside YADE, with or without a display::

	ddem.plots.mesh(mesh, file="out/mesh.pdf")
	ddem.plots.field(mesh, damage, "damage", file="out/damage.png", limits=(0, 1))
	ddem.plots.field(mesh, velocity[:, 0], "velocity $v_x$ [m/s]", displacement=u, scale=10, signed=True)
"""
import os

import numpy as np
from matplotlib import rc_context
from matplotlib.collections import EllipseCollection, LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.tri import Triangulation

from . import provenance

COLUMN = 85.0  # width of one column [mm]
PAGE = 175.0  # width of the page [mm]

# Okabe and Ito (2008): eight colours that the colour-blind can tell apart. The light grey is for the default region.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#F0E442", "#000000")
_DEFAULT_REGION = "#E4E4E4"

SEQUENTIAL = "cividis"  # even steps in lightness, the same for all kinds of colour vision
DIVERGING = "PuOr_r"  # for quantities with a sign; white is zero

STYLE = {
	"font.size": 8,
	"axes.labelsize": 8,
	"axes.titlesize": 8,
	"xtick.labelsize": 7,
	"ytick.labelsize": 7,
	"legend.fontsize": 7,
	"legend.frameon": False,
	"axes.linewidth": 0.6,
	"xtick.major.width": 0.6,
	"ytick.major.width": 0.6,
	"lines.linewidth": 1.0,
	"axes.prop_cycle": f"cycler(color={list(COLOURS)})",
	"savefig.dpi": 300,
	"pdf.fonttype": 42,
	"svg.fonttype": "none",
}


def figure(width=COLUMN, height=None):
	"""A figure of the given width and height [mm]; add axes to it within ``rc_context(STYLE)``."""
	return Figure(figsize=(width / 25.4, (height or 0.75 * width) / 25.4), layout="compressed")


def save(fig, file):
	"""Write a figure; the file's ending says the format, missing folders are made; it says where it comes from."""
	os.makedirs(os.path.dirname(os.path.abspath(file)), exist_ok=True)
	with rc_context(STYLE):
		fig.savefig(file, metadata=provenance.metadata(os.path.splitext(file)[1]))


def mesh(mesh, ax=None, file=None):
	"""Draw a mesh, its regions in colours, and return the axes.

	:param mesh: a mesh, or (nodes [m], triangles)
	:param ax: axes to draw into; new ones in a figure of one column's width when left out
	:param file: write the figure there
	"""
	nodes, triangles = _parts(mesh)
	names, regions = (
		getattr(mesh, "region_names", ("",)),
		getattr(mesh, "regions", np.zeros(len(triangles), dtype=int)),
	)
	colours = np.array([_DEFAULT_REGION] + [COLOURS[i % len(COLOURS)] for i in range(len(names) - 1)])
	with rc_context(STYLE):
		ax, unit = _axes(ax, nodes)
		ax.add_collection(
			PolyCollection(
				nodes[triangles] * unit,
				facecolors=colours[regions],
				edgecolors="0.25",
				linewidths=_line_widths(nodes, triangles),
			)
		)
		handles = [
			Patch(facecolor=colours[i], edgecolor="0.25", linewidth=0.4, label=name)
			for i, name in enumerate(names)
			if name and (regions == i).any()
		]
		if handles:
			ax.figure.legend(handles=handles, loc="outside upper center", ncols=min(4, len(handles)))
		return _finish(ax, file)


def field(
	mesh, values, label, file=None, ax=None, displacement=None, scale=1.0, limits=None, signed=False, edges=False,
	colorbar=True
):
	"""Draw a field on a mesh in colours and return the axes.

	:param mesh: a mesh, or (nodes [m], triangles)
	:param values: one a node (drawn smoothly), one a triangle, or (m, 3), one a sub-element
		(centroid, corner k, corner k+1)
	:param label: text at the colour bar; end it with the unit in brackets
	:param displacement: (n, 2) displacement of the nodes [m]: draw the deformed shape, and the border of the
		undeformed one as a thin line
	:param scale: factor on the displacement
	:param limits: (smallest, largest) value of the colour bar; those of the values when left out
	:param signed: use a colour map with white at zero, and limits symmetric about it
	:param edges: draw the triangles' edges
	:param colorbar: False leaves it out, for several axes with one common colour bar:
		``fig.colorbar(ax.collections[0], ax=axes)``
	"""
	nodes, triangles = _parts(mesh)
	values, count = np.asarray(values, dtype=float), (len(nodes), len(triangles))
	if values.shape not in ((count[0],), (count[1],), (count[1], 3)):
		raise ValueError(
			f"field {label!r}: values of shape {values.shape} fit neither {count[0]} nodes, nor "
			f"{count[1]} triangles, nor ({count[1]}, 3) sub-elements"
		)
	if displacement is not None and np.shape(displacement) != nodes.shape:
		raise ValueError(
			f"field {label!r}: displacement has shape {np.shape(displacement)} instead of {nodes.shape}"
		)
	shape = nodes if displacement is None else nodes + scale * np.asarray(displacement)
	look, extend = _look(values, limits, signed)

	with rc_context(STYLE):
		ax, unit = _axes(ax, np.vstack([nodes, shape]))
		shape = shape * unit
		if values.shape == (count[0],):
			drawn = ax.tripcolor(Triangulation(*shape.T, triangles), values, shading="gouraud", **look)
		else:
			corners = shape[triangles]
			if values.ndim == 2:
				centre = np.repeat(corners.mean(axis=1), 3, axis=0)
				corners = np.stack(
					[centre, corners.reshape(-1, 2), np.roll(corners, -1, axis=1).reshape(-1, 2)],
					axis=1,
				)
			drawn = ax.add_collection(
				PolyCollection(corners, array=values.ravel(), edgecolors="face", linewidths=0.1, **look)
			)
		if edges:
			ax.add_collection(
				PolyCollection(
					shape[triangles],
					facecolors="none",
					edgecolors="0.3",
					linewidths=0.5 * _line_widths(nodes, triangles),
				)
			)
		if displacement is not None:
			ax.add_collection(
				LineCollection(nodes[_border(triangles)] * unit, colors="0.5", linewidths=0.5)
			)
			if scale != 1:
				ax.set_title(f"displacement × {scale:g}")
		if colorbar:
			ax.figure.colorbar(drawn, ax=ax, label=label, extend=extend, shrink=0.9, aspect=25)
		return _finish(ax, file)


def spheres(centres, radii, values, label, file=None, ax=None, limits=None, signed=False, colorbar=True, cracks=None):
	"""Draw spheres as seen along z, the ones in front over those behind, in colours of a value each,
	and return the axes.

	:param centres: (n, 3) [m]; (n, 2) for one layer
	:param radii: (n,) [m]
	:param values: (n,)
	:param label: text at the colour bar; end it with the unit in brackets
	:param cracks: (k, 2, 2) lines [m] drawn over the spheres
	:param limits, signed, colorbar: as in :func:`field`
	"""
	centres, radii, values = (np.asarray(array, dtype=float) for array in (centres, radii, values))
	if not len(centres) == len(radii) == len(values):
		raise ValueError(
			f"spheres {label!r}: {len(centres)} centres, {len(radii)} radii and {len(values)} values"
		)
	look, extend = _look(values, limits, signed)
	front = np.argsort(centres[:, 2], kind="stable") if centres.shape[1] == 3 else np.arange(len(centres))
	with rc_context(STYLE):
		ax, unit = _axes(ax, np.vstack([centres[:, :2] - radii[:, None], centres[:, :2] + radii[:, None]]))
		diameters = 2 * unit * radii[front]
		drawn = EllipseCollection(
			diameters, diameters, np.zeros(len(front)), units="xy", offsets=unit * centres[front, :2],
			offset_transform=ax.transData, array=values[front],
			edgecolors="0.25", linewidths=0.15, **look
		)
		ax.add_collection(drawn)
		if cracks is not None and len(cracks):
			ax.add_collection(
				LineCollection(
					unit * np.asarray(cracks), colors="black", linewidths=0.3, rasterized=True
				)
			)
		if colorbar:
			ax.figure.colorbar(drawn, ax=ax, label=label, extend=extend, shrink=0.9, aspect=25)
		return _finish(ax, file)


def _look(values, limits, signed):
	"""Colours of a field, and at which ends the colour bar goes on beyond them."""
	finite = values[np.isfinite(values)]
	low, high = limits or ((finite.min(), finite.max()) if len(finite) else (0, 1))
	if signed and not limits:
		low, high = -max(abs(low), abs(high)), max(abs(low), abs(high))
	extend = {(False, False): "neither", (True, False): "min", (False, True): "max", (True, True): "both"}
	beyond = bool(len(finite) and finite.min() < low), bool(len(finite) and finite.max() > high)
	return {
		"cmap": DIVERGING if signed else SEQUENTIAL,
		"clim": (low, high if high > low else low + (abs(low) or 1.0)),
		"rasterized": True,
	}, extend[beyond]


def _parts(mesh):
	nodes, triangles = mesh if isinstance(mesh, tuple) else (mesh.nodes, mesh.triangles)
	return np.asarray(nodes, dtype=float), np.asarray(triangles)


def _border(triangles):
	edges = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
	edges, count = np.unique(edges, axis=0, return_counts=True)
	return edges[count == 1]


def _line_widths(nodes, triangles):
	# Thin enough [pt] for the smallest triangles of a graded mesh to be seen.
	a, b, c = (nodes[triangles[:, k]] for k in range(3))
	part = (
		np.sqrt(np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]))
		/ np.ptp(nodes, axis=0).max()
	)
	return np.clip(10 * part, 0.03, 0.4)


def _axes(ax, nodes):
	"""Axes with equal scales and a unit that gives readable numbers; the factor from metres to it."""
	low, span = nodes.min(axis=0), np.ptp(nodes, axis=0)
	factor, name = next(
		((f, n) for f, n in ((1.0, "m"), (1e3, "mm"), (1e6, "µm")) if span.max() * f >= 2), (1e6, "µm")
	)
	if ax is None:
		height = np.clip(0.75 * COLUMN * span[1] / span[0] + 12, 35, 110)
		ax = figure(COLUMN, height).add_subplot()
	ax.set_aspect("equal")
	ax.spines[["top", "right"]].set_visible(False)
	(x, y), (u, v) = low * factor, 0.03 * span.max() * factor * np.ones(2)
	ax.set_xlim(x - u, x + span[0] * factor + u)
	ax.set_ylim(y - v, y + span[1] * factor + v)
	ax.set_xlabel(f"$x$ [{name}]")
	ax.set_ylabel(f"$y$ [{name}]")
	return ax, factor


def _finish(ax, file):
	if file is not None:
		save(ax.figure, file)
	return ax
