# GPL v2 or later, see LICENSE.
"""What follows from the report's equations for a point of concrete without any integration in time: closed forms, and
formulas of others to set beside them.

Stresses and strains are principal ones, tension positive; equation numbers are those of Zubelewicz (2018).
"""
import numpy as np
from scipy.optimize import brentq


def friction(parameters, pressure):
	"""q_D = q_0 (1 + <p>/p_q0)^(−n_q), the closure of :yref:`ConcreteDamageMat`."""
	return (
		parameters["friction"]
		* (1 + max(pressure, 0.0) / parameters["frictionPressure"])**-parameters["frictionPressureExponent"]
	)


def flow_tensors(parameters, stress):
	"""Principal values (2, 3) of M_p (eq. 5) and of M_c; where the largest or the smallest stresses are close, they
	share the flow, each by the weight 1 − d² (3 − 2d) of its distance d from the extreme one."""
	stress = np.asarray(stress, float)
	q = friction(parameters, -stress.sum() / 3)
	largest, smallest = max(stress), min(stress)
	close = parameters["sharingTolerance"] * max(abs(largest), abs(smallest), np.finfo(float).tiny)
	distance = np.minimum(np.array([largest - stress, stress - smallest]) / close, 1)
	weights = 1 - distance**2 * (3 - 2 * distance)
	first, last = (1 + q) * weights[0] / weights[0].sum(), (1 - q) * weights[1] / weights[1].sum()
	return np.array([first - last, first + last])


def steady_stress(parameters, direction, axis, rate, confinement=0.0):
	"""Stress at which a point without damage flows steadily: principal stresses −confinement + s·direction [Pa].

	Then the whole strain rate is that of the flow, ε̇ = ½ M_p ė_eq (eq. 6), so that ė_N = √(½ ε̇:ε̇) = ė_eq
	√(M_p:M_p/8), and eq. 7 says how large σ_eq = ½ M_p:σ is:

		σ_eq = σ_p0 (ė_eq/(Λ_0 ė_0 (ė_N/ė_0)^ω_p))^(1/n_p)

	:param direction: of the stress beyond the confinement, of any length
	:param axis: the component whose strain rate is given
	:param rate: that strain rate [1/s], of the sign of direction[axis]
	"""
	direction = np.asarray(direction, float)

	def excess(size):
		stress = size * direction - confinement
		flow = flow_tensors(parameters, stress)[0]
		amount = rate / (0.5 * flow[axis])
		if amount <= 0:
			return -1.0
		measure = amount * np.sqrt((flow**2).sum() / 8) / parameters["referenceRate"]
		needed = amount / (
			parameters["flowFactor"] * parameters["referenceRate"] * measure**parameters["rateExponent"]
		)
		return 0.5 * flow @ stress / parameters["strength"] - needed**(1 / parameters["flowExponent"])

	size = brentq(excess, 1e-6 * parameters["strength"], 1e2 * parameters["strength"], xtol=1e-3, rtol=1e-14)
	return size * direction - confinement


def young(parameters):
	"""E = 9 B μ/(3 B + μ) [Pa]."""
	return 9 * parameters["bulk"] * parameters["shear"] / (3 * parameters["bulk"] + parameters["shear"])


def damage_parameter(parameters, damage):
	"""(η_0, N_Ω) of principal values Ω."""
	size = np.linalg.norm(damage)
	power = size**parameters["damageExponent"]
	return (1 - parameters["residual"]) * power / (1 + power), np.asarray(damage) / size


def damaged_modulus(parameters, damage, axis, closed):
	"""Slope of uniaxial stress along a principal axis of the damage Ω [Pa].

	With Δ = 1 − η N_Ω the stiffness λ Δ⊗Δ + 2μ Δ·Δ is Hooke's law between σ_a/Δ_a and Δ_a ε_a,
	so the slope is E Δ_a².
	"""
	eta, orientation = damage_parameter(parameters, damage)
	eta *= parameters["damageLimit"] * (parameters["closedEffect"] if closed else 1)
	return young(parameters) * (1 - eta * orientation[axis])**2


def volume_strain(parameters, pressure):
	"""Compression −ε_v = p/B_0 / (1 + (p/p_EOS)^n_EOS) [-] at a pressure p > 0 [Pa]: the equation of state,
	solved for the strain."""
	return pressure / parameters["bulk"] / (1 + (pressure / parameters["eosPressure"])**parameters["eosExponent"])


def fib_factor(rate, tension):
	"""Strength at a strain rate [1/s] over the static one: fib Model Code for Concrete Structures 2010 (2013),
	clause 5.1.11.2.

	Compression: (ε̇/30·10⁻⁶)^0.014 up to 30 /s, 0.012 (ε̇/30·10⁻⁶)^⅓ above; tension: (ε̇/10⁻⁶)^0.018 up to 10 /s,
	0.0062 (ε̇/10⁻⁶)^⅓ above. With these rounded factors the branches meet within 1.1 % and 0.1 %.
	"""
	static, power, limit, factor = (1e-6, 0.018, 10, 0.0062) if tension else (30e-6, 0.014, 30, 0.012)
	ratio = np.asarray(rate, float) / static
	return np.where(np.asarray(rate) <= limit, ratio**power, factor * np.cbrt(ratio))


FIB_STATIC = {True: 1e-6, False: 30e-6}  #: rates [1/s] of the static strength, in tension and in compression

def kupfer(ratio):
	"""Strength in biaxial compression over the uniaxial one at σ_1/σ_2 from 0 to 1: Kupfer and Gerstle (J. Eng.
	Mech. Div. ASCE 99, 1973), fitted to the tests of Kupfer, Hilsdorf and Rüsch (ACI Journal 66, 1969)."""
	return (1 + 3.65 * ratio) / (1 + ratio)**2


def richart(uniaxial, confinement):
	"""Strength of confined cylinders, f_c + 4.1 σ_3 [Pa]: Richart, Brandtzaeg and Brown (University of Illinois,
	Bulletin 185, 1928)."""
	return uniaxial + 4.1 * confinement
