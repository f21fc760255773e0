# GPL v2 or later, see LICENSE.
"""The houses of the package: who may import whom, which names lead where, and which test belongs to what."""
import ast
import importlib
import importlib.util
import re
from pathlib import Path

import ddem
import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "py" / "ddem"

#: tests that no module, class or script names, each about several of them together
TOPICS = {
	"bonded_contacts": "bonded spheres against everything that YADE has",
	"bonded_cells": "bonded spheres in periodic cells",
	"bonded_samples": "samples of bonded spheres as users make and change them",
	"bonded_energy": "the energy book of bonded spheres",
	"deformable_errors": "bad input to triangles",
	"deformable_motion": "triangles and mechanics",
	"deformable_saving": "scenes of triangles that are saved and loaded",
	"deformable_scene": "triangles among YADE's own bodies and engines",
	"deformable_static": "triangles and finite elements",
	"esys_equality": "bonded spheres against recorded runs of ESyS-Particle",
	"houses": "this file",
	"manual": "the extensions that make the manual",
	"results": "what the files of scripts say of themselves",
	"plugin": "that YADE has loaded the plugin",
	"several_engines": "blocks of triangles with engines of their own",
	"single_process": "the refusal to run in several MPI processes",
	"unfelt_settings": "settings of YADE that triangles would not feel",
	"verification_references": "the references of the verification cases",
}
#: house -> houses it must not import
FORBIDDEN = {
	"": {"studies", "reports", "verification", "accuracy"},  # the library
	"studies": {"reports", "verification", "accuracy"},
	"reports": {"verification", "accuracy"},
	"verification": {"accuracy"},
	"accuracy": set(),
}


def modules():
	"""Dotted names within the package -> file."""
	found = {path.relative_to(PACKAGE).with_suffix("").parts: path for path in PACKAGE.rglob("*.py")}
	return {".".join(part for part in parts if part != "__init__"): path for parts, path in found.items()}


def classes():
	"""YADE classes of the plugin."""
	sources = (path.read_text(encoding="utf-8") for path in (ROOT / "pkg").rglob("*.cpp"))
	registered = (re.findall(r"DDEM_PLUGIN\(((?:\(\w+\)\s*)+)\)", source) for source in sources)
	return {name for lists in registered for names in lists for name in re.findall(r"\w+", names)}


def test_every_test_file_names_what_it_tests():
	named = {name.replace(".", "_") for name in modules()}
	named |= {re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower() for name in classes()}
	named |= {path.stem for path in (ROOT / "scripts").glob("*.py")}
	files = [path for folder in ("python", "yade") for path in (ROOT / "tests" / folder).rglob("test_*.py")]
	tests = {path.stem[len("test_"):] for path in files}
	assert len(tests) > 30 and len(classes()) > 10  # they are found at all
	assert not tests - named - set(TOPICS), "name them after a module, house_module, a YADE class or a script"
	assert not set(TOPICS) - tests and not set(TOPICS) & named, "these are no exceptions any more"


def imported(name, path):
	"""First part of the dotted names within the package that a file imports."""
	home = name.split(".") if path.name == "__init__.py" and name else name.split(".")[:-1]
	for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
		if isinstance(node, ast.ImportFrom):
			source = (node.module or "").split(".") if node.module else []
			if node.level:
				source = home[:len(home) - (node.level - 1)] + source
			elif source[:2] == ["yade", "ddem"]:
				source = source[2:]
			else:
				continue
			yield from {source[0]} if source else {alias.name for alias in node.names}


@pytest.mark.parametrize("house", FORBIDDEN)
def test_houses_are_imported_from_above_only(house):
	seen = set()
	for name, path in modules().items():
		first = name.split(".")[0]
		if (first if first in FORBIDDEN else "") == house:
			found = set(imported(name, path))
			seen |= found
			assert not found & FORBIDDEN[house], name
	assert seen  # imports are found at all


def test_short_names_lead_to_modules_that_exist():
	for home in ddem._SHORT.values():
		assert home in modules() and importlib.util.find_spec(f"ddem.{home}"), home
	assert ddem.calibration is ddem.studies.calibration is importlib.import_module("ddem.studies.calibration")
	assert ddem.report is ddem.reports.uniaxial
	assert {"append", "ucs", "reports", "mesh"} <= set(dir(ddem))
	with pytest.raises(AttributeError, match="'nothing'"):
		_ = ddem.nothing


@pytest.mark.parametrize("house", ["studies", "reports", "accuracy"])
def test_a_house_shows_all_its_modules(house):
	own = {name.split(".")[1] for name in modules() if name.startswith(house + ".")}
	assert own == set(getattr(ddem, house)._MODULES)
