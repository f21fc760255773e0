# GPL v2 or later, see LICENSE.
"""A block crushed under lateral pressure, against a material point."""
import numpy as np

from yade import O
from yade.ddem.studies.structures import confined
from yade.ddem.verification import case, tools


@case(group="concrete structures", seconds=4)
def confined_block(check, size=0.02, velocity=0.25):
	"""A block under lateral pressure

	10 cm × 20 cm of concrete with smooth ends and equal fracture energies, pressed from the sides and crushed at
	2.5 /s. It deforms as one point of the material does, in plane strain, until it localises after the peak.

	Reference: a material point on the same path: σ_xx = −p, ε_zz = 0 from the beginning on
	(σ_zz is what the law makes of it), ε_yy driven.

	Expect: strengths and lateral stresses σ_zz within 0.5 %. What is missing is inertia: the sides are set moving;
	unconfined, at twice the speed 1.1 %, at four times 4.9 %.
	"""
	drawn = {}
	for pressure in (0.0, 20e6, 40e6):
		O.reset()
		block = confined.run(pressure, "smooth", None, size, velocity=velocity, strain=0.005)
		strain, stress, lateral = confined.material_point(pressure, block.rate, 0.005)
		check(
			f"strength under {pressure / 1e6:g} MPa [Pa]", block.peak[0], stress.max(), 5e-3,
			"material point"
		)
		top = block.stress.argmax()
		expected = np.interp(block.strain[top], strain, lateral)
		check(
			f"σ_zz at the peak under {pressure / 1e6:g} MPa [Pa], over the strength",
			block.lateral[top], expected, 5e-3, "material point", scale=stress.max()
		)
		rising = (block.strain > 2e-4) & (block.strain < strain[stress.argmax()])
		error = (
			np.abs(block.stress[rising] - np.interp(block.strain[rising], strain, stress)).max()
			/ stress.max()
		)
		check(
			f"stress until the peak under {pressure / 1e6:g} MPa: largest difference over the strength [-]",
			error, 0, 0.01, "material point", scale=1
		)
		check(
			f"error of the energy book under {pressure / 1e6:g} MPa [-]",
			block.energy_error, 0, 1e-5, "first law", scale=1
		)
		drawn[pressure] = block, strain, stress

	def draw():
		fig, (ax,) = tools.axes(height=60)
		for pressure, (block, strain, stress) in drawn.items():
			ax.plot(
				100 * block.strain[::6], block.stress[::6] / 1e6, "o", markersize=2.5,
				label=f"{pressure / 1e6:g} MPa"
			)
			ax.plot(100 * strain, stress / 1e6, "k-", linewidth=0.7)
		ax.plot([], [], "k-", linewidth=0.7, label="material point")
		ax.set_xlabel("strain [%]")
		ax.set_ylabel("axial stress [MPa]")
		tools.legend(ax, 4)
		return fig

	check.picture(draw, "Stress over strain of blocks under three lateral pressures.")
