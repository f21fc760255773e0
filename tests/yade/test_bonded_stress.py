# GPL v2 or later, see LICENSE.
"""Mean stress of bonded spheres from the forces of their bonds: uniform fields, and which share of a bond counts."""
import numpy as np
import pytest

from yade import BondedMat, O, ddem
from yade.ddem import bonded_stress


def pressed(axis):
	"""A prism between platens along an axis, at rest."""
	O.materials.append(BondedMat(label="rock", young=50e9, cohesion=1e12))
	box = ddem.packing.Box((0, 0, 0), (0.012, 0.014, 0.012))
	sample = ddem.bonded.append(ddem.packing.fill(box, 0.7e-3, 1.8e-3, seed=3), "rock")
	press = ddem.bonded.servo(sample, [("stress", 10e6, 2e-4)], velocity=1.0, axis=axis)
	O.engines = ddem.bonded.engines(press, 3e4)
	O.dt = ddem.bonded.time_step(0.6)
	O.run(int(4e-4 / O.dt), True)
	return sample, press


@pytest.mark.parametrize("axis", ["x", "y"])
def test_uniaxial_compression(axis):
	"""σ = diag(…, -p, …): the mean of any cross-section is exact by equilibrium,
	that of all of the sample as well."""
	sample, press = pressed(axis)
	number = "xyz".index(axis)
	lower, upper = sample.lower - 1e-3, sample.upper + 1e-3
	lower[number], upper[number] = np.array([0.4, 0.6]) * sample.upper[number]
	grown = np.prod(np.delete(upper - lower, number)) / press.area  # the box is wider than the sample
	stress = ddem.bonded.mean_stress(sample, lower, upper) * grown
	assert stress[number, number] == pytest.approx(-press.stress, rel=2e-3)
	others = np.abs(stress)
	others[number, number] = 0
	assert others.max() < 0.06 * press.stress  # of a slice; nothing holds the sides
	assert (stress == stress.T).all()


def test_shares_of_lines_within_a_box():
	lower, upper = np.zeros(3), np.ones(3)
	lines = np.array([
		[[-1, 0.5, 0.5], [1, 0.5, 0.5]], [[0.25, 0.5, 0.5], [0.75, 0.5, 0.5]], [[-1, -1, -1], [3, 3, 3]],
		[[2, 0.5, 0.5], [3, 0.5, 0.5]], [[0.5, 2, 0.5], [0.6, 2, 0.5]], [[-1, 0.5, 0.5], [3, 0.5, 0.5]],
		[[0.5, 0.5, 1.5], [1.5, 0.5, 0.5]],
	])
	shares = bonded_stress._share_within(*lines.transpose(1, 0, 2), lower, upper)
	assert shares == pytest.approx([0.5, 1, 0.25, 0, 0, 0.25, 0])


def test_refusals():
	sample, _ = pressed("y")
	with pytest.raises(ValueError, match="upper = .* must be above lower"):
		ddem.bonded.mean_stress(sample, (0, 0, 0), (1, 0, 1))
	with pytest.raises(ValueError, match="no bond runs through the box"):
		ddem.bonded.mean_stress(sample, (1, 1, 1), (2, 2, 2))
