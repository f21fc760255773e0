# GPL v2 or later, see LICENSE.
"""Deformable triangles, concrete damage and rigid bonded particles for YADE scripts.

Append a mesh of deformable triangles and load it::

	from yade import ddem

	O.materials.append(ConcreteDamageMat(label="concrete"))
	block = ddem.append(ddem.mesh.rectangle(width=0.10, height=0.20, size=0.01), "concrete", seed=1)
	platens = ddem.platens(block, velocity=10, ramp=20e-6)
	O.engines = [ForceResetter(),
	DeformableTimeStepper()] + platens.engines + [DeformableEngine(label="deformable")] O.dt = ddem.time_step(0.8)
	ddem.run(until=2e-4)
	print(platens.stress, block.damage.mean())

SI units; tension positive. The package is a library and four houses beside it:

===================  ============================================================================================
here                 what a scene imports: :mod:`mesh` (meshes), :mod:`materialpoint` (one point of the concrete
                     law), :mod:`bonded`, :mod:`packing` and :mod:`shapes` (rigid bonded spheres), :mod:`plots`,
                     :mod:`vtk`, :mod:`provenance` (where results come from)
:mod:`studies`       what scripts build and run: uniaxial tests, structures, calibration, campaigns
:mod:`reports`       pages, tables and pictures of finished studies
:mod:`verification`  cases with a reference each
:mod:`accuracy`      what accuracy costs in time
===================  ============================================================================================

The library imports nothing of the houses, studies nothing of reports. Only :mod:`mesh`, :mod:`materialpoint`,
:mod:`packing`, :mod:`shapes`, :mod:`plots`, :mod:`provenance` and parts of the houses, such as
:mod:`studies.calibration`, work outside YADE.
"""
from . import mesh
from ._lazy import lazy

# Loaded when first used, so that meshes and material points need no YADE, and a scene loads no plotting library
# that it does not call for.
_LAZY = {
	"append": "block", "Block": "block", "time_step": "block", "Field": "field", "platens": "loading",
	"Platens": "loading", "run": "loading", "servo": "loading", "ServoPlatens": "loading", "pressure": "edge_loads",
	"absorb": "edge_loads", "oedometer": "triangle_confinement", "biaxial": "triangle_confinement",
	"simple_shear": "triangle_shear", "three_point_bending": "triangle_bending", "brazilian": "triangle_jaws",
	"brazilian_disc": "triangle_jaws",
	"initial_stress": None, "relax": "relaxation",
	"out_of_balance": "relaxation",
	"EnergyBalance": "energy", "StepMeter": "meter", "estimate": "accuracy.estimate",
	"effects": "effect_table",
	"materialpoint": None, "bonded": None, "packing": None, "shapes": None, "plots": None, "vtk": None,
	"provenance": None,
	"studies": None, "reports": None, "verification": None, "accuracy": None,
}
#: shorter names of modules in the houses
_SHORT = {
	"calibration": "studies.calibration", "commandline": "studies.commandline", "esys": "studies.esys",
	"structures": "studies.structures", "ucs": "studies.uniaxial", "virtualtest": "studies.virtualtest",
	"report": "reports.uniaxial",
}
__getattr__, __dir__ = lazy(globals(), _LAZY, _SHORT)
