# GPL v2 or later, see LICENSE.
"""Strength, Young's modulus and stages of stress–strain curves whose answers are known."""
import math

import numpy as np
import pytest
from ddem.studies import measures
from hypothesis import given
from hypothesis import strategies as st

YOUNG, PEAK = 40e9, 0.002


def brittle(rows=401, young=YOUNG, peak=PEAK, rest=0.1):
	"""Straight up to the peak, straight down to *rest* of it at twice the strain, constant after that."""
	strain = np.linspace(0, 4 * peak, rows)
	return strain, np.where(
		strain <= peak, young * strain, np.maximum(rest, 1 - (1 - rest) * (strain / peak - 1)) * young * peak
	)


def test_brittle_curve():
	found = measures.strength(*brittle())
	assert found.ucs == pytest.approx(YOUNG * PEAK)
	assert found.strain_at_peak == pytest.approx(PEAK)
	assert found.young == pytest.approx(YOUNG)
	assert found.offset == pytest.approx(0, abs=1e-6 * found.ucs)
	assert found.peaked


def test_slope_is_taken_between_a_fifth_and_three_fifths_only():
	# E = 2 below a fifth of the strength, 1 from there to three fifths, then 0.5: only the middle counts.
	stress = np.array([0, 20, 60, 100, 0.0])
	strain = np.array([0, 10, 50, 130, 140.0])
	fine = np.linspace(0, 140, 1401)
	found = measures.strength(fine, np.interp(fine, strain, stress))
	assert found.young == pytest.approx(1)
	assert (fine[found.fit[0]], fine[found.fit[1]]) == pytest.approx((10, 50))
	assert found.offset == pytest.approx(10)


def test_parabola_has_the_slope_of_its_secant():
	# The least-squares slope of a parabola over an interval is that of the chord:
	# for s = 2x - x², from s = 0.2 to 0.6, 2 - (x1 + x2).
	x = np.linspace(0, 2, 20001)
	first, last = (1 - math.sqrt(1 - s) for s in (0.2, 0.6))
	assert measures.strength(x, 2 * x - x**2).young == pytest.approx(2 - first - last, rel=1e-3)


@given(st.integers(0, 2**32 - 1))
def test_noise_of_one_per_cent(seed):
	strain, stress = brittle()
	noisy = stress + 0.01 * YOUNG * PEAK * np.random.default_rng(seed).normal(size=len(stress))
	found = measures.strength(strain, noisy)
	# largest of some ten values near the peak: up to four standard deviations above it
	assert YOUNG * PEAK * 0.97 < found.ucs < YOUNG * PEAK * 1.045
	assert found.strain_at_peak == pytest.approx(PEAK, rel=0.06)
	# 40 points over 0.4 of the strength: standard error of the slope 0.01/(0.4·√(40/12)) = 1.4 %
	assert found.young == pytest.approx(YOUNG, rel=0.08)


def test_wave_on_the_way_down_does_not_enter_the_slope():
	strain, stress = brittle()
	stress[300:] += 0.2 * stress.max() * np.sin(np.arange(101))
	assert measures.strength(strain, stress).young == pytest.approx(YOUNG)


def test_curve_without_a_peak_says_so():
	strain = np.linspace(0, 1e-3, 50)
	found = measures.strength(strain, YOUNG * strain)
	assert (found.ucs, found.peak) == (YOUNG * 1e-3, 49)
	assert found.young == pytest.approx(YOUNG)
	assert not found.peaked


def test_softening_by_less_than_a_tenth_is_no_peak_yet():
	strain, stress = brittle(rest=0.92)
	assert not measures.strength(strain, stress).peaked
	assert measures.strength(strain, stress, fall=0.95).peaked


def test_too_few_records_give_no_modulus_but_a_strength():
	found = measures.strength([0, 1, 2, 3], [0, 10, 100, 5])
	assert found.ucs == 100
	assert math.isnan(found.young)


def test_offset_of_the_start_does_not_change_the_slope():
	strain, stress = brittle()
	assert measures.strength(strain + 3e-4, stress).young == pytest.approx(YOUNG)


@pytest.mark.parametrize("strain, stress, message", [
	([0, 1], [0, 1, 2], "equal length"),
	([0], [1], "at least 2"),
	([0, math.nan, 2], [0, 1, 2], "record 1"),
	([0, 1, 2], [0, 1, math.inf], "record 2"),
	([0, 1, 2], [0, -1, -2], "never carried a load"),
	([0, 1, 2], [0, 0, 0], "never carried a load"),
])
def test_bad_curves(strain, stress, message):
	with pytest.raises(ValueError, match=message):
		measures.strength(strain, stress)


@pytest.mark.parametrize("fit", [(0.6, 0.2), (0, 0.5), (0.5, 1)])
def test_bad_fit(fit):
	with pytest.raises(ValueError, match="fit"):
		measures.strength(*brittle(), fit=fit)


def test_stages_of_a_test():
	strain, stress = brittle()
	rows = measures.instants(strain, stress)
	assert stress[rows] / stress.max() == pytest.approx([0.7, 1, 0.7, 0.4, 0.1], abs=0.01)
	assert rows[-1] == len(stress) - 1


def test_stages_of_a_test_that_ends_at_the_peak():
	assert measures.instants(np.arange(11), np.arange(11)) == [7, 10]
