# GPL v2 or later, see LICENSE.
"""Plane waves: their speed, the stress they carry, and what an interface sends back."""
import numpy as np

from yade import O, RampedTranslationEngine, ddem
from yade.ddem.verification import case, elasticity, tools

LENGTH, SPEED, RAMP = 0.4, 1.0, 30e-6  # [m], of the driven end [m/s], time over which it is reached [s]


def strip(materials, cell, cells_high=1, regions=None, **hold):
	"""A strip of crossed cells along x, its long sides held in the direction hold["sides"] ("" leaves them free)."""
	mesh = ddem.mesh.rectangle(LENGTH, cells_high * cell, cell, regions=regions)
	block = ddem.append(mesh, materials)
	if hold.get("sides"):
		block.hold(np.concatenate([block.boundary("bottom"), block.boundary("top")]), hold["sides"])
	return block


def drive(block, axis, stations, until, rotation="none", ramp=RAMP):
	"""Move the left end at SPEED along an axis (0: x, 1: y) after the ramp; returns the Recorder of the stations' velocity in that direction."""
	left = block.boundary("left")
	block.hold(left)
	push = RampedTranslationEngine(ids=[int(i) for i in left], translationAxis=(1 - axis, axis, 0), velocity=SPEED, rampTime=ramp)
	rows = [np.argmin(np.hypot(block.mesh.nodes[:, 0] - x, block.mesh.nodes[:, 1])) for x in stations]
	recorder = tools.Recorder(lambda: block.velocities[rows, axis], 4)
	tools.start(push, recorder.engine, rotation=rotation)
	O.run(int(until / O.dt), True)
	return recorder


def arrival(times, signal, level):
	"""When a signal first reaches a level [s], between records linearly."""
	k = int(np.argmax(signal >= level))
	return times[k - 1] + (level - signal[k - 1]) / (signal[k] - signal[k - 1]) * (times[k] - times[k - 1])


def measured_speed(recorder, stations):
	"""Distance of the first and the last station over the time that the front needs from one to the other [m/s], the mean over 20 % to 80 % of SPEED."""
	levels = np.linspace(0.2, 0.8, 13) * SPEED
	first, last = (np.mean([arrival(recorder.times, recorder.values[:, k], level) for level in levels]) for k in (0, -1))
	return (stations[-1] - stations[0]) / (last - first)


@case(group="waves and vibration", seconds=1)
def plane_waves(check, cell=0.004):
	"""Plane waves: speed and stress

	One end of a strip is set moving at v = 1 m/s within 30 µs, along the strip or across it, and does not change its shape. The long sides slide on rollers
	for the plane compression wave, are held along the strip for the plane shear wave, and are free for the wave in a bar. The front runs at c, and behind it
	the stress is ρ c v:

		c_p = √((B + 4μ/3)/ρ),   c_s = √(μ/ρ),   c_0 = √(E/((1 − ν²) ρ)),   σ = ρ c v

	Reference: d'Alembert's solution with the speeds of plane strain (Graff, Wave Motion in Elastic Solids, 1975, §§ 2.1 and 5.1).

	Expect: speeds within 0.1 %, stresses within 0.01 % with 25 cells or more in the front; the same with rotating cores, which follow a slow wave.
	"""
	stations = np.array([0.06, 0.26])
	kinds = {"compression": ("c_p", 0, "y", 1), "shear": ("c_s", 1, "x", 1), "bar": ("c_0", 0, "", 2)}  # symbol, direction of motion, sides held, cells high
	drawn = {}
	for rotation in ("none", "cosserat"):
		for name, (symbol, axis, sides, cells_high) in kinds.items():
			O.reset()
			material = tools.elastic()
			p, s = elasticity.speeds(material)
			c = {"c_p": p, "c_s": s, "c_0": np.sqrt(elasticity.plane_modulus(material) / material.density)}[symbol]
			block = strip(material, cell, cells_high, sides=sides)
			end = 0.3 / c + RAMP
			recorder = drive(block, axis, stations, end, rotation)
			check(f"speed of the {name} wave, {rotation} [m/s]", measured_speed(recorder, stations), c, 1e-3, f"Graff (1975): {symbol}")
			behind = (block.mesh.centroids[:, 0] > 0.05) & (block.mesh.centroids[:, 0] < 0.15)
			stress = np.average(block.stress.mean(axis=1)[behind][:, 3 if axis else 0], weights=block.area[behind])
			check(f"stress behind the front of the {name} wave, {rotation} [Pa]", -stress, material.density * c * SPEED, 1e-4, "momentum: ρ c v")
			if rotation == "none":
				drawn[name] = (recorder.times - stations[-1] / c) / RAMP, recorder.values[:, -1] / SPEED

	def draw():
		fig, (ax,) = tools.axes(height=58)
		for (name, (delay, velocity)), marker in zip(drawn.items(), "osv"):
			ax.plot(delay[::3], velocity[::3], marker, markersize=2.5, label=name)
		delay = np.linspace(-0.5, 2, 400)
		ax.plot(delay, np.clip(delay, 0, 1), "k-", linewidth=0.7, label="d'Alembert")
		ax.set_xlim(-0.5, 2)
		ax.set_xlabel("time after the front's exact arrival, over the ramp [-]")
		ax.set_ylabel("velocity over $v$ [-]")
		tools.legend(ax, 4)
		return fig

	check.picture(draw, "Velocity 0.26 m from the driven end, for the three waves, each in its own time.")


@case(group="waves and vibration", seconds=0.2)
def rebar_reflection(check, cell=0.004, ramp=10e-6):
	"""Reflection at a steel interface

	A plane compression wave comes from concrete upon steel. With the impedances Z = ρ c_p of the two, the parts of the stress that come back and that go on are

		σ_r/σ_i = (Z₂ − Z₁)/(Z₂ + Z₁),   σ_t/σ_i = 2 Z₂/(Z₂ + Z₁)

	Reference: continuity of stress and velocity at the interface (Graff, Wave Motion in Elastic Solids, 1975, § 2.1). Moduli of concrete and 304L: Zubelewicz
	(2018).

	Expect: both within 0.1 %, averaged over the plateaus.
	"""
	concrete, steel = tools.elastic("concrete"), tools.elastic("steel", **tools.STEEL)
	(c1, _), (c2, _) = elasticity.speeds(concrete), elasticity.speeds(steel)
	z1, z2 = concrete.density * c1, steel.density * c2
	block = strip({"": "concrete", "steel": "steel"}, cell, regions={"steel": ddem.mesh.box(LENGTH / 2, 0, LENGTH, cell)}, sides="y")
	end = LENGTH / 2 / c1 + ramp + 0.06 / c1
	drive(block, 0, [0.1], end, ramp=ramp)
	x, stress = block.mesh.centroids[:, 0], block.stress.mean(axis=1)[:, 0]

	def mean(low, high):
		inside = (x > low) & (x < high)
		return np.average(stress[inside], weights=block.area[inside])

	incident = -z1 * SPEED
	front = c1 * (O.time - LENGTH / 2 / c1 - ramp)  # how far the reflected wave's plateau has come back
	back = mean(LENGTH / 2 - 0.8 * front, LENGTH / 2 - 0.2 * front) - incident
	on = mean(LENGTH / 2 + 0.2 * front * c2 / c1, LENGTH / 2 + 0.8 * front * c2 / c1)
	check("stress of the incident wave [Pa]", mean(0.01, LENGTH / 2 - front - c1 * ramp), incident, 1e-3, "momentum: ρ c v")
	check("reflected part σ_r/σ_i [-]", back / incident, (z2 - z1) / (z2 + z1), 1e-3, "Graff (1975), § 2.1")
	check("transmitted part σ_t/σ_i [-]", on / incident, 2 * z2 / (z2 + z1), 1e-3, "Graff (1975), § 2.1")
	time = O.time

	def draw():
		fig, (ax,) = tools.axes(height=58)
		place = np.linspace(0, LENGTH, 1000)
		wave = lambda delay: np.clip(delay / ramp, 0, 1)
		incoming, returned = wave(time - place / c1), wave(time - (LENGTH - place) / c1) * (z2 - z1) / (z2 + z1)
		gone = wave(time - LENGTH / 2 / c1 - (place - LENGTH / 2) / c2) * 2 * z2 / (z2 + z1)
		ax.plot(x, stress / incident, ".", markersize=2, label="deformable triangles")
		ax.plot(place, np.where(place < LENGTH / 2, incoming + returned, gone), "k-", linewidth=0.7, label="exact")
		ax.axvspan(LENGTH / 2, LENGTH, color="0.92", zorder=0, linewidth=0)
		ax.text(0.25 * LENGTH, 0.3, "concrete", ha="center")
		ax.text(0.75 * LENGTH, 0.3, "steel", ha="center")
		ax.set_xlabel("$x$ [m]")
		ax.set_ylabel(r"stress over $\sigma_i$ [-]")
		tools.legend(ax)
		return fig

	check.picture(draw, "Stress along the strip after the reflection.")
