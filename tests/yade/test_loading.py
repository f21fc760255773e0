# GPL v2 or later, see LICENSE.
# Platens on shapes that are not boxes: what they hold, their gauge length and their areas.
import numpy as np
import pytest
from yade import DeformableEngine, ForceResetter, O, ddem

from deformable_samples import elastic

mesh = ddem.mesh
DISC = mesh.disc(0, 0, 0.025, 72)


def uneven(amplitude, size=0.01):
	"""A box of 0.1 m by 0.2 m whose border nodes are off by up to `amplitude` of an edge, and where the tops of the
	edges are on average.
	"""
	plain = mesh.rectangle(0.1, 0.2, size=size)
	nodes, border = plain.nodes.copy(), plain.boundary()
	nodes[border] += amplitude * size * np.random.default_rng(4).uniform(-1, 1, (len(border), 2))
	return mesh.Mesh(nodes, plain.triangles).validate(), plain


def crushed(block, treatment="cosserat", **options):
	"""Platens after a slow, short run, with the stress that the sample itself has [Pa], compression positive."""
	platens = ddem.platens(block, velocity=0.01, ramp=2e-5, lateral="free", both=True, **options)
	O.engines = [ForceResetter(), *platens.engines, DeformableEngine(rotation=treatment)]
	O.dt = ddem.time_step(0.8)
	ddem.relax(1e-4, damping=0.3)
	stress, area = block.stress[..., 1].mean(axis=1), block.area
	return platens, float(-(stress * area).sum() / area.sum())


def test_an_uneven_sample_has_the_stress_and_strain_of_a_box():
	young = 30e9
	moduli = {"bulk": young / (3 * (1 - 0.4)), "shear": young / (2 * 1.2)}  # Poisson's ratio 0.2
	rough, plain = uneven(0.1)
	strengths = []
	for shape in (plain, rough):
		O.reset()
		platens, inside = crushed(ddem.append(shape, elastic(**moduli)))
		assert len(platens.top) == len(platens.bottom) == 11
		assert platens.stress == pytest.approx(inside, rel=0.02)
		assert platens.stress_top == pytest.approx(platens.stress, rel=0.02)
		strengths.append(platens.stress / platens.strain)
	assert strengths[0] == pytest.approx(young / (1 - 0.2**2), rel=0.01)  # plane strain, ends free to slide
	assert strengths[1] == pytest.approx(strengths[0], rel=0.03)


def test_a_box_has_exactly_its_height_and_area():
	for pattern in ("crossed", "unstructured"):
		block = ddem.append(mesh.rectangle(0.1, 0.2, size=0.01, pattern=pattern), elastic(), thickness=0.3)
		platens = ddem.platens(block, velocity=1)
		assert (platens.height, platens.area, platens.area_bottom) == (0.2, 0.1 * 0.3, 0.1 * 0.3)


def test_a_notch_bears_no_load():
	"""A mouth of 2 mm in the top: the area is what is left of it."""
	notched = mesh.polygon(
		[(0, 0), (0.1, 0), (0.1, 0.1), (0.051, 0.1), (0.051, 0.05), (0.049, 0.05), (0.049, 0.1), (0, 0.1)],
		size=0.01
	)
	platens = ddem.platens(ddem.append(notched, elastic(), thickness=2), velocity=1)
	assert platens.area == pytest.approx(0.098 * 2, rel=1e-12)
	assert platens.area_bottom == pytest.approx(0.1 * 2, rel=1e-12)


def test_ends_of_different_width_count_with_their_own_areas():
	trapezoid = mesh.polygon([(0, 0), (0.1, 0), (0.08, 0.1), (0.02, 0.1)], size=0.01)
	platens, _ = crushed(ddem.append(trapezoid, elastic()))
	assert (platens.area, platens.area_bottom) == (pytest.approx(0.06), pytest.approx(0.1))
	assert platens.force_top == pytest.approx(platens.force_bottom, rel=1e-3)  # equilibrium
	assert platens.stress == pytest.approx(0.5 * (platens.force_top / 0.06 + platens.force_bottom / 0.1), rel=1e-12)


def test_a_disc_between_jaws_that_are_named_by_functions():
	"""The Brazilian test: nodes of arcs of 20 degrees, their width, and the mean distance of the arcs."""
	half = np.radians(10)
	block = ddem.append(mesh.polygon(DISC, size=0.002), elastic(), thickness=0.5)
	level = 0.025 * np.cos(half) - 1e-6
	platens, _ = crushed(block, top=lambda x, y: y > level, bottom=lambda x, y: y < -level)
	assert platens.area == pytest.approx(2 * 0.025 * np.sin(half) * 0.5, rel=1e-6)
	heights = 0.025 * np.cos(np.radians([-10, -5, 0, 5, 10]))  # 72 corners, an edge each
	assert platens.height == pytest.approx(2 * heights.mean(), rel=1e-9)
	# Hondros (1959): σx = 2P/(πDt) at the centre, σy = -3 of it, for arcs that are not wide
	centre = np.argsort(np.hypot(*block.mesh.centroids.T))[:8]
	split = 2 * platens.force_top / (np.pi * 0.05 * 0.5)
	assert block.stress[centre, :, 0].mean() == pytest.approx(split, rel=0.1)
	assert -block.stress[centre, :, 1].mean() == pytest.approx(3 * split, rel=0.1)


def slanted(slope):
	plain = mesh.rectangle(0.1, 0.2, size=0.01)
	return mesh.Mesh(
		plain.nodes * [1, 1] + np.column_stack(
			[np.zeros(len(plain.nodes)), slope * plain.nodes[:, 0] * plain.nodes[:, 1] / 0.2]
		),
		plain.triangles
	)


NO_SIDE = {
	"disc": lambda: mesh.polygon(DISC, size=0.002), "slanted": lambda: slanted(0.1),
	"apex": lambda: mesh.polygon([(0, 0), (0.1, 0), (0.05, 0.1)], size=0.01),
	"rough": lambda: uneven(0.4)[0]
}


@pytest.mark.parametrize("kind", NO_SIDE)
def test_an_end_that_is_no_side_is_refused_with_what_was_found_and_nothing_is_held(kind):
	block = ddem.append(NO_SIDE[kind](), elastic())
	for ask in (lambda: ddem.platens(block, velocity=1), lambda: block.boundary("top")):
		with pytest.raises(
			ValueError,
			match=r"boundary\('top'\): the mesh has no straight top side.* y = [0-9.]+ m, lies? [0-9]+ "
			r"nodes? "
			r".*Name the nodes by a function.*lambda x, y: y > "
		):
			ask()
	assert {O.bodies[i].state.blockedDOFs for i in block.node_ids} == {"zXYZ"}


@pytest.mark.parametrize(
	"top, bottom, message", [
		(
			lambda x, y: y > 1, "bottom",
			"true at none of the 60 nodes of the border, which spans x from 0 to 0.1 m and y from 0 to 0.2 "
			"m"
		),
		(
			lambda x, y: (y > 0.199) & (x < 0.001), "bottom",
			r"top= finds 1 node, and no edge of the border joins the one at \(0, 0.2\) m"
		),
		("top", lambda x, y: (y < 1e-3) & (np.round(100 * x) % 2 == 0), r"bottom= finds 6 nodes, and no edge"),
		("bottom", "top", "the top lies at y = 0 m, not above the bottom at 0.2 m; exchange"),
		(lambda x, y: y > 0.05, "left", r"nodes, such as the one at \(0, .*belong to both ends"),
		(lambda x, y: (x < 1e-3) & (y > 0.1), "bottom", "border edges of top= are all along the load, x = 0 m"),
		("upper", "bottom", "unknown side 'upper'"),
	]
)
def test_ends_that_cannot_be_loaded_are_refused(top, bottom, message):
	block = ddem.append(mesh.rectangle(0.1, 0.2, size=0.01), elastic())
	with pytest.raises(ValueError, match=message):
		ddem.platens(block, velocity=1, top=top, bottom=bottom)
	assert {O.bodies[i].state.blockedDOFs for i in block.node_ids} == {"zXYZ"}


# ---- a scene that was loaded ----


@pytest.mark.parametrize("both", (False, True))
def test_a_loaded_scene_has_its_block_and_platens_again(both, tmp_path):
	"""Another process goes on: the same stress, strain and fields, and the same run."""
	elastic("soft")
	elastic("hard", shear=20e9, bulk=25e9)
	shape = mesh.rectangle(0.04, 0.08, size=0.01, regions={"hard": mesh.box(0.01, 0.02, 0.03, 0.06)})
	block = ddem.append(shape, {"": "soft", "hard": "hard"}, thickness=0.3, position=(0.2, -0.1, 0))
	platens = ddem.platens(block, velocity=2, both=both)
	O.engines = [ForceResetter(), *platens.engines, DeformableEngine()]
	O.dt = ddem.time_step(0.8)
	O.run(60, True)
	O.save(str(tmp_path / "middle.yade.gz"))
	O.run(40, True)
	expected = (platens.stress, platens.strain, platens.area, platens.height, block.displacements.copy())
	O.reset()
	O.load(str(tmp_path / "middle.yade.gz"))
	again = ddem.Block.from_scene()
	loaded = ddem.Platens.from_scene(again)
	O.run(40, True)
	assert (loaded.stress, loaded.strain) == pytest.approx(expected[:2], rel=1e-12)
	assert (loaded.area, loaded.height) == pytest.approx(expected[2:4], rel=1e-12)
	assert np.array_equal(again.displacements, expected[4])
	assert again.thickness == 0.3 and len(loaded.engines) == 1 + both
	assert sorted(again.mesh.region_names) == ["", "hard", "soft"]
	hard = again.mesh.regions == again.mesh.region_names.index("hard")
	assert again.area[hard].sum() == pytest.approx(0.02 * 0.04)


def test_one_block_of_several_by_its_ids():
	blocks = [
		ddem.append(mesh.rectangle(0.02, 0.02, size=0.01), elastic(f"rock{k}"), thickness=0.1 * (k + 1),
			position=(0.05 * k, 0, 0))
		for k in range(2)
	]
	with pytest.raises(ValueError, match="triangles are 0.1 to 0.2 m thick: give the ids of those of one block"):
		ddem.Block.from_scene()
	again = ddem.Block.from_scene(blocks[1].triangle_ids)
	assert again.thickness == 0.2 and np.array_equal(again.triangle_ids, blocks[1].triangle_ids)
	assert np.array_equal(again.node_ids, blocks[1].node_ids)
	with pytest.raises(ValueError, match=f"body {blocks[0].node_ids[0]} is no deformable triangle"):
		ddem.Block.from_scene([blocks[0].node_ids[0]])
	with pytest.raises(RuntimeError, match="no RampedTranslationEngine in O.engines drives nodes of this block"):
		ddem.Platens.from_scene(again)
	O.reset()
	with pytest.raises(RuntimeError, match="the scene has no deformable triangles"):
		ddem.Block.from_scene()
