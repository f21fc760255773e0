# GPL v2 or later, see LICENSE.
"""Signals that end a script, held back for a moment."""
import contextlib
import signal
import threading


@contextlib.contextmanager
def held_back(*signals):
	"""Signals, as signal.SIGINT, come after what is done meanwhile.

	Processes and threads that are started meanwhile never get them. Python runs handlers in the main thread,
	whichever thread of the program gets the signal: so a mask is not enough, and handlers are put off as well.
	In other threads only the mask counts.
	"""
	came, handlers = [], {}
	if threading.current_thread() is threading.main_thread():
		handlers = {number: signal.signal(number, lambda *given: came.append(given)) for number in signals}
	before = signal.pthread_sigmask(signal.SIG_BLOCK, signals)
	try:
		yield
	finally:
		signal.pthread_sigmask(signal.SIG_SETMASK, before)
		for number, handler in handlers.items():
			signal.signal(number, handler)
	for number, frame in came:
		if callable(handlers[number]):
			handlers[number](number, frame)
		elif handlers[number] is signal.SIG_DFL:
			signal.raise_signal(number)
