# GPL v2 or later, see LICENSE.
"""Samples of deformable triangles and measures of their motion, shared by the tests."""
import sys

import numpy as np

from yade import (
	Body, DeformableElastMat, DeformableEngine, DeformableNode, DeformableTriangle, ForceResetter, O, Vector3i, ddem
)

# concrete without its equation of state: Zubelewicz (2018), Table 1
TABLE_1 = {"bulk": 30e9, "shear": 26e9, "density": 2400}
TREATMENTS = ("none", "corotational", "cosserat")


def elastic(label="elastic", **changes):
	"""Append an elastic material and return it."""
	material = DeformableElastMat(label=label, **{**TABLE_1, **changes})
	O.materials.append(material)
	return material


def lame(material):
	return material.bulk - 2 / 3 * material.shear, material.shear


def skewed_mesh(width=0.05, height=0.04, size=0.011):
	"""An irregular mesh, sheared and stretched so that no triangle is equilateral and no edge
	is parallel to an axis."""
	plain = ddem.mesh.rectangle(width, height, size=size, pattern="unstructured", seed=3)
	skew = np.array([[1.0, 0.3], [0.15, 0.8]])
	return ddem.mesh.Mesh(plain.nodes @ skew.T - (0.02, 0.01), plain.triangles)


def equilateral_mesh(columns=4, rows=4, edge=0.01):
	"""Rows of equilateral triangles, the one shape whose core is not turned by a homogeneous strain."""
	nodes = np.array(
		[(edge * (i + 0.5 * j), edge * np.sqrt(0.75) * j) for j in range(rows + 1) for i in range(columns + 1)]
	)
	at = lambda i, j: j * (columns + 1) + i
	triangles = []
	for j in range(rows):
		for i in range(columns):
			triangles += [
				(at(i, j), at(i + 1, j), at(i, j + 1)),
				(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)),
			]
	return ddem.mesh.Mesh(nodes, np.array(triangles))


def start(*engines, step=0.8, **settings):
	"""Set O.engines (the others before the DeformableEngine) and a time step of `step` times the critical one;
	returns the DeformableEngine."""
	engine = DeformableEngine(**settings)
	O.engines = [ForceResetter(), *engines, engine]
	O.dt = step * engine.criticalTimeStep()
	return engine


def steps(count):
	"""O.step() so many times: unlike O.run it has no thread to wait for (40 ms),
	and errors come as they were raised."""
	for _ in range(count):
		O.step()


def in_main(name, function):
	"""Make a function callable from a PyRunner's command."""
	setattr(sys.modules["__main__"], name, function)
	return name + "()"


def bodies(ids):
	return [O.bodies[int(i)] for i in ids]


def place(block, move):
	"""Put nodes and cores where move(x, y) says, x and y being their reference positions."""
	for body in bodies([*block.node_ids, *block.triangle_ids]):
		x, y = move(body.state.refPos[0], body.state.refPos[1])
		body.state.pos = (x, y, 0)


def set_velocity(block, velocity, spin=0):
	"""Give nodes and cores the velocity(x, y) of their place, and cores the spin [rad/s]."""
	for body in bodies([*block.node_ids, *block.triangle_ids]):
		vx, vy = velocity(body.state.pos[0], body.state.pos[1])
		body.state.vel = (vx, vy, 0)
	for body in bodies(block.triangle_ids):
		body.state.angVel = (0, 0, spin)


def agitate(block, speed, seed=1):
	"""Random velocities up to `speed` [m/s], spins likewise relative to a centimetre."""
	random = np.random.default_rng(seed)
	for body in bodies([*block.node_ids, *block.triangle_ids]):
		body.state.vel = (*random.uniform(-speed, speed, 2), 0)
	for body in bodies(block.triangle_ids):
		body.state.angVel = (0, 0, random.uniform(-speed, speed) / 0.01)


def state_positions(ids):
	"""Positions as State has them."""
	return np.array([(b.state.pos[0], b.state.pos[1]) for b in bodies(ids)])


def state_velocities(ids):
	"""Velocities as State has them."""
	return np.array([(b.state.vel[0], b.state.vel[1]) for b in bodies(ids)])


def momentum(engine):
	"""Linear momentum [kg·m/s] of all triangles."""
	return sum(
		(engine.array(kind + "Mass")[:, None] * engine.array(kind + "Velocity")).sum(axis=0)
		for kind in ("node", "core")
	)


def angular_momentum(engine):
	"""Angular momentum about the origin [kg·m²/s]; with the leapfrog's v(n+½), x(n) and x(n+1) give the same."""
	total = 0.0
	for kind in ("node", "core"):
		mass, x, v = (engine.array(kind + part) for part in ("Mass", "Position", "Velocity"))
		total += (mass * (x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0])).sum()
	if engine.rotation == "cosserat":
		inertia = np.array([b.state.inertia[2] for b in bodies(engine.values("triangleIds"))])
		total += (inertia * engine.array("coreSpin")).sum()
	return total


def kinetic_energy(engine):
	"""½ m v² of all translations [J]."""
	return sum(
		0.5 * (engine.array(kind + "Mass")[:, None] * engine.array(kind + "Velocity")**2).sum()
		for kind in ("node", "core")
	)


def append_bodies(nodes, triangles, material, thickness=1.0):
	"""Append nodes and triangles as they are, without ddem.append: unchecked, in this order.
	Returns the body ids of both."""
	node_ids, triangle_ids = [], []
	for x, y in nodes:
		body = Body()
		body.shape = DeformableNode()
		body.state.pos = body.state.refPos = (x, y, 0)
		node_ids.append(O.bodies.append(body))
	for corners in triangles:
		body = Body()
		body.shape = DeformableTriangle(nodes=Vector3i(*(node_ids[c] for c in corners)), thickness=thickness)
		body.material = material
		centre = np.mean([nodes[c] for c in corners], axis=0)
		body.state.pos = body.state.refPos = (centre[0], centre[1], 0)
		triangle_ids.append(O.bodies.append(body))
	return node_ids, triangle_ids


# --- what every law's material is held to, beside the numbers of its law


def beside_point(material, point, triangle, rates):
	"""A triangle driven at strain rates xx, yy, xy [1/s], a hundred steps of 1 µs each and one at rest, and a
	:class:`MaterialPoint` on the same path; yields the engine and the point's path after each.

	:param triangle: its vertices about their mean, where strains are zero [m]
	"""
	append_bodies(triangle, [(0, 1, 2)], material)
	for body in O.bodies:
		body.state.blockedDOFs = "xyzXYZ"
	engine = start(rotation="none")
	O.dt, now = 1e-6, np.zeros(3)
	for rate in np.array(rates, float):
		for body in O.bodies:
			x, y = body.state.refPos[0], body.state.refPos[1]
			body.state.vel = (rate[0] * x + rate[2] * y, rate[2] * x + rate[1] * y, 0)
		steps(100)
		now = now + 100 * O.dt * rate
		for body in O.bodies:
			body.state.vel = (0, 0, 0)
		steps(1)
		strain = dict(zip(("xx", "yy", "xy"), now))
		yield engine, point.path(100 * O.dt, strain=strain, steps=100)


def assert_goes_on_after_loading(file, count, names, energy):
	"""So many steps from now, and from the scene saved now and loaded, give values of these names and an entry of
	the energy book that are equal bit by bit."""
	O.save(str(file))
	results = []
	for load in (False, True):
		if load:
			O.reset()
			O.load(str(file))
		engine = [e for e in O.engines if isinstance(e, DeformableEngine)][0]
		steps(count)
		results.append([engine.values(name) for name in names] + [O.energy[energy]])
	for first, second in zip(*results):
		assert np.array_equal(first, second)


def assert_fields_reach_paraview(block, folder, names):
	"""Fields of a law, sub-element by sub-element in the block and their means in the cells of a file."""
	from vtkmodules.util.numpy_support import vtk_to_numpy
	from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

	from yade.ddem import vtk
	vtk.Recorder(block, str(folder / "block"))()
	reader = vtkXMLUnstructuredGridReader()
	reader.SetFileName(str(next(folder.rglob("*.vtu"))))
	reader.Update()
	cells = reader.GetOutput().GetCellData()
	units = {name: unit for name, unit, _ in block.fields}
	for name in names:
		field = block.field(name)
		assert field.shape == (len(block.triangle_ids), 3)
		assert np.allclose(
			vtk_to_numpy(cells.GetArray(vtk.title(name, units[name]))),
			field.mean(axis=1),
			rtol=1e-6,
			atol=0,
		)
