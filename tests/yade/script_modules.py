# GPL v2 or later, see LICENSE.
"""Scripts as modules, so that tests can call them without a YADE of their own."""
import importlib.util
import os
import sys

import yade

SCRIPTS = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", "..", "scripts"))


def path(name):
	return os.path.join(SCRIPTS, name + ".py")


def load(name):
	"""A script as a module."""
	spec = importlib.util.spec_from_file_location(name, path(name))
	module = importlib.util.module_from_spec(spec)
	# a YADE script finds these without importing them
	module.__dict__.update({key: getattr(yade, key) for key in dir(yade) if not key.startswith("_")})
	spec.loader.exec_module(module)
	return module


def run(module, monkeypatch, *arguments):
	"""What a user gets from the script with these arguments."""
	monkeypatch.setattr(sys, "argv", [path(module.__name__), *map(str, arguments)])
	return module.main()
