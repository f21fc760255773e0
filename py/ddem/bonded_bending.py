# GPL v2 or later, see LICENSE.
"""Three-point bending of a beam of bonded spheres: supports, load, deflection, flexural strength::

	beam = ddem.packing.fill(ddem.packing.Box((0, 0, 0), (0.08, 0.02, 0.02)), 0.8e-3, 2e-3)
	sample = ddem.bonded.append(ddem.packing.notched(beam, 0.006), "rock")  # or beam itself
	bending = ddem.bonded.three_point_bending(sample, span=0.06, velocity=0.05, notch=0.006)
	O.engines = ddem.bonded.engines(bending)

The beam lies along x, the load acts along y, downwards. SI units.
"""
import math

import numpy as np

from yade import (
	BondedInteractionLoop, Box, ElasticWallMat, Ip2_ElasticWallMat_BondedMat_ElasticWallPhys, O,
	RampedTranslationEngine, Wall, utils
)

from . import scene_notes
from .arrays import BodyIds
from .cells import require_faces

_SKIN = 1.1  # distance of a centre from a face, in radii, up to which a strip holds it, as platens do
GAUGES = ("above the left support", "at mid-span", "above the right support")  #: where the deflection is measured


def three_point_bending(sample, span, velocity, ramp=0.0, strip=None, stiffness=None, notch=0.0):
	"""Support a beam on two strips and push a plate as narrow down on it half way between them.

	A support holds the spheres of the face within its width with springs across the face alone: its reaction is
	vertical whatever the roughness of the packing, the beam is free to slide, to lengthen and, as strips are
	narrow, to rotate on it. The load is a smooth plate that only pushes.

	:param sample: :class:`bonded.BondedSample` of a prism, longest along x
	:param span: distance of the supports, the sample's middle between them [m]
	:param velocity: of the load, downwards [m/s]
	:param ramp: time over which it grows linearly from zero [s]
	:param strip: width of supports and load along the beam [m]. None: two mean radii, or a tenth of the height if
		that is more.
	:param stiffness: K of the strips [Pa]; a sphere of radius r feels the spring π r K. None: a tenth of the
		Young's modulus of the bonds: what the strips resist to rotation then stiffens a beam three times as
		long as high by less than a hundredth; strips as stiff as the bonds do so by a tenth.
	:param notch: depth of the notch beneath the load [m], which :func:`packing.notched` has made; stresses refer to
		the section above it.
	:returns: :class:`Bending`; hand it to :func:`bonded.engines`
	:raises ValueError: numbers out of range, a sample that is no prism or no beam, supports that do not lie below
		it, a strip that overlaps another or has no sphere. Nothing is appended then.
	"""
	require_faces()
	length, height, depth = _beam(sample)
	for name, value, unit in (("span", span, "m"), ("velocity", velocity, "m/s")):
		if not (value > 0 and math.isfinite(value)):
			raise ValueError(f"three_point_bending: {name} = {value} {unit} must be positive and finite")
	if not (ramp >= 0 and math.isfinite(ramp)):
		raise ValueError(f"three_point_bending: ramp = {ramp} s must not be negative")
	if not 0 <= notch < height:
		raise ValueError(
			f"three_point_bending: notch = {notch} m must lie between 0 and the height of the beam, "
			f"{height:.6g} m"
		)
	radii, young = sample.radii, max(O.bodies[i].mat.young for i in sample.ids)
	width = max(2 * float(radii.mean()), 0.1 * height) if strip is None else strip
	if not (width > 0 and math.isfinite(width)):
		raise ValueError(f"three_point_bending: strip = {width} m must be positive and finite")
	if span + width > length * (1 + 1e-9):
		raise ValueError(
			f"three_point_bending: span = {span} m and a strip {width:.6g} m wide do not lie below a beam "
			f"{length:.6g} m long; choose a span of at most {length - width:.6g} m"
		)
	if span < 2 * width:
		raise ValueError(
			f"three_point_bending: span = {span} m leaves no room between strips {width:.6g} m wide; "
			"make it longer"
		)
	material = ElasticWallMat(stiffness=0.1 * young if stiffness is None else stiffness)
	middle = 0.5 * (sample.lower + sample.upper)
	held = [
		_strip(sample, middle[0] + offset * span, width, face)
		for offset, face in ((-0.5, sample.lower[1]), (0.5, sample.lower[1]), (0, sample.upper[1]))
	]
	O.materials.append(material)
	bodies = []
	for spheres in held[:2]:
		# The wall only carries the springs. It stands off the beam, so that no other sphere meets it.
		wall = utils.wall(float(sample.lower[1]) - height, axis=1, sense=0, material=material)
		bodies.append(O.bodies.append(wall))
		Ip2_ElasticWallMat_BondedMat_ElasticWallPhys().bond(bodies[-1], spheres)
	# the plate touches the highest of its spheres
	face = max(O.bodies[i].state.pos[1] + O.bodies[i].shape.radius for i in held[2])
	plate = utils.box(
		(float(middle[0]), face + 0.5 * height, float(middle[2])), (0.5 * width, 0.5 * height, depth),
		material=material, fixed=True
	)
	bodies.append(O.bodies.append(plate))
	bending = Bending(sample, bodies, span, velocity, ramp, notch, width)
	scene_notes.add(
		"bending", bodies, span=span, notch=notch, strip=width, gauges=[ids.tolist() for ids in bending.gauges]
	)
	return bending


def _beam(sample):
	"""Length, height and depth of a beam [m]."""
	size = [float(s) for s in sample.upper - sample.lower]
	if not sample.is_prism:
		raise ValueError(
			"three_point_bending: the sample must be a prism; fill a packing.Box, or give a file's box"
		)
	if size[0] < 2 * size[1]:
		raise ValueError(
			f"three_point_bending: a sample {size[0]:.6g} m long (x) and {size[1]:.6g} m high (y) is "
			"no beam; it must be longer along x than twice its height"
		)
	return size


def _strip(sample, place, width, face):
	"""Ids of the spheres at a face (y) that a strip across x = place holds."""
	centres, radii = sample.positions, sample.radii
	rows = (abs(centres[:, 1] - face) < _SKIN * radii) & (abs(centres[:, 0] - place) <= 0.5 * width)
	if not rows.any():
		raise ValueError(
			f"three_point_bending: no sphere is within {_SKIN} radii of the face y = {face:.6g} m and "
			f"{0.5 * width:.3g} m of x = {place:.6g} m; widen the strip, or change the span"
		)
	return sample.ids[rows].tolist()


class Bending:
	"""A beam on two supports under a load in its middle: what it does and what it feels; see
	:func:`three_point_bending`. It serves wherever platens do. Forces are positive as loading has them."""

	def __init__(self, sample, bodies, span, velocity, ramp, notch, strip):
		self._measure(sample, bodies, span, notch, strip)
		self.engines = [
			RampedTranslationEngine(
				ids=[self.load], translationAxis=(0, 1, 0), velocity=-velocity, rampTime=ramp
			)
		]
		self.gauges = self._near_the_axis()

	@classmethod
	def from_scene(cls, sample):
		"""The bending in the current scene, for a scene that was loaded.

		:param sample: as from :meth:`bonded.BondedSample.from_scene`
		:raises RuntimeError: the scene has no bending that :func:`three_point_bending` made, or more than one
		"""
		note = scene_notes.only("bending", (Wall, Wall, Box))
		self = cls.__new__(cls)
		self._measure(sample, note["bodies"], note["span"], note["notch"], note["strip"])
		self.engines = [
			e for e in O.engines if isinstance(e, RampedTranslationEngine) and list(e.ids) == [self.load]
		]
		self.gauges = [BodyIds(ids) for ids in note["gauges"]]
		return self

	def _measure(self, sample, bodies, span, notch, strip):
		self.sample, self.span, self.notch = sample, span, notch
		#: body ids of the walls that carry the supports, and of the plate
		self.left, self.right, self.load = bodies
		self.strip = strip  #: width of supports and load [m]
		_, self.height, self.depth = (float(s) for s in sample.upper - sample.lower)
		#: ids of the spheres whose mean way is measured, see :data:`GAUGES`
		self.gauges = None

	def _near_the_axis(self):
		"""Ids of spheres near the neutral axis above the left support, at mid-span,
		above the right support."""
		centres = self.sample.positions
		middle = 0.5 * (self.sample.lower + self.sample.upper)
		found = []
		for offset in (-0.5, 0, 0.5):
			distance = np.maximum(
				abs(centres[:, 0] - middle[0] - offset * self.span), abs(centres[:, 1] - middle[1])
			)
			# within a sixth of the height, or else the closest one
			found.append(np.flatnonzero(distance <= max(self.height / 6, 1.0001 * distance.min())))
		return [self.sample.ids[rows] for rows in found]

	@property
	def outlines(self):
		"""Lines (n, 2) [m] in the plane x, y that show supports and load in pictures."""
		lower, middle = float(self.sample.lower[1]), float(0.5 * (self.sample.lower + self.sample.upper)[0])
		wide, tall = max(0.5 * self.strip, 0.06 * self.height), 0.12 * self.height
		triangle = np.array([[0, 0], [-wide, -tall], [wide, -tall], [0, 0]])
		plate = O.bodies[self.load].state
		face = float(plate.pos[1] - 0.5 * self.height)
		notch = [[middle, lower], [middle, lower + self.notch]]
		return [np.array(notch)] * (self.notch > 0) + [
			triangle + [middle - 0.5 * self.span, lower], triangle + [middle + 0.5 * self.span, lower],
			[middle, face] + np.array(
				[
					[-0.5 * self.strip, tall],
					[-0.5 * self.strip, 0],
					[0.5 * self.strip, 0],
					[0.5 * self.strip, tall],
				]
			)
		]

	@property
	def section(self):
		"""Depth and height (2,) of the section above the notch [m]."""
		return self.depth, self.height - self.notch

	@property
	def area(self):
		"""2 b h²/(3 L) [m²]: the bending stress is the load over it."""
		depth, height = self.section
		return 2 * depth * height**2 / (3 * self.span)

	@property
	def force_top(self):
		"""Load P [N]."""
		return O.forces.f(self.load)[1]

	@property
	def force_bottom(self):
		"""Sum of both reactions [N]."""
		return -sum(self.reactions)

	@property
	def reactions(self):
		"""Vertical forces of the beam on the left and the right support [N], downwards negative."""
		return tuple(O.forces.f(wall)[1] for wall in (self.left, self.right))

	@property
	def stress(self):
		"""Bending stress of an elastic beam at its lower face, 3 P L/(2 b h²) [Pa]; its largest value is the
		flexural strength (modulus of rupture)."""
		return self.force_top / self.area

	@property
	def deflection(self):
		"""Of the neutral axis at mid-span against that above the supports, downwards [m], so that what supports
		and load press into the beam does not enter, as a yoke measures it (ASTM C1609).

		:raises RuntimeError: all spheres of one of these three gauges have been erased
		"""
		left, mid, right = (self._sinking(*gauge) for gauge in zip(GAUGES, self.gauges))
		return 0.5 * (left + right) - mid

	@staticmethod
	def _sinking(place, ids):
		"""Mean displacement along y of the spheres of a gauge [m]; those that were erased do not count."""
		there = BondedInteractionLoop.existing(ids)
		if len(there) == 0:
			named = ", ".join(f"#{i}" for i in ids[:5]) + (" …" if len(ids) > 5 else "")
			raise RuntimeError(
				f"Bending: the gauge {place}, near the neutral axis, has lost all of its {len(ids)} "
				f"spheres ({named}), which were erased: there is no deflection to measure"
			)
		return float(BondedInteractionLoop.sphereArray(there, "displacement")[:, 1].mean())

	@property
	def strain(self):
		"""Of the lower face of a slender elastic beam without a notch with that deflection, 6 δ h/L² [-]."""
		return 6 * self.deflection * self.height / self.span**2


def timoshenko_deflection(load, span, young, poisson, depth, height):
	"""Deflection at mid-span of a simply supported elastic beam of rectangular section under a load in its
	middle [m]: P L³/(48 E I) + P L/(4 κ G A), κ = 10(1+ν)/(12+11ν) (Cowper 1966).

	:param load: P [N]
	:param span: L [m]
	:param young, poisson: E [Pa], ν [-]
	:param depth, height: of the section, height along the load [m]
	"""
	inertia, area, shear = depth * height**3 / 12, depth * height, young / (2 * (1 + poisson))
	kappa = 10 * (1 + poisson) / (12 + 11 * poisson)
	return load * span**3 / (48 * young * inertia) + load * span / (4 * kappa * shear * area)
