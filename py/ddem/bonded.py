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
			[Law2_ScGeom_BondedPhys_Bonded(), Law2_ScGeom_ElasticWallPhys_Repulsion()],
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
import copy
import math
import warnings

import numpy as np

from yade import (
	Bo1_Box_Aabb, Bo1_Facet_Aabb, Bo1_RoundPlaten_Aabb, Bo1_Sphere_Aabb, Bo1_Wall_Aabb,
	BondedInteractionLoop, BondedMat, BondedNewtonIntegrator, ElasticWallMat, ForceResetter,
	Ig2_Box_Sphere_ScGeom, Ig2_Facet_Sphere_ScGeom, Ig2_RoundPlaten_Sphere_ScGeom,
	Ig2_Sphere_Sphere_ScGeom, Ig2_Wall_Sphere_ScGeom, InsertionSortCollider, InteractionLoop,
	Ip2_BondedMat_BondedMat_BondedPhys, Ip2_ElasticWallMat_BondedMat_ElasticWallPhys,
	Ip2_FrictMat_BondedMat_BondedPhys, Ip2_FrictMat_FrictMat_FrictPhys, JacketPressure,
	Law2_ScGeom_BondedPhys_Bonded, Law2_ScGeom_ElasticWallPhys_Repulsion,
	Law2_ScGeom_FrictPhys_CundallStrack, Material, Matrix3, NewtonIntegrator, O, RampedTranslationEngine,
	ServoWall, Sphere, Vector3, ViscousBodyDamping, utils
)

from . import broken_bonds, cells, meter, provenance, scene_notes, shapes
from . import packing as packings
from .arrays import BodyIds, fixed
from .bonded_bending import Bending, three_point_bending
from .bonded_jaws import Jaws, brazilian
from .bonded_loads import Confinement, Platens, ServoPlatens, confine, platens, servo, triaxial
from .bonded_shear import DirectShear, direct_shear
from .bonded_stress import mean_stress
from .jacket import Jacket, jacket

DEFAULT_GAP = packings.BOND_GAP  #: gap up to which spheres are bonded, of the largest radius
#: what the column "mode" of :attr:`BondedSample.bond_records` says of a bond
HOLDS, TENSION, SHEAR = 0, 1, 2
#: a row of :attr:`BondedSample.bond_records`
BOND = np.dtype(
	[("id1", int), ("id2", int), ("mode", int)] + [
		(name, float) for name in (
			"time", "radius", "axial_force", "shear_force", "normal_stress", "shear_stress"
		)
	]
)


@meter.makes_particles
def append(packing, material, gap=None, color=None, mass_law="solid", scatter=None):
	"""Append the spheres of a packing to the scene and bond them, as they are, without load.

	:param packing: :class:`packing.Packing`, or what :func:`packing.of` takes, as YADE's SpherePack. One layer
		(:attr:`packing.Packing.flat`) stays in its plane: motion along z and rotation about x and y are
		blocked. The cell of a periodic one becomes that of the scene; in a periodic scene, a packing without
		a cell fills O.cell. Spheres are bonded across its borders, too.
	:param material: a :yref:`BondedMat` of O.materials, or its label; or a list of them, one for each sphere. Where
		two meet, the weaker counts, or a third that is :yref:`between<BondedMat.between>` them.
	:param gap: spheres whose surfaces are closer than this are bonded [m]. None: the packing's own list of bonds,
		or 0.0025 of the largest radius where it has none.
	:param color: of the spheres, three numbers from 0 to 1.
	:param mass_law: "solid": density times volume, 4/3 pi r³; "cube":
		density times r³, the default of ESyS-Particle (with 1 g/mm³ = 1e6 kg/m³).
	:param scatter: factors of the strength of every bond [-]: None, :class:`Weibull`, or another function of the
		number of bonds that returns them, in ascending order of pairs.
	:returns: :class:`BondedSample`; a warning says where it is not in one piece
	:raises ValueError: unknown label or mass law, a material of another kind or with bad parameters, a negative
		gap, nothing to bond, a cell that is not O.cell or less than two bonds wide. Nothing is appended then.
	"""
	packing = _in_cell(packings.of(packing))
	materials = _materials(material, len(packing))
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
	factors = None if scatter is None else np.asarray(scatter(len(pairs)), float)
	spheres = []
	for centre, radius, material in zip(packing.centres, packing.radii, materials):
		body = utils.sphere(Vector3(*centre), float(radius), material=material, color=color or (0.6, 0.6, 0.65))
		if mass_law == "cube":
			body.state.mass = material.density * float(radius)**3
			body.state.inertia = Vector3(1, 1, 1) * (0.4 * body.state.mass * float(radius)**2)
		if packing.flat:
			body.state.blockedDOFs = "zXY"
		spheres.append(body)
	was_periodic = O.periodic
	if packing.cell is not None and not was_periodic:
		O.periodic = True
		sides_before = Matrix3(O.cell.hSize)
		O.cell.hSize = Matrix3(*packing.cell.ravel().tolist())
	# one by one: bodies that YADE takes as a list are never freed, with their bonds 1.5 kB a bond
	ids = BodyIds([O.bodies.append(body) for body in spheres])
	try:
		Ip2_BondedMat_BondedMat_BondedPhys().bond([(i, j) for i, j in ids[pairs]], factors)
	except ValueError:
		for i in ids:
			O.bodies.erase(i)
		if packing.cell is not None and not was_periodic:
			O.cell.hSize = sides_before
			O.periodic = False
		raise
	_warn_of_pieces(packing, pairs)
	scene_notes.add_sample(ids, packing.lower, packing.upper, packing.shape)
	return BondedSample(ids, packing, len(pairs))


def _in_cell(packing):
	"""The packing with the scene's cell and its box, where that is periodic."""
	if not O.periodic:
		if packing.cell is not None and len(O.bodies) > 0:
			raise ValueError(
				"the packing fills a periodic cell and the scene has bodies already: "
				"set O.periodic = True and O.cell.hSize for all of them first"
			)
		return packing
	sides = cells.sides()
	if packing.cell is None:
		packing = copy.copy(packing)
		packing.cell, packing.shape = sides, None
		packing.lower, packing.upper = np.minimum(sides, 0).sum(axis=1), np.maximum(sides, 0).sum(axis=1)
	elif not np.allclose(packing.cell, sides, rtol=1e-9, atol=1e-12 * np.abs(sides).max()):
		raise ValueError(
			f"the packing fills a cell with the sides {packing.cell.tolist()} m (columns), the scene's "
			f"O.cell.hSize is {sides.tolist()} m: set O.cell.hSize, or O.periodic = False and append sets "
			"both"
		)
	return packing


class Weibull:
	"""Random factors of strength with mean 1, after Weibull (1951): what :func:`append` takes as *scatter*.

	:param modulus: m; the coefficient of variation is about 1.2/m: rock has 2 to 10, concrete 5 to 20.
	:param seed: same seed, same factors
	:raises ValueError: a modulus that is not positive
	"""

	def __init__(self, modulus, seed=1):
		if not (modulus > 0 and math.isfinite(modulus)):
			raise ValueError(f"Weibull: modulus = {modulus} [-] must be positive and finite")
		self.modulus, self.seed = modulus, seed
		provenance.note_seed(seed)

	def __call__(self, count):
		"""Factors (count,) [-]."""
		drawn = np.random.default_rng(self.seed).weibull(self.modulus, count)
		return drawn / math.gamma(1 + 1 / self.modulus)


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

	def __init__(self, ids, packing, bonds, unknown=None):
		"""
		:param ids: of its spheres
		:param packing: :class:`packing.Packing` at the start, whose box, shape and cell it has
		:param bonds: their number at the start
		:param unknown: why the shape is not known, in words; None: it is that of the packing, or its box
		"""
		self._appended = BodyIds(ids)
		self._packing, self._unknown = packing, unknown
		#: corners of the box at the start [m]
		self.lower, self.upper = np.array(packing.lower, float), np.array(packing.upper, float)
		self.initial_bonds = bonds  #: number of bonds at the start

	@classmethod
	def from_scene(cls, shape=None):
		"""The sample in the current scene, all spheres of BondedMat together; for a scene that was loaded.
		A scene keeps shape and box of the sample where :func:`append` has made one and nothing else.

		:param shape: one of :mod:`shapes` that it filled at the start; None: what the scene says. Where that
			says nothing, :meth:`face`, :attr:`volume` and what needs a shape raise, and the box is that of
			the spheres.
		:raises RuntimeError: the scene has no spheres of BondedMat
		:raises ValueError: a shape whose box is not that of the spheres, up to their largest diameter
		"""
		bodies = [b for b in O.bodies if b and isinstance(b.shape, Sphere) and isinstance(b.mat, BondedMat)]
		if not bodies:
			raise RuntimeError("the scene has no spheres of BondedMat")
		start = np.array([b.state.refPos for b in bodies])
		radii = np.array([[b.shape.radius] for b in bodies])
		ids = [b.id for b in bodies]
		unknown = None
		if O.periodic:
			packing = packings.Packing(start, radii, cell=np.reshape(O.cell.refHSize, (3, 3)))
		elif shape is not None:
			packing = _filling(shape, start, radii)
		else:
			packing, unknown = _as_noted(ids, start, radii)
		sample = cls(ids, packing, 0, unknown)
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
		"""Area of the face across y at the start [m²], which platens load, see :meth:`face`."""
		return self.face("y")

	def face(self, axis):
		"""Area of the face across an axis, "x", "y" or "z", at the start [m²]: that of the packing's shape
		(:meth:`packing.Packing.area`), or of its box where it has none.

		:raises ValueError: a shape without a flat face there, as a ball; one that the scene it was loaded from
			does not say
		"""
		return self._known().area("xyz".index(axis))

	@property
	def is_prism(self):
		"""Whether it was packed as a box along the axes, or says no shape, so that its box stands for it.

		:raises ValueError: the scene it was loaded from does not say
		"""
		return self._known().shape is None or isinstance(self._packing.shape, packings.Box)

	@property
	def volume(self):
		"""Of the periodic cell, of the packing's shape at the start, or of its box where it has none [m³].

		:raises ValueError: the scene it was loaded from does not say
		"""
		return self._known().volume

	def _known(self):
		"""Its packing, whose shape is known."""
		if self._unknown:
			raise ValueError(
				f"the shape of this sample is unknown: {self._unknown}; say it, as in "
				"BondedSample.from_scene(shape=ddem.packing.Cylinder(…)), or give what loads it the "
				"area= of its face"
			)
		return self._packing

	@property
	def is_shaped(self):
		"""Whether its packing says which shape it fills."""
		return self._packing.shape is not None

	def is_cylinder(self, axis):
		"""Whether it was packed as a cylinder along an axis, "x", "y" or "z"."""
		shape = self._packing.shape
		return isinstance(shape, packings.Cylinder) and abs(shape.axis["xyz".index(axis)]) > 1 - 1e-12

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
	def bond_records(self):
		"""All bonds there have been, a structured array (:data:`BOND`): those that hold in the order of
		:attr:`bonds`, then the broken ones in the order in which they broke.

		================================  ==========================================================
		id1, id2                          body ids, the smaller first among those that hold [-]
		mode                              0 holds, 1 broken in tension, 2 broken in shear
		time                              when it broke [s]; NaN while it holds
		radius                            of its section [m]
		axial_force, shear_force          now, tension positive, and size [N]; NaN where broken
		normal_stress, shear_stress       now, tension positive, or when it broke [Pa]
		================================  ==========================================================

		::

			bonds = sample.bond_records
			held = bonds[bonds["mode"] == ddem.bonded.HOLDS]
			print(held["axial_force"].max(), (bonds["mode"] == ddem.bonded.TENSION).sum())
		"""
		bonds, broken = law().bondArrays(), law().brokenArrays()
		held = len(bonds["ids"])
		records = np.empty(held + len(broken["id1"]), BOND)
		now, lost = records[:held], records[held:]
		now["id1"], now["id2"] = bonds["ids"].T
		now["mode"], now["time"], now["radius"] = HOLDS, np.nan, bonds["radius"]
		now["axial_force"], now["shear_force"] = bonds["axialForce"], bonds["shearForce"]
		now["normal_stress"], now["shear_stress"] = bonds["normalStress"], bonds["shearStress"]
		for name in ("id1", "id2", "mode", "time", "radius", "normal_stress", "shear_stress"):
			lost[name] = broken[name]
		lost["axial_force"] = lost["shear_force"] = np.nan
		mine = self._mine(bonds["ids"]), self._mine(np.column_stack([broken["id1"], broken["id2"]]))
		if all(part.all() for part in mine):
			return fixed(records)
		return fixed(records[np.concatenate(mine)])

	@property
	def broken(self):
		"""Broken bonds in the order in which they broke, a structured array: id1, id2, step, time [s], position
		and normal of the crack (3,) [m, -], radius [m], mode ("tension" or "shear"), normal_stress and
		shear_stress when it broke [Pa], energy it lost [J]. YADE takes ``int(record["id1"])`` as an id.
		"""
		columns = law().brokenArrays()
		columns["mode"] = np.array(["", "tension", "shear"])[columns["mode"]]
		records = np.empty(len(columns["id1"]), dtype=broken_bonds.DTYPE)
		for name, values in columns.items():
			records[name] = values
		return fixed(records[self._mine(np.column_stack([records["id1"], records["id2"]]))])

	@property
	def broken_count(self):
		"""Number of broken bonds."""
		return law().brokenAmong(self._appended)

	@property
	def broken_fraction(self):
		"""Broken bonds over those at the start [-]."""
		return self.broken_count / max(self.initial_bonds, 1)

	def _mine(self, pairs):
		"""Which pairs of body ids are both of this sample."""
		mine = np.zeros(max(int(self._appended.max()), int(pairs.max(initial=-1))) + 1, bool)
		mine[np.asarray(self._appended)] = True
		first, second = np.asarray(pairs).T
		return mine[first] & mine[second]

	@property
	def damage(self):
		"""Broken share of the bonds each sphere had at the start (n,) [-]; 0 for a sphere that had none."""
		bonds = self.bond_records
		return fixed(broken_share(bonds, bonds["mode"] != HOLDS, self.ids))

	@property
	def crack_area(self):
		"""Cross-section of all broken bonds [m²]."""
		return float(np.pi * (self.broken["radius"]**2).sum())


def _as_noted(ids, centres, radii):
	"""The packing of a loaded sample with the box and the shape that the scene says; and why these are unknown, or
	None."""
	note = scene_notes.sample(ids)
	if note is None:
		return packings.Packing(centres, radii), (
			"the scene does not say it, as it was saved by an older version, or has spheres that "
			"bonded.append has not made"
		)
	if note["count"] > 1:
		return packings.Packing(centres, radii), f"the scene has {note['count']} samples, here taken as one"
	shape = note["shape"] and shapes.from_record(note["shape"])
	return packings.Packing(centres, radii, note["lower"], note["upper"], shape=shape), None


def _filling(shape, centres, radii):
	"""The packing of spheres that are said to fill a shape."""
	packing = packings.Packing(centres, radii, shape=shape)
	given, found = np.array([shape.lower, shape.upper]), np.array([packing.lower, packing.upper])
	if abs(given - found)[:, :shape.dimension].max() > 2 * packing.radii.max():
		raise ValueError(
			f"from_scene: shape = {shape} lies from {shape.lower.tolist()} to {shape.upper.tolist()} m, "
			f"the spheres from {packing.lower.tolist()} to {packing.upper.tolist()} m: they do not fill it"
		)
	packing.lower[:shape.dimension], packing.upper[:shape.dimension] = given[:, :shape.dimension]
	return packing


def broken_share(bonds, broken, ids):
	"""Broken share of the bonds each sphere had at the start (n,) [-]; 0 for a sphere that had none.

	:param bonds: as :attr:`BondedSample.bond_records`
	:param broken: which of them are broken (m,)
	:param ids: of the spheres (n,)
	"""
	first, second, ids = bonds["id1"], bonds["id2"], np.asarray(ids, int)
	size = max(int(part.max(initial=-1)) for part in (first, second, ids)) + 1
	ends = lambda some: np.bincount(first[some], minlength=size) + np.bincount(second[some], minlength=size)
	return ends(broken)[ids] / np.maximum(ends(slice(None))[ids], 1)


def engines(platens=None, viscosity=0.0, rotational_viscosity=None, convention="consistent"):
	"""The engines of a bonded scene in their order; append recorders to the list.

	Spheres of :yref:`BondedMat` meet each other, and walls, round platens, boxes and facets of :yref:`BondedMat`,
	:yref:`ElasticWallMat` or :yref:`FrictMat`.

	:param platens: :class:`bonded_loads.Platens`, :class:`bonded_loads.Confinement`, :class:`jacket.Jacket`, or a
		list of them, whose engines are included.
	:param viscosity: of :yref:`ViscousBodyDamping` [1/s]; 0 leaves it out. ESyS-Particle's tutorial has 2.
	:param rotational_viscosity: None: equal to viscosity [1/s].
	:param convention: "consistent", or "esys" for the bonds, the contacts and the moving walls of ESyS-Particle
		2.3.5, to compare with it, see :yref:`Law2_ScGeom_BondedPhys_Bonded`.
	"""
	loads = platens if isinstance(platens, (list, tuple)) else [platens] if platens else []
	drives = [engine for load in loads for engine in load.engines]
	for engine in drives:
		if isinstance(engine, RampedTranslationEngine):
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
			[
				Bo1_Sphere_Aabb(), Bo1_Wall_Aabb(), Bo1_Box_Aabb(), Bo1_Facet_Aabb(),
				Bo1_RoundPlaten_Aabb()
			],
			label="collider"
		),
		BondedInteractionLoop(
			[
				Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom(), Ig2_Box_Sphere_ScGeom(),
				Ig2_Facet_Sphere_ScGeom(), Ig2_RoundPlaten_Sphere_ScGeom()
			],
			[
				Ip2_BondedMat_BondedMat_BondedPhys(), Ip2_ElasticWallMat_BondedMat_ElasticWallPhys(),
				Ip2_FrictMat_BondedMat_BondedPhys(), Ip2_FrictMat_FrictMat_FrictPhys()
			],
			[
				Law2_ScGeom_BondedPhys_Bonded(convention=convention),
				Law2_ScGeom_ElasticWallPhys_Repulsion(), Law2_ScGeom_FrictPhys_CundallStrack(),
			],
			label="interactions",
		),
		*drives,
		*damping,
		BondedNewtonIntegrator(damping=0, label="newton"),
	]


def critical_time_step():
	"""Rigorous bound on the time step [s] of the bonded spheres of the scene (in the consistent convention), see
	:yref:`Law2_ScGeom_BondedPhys_Bonded.criticalTimeStep`; O.engines need not be set."""
	return Law2_ScGeom_BondedPhys_Bonded.criticalTimeStep()


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
	for place, engine in enumerate(O.engines):
		if isinstance(engine, (ServoWall, JacketPressure)) and not order[1] < place < order[2]:
			raise RuntimeError(
				f"wrong order in O.engines: {type(engine).__name__} must come between InteractionLoop "
				"and NewtonIntegrator; see ddem.bonded.engines()"
			)
	_check_between()
	esys = law().convention == "esys"
	for material in O.materials:
		if isinstance(material, (BondedMat, ElasticWallMat)):
			material.validate()
		if esys and isinstance(material, BondedMat) and material.criterion != "MohrCoulomb":
			raise ValueError(
				f"{type(material).__name__} '{material.label}': the convention 'esys' knows bonds of "
				"BondedMat only; use 'consistent'"
			)
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


def _check_between():
	"""Materials between two others must know them, and be the only ones there."""
	bonded = [m for m in O.materials if isinstance(m, BondedMat)]
	labels, seen = {m.label for m in bonded}, {}
	for material in bonded:
		for label in material.between:
			if label not in labels:
				raise ValueError(
					f"BondedMat '{material.label}' is between {' and '.join(material.between)}, "
					f"but O.materials has no BondedMat '{label}'"
				)
		pair = frozenset(material.between)
		if pair and pair in seen:
			raise ValueError(
				f"BondedMat '{seen[pair]}' and '{material.label}' are both between {' and '.join(pair)}"
			)
		seen[pair] = material.label


def law():
	"""The :yref:`Law2_ScGeom_BondedPhys_Bonded` of the scene, which keeps the list of broken bonds.

	:raises RuntimeError: O.engines has no InteractionLoop with one.
	"""
	for engine in O.engines:
		if isinstance(engine, InteractionLoop):
			for functor in engine.lawDispatcher.functors:
				if isinstance(functor, Law2_ScGeom_BondedPhys_Bonded):
					return functor
	raise RuntimeError(
		"O.engines has no InteractionLoop with Law2_ScGeom_BondedPhys_Bonded, so bonds bear no load and "
		"cannot break; see ddem.bonded.engines()"
	)


def _materials(material, count):
	"""The material of each of some spheres, checked."""
	if isinstance(material, (str, Material)):
		return [_material(material)] * count
	materials = list(material)
	if len(materials) != count:
		raise ValueError(f"{len(materials)} materials for {count} spheres; give one, or one for each")
	known = {m: _material(m) for m in set(materials)}
	return [known[m] for m in materials]


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
