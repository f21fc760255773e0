# GPL v2 or later, see LICENSE.
"""A script, or a question to a module of the plugin, in a YADE of its own on the machine that calls this.

Dask sends :func:`run_in_folder` and :func:`ask` to its workers with their code (:mod:`workers`), so that these need
no plugin in their Python, only the program; both use nothing but the standard library and functions of this file.
"""
import functools
import importlib
import json
import os
import platform
import shutil
import signal
import subprocess
import sys
import tempfile
import time

OWNER = "YADE_DDEM_OWNER"  #: variable in the environment of each process: whose it is, for :func:`end`
_RUNNER = "import sys\nfrom yade.ddem.studies import yade_process\nyade_process.answer(*sys.argv[1:])\n"


def run(script, arguments, log, threads=1, yade=None, owner="", inside=None):
	"""Run a script and return its exit code when it has ended, negative where a signal has ended it.

	It ends with the thread that calls this, also where that is killed.

	:param arguments: of the script
	:param log: file for what it prints
	:param threads: OpenMP threads
	:param yade: the program; None: "yade" of the path
	:param owner: for :func:`end`
	:param inside: folder in which it runs; None: the one of this process
	"""
	command = [
		"setpriv", "--pdeathsig", "KILL", "--", yade or shutil.which("yade") or "yade",
		"-n", "-x", f"-j{threads}", script, *arguments
	]
	environment = {**os.environ, "OMP_NUM_THREADS": str(threads), "PYTHONDONTWRITEBYTECODE": "1", OWNER: owner}
	with open(log, "wb") as file:
		return subprocess.run(
			command, stdin=subprocess.DEVNULL, stdout=file, stderr=subprocess.STDOUT, env=environment,
			cwd=inside, start_new_session=True, check=False
		).returncode


def run_in_folder(script, arguments, folder, log, yade=None, owner="", inside=None):
	"""Run a script that writes into an empty folder of its own, what it says into the file *log* there; see
	:func:`run`.

	:returns: its exit code, and the seconds that it took
	"""
	begun = time.perf_counter()
	shutil.rmtree(folder, ignore_errors=True)
	os.makedirs(folder)
	code = run(script, arguments, os.path.join(folder, log), yade=yade, owner=owner, inside=inside)
	return code, time.perf_counter() - begun


def ask(module, request, threads=1, yade=None, owner=""):
	"""What ``module.measure(request)`` gives in a YADE of its own; request and answer are plain data.

	:param module: its name
	:returns: dict of "measured"; "error", a text where there is nothing measured; "by", see :func:`identity`; and
		"seconds" that it took
	"""
	begun = time.perf_counter()
	with tempfile.TemporaryDirectory(prefix="ddem-") as folder:
		script, asked, told, log = (
			os.path.join(folder, name) for name in ("run.py", "request.json", "answer.json", "log.txt")
		)
		for path, text in ((script, _RUNNER), (asked, json.dumps(request))):
			with open(path, "w", encoding="utf-8") as file:
				file.write(text)
		code = run(script, [module, asked, told], log, threads, yade, owner)
		if not os.path.exists(told):
			error = f"YADE {ending(code)} without a result; its last lines: {tail(log)}"
			found = {"measured": None, "error": error, "by": None}
		else:
			with open(told, encoding="utf-8") as file:
				found = json.load(file)
	return {**found, "seconds": round(time.perf_counter() - begun, 3)}


def answer(module, request, path):
	"""In the YADE of :func:`ask`: write ``module.measure`` of the request in a file, or what went wrong,
	into the file that is waited for."""
	from .evaluations import EvaluationError
	found = {"measured": None, "error": None, "by": identity()}
	try:
		with open(request, encoding="utf-8") as file:
			found["measured"] = importlib.import_module(module).measure(json.load(file))
	except EvaluationError as error:
		found["error"] = str(error)
	except Exception as error:
		found["error"] = f"{type(error).__name__}: {error}"
	with open(path + ".unfinished", "w", encoding="utf-8") as file:
		json.dump(found, file)
	os.replace(path + ".unfinished", path)


@functools.lru_cache(maxsize=None)
def identity():
	"""Node, processor, YADE and plugin of this process, as plain data."""
	from yade import config

	from ..provenance import processor
	from .commandline import plugin
	return {"node": platform.node(), "processor": processor(), "yade": config.version, "plugin": plugin()}


def running():
	"""The program of this YADE; None outside of one."""
	arguments = getattr(sys, "yade_argv", None)
	return arguments and (shutil.which(arguments[0]) or arguments[0])


def end(owner):
	"""End all processes of an owner that the calling process has started, and return how many there were."""
	import psutil
	ended = 0
	for process in psutil.Process().children(recursive=True):
		try:
			if process.environ().get(OWNER) == owner:
				process.kill()
				ended += 1
		except psutil.Error:  # it has ended by itself
			pass
	return ended


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
	with open(log, errors="replace", encoding="utf-8") as file:
		return " | ".join(line.strip() for line in file.read().splitlines()[-lines:] if line.strip()) or "none"
