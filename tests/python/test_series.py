# GPL v2 or later, see LICENSE.
"""Time series and their CSV files."""
import numpy as np
import pytest
from ddem.series import Series
from hypothesis import given
from hypothesis import strategies as st

NUMBERS = st.floats(allow_nan=False)


@given(st.lists(st.tuples(NUMBERS, NUMBERS)))
def test_round_trip_keeps_every_digit(tmp_path_factory, rows):
	path = tmp_path_factory.mktemp("series") / "series.csv"
	series = Series(time="s", stress="Pa")
	for time, stress in rows:
		series.append(time=time, stress=stress)
	series.write(path)
	again = Series.read(path)
	assert again.units == {"time": "s", "stress": "Pa"}
	assert len(again) == len(rows)
	for name in again.units:
		np.testing.assert_array_equal(again[name], series[name])


def test_header_names_columns_with_units(tmp_path):
	series = Series(strain="-", speed="m/s", density="kg/m³")
	series.append(strain=0.5, speed=1, density=2400)
	series.write(tmp_path / "series.csv")
	lines = (tmp_path / "series.csv").read_text(encoding="utf-8").splitlines()
	assert lines[:2] == ["strain [-],speed [m/s],density [kg/m³]", "0.5,1.0,2400.0"]
	assert len(lines) == 3 and lines[2].startswith("# provenance: ")


def test_columns():
	series = Series(time="s", stress="Pa")
	series.append(stress=1e6, time=0)
	series.append(time=1, stress=2e6)
	assert series["stress"].tolist() == [1e6, 2e6]
	assert series.last("time") == 1
	with pytest.raises(KeyError, match="no column 'strain'; it has time, stress"):
		series["strain"]


@pytest.mark.parametrize("row", [{"time": 1}, {"time": 1, "stress": 2, "strain": 3}])
def test_rows_must_fit_the_columns(row):
	series = Series(time="s", stress="Pa")
	with pytest.raises(ValueError, match="columns time, stress"):
		series.append(**row)
	assert len(series) == 0


@pytest.mark.parametrize("text, message", [
	("", "line 1"),
	("time,stress [Pa]\n0,1\n", "line 1: the header"),
	("time [s],time [s]\n", "line 1: a column is named twice"),
	("time [s],stress [Pa]\n0,1\n1\n", "line 3: 1 fields where the header has 2"),
	("time [s],stress [Pa]\n0,much\n", "line 2: could not convert"),
])
def test_damaged_files_name_the_line(tmp_path, text, message):
	path = tmp_path / "series.csv"
	path.write_text(text)
	with pytest.raises(ValueError, match=f"series.csv, {message}"):
		Series.read(path)
