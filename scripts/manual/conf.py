# GPL v2 or later, see LICENSE.
# needs: python3-sphinx furo python3-sphinxcontrib.bibtex python3-myst-parser libjs-katex
"""Settings of the manual, for Sphinx. All it needs are Debian's packages; no page asks the network for anything."""
import os
import re
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
CHECKOUT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(HERE, "extensions"))


def version_of_project():
	"""The version in the heading of the newest finished changes."""
	with open(os.path.join(CHECKOUT, "CHANGELOG.md"), encoding="utf-8") as file:
		return re.search(r"^## (\d\S*)", file.read(), re.MULTILINE).group(1)


project = "Deformable triangles and bonded particles for YADE"
copyright = "the authors; licence GPL version 2 or later"  # noqa: A001: Sphinx calls it so
release = version = version_of_project()
html_title = project
html_short_title = "yade.ddem"
language = "en"

extensions = [
	"sphinx.ext.autodoc", "sphinxcontrib.bibtex", "myst_parser", "katex_math", "yade_classes", "verification_cases"
]
source_suffix = {".rst": "restructuredtext", ".md": "markdown"}
exclude_patterns = ["extensions"]
highlight_language = "python3"
# A table of numbers, a tree of folders: what does not parse is shown as it is.
suppress_warnings = ["misc.highlighting_failure"]

# What a module says of itself comes in the order in which it was written.
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True, "undoc-members": False}
autodoc_typehints = "none"
autodoc_preserve_defaults = True
python_use_unqualified_type_names = True
add_module_names = False
toc_object_entries_show_parents = "hide"
# Types in ":param name:" and ":raises:" that belong to others.
nitpick_ignore_regex = [(r"py:.*", r"(numpy|np|matplotlib|yade|vtk)\..*")]

checked_classes = os.path.join(CHECKOUT, "pkg")  # see extensions/yade_classes.py

bibtex_bibfiles = ["references.bib"]
bibtex_default_style = "plain"
bibtex_reference_style = "author_year"

myst_heading_anchors = 0
myst_enable_extensions = ["dollarmath"]

LINKS = ("color-brand-primary", "color-brand-content", "color-brand-visited")
html_theme = "furo"
html_static_path = ["static"]
html_css_files = ["manual.css"]
html_show_sphinx = False
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {
	"navigation_with_keys": True,
	"light_css_variables": dict.fromkeys(LINKS, "#0b4f7d"),
	"dark_css_variables": dict.fromkeys(LINKS, "#7cc0ee"),
}
