# GPL v2 or later, see LICENSE.
"""These tests run inside YADE; each gets a scene of its own."""
import pytest

from yade import O


@pytest.fixture(autouse=True)
def fresh_scene():
	O.reset()
	yield
	if O.running:
		O.pause()
		O.wait()
	O.reset()
