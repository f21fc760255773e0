# GPL v2 or later, see LICENSE.
# Pressure and tractions on edges, and edges through which waves leave.
import numpy as np
import pytest
from yade import AbsorbingEdge, DeformableEngine, EdgeTraction, ForceResetter, O, PyRunner, Vector2, Vector2i, ddem

from deformable_samples import elastic, in_main, lame, skewed_mesh, start, steps

mesh = ddem.mesh


def at_rest(block, *engines, damping=0.1, residual=1e-10, **settings):
	"""Relax a block under engines; returns the DeformableEngine."""
	engine = start(*engines, **settings)
	ddem.relax(residual, damping=damping)
	return engine


def ring(inner, outer, rows):
	"""A quarter of a ring in the first quadrant."""
	plain = mesh.rectangle(1, 1, size=1 / rows)
	r, angle = inner + (outer - inner) * plain.nodes[:, 0], 0.5 * np.pi * plain.nodes[:, 1]
	nodes = np.column_stack([r * np.cos(angle), r * np.sin(angle)])
	return mesh.Mesh(nodes, plain.triangles).validate()


def test_a_uniform_dead_pressure_gives_a_uniform_stress():
	"""The patch test, on skewed triangles and with different pressures: sigma = -p n.n needs no mesh to be exact.
	Strains of some per cent, so that the round-off of positions is far below 1e-12 of the stress."""
	block = ddem.append(skewed_mesh(), elastic())
	stress = np.array([[-2e9, 0.5e9], [0.5e9, -1e9]])  # a state of all components
	nodes = block.mesh.nodes
	rows = {int(i): row for row, i in enumerate(block.node_ids)}
	engines = []
	for a, b in block.edges():  # a traction of its own on each edge
		along = nodes[rows[int(b)]] - nodes[rows[int(a)]]
		normal = np.array([along[1], -along[0]]) / np.hypot(*along)
		tangent = along / np.hypot(*along)
		traction = stress @ normal
		engines.append(
			ddem.pressure(
				block, [(a, b)], -traction @ normal, shear=traction @ tangent, follower=False
			)
		)
	first, second = block.node_ids[[0, -1]]
	block.hold([first])
	block.hold([second], "y")
	start(*engines, rotation="none", damping=0.1)
	O.run(20000, True)
	expected = np.array([stress[0, 0], stress[1, 1], stress[0, 1]])
	assert np.abs(block.stress[..., [0, 1, 3]] - expected).max() < 1e-12 * np.abs(stress).max()


def test_a_thick_walled_cylinder_under_inner_pressure():
	"""Lame (1852), plane strain: u(a) = (1 + nu) a p ((1 - 2 nu) a^2 + b^2)/(E (b^2 - a^2));
	second order in size."""
	inner, outer, p = 0.05, 0.1, 3e6
	errors = []
	for rows in (4, 8):
		O.reset()
		material = elastic()
		block = ddem.append(ring(inner, outer, rows), material, thickness=0.3)
		block.hold(block.boundary("left"), "x")
		block.hold(block.boundary("bottom"), "y")
		bore = ddem.pressure(block, lambda x, y: np.hypot(x, y) < inner + 1e-6, p)
		at_rest(block, bore, residual=1e-7, rotation="none")
		radius = np.hypot(*block.reference_positions.T)
		moved = (block.displacements * block.reference_positions).sum(axis=1) / radius
		nu, young = material.poisson, material.young
		exact = (1 + nu) * inner * p * ((1 - 2 * nu) * inner**2 + outer**2) / (young * (outer**2 - inner**2))
		errors.append(moved[radius < inner + 1e-6].mean() / exact - 1)
	assert abs(errors[1]) < 0.01
	assert errors[0] / errors[1] == pytest.approx(4, rel=0.25)


def test_a_pressure_that_follows_all_around_sets_nothing_in_motion():
	from deformable_samples import angular_momentum, momentum
	block = ddem.append(skewed_mesh(), elastic())
	block.spin = 1e4  # turns by a radian: the load turns as well
	engine = start(ddem.pressure(block, None, 5e8), rotation="corotational", step=0.5)
	before = angular_momentum(engine)
	O.run(int(1e-4 / O.dt), True)
	assert np.abs(block.rotation).min() > 0.9
	impulse = 5e8 * 0.05 * 1e-4  # of one side alone
	assert np.abs(momentum(engine)).max() < 1e-11 * impulse
	assert angular_momentum(engine) == pytest.approx(before, abs=1e-11 * impulse * 0.05)


def test_the_work_of_a_pressure_is_that_of_the_volume_and_the_book_closes():
	block = ddem.append(skewed_mesh(), elastic(), thickness=0.5)
	book = ddem.EnergyBalance()
	start(ddem.pressure(block, None, 1e9, ramp=2e-5), rotation="none", damping=0.1)
	area = lambda: _areas(block.positions[block.mesh.triangles]).sum()
	while O.time < 2e-5:
		area_then = area()  # works are those up to the positions that a step starts from
		steps(1)
	book_then = -O.energy["edgeWork"]
	O.run(20000, True)  # at rest
	book.record()
	assert -O.energy["edgeWork"] - book_then == pytest.approx(1e9 * 0.5 * (area_then - area()), rel=2e-3)
	assert book.largest < 1e-9
	assert O.energy["externalWork"] == 0 and O.energy["edgeWork"] < 0


def _areas(corners):
	a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
	return 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def test_a_beam_under_a_shear_traction_at_its_end():
	"""Timoshenko & Goodier (1970), art. 21: a parabolic shear at the end, P L^3/(3 E' I) + shear; the held end does
	not warp."""
	material = elastic()
	length, height, size = 0.08, 0.02, 0.0025
	block = ddem.append(mesh.rectangle(length, height, size), material, thickness=0.1)
	block.hold(block.boundary("left"))
	middle = 0.5 * height
	load = ddem.pressure(
		block, "right", shear=1.5e6, profile=lambda x, y: 1 - ((y - middle) / middle)**2, follower=False
	)
	engine = at_rest(block, load, residual=1e-5, damping=0.3, rotation="none")
	force = 1e6 * height * 0.1 * (1 - (size / height)**2)  # of a parabola that is linear along each edge
	right = block.boundary("right")
	assert block.reactions[:, 1].sum() == pytest.approx(-force, rel=1e-3)
	assert engine.values("reaction").sum(axis=0)[0] == pytest.approx(0, abs=1e-3 * force)
	young = material.young / (1 - material.poisson**2)
	inertia = 0.1 * height**3 / 12
	slender = force * length**3 / (3 * young * inertia)
	shear = 1.2 * force * length / (material.shear * height * 0.1)
	rows = [list(block.node_ids).index(int(i)) for i in right]
	assert block.displacements[rows, 1].mean() == pytest.approx(slender + shear, rel=0.03)


def test_pressure_on_the_sides_and_platens_together():
	"""An elastic block between smooth platens: sigma_y = E' eps + nu/(1 - nu) p, with p on its sides."""
	material = elastic()
	block = ddem.append(mesh.rectangle(0.05, 0.1, size=0.01), material)
	platens = ddem.platens(block, velocity=0.01, ramp=2e-5, lateral="free")
	sides = [ddem.pressure(block, side, 20e6, ramp=5e-5) for side in ("left", "right")]
	O.engines = [ForceResetter(), *sides, *platens.engines, DeformableEngine()]
	O.dt = ddem.time_step(0.8)
	ddem.relax(1e-4, damping=0.3)
	nu = material.poisson
	expected = material.young / (1 - nu**2) * platens.strain + nu / (1 - nu) * 20e6
	assert platens.stress == pytest.approx(expected, rel=2e-3)
	assert block.stress[..., 0].mean() == pytest.approx(-20e6, rel=2e-3)


def test_a_dead_load_keeps_its_direction_and_one_that_follows_does_not():
	force = []
	for follower in (True, False):
		O.reset()
		block = ddem.append(mesh.rectangle(0.02, 0.02, 0.01), elastic())
		block.hold(block.node_ids)
		start(ddem.pressure(block, "right", 1e6, follower=follower), rotation="none")
		for i in block.node_ids:  # turned by a right angle, and twice as large
			x, y, _ = O.bodies[i].state.refPos
			O.bodies[i].state.pos = (-2 * y, 2 * x, 0)
		O.step()
		engine = O.engines[-1]
		force.append((block.reactions + block.node_forces).sum(axis=0))
	assert np.allclose(force[0], (0, 2 * 1e6 * 0.02), rtol=1e-9, atol=1e-6)  # against -p n L
	assert np.allclose(force[1], (1e6 * 0.02, 0), rtol=1e-9, atol=1e-6)


def test_ramp_course_and_changes_at_any_time():
	block = ddem.append(mesh.rectangle(0.02, 0.02, 0.01), elastic())
	block.hold(block.node_ids)
	load = ddem.pressure(block, "top", 1e6, ramp=10e-7)
	engine = start(load, rotation="none")
	O.dt = 1e-7
	felt = lambda: (block.reactions + block.node_forces)[:, 1].sum() / (1e6 * 0.02)
	seen = []
	for _ in range(13):
		O.step()
		seen.append(felt())
	assert np.allclose(seen, np.minimum(np.arange(13) / 10, 1), atol=1e-9)  # the force of the step's start
	load.times, load.factors = [13e-7, 15e-7, 16e-7], [1, 3, -1]
	seen = []
	for _ in range(5):
		O.step()
		seen.append(felt())
	assert np.allclose(seen, [1, 2, 3, -1, -1], atol=1e-9)
	load.times, load.factors, load.pressure = [], [], 4e6
	O.step()
	assert felt() == pytest.approx(4, abs=1e-9)
	load.dead = True
	O.step()
	assert felt() == pytest.approx(0, abs=1e-9) and load.factor == 1
	load.dead, load.traction, load.pressure = False, Vector2(3e6, 0), 0
	O.step()
	assert (block.reactions + block.node_forces).sum(axis=0) == pytest.approx((-3e6 * 0.02, 0), abs=1e-3)
	assert engine.values("reaction").shape == (13, 2)


def test_a_command_changes_the_load_without_all_of_state_being_written():
	block = ddem.append(mesh.rectangle(0.02, 0.02, 0.01), elastic())
	load = ddem.pressure(block, "top", 0)
	in_main("edge_load", lambda: setattr(load, "pressure", 1e5 * O.iter))
	start(PyRunner(command="edge_load()", iterPeriod=1), load, damping=0.1)
	O.run(50, True)
	assert load.pressure == 1e5 * 49
	assert np.abs(block.velocities).max() > 0


def test_edges_in_either_order_and_of_several_engines():
	for turn in (False, True):
		O.reset()
		block = ddem.append(mesh.rectangle(0.02, 0.02, 0.01), elastic())
		block.hold(block.node_ids)
		pairs = block.edges("right")
		profile = [(1, 0), (0.5, 1)]
		load = EdgeTraction(
			edges=[Vector2i(*(pair[::-1] if turn else pair)) for pair in pairs.tolist()], pressure=1e6,
			profile=[Vector2(*(pair[::-1] if turn else pair)) for pair in profile]
		)
		start(load)
		O.step()
		felt = block.reactions + block.node_forces
		if turn:
			assert np.array_equal(felt, before)
		before = felt
	other = ddem.append(mesh.rectangle(0.02, 0.02, 0.01), "elastic", position=(0.1, 0, 0))
	other.hold(other.node_ids)
	load.edges, load.profile = [Vector2i(*pair) for pair in [*pairs.tolist(), *other.edges("right").tolist()]], []
	O.engines = [
		ForceResetter(), load, DeformableEngine(ids=list(block.triangle_ids)),
		DeformableEngine(ids=list(other.triangle_ids), groupMask=1 << 21)
	]
	O.step()
	for part in (block, other):
		assert (part.reactions + part.node_forces)[:, 0].sum() == pytest.approx(1e6 * 0.02)


@pytest.mark.parametrize("entry", ("edgeWork", "edgeAbsorption"))
def test_a_loaded_scene_goes_on_after_saving_with_the_same_bits(tmp_path, entry):
	from deformable_samples import assert_goes_on_after_loading
	block = ddem.append(skewed_mesh(), elastic())
	O.trackEnergy = True
	load = ddem.pressure(block, None, 1e8, shear=3e7, ramp=3e-6)
	start(load, AbsorbingEdge(edges=of(block, None)), damping=0.1)
	steps(20)
	assert_goes_on_after_loading(tmp_path / "scene.xml.gz", 30, ["stress", "rotation"], entry)


WRONG = {
	"finite numbers": lambda block: ddem.pressure(block, "top", np.nan),
	"ramp = -1": lambda block: ddem.pressure(block, "top", 1, ramp=-1),
	"either ramp": lambda block: ddem.pressure(block, "top", 1, ramp=1, course=[(0, 1)]),
	"rising times": lambda block: ddem.pressure(block, "top", 1, course=[(1, 0), (1, 1)]),
	"as many finite factors": lambda block: ddem.pressure(block, "top", 1, profile=lambda x, y: 1),
	"no pairs of node ids": lambda block: ddem.pressure(block, [1, 2, 3], 1),
	"unknown side": lambda block: ddem.pressure(block, "north", 1),
	"no edge of the border": lambda block: ddem.pressure(block, lambda x, y: (x < 1e-9) & (y < 1e-9), 1),
	"given twice": lambda block: ddem.pressure(block, [(0, 1), (1, 0)], 1),
	"'z' must be": lambda block: ddem.absorb(block, "top", dofs="z"),
}


@pytest.mark.parametrize("words", WRONG)
def test_unusable_loads_are_refused(words):
	block = ddem.append(mesh.rectangle(0.02, 0.02, 0.01), elastic())
	with pytest.raises(ValueError, match=words):
		WRONG[words](block)


def inner_edge(block):
	border = {frozenset(pair) for pair in block.edges().tolist()}
	corners = block.node_ids[block.mesh.triangles[0]]
	pairs = [(int(corners[k]), int(corners[k - 1])) for k in range(3)]
	return next(pair for pair in pairs if frozenset(pair) not in border)


STOPS = {
	"two triangles share it": lambda block: EdgeTraction(edges=[Vector2i(*inner_edge(block))], pressure=1),
	"not corners of one triangle": lambda block: EdgeTraction(
		edges=[Vector2i(block.boundary("top")[0], block.boundary("bottom")[0])]
	),
	"is no DeformableNode": lambda block: EdgeTraction(edges=[Vector2i(block.triangle_ids[0], 0)]),
	"1 pairs for 2 edges": lambda block: EdgeTraction(edges=of(block, "top"), profile=[Vector2(1, 1)]),
	"2 times and 1 factors": lambda block: EdgeTraction(edges=of(block, "top"), times=[0, 1], factors=[1]),
	"must be finite numbers": lambda block: EdgeTraction(edges=of(block, "top"), pressure=np.inf),
	"none of the engine's edges": lambda block: AbsorbingEdge(
		edges=of(block, "top"), nodes=[block.boundary("bottom")[0]], forces=[Vector2(1, 0)]
	),
	"1 nodes and 0 forces": lambda block: AbsorbingEdge(edges=of(block, "top"), nodes=[block.boundary("top")[0]]),
}


def of(block, side):
	return [Vector2i(*pair) for pair in block.edges(side).tolist()]


@pytest.mark.parametrize("words", STOPS)
def test_edges_that_are_none_and_values_that_do_not_fit_stop_the_run(words):
	block = ddem.append(mesh.rectangle(0.02, 0.02, 0.01), elastic())
	start(STOPS[words](block))
	with pytest.raises(ValueError, match=words):
		O.step()


def test_an_edge_engine_that_nobody_asks_stops_the_run():
	block = ddem.append(mesh.rectangle(0.02, 0.02, 0.01), elastic())
	O.engines = [ForceResetter(), ddem.pressure(block, "top", 1)]
	with pytest.raises(RuntimeError, match="acts through a DeformableEngine"):
		O.step()


# --- edges through which waves leave


def pulse(duration):
	"""(1 - cos)/2 of this length [s] as a course."""
	times = np.linspace(0, duration, 101)
	return np.column_stack([times, 0.5 * (1 - np.cos(2 * np.pi * times / duration))])


@pytest.mark.parametrize("rotation", ("none", "cosserat"))
@pytest.mark.parametrize("axis", (0, 1))
def test_waves_of_normal_incidence_leave(axis, rotation):
	"""A pulse of 1 m/s and 25 triangles' length comes in through dashpots on the left, as 2 rho c v, and leaves on
	the right: less than 0.1 % comes back (0.02 % of compression, 0.05 % of shear, which the mesh disperses)."""
	material, length, size, wave = elastic(), 0.2, 0.004, 0.1
	block = ddem.append(mesh.rectangle(length, size, size), material)
	block.hold(np.concatenate([block.boundary("bottom"), block.boundary("top")]), "yx"[axis])
	speed = np.sqrt((material.bulk + 4 / 3 * material.shear, material.shear)[axis] / material.density)
	force = 2 * material.density * speed
	come = ddem.pressure(
		block, "left", traction=(0, force) if axis else (force, 0), course=pulse(wave / speed), follower=False
	)
	ends = [AbsorbingEdge(edges=of(block, side)) for side in ("left", "right")]
	book = ddem.EnergyBalance()
	start(come, *ends, rotation=rotation)
	row = int(np.argmin(np.hypot(block.mesh.nodes[:, 0] - 0.5 * length, block.mesh.nodes[:, 1])))
	peak = {"in": 0, "back": 0}
	while O.time < (1.5 * length + 1.2 * wave) / speed:
		O.step()
		when = "in" if O.time < (0.5 * length + wave) / speed else "back"
		# in between the pulse that goes and the one that comes back overlap, for a tenth of it
		if when == "in" or O.time > (length + 0.8 * wave) / speed:
			peak[when] = max(peak[when], abs(block.velocities[row, axis]))
	assert peak["in"] == pytest.approx(1, rel=2e-3)
	assert peak["back"] < 1e-3
	book.record()
	assert book.largest < 1e-9
	# flux rho c v^2 through the section: 3/8 of the peak's over a pulse of this shape; and none is left
	energy = 3 / 8 * material.density * speed * size * wave / speed
	assert O.energy["edgeAbsorption"] == pytest.approx(-O.energy["edgeWork"], rel=1e-5)
	# the dashpots on the left take as much as the pulse has, while they let it in
	assert O.energy["edgeAbsorption"] == pytest.approx(2 * energy, rel=2e-3)


@pytest.mark.parametrize("degrees", (0, 30, 60))
def test_a_wave_at_an_angle_is_reflected_as_in_theory(degrees):
	"""Motion of the middle of an absorbing edge, before the ends of the edge are heard of: incident, reflected
	compression and reflected shear wave together.
	The incident wave comes in by its tractions on the other sides."""
	from yade.ddem.verification.elasticity import behind_dashpots
	material = elastic()
	lam, mu = lame(material)
	width, height, size, wave = 0.06, 0.24, 0.005, 0.06
	angle = np.radians(degrees)
	way = np.array([np.cos(angle), np.sin(angle)])
	block = ddem.append(mesh.rectangle(width, height, size), material)
	speed = np.sqrt((lam + 2 * mu) / material.density)
	stress = -(lam * np.eye(2) + 2 * mu * np.outer(way, way)) / speed
	rows = {int(i): row for row, i in enumerate(block.node_ids)}
	engines = [AbsorbingEdge(edges=of(block, "right"))]
	for side, normal in (("left", (-1, 0)), ("bottom", (0, -1)), ("top", (0, 1))):
		for pair in block.edges(side).tolist():
			middle = block.mesh.nodes[[rows[i] for i in pair]].mean(axis=0)
			course = pulse(wave / speed)
			course[:, 0] += middle @ way / speed
			traction = tuple(stress @ normal)
			engines.append(ddem.pressure(block, [pair], traction=traction, course=course, follower=False))
	start(*engines, rotation="none")
	row = int(np.argmin(np.hypot(*(block.mesh.nodes - [width, 0.5 * height]).T)))
	arrival = block.mesh.nodes[row] @ way / speed
	seen = []
	while O.time < arrival + wave / speed:
		O.step()
		seen.append(block.velocities[row].copy())
	seen = np.array(seen)
	expected, _ = behind_dashpots(material, angle)
	assert seen[:, 0].max() == pytest.approx(expected[0], abs=0.01)
	assert np.abs(seen[:, 1]).max() == pytest.approx(abs(expected[1]), abs=0.01)


def test_a_support_that_absorbs_bears_what_it_bore():
	"""A column under its weight and a dead load on its top, on its held bottom;
	dashpots take the bottom's place."""
	block = ddem.append(mesh.rectangle(0.05, 0.1, 0.01), elastic())
	block.hold(block.boundary("bottom"))
	for side in ("left", "right"):
		block.hold(block.boundary(side), "x")
	top = ddem.pressure(block, "top", 1e6)
	start(top, gravity=(0, -9.81e3, 0))
	ddem.relax(1e-8, damping=0.1)
	weight, rested = 9.81e3 * 2400 * 0.05 * 0.1, block.positions.copy()
	assert block.reactions[:, 1].sum() == pytest.approx(weight + 1e6 * 0.05, rel=1e-7)
	leave = ddem.absorb(block, "bottom", dofs="y")
	assert np.array(leave.forces)[:, 1].sum() == pytest.approx(weight + 1e6 * 0.05, rel=1e-7)
	assert {O.bodies[i].state.blockedDOFs for i in block.boundary("bottom")[1:-1]} == {"xzXYZ"}
	O.engines = [ForceResetter(), top, leave, DeformableEngine(gravity=(0, -9.81e3, 0))]
	O.run(1000, True)
	sunk = 1e6 / 60e9 * 0.1  # what the load has pressed the column together by
	assert np.abs(block.positions - rested).max() < 1e-6 * sunk
	crossing = 0.1 / np.sqrt((30e9 + 4 / 3 * 26e9) / 2400)
	top.times, top.factors = [O.time, O.time + 2 * crossing], [1, 2]  # and the wave that more of it makes leaves
	O.run(int(5 * crossing / O.dt), True)
	moving = block.velocities[:, 1]
	# the column goes down as the half space below would: v = -dp/(rho c_p)
	impedance = np.sqrt(2400 * (30e9 + 4 / 3 * 26e9))
	assert moving.mean() == pytest.approx(-1e6 / impedance, rel=0.01)
	assert np.ptp(moving) < 0.05 * abs(moving.mean())


def test_reactions_are_unknown_before_a_step():
	block = ddem.append(mesh.rectangle(0.02, 0.02, 0.01), elastic())
	block.hold(block.boundary("bottom"))
	start()
	with pytest.raises(RuntimeError, match="none was made since the scene was read; make one"):
		ddem.absorb(block, "bottom")
	assert O.bodies[block.boundary("bottom")[0]].state.blockedDOFs == "xyzXYZ"
	O.step()
	assert len(ddem.absorb(block, "bottom").forces) == 3


def test_dashpots_leave_the_critical_step_as_it_is_and_a_run_at_it_is_stable():
	block = ddem.append(skewed_mesh(), elastic())
	bound = start(rotation="none").criticalTimeStep()
	start(AbsorbingEdge(edges=of(block, None)), step=0.9999, rotation="none")
	assert O.dt == pytest.approx(0.9999 * bound, rel=1e-12)
	block.velocities = np.random.default_rng(3).uniform(-1, 1, (len(block.node_ids), 2))
	first = np.abs(block.velocities).max()
	O.run(20000, True)
	assert np.abs(block.velocities).max() < 1e-2 * first


@pytest.mark.parametrize("course", [[], (1, 2), [0, 1, 2], [(0, 1, 2)], [(0, "a")], [(1, 1), (0, 0)], [(0, np.nan)]])
def test_courses_that_are_none(course):
	block = ddem.append(mesh.rectangle(0.02, 0.02, size=0.01), elastic())
	with pytest.raises(ValueError, match="must be pairs of rising times"):
		ddem.pressure(block, "top", 1e6, course=course)
