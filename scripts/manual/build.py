# GPL v2 or later, see LICENSE.
"""Makes the manual, as HTML pages in OUTPUT. scripts/ddem docs calls it: yade -n -x scripts/manual/build.py OUTPUT

Every page is made anew: Sphinx does not see that a doc string of a C++ class has changed, and would not repeat the
warnings about a page that it knows already. The exit code is 0 when there was none.
"""
import os
import sys
import tempfile

from sphinx.cmd.build import build_main

source = os.path.dirname(os.path.abspath(sys.argv[0]))
with tempfile.TemporaryDirectory() as cache:
	# A warning is an error (-W), also about a reference to something that does not exist (-n).
	strict = ["-E", "-a", "-n", "-W", "--keep-going"]
	status = build_main(["-b", "html", "-q", *strict, "-d", cache, source, sys.argv[1]])
sys.exit(status)
