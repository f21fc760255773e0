# GPL v2 or later, see LICENSE.
"""Formulas by KaTeX, from Debian's libjs-katex; it is copied into the manual, so that formulas need no network."""
import html
import os

from docutils.nodes import SkipNode
from sphinx.errors import ExtensionError
from sphinx.util.fileutil import copy_asset

FOLDER = "/usr/share/javascript/katex"
#: puts KaTeX's drawing in the place of every formula; a formula that it cannot read is shown as it is written
DRAW = """document.addEventListener("DOMContentLoaded", () => {
	for (const place of document.querySelectorAll(".math"))
		katex.render(place.textContent, place, {displayMode: place.tagName === "DIV", throwOnError: false});
});"""


def inline(writer, node):
	writer.body.append(f'<span class="math">{html.escape(node.astext())}</span>')
	raise SkipNode


def block(writer, node):
	writer.body.append('<div class="equation"{}>'.format(f' id="{node["ids"][0]}"' if node["ids"] else ""))
	writer.body.append(f'<div class="math">{html.escape(aligned(node.astext()))}</div>')
	if node["number"]:
		writer.body.append(f'<span class="number">({node["number"]})')
		writer.add_permalink_ref(node, "Link to this equation")
		writer.body.append("</span>")
	writer.body.append("</div>")
	raise SkipNode


def aligned(text):
	"""Several lines, as LaTeX wants them within one formula; as Sphinx does for its own renderers."""
	text = text.strip()
	if "\\\\" in text and "\\begin" not in text:
		return f"\\begin{{aligned}}{text}\\end{{aligned}}"
	return text


def copy(app, exception):
	if exception or app.builder.format != "html":
		return
	target = os.path.join(app.outdir, "_static", "katex")
	for name in ("katex.min.js", "katex.min.css", "fonts"):
		copy_asset(os.path.join(FOLDER, name), os.path.join(target, "fonts") if name == "fonts" else target)


def add_to_page(app, page, template, context, doctree):
	"""Only pages with formulas load KaTeX."""
	if doctree is None or not app.env.get_domain("math").has_equations(page):
		return
	app.add_css_file("katex/katex.min.css")
	app.add_js_file("katex/katex.min.js")
	app.add_js_file(None, body=DRAW)


def setup(app):
	if not os.path.isfile(os.path.join(FOLDER, "katex.min.js")):
		raise ExtensionError(f"formulas need KaTeX, which is not in {FOLDER}: install Debian's libjs-katex")
	app.add_html_math_renderer("katex", (inline, None), (block, None))
	app.config.html_math_renderer = "katex"
	app.connect("html-page-context", add_to_page)
	app.connect("build-finished", copy)
	return {"parallel_read_safe": True, "parallel_write_safe": True}
