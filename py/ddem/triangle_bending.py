# GPL v2 or later, see LICENSE.
"""Three-point bending of a beam of deformable triangles: supports, load, deflection::

	beam = ddem.append(ddem.mesh.rectangle(0.4, 0.05, size=0.005), "concrete", thickness=0.05)
	bending = ddem.three_point_bending(beam, span=0.3, velocity=0.05, ramp=1e-3)
	O.engines = [ForceResetter(), *bending.engines, DeformableEngine()]

The beam lies along x, the load acts along y, downwards. In plane strain it is stiffer than a beam by 1/(1−ν²), see
:func:`plane_strain_deflection`. SI units.
"""
import math

import numpy as np

from yade import RampedTranslationEngine


def three_point_bending(block, span, velocity, ramp=0.0, strip=None):
	"""Support a beam at two nodes of its bottom and push a strip of its top down half way between them.

	Supports are free to slide and to turn the beam on them; the loaded strip neither slides nor turns.

	:param block: :class:`Block`, a rectangle, longest along x
	:param span: distance of the supports, the beam's middle between them [m]
	:param velocity: of the load, downwards [m/s]
	:param ramp: time over which it grows linearly from zero [s]
	:param strip: width of the load along the beam [m]; None: a fifth of the height. Where no node lies there, the
		closest is taken. A strip that does not turn stiffens the beam, see :func:`plane_strain_deflection`.
	:returns: :class:`Bending`; put its ``engines`` into O.engines before the DeformableEngine.
	:raises ValueError: numbers out of range, a block that is no beam. Nothing is held then.
	"""
	low, high = block.mesh.nodes.min(axis=0), block.mesh.nodes.max(axis=0)
	length, height = high - low
	if length < 2 * height:
		raise ValueError(
			f"three_point_bending: a block {length:.6g} m long (x) and {height:.6g} m high (y) is "
			"no beam; it must be longer along x than twice its height"
		)
	for name, value, unit in (("span", span, "m"), ("velocity", velocity, "m/s")):
		if not 0 < value < math.inf:
			raise ValueError(f"three_point_bending: {name} = {value} {unit} must be positive and finite")
	if not 0 <= ramp < math.inf:
		raise ValueError(f"three_point_bending: ramp = {ramp} s must be finite and not negative")
	if span > length * (1 + 1e-9):
		raise ValueError(
			f"three_point_bending: span = {span} m must not exceed the beam's length, {length:.6g} m"
		)
	strip = 0.2 * height if strip is None else strip
	if not 0 < strip < span:
		raise ValueError(
			f"three_point_bending: strip = {strip} m must lie between 0 and the span of {span} m"
		)
	return Bending(block, span, velocity, ramp, strip)


class Bending:
	"""A beam on two supports under a load in its middle: what it does and what it feels; see
	:func:`three_point_bending`. It serves wherever platens do. Forces are positive as loading has them."""

	notch = 0.0  #: depth of a notch, which this section has not [m]

	def __init__(self, block, span, velocity, ramp, strip):
		mesh, self.sample, self.span = block.mesh, block, span
		low, high = mesh.nodes.min(axis=0), mesh.nodes.max(axis=0)
		middle = 0.5 * (low[0] + high[0])
		self.height = float(high[1] - low[1])
		#: depth and height (2,) of the section [m]
		self.section = block.thickness, self.height
		top, bottom = mesh.boundary("top"), mesh.boundary("bottom")
		away = np.abs(mesh.nodes[top, 0] - middle)
		self._loaded = top[away <= max(0.5 * strip, away.min()) * (1 + 1e-9)]
		places = middle + np.array([-0.5, 0.5]) * span
		#: width of the load, as its nodes have it [m]; 0: one node
		self.strip = float(np.ptp(mesh.nodes[self._loaded, 0]))
		self._stands = bottom[[np.argmin(np.abs(mesh.nodes[bottom, 0] - x)) for x in places]]
		# the nodes say where it really stands
		self.span = float(np.diff(mesh.nodes[self._stands, 0])[0])
		axis = 0.5 * (low[1] + high[1])
		self._gauges = [_place(mesh, (x, axis)) for x in (*mesh.nodes[self._stands, 0], middle)]
		block.hold(block.node_ids[self._stands], "y")
		block.hold(block.node_ids[self._loaded], "xy")
		self.engines = [
			RampedTranslationEngine(
				ids=[int(i) for i in block.node_ids[self._loaded]], translationAxis=(0, -1, 0),
				velocity=velocity, rampTime=ramp
			)
		]

	@property
	def area(self):
		"""2 b h²/(3 L) [m²]: the bending stress is the load over it."""
		depth, height = self.section
		return 2 * depth * height**2 / (3 * self.span)

	@property
	def force_top(self):
		"""Load P [N]."""
		return float(self.sample.node_forces[self._loaded, 1].sum())

	@property
	def force_bottom(self):
		"""Sum of both reactions [N]."""
		return float(-self.sample.node_forces[self._stands, 1].sum())

	@property
	def stress(self):
		"""Bending stress of an elastic beam at its lower face, 3 P L/(2 b h²) [Pa]; its largest value is the
		flexural strength (modulus of rupture)."""
		return self.force_top / self.area

	@property
	def deflection(self):
		"""Of the neutral axis at mid-span against that above the supports, downwards [m], so that what supports
		and load press into the beam does not enter, as a yoke measures it (ASTM C1609)."""
		moved = self.sample.displacements[:, 1]
		left, right, middle = (float(weights @ moved[corners]) for corners, weights in self._gauges)
		return 0.5 * (left + right) - middle

	@property
	def strain(self):
		"""Of the lower face of a slender elastic beam with that deflection, 6 δ h/L² [-]."""
		return 6 * self.deflection * self.height / self.span**2


def plane_strain_deflection(load, span, young, poisson, depth, height):
	"""Deflection at mid-span of a simply supported elastic beam in plane strain under a load in its middle [m],
	with the stresses about the load: P L³/(48 E' I) + P L/(b h) (3/(8 G) − 3/(20 E') − 3 ν'/(8 E')) − 0.21 P/(E'
	b), E' = E/(1−ν²), ν' = ν/(1−ν) (Timoshenko and Goodier, Theory of Elasticity).

	:param load: P [N]
	:param span: L [m]
	:param young, poisson: E [Pa], ν [-]
	:param depth, height: b and h of the section, height along the load [m]

	Limits: of loads at points. Triangles loaded at one node tend to 0.1 % less where the span is eight heights, to
	0.5 % less where it is four; a load 0.25 h wide that does not turn takes another 2 % and 4 %.
	"""
	wide, lateral, shear = young / (1 - poisson**2), poisson / (1 - poisson), young / (2 * (1 + poisson))
	slender = load * span**3 / (4 * wide * depth * height**3)
	sheared = load * span / (depth * height) * (3 / (8 * shear) - 3 / (20 * wide) - 3 * lateral / (8 * wide))
	return slender + sheared - 0.21 * load / (wide * depth)


def _place(mesh, point):
	"""Nodes (3,) of the triangle that holds a point, and their shares (3,) in what a linear field has there."""
	corners = mesh.nodes[mesh.triangles]
	first, edges = corners[:, 0], corners[:, 1:] - corners[:, :1]
	along = np.linalg.solve(np.swapaxes(edges, 1, 2), (np.asarray(point) - first)[..., None])[..., 0]
	shares = np.column_stack([1 - along.sum(axis=1), along])
	row = int(np.argmax(shares.min(axis=1)))  # the one that the point lies deepest in
	return mesh.triangles[row], shares[row]
