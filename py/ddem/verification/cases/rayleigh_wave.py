# GPL v2 or later, see LICENSE.
"""Rayleigh's surface wave."""
import numpy as np

from yade import O, ddem
from yade.ddem import plots
from yade.ddem.verification import case, elasticity, tools

WAVELENGTH, DEPTH = 0.1, 0.2  # [m]
WAVENUMBER = 2 * np.pi / WAVELENGTH  # [1/m]


class SurfaceWave:
	"""A standing surface wave of the exact shape, half a wavelength wide, let go from rest,
	and the frequency at which it swings."""

	def __init__(self, poisson, cells, pattern="crossed", rotation="none"):
		O.reset()
		self.material = material = tools.elastic(young=60e9, poisson=poisson, density=2400)
		extra = {"seed": 1} if pattern == "unstructured" else {}
		block = ddem.append(
			ddem.mesh.rectangle(WAVELENGTH / 2, DEPTH, WAVELENGTH / cells, pattern=pattern, **extra),
			material,
		)
		block.hold(np.concatenate([block.boundary("left"), block.boundary("right")]), "x")
		block.hold(block.boundary("bottom"), "y")
		self.mesh, self.speed = block.mesh, elasticity.rayleigh_speed(material)
		tools.place(block, lambda x, y: np.add((x, y), self.field(x, y)))
		x, y = block.mesh.nodes.T
		corner = np.flatnonzero((x < 1e-9) & (y > DEPTH - 1e-9))[0]
		recorder = tools.Recorder(lambda: block.displacements[corner, 1], 2)
		tools.start(recorder.engine, rotation=rotation)
		O.run(int(4 * WAVELENGTH / self.speed / O.dt), True)
		self.times, self.motion = recorder.times, recorder.values
		# speed [m/s]
		self.measured = (
			tools.fit_frequencies(self.times, self.motion, [self.speed * WAVENUMBER])[0] / WAVENUMBER
		)

	def field(self, x, y):
		"""Displacements u_x, u_y [m] of the exact wave at its largest (Rayleigh 1885; Graff 1975, § 6.1)."""
		p, s = elasticity.speeds(self.material)
		slow, fast, depth = (
			WAVENUMBER * np.sqrt(1 - (self.speed / p)**2),
			WAVENUMBER * np.sqrt(1 - (self.speed / s)**2),
			DEPTH - y,
		)
		ratio, amplitude = 2 * WAVENUMBER * slow / (fast**2 + WAVENUMBER**2), 1e-6 / WAVENUMBER
		along = -WAVENUMBER * np.exp(-slow * depth) + ratio * fast * np.exp(-fast * depth)
		across = -slow * np.exp(-slow * depth) + ratio * WAVENUMBER * np.exp(-fast * depth)
		return amplitude * along * np.sin(WAVENUMBER * x), -amplitude * across * np.cos(WAVENUMBER * x)


@case(group="waves and vibration", seconds=3)
def rayleigh_wave(check, cells=24):
	"""Rayleigh's surface wave

	A standing surface wave: half a wavelength of the exact displacement field, between rollers (its planes of
	symmetry), in a block two wavelengths deep with a free top. Let go from rest it swings at ω = c_R k, and its
	shape stays. c_R is the root of Rayleigh's equation:

		(2 − s)² = 4 √(1 − s) √(1 − s c_s²/c_p²),   s = (c_R/c_s)²

	Reference: Rayleigh (1885), with his closed form √(2 − 2/√3) at ν = ¼ (λ = μ) for the root itself. Order: Strang
	and Fix (1973), linear triangles.

	Expect: the speed within 0.4 % with 24 cells to the wavelength, and an error that falls with the square of their
	size; on an unstructured mesh with rotating cores, β_φ = 2, within 0.6 %.
	"""
	source = "Rayleigh (1885)"
	waves = {poisson: SurfaceWave(poisson, cells) for poisson in (0.2, 0.25, 0.3)}
	for poisson, wave in waves.items():
		c, s = wave.speed, elasticity.speeds(wave.material)[1]
		if poisson == 0.25:
			check(
				"root of Rayleigh's equation c_R/c_s at ν = 0.25 [-]",
				c / s,
				np.sqrt(2 - 2 / np.sqrt(3)),
				1e-12,
				"Rayleigh (1885), λ = μ",
			)
		check(f"c_R/c_s at ν = {poisson:g} [-]", wave.measured / s, c / s, 5e-3, source)
	coarse, wave = SurfaceWave(0.25, cells // 2), waves[0.25]
	order = np.log2((coarse.measured - coarse.speed) / (wave.measured - wave.speed))
	check("order of the speed at ν = 0.25 [-]", order, 2, 5e-2, "Strang and Fix (1973), linear triangles")
	irregular = SurfaceWave(0.25, cells, "unstructured", "cosserat")
	s = elasticity.speeds(irregular.material)[1]
	check(
		"c_R/c_s at ν = 0.25, unstructured, cosserat [-]", irregular.measured / s, irregular.speed / s, 1e-2,
		source
	)
	x, y = wave.mesh.nodes.T
	start = np.column_stack(wave.field(x, y))

	def draw():
		fig, (left, right) = tools.axes(plots.PAGE, 70, panels=2, width_ratios=(1, 2))
		plots.field(
			wave.mesh, 1e6 * start[:, 1], r"$u_y$ at the start [µm]", ax=left, displacement=start,
			scale=0.1 * WAVELENGTH / np.abs(start).max(), signed=True
		)
		left.set_title(None)
		right.plot(
			1e6 * wave.times, wave.motion / wave.motion[0], ".", markersize=2, label="corner of the surface"
		)
		right.plot(
			1e6 * wave.times, np.cos(wave.speed * WAVENUMBER * wave.times), "k-", linewidth=0.7,
			label=r"$\cos c_R k t$"
		)
		right.set_xlabel("time [µs]")
		right.set_ylabel("displacement over that at the start [-]")
		tools.legend(right)
		return fig

	check.picture(
		draw,
		"Left: the standing wave at the start (ν = 0.25), displacements enlarged. Right: the surface swings.",
	)
