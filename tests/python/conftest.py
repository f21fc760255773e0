# GPL v2 or later, see LICENSE.
"""These tests need no scene: they run inside YADE like all others, or in plain Python against an installed overlay:
YADE_PREFIX=OVERLAY python3 -m pytest tests/python"""
import glob
import os
import sys

import pytest

if "yade" in sys.modules:
	import yade.ddem
	sys.modules["ddem"] = yade.ddem
else:
	packages = glob.glob(os.path.join(os.environ.get("YADE_PREFIX") or "/usr", "lib", "*", "yade*", "py", "yade", "ddem"))
	if not packages:
		raise pytest.UsageError("no installed package yade.ddem: set YADE_PREFIX to the overlay it was installed into, or run inside YADE")
	sys.path.insert(0, os.path.dirname(packages[0]))
