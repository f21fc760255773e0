# GPL v2 or later, see LICENSE.
"""Lines of at most 120 columns, a tab being 8."""
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
WIDTH = 120
KINDS = (".cpp", ".hpp", ".in", ".py", ".sh", ".cmake", "CMakeLists.txt", "scripts/ddem")


def sources():
	found = [path for folder in ("pkg", "py", "scripts", "tests") for path in (ROOT / folder).rglob("*")]
	names = [path.relative_to(ROOT).as_posix() for path in found if path.is_file()]
	return ["CMakeLists.txt"] + [name for name in names if name.endswith(KINDS)]


def wide_lines(name):
	with open(ROOT / name, encoding="utf-8") as file:
		return [number for number, line in enumerate(file, 1) if len(line.rstrip("\n").expandtabs(8)) > WIDTH]


def test_lines_are_no_wider_than_120_columns():
	files = sources()
	assert len(files) > 200
	for name in files:
		wide = wide_lines(name)
		assert not wide, f"{name} has lines wider than {WIDTH} columns: {wide}"
