# GPL v2 or later, see LICENSE.
"""Concrete block with a steel bar, crushed at 10 m/s: Zubelewicz (2018), section 4.3.

10 cm wide and 20 cm tall, 800 triangles with three integration points each, a bar of 304L steel of 8 triangles in the middle; the top moves down at full speed
from the first step on, the bottom stands, both are held laterally. Fracture energies are drawn at random.
"""
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import uniform_filter1d

from yade import ConcreteDamageMat, DeformableElastMat, DeformableEngine, ForceResetter, O, ddem

from .. import ucs
from ..runs import Run

WIDTH, HEIGHT, VELOCITY = 0.10, 0.20, 10.0  # [m], [m/s]
BAR = ((0.05, 0.09), (0.06, 0.10), (0.05, 0.11), (0.04, 0.10))  #: 1.4 cm x 1.4 cm in the middle, on its corner, as 8 triangles of the mesh make it [m]
STEEL = {"bulk": 151e9, "shear": 81e9, "density": 8030}  #: 304L
SIZE = 0.01  #: of the report's mesh [m]
RINGING = 5e-6  #: two periods of a row of the report's triangles, 10 mm high, that is hit at full speed [s]
RECORDS = 1e-6  #: time between records, at most [s]
BAND = np.sqrt(2) * SIZE / 2  #: √(2 S) of its triangles [m], for crack_band


@dataclass(frozen=True)
class Crushed:
	"""What happened to the block."""
	run: Run  # record, snapshots and figures of the test
	mesh: object
	recorders: list

	@property
	def times(self):
		"""Of the records [s]."""
		return self.run.series["time"]

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
		"""The same without the ringing of the first row of triangles: its mean over RINGING around each record [Pa]."""
		return uniform_filter1d(self.stress, max(1, round(RINGING / np.diff(self.times).mean())), mode="nearest")

	def snapshot(self, time):
		"""The snapshot nearest to a time [s], and the displacement of its nodes (n, 2) [m]."""
		snapshot = self.run.snapshot_near(time)
		return snapshot, snapshot.nodes - self.mesh.nodes


def run(
	size=SIZE, seed=1, bar=True, pattern="crossed", velocity=VELOCITY, until=6e-4, crack_band=None, rotation="cosserat", step=0.8, concrete=None, recorders=(),
	progress=False
):
	"""Crush the block and return what happened, as :class:`Crushed`.

	:param size: of the cells [m]
	:param seed: draws the fracture energies; None: all have the mean
	:param bar: False leaves the bar out: its triangles are concrete then, all others keep their fracture energies
	:param pattern: of the mesh, see :func:`yade.ddem.mesh.rectangle`
	:param velocity: of the top, downwards [m/s]
	:param until: end [s]
	:param crack_band: see :func:`yade.ddem.append`; :data:`BAND` leaves the report's mesh as it is
	:param rotation: treatment, see :yref:`DeformableEngine.rotation`
	:param step: time step over the critical one
	:param concrete: attributes of :yref:`ConcreteDamageMat` that differ from Tables 1 and 2
	:param recorders: functions of the block that make a recorder, such as ``lambda block: vtk.Recorder(block, "out/block")``
	"""
	O.materials.append(ConcreteDamageMat(label="concrete", **(concrete or {})))  # Tables 1 and 2
	O.materials.append(DeformableElastMat(label="steel", **STEEL))
	mesh = ddem.mesh.rectangle(WIDTH, HEIGHT, size, pattern=pattern, regions={"bar": BAR}, **({"seed": 1} if pattern == "unstructured" else {}))
	block = ddem.append(mesh, {"": "concrete", "bar": "steel" if bar else "concrete"}, seed=seed, crack_band=crack_band)
	platens = ddem.platens(block, velocity)
	engine = DeformableEngine(rotation=rotation, label="deformable")
	O.engines = [ForceResetter(), *platens.engines, engine]
	critical = engine.criticalTimeStep()
	O.dt = step * critical
	made = [make(block) for make in recorders]
	test = ucs.CompressionTest(platens, until, stop=0, recorders=made, critical_dt=critical, rows=max(ucs.ROWS, round(until / RECORDS)))
	return Crushed(test.run(progress=progress), block.mesh, made)


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
