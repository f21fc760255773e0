# GPL v2 or later, see LICENSE.
"""Spall of a bar by its reflected wave."""
import numpy as np

from yade import O
from yade.ddem.materialpoint import MaterialPoint
from yade.ddem.structures import spall, spall_figures
from yade.ddem.verification import case


@case(group="concrete structures", seconds=4)
def spall_bar(check, speed=8.0, duration=40e-6):
	"""Spall of a bar

	A pulse of compression, ρ c v sin²(π t/40 µs), runs along a bar of plane waves and comes back from the free end as tension; once with elastic concrete, once
	with all effects. The strain of the cell that bears the largest tension, played to a material point, must give its stress.

	Reference: d'Alembert's solution: the free end moves at twice the speed, and the tension is ρ c v; Novikov, Divnov and Ivanov (1966): ½ ρ c Δu_fs; the
	material point.

	Expect: the elastic bar within 0.5 %; the material point within 3 % of the largest stress, since the strain varies within the cell where the pulse has
	steepened; the formula gives twice the tension that concrete bears.
	"""
	elastic = spall.run(speed, duration, effects=spall.OFF)
	pulse = spall.IMPEDANCE * speed
	check("elastic: highest velocity of the free end [m/s]", elastic.pullback[0][0], 2 * speed, 5e-3, "d'Alembert: twice the speed")
	check("elastic: largest tension [Pa]", elastic.stress.max(), pulse, 5e-3, "d'Alembert: ρ c v")
	check("elastic: ½ ρ c Δu_fs [Pa]", elastic.spall_stress, elastic.stress.max(), 5e-3, "largest tension in the bar")

	O.reset()
	broken = spall.run(speed, duration)
	row, cell = np.unravel_index(broken.stress.argmax(), broken.stress.shape)
	until = slice(0, row + 1)
	leg = broken.times[1] - broken.times[0]
	replayed = MaterialPoint().path(leg, strain={"xx": broken.strain[until, cell]}, steps=4, every=4).stress[:, 0]
	error = np.abs(replayed - broken.stress[until, cell]).max() / np.abs(broken.stress[until, cell]).max()
	check("concrete: stress of the cell against a material point, until its largest tension [-]", error, 0, 0.03, "material point on the strain of the cell", scale=1)
	check("error of the energy book [-]", max(elastic.energy_error, broken.energy_error), 0, 1e-6, "first law", scale=1)
	check.note(
		f"Concrete bears {broken.stress.max() / 1e6:.1f} MPa of the {pulse / 1e6:.0f} MPa, {1e3 * (0.4 - broken.places[cell]):.0f} mm from the free end; ½ ρ c Δu_fs says "
		f"{broken.spall_stress / 1e6:.1f} MPa. The formula takes the bar to be elastic until it breaks at once in one plane; in this law concrete flows at any tension, "
		"and a wide zone goes on pulling at the free end after the peak. Brittle concrete comes closer: see scripts/spall_bar.py."
	)
	check.picture(
		lambda: spall_figures.history(broken, elastic), "Velocity of the free end (upper left), damage along the bar (lower left), waves in the bar and, in black, where "
		"the damage exceeds 0.5 (right)."
	)
