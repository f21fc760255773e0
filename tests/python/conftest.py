# GPL v2 or later, see LICENSE.
"""These tests need no scene: they run inside YADE like all others, or in plain Python against an installed overlay:
YADE_PREFIX=OVERLAY python3 -m pytest tests/python"""
import glob
import importlib
import importlib.abc
import importlib.util
import os
import sys

import pytest


class SameModules(importlib.abc.MetaPathFinder, importlib.abc.Loader):
	"""Inside YADE the package is yade.ddem; the tests call it ddem in both places,
	and must not load its modules twice."""

	def find_spec(self, name, path, target=None):
		return importlib.util.spec_from_loader(name, self) if name.startswith("ddem.") else None

	def create_module(self, spec):
		self.module = importlib.import_module("yade." + spec.name)
		self.own_spec = self.module.__spec__
		return self.module

	def exec_module(self, module):
		module.__spec__ = self.own_spec


if "yade" in sys.modules:
	sys.modules["ddem"] = importlib.import_module("yade.ddem")
	sys.meta_path.insert(0, SameModules())
else:
	packages = glob.glob(
		os.path.join(os.environ.get("YADE_PREFIX") or "/usr", "lib", "*", "yade*", "py", "yade", "ddem")
	)
	if not packages:
		raise pytest.UsageError(
			"no installed package yade.ddem: set YADE_PREFIX to the overlay it was installed into, or run "
			"inside YADE"
		)
	sys.path.insert(0, os.path.dirname(packages[0]))
