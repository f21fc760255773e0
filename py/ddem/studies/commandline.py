# GPL v2 or later, see LICENSE.
"""What scripts share: kinds of options with errors for people, the number of threads, and how to repeat a run."""
import argparse
import contextlib
import glob
import hashlib
import math
import os
import shlex
import shutil
import sys
import tempfile

import numpy as np

import yade.config
from yade import O

from .. import meter
from .runs import RECORDER
from .workers import Workers

_RESTARTED = "YADE_DDEM_RESTARTED"  # set in the environment of a YADE that was started by restart()


def positive(text):
	value = float(text)
	if not (value > 0 and math.isfinite(value)):
		raise argparse.ArgumentTypeError(f"{text} must be positive")
	return value


def not_negative(text):
	value = float(text)
	if not (value >= 0 and math.isfinite(value)):
		raise argparse.ArgumentTypeError(f"{text} must not be negative")
	return value


def output_options(parser, rows=None):
	"""Options of a test's output, --vtk, --pictures, --pdf, --progress, in a group of their own.

	:param rows: default and least value of --rows; None leaves that option out
	:returns: the group, for more of them
	"""
	output = parser.add_argument_group("output")
	if rows is not None:
		usual, least = rows
		output.add_argument(
			"--rows", type=count, default=usual, metavar="N",
			help=f"records up to the largest strain, at least {least}"
		)
	output.add_argument("--vtk", action=argparse.BooleanOptionalAction, default=True, help="ParaView files")
	output.add_argument(
		"--pictures", action=argparse.BooleanOptionalAction, default=True,
		help="pictures, in the report and as PNG files"
	)
	output.add_argument("--pdf", action="store_true", help="each picture as a PDF file as well")
	output.add_argument(
		"--progress", action=argparse.BooleanOptionalAction, default=True,
		help="progress bars, where the terminal can show them"
	)
	return output


def share(text):
	value = float(text)
	if not 0 <= value < 1:
		raise argparse.ArgumentTypeError(f"{text} must be a part, from 0 to below 1")
	return value


def number(text):
	value = float(text)
	if not math.isfinite(value):
		raise argparse.ArgumentTypeError(f"{text} must be finite")
	return value


def count(text):
	value = int(text)
	if value < 1:
		raise argparse.ArgumentTypeError(f"{text} must be at least 1")
	return value


def seed(text):
	value = int(text)
	if value < 0:
		raise argparse.ArgumentTypeError(f"{text} must not be negative")
	return value


def script_parser(name, description):
	"""Parser of scripts/*name*.py, in whose help every option has its default."""
	return argparse.ArgumentParser(
		prog=f"scripts/ddem run scripts/{name}.py", usage="%(prog)s [options]", description=description,
		formatter_class=argparse.ArgumentDefaultsHelpFormatter,
		allow_abbrev=False
	)


def add_files(parser, name, what="ParaView files"):
	"""Add the options --vtk, of which *what* says what it writes, and --out, by default out/*name*."""
	parser.add_argument("--vtk", action=argparse.BooleanOptionalAction, default=True, help=what)
	parser.add_argument(
		"--out",
		default=os.path.join("out", name),
		metavar="DIR",
		help="folder for all files, made when missing",
	)


def add_workers(parser, jobs, what, note=""):
	"""Add the options --jobs, how many of *what* run at the same time here, and --cluster."""
	parser.add_argument(
		"--jobs", type=count, default=jobs, metavar="N", help=f"{what} at the same time on this machine{note}"
	)
	parser.add_argument(
		"--cluster", default=argparse.SUPPRESS, metavar="ADDRESS",
		help=f"{what} on the workers of the Dask scheduler there, as tcp://node0:8786, in place of this machine"
	)


def workers(parser, options, alike="processor"):
	"""The :class:`workers.Workers` of these options; complains where the cluster does not answer."""
	try:
		found = Workers(options.jobs, getattr(options, "cluster", None), alike)
	except OSError as error:
		parser.error(f"argument --cluster: {error}")
	if found.others:
		print(f"Workers on {found.machine}; those on {', '.join(found.others)} are left alone.", flush=True)
	return found


def require_between(parser, option, values, low, high):
	"""Complain about an option with a value (or a value in a sequence) out of bounds."""
	for value in np.atleast_1d(values):
		if not low <= value <= high:
			parser.error(
				f"argument {option}: {value:g} must "
				+ (f"lie between {low:g} and {high:g}" if high < math.inf else f"be at least {low:g}")
			)


def require_writable(parser, option, folder):
	"""Make a folder, and complain about the option that names it where nothing can be written there."""
	try:
		os.makedirs(folder, exist_ok=True)
		tempfile.TemporaryFile(dir=folder).close()
	except OSError as error:
		parser.error(f"argument {option}: cannot write into {folder}: {error.strerror}")


@contextlib.contextmanager
def steps_told():
	"""Say in the end what all steps have cost that were made meanwhile, a line for each kind of particle, recorders
	left out; for a script's main::

		@commandline.steps_told()
		def main():
			...
	"""
	with meter.StepMeter(apart=[RECORDER]) as counted:
		try:
			yield counted
		finally:
			for text in counted.told():
				print(text, flush=True)


def restart(threads):
	"""Start the running script again, from its beginning, in a YADE of so many OpenMP threads, where this one has
	another number: it is fixed when YADE starts.

	Returns where there is nothing to do.

	:raises RuntimeError: the second YADE has not got them either
	"""
	if threads == O.numThreads:
		return
	if os.environ.get(_RESTARTED):
		raise RuntimeError(
			f"YADE runs on {O.numThreads} threads, not on {threads}; something limits them, such as "
			"OMP_THREAD_LIMIT"
		)
	program, *options = sys.yade_argv[:len(sys.yade_argv) - len(sys.argv)]
	sys.stdout.flush()
	# this YADE's folder in /tmp, which it removes when it exits by itself
	shutil.rmtree(os.path.dirname(O.tmpFilename()), ignore_errors=True)
	# the last -j counts
	os.execve(
		shutil.which(program) or program,
		[program, *options, f"-j{threads}", *sys.argv],
		{**os.environ, _RESTARTED: "1"},
	)


def command(threads=None):
	"""The command line that repeats this run; *threads* of the launcher,
	where the script has no option for them."""
	launcher = ["--threads", str(threads)] if threads and threads > 1 else []
	script = os.path.relpath(sys.argv[0])
	return shlex.join([os.path.join(os.path.dirname(script), "ddem"), "run", *launcher, script, *sys.argv[1:]])


def plain(options):
	"""Options as plain data for a JSON file."""
	return {name: list(value) if isinstance(value, tuple) else value for name, value in vars(options).items()}


def versions(*modules):
	"""Name -> version of YADE, the plugin's libraries (a hash of them), Python and *modules*."""
	return {
		"YADE": yade.config.version,
		"plugin": plugin(),
		"Python": sys.version.split()[0],
		**{module.__name__: module.__version__ for module in modules},
	}


def plugin():
	"""Twelve digits that change with any rebuilt library of the plugin."""
	digest = hashlib.sha256()
	for path in sorted(glob.glob(os.path.join(yade.config.libDir, "*ddem*.so"))):
		with open(path, "rb") as file:
			digest.update(file.read())
	return digest.hexdigest()[:12]
