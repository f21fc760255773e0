# GPL v2 or later, see LICENSE.
"""What Zubelewicz (2018), section 4.3, says of the crushed block with a steel bar, sentence by sentence,
and what is measured here."""
import itertools

import numpy as np

from yade import O

from .reinforced import FINAL, HEIGHT, WIDTH, Fields

CORNER = 0.03  # side of the squares in the corners [m]


def statements(even, crushed):
	"""List of (the report's words, what is measured).

	:param even: :class:`reinforced.Crushed` with one fracture energy for all, for 40 µs at least
	:param crushed: list of realisations, for 0.6 ms at least
	"""
	first, end = crushed[0], crushed[0].times[-1]
	x, y = np.abs(first.mesh.centroids - (WIDTH / 2, HEIGHT / 2)).T
	above = first.mesh.centroids[:, 1] > HEIGHT / 2
	corners = (x > WIDTH / 2 - CORNER) & (y > HEIGHT / 2 - CORNER)
	place, when = even.first_damaged()
	each = lambda measure: ", ".join(f"{measure(one):.2f}" for one in crushed)
	both = lambda measure, digits=2: " and ".join(f"{measure(upper):.{digits}f}" for upper in (True, False))
	mean = lambda one, time, zone: both(lambda upper: one.mean_damage(time, zone & (above == upper)))
	apart = [
		np.average(np.abs(a.damage(FINAL) - b.damage(FINAL)), weights=a.mesh.areas)
		for a, b in itertools.combinations(crushed, 2)
	]
	return [
		(
			"loading continues until the load bearing capacity is reduced to zero",
			f"the stress stays below 2 % of the wave, {first.wave / 1e6:.0f} MPa, after "
			+ ", ".join(f"{1e6 * one.unloaded():.0f}" for one in crushed)
			+ " µs",
		),
		(
			"initially, damages are formed in the upper corners",
			(
				f"without spread of G_f damage first passes 0.1 at ({1e3 * place[0]:.0f}, "
				f"{1e3 * place[1]:.0f}) mm, {1e6 * when:.0f} µs after the blow; with it the mean "
				f"damage at 20 µs is {each(lambda one: one.mean_damage(20e-6, corners & above))} in "
				f"squares of {1e3 * CORNER:.0f} mm at the upper corners, "
				f"{each(lambda one: one.mean_damage(20e-6, above))} in the upper half, "
				f"{each(lambda one: one.mean_damage(20e-6, ~above))} in the lower"
			),
		),
		(
			"then, the damages are spreading down",
			(
				f"without spread of G_f damage above 0.1 reaches {1e3 * even.depth(20e-6):.0f} mm "
				f"below the top at 20 µs and {1e3 * even.depth(40e-6):.0f} mm at 40 µs, along the "
				f"sides; mean damage in upper and lower corners {mean(first, 40e-6, corners)} at "
				f"40 µs, {mean(first, 70e-6, corners)} at 70 µs"
			),
		),
		(
			"the upper part experiences heavy damages",
			"mean damage above and below mid-height: "
			+ ", ".join(
				f"{mean(first, time, np.ones_like(above))} at {1e6 * time:.0f} µs"
				for time in (40e-6, 70e-6, FINAL)
			),
		),
		(
			"lateral deformation is significant",
			(
				"largest lateral displacement above and below mid-height at 0.6 ms: "
				f"{both(lambda upper: 1e3 * first.spread(FINAL, upper), 1)} mm"
			),
		),
		(
			"rotations become significant in the upper corners, in the range π/3",
			"largest rotation above and below mid-height: "
			+ ", ".join(
				f"{both(lambda upper: first.rotation(time, upper)[0])} rad at {1e3 * time:.1f} ms"
				for time in (FINAL, end)[: 1 + (end > 1.1 * FINAL)]
			)
			+ "; the one above at ({:.0f}, {:.0f}) mm; π/3 is 1.05".format(
				*(1e3 * first.rotation(FINAL)[1])
			),
		),
		*(
			(
				(
					"stress plots of the realisations exhibit similar trends",
					f"they differ by at most {trend(crushed) / 1e6:.0f} MPa until 0.12 ms",
				),
				(
					"the mechanisms of final fracture are not quite the same",
					"the damage of a triangle differs between two realisations by "
					+ ", ".join(f"{value:.2f}" for value in apart)
					+ " in the mean",
				),
			)
			if apart
			else ()
		),
		(
			"cones of undamaged material are present near the top and bottom surfaces",
			"mean damage of wedges of 45° at the top and bottom: "
			+ ", ".join(both(lambda upper: one.mean_damage(FINAL, one.wedge(upper))) for one in crushed),
		),
		(
			"damages are localized within certain zones; large chunks of concrete remain intact",
			"share of the concrete with a damage above 0.9: "
			+ each(lambda one: one.share(FINAL, 0.9, 1))
			+ ", below 0.1: "
			+ each(lambda one: one.share(FINAL, 0, 0.1)),
		),
	]


def trend(crushed):
	"""Largest difference [Pa] of the smoothed stress between realisations from 5 µs to 0.12 ms."""
	times = np.linspace(5e-6, 1.2e-4, 200)
	return float(np.ptp([np.interp(times, one.times, one.smooth) for one in crushed], axis=0).max())


#: zones around the bar, of centroids relative to its middle [m]
ZONES = {
	"above": lambda x, y: (np.abs(x) < 0.007) & (y > 0.01) & (y < 0.04),
	"below": lambda x, y: (np.abs(x) < 0.007) & (y < -0.01) & (y > -0.04),
	"diagonally below": lambda x, y: (np.abs(x) > 0.007) & (np.abs(x) < 0.025) & (y < -0.01) & (y > -0.04),
	"at the sides": lambda x, y: (np.abs(y) < 0.007) & (np.abs(x) > 0.01) & (np.abs(x) < 0.03),
}


def with_and_without_bar(crush, **settings):
	"""The block with the bar and without it, {True: …, False: …}, on 3200 triangles, all fracture energies equal,
	in the same time steps.

	:param crush: :func:`reinforced.run`, or a function that calls it
	"""
	crushed = {}
	for bar in (True, False):
		O.reset()
		crushed[bar] = crush(
			size=0.005, seed=None, bar=bar, recorders=[Fields], dt=None if bar else crushed[True].run.dt,
			**settings
		)
	return crushed


def shielding(crushed, arrival=40e-6, late=70e-6):
	"""What the bar does to the material around it: {zone: ((largest compression [Pa] until the arrival [s] with it,
	without it), (damage at the later time, …))}.

	:param crushed: see :func:`with_and_without_bar`
	"""
	measure = lambda one, zone: (one.recorders[0].compression(zone, arrival), one.mean_damage(late, zone))
	return {
		name: tuple(zip(*(measure(crushed[bar], zone) for bar in (True, False))))
		for name, zone in zones(crushed[True].mesh).items()
	}


def zones(mesh):
	"""Masks of the triangles by name, see :data:`ZONES`."""
	x, y = (mesh.centroids - (WIDTH / 2, HEIGHT / 2)).T
	return {**{name: zone(x, y) for name, zone in ZONES.items()}, "all but the bar": mesh.regions == 0}
