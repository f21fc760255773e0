# GPL v2 or later, see LICENSE.
"""Kinds of tests of deformable triangles, as ``scripts/ucs_deformable.py --test`` names them.

A kind is a module here with a :class:`kind.DeformableTest` as ``TEST``: its mesh, its loads, its default speed and
largest strain, its own options, what it refuses, what an elastic sample gives, and what the report says of it.
It is found by being here; nothing else has to know it. :mod:`bonded_tests` is the same for bonded spheres.
"""
import importlib
import pkgutil


def _found():
	modules = (importlib.import_module(f".{each.name}", __name__) for each in pkgutil.iter_modules(__path__))
	return {module.TEST.name: module.TEST for module in modules if hasattr(module, "TEST")}


TESTS = _found()  #: name -> :class:`kind.DeformableTest`
