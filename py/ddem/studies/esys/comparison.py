# GPL v2 or later, see LICENSE.
"""Two records of the same compression test side by side: figures, table, picture."""
import math

import numpy as np
from matplotlib import rc_context

from ... import plots
from ..measures import FIT, strength

#: rows of the table: name among the figures, text, unit, format
ROWS = (
	("ucs_MPa", "strength (UCS)", "MPa", "{:.2f}"),
	("young_GPa", "Young's modulus", "GPa", "{:.2f}"),
	("strain_at_peak_percent", "strain at the peak", "%", "{:.4f}"),
	("broken_at_peak_percent", "bonds broken at the peak", "%", "{:.1f}"),
	("broken_at_end_percent", "bonds broken at the end", "%", "{:.1f}"),
	("seconds", "wall time of the steps", "s", "{:.2f}"),
	("ns_per_particle_step", "per particle and step", "ns", "{:.0f}"),
	("ns_per_bond_step", "per bond and step", "ns", "{:.0f}"),
	("bytes_per_particle", "memory per particle", "B", "{:.0f}"),
)
_COLOURS = ("#9ECAE1", plots.COLOURS[1])  # a light broad line below a dark thin one: both are seen where they coincide
_WIDTHS = (2.6, 0.8)


def figures(record):
	"""What a test has given, by name with its unit; None where a figure does not exist. Times are by the clock
	here, with recording, since that is what both programs say of themselves."""
	measures = strength(record.series["strain"], record.series["stress"])
	values = {
		"ucs_MPa": measures.ucs / 1e6,
		"young_GPa": measures.young / 1e9,
		"strain_at_peak_percent": 100 * measures.strain_at_peak,
		"broken_at_peak_percent": 100 * float(record.broken_share[measures.peak]),
		"broken_at_end_percent": 100 * float(record.broken_share[-1]),
		"peak_passed": measures.peaked,
		"seconds": record.seconds,
		"ns_per_particle_step": record.nanoseconds,
		"ns_per_bond_step": record.nanoseconds * len(record.setup.packing) / len(record.setup.packing.bonds),
		"bytes_per_particle": record.bytes_per_particle,
		"threads": record.threads,
	}
	return {
		name: None if isinstance(value, float) and not math.isfinite(value) else value
		for name, value in values.items()
	}


def differences(first, second, part=FIT[1]):
	"""How the second record departs from the first.

	:param part: of the first's strength, up to which stresses are compared
	:returns: largest difference of stress on the way there [MPa] as ``stress_MPa``, and where it first exceeds 1e-3
		MPa in the whole test, as ``equal_up_to_percent`` of the first's strength; 100 when that is beyond the
		peak
	:raises ValueError: records of different tests
	"""
	if not np.allclose(first.series["time"], second.series["time"], rtol=1e-9, atol=0):
		raise ValueError("these records were not taken at the same times")
	stress = first.series["stress"]
	apart = np.abs(second.series["stress"] - stress)
	measures = strength(first.series["strain"], stress)
	reached = int(np.argmax(stress >= part * measures.ucs))
	beyond = np.flatnonzero(apart > 1e3)
	equal = (
		stress[: beyond[0]].max(initial=0.0) / measures.ucs
		if len(beyond) and beyond[0] <= measures.peak
		else 1.0
	)
	return {"stress_MPa": float(apart[:reached + 1].max() / 1e6), "equal_up_to_percent": 100 * float(equal)}


def table(first, second):
	"""Text for the terminal: the figures of both, the second's departure, and how much faster it is."""
	one, other, apart = figures(first), figures(second), differences(first, second)
	lines = [("", "", first.program, second.program, "difference")]
	for name, text, unit, form in ROWS:
		values = [one[name], other[name]]
		shown = [form.format(value) if value is not None else "-" for value in values]
		lines.append((text, unit, *shown, _change(unit, *values)))
	widths = [max(len(line[column]) for line in lines) for column in range(5)]
	rows = [
		f"{line[0]:<{widths[0]}}  {line[1]:<{widths[1]}}  "
		+ "  ".join(f"{line[c]:>{widths[c]}}" for c in (2, 3, 4))
		for line in lines
	]
	rows.insert(1, "-" * len(rows[0]))
	rows += [
		"",
		f"largest difference of stress up to {100 * FIT[1]:.0f} % of the peak: {apart['stress_MPa']:.1e} MPa; "
		f"below 1e-3 MPa up to {apart['equal_up_to_percent']:.0f} %",
		(
			f"{second.program} takes {other['ns_per_particle_step'] / one['ns_per_particle_step']:.2f} of "
			f"the time of {first.program} per particle and step"
		),
	]
	for record in (first, second):
		if record.engines:
			rows += ["", f"where the time of {record.program} goes"]
			for name, ns, share in record.engines:
				rows.append(f"  {name:<28}{ns:>8.3g} ns  {100 * share:>5.1f} %")
	return "\n".join(line.rstrip() for line in rows)


def _change(unit, first, second):
	"""From the first value to the second, in words."""
	if first is None or second is None:
		return ""
	if unit == "%":
		return f"{round(second - first, 4) + 0.0:+.3g} points"
	if unit in ("s", "ns"):
		return f"{second / first:.2f} times"
	return f"{100 * (second / first - 1):+.2g} %"


def picture(first, second):
	"""Stress, broken bonds and the difference of stress over strain, as a figure of column width."""
	fig = plots.figure(plots.COLUMN, 125)
	with rc_context(plots.STYLE):
		above, middle, below = fig.subplots(3, 1, sharex=True, height_ratios=(3, 2, 2))
		for record, colour, width in zip((first, second), _COLOURS, _WIDTHS):
			strain = 100 * record.series["strain"]
			above.plot(
				strain, record.series["stress"] / 1e6, color=colour, linewidth=width,
				label=record.program
			)
			middle.plot(strain, 100 * record.broken_share, color=colour, linewidth=width)
		apart = np.abs(second.series["stress"] - first.series["stress"]) / 1e6
		below.semilogy(
			100 * first.series["strain"], np.where(apart > 0, apart, np.nan), color="0.3", linewidth=0.6
		)
		above.set_ylabel("axial stress [MPa]")
		middle.set_ylabel("broken bonds [%]")
		below.set_ylabel("difference\nof stress [MPa]")
		below.set_xlabel("axial strain [%]")
		above.set_ylim(bottom=0)
		middle.set_ylim(bottom=0)
		below.set_xlim(0, 100 * first.series["strain"].max())
		for ax in (above, middle, below):
			ax.spines[["top", "right"]].set_visible(False)
		fig.legend(loc="outside upper center", ncols=2, columnspacing=1.5)
	return fig
