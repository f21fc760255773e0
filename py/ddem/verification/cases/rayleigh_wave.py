# GPL v2 or later, see LICENSE.
"""Rayleigh's surface wave."""
import numpy as np

from yade import O, ddem
from yade.ddem import plots
from yade.ddem.verification import case, elasticity, tools

WAVELENGTH = 0.1  # [m]


@case(group="waves and vibration", seconds=2)
def rayleigh_wave(check, cells=24):
	"""Rayleigh's surface wave

	A standing surface wave: half a wavelength of the exact displacement field, between rollers (its planes of symmetry), in a block two wavelengths deep with
	a free top. Let go from rest it swings at ω = c_R k, and its shape stays. c_R is the root of Rayleigh's equation:

		(2 − s)² = 4 √(1 − s) √(1 − s c_s²/c_p²),   s = (c_R/c_s)²

	Reference: Rayleigh (1885); c_R/c_s = 0.911, 0.919, 0.927 at ν = 0.2, 0.25, 0.3 (Lamb 1904).

	Expect: the speed within 0.5 % with 24 cells to the wavelength.
	"""
	tables = {0.2: 0.911, 0.25: 0.919, 0.3: 0.927}
	for poisson, table in tables.items():
		O.reset()
		material = tools.elastic(young=60e9, poisson=poisson, density=2400)
		p, s = elasticity.speeds(material)
		c = elasticity.rayleigh_speed(material)
		check(f"root of Rayleigh's equation c_R/c_s at ν = {poisson:g} [-]", c / s, table, 1e-3, "Lamb (1904)")
		k = 2 * np.pi / WAVELENGTH
		depth = 2 * WAVELENGTH
		block = ddem.append(ddem.mesh.rectangle(WAVELENGTH / 2, depth, WAVELENGTH / cells), material)
		block.hold(np.concatenate([block.boundary("left"), block.boundary("right")]), "x")
		block.hold(block.boundary("bottom"), "y")
		slow, fast = k * np.sqrt(1 - (c / p)**2), k * np.sqrt(1 - (c / s)**2)
		ratio, amplitude = 2 * k * slow / (fast**2 + k**2), 1e-6

		def field(x, y):
			z = depth - y
			ux = -k * np.exp(-slow * z) + ratio * fast * np.exp(-fast * z)
			uz = -slow * np.exp(-slow * z) + ratio * k * np.exp(-fast * z)
			return amplitude / k * ux * np.sin(k * x), -amplitude / k * uz * np.cos(k * x)

		tools.place(block, lambda x, y: np.add((x, y), field(x, y)))
		x, y = block.mesh.nodes.T
		corner = np.flatnonzero((x < 1e-9) & (y > depth - 1e-9))[0]
		recorder = tools.Recorder(lambda: block.displacements[corner, 1], 2)
		tools.start(recorder.engine, rotation="none")
		O.run(int(4 * WAVELENGTH / c / O.dt), True)
		omega = tools.fit_frequencies(recorder.times, recorder.values, [c * k])[0]
		check(f"speed of the surface wave over c_s at ν = {poisson:g} [-]", omega / k / s, c / s, 5e-3, "Rayleigh (1885)")
	mesh, moved, times, tips = block.mesh, block.displacements.copy(), recorder.times, recorder.values
	start = np.column_stack(field(x, y))

	def draw():
		fig, (left, right) = tools.axes(plots.PAGE, 70, panels=2, width_ratios=(1, 2))
		plots.field(mesh, 1e6 * start[:, 1], r"$u_y$ at the start [µm]", ax=left, displacement=start, scale=0.1 * WAVELENGTH / np.abs(start).max(), signed=True)
		left.set_title(None)
		right.plot(1e6 * times, tips / tips[0], ".", markersize=2, label="corner of the surface")
		right.plot(1e6 * times, np.cos(c * k * times), "k-", linewidth=0.7, label=r"$\cos c_R k t$")
		right.set_xlabel("time [µs]")
		right.set_ylabel("displacement over that at the start [-]")
		tools.legend(right)
		return fig

	check.picture(draw, "Left: the standing wave at the start (ν = 0.3), displacements enlarged. Right: the surface swings.")
