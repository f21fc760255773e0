# GPL v2 or later, see LICENSE.
"""The Brazilian test of a disc of bonded spheres: flat or curved jaws, indirect tensile strength::

	disc = ddem.packing.fill(ddem.packing.Cylinder((0, 0, 0), (0, 0, 0.02), radius=0.025), 0.6e-3, 1.5e-3)
	sample = ddem.bonded.append(disc, "rock")
	jaws = ddem.bonded.brazilian(sample, velocity=0.05, jaws="curved")
	O.engines = ddem.bonded.engines(jaws)

The disc lies on its side, its axis along z, and is loaded along y. SI units; compression positive.
"""
import math

import numpy as np

from yade import Body, ElasticWallMat, O, Quaternion, RampedTranslationEngine, RoundPlaten, Vector3

from .bonded_loads import Platens, platens
from .cells import require_faces

JAWS = ("curved", "flat")  #: what brazilian() knows
CURVATURE = 1.5  #: radius of a curved jaw over that of the disc (ISRM 1978)
_HALF_ANGLE = math.radians(30)  # of a curved jaw, about its axis: 0.75 of the disc's diameter wide


def brazilian(sample, velocity, jaws="curved", ramp=0.0, stiffness=100e9, both=True):
	"""Split a disc between two smooth rigid jaws.

	:param sample: :class:`bonded.BondedSample` of a cylinder along z, or, for flat jaws, of one with flat ends
		across y
	:param velocity: speed of each jaw [m/s]
	:param jaws: "curved", with 1.5 times the radius of the disc, as ISRM (1978) suggests; or "flat"
	:param ramp: time over which the speed grows linearly from zero [s]
	:param stiffness: of the jaws, K [Pa]; a sphere of radius r feels the spring π r K
	:param both: True: both jaws move; False: the lower one stands still
	:returns: :class:`Jaws`, or :class:`bonded_loads.Platens` where they are flat; its ``stress`` is 2 P/(π D L),
		that across the loaded diameter in the middle of an elastic disc of diameter D and length L
	:raises ValueError: other jaws, speeds out of range, a sample that is no disc. Nothing is appended then.
	"""
	require_faces()
	if jaws not in JAWS:
		raise ValueError(f"brazilian: jaws = '{jaws}' is unknown; use {' or '.join(map(repr, JAWS))}")
	if not (velocity > 0 and math.isfinite(velocity)):
		raise ValueError(f"brazilian: velocity = {velocity} m/s must be positive and finite: jaws only push")
	diameter, height, length = (float(s) for s in sample.upper - sample.lower)
	area = math.pi / 2 * diameter * length
	if jaws == "flat":
		return platens(sample, velocity, ramp, stiffness, both, area=area)
	if not (ramp >= 0 and math.isfinite(ramp)):
		raise ValueError(f"brazilian: ramp = {ramp} s must not be negative")
	if not sample.is_cylinder("z") and (sample.is_shaped or abs(height - diameter) > 0.02 * diameter):
		raise ValueError(
			"brazilian: curved jaws need a disc on its side, a cylinder along z; this sample is "
			f"{diameter:.6g} m wide (x), {height:.6g} m high (y), {length:.6g} m long "
			f"(z){'' if sample.is_cylinder('z') else ' and no such cylinder'}"
		)
	material = ElasticWallMat(stiffness=stiffness)
	O.materials.append(material)
	radius, middle = 0.5 * CURVATURE * height, 0.5 * (sample.lower + sample.upper)
	made = []
	for up, face in ((-1, sample.lower[1]), (1, sample.upper[1])):
		body = Body()
		body.shape = RoundPlaten(radius=radius, length=2 * length, concave=True, halfAngle=_HALF_ANGLE)
		body.material = material
		body.state.pos = body.state.refPos = Vector3(middle[0], face - up * radius, middle[2])
		body.state.ori = body.state.refOri = Quaternion(Vector3.UnitZ, 0 if up > 0 else math.pi)
		body.state.blockedDOFs = "xyzXYZ"
		body.dynamic = False
		made.append(O.bodies.append(body))
	return Jaws(sample, *made, velocity, ramp, both, area)


class Jaws(Platens):
	"""Two curved jaws on a disc: what they do and what they feel; see :func:`brazilian`.
	Compression is positive."""

	@classmethod
	def from_scene(cls, sample):
		"""The curved jaws in the current scene, for a scene that was loaded; flat ones are
		:class:`bonded_loads.Platens` of an area π D L/2.

		:param sample: as from :meth:`bonded.BondedSample.from_scene`
		:raises RuntimeError: the scene has not two concave round platens
		"""
		jaws = [b for b in O.bodies if b and isinstance(b.shape, RoundPlaten) and b.shape.concave]
		if len(jaws) != 2:
			raise RuntimeError(f"the scene has {len(jaws)} concave RoundPlatens, where curved jaws are two")
		# the axis of the lower one is above that of the upper one, as both are less curved than the disc
		top, bottom = (jaw.id for jaw in sorted(jaws, key=lambda jaw: jaw.state.refPos[1]))
		diameter, _, length = (float(s) for s in sample.upper - sample.lower)
		self = cls.__new__(cls)
		self._measure(sample, bottom, top, math.pi / 2 * diameter * length, "y")
		self.engines = [
			e for i in (top, bottom) for e in O.engines
			if isinstance(e, RampedTranslationEngine) and list(e.ids) == [i]
		]
		return self

	def _measure(self, sample, bottom, top, area, axis):
		self.sample, self.axis = sample, axis
		self.bottom, self.top = bottom, top  #: body ids of the jaws
		self._number, self._way = 1, Vector3.UnitY
		self.height = float(sample.upper[1] - sample.lower[1])  #: diameter of the disc [m]
		self.area = area  #: π D L/2 [m²]

	@property
	def outlines(self):
		"""Lines (n, 2) [m] in the plane x, y that show the jaws in pictures."""
		angles = np.linspace(-_HALF_ANGLE, _HALF_ANGLE, 25)
		lines = []
		for jaw, up in ((self.bottom, -1), (self.top, 1)):
			centre, radius = O.bodies[jaw].state.pos, O.bodies[jaw].shape.radius
			lines.append(
				np.column_stack(
					[centre[0] + radius * np.sin(angles), centre[1] + up * radius * np.cos(angles)]
				)
			)
		return lines

	@property
	def strain(self):
		"""Approach of the jaws over the diameter [-]."""
		bottom, top = (O.bodies[jaw].state.displ()[1] for jaw in (self.bottom, self.top))
		return (bottom - top) / self.height


def disc_stress(load, diameter, length, x, y):
	"""Stress (3,): σ_x, σ_y, τ_xy [Pa], tension positive, of an elastic disc under two opposite line loads,
	in plane stress or strain (Timoshenko and Goodier 1970, § 41): two half-plane solutions and a uniform tension.

	:param load: P, along y [N]
	:param diameter, length: D, L [m]
	:param x, y: from the centre, of any shape [m]; the loads act at y = ±D/2
	"""
	x, y, radius = np.asarray(x, float), np.asarray(y, float), 0.5 * diameter
	below, above = radius + y, radius - y
	lower, upper = (x**2 + below**2)**2, (x**2 + above**2)**2
	scale = -2 * load / (math.pi * length)
	return np.stack([
		scale * (x**2 * below / lower + x**2 * above / upper - 1 / diameter),
		scale * (below**3 / lower + above**3 / upper - 1 / diameter),
		scale * x * (below**2 / lower - above**2 / upper),
	])
