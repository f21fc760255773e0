# GPL v2 or later, see LICENSE.
"""Studies: samples and structures that are built, loaded and measured, for scripts, verification cases and reports.

=============================  ====================================================================================
:mod:`uniaxial`                a sample crushed between platens or pulled apart; :mod:`runs`, :mod:`measures`
                               and :mod:`snapshots`: what is kept of it, as plain data; :mod:`wording`: its words
:mod:`virtualtest`             tests of a small specimen, in this YADE or each in its own
:mod:`calibration`             material parameters for wanted strengths; :mod:`calibration_quantities`,
                               :mod:`evaluations`
:mod:`campaign`                many runs of a script
:mod:`workers`                 where independent runs go: Dask's workers; :mod:`questions` to a module, each
                               answered in a YADE of its own (:mod:`yade_process`)
:mod:`bonded_tests`            kinds of tests of bonded spheres; :mod:`bonded_options`, :mod:`bonded_specimen`:
                               their options and samples
:mod:`deformable_tests`        the same of deformable triangles; :mod:`deformable_options`, :mod:`deformable_laws`
:mod:`bonded_study`            the study of bonded spheres
:mod:`esys`                    ESyS-Particle as a peer
:mod:`structures`              beam, bar and blocks
:mod:`commandline`             options that scripts share
=============================  ====================================================================================
"""
from .._lazy import lazy

_MODULES = (
	"bonded_options", "bonded_specimen", "bonded_study", "bonded_tests", "calibration", "calibration_quantities",
	"campaign", "commandline", "deformable_laws", "deformable_options", "deformable_tests", "esys", "evaluations",
	"interrupts", "measures", "questions", "runs", "snapshots", "structures", "uniaxial", "virtualtest", "wording",
	"workers", "yade_process"
)
__getattr__, __dir__ = lazy(globals(), dict.fromkeys(_MODULES))
