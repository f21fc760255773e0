# GPL v2 or later, see LICENSE.
"""What a report says about a test of bonded spheres: rows about sample and test, and sentences."""
import os

from ..studies.bonded_specimen import CRITERIA
from ..studies.bonded_tests import TESTS
from ..studies.bonded_tests.kind import closing_speed
from . import parameter_tables


def sample_rows(options, packing, bonds, material, dt, critical):
	"""Rows (name, value, meaning) about the sample.

	:param options: as from :func:`studies.bonded_options.read_options`
	:param packing: :class:`packing.Packing`
	:param bonds: number of bonds at the start
	:param material: of the bonds
	:param dt, critical: time step and the largest stable one [s]
	"""
	smallest, largest = (1e3 * radius for radius in (packing.radii.min(), packing.radii.max()))
	width, height, depth = 1e3 * packing.size
	mass = "density × 4/3 π r³" if options.mass_law == "solid" else "density × r³"
	if options.particles:
		origin = f"from {os.path.basename(options.particles)}"
	else:
		packer = "GenGeo" if options.generator == "gengeo" and options.shape == "prism" else "ddem.packing.fill"
		origin = f"packed by {packer}, seed {options.seed}, until {options.fails} insertions in a row failed"
	made = [
		(
			"spheres",
			parameter_tables.number(len(packing)),
			(
				f"radii {smallest:.3g} to {largest:.3g} mm, {100 * packing.solid_fraction:.1f} % of "
				f"the box; {origin}"
			),
		),
		("box", f"{width:.4g} × {height:.4g} × {depth:.4g} mm", "width, height, depth"),
		(
			"bonds",
			parameter_tables.number(bonds),
			f"{2 * bonds / len(packing):.1f} a sphere",
		),
		*parameter_tables.rows(material, parameter_tables.BONDED),
	]
	if options.scatter:
		made.append(
			("m", f"{options.scatter:g}", f"Weibull modulus of the bonds' strength, seed {options.seed}")
		)
	for name in CRITERIA[options.criterion][1].values():
		made.append((name.replace("_", " "), f"{getattr(options, name):g}", f"of {type(material).__name__}"))
	if options.tensile_strength:
		made.append(("f_t", f"{options.tensile_strength / 1e6:.4g} MPa", "tensile strength of the bonds"))
	if options.gradual_friction:
		made.append(
			(
				"gradual friction",
				"yes",
				"tangential forces of contacts grow gradually with the slip (eq. 7)",
			)
		)
	if any(options.contact_damping):
		made.append(
			(
				"contact damping",
				"{:g}, {:g}".format(*options.contact_damping),
				"normal and tangential, parts of the critical one (eq. 6)",
			)
		)
	made.append(("ρ", f"{material.density:.4g} kg/m³", f"density of the spheres; mass = {mass}"))
	made.append(("time step", f"{1e9 * dt:.3g} ns", f"{dt / critical:.2g} of the critical one"))
	return made


def settings(options, platens):
	"""Rows about the test and its walls."""
	kind = TESTS[options.test]
	peer = ", as in ESyS-Particle 2.3.5" if options.convention == "esys" else ""
	direction = f"; they {'pull' if kind.sense < 0 else 'push'}" if kind.two_walls else ""
	rows = [
		("convention", options.convention, f"of bonds, contacts and moving walls{peer}"),
		(
			"walls" if kind.two_walls else "v",
			f"{options.velocity:g} m/s",
			f"speed {kind.motion(options)}, reached after {1e6 * options.ramp:g} µs{direction}",
		),
		(
			"K",
			f"{options.wall_stiffness / 1e9:g} GPa",
			"stiffness of the walls, π r K for a sphere of radius r",
		),
	]
	rows += kind.settings(options, platens)
	if options.bonded_walls:
		along = (
			f"stiffness along them {options.wall_shear_stiffness / 1e9:g} GPa"
			if options.wall_shear_stiffness
			else "free to slide along them"
		)
		rows.append(("ends", "bonded", f"spheres within 1.1 radii of a wall are bonded to it, {along}"))
	strain = f"{100 * options.strain:g} %"
	until = (
		(f"{100 * options.stop:g} % of the peak", f"or a strain of {strain}")
		if options.stop
		else (strain, "of strain")
	)
	return rows + [
		("A", f"{1e6 * platens.area:.4g} mm²", kind.record.wording.face),
		(
			"viscosity",
			f"{options.viscosity:g}, {options.rotational_viscosity:g} /s",
			"of translation and rotation",
		),
		("end of the test", *until),
	]


def notes(options, platens, run):
	"""Sentences about rate, convention and test; *run*: :class:`studies.runs.Run`."""
	said = []
	wave = run.extra["wave_speed_m_s"]
	if wave:
		said.append(
			f"Rate. The sample has {parameter_tables.number(round(run.extra['sample_density_kg_m3']))} "
			f"kg/m³ as a whole, so that a wave runs along it at about √(E/ρ) = {wave:.0f} m/s, "
			f"{parameter_tables.number(round(wave / options.velocity))} times as fast as a wall, and "
			f"needs {1e6 * platens.height / wave:.1f} µs from end to end, in which the strain grows by "
			f"{100 * closing_speed(options) / wave:.3f} %. Where the two wall forces differ, the test is "
			"not quasi-static."
		)
	elif run.wording.modulus != "young_GPa":
		peak = run.strength.peak
		top, bottom = (float(run.series[name][peak]) for name in ("force_top", "force_bottom"))
		said.append(
			f"Rate. At the peak the forces on both sides are {1e-3 * top:.3g} and {1e-3 * bottom:.3g} kN, "
			f"{100 * abs(top - bottom) / max(abs(top + bottom) / 2, 1e-300):.2g} % apart. Where they "
			"differ much, the test is not quasi-static: lower --velocity."
		)
	if options.convention == "esys":
		said.append(
			"ESyS-Particle's bonds have half the bending moment EI/d₀, the sum of the radii as rest "
			"length, and moment arms that are not conservative for unequal radii, so the energy book does "
			"not close exactly. Bonds between spheres with a gap g start with the stress E g/d₀, and "
			"break at once where it exceeds their strength."
		)
	said += TESTS[options.test].notes(options, run)
	return said
