# GPL v2 or later, see LICENSE.
# A scene of deformable triangles that is saved, loaded and continued goes on as if nothing had happened, bit by bit (on
# one thread as on any number).
import sys

import numpy as np
import pytest

from yade import ConcreteDamageMat, DeformableEngine, DeformableTimeStepper, NewtonIntegrator, O, PyRunner, ddem
from yade.utils import sphere

from deformable_samples import agitate, bodies, elastic, skewed_mesh, start, state_positions

ARRAYS = ("nodePosition", "nodeVelocity", "nodeForce", "corePosition", "coreVelocity", "coreForce")
VALUES = (
	"nodeIds", "triangleIds", "vertices", "area", "rotation", "fractureEnergy", "damage", "stress", "strain",
	"plasticStrain", "damageTensor"
)


def crushed(rotation="cosserat"):
	"""Concrete and steel under a ramped platen, beside a falling sphere, with the energy book;
	recorded by a PyRunner."""
	O.materials.append(ConcreteDamageMat(label="concrete"))
	elastic("steel", bulk=151e9, shear=81e9, density=8030)
	mesh = ddem.mesh.rectangle(0.02, 0.04, size=0.005, regions={"steel": ddem.mesh.box(0.005, 0.015, 0.015, 0.025)})
	block = ddem.append(mesh, {"": "concrete", "steel": "steel"}, seed=4)
	platens = ddem.platens(block, velocity=12, ramp=2e-5)
	O.bodies.append(sphere((0.5, 0, 0), 0.01))
	start(DeformableTimeStepper(), *platens.engines, rotation=rotation, damping=0.1, gravity=(0, -10, 0))
	O.engines = O.engines + [NewtonIntegrator(gravity=(0, -10, 0))]
	O.trackEnergy = True


def vibrating(rotation="cosserat"):
	block = ddem.append(skewed_mesh(), elastic())
	start(rotation=rotation)
	agitate(block, 5)
	block.drive(block.node_ids[:2], (0.3, None))
	O.trackEnergy = True


SCENES = {"elastic": vibrating, "concrete": crushed}


def engine_of_scene():
	return [e for e in O.engines if isinstance(e, DeformableEngine)][0]


def everything():
	"""All state that a scene has, for comparison bit by bit."""
	engine = engine_of_scene()
	found = {
		name: engine.array(name).copy()
		for name in ARRAYS + (("coreRotation", "coreSpin") if engine.rotation == "cosserat" else ())
	}
	found.update({name: engine.values(name) for name in VALUES})
	found["State"] = state_positions(range(len(O.bodies)))
	found["energy"] = [value for _, value in sorted(O.energy.items())]
	found["time"] = [O.time, O.iter]
	return found


def assert_same(first, second):
	assert first.keys() == second.keys()
	for name in first:
		assert np.array_equal(first[name], second[name]), name


@pytest.fixture
def records():
	"""What a PyRunner of the scene recorded: (step, sum of node positions)."""
	rows = []
	sys.modules["__main__"].record_positions = lambda: rows.append((O.iter, state_positions(range(5)).sum()))
	return rows


RECORDER = {"command": "record_positions()", "iterPeriod": 7}


STORES = [("cosserat", where) for where in ("scene.xml", "scene.xml.bz2", "scene.bin.gz", "memory")] + [
	("corotational", "memory"),
	("none", "memory"),
]


@pytest.mark.parametrize("rotation, where", STORES)
@pytest.mark.parametrize("scene", SCENES)
def test_a_loaded_scene_goes_on_bitwise(scene, where, rotation, tmp_path, records):
	SCENES[scene](rotation)
	O.engines = O.engines + [PyRunner(**RECORDER)]
	O.run(150, True)
	if where == "memory":
		O.saveTmp("half way")
	else:
		O.save(str(tmp_path / where))
	saved = everything()
	del records[:]
	O.run(150, True)
	once, recorded = everything(), list(records)
	if scene == "concrete":
		assert saved["damage"].max() > 0.01 and once["damage"].max() > saved["damage"].max()
	assert not np.array_equal(saved["nodePosition"], once["nodePosition"])

	del records[:]
	if where == "memory":
		O.loadTmp("half way")
	else:
		O.load(str(tmp_path / where))
	assert_same(everything(), saved)
	O.run(150, True)
	assert_same(everything(), once)
	assert records == recorded and len(records) > 15


def test_a_scene_saved_again_before_its_first_step_keeps_its_state(tmp_path):
	first, second = str(tmp_path / "first.xml"), str(tmp_path / "second.xml")
	crushed()
	O.run(200, True)
	saved = everything()
	O.save(first)
	O.load(first)
	O.save(second)
	O.load(second)
	assert_same(everything(), saved)
	assert saved["damage"].max() > 0.01


def test_saving_does_not_disturb_the_run(tmp_path):
	results = []
	for save in (False, True):
		O.reset()
		crushed()
		O.run(100, True)
		if save:
			O.save(str(tmp_path / "scene.xml"))
			O.saveTmp()
		O.run(100, True)
		results.append(everything())
	assert_same(*results)


def test_a_scene_saved_by_a_pyrunner_has_the_state_of_that_step(tmp_path):
	"""YADE repeats the engines of a step in which a scene was saved, so the loaded scene is one step ahead of its
	O.iter, as with NewtonIntegrator."""
	path = str(tmp_path / "scene.xml")
	vibrating()
	sys.modules["__main__"].save_scene = lambda: O.save(path)
	O.engines = O.engines + [PyRunner(command="save_scene()", iterPeriod=50, firstIterRun=50, nDo=1)]
	O.run(51, True)
	saved = everything()
	O.run(80, True)
	once = everything()
	O.load(path)
	loaded = everything()
	for name in ARRAYS + VALUES:
		assert np.array_equal(loaded[name], saved[name]), name
	O.run(80, True)
	again = everything()
	for name in ARRAYS + VALUES:
		assert np.array_equal(again[name], once[name]), name


def test_a_step_that_changes_right_after_loading_is_taken_as_without(tmp_path):
	ends = []
	for loaded in (False, True):  # forces act for half of the step before, which only the saved state knows
		O.reset()
		vibrating()
		O.run(50, True)
		if loaded:
			O.save(str(tmp_path / "scene.xml"))
			O.load(str(tmp_path / "scene.xml"))
		O.dt *= 0.5
		O.run(3, True)
		ends.append(state_positions(range(len(O.bodies))))
	assert np.array_equal(*ends)


def test_changes_after_loading_take_effect(tmp_path):
	path = str(tmp_path / "scene.xml")
	vibrating()
	O.run(50, True)
	O.save(path)
	O.load(path)
	held, released = O.bodies[5].state, O.bodies[0].state
	held.blockedDOFs, held.vel = "xy", (0, 0, 0)
	released.blockedDOFs = ""
	before = (held.pos[0], held.pos[1])
	O.run(50, True)
	assert (held.pos[0], held.pos[1]) == before
	assert abs(released.vel[0] - 0.3) > 1e-3


def test_a_file_of_another_version_is_refused_every_time(tmp_path):
	path = tmp_path / "scene.xml"
	crushed()
	O.run(150, True)
	O.save(str(path))
	text = path.read_text()
	assert text.count("<savedVersion>") == 1
	version = text.split("<savedVersion>")[1].split("<")[0]
	path.write_text(text.replace(f"<savedVersion>{version}<", "<savedVersion>987<"))
	O.load(str(path))
	for attempt in ("first", "second"):  # not even a second try goes on without the state
		with pytest.raises(RuntimeError, match=f"version 987.*version {version}"):
			O.step()
	with pytest.raises(RuntimeError, match="version 987"):
		engine_of_scene().values("damage")


def test_bodies_can_be_added_after_loading(tmp_path):
	path = tmp_path / "scene.xml"
	crushed()
	O.run(150, True)
	saved = everything()
	O.save(str(path))
	O.load(str(path))
	ddem.append(ddem.mesh.rectangle(0.02, 0.02, size=0.01), "steel", position=(1, 0, 0))
	assert np.array_equal(engine_of_scene().values("damage")[:len(saved["damage"])], saved["damage"])
	O.run(1, True)


@pytest.mark.parametrize("change, says", [(-1, "too short"), (1, "too long")])
def test_a_damaged_file_is_refused_every_time(change, says, tmp_path):
	path = tmp_path / "scene.xml"
	vibrating()
	O.run(10, True)
	O.save(str(path))
	text = path.read_text()
	numbers = text.split("<savedState>")[1].split("</savedState>")[0]
	count = numbers.count("<item>")
	assert count > 100
	last = numbers.rindex("<item>")
	changed = numbers[:last] if change < 0 else numbers + numbers[last:]
	path.write_text(text.replace(numbers, changed.replace(f"<count>{count}<", f"<count>{count + change}<")))
	O.load(str(path))
	for attempt in ("first", "second"):
		with pytest.raises(RuntimeError, match=f"saved state.*{says}"):
			O.step()
