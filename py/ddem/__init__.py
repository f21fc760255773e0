# GPL v2 or later, see LICENSE.
"""Deformable triangles, concrete damage and rigid bonded particles for YADE scripts.

Append a mesh of deformable triangles and load it::

	from yade import ddem

	O.materials.append(ConcreteDamageMat(label="concrete"))
	block = ddem.append(ddem.mesh.rectangle(width=0.10, height=0.20, size=0.01), "concrete", seed=1)
	platens = ddem.platens(block, velocity=10, ramp=20e-6)
	O.engines = [ForceResetter(), DeformableTimeStepper()] + platens.engines + [DeformableEngine(label="deformable")]
	O.dt = ddem.time_step(0.8)
	ddem.run(until=2e-4)
	print(platens.stress, block.damage.mean())

SI units; tension positive. Sub-modules: :mod:`mesh` (meshes), :mod:`materialpoint` (one point of the concrete law), :mod:`bonded` and :mod:`packing` (rigid bonded
spheres), :mod:`calibration` and :mod:`virtualtest`, :mod:`plots`, :mod:`report`. Only :mod:`mesh`, :mod:`materialpoint`, :mod:`packing` and
:mod:`calibration` work outside YADE.
"""
import importlib

from . import mesh

# Loaded when first used, so that meshes and material points need no YADE, and a scene loads no plotting library that it does not call for.
_LAZY = {
	"append": "block", "Block": "block", "time_step": "block", "platens": "loading", "Platens": "loading", "run": "loading", "relax": "relaxation", "out_of_balance": "relaxation", "EnergyBalance": "energy",
	"materialpoint": None, "bonded": None, "packing": None, "calibration": None, "virtualtest": None, "esys": None, "plots": None,
	"report": None, "verification": None, "vtk": None,
}


def __getattr__(name):
	if name not in _LAZY:
		raise AttributeError(f"module 'yade.ddem' has no attribute '{name}'")
	home = _LAZY[name]
	module = importlib.import_module("." + (home or name), __name__)
	return getattr(module, name) if home else module


def __dir__():
	return sorted(list(globals()) + list(_LAZY))
