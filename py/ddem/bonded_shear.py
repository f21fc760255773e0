# GPL v2 or later, see LICENSE.
"""Direct shear of a prism of bonded spheres between two half boxes, under a normal stress::

	block = ddem.packing.fill(ddem.packing.Box((0, 0, 0), (0.04, 0.02, 0.02)), 0.6e-3, 1.5e-3)
	sample = ddem.bonded.append(block, "rock")
	shear = ddem.bonded.direct_shear(sample, normal_stress=10e6, velocity=0.1, ramp=1e-4)
	O.engines = ddem.bonded.engines(shear)

The sample is sheared along x, halfway up its height y. SI units.
"""
import math

import numpy as np

from yade import (
	Box, ElasticWallMat, Ip2_ElasticWallMat_BondedMat_ElasticWallPhys, O, RampedTranslationEngine, ServoWall, Wall,
	utils
)

from . import scene_notes
from .cells import require_faces

# dashpot of the normal load, of that which lets no wave come back; against the whole of it a sample of rock that rises
# at 0.1 m/s would raise the normal stress by a MPa
_DASHPOT = 0.3
_SKIN = 1.1  # distance of a centre from a face, in radii, up to which it is held, as platens do


def direct_shear(
	sample, normal_stress, velocity, ramp=1e-4, gap=None, stiffness=None, normal_velocity=None, normal_ramp=None
):
	"""Put a prism into a shear box: a lower half that moves along x, an upper half that carries the normal load.

	Each half has two smooth side plates and an end plate to which the outermost spheres are bonded, in shear as
	well, as a specimen is cast into its box: it bears the moment of the two forces, which smooth plates
	could not. The front and the back of the box are smooth walls. The upper end plate keeps the normal force by
	a servo and is free to rise; nothing else of the upper half moves.

	:param sample: :class:`bonded.BondedSample` of a prism
	:param normal_stress: σ_n [Pa], compression positive; it grows first, then the lower half starts
	:param velocity: of the lower half along x [m/s]
	:param ramp: time over which it grows linearly from zero [s]
	:param gap: between the half boxes [m]. None: two mean radii.
	:param stiffness: of plates and walls, K [Pa]; a sphere of radius r feels the spring π r K. None: Young's
		modulus of the bonds. Fragments that rattle between plates much stiffer than their bonds gain energy
		from the time step.
	:param normal_velocity: largest speed of the upper end plate [m/s]. None: ten times *velocity*.
	:param normal_ramp: time in which the normal stress grows [s]. None: 20 times that of a wave through the height.
	:returns: :class:`DirectShear`; hand it to :func:`bonded.engines`
	:raises ValueError: numbers out of range, a sample that is no prism, a gap above half of its height, no sphere
		at an end. Nothing is appended then.
	"""
	require_faces()
	density = sum(O.bodies[i].state.mass for i in sample.ids) / float((sample.upper - sample.lower).prod())
	young = max(O.bodies[i].mat.young for i in sample.ids)
	size = [float(s) for s in sample.upper - sample.lower]
	gap = 2 * float(sample.radii.mean()) if gap is None else gap
	normal_velocity = 10 * velocity if normal_velocity is None else normal_velocity
	normal_ramp = 20 * size[1] * math.sqrt(density / young) if normal_ramp is None else normal_ramp
	for name, value, unit in (
		("normal_stress", normal_stress, "Pa"), ("velocity", velocity, "m/s"),
		("normal_velocity", normal_velocity, "m/s"),
		("normal_ramp", normal_ramp, "s")
	):
		if not (value > 0 and math.isfinite(value)):
			raise ValueError(f"direct_shear: {name} = {value} {unit} must be positive and finite")
	if not (ramp >= 0 and math.isfinite(ramp)):
		raise ValueError(f"direct_shear: ramp = {ramp} s must not be negative")
	if not 0 <= gap <= 0.5 * size[1]:
		raise ValueError(
			f"direct_shear: gap = {gap} m must lie between 0 and half of the sample's height, "
			f"{0.5 * size[1]:.6g} m"
		)
	if not sample.is_prism:
		raise ValueError("direct_shear: the sample must be a prism; fill a packing.Box, or give a file's box")
	stiffness = young if stiffness is None else stiffness
	material = ElasticWallMat(stiffness=stiffness, shearStiffness=stiffness)
	heights, reach = sample.positions[:, 1], _SKIN * sample.radii
	held = [sample.ids[abs(heights - face) < reach].tolist() for face in (sample.lower[1], sample.upper[1])]
	if not all(held):
		raise ValueError(
			f"direct_shear: no sphere is within {_SKIN} radii of the {'upper' if held[0] else 'lower'} "
			"face of the sample: nothing to hold there"
		)
	O.materials.append(material)
	halves = [_half(sample, up, gap, material, spheres) for up, spheres in zip((False, True), held)]
	for face, sense in ((sample.lower[2], 1), (sample.upper[2], -1)):
		O.bodies.append(utils.wall(float(face), axis=2, sense=sense, material=material))
	area = size[0] * size[2]
	normal = ServoWall(
		ids=[halves[1][0]], direction=(0, -1, 0), kinds=["force"], targets=[normal_stress * area],
		durations=[normal_ramp],
		velocity=normal_velocity, mass=0.5 * density * area * size[1],
		dashpot=_DASHPOT * math.sqrt(density * young) * area
	)
	drive = RampedTranslationEngine(
		ids=halves[0], translationAxis=(1, 0, 0), velocity=velocity, rampTime=ramp,
		startTime=O.time + 1.2 * normal_ramp
	)
	begins = 1.2 * normal_ramp
	scene_notes.add(
		"direct shear", [*halves[0], *halves[1]], normal_target=normal_stress, gap=gap, begins=begins
	)
	return DirectShear(sample, *halves, normal, drive, normal_stress, gap, begins)


def _half(sample, up, gap, material, spheres):
	"""Body ids of an end plate, to which spheres are bonded, and two side plates."""
	lower, upper, size = sample.lower, sample.upper, sample.upper - sample.lower
	face = float(upper[1] if up else lower[1])
	end = O.bodies.append(utils.wall(face, axis=1, sense=-1 if up else 1, material=material))
	Ip2_ElasticWallMat_BondedMat_ElasticWallPhys().bond(end, spheres)
	# as thick as the sample is wide, and well beyond its faces, where it may rise to
	thick, middle = 0.5 * float(size[0]), 0.5 * float(lower[1] + upper[1])
	inner, outer = (
		(middle + 0.5 * gap, face + float(size[1])) if up else (face - float(size[1]), middle - 0.5 * gap)
	)
	sides = [
		O.bodies.append(
			utils.box(
				(x + out * thick, 0.5 * (inner + outer), 0.5 * float(lower[2] + upper[2])),
				(thick, 0.5 * (outer - inner), float(size[2])), material=material, fixed=True
			)
		) for x, out in ((float(lower[0]), -1), (float(upper[0]), 1))
	]
	return [end, *sides]


class DirectShear:
	"""A shear box around a sample: what it does and what it feels; see :func:`direct_shear`. It serves wherever
	platens do. Forces are those along the shear, positive as loading has them."""

	def __init__(self, sample, lower, upper, normal, drive, normal_target, gap, begins):
		self.sample = sample
		self.lower, self.upper = lower, upper  #: body ids of the halves: end plate, left and right side plate
		self.normal_target, self.gap = normal_target, gap  #: [Pa], [m]
		self.begins = begins  #: time from the start until the lower half moves [s]
		self._normal = normal
		self.engines = [normal, drive]
		self.length, self.height, depth = (float(s) for s in sample.upper - sample.lower)
		self.area = self.length * depth  #: of the plane of shear at the start [m²]

	@classmethod
	def from_scene(cls, sample):
		"""The shear box in the current scene, for a scene that was loaded.

		:param sample: as from :meth:`bonded.BondedSample.from_scene`
		:raises RuntimeError: the scene has no shear box that :func:`direct_shear` made, or more than one, or
			O.engines not what moves it
		"""
		note = scene_notes.only("direct shear", 2 * (Wall, Box, Box))
		lower, upper = note["bodies"][:3], note["bodies"][3:]
		found = []
		for kind, bodies in ((ServoWall, upper[:1]), (RampedTranslationEngine, lower)):
			engines = [e for e in O.engines if isinstance(e, kind) and list(e.ids) == bodies]
			if len(engines) != 1:
				raise RuntimeError(
					f"O.engines has {len(engines)} {kind.__name__} of the bodies {bodies}, where a "
					"shear box has one"
				)
			found += engines
		return cls(sample, lower, upper, *found, note["normal_target"], note["gap"], note["begins"])

	@property
	def outlines(self):
		"""Lines (n, 2) [m] in the plane x, y that show both halves of the box in pictures."""
		lines = []
		for (end, left, right), up in ((self.lower, False), (self.upper, True)):
			face = float(O.bodies[end].state.pos[1])
			faces = [
				float(O.bodies[side].state.pos[0] + out * O.bodies[side].shape.extents[0])
				for side, out in ((left, 1), (right, -1))
			]
			place, extents = O.bodies[left].state.pos[1], O.bodies[left].shape.extents[1]
			inner = float(place - extents if up else place + extents)
			lines.append(
				np.array([[faces[0], inner], [faces[0], face], [faces[1], face], [faces[1], inner]])
			)
		return lines

	@property
	def force_top(self):
		"""Shear force of the sample on the upper half [N], along the motion of the lower one."""
		return sum(O.forces.f(body)[0] for body in self.upper)

	@property
	def force_bottom(self):
		"""Shear force of the sample on the lower half [N], against its motion."""
		return -sum(O.forces.f(body)[0] for body in self.lower)

	@property
	def stress(self):
		"""Shear stress [Pa]: the mean force of both halves over the area at the start. Its largest value is the
		peak shear strength."""
		return 0.5 * (self.force_top + self.force_bottom) / self.area

	@property
	def normal_stress(self):
		"""Stress of the sample on the upper end plate [Pa], compression positive."""
		return O.forces.f(self.upper[0])[1] / self.area

	@property
	def normal_stress_below(self):
		"""Stress of the sample on the lower end plate [Pa], compression positive."""
		return -O.forces.f(self.lower[0])[1] / self.area

	@property
	def displacement(self):
		"""Way of the lower half along x [m]."""
		return float(O.bodies[self.lower[0]].state.displ()[0])

	@property
	def strain(self):
		"""Shear displacement over the length of the plane of shear [-]."""
		return self.displacement / self.length

	@property
	def dilation(self):
		"""Rise of the upper end plate since the start [m]; falling is negative."""
		return -self._normal.displacement
