# GPL v2 or later, see LICENSE.
"""Scripts in YADEs of their own, several at the same time, all of which end when they are told to."""
import os
import shutil
import signal
import subprocess
import sys
import threading


class YadeProcesses:
	"""Runs scripts, each in a YADE of its own on one thread;
	to be called from several Python threads at the same time.

	:param yade: the program; None: the one that is running, or that is found in the path
	"""

	def __init__(self, yade=None):
		self.yade = yade or shutil.which(getattr(sys, "yade_argv", ["yade"])[0]) or "yade"
		self._running, self._lock, self._stopped = set(), threading.Lock(), False

	def run(self, script, arguments, log):
		"""Run a script, what it prints into the file *log*, and return its exit code when it has ended.

		:raises Stopped: :meth:`stop` was called before it was started
		"""
		command = [self.yade, "-n", "-x", "-j1", script, *arguments]
		environment = {**os.environ, "OMP_NUM_THREADS": "1", "PYTHONDONTWRITEBYTECODE": "1"}
		with open(log, "wb") as file:
			with self._lock:
				if self._stopped:
					raise Stopped("interrupted")
				process = subprocess.Popen(
					command, stdin=subprocess.DEVNULL, stdout=file, stderr=subprocess.STDOUT,
					env=environment, start_new_session=True
				)
				self._running.add(process)
			try:
				return process.wait()
			finally:
				with self._lock:
					self._running.discard(process)

	def stop(self):
		"""End what is running, and start nothing more."""
		with self._lock:
			self._stopped = True
			for process in self._running:
				process.kill()


class Stopped(RuntimeError):
	"""A process was not started because all were told to stop."""


def ending(code):
	"""How a process with this exit code ended, in words."""
	if code >= 0:
		return f"ended with exit code {code}"
	try:
		return f"was ended by {signal.Signals(-code).name}"
	except ValueError:
		return f"was ended by signal {-code}"


def tail(log, lines=5):
	"""The last lines of a file that say anything, in one line."""
	with open(log, errors="replace") as file:
		return " | ".join(line.strip() for line in file.read().splitlines()[-lines:] if line.strip()) or "none"
