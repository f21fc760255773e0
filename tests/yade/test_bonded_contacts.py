# GPL v2 or later, see LICENSE.
"""Spheres of BondedMat against everything that YADE has: walls, boxes, facets, clumps, other materials, its steppers
and controllers. Forces, moments, collisions and rolling have closed forms."""
import math

import numpy as np
import pytest

from yade import (
	Bo1_Box_Aabb, Bo1_GridConnection_Aabb, Bo1_Sphere_Aabb, BondedInteractionLoop, BondedMat, CohFrictMat,
	ElasticWallMat, ForceResetter, FrictMat, GlobalStiffnessTimeStepper, Ig2_Box_Sphere_ScGeom,
	Ig2_GridNode_GridNode_GridNodeGeom6D, Ig2_Sphere_GridConnection_ScGridCoGeom, Ig2_Sphere_Sphere_ScGeom,
	InsertionSortCollider, InteractionLoop, Ip2_BondedMat_BondedMat_BondedPhys,
	Ip2_CohFrictMat_CohFrictMat_CohFrictPhys, Ip2_FrictMat_BondedMat_BondedPhys,
	Law2_ScGeom6D_CohFrictPhys_CohesionMoment, Law2_ScGeom_BondedPhys_Bonded, NewtonIntegrator, O, Quaternion,
	TriaxialStressController, UniaxialStrainer, Vector3, ddem, gridpfacet, utils
)

RADIUS, YOUNG, DENSITY = 1e-3, 60e9, 2600
SPRING = math.pi * YOUNG * RADIUS / 2  # of two equal spheres, or of one and its image: EA/d0, A = pi r^2, d0 = 2 r
MASS = 4 / 3 * math.pi * RADIUS**3 * DENSITY
TURN = Quaternion(Vector3(0.3, -0.5, 0.8).normalized(), 0.7)  # of the box, so that no face is along an axis


def rock(**more):
	O.materials.append(BondedMat(label="rock", young=YOUNG, poisson=0.25, density=DENSITY, **more))


def ball(place, **more):
	return O.bodies.append(utils.sphere(place, RADIUS, material="rock", **more))


def wall(material):
	return O.bodies.append(utils.wall(0, axis=1, material=material)), Vector3(0, 1, 0), Vector3.Zero


def box(material):
	made = utils.box((0, 0, 0), (0.01, 0.004, 0.02), material=material, fixed=True, orientation=TURN)
	up = TURN * Vector3(0, 1, 0)
	return O.bodies.append(made), up, 0.004 * up + TURN * Vector3(0.003, 0, -0.002)


def facet(material):
	corners = [TURN * Vector3(*x) for x in ((-0.01, 0, -0.01), (0.01, 0, -0.01), (0, 0, 0.02))]
	made = utils.facet(corners, material=material, fixed=True)
	return O.bodies.append(made), TURN * Vector3(0, 1, 0), TURN * Vector3(0.001, 0, 0.002)


def member(material):
	"""The other sphere of a clump that is held."""
	clump, (one, _) = O.bodies.appendClumped(
		[utils.sphere((0, -RADIUS, 0), RADIUS, material=material),
		utils.sphere((1.5 * RADIUS, -RADIUS, 0), RADIUS, material=material)]
	)
	O.bodies[clump].state.blockedDOFs = "xyzXYZ"
	return one, Vector3(0, 1, 0), Vector3.Zero


SHAPES = {"wall": wall, "box": box, "facet": facet, "clump member": member}


def on(shape, overlap, material="rock", **more):
	"""A ball that is so far in something; its id, that of the other, the normal, the point of contact."""
	rock(**more)
	other, normal, surface = SHAPES[shape](material)
	one = ball(surface + (RADIUS - overlap) * normal)
	O.engines = ddem.bonded.engines()
	O.dt = 1e-9
	return one, other, normal, surface - (overlap / 2) * normal


@pytest.mark.parametrize("shape", SHAPES)
def test_the_force_is_the_spring_times_the_overlap_along_the_normal(shape):
	one, other, normal, point = on(shape, 1e-6)
	O.step()
	(contact, ) = O.interactions
	assert contact.phys.kn == pytest.approx(SPRING, rel=1e-12) and contact.geom.penetrationDepth == pytest.approx(
		1e-6
	)
	force = SPRING * 1e-6 * normal
	assert np.allclose(O.forces.f(one), force, rtol=1e-9, atol=1e-9 * force.norm())
	assert np.allclose(O.forces.f(other), -force, rtol=1e-9, atol=1e-9 * force.norm())
	assert O.forces.t(one).norm() < 1e-9 * force.norm() * RADIUS
	arm = (point - O.bodies[other].state.pos).cross(-force)
	assert np.allclose(O.forces.t(other), arm, atol=1e-6 * force.norm() * RADIUS)


@pytest.mark.parametrize("shape", SHAPES)
def test_it_leaves_as_fast_as_it_came(shape):
	"""Half a period of the oscillator, pi sqrt(m/k), in contact; restitution 1."""
	one, _, normal, _ = on(shape, 0, frictionStatic=0, frictionDynamic=0)
	state = O.bodies[one].state
	state.pos += 1e-9 * normal
	state.vel = -1.0 * normal
	period = math.pi * math.sqrt(MASS / SPRING)
	O.dt = period / 2000
	touching = 0
	for _ in range(2500):
		O.step()
		touching += any(i.isReal for i in O.interactions)
	# leaves between two steps: a part of 2000 of the period
	assert state.vel.dot(normal) == pytest.approx(1, rel=1e-3)
	assert touching * O.dt == pytest.approx(period, rel=5e-3)
	assert (state.vel - state.vel.dot(normal) * normal).norm() < 1e-9 and state.angVel.norm() < 1e-6


@pytest.mark.parametrize("shape", ("wall", "box", "facet"))
def test_what_slides_comes_to_roll_with_five_sevenths_of_its_speed(shape):
	"""Angular momentum about the line of contact stays: m v0 r = m v r + 2/5 m r² ω; rolling, v = 5/7 v0, whatever
	the friction. The spring of the contact goes on swinging about that, as nothing damps it."""
	one, _, normal, _ = on(shape, 1e-6, frictionStatic=0.5, frictionDynamic=0.5)
	state = O.bodies[one].state
	along = normal.cross(Vector3(0, 0, 1)).normalized()
	state.vel = 0.05 * along
	O.forces.setPermF(one, -SPRING * 1e-6 * normal)
	O.dt = 2e-8
	speeds = []
	for _ in range(3000):
		O.step()
		speed, surface = state.vel.dot(along), state.angVel.dot(normal.cross(along)) * RADIUS
		assert speed + 0.4 * surface == pytest.approx(0.05, rel=1e-9)
		speeds.append(speed)
	assert np.mean(speeds[1000:]) == pytest.approx(0.05 * 5 / 7, rel=0.01)


@pytest.mark.parametrize("shape", ("box", "facet", "wall"))
def test_an_oblique_collision_takes_twice_mu_of_the_normal_speed(shape):
	"""Sliding all the time: v_t' = v_t - 2 mu v_n, r ω = 5 mu v_n; and the book closes."""
	one, _, normal, _ = on(shape, 0, frictionStatic=0.1, frictionDynamic=0.1)
	state = O.bodies[one].state
	along = normal.cross(Vector3(0, 0, 1)).normalized()
	state.vel = -1.0 * normal + 1.0 * along
	state.pos += 1e-9 * normal
	O.trackEnergy = True
	O.dt = math.pi * math.sqrt(MASS / SPRING) / 1000
	O.run(1500, True)
	assert state.vel.dot(normal) == pytest.approx(1, rel=2e-3)
	assert state.vel.dot(along) == pytest.approx(0.8, rel=0.02)
	assert state.angVel.dot(normal.cross(along)) * RADIUS == pytest.approx(0.5, rel=0.05)
	moving = 0.5 * MASS * state.vel.squaredNorm() + 0.2 * MASS * RADIUS**2 * state.angVel.squaredNorm()
	assert moving + O.energy["friction"] == pytest.approx(MASS, rel=2e-3)


@pytest.mark.parametrize("first", ("steel", "rock"))
def test_steel_of_frictmat_meets_rock(first):
	"""Springs in series: the harmonic mean of both moduli; the lower friction."""
	rock(frictionStatic=0.6, frictionDynamic=0.4)
	O.materials.append(FrictMat(label="steel", young=200e9, poisson=0.3, frictionAngle=0.3, density=7800))
	names = (first, "rock" if first == "steel" else "steel")
	one, two = (
		O.bodies.append(utils.sphere((x, 0, 0), RADIUS, material=name))
		for x, name in zip((0, 2 * RADIUS - 1e-6), names)
	)
	O.engines = ddem.bonded.engines()
	O.dt = 1e-9
	O.step()
	(contact, ) = O.interactions
	assert contact.phys.kn == pytest.approx(SPRING / YOUNG * 2 / (1 / 200e9 + 1 / YOUNG), rel=1e-12)
	assert contact.phys.frictionStatic == pytest.approx(
		math.tan(0.3)
	) and contact.phys.frictionDynamic == pytest.approx(math.tan(0.3))
	assert O.forces.f(one)[0] == pytest.approx(-contact.phys.kn * 1e-6, rel=1e-9) == -O.forces.f(two)[0]


@pytest.mark.parametrize("shape", ("box", "facet"))
def test_elastic_walls_are_boxes_and_facets_too(shape):
	"""A spring of pi r K without friction."""
	O.materials.append(ElasticWallMat(label="plate", stiffness=50e9))
	one, other, normal, point = on(shape, 1e-6, material="plate")
	O.bodies[one].state.vel = normal.cross(Vector3(0, 0, 1))
	O.step()
	force = math.pi * RADIUS * 50e9 * 1e-6 * normal
	assert np.allclose(O.forces.f(one), force, rtol=1e-9, atol=1e-9 * force.norm())
	assert np.allclose(
		O.forces.t(other), (point - O.bodies[other].state.pos).cross(-force), atol=1e-3 * force.norm() * RADIUS
	)


def test_damping_against_what_nothing_moves_has_the_mass_of_the_sphere():
	"""c = 2 zeta sqrt(m k)."""
	one, _, normal, _ = on("facet", 1e-9, normalDamping=0.1)
	O.bodies[one].state.vel = -0.1 * normal
	O.step()
	O.step()
	drag = O.forces.f(one).dot(normal) - SPRING * next(iter(O.interactions)).geom.penetrationDepth
	assert drag == pytest.approx(2 * 0.1 * math.sqrt(MASS * SPRING) * 0.1, rel=5e-3)


def test_a_deforming_cell_carries_its_images():
	"""Simple shear of a cell: two spheres that move with it touch across its border, and do not slip."""
	rock()
	O.periodic = True
	O.cell.setBox(8 * RADIUS, 8 * RADIUS, 8 * RADIUS)
	rate = 100.0
	O.cell.velGrad = [[0, rate, 0], [0, 0, 0], [0, 0, 0]]
	O.cell.homoDeform = 2
	for height in (0.5 * RADIUS, 6.5 * RADIUS + 1e-6):  # the upper one touches the lower one's image above
		ball((4 * RADIUS, height, 4 * RADIUS))
	O.engines = ddem.bonded.engines()
	O.dt = 1e-9

	def slipped():
		(contact, ) = [i for i in O.interactions if i.isReal and i.cellDist[1]]
		return contact.phys.shearForce.norm() / contact.phys.ks

	for _ in range(3):
		O.step()  # NewtonIntegrator gives the spheres the velocity of the cell
	assert O.bodies[1].state.vel[0] == pytest.approx(6.5 * RADIUS * rate, rel=1e-3)
	before = slipped()
	for _ in range(10):  # a small part of the contact's period
		O.step()
	# The centres are two radii apart; NewtonIntegrator turns the spheres with the cell, by half of the shear.
	# Without the velocity of the image the centres would seem to move by six.
	assert O.bodies[1].state.angVel[2] == pytest.approx(-rate / 2, rel=5e-3)
	assert (slipped() - before) / (10 * O.dt * rate * RADIUS) == pytest.approx(1, rel=0.01)


def test_an_edge_that_two_facets_share_is_touched_twice():
	"""As in all of YADE: an STL plate is twice as stiff along its inner edges."""
	rock()
	for corners in (((-1, 0, -1), (1, 0, -1), (1, 0, 1)), ((-1, 0, -1), (1, 0, 1), (-1, 0, 1))):
		O.bodies.append(
			utils.facet([Vector3(*corner) * 0.01 for corner in corners], material="rock", fixed=True)
		)
	one = ball((0, RADIUS - 1e-6, 0))
	O.engines = ddem.bonded.engines()
	O.dt = 1e-9
	O.step()
	assert O.forces.f(one)[1] == pytest.approx(2 * SPRING * 1e-6, rel=1e-6)


# ---- the bound on the time step ----

INERTIA = 0.4 * MASS * RADIUS**2
SHEAR = SPRING / 2.5  # G = E/2(1 + nu)


@pytest.mark.parametrize("shape", ("wall", "box", "facet"))
def test_the_bound_on_a_plane_is_that_of_normal_or_rolling(shape):
	"""2/omega: k/m along the normal, or k_s (1/m + r²/I) of slip and spin."""
	on(shape, 1e-6)
	O.step()
	highest = max(SPRING / MASS, SHEAR * (1 / MASS + RADIUS**2 / INERTIA))
	assert ddem.bonded.critical_time_step() == pytest.approx(2 / math.sqrt(highest), rel=1e-6)


@pytest.mark.parametrize("shape", ("wall", "box", "facet"))
@pytest.mark.parametrize("share, grows", ((0.9, False), (1.1, True)))
def test_the_bound_on_a_plane_is_sharp(shape, share, grows):
	"""A sticking sphere that rocks: below the bound it stays as fast, above it blows up; by YADE's own loop, which
	is not watched."""
	one, _, normal, _ = on(shape, 1e-6, frictionStatic=1e9, frictionDynamic=1e9)
	O.step()
	functors = [list(getattr(O.engines[2], f"{kind}Dispatcher").functors) for kind in ("geom", "phys", "law")]
	O.engines = [*O.engines[:2], InteractionLoop(*functors), *O.engines[3:]]
	O.forces.setPermF(one, -SPRING * 1e-6 * normal)
	state = O.bodies[one].state
	state.vel = 1e-6 * normal.cross(Vector3(0, 0, 1))
	O.dt = share * ddem.bonded.critical_time_step()
	speed = 0
	for _ in range(100):
		O.step()
		speed = max(speed, state.vel.norm())
	assert (speed > 1e-4) == grows


@pytest.mark.parametrize("shape", ("wall", "box", "facet"))
def test_elastic_planes_count_in_the_bound(shape):
	"""One spring of pi r K along the normal: 2 sqrt(m/k)."""
	O.materials.append(ElasticWallMat(label="plate", stiffness=1e13))
	on(shape, 1e-9, material="plate")
	O.step()
	assert ddem.bonded.critical_time_step() == pytest.approx(
		2 * math.sqrt(MASS / (math.pi * RADIUS * 1e13)), rel=1e-6
	)


def test_contacts_of_frictmat_count_in_the_bound():
	O.materials.append(FrictMat(label="steel", young=200e9, poisson=0.3, frictionAngle=0.3, density=7800))
	for x in (0, 2 * RADIUS - 1e-6):
		O.bodies.append(utils.sphere((x, 0, 0), RADIUS, material="steel"))
	O.engines = ddem.bonded.engines()
	O.dt = 1e-9
	O.step()
	(contact, ) = O.interactions
	mass = O.bodies[0].state.mass
	normal, slip = contact.phys.kn * 2 / mass, contact.phys.ks * (2 / mass + 2 * 2.5 / mass)
	assert ddem.bonded.critical_time_step() == pytest.approx(2 / math.sqrt(max(normal, slip)), rel=1e-6)


def test_members_of_a_clump_count_with_its_mass():
	"""Eight spheres that overlap: their clump weighs less than they do together. The bound is not above the exact
	one of the normal springs, 2 sqrt(M/8k), and just below it the clump swings as with a fifth of the step."""

	def swings(share):
		O.reset()
		rock()
		members = [
			utils.sphere((0.1 * i * RADIUS, RADIUS - 1e-6, 0), RADIUS, material="rock") for i in range(8)
		]
		clump, _ = O.bodies.appendClumped(members, discretization=30)
		O.bodies.append(utils.wall(0, axis=1, material="rock"))
		O.engines = ddem.bonded.engines()
		O.dt = 1e-9
		O.step()
		mass, bound = O.bodies[clump].state.mass, ddem.bonded.critical_time_step()
		assert mass < 3 * MASS and bound <= 2 * math.sqrt(mass / (8 * SPRING)) * (1 + 1e-9)
		O.forces.setPermF(clump, (0, -8 * SPRING * 1e-6, 0))
		O.bodies[clump].state.vel = (0, 1e-4, 0)
		O.dt, fastest = share * bound, 0
		for _ in range(round(200 / share)):
			O.step()
			fastest = max(fastest, O.bodies[clump].state.vel.norm())
		return fastest

	assert swings(0.95) == pytest.approx(swings(0.19), rel=0.1)


def test_a_clump_that_is_held_counts_as_a_wall():
	one, _, _, _ = on("clump member", 1e-6)
	O.step()
	highest = max(SPRING / MASS, SHEAR * (1 / MASS + RADIUS**2 / INERTIA))
	assert ddem.bonded.critical_time_step() == pytest.approx(2 / math.sqrt(highest), rel=1e-6)


@pytest.mark.parametrize("shape", ("wall", "facet", "box"))
def test_a_contact_that_forms_in_a_run_is_watched(shape):
	"""A free ball hits with three times sqrt(m/k): without a stop it leaves several times as fast as it came."""
	one, _, normal, _ = on(shape, 0)
	O.bodies[one].state.pos += 2e-6 * normal
	O.bodies[one].state.vel = -1.0 * normal
	O.dt = 3 * math.sqrt(MASS / SPRING)
	with pytest.raises(RuntimeError, match=f"critical time step .* set by bodies #.* and #"):
		for _ in range(2000):  # O.run may be over before it waits for an error
			O.step()
	assert O.iter < 100 and O.bodies[one].state.vel.norm() < 20


def test_bonds_that_are_made_in_a_run_are_watched_one_by_one_too():
	rock()
	one, two = ball((0, 0, 0)), ball((2 * RADIUS, 0, 0))
	O.engines = ddem.bonded.engines()
	O.engines[2].loopOnSortedInteractions = True
	O.dt = 3 * math.sqrt(MASS / SPRING)
	O.run(10, True)
	Ip2_BondedMat_BondedMat_BondedPhys().bond([(one, two)])
	with pytest.raises(RuntimeError, match="above the critical time step"):
		O.step()


@pytest.mark.parametrize("sorted_", (False, True))
def test_what_a_functor_stops_is_an_error_and_not_the_end_of_the_program(sorted_):
	"""Walls that have met; also where interactions go one by one."""
	O.materials.append(ElasticWallMat(label="plate", stiffness=50e9))
	one, _, normal, _ = on("wall", 1e-6, material="plate")
	O.engines[2].loopOnSortedInteractions = sorted_
	O.step()
	O.bodies[one].state.pos = -1.5 * RADIUS * normal
	O.bodies[0].shape.sense = 1
	with pytest.raises(RuntimeError, match="m behind the wall #0 .* the platens have met"):
		O.step()


def test_grid_connections_are_refused():
	"""Their forces would have to go to the nodes."""
	rock()
	O.materials.append(CohFrictMat(label="wire"))
	O.engines = [
		ForceResetter(),
		InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_GridConnection_Aabb()]),
		BondedInteractionLoop(
			[Ig2_GridNode_GridNode_GridNodeGeom6D(), Ig2_Sphere_GridConnection_ScGridCoGeom()],
			[
				Ip2_BondedMat_BondedMat_BondedPhys(), Ip2_FrictMat_BondedMat_BondedPhys(),
				Ip2_CohFrictMat_CohFrictMat_CohFrictPhys()
			],
			[Law2_ScGeom_BondedPhys_Bonded(), Law2_ScGeom6D_CohFrictPhys_CohesionMoment()]
		),
		NewtonIntegrator(),
	]
	nodes = [
		O.bodies.append(gridpfacet.gridNode((x, 0, 0), 0.2e-3, material="wire", fixed=True))
		for x in (-5e-3, 5e-3)
	]
	O.bodies.append(gridpfacet.gridConnection(*nodes, 0.2e-3, material="wire"))
	ball((0, RADIUS + 0.15e-3, 0))
	O.dt = 1e-10
	with pytest.raises(RuntimeError, match="no contact with grid connections and PFacets"):
		O.step()


# ---- YADE's steppers and controllers ----


def sample(**more):
	rock(cohesion=60e6, **more)
	return ddem.bonded.append(ddem.packing.prism(0.01, 0.02, 0.01, 1e-3, 2e-3, seed=1), "rock")


def test_the_stiffness_stepper_of_yade_stays_below_the_bound():
	rocks = sample()
	bound = ddem.bonded.critical_time_step()
	O.engines = [*ddem.bonded.engines(), GlobalStiffnessTimeStepper(timeStepUpdateInterval=10)]
	O.dt = 0.1 * bound
	O.run(300, True)
	assert 0.3 * bound < O.dt < bound and len(rocks.broken) == 0
	assert 0.5 * (rocks.velocities**2).sum() < 1e-6


def run_and_step():
	O.run(10, True)  # waits only for a run that it sees: an error that comes too soon is lost
	O.step()


@pytest.mark.parametrize("run", (run_and_step, lambda: O.step(), lambda: ddem.run(steps=10)))
def test_a_step_above_the_bound_stops(run):
	sample()
	O.engines = ddem.bonded.engines()
	bound = ddem.bonded.critical_time_step()
	O.dt = 1.001 * bound
	with pytest.raises(
		RuntimeError, match=r"above the critical time step .* set by bodies #\d+ and #\d+ .*time_step"
	):
		run()
	O.dt = 0.999 * bound
	O.run(10, True)  # and goes on when it is right


def test_a_step_that_a_stepper_makes_too_long_names_it():
	sample()
	stepper = GlobalStiffnessTimeStepper(timestepSafetyCoefficient=3, timeStepUpdateInterval=1)
	O.engines = [*ddem.bonded.engines(), stepper]
	O.dt = ddem.bonded.time_step(0.1)
	with pytest.raises(
		RuntimeError, match="GlobalStiffnessTimeStepper sets O.dt: lower its timestepSafetyCoefficient"
	):
		O.step()
		O.step()


def test_triaxial_stress_on_box_walls():
	"""What users of YADE do with rock: six boxes, a controller, 5 MPa."""
	rocks = sample()
	sides = O.bodies.append(utils.aabbWalls(thickness=0, material="rock"))
	names = ("left", "right", "bottom", "top", "back", "front")
	controller = TriaxialStressController(
		thickness=0, stressMask=7, internalCompaction=False, goal1=-5e6, goal2=-5e6, goal3=-5e6, max_vel=0.05,
		**{f"wall_{name}_id": side for name, side in zip(names, sides)}
	)
	O.engines = [
		ForceResetter(),
		InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Box_Aabb()]),
		BondedInteractionLoop(
			[Ig2_Sphere_Sphere_ScGeom(), Ig2_Box_Sphere_ScGeom()], [Ip2_BondedMat_BondedMat_BondedPhys()],
			[Law2_ScGeom_BondedPhys_Bonded()]
		),
		GlobalStiffnessTimeStepper(timestepSafetyCoefficient=0.3, timeStepUpdateInterval=10),
		controller,
		NewtonIntegrator(damping=0.2),
	]
	O.dt = ddem.bonded.time_step(0.3)
	O.run(500, True)
	assert [controller.stress(k)[k // 2] for k in range(6)] == pytest.approx([-5e6] * 6, rel=0.02)
	assert len(rocks.broken) == 0


def test_a_uniaxial_strainer_measures_the_modulus_of_a_lattice():
	"""Columns of a cubic lattice, pulled by their end spheres: E = k_n/d; its strain is that of the centres."""
	rock()
	count, side = (2, 6, 2), 2 * RADIUS
	places = side * (np.array([(x, y, z) for x in range(2) for y in range(6) for z in range(2)]) + 0.5)
	lattice = ddem.bonded.append(ddem.packing.Packing(places, np.full(len(places), RADIUS)), "rock")
	below, above = (
		lattice.ids[abs(places[:, 1] - y) < RADIUS].tolist() for y in (RADIUS, side * count[1] - RADIUS)
	)
	strainer = UniaxialStrainer(
		axis=1, strainRate=20.0, posIds=above, negIds=below, crossSectionArea=(2 * side)**2,
		blockRotations=True,
		blockDisplacements=False, setSpeeds=True, stressUpdateInterval=1
	)
	O.engines = ddem.bonded.engines()
	O.engines = O.engines[:-1] + [strainer, O.engines[-1]]
	O.engines[-1].damping = 0.3
	O.dt = ddem.bonded.time_step(0.3)
	O.run(800, True)
	spring = next(iter(O.interactions)).phys.kn
	assert strainer.avgStress / strainer.strain == pytest.approx(spring / side, rel=0.01)
	assert len(lattice.broken) == 0
