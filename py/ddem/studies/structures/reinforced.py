# GPL v2 or later, see LICENSE.
"""Concrete block with a steel bar, crushed at 10 m/s: Zubelewicz (2018), section 4.3.

10 cm wide and 20 cm tall, 800 triangles with three integration points each, a bar of 304L steel of 8 triangles in the
middle; the top moves down at full speed from the first step on, the bottom stands, both are held laterally.
Fracture energies are drawn at random.
"""
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import uniform_filter1d

from yade import (
	ConcreteDamageMat, DeformableElastMat, DeformableEngine, DeformableTimeStepper, ForceResetter, O, VonMisesMat,
	ddem
)

from .. import uniaxial
from ..runs import Run
from .spall import IMPEDANCE

WIDTH, HEIGHT, VELOCITY = 0.10, 0.20, 10.0  # [m], [m/s]
#: 1.4 cm x 1.4 cm in the middle, on its corner, as 8 triangles of the mesh make it [m]
BAR = ((0.05, 0.09), (0.06, 0.10), (0.05, 0.11), (0.04, 0.10))
STEEL = {"bulk": 151e9, "shear": 81e9, "density": 8030}  #: 304L
SIZE = 0.01  #: of the report's mesh [m]
RINGING = 5e-6  #: two periods of a row of the report's triangles, 10 mm high, that is hit at full speed [s]
RECORDS = 5e-7  #: time between records, at most [s]
INSTANTS = (20e-6, 40e-6, 70e-6, 100e-6, 250e-6)  #: of the damage maps [s]
FINAL = 600e-6  #: nothing bears and damage has stopped: the report's stage P [s]
BAND = np.sqrt(2) * SIZE / 2  #: √(2 S) of its triangles [m], for crack_band


@dataclass(frozen=True)
class Crushed:
	"""What happened to the block."""
	run: Run  # record, snapshots and figures of the test
	mesh: object
	recorders: list
	velocity: float  # of the top, downwards [m/s]
	bar_stress: float = 0.0  # largest Mises stress in the bar at any record [Pa]
	bar_plastic: float = 0.0  # largest equivalent plastic strain in the bar at the end [-]

	@property
	def times(self):
		"""Of the records [s]."""
		return self.run.series["time"]

	@property
	def wave(self):
		"""Stress ρ c_p v [Pa] of the elastic wave that the platen sends off,
		as long as the sides do not matter."""
		return IMPEDANCE * self.velocity

	@property
	def stress(self):
		"""Average normal stress on the top [Pa], compression positive, as the report plots it."""
		return self.run.series["force_top"] / WIDTH

	@property
	def dissipated(self):
		"""Energy per thickness that flow and damage have taken [J/m]."""
		return self.run.energy("plastic flow") + self.run.energy("damage")

	@property
	def smooth(self):
		"""The stress without the ringing of the first row of triangles:
		its mean over RINGING around each record [Pa]."""
		return uniform_filter1d(
			self.stress, max(1, round(RINGING / np.diff(self.times).mean())), mode="nearest"
		)

	def snapshot(self, time):
		"""The snapshot nearest to a time [s], and the displacement of its nodes (n, 2) [m]."""
		snapshot = self.run.snapshot_near(time)
		return snapshot, snapshot.nodes - self.mesh.nodes

	def damage(self, time):
		"""Damage of the triangles (m,) [-], mean of their sub-elements,
		at the snapshot nearest to a time [s]."""
		return self.run.snapshot_near(time).damage.mean(axis=1)

	def mean_damage(self, time, zone=True):
		"""Mean damage [-] by area of the concrete in a zone, as a mask of the triangles."""
		chosen = zone & (self.mesh.regions == 0)
		return float(np.average(self.damage(time)[chosen], weights=self.mesh.areas[chosen]))

	def wedge(self, top):
		"""Mask of the triangles of the wedge below the top (or above the bottom) between the diagonals that
		begin one cell of the report's mesh from its corners."""
		x, y = self.mesh.centroids.T
		return np.abs(x - WIDTH / 2) < WIDTH / 2 - SIZE - (HEIGHT - y if top else y)

	def share(self, time, low, high):
		"""Part [-] of the concrete's area whose damage lies from *low* to *high*."""
		concrete, damage = self.mesh.regions == 0, self.damage(time)
		return float(
			self.mesh.areas[concrete & (damage >= low) & (damage <= high)].sum()
			/ self.mesh.areas[concrete].sum()
		)

	def first_damaged(self, level=0.1):
		"""Centroid [m] of the triangle whose damage was the first to pass the level, as far as snapshots tell,
		and the time [s]."""
		for snapshot in self.run.snapshots:
			damage = snapshot.damage.mean(axis=1)
			if damage.max() > level:
				return self.mesh.centroids[damage.argmax()], snapshot.time
		raise ValueError(f"no triangle has a damage above {level:g}")

	def depth(self, time, level=0.1):
		"""How far below the top there is damage above the level [m]."""
		return float(HEIGHT - self.mesh.centroids[self.damage(time) > level, 1].min(initial=HEIGHT))

	def rotation(self, time, upper=True):
		"""Largest rotation [rad] of a triangle in the upper or lower half, and its centroid [m]."""
		rotation = np.where(
			(self.mesh.centroids[:, 1] > HEIGHT / 2) == upper,
			np.abs(self.run.snapshot_near(time).rotation),
			0,
		)
		return float(rotation.max()), self.mesh.centroids[rotation.argmax()]

	def spread(self, time, upper=True):
		"""Largest lateral displacement [m] of the upper or lower half."""
		_, moved = self.snapshot(time)
		return float(np.abs(moved[(self.mesh.nodes[:, 1] > HEIGHT / 2) == upper, 0]).max())

	def unloaded(self, part=0.02):
		"""When the stress on the top has fallen below a part of the wave's, of either sign, for good [s]."""
		return float(self.times[np.abs(self.stress) > part * self.wave].max(initial=0))


def mises(stress):
	"""Mises' equivalent stress of tensors (…, 4): xx, yy, zz, xy."""
	xx, yy, zz, xy = np.moveaxis(np.asarray(stress), -1, 0)
	return np.sqrt(0.5 * ((xx - yy)**2 + (yy - zz)**2 + (zz - xx)**2) + 3 * xy**2)


class _Test(uniaxial.CompressionTest):
	"""The same, with a snapshot at the first record after each of some instants [s]."""

	def __init__(self, instants, *arguments, **settings):
		super().__init__(*arguments, **settings)
		self._instants = sorted(instants, reverse=True)
		self._steel = self.specimen.sample.mesh.regions == 1
		self.bar_stress = 0.0  #: largest Mises stress in the bar at any record [Pa]

	def record(self):
		super().record()
		if self._steel.any():
			self.bar_stress = max(self.bar_stress, mises(self.specimen.sample.stress[self._steel]).max())
		if self._instants and O.time >= self._instants[-1]:
			self._instants.pop()
			self._look(files=False)


def run(
	size=SIZE, seed=1, bar=True, pattern="crossed", velocity=VELOCITY, until=6e-4, crack_band=None,
	rotation="cosserat", step=0.8, concrete=None, recorders=(), progress=False, dt=None, steel="elastic"
):
	"""Crush the block and return what happened, as :class:`Crushed`.

	:param size: of the cells [m]
	:param seed: draws the fracture energies; None: all have the mean
	:param bar: False leaves the bar out: its triangles are concrete then, all others keep their fracture energies
	:param steel: "elastic", as in the report, or "yielding": at 270 MPa, as 304L does (:yref:`VonMisesMat`)
	:param pattern: of the mesh, see :func:`yade.ddem.mesh.rectangle`
	:param velocity: of the top, downwards [m/s]
	:param until: end [s]
	:param crack_band: see :func:`yade.ddem.append`; :data:`BAND` leaves the report's mesh as it is
	:param rotation: treatment, see :yref:`DeformableEngine.rotation`
	:param step: time step over the critical one, which falls as triangles stretch
	:param dt: time step [s] instead, to compare two runs record by record
	:param concrete: attributes of :yref:`ConcreteDamageMat` that differ from Tables 1 and 2
	:param recorders: functions of the block that make a recorder, such as ``lambda block:
		vtk.Recorder(block, "out/block")``
	"""
	O.materials.append(ConcreteDamageMat(label="concrete", **(concrete or {})))  # Tables 1 and 2
	kind = {"elastic": DeformableElastMat, "yielding": VonMisesMat}[steel]
	O.materials.append(kind(label="steel", **STEEL))
	mesh = ddem.mesh.rectangle(
		WIDTH, HEIGHT, size, pattern=pattern, regions={"bar": BAR},
		**({"seed": 1} if pattern == "unstructured" else {})
	)
	block = ddem.append(
		mesh, {"": "concrete", "bar": "steel" if bar else "concrete"}, seed=seed, crack_band=crack_band
	)
	platens = ddem.platens(block, velocity)
	# crushed to zero bearing capacity and on: single triangles turn inside out then
	engine = DeformableEngine(rotation=rotation, inverted="warn", label="deformable")
	# triangles stretch to several times their size while they turn
	followers = [] if dt else [DeformableTimeStepper(safety=step)]
	O.engines = [ForceResetter(), *platens.engines, *followers, engine]
	critical = engine.criticalTimeStep()
	O.dt = dt or step * critical
	made = [make(block) for make in recorders]
	rows = max(uniaxial.SNAPSHOTS, round(until / RECORDS))
	test = _Test((*INSTANTS, FINAL), platens, until, stop=0, recorders=made, critical_dt=critical, rows=rows)
	run = test.run(progress=progress)
	plastic = np.asarray(block.plastic_strain)[block.mesh.regions == 1] if bar else np.zeros((1, 4))
	equivalent = np.sqrt(2 / 3 * ((plastic**2).sum(axis=-1) + plastic[..., 3]**2))
	return Crushed(run, block.mesh, made, velocity, float(test.bar_stress), float(equivalent.max()))


class Fields:
	"""A recorder that keeps the stress of the triangles: xx, yy, zz, xy (m, 4) [Pa], with the time [s]."""

	def __init__(self, block):
		self.block, self.times, self.stresses = block, [], []

	def __call__(self):
		self.times.append(O.time)
		self.stresses.append(self.block.stress.mean(axis=1))

	def at(self, time):
		"""The stresses nearest to a time [s]."""
		return self.stresses[int(np.argmin(np.abs(np.array(self.times) - time)))]

	def compression(self, zone, until):
		"""Largest vertical compression [Pa] until a time [s], mean of the triangles in a zone."""
		return float(
			max(-stress[zone, 1].mean() for time, stress in zip(self.times, self.stresses) if time <= until)
		)
