# GPL v2 or later, see LICENSE.
"""Names of a package that are loaded when first used."""
import importlib


def lazy(package, names, modules=None):
	"""``__getattr__`` and ``__dir__`` for a package.

	:param package: its globals()
	:param names: name -> module of the package that has it; None: it is itself a module
	:param modules: name -> module that it stands for, where that is called otherwise or lies deeper
	"""
	modules = {**{name: name for name, home in names.items() if home is None}, **(modules or {})}

	def load(name):
		if name not in names and name not in modules:
			raise AttributeError(f"module '{package['__name__']}' has no attribute '{name}'")
		module = importlib.import_module("." + (modules.get(name) or names[name]), package["__name__"])
		return module if name in modules else getattr(module, name)

	return load, lambda: sorted({*package, *names, *modules})
