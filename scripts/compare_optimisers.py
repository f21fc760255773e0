# GPL v2 or later, see LICENSE.
# needs: python3-optuna python3-cmaes python3-torch
"""The search of calibrate.py beside those of Optuna and SciPy: how many points each tries until all targets are met.

Run:      scripts/ddem run scripts/compare_optimisers.py
          scripts/ddem run scripts/compare_optimisers.py --models analytic    (the smooth control alone)
          scripts/ddem run scripts/compare_optimisers.py --methods ours least_squares
          scripts/ddem run scripts/compare_optimisers.py --help               (all options)
Writes:   a line a search and a table here; in out/compare_optimisers: comparison.json with every search,
          prism.png and analytic.png, and evaluations.jsonl with every evaluation, whoever asked for it.

Young's modulus and strength of the prism of scripts/calibrate.py, with few spheres so that a test takes a moment, are
drawn from the range of rock; then a strength in tension as well, from the ratios of strengths that each packing has
between friction angles of 15° and 65°.
All methods begin at the same start, that of the scaling laws, within the same bounds, and try at most the same number
of points; a search ends at the first one that meets all targets. A point counts for every method that tries it, though
it is measured only once: compression, with three targets tension as well. A point whose test fails counts, too.

Ours is given as it is, and without the scaling laws that it knows beside the start. The others work on
logarithms of parameters, relative to the start: least_squares on logarithmic misses over tolerances, with finite
differences of the same 8 %; the rest on the sum of squares of these.
The control is a smooth function with elasticities like those of the prism.

Expect:   bonds break chaotically: a strength scatters by some per cent between neighbouring parameters. Ours needs the
          fewest points: two targets on the prism 3 in the median, without scaling laws 5, least_squares 10, Optuna's
          Gaussian process 14.5, Nelder-Mead 22, while TPE, CMA-ES and differential evolution mostly miss them; with
          three targets 11, and 6 of 8 searches meet them, of least_squares 3, of the others at most 2. Scaling laws
          help where they say what to do: on the smooth function with three targets they cost half a point.
Takes:    most of an hour of one core the first time; a second start some minutes, of which most are Optuna's.
"""
import argparse
import math
import os
import statistics
import sys
import warnings
from dataclasses import dataclass, field

import numpy as np
import scipy
from matplotlib import rc_context
from matplotlib.ticker import FuncFormatter, NullFormatter
from scipy import optimize

from yade.ddem import plots, provenance
from yade.ddem.studies import commandline, virtualtest
from yade.ddem.studies.calibration import DIGITS, Calibration, Target
from yade.ddem.studies.calibration_quantities import MEASURES, TUNABLES, parameters, starts, usual
from yade.ddem.studies.commandline import count, positive, seed, share
from yade.ddem.studies.evaluations import Bench, EvaluationError, OutOfBudget

AIMS = (("young", "ucs"), ("young", "ucs", "tensile"))  #: targets that are sought together
YOUNG, UCS = (20e9, 60e9), (30e6, 150e6)  # of rock [Pa]
ANGLES = (math.radians(15), math.radians(65))  # between which the ratio of both strengths is drawn
REACH = 5.0  # bounds: so many times below and above the start, for angles their range
FAILED = math.log(10)  # logarithmic miss of a point that could not be measured
STEP = 0.08  # of finite differences, as in calibrate.py
FAR = 100.0  # added to log-parameters, so that SciPy's relative steps are steps of the same size everywhere
STRAIN = 0.015  # largest one of a test [-]
SIMPLEX = 0.25  # edge of the first simplex, in logarithms


# ---- what is sought ----


@dataclass(frozen=True)
class Problem:
	"""Targets, and the parameters with their starts and bounds that are tuned for them."""
	targets: list
	parameters: list


def ratios(bench):
	"""Strength in compression over that in tension at both of :data:`ANGLES`, the smaller one first."""
	ends = bench.measure([{"young": 40e9, "cohesion": 60e6, "bondFrictionAngle": angle} for angle in ANGLES])
	for end in ends:
		if end.error:
			raise EvaluationError(f"the ratio of strengths cannot be measured: {end.error}")
	return sorted(end.measured["ucs"] / end.measured["tensile"] for end in ends)


def problems(bench, measures, number, tolerance, drawn):
	"""So many problems on a bench with targets drawn by the numpy generator *drawn*."""
	ratio = ratios(bench) if "tensile" in measures else (1.0, 1.0)
	reference = virtualtest.material("rigid", {}, 2400.0)
	material = {name: getattr(reference, name) for name in TUNABLES["rigid"]}
	made = []
	for _ in range(number):
		young, ucs = (math.exp(drawn.uniform(*np.log(span))) for span in (YOUNG, UCS))
		wanted = {"young": young, "ucs": ucs, "tensile": ucs / drawn.uniform(*ratio)}
		targets = [Target(name, float(f"{wanted[name]:.3g}"), tolerance) for name in measures]
		start = starts("rigid", {target.name: target.value for target in targets}, material)
		names = usual("rigid", measures)
		bounds = {
			name: (start[name] / REACH, start[name] * REACH)
			for name in names
			if not TUNABLES["rigid"][name].span
		}
		made.append(Problem(targets, parameters("rigid", names, start, bounds)))
	return made


class Prism:
	"""Tests in this YADE: they are shorter than the start of another one."""

	def __init__(self, setup, packings):
		self.setup, self.packings = setup, packings

	def settings(self):
		return virtualtest.SeparateYade(self.setup).settings()

	def __call__(self, values, case):
		return virtualtest.perform(self.setup, values, case, self.packings)


class Analytic:
	"""A smooth function with elasticities and curvatures like those of the prism."""

	def settings(self):
		return {"model": "analytic"}

	def __call__(self, values, case):
		stiff, strong = math.log(values["young"] / 40e9), math.log(values["cohesion"] / 60e6)
		angle = math.log(math.tan(values.get("bondFrictionAngle", math.radians(45))))
		return {
			"young": 30e9 * math.exp(stiff + 0.02 * strong),
			"ucs": 75e6 * math.exp(0.08 * stiff + 0.9 * strong + 0.03 * strong**2 + 0.25 * angle),
			"tensile": 26e6 * math.exp(0.02 * stiff + strong - 0.2 * angle - 0.05 * angle**2),
		}


# ---- the bench as a method sees it ----


class Tries:
	"""Measures points for one method: each that it has not tried before counts, whether the store has it or not.

	:param bench: :class:`evaluations.Bench` without a budget
	:param problem: :class:`Problem`
	:param budget: points that the method may try
	"""

	def __init__(self, bench, problem, budget):
		self.bench, self.problem, self.budget = bench, problem, budget
		self.seen, self.misses = {}, []  #: misses: of each point in turn, the largest [-]; inf where it failed
		self.width = len(problem.parameters)
		tuned = problem.parameters
		self.start, self.lower, self.upper = (
			np.log([getattr(p, name) / p.start for p in tuned]) for name in ("start", "lower", "upper")
		)

	@property
	def reached(self):
		"""Whether a point met all targets."""
		return any(miss <= self.problem.targets[0].tolerance for miss in self.misses)

	def measure(self, points):
		"""As :meth:`evaluations.Bench.measure`.

		:raises OutOfBudget: these would be more points than are allowed
		"""
		new = [values for values in points if tuple(values.items()) not in self.seen]
		if len(self.seen) + len(new) > self.budget:
			raise OutOfBudget(f"{self.budget} points were tried")
		found = self.bench.measure(points)
		for values, point in zip(points, found):
			if tuple(values.items()) in self.seen:
				continue
			self.seen[tuple(values.items())] = point
			self.misses.append(
				math.inf
				if point.error
				else max(abs(target.miss(point)) for target in self.problem.targets)
			)
		return found

	def residuals(self, x):
		"""Logarithmic misses over tolerances at *x*, logarithms of parameters over their starts.

		:raises Reached: all targets are met
		:raises OutOfBudget: no point is left
		"""
		values = {
			p.name: float(f"{min(max(p.start * math.exp(step), p.lower), p.upper):.{DIGITS - 1}e}")
			for p, step in zip(self.problem.parameters, x)
		}
		point = self.measure([values])[0]
		if self.reached:
			raise Reached
		return np.array(
			[
				(FAILED if point.error else math.log(point.measured[target.name] / target.value))
				/ target.tolerance
				for target in self.problem.targets
			]
		)

	def distance(self, x):
		"""One number for methods that take no more: the sum of squares of the residuals."""
		return float((self.residuals(x)**2).sum())


class Reached(Exception):
	"""All targets are met."""


# ---- methods: each searches until it is stopped, or gives up ----


def ours(tries, number):
	Calibration(
		tries.problem.parameters, tries.problem.targets, tries, STEP, sensitivities=False
	).run()


def ours_without_laws(tries, number):
	plain = [type(p)(p.name, p.start, p.lower, p.upper) for p in tries.problem.parameters]
	Calibration(plain, tries.problem.targets, tries, STEP, sensitivities=False).run()


def least_squares(tries, number):
	optimize.least_squares(
		lambda x: tries.residuals(x - FAR), tries.start + FAR, bounds=(tries.lower + FAR, tries.upper + FAR),
		diff_step=math.log1p(STEP) / FAR
	)


def nelder_mead(tries, number):
	simplex = np.vstack([tries.start, tries.start + SIMPLEX * np.eye(tries.width)])
	optimize.minimize(
		tries.distance, tries.start, method="Nelder-Mead", bounds=list(zip(tries.lower, tries.upper)),
		options={"initial_simplex": simplex}
	)


def differential_evolution(tries, number):
	optimize.differential_evolution(
		tries.distance, list(zip(tries.lower, tries.upper)), x0=tries.start, popsize=4, polish=False,
		tol=0, seed=number
	)


def tpe(tries, number):
	import optuna
	_optuna(tries, optuna.samplers.TPESampler(n_startup_trials=5, seed=number))


def cma_es(tries, number):
	import optuna
	start = dict(zip(_names(tries), tries.start))
	_optuna(tries, optuna.samplers.CmaEsSampler(x0=start, seed=number))


def gaussian_process(tries, number):
	import optuna
	_optuna(tries, optuna.samplers.GPSampler(n_startup_trials=5, seed=number))


def _names(tries):
	return [p.name for p in tries.problem.parameters]


def _optuna(tries, sampler):
	import optuna
	optuna.logging.set_verbosity(optuna.logging.WARNING)
	names = _names(tries)
	study = optuna.create_study(sampler=sampler)
	study.enqueue_trial(dict(zip(names, tries.start)))
	ranges = {
		name: optuna.distributions.FloatDistribution(low, high)
		for name, low, high in zip(names, tries.lower, tries.upper)
	}
	while True:
		trial = study.ask(ranges)
		study.tell(trial, tries.distance([trial.params[name] for name in names]))


METHODS = {
	"ours": ("yade.ddem", ours),
	"ours_without_laws": ("yade.ddem, no scaling laws", ours_without_laws),
	"least_squares": ("SciPy least_squares", least_squares),
	"nelder_mead": ("SciPy Nelder–Mead", nelder_mead),
	"differential_evolution": ("SciPy diff. evolution", differential_evolution),
	"gaussian_process": ("Optuna Gaussian process", gaussian_process),
	"tpe": ("Optuna TPE", tpe),
	"cma_es": ("Optuna CMA-ES", cma_es),
}


# ---- the comparison ----


@dataclass
class Search:
	"""One method on one problem."""
	model: str  # "prism" or "analytic"
	method: str
	packing: int  # seed of it
	targets: dict  # name -> value [Pa]
	reached: bool
	points: int  # that it tried, until it met the targets or ended
	misses: list = field(repr=False)  # the largest miss of the best point so far, after each [-]; None before any


def search(method, bench, problem, budget, number):
	"""What one method finds on one problem; *number* draws what it draws."""
	tries = Tries(bench, problem, budget)
	try:
		METHODS[method][1](tries, number)
	except (Reached, OutOfBudget):
		pass
	best = np.minimum.accumulate(tries.misses)
	return tries.reached, [float(miss) if math.isfinite(miss) else None for miss in best]


def compare(options, report):
	"""All searches, a list of :class:`Search`."""
	setup = virtualtest.Setup.standard(
		"rigid", "prism", radii=tuple(options.radii), velocity=options.velocity, strain=STRAIN,
		fails=options.fails
	)
	packings = os.path.abspath(os.path.join(options.out, "packings"))
	found = []
	for model, evaluate, seeds in (
		("analytic", Analytic(), options.seeds[:1]), ("prism", Prism(setup, packings), options.seeds)
	):
		if model not in options.models:
			continue
		for measures, packing in ((measures, packing) for measures in AIMS for packing in seeds):
			drawn = np.random.default_rng([options.draw, len(measures), packing])
			cases = virtualtest.cases(measures, [packing]) if model == "prism" else ({}, )
			path = os.path.join(options.out, "evaluations.jsonl")
			with Bench(evaluate, cases, evaluate.settings(), path) as bench:
				for number, problem in enumerate(
					problems(bench, measures, options.targets, options.tolerance, drawn)
				):
					for method in options.methods:
						reached, misses = search(
							method, bench, problem, options.budget, number
						)
						targets = {target.name: target.value for target in problem.targets}
						found.append(
							Search(
								model, method, packing, targets, reached, len(misses),
								misses
							)
						)
						report(line(found[-1]))
	return found


def groups(found):
	"""(model, number of targets, method) -> its searches."""
	made = {}
	for one in found:
		made.setdefault((one.model, len(one.targets), one.method), []).append(one)
	return made


def summary(found):
	"""A dict a model, number of targets and method: points until all targets are met, median and worst, None where
	the search that would be it never met them; and how many did not."""
	made = []
	for (model, targets, method), searches in groups(found).items():
		points = [one.points if one.reached else math.inf for one in searches]
		middle, worst = statistics.median(points), max(points)
		made.append(
			{
				"model": model, "targets": targets, "method": method, "searches": len(searches),
				"median": middle if math.isfinite(middle) else None,
				"worst": worst if math.isfinite(worst) else None,
				"failed": sum(not one.reached for one in searches)
			}
		)
	return made


# ---- what is shown ----


def line(one):
	targets = ", ".join(f"{MEASURES[name].symbol} {MEASURES[name].shown(v)}" for name, v in one.targets.items())
	end = "met" if one.reached else "not met"
	return f"{one.model:<9}{targets:<48}{METHODS[one.method][0]:<28}{one.points:>4} points, {end}"


def table(rows):
	"""The summary as text."""
	lines = [f"{'model':<10}{'targets':>7}  {'method':<28}{'median':>7}{'worst':>7}{'not met':>13}"]
	for row in rows:
		median, worst = (
			"-" if row[name] is None else f"{row[name]:g}" for name in ("median", "worst")
		)
		lines.append(
			f"{row['model']:<10}{row['targets']:>7}  {METHODS[row['method']][0]:<28}{median:>7}{worst:>7}"
			f"{row['failed']:>6} of {row['searches']:>3}"
		)
	return "\n".join(lines)


def picture(found, budget, tolerance, file):
	"""The largest miss of the best point over the number of points, a panel a method: median and range of its
	searches, in a colour for each number of targets. A search that met its targets stays there."""
	made = groups(found)
	methods = list(dict.fromkeys(one.method for one in found))
	columns = min(4, len(methods))
	rows = -(-len(methods) // columns)
	tried = np.arange(1, budget + 1)
	with rc_context(plots.STYLE):
		figure = plots.figure(plots.PAGE, 8 + 42 * rows)
		grid = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
		for ax, method in zip(grid.flat, methods):
			for (_, targets, name), searches in made.items():
				if name == method:
					curves = 100 * np.array([_to_the_end(one.misses, budget) for one in searches])
					colour = plots.COLOURS[targets - 2]
					ax.fill_between(
						tried, curves.min(axis=0), curves.max(axis=0), step="post",
						color=colour, alpha=0.2, linewidth=0
					)
					ax.plot(
						tried, np.median(curves, axis=0), color=colour,
						drawstyle="steps-post", label=f"{targets} targets"
					)
			ax.axhline(100 * tolerance, color="0.3", linewidth=0.6, linestyle="--", label="tolerance")
			ax.set_title(METHODS[method][0])
			ax.spines[["top", "right"]].set_visible(False)
		for ax in list(grid.flat)[len(methods):]:
			ax.set_visible(False)
		ax = grid[0, 0]
		ax.set_xscale("log")
		ax.set_yscale("log")
		ax.set_xlim(1, budget)
		ax.set_xticks([n for n in (1, 2, 5, 10, 20, 50, 100, 200, 500) if n <= budget])
		for axis in (ax.xaxis, ax.yaxis):
			axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
			axis.set_minor_formatter(NullFormatter())
		figure.supxlabel("points tried", fontsize=8)
		figure.supylabel("largest miss of the best point [%]", fontsize=8)
		handles, labels = ax.get_legend_handles_labels()
		figure.legend(handles, labels, loc="outside upper center", ncols=3)
	plots.save(figure, file)


def _to_the_end(misses, budget):
	"""As many as the budget: the last one stays; what could not be measured is a factor of ten away."""
	known = [math.exp(FAILED) - 1 if miss is None else miss for miss in misses]
	return known + [known[-1]] * (budget - len(known))


def write(found, options, versions):
	"""The files; what has been compared with what, and in which versions."""
	provenance.write_json(
		os.path.join(options.out, "comparison.json"),
		{
			"summary": summary(found), "searches": [vars(one) for one in found],
			"options": commandline.plain(options), "versions": versions
		},
		indent=1,
	)
	for model in options.models:
		picture(
			[one for one in found if one.model == model], options.budget, options.tolerance,
			os.path.join(options.out, f"{model}.png")
		)


def read_options():
	"""Options from the command line; complains about them before anything runs."""
	parser = commandline.script_parser("compare_optimisers", __doc__.split("\n\n", 1)[0])
	parser.add_argument(
		"--models", nargs="+", choices=("analytic", "prism"), default=["analytic", "prism"],
		help="what is tuned"
	)
	parser.add_argument(
		"--methods", nargs="+", choices=tuple(METHODS), default=list(METHODS), metavar="NAME",
		help="any of " + ", ".join(METHODS)
	)
	parser.add_argument("--targets", type=count, default=4, metavar="N", help="draws of targets for each packing")
	parser.add_argument("--seeds", type=seed, nargs="+", default=[1, 2], metavar="N", help="of the packings")
	parser.add_argument("--draw", type=seed, default=1, metavar="N", help="seed of the targets")
	parser.add_argument("--budget", type=count, default=60, metavar="N", help="points that each method may try")
	parser.add_argument("--tolerance", type=share, default=0.02, metavar="PART", help="of every target")
	parser.add_argument(
		"--radii", type=positive, nargs=2, default=(0.8e-3, 2e-3), metavar=("MIN", "MAX"),
		help="range of the spheres' radii [m]"
	)
	parser.add_argument(
		"--fails", type=count, default=1000, metavar="N",
		help="the packing is finished when so many spheres in a row found no place"
	)
	parser.add_argument(
		"--velocity", type=positive, default=1.0, metavar="M/S", help="of each platen in compression"
	)
	parser.add_argument(
		"--out", default=os.path.join("out", "compare_optimisers"), metavar="DIR", help="folder for all files"
	)
	options = parser.parse_args(sys.argv[1:])
	commandline.require_between(parser, "--tolerance", options.tolerance, 1e-6, 0.5)
	commandline.require_writable(parser, "--out", options.out)
	provenance.begin(vars(options))
	return options


@commandline.steps_told()
def main():
	options = read_options()
	versions = {scipy.__name__: scipy.__version__}
	if {"tpe", "cma_es", "gaussian_process"} & set(options.methods):
		import optuna
		import torch
		torch.set_num_threads(1)  # a process of a few points is not worth more
		warnings.simplefilter("ignore", optuna.exceptions.ExperimentalWarning)
		versions[optuna.__name__] = optuna.__version__
	found = compare(options, lambda text: print(text, flush=True))
	print()
	print(table(summary(found)))
	write(found, options, versions)
	print(f"Written: {options.out}")
	return 0


if __name__ == "__main__":
	sys.exit(main())
