# GPL v2 or later, see LICENSE.
"""Loads on bonded spheres: platens that are driven, platens and walls that follow stresses and strains.

Their names are those of :mod:`bonded`, too: ``ddem.bonded.platens``. SI units; forces, stresses and strains are
positive in compression.
"""
import math

import numpy as np

from yade import (
	ElasticWallMat, Ip2_ElasticWallMat_BondedMat_ElasticWallPhys, O, RampedTranslationEngine,
	ServoWall, Vector3, Wall, utils
)

from .jacket import jacket
from .cells import require_faces
from .loading import checked_legs

_AXES = "xyz"
_GLUED = 1.1  # distance of a centre from a wall, in radii, up to which it is bonded to it (tutorial of ESyS-Particle)


def platens(
	sample, velocity, ramp=0.0, stiffness=100e9, both=True, bonded=False, shear_stiffness=0.0, area=None, axis="y"
):
	"""Set elastic walls below and above a sample and drive them towards each other along an axis, or apart.

	:param sample: :class:`bonded.BondedSample`; the walls start at its box's lower and upper face,
		and their area is that of the face.
	:param velocity: speed of each wall [m/s], positive compresses, negative pulls (bonded walls only).
	:param ramp: time over which the speed grows linearly from zero [s].
	:param stiffness: of the walls, K [Pa]; a sphere of radius r feels the spring pi r K.
	:param both: True: both walls move; False: the lower one stands still.
	:param bonded: True: the spheres whose centre is within 1.1 of their radius from a wall are bonded to it, for
		good, and feel its spring in both directions.
	:param shear_stiffness: of the walls along their plane, for bonded spheres [Pa]; 0: their ends can contract.
		ESyS-Particle's NRotBondedWall has that of *stiffness*.
	:param area: that stresses refer to [m²]. None: that of the loaded face, :meth:`bonded.BondedSample.face`. To be
		given for packings that neither fill their box nor say their shape, and for those without flat ends.
	:param axis: of loading, "x", "y" or "z".
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
	_check_area(sample, area, axis)
	material = ElasticWallMat(stiffness=stiffness, shearStiffness=shear_stiffness)
	held = []
	if bonded:
		heights, reach = sample.positions[:, _AXES.index(axis)], _GLUED * sample.radii
		faces = (sample.lower[_AXES.index(axis)], sample.upper[_AXES.index(axis)])
		held = [sample.ids[abs(heights - face) < reach].tolist() for face in faces]
		if not all(held):
			raise ValueError(
				f"no sphere is within {_GLUED} radii of the {'upper' if held[0] else 'lower'} face of "
				"the sample: nothing to bond the wall to"
			)
	bottom, top = _two_walls(sample, axis, material)
	for wall, spheres in zip((bottom, top), held):
		Ip2_ElasticWallMat_BondedMat_ElasticWallPhys().bond(wall, spheres)
	return Platens(sample, bottom, top, velocity, ramp, both, area, axis)


def _check_area(sample, area, axis):
	if axis not in _AXES:
		raise ValueError(f"axis = '{axis}' is unknown; use 'x', 'y' or 'z'")
	require_faces()
	box = float(np.delete(sample.upper - sample.lower, _AXES.index(axis)).prod())
	if area is None:
		sample.face(axis)
	elif not 0 < area <= 1.001 * math.pi / 2 * box:  # that of a disc on its side is pi/2 D L
		raise ValueError(
			f"area = {area} m² must be positive, and not above that of the sample's box, {box:.6g} m²"
		)


def _two_walls(sample, axis, material):
	"""Body ids of new elastic walls at the lower and the upper face of a sample's box."""
	number = _AXES.index(axis)
	O.materials.append(material)
	return [
		O.bodies.append(utils.wall(float(face), axis=number, sense=sense, material=material))
		for face, sense in ((sample.lower[number], 1), (sample.upper[number], -1))
	]


class Platens:
	"""Two elastic walls on a bonded sample: what they do and what they feel (report, eqs. 9-11).
	Compression is positive."""

	def __init__(self, sample, bottom, top, velocity, ramp, both, area=None, axis="y"):
		self._measure(sample, bottom, top, area, axis)
		drive = lambda wall, speed: RampedTranslationEngine(
			ids=[wall], translationAxis=self._way, velocity=speed, rampTime=ramp
		)
		self.engines = [drive(top, -velocity)]
		if both:
			self.engines.append(drive(bottom, velocity))

	@classmethod
	def from_scene(cls, sample, area=None, axis="y"):
		"""The platens on a sample of the current scene, for a scene that was loaded.

		:param sample: as from :meth:`bonded.BondedSample.from_scene`
		:param area: of the loaded face [m²], to be given again where it was given; None: that of the sample's
			face, :meth:`bonded.BondedSample.face`
		:param axis: of loading, "x", "y" or "z"
		:raises RuntimeError: the scene has not two Walls of ElasticWallMat across that axis
		:raises ValueError: no area, and a sample whose shape the scene does not say
		"""
		_check_area(sample, area, axis)
		walls = [
			b for b in O.bodies
			if b and isinstance(b.shape, Wall) and b.shape.axis == _AXES.index(axis)
			and isinstance(b.mat, ElasticWallMat)
		]
		if len(walls) != 2:
			raise RuntimeError(
				f"the scene has {len(walls)} Walls of ElasticWallMat across {axis}, where platens are "
				"two"
			)
		bottom, top = sorted(walls, key=lambda wall: wall.state.refPos[_AXES.index(axis)])
		self = cls.__new__(cls)
		self._measure(sample, bottom.id, top.id, area, axis)
		self.engines = [
			e for i in (top.id, bottom.id) for e in O.engines
			if isinstance(e, (RampedTranslationEngine, ServoWall)) and list(e.ids) == [i]
		]
		return self

	def _measure(self, sample, bottom, top, area, axis):
		self.sample, self.axis = sample, axis
		self.bottom, self.top = bottom, top  #: body ids of the walls
		self._number, self._way = _AXES.index(axis), Vector3.Unit(_AXES.index(axis))
		start = [O.bodies[wall].state.refPos[self._number] for wall in (bottom, top)]
		self.height = start[1] - start[0]  #: distance of the walls at the start [m]
		self.area = sample.face(axis) if area is None else area  #: of the loaded face [m²]

	@property
	def force_top(self):
		"""Force of the sample on the upper wall [N]."""
		return O.forces.f(self.top)[self._number]

	@property
	def force_bottom(self):
		"""Force of the sample on the lower wall [N]."""
		return -O.forces.f(self.bottom)[self._number]

	@property
	def stress(self):
		"""Mean stress of both ends [Pa], eq. 9: (F_top + F_bottom)/2A."""
		return 0.5 * (self.force_top + self.force_bottom) / self.area

	@property
	def strain(self):
		"""Approach of the walls over their first distance [-], eq. 11."""
		bottom, top = (O.bodies[wall].state.pos[self._number] for wall in (self.bottom, self.top))
		return 1 - (top - bottom) / self.height


def servo(
	sample, legs, velocity, axis="y", area=None, stiffness=100e9, failure=0.0, impedance=None
):
	"""Elastic walls on both ends of a sample that follow a table of stresses and strains, the same at both ends::

		press = ddem.bonded.servo(sample, [("stress", 20e6, 1e-3), ("stress", 2e6, 1e-3), ("strain", 4e-3,
		2e-3)],
		                          velocity=0.5)
		O.engines = ddem.bonded.engines(press)

	:param sample, axis, area, stiffness: as for :func:`platens`
	:param legs: each ("stress", target [Pa], duration [s]) or ("strain", target [-], duration [s]), compression
		positive; strain counts from the start. A leg goes from what it finds to its target and begins and ends
		without a jolt: unloading and cycles are legs. After the last the walls keep the last stress, or stand
		still.
	:param velocity: largest speed of each wall in legs to a stress [m/s].
	:param failure: share of the stress asked for below which a wall that runs at its largest speed stops for
		good, ``press.failed``; 0: never.
	:param impedance: of the walls' dashpots [Pa·s/m], so that waves do not come back from them. None: the sample's
		own, the root of its mean density times Young's modulus of its bonds.
	:returns: :class:`ServoPlatens`
	:raises ValueError: legs that are none, numbers out of range. Nothing is appended then.
	"""
	legs, material = checked_legs(legs), ElasticWallMat(stiffness=stiffness)
	for kind, target, _ in legs:
		if kind == "stress" and target < 0:
			raise ValueError(
				f"servo: stress target = {target} Pa must not be negative: these walls only push; "
				"platens(velocity < 0, bonded=True) pull"
			)
	_check_area(sample, area, axis)
	face, height = sample.face(axis) if area is None else area, _height(sample, axis)
	mass = sum(O.bodies[i].state.mass for i in sample.ids)
	if impedance is None:
		density = mass / float((sample.upper - sample.lower).prod())
		impedance = math.sqrt(density * max(O.bodies[i].mat.young for i in sample.ids))
	scale = {"stress": face, "strain": 0.5 * height}
	walls = [
		ServoWall(
			direction=sense * Vector3.Unit(_AXES.index(axis)),
			kinds=["force" if kind == "stress" else "displacement" for kind, _, _ in legs],
			targets=[target * scale[kind] for kind, target, _ in legs], durations=[d for _, _, d in legs],
			velocity=velocity, failure=failure, mass=0.5 * mass, dashpot=impedance * face
		) for sense in (1, -1)
	]
	return ServoPlatens(sample, walls, *_two_walls(sample, axis, material), area, axis)


def _height(sample, axis):
	"""Length of a sample's box along an axis, "x", "y" or "z" [m]."""
	return float((sample.upper - sample.lower)[_AXES.index(axis)])


class ServoPlatens(Platens):
	"""Platens that follow a table of stresses and strains; see :func:`servo`."""

	def __init__(self, sample, engines, bottom, top, area, axis):
		self._measure(sample, bottom, top, area, axis)
		for engine, wall in zip(engines, (bottom, top)):
			engine.ids = [wall]
		self.engines = engines

	@property
	def failed(self):
		"""Whether the sample has given way, and a wall stands still."""
		return any(wall.failed for wall in self.engines if isinstance(wall, ServoWall))

	@property
	def done(self):
		"""Whether all legs are done."""
		return all(wall.done for wall in self.engines if isinstance(wall, ServoWall))


class Confinement:
	"""Walls around a sample beside its platens: what :func:`confine` returns."""

	def __init__(self, platens):
		self.platens = platens  #: by axis, :class:`Platens`
		self.engines = [engine for pair in platens.values() for engine in pair.engines]

	@property
	def stress(self):
		"""Mean stress of each pair of walls [Pa] by axis, compression positive."""
		return {axis: pair.stress for axis, pair in self.platens.items()}

	@property
	def strain(self):
		"""Approach of each pair of walls [-] by axis."""
		return {axis: pair.strain for axis, pair in self.platens.items()}


def confine(sample, pressure=None, ramp=1e-4, velocity=1.0, axes="xz", stiffness=100e9):
	"""Walls on the sides of a prism: with a pressure that servos keep (triaxial test), or fixed (oedometric test).

	:param sample: :class:`bonded.BondedSample`
	:param pressure: on these walls [Pa], compression positive; None: they stand still.
	:param ramp: time over which the pressure grows [s]; some ten times that of a wave through the sample.
	:param velocity: largest speed of the walls [m/s].
	:param axes: across which there are walls, of "x", "y", "z".
	:param stiffness: of the walls, as for :func:`platens`.
	:returns: :class:`Confinement`; hand it to :func:`bonded.engines`.
	:raises ValueError: a pressure that is not positive, unknown axes. Nothing is appended then.

	Limits: the walls are smooth and rigid, so the sides stay plane; the pressure is that on the faces of the box at
	the start.
	"""
	for axis in axes:
		_check_area(sample, None, axis)
	if len(set(axes)) != len(axes) or not axes:
		raise ValueError(f"axes = '{axes}' must name each axis once")
	if pressure is not None and not (pressure > 0 and math.isfinite(pressure)):
		raise ValueError(f"pressure = {pressure} Pa must be positive and finite; None holds the walls")
	ElasticWallMat(stiffness=stiffness)  # complains before anything is appended
	around = {}
	for axis in axes:
		if pressure is None:
			around[axis] = ServoPlatens(
				sample, [], *_two_walls(sample, axis, ElasticWallMat(stiffness=stiffness)), None, axis
			)
		else:
			around[axis] = servo(sample, [("stress", pressure, ramp)], velocity, axis, None, stiffness)
	return Confinement(around)


def triaxial(sample, pressure, strain, duration, ramp=1e-4, velocity=1.0, stiffness=100e9, sides="walls"):
	"""Platens, and walls or a jacket, for a triaxial test: equal pressure on all sides first, then the platens
	approach along y while the sides keep it::

		test = ddem.bonded.triaxial(sample, pressure=10e6, strain=0.01, duration=2e-3)
		O.engines = ddem.bonded.engines(test)

	:param pressure: of confinement [Pa]
	:param strain: of the platens at the end, from the start [-]
	:param duration: in which it is reached, after the *ramp* of the pressure [s]
	:param ramp, velocity, stiffness: as for :func:`confine`
	:param sides: "walls", rigid ones on a prism (:func:`confine`), or "jacket", a flexible one, also
		on a cylinder or another convex specimen of one cross-section (:func:`jacket.jacket`)
	:returns: :class:`ServoPlatens` along y with the walls (:class:`Confinement`) or the jacket
		(:class:`jacket.Jacket`) as ``confinement``
	:raises ValueError: numbers out of range. Nothing is appended then.
	"""
	for name, value, unit in (
		("pressure", pressure, "Pa"), ("strain", strain, "[-]"), ("duration", duration, "s"),
		("ramp", ramp, "s"),
		("velocity", velocity, "m/s"), ("stiffness", stiffness, "Pa")
	):
		if not (value > 0 and math.isfinite(value)):
			raise ValueError(f"{name} = {value} {unit} must be positive and finite")
	if sides not in ("walls", "jacket"):
		raise ValueError(f"sides = '{sides}' is unknown; use 'walls' or 'jacket'")
	if sides == "jacket":
		_check_area(sample, None, "y")
		around = jacket(sample, pressure, ramp)
	else:
		around = confine(sample, pressure, ramp, velocity, "xz", stiffness)
	press = servo(
		sample, [("stress", pressure, ramp), ("strain", strain, duration)], velocity, "y", None, stiffness
	)
	press.confinement = around
	press.engines = press.engines + around.engines
	return press
