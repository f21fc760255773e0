# GPL v2 or later, see LICENSE.
"""The extensions of the manual: what they make of doc strings, and that they complain about names that do not exist."""
import io
import re
import shutil
import sys
from pathlib import Path

import pytest
from sphinx.application import Sphinx
from sphinx.util.docutils import docutils_namespace

MANUAL = Path(__file__).resolve().parents[2] / "scripts" / "manual"
LITERATURE = "\n\n.. bibliography::\n"
CONF = """
import sys
sys.path.insert(0, {extensions!r})
extensions = ["sphinx.ext.autodoc", "sphinxcontrib.bibtex", "yade_classes"]
bibtex_bibfiles = ["references.bib"]
checked_classes = {headers!r}
nitpicky = True
"""
#: warnings about what a test leaves out on purpose
LEFT_OUT = re.compile(r"(class|module) \S+ is on no page")


@pytest.fixture
def build(tmp_path, monkeypatch):
	"""Makes one page from reStructuredText and returns its HTML, and the warnings."""
	monkeypatch.setattr(sys, "path", list(sys.path))

	def make(text, headers=""):
		(tmp_path / "pkg").mkdir()
		(tmp_path / "pkg" / "Some.hpp").write_text(headers)
		settings = CONF.format(extensions=str(MANUAL / "extensions"), headers=str(tmp_path / "pkg"))
		(tmp_path / "conf.py").write_text(settings)
		shutil.copy(MANUAL / "references.bib", tmp_path)
		(tmp_path / "index.rst").write_text("Title\n=====\n\n" + text)
		warnings = io.StringIO()
		with docutils_namespace():
			out, cache = tmp_path / "out", tmp_path / "cache"
			Sphinx(tmp_path, tmp_path, out, cache, "html", status=None, warning=warnings).build()
		without_colours = re.sub("\x1b\\[[0-9;]*m", "", warnings.getvalue())
		return (out / "index.html").read_text(encoding="utf-8"), without_colours

	return make


def others(warnings):
	return [line for line in warnings.splitlines() if line and not LEFT_OUT.search(line)]


def test_references_lead_to_the_page_or_to_yades_documentation(build):
	page, warnings = build(
		".. yade-class:: DeformableElastMat\n\n:yref:`the stiffness<DeformableElastMat.rotationStiffness>` "
		":yref:`NewtonIntegrator.damping` :yref:`ConcreteDamageMat.bulk`" + LITERATURE
	)
	assert not others(warnings)
	shown = re.search(r'href="#DeformableElastMat.rotationStiffness" title="[\w.]*">(.*?)</a>', page)
	assert re.sub("<[^>]*>", "", shown.group(1)) == "the stiffness"
	assert 'href="https://yade-dem.org/doc/yade.wrapper.html#yade.wrapper.NewtonIntegrator.damping"' in page
	assert 'href="#DeformableElastMat.bulk"' in page  # inherited: where the class that has it is documented
	assert "yade.wrapper.html#yade.wrapper.ElastMat.young" in page  # in a doc string


@pytest.mark.parametrize("name", ["DeformableTriangel", "DeformableEngine.rotatoin", "NewtonIntegrator.dampnig"])
def test_reference_to_what_yade_does_not_have_is_a_warning(build, name):
	assert any(f"YADE has no '{name}'" in line for line in others(build(f":yref:`{name}`\n")[1]))


def test_class_shows_defaults_units_methods_and_what_it_changes(build):
	page, warnings = build(".. yade-class:: ConcreteDamageMat\n\n.. yade-class:: DeformableEngine" + LITERATURE)
	assert not others(warnings)
	text = re.sub(r"\s+", " ", re.sub("<[^>]*>", "", page))
	for default in ("strength = 140e6", "eosExponent = 2/3", "viscoplasticFlow = True", "flowExponent = 0.5"):
		assert default in text
	assert "bulk (30e9), shear (26e9)" in text  # Zubelewicz (2018), Table 1, in the place of the elastic material's
	assert "array(name)" in text and "criticalTimeStep()" in text
	assert ":ydefault:" not in text and ":yattr" not in text
	assert "[Zubelewicz2018]_" not in text and "Zubelewicz" in text


def test_citation_that_the_bibliography_does_not_have_is_a_warning(build, monkeypatch):
	import yade.ddem.energy
	monkeypatch.setattr(yade.ddem.energy, "__doc__", "Energy after [Nobody1999]_.")
	_, warnings = build(".. automodule:: yade.ddem.energy" + LITERATURE)
	assert any("Nobody1999" in line for line in others(warnings))


def test_class_and_module_without_a_page_are_named(build):
	_, warnings = build(".. automodule:: yade.ddem.energy" + LITERATURE, "REGISTER_SERIALIZABLE(SomeNewLaw);\n")
	assert "class SomeNewLaw is on no page" in warnings
	assert "module yade.ddem.block is on no page" in warnings and "module yade.ddem.energy is" not in warnings


def test_switches_are_a_table_of_what_is_true_or_false(build):
	page, warnings = build(".. yade-switches::\n\n   ConcreteDamageMat\n   DeformableEngine.rotation\n")
	assert not others(warnings)
	assert len(re.findall(r"<tr[ >]", page)) == 1 + 4 + 1  # the head; four effects; rotation


def test_switch_that_does_not_exist_is_named(build):
	_, warnings = build(".. yade-switches::\n\n   ConcreteDamageMat.flwo\n")
	assert any("YADE has no 'ConcreteDamageMat.flwo'" in line for line in others(warnings))
