# GPL v2 or later, see LICENSE.
"""Bonded spheres in periodic cells."""
import itertools

import numpy as np
import pytest

from yade import (
	BondedMat, Matrix3, O, PeriTriaxController, Vector3, Vector3i, pack, utils
)
from yade.ddem import EnergyBalance, bonded, packing, vtk

RADIUS = 1e-3
SIDE = 2 * RADIUS  # of the cubic lattice


def lattice(count=3, **material):
	"""A cubic lattice of touching spheres that fills a periodic cell."""
	O.materials.append(BondedMat(label="rock", young=30e9, poisson=0.2, **material))
	places = SIDE * (np.array(list(itertools.product(range(count), repeat=3))) + 0.5)
	sample = bonded.append(packing.Packing(places, np.full(len(places), RADIUS), cell=[count * SIDE] * 3), "rock")
	O.engines = bonded.engines()
	O.dt = bonded.time_step(0.1)
	return sample


def strained(gradient, steps=20):
	"""Stress over strain rate times time (3, 3) [Pa] of a lattice that is strained at a constant rate."""
	sample = lattice(5)  # bounds must be less than half of the cell
	O.cell.velGrad = Matrix3(*(float(rate) for rate in np.ravel(gradient)))
	O.run(steps, True)
	O.step()
	stress = np.array(utils.getStress()).reshape(3, 3)
	assert len(sample.broken) == 0
	return stress / (steps * O.dt), sample


def spring(name):
	return getattr(next(iter(O.interactions)).phys, name)


def test_bonds_cross_the_border():
	"""Each sphere of the lattice has six bonds, as in an infinite one;
	a third of the pairs at the border cross it."""
	sample = lattice(3)
	assert len(sample.bonds) == 3 * len(sample) == 81
	across = [i for i in O.interactions if i.cellDist != Vector3i(0, 0, 0)]
	assert len(across) == 3 * 9
	assert O.periodic and O.cell.size == Vector3(3, 3, 3) * SIDE
	for i in O.interactions:
		assert i.geom.penetrationDepth == pytest.approx(0, abs=1e-12) and i.phys.bondLength == pytest.approx(
			SIDE
		)


def test_stretching_a_cell_gives_the_modulus_of_the_lattice():
	"""E = k_n/d along an axis, and no stress across: bonds of a cubic lattice do not know each other."""
	modulus, _ = strained([[1, 0, 0], [0, 0, 0], [0, 0, 0]])
	assert modulus[0, 0] == pytest.approx(spring("kn") / SIDE, rel=1e-4)
	modulus[0, 0] = 0
	assert abs(modulus).max() < 1e-6 * spring("kn") / SIDE


@pytest.mark.parametrize("gradient", [[[0, 1, 0], [0, 0, 0], [0, 0, 0]], [[0, 0.5, 0], [0.5, 0, 0], [0, 0, 0]]])
def test_shearing_a_cell_gives_the_modulus_of_the_lattice(gradient):
	"""G = k_s/2d, both in pure shear and in simple shear, which turns the spheres by half of it."""
	modulus, sample = strained(gradient)
	assert modulus[0, 1] == pytest.approx(spring("ks") / (2 * SIDE), rel=1e-4)
	assert modulus[1, 0] == pytest.approx(modulus[0, 1], rel=1e-6)
	half_turn = (gradient[1][0] - gradient[0][1]) / 2
	assert sample.spins[:, 2] == pytest.approx(half_turn, abs=1e-6)


def test_turning_a_cell_is_no_strain():
	modulus, _ = strained([[0, 1, 0], [-1, 0, 0], [0, 0, 0]])
	assert abs(modulus).max() < 1e-6 * spring("kn") / SIDE


def specimen():
	"""A random periodic packing, bonded."""
	O.materials.append(BondedMat(label="rock", density=2600))
	spheres = pack.randomPeriPack(radius=1e-3, initSize=Vector3(1, 1, 1) * 14e-3, rRelFuzz=0.4, seed=1)
	return bonded.append(spheres, "rock", gap=0.1e-3)


def test_a_controller_brings_a_random_specimen_to_a_stress_and_crushes_it():
	"""PeriTriaxController: equal pressure first, then it strains along y while the sides keep their pressure.
	What it says of the stress is the mean over the cell of all bonds and contacts, and its work goes into the
	book's terms: within two parts in a thousand, as the controller takes stress and rate of two different times."""
	sample = specimen()
	pressure = 5e6
	loading = PeriTriaxController(
		dynCell=True, mass=1e-3, stressMask=0b111, goal=Vector3(-1, -1, -1) * pressure,
		maxStrainRate=(50, 50, 50)
	)
	book = EnergyBalance()
	O.engines = bonded.engines()
	O.engines = O.engines[:-1] + [loading, O.engines[-1]]
	O.engines[-1].damping = 0.4
	O.dt = bonded.time_step(0.5)
	O.run(600, True)
	assert np.array(loading.stress) == pytest.approx(-pressure, rel=1e-2)
	assert np.diag(np.reshape(utils.getStress(), (3, 3))) == pytest.approx(-pressure, rel=1e-2)
	mean = bonded.mean_stress(sample, (0, 0, 0), O.cell.size)  # nothing but bonds touches yet
	assert mean == pytest.approx(np.reshape(utils.getStress(), (3, 3)), rel=1e-6, abs=1e-6 * pressure)
	assert np.diag(bonded.mean_stress(sample, (0, 2e-3, 0), (5e-3, 9e-3, 12e-3))) == pytest.approx(
		[-pressure] * 3, rel=0.3
	)
	assert len(sample.broken) == 0

	loading.stressMask, loading.goal = 0b101, (-pressure, -0.02, -pressure)
	across, along = [], []
	while loading.strain[1] > -1e-3:
		O.run(20, True)
		along.append(-loading.stress[1])
		across.append(-loading.stress[0])
	assert 0 < book.error < 2e-3  # 0 where a book has nothing from outside
	O.run(2000, True)
	assert 0 < book.error < 5e-3
	assert max(along) > 10 * pressure and np.mean(across) == pytest.approx(pressure, rel=0.05)
	assert 0.2 < sample.broken_fraction < 1
	# those that broke across the border: their spheres lie on two sides of the cell, and are there where they broke
	far = [
		record for record in sample.broken
		if np.linalg.norm(
			np.subtract(
				O.bodies[int(record["id1"])].state.refPos, O.bodies[int(record["id2"])].state.refPos
			)
		) > 5e-3
	]
	assert len(far) > 10 and all(record["energy"] > 0 for record in far)
	for record in far:
		first = np.array(O.bodies[int(record["id1"])].state.pos)
		assert np.linalg.norm(record["position"] - first) < 2e-3
	inside = np.ptp(sample.positions, axis=0) < 1.2 * np.array(O.cell.size)
	assert inside.all()


def test_a_refused_packing_leaves_the_cell_as_it_was():
	"""Also the sides that O.cell has where it is not in use."""
	O.periodic = True
	O.cell.hSize = Matrix3(3, 0.5, 0, 0, 4, 0, 0, 0, 5)
	O.periodic = False
	O.materials.append(BondedMat(label="rock"))
	narrow = packing.Packing([[1, 1, 1], [3, 1, 1]], [1, 1], cell=(4, 2, 2))
	with pytest.raises(ValueError):
		bonded.append(narrow, "rock", scatter=lambda count: [-1.0] * count)
	assert not O.periodic and len([b for b in O.bodies if b]) == 0
	O.periodic = True
	assert np.array(O.cell.hSize).ravel().tolist() == [3, 0.5, 0, 0, 4, 0, 0, 0, 5]
	assert np.array(O.cell.refHSize).ravel().tolist() == [3, 0.5, 0, 0, 4, 0, 0, 0, 5]


@pytest.mark.parametrize("told", ["by the packing", "by the scene"])
def test_the_volume_of_a_sheared_cell_is_that_of_its_sides(told):
	"""That of the box around it is larger: shear keeps the volume."""
	sides = np.array([[6.0, 3.0, 0.0], [0.0, 6.0, 0.0], [0.0, 0.0, 6.0]]) * RADIUS
	places = SIDE * (np.array(list(itertools.product(range(3), repeat=3))) + 0.5)
	spheres = packing.Packing(places, np.full(27, RADIUS), cell=sides if told == "by the packing" else None)
	O.materials.append(BondedMat(label="rock"))
	if told == "by the scene":
		O.periodic = True
		O.cell.hSize = Matrix3(*sides.ravel())
	sample = bonded.append(spheres, "rock")
	O.engines = bonded.engines()
	again = bonded.BondedSample.from_scene()
	for one in (sample, again):
		assert one.volume == pytest.approx(216 * RADIUS**3)
		assert one.lower == pytest.approx([0, 0, 0]) and one.upper == pytest.approx(
			[9 * RADIUS, 6 * RADIUS, 6 * RADIUS]
		)


def test_a_saved_cell_goes_on(tmp_path):
	"""Bonds keep the period that they cross; sums may differ in the last digits."""
	sample = lattice(5)
	O.cell.velGrad = Matrix3(1e3, 200, 0, 0, 0, 0, 0, 0, 0)
	O.run(10, True)
	O.save(str(tmp_path / "cell.yade.gz"))
	O.run(50, True)
	stress, places = np.array(utils.getStress()), sample.positions
	O.load(str(tmp_path / "cell.yade.gz"))
	again = bonded.BondedSample.from_scene()
	assert again.lower == pytest.approx(sample.lower) and again.upper == pytest.approx(sample.upper)
	assert again.initial_bonds == sample.initial_bonds
	O.run(50, True)
	assert again.positions == pytest.approx(places, rel=1e-12)
	assert np.array(utils.getStress()) == pytest.approx(stress, rel=1e-9, abs=1e-9 * abs(stress).max())


def test_paraview_draws_bonds_to_the_nearest_image(tmp_path):
	"""Read back with VTK: every bond of the lattice is as long as the lattice's step, none crosses the cell."""
	from vtkmodules.util.numpy_support import vtk_to_numpy
	from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
	sample = lattice(5)
	vtk.Recorder(sample, str(tmp_path / "cell"))()
	reader = vtkXMLUnstructuredGridReader()
	reader.SetFileName(str(tmp_path / "cell-bonds-0000.vtu"))
	reader.Update()
	drawn = reader.GetOutput()
	points = vtk_to_numpy(drawn.GetPoints().GetData())
	ends = vtk_to_numpy(drawn.GetCells().GetConnectivityArray()).reshape(-1, 2)
	assert len(ends) == len(sample.bonds) == 3 * 125 and len(points) == 125 + 3 * 25
	assert np.linalg.norm(points[ends[:, 1]] - points[ends[:, 0]], axis=1) == pytest.approx(SIDE)


def test_neighbours_in_a_sheared_cell_are_those_of_all_images():
	"""Against the distance to 125 images of each sphere; positions need not lie in the cell."""
	rng = np.random.default_rng(1)
	cell = np.array([[1.0, 0.4, 0.1], [0, 0.9, -0.3], [0, 0, 1.1]])
	centres, radii = (rng.uniform(-1, 2, (60, 3)) @ cell.T), rng.uniform(0.05, 0.15, 60)
	shifts = np.array(list(itertools.product(range(-6, 7), repeat=3))) @ cell.T
	expected = []
	for i, j in itertools.combinations(range(60), 2):
		distance = np.linalg.norm(centres[j] - centres[i] + shifts, axis=1).min()
		if distance < radii[i] + radii[j] + 0.02:
			expected.append((i, j))
	assert packing.Packing(centres, radii, cell=cell).neighbours(0.02).tolist() == [list(pair) for pair in expected]


@pytest.mark.parametrize(
	"cell, words", [
		([1, 1], "three positive sizes"), ([1, 0, 1], "span a volume"),
		([[1, 1, 0], [1, 1, 0], [0, 0, 1]], "span"),
		([1, float("inf"), 1], "span")
	]
)
def test_bad_cells_are_refused(cell, words):
	with pytest.raises(ValueError, match=words):
		packing.Packing([[0, 0, 0]], [1], cell=cell)


def test_a_cell_that_is_not_the_scenes_is_refused():
	O.materials.append(BondedMat(label="rock"))
	O.periodic = True
	O.cell.setBox(1, 1, 1)
	with pytest.raises(ValueError, match="O.cell.hSize is .*O.periodic = False"):
		bonded.append(packing.Packing([[0, 0, 0], [0.02, 0, 0]], [0.01, 0.01], cell=[2, 1, 1]), "rock")
	assert len(O.bodies) == 0


def test_a_narrow_cell_is_refused_with_its_width():
	"""In a cell of less than two bonds, a bond could go to either of two images."""
	O.materials.append(BondedMat(label="rock"))
	with pytest.raises(ValueError, match=r"0\.02 m apart.*periodic cell's 0\.03 m"):
		bonded.append(packing.Packing([[0, 0, 0], [0.02, 0, 0]], [0.01, 0.01], cell=[1, 0.03, 1]), "rock")
	assert not O.periodic and not any(O.bodies)


def test_platens_are_refused_in_a_cell():
	sample = lattice(3)
	for loads in (
		lambda: bonded.platens(sample, 1.0), lambda: bonded.confine(sample, 1e6),
		lambda: bonded.jacket(sample, 1e6),
		lambda: bonded.three_point_bending(sample, 4e-3, 0.1), lambda: bonded.brazilian(sample, 0.1),
		lambda: bonded.direct_shear(sample, 1e6, 0.1)
	):
		with pytest.raises(ValueError, match="periodic cell.*PeriTriaxController"):
			loads()
