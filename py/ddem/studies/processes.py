# GPL v2 or later, see LICENSE.
"""Scripts in YADEs of their own, several at the same time, all of which end when they are told to."""
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import threading

from .evaluations import EvaluationError


class YadeProcesses:
	"""Runs scripts, each in a YADE of its own; to be called from several Python threads at the same time.

	:param yade: the program; None: the one that is running, or that is found in the path
	:param threads: OpenMP threads of each
	"""

	def __init__(self, yade=None, threads=1):
		self.threads = threads
		self.yade = yade or shutil.which(getattr(sys, "yade_argv", ["yade"])[0]) or "yade"
		self._running, self._lock, self._stopped = set(), threading.Lock(), False

	def run(self, script, arguments, log, threads=None):
		"""Run a script, what it prints into the file *log*, and return its exit code when it has ended;
		*threads* in place of those of all.

		:raises Stopped: :meth:`stop` was called before it was started
		"""
		threads = threads or self.threads
		command = [self.yade, "-n", "-x", f"-j{threads}", script, *arguments]
		environment = {**os.environ, "OMP_NUM_THREADS": str(threads), "PYTHONDONTWRITEBYTECODE": "1"}
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


class Requests:
	"""Asks a script for what it measures, each time in a YADE of its own;
	called from several threads at the same time.

	The script is called with two files, and calls :func:`answer` with them.

	:param script: its path
	:param yade: as for :class:`YadeProcesses`
	:param threads: as for :class:`YadeProcesses`
	"""

	def __init__(self, script, yade=None, threads=1):
		self.script, self._processes = script, YadeProcesses(yade, threads)

	def ask(self, request, threads=None):
		"""What the script measures for a request, both plain data; *threads* in place of those of all.

		:raises EvaluationError: it says that it cannot, or ended without a word
		"""
		with tempfile.TemporaryDirectory(prefix="ddem-") as folder:
			asked, told, log = (
				os.path.join(folder, name) for name in ("request.json", "answer.json", "log.txt")
			)
			with open(asked, "w") as file:
				json.dump(request, file)
			try:
				code = self._processes.run(self.script, [asked, told], log, threads)
			except Stopped as error:
				raise EvaluationError(str(error)) from None
			if not os.path.exists(told):
				raise EvaluationError(
					f"YADE {ending(code)} without a result; its last lines: {tail(log)}"
				)
			with open(told) as file:
				found = json.load(file)
			if found["error"] is not None:
				raise EvaluationError(found["error"])
			return found["measured"]

	def stop(self):
		"""End what is running, and start nothing more."""
		self._processes.stop()


def answer(request, path, measure):
	"""Write ``measure(request)``, or what went wrong, into the file that :class:`Requests` waits for."""
	with open(request) as file:
		asked = json.load(file)
	found = {"measured": None, "error": None}
	try:
		found["measured"] = measure(asked)
	except EvaluationError as error:
		found["error"] = str(error)
	except Exception as error:
		found["error"] = f"{type(error).__name__}: {error}"
	with open(path + ".unfinished", "w") as file:
		json.dump(found, file)
	os.replace(path + ".unfinished", path)


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
