# GPL v2 or later, see LICENSE.
"""A sample of deformable triangles: its bodies in the scene, and whole-sample arrays of its state."""
import math
import numbers

import numpy as np

from yade import Body, ConcreteDamageMat, DeformableElastMat, DeformableEngine, DeformableNode, DeformableTriangle, O, Vector3, Vector3i

from . import crackband, provenance


def append(mesh, materials, seed=None, thickness=1.0, spread=0.8, floor=0.2, position=(0, 0, 0), crack_band=None):
	"""Append the mesh to the scene as nodes and deformable triangles.

	:param mesh: a :class:`mesh.Mesh`; it is checked and renumbered for memory locality first (see :attr:`Block.mesh`).
	:param materials: a material or its label, or a dict from region name to either; region "" is the rest. Materials must be in O.materials.
	:param seed: draws the fracture energy of every concrete triangle from a normal distribution with mean G_f of its material, standard deviation
		*spread* G_f, not below *floor* G_f (Zubelewicz 2018, section 4.3). None: all have the material's G_f.
	:param thickness: of the plane-strain slice [m].
	:param position: offset added to the mesh's coordinates [m].
	:param crack_band: width [m] of a triangle for which its fracture energy per volume holds; once flow has localised, others get as much more or less as makes the
		energy of a crack per area the same (see :mod:`crackband`, with its limits). None: the fracture energy is per volume, as in the report.
	:returns: :class:`Block`
	:raises ValueError: bad mesh (naming the triangle), region without material, unknown label, material of another kind, thickness, seed, spread, floor, position or
		crack_band out of range. Nothing is appended then.
	"""
	mesh.validate()
	mesh = mesh.reordered()
	by_region = _materials_by_region(mesh, materials)
	if not 0 < thickness < math.inf:
		raise ValueError(f"thickness = {thickness} m must be positive and finite")
	energies = _fracture_energies(mesh, by_region, seed, spread, floor)
	provenance.note_seed(seed)
	bands = np.ones(len(mesh.triangles)) if crack_band is None else crackband.factors(mesh.areas, crack_band)
	offset = np.asarray(position, float)
	if offset.shape != (3, ) or not np.isfinite(offset).all():
		raise ValueError(f"position = {position} must be three finite numbers [m]")

	nodes = []
	for x, y in mesh.nodes:
		nodes.append(_body(DeformableNode(), Vector3(x + offset[0], y + offset[1], offset[2]), "zXYZ"))
	node_ids = np.array(O.bodies.append(nodes), dtype=int)
	triangles = []
	centres = mesh.nodes[mesh.triangles].mean(axis=1)
	for triangle, centre, region, energy, band in zip(mesh.triangles, centres, mesh.regions, energies, bands.tolist()):
		shape = DeformableTriangle(nodes=Vector3i(*(int(node_ids[v]) for v in triangle)), thickness=thickness, fractureEnergy=energy, bandFactor=band)
		body = _body(shape, Vector3(centre[0] + offset[0], centre[1] + offset[1], offset[2]), "zXY")
		body.material = by_region[region]
		triangles.append(body)
	return Block(mesh, node_ids, np.array(O.bodies.append(triangles), dtype=int), thickness)


def time_step(safety=0.8):
	"""A stable time step [s] for the deformable triangles of the scene: *safety* times the rigorous bound of :yref:`DeformableEngine.criticalTimeStep`.

	Works before O.engines is set (then with a DeformableEngine's defaults). The bound follows from the largest frequency of the stiffest element alone, so it needs no
	safety against the mesh; the rest below 1 is for stress stiffening and for accuracy.
	"""
	if not 0 < safety <= 1:
		raise ValueError(f"safety = {safety} must lie between 0 and 1, the share of the critical time step to use")
	engines = [e for e in O.engines if isinstance(e, DeformableEngine)]
	return safety * (_engine().criticalTimeStep() if engines else DeformableEngine().timeStepOfScene())


class Block:
	"""Deformable triangles appended together, and their state as arrays.

	Arrays have a row per node or triangle in the order of :attr:`node_ids` and :attr:`triangle_ids`, which is that of :attr:`mesh`. Kinematic arrays are views of the
	engine's memory (no copy, always current); the others are computed when asked for.
	"""

	def __init__(self, mesh, node_ids, triangle_ids, thickness):
		self.mesh = mesh  #: the mesh as appended, renumbered
		self.node_ids = node_ids  #: body ids of the nodes
		self.triangle_ids = triangle_ids  #: body ids of the triangles
		self.thickness = thickness  #: [m]

	# --- whole-sample state
	@property
	def positions(self):
		"""Positions of the nodes (n, 2) [m]."""
		return self._nodes("nodePosition")

	@property
	def displacements(self):
		"""Displacements of the nodes since the start (n, 2) [m]."""
		return self.positions - self.reference_positions

	@property
	def reference_positions(self):
		"""Stress-free positions of the nodes (n, 2) [m]."""
		origin = O.bodies[int(self.node_ids[0])].state.refPos
		return self.mesh.nodes + (np.array([origin[0], origin[1]]) - self.mesh.nodes[0])

	@property
	def velocities(self):
		"""Velocities of the nodes (n, 2) [m/s]."""
		return self._nodes("nodeVelocity")

	@property
	def node_forces(self):
		"""Internal forces on the nodes in the last step (n, 2) [N]; minus the reaction where a node is held."""
		return self._nodes("nodeForce")

	@property
	def stress(self):
		"""Stress of the sub-elements (m, 3, 4): xx, yy, zz, xy in global axes [Pa]."""
		return self._triangles("stress")

	@property
	def strain(self):
		"""Strain of the sub-elements (m, 3, 4): xx, yy, zz, xy in global axes [-]."""
		return self._triangles("strain")

	@property
	def plastic_strain(self):
		"""Plastic strain of the sub-elements (m, 3, 4) [-]."""
		return self._triangles("plasticStrain")

	@property
	def sub_element_damage(self):
		"""Damage η/η_max of the sub-elements (m, 3) [-]."""
		return self._triangles("damage")

	@property
	def damage(self):
		"""Damage η/η_max of the triangles (m,) [-], mean of their sub-elements."""
		return self.sub_element_damage.mean(axis=1)

	@property
	def rotation(self):
		"""Rotation of the triangles (m,) [rad], counter-clockwise."""
		return self._triangles("rotation")

	@property
	def area(self):
		"""Reference area of the triangles (m,) [m²]."""
		return self._triangles("area")

	@property
	def degrees_of_freedom(self):
		"""Unknowns of the sample: two per node, two per core, and one rotation per core where cores rotate."""
		per_core = 3 if _engine().rotation == "cosserat" else 2
		return 2 * len(self.node_ids) + per_core * len(self.triangle_ids)

	# --- boundary conditions
	def boundary(self, side):
		"""Body ids of the nodes on a side ("top", "bottom", "left", "right") or where ``side(x, y)`` is true."""
		return self.node_ids[self.mesh.boundary(side)]

	def hold(self, ids, dofs="xy"):
		"""Hold the nodes with these body ids in the directions *dofs* ("x", "y" or "xy"); their velocity then stays as prescribed (0 unless set)."""
		for i in ids:
			state = O.bodies[int(i)].state
			state.blockedDOFs = "".join(sorted(set(state.blockedDOFs) | set(dofs)))

	def drive(self, ids, velocity):
		"""Prescribe the velocity (vx, vy) [m/s] of these nodes, None leaves a direction free; they are held in the prescribed directions."""
		for axis, value in enumerate(velocity):
			if value is None:
				continue
			self.hold(ids, "xy"[axis])
			for i in ids:
				O.bodies[int(i)].state.vel[axis] = value

	# --- pictures
	def plot(self, quantity, file=None, deformed=1.0, **options):
		"""Draw a quantity of the triangles over the deformed sample: "damage", "rotation", "region", or an array with a value per triangle; see :func:`plots.field`."""
		from . import plots
		labels = {"damage": "damage η/η_max [-]", "rotation": "rotation [rad]", "region": "region"}
		if isinstance(quantity, str):
			if quantity not in labels:
				raise ValueError(f"plot('{quantity}') is unknown; there are {', '.join(labels)}, or give an array with a value per triangle")
			values = self.mesh.regions if quantity == "region" else getattr(self, quantity)
			options.setdefault("label", labels[quantity])
		else:
			values = np.asarray(quantity, float)
		shape = self.reference_positions + deformed * self.displacements
		return plots.field((shape, self.mesh.triangles), values, file=file, **options)

	def _nodes(self, name):
		engine = _engine()
		return engine.array(name)[_rows(engine.values("nodeIds"), self.node_ids)]

	def _triangles(self, name):
		engine = _engine()
		return engine.values(name)[_rows(engine.values("triangleIds"), self.triangle_ids)]


def _rows(all_ids, ids):
	"""Where a block's bodies stand in the engine's arrays; they were appended together, so they stand together."""
	first = np.searchsorted(all_ids, ids[0])
	rows = slice(first, first + len(ids))
	if not np.array_equal(all_ids[rows], ids):
		raise RuntimeError(f"the bodies {ids[0]} to {ids[-1]} of this block are not in the present scene; append the mesh again after O.reset()")
	return rows


def _engine():
	engines = [e for e in O.engines if isinstance(e, DeformableEngine)]
	if len(engines) == 1:
		return engines[0]
	raise RuntimeError(f"O.engines has {len(engines)} DeformableEngine where one is needed: it keeps and moves the deformable triangles")


def _body(shape, position, blocked):
	body = Body()
	body.shape = shape
	body.state.pos = body.state.refPos = position
	body.state.blockedDOFs = blocked
	return body


def _materials_by_region(mesh, materials):
	if not isinstance(materials, dict):
		materials = {name: materials for name in mesh.region_names}
	unknown = set(materials) - set(mesh.region_names)
	if unknown:
		raise ValueError(f"materials name region {sorted(unknown)}, which the mesh does not have; its regions are {list(mesh.region_names)}")
	found = []
	for index, name in enumerate(mesh.region_names):
		if name not in materials:
			if (mesh.regions == index).any():
				raise ValueError(f"region '{name}' of the mesh has no material; give materials={{'{name}': label, …}}")
			found.append(None)
			continue
		material = materials[name]
		if isinstance(material, (str, int)):
			try:
				material = O.materials[material]
			except (KeyError, IndexError):
				raise ValueError(f"region '{name}': O.materials has no material '{material}'; append it first") from None
		if not isinstance(material, DeformableElastMat):
			raise ValueError(f"region '{name}': deformable triangles need a DeformableElastMat or ConcreteDamageMat, not {type(material).__name__}")
		if material.id < 0:
			raise ValueError(f"region '{name}': the {type(material).__name__} '{material.label}' is not in O.materials; append it first")
		found.append(material)
	return found


def _fracture_energies(mesh, by_region, seed, spread, floor):
	factors = np.ones(len(mesh.triangles))
	if seed is not None:
		if not isinstance(seed, numbers.Integral) or seed < 0:
			raise ValueError(f"seed = {seed!r} must be a whole number, 0 or more (or None: every triangle has its material's fracture energy)")
		if not 0 <= spread < math.inf or not 0 < floor <= 1:
			raise ValueError(f"spread = {spread} must be finite and not negative and floor = {floor} must lie in (0, 1], both as shares of the mean fracture energy")
		factors *= np.maximum(np.random.default_rng(seed).normal(1.0, spread, len(factors)), floor)
	energies = np.full(len(mesh.triangles), -1.0)  # the material's own
	if seed is None:
		return energies.tolist()
	for index, material in enumerate(by_region):
		if isinstance(material, ConcreteDamageMat):
			where = mesh.regions == index
			energies[where] = material.fractureEnergy * factors[where]
	return energies.tolist()
