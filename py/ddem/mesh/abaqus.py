# GPL v2 or later, see LICENSE.
"""Input files of Abaqus and CalculiX: nodes, triangles and element sets.

meshio reads them too, but (5.3) gives the sets of ``*ELEMENT, ELSET=`` to other elements where some have none, forgets
a set that is continued, and knows no plane-strain triangles.
"""
import os
import re
from dataclasses import dataclass, field

import numpy as np

# Elements of three nodes that are read as plane triangles, with all their variants: plane strain, plane stress,
# membranes, shells, rigid surfaces.
_TRIANGLE = re.compile(r"(CPE3|CPEG3|CPS3|M3D3|SFM3D3|S3|STRI3|DS3|R3D3)[A-Z]*")
_SECOND_ORDER = re.compile(r"(CPE6|CPEG6|CPS6|M3D6|SFM3D6|S6|STRI65|DS6)[A-Z]*")
# What a mesh may have beside its triangles: points, bars, springs.
_IGNORED = re.compile(r"(T[23]D|B[23]\d|MASS|ROTARYI|SPRING|DASHPOT|CONN[23]D|R[AB]?[23]D2|GAP)\w*")
_GENERATORS = ("NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM")


@dataclass
class Input:
	"""What an input file has: points (n, 3), triangles (m, 3) of rows of points, sets of rows of triangles, and the
	names of those that have a section.
	"""
	points: np.ndarray
	triangles: np.ndarray
	sets: dict
	sections: list


def read(path):
	"""Read nodes, triangles and element sets.

	:raises ValueError: with the line: other elements, unknown nodes or elements, numbers that are none, several
		parts, generated nodes or elements
	"""
	return _Reader(path).result()


@dataclass
class _Block:
	"""A keyword with its parameters and its lines of data."""
	place: str  # file and line, for messages
	keyword: str
	parameters: dict
	rows: list = field(default_factory=list)  # (place, cells of the line)


class _Reader:

	def __init__(self, path):
		self.points, self.rows_of_points = [], {}
		self.triangles, self.rows_of_triangles, self.others = [], {}, set()
		self.sets, self.spelling, self.sections = {}, {}, []  # sets by name in capitals: Abaqus ignores case
		self.internal = set()  # made by Abaqus/CAE for itself
		self.parts = 0
		for block in _blocks(path):
			self.take(block)

	def take(self, block):
		word = block.keyword
		if word == "NODE":
			self.take_nodes(block)
		elif word == "ELEMENT":
			self.take_elements(block)
		elif word == "ELSET":
			self.take_set(block)
		elif word.endswith(" SECTION") and "ELSET" in block.parameters:
			self.sections.append((block.place, block.parameters["ELSET"]))
		elif word in _GENERATORS:
			raise ValueError(
				f"{block.place}: *{word} is not read; write out all nodes and elements with their "
				"coordinates"
			)
		elif word == "PART" or (word == "INSTANCE" and block.rows):
			self.parts += word == "PART"
			if self.parts > 1 or word == "INSTANCE":
				what = "a second *PART" if word == "PART" else "an *INSTANCE that is moved"
				raise ValueError(
					f"{block.place}: {what} is not read; write one flat mesh (in Abaqus/CAE: model "
					"attribute \"Do not use parts and assemblies in input files\")"
				)

	def take_nodes(self, block):
		for place, cells in block.rows:
			number, *position = _numbers(place, cells, int, float)
			if number in self.rows_of_points:
				raise ValueError(f"{place}: node {number} is there twice")
			if len(position) < 2:
				raise ValueError(
					f"{place}: node {number} has {len(position)} coordinates instead of 2 or 3; "
					"the file is damaged"
				)
			self.rows_of_points[number] = len(self.points)
			self.points.append((position + [0.0])[:3])  # direction cosines may follow

	def take_elements(self, block):
		kind = block.parameters.get("TYPE", "").upper()
		name = block.parameters.get("ELSET")
		plane = _TRIANGLE.fullmatch(kind)
		if not plane and not _IGNORED.fullmatch(kind):
			hint = "replace or split them, or leave them out of the file"
			if _SECOND_ORDER.fullmatch(kind):
				hint = "use triangles of first order"
			raise ValueError(
				f"{block.place}: elements of type {kind or '(none)'}; only plane triangles of three "
				f"nodes (CPE3, CPS3, S3 …) can be used; {hint}"
			)
		if not plane:
			self.others.update(_numbers(place, row[:1], int)[0] for place, row in block.rows)
			return
		cells = [(place, number) for place, row in block.rows for number in _numbers(place, row, int)]
		if len(cells) % 4:
			raise ValueError(
				f"{block.place}: the elements have {len(cells)} numbers, which is no multiple of 4 (an "
				"id and three nodes); the file is damaged"
			)
		members = []
		for k in range(0, len(cells), 4):
			place, number = cells[k]
			unknown = [node for _, node in cells[k + 1:k + 4] if node not in self.rows_of_points]
			if unknown:
				raise ValueError(
					f"{place}: element {number} has node {unknown[0]}, which is not in the file "
					"before it"
				)
			if number in self.rows_of_triangles:
				raise ValueError(f"{place}: element {number} is there twice")
			self.rows_of_triangles[number] = len(self.triangles)
			members.append(len(self.triangles))
			self.triangles.append([self.rows_of_points[node] for _, node in cells[k + 1:k + 4]])
		if name is not None:
			self.add(name, members)

	def take_set(self, block):
		name = block.parameters.get("ELSET")
		if not name:
			raise ValueError(f"{block.place}: *ELSET has no name; write *ELSET, ELSET=name")
		if "INTERNAL" in block.parameters:
			self.internal.add(name.upper())
		for place, row in block.rows:
			if "GENERATE" in block.parameters:
				first, last, step = [
					*_numbers(place, row, int), 1, 1
				][:3] if len(row) > 1 else (None,) * 3
				if first is None or step < 1:
					raise ValueError(
						f"{place}: a generated set needs first, last and step of its elements"
					)
				numbers = [n for n in range(first, last + 1, step) if n in self.rows_of_triangles]
				self.add(name, [self.rows_of_triangles[n] for n in numbers])
				continue
			for cell in row:
				self.add(name, self.members(place, name, cell))

	def members(self, place, name, cell):
		"""Rows of the triangles that a cell of a set stands for: an element or another set."""
		if cell.isdigit():
			number = int(cell)
			if number not in self.rows_of_triangles and number not in self.others:
				raise ValueError(
					f"{place}: set {name} has element {number}, which is not in the file before it"
				)
			return [self.rows_of_triangles[number]] if number in self.rows_of_triangles else []
		if cell.upper() not in self.sets:
			raise ValueError(
				f"{place}: set {name} has {cell!r}, which is neither an element nor a set before it"
			)
		return self.sets[cell.upper()]

	def add(self, name, members):
		self.spelling.setdefault(name.upper(), name)
		self.sets.setdefault(name.upper(), []).extend(members)

	def result(self):
		for place, name in self.sections:
			if name.upper() not in self.sets:
				raise ValueError(f"{place}: the section's element set {name} is not in the file")
		sections = {name.upper() for _, name in self.sections}
		kept = [
			key for key, rows in self.sets.items() if rows and (key in sections or key not in self.internal)
		]
		sets = {self.spelling[key]: np.unique(np.array(self.sets[key], dtype=int)) for key in kept}
		sections = [self.spelling[key] for key in kept if key in sections]
		return Input(
			np.array(self.points).reshape(-1, 3), np.array(self.triangles, dtype=int).reshape(-1, 3), sets,
			sections
		)


def _blocks(path, within=()):
	"""The keywords of a file, and of those it includes, one after the other."""
	if os.path.realpath(path) in within:
		raise ValueError(f"{path!r} includes itself")
	within = (*within, os.path.realpath(path))
	block, header = None, ""
	with open(path, encoding="utf-8", errors="replace") as file:
		for number, line in enumerate(file, start=1):
			line, place = line.strip(), f"{path!r}, line {number}"
			if not line or line.startswith("**"):
				continue
			if line.startswith("*") or header:
				header += line
				if header.endswith(","):
					continue  # goes on in the next line
				if block:
					yield block
				block, header = _keyword(place, header), ""
				if block.keyword == "INCLUDE":
					other = os.path.join(os.path.dirname(path), block.parameters.get("INPUT") or "")
					if not os.path.isfile(other):
						raise ValueError(f"{place}: the included file {other!r} does not exist")
					yield from _blocks(other, within)
					block = None
			elif block:
				block.rows.append((place, [cell.strip() for cell in line.rstrip(",").split(",")]))
	if block:
		yield block


def _keyword(place, header):
	word, *parameters = header[1:].split(",")
	pairs = [parameter.partition("=") for parameter in parameters if parameter.strip()]
	return _Block(
		place, " ".join(word.upper().split()),
		{key.strip().upper(): value.strip().strip('"') for key, _, value in pairs}
	)


def _numbers(place, cells, first, others=None):
	"""Numbers of a line, the first of one kind and the others of another."""
	result = []
	for cell in cells:
		kind = first if not result or others is None else others
		try:
			result.append(float(cell.lower().replace("d", "e") or 0) if kind is float else kind(cell))
		except ValueError:
			raise ValueError(
				f"{place}: {cell!r} is not a {'whole ' if kind is int else ''}number"
			) from None
	return result
