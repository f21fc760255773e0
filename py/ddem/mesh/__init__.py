# GPL v2 or later, see LICENSE.
"""Plane triangle meshes: make them, read them, look at their quality.

All lengths are in metres, angles in degrees. A mesh is a :class:`Mesh`: nodes, counter-clockwise triangles, and named
regions (region "" is the default)::

	from yade import ddem

	# regular: 10 cm x 20 cm, 800 triangles, 8 of them steel (the block of Zubelewicz 2018, section 4.3)
	mesh = ddem.mesh.rectangle(width=0.10, height=0.20, size=0.01, regions={"steel":
	ddem.mesh.box(0.043, 0.093, 0.057, 0.107)})

	# irregular, finer towards a hole, with an exact border between the materials
	mesh = ddem.mesh.polygon(
		ddem.mesh.box(0, 0, 0.1, 0.2),
		holes=[ddem.mesh.disc(0.05, 0.15, 0.01, 48)],
		size=lambda x, y: 0.001 + 0.2 * max(0, math.hypot(x - 0.05, y - 0.15) - 0.01),
		regions={"steel": ddem.mesh.box(0.043, 0.043, 0.057, 0.057)},
	)
	print(mesh.quality())

	# Gmsh, VTK, Abaqus and whatever else meshio reads; physical groups and element sets become regions
	mesh = ddem.mesh.read("plate.msh", length_unit="mm")
"""
from .files import read
from .generate import polygon, rectangle
from .outline import box, disc
from .quality import Quality
from .triangles import Mesh

__all__ = ["Mesh", "Quality", "box", "disc", "polygon", "read", "rectangle"]
