# GPL v2 or later, see LICENSE.
"""Three-point bending: a row of spheres is a Timoshenko beam exactly, a packing nearly; forces, strength, notches."""
import math

import numpy as np
import pytest

from yade import BondedMat, ElasticWallMat, O, ddem
from yade.ddem.bonded_bending import timoshenko_deflection

RADIUS, COUNT, BONDS = 1e-3, 21, 16  # of the row; bonds between its supports
YOUNG, POISSON = 50e9, 0.25
SIZE = (0.036, 0.009, 0.009)


def row(**material):
	"""Equal spheres in a row, the outer two beyond the supports."""
	O.materials.append(
		BondedMat(**{**dict(label="rock", young=YOUNG, poisson=POISSON, cohesion=1e12), **material})
	)
	spheres = ddem.packing.Packing([[2 * RADIUS * k, 0, 0] for k in range(COUNT)], [RADIUS] * COUNT)
	return ddem.bonded.append(spheres, "rock", gap=1e-6)


def beam(seed=1, notch=0.0, size=SIZE, **material):
	O.reset()
	O.materials.append(BondedMat(**{**dict(label="rock", young=YOUNG, cohesion=1e12), **material}))
	packing = ddem.packing.fill(ddem.packing.Box((0, 0, 0), size), 0.7e-3, 1.6e-3, seed=seed)
	return ddem.bonded.append(ddem.packing.notched(packing, notch) if notch else packing, "rock")


def run(load, seconds, viscosity=3e4, safety=0.7):
	O.engines = ddem.bonded.engines(load, viscosity)
	O.dt = ddem.bonded.time_step(safety)
	O.run(int(seconds / O.dt), True)


def test_a_row_of_spheres_is_a_timoshenko_beam():
	"""A bond is a Timoshenko element with one integration point: its curvature is that of the moment in its middle,
	P x/2. So the deflection is P/(E I) Σ (x/2)² d over both halves + P L/(4 G A), which tends to P L³/48EI + P
	L/4GA with the square of the bonds' length: 0.4 % above it here."""
	bending = ddem.bonded.three_point_bending(row(), 2 * RADIUS * BONDS, 0.02, ramp=2e-3, strip=0.5 * RADIUS)
	run(bending, 4e-3, viscosity=2e3)
	load, span = bending.force_top, bending.span
	inertia, area, shear = math.pi * RADIUS**4 / 4, math.pi * RADIUS**2, YOUNG / (2 * (1 + POISSON))
	middles = (np.arange(BONDS // 2) + 0.5) * 2 * RADIUS
	exact = 2 * load * (middles**2 / 4).sum() * 2 * RADIUS / (YOUNG * inertia) + load * span / (4 * shear * area)
	# the viscosity's drag at 0.02 m/s is a thousandth of the load
	assert bending.deflection == pytest.approx(exact, rel=1.5e-3)
	continuous = load * span**3 / (48 * YOUNG * inertia) + load * span / (4 * shear * area)
	assert exact / continuous == pytest.approx(1 - 1 / BONDS**2, abs=5e-4)


def test_the_row_breaks_at_the_moment_that_its_section_bears():
	"""Rim stress of the bonds beside the middle: σ = M R/I with M = P/2 (L - d)/2, at the cut-off; a hundred
	steps of loading are a hundredth of it."""
	limit = 4e6
	sample = row(tensileStrength=limit)
	bending = ddem.bonded.three_point_bending(sample, 2 * RADIUS * BONDS, 0.01, ramp=1e-3, strip=0.5 * RADIUS)
	O.engines = ddem.bonded.engines(bending, 2e3)
	O.dt = ddem.bonded.time_step(0.7)
	largest = 0.0
	while not len(sample.broken) and O.time < 0.05:
		O.run(100, True)
		largest = max(largest, bending.force_top)
	moment = limit * (math.pi * RADIUS**4 / 4) / RADIUS
	assert largest == pytest.approx(moment / (0.25 * (bending.span - 2 * RADIUS)), rel=0.02)
	broken = sample.broken[0]
	assert broken["mode"] == "tension" and abs(broken["position"][0] - (COUNT - 1) * RADIUS) < 1.01 * RADIUS


def constants(seed):
	"""Young's modulus and Poisson's ratio of the same packing along x, between smooth platens."""
	sample = beam(seed)
	press = ddem.bonded.servo(sample, [("stress", 10e6, 2e-4)], velocity=1.0, axis="x")
	run(press, 4e-4)
	centres, moved = sample.positions - sample.displacements, sample.displacements
	along, *across = (np.polyfit(centres[:, k], moved[:, k], 1)[0] for k in range(3))
	return -press.stress / along, -np.mean(across) / along


def test_a_packed_beam_bends_as_timoshenko_says():
	"""With the sample's own E and ν, measured in compression. A beam of five spheres over its height is softer:
	bonds end in the centres of the outer spheres, so the height that bears lies between h and
	h less a mean diameter."""
	young, poisson = constants(1)
	assert 0.1 < poisson < 0.3
	sample = beam(1)
	bending = ddem.bonded.three_point_bending(sample, 0.028, 0.05, ramp=1e-4)
	run(bending, 4e-4)
	length, height, depth = SIZE
	skin = 2 * float(sample.radii.mean())
	least = timoshenko_deflection(bending.force_top, 0.028, young, poisson, depth, height)
	most = timoshenko_deflection(bending.force_top, 0.028, young, poisson, depth, height - skin)
	assert least < bending.deflection < most
	assert bending.deflection == pytest.approx(least, rel=0.25)  # 11 % where it is seven spheres high

	left, right = bending.reactions
	# the load acts somewhere within its strip
	assert abs(left - right) < bending.strip / bending.span * bending.force_top
	assert bending.force_bottom == pytest.approx(bending.force_top, rel=0.02)
	for body in (bending.left, bending.right, bending.load):  # nothing pushes along the beam
		assert abs(O.forces.f(body)[0]) < 1e-3 * bending.force_top
	assert bending.stress == pytest.approx(3 * bending.force_top * 0.028 / (2 * depth * height**2), rel=1e-12)
	assert bending.strain == pytest.approx(6 * bending.deflection * height / 0.028**2, rel=1e-12)


def test_strips_hardly_resist_rotation():
	"""Ten times as soft, they let the same beam bend by less than a hundredth more."""
	bent = []
	for share in (0.01, 0.1):
		bending = ddem.bonded.three_point_bending(beam(1), 0.028, 0.05, ramp=1e-4, stiffness=share * YOUNG)
		run(bending, 4e-4)
		bent.append(bending.deflection / bending.force_top)
	assert 1 < bent[0] / bent[1] < 1.01


def test_timoshenkos_formula():
	"""Slender: P L³/48EI; and shear adds P L/(4 κ G A), κ = 5/6 for ν = 0."""
	assert timoshenko_deflection(1, 1, 1, 0, 1, 1e-3) == pytest.approx(1 / (48 * 1e-9 / 12), rel=1e-5)
	both = timoshenko_deflection(1, 1, 1, 0, 1, 1)
	assert both == pytest.approx(12 / 48 + 1 / (4 * 5 / 6 * 0.5), rel=1e-12)


def broken_beam(notch):
	sample = beam(2, notch, cohesion=60e6)
	bending = ddem.bonded.three_point_bending(sample, 0.028, 0.1, ramp=5e-5, notch=notch)
	O.engines = ddem.bonded.engines(bending, 2e3)
	O.dt = ddem.bonded.time_step(0.7)
	loads = []
	while O.time < 1e-3 and (O.time < 2e-4 or loads[-1] > 0.3 * max(loads)):
		O.run(100, True)
		loads.append(bending.force_top)
	assert loads[-1] <= 0.3 * max(loads)  # it is broken
	return sample, max(loads), bending


def test_a_notch_weakens_and_the_crack_starts_there():
	"""The nominal strengths of the sections that are left differ less than the loads do: a notch of a third takes
	half of the section modulus."""
	sample, whole, plain = broken_beam(0.0)
	broken = sample.broken
	assert (broken["mode"] == "tension").mean() > 0.6
	middle = 0.5 * SIZE[0]
	assert abs(broken["position"][:, 0] - middle).mean() < 0.25 * SIZE[1] + 2e-3  # one crack in the middle
	assert broken["position"][:5, 1].mean() < 0.5 * SIZE[1]  # from below
	sample, cut, notched = broken_beam(0.003)
	assert notched.section == pytest.approx((SIZE[2], SIZE[1] - 0.003))
	assert 0.3 < cut / whole < 0.85
	assert 0.7 < (cut / notched.area) / (whole / plain.area) < 1.5
	assert abs(sample.broken["position"][:10, 0] - middle).max() < 3e-3


def test_no_bond_crosses_a_notch():
	packing = ddem.packing.fill(ddem.packing.Box((0, 0, 0), SIZE), 0.7e-3, 1.6e-3)
	cut = ddem.packing.notched(packing, 0.004, x=0.02)
	one, two = packing.centres[cut.bonds].transpose(1, 0, 2)
	share = (0.02 - one[:, 0]) / np.where(one[:, 0] == two[:, 0], 1, two[:, 0] - one[:, 0])
	crossing = ((one[:, 0] < 0.02) != (two[:, 0] < 0.02))
	heights = (one[:, 1] + share * (two[:, 1] - one[:, 1]))[crossing]
	assert len(heights) > 5 and heights.min() >= 0.004
	all_bonds = packing.neighbours(ddem.packing.BOND_GAP * packing.radii.max())
	assert len(all_bonds) > len(cut.bonds)
	for arguments, words in (
		((0, ), "depth = 0 m must lie between 0 and the height"), ((0.01, ), "depth = 0.01 m"),
		((0.004, 0.05), "x = 0.05 m is not between the ends"), ((1e-6, ), "nothing to cut"),
	):
		with pytest.raises(ValueError, match=words):
			ddem.packing.notched(packing, *arguments)


def test_a_notch_keeps_all_else_of_a_packing_and_its_own_stays():
	packing = ddem.packing.fill(ddem.packing.Box((0, 0, 0), SIZE), 0.7e-3, 1.6e-3)
	packing.note = "mine"
	cut = ddem.packing.notched(packing, 0.004)
	assert packing.bonds is None and cut.note == "mine" and cut.shape is packing.shape
	assert np.array_equal(cut.lower, packing.lower) and cut.volume == packing.volume
	cut.centres[0] += 1
	assert packing.centres[0] != pytest.approx(cut.centres[0])


def test_a_periodic_packing_has_no_face_to_notch():
	"""Bonds across the border are not where the centres are."""
	packing = ddem.packing.Packing([[1, 1, 1], [3, 1, 1]], [1, 1], cell=(4, 2, 2))
	with pytest.raises(ValueError, match="a periodic packing has no lower face to cut from"):
		ddem.packing.notched(packing, 0.5)


def test_a_gauge_whose_spheres_are_gone_is_named():
	"""The mean of no displacement is NaN, with which a loop runs on."""
	bending = ddem.bonded.three_point_bending(row(), 2 * RADIUS * BONDS, 0.02, strip=0.5 * RADIUS)
	O.engines = ddem.bonded.engines(bending)
	assert bending.deflection == 0
	O.bodies.erase(COUNT // 2)  # the sphere at mid-span
	for quantity in ("deflection", "strain"):
		with pytest.raises(RuntimeError, match=r"gauge at mid-span, .* has lost all of its 1 spheres \(#10\)"):
			getattr(bending, quantity)


@pytest.mark.parametrize("arguments, words", [
	(dict(span=0), "span = 0 m must be positive"), (dict(velocity=-1), "velocity = -1 m/s must be positive"),
	(dict(ramp=-1), "ramp = -1 s must not be negative"),
	(dict(span=0.036), "span = 0.036 m and a strip .* do not lie below a beam 0.036 m long"),
	(dict(span=0.002), "span = 0.002 m leaves no room between strips"),
	(dict(notch=0.02), "notch = 0.02 m must lie between 0 and the height"),
	(dict(strip=-1), "strip = -1 m must be positive"), (dict(strip=1e-9), "no sphere is within 1.1 radii"),
	(dict(stiffness=-1), "stiffness = -1 Pa"),
])
def test_what_is_refused_appends_nothing(arguments, words):
	sample = beam()
	bodies = len(O.bodies)
	with pytest.raises(ValueError, match=words):
		ddem.bonded.three_point_bending(sample, **{"span": 0.028, "velocity": 0.1, **arguments})
	assert len(O.bodies) == bodies and not any(isinstance(m, ElasticWallMat) for m in O.materials)


def test_only_beams_bend():
	with pytest.raises(ValueError, match="is no beam"):
		ddem.bonded.three_point_bending(beam(size=(0.009, 0.009, 0.009)), 0.005, 0.1)
	O.reset()
	O.materials.append(BondedMat(label="rock"))
	core = ddem.packing.Cylinder((0, 0, 0), (0.03, 0, 0), 0.005)
	sample = ddem.bonded.append(ddem.packing.fill(core, 0.8e-3, 2e-3), "rock")
	with pytest.raises(ValueError, match="the sample must be a prism"):
		ddem.bonded.three_point_bending(sample, 0.02, 0.1)


def test_a_loaded_scene_has_its_bending_again(tmp_path):
	load, lines = ddem.bonded.three_point_bending(beam(notch=0.003), 0.028, 0.05, ramp=1e-5, notch=0.003), []
	run(load, 5e-5)
	O.save(str(tmp_path / "half.yade.gz"))
	results = []
	for again in (False, True):
		if again:
			O.reset()
			O.load(str(tmp_path / "half.yade.gz"))
			load = ddem.bonded.Bending.from_scene(ddem.bonded.BondedSample.from_scene())
		O.run(100, True)
		results.append(
			[
				getattr(load, name)
				for name in ("deflection", "strain", "stress", "force_bottom", "area", "span", "strip")
			]
			+ [len(load.engines)]
		)
		lines.append(np.concatenate(load.outlines))
	assert results[0] == results[1] and results[0][0] != 0
	assert np.array_equal(*lines)
	O.bodies.erase(load.load)
	with pytest.raises(RuntimeError, match="the scene has 0 loads that it says are a bending, where one is asked"):
		ddem.bonded.Bending.from_scene(load.sample)
