# GPL v2 or later, see LICENSE.
"""A sample of deformable triangles: its bodies in the scene, and whole-sample arrays of its state."""
import math
import numbers
import threading

import numpy as np

from yade import Body, DeformableElastMat, DeformableEngine, DeformableNode, DeformableTriangle, O, Vector3, Vector3i

from . import crackband, initial_stress as initial_stresses, mesh, meter, provenance
from .arrays import BodyIds, fixed
from .field import Field


@meter.makes_particles
def append(
	mesh, materials, seed=None, thickness=1.0, spread=0.8, floor=0.2, position=(0, 0, 0), crack_band=None,
	initial_stress=None
):
	"""Append the mesh to the scene as nodes and deformable triangles.

	:param mesh: a :class:`mesh.Mesh`; it is checked and renumbered for memory locality first
		(see :attr:`Block.mesh`).
	:param materials: a material or its label, or a dict from region name to either; region "" is the rest.
		Materials must be in O.materials.
	:param seed: draws the fracture energy of every concrete triangle from a normal distribution with mean G_f of
		its material, standard deviation *spread* G_f, not below *floor* G_f (Zubelewicz 2018, section 4.3).
		None: all have the material's G_f. What is drawn is a triangle's own for good: a later change of the
		material's G_f does not reach it.
	:param thickness: of the plane-strain slice [m].
	:param position: offset added to the mesh's coordinates [m].
	:param crack_band: width [m] of a triangle for which its fracture energy per volume holds; once flow has
		localised, others get as much more or less as makes the energy of a crack per area the same (see
		:mod:`crackband`, with its limits). None: the fracture energy is per volume, as in the report.
	:param initial_stress: stress (xx, yy, xy) or (xx, yy, xy, zz) [Pa] where the block is not strained, tension
		positive, or a function that turns arrays x, y [m] of the mesh's coordinates into these (numbers or
		arrays). zz is that of plane strain where it is left out. The law takes it for its own
		(see :mod:`initial_stress`);
		what it is in equilibrium with is up to the scene.
	:returns: :class:`Block`
	:raises ValueError: bad mesh (naming the triangle), region without material, unknown label, material of another
		kind, thickness, seed, spread, floor, position, initial_stress or crack_band out of range, or a
		crack_band where no material has a fracture energy. Nothing is appended then.
	"""
	mesh.validate()
	mesh = mesh.reordered()
	by_region = _materials_by_region(mesh, materials)
	if not 0 < thickness < math.inf:
		raise ValueError(f"thickness = {thickness} m must be positive and finite")
	energies = _fracture_energies(mesh, by_region, seed, spread, floor)
	provenance.note_seed(seed)
	bands = np.ones(len(mesh.triangles)) if crack_band is None else crackband.factors(mesh.areas, crack_band)
	if crack_band is not None and not any(hasattr(material, "fractureEnergy") for material in by_region):
		kinds = ", ".join(sorted({type(material).__name__ for material in by_region if material}))
		raise ValueError(
			f"crack_band = {crack_band} m scales a fracture energy, and {kinds} has none: leave crack_band "
			"out, or give a region a material that breaks, such as ConcreteDamageMat"
		)
	offset = np.asarray(position, float)
	if offset.shape != (3, ) or not np.isfinite(offset).all():
		raise ValueError(f"position = {position} must be three finite numbers [m]")

	stresses = initial_stresses.of_triangles(mesh, by_region, initial_stress)

	nodes = []
	for x, y in mesh.nodes:
		nodes.append(_body(DeformableNode(), Vector3(x + offset[0], y + offset[1], offset[2]), "zXYZ"))
	# one by one: bodies that YADE takes as a list are never freed
	node_ids = [O.bodies.append(node) for node in nodes]
	triangles = []
	centres = mesh.nodes[mesh.triangles].mean(axis=1)
	for triangle, centre, region, energy, band, stress in zip(
		mesh.triangles.tolist(), centres, mesh.regions, energies, bands.tolist(), stresses
	):
		shape = DeformableTriangle(
			nodes=Vector3i(*(node_ids[v] for v in triangle)), thickness=thickness, fractureEnergy=energy,
			bandFactor=band, **({"initialStress": stress} if stress else {})
		)
		body = _body(shape, Vector3(centre[0] + offset[0], centre[1] + offset[1], offset[2]), "zXY")
		body.material = by_region[region]
		triangles.append(body)
	return Block(mesh, node_ids, [O.bodies.append(triangle) for triangle in triangles], thickness)


def time_step(safety=0.8):
	"""A stable time step [s] for the deformable triangles of the scene: *safety* times the rigorous bound of
	:yref:`DeformableEngine.criticalTimeStep`.

	Works before O.engines is set (then with a DeformableEngine's defaults). The bound follows from the largest
	frequency of the stiffest element alone, so it needs no safety against the mesh;
	the rest below 1 is for stress stiffening and for accuracy.
	"""
	if not 0 < safety <= 1:
		raise ValueError(
			f"safety = {safety} must lie between 0 and 1, the share of the critical time step to use"
		)
	engines = [e for e in O.engines if isinstance(e, DeformableEngine)]
	return safety * (
		min(e.criticalTimeStep() for e in engines) if engines else DeformableEngine().timeStepOfScene()
	)


class Block:
	"""Deformable triangles appended together, and their state as arrays.

	Arrays have a row per node or triangle in the order of :attr:`node_ids` and :attr:`triangle_ids`, which is that
	of :attr:`mesh`. They cannot be written to: what can be set has a setter (:attr:`velocity`, :attr:`spin`,
	:attr:`velocities`), or is set in the State of the bodies. Kinematic arrays may be views of the engine's memory,
	which change as a run goes on: keep a copy, not the array, of what is to be compared later. The others are
	computed when asked for.

	Positions, displacements and velocities can be read before O.engines is set; stresses, strains, damage,
	rotations and forces need the engine that computes them.

	:raises RuntimeError: a quantity needs a DeformableEngine and O.engines has none, or the bodies are not in the
		present scene.
	"""

	def __init__(self, mesh, node_ids, triangle_ids, thickness):
		self.mesh = mesh  #: the mesh as appended, renumbered
		self.node_ids = BodyIds(node_ids)  #: body ids of the nodes, see :class:`arrays.BodyIds`
		self.triangle_ids = BodyIds(triangle_ids)  #: body ids of the triangles
		self.thickness = thickness  #: [m]
		self._found = {}  # rows in an engine's arrays, by what these were

	@classmethod
	def from_scene(cls, ids=None):
		"""The block in the current scene, for a scene that was loaded.

		Its mesh is that of the stress-free positions, in the order of the bodies' ids; where there are several
		materials, each is a region of the name of its label.

		:param ids: body ids of its triangles; None: all deformable triangles together.
		:raises RuntimeError: the scene has no deformable triangles
		:raises ValueError: an id that is no deformable triangle, or triangles of different thickness
		"""
		if ids is None:
			ids = [b.id for b in O.bodies if b and isinstance(b.shape, DeformableTriangle)]
			if not ids:
				raise RuntimeError("the scene has no deformable triangles")
		ids = np.unique(np.asarray(ids, int))
		bodies = [O.bodies[i] if 0 <= i < len(O.bodies) else None for i in ids.tolist()]
		for i, body in zip(ids.tolist(), bodies):
			if body is None or not isinstance(body.shape, DeformableTriangle):
				raise ValueError(f"body {i} is no deformable triangle")
		thickness = {body.shape.thickness for body in bodies}
		if len(thickness) > 1:
			raise ValueError(
				f"triangles are {min(thickness)} to {max(thickness)} m thick: give the ids of those "
				"of one block"
			)
		corners = np.array([list(body.shape.nodes) for body in bodies])
		node_ids, triangles = np.unique(corners, return_inverse=True)
		nodes = [O.bodies[i].state.refPos for i in node_ids.tolist()]
		labels = [body.mat.label or f"material {body.mat.id}" for body in bodies]
		names = list(dict.fromkeys(labels))
		regions = [names.index(label) + 1 for label in labels] if len(names) > 1 else None
		made = mesh.Mesh(
			[(x, y) for x, y, _ in nodes], triangles.reshape(corners.shape), regions,
			("", *names) if len(names) > 1 else ("", )
		)
		return cls(made, node_ids, ids, thickness.pop())

	# --- motion
	@property
	def positions(self):
		"""Positions of the nodes (n, 2) [m]."""
		return self._points("node", "Position")

	@property
	def displacements(self):
		"""Displacements of the nodes since the start (n, 2) [m]."""
		return fixed(self.positions - self.reference_positions)

	@property
	def reference_positions(self):
		"""Stress-free positions of the nodes (n, 2) [m]."""
		origin = _bodies(self.node_ids[[0, -1]], DeformableNode)[0].state.refPos
		return fixed(self.mesh.nodes + (np.array([origin[0], origin[1]]) - self.mesh.nodes[0]))

	@property
	def velocities(self):
		"""Velocities of the nodes (n, 2) [m/s].

		Set them, before the first step or between runs, with an array or one pair for all: ``block.velocities =
		field``. The cores then take the velocity and the spin that the linear field of their corners has where
		they are, because the nodes alone hold a small share of the mass (a sixth by default). Held nodes are
		told their velocity as well, which prescribes it. ``block.velocities[:] = …`` is refused by numpy: the
		array is no place to write to.

		:raises ValueError: values of another shape, or not finite.
		:raises RuntimeError: a run is going on.
		"""
		return self._points("node", "Velocity")

	@velocities.setter
	def velocities(self, values):
		nodes = np.array(values, float)
		if nodes.shape not in ((2,), (len(self.node_ids), 2)) or not np.isfinite(nodes).all():
			bad = np.count_nonzero(~np.isfinite(nodes))
			raise ValueError(
				"velocities must be finite numbers [m/s]: one pair (vx, vy) for all nodes or an array "
				f"({len(self.node_ids)}, 2), not an array of shape {nodes.shape} with {bad} values "
				"that are not finite"
			)
		nodes = np.broadcast_to(nodes, (len(self.node_ids), 2))
		corners, v = self.positions[self.mesh.triangles], nodes[self.mesh.triangles]
		edges, change = corners[:, 1:] - corners[:, :1], v[:, 1:] - v[:, :1]
		gradient = np.linalg.solve(edges, change)  # rows: derivatives along x and y
		arm = self._points("core", "Position") - corners.mean(axis=1)
		cores = v.mean(axis=1) + np.einsum("ti,tij->tj", arm, gradient)
		self._set_motion(nodes, cores, 0.5 * (gradient[:, 0, 1] - gradient[:, 1, 0]), held_too=True)

	@property
	def core_positions(self):
		"""Positions of the triangles' cores (m, 2) [m]."""
		return self._points("core", "Position")

	@property
	def core_velocities(self):
		"""Velocities of the triangles' cores (m, 2) [m/s]."""
		return self._points("core", "Velocity")

	@property
	def velocity(self):
		"""Velocity (vx, vy) of the centre of mass [m/s]: the mean over nodes and cores, weighted with their
		masses.

		Set it, before O.engines or between runs, to throw a block: ``block.velocity = (10, 0)``. Nodes and
		cores then move as one rigid body with this velocity and the :attr:`spin` that they had; motion within
		the block ends. Directions that are held keep the velocity prescribed there.

		:raises ValueError: not two finite numbers.
		:raises RuntimeError: a run is going on.
		"""
		return fixed(self._motion()[0])

	@velocity.setter
	def velocity(self, value):
		velocity = np.array(value, float)
		if velocity.shape != (2,) or not np.isfinite(velocity).all():
			raise ValueError(
				f"velocity = {value!r} must be two finite numbers (vx, vy) [m/s]; a velocity for each "
				"node goes to block.velocities"
			)
		self._move_rigidly(velocity, None)

	@property
	def spin(self):
		"""Rate of rotation about the centre of mass [rad/s], counter-clockwise: angular momentum over moment of
		inertia.

		Set it, before O.engines or between runs: nodes and cores then move as one rigid body that turns at this
		rate about the centre of mass, which keeps its :attr:`velocity`; cores turn with it. Motion within the
		block ends. Directions that are held keep the velocity prescribed there.

		:raises ValueError: not a finite number.
		:raises RuntimeError: a run is going on.
		"""
		return self._motion()[1]

	@spin.setter
	def spin(self, value):
		if not isinstance(value, numbers.Real) or not math.isfinite(value):
			raise ValueError(f"spin = {value!r} must be a finite number [rad/s], counter-clockwise")
		self._move_rigidly(None, float(value))

	# --- what the engine computes
	@property
	def node_forces(self):
		"""Internal forces on the nodes in the last step (n, 2) [N]; minus the reaction where a node is held."""
		engine = self._engine("node_forces")
		return fixed(engine.array("nodeForce")[self._rows(engine, "node")])

	@property
	def reactions(self):
		"""Forces that hold the nodes (n, 2) [N], against all others of the last step: internal ones, loads on
		edges and nodes, weight; zero in directions in which a node is free.
		"""
		return self._of_nodes("reactions", "reaction")

	@property
	def stress(self):
		"""Stress of the sub-elements (m, 3, 4): xx, yy, zz, xy in global axes [Pa]."""
		return self._values("stress", "stress")

	@property
	def strain(self):
		"""Strain of the sub-elements (m, 3, 4): xx, yy, zz, xy in global axes [-]."""
		return self._values("strain", "strain")

	@property
	def plastic_strain(self):
		"""Plastic strain of the sub-elements (m, 3, 4) [-]."""
		return self._values("plastic_strain", "plasticStrain")

	@property
	def sub_element_damage(self):
		"""Damage η/η_max of the sub-elements (m, 3) [-]."""
		return self._values("sub_element_damage", "damage")

	@property
	def damage(self):
		"""Damage η/η_max of the triangles (m,) [-], mean of their sub-elements."""
		engine = self._engine("damage")
		rows = self._rows(engine, "core")
		return Field(engine.values("damage")[rows].mean(axis=1), engine.values("tilePlace")[rows])

	def field(self, name):
		"""What the laws of the triangles remember, by its name (:yref:`DeformableEngine.fields`): (m, 3),
		or (m, 3, 4) in global axes for tensors; zero where a triangle's law has no such field.

		:raises ValueError: a name that no law of the sample has (naming those there are).
		"""
		return self._values(f"field('{name}')", name)

	@property
	def fields(self):
		"""Names of what the laws of the engine's triangles remember, with unit and components:
		a list of tuples."""
		return self._engine("fields").fields()

	@property
	def rotation(self):
		"""Rotation of the triangles (m,) [rad], counter-clockwise."""
		return self._values("rotation", "rotation")

	@property
	def area(self):
		"""Reference area of the triangles (m,) [m²]."""
		return self._values("area", "area") if self._engine_if_any() else self.mesh.areas

	@property
	def degrees_of_freedom(self):
		"""Unknowns of the sample: two per node, two per core, and one rotation per core where cores rotate (as
		they do unless O.engines says otherwise).
		"""
		per_core = 3 if self._settings().rotation == "cosserat" else 2
		return 2 * len(self.node_ids) + per_core * len(self.triangle_ids)

	# --- boundary conditions
	def boundary(self, side):
		"""Body ids of the border's nodes on a side ("top", "bottom", "left", "right"), or where ``side(x, y)``
		is true, x and y being arrays of the mesh's coordinates [m].

		:raises ValueError: the sample has no such side or no such node, see :meth:`mesh.Mesh.boundary`.
		"""
		return self.node_ids[self.mesh.boundary(side)]

	def edges(self, side=None):
		"""Pairs (b, 2) of body ids of the edges of the border whose two nodes both are on a side, as
		:meth:`boundary` takes it; all when left out. The block lies on the left of the way from the first to
		the second.

		:raises ValueError: no such side or node, see :meth:`mesh.Mesh.boundary`; no edge joins the nodes.
		"""
		edges = self.mesh.border_between(self.mesh.boundary(side))
		if not len(edges):
			raise ValueError(
				f"edges({side!r}): no edge of the border joins two of the nodes there; name whole edges"
			)
		return self.node_ids[edges]

	def hold(self, ids, dofs="xy"):
		"""Hold the nodes with these body ids in the directions *dofs* ("x", "y" or "xy"); their velocity then
		stays as prescribed (0 unless set)."""
		for i in np.atleast_1d(BodyIds(ids)):
			state = O.bodies[i].state
			state.blockedDOFs = "".join(sorted(set(state.blockedDOFs) | set(dofs)))

	def release(self, ids, dofs="xy"):
		"""Let go of the nodes with these body ids in the directions *dofs* ("x", "y" or "xy"); their velocity
		stays what it is."""
		for i in np.atleast_1d(BodyIds(ids)):
			state = O.bodies[i].state
			state.blockedDOFs = "".join(sorted(set(state.blockedDOFs) - set(dofs)))

	def drive(self, ids, velocity):
		"""Prescribe the velocity (vx, vy) [m/s] of these nodes, None leaves a direction free;
		they are held in the prescribed directions."""
		for axis, value in enumerate(velocity):
			if value is None:
				continue
			self.hold(ids, "xy"[axis])
			for i in np.atleast_1d(BodyIds(ids)):
				O.bodies[i].state.vel[axis] = value

	# --- pictures
	def plot(self, quantity, file=None, deformed=1.0, **options):
		"""Draw a quantity of the triangles over the deformed sample: "damage", "rotation", "region", or an
		array with a value per triangle; see :func:`plots.field`."""
		from . import plots
		labels = {"damage": "damage η/η_max [-]", "rotation": "rotation [rad]", "region": "region"}
		if isinstance(quantity, str):
			if quantity not in labels:
				raise ValueError(
					f"plot('{quantity}') is unknown; there are {', '.join(labels)}, or give an "
					"array with a value per triangle"
				)
			values = self.mesh.regions if quantity == "region" else getattr(self, quantity)
			options.setdefault("label", labels[quantity])
		else:
			values = np.asarray(quantity, float)
		shape = self.reference_positions + deformed * self.displacements
		return plots.field((shape, self.mesh.triangles), values, file=file, **options)

	# --- within
	def _points(self, kind, quantity):
		"""Position or velocity of nodes or cores (n, 2), from the engine, or from State where there is none."""
		engine = self._engine_if_any()
		if engine:
			return fixed(engine.array(kind + quantity)[self._rows(engine, kind)])
		bodies = self._nodes() if kind == "node" else self._triangles()
		attribute = {"Position": "pos", "Velocity": "vel"}[quantity]
		return fixed(np.array([getattr(body.state, attribute) for body in bodies])[:, :2])

	def _values(self, name, value):
		"""What the engine computes of the triangles; the name is that of the block's property."""
		engine = self._engine(name)
		rows = self._rows(engine, "core")
		return Field(engine.values(value)[rows], engine.values("tilePlace")[rows])

	def _of_nodes(self, name, value):
		"""What the engine computes of the nodes; the name is that of the block's property."""
		engine = self._engine(name)
		return fixed(engine.values(value)[self._rows(engine, "node")])

	def _engine_if_any(self):
		"""The engine of these triangles, None where O.engines has none."""
		return self._engine() if any(isinstance(e, DeformableEngine) for e in O.engines) else None

	def _settings(self):
		"""The engine of these triangles, or one with the defaults."""
		return self._engine_if_any() or DeformableEngine()

	def _engine(self, wanted=None):
		return _engine(wanted, self.triangle_ids[0])

	def _rows(self, engine, kind):
		"""Where the nodes or cores stand in the engine's arrays."""
		name, own = ("nodeIds", self.node_ids) if kind == "node" else ("triangleIds", self.triangle_ids)
		all_ids = engine.values(name)
		before, rows = self._found.get(name, (None, None))
		if before is None or not np.array_equal(before, all_ids):  # looking for them takes ten times as long
			rows = _rows(all_ids, np.asarray(own))
			self._found[name] = all_ids, rows
		return rows

	def _nodes(self):
		return _bodies(self.node_ids, DeformableNode)

	def _triangles(self):
		return _bodies(self.triangle_ids, DeformableTriangle)

	def _masses(self):
		"""Masses of nodes and cores [kg]."""
		engine = self._engine_if_any()
		if engine:
			return tuple(engine.array(kind + "Mass")[self._rows(engine, kind)] for kind in ("node", "core"))
		density = np.array([body.material.density for body in self._triangles()])
		mass, share = density * self.thickness * self.mesh.areas, DeformableEngine().vertexShare
		corners = np.bincount(self.mesh.triangles.ravel(), np.repeat(share / 3 * mass, 3), len(self.node_ids))
		return corners, (1 - share) * mass

	def _motion(self, free_only=False):
		"""Velocity [m/s] of the centre of mass, spin [rad/s], centre and points [m]: the rigid motion that has
		the momenta of nodes and cores.

		:param free_only: look only at those that nobody holds; where all are held they are taken to be at rest
		"""
		masses = self._masses()
		mass, inertia, spins = np.concatenate(masses), *self._spins(masses[1])
		points = np.vstack([self._points(kind, "Position") for kind in ("node", "core")])
		velocities = np.vstack([self._points(kind, "Velocity") for kind in ("node", "core")])
		centre = (mass[:, None] * points).sum(axis=0) / mass.sum()
		if free_only:
			held = [body.state.blockedDOFs for body in self._nodes() + self._triangles()]
			mass = np.where([bool(set(dofs) & set("xy")) for dofs in held], 0.0, mass)
			inertia = np.where(["Z" in dofs for dofs in held[len(self.node_ids):]], 0.0, inertia)
			if not mass.any():
				return np.zeros(2), 0.0, centre, points
		middle = (mass[:, None] * points).sum(axis=0) / mass.sum()
		velocity = (mass[:, None] * velocities).sum(axis=0) / mass.sum()
		arm = points - middle
		momentum = (mass * (_across(arm) * (velocities - velocity)).sum(axis=1)).sum() + (inertia * spins).sum()
		resistance = (mass * (arm**2).sum(axis=1)).sum() + inertia.sum()
		spin = float(momentum / resistance) if resistance > 0 else 0.0  # 0 for a single point without inertia
		return velocity + spin * _across(centre - middle), spin, centre, points

	def _spins(self, core_masses):
		"""Moments of inertia about their centre [kg·m²] and spins [rad/s] of the cores; without inertia where
		they do not rotate.
		"""
		settings = self._settings()
		if settings.rotation != "cosserat":
			return np.zeros(len(core_masses)), np.zeros(len(core_masses))
		# the core has what the rigid triangle has more than its corners: m Σ|r|²/12 - (α m/3) Σ|r|²
		share = settings.vertexShare
		arms = ((self.mesh.nodes[self.mesh.triangles] - self.mesh.centroids[:, None])**2).sum(axis=(1, 2))
		inertia = core_masses / (1 - share) * arms * (1 / 12 - share / 3)
		if self._engine_if_any():
			return inertia, settings.array("coreSpin")[self._rows(settings, "core")]
		return inertia, np.array([body.state.angVel[2] for body in self._triangles()])

	def _move_rigidly(self, velocity, spin):
		"""Give the whole a velocity and a spin; None: what its free part has."""
		own_velocity, own_spin, centre, points = self._motion(free_only=True)
		velocity, spin = own_velocity if velocity is None else velocity, own_spin if spin is None else spin
		nodes, cores = np.split(velocity + spin * _across(points - centre), [len(self.node_ids)])
		self._set_motion(nodes, cores, np.full(len(cores), spin), held_too=False)

	def _set_motion(self, nodes, cores, spins, held_too):
		"""Write velocities and spins into State, where engines and everybody else read them; held directions
		only if *held_too*.
		"""
		if O.running and threading.current_thread() is threading.main_thread():
			raise RuntimeError(
				"a run is going on, which would overwrite velocities that are set now: O.pause() or "
				"O.wait() first, or set them in a PyRunner"
			)
		turns = np.concatenate([np.zeros(len(nodes)), spins]).tolist()
		velocities = np.vstack([nodes, cores]).tolist()
		for body, (x, y), turn in zip(self._nodes() + self._triangles(), velocities, turns):
			state = body.state
			held, old = "" if held_too else state.blockedDOFs, state.vel
			state.vel = Vector3(old[0] if "x" in held else x, old[1] if "y" in held else y, old[2])
			if "Z" not in held:
				state.angVel = Vector3(0, 0, turn)


def _across(arms):
	"""Velocities (…, 2) at these arms for a spin of 1 rad/s."""
	return np.stack([-arms[..., 1], arms[..., 0]], axis=-1)


def _rows(all_ids, ids):
	"""Where the bodies with these ids stand in an engine's arrays: a slice if they stand together (then numpy
	copies nothing), else row numbers.
	"""
	order = np.argsort(all_ids, kind="stable")
	places = np.minimum(np.searchsorted(all_ids, ids, sorter=order), len(all_ids) - 1)
	rows = order[places]
	if not np.array_equal(all_ids[rows], ids):
		missing = ids[int(np.flatnonzero(all_ids[rows] != ids)[0])]
		raise RuntimeError(_gone(missing))
	return slice(rows[0], rows[-1] + 1) if (np.diff(rows) == 1).all() else rows


def _bodies(ids, shape):
	"""The bodies with these ids, which must be of this shape."""
	found, there = [], len(O.bodies)
	for i in ids:
		body = O.bodies[i] if i < there else None
		if body is None or not isinstance(body.shape, shape):
			raise RuntimeError(_gone(i))
		found.append(body)
	return found


def _gone(missing):
	return f"body {missing} of this block is not in the present scene; append the mesh again after O.reset()"


def _engine(wanted=None, triangle=None):
	"""The DeformableEngine in O.engines, where there are several that of a triangle."""
	engines = [e for e in O.engines if isinstance(e, DeformableEngine)]
	if len(engines) == 1:
		return engines[0]
	for engine in engines:
		if triangle is not None and (engine.values("triangleIds") == triangle).any():
			return engine
	if engines:
		what = f"triangle {triangle} belongs to none of them" if triangle is not None else "say which by block"
		raise RuntimeError(f"O.engines has {len(engines)} DeformableEngine, and {what}")
	what = f"block.{wanted} is computed" if wanted else "deformable triangles are computed and moved"
	raise RuntimeError(
		f"{what} by a DeformableEngine, and O.engines has none yet: set O.engines = [ForceResetter(), …, "
		"DeformableEngine()] first (positions, displacements and velocities of a block can be read without)"
	)


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
		raise ValueError(
			f"materials name region {sorted(unknown)}, which the mesh does not have; its regions are "
			f"{list(mesh.region_names)}"
		)
	found = []
	for index, name in enumerate(mesh.region_names):
		if name not in materials:
			if (mesh.regions == index).any():
				raise ValueError(
					f"region '{name}' of the mesh has no material; give materials={{'{name}': "
					"label, …}"
				)
			found.append(None)
			continue
		material = materials[name]
		if isinstance(material, (str, int)):
			try:
				material = O.materials[material]
			except (KeyError, IndexError):
				raise ValueError(
					f"region '{name}': O.materials has no material '{material}'; append it first"
				) from None
		if not isinstance(material, DeformableElastMat):
			raise ValueError(
				f"region '{name}': deformable triangles need a DeformableElastMat or "
				f"ConcreteDamageMat, not {type(material).__name__}"
			)
		if material.id < 0:
			raise ValueError(
				f"region '{name}': the {type(material).__name__} '{material.label}' is not in "
				"O.materials; append it first"
			)
		found.append(material)
	return found


def _fracture_energies(mesh, by_region, seed, spread, floor):
	factors = np.ones(len(mesh.triangles))
	if seed is not None:
		if not isinstance(seed, numbers.Integral) or seed < 0:
			raise ValueError(
				f"seed = {seed!r} must be a whole number, 0 or more (or None: every triangle has its "
				"material's fracture energy)"
			)
		if not 0 <= spread < math.inf or not 0 < floor <= 1:
			raise ValueError(
				f"spread = {spread} must be finite and not negative and floor = {floor} must lie in "
				"(0, 1], both as shares of the mean fracture energy"
			)
		factors *= np.maximum(np.random.default_rng(seed).normal(1.0, spread, len(factors)), floor)
	energies = np.full(len(mesh.triangles), -1.0)  # the material's own
	if seed is None:
		return energies.tolist()
	for index, material in enumerate(by_region):
		if hasattr(material, "fractureEnergy"):
			where = mesh.regions == index
			energies[where] = material.fractureEnergy * factors[where]
	return energies.tolist()
