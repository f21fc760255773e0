# GPL v2 or later, see LICENSE.
"""A ladder as a user writes one, whose errors are known: of first order in the time step."""
from yade import DeformableElastMat, DeformableEngine, ForceResetter, O, ddem
from yade.ddem.accuracy.ladders import Ladder, Quantity, each


def fall(safety):
	"""A block falls from rest: leapfrog's way is g dt² n (n + 1)/2, longer than g t²/2 by one part in n."""
	O.materials.append(DeformableElastMat(young=30e9, poisson=0.2, density=2400, label="rock"))
	block = ddem.append(ddem.mesh.rectangle(0.04, 0.04, size=0.01), "rock")
	O.engines = [ForceResetter(), DeformableEngine(gravity=(0, -1e6, 0))]
	O.dt = safety * 1e-7
	O.run(round(2e-5 / O.dt), True)
	return {"way": (-block.displacements[:, 1].mean(), 0.5e6 * O.time**2)}


LADDERS = [
	Ladder(
		"mine", "time-step fraction", fall, each("safety", 0.8, 0.4, 0.2),
		[Quantity("way", "displacement", "m")], refined="safety"
	)
]
