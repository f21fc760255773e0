# GPL v2 or later, see LICENSE.
# Options and markers shared by all Python tests.
import hypothesis
import pytest

# Slow or fast, a machine must give the same result.
hypothesis.settings.register_profile(
	'any machine', deadline=None, suppress_health_check=[hypothesis.HealthCheck.too_slow]
)
hypothesis.settings.load_profile('any machine')


def pytest_addoption(parser):
	parser.addoption('--all', action='store_true', help='run the slow tests as well')


def pytest_configure(config):
	config.addinivalue_line('markers', 'slow: minutes rather than seconds; only with --all')


def pytest_collection_modifyitems(config, items):
	if config.getoption('--all'):
		return
	slow = [item for item in items if item.get_closest_marker('slow')]
	if slow:
		config.hook.pytest_deselected(items=slow)
		items[:] = [item for item in items if item not in slow]
