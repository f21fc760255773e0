# GPL v2 or later, see LICENSE.
# Stress that is there before anything moves: equilibrium, what unloading does, and all laws.
import numpy as np
import pytest
from yade import (
	ConcreteDamageMat, DeformableEngine, ForceResetter, Matrix3, O, ScalarDamageMat, Vector2i, VonMisesMat, ddem
)

from deformable_samples import TREATMENTS, assert_goes_on_after_loading, elastic, skewed_mesh, start, steps

mesh = ddem.mesh
PLANE = (-2e6, -5e6, 1e6)  # xx, yy, xy [Pa]


def law(name):
	"""A material of each law, the stresses of these tests below what it bears."""
	makes = {
		"elastic": lambda: elastic(),
		"von Mises": lambda: VonMisesMat(label="m", yieldStress=50e6),
		"scalar damage": lambda: ScalarDamageMat(label="m", tensileStrength=3e6, fractureEnergy=1e4),
		"concrete": lambda: ConcreteDamageMat(label="m"),
		"concrete without effects": lambda: ConcreteDamageMat(
			label="m", viscoplasticFlow=False, damage=False, equationOfState=False
		),
	}
	material = makes[name]()
	if name != "elastic":
		O.materials.append(material)
	return material


LAWS = ("elastic", "von Mises", "scalar damage", "concrete", "concrete without effects")


@pytest.mark.parametrize("energy", (False, True))
@pytest.mark.parametrize("name", LAWS)
def test_every_law_takes_the_stress_for_its_own_and_nothing_moves(name, energy):
	"""A uniform stress, xz = 0 but with a zz that is not that of plane strain, between the loads that bear it."""
	material = law(name)
	given = (*PLANE, -4e6)
	block = ddem.append(skewed_mesh(), material, initial_stress=given)
	O.trackEnergy = energy
	start(ddem.initial_stress.on_edges(block, None))
	expected = np.array([given[0], given[1], given[3], given[2]])
	# round-off of positions, as strain of small triangles
	noise = 10 * (material.bulk + 2 * material.shear) * 2e-16
	assert np.abs(block.stress - expected).max() < 10 * noise
	steps(200)
	speed = 5e6 / np.sqrt(material.bulk * material.density)  # that such a stress gives if it is let go
	assert np.abs(block.velocities).max() < 1e-8 * speed
	assert np.abs(block.stress - expected).max() < 1e-9 * 5e6
	assert block.damage.max() == 0 and np.abs(block.plastic_strain).max() < 1e-15
	if energy:  # what the stress has stored; with an equation of state more stiffness, and less strain
		volume = block.area.sum()
		mean = (given[0] + given[1] + given[3]) / 3
		deviator = (
			(given[0] - mean)**2 + (given[1] - mean)**2 + (given[3] - mean)**2 + 2 * given[2]**2
		)
		stored = (deviator / (4 * material.shear) + mean**2 / (2 * material.bulk)) * volume
		assert O.energy["elastPotential"] == pytest.approx(stored, rel=0.2 if name == "concrete" else 1e-9)


@pytest.mark.parametrize("name", LAWS)
def test_the_book_closes_and_a_saved_scene_goes_on(name, tmp_path):
	block = ddem.append(skewed_mesh(), law(name), initial_stress=(*PLANE, -4e6))
	book = ddem.EnergyBalance()
	start(step=0.5)
	for _ in range(20):  # let go: it expands
		steps(10)
		book.record()
	assert np.abs(block.velocities).max() > 0.01
	assert book.largest < (2e-3 if name == "concrete" else 1e-3)
	assert_goes_on_after_loading(tmp_path / "scene.xml.gz", 30, ["stress", "strain"], "elastPotential")


@pytest.mark.parametrize("treatment", TREATMENTS)
@pytest.mark.parametrize("share", (1 / 6, 0.1))
def test_a_column_under_its_weight_stays_at_rest(treatment, share):
	"""K0 with the gravity gradient, on an irregular mesh between walls: node by node in equilibrium."""
	gamma, height, k0 = 2400 * 9.81e3, 0.1, 0.4
	block = ddem.append(
		mesh.rectangle(0.06, height, size=0.011, pattern="unstructured", seed=3), elastic(),
		initial_stress=lambda x, y: (k0 * gamma * (y - height), gamma * (y - height), 0)
	)
	block.hold(block.boundary("bottom"), "y")
	for side in ("left", "right"):
		block.hold(block.boundary(side), "x")
	start(gravity=(0, -9.81e3, 0), rotation=treatment, vertexShare=share)
	steps(500)
	assert np.abs(block.velocities).max() < 1e-8 * 9.81e3 * O.time
	assert np.abs(block.core_velocities).max() < 1e-8 * 9.81e3 * O.time
	weight, bottom = gamma * 0.06 * height, block.boundary("bottom")
	rows = [list(block.node_ids).index(int(i)) for i in bottom]
	assert block.reactions[rows, 1].sum() == pytest.approx(weight, rel=1e-9)
	left = [list(block.node_ids).index(int(i)) for i in block.boundary("left")]
	assert block.reactions[left, 0].sum() == pytest.approx(k0 * gamma * height**2 / 2, rel=1e-9)


def test_loads_on_edges_bear_a_linear_stress():
	"""The same column without walls: tractions of the initial stress on all edges but the held corner."""
	gamma, height = 2400 * 9.81e3, 0.1
	block = ddem.append(
		mesh.rectangle(0.06, height, size=0.011, pattern="unstructured", seed=3), elastic(),
		initial_stress=lambda x, y: (0.4 * gamma * (y - height), gamma * (y - height), 0)
	)
	start(ddem.initial_stress.on_edges(block, None), gravity=(0, -9.81e3, 0))
	steps(500)
	assert np.abs(block.velocities).max() < 1e-8 * 9.81e3 * O.time


def test_unloading_an_edge_gives_the_exact_displacement():
	"""Smooth walls but for the top, whose pressure is taken away: u = p y/(B + 4 mu/3) upwards."""
	material, p, height = elastic(), 5e6, 0.1
	block = ddem.append(mesh.rectangle(0.05, height, size=0.01), material, initial_stress=(-2e6, -p, 0))
	block.hold(block.boundary("bottom"), "y")
	for side in ("left", "right"):
		block.hold(block.boundary(side), "x")
	top = ddem.initial_stress.on_edges(block, "top", course=[(0, 1), (2e-5, 0)])
	start(top, rotation="none")
	ddem.relax(1e-8, damping=0.3)
	modulus = material.bulk + 4 / 3 * material.shear
	exact = p * block.reference_positions[:, 1] / modulus
	assert np.abs(block.displacements[:, 1] - exact).max() < 1e-6 * exact.max()
	assert np.abs(block.stress[..., 1]).max() < 1e-6 * p
	lateral = -2e6 + (material.bulk - 2 / 3 * material.shear) / modulus * p
	assert np.abs(block.stress[..., 0] - lateral).max() < 1e-6 * p


def test_opening_a_hole_gives_kirsch():
	"""A plate under sigma_x, its hole supported, then opened: displacements are those of the hole alone, stresses
	those of Kirsch (1898). The outer border has the tractions of the whole solution."""
	from yade.ddem.verification import elasticity
	sigma, radius, outer, rows = -5e6, 0.02, 0.08, 12
	material = elastic()
	plain = mesh.rectangle(1, 1, size=1 / rows)
	r = radius * (outer / radius)**plain.nodes[:, 0]
	angle = 0.5 * np.pi * plain.nodes[:, 1]
	quarter = mesh.Mesh(np.column_stack([r * np.cos(angle), r * np.sin(angle)]), plain.triangles)
	block = ddem.append(quarter, material, initial_stress=(sigma, 0, 0))
	block.hold(block.boundary("left"), "x")
	block.hold(block.boundary("bottom"), "y")
	field = elasticity.kirsch(material, sigma, radius)
	on_circle = lambda size: lambda x, y: np.abs(np.hypot(x, y) - size) < 1e-6
	rows_of = {int(i): row for row, i in enumerate(block.node_ids)}
	course, far = [(0, 0), (2e-5, 1)], []
	hole = ddem.initial_stress.on_edges(block, on_circle(radius), course=[(0, 1), (2e-5, 0)])
	before = ddem.initial_stress.on_edges(block, on_circle(outer), course=[(0, 1), (2e-5, 0)])
	for pair in block.edges(on_circle(outer)).tolist():
		ends = block.mesh.nodes[[rows_of[i] for i in pair]]
		along = ends[1] - ends[0]
		normal = np.array([along[1], -along[0]]) / np.hypot(*along)
		traction = tuple(field.traction(ends.mean(axis=0), normal).tolist())
		far.append(ddem.pressure(block, [pair], traction=traction, course=course, follower=False))
	start(hole, before, *far, rotation="none")
	steps(1)
	still = np.abs(block.velocities).max()
	assert still < 1e-9 * 5e6 / np.sqrt(material.bulk * 2400)
	ddem.relax(1e-6, damping=0.3)
	wall = np.flatnonzero(on_circle(radius)(*block.mesh.nodes.T))
	uniform = elasticity.kirsch(material, sigma, 1e-9)  # a plate without a hole
	points = block.reference_positions[wall]
	exact = field.displacement(points) - uniform.displacement(points)
	assert np.abs(block.displacements[wall] - exact).max() < 0.02 * np.abs(exact).max()
	near = np.argmin(np.hypot(*(block.mesh.centroids - [0, 1.15 * radius]).T))
	stress = field.stress(block.mesh.centroids[near])
	assert block.stress[near, :, 0].mean() == pytest.approx(stress[0], rel=0.05)


def test_the_initial_stress_turns_with_the_material():
	block = ddem.append(skewed_mesh(), elastic(), initial_stress=PLANE)
	block.hold(block.node_ids)
	engine = start(rotation="corotational")
	angle = 0.7
	turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
	for body in O.bodies:
		x, y = turn @ (body.state.refPos[0], body.state.refPos[1])
		body.state.pos = (x, y, 0)
	expected = turn @ [[PLANE[0], PLANE[2]], [PLANE[2], PLANE[1]]] @ turn.T
	seen = engine.values("stress")
	assert np.abs(seen[..., [0, 1, 3]] - expected[[0, 1, 0], [0, 1, 1]]).max() < 1e-8 * 5e6


def test_more_stress_than_a_law_bears_is_refused_with_its_place():
	O.materials.append(VonMisesMat(label="m", yieldStress=1e6))
	ddem.append(mesh.rectangle(0.02, 0.02, 0.01), "m", initial_stress=(0, -5e6, 0))
	with pytest.raises(ValueError, match=r"body \d+ at .*is more than its law VonMises bears, which comes to"):
		start()


def shape_stress(tensors):
	def spoil(block):
		O.bodies[block.triangle_ids[0]].shape.initialStress = tensors
		start()
	return spoil


WRONG = {
	"xx, yy, xy": lambda block: ddem.append(skewed_mesh(), "elastic", initial_stress=(1, 2)),
	"it is 5": lambda block: ddem.append(skewed_mesh(), "elastic", initial_stress=5),
	"finite": lambda block: ddem.append(skewed_mesh(), "elastic", initial_stress=(0, np.nan, 0)),
	"the function gives": lambda block: ddem.append(skewed_mesh(), "elastic", initial_stress=lambda x, y: (x, y)),
	"no initial stress; append": lambda block: ddem.initial_stress.on_edges(block, "top"),
	"has 2 tensors": shape_stress([Matrix3.Zero, Matrix3.Zero]),
	"zero xz and yz": shape_stress([Matrix3(1, 0, 1, 0, 1, 0, 1, 0, 1)]),
}


@pytest.mark.parametrize("words", WRONG)
def test_unusable_stresses_are_refused(words):
	block = ddem.append(mesh.rectangle(0.02, 0.02, 0.01), elastic())
	before = len(O.bodies)
	with pytest.raises(ValueError, match=words):
		WRONG[words](block)
	assert len(O.bodies) == before


def test_it_cannot_be_changed_once_running():
	block = ddem.append(mesh.rectangle(0.02, 0.02, 0.01), elastic(), initial_stress=PLANE)
	start()
	steps(1)
	O.bodies[block.triangle_ids[0]].shape.initialStress = []
	with pytest.raises(ValueError, match="initialStress is the stress .* at the start"):
		O.step()


def test_pairs_that_are_no_edge_are_named():
	block = ddem.append(mesh.rectangle(0.02, 0.02, size=0.005), elastic(), initial_stress=(*PLANE, -4e6))
	far = [int(block.boundary("top")[0]), int(block.boundary("bottom")[0])]
	for pair in (far, [far[0], 10**6]):
		with pytest.raises(ValueError, match=f"#{pair[0]}|#{pair[1]}"):
			ddem.initial_stress.on_edges(block, [pair])
