# GPL v2 or later, see LICENSE.
"""What can be tuned in each model and what is measured: names, units for people, scaling laws, starts and bounds.
Needs no YADE."""
import math
from dataclasses import dataclass, field

from .calibration import Parameter

_REACH = 20.0  # parameters without a range of their own may become so many times larger or smaller than their start


@dataclass(frozen=True)
class Quantity:
	"""A number with its unit for people: shown = value/factor."""
	name: str  # attribute of the material, or measure of the test
	symbol: str
	unit: str
	factor: float
	meaning: str

	def shown(self, value, digits=4):
		return f"{value / self.factor:.{digits}g}{'' if self.unit == '°' else ' '}{self.unit}".strip()

	@property
	def title(self):
		return f"{self.symbol} [{self.unit}]" if self.unit else self.symbol


@dataclass(frozen=True)
class Tunable(Quantity):
	"""A parameter of a material that can be tuned."""
	laws: dict = field(default_factory=dict)  # measure -> elasticity that follows from dimensions
	span: tuple = None  # lower and upper bound, where they do not follow the start


MEASURES = {
	q.name: q for q in (
		Quantity(
			"young",
			"E",
			"GPa",
			1e9,
			"Young's modulus: slope of the compression test between 20 and 60 % of the strength",
		),
		Quantity("ucs", "UCS", "MPa", 1e6, "strength in compression: largest stress"),
		Quantity("tensile", "σ_t", "MPa", 1e6, "strength in tension: largest stress of the tension test"),
	)
}

_STRENGTHS = {"ucs": 1.0, "tensile": 1.0}
TUNABLES = {
	"rigid": {
		t.name: t for t in (
			Tunable("young", "E", "GPa", 1e9, "Young's modulus of the bonds", {"young": 1.0}),
			Tunable("poisson", "ν", "", 1, "Poisson's ratio of the bonds", span=(0.01, 0.49)),
			Tunable(
				"cohesion",
				"C",
				"MPa",
				1e6,
				"shear strength of the bonds without normal stress",
				_STRENGTHS,
			),
			Tunable(
				"bondFrictionAngle",
				"φ",
				"°",
				math.radians(1),
				"friction angle of the bonds",
				span=(math.radians(5), math.radians(75)),
			),
			Tunable(
				"tensileStrength",
				"f_t",
				"MPa",
				1e6,
				"tension cut-off of the bonds; above C/tan φ it has no effect",
			),
		)
	},
	"deformable": {
		t.name: t for t in (
			Tunable(
				"young",
				"E",
				"GPa",
				1e9,
				"Young's modulus of the triangles: B and μ in a fixed ratio",
				{"young": 1.0},
			),
			Tunable("poisson", "ν", "", 1, "Poisson's ratio of the triangles", span=(0.01, 0.49)),
			Tunable("bulk", "B", "GPa", 1e9, "bulk modulus", {"young": 0.5}),
			Tunable("shear", "μ", "GPa", 1e9, "shear modulus", {"young": 0.5}),
			Tunable("strength", "σ_p0", "MPa", 1e6, "strength in the flow rule", _STRENGTHS),
			Tunable(
				"friction",
				"q_0",
				"",
				1,
				"friction of the flow rule without pressure",
				span=(0.05, 0.95),
			),
			Tunable("fractureEnergy", "G_f", "kJ/m³", 1e3, "mean fracture energy"),
			Tunable("flowFactor", "Λ_0", "", 1, "factor of the flow rate"),
			Tunable("damageExponent", "n_f", "", 1, "exponent of the damage parameter"),
		)
	},
}

#: parameters tuned for a target when nothing else is asked for, the first one not taken by another target
_USUAL = {
	"rigid": {"young": ("young", ), "ucs": ("cohesion", ), "tensile": ("bondFrictionAngle", )},
	"deformable": {"young": ("young", ), "ucs": ("strength", ), "tensile": ("friction", )},
}
#: attribute of the material that sets its strength
_STRENGTH = {"rigid": "cohesion", "deformable": "strength"}


def usual(model, targets):
	"""Parameters to tune for these targets, names of measures, where nobody said which."""
	names = [_USUAL[model][target][0] for target in MEASURES if target in targets]
	if "tensile" in targets and "ucs" not in targets:
		names[-1] = _STRENGTH[model]
	return names


def starts(model, targets, material):
	"""Starting values by scaling laws: the material's own moduli or strengths, all multiplied by one number so
	that they suit the targets.

	:param targets: measure -> value [Pa]
	:param material: attribute -> value of the material as it is
	:returns: attribute -> value for every parameter of TUNABLES that *material* has
	"""
	start = {name: material[name] for name in TUNABLES[model] if name in material}
	moduli = [name for name in ("young", "bulk", "shear") if name in start]
	if "young" in targets:
		stiffer = targets["young"] / material["young"]
		start.update((name, stiffer * material[name]) for name in moduli)
	# the strengths of Zubelewicz's concrete are about half and a fourteenth of σ_p0, those of bonded spheres
	# about C and two fifths of it
	share = {"rigid": {"ucs": 1.0, "tensile": 0.4}, "deformable": {"ucs": 0.5, "tensile": 0.07}}[model]
	for target in ("ucs", "tensile"):
		if target in targets:
			start[_STRENGTH[model]] = targets[target] / share[target]
			break
	return start


def parameters(model, names, start, bounds=None):
	"""The :class:`calibration.Parameter` of these names.

	:param start: name -> value
	:param bounds: name -> (lower, upper), where not those of TUNABLES or a twentieth and twenty times the start
	:raises ValueError: a name that cannot be tuned, both kinds of moduli, no start, a start outside its bounds
	"""
	known = TUNABLES[model]
	for name in names:
		if name not in known:
			raise ValueError(f"'{name}' cannot be tuned in the {model} model; there are {', '.join(known)}")
		if not (name in start and math.isfinite(start[name])):
			raise ValueError(f"{name} has no finite value to start from; give one")
	if {"young", "poisson"} & set(names) and {"bulk", "shear"} & set(names):
		raise ValueError(
			"young and poisson on one side, bulk and shear on the other, say the same twice: tune only "
			"one of the pairs"
		)
	made = []
	for name in names:
		span = (bounds or {}).get(name) or known[name].span or (start[name] / _REACH, start[name] * _REACH)
		made.append(Parameter(name, start[name], *span, known[name].laws))
	return made
