# GPL v2 or later, see LICENSE.
"""Crack-band correction: fracture energy per volume scaled with the size of the triangles, so that a crack takes the same energy per area on any mesh.

The fracture energy G_f of :yref:`ConcreteDamageMat` is per volume: a crack that runs through one row of triangles of width h takes G_f h per area, half of it on
half the size. Bažant and Oh (Crack band theory for fracture of concrete, Matériaux et Constructions 16, 1983) keep the energy per area by

	G_f(h) = G_f h_ref/h,   h = √(2 S)

with S the area of the triangle; that width is Rots' for linear triangles (Computational modeling of concrete fracture, Delft, 1988). It is exact for this law in
the following sense. In an open crack Ω = ½ |M_c| w/G_f (eq. 8) and σ = σ_t/(1 + Ω²), with the work of flow w = ∫ σ dε_p; with the opening δ = h ε_p and G_f h
kept, σ is the same function of δ for all h, but for the rate, whose effect is h^−0.08.

Limits, measured by the verification case ``crack_band`` and by ``scripts/reinforced_block.py --study mesh``:

- Only what is dissipated in bands of one row is corrected. Where flow spreads over many triangles, energy per volume is the right measure, and the correction
  overcorrects: with each halving of the size the crushed block of the report takes about 15 % less energy without it and 18 % more with it, the beam of
  ``scripts/notched_beam.py`` 11 % less and 23 % more.
- G_f slows the damage before the peak as well, so the strength changes with the size: 8.4, 10.4 and 12.6 MPa on rows of 20, 10 and 5 mm in the case, where it is
  10.1, 10.4 and 10.7 MPa without the correction.
- A crack oblique to the rows is wider than h; within a triangle the flow may localise once more, in its sub-elements.
- There is no snap-back within a triangle as long as G_f > 0.43 σ_t²/E, σ_t being the stress of steady flow in tension (the steepest softening of the above,
  0.52 ½|M_c| σ_t²/G_f, against E). That is 0.7 kJ/m³ for Table 2, so h may be a hundred times h_ref.
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
