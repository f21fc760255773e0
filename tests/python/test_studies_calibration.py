# GPL v2 or later, see LICENSE.
"""Calibration of models whose answer is known in closed form: what it finds, how few evaluations it takes, and what it
says when there is nothing to find."""
import math

import numpy as np
import pytest
from ddem.studies.calibration import Calibration, Parameter, Step, Target
from ddem.studies.calibration_quantities import TUNABLES, parameters, starts, usual
from ddem.studies.evaluations import Bench, EvaluationError, Point

STIFFNESS = Parameter("E", 50e9, 5e9, 500e9, {"young": 1})
COHESION = Parameter("C", 50e6, 5e6, 500e6, {"ucs": 1, "tensile": 1})
ANGLE = Parameter("phi", 0.785, 0.17, 1.3)
TARGETS = [Target("young", 40e9, 0.02), Target("ucs", 60e6, 0.02)]
TENSILE = Target("tensile", 6e6, 0.02)


def proportional(values, case):
	return {"young": 0.6 * values["E"], "ucs": 0.8 * values["C"]}


def power_laws(values, case):
	"""Elasticities 1, 0 of young; 0.08, 0.9, 0.3 of ucs; 0.02, 1, -1 of tensile."""
	phi = values.get("phi", 0.785) / 0.785
	stiff, strong = values["E"] / 66e9, values["C"] / 75e6
	return {
		"young": 40e9 * stiff,
		"ucs": 58e6 * stiff**0.08 * strong**0.9 * phi**0.3,
		"tensile": 7.4e6 * stiff**0.02 * strong / phi,
	}


def calibrate(
	model, tuned=(STIFFNESS, COHESION), targets=TARGETS, path=None, budget=60, cases=({},), **options
):
	with Bench(model, cases, path=path, budget=budget) as bench:
		outcome = Calibration(tuned, targets, bench, **options).run()
	return outcome, bench


def assert_met(outcome, targets=TARGETS):
	assert outcome.reached and outcome.why == []
	for target in targets:
		assert outcome.best.measured[target.name] == pytest.approx(target.value, rel=target.tolerance)


def test_scaling_laws_need_two_evaluations():
	outcome, bench = calibrate(proportional, sensitivities=False)
	assert_met(outcome)
	assert bench.ran == 2
	assert outcome.best.values["E"] == pytest.approx(40e9 / 0.6, rel=1e-5)
	assert outcome.best.values["C"] == pytest.approx(60e6 / 0.8, rel=1e-5)
	assert outcome.elasticities is None


def test_known_parameters_are_found_again():
	truth = {"E": 91e9, "C": 123e6, "phi": 0.6}
	targets = [Target(name, value, 1e-4) for name, value in power_laws(truth, {}).items()]
	outcome, bench = calibrate(power_laws, (STIFFNESS, COHESION, ANGLE), targets)
	assert_met(outcome, targets)
	for name, value in truth.items():
		assert outcome.best.values[name] == pytest.approx(value, rel=3e-4)
	assert bench.ran <= 12


def test_elasticities_are_the_exponents():
	outcome, _ = calibrate(power_laws, (STIFFNESS, COHESION, ANGLE), [*TARGETS, TENSILE])
	assert_met(outcome, [*TARGETS, TENSILE])
	# six digits of the parameters
	assert outcome.elasticities == pytest.approx(np.array([[1, 0, 0], [0.08, 0.9, 0.3], [0.02, 1, -1]]), abs=1e-4)
	assert (outcome.errors < 1e-4).all()
	outcome, bench = calibrate(proportional)  # the search needed none: measured in the end, two more
	assert outcome.elasticities == pytest.approx(np.eye(2), abs=1e-4)
	assert bench.ran == 4


def test_elasticities_are_those_at_the_point_found():
	"""The exponent of C grows from 0.5 at the start to 1 at the solution, three times as far."""
	curved = lambda v, _: {
		"young": 0.6 * v["E"],
		"ucs": 60e6 * math.exp(math.log(v["C"] / 60e6) + 0.23 * math.log(v["C"] / 60e6)**2),
	}
	outcome, _ = calibrate(curved, (STIFFNESS, Parameter("C", 20e6, 5e6, 500e6)))
	assert_met(outcome)
	assert outcome.elasticities[1, 1] == pytest.approx(1, abs=0.06)


def test_errors_of_elasticities_are_those_that_scatter_makes():
	"""Of many samples of a plane with scatter, elasticities lie about the true ones as widely as their
	standard errors say."""
	found, errors = [], []
	for seed in range(400):
		random = np.random.default_rng(seed)
		search = Calibration((STIFFNESS, COHESION), TARGETS, None)
		for number, (stiff, strong) in enumerate(random.uniform(-0.1, 0.1, (8, 2))):
			measured = {
				"young": 40e9 * math.exp(stiff),
				"ucs": 60e6 * math.exp(0.1 * stiff + 0.9 * strong + 0.01 * random.normal()),
			}
			point = Point({"E": 50e9 * math.exp(stiff), "C": 50e6 * math.exp(strong)}, measured, {})
			search.steps.append(Step(number, "search", point))
		_, elasticities, error = search.response(np.log([50e9, 50e6]))
		found.append(elasticities[1])
		errors.append(error[1])
		assert elasticities[0] == pytest.approx([1, 0]) and error[0] == pytest.approx(0, abs=1e-9)
	assert np.mean(found, axis=0) == pytest.approx([0.1, 0.9], abs=0.03)
	assert np.sqrt(np.mean(np.square(errors), axis=0)) == pytest.approx(np.std(found, axis=0), rel=0.15)


def test_points_far_away_count_less():
	"""y = x + x² has the slope 1 at 0; a plane through points of equal weight would take it
	from those at 0.5 and 1."""
	search = Calibration((COHESION, ), TARGETS[1:], None)
	for number, x in enumerate([-0.05, 0, 0.05, 0.5, 1.0]):
		search.steps.append(
			Step(number, "search", Point({"C": 50e6 * math.exp(x)}, {"ucs": 60e6 * math.exp(x + x**2)}, {}))
		)
	misses, slopes, _ = search.response(np.log([50e6]))
	assert misses == pytest.approx(0, abs=0.005)
	assert slopes == pytest.approx(1, abs=0.25)


def test_curved_response_is_followed_in_few_steps():
	"""Both strengths of a prism of spheres over the friction angle of its bonds, a parabola through what was
	measured at 15, 45 and 70 degrees."""
	angles = np.log(np.array([15, 45, 70]) / 45)
	ucs, tensile = (
		np.polyfit(angles, np.log(values), 2) for values in ([92.1e6, 60.7e6, 31.2e6], [45.9e6, 21.6e6, 9.8e6])
	)

	def spheres(values, case):
		angle, strong = math.log(values["phi"] / 0.785), values["C"] / 42e6
		return {
			"young": 1.3 * values["E"],
			"ucs": strong * math.exp(np.polyval(ucs, angle)),
			"tensile": strong * math.exp(np.polyval(tensile, angle)),
		}

	for wanted in (26e6, 24e6, 19e6):
		targets = [*TARGETS, Target("tensile", wanted, 0.02)]
		outcome, bench = calibrate(spheres, (STIFFNESS, COHESION, ANGLE), targets)
		assert_met(outcome, targets)
		assert bench.ran <= 12


def test_finite_difference_that_meets_the_targets_ends_the_search():
	start = Parameter("C", 60e6 / 0.8 / 1.08, 5e6, 500e6)  # no law; 8 % above is the solution
	outcome, bench = calibrate(proportional, (Parameter("E", 40e9 / 0.6, 5e9, 500e9), start))
	assert_met(outcome)
	assert (bench.ran, outcome.steps[-1].purpose) == (3, "sensitivity")
	assert outcome.elasticities == pytest.approx(np.eye(2), abs=1e-4)


def test_sensitivities_at_a_bound_look_to_the_other_side():
	outcome, _ = calibrate(proportional, (STIFFNESS, Parameter("C", 70e6, 5e6, 75.5e6, {"ucs": 1})))
	assert_met(outcome)
	tried = [step.point.values["C"] for step in outcome.steps if step.parameter == "C"]
	assert tried == [pytest.approx(75e6 / 1.08, rel=1e-4)]
	assert outcome.elasticities == pytest.approx(np.eye(2), abs=1e-4)


def test_laws_are_no_necessity():
	plain = [Parameter(p.name, p.start, p.lower, p.upper) for p in (STIFFNESS, COHESION)]
	outcome, bench = calibrate(power_laws, plain)
	assert_met(outcome)
	assert bench.ran <= 8


def test_strongly_curved_model():
	outcome, bench = calibrate(
		lambda v, _: {"young": 0.6 * v["E"], "ucs": 100e6 * (1 - math.exp(-((v["C"] / 60e6)**2)))}
	)
	assert_met(outcome)
	assert bench.ran <= 12


def test_more_parameters_than_targets_move_as_little_as_they_can():
	outcome, _ = calibrate(
		lambda v, _: {"young": 0.6 * v["E"] * v["C"] / 50e6, "other": 1.0},
		(STIFFNESS, COHESION, ANGLE),
		TARGETS[:1],
	)
	assert_met(outcome, TARGETS[:1])
	assert outcome.best.values["phi"] == pytest.approx(ANGLE.start)


@pytest.mark.parametrize("seed", range(5))
def test_noise_as_of_breaking_bonds(seed):
	"""1.5 % of scatter in the strength, different at every point and the same whenever that point is asked for;
	three samples are averaged."""

	def noisy(values, case):
		random = np.random.default_rng([int(values["E"]), int(values["C"]), case["seed"], seed])
		measured = power_laws(values, case)
		return {
			"young": measured["young"] * (1 + 0.001 * random.normal()),
			"ucs": measured["ucs"] * (1 + 0.015 * random.normal()),
		}

	outcome, bench = calibrate(noisy, cases=[{"seed": k} for k in range(3)])
	assert_met(outcome)
	assert 0 < outcome.best.scatter["ucs"] < 0.06 * 60e6
	assert bench.ran <= 45


@pytest.mark.parametrize("seed", range(5))
def test_targets_that_answer_nearly_alike_under_noise(seed):
	"""As measured on a prism of spheres: with the friction angle of the bonds both strengths fall, by elasticities
	that differ by 0.3, and a strength scatters by 1.7 % between neighbouring parameters. The ratio of the
	strengths, 2.8 at 45°, is to become 2.5."""

	def spheres(values, case):
		random = np.random.default_rng([int(values["E"]), int(values["C"]), int(1e6 * values["phi"]), seed])
		strong, angle = values["C"] / 42e6, values["phi"] / 0.785
		return {
			"young": 40e9 * values["E"] / 30.4e9,
			"ucs": 60.7e6 * strong * angle**-0.9 * (1 + 0.017 * random.normal()),
			"tensile": 21.6e6 * strong * angle**-1.2 * (1 + 0.005 * random.normal())
		}

	targets = [*TARGETS, Target("tensile", 24e6, 0.05)]
	outcome, bench = calibrate(spheres, (STIFFNESS, COHESION, ANGLE), targets)
	assert_met(outcome, targets)
	assert bench.ran <= 30


def test_steps_that_fail_are_avoided():
	"""Nothing works above C = 70 MPa, where the first step by the scaling laws leads."""

	def fragile(values, case):
		if values["C"] > 70e6:
			raise EvaluationError("the specimen did not fail")
		return {"young": 0.6 * values["E"], "ucs": 60e6 * (values["C"] / 65e6)**3}

	start = Parameter("C", 40e6, 5e6, 500e6, {"ucs": 1})
	outcome, bench = calibrate(fragile, (STIFFNESS, start))
	assert bench.failed > 0
	assert_met(outcome)


FURTHER = "keeps it from going further"


@pytest.mark.parametrize(
	"model, tuned, targets, sentence, hit",
	[
		(
			lambda E, C: {"young": 0.6 * E, "ucs": 0.05 * C},
			(STIFFNESS, COHESION),
			TARGETS,
			f"the upper bound of C, 5e+08, {FURTHER}",
			{"C": "upper"},
		),
		(
			lambda E, C: {"young": 6 * E, "ucs": 0.8 * C * (E / 5e9)**0.2},
			(Parameter("E", 50e9, 10e9, 500e9, {"young": 1}), COHESION),
			TARGETS,
			f"the lower bound of E, 1e+10, {FURTHER}",
			{"E": "lower"},
		),
		(
			lambda E, C: {"young": 0.6 * E, "ucs": 30e6},
			(STIFFNESS, COHESION),
			TARGETS,
			"no tuned parameter moves ucs",
			{},
		),
		(
			lambda E, C: {"young": 0.6 * E, "ucs": 0.8 * C, "tensile": 0.12 * C},
			(STIFFNESS, COHESION),
			[*TARGETS, TENSILE],
			"ucs and tensile answer alike to the tuned parameters",
			{},
		),
		(lambda E: {"young": 0.6 * E, "ucs": E / 1e3}, (STIFFNESS,), TARGETS, "young and ucs answer alike", {}),
	],
)
def test_target_out_of_reach(model, tuned, targets, sentence, hit):
	outcome, bench = calibrate(lambda values, _: model(**values), tuned, targets)
	assert not outcome.reached
	assert any(sentence in reason for reason in outcome.why), outcome.why
	assert {name: side for name, side in outcome.hit.items() if name in hit} == hit
	assert bench.ran <= 20


def test_nearest_point_is_given():
	outcome, _ = calibrate(lambda v, _: {"young": 0.6 * v["E"], "ucs": 0.05 * v["C"]})
	assert outcome.best.values["C"] == pytest.approx(500e6)
	assert outcome.best.measured["ucs"] == pytest.approx(25e6)
	assert outcome.best.measured["young"] == pytest.approx(40e9, rel=0.02)


def test_three_targets_two_parameters():
	outcome, _ = calibrate(power_laws, (STIFFNESS, COHESION), [*TARGETS, Target("tensile", 9e6, 0.02)])
	assert not outcome.reached
	# between both strengths, weighted alike: ucs must miss by as much as tensile, within the curvature
	ucs, tensile = (
		abs(math.log(outcome.best.measured[name] / value)) for name, value in (("ucs", 60e6), ("tensile", 9e6))
	)
	assert ucs == pytest.approx(tensile, rel=0.3)


def test_failure_at_the_start_is_said():
	def broken(values, case):
		raise EvaluationError("no specimen")

	outcome, bench = calibrate(broken)
	assert (outcome.reached, outcome.best, bench.ran) == (False, None, 1)
	assert outcome.why == ["the first evaluation failed: no specimen"]


def test_failure_on_both_sides_is_said():
	def island(values, case):
		if abs(values["C"] / 50e6 - 1) > 0.01:
			raise EvaluationError("no specimen")
		return {"young": 0.6 * values["E"], "ucs": 30e6}

	outcome, _ = calibrate(island)
	assert not outcome.reached
	assert "both sides of C" in outcome.why[0] and "no specimen" in outcome.why[0]
	assert outcome.elasticities is None
	assert outcome.best.measured["ucs"] == 30e6


def test_budget_is_kept():
	outcome, bench = calibrate(lambda v, _: {"young": 0.6 * v["E"], "ucs": 0.05 * v["C"]}, budget=3)
	assert bench.ran <= 3
	assert (outcome.reached, outcome.why) == (False, ["3 evaluations are used up"])
	assert outcome.best is not None


def test_measure_that_is_not_positive_is_a_failure():
	outcome, _ = calibrate(lambda v, _: {"young": 0.6 * v["E"], "ucs": -1.0})
	assert not outcome.reached and "a measure is not positive" in outcome.why[0]


def test_repeated_start_takes_everything_from_the_file(tmp_path):
	first, bench = calibrate(power_laws, path=tmp_path / "e")
	second, again = calibrate(lambda *_: pytest.fail("evaluated again"), path=tmp_path / "e")
	assert (again.ran, again.reused) == (0, bench.ran)
	assert second.best.values == first.best.values
	assert [step.point.values for step in second.steps] == [step.point.values for step in first.steps]
	assert np.array_equal(second.elasticities, first.elasticities)


@pytest.mark.parametrize("after", range(1, 4))
def test_interrupted_search_goes_on(tmp_path, after):
	whole, bench = calibrate(power_laws, path=tmp_path / "whole")
	asked = []

	def interrupted(values, case):
		if len(asked) == after:
			raise KeyboardInterrupt
		asked.append(values)
		return power_laws(values, case)

	with pytest.raises(KeyboardInterrupt):
		calibrate(interrupted, path=tmp_path / "e")
	resumed, rest = calibrate(power_laws, path=tmp_path / "e")
	assert (rest.ran, rest.reused) == (bench.ran - after, after)
	assert resumed.best.values == whole.best.values


def test_every_point_is_told_once():
	told = []
	outcome, bench = calibrate(power_laws, tell=told.append)
	assert told == outcome.steps
	assert [step.number for step in told] == list(range(1, len(told) + 1))
	assert len({tuple(step.point.values.items()) for step in told}) == len(told) == bench.ran
	assert told[0].purpose == "start" and {step.parameter for step in told if step.purpose == "sensitivity"} == {
		"E",
		"C",
	}


@pytest.mark.parametrize("make, message", [
	(lambda: Parameter("E", 0, 1, 2), "positive and finite"),
	(lambda: Parameter("E", 3, 1, 2), "the start, 3, must lie between the bounds, 1 and 2"),
	(lambda: Parameter("E", 1, 2, 1), "lower bound, 2, must be below"),
	(lambda: Parameter("E", 1, 1, math.inf), "positive and finite"),
	(lambda: Target("ucs", -60e6, 0.02), "target ucs = -60000000.0 must be positive"),
	(lambda: Target("ucs", 60e6, 2), "0.02 for 2 %"),
	(lambda: Calibration([], TARGETS, None), "at least one parameter"),
	(lambda: Calibration([STIFFNESS, STIFFNESS], TARGETS, None), "given twice"),
	(lambda: Calibration([STIFFNESS], TARGETS, None, step=0), "step = 0"),
	(
		lambda: calibrate(proportional, targets=[Target("hardness", 1, 0.1)]),
		"nothing measures the target hardness; there are young, ucs",
	),
])
def test_bad_input(make, message):
	with pytest.raises(ValueError, match=message):
		make()


# ---- quantities ----


def test_start_by_scaling_laws_keeps_ratios_of_moduli():
	material = {
		"young": 80e9, "poisson": 0.2, "bulk": 44e9, "shear": 33e9, "strength": 140e6, "friction": 0.66,
		"fractureEnergy": 80e3
	}
	start = starts("deformable", {"young": 40e9, "ucs": 50e6}, material)
	assert (start["young"], start["bulk"], start["shear"]) == (40e9, 22e9, 16.5e9)
	assert start["strength"] == 100e6
	assert start["friction"] == 0.66


def test_what_is_tuned_when_nobody_says():
	assert usual("rigid", {"young": 1, "ucs": 1}) == ["young", "cohesion"]
	assert usual("rigid", {"ucs": 1, "tensile": 1}) == ["cohesion", "bondFrictionAngle"]
	assert usual("deformable", {"tensile": 1}) == ["strength"]


@pytest.mark.parametrize("model, names, message", [
	("rigid", ["youngs"], "'youngs' cannot be tuned in the rigid model; there are young"),
	("deformable", ["young", "bulk"], "say the same twice"),
	("rigid", ["tensileStrength"], "tensileStrength has no finite value to start from")
])
def test_parameters_that_cannot_be_tuned(model, names, message):
	start = {name: 1.0 for name in TUNABLES[model]}
	start["tensileStrength"] = math.inf
	with pytest.raises(ValueError, match=message):
		parameters(model, names, start)


def test_bounds():
	made = parameters(
		"rigid",
		["cohesion", "bondFrictionAngle"],
		{"cohesion": 40e6, "bondFrictionAngle": 0.7},
		{"cohesion": (10e6, 90e6)},
	)
	assert (made[0].lower, made[0].upper) == (10e6, 90e6)
	assert (math.degrees(made[1].lower), math.degrees(made[1].upper)) == (5, pytest.approx(75))
