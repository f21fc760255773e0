# GPL v2 or later, see LICENSE.
"""A test gives the same on a slow, a fast and a busy machine: none looks at the clock."""
import pathlib
import re

TESTS = pathlib.Path(__file__).resolve().parents[1]
CLOCKS = re.compile(
	r'sleep\(|sleep [1-9]|sleep_for|timeout *=|deadline *=(?!None)|'
	r'perf_counter|monotonic|time\.time\(|process_time|datetime\.now|chrono::|'
	r'realPeriod\W+(?!1e-9\b)\w'  # which has gone by at every look
)
EXCEPT = {TESTS / 'waiting.py', pathlib.Path(__file__).resolve()}


def test_no_test_looks_at_the_clock():
	paths = [path for ending in ('py', 'cpp', 'hpp') for path in sorted(TESTS.rglob(f'*.{ending}'))]
	files = [path for path in paths if path not in EXCEPT]
	lines = [(path, number, line) for path in files for number, line in enumerate(path.read_text().splitlines(), 1)]
	assert len(files) > 50
	assert [f'{path}:{number}: {line.strip()}' for path, number, line in lines if CLOCKS.search(line)] == []
