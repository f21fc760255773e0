# GPL v2 or later, see LICENSE.
"""Crack-band correction: fracture energy per volume scaled with the size of the triangles, so that a crack takes the
same energy per area on any mesh.

The fracture energy G_f of :yref:`ConcreteDamageMat` is per volume: a crack that runs through one row of triangles of
width h takes G_f h per area, half of it on half the size. Bažant and Oh (Crack band theory for fracture of concrete,
Matériaux et Constructions 16, 1983) keep the energy per area by

	G_f(h) = G_f h_ref/h,   h = √(2 S)

with S the area of the triangle; that width is Rots' for linear triangles (Computational modeling of concrete fracture,
Delft, 1988). The factor acts from a damage Ω_D of 0.5 on, when with n_f = 2 a fifth of the strength is gone:
until about there flow is spread over the volume and G_f rules the strength, which must not depend on the mesh.
From there on it is right for this law in the following sense. In an open crack ``Ω = ½ |M_c| w/G_f`` (eq. 8) and
σ = σ_t/(1 + Ω²), with the work of flow w = ∫ σ dε_p; with the opening δ = h ε_p and G_f h kept, σ is the same function
of δ for all h, but for the rate, whose effect is h^−0.08.

Measured on bars that break in one row (verification case ``crack_band``, G_f = 8 kJ/m³ at 10 mm): on unstructured
meshes of 12 to 4 mm strengths of 9.8 to 10.0 MPa and energies until 0.1 mm of 341 to 360 J/m² (388 to 207 without the
correction), at 3 and 2.5 mm 11 MPa and 360 J/m²; on straight rows of 20 to 2.5 mm 327 to 392 J/m² (521 to 172 without)
and 10.0 to 10.2 MPa, 12.3 on the finest. The crushed block of ``scripts/reinforced_block.py --study mesh`` takes 5 to
9 % more energy with each halving of the size, where it takes 13 to 16 % less without; the notched beam of
``scripts/notched_beam.py`` 8 % less instead of 19 %.

Its limits:

- What is taken before flow localises stays per volume, as it should where it is spread; counted in one row it is
  a difference of up to 20 % from 20 to 2.5 mm.
- Materials that have not passed their peak at Ω_D = 0.5 harden once more where h is well below h_ref: where the sides
  are held (uniaxial strain) with G_f = 8 kJ/m³ by 21 % at h_ref/4 and 45 % at h_ref/8 on straight rows (13 % at h_ref/4
  on unstructured meshes), and in fast compression (1000 /s) by 11 to 16 % at h_ref/4 with a tenth to a fifth of
  Table 2's G_f. With that itself strengths stay within 0.2 %.
- A crack oblique to the rows is wider than h; within a triangle the flow may localise once more, in its sub-elements:
  bars of the case take 15 to 28 % less than a material point.
- The energy of a crack never ends: σ falls as 1/Ω², so it grows with the cube root of the opening.
  G_f h is a measure of it, not the sum.
- There is no snap-back within a triangle in tension as long as G_f > 0.43 σ_t²/E, σ_t being the stress of steady flow
  (the steepest softening of the above, ``0.52 ½|M_c| σ_t²/G_f``, against E). That is 0.7 kJ/m³ for Table 2 at 1/s,
  so h may be a hundred times h_ref. In compression it comes sooner: in plane strain with Table 2 from five times h_ref
  on, with a fifth of its G_f from twice.
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
		raise ValueError(
			f"crack_band = {reference!r} must be a length [m]: the width √(2 S) of triangles of area "
			"S for which the fracture energy holds"
		)
	return reference / widths(areas)
