# GPL v2 or later, see LICENSE.
"""What a report says about a test of deformable triangles: rows about sample and test, and sentences."""
from ..studies.deformable_laws import LAWS, said
from ..studies.deformable_tests import TESTS
from . import parameter_tables

_ELASTICITY = (
	("young", "E", "GPa", 1e9, "Young's modulus"), ("poisson", "ν", "", 1, "Poisson's ratio"),
	("density", "ρ", "kg/m³", 1, "density")
)


def sample_rows(options, block, material, dt):
	"""Rows (name, value, meaning) about the sample.

	:param options: as from :func:`studies.deformable_options.read_options`
	:param block: :class:`block.Block`
	:param material: of it
	:param dt: time step [s]
	"""
	law, mesh = LAWS[options.law], block.mesh
	made = [
		(
			"triangles",
			parameter_tables.number(len(mesh.triangles)),
			(
				f"{options.pattern} mesh of size {1e3 * options.edge:g} mm, "
				f"{parameter_tables.number(len(mesh.nodes))} nodes, smallest angle "
				f"{mesh.angles.min():.0f}°"
			),
		),
		("rotation", options.rotation, "treatment of the particles' rotation"),
		("law", options.law, law.about),
		*parameter_tables.rows(material, _ELASTICITY),
	]
	for parameter in law.parameters:
		value = getattr(material, parameter.attribute)
		made.append((parameter.attribute, f"{value:g} {parameter.shown_unit}", parameter.help))
	for name, value in options.set:
		made.append((name, said(value), f"attribute of {type(material).__name__}"))
	if options.spread:
		made.append(
			(
				"spread",
				f"{options.spread:g}",
				f"of the triangles' fracture energies over their mean, seed {options.seed}",
			)
		)
	if options.damping:
		made.append(("damping", f"{options.damping:g}", "Cundall's local one, of all motion"))
	return made + [("time step", f"{1e6 * dt:.3g} µs", f"{options.safety:g} of the critical one")]


def settings(options, load):
	"""Rows about the test and its loads."""
	kind = TESTS[options.test]
	width, height, depth = (1e3 * side for side in options.size)
	rows = [
		("sample", f"{width:g} × {height:g} × {depth:g} mm", "width, height, thickness; plane strain"),
		(
			"v",
			f"{options.velocity:g} m/s",
			f"speed {kind.motion(options)}, reached after {1e6 * options.ramp:g} µs",
		),
	]
	if options.ends:
		rows.append(("ends", options.ends, "rough: held laterally; smooth: free to slide"))
	rows += kind.settings(options, load)
	strain = f"{100 * options.strain:g} %"
	until = (
		(f"{100 * options.stop:g} % of the peak", f"or a strain of {strain}") if options.stop
		else (strain, "of strain")
	)
	return rows + [
		("A", f"{1e6 * load.area:.4g} mm²", kind.record.wording.face),
		("end of the test", *until),
	]


def notes(options, load, material, run):
	"""Sentences about rate, elasticity and test; *run*: :class:`studies.runs.Run`."""
	kind = TESTS[options.test]
	peak = run.strength.peak
	top, bottom = (float(run.series[name][peak]) for name in ("force_top", "force_bottom"))
	written = [
		(
			f"Rate. At the peak the forces on both sides are {1e-3 * top:.3g} and {1e-3 * bottom:.3g} kN, "
			f"{100 * abs(top - bottom) / max(abs(top + bottom) / 2, 1e-300):.2g} % apart. Where they "
			"differ much, the test is not quasi-static: lower --velocity."
		)
	]
	modulus = kind.elastic_modulus(load, material.young, material.poisson)
	if modulus:
		written.append(
			f"Elasticity. An elastic sample of this material has the slope {modulus / 1e9:.4g} GPa, "
			f"{kind.modulus}, in this test."
		)
	return written + kind.notes(options, run)
