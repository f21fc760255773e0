# GPL v2 or later, see LICENSE.
"""Stresses at the centre of a disc against Hertz, and against sums of Flamant's forces."""
import math

import pytest
from ddem.disc_stress import hondros, pressed


def test_narrow_jaws_tend_to_line_loads():
	"""Hertz: 2P/(πDt) across, three times as much along."""
	assert hondros(1e-3) == pytest.approx((1, -3), abs=1e-6)
	assert pressed(1e-3) == pytest.approx((1, -3), abs=1e-6)
	# to the second order in α: 1 - 7/6 α² and 1 - 9/4 α²
	alpha = math.radians(5)
	assert hondros(10)[0] == pytest.approx(1 - 7 / 6 * alpha**2, abs=alpha**4)
	assert pressed(10)[0] == pytest.approx(1 - 9 / 4 * alpha**2, abs=2 * alpha**4)


def test_pressure_of_flat_ends_of_20_degrees_leaves_0_96():
	"""sin 20° = 0.34202, π/18 = 0.17453, sin 10° = 0.17365; for 30° it is 0.92, and less still under rigid jaws."""
	assert hondros(20)[0] == pytest.approx((0.34202 - 0.17453) / 0.17365, abs=1e-4)
	assert hondros(20)[0] == pytest.approx(0.9645, abs=1e-4)
	assert hondros(30)[0] == pytest.approx((0.5 - 0.26180) / 0.25882, abs=1e-4)
	assert pressed(30)[0] < hondros(30)[0] < hondros(20)[0]
