# GPL v2 or later, see LICENSE.
# Writes the module that tells an installed package its version and the commit it was built from.
#   build_record.py CHECKOUT FILE
import importlib.util
import pathlib
import sys

checkout, target = map(pathlib.Path, sys.argv[1:])
spec = importlib.util.spec_from_file_location("provenance", checkout / "py" / "ddem" / "provenance.py")
provenance = importlib.util.module_from_spec(spec)
spec.loader.exec_module(provenance)
text = f'''# Written when the package was installed.
VERSION = {provenance.version_of(checkout)!r}
REVISION = {provenance.revision_of(checkout)!r}
'''
if not target.is_file() or target.read_text() != text:
	target.write_text(text)
