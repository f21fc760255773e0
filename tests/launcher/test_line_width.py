# GPL v2 or later, see LICENSE.
"""Lines of at most 120 columns, a tab being 8: new files keep to it, and older ones may only come closer."""
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
WIDTH = 120
KNOWN = ROOT / "tests" / "data" / "wide_lines.txt"  # lines that were wider when this was first checked: number, file
KINDS = (".cpp", ".hpp", ".in", ".py", ".sh", ".cmake", "CMakeLists.txt", "scripts/ddem")


def sources():
	if not (ROOT / ".git").exists():
		pytest.skip("no checkout")
	listed = subprocess.run(["git", "-c", f"safe.directory={ROOT}", "ls-files"], cwd=ROOT, capture_output=True, text=True)
	if listed.returncode:
		pytest.skip(f"git does not list the files: {listed.stderr.strip()}")
	return [name for name in listed.stdout.split() if name.endswith(KINDS) and (ROOT / name).exists()]


def wide_lines(name):
	with open(ROOT / name, encoding="utf-8") as file:
		return [number for number, line in enumerate(file, 1) if len(line.rstrip("\n").expandtabs(8)) > WIDTH]


def test_lines_are_no_wider_than_120_columns():
	known = {name: int(count) for count, name in (line.split() for line in KNOWN.read_text().splitlines())}
	files = sources()
	assert len(files) > 200
	for name in files:
		wide = wide_lines(name)
		assert len(wide) <= known.get(name, 0), f"{name} has lines wider than {WIDTH} columns: {wide}"
