# GPL v2 or later, see LICENSE.
"""Calls of a test's own function from inside a run: O.run looks for its end only every 40 ms,
so many short runs take long."""
import builtins

from yade import O, PyRunner


def run_recording(steps, period, function):
	"""Run some steps and call a function after every so many of them, and in the end.
	It may end the run with O.pause()."""
	builtins._recorded = function
	runner = PyRunner(command="_recorded()", iterPeriod=period, firstIterRun=O.iter + period - 1)
	O.engines = O.engines + [runner]
	try:
		O.run(steps, True)
	finally:
		O.engines = O.engines[:-1]
		del builtins._recorded
