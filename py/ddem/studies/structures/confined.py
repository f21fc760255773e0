# GPL v2 or later, see LICENSE.
"""A block crushed under lateral pressure, in plane strain: first the pressure on its sides, then the platens."""
from dataclasses import dataclass

import numpy as np

from yade import ConcreteDamageMat, DeformableEngine, ForceResetter, InterpolatingDirectedForceEngine, O, ddem

from ...series import Series
from .stepping import advance

WIDTH, HEIGHT = 0.10, 0.20  # [m]
PRESSING, RAMP = 2e-4, 2e-4  #: time over which the pressure grows, and the speed of the platens [s]


@dataclass(frozen=True)
class History:
	"""What happened to the block; compression positive."""
	mesh: object
	pressure: float  # [Pa]
	rate: float  # strain rate of the platens at full speed [1/s]
	strain: np.ndarray  # axial, from the start of the platens [-]
	stress: np.ndarray  # axial, mean of both ends [Pa]
	lateral: np.ndarray  # σ_zz, mean of the block [Pa]
	nodes: np.ndarray  # where they are at the end (n, 2) [m]
	damage: np.ndarray  # of the sub-elements at the end (m, 3) [-]
	peak_damage: float  # mean at the peak [-]
	energy_error: float  # see EnergyBalance.largest [-]

	@property
	def peak(self):
		"""(largest stress [Pa], strain there [-])."""
		row = int(self.stress.argmax())
		return float(self.stress[row]), float(self.strain[row])

	@property
	def energy(self):
		"""Work of the platens until the end over the volume of the block [J/m³]."""
		return float(np.trapezoid(self.stress, self.strain))

	@property
	def series(self):
		"""Strain and stress as a :class:`Series`."""
		return Series.of({"strain": "-", "stress": "Pa"}, strain=self.strain, stress=self.stress)

	def bands(self, width=0.015):
		"""The band of damage that rises to the right and the one that rises to the left:
		(angle to the horizontal [°], share [-]) each.

		The block is cut into parallel strips of that width [m]; share is how much of the variance of the damage
		lies between strips rather than within them, and the angle, from 40° to 85°, is that with the largest
		share. One band, as wide as a strip, in an intact block has a share of 0.5 to 1.
		"""
		return tuple(
			max(
				(
					(sum(self._share(sign * angle, width, shift) for shift in (0, 0.5)) / 2, angle)
					for angle in range(40, 86)
				)
			)[::-1]
			for sign in (1, -1)
		)

	def _share(self, angle, width, shift):
		"""Variance of the damage between strips under an angle [°] over its variance."""
		along, areas, damage = np.radians(angle), self.mesh.areas, self.damage.mean(axis=1)
		across = (self.mesh.centroids - (WIDTH / 2, HEIGHT / 2)) @ (-np.sin(along), np.cos(along))
		strip = np.floor((across - across.min()) / width + shift).astype(int)
		damage = damage - np.average(damage, weights=areas)
		strips, parts = np.bincount(strip, areas * damage), np.bincount(strip, areas)
		total = areas @ damage**2
		return float((strips**2 / np.maximum(parts, 1e-30)).sum() / total) if total > 0 else 0.0


def run(
	pressure, ends="rough", seed=1, size=0.01, pattern="crossed", velocity=0.5, strain=0.01, rotation="cosserat",
	step=0.6, records=300, recorders=()
):
	"""Press the sides, crush the block and return its :class:`History`.

	:param pressure: on the sides [Pa], a dead load on the undeformed sides
	:param ends: "rough" holds the ends laterally while the platens move, "smooth" lets them slide
	:param seed: draws the fracture energies; None: all have the mean
	:param velocity: of each platen, towards the other [m/s]
	:param strain: at which the test ends [-]
	:param step: time step over the critical one, which falls as pressure stiffens the concrete
	:param recorders: functions of the block that make a recorder; it is called at 50 moments
	"""
	O.materials.append(ConcreteDamageMat(label="concrete"))
	mesh = ddem.mesh.rectangle(
		WIDTH, HEIGHT, size, pattern=pattern, **({"seed": 1} if pattern == "unstructured" else {})
	)
	block = ddem.append(mesh, "concrete", seed=seed)
	platens = ddem.platens(block, velocity, RAMP, lateral="free", both=True)
	block.hold(_middle(block), "x")
	engine = DeformableEngine(rotation=rotation, label="deformable")
	for drive in platens.engines:
		drive.dead = True
	O.engines = [ForceResetter(), *_pressing(block, pressure), *platens.engines, engine]
	O.dt = step * engine.criticalTimeStep()
	book, writers = ddem.EnergyBalance(), [make(block) for make in recorders]
	if pressure > 0:
		engine.damping = 0.2
		ddem.run(until=2 * PRESSING, progress=False)
		engine.damping = 0.0
	if ends == "rough":
		block.hold(np.concatenate([platens.top, platens.bottom]), "xy")
	for drive in platens.engines:
		drive.dead = False

	begin, steps = platens.strain, round((strain * HEIGHT / (2 * velocity) + 0.5 * RAMP) / O.dt)

	def row():
		book.record()
		lateral = -np.average(block.stress[..., 2].mean(axis=1), weights=block.mesh.areas)
		return platens.strain - begin, platens.stress, lateral, block.damage.mean()

	rows = advance(steps, records, row, writers)
	strains, stresses, laterals, damages = np.array(rows).T
	return History(
		block.mesh, pressure, 2 * velocity / HEIGHT, strains, stresses, laterals, np.array(block.positions),
		np.array(block.sub_element_damage),
		damages[stresses.argmax()], book.largest
	)


def _middle(block):
	"""The node on the bottom that is held laterally while the ends slide."""
	bottom = block.mesh.boundary("bottom")
	return block.node_ids[[bottom[np.argmin(np.abs(block.mesh.nodes[bottom, 0] - WIDTH / 2))]]]


def _pressing(block, pressure):
	"""Engines that press both sides, the force of each node growing smoothly to that of its share of the side."""
	parts = np.linspace(0, 1, 51)
	grows = 0.5 * (1 - np.cos(np.pi * parts))
	engines = []
	for side, direction in (("left", 1), ("right", -1)):
		rows = block.mesh.boundary(side)
		rows = rows[np.argsort(block.mesh.nodes[rows, 1])]
		edges = np.diff(block.mesh.nodes[rows, 1])
		shares = 0.5 * (np.append(edges, 0) + np.insert(edges, 0, 0))
		for share in np.unique(shares.round(12)):
			ids = [int(i) for i in block.node_ids[rows[np.isclose(shares, share)]]]
			forces = pressure * share * block.thickness * grows
			engines.append(
				InterpolatingDirectedForceEngine(
					ids=ids,
					direction=(direction, 0, 0),
					times=(PRESSING * parts).tolist(),
					magnitudes=forces.tolist(),
				)
			)
	return engines


def material_point(pressure, rate, strain=0.01):
	"""The same test on one point in plane strain: axial strains [-], axial stresses and σ_zz [Pa], compression
	positive, from the start of the platens.

	Its ε_zz stays zero from the beginning, so σ_zz is what the law makes of it: with the concrete of Tables 1 and
	2, at the peak, 10, 31, 53 and 75 MPa under 0, 20, 40 and 60 MPa at 10 /s. That is why strengths are not those
	of a cylinder in a pressure cell (105, 187, 261 and 329 MPa).
	"""
	from ...materialpoint import MaterialPoint
	point = MaterialPoint()
	if pressure > 0:
		point.path(PRESSING, strain={"yy": 0.0}, stress={"xx": -pressure}, steps=200)
	result = point.path(strain / rate, strain={"yy": -strain}, stress={"xx": -pressure}, steps=round(strain / 2e-6))
	return -result.strain[:, 1], -result.stress[:, 1], -result.stress[:, 2]
