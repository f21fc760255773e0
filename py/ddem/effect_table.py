# GPL v2 or later, see LICENSE.
"""What a scene simulates, and why: the table of effects of both models, with what each takes and what it changed.

::

	print(ddem.effects())         # before a run: what is asked for; after it: what it did as well

An effect is *on* (it runs), *off* (it does not: no instruction, no byte) or *idle*: it ran, and what it changed is not
above :data:`effect_entries.NOTHING` by a bound that is measured. An idle effect may be switched off, and the scene
gives the same within that bound. The bound is a relative change, of the stresses unless said otherwise:

=================================  ==================================================================================
effect                             bound
=================================  ==================================================================================
flow, yielding, rate               largest stress that plastic strain takes, :math:`|C:\\varepsilon_p|`, over the
                                   largest
damage, fracture energies          largest damage :math:`\\eta/\\eta_{max}`
equation of state                  largest stiffening :math:`B/B_0-1`
crack band                         0 until damage reaches the value from which it acts, see :mod:`crackband`
rotation                           :math:`2\\theta+\\theta^2/2\\varepsilon` of the largest rotation and elastic
                                   strain; with 'cosserat' also the share of *elastRotation* in the energy book
gravity of triangles               the larger of :math:`\\rho g L` over the largest stress and :math:`g t` over the
                                   largest velocity
energy losses, gravity of spheres  share of the energy book, where O.trackEnergy has kept it
shear, bending, torsion of bonds   largest stress that it makes over the largest of all parts, in the bonds that hold
failure criterion                  0 while no bond has broken, then 1
contacts, their damping            0 while no bond has broken and no spheres touch without one
=================================  ==================================================================================

The flow of concrete (eq. 7) has no threshold and its equation of state is steep at first: in the elastic range both
change some per mille, by which they are on. The bound stands beside each effect, for those who take another limit.

Limits: a bound compares states with the effect and without at the same strain; in motion, differences of motion add to
it. Rotations, stiffening, stresses and velocities are those of the moment, so ask under load; what a law remembers
(plastic strain, damage) is the whole history. A bond that broke is not in the shares of bending and torsion. Forces set
by O.forces.setPermF are felt and not listed: YADE does not say whether there are any. Before the first step, and where
nothing is known, nothing is claimed: an effect is idle only by a number.
"""
import math
import textwrap
from dataclasses import asdict

from . import meter
from .effects_of_spheres import groups_of_spheres
from .effects_of_triangles import groups_of_triangles

_WIDTH = 120  # of the table


class EffectTable:
	"""What :func:`effects` returns; ``print`` shows it, :meth:`rows` gives it as plain data."""

	def __init__(self, groups, bytes_per_particle=None):
		self.groups = groups  #: list of :class:`effect_entries.Group`
		#: what the whole scene takes [bytes], see :func:`meter.bytes_per_particle`; None: not known
		self.bytes_per_particle = bytes_per_particle

	def __len__(self):
		return len(self.groups)

	def __iter__(self):
		return iter(self.groups)

	def __getitem__(self, name):
		"""The group of that name, or the first whose name has it as a part."""
		for group in self.groups:
			if name == group.name:
				return group
		for group in self.groups:
			if name in group.name:
				return group
		raise KeyError(
			f"'{name}' is no group of this scene; there are "
			f"{', '.join(g.name for g in self.groups) or 'none'}"
		)

	def rows(self):
		"""A dict an effect: group, particle, count, group_bytes, cost, ns_per_particle_step, effect, state
		("on", "off", "idle"), runs, changed (None: not known), why, bytes, measured, bound; and
		bytes_per_particle of the whole scene. Plain values for JSON.
		"""
		rows = []
		for group in self.groups:
			shared = {
				"group": group.name, "particle": group.particle, "count": group.count,
				"group_bytes": group.bytes, "cost": group.cost, "ns_per_particle_step": group.ns,
				"bytes_per_particle": self.bytes_per_particle
			}
			for effect in group.effects:
				plain = asdict(effect)
				plain["effect"] = plain.pop("name")
				bound = plain["bound"]
				plain["bound"] = float(bound) if bound is not None and math.isfinite(bound) else None
				changed = effect.changed
				plain["changed"] = None if changed is None else bool(changed)
				rows.append({**shared, **plain, "state": effect.state})
		return rows

	def __str__(self):
		if not self.groups:
			return "no effects: the scene has neither deformable triangles nor bonded spheres"
		widths = [max(len(e.name) for g in self.groups for e in g.effects), 4, 6]
		margin = " " * (2 + sum(widths) + 2 * len(widths))
		blocks = []
		for group in self.groups:
			count = f"{group.count:,d}".replace(",", "\u202f")
			head = f"{group.name}: {count} {group.particle}{'' if group.count == 1 else 's'}"
			head += f", {group.bytes} bytes of state each" if group.bytes else ""
			lines = [head]
			if group.cost:
				lines += textwrap.wrap(
					group.cost, _WIDTH, initial_indent="  cost: ", subsequent_indent="        "
				)
			for e in group.effects:
				taken = f"{e.bytes} B" if e.bytes else ""
				start = f"  {e.name:<{widths[0]}}  {e.state:<{widths[1]}}  {taken:>{widths[2]}}  "
				lines += textwrap.wrap(e.why, _WIDTH, initial_indent=start, subsequent_indent=margin)
				if e.measured:
					said = e.measured + (": changed nothing" if e.state == "idle" else "")
					lines += textwrap.wrap(
						said, _WIDTH, initial_indent=margin + "→ ",
						subsequent_indent=margin + "  "
					)
			blocks.append("\n".join(lines))
		if self.bytes_per_particle is not None:
			kind = "triangle" if any(group.particle == "triangle" for group in self.groups) else "sphere"
			blocks.append(
				f"memory: {self.bytes_per_particle:.0f} bytes a {kind}, with its body, its share of "
				"nodes or bonds, and the engines' tables"
			)
		return "\n\n".join(blocks)

	__repr__ = __str__


def effects():
	"""The table of effects of the present scene, as an :class:`EffectTable`: print it.

	Before O.engines is set it says what would run by the materials; before the first step what runs, why and how
	many bytes it takes; after a run also what it cost (where O.timingEnabled was on) and which effects changed
	nothing. Reads the whole sample once: call it at the end, not in every step.
	"""
	return EffectTable([*groups_of_triangles(), *groups_of_spheres()], meter.bytes_per_particle())
