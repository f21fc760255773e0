# GPL v2 or later, see LICENSE.
# The manual as its readers get it: scripts/ddem docs. Warnings are errors there, so that it builds at all says that
# nothing in it leads nowhere.
import html.parser
import os
import pathlib
import subprocess
import urllib.parse

import pytest

DDEM = pathlib.Path(__file__).resolve().parents[2] / 'scripts' / 'ddem'


@pytest.fixture(scope='module')
def manual(tmp_path_factory):
	folder = tmp_path_factory.mktemp('a manual') / 'html'
	made = subprocess.run([DDEM, 'docs', '--out', folder], capture_output=True, text=True)
	assert made.returncode == 0, made.stderr
	assert f'manual: {folder}/index.html' in made.stderr
	return folder


class Page(html.parser.HTMLParser):
	"""What a page links to, loads, and names."""

	def __init__(self, path):
		super().__init__()
		self.links, self.loads, self.names = [], [], set()
		self.feed(path.read_text(encoding='utf-8'))

	def handle_starttag(self, tag, attributes):
		attributes = dict(attributes)
		if tag == 'a' and 'href' in attributes:
			self.links.append(attributes['href'])
		elif tag in ('link', 'script', 'img'):
			self.loads += [attributes[key] for key in ('href', 'src') if key in attributes]
		if 'id' in attributes:
			self.names.add(attributes['id'])


@pytest.fixture(scope='module')
def pages(manual):
	return {path: Page(path) for path in manual.rglob('*.html')}


def test_nothing_is_loaded_from_the_network_and_everything_that_is_loaded_is_there(manual, pages):
	assert len(pages) > 15
	for path, page in pages.items():
		for address in page.loads:
			if address == '#':
				continue  # the page itself
			parts = urllib.parse.urlsplit(address)
			assert not parts.scheme and not parts.netloc, f'{path.name} loads {address}'
			assert (path.parent / urllib.parse.unquote(parts.path)).is_file(), f'{path.name}: no {address}'


def test_every_link_within_the_manual_leads_somewhere(manual, pages):
	followed = 0
	for path, page in pages.items():
		for address in page.links:
			parts = urllib.parse.urlsplit(address)
			if parts.scheme:
				continue
			target = path
			if parts.path:
				target = pathlib.Path(os.path.normpath(path.parent / urllib.parse.unquote(parts.path)))
			assert target.is_file(), f'{path.name}: no {address}'
			assert not parts.fragment or parts.fragment in pages[target].names, f'{path.name}: no {address}'
			followed += bool(parts.fragment)
	assert followed > 500  # it has looked at something


def test_pages_with_formulas_draw_them_and_only_those_load_what_draws(manual):
	with_formulas = (manual / 'models' / 'concrete.html').read_text(encoding='utf-8')
	without = (manual / 'changes.html').read_text(encoding='utf-8')
	assert 'class="math"' in with_formulas and 'katex.min.js' in with_formulas
	assert 'katex' not in without
	assert any((manual / '_static' / 'katex' / 'fonts').glob('*.woff2'))


def test_nothing_is_left_behind_in_the_checkout(manual):
	suffixes = {path.suffix for path in (DDEM.parent / 'manual').rglob('*') if path.is_file()}
	assert suffixes == {'.py', '.rst', '.bib', '.css'}
