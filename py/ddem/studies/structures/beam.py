# GPL v2 or later, see LICENSE.
"""Notched beam in three-point bending, in plane strain: a crack grows from the notch to the load.

The beam stands on two nodes and is pushed by the nodes of a strip on the top, whose speed grows to 0.05 m/s. Inertia is
measured: by the difference between the load and the reactions of the supports, and by the kinetic energy. Around
supports and load the concrete is elastic, so that it does not crush there.
"""
from dataclasses import dataclass

import numpy as np
from scipy.integrate import cumulative_trapezoid

from yade import (
	ConcreteDamageMat, DeformableElastMat, DeformableEngine, ForceResetter, O, RampedTranslationEngine, ddem
)

from ...materialpoint import MaterialPoint, concrete
from ...series import Series
from .stepping import advance

LENGTH, HEIGHT, SPAN, NOTCH, SLOT = 0.44, 0.10, 0.40, 0.03, 0.004  #: notch: its depth, slot: its width [m]
PAD = 0.012  #: half the width of elastic concrete at supports and load [m]
CONCRETE = {"bulk": 30e9, "shear": 26e9, "density": 2400}
MODULUS = 4 * 26e9 * (3 * 30e9 + 26e9) / (3 * 30e9 + 4 * 26e9)  #: E/(1 − ν²) of this concrete [Pa]
ENERGY, BAND = 4e3, 0.007  #: fracture energy [J/m³], a twentieth of Table 2's, and the width for which it holds [m]


@dataclass(frozen=True)
class History:
	"""What happened to the beam."""
	mesh: object
	deflection: np.ndarray  # of the load [m]
	force: np.ndarray  # per thickness [N/m]
	opening: np.ndarray  # of the notch's mouth [m]
	dissipated: np.ndarray  # by flow and damage, per thickness [J/m]
	reaction: np.ndarray  # of both supports, per thickness [N/m]
	kinetic: np.ndarray  # energy, per thickness [J/m]
	nodes: np.ndarray  # where they are at the end (n, 2) [m]
	damage: np.ndarray  # of the sub-elements at the end (m, 3) [-]
	energy_error: float  # see EnergyBalance.largest [-]

	@property
	def work(self):
		"""Of the load until each record, per thickness [J/m]."""
		return cumulative_trapezoid(self.force, self.deflection, initial=0)

	@property
	def series(self):
		"""What is recorded, as a :class:`Series`."""
		units = {
			"deflection": "m", "force": "N/m", "reaction": "N/m", "opening": "m", "dissipated": "J/m",
			"kinetic": "J/m"
		}
		return Series.of(units, **{name: getattr(self, name) for name in units})

	@property
	def imbalance(self):
		"""Largest difference between load and reactions over the largest load [-]:
		what inertia takes part in."""
		return np.abs(self.force - self.reaction).max() / self.force.max()

	@property
	def kinetic_share(self):
		"""Largest kinetic energy over the work of the load [-], from half the largest load on."""
		loaded = slice(int(np.argmax(self.force > 0.5 * self.force.max())), None)
		return (self.kinetic[loaded] / self.work[loaded]).max()

	def crack(self, low=NOTCH, high=HEIGHT - 0.015):
		"""Where the crack runs: heights [m] and its x [m], the mean place of the damage in
		strips above the notch."""
		centres, damage = self.mesh.centroids, self.damage.mean(axis=1)
		weights = np.where(damage > 0.5, damage, 0) * self.mesh.areas
		edges = np.linspace(low, high, 9)
		strips = [(centres[:, 1] >= a) & (centres[:, 1] < b) & (weights > 0) for a, b in zip(edges, edges[1:])]
		found = [
			(0.5 * (a + b), np.average(centres[strip, 0], weights=weights[strip]))
			for a, b, strip in zip(edges, edges[1:], strips)
			if strip.any()
		]
		return np.array(found).reshape(-1, 2).T


def mesh(size=0.005, coarse=0.015, seed=None):
	"""Irregular mesh, of *size* [m] in the middle and *coarse* towards the ends;
	regions "left", "right" and "top" are the elastic pads."""
	middle, half = LENGTH / 2, SLOT / 2
	outline = [
		(0, 0), (middle - half, 0), (middle - half, NOTCH), (middle + half, NOTCH), (middle + half, 0),
		(LENGTH, 0), (LENGTH, HEIGHT), (0, HEIGHT)
	]
	left, right = 0.5 * (LENGTH - SPAN), 0.5 * (LENGTH + SPAN)
	pads = {
		"left": ddem.mesh.box(left - PAD, 0, left + PAD, PAD),
		"right": ddem.mesh.box(right - PAD, 0, right + PAD, PAD),
		"top": ddem.mesh.box(middle - PAD, HEIGHT - PAD, middle + PAD, HEIGHT)
	}
	field = lambda x, y: min(coarse, size + 0.25 * max(0.0, abs(x - middle) - 0.03))
	return ddem.mesh.polygon(outline, size=field, regions=pads, seed=seed)


def opening_compliance():
	"""Opening of the notch's mouth over the load per thickness [m²/N] of the elastic beam: Tada, Paris and Irwin,
	The stress analysis of cracks handbook (1985), p. 2.16.

	For a sharp crack and a span of four times the height, 4 σ a V₁(a/W)/E' with σ = 3PS/2W² and V₁ within 1 %;
	E' = E/(1 − ν²) in plane strain.
	"""
	a = NOTCH / HEIGHT
	v1 = 0.76 - 2.28 * a + 3.87 * a**2 - 2.04 * a**3 + 0.66 / (1 - a)**2
	return 4 * 1.5 * SPAN / HEIGHT**2 * NOTCH * v1 / MODULUS


def crack_energy(opening, duration, energy=ENERGY):
	"""(tensile strength [Pa], energy per area [J/m²]) of a band of the width :data:`BAND` that opens so far [m] in
	that time [s]: a material point in tension.

	There is no energy per area at which the crack is open: with σ falling as 1/Ω² (see :mod:`yade.ddem.crackband`)
	it grows as the cube root of the opening.
	"""
	point = MaterialPoint(concrete(fractureEnergy=energy)).path(
		duration, strain={"xx": opening / BAND}, stress={"yy": 0.0}, steps=round(opening / BAND / 1e-5)
	)
	return point.stress[:, 0].max(), BAND * (point.plastic_dissipation[-1] + point.damage_dissipation[-1])


def bending_strength(tensile_strength):
	"""Load per thickness [N/m] at which the section above the notch, bent elastically without a notch's effect, has
	that stress [Pa] at its edge."""
	return tensile_strength * (HEIGHT - NOTCH)**2 / 6 * 4 / SPAN


def toughness_strength(energy):
	"""Load per thickness [N/m] at which a sharp crack of the notch's depth grows, if it takes that energy [J/m²]:
	K² = G E', with K of ASTM E399, annex A3."""
	a = NOTCH / HEIGHT
	shape = (
		3
		* np.sqrt(a)
		* (1.99 - a * (1 - a) * (2.15 - 3.93 * a + 2.7 * a**2))
		/ (2 * (1 + 2 * a) * (1 - a)**1.5)
	)
	return np.sqrt(energy * MODULUS) * HEIGHT**1.5 / (SPAN * shape)


def run(
	size=0.005, velocity=0.05, ramp=4e-3, deflection=3e-4, energy=ENERGY, crack_band=None, seed=None, elastic=False,
	step=0.8, records=300, recorders=()
):
	"""Bend the beam and return its :class:`History`.

	:param size: of the mesh in the middle [m]
	:param velocity, ramp: of the load, downwards [m/s], and the time over which it grows [s]
	:param deflection: at which the test ends [m]
	:param energy: fracture energy per volume [J/m³]
	:param crack_band: width [m] for which it holds, see :func:`yade.ddem.append`
	:param seed: draws another mesh
	:param elastic: leave flow, damage and equation of state out
	:param recorders: functions of the block that make a recorder; it is called at 50 moments
	"""
	O.materials.append(DeformableElastMat(label="elastic", **CONCRETE))
	O.materials.append(ConcreteDamageMat(label="concrete", fractureEnergy=energy))
	pads = dict.fromkeys(("left", "right", "top"), "elastic")
	block = ddem.append(
		mesh(size, seed=seed), {"": "elastic" if elastic else "concrete", **pads}, crack_band=crack_band
	)
	loaded, stands = supports(block)
	push = RampedTranslationEngine(
		ids=[int(i) for i in block.node_ids[loaded]],
		translationAxis=(0, -1, 0),
		velocity=velocity,
		rampTime=ramp,
	)
	engine = DeformableEngine(label="deformable")
	O.engines = [ForceResetter(), push, engine]
	O.dt = step * engine.criticalTimeStep()
	book, writers = ddem.EnergyBalance(), [make(block) for make in recorders]
	x, y = block.mesh.nodes.T
	mouth = [int(np.argmin(np.hypot(x - LENGTH / 2 - side * SLOT / 2, y))) for side in (-1, 1)]

	steps = round((deflection / velocity + 0.5 * ramp) / O.dt)

	def row():
		parts, moved, forces = book.record(), block.displacements, block.node_forces[:, 1] / block.thickness
		return (
			-moved[loaded, 1].mean(), forces[loaded].sum(), moved[mouth[1], 0] - moved[mouth[0], 0],
			(parts.get("plasticFlow", 0) + parts.get("damage", 0)) / block.thickness, -forces[stands].sum(),
			parts["kinetic"] / block.thickness
		)

	rows = advance(steps, records, row, writers)
	return History(
		block.mesh, *np.array(rows).T, np.array(block.positions), np.array(block.sub_element_damage),
		book.largest
	)


def supports(block):
	"""Hold the supports and the loaded strip; rows of the loaded nodes and of the two supports."""
	x, y = block.mesh.nodes.T
	stands = [int(np.argmin(np.hypot(x - place, y))) for place in (0.5 * (LENGTH - SPAN), 0.5 * (LENGTH + SPAN))]
	block.hold(block.node_ids[stands], "y")
	top = block.mesh.boundary("top")
	loaded = top[np.abs(x[top] - LENGTH / 2) <= PAD / 2]
	block.hold(block.node_ids[loaded], "xy")  # what pushes does not let the beam slide either
	return loaded, stands
