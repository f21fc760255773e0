# GPL v2 or later, see LICENSE.
"""Crack-band correction: fracture energy per volume scaled with the size of the triangles, so that a crack takes the same energy per area on any mesh.

The fracture energy G_f of :yref:`ConcreteDamageMat` is per volume: a crack that runs through one row of triangles of width h takes G_f h per area, half of it on
half the size. Bažant and Oh (Crack band theory for fracture of concrete, Matériaux et Constructions 16, 1983) keep the energy per area by

	G_f(h) = G_f h_ref/h,   h = √(2 S)

with S the area of the triangle; that width is Rots' for linear triangles (Computational modeling of concrete fracture, Delft, 1988). It is exact for this law in
the following sense. In an open crack Ω = ½ |M_c| w/G_f (eq. 8) and σ = σ_t/(1 + Ω²), with the work of flow w = ∫ σ dε_p; with the opening δ = h ε_p and G_f h
kept, σ is the same function of δ for all h, but for the rate, whose effect is h^−0.08.

Measured on bars that break in one row (verification case ``crack_band``, G_f = 8 kJ/m³ at 10 mm): energies until 0.1 mm of 342 to 371 J/m² on straight rows of
20 to 2.5 mm and of 351 to 381 J/m² on unstructured meshes of 12 to 4 mm, where without the correction they are 521 to 172 and 388 to 207 J/m².

It is meant for what is dissipated in bands of one row after the peak, and for nothing else:

- G_f slows the damage before the peak as well. With the correction the strength grows on finer meshes, in that case from 8.2 to 15.4 MPa, where it is 10.0 to
  10.3 MPa without; and so does what the material takes, per volume, before its peak, from 2.0 to 11 kJ/m³ (3.4 to 3.6 without).
- Flow of this law is spread over many triangles before it localises, and stays so in compression; there, energy per volume is the right measure, and the
  correction overcorrects. With each halving of the size the crushed block of ``scripts/reinforced_block.py --study mesh`` takes 13 to 16 % less energy without
  it, as h^0.22 where one crack would take h^1, and 16 to 21 % more with it.
  The notched beam of ``scripts/notched_beam.py``, bent slowly, takes 19 % less without it and the same with it.
- A crack oblique to the rows is wider than h; within a triangle the flow may localise once more, in its sub-elements: bars of the case take 15 to 28 % less
  than a material point.
- The energy of a crack never ends: σ falls as 1/Ω², so it grows with the cube root of the opening. G_f h is a measure of it, not the sum.
- There is no snap-back within a triangle as long as G_f > 0.43 σ_t²/E, σ_t being the stress of steady flow in tension (the steepest softening of the above,
  0.52 ½|M_c| σ_t²/G_f, against E). That is 0.7 kJ/m³ for Table 2 at 1/s, so h may be a hundred times h_ref.
"""
import math
import numbers

import numpy as np


def widths(areas):
	"""Width of the crack band √(2 S) [m] of triangles of these areas [m²]."""
	return np.sqrt(2 * np.asarray(areas, float))


def factors(areas, reference):
	"""Factors h_ref/h on the fracture energy of triangles of these areas [m²].

	:param reference: width h_ref [m] for which the material's fracture energy holds
	:raises ValueError: it is not a positive number
	"""
	if not isinstance(reference, numbers.Real) or not 0 < reference < math.inf:
		raise ValueError(f"crack_band = {reference!r} must be a length [m]: the width √(2 S) of triangles of area S for which the fracture energy holds")
	return reference / widths(areas)
