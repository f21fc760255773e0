# GPL v2 or later, see LICENSE.
"""Rungs that nobody has run: power laws through those that were."""
from dataclasses import replace

import pytest
from ddem.accuracy.points import Point
from ddem.accuracy.prediction import Laws, predict


def point(step, error, cpu_s, memory=1.0):
	return Point(
		"beam", "mesh size", "beam", "deflection", "displacement", "m", f"{step}", {}, step=step, error=error,
		cost={"cpu_s": cpu_s, "memory_MB": memory}
	)


#: error 3 h², processor time h⁻³, memory h⁻²
KNOWN = [point(h, 3 * h**2, h**-3, h**-2) for h in (0.4, 0.2, 0.1)]


def test_power_laws_are_found_again():
	laws = Laws(KNOWN)
	found = laws.at(0.05)
	assert (found.error, found.cpu_s, found.memory_MB) == pytest.approx((3 * 0.05**2, 8000, 400))
	assert found.order == pytest.approx(2) and found.settled
	assert laws.reaching(3e-4).step == pytest.approx(0.01) == predict(KNOWN, 3e-4).step


def test_the_finest_two_count_and_an_order_that_changes_is_told():
	changing = [point(0.4, 3.0, 1), *KNOWN[1:]]
	assert Laws(changing).at(0.05).error == pytest.approx(3 * 0.05**2) and not Laws(changing).settled


def test_what_failed_or_has_no_error_does_not_count():
	bad = Point("beam", "mesh size", "beam", "deflection", "displacement", "m", "0.05", {}, step=0.05, failed="no")
	assert Laws([*KNOWN, bad]).best.step == 0.1


@pytest.mark.parametrize("points, message", [
	(KNOWN[:1], "needs two rungs with an error, and there are 1"), ([], "there are 0"),
	([point(0.2, 0.1, 1), point(0.1, 0.1, 8)], "do not fall"),
	([point(0.2, 0.2, 8), point(0.1, 0.1, 1)], "do not fall with what they cost"),
])
def test_what_has_no_order_is_refused(points, message):
	with pytest.raises(ValueError, match=message):
		Laws(points)
	assert predict(points, 1e-6) is None


def test_what_is_good_enough_is_not_predicted():
	assert predict(KNOWN, 0.5) is None


def test_time_is_steps_times_the_time_of_a_step():
	"""Particles h⁻², steps h⁻¹; a step takes 1 µs and 20 ns a particle, which coarse samples hardly show."""
	points = [
		replace(
			point(h, 3 * h**2, h**-1 * (1e-6 + 20e-9 * h**-2)),
			cost={
				"cpu_s": h**-1 * (1e-6 + 20e-9 * h**-2),
				"memory_MB": 1.0,
				"steps": h**-1,
				"particles": h**-2,
			}
		)
		for h in (0.4, 0.2)
	]
	assert Laws(points).at(0.01).cpu_s == pytest.approx(100 * (1e-6 + 20e-9 * 1e4))
	# a count that an irregular mesh throws off a little is taken for the whole power
	points[0].cost["particles"] *= 1.15
	assert Laws(points).at(0.01).cpu_s == pytest.approx(100 * (1e-6 + 20e-9 * 1e4), rel=0.3)
