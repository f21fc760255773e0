# GPL v2 or later, see LICENSE.
"""The page of the study of bonded spheres, with its JSON, CSV files and pictures."""
import datetime
import os
import re

from .. import provenance
from ..studies.bonded_study import (
	ESYS, FIGURES, RECORD, UCS_CLAIMED, YOUNG_CLAIMED, change, claims, place, write_curves
)
from . import bonded_study_figures as figures
from . import pages

_MEDIUM = (0.4e-3, 2e-3)  # radii [m]
# in tables
_SHOWN = [figure for figure in FIGURES if figure[0] not in ("particles", "bonds", "time_bottom_ms", "time_top_ms")]
TITLE = "Uniaxial compression of bonded spheres: the paper's figures"


def write(groups, folder, command, options, versions, settings, pictures=True, pdf=False):
	"""Write bonded_figures.html and everything beside it, and return its path.

	:param groups: list of :class:`studies.bonded_study.Group`, those of kind "paper" first
	:param settings: (name, value with unit, meaning) of the test
	"""
	os.makedirs(folder, exist_ok=True)
	written = datetime.datetime.now().astimezone().replace(microsecond=0)
	paper, others = [g for g in groups if g.kind == "paper"], [g for g in groups if g.kind != "paper"]
	said = claims(groups)
	texts = {"findings": findings(groups), "others": influences(groups), "readings": readings(groups)}
	plain = _plain(groups, said, texts, written, command, options, versions)
	provenance.write_json(os.path.join(folder, "study.json"), plain, indent=2, ensure_ascii=False, allow_nan=False)
	_write_runs(groups, os.path.join(folder, "runs.csv"))
	for group in groups:
		write_curves(group, os.path.join(folder, f"curves_{group.name}.csv"))
	drawn = {}
	if pictures:
		drawn = {name: draw(paper) for name, draw in figures.PAPER.items()}
		if others:
			drawn["influences"] = figures.influences(_compared(groups))
	columns = [f"{title} [{unit}]" if unit else title for _, title, unit, _ in _SHOWN]
	page = pages.render(
		"bonded_study.html", {"tied": _tied}, title=TITLE, written=written,
		runs=sum(len(g.records) for g in groups), machine=pages.processor(), lead=lead(paper),
		claims=said, packings=len(paper[0].records), columns=columns, rows=_rows(groups),
		breaks=_breaks(groups), settings=settings, command=command,
		versions=versions, pictures=pages.save(drawn, folder, pdf), effects=effects(groups),
		engines=engines(groups), first_run=groups[0].label, **texts
	)
	return pages.write(page, os.path.join(folder, "bonded_figures.html"))


def effects(groups):
	"""What the first run simulated, a list of dicts; empty for runs of versions that did not say so."""
	return groups[0].records[0].summary.get("effects", [])


def engines(groups):
	"""Where the time of the first run went, see :func:`studies.runs.plain_costs`; empty for runs of versions that
	did not say so."""
	return groups[0].records[0].summary.get("engines", [])


def told(groups):
	"""What the steps of all runs have cost, in a line, as :func:`meter.line` says it; recording left out."""
	from .. import meter  # needs YADE, as who has made steps does
	runs = [record.summary for group in groups for record in group.records]
	cpu = sum(run["cpu_s"] - run["recording_s"] for run in runs)
	counts = [run["particles"] for run in runs]
	steps = sum(run["steps"] for run in runs)
	particle_steps = sum(run["steps"] * run["particles"] for run in runs)
	return meter.line("sphere", steps, particle_steps, cpu, min(counts), max(counts))


def table(groups):
	"""Strength and the like of all groups, for a terminal."""
	lines = [["", *(f"{title} [{unit}]" for _, title, unit, _ in _SHOWN)]]
	lines += [[group.label, *(_cell(group, name, form) for name, _, _, form in _SHOWN)] for group in groups]
	widths = [max(len(line[column]) for line in lines) for column in range(len(lines[0]))]
	rows = [
		"  ".join(
			[f"{line[0]:<{widths[0]}}", *(f"{cell:>{width}}" for cell, width in zip(line[1:], widths[1:]))]
		)
		for line in lines
	]
	return "\n".join([rows[0], "-" * len(rows[0]), *rows[1:]])


def lead(paper):
	strengths = "; ".join(
		f"{g.spread('ucs_MPa').text('{:.0f}')} MPa for {g.range_text}"
		for g in paper
		if g.stiffness == paper[0].stiffness
	)
	return (
		"Prisms of bonded spheres, 10 × 20 × 10 mm, are crushed between elastic walls, as in the tutorial of "
		f"ESyS-Particle. Between walls of {paper[0].stiffness / 1e9:g} GPa their strength by eq. 9, median "
		f"and range over packings, is {strengths}."
	)


def findings(groups):
	"""What the comparison means, in sentences."""
	ucs, young = ESYS["ref_s1"]
	said = [
		(
			"Factor of two. Eq. 9 divides the sum of both wall forces by 2A; the script printed in "
			"ESyS-Particle's tutorial, which the paper follows, divides it by A. With the tutorial's "
			f"parameters ESyS-Particle 2.3.5 itself gives {ucs:g} MPa and {young:g} GPa by eq. 9 on "
			"a sample of 0.4–2.0 mm, and the tutorial's own plot shows 145 MPa and 91 GPa. Twice that, "
			f"{2 * ucs:.0f} MPa and {2 * young:.0f} GPa, are at the upper ends of the paper's ranges, "
			f"{UCS_CLAIMED[0]:g}–{UCS_CLAIMED[1]:g} MPa and {YOUNG_CLAIMED[0]:g}–{YOUNG_CLAIMED[1]:g} "
			"GPa: its stresses, strengths and moduli are very likely twice those of eq. 9. That is not "
			"proven, since the packings are not the same."
		)
	]
	medium, sample = _named(groups, "paper", _MEDIUM), _named(groups, "sample of ESyS-Particle", _MEDIUM)
	if medium and sample:
		mine = sample.records[0].figures()
		said.append(
			"The packing matters as much. On that sample of ESyS-Particle the bonds here give "
			f"{mine['ucs_MPa']:.1f} MPa and {mine['young_GPa']:.1f} GPa as well. The packings made here "
			"by GenGeo, with the same radii, are denser and touch the walls with more spheres, and give "
			f"{medium.spread('ucs_MPa').text('{:.0f}')} MPa and "
			f"{medium.spread('young_GPa').text('{:.0f}')} GPa."
		)
	return said


def readings(groups):
	"""Where strength and modulus lie in the paper's ranges:
	label, then UCS and E by eq. 9, and both divided by A instead."""
	softest = min(group.stiffness for group in groups)
	rows = []
	for group in groups:
		if group.stiffness == softest and group.kind in ("paper", "sample of ESyS-Particle"):
			measured = ((group.spread("ucs_MPa"), UCS_CLAIMED), (group.spread("young_GPa"), YOUNG_CLAIMED))
			rows.append(
				[
					group.label,
					*(
						place(factor * spread, claimed)
						for factor in (1, 2)
						for spread, claimed in measured
					),
				]
			)
	return rows


def influences(groups):
	"""What mass and convention do, in sentences."""
	base = _named(groups, "paper", _MEDIUM) or next(group for group in groups if group.kind == "paper")
	said = []
	rock = _named(groups, "rock density", base.radii)
	if rock:
		text = (
			"Rate. ESyS-Particle's default mass r³ makes the spheres 92 times as heavy as rock, and its "
			"waves slow. With the density of rock, 2600 kg/m³, and everything else the same the strength "
			f"changes by {_percent(change(rock, base, 'ucs_MPa'))} and Young's modulus by "
			f"{_percent(change(rock, base, 'young_GPa'))}, packing by packing: the paper's test is not "
			"quasi-static."
		)
		heavy, light = (
			_named(groups, "sample of ESyS-Particle", base.radii),
			_named(groups, "sample of ESyS-Particle, rock density", base.radii),
		)
		if heavy and light:
			theirs = 100 * (ESYS["ref_s1_rock"][0] / ESYS["ref_s1"][0] - 1)
			mine = _percent(change(light, heavy, "ucs_MPa"))
			text += (
				f" On the sample of ESyS-Particle the strength changes by {mine}, in ESyS-Particle "
				f"itself by −{-theirs:.0f} %."
			)
		said.append(text)
	consistent = _named(groups, "consistent bonds", base.radii)
	if consistent:
		said.append(
			"Convention. Consistent bonds (full bending moment EI/d₀, rest length as built, conservative, "
			"friction that remembers sliding) instead of ESyS-Particle's, with the same masses, change "
			f"the strength by {_percent(change(consistent, base, 'ucs_MPa'))} and Young's modulus by "
			f"{_percent(change(consistent, base, 'young_GPa'))}: twice the bending moment puts the rim of "
			"a bond under more tension."
		)
	return said


# ---- parts ----


def _named(groups, kind, radii):
	return next((g for g in groups if g.kind == kind and g.radii == radii), None)


def _compared(groups):
	"""The groups of the picture of influences: the paper's test of one range, and what else was done with it."""
	others = [g for g in groups if g.kind != "paper"]
	base = next(g for g in groups if g.kind == "paper" and g.radii == others[0].radii)
	return [base] + [
		g
		for g in others
		if g.radii == base.radii and g.kind in ("rock density", "consistent bonds", "sample of ESyS-Particle")
	]


def _tied(text):
	"""With spaces before units that do not break."""
	return re.sub(r"(?<=[\d)]) (?=%|MPa|GPa|mm|kg)", "\u00a0", text)


def _percent(spread):
	return (100 * spread).text("{:+.1f}") + " %"


def _cell(group, name, form):
	spread = group.spread(name)
	return "–" if spread is None else spread.text(form)


def _rows(groups):
	"""Label, and median and range of every figure."""
	return [
		(
			group.label,
			[
				group.spread(name).texts(form) if group.spread(name) else ("–", "")
				for name, _, _, form in _SHOWN
			],
		)
		for group in groups
	]


def _breaks(groups):
	"""Labels of the rows above which the table has a line."""
	return [
		new.label
		for old, new in zip(groups, groups[1:])
		if (old.kind == "paper", old.stiffness) != (new.kind == "paper", new.stiffness)
	]


def _write_runs(groups, path):
	with provenance.csv_writer(path) as writer:
		titles = [f"{name} [{unit or '-'}]" for name, _, unit, _ in FIGURES]
		writer.writerow(
			["group", "kind", "radius_min [m]", "radius_max [m]", "wall_stiffness [Pa]", "seed", *titles]
		)
		for group in groups:
			for record in group.records:
				measured = record.figures()
				start = [
					group.label, group.kind, *group.radii, group.stiffness,
					record.options.get("seed", "")
				]
				writer.writerow(
					start
					+ [
						"" if measured[name] is None else measured[name]
						for name, _, _, _ in FIGURES
					]
				)


def _plain(groups, said, texts, written, command, options, versions):
	return {
		"title": TITLE,
		"written": written.isoformat(),
		"command": command,
		"options": options,
		"versions": versions,
		"seconds_between_records_of_the_paper": RECORD,
		"groups": [{
			"name": group.name,
			"label": group.label,
			"kind": group.kind,
			"radii_m": list(group.radii),
			"wall_stiffness_Pa": group.stiffness,
			"spread": {name: _spread(group.spread(name)) for name, _, _, _ in FIGURES},
			"runs": [_run(record) for record in group.records],
		} for group in groups],
		"claims": [vars(claim) for claim in said],
		"effects": effects(groups),
		"engines": engines(groups),
		**texts,
	}


def _run(record):
	return {
		"folder": os.path.basename(record.folder),
		"steps": record.summary["steps"],
		"processor_s": record.summary["cpu_s"],
		**record.figures(),
	}


def _spread(spread):
	return (
		None
		if spread is None
		else {"median": float(spread.median), "smallest": float(spread.low), "largest": float(spread.high)}
	)
