# GPL v2 or later, see LICENSE.
# Sphere packings: what a random prism must be, neighbours, files and their errors.
import itertools

import numpy as np
import pytest

from yade.ddem import packing


@pytest.fixture(scope="module")
def prism():
	return packing.prism(0.01, 0.02, 0.01, rmin=1e-3, rmax=2e-3, seed=4, fails=300)


def test_prism_lies_in_its_box_with_radii_of_its_range(prism):
	around = prism.radii[:, None]
	assert (prism.centres - around >= prism.lower - 1e-7).all() and (
		prism.centres + around <= prism.upper + 1e-7
	).all()
	assert prism.radii.min() >= 1e-3 and prism.radii.max() <= 2e-3 * (1 + 1e-12)
	assert prism.size == pytest.approx([0.01, 0.02, 0.01])
	assert 0.4 < prism.solid_fraction < 0.74  # between loose and densest packing of equal spheres
	assert not prism.flat


def test_spheres_touch_but_do_not_overlap(prism):
	distances = np.linalg.norm(prism.centres[:, None] - prism.centres[None], axis=2)
	gaps = (distances - prism.radii[:, None] - prism.radii[None])[np.triu_indices(len(prism), 1)]
	assert gaps.min() > -5e-6 * 2e-3 * 1.01
	assert (gaps < 5e-6).sum() > 1.5 * len(prism)


def test_same_seed_same_packing():
	first, second, other = (packing.prism(6e-3, 8e-3, 6e-3, 1e-3, 2e-3, seed=s, fails=100) for s in (7, 7, 8))
	assert np.array_equal(first.centres, second.centres) and np.array_equal(first.radii, second.radii)
	assert len(first) != len(other) or not np.array_equal(first.centres, other.centres)


def test_kept_packing_is_the_same_and_only_that(tmp_path, monkeypatch):
	"""A packing comes back from its file with every digit; one with another parameter is another packing."""
	asked = {"width": 6e-3, "height": 8e-3, "depth": 6e-3, "rmin": 1e-3, "rmax": 2e-3, "seed": 7, "fails": 50}
	made = packing.prism(**asked, keep=tmp_path / "kept")
	for name, value in (
		("width", 7e-3), ("height", 9e-3), ("depth", 7e-3), ("rmin", 0.9e-3), ("rmax", 1.9e-3), ("seed", 8),
		("fails", 60)
	):
		packing.prism(**{**asked, name: value}, keep=tmp_path / "kept")
	assert len(list((tmp_path / "kept").iterdir())) == 8
	monkeypatch.setattr(packing, "_pack", lambda *_: pytest.fail("it was made again"))
	kept = packing.prism(**asked, keep=tmp_path / "kept")
	assert np.array_equal(kept.centres, made.centres) and np.array_equal(kept.radii, made.radii)
	assert np.array_equal(kept.lower, made.lower) and np.array_equal(kept.upper, made.upper) and kept.bonds is None


def test_a_prism_may_be_filled_without_gengeo(tmp_path, monkeypatch):
	"""The same specimen by the other generator; packings that are kept are told apart."""
	asked = {"width": 6e-3, "height": 8e-3, "depth": 6e-3, "rmin": 1e-3, "rmax": 2e-3, "seed": 7, "fails": 50}
	other = packing.prism(**asked, keep=tmp_path)
	monkeypatch.setattr(packing, "_pack", lambda *_: pytest.fail("GenGeo was asked"))
	made = packing.prism(**asked, keep=tmp_path, generator="fill")
	assert len(list(tmp_path.iterdir())) == 2 and not np.array_equal(made.radii, other.radii)
	assert made.lower.tolist() == other.lower.tolist() and made.upper.tolist() == other.upper.tolist()
	again = packing.prism(**asked, keep=tmp_path, generator="fill")
	plain = packing.fill(packing.Box((0, 0, -3e-3), (6e-3, 8e-3, 3e-3)), 1e-3, 2e-3, seed=7, fails=50)
	for packed in (again, plain):
		assert np.array_equal(packed.centres, made.centres) and np.array_equal(packed.radii, made.radii)
	layer = packing.layer(0.02, 0.03, 1e-3, 2e-3, fails=50, generator="fill")
	assert layer.flat and layer.size == pytest.approx([0.02, 0.03, 4e-3])
	with pytest.raises(ValueError, match="generator = 'simplex' is unknown"):
		packing.prism(**asked, generator="simplex")


def test_both_generators_make_packings_of_the_same_kind():
	"""Place and Mora's insertion twice, with touching spheres from a simplex search and in closed form. Means of
	three packings of 700 spheres; between packings, the solid fraction scatters by 0.002 and
	bonds a sphere by 0.02."""
	kinds = {}
	for generator in packing.GENERATORS:
		made = [
			packing.prism(0.01, 0.02, 0.01, 0.5e-3, 2e-3, seed=s, fails=1000, generator=generator)
			for s in (1, 2, 3)
		]
		kinds[generator] = np.mean([
			(p.solid_fraction, 2 * len(p.neighbours(5e-6)) / len(p), p.radii.mean() / 2e-3) for p in made
		], axis=0)
	assert kinds["fill"] == pytest.approx(kinds["gengeo"], rel=0.03)


def test_layer_is_flat_and_two_spheres_wide_deep():
	layer = packing.layer(0.02, 0.03, rmin=1e-3, rmax=2e-3, seed=1, fails=200)
	assert layer.flat
	assert layer.size == pytest.approx([0.02, 0.03, 4e-3])
	assert (layer.centres[:, :2] - layer.radii[:, None] >= -1e-7).all() and (
		layer.centres[:, :2] + layer.radii[:, None] <= np.array([0.02, 0.03]) + 1e-7
	).all()


def test_packer_is_silent(capfd):
	packing.prism(5e-3, 5e-3, 5e-3, 1e-3, 2e-3, fails=10)
	assert capfd.readouterr().out == ""


def test_neighbours_are_all_pairs_within_the_gap():
	random = np.random.default_rng(2)
	spheres = packing.Packing(random.uniform(0, 1, (150, 3)), 10**random.uniform(-2.3, -0.8, 150))
	for gap in (0, 0.03):
		expected = [
			(i, j)
			for i, j in itertools.combinations(range(len(spheres)), 2)
			if np.linalg.norm(spheres.centres[i] - spheres.centres[j])
			< spheres.radii[i] + spheres.radii[j] + gap
		]
		assert spheres.neighbours(gap).tolist() == [list(pair) for pair in expected]


def test_files_keep_every_digit(tmp_path, prism):
	prism.bonds = prism.neighbours(5e-6)
	for unit in ("m", "mm"):
		prism.write(tmp_path / "p.csv", tmp_path / "b.csv", length_unit=unit)
		back = packing.read(tmp_path / "p.csv", tmp_path / "b.csv", length_unit=unit)
		assert np.array_equal(back.bonds, prism.bonds)
		assert np.allclose(back.centres, prism.centres, rtol=1e-15, atol=0) and np.allclose(
			back.radii, prism.radii, rtol=1e-15, atol=0
		)


def test_ids_of_a_file_may_be_any_numbers(tmp_path):
	(tmp_path / "p.csv").write_text("r, id, x, y, z, colour\n1,10,0,0,0,red\n2,7,3,0,0,blue\n")
	(tmp_path / "b.csv").write_text("i,j\n7,10\n")
	spheres = packing.read(tmp_path / "p.csv", tmp_path / "b.csv", length_unit="mm")
	assert spheres.bonds.tolist() == [[0, 1]]
	assert spheres.centres[1] == pytest.approx([3e-3, 0, 0]) and spheres.radii == pytest.approx([1e-3, 2e-3])


@pytest.mark.parametrize("lines, words", [
	(["id,x,y,z", "0,0,0,0"], "line 1: column r is missing"),
	(["id,x,y,z,r", "0,0,0,0,1", "1,0,zero,0,1"], "line 3: y = 'zero' is not a number"),
	(["id,x,y,z,r", "0,0,0,0,1", "1,0,0,1"], "line 3: 4 fields"),
	(["id,x,y,z,r", "0,0,0,0,-1"], "line 2: radius r = -1.0 mm must be positive"),
	(["id,x,y,z,r", "0,0,0,nan,1"], "line 2: z = nan is not finite"),
	(["id,x,y,z,r", "0,0,0,0,1", "0,2,0,0,1"], "line 3: id 0 appears twice"),
	(["id,x,y,z,r", "0.5,0,0,0,1"], "line 2: id = '0.5' is not a whole number"),
	(["id,x,y,z,r"], "no spheres"),
])
def test_bad_particle_files_name_the_line(tmp_path, lines, words):
	(tmp_path / "p.csv").write_text("\n".join(lines) + "\n")
	with pytest.raises(ValueError, match=words.replace("'", ".")):
		packing.read(tmp_path / "p.csv", length_unit="mm")


@pytest.mark.parametrize("lines, words", [
	(["i,j", "0,1", "1,5"], "line 3: there is no sphere with id 5"),
	(["i,j", "1,1"], "line 2: sphere 1 is bonded to itself"),
	(["i", "1"], "line 1: column j is missing"),
	(["i,j", "0,1", "1,0"], "listed twice"),
])
def test_bad_bond_files_name_the_line(tmp_path, lines, words):
	(tmp_path / "p.csv").write_text("id,x,y,z,r\n0,0,0,0,1\n1,2,0,0,1\n")
	(tmp_path / "b.csv").write_text("\n".join(lines) + "\n")
	with pytest.raises(ValueError, match=words):
		packing.read(tmp_path / "p.csv", tmp_path / "b.csv")


@pytest.mark.parametrize("change, words", [
	({"rmax": 6e-3}, "does not fit"), ({"rmin": 3e-3}, "rmin = 0.003 m is above rmax"),
	({"width": -1}, "width = -1 m must be positive"),
	({"rmin": float("nan")}, "rmin = nan m must be positive"),
])
def test_bad_prisms_are_refused(change, words):
	with pytest.raises(ValueError, match=words):
		packing.prism(**{**dict(width=0.01, height=0.02, depth=0.01, rmin=1e-3, rmax=2e-3), **change})


@pytest.mark.parametrize("centres, radii, words", [
	([[0, 0, 0]], [0], "sphere 0: radius = 0.0 m must be positive"),
	([[0, 0, float("nan")]], [1], "sphere 0: centre"), ([[0, 0, 0]], [1, 2], "a radius for each centre"),
])
def test_bad_packings_are_refused(centres, radii, words):
	with pytest.raises(ValueError, match=words):
		packing.Packing(centres, radii)


def test_unknown_unit_is_refused(tmp_path):
	with pytest.raises(ValueError, match="length_unit = 'inch' is unknown"):
		packing.read(tmp_path / "p.csv", length_unit="inch")


def test_what_yade_packs_is_a_packing(tmp_path):
	"""A SpherePack, its text file, and the list of bodies that regularHexa and randomDensePack return."""
	from yade import pack
	spheres = pack.SpherePack([((0, 0, 0), 0.01), ((0.02, 0, 0), 0.01), ((0, 0.03, 0), 0.02)])
	spheres.save(str(tmp_path / "three.spheres"))
	for found in (packing.of(spheres), packing.read(tmp_path / "three.spheres")):
		assert found.centres == pytest.approx(np.array([[0, 0, 0], [0.02, 0, 0], [0, 0.03, 0]]))
		assert found.radii == pytest.approx([0.01, 0.01, 0.02]) and found.lower == pytest.approx(
			[-0.02, -0.01, -0.02]
		)
	bodies = pack.regularHexa(pack.inAlignedBox((0, 0, 0), (0.1, 0.1, 0.1)), radius=0.01, gap=0)
	found = packing.of(bodies)
	assert len(found) == len(bodies) and found.radii == pytest.approx(0.01)
	assert found.centres[3] == pytest.approx(tuple(bodies[3].state.pos))
	assert packing.of(found) is found


def test_lines_of_numbers_may_have_comments_and_more_columns(tmp_path):
	(tmp_path / "export.txt").write_text("#format x_y_z_r_matId\n0 0 0 1 0\n\n2 0 0 1 7\n")
	found = packing.read(tmp_path / "export.txt", length_unit="mm")
	assert found.centres.tolist() == [[0, 0, 0], [2e-3, 0, 0]] and found.radii.tolist() == [1e-3, 1e-3]
	(tmp_path / "short.txt").write_text("0 0 0 1\n1 2 3\n")
	with pytest.raises(ValueError, match="short.txt, line 2: .* x y z r at least"):
		packing.read(tmp_path / "short.txt")


@pytest.mark.parametrize("nothing", (3, [1, 2], ["a"], [((0, 0, 0), "r")]))
def test_what_is_no_packing_is_refused(nothing):
	with pytest.raises(ValueError, match="is no packing"):
		packing.of(nothing)


def test_pieces():
	three = packing.Packing([[x, 0, 0] for x in range(5)], [0.5] * 5)
	assert three.pieces([[3, 4], [2, 3]]).tolist() == [1, 2, 0, 0, 0]
	assert three.pieces([[0, 1], [1, 2], [2, 3], [3, 4]]).tolist() == [0] * 5


def test_columns_are_those_that_yade_names(tmp_path):
	"""export.textExt writes the id first where it is asked to."""
	from yade import O, export, utils
	O.reset()
	for x in (0.1, 0.2):
		O.bodies.append(utils.sphere((x, 0.3, 0.4), 0.01))
	export.textExt(str(tmp_path / "with_ids.txt"), format="id_x_y_z_r_matId")
	found = packing.read(tmp_path / "with_ids.txt")
	assert found.centres.tolist() == [[0.1, 0.3, 0.4], [0.2, 0.3, 0.4]] and found.radii.tolist() == [0.01, 0.01]
	(tmp_path / "other.txt").write_text("#format jointedPM\n0 0 0 1\n")
	with pytest.raises(
		ValueError, match="other.txt, line 1: the format must name x, y, z and r: #format jointedPM"
	):
		packing.read(tmp_path / "other.txt")
	O.reset()
