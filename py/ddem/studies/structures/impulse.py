# GPL v2 or later, see LICENSE.
"""Elastic block under a horizontal impulse on its side: Zubelewicz (2018), section 4.2.

The report prints the block, 10 cm x 40 cm of 1600 triangles, and its constants (Table 1, no equation of state); of the
impulse it says that it is horizontal and acts on a side. Here it is a pressure on the left side that grows and falls
smoothly; the other sides are free.
"""
from dataclasses import dataclass

import numpy as np
from scipy.integrate import cumulative_trapezoid
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from yade import DeformableElastMat, DeformableEngine, ForceResetter, InterpolatingDirectedForceEngine, O, ddem

WIDTH, HEIGHT = 0.10, 0.40  # [m]
INSTANTS = (20e-6, 50e-6, 100e-6)  #: of the fields [s]
CONCRETE = {"bulk": 30e9, "shear": 26e9, "density": 2400, "rotationStiffness": 2.0}  #: Zubelewicz (2018), Table 1

#: pressure over its largest value, of the time over the duration
SHAPES = {
	"sine-squared": lambda t: np.sin(np.pi * t)**2,
	"half-sine": lambda t: np.sin(np.pi * t),
	"triangle": lambda t: 1 - np.abs(2 * t - 1),
	# without jumps, whose momentum would depend on where the steps fall
	"trapezoid": lambda t: np.clip(10 * np.minimum(t, 1 - t), 0, 1),
}


@dataclass(frozen=True)
class Impulse:
	"""A pressure on the middle of the left side."""
	shape: str = "sine-squared"  # one of SHAPES
	pressure: float = 10e6  # largest [Pa]
	duration: float = 40e-6  # [s]
	patch: float = HEIGHT  # height of the loaded part [m]

	def __post_init__(self):
		if self.shape not in SHAPES:
			raise ValueError(f"impulse: shape {self.shape!r} is unknown; there are {', '.join(SHAPES)}")
		if not 0 < abs(self.pressure) < np.inf:
			raise ValueError(
				f"impulse: pressure = {self.pressure} Pa must be a number other than zero; a negative "
				"one pulls"
			)
		if not 0 < self.duration < np.inf:
			raise ValueError(f"impulse: duration = {self.duration} s must be positive")
		if not 0 < self.patch <= HEIGHT:
			raise ValueError(
				f"impulse: patch = {self.patch} m must be positive and no larger than the side, "
				f"{HEIGHT} m"
			)

	@property
	def table(self):
		"""Times [s] and pressures [Pa], between which the pressure is linear; zero afterwards."""
		parts = np.linspace(0, 1, 201)
		pressures = self.pressure * SHAPES[self.shape](parts)
		return self.duration * np.append(parts, 1 + 1e-9), np.append(pressures, 0.0)

	def at(self, time):
		"""Pressure at a time [s] or times [Pa]."""
		return np.interp(time, *self.table)

	@property
	def momentum(self):
		"""What it brings in per thickness, from the beginning to the end [N·s/m]."""
		return float(np.trapezoid(self.table[1], self.table[0])) * self.patch

	def rigid(self, times):
		"""Displacement [m] at times [s], from zero on in small steps, of a rigid block of that mass: what is
		left of a displacement is deformation."""
		pushed = self.at(times) * self.patch / (CONCRETE["density"] * WIDTH * HEIGHT)
		velocity = cumulative_trapezoid(pushed, times, initial=0)
		return cumulative_trapezoid(velocity, times, initial=0)

	def shares(self, mesh):
		"""Nodes that are loaded, and their force per pressure and thickness [m],
		that of linear displacement along the edges."""
		side = mesh.boundary("left")
		side = side[np.argsort(mesh.nodes[side, 1])]
		y = mesh.nodes[side, 1]
		low, high = 0.5 * (HEIGHT - self.patch), 0.5 * (HEIGHT + self.patch)
		shares = np.zeros(len(side))
		for k, (a, b) in enumerate(zip(y, y[1:])):
			start, end = max(a, low), min(b, high)
			if end > start:
				right = 0.5 * (start + end - 2 * a) / (b - a) * (end - start)
				shares[k:k + 2] += (end - start - right, right)
		return side[shares > 0], shares[shares > 0]


@dataclass(frozen=True)
class History:
	"""What happened to the block."""
	mesh: object  # as in the scene
	impulse: Impulse
	dt: float  # [s]
	times: np.ndarray  # of the records [s]
	centre: np.ndarray  # displacement of the central node at these times (n, 2) [m]
	instants: np.ndarray  # [s]
	fields: list  # displacement of the nodes at the instants, (nodes, 2) each [m]
	velocity: float  # mean along x at the end [m/s]
	energy_error: float  # see EnergyBalance.largest [-]


def central_node(mesh):
	"""Row of the node closest to the centre of the block."""
	return int(np.argmin(np.linalg.norm(mesh.nodes - (WIDTH / 2, HEIGHT / 2), axis=1)))


def regions(mesh, values, part=0.1):
	"""Number of separate regions of the mesh in which nodal values have one sign and more than a part of the
	largest size: how rich a pattern is."""
	sign = np.sign(values) * (np.abs(values) > part * np.abs(values).max())
	first, second = np.concatenate([mesh.triangles[:, [k, (k + 1) % 3]] for k in range(3)]).T
	joined = (sign[first] == sign[second]) & (sign[first] != 0)
	edges = coo_matrix((np.ones(joined.sum()), (first[joined], second[joined])), (len(sign), len(sign)))
	_, labels = connected_components(edges, directed=False)
	return len(np.unique(labels[sign != 0]))


def run(
	size=0.01, impulse=Impulse(), rotation="cosserat", until=200e-6, instants=INSTANTS, step=0.8, recorders=(),
	files=50
):
	"""Build the block, push it and return its :class:`History`.

	:param size: of the crossed cells [m]; 0.01 gives the report's 1600 triangles
	:param rotation: treatment, see :yref:`DeformableEngine.rotation`
	:param until: end [s]
	:param instants: times of the fields [s], moved to the nearest even step
	:param step: time step over the critical one
	:param recorders: functions of the block that make a recorder, such as ``lambda block: vtk.Recorder(block,
		"out/block")``; it is called at *files* moments
	"""
	O.materials.append(DeformableElastMat(label="elastic", **CONCRETE))
	block = ddem.append(ddem.mesh.rectangle(WIDTH, HEIGHT, size), "elastic")
	nodes, shares = impulse.shares(block.mesh)
	moments, pressures = impulse.table
	pushes = [
		InterpolatingDirectedForceEngine(
			ids=[int(i) for i in block.node_ids[nodes[np.isclose(shares, share)]]], direction=(1, 0, 0),
			times=moments.tolist(),
			magnitudes=(pressures * share * block.thickness).tolist()
		) for share in np.unique(shares.round(12))
	]
	engine = DeformableEngine(rotation=rotation, label="deformable")
	O.engines = [ForceResetter(), *pushes, engine]
	O.dt = step * engine.criticalTimeStep()
	book, writers = ddem.EnergyBalance(), [make(block) for make in recorders]

	row, steps = central_node(block.mesh), 2 * round(until / (2 * O.dt))
	looks = {2 * round(instant / (2 * O.dt)) for instant in instants}
	filed = set(np.linspace(0, steps, files, dtype=int).tolist()) if writers else set()
	times, centre, fields = [], [], []
	for k in range(steps + 1):
		times.append(O.time)
		centre.append(block.displacements[row])
		if k in looks:
			fields.append((O.time, block.displacements))
		if k in filed:
			for write in writers:
				write()
		O.step()
		book.record()
	mass = engine.array("nodeMass").sum() + engine.array("coreMass").sum()
	momentum = sum(
		(engine.array(kind + "Mass")[:, None] * engine.array(kind + "Velocity")).sum(axis=0)
		for kind in ("node", "core")
	)
	instants, fields = zip(*fields)
	return History(
		block.mesh, impulse, O.dt, np.array(times), np.array(centre), np.array(instants), list(fields),
		momentum[0] / mass, book.largest
	)
