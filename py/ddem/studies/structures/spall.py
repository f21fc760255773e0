# GPL v2 or later, see LICENSE.
"""Spall: a compression pulse runs along a bar, comes back from the free end as tension, and opens a crack.

One row of crossed cells whose long sides slide on rollers: plane waves, as in plate impact. The left end moves as the
pulse says and stops; the right end is free.
"""
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from yade import ConcreteDamageMat, DeformableEngine, ForceResetter, O, ddem

WAVE = np.sqrt((30e9 + 4 / 3 * 26e9) / 2400)  #: plane compression wave of the concrete [m/s]
IMPEDANCE = 2400 * WAVE  #: ρ c [Pa·s/m]
OFF = {"viscoplasticFlow": False, "damage": False, "equationOfState": False}  #: concrete that is elastic


@dataclass(frozen=True)
class History:
	"""What happened in the bar, x counted from the driven end."""
	duration: float  # of the pulse [s]
	times: np.ndarray  # of the records [s]
	places: np.ndarray  # middles of the cells [m]
	stress: np.ndarray  # axial, mean of each cell at each time (times, cells) [Pa]
	damage: np.ndarray  # likewise [-]
	surface: np.ndarray  # velocity of the free end [m/s]
	strain: np.ndarray  # axial, mean of each cell (times, cells) [-]
	energy_error: float  # see EnergyBalance.largest [-]

	@property
	def pullback(self):
		"""(largest velocity of the free end, the minimum after it) [m/s] and their rows.

		The first minimum that lies 8 % of the largest velocity below it, so that ringing behind a steep front
		does not count, and after which it rises by 1 % again; where it never does so,
		the lowest velocity of the record.
		"""
		top = int(self.surface.argmax())
		after, lowest = self.surface[top:], None
		for k in range(1, len(after)):
			if lowest is None or after[k] < after[lowest]:
				lowest = k
			elif (
				after[k] > after[lowest] + 0.01 * self.surface[top]
				and after[lowest] < 0.92 * self.surface[top]
			):
				break
		return (self.surface[top], after[lowest]), (top, top + lowest)

	@property
	def spall_stress(self):
		"""½ ρ c Δu_fs [Pa], Δu_fs being the fall of the free end's velocity from its maximum to the minimum
		after it: Novikov, Divnov and Ivanov (1966)."""
		(high, low), _ = self.pullback
		return 0.5 * IMPEDANCE * (high - low)

	@property
	def length(self):
		"""Of the bar [m]."""
		return self.places[-1] + self.places[0]

	@property
	def tension(self):
		"""(largest tension [Pa], its row, its cell)."""
		row, cell = np.unravel_index(self.stress.argmax(), self.stress.shape)
		return self.stress[row, cell], row, cell

	@property
	def arrivals(self):
		"""(times [s]) at which waves leave the free end to meet the largest tension,
		and come back from there."""
		_, row, cell = self.tension
		away = (self.length - self.places[cell]) / WAVE
		return self.times[row] - away, self.times[row] + away

	@property
	def matched_stress(self):
		"""(½ ρ c Δu, ½ ρ c² (I₋ − I₊)) [Pa], whose difference is the largest tension σ in any material;
		NaN where the record is too short.

		Where x = ± c t, σ ∓ ρ c u changes by −ρ c² I±, I being the growth on that way of ε − σ/ρc², the strain
		that is not linear elastic. From the free end (σ = 0) to the place of the largest tension and back
		again, 2 σ = ρ c Δu − ρ c² (I₋ − I₊), with the fall Δu of the free end's velocity between
		the two :attr:`arrivals`.
		"""
		_, row, cell = self.tension
		rate = np.gradient(self.strain - self.stress / (IMPEDANCE * WAVE), self.times, axis=0)
		rate = RegularGridInterpolator((self.times, self.places), rate, bounds_error=False, fill_value=None)
		way = np.linspace(0, self.length - self.places[cell], 200)
		growth = [
			np.trapezoid(rate((self.times[row] + sign * way / WAVE, self.places[cell] + way)), way / WAVE)
			for sign in (-1, 1)
		]
		before, after = np.interp(self.arrivals, self.times, self.surface, left=np.nan, right=np.nan)
		return 0.5 * IMPEDANCE * (before - after), 0.5 * IMPEDANCE * WAVE * (growth[0] - growth[1])

	@property
	def damage_depth(self):
		"""Distance of the centre of the damage from the free end [m]; NaN without damage."""
		damage = self.damage[-1]
		return self.length - damage @ self.places / damage.sum() if damage.any() else np.nan


def largest_tension(depth, speed, duration):
	"""In an elastic bar, at a distance from the free end [m] (arrays, too): what is left of the pulse on its way
	out is subtracted from what is back; d'Alembert.

	The pulse ρ c speed sin²(π t/duration) meets itself: −sin²(…(t + d/c)) + sin²(…(t − d/c)) is largest at
	t = ¾ duration, with sin(2π d/(c duration)); from d = c duration/4 on the whole pulse is felt.
	"""
	return IMPEDANCE * speed * np.sin(np.minimum(2 * np.pi * np.asarray(depth) / (WAVE * duration), np.pi / 2))


def run(speed=2.0, duration=40e-6, length=0.4, size=0.004, effects=None, until=None, step=0.8, every=4, recorders=()):
	"""Send a pulse through the bar and return its :class:`History`.

	:param speed: largest speed of the driven end [m/s]; the pulse has the stress ρ c speed
	:param duration: of the pulse, speed·sin²(π t/duration) [s]
	:param length, size: of the bar and its cells [m]
	:param effects: attributes of :yref:`ConcreteDamageMat`, such as :data:`OFF`
	:param until: end [s]; when the pulse is back at the driven end if left out
	:param step: time step over the critical one
	:param every: steps between records
	:param recorders: functions of the block that make a recorder; it is called at 50 moments
	"""
	O.materials.append(ConcreteDamageMat(label="concrete", **(effects or {})))
	block = ddem.append(ddem.mesh.rectangle(length, size, size), "concrete")
	block.hold(np.concatenate([block.boundary("bottom"), block.boundary("top")]), "y")
	driven = [O.bodies[int(i)].state for i in block.boundary("left")]
	block.hold(block.boundary("left"), "x")
	engine = DeformableEngine(rotation="none", label="deformable")
	O.engines = [ForceResetter(), engine]
	O.dt = step * engine.criticalTimeStep()
	book, writers = ddem.EnergyBalance(), [make(block) for make in recorders]

	steps = round((until or 2 * length / WAVE) / O.dt)
	files = set(np.linspace(0, steps, 50, dtype=int).tolist()) if writers else set()
	cell = np.minimum((block.mesh.centroids[:, 0] / size).astype(int), round(length / size) - 1)
	mean = lambda values: np.bincount(cell, values * block.mesh.areas) / np.bincount(cell, block.mesh.areas)
	free = block.mesh.boundary("right")
	rows = []
	for k in range(steps):
		time = O.time + 0.5 * O.dt  # velocities live half a step later
		for state in driven:
			state.vel = (speed * np.sin(np.pi * time / duration)**2 if time < duration else 0.0, 0, 0)
		if k in files:
			for write in writers:
				write()
		O.step()
		if k % every == 0:
			book.record()
			stress, strain = (values.mean(axis=1)[:, 0] for values in (block.stress, block.strain))
			rows.append(
				(
					O.time, mean(stress), mean(block.damage), block.velocities[free, 0].mean(),
					mean(strain)
				)
			)
	times, stress, damage, surface, strain = (np.array(column) for column in zip(*rows))
	return History(
		duration, times, size * (np.arange(stress.shape[1]) + 0.5), stress, damage, surface, strain,
		book.largest
	)
