# GPL v2 or later, see LICENSE.
"""What Python sees and changes of State in a run, in which State lags until somebody looks: as if it never lagged."""
import shutil
import subprocess

import numpy as np
import pytest

from deformable_samples import agitate, elastic, in_main, skewed_mesh, start, state_positions, state_velocities
from waiting import BackgroundRun, until
from yade import (
	Body, DeformableElastMat, DeformableEngine, Engine, ForceResetter, FrictMat, NewtonIntegrator, O,
	PeriodicEngine, PyRunner, RadialForceEngine, State, TranslationEngine, Vector3, ddem, minieigenHP, utils
)

STEPS = 12


def numbers(value):
	"""Whatever Python saw, as a flat list of numbers."""
	if value is None:
		return []
	if isinstance(value, dict):
		return [number for key in sorted(value) for number in numbers(value[key])]
	try:
		return [float(value)]
	except TypeError:
		return [number for part in value for number in numbers(part)]


class Scene:
	"""A block with a driven side, and what commands of a PyRunner need; `held` are States taken before the run."""

	def __init__(self, place):
		self.material = elastic()
		self.other = elastic("soft", bulk=3e9, shear=2e9)
		self.block = ddem.append(skewed_mesh(), self.material)
		self.node, self.core = int(self.block.node_ids[5]), int(self.block.triangle_ids[7])
		self.top = self.block.boundary(lambda x, y: y > 0.024)
		self.block.hold(self.top, "y")
		O.materials.append(FrictMat(label="spheres"))
		self.ball = O.bodies.append(utils.sphere((5, 5, 5), 0.1, material="spheres"))
		self.drive = TranslationEngine(ids=[int(i) for i in self.top], translationAxis=(0, 1, 0), velocity=-1)
		# engines of YADE that read State in every step
		radial = dict(ids=[self.core], axisPt=(0.02, 0.4, 0), axisDir=(0, 0, 1), fNorm=2e4)
		self.reader, self.other_reader = RadialForceEngine(dead=True, **radial), RadialForceEngine(**radial)
		runner = PyRunner(command="command()", iterPeriod=1)
		self.engine = start(self.reader, *([self.drive, runner] if place == "before" else [self.drive]))
		O.engines = O.engines + ([runner] if place == "after" else []) + [NewtonIntegrator(damping=0)]
		self.held = [O.bodies[i].state for i in (self.node, self.core)]
		agitate(self.block, 5)
		self.velocity, self.spin = self.held[0].vel, self.held[1].angVel  # references into State


def give(owner, **attributes):
	for name, value in attributes.items():
		setattr(owner, name, value)


def state(scene):
	return O.bodies[scene.core].state


READ = {
	"pos": lambda s: O.bodies[s.node].state.pos,
	"vel": lambda s: O.bodies[s.core].state.vel,
	"ori": lambda s: O.bodies[s.core].state.ori.toAxisAngle(),
	"angVel": lambda s: O.bodies[s.core].state.angVel,
	"se3": lambda s: O.bodies[s.core].state.se3[0],
	"displ, rot": lambda s: [state(s).displ(), state(s).rot()],
	"dict": lambda s: {name: v for name, v in state(s).dict().items() if name in ("vel", "angVel", "mass")},
	"held": lambda s: [part.pos for part in s.held],
	"arrays of vectors": lambda s: [
		np.array(state(s).pos),
		tuple(state(s).vel),
		len(state(s).pos),
		list(state(s).angVel),
	],
	"flags": lambda s: [O.bodies[s.core].dynamic, O.bodies[s.core].isStandalone, O.bodies[s.core].mask],
	"kept vectors": lambda s: [s.velocity[1], s.velocity.norm(), s.spin[2]],
	"kept vector in a sum": lambda s: Vector3(1, 0, 0) + s.velocity,
	"kept vector given on": lambda s: O.forces.addF(s.core, 100 * s.velocity),
	"all": lambda s: [b.state.pos for b in O.bodies],
	"driven": lambda s: [(O.bodies[int(i)].state.pos, O.bodies[int(i)].state.vel) for i in s.top],
	"driven after bulk": lambda s: [utils.kineticEnergy(), [O.bodies[int(i)].state.vel for i in s.top]],
	"other bodies": lambda s: [O.bodies[s.ball].state.pos, O.bodies[s.ball].state.vel],
	"nodes, then all": lambda s: [O.bodies[s.node].state.vel, utils.kineticEnergy(), O.bodies[s.core].state.vel],
	"bulk functions": lambda s: [utils.kineticEnergy(), utils.aabbExtrema(), utils.unbalancedForce()],
	"getattr": lambda s: getattr(O.bodies[s.node].state, "vel"),
	"class's property": lambda s: State.vel.fget(O.bodies[s.node].state),
	"function kept": lambda s: KEPT(O.bodies[s.node].state),
	"function's __call__": lambda s: [KEPT.__call__(O.bodies[s.node].state), utils.kineticEnergy.__call__()],
	"map": lambda s: list(map(KEPT, s.held)),
	"forces": lambda s: [O.forces.f(int(i)) for i in s.top],
	"arrays": lambda s: [s.block.positions, s.block.stress],
	"shape": lambda s: [O.bodies[s.core].shape.stress[0], O.bodies[s.core].shape.rotation],
	"to string": lambda s: [len(str(O.bodies[s.core].state)) > 0],
	"engine called": lambda s: [seen for seen in [utils.kineticEnergy()]],
}
KEPT = State.pos.fget

WRITTEN = {
	"vel": lambda s: O.iter == 4 and give(O.bodies[s.node].state, vel=(0.3, 0.2, 0)),
	"vel of all, each step": lambda s: [give(O.bodies[int(i)].state, vel=(0, -1, 0)) for i in s.block.triangle_ids],
	"held": lambda s: [give(part, vel=(0.1, 0.1, 0)) for part in s.held],
	"kept vector": lambda s: O.iter == 4 and s.velocity.__setitem__(1, 0.25),
	"part of a vector": lambda s: O.iter == 4 and O.bodies[s.core].state.angVel.__setitem__(2, 3.0),
	"pos": lambda s: O.iter == 4 and give(O.bodies[s.node].state, pos=O.bodies[s.node].state.pos + (1e-6, 0, 0)),
	"ori": lambda s: O.iter == 4 and give(state(s), ori=utils.Quaternion((0, 0, 1), 0.01)),
	"angVel": lambda s: O.iter == 4 and give(state(s), angVel=(0, 0, 3)),
	"blockedDOFs": lambda s: O.iter == 4 and give(state(s), blockedDOFs="xyZ"),
	"dynamic": lambda s: O.iter == 4 and give(O.bodies[s.core], dynamic=False),
	"driven node": lambda s: give(O.bodies[int(s.top[0])].state, vel=(0.5, 3, 0)),
	"updateAttrs": lambda s: O.iter == 4 and O.bodies[s.node].state.updateAttrs({"vel": (0.3, 0.2, 0)}),
	"then bulk": lambda s: [give(O.bodies[s.node].state, vel=(0.3, 0.2, 0)), utils.kineticEnergy()][1],
	"bulk, then": lambda s: [utils.kineticEnergy(), give(O.bodies[s.node].state, vel=(0.3, 0.2, 0))][0],
	"other State": lambda s: O.iter == 4 and give(O.bodies[s.ball], state=State(mass=1, vel=(3, 3, 3))),
	"forces": lambda s: O.forces.addF(s.core, (100, 20, 0)),
	"torques": lambda s: O.forces.addT(s.core, (0, 0, 0.5)),
	"forces sometimes": lambda s: O.iter % 3 == 0 and O.forces.addF(s.core, (100, 20, 0)),
	"permanent force": lambda s: O.iter == 4 and O.forces.setPermF(s.core, (100, 20, 0)),
	"engine": lambda s: give(s.drive, velocity=-0.1 * O.iter),
	"a reader wakes": lambda s: O.iter == 4 and give(s.reader, dead=False),
	"a reader comes": lambda s: O.iter == 4 and give(O, engines=[O.engines[0], s.other_reader, *O.engines[1:]]),
	"counter of forces": lambda s: [
		O.forces.addF(s.core, (99, 9, 0)), O.forces.f(s.core, sync=True), give(O.forces, syncCount=0)
	][:1],
	"gravity": lambda s: O.iter == 4 and give(s.engine, gravity=(0, -1e5, 0)),
	"material's modulus": lambda s: O.iter == 4 and give(s.material, bulk=20e9),
	"body's material": lambda s: O.iter == 4 and give(O.bodies[s.core], material=s.other),
	"shape": lambda s: O.iter == 4 and give(O.bodies[s.core].shape, thickness=2),
	"treatment": lambda s: O.iter == 4 and give(s.engine, rotation="corotational"),
	"time step": lambda s: give(O, dt=O.dt * 0.99),
	"other bodies come": lambda s: O.bodies.append(utils.sphere((O.iter + 9, 9, 9), 0.1, material="spheres")),
	"block's velocity": lambda s: O.iter == 4 and give(s.block, velocity=(0.5, 0)),
}


def follow(command, place, shown):
	"""What the command gave in each step, and the block at the end; `shown`: State is shown before it is called."""
	O.reset()
	scene, seen = Scene(place), []

	def look():
		if shown:
			utils.kineticEnergy()  # reads State of all bodies: no function that touches nothing
		seen.append(numbers(command(scene)))

	in_main("command", look)
	O.run(STEPS, True)
	ids = [*scene.block.node_ids, *scene.block.triangle_ids]
	end = [scene.block.positions, state_positions(ids), state_velocities(ids), np.array(scene.block.stress)]
	return seen, end


@pytest.mark.parametrize("place", ("before", "after"))
@pytest.mark.parametrize(
	"command", [*READ.values(), *WRITTEN.values()], ids=[*READ, *(name + " written" for name in WRITTEN)]
)
def test_python_does_not_notice_that_state_lags(command, place):
	seen, end = follow(command, place, shown=False)
	expected, expected_end = follow(command, place, shown=True)
	assert len(seen) >= STEPS - 1 and repr(seen) == repr(expected)  # bit by bit, also what is not a number
	for part, wanted in zip(end, expected_end):
		assert np.array_equal(part, wanted)
	assert np.isfinite(end[0]).all()


def test_a_scene_saved_in_a_look_goes_on(tmp_path):
	file = str(tmp_path / "look.yade.gz")
	scene = Scene("after")
	in_main("command", lambda: O.iter == 5 and O.save(file))
	O.run(STEPS, True)
	expected = scene.block.positions.copy()
	O.load(file)
	in_main("command", lambda: None)
	O.run(STEPS - O.iter - 1, True)  # YADE counts a step when it has ended
	assert np.array_equal(O.engines[3].array("nodePosition"), expected)


def test_what_is_not_finite_stops_the_run_with_its_body():
	scene = Scene("before")
	in_main("command", lambda: O.iter == 3 and give(O.bodies[scene.node].state, vel=(np.nan, 0, 0)))
	with pytest.raises(Exception, match=f"body {scene.node} at .*not finite"):
		O.run(STEPS, True)
		O.step()


@pytest.mark.parametrize("ended_by", ("pause", "stopAtIter", "outside"))
def test_state_is_current_where_a_look_ends_a_run(ended_by):
	scene = Scene("after")
	ends = {"pause": O.pause, "stopAtIter": lambda: give(O, stopAtIter=O.iter + 1), "outside": lambda: None}[
		ended_by
	]
	in_main("command", lambda: O.iter == 6 and ends())
	if ended_by == "outside":
		run = BackgroundRun()
		until(lambda: O.iter > 20)
		run.pause()
	else:
		O.run(STEPS, True)
	node = O.bodies[scene.node].state
	assert tuple(node.pos)[:2] == tuple(scene.engine.array("nodePosition")[5])
	node.vel = (0.25, 0.5, 0)
	assert tuple(scene.engine.array("nodeVelocity")[5]) == (0.25, 0.5)  # taken up


def test_looks_at_two_engines():
	blocks = [ddem.append(skewed_mesh(), elastic(label)) for label in ("a", "b")]
	engines = [DeformableEngine(ids=list(blocks[0].triangle_ids)), DeformableEngine(groupMask=1 << 21)]
	seen = []

	def look():
		for block, engine in zip(blocks, engines):
			i = int(block.node_ids[3])
			seen.append(np.abs(np.array(O.bodies[i].state.pos)[:2] - engine.array("nodePosition")[3]).max())

	O.engines = [ForceResetter(), *engines, PyRunner(command=in_main("look", look), iterPeriod=1)]
	O.dt = 1e-7
	for block in blocks:
		agitate(block, 5)
	O.run(STEPS, True)
	assert len(seen) >= 2 * (STEPS - 1) and max(seen) == 0


def test_another_state_between_runs():
	scene = Scene("after")
	seen = []
	in_main("command", lambda: seen.append(np.abs(np.array(O.bodies[scene.node].state.pos)[:2] - nodes[5]).max()))
	nodes = scene.engine.array("nodePosition")
	O.run(STEPS, True)
	before = O.bodies[scene.node].state
	O.bodies[scene.node].state = State()
	for name in ("se3", "vel", "mass", "refPos", "blockedDOFs"):
		setattr(O.bodies[scene.node].state, name, getattr(before, name))
	O.run(STEPS, True)
	assert len(seen) > 2 * STEPS - 4 and max(seen) == 0


def test_pauses_and_reads_beside_a_run_change_nothing():
	results = []
	for pauses in (0, 20):
		O.reset()
		scene = Scene("after")
		in_main("command", lambda: O.bodies[scene.core].state.pos)
		for _ in range(pauses):
			reached = O.iter + 10
			run = BackgroundRun()
			until(lambda: O.iter >= reached)
			O.pause()
			scene.engine.array("nodePosition")  # perhaps while a step is under way
			_ = O.bodies[scene.core].shape.stress
			run.pause()
		assert O.iter < 30_000
		O.run(30_000 - O.iter, True)
		results.append(scene.block.positions.copy())
	assert np.array_equal(*results)


@pytest.mark.parametrize("kept", (False, True))
def test_a_new_engine_after_a_pause_goes_on_from_where_the_old_one_was(kept):
	block = ddem.append(skewed_mesh(), elastic())
	engine = start()
	block.velocity = (3, 0)
	run = BackgroundRun()
	until(lambda: O.iter > 300)
	run.pause()
	moved = 3 * O.dt * O.iter
	O.engines = [ForceResetter(), DeformableEngine()]
	if not kept:
		del engine
	assert block.displacements[:, 0] == pytest.approx(np.full(len(block.node_ids), moved), rel=1e-9)
	now = state_positions(block.node_ids)[:, 0]
	O.step()
	assert state_positions(block.node_ids)[:, 0] == pytest.approx(now + 3 * O.dt, rel=1e-9)
	assert now - block.reference_positions[:, 0] == pytest.approx(np.full(len(now), moved), rel=1e-9)


FORKS = """
import os
from yade import ddem, utils
O.materials.append(DeformableElastMat(young=30e9, poisson=0.2, density=2400, label="rock"))
block = ddem.append(ddem.mesh.rectangle(0.04, 0.04, size=0.002), "rock")
O.engines = [ForceResetter(), DeformableEngine(), PyRunner(command="fork()", iterPeriod=5)]
O.dt = ddem.time_step(0.5)
block.velocity = (1, 0)

def fork():
	child = os.fork()
	if not child:
		box = [O.bodies[i].state.pos[0] for i in block.node_ids[:3]], utils.kineticEnergy()
		moved = O.bodies[block.node_ids[0]].state.displ()[0]
		os._exit(0 if abs(moved - O.dt * (O.iter + 1)) < 1e-9 * moved else 1)
	assert os.waitpid(child, 0)[1] == 0
	print("forked", flush=True)

O.run(20, True)
"""


def test_a_command_may_fork(tmp_path):
	script = tmp_path / "forks.py"
	script.write_text(FORKS)
	run = subprocess.run([shutil.which("yade"), "-n", "-x", "-j2", script], capture_output=True, text=True)
	assert run.stdout.count("forked") > 2, run.stdout + run.stderr


def test_scenes_and_engines_go_while_state_lags():
	for _ in range(3):
		scene = Scene("after")
		in_main("command", lambda: None)
		O.run(STEPS, True)
		O.engines = O.engines[:-1]
		O.run(2, True)
		O.reset()
	O.bodies.append(Body())
	assert tuple(O.bodies[0].state.pos) == (0, 0, 0)


def test_functions_that_touch_one_state_are_those_of_state():
	from yade.ddem import looks
	one, nothing = looks.touching_one_state(), looks.touching_nothing()
	assert State.vel.fget in one and State.vel.fset in one and State.displ in one
	assert not set(map(id, one)) & set(map(id, nothing))
	assert Body.state.fget in nothing and Body.state.fset not in nothing
	assert (
		DeformableElastMat.rotationStiffness.fset not in nothing
		and DeformableEngine.rotation.fset not in nothing
	)
	assert TranslationEngine.velocity.fset in nothing
	vectors = [
		part for name, member in vars(minieigenHP.Vector3).items() if name != "__reduce__"
		for part in looks._parts(member)
	]
	assert all(part in nothing for part in vectors if isinstance(part, type(State.displ)))
	# who looks next: a command that says so must not find that State lags
	timing = [vars(Engine)["dead"], *(m for m in vars(PeriodicEngine).values() if isinstance(m, property))]
	assert len(timing) > 6 and not any(member.fset in nothing for member in timing)
	assert not any(getattr(type(O), name).fset in nothing for name in ("dt", "stopAtIter", "stopAtTime", "engines"))
	for function in (
		utils.kineticEnergy, utils.aabbExtrema, type(O).save, type(O).pause, type(O.bodies).append,
		Body.material.fset
	):
		assert function not in one and function not in nothing
