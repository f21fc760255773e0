# GPL v2 or later, see LICENSE.
"""Figure 2 of Zubelewicz (2018): every stress-strain curve of the report."""
import numpy as np
from matplotlib import rc_context

from yade.ddem import plots
from yade.ddem.materialpoint import MaterialPoint, concrete
from yade.ddem.verification import case, concrete_rates, concrete_theory

CONFINED = (0, 20e6, 40e6, 60e6)  # confining pressures [Pa]
PULLED = (1e-3, 1e-1, 10, 1e3)  # strain rates [1/s]
LIMIT = 0.005  # strain of the cycles [-]
CYCLES = (LIMIT, -LIMIT, LIMIT, -LIMIT, 0)
SAMPLES = 200  # of each curve, 50 of each leg of the cycles


@case(group="concrete at a point", seconds=4)
def concrete_curves(check):
	"""Every curve of the report's Figure 2

	Uniaxial compression at 1/s, free and confined by 20, 40 and 60 MPa; uniaxial tension at 10⁻³, 10⁻¹, 10 and
	10³ /s; two cycles between strains of ±0.005 at 1/s. The report prints the curves, not their numbers;
	the strengths and the stiffness of which it speaks are checked here as well.

	Reference: the equations of the report a second time, as rate equations that share no code with the plugin and
	are integrated by SciPy to 10⁻⁵ of the peak. Zubelewicz (2018), section 4.3: "100 MPa and in tension is ten
	times smaller". Closed forms of the stiffness with the damage that the cycles leave.

	Expect: the law is first order in its steps. Extrapolated from two step sizes, whole curves agree within 2·10⁻⁵
	of the peak in compression, 10⁻⁴ in tension (where stress sets in with the square root of the flow, and the
	error falls with the power 1½ only) and 3·10⁻⁴ in cycles (where cracks open and close); peaks with the default
	steps, 10⁻⁶, within 4·10⁻⁴. The strengths are 91 MPa where the report says 100, and 10.1 MPa where
	it says ten times smaller.
	"""
	parameters = concrete()
	tests = [(-1.0, -0.02, pressure) for pressure in CONFINED] + [(rate, 0.006, 0.0) for rate in PULLED]
	curves = {}
	for rate, until, pressure in tests:
		if rate > 0:
			name, steps, tolerance = f"tension at {rate:g} /s", 9600, 1e-4
		else:
			name, steps, tolerance = (
				f"compression confined by {pressure / 1e6:g} MPa" if pressure else "free compression",
				16000,
				2e-5,
			)
		strain, stress = concrete_rates.RatePoint(parameters).uniaxial(rate, until, pressure, SAMPLES)
		run = lambda count: (
			MaterialPoint(parameters)
			.uniaxial(rate, until, pressure, abs(until) / count, count // SAMPLES)
			.axial_stress
		)
		difference = concrete_rates.largest_difference(concrete_rates.extrapolated(run, steps), stress[:, 1])
		check(
			f"{name}: largest difference of the curve, over the peak [-]",
			difference, 0, tolerance, concrete_rates.SOURCE, scale=1
		)
		found = MaterialPoint(parameters).uniaxial(rate, until, pressure)
		check(
			f"{name}: peak with the default steps [Pa]", found.peak.stress,
			concrete_rates.peak(strain[:, 1], stress[:, 1]), 4e-4, concrete_rates.SOURCE
		)
		curves[rate, pressure] = found, strain[:, 1], stress[:, 1]
	check(
		"strength in compression at 1/s [Pa]",
		-curves[-1, 0][0].peak.stress,
		100e6,
		0.1,
		"Zubelewicz (2018), section 4.3",
	)
	check(
		"strength in tension at 1/s [Pa]",
		MaterialPoint(parameters).uniaxial(rate=1, until=0.003).peak.stress,
		10e6,
		0.02,
		"Zubelewicz (2018), section 4.3",
	)

	cycles, reference = cycled(check, parameters)
	left = {number: result.axial_stress[-1] / result.peak.stress for number, (result, _, _) in curves.items()}
	check.note(
		"Left of the peak after 2 %: "
		+ ", ".join(
			f"{100 * left[-1, pressure]:.0f} % confined by {pressure / 1e6:g} MPa" for pressure in CONFINED
		)
		+ '; the report: confining pressure "decreases strain softening". Left after 0.6 % in tension: '
		+ ", ".join(f"{100 * left[rate, 0]:.0f} % at {rate:g} /s" for rate in PULLED)
		+ '; the report: high rates "tend to steepen strain softening".'
	)
	check.picture(
		lambda: draw(curves, cycles, reference),
		"Stress and strain at a point of concrete, as in Figure 2 of Zubelewicz (2018): compression at 1/s "
		"(left), tension (upper right), cycles at 1/s (lower right). Coloured: material point with its "
		"default steps; dotted: the rate equations.",
	)


def cycled(check, parameters):
	"""The cycles and the stiffness that they leave; strain and stress along the axis, of the material point and
	of the rate equations."""
	free, samples = {"xx": 0, "zz": 0}, SAMPLES // 4

	def point(steps):
		path = MaterialPoint(parameters)
		return path.path(LIMIT, strain={"yy": CYCLES}, stress=free, steps=steps, every=steps // samples)

	rates = concrete_rates.RatePoint(parameters)
	legs = [
		rates.go(LIMIT, {"yy": target}, free, shares=concrete_rates.fractions(samples))[:2] for target in CYCLES
	]
	strain, stress = (np.concatenate(parts)[:, 1] for parts in zip(*legs))
	found = concrete_rates.extrapolated(lambda steps: point(steps).axial_stress, 8000)
	check(
		"cycles: largest difference of the curve, over the peak [-]",
		concrete_rates.largest_difference(found, stress), 0, 3e-4, concrete_rates.SOURCE, scale=1
	)

	result = point(500)
	damage = result.damage[-1]

	def modulus(strain):
		return (
			MaterialPoint(parameters, effects={"damage"}, damage=damage)
			.path(1, strain={"yy": strain}, stress=free, steps=1)
			.stress[0, 1]
			/ strain
		)

	whole, left = concrete_theory.young(parameters), {}
	for name, strain_there, closed in (("tension", 1e-5, False), ("compression", -1e-3, True)):
		left[name] = modulus(strain_there) / whole
		expected = concrete_theory.damaged_modulus(parameters, damage[:3], 1, closed) / whole
		check(
			f"stiffness left in {name} after the cycles, over E [-]", left[name], expected, 1e-10,
			"E (1 − η N)² with the damage of the cycles"
		)
	check.note(
		f"Two cycles leave a damage of {result.damage_ratio[-1]:.2f}; the stiffness is "
		f"{100 * left['tension']:.0f} % of E in tension and {100 * left['compression']:.0f} % in compression."
	)
	whole_path = (np.concatenate([[0], values[:, 1]]) for values in (result.strain, result.stress))
	return tuple(whole_path), (strain, stress)


def draw(curves, cycles, reference):
	with rc_context(plots.STYLE):
		fig = plots.figure(plots.PAGE, 105)
		fig.set_layout_engine("constrained")
		panels = fig.subplot_mosaic([["compression", "tension"], ["compression", "cycles"]])
		for name, ax in panels.items():
			ax.spines[["top", "right"]].set_visible(False)
			sense = "shortening" if name == "compression" else "strain"
			ax.set_xlabel(f"{sense} [%]")
			ax.set_ylabel(("compressive " if name == "compression" else "") + "stress [MPa]")
		dotted = {"color": "k", "linestyle": ":", "linewidth": 0.8}
		for (rate, pressure), (result, strain, stress) in curves.items():
			ax, sign = (panels["compression"], -1) if rate < 0 else (panels["tension"], 1)
			label = f"{pressure / 1e6:g} MPa" if rate < 0 else f"$10^{{{round(np.log10(rate))}}}$ /s"
			along, height = (
				[start, *values]
				for start, values in zip((0, -pressure), (result.axial_strain, result.axial_stress))
			)
			ax.plot(100 * sign * np.array(along), sign * np.array(height) / 1e6, label=label)
			ax.plot(100 * sign * strain, sign * stress / 1e6, **dotted)
		panels["compression"].legend(title="confining pressure", loc="upper right")
		panels["compression"].set_ylim(0, 360)
		panels["tension"].set_ylim(0, None)
		panels["tension"].legend(title="strain rate", loc="upper left", bbox_to_anchor=(1.0, 1.0))
		panels["cycles"].plot(100 * cycles[0], cycles[1] / 1e6)
		panels["cycles"].plot(100 * reference[0], reference[1] / 1e6, **dotted)
		panels["cycles"].axhline(0, color="0.6", linewidth=0.5)
		panels["cycles"].axvline(0, color="0.6", linewidth=0.5)
	return fig
