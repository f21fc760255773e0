# GPL v2 or later, see LICENSE.
"""How well the energy book of a run closes."""
from yade import (
	DeformableEngine, DeformableNode, DeformableTriangle, InteractionLoop, NewtonIntegrator, O, Quaternion, Vector3,
	utils
)

#: entries of O.energy that say what came in from outside, as YADE writes them: with a minus sign
EXTERNAL = ("externalWork", "gravWork", "edgeWork", "jacketWork", "velGradWork")
#: entries that a sound model cannot make negative: a law that creates energy borrows it there, without the total moving
NEVER_NEGATIVE = ("elastPotential", "elastRotation", "plasticFlow", "damage", "nonviscDamp", "edgeAbsorption")


class EnergyBalance:
	"""The energy book of the scene, from O.energy. Make one before the first step; it switches O.trackEnergy on.

	O.energy holds what is stored and dissipated with a plus sign and what came in from outside with a minus sign,
	so the total does not change in an exact run. It is zero where the run begins at rest; a scene that moves
	already (or was not tracked before) has energy of its own, which is known after the first tracked step:
	the error then counts from the first look at :attr:`error` or :meth:`record`.

	NewtonIntegrator books the kinetic energy of half a step ago, while all else belongs to the present positions;
	here it is the mean of half a step ago and half a step ahead, which is of second order in the time step.
	BondedNewtonIntegrator books that of the present positions itself, without an error.
	"""

	def __init__(self):
		begun = O.trackEnergy and len(O.energy.keys()) > 0
		self._born = O.iter
		#: total [J] that the book must keep; None until it is known
		self.start = O.energy.total() if begun else 0.0 if O.iter == 0 and _at_rest() else None
		self._drift = self._through = 0.0  # largest at any record [J]
		self.recorded_drift = 0.0  #: what the book had too much at the last :meth:`record` [J]
		O.trackEnergy = True

	def parts(self):
		"""All entries [J] by name, the kinetic energy at the present time."""
		entries = dict(O.energy.items())
		if "kinetic" in entries and _books_half_a_step_ago(O.engines):
			entries["kinetic"] = 0.5 * (entries["kinetic"] + utils.kineticEnergy())
		return entries

	@property
	def drift(self):
		"""What the book has too much now [J]; 0 before anything happened."""
		return self._drift_of(self.parts())

	def _drift_of(self, parts):
		if self.start is None:
			if O.iter == self._born:
				return 0.0
			self.start = sum(parts.values())
		return sum(parts.values()) - self.start

	@property
	def error(self):
		"""How far the total has moved, and what stores and losses have below zero, over the energy that has
		gone through the system [-]; 0 before anything happened."""
		drift, through = self._errors(self.parts())
		return drift / through if through > 0 else 0.0

	@property
	def largest(self):
		"""Largest such distance at any :meth:`record`, over the largest energy that has gone through [-];
		a moment when next to nothing had gone through does not count."""
		return self._drift / self._through if self._through > 0 else 0.0

	def record(self):
		"""The parts now; keeps the largest error, and :attr:`recorded_drift`."""
		parts = self.parts()
		drift, through = self._errors(parts)
		self._drift, self._through = max(self._drift, drift), max(self._through, through)
		self.recorded_drift = self._drift_of(parts)
		return parts

	def _errors(self, parts):
		drift = self._drift_of(parts)
		through = max(
			sum(abs(parts.get(name, 0)) for name in EXTERNAL),
			sum(value for name, value in parts.items() if name not in EXTERNAL),
		)
		borrowed = -sum(min(0.0, parts.get(name, 0.0)) for name in NEVER_NEGATIVE)
		return abs(drift) + borrowed, through


def _books_half_a_step_ago(engines):
	"""Whether the kinetic energy is booked by a NewtonIntegrator before it moves the bodies; DeformableEngine and
	BondedNewtonIntegrator book that of the present positions."""
	behind = False
	for engine in engines:
		if isinstance(engine, DeformableEngine):
			return False
		behind = behind or isinstance(engine, NewtonIntegrator) and not getattr(engine, "moved", 0)
	return behind


def _at_rest():
	"""Whether nothing moves by itself and nothing is under load;
	what moves as prescribed has its energy from outside."""
	for engine in O.engines:
		if any(
			getattr(functor, "convention", None) == "esys"
			for functor in (engine.lawDispatcher.functors if isinstance(engine, InteractionLoop) else ())
		):
			return False  # bonds across gaps are under tension from the beginning
	still = Vector3.Zero
	for body in O.bodies:
		state = body.state
		if isinstance(body.shape, (DeformableNode, DeformableTriangle)) and (
			state.pos != state.refPos or state.ori != Quaternion.Identity
			or getattr(body.shape, "initialStress", None)
		):
			return False
		if state.vel == still and state.angVel == still:
			continue
		blocked = state.blockedDOFs
		if any(
			state.vel[k] and "xyz"[k] not in blocked or state.angVel[k] and "XYZ"[k] not in blocked
			for k in range(3)
		):
			return False
	return True
