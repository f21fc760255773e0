# GPL v2 or later, see LICENSE.
"""Lists of broken bonds as CSV files: which, when, where, why.

::

	broken_bonds.write(sample.broken, "out/broken.csv")
	records = broken_bonds.read("out/broken.csv")
	(records["mode"] == "tension").sum()

The columns are those of :attr:`bonded.BondedSample.broken`: the two bodies, step and time of failure, middle and normal
of the crack, its radius, the mode ("tension" or "shear"), the normal (tension positive) and shear stress that broke the
bond, and the elastic energy that was lost with it. Needs no YADE.
"""

import numpy as np

from . import provenance

#: a record of a broken bond
DTYPE = np.dtype([
	("id1", int), ("id2", int), ("step", int), ("time", float), ("position", float, 3), ("normal", float, 3),
	("radius", float), ("mode", "U7"),
	("normal_stress", float), ("shear_stress", float), ("energy", float)
])
_COLUMNS = (
	("id1 [-]", "id1", None), ("id2 [-]", "id2", None), ("step [-]", "step", None), ("time [s]", "time", None),
	("x [m]", "position", 0), ("y [m]", "position", 1), ("z [m]", "position", 2),
	("normal_x [-]", "normal", 0), ("normal_y [-]", "normal", 1), ("normal_z [-]", "normal", 2),
	("radius [m]", "radius", None), ("mode", "mode", None), ("normal_stress [Pa]", "normal_stress", None),
	("shear_stress [Pa]", "shear_stress", None),
	("energy [J]", "energy", None)
)  # title, field and component


def write(records, path):
	"""Write records (structured array of :data:`DTYPE`) to a CSV file, all digits of every number."""
	columns = [records[name] if part is None else records[name][:, part] for _, name, part in _COLUMNS]
	with provenance.csv_writer(path) as writer:
		writer.writerow([title for title, _, _ in _COLUMNS])
		writer.writerows(zip(*(column.tolist() for column in columns)))


def read(path):
	"""Read what :func:`write` wrote. ValueError names the line that is not understood."""
	with open(path, newline="") as file:
		lines = provenance.csv_rows(file)
		if next(lines, (1, None))[1] != [title for title, _, _ in _COLUMNS]:
			raise ValueError(f"{path}, line 1: not the header of a list of broken bonds")
		rows = []
		for line, cells in lines:
			if len(cells) != len(_COLUMNS):
				raise ValueError(f"{path}, line {line}: {len(cells)} fields instead of {len(_COLUMNS)}")
			row = np.zeros((), DTYPE)
			for (_, name, part), cell in zip(_COLUMNS, cells):
				kind = DTYPE[name].base.kind
				try:
					value = cell if kind == "U" else int(cell) if kind == "i" else float(cell)
				except ValueError as error:
					raise ValueError(f"{path}, line {line}: {name}: {error}") from None
				if part is None:
					row[name] = value
				else:
					row[name][part] = value
			rows.append(row)
	return np.array(rows, DTYPE)


def counts(records, times, mode=None):
	"""Number of bonds that had broken at each of *times* [s], all of them or those of a mode: (n,)."""
	broken = records["time"] if mode is None else records["time"][records["mode"] == mode]
	return np.searchsorted(np.sort(broken), times, side="right")
