# GPL v2 or later, see LICENSE.
"""``.. verification-cases::`` lists the verification cases, from what each says of itself."""
from docutils import nodes
from sphinx.util.docutils import SphinxDirective

from yade.ddem import verification


class VerificationCases(SphinxDirective):
	"""A table for each group: name, what it shows, wall time."""

	def run(self):
		found = verification.all_cases()
		shown = []
		for group in dict.fromkeys(case.group for case in found):
			shown += [nodes.rubric(text=group), table([case for case in found if case.group == group])]
		return shown


def table(cases):
	result, widths = nodes.table(), (24, 68, 8)
	group = nodes.tgroup(cols=len(widths))
	result += group
	group += [nodes.colspec(colwidth=width) for width in widths]
	head, body = nodes.thead(), nodes.tbody()
	group += [head, body]
	head += row([nodes.Text("case")], [nodes.Text("shows")], [nodes.Text("takes")])
	for case in cases:
		needs = f" (needs {case.needs})" if case.needs else ""
		name, title = nodes.literal(text=case.name), nodes.Text(case.title + needs)
		body += row([name], [title], [nodes.Text(f"{case.seconds:g} s")])
	return result


def row(*entries):
	made = nodes.row()
	for entry in entries:
		made += nodes.entry("", nodes.paragraph("", "", *entry))
	return made


def setup(app):
	app.add_directive("verification-cases", VerificationCases)
	return {"parallel_read_safe": False, "parallel_write_safe": True}
