# GPL v2 or later, see LICENSE.
"""Reports: tables, files, pictures and pages of finished studies. Nothing here needs a scene.

===========================  ====================================================================================
:mod:`uniaxial`              tests in compression or tension; :mod:`figures`: its pictures
:mod:`calibration`           a calibration
:mod:`bonded_study`          the study of bonded spheres; :mod:`bonded_study_figures`: its pictures
:mod:`bonded_test`           what a report says about a test of bonded spheres; :mod:`deformable_test`: of triangles
:mod:`pages`                 what all pages share; :mod:`parameter_tables`: materials in them
===========================  ====================================================================================
"""
from .._lazy import lazy

_MODULES = (
	"bonded_study", "bonded_study_figures", "bonded_test", "calibration", "deformable_test", "figures", "pages",
	"parameter_tables",
	"uniaxial"
)
__getattr__, __dir__ = lazy(globals(), dict.fromkeys(_MODULES))
