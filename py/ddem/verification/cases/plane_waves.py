# GPL v2 or later, see LICENSE.
"""Plane waves: their speed, the stress they carry, and what an interface sends back."""
import numpy as np

from yade import O, RampedTranslationEngine, ddem
from yade.ddem.verification import case, elasticity, tools

LENGTH, SPEED, RAMP = 0.4, 1.0, 30e-6  # [m], of the driven end [m/s], time over which it is reached [s]


def strip(materials, size, pattern="crossed", height=None, regions=None, sides=""):
	"""A strip along x, one cell high unless *height* [m] is given, its long sides held in the directions *sides*
	("" leaves them free)."""
	extra = {"seed": 1} if pattern == "unstructured" else {}
	block = ddem.append(
		ddem.mesh.rectangle(LENGTH, height or size, size, pattern=pattern, regions=regions, **extra), materials
	)
	if sides:
		block.hold(np.concatenate([block.boundary("bottom"), block.boundary("top")]), sides)
	return block


def drive(block, axis, stations, until, rotation="none", ramp=RAMP):
	"""Move the left end at SPEED along an axis (0: x, 1: y) after the ramp; returns the places x [m] of the nodes
	nearest to the stations, and the Recorder of their velocity in that direction."""
	left = block.boundary("left")
	block.hold(left)
	push = RampedTranslationEngine(
		ids=[int(i) for i in left], translationAxis=(1 - axis, axis, 0), velocity=SPEED, rampTime=ramp
	)
	rows = [np.argmin(np.hypot(block.mesh.nodes[:, 0] - x, block.mesh.nodes[:, 1])) for x in stations]
	recorder = tools.Recorder(lambda: block.velocities[rows, axis], 4)
	tools.start(push, recorder.engine, rotation=rotation)
	O.run(int(until / O.dt), True)
	return block.mesh.nodes[rows, 0], recorder


def arrival(times, signal, level):
	"""When a signal first reaches a level [s], between records linearly."""
	k = int(np.argmax(signal >= level))
	return times[k - 1] + (level - signal[k - 1]) / (signal[k] - signal[k - 1]) * (times[k] - times[k - 1])


def measured_speed(places, recorder):
	"""Distance of the first and the last place over the time that the front needs from one to the other [m/s], the
	mean over 20 % to 80 % of SPEED."""
	levels = np.linspace(0.2, 0.8, 13) * SPEED
	first, last = (
		np.mean([arrival(recorder.times, recorder.values[:, k], level) for level in levels]) for k in (0, -1)
	)
	return (places[-1] - places[0]) / (last - first)


def of_plane_stress(material):
	"""Moduli with which plane strain behaves like plane stress of this material:
	the same μ, and λ' = 2λμ/(λ + 2μ)."""
	lam, mu = tools.lame(material)
	return {"bulk": 2 * lam * mu / (lam + 2 * mu) + 2 / 3 * mu, "shear": mu, "density": material.density}


@case(group="waves and vibration", seconds=3)
def plane_waves(check, size=0.004):
	"""Plane waves and waves in bars: speed and stress

	One end of a strip is set moving at v = 1 m/s within 30 µs, along the strip or across it, and does not change
	its shape. The long sides slide on rollers for the plane compression wave, are held along the strip for the
	plane shear wave, and are free for the wave in a bar, much lower than the wave is long: in plane strain, and in
	plane stress as a thin bar has it, by moduli with which plane strain behaves so (λ' = 2λμ/(λ + 2μ)). The front
	runs at c, and behind it the mean stress is ρ c v:

		c_p = √((B + 4μ/3)/ρ),   c_s = √(μ/ρ),   σ = ρ c v

		c_0 = √(E/((1 − ν²) ρ)) in plane strain,   c_0 = √(E/ρ) in plane stress

	Crossed cells without rotation; an unstructured mesh with rotating cores, β_φ = 2, which follow a slow wave.

	Reference: d'Alembert's solution (Graff, Wave Motion in Elastic Solids, 1975, § 2.1),
	with the speeds of plane waves (ibid., § 5.1).

	Expect: speeds within 0.04 %, stresses within 3e-5 with 25 triangles or more in the front.
	"""
	stations = np.array([0.06, 0.26])
	# direction of motion, sides held, height
	kinds = {
		"compression": (0, "y", None),
		"shear": (1, "x", None),
		"bar, plane strain": (0, "", 2 * size),
		"bar, plane stress": (0, "", 2 * size),
	}
	drawn = {}
	for pattern, rotation in (("crossed", "none"), ("unstructured", "cosserat")):
		for name, (axis, sides, height) in kinds.items():
			O.reset()
			material = tools.elastic()
			p, s = elasticity.speeds(material)
			modulus = material.young if name.endswith("stress") else elasticity.plane_modulus(material)
			c = {"compression": p, "shear": s}.get(name, np.sqrt(modulus / material.density))
			simulated = (
				tools.elastic("simulated", **of_plane_stress(material))
				if name.endswith("stress")
				else material
			)
			block = strip(
				simulated, size, pattern, height if pattern == "crossed" else 4 * size, sides=sides
			)
			places, recorder = drive(block, axis, stations, 0.3 / c + RAMP, rotation)
			where = f"{name}, {pattern}, {rotation}"
			check(
				f"speed, {where} [m/s]", measured_speed(places, recorder), c, 7e-4,
				"Graff (1975), § 2.1" if height else "Graff (1975), § 5.1"
			)
			behind = (block.mesh.centroids[:, 0] > 0.05) & (block.mesh.centroids[:, 0] < 0.15)
			stress = np.average(
				block.stress.mean(axis=1)[behind][:, 3 if axis else 0], weights=block.area[behind]
			)
			check(
				f"stress behind the front, {where} [Pa]", -stress, material.density * c * SPEED, 5e-5,
				"momentum: ρ c v"
			)
			if pattern == "crossed":
				drawn[name] = (recorder.times - places[-1] / c) / RAMP, recorder.values[:, -1] / SPEED

	def draw():
		fig, (ax,) = tools.axes(height=62)
		for (name, (delay, velocity)), marker in zip(drawn.items(), "osv^"):
			ax.plot(delay[::3], velocity[::3], marker, markersize=2.5, label=name)
		delay = np.linspace(-0.5, 1.2, 400)
		ax.plot(delay, np.clip(delay, 0, 1), "k-", linewidth=0.7, label="d'Alembert")
		ax.set_xlim(-0.5, 1.2)
		ax.set_xlabel("time after the exact arrival, over the ramp [-]")
		ax.set_ylabel("velocity over $v$ [-]")
		tools.legend(ax)
		return fig

	check.picture(
		draw, "Velocity 0.26 m from the driven end, crossed cells, for the four waves, each in its own time."
	)


@case(group="waves and vibration", seconds=0.5)
def rebar_reflection(check, size=0.004, ramp=10e-6):
	"""Reflection at a steel interface

	A plane wave comes from concrete upon steel: a compression wave on crossed cells without rotation, and a shear
	wave on an unstructured mesh with rotating cores, β_φ = 2. With the impedances Z = ρ c of the two, c being c_p
	or c_s, the parts of the stress that come back and that go on are

		σ_r/σ_i = (Z₂ − Z₁)/(Z₂ + Z₁),   σ_t/σ_i = 2 Z₂/(Z₂ + Z₁)

	Reference: continuity of stress and velocity at the interface (Graff, Wave Motion in Elastic Solids, 1975, §
	2.2). Moduli of concrete and 304L: Zubelewicz (2018).

	Expect: all within 1e-3, on crossed cells within 1e-4, averaged over the plateaus.
	"""
	drawn = None
	for axis, pattern, rotation, tolerance in (
		(0, "crossed", "none", 1e-4),
		(1, "unstructured", "cosserat", 1.6e-3),
	):
		O.reset()
		concrete, steel = tools.elastic("concrete"), tools.elastic("steel", **tools.STEEL)
		c1, c2 = elasticity.speeds(concrete)[axis], elasticity.speeds(steel)[axis]
		z1, z2 = concrete.density * c1, steel.density * c2
		height = size if pattern == "crossed" else 4 * size
		regions = {"steel": ddem.mesh.box(LENGTH / 2, 0, LENGTH, height)}
		block = strip(
			{"": "concrete", "steel": "steel"}, size, pattern, height, regions, sides="x" if axis else "y"
		)
		drive(block, axis, [0.1], LENGTH / 2 / c1 + ramp + 0.06 / c1, rotation, ramp)
		x, stress = block.mesh.centroids[:, 0], block.stress.mean(axis=1)[:, 3 if axis else 0]

		def mean(low, high):
			inside = (x > low) & (x < high)
			return np.average(stress[inside], weights=block.area[inside])

		incident = -z1 * SPEED
		front = c1 * (O.time - LENGTH / 2 / c1 - ramp)  # how far the reflected wave's plateau has come back
		back = mean(LENGTH / 2 - 0.8 * front, LENGTH / 2 - 0.2 * front) - incident
		on = mean(LENGTH / 2 + 0.2 * front * c2 / c1, LENGTH / 2 + 0.8 * front * c2 / c1)
		plateau = LENGTH / 2 - front - c1 * ramp  # what the reflected wave has not yet reached
		name = f"{'shear' if axis else 'compression'}, {pattern}, {rotation}"
		check(
			f"stress of the incident wave, {name} [Pa]", mean(0.2 * plateau, 0.8 * plateau), incident,
			tolerance, "momentum: ρ c v"
		)
		check(
			f"reflected part σ_r/σ_i, {name} [-]", back / incident, (z2 - z1) / (z2 + z1), tolerance,
			"Graff (1975), § 2.2"
		)
		check(
			f"transmitted part σ_t/σ_i, {name} [-]", on / incident, 2 * z2 / (z2 + z1), tolerance,
			"Graff (1975), § 2.2"
		)
		drawn = drawn or (x, stress / incident, O.time, c1, c2, z1, z2)

	def draw():
		fig, (ax,) = tools.axes(height=58)
		x, stress, time, c1, c2, z1, z2 = drawn
		place = np.linspace(0, LENGTH, 1000)
		wave = lambda delay: np.clip(delay / ramp, 0, 1)
		incoming, returned = wave(time - place / c1), wave(time - (LENGTH - place) / c1) * (z2 - z1) / (z2 + z1)
		gone = wave(time - LENGTH / 2 / c1 - (place - LENGTH / 2) / c2) * 2 * z2 / (z2 + z1)
		ax.plot(x, stress, ".", markersize=2, label="deformable triangles")
		ax.plot(
			place, np.where(place < LENGTH / 2, incoming + returned, gone), "k-", linewidth=0.7,
			label="exact"
		)
		ax.axvspan(LENGTH / 2, LENGTH, color="0.92", zorder=0, linewidth=0)
		ax.text(0.25 * LENGTH, 0.3, "concrete", ha="center")
		ax.text(0.9 * LENGTH, 0.3, "steel", ha="center")
		ax.set_xlabel("$x$ [m]")
		ax.set_ylabel(r"stress over $\sigma_i$ [-]")
		tools.legend(ax)
		return fig

	check.picture(draw, "Stress along the strip after the reflection, compression wave.")
