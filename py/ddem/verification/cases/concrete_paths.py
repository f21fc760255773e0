# GPL v2 or later, see LICENSE.
"""Concrete at a point under several stresses at once, beside its rate equations."""
import numpy as np

from yade.ddem import plots
from yade.ddem.materialpoint import MaterialPoint, concrete
from yade.ddem.verification import case, concrete_rates, tools

SAMPLES, STEPS = 100, 8000  # of a leg
PATHS = {  # name: (targets in strain of the legs, stresses held, tolerance)
	"plane strain, compression": ([{"yy": -0.01}], {"xx": 0.0}, 2e-5),
	"plane strain, tension": ([{"yy": 0.005}], {"xx": 0.0}, 5e-5),
	"equal biaxial compression": ([{"xx": -0.005, "yy": -0.005}], {"zz": 0.0}, 2e-5),
	"tension, then shear": ([{"yy": 5e-4}, {"yy": 5e-4, "xy": 2e-3}], {}, 2e-5),
	"compression, then shear": ([{"yy": -2e-3}, {"yy": -2e-3, "xy": 4e-3}], {}, 2e-6)
}


@case(group="concrete at a point", seconds=2)
def concrete_paths(check):
	"""Plane strain, biaxial stress, turning axes

	The whole law where two or three stresses act: plane strain in compression and in tension, equal biaxial
	compression; then tension and compression without lateral strain, followed by shear, which turns the principal
	stresses away from the axes of the damage that there is.

	Reference: the equations of the report a second time, as rate equations that share no code with the plugin and
	are integrated by SciPy.

	Expect: extrapolated from two step sizes, all components of the stress within 2·10⁻⁵ of the largest,
	5·10⁻⁵ in tension.
	"""
	parameters, drawn = concrete(), {}
	for name, (legs, held, tolerance) in PATHS.items():
		# at 1/s
		rates, duration = concrete_rates.RatePoint(parameters), max(abs(value) for value in legs[0].values())
		parts = [rates.go(duration, leg, held, shares=concrete_rates.fractions(SAMPLES)) for leg in legs]
		strain, expected = (np.concatenate([part[k] for part in parts]) for k in (0, 1))

		def run(steps):
			point = MaterialPoint(parameters)
			return np.concatenate(
				[
					point.path(duration, leg, held, steps=steps, every=steps // SAMPLES).stress
					for leg in legs
				]
			)

		found = concrete_rates.extrapolated(run, STEPS)
		difference = concrete_rates.largest_difference(found, expected)
		check(
			f"{name}: largest difference of a stress, over the largest [-]",
			difference, 0, tolerance, concrete_rates.SOURCE, scale=1
		)
		drawn[name] = strain, found, expected

	def draw():
		fig, panels = tools.axes(plots.PAGE, 66, panels=3)
		dotted = {"color": "k", "linestyle": ":", "linewidth": 0.8}
		titles = ("plane strain, biaxial", *(name for name in PATHS if "shear" in name))
		for name, (strain, found, expected) in drawn.items():
			if name not in titles:
				panels[0].plot(100 * strain[:, 1], found[:, 1] / 1e6, label=name)
				panels[0].plot(100 * strain[:, 1], expected[:, 1] / 1e6, **dotted)
				continue
			ax, sheared = panels[titles.index(name)], slice(SAMPLES, None)
			for component, label in enumerate(("xx", "yy", "zz", "xy")):
				ax.plot(
					100 * strain[sheared, 3],
					found[sheared, component] / 1e6,
					label=rf"$\sigma_{{{label}}}$",
				)
				ax.plot(100 * strain[sheared, 3], expected[sheared, component] / 1e6, **dotted)
			ax.set_xlabel(r"shear strain $\varepsilon_{xy}$ [%]")
			tools.legend(ax, 2, title=name)
		panels[0].set_xlabel(r"strain $\varepsilon_{yy}$ [%]")
		panels[0].set_ylabel(r"stress, left: $\sigma_{yy}$ [MPa]")
		tools.legend(panels[0], 1)
		return fig

	check.picture(draw, "Stress on other paths at 1/s. Coloured: material point; dotted: the rate equations.")
