# GPL v2 or later, see LICENSE.
"""The compression test: what it records, when it stops, and what of it reaches the report."""
import numpy as np
import pytest

from yade import BondedMat, ConcreteDamageMat, DeformableElastMat, DeformableEngine, ForceResetter, O, ddem
from yade.ddem import bonded, packing
from yade.ddem.studies import uniaxial
from yade.ddem.studies.runs import ENERGY_PARTS, EXTERNAL

VELOCITY, RAMP = 2.0, 2e-5


def deformable(material="concrete"):
	"""A small block of concrete between platens."""
	O.materials.append(ConcreteDamageMat(label="concrete"))
	O.materials.append(DeformableElastMat(label="steel", bulk=151e9, shear=81e9, density=8030))
	block = ddem.append(ddem.mesh.rectangle(0.04, 0.08, size=0.01), material, seed=1, thickness=0.02)
	platens = ddem.platens(block, VELOCITY, ramp=RAMP, both=True)
	O.engines = [ForceResetter(), *platens.engines, DeformableEngine(label="triangles")]
	O.dt = ddem.time_step(0.8)
	return platens


def rigid():
	"""A small prism of bonded spheres between platens."""
	O.materials.append(BondedMat(label="rock", young=60e9, cohesion=50e6, density=4000))
	sample = bonded.append(packing.prism(0.04, 0.08, 0.04, 0.004, 0.008, seed=1), "rock")
	platens = bonded.platens(sample, VELOCITY, ramp=RAMP)
	O.engines = bonded.engines(platens)
	O.dt = bonded.time_step(0.8)
	return platens


@pytest.mark.parametrize("make, model", [(deformable, "deformable"), (rigid, "rigid")])
def test_record_of_a_test(make, model):
	platens = make()
	engines = len(O.engines)
	called = []
	test = uniaxial.CompressionTest(
		platens, duration=2.5e-4, stop=0, recorders=[lambda: called.append(O.time)], critical_dt=O.dt / 0.8
	)
	run = test.run(progress=False)

	assert (run.model, run.dt, run.steps) == (model, O.dt, O.iter)
	assert run.steps == round(2.5e-4 / O.dt)
	assert run.stopped == "largest strain reached"
	assert uniaxial.running is None
	# platens that ramp up and then move on: v (t - t_r/2) each, and the step that is not seen yet
	series = run.series
	late = series["time"] > 1.5 * RAMP
	expected = 2 * VELOCITY * (series["time"][late] - RAMP / 2) / 0.08
	np.testing.assert_allclose(series["strain"][late], expected, atol=2 * 2 * VELOCITY * O.dt / 0.08)
	# stress is the mean of both ends over the face
	np.testing.assert_allclose(
		series["stress"],
		(series["force_top"] + series["force_bottom"]) / (2 * platens.area),
		rtol=1e-12,
		atol=1e-6,
	)
	assert 20e6 < run.strength.ucs < 400e6
	assert 0 < series["damage"][-1] <= 1 and (np.diff(series["damage"]) >= -1e-12).all()
	# the parts of the energy book are all known, and it closes
	entries = {
		name[len("energy_") :]
		for name in series.units
		if name.startswith("energy_") and np.abs(series[name]).max() > 0
	} - {"drift"}
	assert entries <= {name for names in ENERGY_PARTS.values() for name in names} | set(EXTERNAL)
	assert run.energy("input")[-1] > 0
	stored = sum(part for part in map(run.energy, ENERGY_PARTS) if part is not None)
	np.testing.assert_allclose(stored[len(stored) // 2:], run.energy("input")[len(stored) // 2:], rtol=0.02)
	assert run.energy_error < 0.02
	# pictures in memory at every instant of the recorders, the start and the end among them, and none twice
	times = [snapshot.time for snapshot in run.snapshots]
	assert set(called) <= set(times) and sorted(set(called)) == called and sorted(set(times)) == times
	assert called[0] == 0 and called[-1] == O.time and len(times) > len(called) > 10
	# every engine was timed
	assert len(run.engines) == engines + 1 and run.engines[-1][0] == "recorder"
	timed = [seconds for _, seconds, _ in run.engines]
	assert timed == pytest.approx([1e-9 * e.execTime for e in O.engines])
	assert min(timed) > 0 and sum(timed) <= run.wall
	figures = run.summary()
	assert figures["dt_over_critical"] == pytest.approx(0.8)
	assert figures["degrees_of_freedom"] == platens.sample.degrees_of_freedom


@pytest.mark.parametrize("make", [deformable, rigid])
def test_stops_when_the_sample_has_failed(make):
	test = uniaxial.CompressionTest(make(), duration=1e-2, stop=0.5)
	run = test.run(progress=False)
	assert run.stopped == "stress stayed below 50 % of the peak"
	assert run.series.last("stress") < 0.5 * run.strength.ucs
	assert run.series.last("time") < 5e-3
	assert run.strength.peaked


def test_damage_counts_concrete_only():
	mesh = ddem.mesh.rectangle(0.04, 0.08, size=0.01, regions={"steel": ddem.mesh.box(0.0, 0.0, 0.04, 0.02)})
	O.materials.append(ConcreteDamageMat(label="concrete"))
	O.materials.append(DeformableElastMat(label="steel", bulk=151e9, shear=81e9, density=8030))
	block = ddem.append(mesh, {"": "concrete", "steel": "steel"})
	O.engines = [ForceResetter(), DeformableEngine()]
	for i in block.triangle_ids[block.mesh.regions == 0]:
		O.bodies[int(i)].shape.initialDamage = np.diag([3.0, 0, 0]).tolist()
	specimen = uniaxial.Specimen(block)
	specimen.prepare()
	# η/η_max = Ω²/(1 + Ω²), Zubelewicz (2018), section 3, with n_f = 2;
	# the residual of 1e-6 keeps it from reaching 1
	assert specimen.damage == pytest.approx(0.9, rel=2e-6)


def test_a_block_that_cannot_break_has_no_damage():
	run = uniaxial.CompressionTest(deformable("steel"), duration=1e-5).run(progress=False)
	assert (run.series["damage"] == 0).all() and not run.strength.peaked


@pytest.mark.parametrize(
	"options, message",
	[
		({"duration": 0}, "duration"),
		({"duration": 1e-4, "stop": 1}, "stop"),
		({"duration": 1e-4, "stop": -0.1}, "stop"),
	],
)
def test_bad_settings(options, message):
	with pytest.raises(ValueError, match=message):
		uniaxial.CompressionTest(deformable(), **options)


def test_missing_time_step():
	platens = deformable()
	O.dt = 0
	with pytest.raises(ValueError, match="O.dt"):
		uniaxial.CompressionTest(platens, duration=1e-4).run(progress=False)
