# GPL v2 or later, see LICENSE.
"""Arithmetic of errors and costs, on laws that are known."""
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ddem.accuracy import convergence

SIZES = np.array([8.0, 4.0, 2.0, 1.0])


def test_digits():
	assert convergence.digits(0.01) == pytest.approx(2)
	assert convergence.digits(0) == math.inf and math.isnan(convergence.digits(math.nan))
	assert convergence.efficacy(0.01, 10) == pytest.approx(1)


@given(st.floats(-4, 4), st.floats(1e-6, 1e6))
def test_a_power_law_is_found(exponent, constant):
	found = convergence.power_law(SIZES, constant * SIZES**exponent)
	assert found == (pytest.approx(constant, rel=1e-9), pytest.approx(exponent, abs=1e-9))


def test_a_power_law_needs_two_points():
	for x, y in (([1], [1]), ([1, 1], [1, 2]), ([1, 2], [0, 1]), ([1, 2], [math.nan, 1])):
		assert all(map(math.isnan, convergence.power_law(x, y)))


def test_the_front_has_what_nothing_beats():
	seconds = [1, 2, 3, 4, 2, 5, 0.5, math.nan, 6]
	errors = [0.1, 0.05, 0.06, 0.01, 0.05, 0.02, math.nan, 1e-9, 0.01]
	assert convergence.front(seconds, errors) == [0, 1, 3]


@given(st.lists(st.tuples(st.floats(0.1, 10), st.floats(1e-4, 1)), min_size=1, max_size=20))
def test_the_front_is_what_its_definition_says(points):
	seconds, errors = zip(*points)
	found = convergence.front(seconds, errors)
	beaten = lambda i: any(
		s <= seconds[i] and e <= errors[i] and (s < seconds[i] or e < errors[i]) for s, e in points
	)
	assert {points[i] for i in found} == {points[i] for i in range(len(points)) if not beaten(i)}
	assert [errors[i] for i in found] == sorted((errors[i] for i in found), reverse=True)


@pytest.mark.parametrize("order", (1, 1.7, 2, 3.5))
@pytest.mark.parametrize("sizes", ((4.0, 2.0, 1.0), (3.0, 2.0, 1.0), (1.0, 5.0, 2.5)))
def test_richardson_finds_limit_and_order(order, sizes):
	values = [7 - 0.3 * size**order for size in sizes]
	limit = convergence.richardson(sizes, values)
	assert limit.value == pytest.approx(7, rel=1e-8) and limit.order == pytest.approx(order, rel=1e-7)
	assert limit.error == pytest.approx(1.25 * 0.3, rel=1e-6)  # of the finest, whose h is 1


def test_richardson_is_careful_where_there_is_no_order():
	assert convergence.richardson((4, 2, 1), (1.0, 1.2, 1.1)).error == pytest.approx(0.6)  # it turns back
	assert convergence.richardson((4, 2, 1), (1.0, 1.1, 1.3)).order != 1  # it runs away
	assert convergence.richardson((4, 2, 1), (5.0, 5.0, 5.0)) == convergence.Limit(
		5.0, pytest.approx(math.nan, nan_ok=True), 0
	)
	with pytest.raises(ValueError, match="three different sizes, and there are 2"):
		convergence.richardson((4, 2, 2), (1, 2, 3))


def test_the_size_where_scatter_hides_the_mesh():
	error, scatter = 0.02 * SIZES, 0.05 * SIZES**0
	assert convergence.crossing(SIZES, error, scatter) == pytest.approx(2.5)
	assert convergence.crossing(SIZES, error, 0.01 * SIZES**0.5) == pytest.approx(0.25)
	assert convergence.crossing(SIZES, error, 1e-6 * SIZES**0) is None  # far below what was run
	assert convergence.crossing(SIZES, 0.02 / SIZES, scatter) is None  # the error grows with refinement


def test_cost_of_an_error():
	seconds, errors = [1.0, 10.0, 100.0, 50.0], [0.1, 0.01, 0.001, 0.5]
	assert convergence.cost_of(0.2, seconds, errors) == (1.0, True)
	assert convergence.cost_of(0.03162277660168379, seconds, errors) == (pytest.approx(10**0.5), True)
	assert convergence.cost_of(1e-4, seconds, errors) == (pytest.approx(1000), False)
	assert math.isnan(convergence.cost_of(0.01, [], [])[0])
	assert math.isnan(convergence.cost_of(0.01, [1.0], [0.1])[0])  # one setting has no slope
