# GPL v2 or later, see LICENSE.
"""Running a structure and looking at it now and then."""
from yade import O


def advance(steps, looks, row, writers=()):
	"""Make *steps* time steps; after each of about *looks* equal parts of them call ``row()``,
	and return the list of what it gave.

	:param writers: called 50 times on the way, such as recorders of ParaView files
	"""
	every, filed, rows = max(1, steps // looks), max(1, looks // 50), []
	for k in range(0, steps, every):
		for write in writers if (k // every) % filed == 0 else ():
			write()
		for _ in range(every):
			O.step()  # O.run looks for its end every 40 ms only
		rows.append(row())
	return rows
