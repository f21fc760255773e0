# GPL v2 or later, see LICENSE.
"""What a test in compression or tension measures: strength, strain at the peak and Young's modulus of
a stress–strain curve."""
import math
from dataclasses import dataclass

import numpy as np

FIT = (0.2, 0.6)  #: part of the strength between which Young's modulus is fitted
FALL = 0.9  #: a curve has a peak when its stress falls below this part of the largest stress afterwards


@dataclass(frozen=True)
class Strength:
	"""Measures of a stress–strain curve, loading positive; made by :func:`strength`."""
	ucs: float  # largest stress [Pa]; a lower bound of the strength unless peaked
	strain_at_peak: float  # [-]
	# slope between FIT of the strength on the way to the peak [Pa]; NaN with fewer than three records there
	young: float
	offset: float  # stress of the fitted line at zero strain [Pa]
	fit: tuple  # first and last row of the fit
	peak: int  # row of the peak
	peaked: bool  # whether the stress fell below FALL of the peak afterwards


def strength(strain, stress, fit=FIT, fall=FALL):
	"""Strength (UCS), strain at the peak and Young's modulus of a stress–strain curve.

	The strength is the largest recorded stress. Young's modulus is the least-squares slope over the rows from the
	first that reaches *fit[0]* of it to the first that reaches *fit[1]*, so that an oscillation later on the way
	does not enter (ESyS-Particle's tutorial; Weatherley et al. take 20 % and 60 %).

	:param strain, stress: rows of the test in order of time, compression positive, or tension positive in a test in
		tension [-], [Pa]
	:returns: :class:`Strength`
	:raises ValueError: lengths that differ, fewer than two rows, numbers that are not finite
		(which row), no load at all
	"""
	strain, stress = np.asarray(strain, float), np.asarray(stress, float)
	if strain.ndim != 1 or strain.shape != stress.shape or len(strain) < 2:
		raise ValueError(
			"a stress–strain curve needs two rows of equal length, at least 2 records long: "
			f"got {strain.shape} strains and {stress.shape} stresses"
		)
	bad = np.flatnonzero(~(np.isfinite(strain) & np.isfinite(stress)))
	if len(bad):
		raise ValueError(
			f"record {bad[0]} of the stress–strain curve is not finite: strain {strain[bad[0]]}, stress "
			f"{stress[bad[0]]} Pa"
		)
	if not 0 < fit[0] < fit[1] < 1:
		raise ValueError(f"fit = {fit} must be two growing parts of the strength between 0 and 1")
	peak = int(np.argmax(stress))
	ucs = float(stress[peak])
	if not ucs > 0:
		raise ValueError(
			f"the sample never carried a load: the largest stress of the curve is {ucs} Pa (compression "
			"is positive; tension in a test in tension)"
		)
	first, last = (int(np.argmax(stress >= part * ucs)) for part in fit)
	young, offset = math.nan, math.nan
	if last - first >= 2 and np.ptp(strain[first:last + 1]) > 0:
		young, offset = (float(v) for v in np.polyfit(strain[first:last + 1], stress[first:last + 1], 1))
	return Strength(
		ucs, float(strain[peak]), young, offset, (first, last), peak, bool((stress[peak:] < fall * ucs).any())
	)


def instants(strain, stress, before=(0.7, ), after=(0.7, 0.4)):
	"""Rows that show a test, each once: where the stress first reaches parts *before* of the peak, the peak, where
	it first falls to parts *after* of it, and the end."""
	stress = np.asarray(stress, float)
	peak = int(np.argmax(stress))
	rows = [int(np.argmax(stress >= part * stress[peak])) for part in before] + [peak]
	for part in after:
		below = np.flatnonzero(stress[peak:] <= part * stress[peak])
		if len(below):
			rows.append(peak + int(below[0]))
	return sorted(set(rows + [len(stress) - 1]))
