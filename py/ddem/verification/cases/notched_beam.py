# GPL v2 or later, see LICENSE.
"""A notched beam in three-point bending."""
import numpy as np

from yade import DeformableElastMat, O, ddem
from yade.ddem.structures import beam
from yade.ddem.verification import case, freefem, statics, tools


def stiffness(size):
	"""Force over deflection of the elastic beam, per thickness [Pa], by FreeFem++ on the mesh split at the centroids: twice the energy over the deflection squared."""
	O.reset()
	O.materials.append(DeformableElastMat(label="elastic", **beam.CONCRETE))
	block = ddem.append(beam.mesh(size), "elastic")
	loaded, stands = beam.supports(block)
	nodes, triangles = statics.split_at_centroids(block.mesh)
	held, values = np.zeros(nodes.shape, bool), np.zeros(nodes.shape)
	held[stands, 1] = held[loaded] = True
	values[loaded, 1] = -1.0
	lam, mu = tools.lame(O.materials["elastic"])
	moved = freefem.solve(nodes, triangles, (lam, mu), np.zeros(nodes.shape), held, values)
	corners = np.concatenate([np.ones((len(triangles), 3, 1)), nodes[triangles]], axis=2)
	gradient = np.einsum("tik,tkj->tij", np.linalg.inv(corners)[:, 1:], moved[triangles])
	strain = 0.5 * (gradient + gradient.transpose(0, 2, 1))
	energy = 0.5 * lam * np.trace(strain, axis1=1, axis2=2)**2 + mu * (strain**2).sum(axis=(1, 2))
	return 2 * (0.5 * np.linalg.det(corners) * energy).sum()


@case(group="concrete structures", seconds=8, needs="FreeFem++")
def notched_beam(check, size=0.01):
	"""A notched beam in three-point bending

	A beam of 44 cm × 10 cm on a span of 40 cm, with a notch of 3 cm, is pushed down in the middle; first elastic and slowly, then until a crack has grown.

	Reference: the elastic beam by FreeFem++ at rest; the crack runs up from the notch, since the beam is symmetric but for its mesh; the first law.

	Expect: the stiffness within 2 % (a slow push still shakes the beam); the crack within a triangle's size of the middle, more than half of the way up.
	"""
	expected = stiffness(size)
	O.reset()
	slow = beam.run(size, velocity=0.05, elastic=True, deflection=5e-5)
	rising = slow.deflection > 1e-5
	found = (slow.force[rising] @ slow.deflection[rising]) / (slow.deflection[rising] @ slow.deflection[rising])
	check("stiffness of the elastic beam [Pa]", found, expected, 0.02, "FreeFem++ on the split mesh, at rest")
	O.reset()
	broken = beam.run(size)
	heights, places = broken.crack()
	check("mean distance of the crack from the middle [m]", np.mean(places) - beam.LENGTH / 2, 0, 1.0, "symmetry; relative to the triangles' size", scale=size)
	grown = (heights.max() - beam.NOTCH) / (beam.HEIGHT - beam.NOTCH)
	check("what the crack lacks of half the way up [-]", max(0.5 - grown, 0), 0, 1e-12, "the beam breaks", scale=1)
	check("error of the energy book [-]", max(slow.energy_error, broken.energy_error), 0, 1e-6, "first law", scale=1)
	check.note(
		f"The crack is {100 * grown:.0f} % of the way up. Largest force {broken.force.max() / 1e3:.0f} kN/m at {1e3 * broken.deflection[broken.force.argmax()]:.2f} mm; the load has done {broken.work[-1]:.1f} J/m until "
		f"{1e3 * broken.deflection[-1]:.1f} mm, of which flow and damage have taken {broken.dissipated[-1]:.1f}. Finer meshes: scripts/notched_beam.py."
	)

	def draw():
		fig, (ax,) = tools.axes(height=58)
		ax.plot(1e3 * broken.deflection, broken.force / 1e3, label="concrete")
		elastic = np.linspace(0, 6e-5, 2)
		ax.plot(1e3 * elastic, expected * elastic / 1e3, "k--", linewidth=0.8, label="elastic, FreeFem++")
		ax.set_xlabel("deflection [mm]")
		ax.set_ylabel("force per thickness [kN/m]")
		tools.legend(ax)
		return fig

	check.picture(draw, "Force over deflection of the notched beam.")
