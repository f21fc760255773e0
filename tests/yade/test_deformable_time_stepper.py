# GPL v2 or later, see LICENSE.
"""DeformableTimeStepper: follows the critical time step of triangles that stretch,
and leaves alone scenes that need no help."""
import numpy as np
import pytest

from deformable_samples import agitate, elastic, place, set_velocity, start, steps
from yade import (
	ConcreteDamageMat, DeformableEngine, DeformableTimeStepper, ForceResetter, GlobalStiffnessTimeStepper, O, ddem
)


def crushed(stepper, rotation="cosserat", velocity=10):
	"""A small block of concrete under a platen of 10 m/s; its triangles stretch to several times their size
	as damage lets them go."""
	O.reset()
	O.materials.append(ConcreteDamageMat(label="concrete"))
	block = ddem.append(ddem.mesh.rectangle(0.04, 0.04, 0.01, pattern="crossed"), "concrete", seed=1)
	platens = ddem.platens(block, velocity)
	engine = DeformableEngine(rotation=rotation, inverted="warn")  # crushed far beyond what it bears
	O.engines = [ForceResetter(), *platens.engines, *([stepper] if stepper else []), engine]
	O.dt = 0.8 * engine.criticalTimeStep()
	return block, engine


def test_a_block_can_be_crushed_until_its_triangles_have_stretched_to_a_multiple():
	stepper = DeformableTimeStepper()
	block, engine = crushed(stepper)
	energy, first = ddem.EnergyBalance(), O.dt
	while O.time < 1.5e-3:
		O.run(500, True)
		assert O.dt < 0.85 * engine.criticalTimeStep()  # lowered from 0.82 on, and it looks every 10 steps
	assert O.dt < 0.9 * first
	assert stepper.largest == first
	assert abs(energy.drift) < 1e-4 * -energy.parts()["externalWork"]


def test_no_step_of_an_impact_is_above_the_bound():
	_, engine = crushed(DeformableTimeStepper())  # the equation of state stiffens within some steps
	largest = 0
	for _ in range(300):
		O.step()
		largest = max(largest, O.dt / engine.criticalTimeStep())
	assert 0.75 < largest < 1


def test_a_faster_impact_needs_a_look_in_every_step():
	block, _ = crushed(DeformableTimeStepper(timeStepUpdateInterval=1), velocity=50)
	steps(1000)
	assert np.abs(block.positions).max() < 0.1


def test_without_it_the_run_stops_with_a_way_out():
	crushed(None)
	with pytest.raises(RuntimeError, match="above the critical time step.*let DeformableTimeStepper"):
		while O.time < 1.5e-3:
			O.run(500, True)


@pytest.mark.parametrize("rotation", ["none", "corotational", "cosserat"])
def test_a_scene_of_small_strains_is_not_changed_by_it(rotation):
	ends = []
	for extra in ([], [DeformableTimeStepper(timeStepUpdateInterval=1)]):
		O.reset()
		block = ddem.append(ddem.mesh.rectangle(0.04, 0.04, 0.01), elastic())
		engine = start(*extra, rotation=rotation)
		agitate(block, 0.1)
		steps(300)
		ends.append((O.dt, engine.array("nodePosition").copy()))
	assert ends[0][0] == ends[1][0]
	assert np.array_equal(ends[0][1], ends[1][1])


def test_the_step_rises_again_up_to_the_largest():
	block = ddem.append(ddem.mesh.rectangle(0.02, 0.02, 0.01), elastic())
	start(DeformableTimeStepper(timeStepUpdateInterval=1))
	first = O.dt

	# against their vertices: from a right angle on, a core that turns on strains its triangle
	# more than any other motion
	def turn_cores(angle):
		for i in block.triangle_ids:
			O.bodies[int(i)].state.ori = ((0, 0, 1), angle)
			O.bodies[int(i)].state.angVel = (0, 0, 0)

	O.step()
	assert O.dt == first
	turn_cores(np.pi / 2)
	O.step()
	assert O.dt < 0.9 * first
	turn_cores(0)
	place(block, lambda x, y: (x, y))
	set_velocity(block, lambda x, y: (0, 0))
	O.step()
	assert O.dt == first


def test_triangles_that_come_later_lower_the_step_at_once():
	O.reset()
	elastic()
	ddem.append(ddem.mesh.rectangle(0.02, 0.02, 0.01), "elastic")
	engine = start(DeformableTimeStepper(timeStepUpdateInterval=1000))
	steps(15)
	first = O.dt
	ddem.append(ddem.mesh.rectangle(0.01, 0.01, 0.005), "elastic", position=(1, 0, 0))
	O.step()
	assert O.dt == pytest.approx(0.5 * first) and O.dt <= 0.8 * engine.criticalTimeStep() * (1 + 1e-12)


def test_it_must_come_before_the_engine_and_alone():
	O.reset()
	ddem.append(ddem.mesh.rectangle(0.02, 0.02, 0.01), elastic())
	start()
	O.engines = O.engines + [DeformableTimeStepper()]
	with pytest.raises(RuntimeError, match="DeformableTimeStepper comes after DeformableEngine"):
		O.step()
	O.reset()
	ddem.append(ddem.mesh.rectangle(0.02, 0.02, 0.01), elastic())
	start(GlobalStiffnessTimeStepper(), DeformableTimeStepper())
	with pytest.raises(RuntimeError, match="more than one engine that sets O.dt.*largest"):
		O.step()


def test_one_that_looks_too_seldom_is_told_so():
	crushed(DeformableTimeStepper(timeStepUpdateInterval=10000))
	with pytest.raises(RuntimeError, match="looks every 10000 steps: let it look more often"):
		steps(300)


def test_errors_name_value_and_way_out():
	for values, text in (
		({"safety": 0.0}, "safety = 0.*0.8 is a good choice"),
		({"safety": 1.5}, "safety = 1.5"),
		({"largest": -1.0}, "largest = -1.*0 takes O.dt"),
	):
		with pytest.raises(Exception, match=text):
			DeformableTimeStepper(**values)


def test_without_an_engine_it_says_so():
	O.engines = [ForceResetter(), DeformableTimeStepper()]
	O.dt = 1e-7
	with pytest.raises(RuntimeError, match="no DeformableEngine"):
		O.step()


def test_the_largest_step_is_kept_in_a_saved_scene(tmp_path):
	crushed(DeformableTimeStepper())
	first, file = O.dt, str(tmp_path / "scene.xml.bz2")
	O.run(150, True)
	O.save(file)
	O.load(file)
	stepper = next(e for e in O.engines if isinstance(e, DeformableTimeStepper))
	assert stepper.largest == first
