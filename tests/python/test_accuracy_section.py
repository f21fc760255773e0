# GPL v2 or later, see LICENSE.
"""What the accuracy of a run cost, for its report: samples whose strength follows a known law."""
import json

import numpy as np
import pytest
from ddem.accuracy import points, sentences
from ddem.accuracy.ladders import Ladder, Quantity, each
from ddem.accuracy.section import Section

SIZES = (0.004, 0.002, 0.001)
SEEDS = (1, 2, 3)


def outcome(size, seed, noise, order=1.0, **more):
	"""60 MPa and 5 % of it for each millimetre to the order; seeds lie *noise* below, on and above that."""
	strength = 60e6 * (1 + 0.05 * (1e3 * size)**order) * (1 + noise * (seed - 2))
	return {
		"value:strength": strength, "cpu_s": 1e-9 * size**-3, "wall_s": 1e-9 * size**-3,
		"ns_per_particle_step": 20.0, "bytes_per_particle": 1500.0, "memory_MB": 3.0, "steps": 1000,
		"particles": 2e-3 / size**2, "unknowns": 1 / size**2, "dt_s": 1e-7, "threads": 1,
		"engine:triangles": 19.0, "engine:platens": 1.0, **more
	}


def found(noise, sizes=SIZES, of=outcome):
	ladder = Ladder(
		"deformable", "mesh size", "/somewhere/script.py:one_test", each("size", *sizes),
		[Quantity("strength", "UCS", "Pa")], refined="size", seeds=SEEDS
	)
	return points.of_ladder(ladder, [[of(size, seed, noise) for seed in SEEDS] for size in sizes], ladder.scene)


def section(noise=0.001, **more):
	return Section({"triangles": found(noise, **more)}, {"triangles": "deformable"}, ["A note."], {
		"triangles": {"damage of ConcreteDamageMat": 0.02, "flow of ConcreteDamageMat": 0.4}
	})


def test_both_errors_stand_beside_what_they_cost():
	"""At 1 mm the error of 60 MPa is 5 %; Richardson's limit of order one is exact, its own bound 1.25 times the
	distance from the finest value, 3 MPa, over the limit, 6.25 %, and the standard error of the finest mean,
	0.06 %. Seeds scatter by 0.1 %."""
	one, *_ = section().sentences("triangles")
	assert one == (
		"Strength with 1 mm: 1 s of processor time a sample, error of discretisation 6.3 % (Richardson's limit "
		"of this ladder, observed order 1), scatter of samples 0.1 %: a finer sample would show more than "
		"more seeds."
	)
	one, *_ = section(noise=0.2).sentences("triangles")
	assert one.endswith("scatter of samples 20 %: more seeds would show more than a finer sample.")


def test_it_says_where_the_time_goes():
	told = section().sentences("triangles")
	assert "Where the time goes at 1 mm: triangles 95 %, platens 5 %." in told
	assert told[-1] == (
		"Effects, as shares of a step in which all is strained: flow of ConcreteDamageMat 40 %, damage of "
		"ConcreteDamageMat 2 %."
	)


def test_table_and_file_have_every_sample():
	made = section()
	rows = made.rows("triangles")
	assert [row[0] for row in rows] == ["4 mm", "2 mm", "1 mm"]
	# 2e-3/h² particles, and what the outcomes say
	assert dict(zip(made.columns, rows[2])) == {
		"sample": "1 mm", "quantity": "strength", "particles": "2000", "steps": "1000",
		"ns a particle-step": "20", "bytes a particle": "1500", "core-seconds": "1", "memory [MB]": "3",
		"error": "6.3 %", "scatter": "0.1 %", "digits": "1.2"
	}
	text = made.text()
	assert text.startswith("What this accuracy cost\n") and text.endswith("\nA note.")
	assert all(cell in text for row in rows for cell in row)
	plain = json.loads(json.dumps(made.plain(), allow_nan=False))
	assert plain["notes"] == ["A note."] and len(plain["deformable"]["points"]) == 3
	assert plain["deformable"]["points"][2]["bytes_per_particle"] == 1500
	assert "/somewhere" not in json.dumps(plain)


def test_where_no_order_is_seen_the_bound_of_the_reference_counts():
	"""Strengths of 60, 63, 60 MPa approach nothing: three times the largest difference, 3 MPa, over the finest."""
	strengths = {0.004: 60e6, 0.002: 63e6, 0.001: 60e6}
	made = section(of=lambda size, seed, noise: outcome(size, seed, noise, **{"value:strength": strengths[size]}))
	assert made.rows("triangles")[2][made.columns.index("error")] == "15 %"
	said = made.sentences("triangles")[0]
	assert "discretisation up to 15 % (Richardson's limit of this ladder, no order observed: the finest)" in said
	assert said.endswith(": sizes show no trend, so more seeds come first.")
	assert made.figures() == {"cost_deformable": None}  # one bound for all sizes is no picture


def test_a_single_size_has_no_error_of_discretisation():
	one, *_ = section(sizes=(0.001, )).sentences("triangles")
	assert "error of discretisation not known" in one and one.endswith("scatter of samples 0.1 %.")


def test_a_sample_that_failed_says_why():
	of = lambda size, seed, noise: "the stress had not fallen" if size == 0.004 else outcome(size, seed, noise)
	made = section(of=of)
	assert made.rows("triangles")[0] == ["4 mm", "strength", "the stress had not fallen"]
	assert "FAILED: the stress had not fallen" in made.text()


def test_nothing_is_said_where_nothing_ran():
	points_ = found(0.0, of=lambda *_: "no result")
	assert sentences.of_one(points_) == sentences.engines(points_) == ""
	made = Section({"triangles": points_}, {"triangles": "deformable"})
	assert made.sentences("triangles") == [] and made.figures() == {"cost_deformable": None}


@pytest.mark.parametrize("noise", [0.0, 0.05])
def test_pictures_have_the_ranges_of_seeds(noise):
	drawn = section(noise).figures()["cost_deformable"]
	pairs = [line for line in drawn.axes[0].lines if len(line.get_xdata()) == 2]
	upright = [line for line in pairs if len(set(line.get_xdata())) == 1]
	assert any(np.ptp(line.get_ydata()) > 0 for line in upright) is (noise > 0)
