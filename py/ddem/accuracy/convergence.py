# GPL v2 or later, see LICENSE.
"""Errors of a ladder of settings: orders, limits, fronts, and where one error hides another. Plain arithmetic; needs no
YADE.

Errors are relative [-], costs core-seconds [s], h the size of an element or particle [m].
"""
import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq


def digits(value):
	"""−log10 of an error: 2 for one per cent. Infinite for zero, nan for what is no error."""
	if not value >= 0:
		return math.nan
	return -math.log10(value) if value > 0 else math.inf


def efficacy(error, seconds):
	"""−log10(error × seconds) [-, Chang et al. 2018]: what is more accurate for its time has more of it."""
	return digits(error * seconds)


def power_law(x, y):
	"""Constant C and exponent p of y = C x^p by least squares of the logarithms; needs two points that are positive
	and apart, else (nan, nan)."""
	x, y = np.asarray(x, float), np.asarray(y, float)
	good = (x > 0) & (y > 0) & np.isfinite(x) & np.isfinite(y)
	if len(np.unique(x[good])) < 2:
		return math.nan, math.nan
	exponent, constant = np.polyfit(np.log(x[good]), np.log(y[good]), 1)
	return math.exp(constant), exponent


def front(seconds, errors):
	"""Places of the settings that no other one beats in both cost and error (the Pareto front), cheapest first.
	Of equal ones the first counts; what has no error or cost (nan) is never on it."""
	order = [i for i in range(len(errors)) if math.isfinite(seconds[i]) and math.isfinite(errors[i])]
	order.sort(key=lambda i: (seconds[i], errors[i], i))
	best, found = math.inf, []
	for i in order:
		if errors[i] < best:
			best = errors[i]
			found.append(i)
	return found


@dataclass(frozen=True)
class Limit:
	"""What values on refined meshes tend to."""
	value: float
	order: float  # observed, of the last three meshes [-]
	error: float  # bound on that of the limit itself, in the unit of the value


def richardson(h, values):
	"""The limit of values for h → 0 from the finest three meshes, with the observed order (Roache 1997).

	The order p follows from (f₁ − f₂)/(f₂ − f₃) = (h₁^p − h₂^p)/(h₂^p − h₃^p), for any ratio of sizes. The error of
	the limit is bounded by Roache's grid convergence index with a factor of 1.25 on the distance from the finest
	value, three where the order is not between half of one and four, or where the values do not approach in one
	direction: then the limit is the finest value, and the largest difference counts.

	:raises ValueError: fewer than three different sizes
	"""
	pairs = sorted(zip(h, values))
	if len({size for size, _ in pairs}) < 3:
		raise ValueError(
			f"an observed order needs three different sizes, and there are {len({s for s, _ in pairs})}"
		)
	(h3, f3), (h2, f2), (h1, f1) = pairs[:3]
	coarse, fine = f1 - f2, f2 - f3
	spread = 3 * max(abs(coarse), abs(fine))
	if coarse == fine == 0:
		return Limit(f3, math.nan, 0.0)
	if coarse * fine <= 0:
		return Limit(f3, math.nan, spread)

	def residual(order):
		return coarse * (h2**order - h3**order) - fine * (h1**order - h2**order)

	# divided by h2^p it is monotone between these; order 0 is a root that means nothing
	low, high = 0.05, 12.0
	scale = (lambda order: residual(order) / h2**order)
	if scale(low) * scale(high) > 0:
		return Limit(f3, math.nan, spread)
	order = brentq(scale, low, high, xtol=1e-10)
	step = fine * h3**order / (h2**order - h3**order)
	sound = 0.5 <= order <= 4
	return Limit(f3 - step, order, (1.25 if sound else 3) * abs(step))


def crossing(h, discretisation, scatter):
	"""The size at which the error of discretisation, C h^p, equals the scatter of samples, S h^q; both by their
	power laws over *h*. Finer meshes gain nothing that one sample shows. None where the laws do not cross within
	a factor of four of the sizes that were run, or the error does not fall with h."""
	c, p = power_law(h, discretisation)
	s, q = power_law(h, scatter)
	if not (math.isfinite(c) and math.isfinite(s)) or p <= 0 or p <= q:
		return None
	size = (s / c)**(1 / (p - q))
	return size if min(h) / 4 <= size <= 4 * max(h) else None


def cost_of(error, seconds, errors):
	"""Core-seconds for an error, on the front of what was run: interpolated between its points in logarithms, its
	power law beyond its ends. Returns (seconds, whether interpolated); (nan, False) where nothing leads there."""
	places = front(seconds, errors)
	if not places or not error > 0:
		return math.nan, False
	x = np.array([errors[i] for i in places])
	y = np.array([seconds[i] for i in places])
	if error >= x[0]:
		return float(y[0]), True  # the cheapest is good enough
	if error >= x[-1]:
		return float(np.exp(np.interp(-math.log(error), -np.log(x), np.log(y)))), True
	constant, exponent = power_law(x, y)
	if not exponent < 0:
		return math.nan, False
	return float(y[-1] * (error / x[-1])**exponent), False
