# GPL v2 or later, see LICENSE.
"""What is said of a run before it is run: counts exactly, times by measurement."""
import pytest

from deformable_samples import elastic, skewed_mesh, start
from yade import BondedMat, ConcreteDamageMat, DeformableTimeStepper, O, PyRunner, ddem


def test_triangles_before_a_run():
	O.materials.append(ConcreteDamageMat(label="concrete", rateDependence=False))
	block = ddem.append(ddem.mesh.rectangle(0.02, 0.04, size=0.004), "concrete", seed=1)
	platens = ddem.platens(block, velocity=1)
	engine = start(DeformableTimeStepper(), *platens.engines)
	O.engines = O.engines + [PyRunner(command="nothing_that_there_is()", iterPeriod=1, label="mine")]
	positions = block.positions.copy()
	found = ddem.estimate(until=100.5 * O.dt, bench=0.3)
	assert (found.steps, found.particles, found.kind) == (101, len(block.triangle_ids), "triangle")
	assert found.dt == O.dt and found.critical == engine.criticalTimeStep()
	assert found.ruling == engine.rulingTriangle()[0] and found.left_out == ("mine", )
	low, high = found.seconds
	assert 0 < low <= high and found.memory_MB > 1
	assert set(found.effects) == {
		f"{name} of concrete" for name in ("viscoplasticFlow", "damage", "equationOfState")
	}
	assert all(0 <= share < 1 for share in found.effects.values())
	said = str(found)
	assert said.startswith(f"101 steps of {len(block.triangle_ids)} triangles: ") and "without mine" in said
	assert f"triangle {found.ruling} at (" in said and "0.80 of the critical one" in said
	assert O.iter == 0 and (block.positions == positions).all()  # the scene itself has not moved


def test_spheres_before_a_run():
	O.materials.append(BondedMat(label="bonds", young=50e9, cohesion=80e6))
	packing = ddem.packing.prism(0.01, 0.02, 0.01, 1e-3, 2e-3, seed=1)
	sample = ddem.bonded.append(packing, "bonds")
	O.engines = ddem.bonded.engines(ddem.bonded.platens(sample, 0.1, 1e-4))
	O.dt = ddem.bonded.time_step(0.8)
	found = ddem.estimate(steps=50, bench=0.2)
	assert (found.steps, found.particles, found.kind) == (50, len(sample), "sphere")
	assert found.ruling is None and found.dt / found.critical == pytest.approx(0.8) and found.seconds[0] > 0


@pytest.mark.parametrize("wrong", ({}, {"until": 1.0, "steps": 3}, {"until": -1.0}))
def test_wrong_questions_are_refused(wrong):
	ddem.append(skewed_mesh(), elastic())
	start()
	with pytest.raises(ValueError, match="until"):
		ddem.estimate(**wrong)
	O.dt = 0
	with pytest.raises(ValueError, match="O.dt = 0"):
		ddem.estimate(steps=3)
