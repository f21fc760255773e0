# GPL v2 or later, see LICENSE.
"""Materials of deformable triangles as scripts make them from options: a law is an entry of :data:`LAWS`."""
import argparse
import difflib
import math
from argparse import SUPPRESS
from dataclasses import dataclass

from yade import ConcreteDamageMat, DeformableElastMat, O, ScalarDamageMat, VonMisesMat

from .commandline import not_negative, positive


_SWITCHES = {"on": True, "off": False}  # values of --set that are no numbers


@dataclass(frozen=True)
class Parameter:
	"""An option of a law; its default is that of the material."""
	attribute: str  # of the material
	unit: str  # "Pa"; as metavar
	kind: object  # what argparse calls with the text
	help: str

	@property
	def option(self):
		"""Its name on the command line, without dashes in front."""
		return "".join("-" + c.lower() if c.isupper() else c for c in self.attribute)

	@property
	def shown_unit(self):
		"""The unit as texts have it."""
		return self.unit.replace("PA", "Pa").replace("M3", "m³").replace("M2", "m²")


@dataclass(frozen=True)
class Law:
	"""A law that --law names."""
	material: type
	about: str
	parameters: tuple = ()  # of :class:`Parameter`


#: name -> :class:`Law`
LAWS = {
	"concrete": Law(
		ConcreteDamageMat, "viscoplastic flow and damage of concrete (Zubelewicz 2018)", (
			Parameter("strength", "PA", positive, "strength of the undamaged material in the flow rule"),
			Parameter(
				"fractureEnergy",
				"J/M3",
				positive,
				"mean fracture energy, per volume",
			),
		)
	),
	"scalar-damage": Law(
		ScalarDamageMat, "Mazars' damage with a crack band, for tension", (
			Parameter("tensileStrength", "PA", positive, "strength in uniaxial tension"),
			Parameter("fractureEnergy", "J/M2", positive, "fracture energy per area of crack"),
		)
	),
	"von-mises": Law(
		VonMisesMat, "metal that yields", (
			Parameter("yieldStress", "PA", positive, "stress at which uniaxial tension yields"),
			Parameter("hardening", "PA", not_negative, "slope of the yield stress over plastic strain"),
		)
	),
	"elastic": Law(DeformableElastMat, "linear elasticity"),
}


def add_options(group):
	"""Add the options of all laws to a group of a parser, each once."""
	shared = {}  # laws by the attribute that their materials share
	for name, law in LAWS.items():
		for parameter in law.parameters:
			shared.setdefault(parameter.attribute, []).append((name, law, parameter))
	for attribute, users in shared.items():
		said = "; ".join(
			(
				f"{name}: {parameter.help} (default: {getattr(law.material(), attribute):g} "
				f"{parameter.shown_unit})"
			)
			for name, law, parameter in users
		)
		first = users[0][2]
		group.add_argument(
			f"--{first.option}", type=first.kind, default=SUPPRESS,
			metavar=first.unit if len(users) == 1 else "E",
			help=said
		)
	group.add_argument(
		"--set", type=assignment, action="append", default=[], metavar="NAME=VALUE",
		help=(
			"any other number of the material, in its unit, as damageExponent=1, or on or off for one that "
			"is either; may be repeated"
		)
	)


def assignment(text):
	"""A name and a value of "name=number", "name=on" or "name=off"."""
	name, _, value = (part.strip() for part in text.partition("="))
	if value in _SWITCHES:
		return name, _SWITCHES[value]
	try:
		number = float(value)
	except ValueError:
		number = math.nan
	if not (name and math.isfinite(number)):
		raise argparse.ArgumentTypeError(f"'{text}' must be NAME=NUMBER, NAME=on or NAME=off")
	return name, number


def check(options, refuse):
	"""Call *refuse* with a text about parameters of other laws."""
	own = {parameter.attribute for parameter in LAWS[options.law].parameters}
	for name, law in LAWS.items():
		for parameter in law.parameters:
			if parameter.attribute not in own and hasattr(options, parameter.option.replace("-", "_")):
				refuse(f"argument --{parameter.option}: it belongs to --law {name}")
	for name, value in options.set:
		_check_setting(options.law, name, value, refuse)


def _check_setting(law, name, value, refuse):
	"""Call *refuse* with a text about a name and a value of --set that the material cannot take."""
	material = LAWS[law].material
	# what says which material it is, as its id and label, is neither
	known = {key: usual for key, usual in material().dict().items() if isinstance(usual, (float, bool))}
	own = {parameter.attribute: parameter.option for parameter in LAWS[law].parameters}
	own.update({key: key for key in ("young", "poisson", "density")})
	if name in own:
		refuse(f"argument --set: '{name}' has an option of its own, --{own[name]}")
	if name not in known:
		near = difflib.get_close_matches(name, known, n=1, cutoff=0.5)
		refuse(
			f"argument --set: {material.__name__} has no number '{name}'; it has "
			f"{', '.join(sorted(known.keys() - own.keys()))}"
			f"{f'. Did you mean {near[0]}?' if near else ''}"
		)
	if isinstance(known[name], bool) != isinstance(value, bool):
		asked = "is on or off" if isinstance(known[name], bool) else "is a number"
		refuse(f"argument --set: '{name}' of {material.__name__} {asked}, not {said(value)}")


def said(value):
	"""A value of --set as texts have it."""
	return f"{value:g}" if not isinstance(value, bool) else "on" if value else "off"


def append(options):
	"""The material "sample" of these options, in O.materials.

	:raises ValueError: a parameter out of bounds
	"""
	law = LAWS[options.law]
	usual = law.material()
	values = {
		name: getattr(usual, name) if getattr(options, name) is None else getattr(options, name)
		for name in ("young", "poisson", "density")
	}
	for parameter in law.parameters:
		given = getattr(options, parameter.option.replace("-", "_"), None)
		if given is not None:
			values[parameter.attribute] = given
	for name, value in options.set:
		values[name] = value
	material = law.material(label="sample", **values)
	material.validate() if hasattr(material, "validate") else None
	O.materials.append(material)
	return material
