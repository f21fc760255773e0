# GPL v2 or later, see LICENSE.
"""What result files say of where they come from."""
import re

from yade.ddem import provenance

PARTS = {
	"plugin", "versions", "machine", "written", "command", "seed", "parameters_sha256", "files", "inputs_sha256"
}
ABSOLUTE = re.compile(r"(^|[\s='\"])/\w")  # the beginning of an absolute path


def numbers(path):
	"""The lines of a CSV file without the one that says when and how it was made."""
	return [line for line in path.read_bytes().splitlines() if not line.startswith(b"#")]


def of_all(folder):
	"""{file: its record} of every file below a folder; fails at one that has none."""
	found = {}
	for path in sorted(path for path in folder.rglob("*") if path.is_file()):
		if path.suffix == ".pdf":  # has no reader, because PDF writes strings in its own way
			text = path.read_bytes()
			assert b"/Subject" in text and b"inputs_sha256" in text, path
			continue
		found[path] = provenance.read(str(path))
		assert set(found[path]) == PARTS, path
		assert found[path]["versions"]["YADE"] and found[path]["plugin"]["version"], path
		assert not ABSOLUTE.search(found[path]["command"]), path
		assert not any(ABSOLUTE.search(one["file"]) for one in found[path]["files"]), path
	return found
