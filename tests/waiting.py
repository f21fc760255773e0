# GPL v2 or later, see LICENSE.
"""Waiting in tests: for what must come, however slow the machine; scripts/setup/tests.sh ends a test that hangs."""
import os
import time


def until(condition):
	"""Wait until the function *condition* gives something true, and return that."""
	while not (found := condition()):
		time.sleep(0.002)  # leaves the processor to what is waited for
	return found


class BackgroundRun:
	"""A run of YADE in the background, from O.run() on."""

	def __init__(self, *arguments):
		from yade import O
		self._scene, self._before = O, self._threads()
		O.run(*arguments)

	@staticmethod
	def _threads():
		return set(os.listdir("/proc/self/task"))

	def pause(self):
		"""O.pause(), and wait for the end of the step in hand, as O.wait() does not:
		its thread ends with it."""
		self._scene.pause()
		until(lambda: self._threads() <= self._before)
