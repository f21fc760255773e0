# GPL v2 or later, see LICENSE.
"""The law of a point of concrete a second time, as the ordinary differential equations that Zubelewicz
(2018) writes, integrated by SciPy.

It shares no code with the plugin: rates instead of steps, tensors of three dimensions with NumPy's eigenvectors instead
of Mohr's circle, derivatives of the stress by complex steps, adaptive multistep integration (LSODA).
The steps of the plugin must converge to it.

With the elastic strain ε_e = ε − ε_p, the stress σ(ε_e, Ω) of section 3 and the flow tensors of eqs. 5 and
8, the state follows

	ε̇_p = ½ M_p ė_eq + κ ε_e,   Ω̇ = ½ M_c ξ_c0 σ_eq ė_eq/G_f,
	ė_eq = Λ_0 ė_0 (ė_N/ė_0)^ω_p (σ_eq/σ_p)^n_p,   ė_N = √(½ ε̇:ε̇)

Where a stress is held, the components of ε̇ that are free follow from σ̇ = (∂σ/∂ε_e):ε̇_e + (∂σ/∂Ω):Ω̇. The slip
κ ≥ 0 of a crack that closes is what :yref:`ConcreteDamageMat` adds: the stored energy W must not rise by the change of
the stiffness alone, κ = ½ (∂ ln W/∂χ) χ̇, with the share χ of the damage that the stiffness feels.

Tensors have the components xx, yy, zz, xy; tension is positive.
"""
import numpy as np
from scipy.integrate import solve_ivp

from . import concrete_theory

SOURCE = "rate equations integrated by SciPy (concrete_rates.py)"
COMPONENTS = ("xx", "yy", "zz", "xy")
_TWICE = np.array([1, 1, 1, 2])  # of each component in a double product
_PLACES = ((0, 0), (1, 1), (2, 2), (0, 1))  # of the components in a tensor
_BASIS = np.array([np.eye(9)[3 * i + j] + (i != j) * np.eye(9)[3 * j + i] for i, j in _PLACES])
_STEP = 1e-30  # of complex differences


def _tensor(components):
	"""(…, 3, 3) of (…, 4)."""
	return (components @ _BASIS).reshape(*components.shape[:-1], 3, 3)


def _components(tensor):
	"""(…, 4) of (…, 3, 3)."""
	return tensor.reshape(*tensor.shape[:-2], 9)[..., [0, 4, 8, 1]]


def _double(a, b):
	"""a:b (…) of tensors (…, 3, 3)."""
	return (a * b).sum(axis=(-1, -2))


def extrapolated(run, steps):
	"""What run(steps) tends to as its steps become small, their error being of first order:
	twice run(steps) minus run(half as many)."""
	return 2 * run(steps) - run(steps // 2)


def largest_difference(found, reference):
	"""Largest difference over the largest reference [-]."""
	return np.abs(found - reference).max() / np.abs(reference).max()


def peak(strain, stress):
	"""Stress [Pa] at the top of a curve, of the parabola through the three samples there."""
	top = np.clip(np.abs(stress).argmax(), 1, len(stress) - 2)
	a, b, c = np.polyfit(strain[top - 1:top + 2] - strain[top], stress[top - 1:top + 2], 2)
	return c - b * b / (4 * a)


def fractions(count):
	"""1/count, 2/count … 1."""
	return np.arange(1, count + 1) / count


class Law:
	"""The right-hand sides, with all effects on;
	*parameters* as :func:`yade.ddem.materialpoint.concrete` gives them."""

	def __init__(self, parameters):
		self.p = parameters
		self.closed = parameters["closedEffect"] * parameters["damageLimit"]

	def damage(self, damage):
		"""(η_0 N_Ω (…, 3, 3), η_0 (…)) [-]."""
		tensor = _tensor(damage)
		square = _double(tensor, tensor)
		present = square.real > 0
		size = np.sqrt(np.where(present, square, 1))
		power = size**self.p["damageExponent"]
		ratio = np.where(present, (1 - self.p["residual"]) * power / (1 + power), 0)
		return (ratio / size)[..., None, None] * tensor, ratio

	def effect(self, elastic, loss, ratio):
		"""χ [-]: η_max for an open crack, η_max ξ_c1 for a closed one, linear over the closure band in the
		crack-normal stress of the closed crack."""
		normal = _double(loss, self.degraded(self.closed, loss, elastic))
		band = np.where(ratio.real > 0, ratio, 1) * self.p["closureBand"]
		openness = np.where(normal.real >= 0, 1, np.where(normal.real <= -band.real, 0, 1 + normal / band))
		return self.closed + (self.p["damageLimit"] - self.closed) * openness

	def degraded(self, effect, loss, elastic):
		"""λ Δ (Δ:ε_e) + 2μ Δ·ε_e·Δ with Δ = 1 − χ η_0 N_Ω [Pa], without the equation of state."""
		delta = np.eye(3) - np.asarray(effect)[..., None, None] * loss
		along = _double(delta, elastic)[..., None, None]
		return (self.p["bulk"] - 2 / 3 * self.p["shear"]) * along * delta + 2 * self.p[
			"shear"
		] * delta @ elastic @ delta

	def stress(self, elastic, damage):
		"""(σ (…, 4) [Pa], χ (…) [-])."""
		loss, damaged = self.damage(damage)
		elastic = _tensor(elastic)
		effect = self.effect(elastic, loss, damaged)
		stress = self.degraded(effect, loss, elastic)
		# s = ((1 + s) a)^n by Newton's method; the last iterations carry the imaginary part of a complex step
		ratio = -np.trace(stress, axis1=-2, axis2=-1) / 3 / self.p["eosPressure"]
		n, pressed = self.p["eosExponent"], ratio.real > 0
		ratio = np.where(pressed, ratio, 1)
		stiffening = np.where(ratio.real < 1, ratio**n, 2 * ratio)
		while pressed.any():
			power = ((1 + stiffening) * ratio)**n
			change = (stiffening - power) / (1 - n * power / (1 + stiffening))
			stiffening = stiffening - change
			if (np.abs(change) <= 1e-14 * np.abs(stiffening)).all():
				break
		return _components((1 + np.where(pressed, stiffening, 0))[..., None, None] * stress), effect

	def _slip(self, elastic, damage, effect, gradient):
		"""κ over the rates of ε_e before slip and of Ω, (8,); *gradient* of χ, (8,)."""
		if not gradient.any():
			return np.zeros(8)
		loss, strain = self.damage(damage)[0], _tensor(elastic)
		twice_energy = _double(self.degraded(effect + 1j * _STEP, loss, strain), strain)
		half = 0.5 * twice_energy.imag / _STEP / twice_energy.real
		return half * gradient / (1 + half * gradient[:4] @ elastic)

	def rates(self, elastic, damage, strain_rate, stress_rate, held, combine):
		"""Rates of ε, ε_p and Ω, (3, 4) [1/s].

		:param strain_rate: (4,) [1/s], of the components that are not held
		:param stress_rate: (4,) [Pa/s], of those that are held
		:param held: (4,) where the stress is prescribed
		:param combine: (4, 4), what of the stresses is prescribed there;
			the unit matrix for the components themselves
		"""
		p = self.p
		at = np.concatenate([elastic, damage]) + 1j * _STEP * np.vstack([np.zeros(8), np.eye(8)])
		stresses, effects = self.stress(at[:, :4], at[:, 4:])
		# ∂σ/∂(ε_e, Ω) (4, 8)
		stress, effect, tangent = stresses[0].real, effects[0].real, combine @ stresses[1:].imag.T / _STEP
		slip = self._slip(elastic, damage, effect, effects[1:].imag / _STEP)
		values, axes = np.linalg.eigh(_tensor(stress))
		flow, growth = _components((axes * concrete_theory.flow_tensors(p, values)[:, None, :]) @ axes.T)
		equivalent, ratio = max(0.5 * (_TWICE * flow) @ stress, 0.0), self.damage(damage)[1]
		openness = (
			(effect - self.closed) / (p["damageLimit"] - self.closed)
			if ratio > 0
			else float(values[-1] >= 0)
		)
		growth = (
			0.5
			* growth
			* (p["closedGrowth"] + (1 - p["closedGrowth"]) * openness)
			* equivalent
			/ p["fractureEnergy"]
		)
		of_flow = np.concatenate([-0.5 * flow, growth])  # of (ε_e, Ω)
		# all rates are linear in ė_eq: what is constant and what multiplies it, in two columns; without slip,
		# and again with it where it would be positive
		for kappa in (np.zeros(8), slip):
			reduced = tangent - np.outer(tangent[:, :4] @ elastic, kappa)
			total = np.column_stack([np.where(held, 0, strain_rate), np.zeros(4)])
			right = (
				np.column_stack([np.where(held, stress_rate, 0), -reduced @ of_flow])
				- reduced[:, :4] @ total
			)
			total[held] = np.linalg.solve(reduced[:, :4][np.ix_(held, held)], right[held])
			amount = self._amount(total, equivalent / (p["strength"] * (1 - ratio)))
			strain = total @ (1, amount)
			change = amount * of_flow
			change[:4] += strain  # of (ε_e, Ω), before slip
			if not slip @ change > 0:
				break
		return np.stack([strain, 0.5 * amount * flow + max(kappa @ change, 0) * elastic, amount * growth])

	def _amount(self, total, intensity):
		"""ė_eq [1/s]: the root of eq. 7, in which ė_N contains ė_eq, by Newton's method."""
		p = self.p
		if not intensity > 0:
			return 0.0
		full = p["flowFactor"] * p["referenceRate"] * intensity**p["flowExponent"]
		amount = 0.0
		for _ in range(50):
			rate = total @ (1, amount)
			square = 0.5 * (_TWICE * rate) @ rate
			found = full * (np.sqrt(square) / p["referenceRate"])**p["rateExponent"]
			slope = found * p["rateExponent"] * 0.5 * (_TWICE * rate) @ total[:, 1] / square
			change = (found - amount) / (1 - slope)
			amount += change
			if abs(change) <= 1e-14 * abs(amount):
				return amount
		raise RuntimeError(f"no rate of flow solves eq. 7 at an intensity of {intensity:g}")


class RatePoint:
	"""A point that goes along paths as :class:`yade.ddem.materialpoint.MaterialPoint` does,
	but by integration of the rates."""

	def __init__(self, parameters, damage=(0, 0, 0, 0)):
		self.law = Law(parameters)
		self.state = np.concatenate([np.zeros(8), damage])  # ε, ε_p, Ω

	def uniaxial(self, rate, until, confinement=0.0, samples=200):
		"""Strain and stress (samples, 4) of uniaxial stress under a confining pressure, the axial strain yy
		counted from the confined state; as :meth:`yade.ddem.materialpoint.MaterialPoint.uniaxial`."""
		if confinement:
			self.go(
				confinement / (3 * self.law.p["bulk"] * abs(rate)),
				stress=dict.fromkeys(("xx", "yy", "zz"), -confinement),
			)
		begin = self.state[1]
		strain, stress, _, _ = self.go(
			until / rate,
			strain={"yy": begin + until},
			stress={"xx": -confinement, "zz": -confinement},
			shares=fractions(samples),
		)
		strain[:, 1] -= begin
		return strain, stress

	def go(self, duration, strain=None, stress=None, follow=None, shares=(1.0, ), tolerance=1e-6):
		"""Go linearly to targets in strain [-] and stress [Pa], by component, within a duration [s].

		:param follow: stresses that change in proportion to another: {component: (leader, ratio)}
		:param shares: of the leg at which the state is wanted, growing, up to 1
		:param tolerance: of the integration, relative
		:returns: strain, stress, ε_p and Ω there, (k, 4) each
		:raises RuntimeError: the integration stops, because the rates have no solution or grow without bound
		"""
		strain, stress, follow = strain or {}, stress or {}, follow or {}
		held, combine = np.array([name in stress or name in follow for name in COMPONENTS]), np.eye(4)
		for name, (leader, ratio) in follow.items():
			combine[COMPONENTS.index(name), COMPONENTS.index(leader)] = -ratio
		now, _ = self.law.stress(self.state[:4] - self.state[4:8], self.state[8:])
		rate = lambda targets, start: (
			np.array([targets.get(name, value) - value for name, value in zip(COMPONENTS, start)])
			/ duration
		)
		strain_rate, stress_rate = rate(strain, self.state[:4]), rate(stress, now)
		size = np.abs(strain_rate).max() * duration or 1e-3

		def rates(_, state):
			return self.law.rates(
				state[:4] - state[4:8], state[8:], strain_rate, stress_rate, held, combine
			).ravel()

		solved = solve_ivp(
			rates, (0, duration), self.state, method="LSODA", t_eval=duration * np.asarray(shares),
			rtol=tolerance, atol=tolerance * 1e-2 * size,
			first_step=1e-6 * duration, max_step=0.1 * duration
		)
		if not solved.success:
			raise RuntimeError(f"integration of the rates stopped on the way: {solved.message}")
		self.state = solved.y[:, -1]
		whole, plastic, damage = np.split(solved.y.T, 3, axis=1)
		return whole, self.law.stress(whole - plastic, damage)[0], plastic, damage
