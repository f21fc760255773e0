# GPL v2 or later, see LICENSE.
"""Samples of bonded spheres as users of YADE make and change them."""
import math

import numpy as np
import pytest

from yade import BondedMat, O, pack
from yade.ddem import bonded, packing, vtk
from yade.ddem.studies.snapshots import SphereMotion, SphereSnapshot


def specimen():
	"""A sample between platens, with its engines."""
	O.materials.append(BondedMat(label="rock"))
	sample = bonded.append(packing.prism(0.01, 0.02, 0.01, rmin=1e-3, rmax=2e-3, seed=1, fails=200), "rock")
	platens = bonded.platens(sample, velocity=2.0, ramp=10e-6)
	O.engines = bonded.engines(platens, viscosity=2)
	O.dt = bonded.time_step(0.5)
	return sample, platens


def test_a_sphere_is_erased_and_all_goes_on(tmp_path):
	"""Excavation: counts, arrays and ParaView files are those of the spheres that are left."""
	sample, platens = specimen()
	O.run(50, True)
	before, gone = len(sample), int(sample.ids[10])
	held = len(sample.bonds)
	of_it = int((sample.bonds == gone).any(axis=1).sum())
	others = np.delete(np.arange(before), 10)
	positions, damage = sample.positions[others], sample.damage[others]
	O.bodies.erase(gone)
	assert len(sample) == before - 1 and gone not in sample.ids
	assert (sample.positions == positions).all() and sample.damage == pytest.approx(damage)
	O.run(10, True)
	assert len(sample.bonds) == held - of_it and not (sample.bonds == gone).any()
	for name in ("positions", "velocities", "displacements", "rotations", "radii", "damage"):
		assert len(getattr(sample, name)) == before - 1
	assert sample.rows([gone, sample.ids[0]]).tolist() == [-1, 0]
	vtk.Recorder(sample, str(tmp_path / "erased"))()
	assert SphereSnapshot.of(sample, O.time).centres.shape == (before - 1, 3)
	assert sample.degrees_of_freedom == 6 * (before - 1)


def test_bond_records_are_the_bonds_that_hold_and_the_broken_ones():
	"""Column by column what the other arrays say, in another sample's presence too."""
	sample, _ = specimen()
	other = bonded.append(packing.Packing([[0.1, 0, 0], [0.102, 0, 0]], [0.001, 0.001]), "rock")
	O.run(900, True)
	records, held, broken = sample.bond_records, len(sample.bonds), sample.broken
	assert len(broken) > 20 and len(records) == held + len(broken) == sample.initial_bonds
	now, lost = records[:held], records[held:]
	assert (now["mode"] == bonded.HOLDS).all() and np.isnan(now["time"]).all()
	assert (np.column_stack([now["id1"], now["id2"]]) == sample.bonds).all()
	assert (np.column_stack([now["normal_stress"], now["shear_stress"]]) == sample.bond_stresses).all()
	assert (np.column_stack([now["axial_force"], now["shear_force"]]) == sample.bond_forces).all()
	assert (now["radius"] == sample.bond_radii).all()
	for name in ("id1", "id2", "time", "radius", "normal_stress", "shear_stress"):
		assert (lost[name] == broken[name]).all()
	assert ((lost["mode"] == bonded.TENSION) == (broken["mode"] == "tension")).all()
	assert (lost["mode"] != bonded.HOLDS).all() and np.isnan(lost["axial_force"]).all()
	assert len(other.bond_records) == 1 and not sample.bond_records.flags.writeable


def test_what_is_kept_of_an_instant_gives_its_snapshot_at_any_later_time():
	"""Which bonds had broken by then, the records of broken bonds say."""
	sample, _ = specimen()
	kept, whole = [], []
	for _ in range(3):
		O.run(300, True)
		kept.append(SphereMotion.of(sample, O.time))
		whole.append(SphereSnapshot.of(sample, O.time))
	assert 0 < len(whole[1].cracks) < len(whole[2].cracks)
	for one, then in zip(kept, whole):
		made = one.snapshot(sample.bond_records)
		for name in ("time", "centres", "radii", "damage", "rotation", "cracks", "tension"):
			assert np.array_equal(getattr(made, name), getattr(then, name)), name
	assert (whole[-1].damage == sample.damage).all()


def test_a_specimen_in_pieces_is_told():
	"""Spheres of nearly one size hardly touch."""
	rock = BondedMat(label="rock")
	O.materials.append(rock)
	loose = packing.prism(0.02, 0.02, 0.02, rmin=1.9e-3, rmax=2e-3, seed=1, fails=200)
	with pytest.warns(
		UserWarning, match=r"are in \d+ pieces: \d+ in the largest, \d+ loose; a larger gap="
	):
		bonded.append(loose, rock)


def test_a_sphere_pack_is_appended():
	O.materials.append(BondedMat(label="rock"))
	spheres = pack.SpherePack([((0, 0, 0), 0.01), ((0.02, 0, 0), 0.01)])
	O.engines = bonded.engines()
	assert bonded.append(spheres, "rock").bonds.tolist() == [[0, 1]]


def test_platens_load_the_face_of_the_shape_that_was_filled():
	O.materials.append(BondedMat(label="rock"))
	cylinder = packing.Cylinder((0, 0, 0), (0, 0.02, 0), 0.005)
	sample = bonded.append(packing.fill(cylinder, 1e-3, 2e-3, fails=200), "rock")
	assert bonded.platens(sample, velocity=0.2).area == pytest.approx(math.pi * 0.005**2)
	ball = bonded.append(packing.fill(packing.Ball((0, 0, 0), 0.006), 1e-3, 2e-3, fails=200), "rock")
	bodies = len(O.bodies)
	with pytest.raises(ValueError, match="the ball of radius 0.006 m has no flat face"):
		bonded.platens(ball, velocity=0.2)
	assert len(O.bodies) == bodies
	assert bonded.platens(ball, velocity=0.2, area=1e-4).area == 1e-4


def test_the_area_of_a_cylinder_is_its_own():
	"""Stress of UCS is force over pi/4 D² (ISRM), not over the square around it."""
	width = 0.01
	box = packing.prism(width, 0.02, width, 0.5e-3, 1e-3, seed=1, fails=300)
	inside = np.hypot(box.centres[:, 0] - width / 2, box.centres[:, 2]) + box.radii < width / 2 + 1e-6
	O.materials.append(BondedMat(label="rock"))
	column = packing.Packing(box.centres[inside], box.radii[inside], box.lower, box.upper)
	sample = bonded.append(column, "rock", gap=1e-5)
	platens = bonded.platens(sample, velocity=0.2, area=math.pi / 4 * width**2)
	O.engines = bonded.engines(platens)
	O.dt = bonded.time_step(0.8)
	O.run(100, True)
	force = 0.5 * (platens.force_top + platens.force_bottom)
	assert platens.stress == pytest.approx(force / (math.pi / 4 * width**2)) and force > 0
	with pytest.raises(ValueError, match="area = 1 m² must be positive, and not above"):
		bonded.platens(sample, velocity=0.2, area=1)


def test_platens_that_meet_stop():
	"""100 m/s: without a stop the walls pass each other with a stress of a million MPa."""
	sample, _ = specimen()
	platens = bonded.platens(sample, velocity=100)
	O.engines = bonded.engines(platens)
	O.dt = bonded.time_step(0.8)
	with pytest.raises(
		RuntimeError, match=r"sphere #\d+ is .* m behind the wall #\d+ .*: the platens have met"
	):
		O.run(int(2.5e-4 / O.dt), True)
	assert platens.strain < 1.1


def test_a_loaded_scene_has_its_sample_and_platens_again(tmp_path):
	sample, platens = specimen()
	O.run(60, True)
	O.save(str(tmp_path / "middle.yade.gz"))
	O.run(40, True)
	expected = platens.stress, platens.strain
	assert expected[0] > 0
	O.reset()
	O.load(str(tmp_path / "middle.yade.gz"))
	again = bonded.BondedSample.from_scene()
	with pytest.raises(
		RuntimeError, match="the scene has 1 Walls of ElasticWallMat across y, where platens are two"
	):
		wall = O.bodies[platens.top]
		wall.shape.axis = 0
		bonded.Platens.from_scene(again)
	wall.shape.axis = 1
	loaded = bonded.Platens.from_scene(again)
	O.run(40, True)
	assert loaded.strain == pytest.approx(expected[1], rel=1e-9)
	assert loaded.stress == pytest.approx(expected[0], rel=1e-3)  # the box of the spheres is that of the packing
	assert bonded.Platens.from_scene(again, area=platens.area).stress == pytest.approx(expected[0], rel=1e-6)
	assert len(loaded.engines) == 2 and again.initial_bonds == sample.initial_bonds


def loaded(tmp_path):
	"""What another process finds."""
	O.engines = bonded.engines()
	O.save(str(tmp_path / "sample.yade.gz"))
	O.reset()
	O.load(str(tmp_path / "sample.yade.gz"))


def round_sample():
	O.materials.append(BondedMat(label="rock"))
	cylinder = packing.Cylinder((0, 0, 0), (0, 0.02, 0), 0.005)
	return bonded.append(packing.fill(cylinder, 1e-3, 2e-3, fails=200), "rock"), cylinder


def test_a_loaded_cylinder_is_a_cylinder(tmp_path):
	"""Taken for its box, its stresses would be those of 4/π times its face."""
	sample, cylinder = round_sample()
	bonded.platens(sample, velocity=0.2)
	loaded(tmp_path)
	again = bonded.BondedSample.from_scene()
	assert again.is_cylinder("y") and not again.is_prism and again.is_shaped
	assert again.volume == cylinder.volume and (again.upper == cylinder.upper).all()
	assert bonded.Platens.from_scene(again).area == pytest.approx(math.pi * 0.005**2, rel=1e-15)
	O.bodies.erase(int(again.ids[3]))
	assert bonded.BondedSample.from_scene().is_cylinder("y")


def test_the_box_of_a_loaded_sample_is_that_of_its_packing(tmp_path):
	O.materials.append(BondedMat(label="rock"))
	bonded.append(packing.Packing([[0, 0, 0], [2, 0, 0]], [1, 1], (-2, -1, -1), (3, 1, 1)), "rock")
	loaded(tmp_path)
	again = bonded.BondedSample.from_scene()
	assert again.is_prism and not again.is_shaped
	assert (again.lower.tolist(), again.upper.tolist(), again.volume) == ([-2, -1, -1], [3, 1, 1], 20)


@pytest.mark.parametrize("why", ["an older version", "2 samples"])
def test_a_shape_that_nobody_knows_is_asked_for(tmp_path, why):
	_, cylinder = round_sample()
	if why == "2 samples":
		bonded.append(packing.Packing([[0.1, 0, 0], [0.102, 0, 0]], [0.001, 0.001]), "rock")
	else:
		O.tags["ddem sample"] = "[]"  # as in a scene without the tag
	loaded(tmp_path)
	again = bonded.BondedSample.from_scene()
	bodies = len(O.bodies)
	for use in (
		lambda: again.volume, lambda: again.is_prism, lambda: bonded.platens(again, velocity=1),
		lambda: bonded.direct_shear(again, 1e6, 0.1),
		lambda: bonded.three_point_bending(again, 0.01, 0.1)
	):
		with pytest.raises(ValueError, match=f"shape of this sample is unknown: the scene .*{why}"):
			use()
	assert len(O.bodies) == bodies
	assert bonded.platens(again, velocity=1, area=1e-5).area == 1e-5
	if why != "2 samples":
		told = bonded.BondedSample.from_scene(shape=cylinder)
		assert told.area == pytest.approx(math.pi * 0.005**2) and (told.lower == cylinder.lower).all()
	with pytest.raises(ValueError, match="shape = the ball of radius 1.0 m .* they do not fill it"):
		bonded.BondedSample.from_scene(shape=packing.Ball((0, 0, 0), 1))


def test_a_crushing_scene_goes_on_with_the_same_bits_after_loading(tmp_path):
	"""Contacts that broken bonds leave begin in the order of their breaking; after loading nobody knows that."""
	sample, _ = specimen()
	O.materials["rock"].cohesion = 20e6
	O.run(900, True)
	instants = []
	for k in range(6):
		O.save(str(tmp_path / f"{k}.yade.gz"))
		O.run(60, True)
		instants.append((sample.positions, sample.spins, sample.broken_fraction))
	assert 0.05 < instants[0][2] < instants[-1][2]
	for k, (places, spins, _) in enumerate(instants):
		O.load(str(tmp_path / f"{k}.yade.gz"))
		O.run(60, True)
		again = bonded.BondedSample.from_scene()
		assert (again.positions == places).all() and (again.spins == spins).all(), k


def test_a_sample_that_takes_the_place_of_another_is_the_one_that_the_scene_knows(tmp_path):
	"""As in a loop over packings that clears the bodies but does not reset the scene."""
	round_sample()
	O.bodies.clear()
	bonded.append(packing.prism(0.01, 0.02, 0.01, rmin=1e-3, rmax=2e-3, seed=1, fails=200), "rock")
	loaded(tmp_path)
	assert bonded.BondedSample.from_scene().is_prism
