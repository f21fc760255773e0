# GPL v2 or later, see LICENSE.
"""Rigid spheres joined by breakable bonds: samples, platens, time step, engines.

Crush a prism of bonded spheres::

	from yade import ddem

	O.materials.append(BondedMat(label="rock"))
	sample = ddem.bonded.append(ddem.packing.prism(0.01, 0.02, 0.01, rmin=0.8e-3, rmax=2e-3, seed=1), "rock")
	platens = ddem.bonded.platens(sample, velocity=0.125, ramp=5e-6)
	O.engines = [
		ForceResetter(),
		InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]),
		BondedInteractionLoop(
			[Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],
			[Ip2_BondedMat_BondedMat_BondedPhys(), Ip2_ElasticWallMat_BondedMat_ElasticWallPhys()],
			[Law2_ScGeom_BondedPhys_MohrCoulomb(), Law2_ScGeom_ElasticWallPhys_Repulsion()],
		),
		*platens.engines,
		ViscousBodyDamping(),
		BondedNewtonIntegrator(damping=0),
	]
	O.dt = ddem.bonded.time_step(0.8)
	O.run(5000, True)
	print(platens.stress, sample.broken_fraction)

:func:`engines` writes that list. SI units; a platen's force, stress and strain are positive in compression.
"""
import math
import warnings

import numpy as np

from yade import (
	Bo1_Box_Aabb, Bo1_Facet_Aabb, Bo1_Sphere_Aabb, Bo1_Wall_Aabb, BondedInteractionLoop, BondedMat,
	BondedNewtonIntegrator, ElasticWallMat, ForceResetter, Ig2_Box_Sphere_ScGeom, Ig2_Facet_Sphere_ScGeom,
	Ig2_Sphere_Sphere_ScGeom, Ig2_Wall_Sphere_ScGeom, InsertionSortCollider, InteractionLoop,
	Ip2_BondedMat_BondedMat_BondedPhys, Ip2_ElasticWallMat_BondedMat_ElasticWallPhys,
	Ip2_FrictMat_BondedMat_BondedPhys, Ip2_FrictMat_FrictMat_FrictPhys, Law2_ScGeom_BondedPhys_MohrCoulomb,
	Law2_ScGeom_ElasticWallPhys_Repulsion, Law2_ScGeom_FrictPhys_CundallStrack, NewtonIntegrator, O,
	RampedTranslationEngine, Sphere, Vector3, ViscousBodyDamping, Wall, utils
)

from . import broken_bonds, meter
from . import packing as packings
from .arrays import BodyIds, fixed

#: gap up to which spheres are bonded, of the largest radius: the tutorial's 0.005 mm for 2 mm
DEFAULT_GAP = 0.0025

_GLUED = 1.1  # distance of a centre from a wall, in radii, up to which it is bonded to it (tutorial of ESyS-Particle)


@meter.makes_particles
def append(packing, material, gap=None, color=None, mass_law="solid"):
	"""Append the spheres of a packing to the scene and bond them, as they are, without load.

	:param packing: :class:`packing.Packing`, or what :func:`packing.of` takes, as YADE's SpherePack. One layer
		(:attr:`packing.Packing.flat`) stays in its plane:
		motion along z and rotation about x and y are blocked.
	:param material: a :yref:`BondedMat` of O.materials, or its label.
	:param gap: spheres whose surfaces are closer than this are bonded [m]. None: the packing's own list of bonds,
		or 0.0025 of the largest radius where it has none.
	:param color: of the spheres, three numbers from 0 to 1.
	:param mass_law: "solid": density times volume, 4/3 pi r³; "cube":
		density times r³, the default of ESyS-Particle (with 1 g/mm³ = 1e6 kg/m³).
	:returns: :class:`BondedSample`; a warning says where it is not in one piece
	:raises ValueError: unknown label or mass law, a material of another kind or with bad parameters, a negative
		gap, nothing to bond. Nothing is appended then.
	"""
	material, packing = _material(material), packings.of(packing)
	if mass_law not in ("solid", "cube"):
		raise ValueError(
			f"mass_law = '{mass_law}' is unknown; use 'solid' (density times 4/3 pi r³) or 'cube' "
			"(density times r³)"
		)
	if gap is not None:
		pairs = packing.neighbours(gap)
	else:
		pairs = (
			packing.bonds
			if packing.bonds is not None
			else packing.neighbours(DEFAULT_GAP * packing.radii.max())
		)
	for i, j in pairs[(packing.centres[pairs[:, 0]] == packing.centres[pairs[:, 1]]).all(axis=1)]:
		raise ValueError(f"spheres {i} and {j} of the packing have the same centre and cannot be bonded")
	if len(pairs) == 0:
		raise ValueError(
			"no two spheres are closer than the gap: nothing would be bonded; give a larger gap [m] (the "
			f"smallest radius is {packing.radii.min()} m)"
		)
	spheres = []
	for centre, radius in zip(packing.centres, packing.radii):
		body = utils.sphere(Vector3(*centre), float(radius), material=material, color=color or (0.6, 0.6, 0.65))
		if mass_law == "cube":
			body.state.mass = material.density * float(radius)**3
			body.state.inertia = Vector3(1, 1, 1) * (0.4 * body.state.mass * float(radius)**2)
		if packing.flat:
			body.state.blockedDOFs = "zXY"
		spheres.append(body)
	# one by one: bodies that YADE takes as a list are never freed, with their bonds 1.5 kB a bond
	ids = BodyIds([O.bodies.append(body) for body in spheres])
	Ip2_BondedMat_BondedMat_BondedPhys().bond([(i, j) for i, j in ids[pairs]])
	_warn_of_pieces(packing, pairs)
	return BondedSample(ids, packing.lower, packing.upper, len(pairs), packing.shape and packing)


def _warn_of_pieces(packing, pairs):
	"""A specimen must hold together; where it does not, its strength would be that of its largest piece."""
	sizes = np.bincount(packing.pieces(pairs))
	if len(sizes) == 1:
		return
	loose = int((sizes == 1).sum())
	warnings.warn(
		(
			f"{len(packing)} spheres with {len(pairs)} bonds, {2 * len(pairs) / len(packing):.1f} "
			f"a sphere, are in {len(sizes)} pieces: {sizes[0]} in the largest, {loose} loose; a larger "
			"gap= or a wider range of radii joins them"
		),
		stacklevel=4,
	)


class BondedSample:
	"""Bonded spheres appended together, and their state as arrays, a row per sphere in the order of :attr:`ids`.
	A sphere that is erased (``O.bodies.erase``) has no row any more.

	The arrays are copies and cannot be written to; velocities and positions are set in the State of the spheres.
	"""

	def __init__(self, ids, lower, upper, bonds, shaped=None):
		self._appended = BodyIds(ids)
		self._shaped = shaped
		#: corners of the box at the start [m]
		self.lower, self.upper = np.array(lower, float), np.array(upper, float)
		self.initial_bonds = bonds  #: number of bonds at the start

	@classmethod
	def from_scene(cls):
		"""The sample in the current scene, all spheres of BondedMat together; for a scene that was loaded."""
		bodies = [b for b in O.bodies if b and isinstance(b.shape, Sphere) and isinstance(b.mat, BondedMat)]
		if not bodies:
			raise RuntimeError("the scene has no spheres of BondedMat")
		start = np.array([b.state.refPos for b in bodies])
		radii = np.array([[b.shape.radius] for b in bodies])
		sample = cls([b.id for b in bodies], (start - radii).min(axis=0), (start + radii).max(axis=0), 0)
		sample.initial_bonds = len(sample.bonds) + len(sample.broken)
		return sample

	@property
	def ids(self):
		"""Body ids of the spheres that are there (n,), see :class:`arrays.BodyIds`."""
		there = BondedInteractionLoop.existing(self._appended)
		return self._appended if len(there) == len(self._appended) else BodyIds(there)

	def __len__(self):
		return len(self.ids)

	@property
	def area(self):
		"""Area of the face across y at the start [m²], which platens load: that of the packing's shape
		(:meth:`packing.Packing.area`), or of its box where it has none.

		:raises ValueError: a shape without a flat face there, as a ball
		"""
		width, _, depth = self.upper - self.lower
		return float(width * depth) if self._shaped is None else self._shaped.area(1)

	@property
	def positions(self):
		"""Centres (n, 3) [m]."""
		return fixed(BondedInteractionLoop.sphereArray(self.ids, "position"))

	@property
	def displacements(self):
		"""Displacements since the start (n, 3) [m]."""
		return fixed(BondedInteractionLoop.sphereArray(self.ids, "displacement"))

	@property
	def rotations(self):
		"""Rotation vectors since the start (n, 3) [rad], of a length up to π."""
		return fixed(BondedInteractionLoop.sphereArray(self.ids, "rotation"))

	@property
	def spins(self):
		"""Angular velocities (n, 3) [rad/s]."""
		return fixed(BondedInteractionLoop.sphereArray(self.ids, "spin"))

	@property
	def velocities(self):
		"""Velocities (n, 3) [m/s]."""
		return fixed(BondedInteractionLoop.sphereArray(self.ids, "velocity"))

	@property
	def radii(self):
		"""Radii (n,) [m]."""
		return fixed(BondedInteractionLoop.sphereArray(self.ids, "radius"))

	def rows(self, ids):
		"""Rows of bodies in the arrays, in the shape of *ids*; -1 for those that are not there."""
		own, ids = self.ids, np.asarray(ids, int)
		row = np.full(max(int(own.max(initial=-1)), int(ids.max(initial=-1))) + 1, -1)
		row[own] = np.arange(len(own))
		return row[ids]

	def hold_faces(self, axis, dof):
		"""Hold the spheres that touch the two faces of the box across *axis* (0, 1 or 2) in one direction, "x",
		"y" or "z": rough platens, or plane strain."""
		centres = np.array([O.bodies[i].state.refPos[axis] for i in self.ids])
		for face in (self.lower[axis], self.upper[axis]):
			for i in self.ids[abs(centres - face) < 1.001 * self.radii]:
				state = O.bodies[i].state
				state.blockedDOFs = "".join(sorted(set(state.blockedDOFs) | {dof}))

	@property
	def degrees_of_freedom(self):
		"""Unknowns of the sample: six per sphere, three where it is one layer."""
		return sum(6 - len(O.bodies[i].state.blockedDOFs) for i in self.ids)

	@property
	def bonds(self):
		"""Bonds that hold: body ids (m, 2), in ascending order; ``O.interactions[i, j]`` of a row i, j is the
		bond.
		"""
		pairs = law().bondArrays()["ids"]
		return fixed(BodyIds(pairs[self._mine(pairs)]))

	@property
	def bond_stresses(self):
		"""Normal (tension positive) and shear stress (m, 2) [Pa] of the bonds that hold,
		in the order of :attr:`bonds`."""
		return fixed(self._of_bonds("normalStress", "shearStress"))

	@property
	def bond_forces(self):
		"""Axial force (tension positive) and size of the shear force (m, 2) [N] of the bonds that hold, in the
		order of :attr:`bonds`."""
		return fixed(self._of_bonds("axialForce", "shearForce"))

	@property
	def bond_radii(self):
		"""Radii (m,) [m] of the bonds that hold, in the order of :attr:`bonds`."""
		return fixed(self._of_bonds("radius")[:, 0])

	def _of_bonds(self, *columns):
		bonds = law().bondArrays()
		return np.column_stack([bonds[name] for name in columns])[self._mine(bonds["ids"])]

	@property
	def broken(self):
		"""Broken bonds in the order in which they broke, a structured array: id1, id2, step, time [s], position
		and normal of the crack (3,) [m, -], radius [m], mode ("tension" or "shear"), normal_stress and
		shear_stress when it broke [Pa], energy it lost [J]. YADE takes ``int(record["id1"])`` as an id.
		"""
		columns = law().brokenArrays()
		columns["mode"] = np.where(columns.pop("tension"), "tension", "shear")
		records = np.empty(len(columns["id1"]), dtype=broken_bonds.DTYPE)
		for name, values in columns.items():
			records[name] = values
		return fixed(records[self._mine(np.column_stack([records["id1"], records["id2"]]))])

	@property
	def broken_fraction(self):
		"""Broken bonds over those at the start [-]."""
		return law().brokenAmong(self._appended) / max(self.initial_bonds, 1)

	def _mine(self, pairs):
		"""Which pairs of body ids are both of this sample."""
		mine = np.zeros(max(int(self._appended.max()), int(pairs.max(initial=-1))) + 1, bool)
		mine[np.asarray(self._appended)] = True
		return mine[np.asarray(pairs)].all(axis=1)

	@property
	def damage(self):
		"""Broken share of the bonds each sphere had at the start (n,) [-]; 0 for a sphere that had none."""
		size, ids, broken = int(self._appended.max()) + 1, self.ids, self.broken
		lost = np.bincount(np.concatenate([broken["id1"], broken["id2"]]), minlength=size)[ids]
		held = np.bincount(self.bonds.ravel(), minlength=size)[ids]
		return fixed(lost / np.maximum(lost + held, 1))

	@property
	def crack_area(self):
		"""Cross-section of all broken bonds [m²]."""
		return float(np.pi * (self.broken["radius"]**2).sum())


def platens(
	sample, velocity, ramp=0.0, stiffness=100e9, both=True, bonded=False, shear_stiffness=0.0, area=None
):
	"""Set elastic walls below and above a sample and drive them towards each other along y, or apart.

	:param sample: :class:`BondedSample`; the walls start at its box's lower and upper face,
		and their area is that of the face.
	:param velocity: speed of each wall [m/s], positive compresses, negative pulls (bonded walls only).
	:param ramp: time over which the speed grows linearly from zero [s].
	:param stiffness: of the walls, K [Pa]; a sphere of radius r feels the spring pi r K.
	:param both: True: both walls move; False: the lower one stands still.
	:param bonded: True: the spheres whose centre is within 1.1 of their radius from a wall are bonded to it, for
		good, and feel its spring in both directions.
	:param shear_stiffness: of the walls along their plane, for bonded spheres [Pa]; 0: their ends can contract.
		ESyS-Particle's NRotBondedWall has that of *stiffness*.
	:param area: that stresses refer to [m²]. None: that of the loaded face, :attr:`BondedSample.area`. To be given
		for packings that neither fill their box nor say their shape, and for those without flat ends.
	:returns: :class:`Platens`; put its ``engines`` into O.engines after the interaction loop.
	:raises ValueError: velocity zero or not finite, or negative without bonded walls, negative ramp, stiffness not
		positive, no sphere at a wall that is to be bonded, no area and a specimen without flat ends. Nothing is
		appended then.
	"""
	if not math.isfinite(velocity) or velocity == 0:
		raise ValueError(f"velocity = {velocity} m/s must be a number other than zero")
	if velocity < 0 and not bonded:
		raise ValueError(
			f"velocity = {velocity} m/s: these walls only push; a positive velocity compresses, and "
			"bonded=True makes walls that pull"
		)
	if not (ramp >= 0 and math.isfinite(ramp)):
		raise ValueError(f"ramp = {ramp} s must not be negative")
	width, _, depth = sample.upper - sample.lower
	box = float(width * depth)
	if area is not None and not 0 < area <= 1.001 * box:
		raise ValueError(
			f"area = {area} m² must be positive, and not above that of the sample's box, {box:.6g} m²"
		)
	area = sample.area if area is None else area
	material = ElasticWallMat(stiffness=stiffness, shearStiffness=shear_stiffness)
	held = []
	if bonded:
		heights, reach = sample.positions[:, 1], _GLUED * sample.radii
		held = [sample.ids[abs(heights - face) < reach].tolist() for face in (sample.lower[1], sample.upper[1])]
		if not all(held):
			raise ValueError(
				f"no sphere is within {_GLUED} radii of the {'upper' if held[0] else 'lower'} face of "
				"the sample: nothing to bond the wall to"
			)
	O.materials.append(material)
	bottom, top = (
		utils.wall(float(face), axis=1, sense=sense, material=material)
		for face, sense in ((sample.lower[1], 1), (sample.upper[1], -1))
	)
	bottom, top = (O.bodies.append(wall) for wall in (bottom, top))
	for wall, spheres in zip((bottom, top), held):
		Ip2_ElasticWallMat_BondedMat_ElasticWallPhys().bond(wall, spheres)
	return Platens(sample, bottom, top, velocity, ramp, both, area)


class Platens:
	"""Two elastic walls on a bonded sample: what they do and what they feel (report, eqs. 9-11).
	Compression is positive."""

	def __init__(self, sample, bottom, top, velocity, ramp, both, area):
		self._measure(sample, bottom, top, sample.upper[1] - sample.lower[1], area)
		self.engines = [
			RampedTranslationEngine(ids=[top], translationAxis=(0, 1, 0), velocity=-velocity, rampTime=ramp)
		]
		if both:
			self.engines.append(
				RampedTranslationEngine(
					ids=[bottom], translationAxis=(0, 1, 0), velocity=velocity, rampTime=ramp
				)
			)

	@classmethod
	def from_scene(cls, sample, area=None):
		"""The platens on a sample of the current scene, for a scene that was loaded.

		:param sample: as from :meth:`BondedSample.from_scene`
		:param area: of the loaded face [m²], to be given again where it was given, or where the packing said
			its shape (a scene does not save it); None: that of the box around the spheres at the start.
		:raises RuntimeError: the scene has not two Walls of ElasticWallMat across y
		"""
		walls = [
			b for b in O.bodies
			if b and isinstance(b.shape, Wall) and b.shape.axis == 1 and isinstance(b.mat, ElasticWallMat)
		]
		if len(walls) != 2:
			raise RuntimeError(
				f"the scene has {len(walls)} Walls of ElasticWallMat across y, where platens are two"
			)
		bottom, top = sorted(walls, key=lambda wall: wall.state.refPos[1])
		self = cls.__new__(cls)
		height = top.state.refPos[1] - bottom.state.refPos[1]
		self._measure(sample, bottom.id, top.id, height, area)
		self.engines = [
			e for i in (top.id, bottom.id) for e in O.engines
			if isinstance(e, RampedTranslationEngine) and list(e.ids) == [i]
		]
		return self

	def _measure(self, sample, bottom, top, height, area):
		self.sample = sample
		self.bottom, self.top = bottom, top  #: body ids of the walls
		self.height = height  #: distance of the walls at the start [m]
		self.area = sample.area if area is None else area  #: of the loaded face [m²]

	@property
	def force_top(self):
		"""Force of the sample on the upper wall [N]."""
		return O.forces.f(self.top)[1]

	@property
	def force_bottom(self):
		"""Force of the sample on the lower wall [N]."""
		return -O.forces.f(self.bottom)[1]

	@property
	def stress(self):
		"""Mean stress of both ends [Pa], eq. 9: (F_top + F_bottom)/2A."""
		return 0.5 * (self.force_top + self.force_bottom) / self.area

	@property
	def strain(self):
		"""Approach of the walls over their first distance [-], eq. 11."""
		return 1 - (O.bodies[self.top].state.pos[1] - O.bodies[self.bottom].state.pos[1]) / self.height


def engines(platens=None, viscosity=0.0, rotational_viscosity=None, convention="consistent"):
	"""The engines of a bonded scene in their order; append recorders to the list.

	Spheres of :yref:`BondedMat` meet each other, and walls, boxes and facets of :yref:`BondedMat`,
	:yref:`ElasticWallMat` or :yref:`FrictMat`.

	:param platens: :class:`Platens` whose motion is included.
	:param viscosity: of :yref:`ViscousBodyDamping` [1/s]; 0 leaves it out. ESyS-Particle's tutorial has 2.
	:param rotational_viscosity: None: equal to viscosity [1/s].
	:param convention: "consistent", or "esys" for the bonds, the contacts and the moving walls of ESyS-Particle
		2.3.5, to compare with it, see :yref:`Law2_ScGeom_BondedPhys_MohrCoulomb`.
	"""
	for engine in platens.engines if platens else ():
		engine.ahead = convention == "esys"
	rotational = viscosity if rotational_viscosity is None else rotational_viscosity
	damping = (
		[ViscousBodyDamping(viscosity=viscosity, rotationalViscosity=rotational, label="bodyDamping")]
		if viscosity or rotational
		else []
	)
	return [
		ForceResetter(),
		InsertionSortCollider(
			[Bo1_Sphere_Aabb(), Bo1_Wall_Aabb(), Bo1_Box_Aabb(), Bo1_Facet_Aabb()], label="collider"
		),
		BondedInteractionLoop(
			[
				Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom(), Ig2_Box_Sphere_ScGeom(),
				Ig2_Facet_Sphere_ScGeom()
			],
			[
				Ip2_BondedMat_BondedMat_BondedPhys(), Ip2_ElasticWallMat_BondedMat_ElasticWallPhys(),
				Ip2_FrictMat_BondedMat_BondedPhys(), Ip2_FrictMat_FrictMat_FrictPhys()
			],
			[
				Law2_ScGeom_BondedPhys_MohrCoulomb(convention=convention),
				Law2_ScGeom_ElasticWallPhys_Repulsion(), Law2_ScGeom_FrictPhys_CundallStrack(),
			],
			label="interactions",
		),
		*(platens.engines if platens else []),
		*damping,
		BondedNewtonIntegrator(damping=0, label="newton"),
	]


def critical_time_step():
	"""Rigorous bound on the time step [s] of the bonded spheres of the scene (in the consistent convention), see
	:yref:`Law2_ScGeom_BondedPhys_MohrCoulomb.criticalTimeStep`; O.engines need not be set."""
	return Law2_ScGeom_BondedPhys_MohrCoulomb.criticalTimeStep()


def time_step(safety=0.8):
	"""A stable time step [s]: *safety* times :func:`critical_time_step`.
	The rest below 1 is for contacts that form later and for accuracy."""
	if not 0 < safety <= 1:
		raise ValueError(
			f"safety = {safety} must lie between 0 and 1, the share of the critical time step to use"
		)
	critical = critical_time_step()
	if math.isinf(critical):
		raise ValueError(
			"nothing limits the time step: the scene has no bonds, contacts or walls near spheres yet; "
			"set O.dt yourself"
		)
	return safety * critical


def check():
	"""Check engines and time step of a bonded scene before a run.

	:raises RuntimeError: an engine is missing or in the wrong place.
	:raises ValueError: a material was changed to bad parameters, or O.dt is above the critical step.
	"""
	kinds = (InteractionLoop, NewtonIntegrator)
	names = [next((k.__name__ for k in kinds if isinstance(e, k)), type(e).__name__) for e in O.engines]
	for name, purpose in (
		("ForceResetter", "forces would add up"),
		("InsertionSortCollider", "fragments would pass through each other"),
		("InteractionLoop", "bonds would bear no load"),
		("NewtonIntegrator", "nothing would move")
	):
		if name not in names:
			raise RuntimeError(f"O.engines has no {name}: {purpose}; see ddem.bonded.engines()")
	if names.count("InteractionLoop") > 1:
		raise RuntimeError(
			"O.engines has more than one InteractionLoop: every bond would act more than once; "
			"see ddem.bonded.engines()"
		)
	order = [names.index(name) for name in ("ForceResetter", "InteractionLoop", "NewtonIntegrator")]
	if order != sorted(order):
		raise RuntimeError(
			"wrong order in O.engines: it must be ForceResetter, InteractionLoop, NewtonIntegrator; "
			"see ddem.bonded.engines()"
		)
	esys = law().convention == "esys"
	for material in O.materials:
		if isinstance(material, (BondedMat, ElasticWallMat)):
			material.validate()
		if (
			esys
			and isinstance(material, BondedMat)
			and (material.gradualFriction or material.normalDamping or material.shearDamping)
		):
			raise ValueError(
				f"BondedMat '{material.label}': the convention 'esys' has neither gradualFriction nor "
				"normalDamping nor shearDamping; reset them or use 'consistent'"
			)
	limit = critical_time_step()
	if O.dt > limit:
		raise ValueError(
			f"O.dt = {O.dt} s is above the critical time step {limit} s of the bonds: the run would blow "
			"up; set O.dt = ddem.bonded.time_step(0.8)"
		)


def law():
	"""The :yref:`Law2_ScGeom_BondedPhys_MohrCoulomb` of the scene, which keeps the list of broken bonds.

	:raises RuntimeError: O.engines has no InteractionLoop with one.
	"""
	for engine in O.engines:
		if isinstance(engine, InteractionLoop):
			for functor in engine.lawDispatcher.functors:
				if isinstance(functor, Law2_ScGeom_BondedPhys_MohrCoulomb):
					return functor
	raise RuntimeError(
		"O.engines has no InteractionLoop with Law2_ScGeom_BondedPhys_MohrCoulomb, so bonds bear no load and "
		"cannot break; see ddem.bonded.engines()"
	)


def _material(material):
	if isinstance(material, str):
		labels = [m.label for m in O.materials]
		if material not in labels:
			raise ValueError(
				f"there is no material with label '{material}' in O.materials; it has: "
				f"{', '.join(filter(None, labels)) or 'none'}"
			)
		material = O.materials[labels.index(material)]
	if not isinstance(material, BondedMat):
		raise ValueError(f"bonded spheres need a BondedMat, not {type(material).__name__}")
	material.validate()
	return material
