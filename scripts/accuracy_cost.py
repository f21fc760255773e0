# GPL v2 or later, see LICENSE.
# needs: freefem++
"""What accuracy costs in time: errors against core-seconds for meshes, treatments, effects, time steps, loading rates,
spheres and triangles, and what the scatter of samples hides.

Run:      scripts/ddem run scripts/accuracy_cost.py                           (all ladders that fit into ten minutes)
          scripts/ddem run scripts/accuracy_cost.py --list                    (what there is)
          scripts/ddem run scripts/accuracy_cost.py --case cantilever ucs     (some: ladders, or all of a scene)
          scripts/ddem run scripts/accuracy_cost.py --case cantilever --target 0.5%
          scripts/ddem run scripts/accuracy_cost.py --ladders mine.py         (ladders of one's own, see
                                                                              ddem.accuracy.ladders)
Writes:   a table and sentences here, and into out/accuracy_cost: cost.json, cost.csv, accuracy_cost.html with pictures.
          What has been run on this machine with this build is kept there and not run again.
Expect:   errors of deflections and frequencies that fall with the square of the size, so that a tenth of the error
          costs some thirty times as much in two dimensions;
          strengths whose scatter from sample to sample soon hides the mesh.
"""
import importlib.util
import os
import re
import sys

from yade.ddem import meter
from yade.ddem.accuracy import ladders, page, sentences, study
from yade.ddem.studies import commandline
from yade.ddem.studies.evaluations import Lost


def main():
	options, parser = read_options()
	if options.list:
		print_list(options.known)
		return 0
	with commandline.workers(parser, options, alike="node") as workers:
		work = study.Study(
			options.chosen, options.out, threads=options.threads, workers=workers, budget=options.budget,
			report=lambda text: print(text, flush=True)
		)
		try:
			points = work.run(options.target)
		except Lost as error:
			sys.exit(f"accuracy_cost.py: {error}; what has been run is kept, and the same command goes on")
	told = sentences.all_of(points)
	print()
	print(page.table(points))
	print()
	print("\n".join(told))
	for ladder, predicted, measured in work.predictions:
		print(page.prediction(ladder, predicted, measured))
	for text in sentences.failures(points):
		print(f"FAILED: {text}")
	for text in sentences.skipped(points):
		print(text)
	print(f"Report: {page.write(points, told, work, options.out, commandline.command())}")
	print(steps_told(work))
	return 0


def steps_told(work):
	"""What the steps of all runs have cost, those among them that were kept from before."""
	runs = [one for outcomes in work.outcomes.values() for one in outcomes if not isinstance(one, str)]
	if not runs:
		return "no steps"
	steps, particle_steps, cpu_s = (sum(one[name] for one in runs) for name in ("steps", "particle_steps", "cpu_s"))
	counts = [round(one["particles"]) for one in runs]
	return meter.line("particle", round(steps), round(particle_steps), cpu_s, min(counts), max(counts))


def read_options():
	"""Options from the command line; complains about them before anything runs."""
	parser = commandline.script_parser("accuracy_cost", __doc__.split("\n\n", 1)[0])
	parser.add_argument("--list", action="store_true", help="say what ladders there are")
	parser.add_argument("--case", nargs="+", metavar="NAME", help="ladders by their names, or all of a scene")
	parser.add_argument(
		"--ladders", metavar="FILE", help="Python file with LADDERS of one's own, run beside the others"
	)
	parser.add_argument(
		"--target", type=share, metavar="1%", help="refine to this error, predicted before it is run"
	)
	parser.add_argument("--budget", type=duration, default=600.0, metavar="5min", help="time for all of it")
	parser.add_argument("--threads", type=int, default=1, metavar="N", help="OpenMP threads of every run")
	commandline.add_workers(parser, 1, "runs", ", which disturb each other's times")
	parser.add_argument(
		"--out", default=os.path.join("out", "accuracy_cost"), metavar="DIR", help="folder for all files"
	)
	options = parser.parse_args(sys.argv[1:])
	commandline.require_between(parser, "--threads", options.threads, 1, 1024)
	options.known = list(ladders.LADDERS)
	if options.ladders:
		try:
			mine = of_file(options.ladders)
		except Exception as error:
			parser.error(f"argument --ladders: {options.ladders}: {type(error).__name__}: {error}")
		options.known += mine
	try:
		options.chosen = options.known
		if options.case:
			options.chosen = list(
				dict.fromkeys(
					found for name in options.case for found in ladders.find(name, options.known)
				)
			)
		elif options.ladders:
			options.chosen = mine
	except ValueError as error:
		parser.error(f"argument --case: {error}")
	if not options.list:
		commandline.require_writable(parser, "--out", options.out)
	return options, parser


def of_file(path):
	"""LADDERS of a file."""
	spec = importlib.util.spec_from_file_location("ddem_ladders_of_user", os.path.abspath(path))
	module = importlib.util.module_from_spec(spec)
	sys.modules[spec.name] = module
	spec.loader.exec_module(module)
	return list(module.LADDERS)


def share(text):
	"""An error as "1%" or "0.01"."""
	value = float(text[:-1]) / 100 if text.endswith("%") else float(text)
	if not 0 < value < 1:
		raise ValueError(text)
	return value


def duration(text):
	"""A time as "90", "90s", "5min" or "2h" [s]."""
	found = re.fullmatch(r"\s*([\d.]+)\s*(s|min|h|)\s*", text)
	if not found:
		raise ValueError(text)
	return float(found[1]) * {"": 1, "s": 1, "min": 60, "h": 3600}[found[2]]


def print_list(known):
	for ladder in known:
		print(f"{ladder.name:<18}{ladder.kind:<22}{', '.join(ladders.label(rung) for rung in ladder.rungs)}")
		print(f"{'':<18}{'':<22}{', '.join(quantity.name for quantity in ladder.quantities)}")


if __name__ == "__main__":
	sys.exit(main())
