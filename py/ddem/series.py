# GPL v2 or later, see LICENSE.
"""Time series with units, and their CSV files."""
import re

import numpy as np

from . import provenance

_HEADER = re.compile(r"\s*(\w+)\s*\[(.*)\]\s*$")


class Series:
	"""Rows of numbers in named columns with units.

	Fill it row by row, take a column, write and read files::

		series = Series(time="s", stress="Pa")
		series.append(time=0.0, stress=1e6)
		series["stress"]                        # numpy array
		series.write("series.csv")              # header: time [s],stress [Pa]
		Series.read("series.csv")
	"""

	def __init__(self, **units):
		if not units:
			raise ValueError("a series needs columns, given as name=unit (\"-\" for a pure number)")
		self.units = dict(units)  #: unit by column, in order
		self._rows = []

	@classmethod
	def of(cls, units, **columns):
		"""A series of whole columns: ``Series.of({"time": "s"}, time=times)``."""
		series = cls(**units)
		for row in zip(*columns.values(), strict=True):
			series.append(**dict(zip(columns, row)))
		return series

	def __len__(self):
		return len(self._rows)

	def __getitem__(self, name):
		"""A column as an array."""
		column = self._column(name)
		return np.array([row[column] for row in self._rows], float)

	def last(self, name):
		"""The newest value of a column."""
		return self._rows[-1][self._column(name)]

	def append(self, **values):
		"""Add a row; it must have exactly this series' columns."""
		if values.keys() != self.units.keys():
			wrong = sorted(values.keys() ^ self.units.keys())
			raise ValueError(
				f"a row of this series has the columns {', '.join(self.units)}; {', '.join(wrong)} is "
				"missing or unknown"
			)
		self._rows.append([float(values[name]) for name in self.units])

	def write(self, path):
		"""Write a CSV file: a header of names with units, then all digits of every number.

		Its last line, which begins with "#", says where it comes from (see :mod:`provenance`).
		"""
		with provenance.csv_writer(path) as writer:
			writer.writerow([f"{name} [{unit}]" for name, unit in self.units.items()])
			writer.writerows([[repr(value) for value in row] for row in self._rows])

	@classmethod
	def read(cls, path):
		"""Read what :meth:`write` wrote. ValueError names the line that is not understood."""
		with open(path, newline="") as file:
			rows = provenance.csv_rows(file)
			columns = [_HEADER.match(cell) for cell in next(rows, (1, []))[1]]
			if not columns or not all(columns):
				raise ValueError(
					f"{path}, line 1: the header must name every column with its unit, "
					"as in \"time [s],stress [Pa]\""
				)
			series = cls(**{found[1]: found[2] for found in columns})
			if len(series.units) != len(columns):
				raise ValueError(f"{path}, line 1: a column is named twice")
			for line, row in rows:
				try:
					series._rows.append([float(cell) for cell in row])
				except ValueError as error:
					raise ValueError(f"{path}, line {line}: {error}") from None
				if len(row) != len(columns):
					raise ValueError(
						f"{path}, line {line}: {len(row)} fields where the header has "
						f"{len(columns)}"
					)
		return series

	def _column(self, name):
		try:
			return list(self.units).index(name)
		except ValueError:
			raise KeyError(f"this series has no column '{name}'; it has {', '.join(self.units)}") from None
