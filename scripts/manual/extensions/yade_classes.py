# GPL v2 or later, see LICENSE.
"""YADE's classes in a manual: doc strings, parameters and methods as Python sees them; YADE's role for references.

``:yref:`DeformableEngine.damping``` and ``:yref:`the damping <DeformableEngine.damping>``` lead to the class or
attribute, on the pages of this manual when it is documented there, else in YADE's own documentation. What the running
YADE does not have is a warning.

``.. yade-class:: NAME`` documents a class. ``.. yade-switches::`` makes a table of attributes, of those named as
``Class.attribute`` on its lines, and of all that are true or false of a ``Class``.

A class of the plugin that no page documents is a warning, and so is a module of its package.

``[Zubelewicz2018]_`` in a doc string, as YADE writes citations, cites the entry of the bibliography.
"""
import inspect
import math
import pathlib
import pkgutil
import re
import textwrap

import yade
import yade.ddem
import yade.wrapper
from docutils import nodes
from docutils.statemachine import StringList
from sphinx import addnodes
from sphinx.errors import NoUri
from sphinx.util import logging
from sphinx.util.docutils import ReferenceRole, SphinxDirective

logger = logging.getLogger(__name__)

YADE_PAGE = "https://yade-dem.org/doc/yade.wrapper.html#yade.wrapper."
IDENTITY = {"id", "dead", "label"}  # attributes whose values differ between any two objects
READ_ONLY = 2  # a flag of YADE's Attr
#: what a plain number looks like in C++
NUMBER = re.compile(r"-?[\d.]+(e-?\d+)?(/[\d.]+)?")
#: modules without a page: what is not for users, and the parts of a package that shows what they hold as its own
WITHOUT_PAGE = re.compile(r"yade\.ddem\.(_\w+|mesh\.\w+|verification\.cases.*)")
#: stands for the space in ":param width, height:", where Sphinx takes what is before a space for a type
JOINER = "\u2060"
#: kinds of objects that a role of the Python domain can mean
KINDS = {
	"func": {"function"}, "meth": {"method"}, "class": {"class", "exception"}, "mod": {"module"},
	"attr": {"attribute", "property"}, "data": {"data"},
}


def yade_object(name):
	"""The class, or attribute of a class, with this name in the running YADE; None when there is none."""
	first, *rest = name.split(".")
	found = getattr(yade.wrapper, first, None)
	for part in rest:
		found = inspect.getattr_static(found, part, None) if not hasattr(found, part) else getattr(found, part)
	return found


class YadeReference(ReferenceRole):
	"""``:yref:``, a reference to a class of YADE or of the plugin."""

	def run(self):
		shown = nodes.literal(self.rawtext, self.title, classes=["xref", "py"])
		if yade_object(self.target) is None:
			message = f"YADE has no '{self.target}' (:yref:)"
			return [shown], [self.inliner.reporter.warning(message, line=self.lineno)]
		reference = addnodes.pending_xref(
			self.rawtext, shown, refdomain="", reftype="yref", reftarget=self.target
		)
		reference["refexplicit"] = reference["refwarn"] = True
		self.set_source_info(reference)
		return [reference], []


def resolve(app, env, node, content):
	"""Where references lead that Sphinx has not resolved: YADE's names, and short names of what is ours."""
	if node.get("reftype") == "yref":
		target = where_documented(node["reftarget"])
		found = python_object(env, target)
		if found:
			return link(app, env, node, content, *found)
		return nodes.reference("", "", content, refuri=YADE_PAGE + target, internal=False)
	if node.get("refdomain") == "py":
		kinds = KINDS.get(node["reftype"], set())
		module, of_class = node.get("py:module") or "", node.get("py:class") or ""
		found = by_short_name(env, node["reftarget"], kinds, module, of_class)
		if found:
			return link(app, env, node, content, *found)
	return None


def where_documented(name):
	"""The name of an attribute with the class that has it first: what a class inherits is documented there."""
	first, _, attribute = name.partition(".")
	owners = [base.__name__ for base in yade_object(first).__mro__ if attribute in vars(base)] if attribute else []
	return f"{owners[0]}.{attribute}" if owners else name


def python_object(env, name):
	return (name, env.get_domain("py").objects[name]) if name in env.get_domain("py").objects else None


def by_short_name(env, target, kinds, module, of_class):
	"""An object of one of these kinds whose name ends with the target, in the module or the nearest package.

	None when there is none or more than one.
	"""
	objects = env.get_domain("py").objects
	scopes = [f"{module}.{of_class}"] if of_class else []
	while module:
		scopes.append(module)
		module = module.rpartition(".")[0]
	for scope in scopes:
		if f"{scope}.{target}" in objects:
			return python_object(env, f"{scope}.{target}")
	for scope in scopes:
		inside = [name for name in objects if name.startswith(scope + ".") and name.endswith("." + target)]
		found = [name for name in inside if objects[name].objtype in kinds]
		if len(found) == 1:
			return python_object(env, found[0])
	return None


def link(app, env, node, content, name, entry):
	try:
		address = app.builder.get_relative_uri(node["refdoc"], entry.docname)
	except NoUri:
		return content
	return nodes.reference("", "", content, refuri=f"{address}#{entry.node_id}", reftitle=name, internal=True)


class YadeClass(SphinxDirective):
	"""Documents a class of YADE: what it says of itself, its own attributes with their defaults, its methods."""
	required_arguments = 1

	def run(self):
		name = self.arguments[0]
		documented = yade_object(name)
		if not inspect.isclass(documented):
			raise self.error(f"YADE has no class '{name}'")
		self.env.metadata[self.env.docname].setdefault("yade_classes", set()).add(name)
		return parse(self, class_text(documented))


def parse(directive, text):
	place = f"doc strings on page {directive.env.docname}"
	part = nodes.section()
	part.document = directive.state.document
	directive.state.nested_parse(StringList(text.split("\n"), place), 0, part)
	return part.children


def class_text(documented):
	"""A class as reStructuredText."""
	parts = [f".. py:class:: {documented.__name__}(…)\n"]
	parts += [indented(bases_text(documented)), indented(cited(documented.__doc__ or ""))]
	members = [(name, member) for name, member in vars(documented).items() if not name.startswith("_")]
	for name, member in members:
		if isinstance(member, property):
			parts.append(indented(attribute_text(documented, name, member)))
	for name, member in members:
		if not isinstance(member, property) and callable(getattr(documented, name)):
			parts.append(indented(method_text(documented, name)))
	return "\n\n".join(parts)


def bases_text(documented):
	base = documented.__mro__[1].__name__
	text = f"Base: :yref:`{base}`."
	changed = changed_defaults(documented)
	return text + (" Defaults of its own for " + ", ".join(changed) + "." if changed else "")


def changed_defaults(documented):
	"""Inherited attributes to which the constructor gives another default than the base does."""
	try:
		mine, theirs = documented(), documented.__mro__[1]()
	except (RuntimeError, TypeError, ValueError):  # classes that nobody can make
		return []
	changed = []
	for base in documented.__mro__[1:]:
		for name, member in vars(base).items():
			settable = isinstance(member, property) and member.fset is not None
			if not settable or name.startswith("_") or name in IDENTITY:
				continue
			value = getattr(mine, name)
			if isinstance(value, (int, float)) and value != getattr(theirs, name):
				changed.append(f":yref:`{name}<{base.__name__}.{name}>` ({number(value)})")
	return changed


def number(value):
	"""A number as this code base writes it: 26e9 rather than 2.6e+10."""
	if isinstance(value, bool) or not 1e4 <= abs(value) < math.inf:
		return f"{value:.4g}" if isinstance(value, float) else repr(value)
	power = 3 * int(math.log10(abs(value)) // 3)
	return f"{value / 10**power:.4g}e{power}"


def documentation(member):
	"""Text, default in C++ (None when computed) and flags of an attribute: what YADE appends to its doc string."""
	text = member.__doc__ or ""
	notes = {key: value for key, value in re.findall(r":y(default|attrtype|attrflags):`([^`]*)`", text)}
	text = re.sub(r"\s*:y(default|attrtype|attrflags):`[^`]*`", "", text).strip()
	return text, notes.get("default"), int(notes.get("attrflags") or 0)


def default_text(documented, name, member):
	"""The default of an attribute as a Python script would write it; empty when there is none."""
	written = documentation(member)[1]
	if written is None:
		return ""
	written = re.sub(r"\s*/\s*", "/", written)  # 2. / 3
	if NUMBER.fullmatch(written):
		return re.sub(r"(?<=\d)\.(?!\d)", "", re.sub(r"(?<!\d)\.(?=\d)", "0.", written))
	try:
		value = getattr(documented(), name)
	except (RuntimeError, TypeError, ValueError):
		return written
	return number(value) if isinstance(value, float) else repr(value)


def attribute_text(documented, name, member):
	text, _, flags = documentation(member)
	head = [f".. py:attribute:: {documented.__name__}.{name}"]
	default = default_text(documented, name, member)
	if default and len(default) < 60:
		head.append(f"   :value: {default}")
	read_only = flags & READ_ONLY or member.fset is None
	return "\n".join(head) + "\n\n" + indented(cited(text) + (" *Read-only.*" if read_only else ""))


def method_text(documented, name):
	"""A method from the doc string that Boost.Python makes.

	That has, for each overload, a line 'name( (Type)argument, …) -> type :' and the text below it.
	"""
	static = "   :staticmethod:\n" if isinstance(vars(documented)[name], staticmethod) else ""
	text = getattr(documented, name).__doc__ or ""
	parts = re.split(rf"^{re.escape(name)}\((.*)\) -> (.*) :$", text, flags=re.MULTILINE)
	if len(parts) < 4:
		return f".. py:method:: {documented.__name__}.{name}()\n{static}\n" + indented(cited(text))
	shown = []
	for arguments, _, body in zip(parts[1::3], parts[2::3], parts[3::3]):
		found = re.findall(r"\([^()]*\)(\w+(?:=[^,\]]+)?)", arguments)
		# without self, which has no name
		names = ", ".join(name for name in found if not re.match(r"arg\d", name))
		head = f".. py:method:: {documented.__name__}.{name}({names})\n{static}\n"
		shown.append(head + indented(cited(textwrap.dedent(body).strip())))
	return "\n\n".join(shown)


def indented(text):
	return textwrap.indent(text, "   ")


def cited(text):
	"""A doc string, where [Key]_ is a citation."""
	return re.sub(r"\[([A-Z]\w*\d{4}[a-z]?)\]_", r":cite:p:`\1`", text)


def truths(documented):
	"""Names of the attributes that are true or false."""
	return [name for name, member in vars(documented).items() if documentation(member)[1] in ("true", "false")]


class YadeSwitches(SphinxDirective):
	"""A table of attributes: name, default, what it says of itself."""
	has_content = True

	def run(self):
		rows = []
		for line in self.content:
			name, _, attribute = line.strip().partition(".")
			documented = yade_object(name)
			if not inspect.isclass(documented) or attribute and not hasattr(documented, attribute):
				raise self.error(f"YADE has no '{line.strip()}'")
			chosen = [attribute] if attribute else truths(documented)
			if not chosen:
				raise self.error(f"'{name}' has no attribute that is true or false")
			rows += [(documented, key, inspect.getattr_static(documented, key)) for key in chosen]
		text = [".. list-table::", "   :header-rows: 1", "   :widths: 26 14 60", ""]
		text += ["   * - switch", "     - default", "     - what it does"]
		for documented, key, member in rows:
			text.append(f"   * - :yref:`{documented.__name__}.{key}`")
			text.append(f"     - ``{default_text(documented, key, member)}``")
			text.append(f"     - {cited(documentation(member)[0])}")
		return parse(self, "\n".join(text))


def read_docstring(app, what, name, documented, options, lines):
	text = "\n".join(lines)
	text = re.sub(r"(?<=:param )[\w, ]+(?=:)", lambda names: names.group().replace(", ", "," + JOINER), text)
	title = [f".. rubric:: {name}", "   :class: module", ""] if what == "module" else []
	lines[:] = title + cited(text).split("\n")


def show_spaces(app, page):
	for text in list(page.findall(nodes.Text)):
		if JOINER in text:
			text.parent.replace(text, nodes.Text(text.replace(JOINER, " ")))


def classes_of_plugin(folder):
	"""YADE classes that the plugin's headers register."""
	found = set()
	for header in pathlib.Path(folder).rglob("*.hpp"):
		text = header.read_text(encoding="utf-8")
		found.update(re.findall(r"^REGISTER_SERIALIZABLE\((\w+)\)", text, re.MULTILINE))
	return found


def modules_of_package():
	"""All modules of yade.ddem but programs and verification cases, which have pages of their own."""
	package = yade.ddem
	names = {module.name for module in pkgutil.walk_packages(package.__path__, package.__name__ + ".")}
	return {name for name in names | {package.__name__} if not WITHOUT_PAGE.fullmatch(name)}


def check_complete(app, env):
	"""Nothing of the plugin is forgotten, and no name of something that is gone stays."""
	shown = set().union(*(data.get("yade_classes", ()) for data in env.metadata.values()))
	for name in sorted(classes_of_plugin(app.config.checked_classes) - shown):
		logger.warning("class %s is on no page: add '.. yade-class:: %s' to reference/classes.rst", name, name)
	for name in sorted(modules_of_package() - set(env.get_domain("py").modules)):
		logger.warning("module %s is on no page: add '.. automodule:: %s' to a page of reference/", name, name)


def setup(app):
	app.add_config_value("checked_classes", "", "env")
	app.add_role("yref", YadeReference())
	app.add_directive("yade-class", YadeClass)
	app.add_directive("yade-switches", YadeSwitches)
	app.connect("missing-reference", resolve)
	app.connect("autodoc-process-docstring", read_docstring)
	app.connect("doctree-read", show_spaces)
	app.connect("env-check-consistency", check_complete)
	return {"parallel_read_safe": False, "parallel_write_safe": True}
