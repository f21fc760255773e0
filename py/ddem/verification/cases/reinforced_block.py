# GPL v2 or later, see LICENSE.
"""The report's crushed block with a steel bar."""
import numpy as np
from scipy.spatial import cKDTree

from yade import O
from yade.ddem.structures import reinforced, reinforced_figures, spall
from yade.ddem.verification import case

INDEPENDENT = "independent implementation of the same equations (numpy), other treatment of closing cracks"


@case(group="concrete structures", seconds=8)
def reinforced_block(check):
	"""The report's crushed block with a steel bar

	10 cm × 20 cm of concrete, 800 triangles, a steel bar in the middle, ends held laterally; the top comes down at 10 m/s from the first step on, until nothing
	bears any more (Zubelewicz (2018), section 4.3). Three realisations of the fracture energies, and one without spread.

	Reference: the elastic wave ρ c_p v below the middle of the platen before the release from the sides is there; the first law; symmetry; an independent
	implementation for damage and rotation; what the report says in words: wedges at the ends stay undamaged, realisations have the same trend, no bearing
	capacity is left.

	Expect: 125 MPa of the wave within 2 %; the energy book closes to 10⁻⁵; less than 2 % of the wave is left after 0.2 ms, wedges with a damage below 0.1.
	"""
	wave = spall.IMPEDANCE * reinforced.VELOCITY
	early = reinforced.run(seed=None, until=8e-6, concrete=spall.OFF, recorders=[reinforced.Fields])
	x, y = early.mesh.centroids.T
	behind = (np.abs(x - reinforced.WIDTH / 2) < 0.01) & (y > 0.17) & (y < 0.19)
	elastic = -np.average(early.recorders[0].stresses[-1][behind, 1], weights=early.mesh.areas[behind])
	check("elastic wave below the platen [Pa]", elastic, wave, 0.02, "momentum: ρ c_p v")

	O.reset()
	even = reinforced.run(seed=None, until=4e-5)
	_, mirror = cKDTree(even.mesh.centroids).query(even.mesh.centroids * (-1, 1) + (reinforced.WIDTH, 0))
	damage = even.run.snapshots[-1].damage.mean(axis=1)
	check("damage without spread at 40 µs: largest difference to its mirror image [-]", np.abs(damage - damage[mirror]).max(), 0, 1e-6, "symmetry", scale=1)

	crushed = {}
	for seed in (1, 2, 3):
		O.reset()
		crushed[seed] = reinforced.run(seed=seed, until=6e-4)
	first = crushed[1]
	damages = np.array([snapshot.damage for snapshot in first.run.snapshots])
	late = first.snapshot(6e-4)[0]
	cone = (np.abs(x - reinforced.WIDTH / 2) < 0.03) & ((y > 0.185) | (y < 0.015))
	source = "Zubelewicz (2018), section 4.3"
	check("stress left after 0.2 ms, over the wave [-]", np.abs(first.stress[first.times > 2e-4]).max() / wave, 0, 0.02, source + ": reduced to zero", scale=1)
	check("mean damage of the wedges at the ends [-]", late.damage[cone].mean(), 0, 0.1, source + ": cones of undamaged material", scale=1)
	check("damage of the steel [-]", np.abs(late.damage[first.mesh.region("bar")]).max(), 0, 1e-15, "it is elastic", scale=1)
	check("largest healing between two snapshots [-]", max(-np.diff(damages, axis=0).min(), 0), 0, 1e-12, "damage only grows (eq. 8)", scale=1)
	check("mean damage at 0.6 ms [-]", first.run.series.last("damage"), 0.6, 0.1, INDEPENDENT)
	check("largest rotation at 0.6 ms [rad]", np.abs(late.rotation).max(), 0.56, 0.15, INDEPENDENT)
	times = np.linspace(5e-6, 1.2e-4, 200)
	curves = np.array([np.interp(times, one.times, one.smooth) for one in crushed.values()])
	spread = np.ptp(curves, axis=0).max() / wave
	check("realisations: largest difference of the stress until 0.12 ms, over the wave [-]", spread, 0, 0.1, source + ": similar trends", scale=1)
	final = [one.snapshot(6e-4)[0].damage.mean(axis=1) for one in crushed.values()]
	check("error of the energy book [-]", max(one.run.energy_error for one in crushed.values()), 0, 1e-5, "first law", scale=1)
	check.note(
		f"The damage of single triangles differs between realisations by {np.mean([np.abs(a - b).mean() for a, b in zip(final, final[1:])]):.2f} in the mean at the "
		f"end. The mean stress until 20 µs is {first.stress[first.times <= 2e-5].mean() / 1e6:.0f} MPa with all effects. Rotations reach π/3 at 2.5 ms: "
		"scripts/reinforced_block.py."
	)
	check.picture(
		lambda: reinforced_figures.history(first, (20e-6, 60e-6, 100e-6, 200e-6, 600e-6)), "Average stress on the top and damage at five instants, as in Figure 7 of "
		"Zubelewicz (2018)."
	)
	check.picture(lambda: reinforced_figures.realisations(crushed, 6e-4), "Three realisations of the fracture energies, as in Figure 8 of Zubelewicz (2018).")
