# GPL v2 or later, see LICENSE.
"""A notched beam in three-point bending."""
import numpy as np

from yade import DeformableElastMat, O, ddem
from yade.ddem.studies.structures import beam
from yade.ddem.verification import case, freefem, statics, tools


def stiffness(size):
	"""Load over deflection of the elastic beam, per thickness [Pa], by FreeFem++ on the split mesh: twice the
	energy over the deflection squared."""
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


@case(group="concrete structures", seconds=20, needs="FreeFem++")
def notched_beam(check, size=0.01, elastic_size=0.005):
	"""A notched beam in three-point bending

	A beam of 44 cm × 10 cm on a span of 40 cm, with a notch of 3 cm, is pushed down in the middle;
	first elastic, then until a crack has grown.

	Reference: the elastic beam by FreeFem++ at rest; the opening of its notch by Tada, Paris and Irwin (1985),
	p. 2.16; the first law; symmetry. For the largest load, two theories between which a beam of this size lies:
	the section above the notch bent elastically until its edge has the tensile strength, and linear elastic
	fracture mechanics (ASTM E399, bend specimen) with the energy that a band of the law takes
	until it is open by 0.1 mm.

	Expect: the stiffness within 0.5 % (the push still shakes the beam); the opening within 3 %, since the formula
	is for a sharp crack and triangles of 5 mm at the tip are too stiff (10 mm: 10 %); the load between the two
	theories; the reactions within 6 % of the load; the crack within a triangle's size of the middle.
	"""
	expected = stiffness(elastic_size)
	O.reset()
	slow = beam.run(elastic_size, elastic=True, deflection=1e-4)
	late = slow.deflection > 3e-5
	slope = lambda x, y: np.polyfit(x[late], y[late], 1)[0]
	check(
		"stiffness of the elastic beam [Pa]",
		slope(slow.deflection, slow.force),
		expected,
		0.005,
		"FreeFem++ on the split mesh, at rest",
	)
	check(
		"opening of the notch over the load [m²/N]",
		slope(slow.force, slow.opening),
		beam.opening_compliance(),
		0.03,
		"Tada, Paris and Irwin (1985), p. 2.16",
	)
	O.reset()
	broken = beam.run(size)
	strength, energy = beam.crack_energy(1e-4, 4e-3)
	low, high = beam.bending_strength(strength), beam.toughness_strength(energy)
	peak = broken.force.max()
	check(
		"largest load over that of elastic bending [-]", peak / low, 0.5 * (1 + high / low),
		0.5 * (high / low - 1), "from 1 to fracture mechanics", scale=1
	)
	check(
		"largest difference of load and reactions over the largest load [-]",
		broken.imbalance, 0, 0.06, "statics", scale=1
	)
	check(
		"kinetic energy over work, from half the largest load on [-]",
		broken.kinetic_share, 0, 0.04, "statics", scale=1
	)
	heights, places = broken.crack()
	check(
		"mean distance of the crack from the middle [m]", np.mean(places) - beam.LENGTH / 2, 0, 1.0,
		"symmetry; relative to the triangles' size", scale=size
	)
	check(
		"error of the energy book [-]", max(slow.energy_error, broken.energy_error), 0, 1e-8, "first law",
		scale=1
	)
	ligament = beam.HEIGHT - beam.NOTCH
	top, band = broken.force.argmax(), beam.ENERGY * beam.BAND
	check.note(
		f"Largest load {peak / 1e3:.0f} kN/m (elastic bending {low / 1e3:.0f}, fracture mechanics "
		f"{high / 1e3:.0f}) at {1e3 * broken.deflection[top]:.2f} mm; until {1e3 * broken.deflection[-1]:.1f} "
		f"mm the load has done {broken.work[-1]:.1f} J/m, of which {broken.kinetic[-1]:.2f} are kinetic and "
		f"{broken.dissipated[-1]:.1f} taken by flow and damage. G_f times the band's width times the "
		f"section is only {band * ligament:.1f} J/m: G_f is no energy of a crack. In an open band the stress "
		"falls as 1/Ω², so that the energy grows without end, as the cube root of the opening: a material "
		f"point takes {energy:.0f} J/m² until 0.1 mm, {energy / band:.1f} G_f h, which is "
		f"{energy * ligament:.1f} J/m on the section. The rest flows beside the crack. The crack is "
		f"{100 * (heights.max() - beam.NOTCH) / ligament:.0f} % of the way up."
	)
	check.note(
		"The strength depends on the speed: on this mesh 103, 83, 61 and 54 kN/m at 0.2, 0.05, 0.02 and "
		"0.01 m/s, where the rate effect of the law alone would take 20 % "
		"from the first to the last. At 0.2 m/s load and reactions differ by 22 % of the largest load: "
		"that is inertia. At 0.02 m/s and below the crack opens in one sub-element of the triangle above the "
		"notch and stays there, with any treatment of rotation, and the load grows again: a limit of the "
		"method on a coarse mesh."
	)

	def draw():
		fig, (ax,) = tools.axes(height=58)
		ax.plot(1e3 * broken.deflection, broken.force / 1e3, label="load")
		ax.plot(1e3 * broken.deflection, broken.reaction / 1e3, linewidth=0.6, label="supports")
		elastic = np.linspace(0, 4.5e-5, 2)
		ax.plot(1e3 * elastic, expected * elastic / 1e3, "k--", linewidth=0.8, label="elastic, FreeFem++")
		ax.axhline(low / 1e3, color="0.5", linewidth=0.8, linestyle=":", label="elastic bending")
		ax.set_xlabel("deflection [mm]")
		ax.set_ylabel("load per thickness [kN/m]")
		ax.set_ylim(0, None)
		tools.legend(ax)
		return fig

	check.picture(draw, "Load and reactions over deflection of the notched beam.")
