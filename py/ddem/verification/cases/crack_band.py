# GPL v2 or later, see LICENSE.
"""Energy of a crack and the size of the elements."""
import numpy as np

from yade import ConcreteDamageMat, O, ddem
from yade.ddem import plots
from yade.ddem.materialpoint import MaterialPoint, concrete
from yade.ddem.verification import case, tools

LENGTH, WIDTH, SPEED = 0.06, 0.04, 0.2  # of the bar [m], of each end [m/s]
OPENING = 1e-4  # up to which the energy is counted [m]
ENERGY, REFERENCE = 8e3, 0.01  # fracture energy [J/m³] of a row of this height [m]


def pulled(height, crack_band):
	"""A bar with one row of concrete of that height [m], pulled apart; returns openings of the row [m], stresses [Pa] and the material's own parameters."""
	O.reset()
	tools.elastic()
	O.materials.append(ConcreteDamageMat(label="concrete", fractureEnergy=ENERGY))
	low = height * round((LENGTH / height - 1) / 2)
	mesh = ddem.mesh.rectangle(WIDTH, LENGTH, height, pattern="alternating", regions={"row": ddem.mesh.box(1e-9, low, WIDTH - 1e-9, low + height)})
	block = ddem.append(mesh, {"": "elastic", "row": "concrete"}, crack_band=crack_band)
	platens = ddem.platens(block, velocity=-SPEED, ramp=2e-4, lateral="free", both=True)
	block.hold(np.concatenate([block.boundary("left"), block.boundary("right")]), "x")
	tools.start(*platens.engines, rotation="none")
	y = block.mesh.nodes[:, 1]
	over, under = np.isclose(y, low + height), np.isclose(y, low)
	rows = [(0.0, 0.0)]
	while rows[-1][0] < OPENING and O.time < 1e-3:
		for _ in range(10):
			O.step()
		moved = block.displacements[:, 1]
		rows.append((moved[over].mean() - moved[under].mean(), -platens.stress))
	return *np.array(rows).T, concrete(fractureEnergy=ENERGY * (REFERENCE / height if crack_band else 1))


@case(group="concrete structures", seconds=1)
def crack_band(check):
	"""Energy of a crack on three meshes

	A bar breaks in one row of concrete, 20, 10 or 5 mm high; what is above and below stays elastic, and the sides slide on rollers. The fracture energy is per
	volume, so a crack takes energy in proportion to the height of its row. With crack_band = 10 mm, G_f is multiplied by 10 mm/√(2S), and the stress becomes the
	same function of the opening: Bažant and Oh (1983).

	Reference: before it localises, the row is a material point in uniaxial strain; the ratio of energies without the correction is that of material points of
	the three heights; with it, it is 1.

	Expect: peaks within 2 % of the material point; energies until 0.1 mm within 6 % of each other with the correction, 2.1 to 1 without, where material points
	have 2.0. The strength pays for it: G_f slows the damage before the peak as well.
	"""
	heights, energies, drawn = (0.02, 0.01, 0.005), {}, {}
	for name, band in (("with", REFERENCE), ("without", None)):
		for height in heights:
			opening, stress, parameters = pulled(height, band)
			point = MaterialPoint(parameters).path(OPENING / (2 * SPEED), strain={"yy": OPENING / height}, steps=int(OPENING / height / 1e-5))
			check(f"peak {name} the correction, {1e3 * height:g} mm [Pa]", stress.max(), point.stress[:, 1].max(), 0.02, "material point in uniaxial strain")
			until = np.linspace(0, OPENING, 400)
			curves = (opening, stress), (point.strain[:, 1] * height, point.stress[:, 1])
			energies[name, height] = [np.trapezoid(np.interp(until, x, y), until) for x, y in curves]
			drawn[name, height] = opening, stress
	ratio = lambda name, which: energies[name, 0.02][which] / energies[name, 0.005][which]
	check("energy on 20 mm over that on 5 mm, with the correction [-]", ratio("with", 0), 1, 0.06, "crack band: the same energy per area")
	check("energy on 20 mm over that on 5 mm, without [-]", ratio("without", 0), ratio("without", 1), 0.1, "material points of these heights")
	check.note(
		"Energies until 0.1 mm on 20, 10 and 5 mm: " + "; ".join(
			f"{name} the correction {', '.join(f'{energies[name, height][0]:.0f}' for height in heights)} J/m²" for name in ("without", "with")
		) + ". The row localises once more, in sub-elements, so that it takes a tenth to a fifth less than the material point."
	)

	def draw():
		fig, panels = tools.axes(plots.PAGE, 60, panels=2, sharey=True)
		for ax, name in zip(panels, ("without", "with")):
			for height in heights:
				opening, stress = drawn[name, height]
				ax.plot(1e6 * opening, stress / 1e6, label=f"{1e3 * height:g} mm")
			ax.set_xlim(0, 1e6 * OPENING)
			ax.set_title("$G_f$ per volume" if name == "without" else "$G_f$ with crack band")
			ax.set_xlabel("opening of the row [µm]")
		panels[0].set_ylabel("stress [MPa]")
		panels[0].legend(title="height of the row")
		return fig

	check.picture(draw, "Stress over the opening of the row that breaks, for rows of three heights.")
