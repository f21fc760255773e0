# GPL v2 or later, see LICENSE.
"""The cheapest settings for an error, and the sentence that says so, from made-up points whose answer is known."""
import pytest

from ddem.accuracy import points, recommendation, sentences
from ddem.accuracy.ladders import Ladder, Quantity, each

STRENGTH = Quantity("strength", "UCS", "Pa", "ucs")
BASE = {"model": "deformable", "size": 0.008}
SIZES = (0.008, 0.004, 0.002, 0.001)


def outcome(value, seconds):
	return {
		"value:ucs": value, "cpu_s": seconds, "wall_s": seconds, "ns_per_particle_step": 20.0, "memory_MB": 5.0,
		"steps": 1000, "particles": 500, "unknowns": 1000, "dt_s": 1e-7, "threads": 1
	}


def group(name, kind, rungs, outcomes, **more):
	"""Points of a ladder; each rung's outcome is (strength, core-seconds), or a list of these, one a seed."""
	given = Ladder(name, kind, "ucs", rungs, [STRENGTH], {**BASE, **more.pop("base", {})}, **more)
	outcomes = [one if isinstance(one, list) else [one] for one in outcomes]
	outcomes = [[outcome(*one) if isinstance(one, tuple) else one for one in seeds] for seeds in outcomes]
	return points.of_ladder(given, outcomes, "ucs")


def mesh():
	"""Errors of 8, 4, 2 and 1 % against a limit of 100, itself known within 1.25 %; 1, 8, 64 and 512 s."""
	outcomes = [(100 * (1 + 10 * size), (0.008 / size)**3) for size in SIZES]
	return group("mesh", "mesh size", each("size", *SIZES), outcomes, refined="size")


def rotation():
	"""None saves half of the time and changes 3 %, corotational a tenth and changes 0.5 %."""
	rungs = each("rotation", "none", "corotational", "cosserat")
	return group("turn", "rotation treatment", rungs, [(103.0, 1.0), (100.5, 1.8), (100.0, 2.0)])


def effects():
	"""Without the equation of state it takes three quarters of the time and changes 1 %."""
	rungs = ({"values": {"equationOfState": False}}, {"values": {}})
	return group("law", "law and effects", rungs, [(101.0, 1.5), (100.0, 2.0)])


def flow():
	"""Half of the time for nothing, but without the equation of state only."""
	base = {"values": {"equationOfState": False}}
	return group("flow", "flowInterval", each("flow_interval", 2, 1), [(101.0, 1.0), (101.0, 2.0)], base=base)


def book():
	"""A twentieth of the time, in the median of three seeds."""
	without, with_ = [(100.0, 1.9), (100.0, 1.8), (100.0, 1.96)], [(100.0, 2.0)] * 3
	return group("book", "energy book", each("energy_book", False, True), [without, with_], seeds=(1, 2, 3))


def stiffness(change=0.0):
	rungs = tuple({"values": {"rotationStiffness": beta}} for beta in (0, 2))
	return group("beta", "rotation stiffness", rungs, [(100.0 * (1 + change), 2.0), (100.0, 2.0)])


def names(found):
	return [point.rung for point in found.points]


def test_errors_add_up_and_the_cheapest_combination_is_taken():
	groups = [mesh(), rotation()]
	best = recommendation.cheapest(0.05, groups[0], groups)
	# 4 mm with 4 % leaves 1 %, enough for corotational; 2 mm with none is 5 % as well, for 32 s
	assert names(best) == ["4 mm", "corotational"] and not best.measured
	assert best.cpu_s == pytest.approx(8 * 0.9) and best.error == pytest.approx(0.045)
	best = recommendation.cheapest(0.041, groups[0], groups)  # leaves a thousandth
	assert names(best) == ["4 mm", "cosserat"] and best.measured and best.cpu_s == pytest.approx(8)
	assert names(recommendation.cheapest(0.12, groups[0], groups)) == ["8 mm", "no rotation"]
	assert recommendation.cheapest(0.01, groups[0], groups) is None  # the limit is not known so well


def test_settings_that_need_another_go_with_it_only():
	groups = [mesh(), effects(), flow()]
	assert names(recommendation.cheapest(0.041, groups[0], groups)) == ["4 mm", "all effects", "flow interval 1"]
	best = recommendation.cheapest(0.05, groups[0], groups)
	assert names(best) == ["4 mm", "equationOfState off", "flow interval 2"]
	assert best.cpu_s == pytest.approx(8 * 0.75 * 0.5)


def test_a_saving_within_the_noise_is_not_taken():
	rungs = each("rotation", "none", "cosserat")
	close = group("turn", "rotation treatment", rungs, [(100.0, 1.96), (100.0, 2.0)])
	groups = [mesh(), close]
	assert names(recommendation.cheapest(0.05, groups[0], groups)) == ["4 mm", "cosserat"]


def test_a_slower_setting_is_taken_where_the_usual_one_is_not_close_enough():
	step = group(
		"step", "time-step fraction", each("safety", 0.8, 0.4, 0.2), [(108.0, 1.0), (104.0, 2.0), (102.0, 4.0)],
		refined="safety", usual={"safety": 0.8}
	)
	groups = [mesh(), step]
	assert names(recommendation.cheapest(0.2, groups[0], groups)) == ["8 mm", "safety 0.8"]
	assert names(recommendation.cheapest(0.065, groups[0], groups)) == ["4 mm", "safety 0.2"]


def test_ladders_of_another_scene_or_without_a_usual_rung_are_left_out():
	sized = mesh()
	spheres = group(
		"turn", "rotation treatment", each("rotation", "none", "cosserat"), [(1.0, 1.0), (1.0, 2.0)],
		base={"model": "rigid"}
	)
	missing = group(
		"turn", "rotation treatment", each("rotation", "none", "cosserat"), [(1.0, 1.0), "not run: no time"]
	)
	groups = [sized, spheres, missing]
	assert recommendation.companions(sized, groups, ["rotation treatment"]) == []
	assert sentences.headline(sized, groups) == ""


def test_the_sentence_that_a_user_wants():
	groups = [mesh(), rotation(), effects(), flow(), book(), stiffness()]
	assert sentences.headline(groups[0], groups) == (
		"10 % in strength costs about 0.34 s: 8 mm, corotational, equationOfState off, flow interval 2; "
		"5 % costs about 3 s: 4 mm, cosserat, equationOfState off, flow interval 2; "
		"2 % costs 64 s: 2 mm, cosserat; the energy book is 5 % of it; β_φ changes nothing here."
	)
	assert sentences.all_of([p for one in groups for p in one])[0] == sentences.headline(groups[0], groups)


def test_clauses_of_ladders_that_were_not_run_are_left_out():
	groups = [mesh(), stiffness(-0.012)]
	assert sentences.headline(groups[0], groups) == (
		"10 % in strength costs 1 s: 8 mm; 5 % costs 8 s: 4 mm; 2 % costs 64 s: 2 mm; "
		"β_φ changes strength by no more than 1.2 %."
	)
	noisy = group(
		"book", "energy book", each("energy_book", False, True), [[(1.0, 1.9), (1.0, 2.1)], [(1.0, 2.0)] * 2],
		seeds=(1, 2)
	)
	assert "the energy book costs no more than times scatter" in sentences.headline(groups[0], [groups[0], noisy])
	alone = [mesh()]
	assert sentences.headline(alone[0], alone) == ""


def test_the_rate_is_named_beside_what_it_changes():
	rate = group(
		"rate", "loading rate", each("velocity", 2.0, 1.0, 0.5), [(120.0, 1.0), (110.0, 2.0), (105.0, 4.0)],
		refined="velocity", usual={"velocity": 1.0}, base={"rotation": "corotational"}
	)
	groups = [mesh(), rate]
	assert sentences.headline(groups[0], groups).endswith(
		"; all at 1 m/s, where strength is 10 % above that of slow loading (corotational)."
	)
