# GPL v2 or later, see LICENSE.
"""Figure 2 of Zubelewicz (2018): every stress-strain curve of the report."""
import numpy as np
from matplotlib import rc_context

from yade.ddem import plots
from yade.ddem.materialpoint import MaterialPoint, concrete
from yade.ddem.verification import case, concrete_theory

INDEPENDENT = "independent implementation of the same closures (numpy)"
CONFINED = {0: (91.1e6, 0.0026), 20e6: (174e6, 0.0033), 40e6: (249e6, 0.0039), 60e6: (317e6, 0.0044)}  # confinement [Pa]: peak [Pa], strain there [-]
PULLED = {1e-3: 5.94e6, 1e-1: 8.49e6, 1: 10.08e6, 10: 11.92e6, 1e3: 16.25e6}  # rate [1/s]: peak [Pa]
LIMIT = 0.005  # strain of the cycles [-]


@case(group="concrete at a point", seconds=0.1)
def concrete_curves(check):
	"""Every curve of the report's Figure 2

	Uniaxial compression at 1/s, free and confined by 20, 40 and 60 MPa; uniaxial tension at 10⁻³ to 10³ /s; cycles between strains of ±0.005 at 1/s. The report
	prints the curves, not their numbers; what it says in words is checked here as well.

	Reference: an independent implementation of the same closures for peaks and the strains there; Zubelewicz (2018), section 4.3: "100 MPa, and in tension ten
	times smaller"; closed forms of the stiffness with the damage that the cycles leave.

	Expect: peaks within 0.5 % of the independent implementation, 91 MPa where the report says 100, 10.1 where it says ten times smaller; after the cycles a
	third of the stiffness is left in tension, and nine tenths in compression.
	"""
	parameters = concrete()
	compression = {confinement: MaterialPoint(parameters).uniaxial(rate=-1, until=-0.02, confinement=confinement) for confinement in CONFINED}
	for confinement, (strength, strain) in CONFINED.items():
		what = f"compression confined by {confinement / 1e6:g} MPa" if confinement else "free compression"
		peak = compression[confinement].peak
		check(f"{what}: peak [Pa]", -peak.stress, strength, 5e-3, INDEPENDENT)
		check(f"{what}: strain at the peak [-]", -peak.strain, strain, 0.03, INDEPENDENT + ", printed to 10⁻⁴")
	check("free compression: stress left at 2 % [Pa]", -compression[0].axial_stress[-1], 14e6, 0.04, INDEPENDENT + ", printed to 1 MPa")
	tension = {rate: MaterialPoint(parameters).uniaxial(rate=rate, until=0.006) for rate in PULLED}
	for rate, strength in PULLED.items():
		check(f"tension at {rate:g} /s: peak [Pa]", tension[rate].peak.stress, strength, 5e-3, INDEPENDENT)
	check("strength in compression at 1/s [Pa]", -compression[0].peak.stress, 100e6, 0.1, "Zubelewicz (2018), section 4.3")
	check("strength in tension at 1/s [Pa]", tension[1].peak.stress, 10e6, 0.1, "Zubelewicz (2018), section 4.3")

	point = MaterialPoint(parameters)
	cycles = point.path(LIMIT, strain={"yy": [LIMIT, -LIMIT, LIMIT, -LIMIT, 0]}, stress={"xx": 0, "zz": 0}, steps=500)
	damage = point.state.damage[0]

	def elastic(strain):
		point = MaterialPoint(parameters, effects={"damage"}, damage=damage)
		return point.path(1, strain={"yy": strain}, stress={"xx": 0, "zz": 0}, steps=1).stress[0, 1] / strain

	whole = concrete_theory.young(parameters)
	for name, strain, closed in (("tension", 1e-5, False), ("compression", -1e-3, True)):
		expected = concrete_theory.damaged_modulus(parameters, damage[:3], 1, closed)
		source = "E (1 − η N)² with the damage of the cycles"
		check(f"stiffness left in {name} after the cycles, over E [-]", elastic(strain) / whole, expected / whole, 1e-10, source)
	check.note(
		f"Two cycles leave a damage of {point.state.damage_ratio[0]:.2f}; the stiffness in tension is {100 * elastic(1e-5) / whole:.0f} % of E, that in compression "
		f"{100 * elastic(-1e-3) / whole:.0f} %."
	)
	check.picture(
		lambda: draw(compression, tension, cycles), "Stress and strain at a point of concrete, as in Figure 2 of Zubelewicz (2018): compression at 1/s (left), tension "
		"(upper right), cycles at 1/s (lower right)."
	)


def draw(compression, tension, cycles):
	with rc_context(plots.STYLE):
		fig = plots.figure(plots.PAGE, 100)
		fig.set_layout_engine("constrained")
		panels = fig.subplot_mosaic([["compression", "tension"], ["compression", "cycles"]])
		for ax in panels.values():
			ax.spines[["top", "right"]].set_visible(False)
		for confinement, result in compression.items():
			panels["compression"].plot(-100 * result.axial_strain, -result.axial_stress / 1e6, label=f"{confinement / 1e6:g} MPa")
		panels["compression"].legend(title="confining pressure", loc="upper right")
		panels["compression"].set_ylim(0, 360)
		for rate, result in tension.items():
			panels["tension"].plot(100 * result.axial_strain, result.axial_stress / 1e6, label=f"$10^{{{round(np.log10(rate))}}}$ /s")
		panels["tension"].legend(title="strain rate", loc="upper left", bbox_to_anchor=(1.0, 1.0))
		strain, stress = (np.concatenate([[0], values]) for values in (cycles.strain[:, 1], cycles.stress[:, 1]))
		panels["cycles"].plot(100 * strain, stress / 1e6)
		panels["cycles"].axhline(0, color="0.6", linewidth=0.5)
		panels["cycles"].axvline(0, color="0.6", linewidth=0.5)
		for name, ax in panels.items():
			sense = "shortening" if name == "compression" else "strain"
			ax.set_xlabel(f"{sense} [%]")
			ax.set_ylabel(("compressive " if name == "compression" else "") + "stress [MPa]")
	return fig
