# GPL v2 or later, see LICENSE.
"""Pages: what all reports in HTML share. A page is one file; its pictures are in it, and beside it as files."""
import base64
import os
from dataclasses import dataclass

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from .. import plots, provenance
from ..provenance import machine, processor  # noqa: F401: of all pages

_TEMPLATES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "templates")


@dataclass(frozen=True)
class Picture:
	"""A picture of a page."""
	data: str  # PNG file in base64
	width: float  # on paper [mm]


def encoded(data):
	"""Bytes of a file in base64, as a page holds them."""
	return base64.b64encode(data).decode()


def save(figures, folder, pdf=False):
	"""Write figures as PNG files into a folder and return them as a dict of :class:`Picture`.

	:param figures: dict from the name of the file to a matplotlib figure; None where there is nothing to draw
	:param pdf: write each as a PDF file as well
	"""
	pictures = {}
	for name, figure in figures.items():
		if figure is None:
			continue
		path = os.path.join(folder, name)
		for ending in ("png", "pdf") if pdf else ("png", ):
			plots.save(figure, f"{path}.{ending}")
		with open(f"{path}.png", "rb") as file:
			pictures[name] = Picture(encoded(file.read()), 25.4 * figure.get_figwidth())
	return pictures


def short(value):
	"""A number with three digits, whole from a hundred on: "9.87", "1234"."""
	return f"{value:.3g}" if abs(value) < 100 else f"{value:.0f}"


def render(template, filters=None, **values):
	"""A page from a template of this package's, which extends page.html.

	:param filters: name -> function, for the template
	:param values: for the template; a name that it uses and that is missing is an error
	"""
	environment = Environment(
		loader=FileSystemLoader(_TEMPLATES), autoescape=True, undefined=StrictUndefined, trim_blocks=True,
		lstrip_blocks=True
	)
	environment.filters.update({"short": short, **(filters or {})})
	origin = provenance.record()
	comment = Markup(provenance.comment(origin))
	return environment.get_template(template).render(origin=origin, comment=comment, **values)


def write(page, path):
	"""Write a page and return its path."""
	with open(path, "w", encoding="utf-8") as file:
		file.write(page)
	return path
