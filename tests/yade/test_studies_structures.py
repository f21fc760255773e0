# GPL v2 or later, see LICENSE.
"""Structures of the report and beyond: their loads, what they measure, and their scripts. What happens to them is
checked by the verification cases."""
import numpy as np
import origins
import pytest
import script_modules
from test_vtk import collection, read
from vtkmodules.vtkCommonDataModel import VTK_TRIANGLE

from yade import ConcreteDamageMat, O, ddem
from yade.ddem.series import Series
from yade.ddem.studies.snapshots import TriangleSnapshot
from yade.ddem.studies.structures import beam, confined, impulse, reinforced, spall

# --- loads


@pytest.mark.parametrize("patch", [0.4, 0.1, 0.0333])
def test_impulse_on_nodes_has_the_force_and_the_place_of_its_pressure(patch):
	push = impulse.Impulse(patch=patch)
	mesh = ddem.mesh.rectangle(impulse.WIDTH, impulse.HEIGHT, 0.01)
	nodes, shares = push.shares(mesh)
	assert shares.sum() == pytest.approx(patch)
	assert shares @ mesh.nodes[nodes, 1] == pytest.approx(patch * impulse.HEIGHT / 2)  # in the middle of the side
	assert (mesh.nodes[nodes, 0] == 0).all()


@pytest.mark.parametrize(
	"shape, mean", [("sine-squared", 1 / 2), ("half-sine", 2 / np.pi), ("triangle", 1 / 2), ("trapezoid", 0.9)]
)
def test_impulse_brings_in_its_momentum(shape, mean):
	push = impulse.Impulse(shape, pressure=3e6, duration=20e-6)
	assert push.momentum == pytest.approx(mean * 3e6 * 20e-6 * impulse.HEIGHT, rel=1e-4)  # integrals of the shapes
	assert push.at(1.01 * push.duration) == 0


@pytest.mark.parametrize("until", [1.9e-5, 2e-5, 2.013e-5])
def test_every_instant_up_to_the_end_has_its_field(until):
	history = impulse.run(size=0.02, until=until, instants=(1e-5, until))
	assert np.abs(history.instants - (1e-5, until)).max() <= 1.001 * history.dt and len(history.fields) == 2


@pytest.mark.parametrize("waves", [1, 2, 5])
def test_regions_of_one_sign_are_counted(waves):
	mesh = ddem.mesh.rectangle(impulse.WIDTH, impulse.HEIGHT, 0.01)
	values = np.sin(np.pi * waves * mesh.nodes[:, 1] / impulse.HEIGHT)
	assert impulse.regions(mesh, values) == waves
	# what is below a tenth does not count
	assert impulse.regions(mesh, values + 0.05 * np.sin(999 * mesh.nodes[:, 0])) == waves


def test_sides_are_pressed_evenly():
	O.materials.append(ConcreteDamageMat(label="concrete"))
	block = ddem.append(ddem.mesh.rectangle(confined.WIDTH, confined.HEIGHT, 0.02), "concrete", thickness=0.5)
	total = {1: 0.0, -1: 0.0}
	for engine in confined._pressing(block, 7e6):
		total[int(engine.direction[0])] += engine.magnitudes[-1] * len(engine.ids)
		assert engine.magnitudes[0] == 0
	assert total == {1: pytest.approx(7e6 * confined.HEIGHT * 0.5), -1: pytest.approx(7e6 * confined.HEIGHT * 0.5)}


# --- measures


def test_pullback_ends_at_the_first_minimum():
	surface = np.array([0, 4, 10, 8, 5, 6, 7, 3, 1.0])
	zeros = np.zeros((9, 2))
	history = spall.History(1, np.arange(9.0), np.arange(2.0), zeros, zeros, surface, zeros, 0)
	assert history.pullback == ((10, 5), (2, 4))
	# ½ ρ c Δu with c = √((B + 4μ/3)/ρ) of Table 1
	assert history.spall_stress == pytest.approx(0.5 * 2400 * 5190.8 * 5, rel=1e-4)


def test_ringing_behind_the_front_is_no_pullback():
	surface = np.array([0, 10, 9.5, 9.8, 6, 6.2, 3])
	zeros = np.zeros((7, 2))
	assert spall.History(1, np.arange(7.0), np.arange(2.0), zeros, zeros, surface, zeros, 0).pullback == (
		(10, 6),
		(1, 4),
	)


def test_largest_tension_is_that_of_pulses_laid_over_each_other():
	duration, speed = 30e-6, 3.0
	times = np.linspace(0, 2 * duration, 4001)
	pulse = lambda t: speed * np.sin(np.pi * t / duration)**2 * ((t > 0) & (t < duration))
	for depth in (0.005, 0.02, 0.05, 0.2):
		late = depth / spall.WAVE  # the free end gets the pulse at t = 0
		expected = spall.IMPEDANCE * (pulse(times - late) - pulse(times + late)).max()
		assert spall.largest_tension(depth, speed, duration) == pytest.approx(expected, rel=1e-3)


def test_crack_is_where_the_damage_is():
	mesh = beam.mesh(0.01)
	x, y = mesh.centroids.T
	line = beam.LENGTH / 2 + 0.3 * (y - beam.NOTCH)
	damage = np.repeat(
		((np.abs(x - line) < 0.01) & (y > beam.NOTCH) & (y < 0.08)).astype(float)[:, None], 3, axis=1
	)
	none = np.zeros(2)
	heights, places = beam.History(mesh, none, none, none, none, none, none, mesh.nodes, damage, 0).crack()
	assert heights.max() < 0.085 and len(heights) >= 6
	assert np.abs(places - (beam.LENGTH / 2 + 0.3 * (heights - beam.NOTCH))).max() < 0.01  # within a triangle


def test_bands_are_found_under_their_angles():
	mesh = ddem.mesh.rectangle(confined.WIDTH, confined.HEIGHT, 0.005)
	x, y = (mesh.centroids - (confined.WIDTH / 2, confined.HEIGHT / 2)).T
	band = lambda angle: np.abs(y * np.cos(np.radians(angle)) - x * np.sin(np.radians(angle))) < 0.008
	damage = np.repeat((band(52) | band(-67)).astype(float)[:, None], 3, axis=1)
	none = np.zeros(2)
	(right, _), (left, _) = confined.History(mesh, 0.0, 1.0, none, none, none, mesh.nodes, damage, 0.0, 0.0).bands()
	assert (right, left) == (pytest.approx(52, abs=2), pytest.approx(67, abs=2))
	((_, alone), _) = confined.History(
		mesh, 0.0, 1.0, none, none, none, mesh.nodes, np.repeat(band(60).astype(float)[:, None], 3, axis=1),
		0.0, 0.0
	).bands()
	assert 0.5 < alone <= 1


def test_handbook_formulas_of_the_notched_beam():
	# a/W = 0.3, S/W = 4: V₁ = 1.7162, f = 1.5212 by the polynomials of Tada, Paris and Irwin
	# (1985) and of ASTM E399
	modulus = 60.517e9 / (1 - 0.16379**2)  # E = 9 B μ/(3 B + μ), ν = (3 B − 2 μ)/(6 B + 2 μ)
	assert beam.opening_compliance() == pytest.approx(4 * 60 * 0.03 * 1.7162 / modulus, rel=1e-3)
	assert beam.toughness_strength(100) == pytest.approx(
		np.sqrt(100 * modulus) * 0.1**1.5 / (0.4 * 1.5212), rel=1e-3
	)
	assert beam.bending_strength(6e6) == pytest.approx(6e6 * 0.07**2 / 6 * 10)


def test_bar_is_the_same_on_every_fitting_mesh():
	for size, count in ((0.02, 2), (0.01, 8), (0.005, 32)):
		mesh = ddem.mesh.rectangle(reinforced.WIDTH, reinforced.HEIGHT, size, regions={"bar": reinforced.BAR})
		assert len(mesh.region("bar")) == count
		assert mesh.areas[mesh.region("bar")].sum() == pytest.approx(2e-4)


def test_block_is_tested_for_the_whole_time_though_the_platen_pulls():
	pulled = reinforced.run(size=0.02, velocity=-1, until=1e-4)
	assert (pulled.stress[5:] < 0).all()
	assert pulled.times[-1] == pytest.approx(1e-4, rel=0.01)


def test_snapshots_are_of_the_instants_that_the_pictures_name():
	crushed = reinforced.run(size=0.02, until=1.2e-4)
	for instant in reinforced.INSTANTS[:4]:
		assert abs(crushed.snapshot(instant)[0].time - instant) < 1e-6


def test_measures_of_a_block_with_known_damage():
	crushed = reinforced.run(size=0.01, until=1e-6)
	mesh, run = crushed.mesh, crushed.run
	x, y = mesh.centroids.T
	damage = np.where(y > 0.15, 0.95, 0.0)[:, None].repeat(3, axis=1)
	nodes = mesh.nodes + 0.003 * (mesh.nodes[:, 1:] < 0.05) * (1, 0)
	run.snapshots[:] = [
		TriangleSnapshot(
			1.0, nodes, mesh.triangles, damage, np.where((x > 0.09) & (y > 0.19), 0.4, 0.1 * (y < 0.1)),
			run.snapshots[0].border
		)
	]
	concrete = mesh.areas[mesh.regions == 0].sum()
	assert crushed.mean_damage(1.0) == pytest.approx(0.95 * 0.005 / concrete)
	assert crushed.share(1.0, 0.9, 1) == pytest.approx(0.005 / concrete) and crushed.share(
		1.0, 0, 0.1
	) == pytest.approx(1 - 0.005 / concrete)
	assert (
		crushed.mean_damage(1.0, crushed.wedge(top=True)) == pytest.approx(0.95)
		and crushed.mean_damage(1.0, crushed.wedge(top=False)) == 0
	)
	assert mesh.areas[crushed.wedge(top=True)].sum() == pytest.approx(0.04**2, rel=0.02)  # base 8 cm, height 4 cm
	assert crushed.depth(1.0) == pytest.approx(0.05, abs=0.005)
	assert crushed.spread(1.0, upper=False) == pytest.approx(0.003) and crushed.spread(1.0, upper=True) == 0
	largest, place = crushed.rotation(1.0)
	assert largest == 0.4 and place[0] > 0.09 and place[1] > 0.19
	assert crushed.rotation(1.0, upper=False)[0] == 0.1
	assert crushed.wave == pytest.approx(2400 * np.sqrt((30e9 + 4 / 3 * 26e9) / 2400) * 10)  # ρ c_p v of Table 1


@pytest.mark.slow
def test_the_time_step_follows_the_block_until_its_corners_have_turned_by_a_third_of_pi():
	crushed = reinforced.run(until=2.5e-3)  # Zubelewicz (2018), section 4.3: "in the range π/3"
	assert crushed.rotation(2.5e-3)[0] > np.pi / 3
	assert crushed.run.energy_error < 1e-4
	assert 0.3 < O.dt / crushed.run.dt < 0.7  # of triangles that have stretched to four times their size


def test_without_the_bar_the_others_keep_their_fracture_energies():
	energies = []
	for bar in (True, False):
		O.reset()
		crushed = reinforced.run(size=0.02, seed=3, bar=bar, until=2e-6)
		energies.append(
			np.array([O.bodies[int(i)].shape.fractureEnergy for i in O.engines[-2].values("triangleIds")])
		)
	others = np.setdiff1d(np.arange(len(energies[0])), crushed.mesh.region("bar"))
	assert np.array_equal(energies[0][others], energies[1][others])
	assert not np.array_equal(*energies)


# --- scripts

SMALL = {
	"elastic_impulse": (
		["--no-reference", "--size", "0.02", "--until", "3e-5", "--instants", "1e-5", "3e-5"],
		{"displacement.png", "contours.png", "centre.csv", "block.pvd"},
	),
	"reinforced_block": (
		["--until", "2e-5", "--seeds", "1", "2"],
		{"mesh.png", "history.png", "shape.png", "realisations.png", "seed-1.csv", "seed-2.csv", "seed-1.pvd"},
	),
	"spall_bar": (["--size", "0.01"], {"spall.png", "free_end.csv", "bar.pvd"}),
	"confined_block": (
		["--pressures", "0", "--size", "0.025", "--strain", "2e-4"],
		{"confined.png", "pressure-0-rough.csv", "pressure-0-smooth.csv", "pressure-0.pvd"},
	),
	"notched_beam": (
		["--sizes", "0.02", "--deflection", "2e-6"],
		{"bending.png", "size-20-volume.csv", "size-20-band.csv", "beam.pvd"},
	),
	"mesh_orientation": (
		["--count", "150", "--strain", "2e-4"],
		{"orientation.png", "crossed-150.csv", "alternating-150.csv", "unstructured-150.csv"}
		| {f"{pattern}-150.pvd" for pattern in ("crossed", "alternating", "unstructured")},
	),
}


@pytest.mark.parametrize("name", SMALL)
def test_script_writes_what_it_promises(name, monkeypatch, tmp_path, capsys):
	arguments, expected = SMALL[name]
	script_modules.run(script_modules.load(name), monkeypatch, *arguments, "--out", tmp_path / "new")
	found = {file.name for file in (tmp_path / "new").iterdir() if file.suffix != ".vtu"}
	assert len({origin["inputs_sha256"] for origin in origins.of_all(tmp_path / "new").values()}) == 1
	assert found == expected
	for file in expected:
		if file.endswith(".pvd"):
			files = collection(tmp_path / "new" / file)
			assert len(files) >= 10 and sorted(time for time, _ in files) == [time for time, _ in files]
			points, cells, kind, point, cell, time, _ = read(files[-1][1])
			assert kind == VTK_TRIANGLE and len(cells) > 20 and time == files[-1][0] > 0
			assert (
				np.abs(point["displacement [m]"]).max() > 0
				and np.isfinite(cell["stress [Pa]"]).all()
				and np.abs(cell["stress [Pa]"]).max() > 1e3
			)
		if file.endswith(".csv"):
			assert len(Series.read(tmp_path / "new" / file)) > 10
	assert str(tmp_path / "new") in capsys.readouterr().out


WRONG = [
	("elastic_impulse", ["--patch", "1"], "patch = 1.0 m"), ("elastic_impulse", ["--instants", "1"], "--instants"),
	("elastic_impulse", ["--pressure", "nan"], "pressure = nan Pa"),
	("elastic_impulse", ["--size", "1e-5"], "--size: 1e-05"),
	("reinforced_block", ["--step", "2"], "--step: 2"), ("reinforced_block", ["--until", "0"], "--until: 0"),
	("spall_bar", ["--speed", "0"], "--speed: 0"), ("spall_bar", ["--duration", "1"], "--duration"),
	("confined_block", ["--pressures", "-1"], "--pressures: -1"), ("notched_beam", ["--sizes", "1"], "--sizes: 1"),
	("mesh_orientation", ["--count", "3"], "--count: 3")
]


@pytest.mark.parametrize("name, arguments, words", WRONG)
def test_script_names_what_is_wrong_before_anything_runs(name, arguments, words, monkeypatch, tmp_path, capsys):
	with pytest.raises(SystemExit) as error:
		script_modules.run(script_modules.load(name), monkeypatch, *arguments, "--out", tmp_path / "new")
	assert error.value.code == 2
	assert words in capsys.readouterr().err
	assert not len(O.bodies)
