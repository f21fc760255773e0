# GPL v2 or later, see LICENSE.
# Rigid bonded particles inside YADE: closed forms of two particles, conservation, failure, friction, walls, saving,
# a small crushed specimen.
import math

import numpy as np
import pytest

import yade
from yade import (
	Bo1_Sphere_Aabb, BondedMat, ElasticWallMat, ForceResetter, FrictMat, Ig2_Sphere_Sphere_ScGeom,
	InsertionSortCollider, InteractionLoop,
	Ip2_BondedMat_BondedMat_BondedPhys, NewtonIntegrator, O, Quaternion, RampedTranslationEngine, Vector3,
	ViscousBodyDamping, ddem, utils
)
from yade.ddem import bonded, packing

YOUNG, POISSON = 100e9, 0.25
RADIUS = 1e-3
AREA = math.pi * RADIUS**2
KN = math.pi * YOUNG * RADIUS / 2  # stiffnesses of a bond between touching spheres of this radius
KS = KN / 2.5
KB = math.pi * YOUNG * RADIUS**3 / 8
KT = KB * 2 / 2.5
COHESION = 100e6


@pytest.fixture(autouse=True)
def each_test_has_its_scene():
	new_scene()
	yield
	O.reset()


def new_scene():
	O.reset()
	O.materials.append(
		BondedMat(
			label="rock", young=YOUNG, poisson=POISSON, cohesion=COHESION, bondFrictionAngle=math.atan(0.5),
			density=2600
		)
	)


def pair(radius1=RADIUS, radius2=RADIUS, gap=0.0, bond=True):
	"""Two touching spheres along x; their ids."""
	spheres = packing.Packing([(0, 0, 0), (radius1 + radius2 + gap, 0, 0)], [radius1, radius2], bonds=[(0, 1)])
	if bond:
		return bonded.append(spheres, "rock").ids.tolist()
	return O.bodies.append(
		[utils.sphere(c, r, material="rock") for c, r in zip(spheres.centres.tolist(), spheres.radii.tolist())]
	)


def static_engines():
	"""Forces only: nothing moves unless the test moves it."""
	O.engines = bonded.engines()
	O.engines[-1].mask = 2  # no body has it
	O.dt = 1e-9


def loads(body):
	return np.array(O.forces.f(body)), np.array(O.forces.t(body))


def turn(angle, axis):
	return Quaternion(Vector3(*axis), angle)


class TestClosedForms:
	def moved(self, displacement=(0, 0, 0), turn1=None, turn2=None):
		one, two = pair()
		static_engines()
		O.bodies[two].state.pos += Vector3(*displacement)
		for body, rotation in ((one, turn1), (two, turn2)):
			if rotation:
				O.bodies[body].state.ori = turn(*rotation)
		O.step()
		return [*loads(one), *loads(two)]

	def test_normal(self):
		f1, m1, f2, m2 = self.moved((1e-7, 0, 0))
		assert f1 == pytest.approx([KN * 1e-7, 0, 0], rel=1e-8) and np.array_equal(f2, -f1)
		assert not m1.any() and not m2.any()

	def test_shear(self):
		f1, m1, f2, m2 = self.moved((0, 1e-7, 0))
		assert f1[1] == pytest.approx(KS * 1e-7, rel=1e-9)
		assert m1[2] == pytest.approx(KS * 1e-7 * RADIUS, rel=1e-9) and m2[2] == pytest.approx(m1[2], rel=1e-9)

	def test_bending(self):
		f1, m1, f2, m2 = self.moved(turn1=(-1e-4, (0, 0, 1)), turn2=(1e-4, (0, 0, 1)))
		assert m1[2] == pytest.approx(KB * 2e-4, rel=1e-9) and np.allclose(m2, -m1, rtol=1e-12)
		assert np.abs(f1).max() < 1e-9 * KN * RADIUS

	def test_torsion(self):
		f1, m1, f2, m2 = self.moved(turn2=(2e-4, (1, 0, 0)))
		assert m1[0] == pytest.approx(KT * 2e-4, rel=1e-9) and np.allclose(m2, -m1, rtol=1e-12)

	def test_unequal_radii_share_one_beam(self):
		one, two = pair(1e-3, 3e-3)
		static_engines()
		O.bodies[two].state.pos += Vector3(0, 1e-7, 0)
		O.step()
		shear = math.pi * (2e-3)**2 * YOUNG / 2.5 / 4e-3 * 1e-7  # G A/d0 with R = d0/2
		assert loads(one)[0][1] == pytest.approx(shear, rel=1e-9)
		assert loads(one)[1][2] == pytest.approx(shear * 2e-3, rel=1e-9) and loads(two)[1][2] == pytest.approx(
			shear * 2e-3, rel=1e-9
		)

	def test_rest_length_is_the_first_distance(self):
		for gap in (-1e-5, 1e-5):
			new_scene()
			one, two = pair(gap=gap)
			static_engines()
			O.step()
			assert np.linalg.norm(loads(one)[0]) < 1e-9 * KN * 1e-5


class TestFailure:
	def test_tension_at_the_exact_load(self):
		limit = COHESION / 0.5 * AREA / KN  # stretch at which σ = C/tan φ
		for factor, held in ((1 - 1e-9, True), (1 + 1e-9, False)):
			new_scene()
			one, two = pair()
			static_engines()
			O.bodies[two].state.pos += Vector3(factor * limit, 0, 0)
			O.step()
			assert (bonded.law().brokenCount() == 0) == held
		broken, = bonded.law().brokenBonds()
		assert broken.mode == "tension" and (broken.id1, broken.id2) == (one, two)
		assert broken.normalStress == pytest.approx(2 * COHESION) and broken.shearStress == 0
		assert broken.pos == pytest.approx([RADIUS + limit / 2, 0, 0])
		assert broken.energy == pytest.approx(0.5 * KN * limit**2, rel=1e-6)
		assert not loads(one)[0].any()
		O.step()
		assert not loads(one)[0].any() and O.interactions.countReal() == 0

	def test_shear_at_the_exact_load(self):
		limit = COHESION * AREA / KS
		for factor, held in ((1 - 1e-9, True), (1 + 1e-9, False)):
			new_scene()
			one, two = pair()
			static_engines()
			O.bodies[two].state.pos += Vector3(0, factor * limit, 0)
			O.step()
			assert (bonded.law().brokenCount() == 0) == held
		assert bonded.law().brokenBonds()[0].mode == "shear"
		assert bonded.law().brokenBonds()[0].shearStress == pytest.approx(COHESION)

	def test_a_compressed_bond_keeps_its_normal_force(self):
		one, two = pair()
		static_engines()
		O.bodies[two].state.pos += Vector3(-1e-6, 0, 0)
		O.step()
		assert loads(one)[0] == pytest.approx([-KN * 1e-6, 0, 0])
		O.bodies[two].state.pos += Vector3(0, 2 * COHESION * AREA / KS, 0)
		O.step()
		assert bonded.law().brokenCount() == 1
		branch = np.array(O.bodies[two].state.pos)
		distance = np.linalg.norm(branch)
		assert loads(one)[0] == pytest.approx(KN * (distance - 2 * RADIUS) * branch / distance)
		assert O.interactions[one, two].phys.shearForce.norm() == 0

	def test_a_broken_bond_does_not_heal(self):
		one, two = pair()
		static_engines()
		for stretch in (5e-6, -5e-6):
			O.bodies[two].state.pos = Vector3(2 * RADIUS + stretch, 0, 0)
			O.step()
		assert bonded.law().brokenCount() == 1 and len(bonded.law().bonds()["ids"]) == 0

	def test_an_overlap_at_the_start_stays_free_of_load_after_failure(self):
		one, two = pair(gap=-1e-5)
		static_engines()
		O.bodies[two].state.pos += Vector3(5e-6, 0, 0)
		for _ in range(3):
			O.step()
			assert bonded.law().brokenCount() == 1 and not loads(one)[0].any()
		O.bodies[two].state.pos -= Vector3(7e-6, 0, 0)  # 2 µm nearer than they were bonded
		O.step()
		reach = 2 * RADIUS - 1e-5
		assert loads(one)[0][0] == pytest.approx(-math.pi * YOUNG * reach / 4 * 2e-6, rel=1e-6)

	def test_records_are_in_order_of_step_and_ids(self):
		centres = [(2 * RADIUS * i, 0, 0) for i in range(6)]
		bonded.append(packing.Packing(centres, [RADIUS] * 6), "rock")
		static_engines()
		for bodies in ((5,), (3, 1)): # the second step breaks the bonds on either side of both
			for body in bodies:
				O.bodies[body].state.pos += Vector3(0, 1e-4, 0)
			O.step()
		records = [(b.iter, b.id1, b.id2) for b in bonded.law().brokenBonds()]
		assert records == sorted(records) and [r[1:] for r in records] == [
			(4, 5), (0, 1), (1, 2), (2, 3), (3, 4)
		]


class TestFriction:
	def test_static_until_the_first_slip_then_dynamic(self):
		O.materials[0].frictionStatic, O.materials[0].frictionDynamic = 0.6, 0.4
		one, two = pair(gap=-2e-6, bond=False)
		O.engines = bonded.engines()
		for body in (one, two):
			O.bodies[body].state.blockedDOFs = "xyzXYZ"
		O.bodies[two].state.vel = Vector3(0, 0.01, 0)
		O.dt = 1e-6  # a slip of 10 nm a step: 300 steps to 0.6 Fn
		ratio = []
		for _ in range(400):
			O.step()
			phys = O.interactions[one, two].phys
			ratio.append(phys.shearForce.norm() / phys.normalForce.norm())
		assert 0.597 < max(ratio) <= 0.6
		slip = int(np.argmax(ratio))
		assert 297 <= slip <= 301
		assert ratio[slip + 1:] == pytest.approx([0.4] * (399 - slip), rel=2e-3)
		assert loads(one)[0][1] > 0  # dragged along with the other


class TestConservation:
	def test_momenta_and_energy_of_free_flight(self):
		random = np.random.default_rng(5)
		sample = bonded.append(
			packing.Packing([(0, 0, 0), (2.2e-3, 0, 0), (1e-3, 1.9e-3, 0.4e-3)], [0.7e-3, 1.5e-3, 0.6e-3]),
			"rock",
			gap=2e-3,
		)
		O.engines = bonded.engines()
		O.dt = 0.2 * bonded.critical_time_step()
		O.trackEnergy = True
		bodies = [O.bodies[int(i)] for i in sample.ids]
		for body in bodies:
			body.state.vel = Vector3(*random.uniform(-5, 5, 3))
			body.state.angVel = Vector3(*random.uniform(-3000, 3000, 3))

		def momenta():
			linear = sum((b.state.mass * b.state.vel for b in bodies), Vector3.Zero)
			# positions are half a step ahead of velocities
			angular = sum(
				(
					b.state.mass * b.state.pos.cross(b.state.vel)
					+ b.state.inertia[0] * b.state.angVel
					for b in bodies
				),
				Vector3.Zero,
			)
			return np.array(linear), np.array(angular)

		linear, angular = momenta()
		O.step()
		energy = []
		for _ in range(3000):
			O.step()
			energy.append(O.energy.total())
		assert O.energy["bondElastic"] > 0.01 * energy[0]
		assert np.linalg.norm(momenta()[0] - linear) < 1e-12 * np.linalg.norm(linear)
		assert np.linalg.norm(momenta()[1] - angular) < 1e-12 * np.linalg.norm(angular)
		assert np.ptp([np.mean(part) for part in np.array_split(energy, 6)]) < 2e-3 * energy[0]
		assert bonded.law().brokenCount() == 0

	def test_bond_energy_is_that_of_its_loads(self):
		one, two = pair()
		static_engines()
		O.trackEnergy = True
		O.bodies[two].state.pos += Vector3(-1e-7, 1e-7, 0)
		O.step()
		assert O.energy["bondElastic"] == pytest.approx(0.5 * (KN + KS) * 1e-14, rel=1e-6)


class TestTimeStep:
	def run_at(self, share):
		"""Growth of a pair's shaking in its fastest mode, shear against both rotations."""
		O.reset()
		O.materials.append(BondedMat(label="rock", cohesion=1e30, density=2600))
		one, two = pair()
		O.engines = bonded.engines()
		# YADE's own loop, which does not stop above the bound
		functors = [
			list(getattr(O.engines[2], f"{kind}Dispatcher").functors) for kind in ("geom", "phys", "law")
		]
		O.engines = [*O.engines[:2], InteractionLoop(*functors), *O.engines[3:]]
		O.dt = share * bonded.critical_time_step()
		for body, sign in ((one, -1), (two, 1)):
			O.bodies[body].state.angVel = Vector3(0, 0, 1e-3)
			O.bodies[body].state.vel = Vector3(0, -sign * 1e-7, 0)
		O.run(2000, True)
		return abs(O.bodies[one].state.angVel[2]) / 1e-3

	def test_is_sharp_for_a_pair(self):
		assert self.run_at(0.99) < 20
		assert self.run_at(1.01) > 100

	def test_counts_walls_before_they_touch(self):
		one, two = pair()
		free = bonded.critical_time_step()
		O.engines = bonded.engines()
		bonded.platens(bonded.BondedSample.from_scene(), 1.0, stiffness=1e13)
		assert bonded.critical_time_step() < 0.5 * free

	def test_is_infinite_without_springs(self):
		pair(bond=False)
		assert math.isinf(bonded.critical_time_step())
		with pytest.raises(ValueError, match="nothing limits the time step"):
			bonded.time_step()


class TestWallsAndMotion:
	def test_walls_repel_with_pi_r_K(self):
		for sense, side in ((1, 1), (-1, -1)):
			new_scene()
			material = ElasticWallMat(stiffness=100e9)
			wall = O.bodies.append(utils.wall(0.0, axis=1, sense=sense, material=material))
			ball = O.bodies.append(utils.sphere((0, side * (0.7e-3 - 1.4e-6), 0), 0.7e-3, material="rock"))
			static_engines()
			O.step()
			# ESyS-Particle 2.3.5 gives 307.876 N
			assert loads(ball)[0] == pytest.approx([0, side * 307.876, 0], abs=1e-3)
			assert np.array_equal(loads(wall)[0], -loads(ball)[0])
			assert not loads(ball)[1].any()

	def test_speed_grows_linearly_to_its_full_value(self):
		ball = O.bodies.append(utils.sphere((0, 0, 0), 1e-3, material="rock", fixed=True))
		O.engines = [
			ForceResetter(),
			RampedTranslationEngine(ids=[ball], translationAxis=(0, 0, 2), velocity=3, rampTime=1e-3),
			NewtonIntegrator(damping=0),
		]
		O.dt = 1e-4
		speeds = []
		for _ in range(14):
			O.step()
			speeds.append(O.bodies[ball].state.vel[2])
		assert speeds == pytest.approx([min(0.3 * i, 3) for i in range(14)])
		assert O.bodies[ball].state.pos[2] == pytest.approx(sum(speeds) * 1e-4)

	def test_a_driven_body_may_be_erased(self):
		balls = O.bodies.append(
			[utils.sphere((3e-3 * i, 0, 0), 1e-3, material="rock", fixed=True) for i in range(2)]
		)
		O.engines = [
			ForceResetter(),
			RampedTranslationEngine(ids=balls, velocity=3),
			NewtonIntegrator(damping=0),
		]
		O.trackEnergy = True
		O.dt = 1e-4
		O.step()
		O.bodies.erase(balls[0])
		O.step()
		assert O.bodies[balls[1]].state.pos[1] == pytest.approx(2 * 3e-4)

	def test_free_bodies_slow_down_exponentially(self):
		ball = O.bodies.append(utils.sphere((0, 0, 0), 1e-3, material="rock"))
		O.engines = [
			ForceResetter(),
			InteractionLoop([], [], []),
			ViscousBodyDamping(viscosity=200, rotationalViscosity=500),
			NewtonIntegrator(damping=0),
		]
		O.bodies[ball].state.vel = Vector3(1, 2, 3)
		O.bodies[ball].state.angVel = Vector3(30, 20, 10)
		O.trackEnergy = True
		O.dt = 1e-5
		O.step()
		energy = O.energy.total() - O.energy["bodyDamping"]
		O.run(999, True)
		assert O.bodies[ball].state.vel == pytest.approx(math.exp(-2) * np.array([1, 2, 3]), rel=1e-5)
		assert O.bodies[ball].state.angVel == pytest.approx(math.exp(-5) * np.array([30, 20, 10]), rel=1e-4)
		O.step()
		assert O.energy.total() == pytest.approx(energy, rel=3e-3)

	@pytest.mark.parametrize("engines, words", [
		([ViscousBodyDamping(), InteractionLoop([], [], []), NewtonIntegrator()], "before InteractionLoop"),
		([InteractionLoop([], [], []), NewtonIntegrator(), ViscousBodyDamping()], "after NewtonIntegrator"),
		([ViscousBodyDamping()], "needs NewtonIntegrator"),
	])
	def test_damping_refuses_a_wrong_order(self, engines, words):
		O.bodies.append(utils.sphere((0, 0, 0), 1e-3, material="rock"))
		O.engines = engines
		with pytest.raises(RuntimeError, match=words):
			O.step()


def specimen(seed=1, **material):
	O.reset()
	O.materials.append(BondedMat(label="rock", **material))
	sample = bonded.append(packing.prism(0.01, 0.02, 0.01, rmin=1e-3, rmax=2e-3, seed=seed, fails=200), "rock")
	platens = bonded.platens(sample, velocity=2.0, ramp=10e-6)
	O.engines = bonded.engines(platens, viscosity=2)
	O.trackEnergy = True
	O.dt = bonded.time_step(0.5)
	return sample, platens


class TestSpecimen:
	def test_is_crushed(self):
		sample, platens = specimen()
		bonded.check()
		stress, strain, broken = [], [], []
		balance = ddem.EnergyBalance()
		while O.time < 120e-6:
			O.run(20, True)
			stress.append(platens.stress)
			strain.append(platens.strain)
			broken.append(sample.broken_fraction)
			balance.record()
		peak = int(np.argmax(stress))
		assert 0 < peak < len(stress) - 1 and stress[-1] < 0.7 * stress[peak]
		assert strain == sorted(strain)
		assert strain[-1] == pytest.approx(2 * 2.0 * (O.time - 5e-6) / 0.02, rel=0.01)
		assert 0 < broken[peak] < broken[-1] < 1
		assert balance.largest < 1e-2  # the bound that the project states for runs that dissipate
		records = sample.broken
		assert (
			len(records)
			== round(broken[-1] * sample.initial_bonds)
			== sample.initial_bonds - len(sample.bonds)
		)
		assert set(records["mode"]) == {"tension", "shear"}
		order = list(zip(records["step"], records["id1"], records["id2"]))
		assert order == sorted(order)
		beyond = records["shear_stress"] - (100e6 - records["normal_stress"])
		assert (beyond > 0).all()
		assert (sample.damage >= 0).all() and 0 < sample.damage.mean() < 1
		assert records["energy"].sum() == pytest.approx(O.energy["bondBroken"])

	def test_forces_on_both_walls_agree_while_slow(self):
		sample, platens = specimen(cohesion=1e12)
		O.engines[3].velocity, O.engines[4].velocity = -0.05, 0.05
		O.engines[5].viscosity = O.engines[5].rotationalViscosity = 2e5
		O.run(1500, True)
		assert platens.force_top == pytest.approx(platens.force_bottom, rel=0.05) and platens.force_top > 0

	def test_goes_on_bitwise_after_saving(self, tmp_path):
		def state():
			bodies = [O.bodies[i].state for i in range(len(O.bodies))]
			return np.array([[*s.pos, *s.vel, *s.angVel, *s.ori] for s in bodies])

		sample, platens = specimen()
		# the order of summation does not depend on what the collider remembers;
		# bonds are then computed one by one
		O.engines[2].loopOnSortedInteractions = True
		O.run(700, True)
		assert 0 < bonded.law().brokenCount() < sample.initial_bonds
		O.save(str(tmp_path / "crushed.yade.gz"))
		O.run(300, True)
		expected, broken, energy = state(), sample.broken, dict(O.energy.items())
		O.load(str(tmp_path / "crushed.yade.gz"))
		O.run(300, True)
		assert np.array_equal(state(), expected)
		again = bonded.BondedSample.from_scene()
		assert np.array_equal(again.broken, broken) and again.initial_bonds == sample.initial_bonds
		assert dict(O.energy.items()) == pytest.approx(energy, rel=1e-12)

	def test_one_layer_stays_in_its_plane(self):
		sample = bonded.append(packing.layer(0.02, 0.03, rmin=1e-3, rmax=2e-3, seed=1, fails=200), "rock")
		platens = bonded.platens(sample, velocity=2.0)
		O.engines = bonded.engines(platens)
		O.dt = bonded.time_step(0.5)
		O.run(300, True)
		assert platens.stress > 0
		assert not sample.positions[:, 2].any()
		assert sample.degrees_of_freedom == 3 * len(sample)


class TestBadInput:
	@pytest.mark.parametrize("change, words", [
		({"poisson": 0.5}, r"poisson = 0.5 \[-\] must lie between -1 and 0.5"),
		({"young": 0}, "young = 0 Pa must be positive"), ({"young": float("nan")}, "young = nan Pa"),
		({"density": -1}, "density = -1 kg/m³ must be positive"), ({"cohesion": 0}, "cohesion = 0 Pa"),
		({"bondFrictionAngle": 45}, "Given in degrees"),
		({"bondFrictionAngle": -0.1}, "rad is not allowed; it must be at least 0"),
		({"frictionDynamic": 0.7}, "frictionStatic = 0.6"), ({"tensileStrength": 0}, "tensileStrength = 0 Pa"),
	])
	def test_material(self, change, words):
		with pytest.raises(ValueError, match="BondedMat 'bad': .*" + words):
			BondedMat(label="bad", **change)

	def test_wall_stiffness(self):
		with pytest.raises(ValueError, match="stiffness = -1 Pa must be positive"):
			ElasticWallMat(stiffness=-1)

	def test_material_spoilt_later_is_found_before_anything_is_appended(self):
		O.materials[0].poisson = 0.5
		with pytest.raises(ValueError, match="poisson = 0.5"):
			pair()
		assert len(O.bodies) == 0

	def test_unknown_label_and_other_materials(self):
		spheres = packing.Packing([(0, 0, 0), (2, 0, 0)], [1, 1])
		with pytest.raises(ValueError, match="no material with label 'stone' in O.materials; it has: rock"):
			bonded.append(spheres, "stone")
		with pytest.raises(ValueError, match="bonded spheres need a BondedMat, not FrictMat"):
			bonded.append(spheres, FrictMat())
		assert len(O.bodies) == 0

	def test_nothing_to_bond(self):
		with pytest.raises(ValueError, match="nothing would be bonded"):
			bonded.append(packing.Packing([(0, 0, 0), (3, 0, 0)], [1, 1]), "rock")
		assert len(O.bodies) == 0

	@pytest.mark.parametrize("pairs, words", [
		([(0, 0)], "itself"), ([(0, 1), (1, 0)], "bonded already"), ([(0, 9)], "there is no body #9"),
		([(0, 2)], "#2 is not a sphere"), ([(0, 3)], "#3 has no BondedMat"),
		([(0, 4)], "same centre"),
	])
	def test_pairs(self, pairs, words):
		pair(bond=False)
		O.bodies.append([
			utils.wall(0.0, axis=1, material="rock"),
			utils.sphere((9, 0, 0), 1, material=FrictMat()),
			utils.sphere((0, 0, 0), RADIUS, material="rock")
		])
		with pytest.raises(ValueError, match=words):
			Ip2_BondedMat_BondedMat_BondedPhys().bond([(0, 1)] * (pairs[0] != (0, 1)) + pairs)
		assert len(O.interactions) == 0

	@pytest.mark.parametrize("change, words", [
		({"velocity": 0}, "velocity = 0 m/s"), ({"velocity": float("nan")}, "velocity = nan"),
		({"velocity": -1}, "only push"), ({"ramp": -1}, "ramp = -1 s"),
		({"stiffness": 0}, "stiffness = 0 Pa"),
	])
	def test_platens(self, change, words):
		sample = bonded.append(packing.Packing([(0, 0, 0), (2, 0, 0)], [1, 1]), "rock")
		with pytest.raises(ValueError, match=words):
			bonded.platens(sample, **{**dict(velocity=1.0), **change})
		assert len(O.bodies) == 2

	def test_spheres_at_one_place(self):
		with pytest.raises(ValueError, match="spheres 0 and 2 of the packing have the same centre"):
			bonded.append(
				packing.Packing([(0, 0, 0), (2, 0, 0), (0, 0, 0)], [1, 1, 1], bonds=[(0, 1), (0, 2)]),
				"rock",
			)
		assert len(O.bodies) == 0

	def test_missing_or_misplaced_engines(self):
		pair()
		O.engines = []
		with pytest.raises(RuntimeError, match="no ForceResetter"):
			bonded.check()
		complete = bonded.engines()
		O.engines = [
			complete[0],
			complete[1],
			InteractionLoop([Ig2_Sphere_Sphere_ScGeom()], [], []),
			complete[-1],
		]
		with pytest.raises(RuntimeError, match="no InteractionLoop with Law2_ScGeom_BondedPhys_Bonded"):
			bonded.check()
		O.engines = [complete[0], complete[1], complete[2], bonded.engines()[2], complete[3]]
		with pytest.raises(RuntimeError, match="more than one InteractionLoop"):
			bonded.check()
		O.engines = [complete[1], complete[2], complete[3], complete[0]]
		with pytest.raises(RuntimeError, match="wrong order"):
			bonded.check()

	def test_time_step_above_critical(self):
		pair()
		O.engines = bonded.engines()
		O.dt = 1.01 * bonded.critical_time_step()
		with pytest.raises(ValueError, match="above the critical time step"):
			bonded.check()
		O.dt = bonded.time_step(0.99)
		bonded.check()

	def test_time_step_share(self):
		with pytest.raises(ValueError, match="safety = 1.2"):
			bonded.time_step(1.2)

	@pytest.mark.parametrize(
		"engine, change", [(ViscousBodyDamping, {"viscosity": -1}), (RampedTranslationEngine, {"rampTime": -1})]
	)
	def test_engine_parameters(self, engine, change):
		with pytest.raises(ValueError, match="-1.0* .*must not be negative"):
			engine(**change)


class TestOtherModels:
	"""What the manual's table says of YADE's own bonded materials: asked of YADE's own contacts."""

	RADIUS, YOUNG = 1e-3, 1e9

	def contact(self, material, ip2, law):
		O.reset()
		O.materials.append(material)
		for x in (0, 2 * self.RADIUS):
			O.bodies.append(utils.sphere(Vector3(x, 0, 0), self.RADIUS, material=material))
		O.engines = [
			ForceResetter(),
			InsertionSortCollider([Bo1_Sphere_Aabb(aabbEnlargeFactor=1.5)]),
			InteractionLoop([Ig2_Sphere_Sphere_ScGeom(interactionDetectionFactor=1.5)], [ip2], [law]),
			NewtonIntegrator(),
		]
		O.dt = 1e-9
		O.step()
		return O.interactions[0, 1].phys

	def ours(self, ratio, **more):
		O.reset()
		O.materials.append(BondedMat(label="rock", young=self.YOUNG, poisson=1 / (2 * ratio) - 1, **more))
		spheres = packing.Packing([(0, 0, 0), (2 * self.RADIUS, 0, 0)], [self.RADIUS] * 2)
		bonded.append(spheres, "rock", gap=1e-6)
		return O.interactions[0, 1].phys

	def test_jcfpm(self):
		material = yade.JCFpmMat(
			young=self.YOUNG, poisson=0.4, cohesion=1e6, tensileStrength=2e6, frictionAngle=0.5,
			density=2600
		)
		theirs = self.contact(
			material, yade.Ip2_JCFpmMat_JCFpmMat_JCFpmPhys(cohesiveTresholdIteration=1),
			yade.Law2_ScGeom_JCFpmPhys_JointedCohesiveFrictionalPM()
		)
		ours = self.ours(ratio=0.4)
		assert ours.kn == pytest.approx(math.pi / 2 * theirs.kn, rel=1e-6)
		assert ours.ks / ours.kn == pytest.approx(theirs.ks / theirs.kn, rel=1e-6)
		area = math.pi * self.RADIUS**2
		assert (theirs.FnMax, theirs.FsMax) == (pytest.approx(2e6 * area), pytest.approx(1e6 * area))

	def test_cpm(self):
		material = yade.CpmMat(
			young=self.YOUNG, poisson=0.4, sigmaT=1e6, frictionAngle=0.5, epsCrackOnset=1e-4,
			relDuctility=30
		)
		theirs = self.contact(
			material, yade.Ip2_CpmMat_CpmMat_CpmPhys(cohesiveThresholdIter=1),
			yade.Law2_ScGeom_CpmPhys_Cpm()
		)
		ours = self.ours(ratio=0.4)
		assert ours.kn == pytest.approx(theirs.kn, rel=1e-6)
		assert ours.ks == pytest.approx(theirs.ks, rel=1e-6)
		assert (theirs.undamagedCohesion, theirs.epsCrackOnset) == (1e6, 1e-4)
