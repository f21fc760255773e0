# GPL v2 or later, see LICENSE.
"""What a kind of test calls what it measures: labels of pictures, rows of tables and sentences of reports."""
from dataclasses import dataclass


@dataclass(frozen=True)
class Column:
	"""A quantity of the load that a kind of test records beside stress, strain and forces,
	and draws over strain."""
	name: str  # of the load's attribute
	unit: str  # of it
	label: str  # of its axis, with the unit shown there
	factor: float = 1.0  # from its unit to that


@dataclass(frozen=True)
class Wording:
	"""Words of a kind of test; the default is uniaxial compression."""
	strength: str = "ucs_MPa"  # name of the strength in summary.json
	peak: str = "UCS"  # short name of it, for legends
	rows: tuple = ()  # of the table, beside :data:`reports.uniaxial.ROWS` and as they are
	stress: str = "axial stress"
	strain: str = "axial strain"
	modulus: str = "young_GPa"  # name of the slope in summary.json; None: it means nothing
	modulus_name: str = "Young's modulus"
	where: str = ""  # after the figure of the strength: "in tension"
	digits: int = 2  # of the strain at the peak in per cent
	loads: str = "platens"  # what does the work
	ends: tuple = ("top platen", "bottom platen")
	force: str = "force on platen"
	curve: str = "Axial stress, the mean of both platens, over the shortening of the sample."
	forces: str = (
		"Forces on the two platens. Where they agree the sample is in equilibrium; their difference is the "
		"inertia of the sample, and a sign that the platens move fast."
	)
	# what stress and strain are, in HTML
	definition: str = (
		"Stress: (<i>F</i><sub>top</sub> + <i>F</i><sub>bottom</sub>)/(2<i>A</i>), <i>A</i> the loaded face "
		"before loading; strain: approach of the platens over the height; compression positive."
	)
	also: tuple = ()  # of :class:`Column`, each drawn over the last one
	also_text: str = ""  # caption of that picture
	face: str = "loaded face"  # what the area A of the settings is


COMPRESSION = Wording()
TENSION = Wording(
	strength="tensile_MPa", peak="tensile strength", stress="tensile stress", where="in tension ", digits=3,
	curve="Axial stress, the mean of both platens, over the lengthening of the sample.",
	definition=COMPRESSION.definition.replace("approach of the platens", "distance that the platens moved apart"
	).replace("compression positive", "tension positive")
)
