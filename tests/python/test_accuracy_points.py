# GPL v2 or later, see LICENSE.
"""Points and sentences of ladders whose errors follow a known law."""
import json
import math

import pytest

from ddem.accuracy import figures, points, sentences
from ddem.accuracy.ladders import Ladder, Quantity, each, find, label

SIZES = (0.008, 0.004, 0.002, 0.001)
DEFLECTION = Quantity("deflection", "displacement", "m")
STRENGTH = Quantity("strength", "UCS", "Pa", "ucs")


def scene(size):
	"""Stands for a function; never called."""


def cost(seconds, size=0.001, **values):
	unknowns = 1 / size**2
	return {
		**{f"{kind}:{name}": number for name, of in values.items() for kind, number in of.items()},
		"cpu_s": seconds,
		"wall_s": seconds,
		"ns_per_particle_step": 20.0,
		"memory_MB": 5.0,
		"steps": 1000,
		"particles": unknowns / 2,
		"unknowns": unknowns,
		"dt_s": 1e-7,
		"threads": 1,
	}


def second_order(size, exact=3.0, known=True):
	"""What a scene gives whose error is (size/mm)² per cent, and whose cost grows with size^-3."""
	error = 0.01 * (1e3 * size)**2
	entry = {"value": exact * (1 - error)}
	if known:
		entry.update(reference=exact, error=error)
	return cost(1e-9 * size**-3, size, deflection=entry)


def ladder(quantity=DEFLECTION, **more):
	return Ladder("beam", "mesh size", scene, each("size", *SIZES), [quantity], refined="size", **more)


def test_errors_costs_and_front_of_a_known_law():
	found = points.of_ladder(ladder(), [[second_order(size)] for size in SIZES], "scene")
	assert [p.error for p in found] == pytest.approx([0.64, 0.16, 0.04, 0.01])
	assert all(p.pareto for p in found)
	assert found[-1].cpu_s == pytest.approx(1) and found[-1].step == 0.001
	row = found[-1].plain()
	assert row["digits_of_accuracy"] == pytest.approx(2) and row["digits_of_efficacy"] == pytest.approx(2)
	assert row["digits_of_size"] == pytest.approx(6)
	json.dumps(row, allow_nan=False)
	keys = (
		"case quantity rung settings error reference reference_error wall_s cpu_s ns_per_particle_step "
		"memory_MB pareto"
	)
	assert set(keys.split()) <= set(row)
	assert sentences.prices(found) == "5 % in deflection costs 0.12 s (2 mm); 1 % costs 1 s (1 mm)."


def test_without_a_reference_the_limit_is_richardson_s():
	found = points.of_ladder(ladder(), [[second_order(size, known=False)] for size in SIZES], "scene")
	assert [p.error for p in found] == pytest.approx([0.64, 0.16, 0.04, 0.01], rel=1e-6)
	assert found[0].reference == pytest.approx(3) and "observed order 2" in found[0].source
	assert found[0].reference_error == pytest.approx(1.25 * 0.01, rel=1e-6)


def test_what_costs_more_and_is_no_closer_is_not_on_the_front():
	outcomes = [[second_order(size)] for size in SIZES]
	outcomes[2][0]["cpu_s"] = 5.0
	found = points.of_ladder(ladder(), outcomes, "scene")
	assert [p.pareto for p in found] == [True, True, False, True]
	assert sentences.never_worth(found) == "Never worth it here: 2 mm (beam)."


def test_failures_are_listed():
	outcomes = [[second_order(size)] for size in SIZES]
	outcomes[1] = ["the run blew up"]
	found = points.of_ladder(ladder(), outcomes, "scene")
	assert math.isnan(found[1].error) and not found[1].pareto and found[1].plain()["error"] is None
	assert sentences.failures(found) == ["beam, 4 mm: the run blew up"]
	found = points.of_ladder(ladder(STRENGTH), [[second_order(size)] for size in SIZES], "scene")
	assert found[0].failed == "the scene gives no 'ucs', but deflection"


def samples(size, scatter):
	"""Three seeds of a strength that is 1 % too small per mm and scatters."""
	return [cost(1e-9 * size**-3, size, ucs={"value": 100.0 * (1 - 10 * size + scatter * t)}) for t in (-1, 0, 1)]


def test_two_errors_of_fracture_and_where_they_cross():
	found = points.of_ladder(ladder(STRENGTH, seeds=(1, 2, 3)), [samples(size, 0.02) for size in SIZES], "scene")
	assert found[0].scatter == pytest.approx(0.02 / 0.92)
	assert len(found[0].errors) == 3 and found[0].source.startswith("Richardson's limit")
	# the finest is 1 % below the limit; its mean is known within its scatter over √3
	assert found[-1].reference_error == pytest.approx(1.25 * 0.01 + found[-1].scatter / math.sqrt(3))
	h, discretisation, scatter = sentences.two_errors(found)
	assert h == list(SIZES[:-1]) and discretisation == pytest.approx([0.04 / 0.96, 0.02 / 0.98, 0.01 / 0.99])
	assert scatter == pytest.approx([0.02 / 0.92, 0.02 / 0.96, 0.02 / 0.98])
	size, error = sentences.recommended(found)
	assert size == pytest.approx(0.0041, rel=0.05)  # where half of it, 5 h, is 2 %
	assert error == pytest.approx(0.0207, rel=0.02)
	assert sentences.hidden(found).startswith(
		"Below 2.1 % in strength the scatter of samples hides the mesh: 4.1 mm"
	)
	calm = points.of_ladder(ladder(STRENGTH, seeds=(1, 2, 3)), [samples(size, 1e-6) for size in SIZES], "scene")
	assert sentences.recommended(calm) is None and "the mesh counts at every size" in sentences.hidden(calm)


def test_names_that_vary_are_found_by_what_stays():
	angle = Quantity("stress", "stress", "-", "stress, over … turns, root")
	given = Ladder("disc", "mesh size", scene, each("size", *SIZES), [angle], refined="size")
	entry = {"value": 0.1, "reference": 0.0, "error": 0.1}
	outcome = cost(
		1, **{"stress, over 4.99 turns, mean [-]": {"value": 9.0}, "stress, over 4.99 turns, root [-]": entry}
	)
	assert points.of_ladder(given, [[outcome]] * 4, "scene")[0].error == 0.1


def test_nothing_is_compared_with_a_setting_that_is_missing():
	given = Ladder("turn", "rotation treatment", scene, each("rotation", "none", "cosserat"), [STRENGTH])
	found = points.of_ladder(given, [[cost(1, ucs={"value": 99.0})], ["not run: no time"]], "scene")
	assert math.isnan(found[0].error) and sentences.changes(found) == "" and found[1].skipped
	assert sentences.skipped(found) == ["turn, cosserat: not run: no time"] and not sentences.failures(found)


def test_other_settings_are_compared_with_the_last():
	rungs = each("rotation", "none", "cosserat")
	given = Ladder("turn", "rotation treatment", scene, rungs, [STRENGTH])
	found = points.of_ladder(given, [[cost(1, ucs={"value": 99.0})], [cost(2, ucs={"value": 100.0})]], "scene")
	assert found[0].error == pytest.approx(0.01) and math.isnan(found[1].error)
	assert (
		sentences.changes(found)
		== "Against cosserat: no rotation changes strength by -1 % and costs 0.5 times."
	)
	rate = Ladder("rate", "loading rate", scene, each("velocity", 2.0, 1.0), [STRENGTH])
	found = points.of_ladder(rate, [[cost(1, ucs={"value": 110.0})], [cost(2, ucs={"value": 99.0})]], "scene")
	assert (
		sentences.slow_enough(found)
		== "Loading (rate): 2 m/s to 1 m/s moves strength by -10 % and costs 2 times. "
		"These speeds show no limit of the strength: none is known to be slow enough."
	)


def rates(values, speeds=(4.0, 2.0, 1.0, 0.5)):
	"""Points of strengths [MPa] at these speeds, each of which costs as much more as it is slower."""
	given = Ladder(
		"rate", "loading rate", scene, each("velocity", *speeds), [STRENGTH], refined="velocity",
		usual={"velocity": 1.0}
	)
	outcomes = [[cost(1 / speed, ucs={"value": 1e6 * value})] for speed, value in zip(speeds, values)]
	return points.of_ladder(given, outcomes, "scene")


def test_loading_is_slow_enough_where_the_strength_settles():
	"""50 MPa and 0.9 % more per m/s: a first order whose limit is known, within 1.25 times 0.45 %."""
	found = rates([50 * (1 + 0.009 * speed) for speed in (4.0, 2.0, 1.0, 0.5)])
	limit = sentences.quasistatic(found)
	assert limit.value == pytest.approx(50e6) and limit.order == pytest.approx(1)
	assert sentences.slow_enough(found) == (
		"Loading (rate): as it slows down, strength tends to 50 MPa (order 1, itself within 0.56 %); 1 m/s as "
		"usual is 0.9 % above; 2 m/s is slow enough for 2 % and costs 0.5 times; 1 m/s is slow enough for 1 % "
		"and costs 1 times."
	)
	coarse = rates([50 * (1 + 0.08 * speed) for speed in (4.0, 2.0, 1.0, 0.5)])  # 4 % at 0.5 m/s
	assert (
		"none that was run is known to be slow enough for 2 %, which by these laws takes a speed 4 times lower "
		"and 4 times the cost"
	) in sentences.slow_enough(coarse)


def test_loading_that_does_not_settle_is_said_to():
	found = rates([54.0, 53.0, 52.0, 50.0])  # moves more and more
	assert sentences.quasistatic(found) is None
	assert sentences.slow_enough(found).endswith("none is known to be slow enough.")


def test_threads_are_told_by_the_clock():
	given = Ladder("threads", "threads", scene, each("threads", 1, 2), [STRENGTH])
	one, two = cost(4.0, ucs={"value": 7.0}), {**cost(4.4, ucs={"value": 7.0}), "wall_s": 2.4}
	found = points.of_ladder(given, [[one], [two]], "scene")
	said = (
		"threads 2 take 0.6 of its time by the clock (efficiency 83 %) and 1.1 of its processor time, for the "
		"same strength"
	)
	assert sentences.threads(found) == f"Against threads 1 of 500000 particles: {said}."
	wall, processors, ideal = figures.threads(found).axes[0].lines
	assert list(wall.get_xdata()) == [1, 2] and list(wall.get_ydata()) == [4.0, 2.4]
	assert list(processors.get_ydata()) == [4.0, 4.4] and list(ideal.get_ydata()) == [4.0, 2.0]
	assert figures.work_precision(found) is None and figures.threads(found[:1]) is None


def test_an_energy_that_depends_on_the_mesh_is_said_to():
	energy = Quantity("energy per volume", "crack energy", "J/m²", source="the point")
	given = Ladder("crack", "mesh size", scene, each("size", *SIZES), [energy], refined="size")
	entries = [{"value": 1e5 * size, "reference": 400.0, "error": abs(1e5 * size - 400) / 400} for size in SIZES]
	outcomes = [[cost(1.0, size, **{"energy per volume": entry})] for size, entry in zip(SIZES, entries)]
	found = points.of_ladder(given, outcomes, "scene")
	said = "From 8 mm to 1 mm energy per volume goes from 800 J/m² to 100 J/m², as size^1.00; the point: 400 J/m²."
	assert sentences.mesh_dependence(found) == said and said in sentences.all_of(found)
	line, right = figures.crack_energy(found).axes[0].lines
	assert list(line.get_ydata()) == pytest.approx([100, 200, 400, 800]) and right.get_ydata()[0] == 400


def test_marks_are_open_below_the_error_of_the_reference():
	"""The limit of a first order from 8, 4, 2 and 1 mm is known within 1.25 times the finest one's error, which is
	the only one that is smaller."""
	outcomes = [[cost(1e-9 * size**-3, size, ucs={"value": 100 * (1 - 10 * size)})] for size in SIZES]
	figure = figures.work_precision(points.of_ladder(ladder(STRENGTH), outcomes, "scene"))
	line, open_, _ = figure.axes[0].lines
	assert open_.get_markerfacecolor() == "white" and list(open_.get_ydata()) == pytest.approx([0.0125])
	assert list(line.get_ydata()) == pytest.approx([0.08, 0.04, 0.02, 0.0125])
	assert "below the error of the reference" in figure.legends[0].get_texts()[-1].get_text()
	known = figures.work_precision(points.of_ladder(ladder(), [[second_order(size)] for size in SIZES], "scene"))
	assert len(known.legends[0].get_texts()) == 1


def test_pictures_are_drawn_where_there_is_something():
	found = points.of_ladder(ladder(STRENGTH, seeds=(1, 2, 3)), [samples(size, 0.02) for size in SIZES], "scene")
	for figure in (figures.work_precision(found), figures.two_errors(found), figures.summary(found)):
		assert figure.axes[0].lines
	failed = points.of_ladder(ladder(), [["no"]] * 4, "scene")
	assert figures.work_precision(failed) is figures.two_errors(failed) is figures.summary(failed) is None


@pytest.mark.parametrize(
	"wrong, says", (
		({"kind": "colour"}, "kind 'colour' is unknown"), ({"rungs": ()}, "needs rungs"),
		({"refined": "h"}, "setting 'h'"),
		({"rungs": ({"size": 1.0}, {"size": 1.0})}, "same rung twice"),
		({"quantities": [Quantity("x", "taste")]}, "kind 'taste' is unknown"),
		({"usual": {"size": 2.0}}, "usual rung, 2000 mm, is none of its rungs"),
	)
)
def test_bad_ladders_are_refused(wrong, says):
	with pytest.raises(ValueError, match=says):
		Ladder(
			**{
				"name": "n", "kind": "mesh size", "scene": scene, "rungs": each("size", 1.0),
				"quantities": [DEFLECTION], **wrong
			}
		)


def test_ladders_are_found_by_name_and_scene():
	assert [found.name for found in find("kirsch")] == ["kirsch"]
	assert len(find("ucs")) > 4
	with pytest.raises(ValueError, match="no ladder 'beem'; there are cantilever"):
		find("beem")
	assert label({"size": 0.005, "values": {"equationOfState": False}}) == "5 mm, equationOfState off"


def test_coarser_settings_foretell_the_finest():
	"""Errors of second order, three of them; and nothing where there is no order."""
	made = [
		points.Point(
			"beam", "mesh size", "beam", "deflection", "displacement", "m", f"{1e3 * h:g} mm", {}, step=h,
			error=400 * h**2, cost={"cpu_s": h**-3 * 1e-9, "steps": 1 / h, "particles": h**-2}
		)
		for h in (0.008, 0.004, 0.002)
	]
	assert sentences.foretold(made) == (
		"By coarser settings 2 mm would have 0.16 % in deflection for 0.12 s (order 2); it has 0.16 % for "
		"0.12 s."
	)
	assert sentences.foretold(made[1:]) == "" == sentences.foretold([made[0], *made[:2]])
