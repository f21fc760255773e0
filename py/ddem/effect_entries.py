# GPL v2 or later, see LICENSE.
"""Entries of the table of effects, and what they say in words; see :mod:`effect_table`."""
from dataclasses import dataclass, field

from yade import O

from .energy import EXTERNAL

NOTHING = 1e-3  #: an effect whose measured bound is not above this changed nothing [-]
_NOT_TIMED = "not measured: O.timingEnabled = True before the run"
_NOT_BOOKED = "not measured: O.trackEnergy = True before the run"


@dataclass
class Effect:
	"""A line of the table."""
	name: str  #: as the switch or setting is called, where there is one
	runs: bool  #: whether it is evaluated
	why: str  #: parameter or setting that asked for it, or why it is off
	bytes: int = 0  #: of state that it takes per particle, 0 where it is off
	measured: str = ""  #: what it did, in words
	bound: float = None  #: of the relative change it made [-], None where it is not known

	@property
	def changed(self):
		"""Whether it changed anything: False where it is off or idle, None where that is not known."""
		if not self.runs:
			return False
		return None if self.bound is None else self.bound > NOTHING

	@property
	def state(self):
		"""'on', 'off' or 'idle' (on, and changed nothing)."""
		return "off" if not self.runs else "idle" if self.changed is False else "on"


@dataclass
class Group:
	"""Effects of particles that share them: of an engine, of a group of triangles, of bonded spheres."""
	name: str
	particle: str  #: "triangle" or "bond"
	count: int  #: of particles
	bytes: int = 0  #: of state per particle
	cost: str = ""  #: in words, with the ns per particle and step where they were measured
	ns: float = None  #: of the engine per particle and step, None where not measured [ns]
	effects: list = field(default_factory=list)  #: of :class:`Effect`

	def __getitem__(self, name):
		"""The effect of that name."""
		for effect in self.effects:
			if effect.name == name:
				return effect
		raise KeyError(
			f"'{name}' is no effect of {self.name}; there are {', '.join(e.name for e in self.effects)}"
		)

	def __contains__(self, name):
		return any(effect.name == name for effect in self.effects)

	def add(self, *values, **more):
		"""Append an :class:`Effect`."""
		self.effects.append(Effect(*values, **more))


def name_of(material):
	"""Class and label of a material."""
	return f"{type(material).__name__} '{material.label}'" if material.label else type(material).__name__


def values_of(materials, name, unit=""):
	"""Values of an attribute and whose they are: "name = value of material, …"."""
	values = {}
	for material in materials:
		values.setdefault(getattr(material, name), []).append(name_of(material))
	form = "{}" if isinstance(next(iter(values)), bool) else "{:g} " + unit
	shown = (f"{form.format(value).strip()} of {', '.join(names)}" for value, names in values.items())
	return f"{name} = {', '.join(shown)}"


def cost_of(engines, particles, particle):
	"""ns per particle and step, and the same in words."""
	timed = [e for e in engines if e.execCount and e.execTime]
	if not timed or not particles:
		return None, _NOT_TIMED
	ns = float(sum(e.execTime / e.execCount for e in timed)) / particles
	return ns, f"{ns:.3g} ns per {particle} and step, the engine as a whole"


def share_of(entry, of=None):
	"""What an entry of the energy book has of what went through it, in words and as a bound.

	:param of: entries that it is a share of; all where left out
	:returns: (text, share), nothing before the first step
	"""
	if not O.iter:
		return ()
	book = dict(O.energy.items()) if O.trackEnergy else {}
	if not book:
		return _NOT_BOOKED, None
	if of:
		through = sum(abs(book.get(name, 0.0)) for name in of)
	else:
		inner = sum(value for name, value in book.items() if name not in EXTERNAL)
		through = max(sum(abs(book.get(name, 0.0)) for name in EXTERNAL), inner)
	share = abs(book.get(entry, 0.0)) / through if through > 0 else 0.0
	return f"{entry} {book.get(entry, 0.0):.2g} J, {share:.2g} of the energy", share
