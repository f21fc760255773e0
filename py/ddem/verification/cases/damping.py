# GPL v2 or later, see LICENSE.
"""Damping: how motion dies."""
import numpy as np

from yade import O, Vector3, ddem
from yade.ddem import plots
from yade.ddem.verification import case, tools

EDGE = 0.01  # [m]


@case(group="dynamic relaxation", seconds=0.3)
def local_damping(check, cycles=3):
	"""Local damping of one oscillator

	The core of one equilateral triangle, its vertices held, is pushed aside or turned and let go, with Cundall's
	local damping d. The force against the motion is (1 + d) times the elastic force on the way out and (1 − d)
	times on the way back, so amplitudes fall by a fixed ratio in every half cycle, whatever its frequency:

		A₂/A₁ = √((1 − d)/(1 + d)),   t = ½π (1/√(1 − d) + 1/√(1 + d))/ω

	with ω² = 6 (λ + 3μ)/(ρ (1 − α) a²) for the core's shift (edge a, α the share of the mass in the vertices) and
	ω² = μβ_φ/(ρ a² (1/12 − α/3)) for its rotation.

	Reference: integration of m ẍ = −k x (1 ± d) over a half cycle, derived here; Cundall (1987) for the damping.

	Expect: amplitudes within 0.02 %, times within 0.1 %, a few tenths of a time step; what is lost is booked.
	"""
	drawn = {}
	for motion in ("shift", "rotation"):
		for damping in (0.1, 0.3):
			O.reset()
			material = tools.elastic(rotationStiffness=2)
			lam, mu = tools.lame(material)
			corners = EDGE * np.array([(0, 0), (1, 0), (0.5, np.sqrt(0.75))])
			block = ddem.append(ddem.mesh.Mesh(corners, np.array([[0, 1, 2]])), material)
			block.hold(block.node_ids)
			state = O.bodies[int(block.triangle_ids[0])].state
			recorder = tools.Recorder(
				lambda: (
					engine.array("corePosition")[0, 0] - 0.5 * EDGE
					if motion == "shift"
					else engine.array("coreRotation")[0]
				),
				1,
			)
			engine = tools.start(recorder.engine, step=0.02, rotation="cosserat", damping=damping)
			share = engine.vertexShare
			if motion == "shift":
				state.pos += Vector3(1e-5 * EDGE, 0, 0)
				omega = np.sqrt(6 * (lam + 3 * mu) / (material.density * (1 - share) * EDGE**2))
			else:
				state.ori = (Vector3(0, 0, 1), 1e-5)
				omega = np.sqrt(
					mu
					* material.rotationStiffness
					/ (material.density * EDGE**2 * (1 / 12 - share / 3))
				)
			half = 0.5 * np.pi * (1 / np.sqrt(1 - damping) + 1 / np.sqrt(1 + damping)) / omega
			energy = ddem.EnergyBalance()
			O.step()
			energy.record()  # what it begins with
			O.run(int((2 * cycles + 0.1) * half / O.dt), True)
			energy.record()
			times, values = recorder.times, recorder.values / recorder.values[0]
			turning = 1 + np.flatnonzero((values[1:-1] - values[:-2]) * (values[2:] - values[1:-1]) < 0)
			peaks = np.abs(values[turning])
			check(
				(
					f"amplitude after {len(peaks)} half cycles, {motion}, d = {damping:g}, over "
					"that at the start [-]"
				),
				peaks[-1],
				((1 - damping) / (1 + damping))**(len(peaks) / 2),
				2e-4,
				"half cycles of m ẍ = −k x (1 ± d)",
			)
			check(
				f"time of a half cycle, {motion}, d = {damping:g} [s]",
				times[turning[-1]] / len(peaks),
				half,
				1e-3,
				"half cycles of m ẍ = −k x (1 ± d)",
			)
			check(
				f"drift of the energy book, {motion}, d = {damping:g} [-]", energy.largest, 0, 1e-8,
				"conservation of energy", scale=1
			)
			drawn[motion, damping] = times / half, values

	def draw():
		fig, panels = tools.axes(plots.PAGE, 55, panels=2, sharey=True)
		for ax, damping in zip(panels, (0.1, 0.3)):
			for motion, style in (("shift", "-"), ("rotation", "--")):
				ax.plot(*drawn[motion, damping], style, label=motion)
			envelope = np.linspace(0, 2 * cycles, 100)
			ratio = np.sqrt((1 - damping) / (1 + damping))
			ax.plot(envelope, ratio**envelope, "k:", linewidth=0.8, label="√((1 − d)/(1 + d)) a half cycle")
			ax.plot(envelope, -ratio**envelope, "k:", linewidth=0.8)
			ax.set_title(f"d = {damping:g}", loc="left")
			ax.set_xlabel("time over that of a half cycle [-]")
		panels[0].set_ylabel("motion over that at the start [-]")
		fig.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
		return fig

	check.picture(draw, "Shift and rotation of the core with local damping, and the exact fall of the amplitude.")
