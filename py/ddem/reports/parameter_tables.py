# GPL v2 or later, see LICENSE.
"""Parameters of materials as reports show them: symbol, value with unit, meaning."""
import math

from .uniaxial import THOUSANDS

#: attribute, symbol, unit shown, factor to it, meaning
CONCRETE = (
	("bulk", "B", "GPa", 1e9, "bulk modulus"), ("shear", "μ", "GPa", 1e9, "shear modulus"),
	("density", "ρ", "kg/m³", 1, "density"),
	("strength", "σ_p0", "MPa", 1e6, "strength in the flow rule"),
	("fractureEnergy", "G_f", "kJ/m³", 1e3, "mean fracture energy"),
	("rotationStiffness", "β_φ", "", 1, "stiffness against rotation")
)
BONDED = (
	("young", "E", "GPa", 1e9, "Young's modulus of the bonds"),
	("poisson", "ν", "", 1, "Poisson's ratio of the bonds"),
	("cohesion", "C", "MPa", 1e6, "shear strength of the bonds without normal stress"),
	("bondFrictionAngle", "φ", "°", math.radians(1), "friction angle of the bonds"),
	("frictionStatic", "μ_s", "", 1, "friction of contacts until the first slip"),
	("frictionDynamic", "μ_d", "", 1, "friction of contacts after it")
)


def rows(material, table):
	"""(symbol, value with unit, meaning) for a table of the report."""
	return [
		(symbol, f"{getattr(material, name) / factor:.4g} {unit}".strip(), meaning)
		for name, symbol, unit, factor, meaning in table
	]


def number(count):
	"""A whole number with spaces between thousands."""
	return f"{count:,d}".replace(",", THOUSANDS)
