# GPL v2 or later, see LICENSE.
# needs: freefem++
"""See deformable triangles and the concrete law hold: cases with exact, published or independent solutions,
each with its error and tolerance.

Run:      scripts/ddem run scripts/verify.py                                (the quick cases: some 40 s)
          scripts/ddem run scripts/verify.py --all --report out/verify      (all cases, and a page with pictures)
          scripts/ddem run scripts/verify.py --list                         (what there is)
          scripts/ddem run scripts/verify.py --case kirsch cantilever       (some)
Writes:   a table here; with --json FILE a list of {case, quantity, value, reference, error, tolerance, passed, source,
          wall_s, ns_per_particle_step, bytes_per_particle}; with --report DIR DIR/verification.html,
          which holds everything, and its pictures as files.
Expect:   every check passes, and the exit code is 0; it is 1 when one fails. A case is a small file in
          py/ddem/verification/cases, which reads as an example and says what it shows,
          where its reference comes from and what to expect.
"""
import argparse
import os
import shlex
import sys
import tempfile

import yade.config
from yade.ddem import provenance, verification
from yade.ddem.studies import commandline
from yade.ddem.verification import freefem


@commandline.steps_told()
def main():
	options = read_options()
	if options.list:
		print_list()
		return 0
	results = []
	for case in options.cases:
		print(f"{case.name}: {case.title}", flush=True)
		results.append(verification.run(case, pictures=options.report is not None))
		print_result(results[-1])
	records = [record for result in results for record in result.records]
	if options.json:
		plain = [record.plain() for record in records]
		provenance.write_json(options.json, plain, indent=2, ensure_ascii=False, allow_nan=False)
	failed = [result.case.name for result in results if not result.passed]
	print(
		f"{sum(record.passed for record in records)} of {len(records)} checks passed, {len(results)} cases, "
		f"{sum(result.wall for result in results):.0f} s"
	)
	if failed:
		print(f"FAILED: {', '.join(failed)}")
	if options.report:
		from yade.ddem.verification import page
		print(f"Report: {page.write(results, options.report, command(), versions(results))}")
	return 1 if failed else 0


def read_options():
	"""Options from the command line; complains about them before anything runs."""
	parser = argparse.ArgumentParser(
		prog="scripts/ddem run scripts/verify.py",
		usage="%(prog)s [--list | --case NAME … | --all] [--json FILE] [--report DIR]",
		description=(
			"Run verification cases: each compares a result with a reference whose source is named. "
			"Without --case and --all: those that take seconds."
		),
		allow_abbrev=False,
		epilog="The exit code is 0 when every check passed, 1 when one failed, 2 for a wrong call.",
	)
	which = parser.add_mutually_exclusive_group()
	which.add_argument("--list", action="store_true", help="name the cases, and run none")
	which.add_argument("--case", nargs="+", action="extend", metavar="NAME", help="run these cases")
	which.add_argument("--all", action="store_true", help="run the slow cases as well")
	parser.add_argument("--json", metavar="FILE", help="write all comparisons into a file")
	parser.add_argument(
		"--report", metavar="DIR", help="write a page with tables and pictures into a folder, made when missing"
	)
	options = parser.parse_args()
	provenance.begin(vars(options))
	if options.list and (options.json or options.report):
		parser.error(
			"argument --list: runs no case, so there is nothing for --json or --report; leave out one of "
			"them"
		)
	if options.json and os.path.isdir(options.json):
		parser.error(
			f"argument --json: {options.json} is a folder; name a file, such as "
			f"{os.path.join(options.json, 'verification.json')}"
		)
	try:
		if options.case:
			options.cases = [verification.find(name) for name in dict.fromkeys(options.case)]
		else:
			options.cases = [case for case in verification.all_cases() if options.all or not case.slow]
	except ValueError as error:
		parser.error(f"argument --case: {error}")
	for name, folder in (("--json", os.path.dirname(options.json or "") or "."), ("--report", options.report)):
		try:
			if getattr(options, name[2:]):
				os.makedirs(folder, exist_ok=True)
				tempfile.TemporaryFile(dir=folder).close()
		except OSError as error:
			parser.error(f"argument {name}: cannot write into {folder}: {error.strerror}")
	return options


def print_list():
	for group in verification.GROUPS:
		members = [case for case in verification.all_cases() if case.group == group]
		if members:
			print(group)
		for case in members:
			print(f"  {case.name:<28} {case.title} ({case.seconds:g} s{', slow' if case.slow else ''})")


def print_result(result):
	for record in result.records:
		mark = "ok    " if record.passed else "FAILED"
		print(
			f"  {mark} {record.quantity:<58} {record.value:>13.6g}   reference {record.reference:>13.6g}   "
			f"error {record.error:.1e} of {record.tolerance:.1e}"
		)
	if result.error:
		print(result.error)
	print("\n".join(f"  {text}" for text in (f"{result.wall:.1f} s", *result.told)), flush=True)


def command():
	script = os.path.relpath(sys.argv[0])
	return shlex.join([os.path.join(os.path.dirname(script), "ddem"), "run", script, *sys.argv[1:]])


def versions(results):
	import matplotlib
	import numpy
	import scipy
	needed = {"FreeFem++": freefem.version()} if any(result.case.needs == "FreeFem++" for result in results) else {}
	return {
		"YADE": yade.config.version,
		"Python": sys.version.split()[0],
		"NumPy": numpy.__version__,
		"SciPy": scipy.__version__,
		"Matplotlib": matplotlib.__version__,
		**needed
	}


if __name__ == "__main__":
	sys.exit(main())
