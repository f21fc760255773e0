# GPL v2 or later, see LICENSE.
"""What YADE users usually write either acts on triangles or stops with the value, the place and the way out."""
import re

import numpy as np
import pytest

from deformable_samples import agitate, elastic, skewed_mesh, start, steps
from yade import (
	ConcreteDamageMat, DeformableEngine, DeformableTimeStepper, ForceEngine, ForceResetter,
	GlobalStiffnessTimeStepper, Matrix3, NewtonIntegrator, O, ddem
)


def block_of(material=None):
	return ddem.append(skewed_mesh(), material or elastic())


# --- gravity and damping of NewtonIntegrator

def fall_of(block, count):
	return block.displacements[:, 1], -9.81 * O.dt**2 * count * (count + 1) / 2


@pytest.mark.parametrize(
	"own, newton", (((0, 0, 0), (0, -9.81, 0)), ((0, -9.81, 0), (0, 0, 0)), ((0, -9.81, 0), (0, -9.81, 0)))
)
def test_gravity_acts_once_wherever_it_is_said(own, newton):
	block = block_of()
	start(gravity=own)
	O.engines = O.engines + [NewtonIntegrator(gravity=newton, damping=0)]
	steps(20)
	fallen, expected = fall_of(block, 20)
	assert fallen == pytest.approx(expected, rel=1e-9)


def test_gravity_that_comes_in_a_run_is_felt():
	block = block_of()
	start()
	O.engines = O.engines + [NewtonIntegrator(damping=0)]
	steps(5)
	O.engines[-1].gravity = (0, -9.81, 0)
	steps(10)
	fallen, expected = fall_of(block, 10)
	assert fallen == pytest.approx(expected, rel=1e-9)


def test_two_different_gravities_are_refused():
	block_of()
	start(gravity=(0, -1, 0))
	O.engines = O.engines + [NewtonIntegrator(gravity=(0, -9.81, 0))]
	with pytest.raises(RuntimeError, match="gravity.*differ"):
		O.step()


def test_damping_of_newton_that_triangles_would_not_feel_is_refused():
	block_of()
	engine = start()
	O.engines = O.engines + [NewtonIntegrator(damping=0.4)]
	with pytest.raises(RuntimeError, match="NewtonIntegrator.damping = 0.4 does not act.*DeformableEngine.damping"):
		O.step()
	engine.damping = 0  # said
	O.step()
	O.engines[-1].damping = 0.7
	engine.damping = 0.7
	O.step()


# --- a periodic cell

def test_a_periodic_cell_is_refused():
	block_of()
	start()
	O.periodic = True
	O.cell.setBox(1, 1, 1)
	with pytest.raises(RuntimeError, match="periodic.*O.periodic = False"):
		O.step()


# --- forces that come too late

def test_a_force_after_the_engine_is_refused_and_before_it_acts():
	block = block_of()
	start()
	O.engines = O.engines + [ForceEngine(ids=[block.node_ids[3]], force=(1, 0, 0))]
	with pytest.raises(RuntimeError, match=f"ForceEngine comes after.*body {block.node_ids[3]}.*put it before"):
		O.step()
	O.engines = [O.engines[0], O.engines[2], O.engines[1]]
	steps(1)
	assert block.velocities[3, 0] > 0


# --- time steps

@pytest.mark.parametrize("dt", (0.0, float("nan"), float("inf")))
def test_a_time_step_that_is_none_is_refused(dt):
	block_of()
	start()
	O.dt = dt
	with pytest.raises(RuntimeError, match="O.dt = .* s .*(positive and finite|above the critical)"):
		O.step()


def test_the_step_that_yade_starts_with_is_nobodys_choice():
	block_of()
	O.engines = [ForceResetter(), DeformableTimeStepper(), DeformableEngine()]
	assert O.dt == 1e-8
	O.step()
	assert O.dt == pytest.approx(0.8 * O.engines[2].criticalTimeStep(), rel=1e-9)


def test_steps_that_alternate_are_refused():
	block = block_of()
	engine = start()
	agitate(block, 0.1)
	large, small = 0.5 * engine.criticalTimeStep(), 0.2 * engine.criticalTimeStep()
	with pytest.raises(RuntimeError, match="up and down.*constant"):
		for i in range(40):
			O.dt = large if i % 2 else small
			O.step()
	O.dt = small
	steps(30)
	O.dt = large  # a change now and then is none
	steps(30)
	O.dt = small
	steps(30)


def test_another_engine_that_sets_the_step_is_named():
	block_of()
	engine = start(GlobalStiffnessTimeStepper(timeStepUpdateInterval=1, defaultDt=1e-3))
	O.dt = 2 * engine.criticalTimeStep()
	with pytest.raises(RuntimeError, match="GlobalStiffnessTimeStepper sets O.dt.*DeformableTimeStepper"):
		steps(3)


# --- triangles inside out

def test_a_triangle_inside_out_stops_the_run():
	block = block_of()
	start()
	steps(3)
	at = int(block.mesh.triangles[4, 0])
	centre = block.mesh.nodes[block.mesh.triangles[4]].mean(axis=0)
	body = O.bodies[block.node_ids[at]]
	place = (
		2 * centre
		- np.array([body.state.pos[0], body.state.pos[1]])
		+ 0.2 * (centre - np.array([body.state.pos[0], body.state.pos[1]]))
	)
	body.state.pos = (place[0], place[1], 0)
	O.dt = 0.1 * O.dt  # to be looked at at once
	with pytest.raises(RuntimeError, match=r"triangle body \d+ at .* is inside out in step 3.*area is -"):
		O.step()


# --- velocities

@pytest.mark.parametrize("whom", ("nodes", "cores"))
def test_velocities_of_nodes_alone_are_refused(whom):
	block = block_of()
	start()
	for i in block.node_ids if whom == "nodes" else block.triangle_ids:
		O.bodies[i].state.vel = (1, 0, 0)
	if whom == "nodes":
		with pytest.raises(RuntimeError, match=r"all nodes have a velocity, \(1, 0\) m/s.*block.velocity"):
			O.step()
	else:
		O.step()  # a wave from the cores: odd, but nobody's slip
	O.reset()
	block = block_of()
	start()
	for i in block.node_ids[:3]:
		O.bodies[i].state.vel = (1, 0, 0)
	O.step()  # some nodes are a load


# --- saved scenes

def test_a_scene_of_0_1_0_is_a_clear_error(tmp_path):
	block = block_of()
	engine = start()
	agitate(block, 1)
	steps(3)
	path = tmp_path / "scene.xml"
	O.save(str(path))
	text = path.read_text()
	assert "<savedVersion>4</savedVersion>" in text
	# as 0.1.0 wrote it
	path.write_text(text.replace("<savedVersion>4</savedVersion>", "<savedVersion>2</savedVersion>"))
	O.load(str(path))
	with pytest.raises(RuntimeError, match="version 2 .*0.1.0.*load it with the plugin that saved it"):
		O.step()
	assert engine is not None


def test_a_scene_that_was_saved_without_works_of_edges_goes_on(tmp_path):
	"""Version 3 of the state has two numbers less: the works of edges that wait for the energy book."""
	block = block_of()
	start()
	agitate(block, 1)
	steps(3)
	path = tmp_path / "scene.xml"
	O.save(str(path))
	steps(10)
	expected = block.positions.copy()
	text = path.read_text().replace("<savedVersion>4</savedVersion>", "<savedVersion>3</savedVersion>")
	head, rest = text.split("<savedState>", 1)
	state, tail = rest.split("</savedState>", 1)
	items = re.findall(r"<item>.*?</item>", state, re.DOTALL)
	first = state.index(items[0])
	kept = items[:5] + items[7:]  # nodes, cores, three works; then two of edges
	preface = state[:first].replace(f"<count>{len(items)}</count>", f"<count>{len(kept)}</count>")
	path.write_text(head + "<savedState>" + preface + "\n".join(kept) + "</savedState>" + tail)
	O.reset()
	O.load(str(path))
	steps(10)
	assert np.array_equal(ddem.Block.from_scene().positions, expected)


def test_saved_scenes_carry_names_of_fields(tmp_path):
	O.materials.append(ConcreteDamageMat(label="concrete"))
	block = block_of("concrete")
	start()
	agitate(block, 5)
	steps(3)
	path = tmp_path / "scene.xml"
	O.save(str(path))
	text = path.read_text()
	for name in ("plasticStrain:4", "damageTensor:4", "closure:1", "stiffening:1"):
		assert name in text


# --- reading one body

def test_reading_one_triangle_takes_up_what_was_changed_there_only():
	block = block_of()
	start()
	steps(2)
	body = O.bodies[block.triangle_ids[0]]
	assert abs(body.shape.stress[0][0, 0]) < 1
	for i in body.shape.nodes:
		node = O.bodies[int(i)]
		node.state.pos = (1.001 * node.state.pos[0], node.state.pos[1], 0)
	stretched = body.shape.stress[0][0, 0]
	assert abs(stretched) > 1e6
	assert block.stress[0, 0, 0] == pytest.approx(stretched, rel=1e-12)
	far = O.bodies[[i for i in block.node_ids if i not in tuple(body.shape.nodes)][-1]]
	far.state.pos = (float("nan"), 0, 0)
	# nobody else is looked at, so it costs the same in a sample of any size
	assert body.shape.stress[0][0, 0] == stretched
	with pytest.raises(ValueError, match=f"body {far.id} .*not finite"):
		block.stress


# --- what changes in a run

def test_a_cell_that_becomes_periodic_in_a_run_is_refused():
	block_of()
	start()
	steps(3)
	O.periodic = True
	O.cell.setBox(1, 1, 1)
	with pytest.raises(RuntimeError, match="periodic"):
		O.step()


@pytest.mark.parametrize("look", (False, True))
def test_another_material_of_a_body_is_taken_up(look):
	results = []
	for soft in (False, True):
		O.reset()
		block = block_of()
		soft_one = elastic("soft", bulk=3e9, shear=2.6e9)
		start()
		agitate(block, 1)
		O.run(20, True)
		if soft:
			for i in block.triangle_ids:
				O.bodies[i].material = soft_one
			if look:
				stress, before = O.bodies[block.triangle_ids[0]].shape.stress[0], results[0][0]
				assert np.allclose(np.array(stress), 0.1 * np.array(before), rtol=1e-9, atol=1)
		else:
			results.append((O.bodies[block.triangle_ids[0]].shape.stress[0], None))
		O.run(50, True)
		results.append(block.positions.copy())
	assert not np.array_equal(results[1], results[2])
	# a run in which the material was there from the same moment on, by changing its parameters
	O.reset()
	material = elastic()
	block = block_of(material)
	start()
	agitate(block, 1)
	O.run(20, True)
	material.bulk, material.shear = 3e9, 2.6e9
	O.run(50, True)
	assert np.abs(block.positions - results[2]).max() < 1e-12


def test_flow_that_waits_is_refused_where_it_would_be_wrong():
	O.materials.append(ConcreteDamageMat(label="concrete"))
	block_of("concrete")
	with pytest.raises(ValueError, match="flowInterval = 3 with an equation of state.*equationOfState = False"):
		start(flowInterval=3)


def test_flow_that_waits_keeps_the_energy_book():
	"""Beside triangles that are damaged and flow in every step, in the same batches."""
	O.materials.append(ConcreteDamageMat(label="plain", equationOfState=False))
	block = block_of("plain")
	for i in block.triangle_ids[::3]:
		O.bodies[int(i)].shape.initialDamage = 0.3 * Matrix3.Identity
	start(flowInterval=3)
	agitate(block, 1)
	O.trackEnergy = True
	steps(1)
	total = O.energy.total()
	steps(60)
	dissipated = O.energy["plasticFlow"] + O.energy["damage"]
	assert dissipated > 1e-4 * total
	assert O.energy.total() == pytest.approx(total, rel=2e-6)  # as without waiting: 8e-7, in either case
