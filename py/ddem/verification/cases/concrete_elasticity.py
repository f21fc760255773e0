# GPL v2 or later, see LICENSE.
"""Concrete at a point before it flows: elastic slopes, equation of state, stiffness after damage."""
import numpy as np

from yade.ddem.materialpoint import MaterialPoint, concrete
from yade.ddem.verification import case, concrete_theory, tools


def slope(point, control, strain=-1e-5):
	"""Stress yy over strain yy, xx and zz being held at strain ("e") or free of stress ("s") [Pa]."""
	held = {name: 0.0 for name, how in zip(("xx", "zz"), control) if how == "s"}
	end = point.path(1e-3, strain={"yy": strain}, stress=held, steps=1)
	return end.stress[-1, 1] / strain


@case(group="concrete at a point", seconds=0.1)
def equation_of_state(check):
	"""Equation of state: pressure and volume

	A point is pressed from all sides and released. Equal principal stresses make M_p = ⅔ q_D 1, whose equivalent
	stress is negative under pressure, so that nothing flows even with all effects on, and the pressure follows

		p = B_0 (1 + (p/p_EOS)^n_EOS) (−ε_v)

	up and down the same way. Without it, and without flow, the slopes of stress and strain
	are those of Hooke's law.

	Reference: the equation of state of Zubelewicz (2018), section 3, whose inverse
	−ε_v = p/B_0/(1 + (p/p_EOS)^n_EOS) needs no solver; Hooke's law.

	Expect: all to round-off.
	"""
	parameters = concrete()
	point = MaterialPoint(parameters)
	strain = -0.05 / 3
	loading = point.path(1.0, strain={name: strain for name in ("xx", "yy", "zz")}, steps=1000)
	release = point.path(1.0, strain={name: 0.0 for name in ("xx", "yy", "zz")}, steps=1000)
	for name, leg in (("loading", loading), ("release", release)):
		volume = -leg.strain[:, :3].sum(axis=1)
		pressed = leg.pressure > 1e6
		expected = concrete_theory.volume_strain(parameters, leg.pressure[pressed])
		difference = np.abs(volume[pressed] - expected).max()
		check(
			f"compression at the pressure reached, {name}: largest difference [-]",
			difference, 0, 1e-10, "closed form", scale=0.05
		)
	check(
		"modulus factor at p_EOS [-]", np.interp(1.1e9, loading.pressure, loading.modulus_factor), 2, 1e-5,
		"1 + 1"
	)
	check("plastic strain [-]", np.abs(release.plastic_strain).max(), 0, 1e-15, "σ_eq = −q_D p < 0", scale=1)

	elastic = lambda control: slope(MaterialPoint(parameters, effects=()), control)
	bulk, shear = parameters["bulk"], parameters["shear"]
	check(
		"slope of uniaxial stress [Pa]", elastic("ss"), concrete_theory.young(parameters), 1e-12,
		"E = 9Bμ/(3B + μ)"
	)
	check(
		"slope in plane strain [Pa]", elastic("se"), 4 * shear * (3 * bulk + shear) / (3 * bulk + 4 * shear),
		1e-12, "E/(1 − ν²)"
	)
	check("slope of uniaxial strain [Pa]", elastic("ee"), bulk + 4 / 3 * shear, 1e-12, "B + 4μ/3")

	def draw():
		fig, (ax,) = tools.axes(height=58)
		volume = -100 * loading.strain[:, :3].sum(axis=1)
		pressure = np.linspace(0, loading.pressure[-1], 200)
		ax.plot(volume[::50], loading.pressure[::50] / 1e9, "o", markersize=3, label="loading")
		ax.plot(
			-100 * release.strain[::50, :3].sum(axis=1), release.pressure[::50] / 1e9, "x", markersize=4,
			label="release"
		)
		ax.plot(
			100 * concrete_theory.volume_strain(parameters, pressure), pressure / 1e9, "k-", linewidth=0.7,
			label="equation of state"
		)
		ax.plot(volume, 0.01 * volume * bulk / 1e9, "--", color="0.5", linewidth=0.7, label="constant $B_0$")
		ax.set_xlabel("compression $-\\varepsilon_v$ [%]")
		ax.set_ylabel("pressure [GPa]")
		tools.legend(ax, 2)
		return fig

	check.picture(draw, "Pressure over compression of volume, loading and release.")


@case(group="concrete at a point", seconds=0.1)
def damaged_stiffness(check):
	"""Stiffness after damage, open and closed

	A point is pulled to a strain of 0.5 % and let go. What damage is left makes it anisotropic; pulled a little,
	its crack is open, pressed a little, it is closed:

		E_open = E (1 − η_0 N)²,   E_closed = E (1 − ξ_c1 η_0 N)²

	along the direction that was pulled, N being the component of N_Ω there.

	Reference: Zubelewicz (2018), section 3: with Δ = 1 − η N_Ω, λ Δ⊗Δ + 2μ Δ·Δ is Hooke's law
	between σ_a/Δ_a and Δ_a ε_a.

	Expect: both slopes to round-off; the closed crack has all but its stiffness back.
	"""
	parameters = concrete()
	pulled = MaterialPoint(parameters)
	damage = pulled.uniaxial(rate=1, until=0.005).damage[-1]
	# strains at which flow is switched off and the closed crack is pressed well beyond the band of
	# 1 MPa over which it closes
	opened, closed = (
		slope(MaterialPoint(parameters, effects={"damage"}, damage=damage), "ss", strain)
		for strain in (1e-5, -1e-3)
	)
	expected = [concrete_theory.damaged_modulus(parameters, damage[:3], 1, shut) for shut in (False, True)]
	check("slope of the open crack [Pa]", opened, expected[0], 1e-10, "E (1 − η_0 N)²")
	check("slope of the closed crack [Pa]", closed, expected[1], 1e-10, "E (1 − ξ_c1 η_0 N)²")
	strain = np.linspace(-6e-4, 4e-4, 201)
	stress = np.array(
		[
			slope(MaterialPoint(parameters, effects={"damage"}, damage=damage), "ss", value) * value
			if value
			else 0.0
			for value in strain
		]
	)

	def draw():
		fig, (ax,) = tools.axes(height=55)
		modulus = np.where(strain > 0, *expected)
		ax.plot(
			1e3 * strain, concrete_theory.young(parameters) * strain / 1e6, "--", color="0.5",
			linewidth=0.7, label="intact"
		)
		ax.plot(1e3 * strain, modulus * strain / 1e6, "k-", linewidth=0.7, label="closed form")
		ax.plot(1e3 * strain[::8], stress[::8] / 1e6, "o", markersize=2.5, label="material point")
		ax.set_ylim(-30, 12)
		ax.set_xlabel("strain [10$^{-3}$]")
		ax.set_ylabel("stress [MPa]")
		tools.legend(ax, 3)
		return fig

	check.picture(
		draw,
		"Stress over strain of a point that was pulled to 0.5 % before, elastic part: the crack is open in "
		"tension and closed in compression.",
	)
	check.note(
		f"Damage {concrete_theory.damage_parameter(parameters, damage[:3])[0]:.2f}: E falls from "
		f"{concrete_theory.young(parameters) / 1e9:.1f} to {opened / 1e9:.1f} GPa with the crack open and to "
		f"{closed / 1e9:.1f} GPa with it closed."
	)
