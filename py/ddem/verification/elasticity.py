# GPL v2 or later, see LICENSE.
"""Exact solutions of plane-strain elasticity, and what follows from the elastic constants.

Plane fields come from the complex potentials φ and ψ of Kolosov and Muskhelishov (N. I. Muskhelishov, Some Basic
Problems of the Mathematical Theory of Elasticity, 1953, § 32), so that equilibrium and compatibility
hold by construction::

	2μ (u + i v) = κ φ(z) − z conj φ'(z) − conj ψ(z),   κ = 3 − 4ν
	σ_xx + σ_yy = 4 Re φ'(z),   σ_yy − σ_xx + 2 i σ_xy = 2 (conj(z) φ''(z) + ψ'(z))
"""
import numpy as np
from scipy.optimize import brentq


class PlaneField:
	"""A solution given by its potentials: φ, φ', φ'', ψ, ψ' as functions of z = x + i y [Pa·m, Pa, Pa/m]."""

	def __init__(self, material, phi, dphi, ddphi, psi, dpsi):
		self.mu, self.kappa = material.shear, 3 - 4 * material.poisson
		self.phi, self.dphi, self.ddphi, self.psi, self.dpsi = phi, dphi, ddphi, psi, dpsi

	def displacement(self, points):
		"""(n, 2) [m] at points (n, 2) [m]."""
		z = points[..., 0] + 1j * points[..., 1]
		u = (self.kappa * self.phi(z) - z * np.conj(self.dphi(z)) - np.conj(self.psi(z))) / (2 * self.mu)
		return np.stack([u.real, u.imag], axis=-1)

	def stress(self, points):
		"""(n, 3) xx, yy, xy [Pa] at points (n, 2) [m]."""
		z = points[..., 0] + 1j * points[..., 1]
		mean, deviator = 2 * self.dphi(z).real, np.conj(z) * self.ddphi(z) + self.dpsi(z)
		return np.stack([mean - deviator.real, mean + deviator.real, deviator.imag], axis=-1)

	def traction(self, points, normals):
		"""(n, 2) force per area [Pa] on surfaces with these outer normals."""
		xx, yy, xy = np.moveaxis(self.stress(points), -1, 0)
		return np.stack(
			[xx * normals[..., 0] + xy * normals[..., 1], xy * normals[..., 0] + yy * normals[..., 1]],
			axis=-1,
		)


def kirsch(material, stress, radius):
	"""Infinite plate with a hole at the origin, pulled by *stress* [Pa] along x (Kirsch 1898;
	Muskhelishov § 56a)."""
	s, a = stress, radius
	return PlaneField(
		material,
		lambda z: s / 4 * (z + 2 * a**2 / z),
		lambda z: s / 4 * (1 - 2 * a**2 / z**2),
		lambda z: s * a**2 / z**3,
		lambda z: -s / 2 * (z + a**2 / z - a**4 / z**3),
		lambda z: -s / 2 * (1 - a**2 / z**2 + 3 * a**4 / z**4),
	)


def exponential(material, stress, length):
	"""A smooth field with all components, which grows by e over *length* [m];
	φ = S ℓ e^{z/ℓ}, ψ = i S ℓ e^{z/ℓ}/2."""
	s, l = stress, length
	grow = lambda z: np.exp(z / l)
	return PlaneField(
		material, lambda z: s * l * grow(z), lambda z: s * grow(z), lambda z: s / l * grow(z),
		lambda z: 0.5j * s * l * grow(z), lambda z: 0.5j * s * grow(z)
	)


def plane_modulus(material):
	"""E/(1 − ν²) [Pa]: Young's modulus of a strip in plane strain."""
	return material.young / (1 - material.poisson**2)


def speeds(material):
	"""Speeds of compression and shear waves in plane strain [m/s]: √((B + 4μ/3)/ρ), √(μ/ρ)."""
	return np.sqrt((material.bulk + 4 / 3 * material.shear) / material.density), np.sqrt(
		material.shear / material.density
	)


def rayleigh_speed(material):
	"""Speed of Rayleigh's surface wave [m/s], the root of (2 − s)² = 4 √(1 − s) √(1 − s c_s²/c_p²), s = c_R²/c_s²
	(Rayleigh 1885)."""
	p, s = speeds(material)
	ratio = (s / p)**2
	root = brentq(lambda x: (2 - x)**2 - 4 * np.sqrt((1 - x) * (1 - x * ratio)), 1e-3, 1 - 1e-9, xtol=1e-15)
	return s * np.sqrt(root)


def behind_dashpots(material, angle):
	"""What a plane compression wave of velocity 1 makes of itself at an edge with dashpots ρ c_p and ρ c_s along
	and across its normal (Lysmer & Kuhlemeyer 1969), which it meets at this angle to the normal [rad],
	below 90 degrees.

	The traction of the incident, the reflected compression and the reflected shear wave is that of the dashpots,
	and their places on the edge go along together (Snell).

	:returns: velocity of the edge along the outward normal and along the edge, towards which the wave goes [-];
		share of the energy that comes back [-]
	"""
	lam, mu = material.bulk - 2 / 3 * material.shear, material.shear
	fast, slow = speeds(material)
	shear_angle = np.arcsin(slow / fast * np.sin(angle))

	def wave(direction, polarisation, speed):
		"""Velocity at the edge, and its traction plus that of the dashpots."""
		strain = -0.5 / speed * (np.outer(direction, polarisation) + np.outer(polarisation, direction))
		stress = lam * np.trace(strain) * np.eye(2) + 2 * mu * strain
		return polarisation, stress[:, 0] + material.density * np.array([fast, slow]) * polarisation

	ways = [np.array([sign * np.cos(angle), np.sin(angle)]) for sign in (1, -1)]
	shear = np.array([-np.cos(shear_angle), np.sin(shear_angle)])
	waves = [wave(ways[0], ways[0], fast), wave(ways[1], ways[1], fast), wave(shear, shear[::-1] * [1, -1], slow)]
	back = np.linalg.solve(np.column_stack([waves[1][1], waves[2][1]]), -waves[0][1])
	velocity = waves[0][0] + back[0] * waves[1][0] + back[1] * waves[2][0]
	energy = back[0]**2 + back[1]**2 * slow * np.cos(shear_angle) / (fast * np.cos(angle))
	return velocity, float(energy)
