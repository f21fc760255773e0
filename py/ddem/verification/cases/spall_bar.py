# GPL v2 or later, see LICENSE.
"""Spall of a bar by its reflected wave."""
import numpy as np

from yade import O
from yade.ddem.materialpoint import MaterialPoint
from yade.ddem.studies.structures import spall, spall_figures
from yade.ddem.verification import case


@case(group="concrete structures", seconds=4)
def spall_bar(check, speed=8.0, duration=40e-6):
	"""Spall of a bar

	A pulse of compression, ρ c v sin²(π t/T) with T = 40 µs, runs along a bar of plane waves and comes back from
	the free end as tension; once with elastic concrete, once with all effects. The strain of the cell that bears
	the largest tension σ, played to a material point, must give its stress. Between the free end and that cell,
	characteristics tell σ from the free end's velocity in any material, if one knows how much it flows on the way:

		2 σ = ρ c [u(t − d/c) − u(t + d/c)] − ρ c² (I₋ − I₊)

	with the growth I₋ and I₊ of ε − σ/ρc² on the way from the free end and back.

	Reference: d'Alembert's solution: the free end moves at twice the speed, and at a distance d from it the largest
	tension is ρ c v sin(2π d/cT), ρ c v from d = cT/4 on; Novikov, Divnov and Ivanov (1966): ½ ρ c Δu_fs;
	the equations of characteristics; the material point.

	Expect: the elastic bar within 0.5 %; the material point within 3 % of the largest stress, since the strain
	varies within the cell where the pulse has steepened; the characteristics within 8 % (4 % found, 2 % on half the
	size); the centre of the damage between cT/4, the nearest place that feels the whole pulse, and cT/2, from where
	on the pulses on their way out and back do not overlap.
	"""
	elastic = spall.run(speed, duration, effects=spall.OFF)
	pulse = spall.IMPEDANCE * speed
	check(
		"elastic: highest velocity of the free end [m/s]", elastic.pullback[0][0], 2 * speed, 5e-3,
		"d'Alembert: twice the speed"
	)
	check("elastic: largest tension [Pa]", elastic.stress.max(), pulse, 5e-3, "d'Alembert: ρ c v")
	check(
		"elastic: ½ ρ c Δu_fs [Pa]", elastic.spall_stress, elastic.stress.max(), 5e-3,
		"largest tension in the bar"
	)
	depth = elastic.length - elastic.places
	error = (
		np.abs(elastic.stress.max(axis=0) - spall.largest_tension(depth, speed, duration))[depth < 0.1].max()
		/ pulse
	)
	check(
		"elastic: largest tension within 10 cm of the free end, largest error over ρ c v [-]",
		error, 0, 5e-3, "d'Alembert: sin(2π d/cT)", scale=1
	)

	O.reset()
	broken = spall.run(speed, duration)
	tension, row, cell = broken.tension
	until = slice(0, row + 1)
	leg = broken.times[1] - broken.times[0]
	replayed = MaterialPoint().path(leg, strain={"xx": broken.strain[until, cell]}, steps=4, every=4).stress[:, 0]
	error = np.abs(replayed - broken.stress[until, cell]).max() / np.abs(broken.stress[until, cell]).max()
	check(
		"concrete: stress of the cell, until its largest tension [-]",
		error, 0, 0.03, "material point on the strain of the cell", scale=1
	)
	check(
		"error of the energy book [-]", max(elastic.energy_error, broken.energy_error), 0, 1e-6, "first law",
		scale=1
	)
	matched, flow = broken.matched_stress
	check(
		"concrete: ½ ρ c Δu less the flow on the characteristics [Pa]",
		matched - flow, tension, 0.08, "largest tension in the bar"
	)
	wave = spall.WAVE * duration
	check(
		"concrete: distance of the damage's centre from the free end [m]",
		broken.damage_depth, 3 / 8 * wave, 1 / 3, "from cT/4 to cT/2"
	)
	bulk = np.sqrt(30e9 + 4 / 3 * 26e9) / np.sqrt(30e9)
	check.note(
		f"Concrete bears {tension / 1e6:.1f} MPa of the {pulse / 1e6:.0f} MPa, "
		f"{1e3 * (broken.length - broken.places[cell]):.0f} mm from the free end, and ½ ρ c Δu_fs "
		f"says {broken.spall_stress / 1e6:.1f} MPa ({broken.spall_stress / bulk / 1e6:.1f} MPa with the bulk "
		"wave speed, as for metals that flow). Between the two times "
		f"that belong to the largest tension the free end loses {matched / 1e6:.1f} MPa/½ρc, of which "
		f"{flow / 1e6:.1f} are flow between that place and the free end; the "
		f"other {(broken.spall_stress - matched) / 1e6:.1f} MPa it loses before and after, as a wide zone "
		"goes on pulling while it flows. The formula takes the bar to be "
		"elastic until it breaks at once in one plane; this law flows at any tension, and the velocity goes "
		"on falling after its first, slight minimum: there is no spall strength to be read from it. "
		"An elastic bar that broke at that tension would do so "
		f"{1e3 * wave / (2 * np.pi) * np.arcsin(tension / pulse):.0f} mm from the end; flow lets the tension "
		"pass on, and damage gathers where it lasts."
	)
	check.picture(
		lambda: spall_figures.history(broken, elastic),
		"Velocity of the free end (upper left), damage along the bar (lower left), waves in the bar and, "
		"in black, where the damage exceeds 0.5 (right). Dashed: the characteristics that link the largest "
		"tension (dot) to the free end.",
	)
