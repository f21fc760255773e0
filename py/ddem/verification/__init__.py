# GPL v2 or later, see LICENSE.
"""Verification: cases with a reference each, which anybody can run.

``scripts/ddem run scripts/verify.py`` runs them; so do the tests. To add one, put a file into ``cases/`` (one concept
or family a file; every file there is found by itself). It reads like an example::

	# GPL v2 or later, see LICENSE.
	\"\"\"A column under its own weight.\"\"\"
	from yade import ForceResetter, DeformableElastMat, DeformableEngine, O, ddem
	from yade.ddem import plots
	from yade.ddem.verification import case


	@case(group="statics", seconds=0.4)
	def settling(check, size=0.01):
		\"\"\"A column settles under its own weight

		The sides are free, the bottom slides on rollers: σ_yy = −ρ g (H − y),
		and away from the bottom nothing else.

		Reference: equilibrium of the part above y; any textbook, Timoshenko and Goodier (1970), art. 96.

		Expect: the weight on the support to round-off, the stress at mid-height within 1 %.
		\"\"\"
		O.materials.append(DeformableElastMat(label="rock", bulk=30e9, shear=26e9, density=2400))
		column = ddem.append(ddem.mesh.rectangle(0.1, 0.4, size), "rock")
		…
		check("stress at mid-height [Pa]", stress, -2400 * 9.81 * 0.2, tolerance=1e-2, source="equilibrium")
		check("shear stress [Pa]", shear, 0, tolerance=1e-3, scale=2400 * 9.81 * 0.4, source="free sides")
		check.picture(lambda: draw(column.stress.copy()), "Stress over height; the line is −ρ g (H − y).")
		check.note("What the numbers mean, a limit that they show.")

- ``group`` is one of :data:`framework.GROUPS` and orders the report; ``seconds`` is the wall time that the case takes,
  rounded up. Cases that take longer than :data:`framework.SLOW` seconds are slow: they run with ``--all`` only.
  One that calls another program says so with ``needs``; the tests run it among the slow ones, and its Debian package
  stands in the header of scripts/verify.py.
- The first line of the docstring is the case's title, the other paragraphs are its text in the report; *Reference:* and
  *Expect:* are paragraphs of it. What comes after a blank line and is indented by a tab more is shown as a formula.
- ``check(quantity, value, reference, tolerance, source)`` records a comparison: the error is ``|value − reference|``
  over ``|reference|``, or over ``scale`` where the reference is zero or small. The quantity ends with its unit in
  brackets. A case passes when all its checks do; one that raises has failed.
- ``check.picture(draw, caption)`` calls ``draw()``, which returns a matplotlib figure or axes, at once and off the
  clock, and only where pictures are wanted.
- The scene is empty when a case begins; a case may call O.reset() as often as it likes.
  What it needs of others is in :mod:`tools`.
- Further arguments of the function are settings with a default (mesh size, treatment of rotation …), which
  ``verification.run(name, size=0.005)`` may change.
- Never loosen a tolerance to make a case pass: find out why. What is a limit of the method is said in a note.
"""
from .framework import GROUPS, SLOW, Case, Record, Result, all_cases, case, find, run

__all__ = ["GROUPS", "SLOW", "Case", "Record", "Result", "all_cases", "case", "find", "run"]
